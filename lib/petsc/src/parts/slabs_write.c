/* Writing datasets of HDF5 in parts. */
#include <string.h>

#include "core/status.h"
#include "slabs_struct.h"

/* Numbers of at most so many bytes stand in the header of their dataset, and others in chunks. */
enum { HEADER_MOST = 1024, CHUNK_BYTES = 1 << 19 };

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

/* Make the list of how an object is created, for H5Pclose. The same contents are the same bytes at
 * any time. */
static hid_t creation(hid_t kind)
{
  const hid_t how = H5Pcreate(kind);
  if (how >= 0) (void)H5Pset_obj_track_times(how, 0);
  return how;
}

/* Let each process write to room that is there. */
static int choose_rows(hid_t how)
{
  return H5Pset_alloc_time(how, H5D_ALLOC_TIME_EARLY) >= 0 &&
         H5Pset_fill_time(how, H5D_FILL_TIME_NEVER) >= 0;
}

/* Let a dataset have checksums: of its header, where it is small, or of chunks of whole rows. */
static int choose_layout(hid_t how, hid_t type, hid_t space)
{
  hsize_t extent[2] = {1, 1};
  const int axes = H5Sget_simple_extent_ndims(space);
  if (axes > 0) (void)H5Sget_simple_extent_dims(space, extent, NULL);
  const hsize_t row = extent[1] * H5Tget_size(type), most = CHUNK_BYTES / row;
  if (extent[0] * row <= HEADER_MOST) return H5Pset_layout(how, H5D_COMPACT) >= 0;
  if (extent[0] > most) extent[0] = most > 0 ? most : 1;
  return H5Pset_chunk(how, axes, extent) >= 0 && H5Pset_fletcher32(how) >= 0;
}

/* A dataset that is written: the types of its numbers in the file and in memory, its room, and what
 * this process writes of it. `in_memory` and `in_file` may be H5S_ALL. */
typedef struct written_set {
  hid_t stored, type, space, in_memory, in_file;
  int is_whole;   /* by each process */
  int is_written; /* by this one */
} written_set;

/* Create a dataset, and write it. */
static int write_set(hid_t file, const char *name, const written_set *w, const void *numbers)
{
  const hid_t how = creation(H5P_DATASET_CREATE);
  const int is_chosen = how >= 0 && w->space >= 0 &&
                        (w->is_whole ? choose_layout(how, w->stored, w->space) : choose_rows(how));
  const hid_t set = is_chosen
                        ? H5Dcreate2(file, name, w->stored, w->space, H5P_DEFAULT, how, H5P_DEFAULT)
                        : H5I_INVALID_HID;
  int is_good = set >= 0 && (!w->is_written || H5Dwrite(set, w->type, w->in_memory, w->in_file,
                                                        H5P_DEFAULT, numbers) >= 0);
  if (set >= 0) is_good = H5Dclose(set) >= 0 && is_good;
  if (how >= 0) (void)H5Pclose(how);
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
  const hsize_t extent[2] = {(hsize_t)slab->rows, (hsize_t)slab->width};
  const written_set w = {.stored = stored_type(slab->type),
                         .type = dvi__slabs_type(slab->type),
                         .space = H5Screate_simple(slab->width > 0 ? 2 : 1, extent, NULL),
                         .in_memory = H5S_ALL,
                         .in_file = H5S_ALL,
                         .is_whole = 1,
                         .is_written = 1};
  const int is_good = write_set(file->id, slab->name, &w, numbers);
  if (w.space >= 0) (void)H5Sclose(w.space);
  return check_written(file, is_good);
}

/* Small datasets stand in headers, which all processes write. */
dvi_status dvi__slabs_write_text(const dvi__slabs *file, const char *name, const char *text)
{
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  const written_set w = {.stored = type,
                         .type = type,
                         .space = space,
                         .in_memory = H5S_ALL,
                         .in_file = H5S_ALL,
                         .is_whole = 1,
                         .is_written = 1};
  const int is_good = type >= 0 && H5Tset_size(type, strlen(text) + 1) >= 0 &&
                      write_set(file->id, name, &w, text);
  if (type >= 0) (void)H5Tclose(type);
  if (space >= 0) (void)H5Sclose(space);
  return check_written(file, is_good);
}

dvi_status dvi__slabs_write_group(const dvi__slabs *file, const char *name)
{
  const hid_t how = creation(H5P_GROUP_CREATE),
              group = how >= 0 ? H5Gcreate2(file->id, name, H5P_DEFAULT, how, H5P_DEFAULT)
                               : H5I_INVALID_HID;
  if (how >= 0) (void)H5Pclose(how);
  return check_written(file, group >= 0 && H5Gclose(group) >= 0);
}
