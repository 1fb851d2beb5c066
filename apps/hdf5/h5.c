#define _POSIX_C_SOURCE 200809L
#include "hdf5/h5.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { REASON_SIZE = 512 };

static char reason[REASON_SIZE];

/* ---- reasons ---- */

const char *h5_reason(void)
{
  return reason;
}

bool h5_refuse(const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  (void)vsnprintf(reason, sizeof reason, format, arguments);
  va_end(arguments);
  return false;
}

/* Take the innermost description of the library's stack. That of a failed system call has the
 * system's message in it. */
static herr_t take_description(unsigned place, const H5E_error2_t *error, void *user)
{
  static const char mark[] = "error message = '";
  (void)user;
  if (place > 0 || error->desc == NULL) return 0;
  const char *message = strstr(error->desc, mark);
  if (message != NULL) message += sizeof mark - 1;
  (void)h5_refuse("%.*s", message != NULL ? (int)strcspn(message, "'") : REASON_SIZE,
                  message != NULL ? message : error->desc);
  return 0;
}

bool h5_refuse_by_library(void)
{
  (void)h5_refuse("HDF5 gives no reason");
  (void)H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_description, NULL);
  return false;
}

/* ---- files ---- */

/* The library must neither print its errors, nor write at the end of the process to a file that
 * could not be closed. */
static void quieten(void)
{
  (void)H5dont_atexit();
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

/* The format of HDF5 1.10, which all readers since then know, lets readers in. */
static hid_t access_list(void)
{
  const hid_t list = H5Pcreate(H5P_FILE_ACCESS);
  if (list >= 0) (void)H5Pset_libver_bounds(list, H5F_LIBVER_V110, H5F_LIBVER_V110);
  return list;
}

hid_t h5_creation_list(hid_t kind)
{
  const hid_t list = H5Pcreate(kind);
  if (list >= 0) (void)H5Pset_obj_track_times(list, false);
  return list;
}

hid_t h5_create(const char *path)
{
  quieten();
  const hid_t list = access_list(), root = h5_creation_list(H5P_FILE_CREATE),
              file = H5Fcreate(path, H5F_ACC_TRUNC, root, list);
  if (file < 0) (void)h5_refuse_by_library();
  (void)H5Pclose(root);
  (void)H5Pclose(list);
  return file;
}

/* Lock a file, because two processes would write the same rows. */
static bool lock(int descriptor)
{
  struct flock all = {.l_type = (short)F_WRLCK, .l_whence = (short)SEEK_SET};
  if (fcntl(descriptor, F_SETLK, &all) == 0 || (errno != EACCES && errno != EAGAIN)) return true;
  return h5_refuse("another process writes it");
}

/* Tell if no other process has locked the file. */
static bool is_free(const char *path)
{
  const int descriptor = open(path, O_RDWR | O_CLOEXEC);
  if (descriptor < 0) return h5_refuse("%s", strerror(errno));
  const bool free_now = lock(descriptor);
  (void)close(descriptor);
  return free_now;
}

/* Tell why a file was not opened. */
static void refuse_to_open(const char *path)
{
  (void)h5_refuse_by_library();
  if (H5Fis_hdf5(path) <= 0)
    (void)h5_refuse("it is no file of HDF5");
  else if (strncmp(reason, "truncated", strlen("truncated")) == 0)
    (void)h5_refuse("it is cut short");
}

hid_t h5_open(const char *path)
{
  quieten();
  if (!is_free(path)) return H5I_INVALID_HID;
  /* A writer that was killed leaves a mark that the file is being written. This property, by which
   * the tool h5clear takes it away, is set without effect where it does not exist. */
  const hbool_t clear = 1;
  const hid_t list = access_list();
  (void)H5Pset(list, "clear_status_flags", &clear);
  hid_t file = H5Fis_hdf5(path) > 0 ? H5Fopen(path, H5F_ACC_RDWR, list) : H5I_INVALID_HID;
  if (file < 0) refuse_to_open(path);
  (void)H5Pclose(list);
  /* The writer may have been killed before it told how long the file is. */
  if (file >= 0 && H5Fincrement_filesize(file, 0) < 0) {
    (void)h5_refuse_by_library();
    (void)H5Fclose(file);
    file = H5I_INVALID_HID;
  }
  return file;
}

/* Tell how many bytes a file has. */
static bool measure(const char *path, off_t *size)
{
  struct stat now;
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
  const bool good = descriptor >= 0 && fstat(descriptor, &now) == 0;
  if (!good) (void)h5_refuse("%s", strerror(errno));
  if (descriptor >= 0) (void)close(descriptor);
  if (good) *size = now.st_size;
  return good;
}

hid_t h5_open_to_read(const char *path)
{
  off_t size;
  haddr_t end;
  quieten();
  if (!measure(path, &size)) return H5I_INVALID_HID;
  hid_t file = H5Fis_hdf5(path) > 0 ? H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT) : H5I_INVALID_HID;
  if (file < 0) refuse_to_open(path);
  if (file < 0) file = H5Fopen(path, H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, H5P_DEFAULT);
  /* The library gives zeros for what lies behind the end of a file that was being written. */
  if (file >= 0 && (H5Fget_eoa(file, &end) < 0 || end > (haddr_t)size)) {
    (void)h5_refuse("it is cut short");
    (void)H5Fclose(file);
    file = H5I_INVALID_HID;
  }
  return file;
}

bool h5_start(hid_t file)
{
  return (H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0 && H5Fstart_swmr_write(file) >= 0) ||
         h5_refuse_by_library();
}

/* Flush the raw data of all datasets. */
static bool flush_data(hid_t file)
{
  enum { MOST = 64 };
  hid_t set[MOST];
  const ssize_t count = H5Fget_obj_ids(file, H5F_OBJ_DATASET, MOST, set);
  bool good = count >= 0;
  for (ssize_t i = 0; i < count && good; i++) good = H5Dflush(set[i]) >= 0;
  return good || h5_refuse_by_library();
}

/* Reserve the room that the file takes when it is flushed. */
static bool reserve(hid_t file, int descriptor)
{
  hsize_t size;
  struct stat now;
  if (H5Fget_filesize(file, &size) < 0) return h5_refuse_by_library();
  if (fstat(descriptor, &now) != 0 || (off_t)size <= now.st_size) return true;
  const int failed = posix_fallocate(descriptor, now.st_size, (off_t)size - now.st_size);
  return failed == 0 || h5_refuse("%s", strerror(failed));
}

/* HDF5's flush goes on after a failure, and describes data that are not there. So the parts that
 * may fail come first. */
bool h5_flush(hid_t file)
{
  void *handle;
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0) return h5_refuse_by_library();
  const int descriptor = *(const int *)handle;
  if (!reserve(file, descriptor) || !flush_data(file)) return false;
  return (H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0 || h5_refuse_by_library()) && lock(descriptor);
}

/* ---- attributes ---- */

static bool put(hid_t place, const char *name, hid_t type, hid_t space, const void *value)
{
  const hid_t attribute = H5Acreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  const bool good = attribute >= 0 && H5Awrite(attribute, type, value) >= 0;
  if (!good) (void)h5_refuse_by_library();
  (void)H5Aclose(attribute);
  (void)H5Sclose(space);
  return good;
}

static hid_t space_of(int count)
{
  const hsize_t size = (hsize_t)count;
  return count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, NULL);
}

bool h5_put_texts(hid_t place, const char *name, int count, const char *const *text)
{
  const hid_t type = H5Tcopy(H5T_C_S1);
  (void)H5Tset_size(type, H5T_VARIABLE);
  (void)H5Tset_cset(type, H5T_CSET_UTF8);
  const bool good = put(place, name, type, space_of(count), text);
  (void)H5Tclose(type);
  return good;
}

bool h5_put_number(hid_t place, const char *name, double number)
{
  return put(place, name, H5T_NATIVE_DOUBLE, space_of(1), &number);
}

bool h5_put_wholes(hid_t place, const char *name, int count, const int64_t *whole)
{
  return put(place, name, H5T_NATIVE_INT64, space_of(count), whole);
}

/* ---- arrays ---- */

bool h5_array_create(hid_t place, const char *name, hid_t type, int width, int64_t chunk,
                     h5_array *array)
{
  *array = (h5_array){.type = type, .rank = width > 0 ? 2 : 1, .size = {0, (hsize_t)width}};
  const hsize_t most[] = {H5S_UNLIMITED, (hsize_t)width},
                block[] = {(hsize_t)chunk, (hsize_t)width};
  const hid_t space = H5Screate_simple(array->rank, array->size, most);
  const hid_t list = h5_creation_list(H5P_DATASET_CREATE);
  (void)H5Pset_chunk(list, array->rank, block);
  array->set = H5Dcreate2(place, name, type, space, H5P_DEFAULT, list, H5P_DEFAULT);
  (void)H5Pclose(list);
  (void)H5Sclose(space);
  return array->set >= 0 || h5_refuse_by_library();
}

bool h5_array_append(h5_array *array, int64_t rows, const void *values)
{
  const hsize_t from[] = {array->size[0], 0}, count[] = {(hsize_t)rows, array->size[1]};
  const hsize_t size[] = {from[0] + count[0], count[1]};
  if (rows == 0) return true;
  if (H5Dset_extent(array->set, size) < 0) return h5_refuse_by_library();
  const hid_t in_file = H5Dget_space(array->set),
              in_memory = H5Screate_simple(array->rank, count, NULL);
  const bool good = H5Sselect_hyperslab(in_file, H5S_SELECT_SET, from, NULL, count, NULL) >= 0 &&
                    H5Dwrite(array->set, array->type, in_memory, in_file, H5P_DEFAULT, values) >= 0;
  if (good)
    array->size[0] = size[0];
  else
    (void)h5_refuse_by_library();
  (void)H5Sclose(in_file);
  (void)H5Sclose(in_memory);
  return good;
}

void h5_array_close(h5_array *array)
{
  if (array->set > 0) (void)H5Dclose(array->set);
  array->set = 0;
}
