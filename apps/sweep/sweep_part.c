#define _POSIX_C_SOURCE 200809L
#include "sweep/sweep_part.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"

enum { TAIL_SIZE = 64 };

static bool refuse_part(const sweep_part *part)
{
  complain("cannot write '%s': %s", part->path, strerror(errno));
  return false;
}

/* Lock the file, because two processes would write the same rows. */
static bool part_lock(const sweep_part *part)
{
  struct flock all = {.l_type = (short)F_WRLCK, .l_whence = (short)SEEK_SET};
  if (fcntl(fileno(part->stream), F_SETLK, &all) == 0 || (errno != EACCES && errno != EAGAIN))
    return true;
  complain("sweep: another process writes '%s'; wait for it, or give another --out", part->path);
  return false;
}

/* Read the rows up to the first line that is not complete, and cut off the rest. */
static bool part_read_rows(sweep_part *part, const sweep_key *key, long points, sweep_row *row)
{
  long size;
  if (!sweep_read_lines(part->stream, part->head, &key->part, points, row, &size)) {
    complain("out of memory");
    return false;
  }
  const long good = (long)strlen(part->head) + size;
  if (fseek(part->stream, good, SEEK_SET) == 0 && ftruncate(fileno(part->stream), (off_t)good) == 0)
    return true;
  return refuse_part(part);
}

static bool part_read(sweep_part *part, const sweep_key *key, long points, sweep_row *row)
{
  char found[SWEEP_HEAD_SIZE] = "";
  sweep_head(key, part->head);
  const bool has_line = fgets(found, sizeof found, part->stream) != NULL;
  /* an earlier sweep may have ended within the head, too */
  if (!has_line || (strchr(found, '\n') == NULL && strstr(part->head, found) == part->head)) {
    if (fseek(part->stream, 0, SEEK_SET) == 0 && fputs(part->head, part->stream) >= 0 &&
        fflush(part->stream) == 0)
      return true;
    return refuse_part(part);
  }
  if (strcmp(found, part->head) == 0) return part_read_rows(part, key, points, row);
  complain("sweep: '%s' was begun with another scene or other settings; remove it, or give another "
           "--out",
           part->path);
  return false;
}

static char *spell_path(const char *out, const study_part *part)
{
  const size_t size = strlen(out) + TAIL_SIZE;
  char *path = malloc(size);
  if (path == NULL)
    complain("out of memory");
  else if (!part->given)
    (void)snprintf(path, size, "%s.part", out);
  else
    (void)snprintf(path, size, "%s.%ld-of-%ld", out, part->part + 1, part->parts);
  return path;
}

bool sweep_part_open(sweep_part *part, const char *out, const sweep_key *key, long points,
                     sweep_row *row)
{
  *part = (sweep_part){.path = spell_path(out, &key->part)};
  if (part->path == NULL) return false;
  const int descriptor = open(part->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) return refuse_part(part);
  part->stream = fdopen(descriptor, "r+");
  if (part->stream != NULL) return part_lock(part) && part_read(part, key, points, row);
  (void)close(descriptor);
  return refuse_part(part);
}

bool sweep_part_add(sweep_part *part, long k, const sweep_row *row)
{
  errno = 0;
  sweep_write_line(part->stream, part->head, k, row);
  return (fflush(part->stream) == 0 && !ferror(part->stream)) || refuse_part(part);
}

void sweep_part_close(sweep_part *part, bool elsewhere)
{
  if (elsewhere) (void)unlink(part->path);
  if (part->stream != NULL) (void)fclose(part->stream);
  free(part->path);
  *part = (sweep_part){.path = NULL};
}
