/** Fields on a grid at several times, as VTK's readers take them (VTKHDF 2.0, UnstructuredGrid).
 * The functions are those of hdf5_module.h. */
#ifndef STORED_FRAMES_H
#define STORED_FRAMES_H
#include "hdf5/hdf5_module.h"

hdf5_frames *stored_frames_create(const char *path, const hdf5_head *head, const hdf5_grid *grid,
                                  int fields, const hdf5_field *field);
bool stored_frames_add(hdf5_frames *frames, double t, const hdf5_grid *grid,
                       const hdf5_field *field);
bool stored_frames_close(hdf5_frames **frames);
#endif
