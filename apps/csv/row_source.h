/** Rows of a file of HDF5, read block by block. */
#ifndef ROW_SOURCE_H
#define ROW_SOURCE_H
#include "module/store.h"

/** A file being read. All zero is none. */
typedef struct row_source {
  const hdf5_module *module;
  hdf5_source *file;
  hdf5_content content;
  double *block;       /**< [held*columns] rows from `first` on */
  int64_t first, held; /**< rows of the block */
  int64_t next;        /**< row that is read next */
  bool failed;
} row_source;

/** Open a file. Complains and returns false if it cannot be read. */
bool row_source_open(row_source *source, const char *path);

/** Return the next row [columns], which stays until the next call, or NULL at the end, and if it
 * cannot be read, which row_source_failed tells then. */
const double *row_source_next(row_source *source);

/** Complain and return true if a row could not be read. */
bool row_source_failed(const row_source *source, const char *path);

void row_source_close(row_source *source);
#endif
