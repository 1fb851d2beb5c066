/* PLY (Turk 1994): a head that tells which elements follow and of what each of them consists, then
 * their numbers, as text or little-endian. Points are the elements `vertex`, cells the lists
 * `vertex_indices` of the elements `face`. All other properties are passed over. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "field/mesh/file/formats.h"

enum { MOST_ELEMENTS = 16, MOST_PROPERTIES = 64 };

/* The types of numbers, each of which has two names. */
typedef struct type {
  const char *name, *other;
  int width, is_signed, is_real;
} type;
static const type types[] = {
    {"char", "int8", 1, 1, 0},     {"uchar", "uint8", 1, 0, 0},    {"short", "int16", 2, 1, 0},
    {"ushort", "uint16", 2, 0, 0}, {"int", "int32", 4, 1, 0},      {"uint", "uint32", 4, 0, 0},
    {"float", "float32", 4, 1, 1}, {"double", "float64", 8, 1, 1},
};
enum { TYPES = sizeof types / sizeof *types };

/* What a property is to the mesh. */
typedef enum role { OTHER, X, Y, Z, CORNERS } role;

/* A property of an element. */
typedef struct property {
  char name[64];
  const type *type, *count; /* the count's type for lists, else NULL */
  role role;
} property;

/* A kind of elements. */
typedef struct element {
  char name[64];
  int64_t count;
  int properties;
  property property[MOST_PROPERTIES];
} element;

/* The head of a file. */
typedef struct head {
  int is_binary, elements;
  element element[MOST_ELEMENTS];
} head;

/* ---- the head ---- */

static dvi_status read_format(dvi__reader *r, head *h)
{
  dvi__word word;
  DVI_TRY(dvi__expect_word(r, "ply"));
  DVI_TRY(dvi__end_line(r, "\"ply\""));
  while (h->is_binary < 0) {
    DVI_TRY(dvi__read_word(r, "\"format\"", &word));
    if (strcmp(word.text, "comment") == 0 || strcmp(word.text, "obj_info") == 0) {
      dvi__skip_line(r);
      continue;
    }
    if (strcmp(word.text, "format") != 0)
      return dvi__reject(r, r->mark, "found \"%s\" where \"format\" is expected", word.text);
    DVI_TRY(dvi__read_word(r, "\"ascii\" or \"binary_little_endian\"", &word));
    if (strcmp(word.text, "ascii") == 0) h->is_binary = 0;
    if (strcmp(word.text, "binary_little_endian") == 0) h->is_binary = 1;
    if (h->is_binary < 0)
      return dvi__reject(r, r->mark,
                         "the format is \"%s\", and only ascii and binary_little_endian can be "
                         "read: save the file as one of these",
                         word.text);
  }
  DVI_TRY(dvi__expect_word(r, "1.0"));
  return dvi__end_line(r, "the format");
}

static dvi_status read_type(dvi__reader *r, const type **found)
{
  dvi__word word;
  DVI_TRY(dvi__read_word(r, "the type of a property", &word));
  for (int i = 0; i < TYPES; i++)
    if (strcmp(types[i].name, word.text) == 0 || strcmp(types[i].other, word.text) == 0) {
      *found = types + i;
      return DVI_OK;
    }
  return dvi__reject(r, r->mark, "found \"%s\" where the type of a property is expected",
                     word.text);
}

static role role_of(const element *e, const property *p)
{
  static const char *const axis[] = {"x", "y", "z"};
  for (int i = 0; i < 3; i++)
    if (strcmp(e->name, "vertex") == 0 && p->count == NULL && strcmp(p->name, axis[i]) == 0)
      return (role)(X + i);
  const int is_list = strcmp(p->name, "vertex_indices") == 0 ||
                      strcmp(p->name, "vertex_index") == 0;
  return strcmp(e->name, "face") == 0 && p->count != NULL && is_list ? CORNERS : OTHER;
}

static dvi_status read_property(dvi__reader *r, head *h)
{
  dvi__word word;
  if (h->elements == 0) return dvi__reject(r, r->mark, "a property comes before all elements");
  element *e = h->element + h->elements - 1;
  if (e->properties == MOST_PROPERTIES)
    return dvi__reject(r, r->mark, "the element \"%s\" has more than %d properties", e->name,
                       (int)MOST_PROPERTIES);
  property *p = e->property + e->properties;
  const size_t before = r->at;
  DVI_TRY(dvi__read_word(r, "the type of a property", &word));
  if (strcmp(word.text, "list") == 0)
    DVI_TRY(read_type(r, &p->count));
  else
    r->at = before;
  DVI_TRY(read_type(r, &p->type));
  if (p->count != NULL && p->count->is_real)
    return dvi__reject(r, r->mark, "the length of a list is no integer");
  DVI_TRY(dvi__read_word(r, "the name of a property", &word));
  memcpy(p->name, word.text, sizeof p->name);
  p->role = role_of(e, p);
  for (int i = 0; i < e->properties; i++)
    if (strcmp(e->property[i].name, p->name) == 0)
      return dvi__reject(r, r->mark, "the element \"%s\" has a second property \"%s\"", e->name,
                         p->name);
  e->properties++;
  return DVI_OK;
}

static dvi_status read_element(dvi__reader *r, head *h)
{
  dvi__word word;
  if (h->elements == MOST_ELEMENTS)
    return dvi__reject(r, r->mark, "there are more than %d kinds of elements", (int)MOST_ELEMENTS);
  element *e = h->element + h->elements;
  DVI_TRY(dvi__read_word(r, "the name of an element", &word));
  memcpy(e->name, word.text, sizeof e->name);
  for (int i = 0; i < h->elements; i++)
    if (strcmp(h->element[i].name, e->name) == 0)
      return dvi__reject(r, r->mark, "there is a second element \"%s\"", e->name);
  DVI_TRY(dvi__read_text_integer(r, "the number of elements", 0, INT32_MAX, &e->count));
  h->elements++;
  return DVI_OK;
}

static dvi_status read_head(dvi__reader *r, head *h)
{
  DVI_TRY(read_format(r, h));
  for (;;) {
    dvi__word word;
    DVI_TRY(dvi__read_word(r, "\"end_header\"", &word));
    if (strcmp(word.text, "end_header") == 0) break;
    if (strcmp(word.text, "comment") == 0 || strcmp(word.text, "obj_info") == 0) {
      dvi__skip_line(r);
      continue;
    }
    if (strcmp(word.text, "element") == 0)
      DVI_TRY(read_element(r, h));
    else if (strcmp(word.text, "property") == 0)
      DVI_TRY(read_property(r, h));
    else
      return dvi__reject(
          r, r->mark, "found \"%s\" where element, property or end_header is expected", word.text);
    DVI_TRY(dvi__end_line(r, "what it needs"));
  }
  return dvi__end_line(r, "\"end_header\"");
}

static const element *find_element(const head *h, const char *name)
{
  for (int i = 0; i < h->elements; i++)
    if (strcmp(h->element[i].name, name) == 0) return h->element + i;
  return NULL;
}

static int has_role(const element *e, role wanted)
{
  int i = 0;
  while (i < e->properties && e->property[i].role != wanted) i++;
  return i < e->properties;
}

/* Faces are made of points that are known. */
static dvi_status check_head(const dvi__reader *r, const head *h)
{
  const element *vertex = find_element(h, "vertex"), *face = find_element(h, "face");
  if (vertex == NULL || !has_role(vertex, X) || !has_role(vertex, Y))
    return dvi__reject(r, r->mark, "the head has no element vertex with the properties x and y");
  if (face == NULL || !has_role(face, CORNERS))
    return dvi__reject(r, r->mark, "the head has no element face with a list vertex_indices");
  if (face < vertex) return dvi__reject(r, r->mark, "the element face comes before vertex");
  for (int i = 0; i < h->elements; i++) {
    int64_t width = 0;
    for (int p = 0; p < h->element[i].properties; p++) {
      const property *of = h->element[i].property + p;
      width += of->count != NULL ? of->count->width : of->type->width;
    }
    if (width == 0 && h->element[i].count > 0)
      return dvi__reject(r, r->mark, "the element \"%s\" has no properties", h->element[i].name);
    if (width > 0)
      DVI_TRY(dvi__claim(r, "elements", h->element[i].count, 2 * (int64_t)h->element[i].properties,
                         width));
  }
  return DVI_OK;
}

/* ---- numbers ---- */

static double real_of(const type *t, uint64_t bits)
{
  double value;
  float single;
  const uint32_t half = (uint32_t)bits;
  if (t->width == 8) {
    memcpy(&value, &bits, sizeof value);
    return value;
  }
  memcpy(&single, &half, sizeof single);
  return (double)single;
}

/* Read an integer of a type, of 32 bits at most. */
static dvi_status read_integer(dvi__reader *r, const char *what, const type *t, int64_t *value)
{
  const unsigned char *byte = NULL;
  if (!r->is_binary) return dvi__read_text_integer(r, what, INT32_MIN, UINT32_MAX, value);
  DVI_TRY(dvi__read_bytes(r, what, (size_t)t->width, &byte));
  const uint64_t bits = dvi__little_endian(byte, t->width), sign = UINT64_C(1)
                                                                   << (8 * t->width - 1);
  *value = (int64_t)bits - (t->is_signed && bits & sign ? 2 * (int64_t)sign : 0);
  return DVI_OK;
}

/* Read a finite number of a type. */
static dvi_status read_number(dvi__reader *r, const char *what, const type *t, double *value)
{
  const unsigned char *byte = NULL;
  int64_t integer = 0;
  if (!r->is_binary) return dvi__read_real(r, what, value);
  if (!t->is_real) {
    DVI_TRY(read_integer(r, what, t, &integer));
    *value = (double)integer;
    return DVI_OK;
  }
  DVI_TRY(dvi__read_bytes(r, what, (size_t)t->width, &byte));
  *value = real_of(t, dvi__little_endian(byte, t->width));
  if (isfinite(*value)) return DVI_OK;
  return dvi__reject(r, r->mark, "%s is %g, and must be finite", what, *value);
}

/* Pass over a number, which may be anything. */
static dvi_status skip_number(dvi__reader *r, const type *t)
{
  const unsigned char *byte;
  dvi__word word;
  return r->is_binary ? dvi__read_bytes(r, "a property", (size_t)t->width, &byte)
                      : dvi__read_word(r, "a property", &word);
}

/* ---- elements ---- */

static dvi_status read_corners(dvi__reader *r, dvi__raw *raw, const property *p, int64_t length,
                               int64_t face)
{
  const size_t place = r->mark;
  int64_t corner[DVI__SHAPE_CORNERS];
  if (length != 3 && length != 4)
    return dvi__reject(r, place,
                       "a face has %lld corners: only triangles and quadrangles can be read",
                       (long long)length);
  if (p->type->is_real) return dvi__reject(r, place, "the corners of a face are no integers");
  for (int64_t c = 0; c < length; c++)
    DVI_TRY(read_integer(r, "a corner of a face", p->type, corner + c));
  return dvi__raw_add_element(raw, length == 3 ? DVI__TRIANGLE : DVI__QUADRANGLE, face, place,
                              corner);
}

static dvi_status read_list(dvi__reader *r, dvi__raw *raw, const property *p, int64_t i)
{
  int64_t length = 0;
  DVI_TRY(read_integer(r, "the length of a list", p->count, &length));
  if (p->role == CORNERS) return read_corners(r, raw, p, length, i);
  if (length < 0) return dvi__reject(r, r->mark, "a list has the length %lld", (long long)length);
  for (int64_t k = 0; k < length; k++) DVI_TRY(skip_number(r, p->type));
  return DVI_OK;
}

static dvi_status read_one(dvi__reader *r, dvi__raw *raw, const element *e, int64_t i)
{
  double x[3] = {0};
  for (int k = 0; k < e->properties; k++) {
    const property *p = e->property + k;
    if (p->count != NULL)
      DVI_TRY(read_list(r, raw, p, i));
    else if (p->role >= X && p->role <= Z)
      DVI_TRY(read_number(r, "a coordinate", p->type, x + (p->role - X)));
    else
      DVI_TRY(skip_number(r, p->type));
  }
  return strcmp(e->name, "vertex") == 0 ? dvi__raw_add_point(raw, i, r->mark, x) : DVI_OK;
}

static dvi_status read_all(dvi__reader *r, dvi__raw *raw, head *h)
{
  h->is_binary = -1;
  DVI_TRY(read_head(r, h));
  r->is_binary = h->is_binary;
  DVI_TRY(check_head(r, h));
  for (int k = 0; k < h->elements; k++)
    for (int64_t i = 0; i < h->element[k].count; i++) DVI_TRY(read_one(r, raw, h->element + k, i));
  return DVI_OK;
}

dvi_status dvi__read_ply(dvi__reader *r, dvi__raw *raw)
{
  head *h = DVI_NEW(head, 1);
  if (h == NULL) return dvi__fail(DVI_NO_MEMORY, "%.300s: no memory for the head", r->path);
  const dvi_status status = read_all(r, raw, h);
  dvi__release(h);
  return status;
}
