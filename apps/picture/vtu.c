/* A .vtu file is a text that describes arrays, and then the arrays as bytes, each with their number
 * before it. This reader knows the files that dvi_mesh_write writes, and refuses all others. */
#include "picture/vtu.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"

/* The description of an array takes about 100 bytes. */
enum { PREFIX = 8, WORD = 24, HEAD_MOST = 1 << 20 };

/* A file, whose arrays are read when they are wanted. */
struct vtu_file {
  const char *path;
  FILE *stream;
  size_t size;
  char *text;       /* its begin, with the description */
  const char *head; /* end of the description */
  size_t bytes;     /* begin of the arrays */
};

/* An array's description, and the place of its bytes. */
typedef struct vtu_array {
  char name[VTU_NAME], type[WORD];
  long components;
  size_t at, size;
} vtu_array;

static bool refuse(const vtu_file *file, const char *reason)
{
  complain("%s: %s; dvi plot draws the .vtu files that dvi has written", file->path, reason);
  return false;
}

/* ---- the file ---- */

static bool load(const char *path, vtu_file *file)
{
  long size = -1;
  *file = (vtu_file){.path = path, .stream = fopen(path, "rb")};
  if (file->stream != NULL && fseek(file->stream, 0, SEEK_END) == 0) size = ftell(file->stream);
  if (size >= 0 && fseek(file->stream, 0, SEEK_SET) == 0) {
    const size_t begin = size < HEAD_MOST ? (size_t)size : HEAD_MOST;
    file->size = (size_t)size;
    file->text = calloc(begin + 1, 1);
    if (file->text != NULL && fread(file->text, 1, begin, file->stream) == begin) return true;
  }
  complain("%s: cannot be read: %s", path, strerror(errno != 0 ? errno : EIO));
  return false;
}

static bool read_bytes(const vtu_file *file, size_t at, size_t count, void *bytes)
{
  return (fseek(file->stream, (long)at, SEEK_SET) == 0 &&
          fread(bytes, 1, count, file->stream) == count) ||
         refuse(file, "it is cut short");
}

/* Find where the description ends and the arrays begin. */
static bool split(vtu_file *file)
{
  static const char mark[] = "<AppendedData encoding=\"raw\">";
  if (strstr(file->text, "type=\"UnstructuredGrid\"") == NULL ||
      strstr(file->text, "header_type=\"UInt64\"") == NULL ||
      strstr(file->text, "byte_order=\"LittleEndian\"") == NULL)
    return refuse(file, "it is no unstructured grid with little-endian numbers");
  file->head = strstr(file->text, mark);
  const char *begin = file->head != NULL ? strchr(file->head, '_') : NULL;
  if (begin == NULL) return refuse(file, "it has no raw arrays at its end");
  file->bytes = (size_t)(begin + 1 - file->text);
  return true;
}

/* ---- the description ---- */

/* Copy an attribute of the tag that begins at `tag`. */
static bool attribute(const char *tag, const char *name, char *word, size_t size)
{
  char start[WORD];
  (void)snprintf(start, sizeof start, " %s=\"", name);
  const char *end = strchr(tag, '>'), *at = strstr(tag, start);
  if (end == NULL || at == NULL || at > end) return false;
  at += strlen(start);
  const size_t length = strcspn(at, "\"");
  if (length >= size || at + length > end) return false;
  memcpy(word, at, length);
  word[length] = '\0';
  return true;
}

static bool attribute_number(const char *tag, const char *name, long *number)
{
  char word[WORD], *end = word;
  if (!attribute(tag, name, word, sizeof word)) return false;
  errno = 0;
  *number = strtol(word, &end, 10);
  return errno == 0 && end != word && *end == '\0' && *number >= 0;
}

static size_t size_of_prefix(const unsigned char *prefix)
{
  size_t size = 0;
  for (int i = PREFIX - 1; i >= 0; i--) size = size << 8 | prefix[i];
  return size;
}

/* Find the array that the tag describes. */
static bool take_array(const vtu_file *file, const char *tag, vtu_array *array)
{
  long offset;
  unsigned char prefix[PREFIX];
  if (!attribute(tag, "Name", array->name, sizeof array->name) ||
      !attribute(tag, "type", array->type, sizeof array->type) ||
      !attribute_number(tag, "NumberOfComponents", &array->components) ||
      !attribute_number(tag, "offset", &offset) || array->components < 1)
    return refuse(file, "an array is not described");
  const size_t room = file->size - file->bytes;
  if ((size_t)offset > room || room - (size_t)offset < PREFIX)
    return refuse(file, "it is cut short");
  array->at = file->bytes + (size_t)offset + PREFIX;
  if (!read_bytes(file, array->at - PREFIX, PREFIX, prefix)) return false;
  array->size = size_of_prefix(prefix);
  return array->size <= room - (size_t)offset - PREFIX || refuse(file, "it is cut short");
}

/* Read an array of numbers of 8 bytes, as this machine has them. */
static bool read_numbers(const vtu_file *file, const vtu_array *array, const char *type,
                         int64_t count, void *numbers)
{
  const uint16_t probe = 1;
  if (strcmp(array->type, type) != 0 || array->size != 8 * (size_t)count)
    return refuse(file, "an array has another size or type");
  if (*(const unsigned char *)&probe != 1) return refuse(file, "this machine is big-endian");
  return read_bytes(file, array->at, array->size, numbers);
}

/* ---- arrays ---- */

/* The array of a tag within a section, or of a name. */
static const char *next_array(const vtu_file *file, const char *from, const char *end)
{
  const char *tag = strstr(from, "<DataArray");
  return tag != NULL && tag < end && tag < file->head ? tag : NULL;
}

/* Find a section, such as PointData. Returns false if the file has none. */
static bool find_section(const vtu_file *file, const char *name, const char **begin,
                         const char **end)
{
  char word[WORD];
  (void)snprintf(word, sizeof word, "<%s>", name);
  *begin = strstr(file->text, word);
  (void)snprintf(word, sizeof word, "</%s>", name);
  *end = *begin != NULL ? strstr(*begin, word) : NULL;
  return *end != NULL && *end < file->head;
}

static bool find_array(const vtu_file *file, const char *section, const char *name,
                       vtu_array *array)
{
  const char *at, *end;
  if (!find_section(file, section, &at, &end)) return refuse(file, "a section is missing");
  while ((at = next_array(file, at, end)) != NULL) {
    if (!take_array(file, at, array)) return false;
    if (strcmp(array->name, name) == 0) return true;
    at++;
  }
  return refuse(file, "an array is missing");
}

/* Name a field after its array, and a component by its axis. */
static void name_field(const char *name, int component, vtu_field *field)
{
  const size_t length = strlen(name);
  (void)snprintf(field->name, sizeof field->name, "%s", name);
  if (component < 0 || length + 3 > sizeof field->name) return;
  field->name[length] = '_';
  field->name[length + 1] = "xyz"[component];
  field->name[length + 2] = '\0';
}

/* Add one component of vectors, or with -1 their lengths. */
static bool add_field(vtu_grid *g, bool is_by_cell, int components, int component,
                      const double *number)
{
  const int64_t count = is_by_cell ? g->cells : g->points;
  vtu_field *field = &g->field[g->fields - 1];
  field->is_by_cell = is_by_cell;
  field->value = calloc((size_t)count + 1, sizeof *field->value);
  if (field->value == NULL) {
    complain("out of memory");
    return false;
  }
  for (int64_t i = 0; i < count; i++) {
    const double *vector = number + i * components;
    double square = 0;
    for (int c = 0; c < components; c++) square += vector[c] * vector[c];
    field->value[i] = component >= 0    ? vector[component]
                      : components == 1 ? vector[0]
                                        : sqrt(square);
  }
  return true;
}

bool vtu_add_fields(vtu_grid *g, const char *name, bool is_by_cell, int components,
                    const double *number)
{
  const int axes = components == 1 || components > 3 ? 0 : components;
  for (int component = -1; component < axes && g->fields < VTU_FIELDS; component++) {
    name_field(name, component, &g->field[g->fields++]);
    if (!add_field(g, is_by_cell, components, component, number)) return false;
  }
  return true;
}

static bool take_field(const vtu_file *file, const vtu_array *array, bool is_by_cell, vtu_grid *g)
{
  const int64_t numbers = (is_by_cell ? g->cells : g->points) * array->components;
  if (array->size != 8 * (size_t)numbers) return refuse(file, "an array has another size or type");
  double *all = calloc((size_t)numbers + 1, sizeof *all);
  if (all == NULL) complain("out of memory");
  const bool good = all != NULL && read_numbers(file, array, "Float64", numbers, all) &&
                    vtu_add_fields(g, array->name, is_by_cell, (int)array->components, all);
  free(all);
  return good;
}

/* Take the arrays of a section as fields. */
static bool take_fields(const vtu_file *file, const char *section, bool is_by_cell, vtu_grid *g)
{
  const char *at, *end;
  vtu_array array;
  if (!find_section(file, section, &at, &end)) return true;
  while ((at = next_array(file, at, end)) != NULL && g->fields < VTU_FIELDS) {
    if (!take_array(file, at, &array) || !take_field(file, &array, is_by_cell, g)) return false;
    at++;
  }
  return true;
}

/* ---- points and cells ---- */

static bool take_counts(const vtu_file *file, vtu_grid *g)
{
  const char *piece = strstr(file->text, "<Piece");
  long points, cells;
  if (piece == NULL || !attribute_number(piece, "NumberOfPoints", &points) ||
      !attribute_number(piece, "NumberOfCells", &cells))
    return refuse(file, "it has no piece with its counts");
  /* Each point and each cell has eight bytes at least. */
  if ((size_t)points > file->size / 8 || (size_t)cells > file->size / 8 || points < 1 || cells < 1)
    return refuse(file, "its counts do not fit its size");
  g->points = points;
  g->cells = cells;
  return true;
}

int vtu_corners(int kind)
{
  static const int corners[] = {
      [VTU_LINE] = 2, [VTU_TRIANGLE] = 3, [VTU_PIXEL] = 4, [VTU_TETRAHEDRON] = 4, [VTU_VOXEL] = 8};
  return kind >= 0 && kind <= VTU_VOXEL ? corners[kind] : 0;
}

const char *vtu_flaw(const vtu_grid *g)
{
  for (int64_t i = 0; i < 3 * g->points; i++)
    if (!isfinite(g->point[i])) return "a coordinate is not finite";
  for (int64_t i = 0; i < g->cells * g->corners; i++)
    if (g->vertex[i] < 0 || g->vertex[i] >= g->points)
      return "a cell has a point that does not exist";
  return NULL;
}

/* All cells are of one kind. */
static bool take_kinds(const vtu_file *file, const unsigned char *kind, vtu_grid *g)
{
  for (int64_t c = 0; c < g->cells; c++)
    if (kind[c] != kind[0]) return refuse(file, "its cells are of several kinds");
  if (vtu_corners(kind[0]) == 0)
    return refuse(file, "its cells are no lines, triangles, pixels, tetrahedra or voxels");
  g->kind = (vtu_cell)kind[0];
  g->corners = vtu_corners(kind[0]);
  return true;
}

static bool take_kind(const vtu_file *file, vtu_grid *g)
{
  vtu_array types;
  if (!find_array(file, "Cells", "types", &types)) return false;
  if (types.size != (size_t)g->cells || strcmp(types.type, "UInt8") != 0)
    return refuse(file, "it has not one type for each cell");
  unsigned char *kind = calloc((size_t)g->cells, 1);
  if (kind == NULL) complain("out of memory");
  const bool good = kind != NULL && read_bytes(file, types.at, types.size, kind) &&
                    take_kinds(file, kind, g);
  free(kind);
  return good;
}

static bool take_cells(const vtu_file *file, vtu_grid *g)
{
  vtu_array points, connectivity;
  const int64_t corners = g->cells * g->corners;
  if (!find_array(file, "Points", "Points", &points) ||
      !find_array(file, "Cells", "connectivity", &connectivity))
    return false;
  g->point = calloc((size_t)g->points * 3, sizeof *g->point);
  g->vertex = calloc((size_t)corners, sizeof *g->vertex);
  if (g->point == NULL || g->vertex == NULL) {
    complain("out of memory");
    return false;
  }
  if (!read_numbers(file, &points, "Float64", 3 * g->points, g->point) ||
      !read_numbers(file, &connectivity, "Int64", corners, g->vertex))
    return false;
  const char *flaw = vtu_flaw(g);
  return flaw == NULL || refuse(file, flaw);
}

static void close_file(vtu_file *file)
{
  if (file->stream != NULL) (void)fclose(file->stream);
  free(file->text);
}

static bool take_grid(const vtu_file *file, vtu_grid *g)
{
  memset(g, 0, sizeof *g);
  return take_counts(file, g) && take_kind(file, g) && take_cells(file, g);
}

int vtu_read(const char *path, vtu_grid *g)
{
  vtu_file file;
  memset(g, 0, sizeof *g);
  const bool good = load(path, &file) && split(&file) && take_grid(&file, g) &&
                    take_fields(&file, "PointData", false, g) &&
                    take_fields(&file, "CellData", true, g);
  close_file(&file);
  if (!good) vtu_clear(g);
  return good ? DONE : FAILED;
}

/* ---- files in parts ---- */

vtu_file *vtu_open(const char *path)
{
  vtu_file *file = calloc(1, sizeof *file);
  if (file == NULL) complain("out of memory");
  if (file != NULL && load(path, file) && split(file)) return file;
  if (file != NULL) close_file(file);
  free(file);
  return NULL;
}

bool vtu_read_grid(const vtu_file *file, vtu_grid *g)
{
  if (take_grid(file, g)) return true;
  vtu_clear(g);
  return false;
}

bool vtu_read_rows(const vtu_file *file, bool is_by_cell, const char *name, int64_t first,
                   int64_t rows, double *number)
{
  vtu_array array;
  if (!find_array(file, is_by_cell ? "CellData" : "PointData", name, &array)) return false;
  const size_t row = 8 * (size_t)array.components, begin = (size_t)first * row,
               bytes = (size_t)rows * row;
  if (begin > array.size || bytes > array.size - begin)
    return refuse(file, "an array has another size or type");
  return read_bytes(file, array.at + begin, bytes, number);
}

void vtu_close(vtu_file **file)
{
  if (*file != NULL) close_file(*file);
  free(*file);
  *file = NULL;
}

const vtu_field *vtu_find(const vtu_grid *g, const char *name)
{
  for (int i = 0; i < g->fields; i++)
    if (strcmp(g->field[i].name, name) == 0) return &g->field[i];
  return NULL;
}

void vtu_clear(vtu_grid *g)
{
  for (int i = 0; i < g->fields; i++) free(g->field[i].value);
  free(g->point);
  free(g->vertex);
  memset(g, 0, sizeof *g);
}
