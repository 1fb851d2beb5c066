#include "mechanics/march.h"

#include <math.h>
#include <stdbool.h>

enum { PROGRESS_STEPS = 256, SPAN_TRIES = 8, SPAN_STEPS_MAX = 1 << 20 };
static const double shorter = 0.25; /* factor of the step in the next try to measure a span */

/* The state of a march, for dvi_run. */
typedef struct marcher {
  march_look look;
  void *user;
  progress_line *progress;
  const char *words;
  long steps;
} marcher;

static void march_show_progress(marcher *m)
{
  if (m->progress != NULL && m->steps++ % PROGRESS_STEPS == 0)
    progress_show(m->progress, -1.0, m->words);
}

static int march_after_step(dvi_integrator *integrator, void *user)
{
  marcher *m = user;
  march_show_progress(m);
  return m->look != NULL ? m->look(integrator, m->user) : 0;
}

/* Tell whether nothing happens between the steps, and they have one length in time. */
static bool march_is_plain(const dvi_integrator *integrator, march_look look,
                           const progress_line *progress)
{
  return look == NULL && progress == NULL && dvi_integrator_monitor(integrator) == NULL;
}

dvi_status march(dvi_integrator *integrator, double h, long steps, double t_end, march_look look,
                 void *user, progress_line *progress, const char *words)
{
  marcher m = {.look = look, .user = user, .progress = progress, .words = words};
  if (dvi_integrator_chooses_steps(integrator))
    return dvi_run(
        integrator,
        &(dvi_run_options){.h = h, .t_end = t_end, .observe = march_after_step, .user = &m}, NULL);
  if (march_is_plain(integrator, look, progress))
    return dvi_run(integrator, &(dvi_run_options){.h = h, .t_end = t_end}, NULL);
  dvi_status status = DVI_OK;
  for (long i = 0; i < steps && status == DVI_OK; i++) {
    march_show_progress(&m);
    status = dvi_integrator_step(integrator, h);
    if (status == DVI_OK && look != NULL && look(integrator, user) != 0) return DVI_CALLBACK_FAILED;
  }
  return status;
}

/* Count the steps. A run with a step that is too long where the monitor is large may get stuck
 * where the monitor is almost 0. */
static int march_count(dvi_integrator *integrator, void *user)
{
  long *steps = user;
  (void)integrator;
  return (*steps)++ > SPAN_STEPS_MAX;
}

dvi_status march_span(dvi_integrator *integrator, const double *q, const double *p, double h,
                      double t_end, double *span)
{
  dvi_status status = DVI_OK;
  *span = t_end;
  if (dvi_integrator_monitor(integrator) == NULL) return DVI_OK;
  h = copysign(h, t_end);
  for (int i = 0; i < SPAN_TRIES; i++, h *= shorter) {
    dvi_run_report report = {0};
    long steps = 0;
    status = dvi_integrator_start(integrator, 0.0, q, p);
    if (status == DVI_OK)
      status = dvi_run(
          integrator,
          &(dvi_run_options){.h = h, .t_end = t_end, .observe = march_count, .user = &steps},
          &report);
    if (status <= 0) {
      *span = report.end == DVI_RUN_COMPLETE ? h * (double)report.steps : (double)NAN;
      return status;
    }
  }
  return status;
}
