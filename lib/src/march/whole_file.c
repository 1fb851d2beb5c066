#define _XOPEN_SOURCE 700 /* fsync, realpath */
#include "march/whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/memory.h"
#include "core/status.h"

/* Create a new file beside path, with a unique name. The process number in the name excludes other
 * processes, the count other threads. A file that a killed process of the same number has left
 * behind is passed over. Return its descriptor, or -1 with errno. */
static int create_beside(const char *path, size_t size, char *beside)
{
  enum { MOST_NAMES = 1000 };
  static atomic_ulong count;
  for (int i = 0; i < MOST_NAMES; i++) {
    const int length = snprintf(beside, size, "%s.part-%ld-%lu", path, (long)getpid(),
                                atomic_fetch_add(&count, 1));
    if (length < 0 || (size_t)length >= size) {
      errno = ENAMETOOLONG;
      return -1;
    }
    const int descriptor = open(beside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

/* Test for a device or a pipe, which renaming would replace by a file. */
static int is_no_file(const char *path)
{
  struct stat old;
  return stat(path, &old) == 0 && !S_ISREG(old.st_mode);
}

static void take_rights(int descriptor, const char *path)
{
  struct stat old;
  if (stat(path, &old) == 0) (void)fchmod(descriptor, old.st_mode & 07777);
}

/* Write all bytes. Signals may interrupt a write, which is then repeated. */
static int write_all(int descriptor, const unsigned char *bytes, size_t count)
{
  while (count > 0) {
    const ssize_t written = write(descriptor, bytes, count);
    if (written < 0 && errno != EINTR) return -1;
    if (written > 0) bytes += written, count -= (size_t)written;
  }
  return 0;
}

/* Flush and close. Return 0 or the first error number. */
static int flush_and_close(int descriptor)
{
  int reason = fsync(descriptor) != 0 ? errno : 0;
  if (close(descriptor) != 0 && reason == 0) reason = errno;
  return reason;
}

/* Flush the new name to the disk, too, where the file system supports this and the folder can be
 * opened. Return 0 or the error number. */
static int flush_folder(const char *path)
{
  char folder[PATH_MAX + 2];
  const char *slash = strrchr(path, '/');
  (void)snprintf(folder, sizeof folder, "%.*s", slash != NULL ? (int)(slash - path) + 1 : 1,
                 slash != NULL ? path : ".");
  const int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return 0;
  const int reason = fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP ? errno : 0;
  (void)close(descriptor);
  return reason;
}

struct dvi__whole_file {
  int descriptor, reason; /* the first error number, or 0 */
  const char *link;       /* the name of the call, in `text` */
  char path[PATH_MAX], beside[PATH_MAX + 64], text[];
};

static dvi_status open_beside(dvi__whole_file *file)
{
  if (realpath(file->link, file->path) == NULL)
    (void)snprintf(file->path, sizeof file->path, "%s", file->link);
  if (is_no_file(file->path))
    return dvi__fail(DVI_IO_ERROR, "cannot write %s: it is not a regular file", file->link);
  file->descriptor = create_beside(file->path, sizeof file->beside, file->beside);
  if (file->descriptor < 0)
    return dvi__fail(DVI_IO_ERROR, "cannot write a file beside %.256s: %s", file->link,
                     strerror(errno));
  take_rights(file->descriptor, file->path);
  return DVI_OK;
}

dvi_status dvi__whole_begin(const char *path, dvi__whole_file **file)
{
  const size_t size = strlen(path) + 1;
  dvi__whole_file *made = dvi__allocate(sizeof *made + size, 1);
  *file = NULL;
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "%.300s: no memory for the file", path);
  made->link = memcpy(made->text, path, size);
  const dvi_status status = open_beside(made);
  if (status == DVI_OK)
    *file = made;
  else
    dvi__release(made);
  return status;
}

void dvi__whole_put(dvi__whole_file *file, const unsigned char *bytes, size_t count)
{
  if (file->reason == 0 && write_all(file->descriptor, bytes, count) != 0) file->reason = errno;
}

/* Move a file to its place. */
static dvi_status keep(dvi__whole_file *file)
{
  const int closed = flush_and_close(file->descriptor);
  if (file->reason == 0) file->reason = closed;
  if (file->reason == 0 && rename(file->beside, file->path) != 0) file->reason = errno;
  if (file->reason != 0) {
    (void)unlink(file->beside);
    return dvi__fail(DVI_IO_ERROR, "cannot write %s: %s", file->link, strerror(file->reason));
  }
  const int reason = flush_folder(file->path);
  return reason == 0
             ? DVI_OK
             : dvi__fail(DVI_IO_ERROR, "%s is written, but its folder cannot be flushed: %s",
                         file->link, strerror(reason));
}

dvi_status dvi__whole_end(dvi__whole_file **file, dvi_status status)
{
  if (*file == NULL) return status;
  if (status == DVI_OK) {
    status = keep(*file);
  } else {
    (void)close((*file)->descriptor);
    (void)unlink((*file)->beside);
  }
  dvi__release(*file);
  *file = NULL;
  return status;
}

dvi_status dvi__write_whole(const char *path, const unsigned char *bytes, size_t count)
{
  dvi__whole_file *file;
  DVI_TRY(dvi__whole_begin(path, &file));
  dvi__whole_put(file, bytes, count);
  return dvi__whole_end(&file, DVI_OK);
}
