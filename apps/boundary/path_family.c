#include "boundary/path_family.h"

#include <stdio.h>
#include <stdlib.h>

#include "boundary/path_ends.h"
#include "cli/command.h"
#include "csv/points.h"
#include "load/open.h"

enum { VALUES_MOST = 10000, SETTING_SIZE = 128 };

/* ---- members ---- */

/* Create the problem with its settings, and its path with a guess. */
static int member_create(const char *name, const path_request *request, const words *settings,
                         member *m)
{
  points guess = {0};
  path_request own = *request;
  int code = open_problem(name, settings, &m->scene);
  if (code == DONE) code = open_wish("path", m->scene, &own.method);
  if (code == DONE) code = refuse_march(m->scene, own.method);
  if (code == DONE && m->scene->terms->factors != NULL)
    code = usage_error("path: %s has factors, and paths are found between ends in R^n; dvi run "
                       "goes forward from its start",
                       name);
  if (code == DONE && request->guess != NULL) code = points_read(request->guess, m->scene, &guess);
  if (code == DONE) code = path_open(&own, m->scene, &guess, &m->path);
  points_clear(&guess);
  return code;
}

void member_destroy(member *m)
{
  dvi_path_destroy(&m->path);
  problem_destroy(&m->scene);
}

/* ---- families ---- */

int read_family(const path_request *request, family *f)
{
  const char *text = request->follow;
  char first[NAME_SIZE], last[NAME_SIZE], count[NAME_SIZE], rest[2];
  char *end = NULL;
  if (text == NULL) return DONE;
  if (request->settings.count == WORDS_MAX)
    return usage_error("path: --set is given too often for --continue");
  const int fields = sscanf(text, "%63[^=]=%63[^:]:%63[^:]:%63[0-9]%1s", f->name, first, last,
                            count, rest);
  if (fields == 4) f->parts = strtol(count, &end, 10);
  if (fields != 4 || !parse_number(first, &f->first) || !parse_number(last, &f->last) ||
      f->parts < 1 || f->parts > VALUES_MOST)
    return usage_error("path: --continue wants NAME=FROM:TO:PARTS with 1 to %d parts, not '%s'",
                       (int)VALUES_MOST, text);
  return DONE;
}

static int member_solve(member *m)
{
  const dvi_status status = dvi_path_solve(m->path, &m->report);
  m->found = status == DVI_OK || status == DVI_STEP_TOO_LARGE;
  return status == DVI_OK ? DONE : library_error(status);
}

/* Solve member k of the family, with a guess along the two members before it. */
static int member_follow(const char *name, const path_request *request, const family *f, long k,
                         const member *last, const member *before, member *next)
{
  char setting[SETTING_SIZE];
  words settings = request->settings;
  if (f->parts > 0) {
    (void)snprintf(setting, sizeof setting, "%s=%.17g", f->name,
                   f->first + (f->last - f->first) * ((double)k / (double)f->parts));
    settings.word[settings.count++] = setting;
  }
  int code = member_create(name, request, &settings, next);
  if (code == DONE && last->path != NULL) {
    const dvi_status status = dvi_path_guess_along(next->path, last->path, before->path, 1.0);
    code = status == DVI_OK ? DONE : library_error(status);
  }
  if (code == DONE) code = member_solve(next);
  if (code != DONE && f->parts > 0) complain("path: this was at %s", setting);
  return code;
}

int solve_family(const char *name, const path_request *request, const family *f, member *last)
{
  member before = {0};
  int code = DONE;
  long k = 0;
  do {
    member next = {0};
    code = member_follow(name, request, f, k, last, &before, &next);
    member_destroy(&before);
    before = *last;
    *last = next;
  } while (code == DONE && ++k <= f->parts);
  member_destroy(&before);
  return code;
}
