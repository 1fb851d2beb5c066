/** Files of fields, as stored_frames writes them, that are read. */
#ifndef READ_FRAMES_H
#define READ_FRAMES_H
#include "hdf5/hdf5_module.h"

/** The functions of the module. */
hdf5_views *read_frames_open(const char *path, hdf5_views_content *content);
bool read_frames_read(hdf5_views *views, int64_t step, double *point, double *const *value);
void read_frames_close(hdf5_views **views);
#endif
