#include "hdf5/stored_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "hdf5/h5.h"
#include "hdf5/head.h"

/* Bytes of a chunk of rows, which is written at once: so many that reading is fast, and fewer where
 * few rows are expected. */
enum { CHUNK_LEAST = 1 << 13, CHUNK_MOST = 1 << 18 };

static const char rows_name[] = "rows";

struct hdf5_rows {
  hid_t file;
  h5_array array;
  double *block; /* [chunk*columns] rows that are not written yet */
  int64_t chunk, pending;
  int columns;
  time_t flushed;
  bool failed; /* a write; what was flushed before is in the file */
};

static int64_t chunk_of(const hdf5_head *head)
{
  const double row = (double)head->columns * sizeof(double);
  const double rows = fmin(fmax(head->expected, CHUNK_LEAST / row), CHUNK_MOST / row);
  return rows > 1 ? (int64_t)rows : 1;
}

/* Release everything, whatever is open. Returns NULL. A file that could not be written is left as
 * it was flushed last: closing it would describe what is not there. */
static hdf5_rows *discard(hdf5_rows *rows)
{
  if (rows == NULL) return NULL;
  if (!rows->failed) h5_array_close(&rows->array);
  if (!rows->failed && rows->file > 0) (void)H5Fclose(rows->file);
  free(rows->block);
  free(rows);
  return NULL;
}

static hdf5_rows *reserve(const hdf5_head *head)
{
  hdf5_rows *rows = calloc(1, sizeof *rows);
  if (rows != NULL)
    *rows = (hdf5_rows){.columns = head->columns, .chunk = chunk_of(head), .flushed = time(NULL)};
  else
    (void)h5_refuse("out of memory");
  return rows;
}

/* Make room for the rows of a chunk. */
static bool reserve_block(hdf5_rows *rows)
{
  if (rows->chunk < 1 || rows->columns < 1) return h5_refuse("it has no chunks of rows");
  rows->block = calloc((size_t)(rows->chunk * rows->columns), sizeof *rows->block);
  return rows->block != NULL || h5_refuse("out of memory");
}

/* Create the file with its head, an empty array, and nothing that is in the way of readers. */
static bool make(hdf5_rows *rows, const char *path, const hdf5_head *head)
{
  rows->file = h5_create(path);
  return rows->file >= 0 && head_write(rows->file, head) &&
         h5_array_create(rows->file, rows_name, H5T_NATIVE_DOUBLE, rows->columns, rows->chunk,
                         &rows->array) &&
         head_write_columns(rows->array.set, head);
}

hdf5_rows *stored_rows_create(const char *path, const hdf5_head *head)
{
  hdf5_rows *rows = reserve(head);
  if (rows == NULL) return NULL;
  const bool good = reserve_block(rows) && make(rows, path, head) && h5_start(rows->file);
  return good ? rows : discard(rows);
}

/* ---- an old file ---- */

static bool open_array(hdf5_rows *rows)
{
  h5_array *array = &rows->array;
  array->set = H5Lexists(rows->file, rows_name, H5P_DEFAULT) > 0
                   ? H5Dopen2(rows->file, rows_name, H5P_DEFAULT)
                   : -1;
  if (array->set < 0) return h5_refuse("it has no dataset '%s'", rows_name);
  array->type = H5T_NATIVE_DOUBLE;
  array->rank = 2;
  const hid_t space = H5Dget_space(array->set), list = H5Dget_create_plist(array->set);
  hsize_t chunk[2] = {0, 0};
  const bool good = H5Sget_simple_extent_ndims(space) == 2 &&
                    H5Sget_simple_extent_dims(space, array->size, NULL) == 2 &&
                    array->size[1] == (hsize_t)rows->columns && H5Pget_chunk(list, 2, chunk) == 2 &&
                    chunk[1] == array->size[1];
  rows->chunk = (int64_t)chunk[0];
  (void)H5Pclose(list);
  (void)H5Sclose(space);
  return good || h5_refuse("it has other columns");
}

/* Read the time of a row. */
static bool read_time(const hdf5_rows *rows, hsize_t row, double *t)
{
  const hsize_t from[] = {row, 0}, count[] = {1, 1};
  const hid_t in_file = H5Dget_space(rows->array.set), in_memory = H5Screate(H5S_SCALAR);
  const bool good = H5Sselect_hyperslab(in_file, H5S_SELECT_SET, from, NULL, count, NULL) >= 0 &&
                    H5Dread(rows->array.set, H5T_NATIVE_DOUBLE, in_memory, in_file, H5P_DEFAULT,
                            t) >= 0;
  (void)H5Sclose(in_file);
  (void)H5Sclose(in_memory);
  return good || h5_refuse_by_library();
}

/* Count the rows before the state, by bisection. */
static bool count_before(const hdf5_rows *rows, const hdf5_state *state, hsize_t *count)
{
  hsize_t low = 0, high = rows->array.size[0];
  while (low < high) {
    const hsize_t middle = low + (high - low) / 2;
    double t = 0;
    if (!read_time(rows, middle, &t)) return false;
    if (state->direction * (t - state->t) < 0)
      low = middle + 1;
    else
      high = middle;
  }
  *count = low;
  return true;
}

/* Refuse rows that leave a gap before the state, or begin behind it. */
static bool check_gap(const hdf5_rows *rows, const hdf5_state *state, hsize_t before, bool has_row)
{
  double t = 0;
  if (has_row || rows->array.size[0] == 0) return true;
  if (!read_time(rows, before > 0 ? before - 1 : 0, &t)) return false;
  if (before == 0)
    return h5_refuse("its rows begin at t = %.17g, and the checkpoint stands at t = %.17g", t,
                     state->t);
  if (!state->has_row && state->direction * (state->t - t) <= state->gap) return true;
  return h5_refuse("its rows end at t = %.17g, and the checkpoint stands at t = %.17g", t,
                   state->t);
}

/* Cut off the rows behind the state, and that of the state if an uninterrupted run has none. */
static bool cut(hdf5_rows *rows, const hdf5_state *state, bool *has_row)
{
  hsize_t before;
  double t = 0;
  if (!count_before(rows, state, &before)) return false;
  *has_row = before < rows->array.size[0];
  if (*has_row && !read_time(rows, before, &t)) return false;
  *has_row = *has_row && t == state->t && (state->has_row || before == 0);
  if (!check_gap(rows, state, before, *has_row)) return false;
  rows->array.size[0] = before + (*has_row ? 1 : 0);
  return H5Dset_extent(rows->array.set, rows->array.size) >= 0 || h5_refuse_by_library();
}

hdf5_rows *stored_rows_append(const char *path, const hdf5_head *head, const hdf5_state *state,
                              bool *has_row)
{
  hdf5_rows *rows = reserve(head);
  if (rows == NULL) return NULL;
  rows->file = h5_open(path);
  const bool good = rows->file >= 0 && open_array(rows) && reserve_block(rows) &&
                    head_is_same(rows->file, rows->array.set, head) && cut(rows, state, has_row) &&
                    h5_start(rows->file) && h5_flush(rows->file);
  return good ? rows : discard(rows);
}

/* ---- rows ---- */

static bool write_block(hdf5_rows *rows)
{
  const bool good = h5_array_append(&rows->array, rows->pending, rows->block);
  rows->pending = 0;
  return good;
}

bool stored_rows_flush(hdf5_rows *rows)
{
  rows->flushed = time(NULL);
  if (!write_block(rows) || !h5_flush(rows->file)) rows->failed = true;
  return !rows->failed;
}

bool stored_rows_add(hdf5_rows *rows, const double *row)
{
  memcpy(rows->block + rows->pending++ * rows->columns, row, (size_t)rows->columns * sizeof *row);
  /* Blocks end where chunks do, so that a chunk is written once. */
  const int64_t room = rows->chunk - (int64_t)rows->array.size[0] % rows->chunk;
  if (rows->pending == room && !write_block(rows)) rows->failed = true;
  if (rows->failed) return false;
  return time(NULL) == rows->flushed || stored_rows_flush(rows);
}

bool stored_rows_close(hdf5_rows **rows)
{
  hdf5_rows *closing = *rows;
  *rows = NULL;
  bool good = !closing->failed && stored_rows_flush(closing);
  if (good) {
    h5_array_close(&closing->array);
    good = H5Fclose(closing->file) >= 0 || h5_refuse_by_library();
    closing->file = 0;
  }
  (void)discard(closing);
  return good;
}

/* ---- tables ---- */

/* Write a column of texts, all as long as the longest one. */
static bool write_texts(hid_t group, int64_t rows, const hdf5_texts *texts, int column)
{
  size_t size = 1;
  for (int64_t i = 0; i < rows; i++) {
    const size_t length = strlen(texts->cell[i * texts->columns + column]);
    size = length > size ? length : size;
  }
  char *packed = calloc((size_t)rows + 1, size);
  if (packed == NULL) return h5_refuse("out of memory");
  for (int64_t i = 0; i < rows; i++) {
    const char *text = texts->cell[i * texts->columns + column];
    for (size_t k = 0; text[k] != '\0'; k++) packed[(size_t)i * size + k] = text[k];
  }
  h5_array array = {.set = 0};
  const hid_t type = H5Tcopy(H5T_C_S1);
  (void)H5Tset_size(type, size);
  (void)H5Tset_strpad(type, H5T_STR_NULLPAD);
  (void)H5Tset_cset(type, H5T_CSET_UTF8);
  const bool good = h5_array_create(group, texts->column[column], type, 0, 1024, &array) &&
                    h5_array_append(&array, rows, packed);
  h5_array_close(&array);
  (void)H5Tclose(type);
  free(packed);
  return good;
}

static bool write_all_texts(hid_t file, int64_t rows, const hdf5_texts *texts)
{
  if (texts->columns == 0) return true;
  const hid_t list = h5_creation_list(H5P_GROUP_CREATE);
  const hid_t group = H5Gcreate2(file, "text", H5P_DEFAULT, list, H5P_DEFAULT);
  (void)H5Pclose(list);
  bool good = group >= 0 || h5_refuse_by_library();
  for (int j = 0; j < texts->columns && good; j++) good = write_texts(group, rows, texts, j);
  (void)H5Gclose(group);
  return good;
}

bool stored_table(const char *path, const hdf5_head *head, int64_t rows, const double *number,
                  const hdf5_texts *texts)
{
  hdf5_rows *table = reserve(head);
  if (table == NULL) return false;
  bool good = make(table, path, head) && h5_array_append(&table->array, rows, number) &&
              write_all_texts(table->file, rows, texts);
  if (good) return stored_rows_close(&table);
  (void)discard(table);
  return false;
}
