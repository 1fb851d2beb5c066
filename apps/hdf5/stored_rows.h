/** Rows of numbers in a file, and tables. The functions are those of hdf5_module.h. */
#ifndef STORED_ROWS_H
#define STORED_ROWS_H
#include "hdf5/hdf5_module.h"

hdf5_rows *stored_rows_create(const char *path, const hdf5_head *head);
hdf5_rows *stored_rows_append(const char *path, const hdf5_head *head, const hdf5_state *state,
                              bool *has_row);
bool stored_rows_add(hdf5_rows *rows, const double *row);
bool stored_rows_flush(hdf5_rows *rows);
bool stored_rows_close(hdf5_rows **rows);
bool stored_table(const char *path, const hdf5_head *head, int64_t rows, const double *number,
                  const hdf5_texts *texts);
#endif
