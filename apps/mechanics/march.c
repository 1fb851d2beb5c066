#include "mechanics/march.h"

#include <math.h>

enum { PROGRESS_STEPS = 256, SPAN_TRIES = 8, SPAN_STEPS_MAX = 1 << 20 };
static const double shorter = 0.25; /* steps of the next try to measure a span */

/* A march under way, for dvi_run. */
typedef struct marcher {
  march_look look;
  void *user;
  progress_line *progress;
  const char *words;
  long steps;
} marcher;

static void show(marcher *m)
{
  if (m->progress != NULL && m->steps++ % PROGRESS_STEPS == 0)
    progress_show(m->progress, -1.0, m->words);
}

static int observe(dvi_integrator *integrator, void *user)
{
  marcher *m = user;
  show(m);
  return m->look != NULL ? m->look(integrator, m->user) : 0;
}

dvi_status march(dvi_integrator *integrator, double h, long steps, double t_end, march_look look,
                 void *user, progress_line *progress, const char *words)
{
  marcher m = {look, user, progress, words, 0};
  if (dvi_integrator_chooses_steps(integrator))
    return dvi_run(integrator,
                   &(dvi_run_options){.h = h, .t_end = t_end, .observe = observe, .user = &m},
                   NULL);
  dvi_status status = DVI_OK;
  for (long i = 0; i < steps && status == DVI_OK; i++) {
    show(&m);
    status = dvi_integrator_step(integrator, h);
    if (status == DVI_OK && look != NULL && look(integrator, user) != 0) return DVI_CALLBACK_FAILED;
  }
  return status;
}

/* One that leaps where its monitor is large may end up where it is next to nothing. */
static int count(dvi_integrator *integrator, void *user)
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
      status = dvi_run(integrator,
                       &(dvi_run_options){.h = h, .t_end = t_end, .observe = count, .user = &steps},
                       &report);
    if (status <= 0) {
      *span = report.end == DVI_RUN_COMPLETE ? h * (double)report.steps : (double)NAN;
      return status;
    }
  }
  return status;
}
