#define _POSIX_C_SOURCE 200809L
#include "slabs_struct.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "core/memory.h"
#include "core/status.h"

enum { NAME_SIZE = 64 };

/* ---- open and close ---- */

static dvi__slabs *slabs_new(const dvi__world *world, const char *path)
{
  dvi__slabs *file = DVI_NEW(dvi__slabs, 1);
  if (file == NULL) return NULL;
  file->world = world;
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

static dvi_status agree(const dvi__world *world, dvi_status status)
{
  return world != NULL ? dvi__world_agree(world, status) : status;
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

/* Make the list of how a file is accessed, for H5Pclose. */
static hid_t access_by(const dvi__world *world)
{
  const hid_t list = H5Pcreate(H5P_FILE_ACCESS);
  if (list < 0 || world == NULL || H5Pset_fapl_mpio(list, world->comm, MPI_INFO_NULL) >= 0)
    return list;
  (void)H5Pclose(list);
  return H5I_INVALID_HID;
}

static hid_t open_together(const dvi__world *world, const char *path)
{
  const hid_t access = access_by(world),
              id = access >= 0 ? H5Fopen(path, H5F_ACC_RDONLY, access) : H5I_INVALID_HID;
  if (access >= 0) (void)H5Pclose(access);
  return id;
}

dvi_status dvi__slabs_open(const dvi__world *world, const char *path, dvi__slabs **file)
{
  dvi__slabs *made = slabs_new(world, path);
  dvi_status status = made != NULL && made->path != NULL
                          ? check_readable(path)
                          : dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a file");
  status = agree(world, status);
  if (status == DVI_OK) {
    made->id = open_together(world, path);
    status = agree(
        world,
        made->id >= 0
            ? DVI_OK
            : dvi__fail(DVI_BAD_FILE, "%.300s: it is no file of HDF5, or it is cut short", path));
  }
  *file = made;
  if (status != DVI_OK) (void)dvi__slabs_end(file, 0);
  return status;
}

/* ---- a file beside its place ---- */

static int is_first(const dvi__slabs *file)
{
  return file->world == NULL || file->world->rank == 0;
}

/* Name the file after the first process. */
static dvi_status name_beside(dvi__slabs *file, const char *path)
{
  const size_t size = strlen(path) + NAME_SIZE;
  int64_t process = getpid();
  dvi_status status = DVI_OK;
  if (file->world != NULL &&
      MPI_Bcast(&process, 1, MPI_INT64_T, 0, file->world->comm) != MPI_SUCCESS)
    status = dvi__world_fail(file->world);
  file->beside = dvi__allocate(size, 1);
  if (status == DVI_OK && file->beside == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a file");
  if (file->beside != NULL)
    (void)snprintf(file->beside, size, "%s.part-%lld", path, (long long)process);
  return status;
}

/* The first process creates an empty file, of which the system tells why it cannot be. */
static dvi_status try_beside(const dvi__slabs *file)
{
  if (!is_first(file)) return DVI_OK;
  FILE *stream = fopen(file->beside, "wb");
  if (stream != NULL && fclose(stream) == 0) return DVI_OK;
  return dvi__fail(DVI_IO_ERROR, "cannot write a file beside %.300s: %s", file->path,
                   strerror(errno));
}

/* Headers of this version have checksums. The same contents are the same bytes at any time. */
static dvi_status create(dvi__slabs *file)
{
  const hid_t access = access_by(file->world), how = H5Pcreate(H5P_FILE_CREATE);
  if (access >= 0 && how >= 0 && H5Pset_obj_track_times(how, 0) >= 0 &&
      H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110) >= 0)
    file->id = H5Fcreate(file->beside, H5F_ACC_TRUNC, how, access);
  if (access >= 0) (void)H5Pclose(access);
  if (how >= 0) (void)H5Pclose(how);
  return file->id >= 0 ? DVI_OK
                       : dvi__fail(DVI_IO_ERROR, "cannot write a file beside %.300s: HDF5 failed",
                                   file->path);
}

dvi_status dvi__slabs_create(const dvi__world *world, const char *path, dvi__slabs **file)
{
  dvi__slabs *made = slabs_new(world, path);
  dvi_status status = agree(world, made != NULL && made->path != NULL
                                       ? DVI_OK
                                       : dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a file"));
  if (status == DVI_OK) status = agree(world, name_beside(made, path));
  if (status == DVI_OK) status = agree(world, try_beside(made));
  if (status == DVI_OK) status = agree(world, create(made));
  *file = made;
  if (status != DVI_OK) (void)dvi__slabs_end(file, 0);
  return status;
}

/* Have the bytes on the disk before the name changes. Returns 0 or the error number. */
static int flush(const char *path)
{
  const int descriptor = open(path, O_RDWR | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int reason = fsync(descriptor) != 0 ? errno : 0;
  (void)close(descriptor);
  return reason;
}

static dvi_status keep_file(const dvi__slabs *file)
{
  int reason = flush(file->beside);
  if (reason == 0 && rename(file->beside, file->path) != 0) reason = errno;
  if (reason == 0) return DVI_OK;
  (void)unlink(file->beside);
  return dvi__fail(DVI_IO_ERROR, "cannot write %.300s: %s", file->path, strerror(reason));
}

/* Close a file that is written. */
static dvi_status finish(const dvi__slabs *file, int keep)
{
  const int is_closed = H5Fclose(file->id) >= 0;
  if (file->beside == NULL) return DVI_OK;
  const dvi_status closed = agree(
      file->world, is_closed || !keep
                       ? DVI_OK
                       : dvi__fail(DVI_IO_ERROR, "cannot write %.300s: HDF5 failed", file->path));
  if (!is_first(file)) return agree(file->world, DVI_OK);
  if (closed == DVI_OK && keep) return agree(file->world, keep_file(file));
  (void)unlink(file->beside);
  (void)agree(file->world, DVI_OK);
  return closed;
}

dvi_status dvi__slabs_end(dvi__slabs **file, int keep)
{
  dvi_status status = DVI_OK;
  if (*file == NULL) return DVI_OK;
  if ((*file)->id >= 0)
    status = finish(*file, keep);
  else if ((*file)->beside != NULL && is_first(*file))
    (void)unlink((*file)->beside);
  slabs_free(*file);
  *file = NULL;
  return status;
}

/* ---- datasets ---- */

hid_t dvi__slabs_type(dvi__number_type type)
{
  if (type == DVI__INT8) return H5T_NATIVE_INT8;
  if (type == DVI__INT32) return H5T_NATIVE_INT32;
  return type == DVI__INT64 ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
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
  const int is_same = stored >= 0 && H5Tget_class(stored) == H5Tget_class(dvi__slabs_type(type));
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
                      H5Dread(set, dvi__slabs_type(slab->type), memory, place, H5P_DEFAULT,
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
                 : dvi__slabs_refuse(
                       file, "it has no text \"%s\": it is of another kind, or damaged", name);
}
