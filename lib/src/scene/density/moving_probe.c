/* Probes of a field on a mesh that moves: functions of the field, its slopes and its rate at
 * points, and their integrals over the cells. */
#include "scene/density/moving.h"
#include "text/heap.h"

bool dvi__moving_check_probe(dvi_scene *scene, const dvi__local *function, const double *x,
                             const char *name, dvi__span span)
{
  for (int k = 0; k < function->variables; k++) {
    const dvi_jet *jet = function->variable + k;
    if (jet->order[0] + jet->order[1] + (jet->rate != 0) > 1)
      return dvi__scene_refuse(
          scene, span,
          "on a mesh that moves a probe has fields, their rates and their first "
          "derivatives in space, and '%s' has others",
          name);
    if (jet->rate && scene->density->is_static)
      return dvi__scene_refuse(scene, span, "nothing moves here, and '%s' has a rate", name);
  }
  double u[DVI_MOVING_COMPONENTS_MAX];
  const dvi_status status = x == NULL ? DVI_OK
                                      : dvi_moving_evaluate(scene->density->moving->made, 0,
                                                            scene->q, 0, 1, x, u);
  return status == DVI_OK || dvi__complain(scene->complaint, status, span, "the probe '%s': %s",
                                           name, dvi_last_error());
}

/* A function without variables and terms is 0. */
static int zero(int count, double t, const double *x, const double *z, double *l, double *l_z,
                double *l_zz, void *user)
{
  (void)t, (void)x, (void)z, (void)l_z, (void)l_zz, (void)user;
  for (int k = 0; k < count; k++) l[k] = 0;
  return 0;
}

int dvi__moving_value(const dvi_scene *scene, const dvi__local *function, bool has_rates, double t,
                      const double *q, const double *p, const double *x, double *value)
{
  const dvi_moving *moving = scene->density->moving->made;
  const dvi_density_part part = {.variable = function->variable,
                                 .variables = function->variables,
                                 .density = function->term != NULL ? dvi__local_density : zero,
                                 .user = (void *)function};
  double *v = NULL;
  dvi_status status = has_rates ? dvi__density_velocity(scene, t, q, p, &v) : DVI_OK;
  if (status == DVI_OK) status = dvi_moving_measure(moving, t, q, v, &part, x, value);
  dvi__heap_free(v);
  return (int)status;
}
