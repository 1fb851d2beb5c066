/* Runs at all points of a grid. */
#include <pthread.h>
#include <stdio.h>

#include "core/status.h"
#include "study/grid.h"
#include "study/point.h"

/* The state of a sweep. The lock guards the members below it. */
typedef struct sweep {
  const dvi_study_sweep_options *options;
  int64_t points, stride;
  pthread_mutex_t lock;
  int64_t next; /* point where the search for one to run goes on */
  dvi_study_sweep_report report;
  dvi_status status;
  char sentence[DVI__SENTENCE_SIZE]; /* of the status, which another thread may have met */
} sweep;

static dvi_status sweep_check(const dvi_study_sweep_options *options)
{
  if (options == NULL || options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "sweep: give options, with size = sizeof(dvi_study_sweep_options)");
  if (options->open == NULL || options->found == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "sweep: open and found are needed");
  if (dvi_study_points(options->axes, options->axis) < 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "sweep: a grid has 1 to %d axes, each with at least one value, and at most "
                     "2^63 - 1 points",
                     (int)DVI_STUDY_AXES_MAX);
  const int64_t parts = options->parts != 0 ? options->parts : 1;
  if (options->part < 0 || options->part >= parts)
    return dvi__fail(DVI_BAD_ARGUMENT, "sweep: part %lld is not from 0 to %lld",
                     (long long)options->part, (long long)parts - 1);
  if (options->threads < 0 || options->threads > DVI_STUDY_THREADS_MAX)
    return dvi__fail(DVI_BAD_ARGUMENT, "sweep: %d threads are not from 1 to %d", options->threads,
                     (int)DVI_STUDY_THREADS_MAX);
  return DVI_OK;
}

static int is_cancelled(const sweep *s)
{
  return s->options->cancel != NULL && *s->options->cancel != 0;
}

/* Go on to the next point that is not left out, in time for the end of the numbers. */
static void sweep_seek(sweep *s)
{
  const char *skip = s->options->skip;
  while (s->next < s->points && skip != NULL && skip[s->next] != 0)
    s->next = s->next < s->points - s->stride ? s->next + s->stride : s->points;
}

/* Return the next point, or -1 if there is none, or none is to be begun. */
static int64_t sweep_take(sweep *s)
{
  int64_t taken = -1;
  (void)pthread_mutex_lock(&s->lock);
  sweep_seek(s);
  if (s->next < s->points && is_cancelled(s)) s->report.cancelled = 1;
  if (s->next < s->points && s->status == DVI_OK && !s->report.cancelled) {
    taken = s->next;
    s->next = taken < s->points - s->stride ? taken + s->stride : s->points;
  }
  (void)pthread_mutex_unlock(&s->lock);
  return taken;
}

/* Keep the first failure of the sweep, with this thread's sentence. */
static void sweep_fail(sweep *s, dvi_status status)
{
  if (s->status != DVI_OK) return;
  s->status = status;
  (void)snprintf(s->sentence, sizeof s->sentence, "%s", dvi_last_error());
}

/* Hand over a row. The caller holds the lock. */
static void sweep_give(sweep *s, const dvi_study_point *at, const dvi__point *point)
{
  if (point->row.report.end == DVI_RUN_CANCELLED) {
    s->report.cancelled = 1;
    return;
  }
  if (s->status != DVI_OK) return;
  s->report.rows++;
  s->report.failed += point->row.status != DVI_OK;
  if (s->options->found(at, &point->run, &point->row, s->options->user) != 0)
    sweep_fail(s, dvi__fail(DVI_CALLBACK_FAILED, "sweep: found refused the row of point %lld",
                            (long long)at->number));
}

static void sweep_work(void *user)
{
  sweep *s = user;
  const dvi_study_sweep_options *options = s->options;
  int64_t index[DVI_STUDY_AXES_MAX];
  double value[DVI_STUDY_AXES_MAX];
  dvi_study_point at = {.index = index, .value = value};
  while ((at.number = sweep_take(s)) >= 0) {
    dvi__point point;
    dvi__grid_at(options->axes, options->axis, at.number, index, value);
    const dvi_status status = dvi__point_run(options, &at, &point);
    (void)pthread_mutex_lock(&s->lock);
    if (status == DVI_OK)
      sweep_give(s, &at, &point);
    else
      sweep_fail(s, status);
    (void)pthread_mutex_unlock(&s->lock);
    dvi__point_close(options, &point);
  }
}

dvi_status dvi_study_sweep(const dvi_study_sweep_options *options, dvi_study_sweep_report *report)
{
  if (report != NULL) *report = (dvi_study_sweep_report){.rows = 0};
  DVI_TRY(sweep_check(options));
  sweep s = {.options = options,
             .points = dvi_study_points(options->axes, options->axis),
             .stride = options->parts != 0 ? options->parts : 1,
             .next = options->part};
  (void)pthread_mutex_init(&s.lock, NULL);
  dvi_study_parallel(options->threads != 0 ? options->threads : 1, sweep_work, &s);
  (void)pthread_mutex_destroy(&s.lock);
  if (report != NULL) *report = s.report;
  return s.status == DVI_OK ? DVI_OK : dvi__fail(s.status, "%s", s.sentence);
}
