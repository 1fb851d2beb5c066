/** Reading files of rows and tables. The functions are those of hdf5_module.h. */
#ifndef READ_ROWS_H
#define READ_ROWS_H
#include "hdf5/hdf5_module.h"

hdf5_source *read_rows_open(const char *path, hdf5_content *content);
bool read_rows_read(hdf5_source *source, int64_t first, int64_t count, double *number);
void read_rows_close(hdf5_source **source);
#endif
