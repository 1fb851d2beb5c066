/* The sections of Gmsh's files, and what both versions have in common (Gmsh Reference Manual, "File
 * formats"). */
#include "field/mesh/file/msh.h"

#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "field/mesh/file/formats.h"

/* A file while its sections are read. */
typedef struct msh {
  dvi__reader *r;
  dvi__raw *raw;
  dvi__msh_entities entities;
  int is_newer;  /* version 4.1, else 2.2 */
  unsigned seen; /* a bit for each section */
} msh;

/* ---- types of elements ---- */

dvi_status dvi__msh_shape(const dvi__reader *r, int64_t type, dvi__shape *shape)
{
  static const char *const other[] = {[6] = "prism",        [7] = "pyramid",
                                      [8] = "line",         [9] = "triangle",
                                      [10] = "quadrangle",  [11] = "tetrahedron",
                                      [12] = "hexahedron",  [13] = "prism",
                                      [14] = "pyramid",     [15] = "",
                                      [16] = "quadrangle",  [17] = "hexahedron",
                                      [18] = "prism",       [19] = "pyramid",
                                      [20] = "triangle",    [21] = "triangle",
                                      [22] = "triangle",    [23] = "triangle",
                                      [24] = "triangle",    [25] = "triangle",
                                      [26] = "line",        [27] = "line",
                                      [28] = "line",        [29] = "tetrahedron",
                                      [30] = "tetrahedron", [31] = "tetrahedron"};
  const int known = (int)(sizeof other / sizeof *other);
  for (int s = 0; s < DVI__SHAPES; s++)
    if (dvi__shape_facts_of[s].msh == type) {
      *shape = (dvi__shape)s;
      return DVI_OK;
    }
  if (type == 6 || type == 7)
    return dvi__reject(r, r->mark,
                       "element type %d is a %s: a mesh has simplices, or boxes, and nothing else",
                       (int)type, other[type]);
  if (type >= 8 && type < known)
    return dvi__reject(r, r->mark,
                       "element type %d is a %s of higher order: save the mesh with straight "
                       "elements of order 1",
                       (int)type, other[type]);
  return dvi__reject(r, r->mark,
                     "element type %lld is not known: there are 15 points, 1 lines, 2 triangles, "
                     "3 quadrangles, 4 tetrahedra and 5 hexahedra",
                     (long long)type);
}

/* ---- $MeshFormat ---- */

/* A binary file has the number 1 as an int, from which its byte order is seen. */
static dvi_status check_byte_order(dvi__reader *r)
{
  const unsigned char *byte = NULL;
  DVI_TRY(dvi__end_line(r, "the format"));
  DVI_TRY(dvi__read_bytes(r, "the number 1 as four bytes", 4, &byte));
  const uint64_t one = dvi__little_endian(byte, 4);
  if (one == 1) return DVI_OK;
  if (one == UINT64_C(1) << 24)
    return dvi__reject(r, r->mark,
                       "the file is big-endian, and only little-endian binary files can be read: "
                       "save it as text");
  return dvi__reject(r, r->mark, "found the bytes of %llu where those of 1 are expected",
                     (unsigned long long)one);
}

static dvi_status read_format(msh *m)
{
  dvi__reader *r = m->r;
  dvi__word version;
  int64_t binary, width;
  DVI_TRY(dvi__expect_word(r, "$MeshFormat"));
  DVI_TRY(dvi__read_word(r, "the version", &version));
  m->is_newer = strcmp(version.text, "4.1") == 0;
  if (!m->is_newer && strcmp(version.text, "2.2") != 0)
    return dvi__reject(r, r->mark,
                       "the file has version \"%s\" of the format: only 2.2 and 4.1 can be read",
                       version.text);
  DVI_TRY(dvi__read_text_integer(r, "0 for text, or 1 for binary", 0, 1, &binary));
  DVI_TRY(dvi__read_text_integer(r, "the size of numbers", 8, 8, &width));
  r->is_binary = binary != 0;
  if (binary) DVI_TRY(check_byte_order(r));
  return dvi__expect_word(r, "$EndMeshFormat");
}

/* ---- $PhysicalNames and $DviSpace, which are text in binary files, too ---- */

static dvi_status read_name(dvi__reader *r, dvi__raw *raw)
{
  int64_t dimension, tag;
  DVI_TRY(dvi__read_text_integer(r, "the dimension of a group", 0, 3, &dimension));
  const size_t place = r->mark;
  DVI_TRY(dvi__read_text_integer(r, "the number of a group", 0, INT32_MAX, &tag));
  if (!dvi__skip_blanks(r) || r->byte[r->at] != '"')
    return dvi__reject(r, r->at, "expected a name in quotes");
  const size_t first = ++r->at;
  while (r->at < r->size && r->byte[r->at] != '"' && r->byte[r->at] != '\n') r->at++;
  if (r->at == r->size || r->byte[r->at] != '"')
    return dvi__reject(r, first, "a name has no quote at its end");
  r->at++;
  return dvi__raw_name_group(raw, dimension, tag, place, r->byte + first, r->at - 1 - first);
}

static dvi_status read_names(msh *m)
{
  int64_t count;
  DVI_TRY(dvi__read_text_integer(m->r, "the number of names", 0, INT32_MAX, &count));
  DVI_TRY(dvi__claim(m->r, "names", count, 8, 8));
  for (int64_t i = 0; i < count; i++) DVI_TRY(read_name(m->r, m->raw));
  return dvi__raw_sort_groups(m->raw);
}

/* Lines may be simplices or boxes, which no other number of a file tells. */
static dvi_status read_kind(msh *m)
{
  dvi__word kind;
  DVI_TRY(dvi__read_word(m->r, "\"simplices\" or \"boxes\"", &kind));
  const int are_boxes = strcmp(kind.text, "boxes") == 0;
  if (!are_boxes && strcmp(kind.text, "simplices") != 0)
    return dvi__reject(m->r, m->r->mark, "found \"%s\" where simplices or boxes are expected",
                       kind.text);
  m->raw->lines = are_boxes ? DVI_BOXES : DVI_SIMPLICES;
  return DVI_OK;
}

static dvi_status read_axes(msh *m)
{
  int64_t space;
  DVI_TRY(read_kind(m));
  DVI_TRY(dvi__read_text_integer(m->r, "the number of coordinates", 1, 3, &space));
  for (int i = 0; i < space; i++)
    DVI_TRY(dvi__read_real(m->r, "the metric of an axis", m->raw->metric + i));
  for (int i = 0; i < space; i++)
    DVI_TRY(dvi__read_real(m->r, "the period of an axis", m->raw->period + i));
  m->raw->space = (int)space;
  return DVI_OK;
}

/* This section is not Gmsh's, which passes over it. It tells what a mesh of libdvi has besides. */
static dvi_status read_space(msh *m)
{
  const int is_binary = m->r->is_binary;
  m->r->is_binary = 0;
  const dvi_status status = read_axes(m);
  m->r->is_binary = is_binary;
  return status;
}

/* ---- the other sections ---- */

static dvi_status read_entities(msh *m)
{
  return dvi__msh4_entities(m->r, &m->entities);
}

static dvi_status read_nodes(msh *m)
{
  DVI_TRY(m->is_newer ? dvi__msh4_nodes(m->r, m->raw) : dvi__msh2_nodes(m->r, m->raw));
  return dvi__raw_sort_points(m->raw);
}

static dvi_status read_elements(msh *m)
{
  DVI_TRY(m->is_newer ? dvi__msh4_elements(m->r, m->raw, &m->entities)
                      : dvi__msh2_elements(m->r, m->raw));
  return dvi__raw_check_tags(m->raw);
}

static dvi_status refuse_partitions(msh *m)
{
  return dvi__reject(m->r, m->r->mark,
                     "the mesh is partitioned: save it without partitions to read it");
}

/* A section that is read. */
typedef struct section {
  const char *name;
  dvi_status (*read)(msh *m);
  int is_newer;  /* version 4.1 alone has it */
  int is_binary; /* in a binary file its first number begins behind the line with its name */
  int before;    /* a section that must not come before it, or -1 */
  int after;     /* a section that must come before it, or -1 */
} section;
enum { NAMES, SPACE, ENTITIES, NODES, ELEMENTS, PARTITIONS, SECTIONS };
static const section sections[SECTIONS] = {
    [NAMES] = {"PhysicalNames", read_names, 0, 0, -1, -1},
    [SPACE] = {"DviSpace", read_space, 0, 0, -1, -1},
    [ENTITIES] = {"Entities", read_entities, 1, 1, ELEMENTS, -1},
    [NODES] = {"Nodes", read_nodes, 0, 1, -1, -1},
    [ELEMENTS] = {"Elements", read_elements, 0, 1, -1, NODES},
    [PARTITIONS] = {"PartitionedEntities", refuse_partitions, 1, 1, -1, -1},
};

static dvi_status check_order(const msh *m, int s)
{
  const section *this_one = sections + s;
  if (m->seen >> s & 1)
    return dvi__reject(m->r, m->r->mark, "there is a second section $%s", this_one->name);
  if (this_one->after >= 0 && !(m->seen >> this_one->after & 1))
    return dvi__reject(m->r, m->r->mark, "$%s comes before $%s", this_one->name,
                       sections[this_one->after].name);
  if (this_one->before >= 0 && m->seen >> this_one->before & 1)
    return dvi__reject(m->r, m->r->mark, "$%s comes behind $%s", this_one->name,
                       sections[this_one->before].name);
  return DVI_OK;
}

static dvi_status read_section(msh *m, int s)
{
  char end[32];
  DVI_TRY(check_order(m, s));
  m->seen |= 1U << s;
  if (sections[s].is_binary) DVI_TRY(dvi__end_line(m->r, "the name of a section"));
  DVI_TRY(sections[s].read(m));
  (void)snprintf(end, sizeof end, "$End%s", sections[s].name);
  return dvi__expect_word(m->r, end);
}

/* Pass over a section that tells nothing of the mesh. */
static dvi_status skip_section(msh *m, const dvi__word *name)
{
  dvi__reader *r = m->r;
  char end[sizeof name->text + 4];
  const size_t place = r->mark;
  (void)snprintf(end, sizeof end, "$End%s", name->text + 1);
  const size_t length = strlen(end);
  for (; r->at + length <= r->size; r->at++)
    if (r->byte[r->at] == '$' && memcmp(r->byte + r->at, end, length) == 0) {
      r->at += length;
      return DVI_OK;
    }
  return dvi__reject(r, place, "the section \"%s\" has no end \"%s\"", name->text, end);
}

static dvi_status read_next(msh *m)
{
  dvi__word name;
  int s = 0;
  DVI_TRY(dvi__read_word(m->r, "a section", &name));
  if (name.text[0] != '$' || name.length < 2 || name.length >= sizeof name.text)
    return dvi__reject(m->r, m->r->mark, "found \"%s\" where a section like $Nodes is expected",
                       name.text);
  while (s < SECTIONS &&
         (strcmp(sections[s].name, name.text + 1) != 0 || (sections[s].is_newer && !m->is_newer)))
    s++;
  return s < SECTIONS ? read_section(m, s) : skip_section(m, &name);
}

static dvi_status read_sections(msh *m)
{
  static const int needed[] = {NODES, ELEMENTS};
  DVI_TRY(read_format(m));
  while (dvi__skip_blanks(m->r)) DVI_TRY(read_next(m));
  for (int i = 0; i < 2; i++)
    if (!(m->seen >> needed[i] & 1))
      return dvi__reject(m->r, m->r->size, "the file has no section $%s", sections[needed[i]].name);
  return DVI_OK;
}

dvi_status dvi__read_msh(dvi__reader *r, dvi__raw *raw)
{
  msh m = {.r = r, .raw = raw};
  const dvi_status status = read_sections(&m);
  dvi__release(m.entities.entity.at);
  dvi__release(m.entities.physical.at);
  return status;
}
