/* Probes of a field on a mesh that moves: functions of the field and its slope at points, and their
 * integrals over the cells, by Gauss's rule. */
#include <dvi/quadrature.h>

#include "scene/density/moving.h"
#include "text/heap.h"

enum { POINTS = 8 };

bool dvi__moving_check_probe(dvi_scene *scene, const dvi__local *function, const char *name,
                             dvi__span span)
{
  for (int k = 0; k < function->variables; k++)
    if (function->variable[k].rate || function->variable[k].order[0] > 1)
      return dvi__scene_refuse(scene, span,
                               "on a mesh that moves a probe has fields and their first "
                               "derivatives in space, and '%s' has others",
                               name);
  return true;
}

/* Tell if a function has slopes (order 1) or values (0) among its variables. */
static bool has_order(const dvi__local *function, int order)
{
  for (int k = 0; k < function->variables; k++)
    if (function->variable[k].order[0] == order) return true;
  return false;
}

/* Evaluate at points [count] that are in their cells. */
static int evaluate(const dvi_scene *scene, const dvi__local *function, double t, const double *q,
                    int64_t count, const double *x, double *f)
{
  const dvi_moving *moving = scene->density->moving->made;
  const int components = scene->density->jets.components;
  const size_t values = (size_t)(components * count);
  double *u = dvi__heap_take(2 * values + (size_t)(function->variables * count) + 1, sizeof *u);
  if (u == NULL) return DVI_NO_MEMORY;
  double *const slope = u + values, *const z = slope + values;
  dvi_status status = DVI_OK;
  if (has_order(function, 0)) status = dvi_moving_evaluate(moving, t, q, 0, count, x, u);
  if (status == DVI_OK && has_order(function, 1))
    status = dvi_moving_evaluate(moving, t, q, 1, count, x, slope);
  for (int k = 0; k < function->variables; k++) {
    const dvi_jet *jet = function->variable + k;
    const double *of = (jet->order[0] > 0 ? slope : u) + jet->component * count;
    for (int64_t i = 0; i < count; i++) z[k * count + i] = of[i];
  }
  int failed = (int)status;
  for (int64_t i = 0; i < count; i++) f[i] = 0;
  if (failed == 0 && function->term != NULL)
    failed = dvi__local_density((int)count, t, x, z, f, NULL, NULL, (void *)function);
  dvi__heap_free(u);
  return failed;
}

int dvi__moving_value(const dvi_scene *scene, const dvi__local *function, double t, const double *q,
                      double x, double *value)
{
  return evaluate(scene, function, t, q, 1, &x, value);
}

/* Sum over the cells between nodes [cells+1], at points [cells*POINTS]. */
static int sum(const dvi_scene *scene, const dvi__local *function, double t, const double *q,
               int cells, const double *node, double *x, double *f, double *value)
{
  double at[POINTS], weight[POINTS];
  dvi_status status = dvi_quadrature(DVI_GAUSS, POINTS, at, weight);
  for (int i = 0; i < cells * POINTS; i++) {
    const int cell = i / POINTS;
    x[i] = node[cell] + at[i % POINTS] * (node[cell + 1] - node[cell]);
  }
  const int failed = status != DVI_OK ? (int)status
                                      : evaluate(scene, function, t, q, cells * POINTS, x, f);
  *value = 0;
  for (int i = 0; i < cells * POINTS && failed == 0; i++) {
    const int cell = i / POINTS;
    *value += weight[i % POINTS] * (node[cell + 1] - node[cell]) * f[i];
  }
  return failed;
}

int dvi__moving_integral(const dvi_scene *scene, const dvi__local *function, double t,
                         const double *q, double *value)
{
  const dvi_moving *moving = scene->density->moving->made;
  int cells;
  (void)dvi_moving_nodes(moving, &cells);
  const size_t points = (size_t)cells * POINTS;
  double *node = dvi__heap_take((size_t)cells + 1 + 2 * points, sizeof *node);
  if (node == NULL) return DVI_NO_MEMORY;
  double *const x = node + cells + 1;
  const dvi_status status = dvi_moving_lift(moving, t, q, node, NULL);
  const int failed = status != DVI_OK
                         ? (int)status
                         : sum(scene, function, t, q, cells, node, x, x + points, value);
  dvi__heap_free(node);
  return failed;
}
