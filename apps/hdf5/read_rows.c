#include "hdf5/read_rows.h"

#include <limits.h>
#include <stdlib.h>

#include "hdf5/h5.h"
#include "hdf5/head.h"

static const char rows_name[] = "rows";
enum { ROWS, TABLE, LAYOUTS };
static const char *const layouts[LAYOUTS + 1] = {
    [ROWS] = "dvi rows 1", [TABLE] = "dvi table 1", [LAYOUTS] = NULL};

struct hdf5_source {
  hid_t file, set;
  int columns;
  char **column; /* [columns] HDF5's texts, each in memory of its own */
};

void read_rows_close(hdf5_source **source)
{
  hdf5_source *closing = *source;
  *source = NULL;
  if (closing == NULL) return;
  for (int i = 0; i < closing->columns && closing->column != NULL; i++)
    (void)H5free_memory(closing->column[i]);
  free(closing->column);
  if (closing->set >= 0) (void)H5Dclose(closing->set);
  if (closing->file >= 0) (void)H5Fclose(closing->file);
  free(closing);
}

/* Find the dataset of the rows, and how large it is. */
static bool open_set(hdf5_source *source, hdf5_content *content)
{
  hsize_t size[2] = {0, 0};
  if (H5Lexists(source->file, rows_name, H5P_DEFAULT) > 0)
    source->set = H5Dopen2(source->file, rows_name, H5P_DEFAULT);
  if (source->set < 0) return h5_refuse("it has no dataset '%s'", rows_name);
  const hid_t space = H5Dget_space(source->set), type = H5Dget_type(source->set);
  const bool good = H5Sget_simple_extent_ndims(space) == 2 &&
                    H5Sget_simple_extent_dims(space, size, NULL) == 2 && size[0] <= INT_MAX &&
                    size[1] > 0 && size[1] <= INT_MAX && H5Tget_class(type) == H5T_FLOAT;
  (void)H5Tclose(type);
  (void)H5Sclose(space);
  content->rows = (int64_t)size[0];
  source->columns = content->columns = good ? (int)size[1] : 0;
  return good || h5_refuse("its dataset '%s' is no table of numbers", rows_name);
}

static bool read_names(hdf5_source *source, hdf5_content *content)
{
  source->column = calloc((size_t)source->columns + 1, sizeof *source->column);
  if (source->column == NULL) return h5_refuse("out of memory");
  content->column = (const char *const *)source->column;
  return head_read_columns(source->set, source->columns, source->column);
}

hdf5_source *read_rows_open(const char *path, hdf5_content *content)
{
  hdf5_source *source = calloc(1, sizeof *source);
  *content = (hdf5_content){.rows = 0};
  if (source == NULL) {
    (void)h5_refuse("out of memory");
    return NULL;
  }
  source->set = -1;
  source->file = h5_open_to_read(path);
  const int layout = source->file >= 0 ? head_find_layout(source->file, layouts) : -1;
  content->is_table = layout == TABLE;
  if (layout < 0 || !open_set(source, content) || !read_names(source, content))
    read_rows_close(&source);
  return source;
}

bool read_rows_read(hdf5_source *source, int64_t first, int64_t count, double *number)
{
  const hsize_t from[] = {(hsize_t)first, 0}, size[] = {(hsize_t)count, (hsize_t)source->columns};
  const hid_t in_file = H5Dget_space(source->set), in_memory = H5Screate_simple(2, size, NULL);
  const bool good = H5Sselect_hyperslab(in_file, H5S_SELECT_SET, from, NULL, size, NULL) >= 0 &&
                    H5Dread(source->set, H5T_NATIVE_DOUBLE, in_memory, in_file, H5P_DEFAULT,
                            number) >= 0;
  if (!good) (void)h5_refuse_by_library();
  (void)H5Sclose(in_file);
  (void)H5Sclose(in_memory);
  return good;
}
