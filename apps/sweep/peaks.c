#define _POSIX_C_SOURCE 200809L
#include "sweep/peaks.h"

#include <dvi/study.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/command.h"
#include "sweep/peak_refinement.h"
#include "cli/progress.h"

enum { LINE_SIZE = 64 };

static const double floor_of_errors = 1e-12;

/* The state of a search. The lock guards the members below it. */
typedef struct round_of_runs {
  const resonance_task *task;
  peaks_found *found;
  pthread_mutex_t lock;
  int next; /* first point that is still to be run */
  progress_line progress;
} round_of_runs;

double peaks_height(const resonance_point *point)
{
  /* fmax of a NaN and the floor is the floor */
  return log10(fmin(fmax(point->error, floor_of_errors), RESONANCE_LIMIT));
}

/* ---- runs ---- */

static int peaks_take_point(round_of_runs *r)
{
  char line[LINE_SIZE];
  (void)pthread_mutex_lock(&r->lock);
  const int k = r->next < r->found->count ? r->next++ : -1;
  (void)snprintf(line, sizeof line, "dvi resonance: %d of %d points so far", r->next,
                 r->found->count);
  progress_show(&r->progress, -1.0, line);
  (void)pthread_mutex_unlock(&r->lock);
  return k;
}

static void peaks_work(void *user)
{
  round_of_runs *r = user;
  for (int k = peaks_take_point(r); k >= 0; k = peaks_take_point(r))
    resonance_run(r->task, &r->found->point[k]);
}

static int compare_value(const void *left, const void *right)
{
  const double a = ((const resonance_point *)left)->value,
               b = ((const resonance_point *)right)->value;
  return (a > b) - (a < b);
}

static void run_new_points(round_of_runs *r, long threads)
{
  const long left = r->found->count - r->next;
  dvi_study_parallel((int)(threads < left ? threads : left), peaks_work, r);
  qsort(r->found->point, (size_t)r->found->count, sizeof *r->found->point, compare_value);
}

/* ---- points ---- */

static void add_point(peaks_found *found, double value)
{
  found->point[found->count++] = (resonance_point){.value = value};
}

/* Add the points of the grid, for which x [grid] is memory. */
static void add_grid(const peaks_search *search, peaks_found *found, double *x)
{
  (void)dvi_study_range(search->from, search->to, search->grid, x);
  for (long k = 0; k < search->grid; k++) add_point(found, x[k]);
}

/* Add the middles of the marked gaps. Returns false if there is room for only some of them. */
static bool add_middles(const peaks_search *search, peaks_found *found, double *x, bool *halve)
{
  const int count = found->count;
  double *y = x + search->most;
  for (int i = 0; i < count; i++) {
    x[i] = found->point[i].value;
    y[i] = peaks_height(&found->point[i]);
  }
  const int wanted = peak_gaps(count, x, y, search->width, found->top, halve);
  for (int i = 0; i + 1 < count && found->count < search->most; i++)
    if (halve[i]) add_point(found, 0.5 * x[i] + 0.5 * x[i + 1]);
  return found->count == count + wanted;
}

static void peaks_run_rounds(round_of_runs *r, const peaks_search *search, double *x, bool *halve)
{
  progress_start(&r->progress, true);
  add_grid(search, r->found, x);
  while (r->next < r->found->count) {
    run_new_points(r, search->threads);
    r->found->complete = add_middles(search, r->found, x, halve);
  }
  progress_end(&r->progress);
}

bool peaks_find(const resonance_task *task, const peaks_search *search, peaks_found *found)
{
  const size_t most = (size_t)search->most;
  *found = (peaks_found){.point = calloc(most, sizeof *found->point),
                         .top = calloc(most, sizeof *found->top)};
  round_of_runs r = {.task = task, .found = found};
  double *x = calloc(2 * most, sizeof *x);
  bool *halve = calloc(most, sizeof *halve);
  const bool good = found->point != NULL && found->top != NULL && x != NULL && halve != NULL;
  (void)pthread_mutex_init(&r.lock, NULL);
  if (good)
    peaks_run_rounds(&r, search, x, halve);
  else
    complain("out of memory");
  (void)pthread_mutex_destroy(&r.lock);
  free(x);
  free(halve);
  return good;
}

void peaks_clear(peaks_found *found)
{
  free(found->point);
  free(found->top);
  *found = (peaks_found){.count = 0};
}
