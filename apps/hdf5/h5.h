/** What all files have in common: how they are opened, why that fails, attributes, and arrays that
 * grow. Functions that return an hid_t return a negative one on failure. */
#ifndef H5_H
#define H5_H
#include <hdf5.h>
#include <stdbool.h>
#include <stdint.h>

/** Remember why a function fails. Returns false. */
bool h5_refuse(const char *format, ...) __attribute__((format(printf, 1, 2)));

/** Remember HDF5's own reason, that of the operating system if there is one. Returns false. */
bool h5_refuse_by_library(void);

/** Return what was remembered. */
const char *h5_reason(void);

/** Make the list of properties by which an object of a class is created, for H5Pclose. The time is
 * left out, so that the same contents are the same bytes. */
hid_t h5_creation_list(hid_t kind);

/** Create a file that can be read while it is written. */
hid_t h5_create(const char *path);

/** Open such a file to write, even if its last writer was killed. */
hid_t h5_open(const char *path);

/** Open a file to read. It may be one that is being written, or whose writer was killed. */
hid_t h5_open_to_read(const char *path);

/** Let readers in. All datasets exist by now, and no attribute is open. */
bool h5_start(hid_t file);

/** Let readers see what was written so far, and lock the file against other writers. If that
 * fails, the file is as it was flushed before, unless it is closed. */
bool h5_flush(hid_t file);

/** Write attributes of a group or a dataset: texts [count], a scalar if there is one; a number; or
 * whole numbers [count]. */
bool h5_put_texts(hid_t place, const char *name, int count, const char *const *text);
bool h5_put_number(hid_t place, const char *name, double number);
bool h5_put_wholes(hid_t place, const char *name, int count, const int64_t *whole);

/** An array in a file, which grows along its first axis. */
typedef struct h5_array {
  hid_t set;
  hid_t type;      /**< of an element in memory */
  int rank;        /**< 1 or 2 */
  hsize_t size[2]; /**< rows so far, and elements of a row */
} h5_array;

/** Create an empty array, stored in chunks of so many rows. The width is 0 for one axis. */
bool h5_array_create(hid_t place, const char *name, hid_t type, int width, int64_t chunk,
                     h5_array *array);

/** Append rows. */
bool h5_array_append(h5_array *array, int64_t rows, const void *values);

void h5_array_close(h5_array *array);
#endif
