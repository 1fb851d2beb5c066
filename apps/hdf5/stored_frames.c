#include "hdf5/stored_frames.h"

#include <stdlib.h>
#include <string.h>

#include "hdf5/h5.h"
#include "hdf5/head.h"

/* Rows of a chunk: of arrays with a row for each step, and at most of large arrays, which have
 * those of a step. Fields are written some chunks at a time. */
enum { STEPS_AT_ONCE = 256, CHUNK_MOST = 8192, ROWS_AT_ONCE = 8 * CHUNK_MOST };

static const char steps_name[] = "NSteps";

/* The arrays that do not depend on the fields. Offsets tell where a step begins in the large
 * arrays, which hold all steps one after the other: a grid that rests is there once. */
typedef enum array_name {
  POINTS,
  CONNECTIVITY,
  OFFSETS,
  TYPES,
  NUMBER_OF_POINTS,
  NUMBER_OF_CELLS,
  NUMBER_OF_CONNECTIVITY_IDS,
  VALUES,
  PART_OFFSETS,
  NUMBER_OF_PARTS,
  POINT_OFFSETS,
  CELL_OFFSETS,
  CONNECTIVITY_ID_OFFSETS,
  ARRAYS
} array_name;

struct hdf5_frames {
  hid_t file, root, steps;
  h5_array array[ARRAYS];
  int fields;
  h5_array *field, *field_offset;     /* [fields] */
  int64_t count, points, last_points; /* steps, points of a grid, first point of the last step */
  bool failed;                        /* a write; what was flushed before is in the file */
};

static void close_all(hdf5_frames *frames)
{
  for (int i = 0; i < ARRAYS; i++) h5_array_close(&frames->array[i]);
  for (int i = 0; i < frames->fields; i++) {
    h5_array_close(&frames->field[i]);
    h5_array_close(&frames->field_offset[i]);
  }
  if (frames->steps > 0) (void)H5Gclose(frames->steps);
  if (frames->root > 0) (void)H5Gclose(frames->root);
  frames->steps = frames->root = 0;
}

/* Release everything, whatever is open. Returns NULL. A file that could not be written is left as
 * it was flushed last: closing it would describe what is not there. */
static hdf5_frames *discard(hdf5_frames *frames)
{
  if (frames == NULL) return NULL;
  if (!frames->failed) close_all(frames);
  if (!frames->failed && frames->file > 0) (void)H5Fclose(frames->file);
  free(frames->field);
  free(frames->field_offset);
  free(frames);
  return NULL;
}

/* ---- creation ---- */

/* Create a group, which knows the order of its fields. */
static hid_t make_group(hid_t place, const char *name)
{
  const hid_t list = h5_creation_list(H5P_GROUP_CREATE);
  (void)H5Pset_link_creation_order(list, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  const hid_t group = H5Gcreate2(place, name, H5P_DEFAULT, list, H5P_DEFAULT);
  if (group < 0) (void)h5_refuse_by_library();
  (void)H5Pclose(list);
  return group;
}

/* VTK's readers want a text of fixed length here. */
static bool put_type(hid_t root)
{
  static const char name[] = "UnstructuredGrid";
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  (void)H5Tset_size(type, sizeof name - 1);
  (void)H5Tset_strpad(type, H5T_STR_NULLPAD);
  const hid_t attribute = H5Acreate2(root, "Type", type, space, H5P_DEFAULT, H5P_DEFAULT);
  const bool good = attribute >= 0 && H5Awrite(attribute, type, name) >= 0;
  if (!good) (void)h5_refuse_by_library();
  (void)H5Aclose(attribute);
  (void)H5Sclose(space);
  (void)H5Tclose(type);
  return good;
}

static int64_t chunk_of(int64_t rows)
{
  return rows < 1 ? 1 : rows < CHUNK_MOST ? rows : CHUNK_MOST;
}

static bool make_arrays(hdf5_frames *frames, const hdf5_grid *grid)
{
  const int64_t ids = grid->cells * grid->corners;
  const struct {
    const char *name;
    bool is_of_step;
    hid_t type;
    int width;
    int64_t rows; /* of a step */
  } list[ARRAYS] = {
      [POINTS] = {"Points", false, H5T_NATIVE_DOUBLE, 3, grid->points},
      [CONNECTIVITY] = {"Connectivity", false, H5T_NATIVE_INT64, 0, ids},
      [OFFSETS] = {"Offsets", false, H5T_NATIVE_INT64, 0, grid->cells + 1},
      [TYPES] = {"Types", false, H5T_NATIVE_UINT8, 0, grid->cells},
      [NUMBER_OF_POINTS] = {"NumberOfPoints", false, H5T_NATIVE_INT64, 0, 1},
      [NUMBER_OF_CELLS] = {"NumberOfCells", false, H5T_NATIVE_INT64, 0, 1},
      [NUMBER_OF_CONNECTIVITY_IDS] = {"NumberOfConnectivityIds", false, H5T_NATIVE_INT64, 0, 1},
      [VALUES] = {"Values", true, H5T_NATIVE_DOUBLE, 0, STEPS_AT_ONCE},
      [PART_OFFSETS] = {"PartOffsets", true, H5T_NATIVE_INT64, 0, STEPS_AT_ONCE},
      [NUMBER_OF_PARTS] = {"NumberOfParts", true, H5T_NATIVE_INT64, 0, STEPS_AT_ONCE},
      [POINT_OFFSETS] = {"PointOffsets", true, H5T_NATIVE_INT64, 0, STEPS_AT_ONCE},
      [CELL_OFFSETS] = {"CellOffsets", true, H5T_NATIVE_INT64, 1, STEPS_AT_ONCE},
      [CONNECTIVITY_ID_OFFSETS] = {"ConnectivityIdOffsets", true, H5T_NATIVE_INT64, 1,
                                   STEPS_AT_ONCE},
  };
  bool good = true;
  for (int i = 0; i < ARRAYS && good; i++)
    good = h5_array_create(list[i].is_of_step ? frames->steps : frames->root, list[i].name,
                           list[i].type, list[i].width, chunk_of(list[i].rows), &frames->array[i]);
  return good;
}

/* Create the fields of the points, or of the cells, and the offsets of their steps. */
static bool make_fields(hdf5_frames *frames, bool is_by_cell, const hdf5_grid *grid,
                        const hdf5_field *field)
{
  const int64_t rows = chunk_of(is_by_cell ? grid->cells : grid->points);
  const hid_t data = make_group(frames->root, is_by_cell ? "CellData" : "PointData"),
              offsets = make_group(frames->steps,
                                   is_by_cell ? "CellDataOffsets" : "PointDataOffsets");
  bool good = data >= 0 && offsets >= 0;
  for (int i = 0; i < frames->fields && good; i++) {
    if (field[i].is_by_cell != is_by_cell) continue;
    const int width = field[i].components > 1 ? field[i].components : 0;
    good = h5_array_create(data, field[i].name, H5T_NATIVE_DOUBLE, width, rows,
                           &frames->field[i]) &&
           h5_array_create(offsets, field[i].name, H5T_NATIVE_INT64, 0, STEPS_AT_ONCE,
                           &frames->field_offset[i]);
  }
  (void)H5Gclose(data);
  (void)H5Gclose(offsets);
  return good;
}

static bool make(hdf5_frames *frames, const char *path, const hdf5_head *head,
                 const hdf5_grid *grid, const hdf5_field *field)
{
  static const int64_t version[] = {2, 0}, none = 0;
  frames->file = h5_create(path);
  if (frames->file < 0 || !head_write(frames->file, head)) return false;
  frames->root = make_group(frames->file, "VTKHDF");
  if (frames->root < 0 || !h5_put_wholes(frames->root, "Version", 2, version) ||
      !put_type(frames->root))
    return false;
  frames->steps = make_group(frames->root, "Steps");
  return frames->steps >= 0 && h5_put_wholes(frames->steps, steps_name, 1, &none) &&
         make_arrays(frames, grid) && make_fields(frames, false, grid, field) &&
         make_fields(frames, true, grid, field) && h5_start(frames->file);
}

hdf5_frames *stored_frames_create(const char *path, const hdf5_head *head, const hdf5_grid *grid,
                                  int fields, const hdf5_field *field)
{
  hdf5_frames *frames = calloc(1, sizeof *frames);
  if (frames != NULL) {
    frames->field = calloc((size_t)fields + 1, sizeof *frames->field);
    frames->field_offset = calloc((size_t)fields + 1, sizeof *frames->field_offset);
    if (frames->field != NULL && frames->field_offset != NULL) {
      frames->fields = fields;
      return make(frames, path, head, grid, field) ? frames : discard(frames);
    }
  }
  (void)h5_refuse("out of memory");
  return discard(frames);
}

/* ---- steps ---- */

static bool add_whole(hdf5_frames *frames, array_name name, int64_t number)
{
  return h5_array_append(&frames->array[name], 1, &number);
}

/* Write the cells, once. */
static bool add_cells(hdf5_frames *frames, const hdf5_grid *grid)
{
  const int64_t ids = grid->cells * grid->corners;
  int64_t *end = calloc((size_t)grid->cells + 1, sizeof *end);
  uint8_t *type = calloc((size_t)grid->cells + 1, 1);
  bool good = end != NULL && type != NULL;
  for (int64_t i = 0; i <= grid->cells && good; i++) end[i] = i * grid->corners;
  if (good)
    memset(type, grid->type, (size_t)grid->cells);
  else
    (void)h5_refuse("out of memory");
  good = good && h5_array_append(&frames->array[CONNECTIVITY], ids, grid->vertex) &&
         h5_array_append(&frames->array[OFFSETS], grid->cells + 1, end) &&
         h5_array_append(&frames->array[TYPES], grid->cells, type) &&
         add_whole(frames, NUMBER_OF_POINTS, grid->points) &&
         add_whole(frames, NUMBER_OF_CELLS, grid->cells) &&
         add_whole(frames, NUMBER_OF_CONNECTIVITY_IDS, ids);
  free(end);
  free(type);
  return good;
}

static bool add_grid(hdf5_frames *frames, const hdf5_grid *grid)
{
  frames->last_points = (int64_t)frames->array[POINTS].size[0];
  frames->points = grid->points;
  return (frames->count > 0 || add_cells(frames, grid)) &&
         h5_array_append(&frames->array[POINTS], grid->points, grid->point);
}

/* Append some rows of a field, which `room` is for if they are not in memory. */
static bool add_rows(h5_array *array, const hdf5_field *field, int64_t first, int64_t rows,
                     double *room)
{
  const double *value = field->value != NULL ? field->value + first * field->components : room;
  if (field->value == NULL && !field->read(field, first, rows, room))
    return h5_refuse("the values of '%s' cannot be read", field->name);
  return h5_array_append(array, rows, value);
}

static bool add_field(h5_array *array, const hdf5_field *field, int64_t rows)
{
  const int64_t most = rows < ROWS_AT_ONCE ? rows : ROWS_AT_ONCE;
  double *room = field->value == NULL ? calloc((size_t)(most * field->components), sizeof *room)
                                      : NULL;
  bool good = field->value != NULL || room != NULL || h5_refuse("out of memory");
  for (int64_t first = 0; first < rows && good; first += most)
    good = add_rows(array, field, first, rows - first < most ? rows - first : most, room);
  free(room);
  return good;
}

static bool add_fields(hdf5_frames *frames, const hdf5_field *field)
{
  const int64_t cells = (int64_t)frames->array[TYPES].size[0];
  bool good = true;
  for (int i = 0; i < frames->fields && good; i++) {
    const int64_t begin = (int64_t)frames->field[i].size[0];
    good = h5_array_append(&frames->field_offset[i], 1, &begin) &&
           add_field(&frames->field[i], &field[i], field[i].is_by_cell ? cells : frames->points);
  }
  return good;
}

static bool count_step(hdf5_frames *frames)
{
  frames->count++;
  const hid_t attribute = H5Aopen(frames->steps, steps_name, H5P_DEFAULT);
  const bool good = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_INT64, &frames->count) >= 0;
  (void)H5Aclose(attribute);
  return (good || h5_refuse_by_library()) && h5_flush(frames->file);
}

bool stored_frames_add(hdf5_frames *frames, double t, const hdf5_grid *grid,
                       const hdf5_field *field)
{
  const bool good = (grid == NULL || add_grid(frames, grid)) && add_fields(frames, field) &&
                    h5_array_append(&frames->array[VALUES], 1, &t) &&
                    add_whole(frames, PART_OFFSETS, 0) && add_whole(frames, NUMBER_OF_PARTS, 1) &&
                    add_whole(frames, POINT_OFFSETS, frames->last_points) &&
                    add_whole(frames, CELL_OFFSETS, 0) &&
                    add_whole(frames, CONNECTIVITY_ID_OFFSETS, 0) && count_step(frames);
  frames->failed = !good;
  return good;
}

bool stored_frames_close(hdf5_frames **frames)
{
  hdf5_frames *closing = *frames;
  *frames = NULL;
  bool good = !closing->failed;
  if (good) {
    close_all(closing);
    good = H5Fclose(closing->file) >= 0 || h5_refuse_by_library();
    closing->file = 0;
  }
  (void)discard(closing);
  return good;
}
