/* Writing datasets of HDF5 in parts. */
#include <string.h>

#include "core/status.h"
#include "slabs_struct.h"

static hid_t stored_type(dvi__number_type type)
{
  if (type == DVI__INT8) return H5T_STD_I8LE;
  if (type == DVI__INT32) return H5T_STD_I32LE;
  return type == DVI__INT64 ? H5T_STD_I64LE : H5T_IEEE_F64LE;
}

static dvi_status check_written(const dvi__slabs *file, int is_written)
{
  return is_written ? DVI_OK
                    : dvi__fail(DVI_IO_ERROR, "cannot write %.300s: HDF5 failed", file->path);
}

/* Make the list of how a dataset is created, for H5Pclose. Each process writes to room that is
 * there, and the same contents are the same bytes at any time. */
static hid_t creation(void)
{
  const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
  if (list < 0) return list;
  (void)H5Pset_alloc_time(list, H5D_ALLOC_TIME_EARLY);
  (void)H5Pset_fill_time(list, H5D_FILL_TIME_NEVER);
  (void)H5Pset_obj_track_times(list, 0);
  return list;
}

/* A dataset that is written: the type of its numbers in the file and in memory, how many there are,
 * and what this process writes of them. `in_memory` and `in_file` may be H5S_ALL. */
typedef struct written_set {
  hid_t stored, type, space, in_memory, in_file;
  int is_written; /* by this process */
} written_set;

/* Create a dataset, and write it. */
static int write_set(hid_t file, const char *name, const written_set *w, const void *numbers)
{
  const hid_t list = creation(), set = w->space >= 0 && list >= 0
                                           ? H5Dcreate2(file, name, w->stored, w->space,
                                                        H5P_DEFAULT, list, H5P_DEFAULT)
                                           : H5I_INVALID_HID;
  int is_good = set >= 0 && (!w->is_written || H5Dwrite(set, w->type, w->in_memory, w->in_file,
                                                        H5P_DEFAULT, numbers) >= 0);
  if (set >= 0) is_good = H5Dclose(set) >= 0 && is_good;
  if (list >= 0) (void)H5Pclose(list);
  return is_good;
}

dvi_status dvi__slabs_write_rows(const dvi__slabs *file, const dvi__slab *slab, int64_t total,
                                 const void *numbers)
{
  const int axes = slab->width > 0 ? 2 : 1;
  const hsize_t extent[2] = {(hsize_t)total, (hsize_t)slab->width},
                start[2] = {(hsize_t)slab->first, 0},
                count[2] = {(hsize_t)slab->rows, (hsize_t)slab->width};
  const written_set w = {.stored = stored_type(slab->type),
                         .type = dvi__slabs_type(slab->type),
                         .space = H5Screate_simple(axes, extent, NULL),
                         .in_memory = H5Screate_simple(axes, count, NULL),
                         .in_file = H5Screate_simple(axes, extent, NULL),
                         .is_written = slab->rows > 0};
  const int is_good = w.in_memory >= 0 && w.in_file >= 0 &&
                      (slab->rows == 0 || H5Sselect_hyperslab(w.in_file, H5S_SELECT_SET, start,
                                                              NULL, count, NULL) >= 0) &&
                      write_set(file->id, slab->name, &w, numbers);
  if (w.space >= 0) (void)H5Sclose(w.space);
  if (w.in_memory >= 0) (void)H5Sclose(w.in_memory);
  if (w.in_file >= 0) (void)H5Sclose(w.in_file);
  return check_written(file, is_good);
}

dvi_status dvi__slabs_write(const dvi__slabs *file, const dvi__slab *slab, const void *numbers)
{
  return dvi__slabs_write_rows(file, slab, slab->rows, numbers);
}

dvi_status dvi__slabs_write_text(const dvi__slabs *file, const char *name, const char *text)
{
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  const written_set w = {.stored = type,
                         .type = type,
                         .space = space,
                         .in_memory = H5S_ALL,
                         .in_file = H5S_ALL,
                         .is_written = file->world == NULL || file->world->rank == 0};
  const int is_good = type >= 0 && H5Tset_size(type, strlen(text) + 1) >= 0 &&
                      write_set(file->id, name, &w, text);
  if (type >= 0) (void)H5Tclose(type);
  if (space >= 0) (void)H5Sclose(space);
  return check_written(file, is_good);
}

dvi_status dvi__slabs_write_group(const dvi__slabs *file, const char *name)
{
  const hid_t group = H5Gcreate2(file->id, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  return check_written(file, group >= 0 && H5Gclose(group) >= 0);
}
