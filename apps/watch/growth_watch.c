#include "watch/growth_watch.h"

#include <math.h>

#include "cli/command.h"
#include "watch/energy_watch.h"

enum { FIRST_STEP = 4 };

static const double step_factor = 1.5, look_factor = 1e3, alarming = 1e6;

static double sum_of_sizes(const growth_watch *w)
{
  const double *p = dvi_integrator_p(w->integrator);
  double sum = 0.0;
  for (int i = 0; i < w->scene->nv; i++) sum += fabs(p[i]);
  return sum;
}

void growth_watch_start(growth_watch *w, const problem *scene, dvi_integrator *integrator)
{
  *w = (growth_watch){.scene = scene, .integrator = integrator, .factor = 1.0};
  w->is_on = !dvi_system_autonomous(scene->system) && scene->terms->noise == NULL;
}

void growth_watch_step(growth_watch *w)
{
  w->steps++;
  if (!w->is_on || w->steps < FIRST_STEP || !energy_look_due(w->steps)) return;
  const double size = sum_of_sizes(w),
               least = w->steps <= ENERGY_EVERY_STEP ? step_factor : look_factor,
               factor = w->last > 0.0 ? size / w->last : 1.0;
  const bool grows = factor > least && isfinite(factor);
  if (!grows) w->from = dvi_integrator_time(w->integrator);
  w->factor = grows ? w->factor * factor : 1.0;
  w->last = size;
  if (!(w->factor >= alarming) || w->passed > 0.0) return;
  w->passed = w->factor;
  w->passed_at = dvi_integrator_time(w->integrator);
}

void growth_watch_tell(const growth_watch *w, const char *method, double h)
{
  if (!(w->passed > 0.0)) return;
  complain("run: the momenta of %s with --h %g grew by a factor of %.3g from t = %g to t = %g, as "
           "those of an unstable step do",
           method, h, w->passed, w->from, w->passed_at);
  complain("run: try a smaller --h, or an implicit method such as midpoint; --verify tells how "
           "many digits are right");
}
