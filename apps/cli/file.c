#define _XOPEN_SOURCE 700
#include "cli/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/command.h"

enum { LINK_SIZE = 4096, LINKS_MAX = 40, UNFINISHED_MAX = 4 };

/* Names of the existing temporary files, which a signal handler removes. A command writes only a
 * few files at a time. A name stands here from before its file is made until after the file is
 * gone. */
static _Atomic(const char *) unfinished[UNFINISHED_MAX];

/* Replace a name by the name `by`. Either may be NULL for no name. */
static void replace_unfinished(const char *name, const char *by)
{
  int k = 0;
  while (k < UNFINISHED_MAX && unfinished[k] != name) k++;
  if (k < UNFINISHED_MAX) unfinished[k] = by;
}

static bool refuse_to_write(const char *path)
{
  complain("cannot write '%s': %s", path, errno != 0 ? strerror(errno) : "an earlier write failed");
  return false;
}

static char *join_path(const char *head, size_t head_length, const char *tail)
{
  const size_t tail_length = strlen(tail);
  char *text = malloc(head_length + tail_length + 1);
  if (text != NULL) {
    memcpy(text, head, head_length);
    memcpy(text + head_length, tail, tail_length + 1);
  }
  return text;
}

static char *folder_of(const char *path)
{
  const char *slash = strrchr(path, '/');
  if (slash == NULL) return join_path(".", 1, "");
  return join_path(path, slash == path ? 1 : (size_t)(slash - path), "");
}

/* Return the target of the link at a path, as a path from here. Without a link NULL, and errno is
 * EINVAL or ENOENT. */
static char *follow_link(const char *path)
{
  char target[LINK_SIZE];
  const ssize_t length = readlink(path, target, sizeof target - 1);
  if (length < 0) return NULL;
  target[length] = '\0';
  const char *slash = strrchr(path, '/');
  return target[0] == '/' || slash == NULL ? join_path("", 0, target)
                                           : join_path(path, (size_t)(slash - path) + 1, target);
}

/* Return the file that a path leads to, even if the file does not exist. A rename must replace the
 * file, not a link to the file. */
static char *resolve_path(const char *path)
{
  char *at = realpath(path, NULL);
  if (at != NULL) return at;
  at = join_path("", 0, path);
  for (int i = 0; i < LINKS_MAX && at != NULL; i++) {
    char *next = follow_link(at);
    if (next == NULL) return at;
    free(at);
    at = next;
  }
  free(at);
  errno = ELOOP;
  return NULL;
}

/* Create a new file beside path, with the rights that the old file has or a new one would get. */
static bool open_temporary(whole_file *file, const struct stat *old)
{
  char tail[48];
  (void)snprintf(tail, sizeof tail, ".part-%ld", (long)getpid());
  file->temporary = join_path(file->path, strlen(file->path), tail);
  if (file->temporary == NULL) return false;
  replace_unfinished(NULL, file->temporary);
  (void)unlink(file->temporary); /* left over from a killed process of the same number */
  const int descriptor = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) return false;
  if (old != NULL) (void)fchmod(descriptor, old->st_mode & 07777);
  file->stream = fdopen(descriptor, "w");
  if (file->stream == NULL) (void)close(descriptor);
  return file->stream != NULL;
}

static bool open_path(whole_file *file)
{
  struct stat old;
  const bool exists = stat(file->path, &old) == 0;
  if (!exists && errno != ENOENT) return false;
  if (!exists || S_ISREG(old.st_mode)) {
    if (exists && access(file->path, W_OK) != 0) return false;
    return open_temporary(file, exists ? &old : NULL);
  }
  file->stream = fopen(file->path, "w");
  return file->stream != NULL;
}

bool file_open(whole_file *file, const char *path)
{
  memset(file, 0, sizeof *file);
  if (strcmp(path, "-") == 0) {
    file->stream = stdout;
    return true;
  }
  errno = 0;
  file->path = resolve_path(path);
  if (file->path != NULL && open_path(file)) return true;
  (void)refuse_to_write(path);
  file_discard(file);
  return false;
}

static bool same_inode(const struct stat *a, const struct stat *b)
{
  return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

static const char *name_in_folder(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash != NULL ? slash + 1 : path;
}

/* Compare two files that do not exist yet. They are the same if their folders and their names
 * are. */
static bool same_new_file(const char *path, const char *other)
{
  struct stat a;
  struct stat b;
  char *folders[] = {folder_of(path), folder_of(other)};
  const bool same = folders[0] != NULL && folders[1] != NULL && stat(folders[0], &a) == 0 &&
                    stat(folders[1], &b) == 0 && same_inode(&a, &b) &&
                    strcmp(name_in_folder(path), name_in_folder(other)) == 0;
  free(folders[0]);
  free(folders[1]);
  return same;
}

bool file_same(const char *path, const char *other)
{
  struct stat a;
  struct stat b;
  const bool there = stat(path, &a) == 0;
  if (there != (stat(other, &b) == 0)) return false;
  if (there) return same_inode(&a, &b);
  char *real[] = {resolve_path(path), resolve_path(other)};
  const bool same = real[0] != NULL && real[1] != NULL && same_new_file(real[0], real[1]);
  free(real[0]);
  free(real[1]);
  return same;
}

/* Sync the folder of a renamed file, because a rename is on disk only when its folder is. Some file
 * systems cannot sync folders. The content is safe all the same. */
static void sync_folder(const char *path)
{
  char *folder = folder_of(path);
  if (folder == NULL) return;
  const int descriptor = open(folder, O_RDONLY | O_CLOEXEC);
  if (descriptor >= 0) {
    (void)fsync(descriptor);
    (void)close(descriptor);
  }
  free(folder);
}

static bool close_stream(whole_file *file)
{
  errno = 0;
  bool good = fflush(file->stream) == 0 && !ferror(file->stream);
  if (good && file->temporary != NULL) good = fsync(fileno(file->stream)) == 0;
  const int reason = errno;
  if (fclose(file->stream) != 0 && good)
    good = false;
  else if (reason != 0)
    errno = reason;
  file->stream = NULL;
  return good;
}

bool file_keep(whole_file *file)
{
  if (file->path == NULL) {
    file->stream = NULL;
    return output_flushed();
  }
  bool good = close_stream(file);
  if (good && file->temporary != NULL) {
    good = rename(file->temporary, file->path) == 0;
    if (good) {
      replace_unfinished(file->temporary, NULL);
      free(file->temporary);
      file->temporary = NULL;
      sync_folder(file->path);
    }
  }
  if (!good) (void)refuse_to_write(file->path);
  file_discard(file);
  return good;
}

void file_discard(whole_file *file)
{
  if (file->stream != NULL && file->path != NULL) (void)fclose(file->stream);
  if (file->temporary != NULL) {
    (void)unlink(file->temporary);
    replace_unfinished(file->temporary, NULL);
  }
  free(file->temporary);
  free(file->path);
  memset(file, 0, sizeof *file);
}

void file_remove_unfinished(void)
{
  for (int k = 0; k < UNFINISHED_MAX; k++) {
    const char *temporary = unfinished[k];
    if (temporary != NULL) (void)unlink(temporary);
  }
}

bool file_writable(const char *path)
{
  if (strcmp(path, "-") == 0) return true;
  struct stat old;
  const bool exists = stat(path, &old) == 0;
  errno = exists && S_ISDIR(old.st_mode) ? EISDIR : 0;
  bool good = errno == 0 && (!exists || access(path, W_OK) == 0);
  if (good && (!exists || S_ISREG(old.st_mode))) {
    char *real = resolve_path(path);
    char *folder = real != NULL ? folder_of(real) : NULL;
    good = folder != NULL && access(folder, W_OK | X_OK) == 0;
    free(folder);
    free(real);
  }
  return good || refuse_to_write(path);
}
