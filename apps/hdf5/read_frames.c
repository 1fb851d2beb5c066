#include "hdf5/read_frames.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

#include "hdf5/h5.h"
#include "hdf5/head.h"

enum { NAME_SIZE = 64, FIELDS_MOST = 256 };
static const char *const layouts[] = {"dvi rows 1", NULL};
static const char root_name[] = "VTKHDF";

/* Where a field's values are. */
typedef struct field_place {
  char name[NAME_SIZE];
  hid_t set;
  int64_t *offset; /* [steps] */
} field_place;

struct hdf5_views {
  hid_t file, root, steps, points;
  int64_t count; /* of steps */
  double *time;  /* [count] */
  int64_t *point_offset, *vertex;
  hdf5_grid grid;
  int fields;
  hdf5_field field[FIELDS_MOST];
  field_place place[FIELDS_MOST];
};

static void close_object(hid_t object)
{
  if (object > 0) (void)H5Oclose(object);
}

void read_frames_close(hdf5_views **views)
{
  hdf5_views *closing = *views;
  *views = NULL;
  if (closing == NULL) return;
  for (int i = 0; i < closing->fields; i++) {
    close_object(closing->place[i].set);
    free(closing->place[i].offset);
  }
  close_object(closing->points);
  close_object(closing->steps);
  close_object(closing->root);
  if (closing->file > 0) (void)H5Fclose(closing->file);
  free(closing->time);
  free(closing->point_offset);
  free(closing->vertex);
  free(closing);
}

/* ---- arrays ---- */

/* Open a group or an array, which must be there. */
static hid_t open_object(hid_t place, const char *name)
{
  const hid_t object = H5Lexists(place, name, H5P_DEFAULT) > 0 ? H5Oopen(place, name, H5P_DEFAULT)
                                                               : H5I_INVALID_HID;
  if (object < 0) (void)h5_refuse("it has no '%s'", name);
  return object;
}

/* Tell the rows and the width of an array, which is 0 for one axis. */
static bool measure(hid_t set, int64_t *rows, int *width)
{
  hsize_t size[2] = {0, 0};
  const hid_t space = H5Iget_type(set) == H5I_DATASET ? H5Dget_space(set) : H5I_INVALID_HID;
  const int rank = space >= 0 ? H5Sget_simple_extent_ndims(space) : 0;
  const bool good = (rank == 1 || rank == 2) &&
                    H5Sget_simple_extent_dims(space, size, NULL) == rank && size[0] <= INT64_MAX &&
                    size[1] <= INT_MAX;
  if (space >= 0) (void)H5Sclose(space);
  *rows = (int64_t)size[0];
  *width = (int)size[1];
  return good || h5_refuse("an array has another form");
}

/* Tell whether an array has these rows. */
static bool has_rows(hid_t set, int64_t first, int64_t count, int width)
{
  int64_t rows;
  int found;
  if (!measure(set, &rows, &found)) return false;
  return (found == width && count >= 1 && first >= 0 && first <= rows && count <= rows - first) ||
         h5_refuse("an array has another size");
}

/* Read rows of an array. */
static bool read_rows(hid_t set, hid_t type, int64_t first, int64_t count, int width, void *to)
{
  const hsize_t from[] = {(hsize_t)first, 0}, size[] = {(hsize_t)count, (hsize_t)width};
  if (!has_rows(set, first, count, width)) return false;
  const hid_t in_file = H5Dget_space(set),
              in_memory = H5Screate_simple(width > 0 ? 2 : 1, size, NULL);
  const bool good = H5Sselect_hyperslab(in_file, H5S_SELECT_SET, from, NULL, size, NULL) >= 0 &&
                    H5Dread(set, type, in_memory, in_file, H5P_DEFAULT, to) >= 0;
  if (!good) (void)h5_refuse_by_library();
  (void)H5Sclose(in_file);
  (void)H5Sclose(in_memory);
  return good;
}

/* Read the first numbers of 8 bytes of an array, to be freed. NULL with a reason. */
static void *read_array(hid_t place, const char *name, hid_t type, int64_t count)
{
  void *numbers = NULL;
  const hid_t set = open_object(place, name);
  if (set >= 0 && has_rows(set, 0, count, 0)) {
    numbers = calloc((size_t)count, sizeof(int64_t));
    if (numbers == NULL) (void)h5_refuse("out of memory");
  }
  if (numbers != NULL && !read_rows(set, type, 0, count, 0, numbers)) {
    free(numbers);
    numbers = NULL;
  }
  close_object(set);
  return numbers;
}

static bool read_whole(hid_t place, const char *name, int64_t *number)
{
  int64_t *read = read_array(place, name, H5T_NATIVE_INT64, 1);
  if (read != NULL) *number = read[0];
  free(read);
  return read != NULL;
}

/* ---- what a file holds ---- */

static bool read_steps(hdf5_views *views)
{
  const hid_t attribute = H5Aexists(views->steps, "NSteps") > 0
                              ? H5Aopen(views->steps, "NSteps", H5P_DEFAULT)
                              : H5I_INVALID_HID;
  const bool good = attribute >= 0 && H5Aread(attribute, H5T_NATIVE_INT64, &views->count) >= 0;
  if (attribute >= 0) (void)H5Aclose(attribute);
  if (!good || views->count < 1 || views->count > INT_MAX)
    return h5_refuse("it has no fields of a time");
  views->time = read_array(views->steps, "Values", H5T_NATIVE_DOUBLE, views->count);
  views->point_offset = read_array(views->steps, "PointOffsets", H5T_NATIVE_INT64, views->count);
  views->points = open_object(views->root, "Points");
  return views->time != NULL && views->point_offset != NULL && views->points >= 0;
}

/* Read the cells, which are of one kind, and the same at all times. */
static bool read_cells(hdf5_views *views)
{
  hdf5_grid *grid = &views->grid;
  int64_t ids = 0, type = 0;
  if (!read_whole(views->root, "NumberOfPoints", &grid->points) ||
      !read_whole(views->root, "NumberOfCells", &grid->cells) ||
      !read_whole(views->root, "NumberOfConnectivityIds", &ids) ||
      !read_whole(views->root, "Types", &type))
    return false;
  if (grid->points < 1 || grid->cells < 1 || ids < 1 || ids % grid->cells != 0)
    return h5_refuse("its counts do not fit each other");
  grid->corners = (int)(ids / grid->cells);
  grid->type = (int)type;
  grid->vertex = views->vertex = read_array(views->root, "Connectivity", H5T_NATIVE_INT64, ids);
  return views->vertex != NULL;
}

/* Open a field. Its values of a step begin at an offset. */
static bool open_field(hdf5_views *views, bool is_by_cell, hid_t data, hid_t offsets,
                       const char *name)
{
  hdf5_field *field = &views->field[views->fields];
  field_place *place = &views->place[views->fields++];
  int64_t rows;
  int width;
  (void)snprintf(place->name, sizeof place->name, "%s", name);
  place->set = open_object(data, name);
  if (place->set < 0 || !measure(place->set, &rows, &width)) return false;
  *field = (hdf5_field){
      .name = place->name, .components = width > 0 ? width : 1, .is_by_cell = is_by_cell};
  place->offset = read_array(offsets, name, H5T_NATIVE_INT64, views->count);
  return place->offset != NULL;
}

/* Return the order in which the names of a group are told: as they were made, if that is known. */
static H5_index_t order_of(hid_t group)
{
  unsigned flags = 0;
  const hid_t list = H5Gget_create_plist(group);
  const bool known = list >= 0 && H5Pget_link_creation_order(list, &flags) >= 0 &&
                     (flags & H5P_CRT_ORDER_TRACKED) != 0;
  if (list >= 0) (void)H5Pclose(list);
  return known ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
}

static bool open_fields(hdf5_views *views, bool is_by_cell)
{
  const hid_t data = open_object(views->root, is_by_cell ? "CellData" : "PointData"),
              offsets = open_object(views->steps,
                                    is_by_cell ? "CellDataOffsets" : "PointDataOffsets");
  H5G_info_t info = {.nlinks = 0};
  bool good = data >= 0 && offsets >= 0 && H5Gget_info(data, &info) >= 0;
  const H5_index_t order = good ? order_of(data) : H5_INDEX_NAME;
  for (hsize_t k = 0; k < info.nlinks && good && views->fields < FIELDS_MOST; k++) {
    char name[NAME_SIZE];
    const ssize_t length = H5Lget_name_by_idx(data, ".", order, H5_ITER_INC, k, name, sizeof name,
                                              H5P_DEFAULT);
    good = length > 0 && length < NAME_SIZE ? open_field(views, is_by_cell, data, offsets, name)
                                            : h5_refuse("a field has a name too long");
  }
  close_object(data);
  close_object(offsets);
  return good;
}

/* Find the fields in a file that has them beside its facts. */
static bool open_root(hdf5_views *views)
{
  if (head_find_layout(views->file, layouts) < 0) return false;
  views->root = open_object(views->file, root_name);
  views->steps = views->root >= 0 ? open_object(views->root, "Steps") : H5I_INVALID_HID;
  return views->steps >= 0;
}

hdf5_views *read_frames_open(const char *path, hdf5_views_content *content)
{
  hdf5_views *views = calloc(1, sizeof *views);
  *content = (hdf5_views_content){.steps = 0};
  if (views == NULL) {
    (void)h5_refuse("out of memory");
    return NULL;
  }
  views->file = h5_open_to_read(path);
  if (views->file < 0 || !open_root(views) || !read_steps(views) || !read_cells(views) ||
      !open_fields(views, false) || !open_fields(views, true)) {
    read_frames_close(&views);
    return NULL;
  }
  *content = (hdf5_views_content){.steps = views->count,
                                  .time = views->time,
                                  .grid = views->grid,
                                  .fields = views->fields,
                                  .field = views->field};
  return views;
}

bool read_frames_read(hdf5_views *views, int64_t step, double *point, double *const *value)
{
  const hdf5_grid *grid = &views->grid;
  bool good = read_rows(views->points, H5T_NATIVE_DOUBLE, views->point_offset[step], grid->points,
                        3, point);
  for (int i = 0; i < views->fields && good; i++) {
    const hdf5_field *field = &views->field[i];
    good = read_rows(views->place[i].set, H5T_NATIVE_DOUBLE, views->place[i].offset[step],
                     field->is_by_cell ? grid->cells : grid->points,
                     field->components > 1 ? field->components : 0, value[i]);
  }
  return good;
}
