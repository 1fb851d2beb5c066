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

/* Write, flush and close. Return 0 or the first error number. */
static int write_and_close(int descriptor, const unsigned char *bytes, size_t count)
{
  int reason = write_all(descriptor, bytes, count) != 0 || fsync(descriptor) != 0 ? errno : 0;
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

dvi_status dvi__write_whole(const char *link, const unsigned char *bytes, size_t count)
{
  char beside[PATH_MAX + 64], real[PATH_MAX];
  const char *path = realpath(link, real) != NULL ? real : link;
  if (is_no_file(path))
    return dvi__fail(DVI_IO_ERROR, "cannot write %s: it is not a regular file", link);
  const int descriptor = create_beside(path, sizeof beside, beside);
  if (descriptor < 0)
    return dvi__fail(DVI_IO_ERROR, "cannot write a file beside %.256s: %s", link, strerror(errno));
  take_rights(descriptor, path);
  int reason = write_and_close(descriptor, bytes, count);
  if (reason == 0 && rename(beside, path) != 0) reason = errno;
  if (reason != 0) {
    (void)unlink(beside);
    return dvi__fail(DVI_IO_ERROR, "cannot write %s: %s", link, strerror(reason));
  }
  reason = flush_folder(path);
  return reason == 0
             ? DVI_OK
             : dvi__fail(DVI_IO_ERROR, "%s is written, but its folder cannot be flushed: %s", link,
                         strerror(reason));
}
