#define _POSIX_C_SOURCE 200809L
#include "slabs.h"

#include <errno.h>
#include <hdf5.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "core/memory.h"
#include "core/status.h"

/* Numbers of at most so many bytes stand in the header of their dataset, and others in chunks. */
enum { NAME_SIZE = 64, HEADER_MOST = 1024, CHUNK_BYTES = 1 << 19 };

struct dvi__slabs {
  hid_t id;
  char *path, *beside; /* the file that is written */
  H5E_auto2_t printer; /* of HDF5's own words, which are not wanted */
  void *printer_user;
};

/* ---- open and close ---- */

static dvi__slabs *slabs_new(const char *path)
{
  dvi__slabs *file = DVI_NEW(dvi__slabs, 1);
  if (file == NULL) return NULL;
  file->id = H5I_INVALID_HID;
  file->path = dvi__duplicate(path, strlen(path) + 1, 1);
  (void)H5Eget_auto2(H5E_DEFAULT, &file->printer, &file->printer_user);
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  return file;
}

static void slabs_free(dvi__slabs *file)
{
  (void)H5Eset_auto2(H5E_DEFAULT, file->printer, file->printer_user);
  dvi__release(file->path);
  dvi__release(file->beside);
  dvi__release(file);
}

dvi_status dvi__slabs_refuse(const dvi__slabs *file, const char *sentence, ...)
{
  char text[256];
  va_list arguments;
  va_start(arguments, sentence);
  /* NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start has begun it */
  (void)vsnprintf(text, sizeof text, sentence, arguments);
  va_end(arguments);
  return dvi__fail(DVI_BAD_FILE, "%.200s: %s", file->path, text);
}

/* MPI's files tell less about a failure than the system does. */
static dvi_status check_readable(const char *path)
{
  FILE *stream = fopen(path, "rb");
  if (stream == NULL)
    return dvi__fail(DVI_IO_ERROR, "cannot open %.300s: %s", path, strerror(errno));
  (void)fclose(stream);
  return DVI_OK;
}

static hid_t open_together(const dvi__world *world, const char *path)
{
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  hid_t id = H5I_INVALID_HID;
  if (access >= 0 && H5Pset_fapl_mpio(access, world->comm, MPI_INFO_NULL) >= 0)
    id = H5Fopen(path, H5F_ACC_RDONLY, access);
  if (access >= 0) (void)H5Pclose(access);
  return id;
}

dvi_status dvi__slabs_open(const dvi__world *world, const char *path, dvi__slabs **file)
{
  dvi__slabs *made = slabs_new(path);
  dvi_status status = made != NULL && made->path != NULL
                          ? check_readable(path)
                          : dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a file");
  status = dvi__world_agree(world, status);
  if (status == DVI_OK) {
    made->id = open_together(world, path);
    status = dvi__world_agree(world, made->id >= 0 ? DVI_OK
                                                   : dvi__fail(DVI_BAD_FILE,
                                                               "%.300s: it is no file of HDF5, or "
                                                               "it is cut short",
                                                               path));
  }
  *file = made;
  if (status != DVI_OK) (void)dvi__slabs_end(file, 0);
  return status;
}

/* Headers of this version have checksums. */
static hid_t create_file(const char *path)
{
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  hid_t id = H5I_INVALID_HID;
  if (access >= 0 && H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_LATEST) >= 0)
    id = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access);
  if (access >= 0) (void)H5Pclose(access);
  return id;
}

dvi_status dvi__slabs_create(const char *path, dvi__slabs **file)
{
  dvi__slabs *made = slabs_new(path);
  const size_t size = strlen(path) + NAME_SIZE;
  *file = made;
  if (made != NULL) made->beside = dvi__allocate(size, 1);
  if (made == NULL || made->path == NULL || made->beside == NULL) {
    (void)dvi__slabs_end(file, 0);
    return dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a file");
  }
  (void)snprintf(made->beside, size, "%s.part-%ld", path, (long)getpid());
  made->id = create_file(made->beside);
  if (made->id >= 0) return DVI_OK;
  (void)dvi__slabs_end(file, 0);
  return dvi__fail(DVI_IO_ERROR, "cannot write a file beside %.300s", path);
}

static dvi_status finish(const dvi__slabs *file, int keep, int is_closed)
{
  if (file->beside == NULL) return DVI_OK;
  if (keep && is_closed && rename(file->beside, file->path) == 0) return DVI_OK;
  const int reason = is_closed ? errno : EIO;
  (void)unlink(file->beside);
  return keep ? dvi__fail(DVI_IO_ERROR, "cannot write %.300s: %s", file->path, strerror(reason))
              : DVI_OK;
}

dvi_status dvi__slabs_end(dvi__slabs **file, int keep)
{
  dvi_status status = DVI_OK;
  if (*file == NULL) return DVI_OK;
  const int was_open = (*file)->id >= 0, is_closed = was_open && H5Fclose((*file)->id) >= 0;
  if (was_open) status = finish(*file, keep, is_closed);
  slabs_free(*file);
  *file = NULL;
  return status;
}

/* ---- datasets ---- */

static hid_t type_in_memory(dvi__number_type type)
{
  if (type == DVI__INT8) return H5T_NATIVE_INT8;
  if (type == DVI__INT32) return H5T_NATIVE_INT32;
  return type == DVI__INT64 ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
}

static hid_t type_in_file(dvi__number_type type)
{
  if (type == DVI__INT8) return H5T_STD_I8LE;
  if (type == DVI__INT32) return H5T_STD_I32LE;
  return type == DVI__INT64 ? H5T_STD_I64LE : H5T_IEEE_F64LE;
}

int dvi__slabs_have(const dvi__slabs *file, const char *name)
{
  return H5Lexists(file->id, name, H5P_DEFAULT) > 0;
}

dvi_status dvi__slabs_members(const dvi__slabs *file, const char *name, int *members)
{
  H5G_info_t facts;
  const hid_t group = dvi__slabs_have(file, name) ? H5Gopen2(file->id, name, H5P_DEFAULT)
                                                  : H5I_INVALID_HID;
  const int known = group >= 0 && H5Gget_info(group, &facts) >= 0 && facts.nlinks < INT_MAX;
  if (group >= 0) (void)H5Gclose(group);
  if (!known) return dvi__slabs_refuse(file, "it has no group \"%s\", or that is damaged", name);
  *members = (int)facts.nlinks;
  return DVI_OK;
}

/* Give the axes of an open dataset. Returns whether they are one or two. */
static int shape_of(hid_t set, int64_t *rows, int *width)
{
  hsize_t extent[2] = {0};
  const hid_t space = H5Dget_space(set);
  const int axes = space >= 0 ? H5Sget_simple_extent_ndims(space) : 0,
            known = (axes == 1 || axes == 2) &&
                    H5Sget_simple_extent_dims(space, extent, NULL) == axes && extent[1] <= INT_MAX;
  if (space >= 0) (void)H5Sclose(space);
  *rows = known ? (int64_t)extent[0] : 0;
  *width = known ? (int)extent[1] : 0;
  return known;
}

dvi_status dvi__slabs_shape(const dvi__slabs *file, const char *name, int64_t *rows, int *width)
{
  const hid_t set = dvi__slabs_have(file, name) ? H5Dopen2(file->id, name, H5P_DEFAULT)
                                                : H5I_INVALID_HID;
  const int known = set >= 0 && shape_of(set, rows, width);
  if (set >= 0) (void)H5Dclose(set);
  return known ? DVI_OK
               : dvi__slabs_refuse(
                     file, "it has no dataset \"%s\" of one or two axes, or that is damaged", name);
}

/* Numbers of another class would be converted without a word. */
static int has_class(hid_t set, dvi__number_type type)
{
  const hid_t stored = H5Dget_type(set);
  const int is_same = stored >= 0 && H5Tget_class(stored) == H5Tget_class(type_in_memory(type));
  if (stored >= 0) (void)H5Tclose(stored);
  return is_same;
}

static int read_rows(hid_t set, const dvi__slab *slab, void *numbers)
{
  const hsize_t start[2] = {(hsize_t)slab->first, 0},
                count[2] = {(hsize_t)slab->rows, (hsize_t)slab->width};
  const int axes = slab->width > 0 ? 2 : 1;
  if (slab->rows == 0) return 1;
  const hid_t place = H5Dget_space(set), memory = H5Screate_simple(axes, count, NULL);
  const int is_read = place >= 0 && memory >= 0 &&
                      H5Sselect_hyperslab(place, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
                      H5Dread(set, type_in_memory(slab->type), memory, place, H5P_DEFAULT,
                              numbers) >= 0;
  if (place >= 0) (void)H5Sclose(place);
  if (memory >= 0) (void)H5Sclose(memory);
  return is_read;
}

dvi_status dvi__slabs_read(const dvi__slabs *file, const dvi__slab *slab, void *numbers)
{
  int64_t rows = 0;
  int width = 0;
  DVI_TRY(dvi__slabs_shape(file, slab->name, &rows, &width));
  if (slab->first + slab->rows > rows || width != slab->width)
    return dvi__slabs_refuse(file, "\"%s\" has %lld rows of %d numbers, and %lld of %d are needed",
                             slab->name, (long long)rows, width > 0 ? width : 1,
                             (long long)slab->first + (long long)slab->rows,
                             slab->width > 0 ? slab->width : 1);
  const hid_t set = H5Dopen2(file->id, slab->name, H5P_DEFAULT);
  const int is_read = set >= 0 && has_class(set, slab->type) && read_rows(set, slab, numbers);
  if (set >= 0) (void)H5Dclose(set);
  return is_read ? DVI_OK
                 : dvi__slabs_refuse(file, "\"%s\" has other numbers, is damaged, or is cut short",
                                     slab->name);
}

dvi_status dvi__slabs_read_text(const dvi__slabs *file, const char *name, size_t size, char *text)
{
  const hid_t set = dvi__slabs_have(file, name) ? H5Dopen2(file->id, name, H5P_DEFAULT)
                                                : H5I_INVALID_HID,
              type = set >= 0 ? H5Dget_type(set) : H5I_INVALID_HID,
              space = set >= 0 ? H5Dget_space(set) : H5I_INVALID_HID;
  const int is_text = type >= 0 && H5Tget_class(type) == H5T_STRING &&
                      H5Tis_variable_str(type) == 0 && H5Tget_size(type) < size && space >= 0 &&
                      H5Sget_simple_extent_npoints(space) == 1;
  if (is_text) memset(text, 0, size);
  const int is_read = is_text && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0;
  if (space >= 0) (void)H5Sclose(space);
  if (type >= 0) (void)H5Tclose(type);
  if (set >= 0) (void)H5Dclose(set);
  return is_read ? DVI_OK
                 : dvi__slabs_refuse(file, "it has no text \"%s\", or that is damaged", name);
}

/* ---- write ---- */

static dvi_status check_written(const dvi__slabs *file, int is_written)
{
  return is_written ? DVI_OK
                    : dvi__fail(DVI_IO_ERROR, "cannot write %.300s: HDF5 failed", file->path);
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

static hid_t create_set(hid_t file, const char *name, hid_t type, hid_t space)
{
  const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
  const hid_t set = how >= 0 && space >= 0 && choose_layout(how, type, space)
                        ? H5Dcreate2(file, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT)
                        : H5I_INVALID_HID;
  if (how >= 0) (void)H5Pclose(how);
  return set;
}

/* Write a whole dataset, and close its space. */
static int write_set(hid_t file, const char *name, hid_t type, hid_t in_memory, hid_t space,
                     const void *numbers)
{
  const hid_t set = create_set(file, name, type, space);
  int is_written = set >= 0 &&
                   H5Dwrite(set, in_memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) >= 0;
  if (set >= 0) is_written = H5Dclose(set) >= 0 && is_written;
  if (space >= 0) (void)H5Sclose(space);
  return is_written;
}

dvi_status dvi__slabs_write(const dvi__slabs *file, const dvi__slab *slab, const void *numbers)
{
  const hsize_t extent[2] = {(hsize_t)slab->rows, (hsize_t)slab->width};
  const hid_t space = H5Screate_simple(slab->width > 0 ? 2 : 1, extent, NULL);
  return check_written(file, write_set(file->id, slab->name, type_in_file(slab->type),
                                       type_in_memory(slab->type), space, numbers));
}

dvi_status dvi__slabs_write_text(const dvi__slabs *file, const char *name, const char *text)
{
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  const int is_written = type >= 0 && H5Tset_size(type, strlen(text) + 1) >= 0 &&
                         write_set(file->id, name, type, type, space, text);
  if (type >= 0) (void)H5Tclose(type);
  return check_written(file, is_written);
}

dvi_status dvi__slabs_write_group(const dvi__slabs *file, const char *name)
{
  const hid_t group = H5Gcreate2(file->id, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  return check_written(file, group >= 0 && H5Gclose(group) >= 0);
}
