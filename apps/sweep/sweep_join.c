#define _POSIX_C_SOURCE 200809L
#include "sweep/sweep_join.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"

/* The state of a join. */
typedef struct join {
  const sweep_key *key;
  long points;
  sweep_row *row;
  long parts;        /* number of parts, 0 before the first file */
  const char **path; /* [parts] file of each part, NULL if there was none yet */
} join;

static bool refuse_difference(const char *path, sweep_difference difference)
{
  switch (difference) {
  case SWEEP_NO_HEAD: complain("sweep: '%s' is no part of a sweep", path); break;
  case SWEEP_OTHER_VERSION:
    complain("sweep: '%s' was made by another version of dvi than this one, %s", path,
             dvi_version());
    break;
  case SWEEP_OTHER_SCENE:
    complain("sweep: '%s' is a part of a sweep of another scene", path);
    break;
  case SWEEP_OTHER_RUN:
    complain("sweep: '%s' is a part of a sweep with another --method, --h or --t-end", path);
    break;
  default: complain("sweep: '%s' is a part of a sweep over other values", path); break;
  }
  return false;
}

/* Note whose file this is. The first one tells how many parts there are. */
static bool take_part(join *j, const char *path, const study_part *part)
{
  if (j->parts == 0) {
    j->path = calloc((size_t)part->parts, sizeof *j->path);
    if (j->path == NULL) {
      complain("out of memory");
      return false;
    }
    j->parts = part->parts;
  }
  if (part->parts != j->parts)
    complain("sweep: '%s' is one of %ld parts, but the files before it are of %ld", path,
             part->parts, j->parts);
  else if (j->path[part->part] != NULL)
    complain("sweep: part %ld/%ld is there twice, '%s' and '%s'", part->part + 1, part->parts,
             j->path[part->part], path);
  else
    j->path[part->part] = path;
  return part->parts == j->parts && j->path[part->part] == path;
}

static bool read_rows(const join *j, FILE *stream, const char *head, const char *path,
                      const study_part *part)
{
  long size, there = 0;
  if (!sweep_read_lines(stream, head, part, j->points, j->row, &size)) {
    complain("out of memory");
    return false;
  }
  for (long k = part->part; k < j->points; k += part->parts) there += j->row[k].text != NULL;
  if (there == study_part_size(part, j->points) && getc(stream) == EOF) return true;
  complain("sweep: '%s' has %ld of its %ld points: it is unfinished, cut short or damaged; the "
           "command of part %ld/%ld goes on from there",
           path, there, study_part_size(part, j->points), part->part + 1, part->parts);
  return false;
}

static bool join_file(join *j, const char *path)
{
  char head[SWEEP_HEAD_SIZE] = "";
  study_part found = {.part = 0};
  FILE *stream = fopen(path, "r");
  if (stream == NULL) {
    complain("cannot read '%s': %s", path, strerror(errno));
    return false;
  }
  (void)fgets(head, sizeof head, stream);
  const sweep_difference difference = sweep_compare(head, j->key, &found);
  const bool good = difference == SWEEP_SAME
                        ? take_part(j, path, &found) && read_rows(j, stream, head, path, &found)
                        : refuse_difference(path, difference);
  (void)fclose(stream);
  return good;
}

static bool refuse_missing(const join *j)
{
  long missing = 0, first = 0;
  for (long k = j->parts - 1; k >= 0; k--) {
    if (j->path[k] != NULL) continue;
    missing++;
    first = k;
  }
  if (missing > 0)
    complain("sweep: %ld of %ld parts are missing, the first one is %ld/%ld", missing, j->parts,
             first + 1, j->parts);
  return missing == 0;
}

bool sweep_join(const sweep_key *key, const word_list *files, long points, sweep_row *row)
{
  join j = {.key = key, .points = points, .row = row};
  bool good = true;
  for (int i = 0; i < files->count && good; i++) good = join_file(&j, files->word[i]);
  good = good && refuse_missing(&j);
  free(j.path);
  return good;
}
