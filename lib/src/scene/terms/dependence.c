/* The callbacks of derivatives by parameters. `user` is the scene. */
#include <math.h>
#include <string.h>

#include "scene/terms/callbacks.h"
#include "scene/terms/fault.h"

/* ---- the motion ---- */

static int depend(double t, const double *q, const double *v, double *in_q, double *in_v,
                  void *user)
{
  const dvi_scene *scene = user;
  dvi__scene_term *L = scene->varied_L, *F = scene->varied_F, *R = scene->varied_R;
  const double *x[DVI__BLOCKS] = {&t, q, v, scene->zeros, scene->inputs};
  const int first = scene->control_count, count = scene->parameter_count;
  int returned = dvi__term_add_matrix(L, DVI__PAIR_QU, x, 1, first, count, in_q);
  if (returned == 0) returned = dvi__term_add_matrix(L, DVI__PAIR_VU, x, 1, first, count, in_v);
  returned = dvi__fault_check(L, 1, x, 0, returned);
  if (returned == 0 && F != NULL)
    returned = dvi__fault_check(F, 1, x, 0,
                                dvi__term_add_matrix(F, DVI__PAIR_WU, x, 1, first, count, in_q));
  if (returned == 0 && R != NULL)
    returned = dvi__fault_check(R, 1, x, 0,
                                dvi__term_add_matrix(R, DVI__PAIR_VU, x, 1, first, count, in_q));
  return returned;
}

dvi_dependence dvi__scene_dependence(dvi_scene *scene)
{
  return (dvi_dependence){scene->parameter_count, depend, scene};
}

/* ---- the start ---- */

/* Add A x to y, for a pair of L of which the columns are coordinates or velocities, for all
 * parameters. */
static int add_products(const dvi_scene *scene, int pair, const double *const *x, double *matrix,
                        const double *of, double *to)
{
  const size_t n = (size_t)scene->n;
  memset(matrix, 0, n * n * sizeof *matrix);
  const int returned = dvi__term_add_matrix(scene->varied_L, pair, x, 1, 0, scene->n, matrix);
  for (size_t k = 0; k < (size_t)scene->parameter_count; k++)
    for (size_t j = 0; j < n; j++)
      for (size_t i = 0; i < n; i++) to[k * n + i] += matrix[j * n + i] * of[k * n + j];
  return returned;
}

int dvi__scene_start_tangent(const dvi_scene *scene, double *by_q, double *by_p, double *matrix,
                             double *by_v)
{
  const double t = 0;
  const double *x[DVI__BLOCKS] = {&t, scene->q, scene->v, scene->zeros, scene->inputs};
  const size_t all = (size_t)scene->n * (size_t)scene->parameter_count;
  const int first = scene->control_count, count = scene->parameter_count;
  double *second = scene->momenta_given ? by_p : by_v;
  memset(by_q, 0, all * sizeof *by_q);
  memset(by_p, 0, all * sizeof *by_p);
  memset(by_v, 0, all * sizeof *by_v);
  int returned = dvi__term_add_matrix(scene->varied_q, DVI__PAIR_WU, x, 1, first, count, by_q);
  if (returned == 0)
    returned = dvi__term_add_matrix(scene->varied_second, DVI__PAIR_WU, x, 1, first, count, second);
  if (returned != 0 || scene->momenta_given) return returned;
  /* p = L_v(0, q, v, theta) */
  returned = dvi__term_add_matrix(scene->varied_L, DVI__PAIR_VU, x, 1, first, count, by_p);
  if (returned == 0) returned = add_products(scene, DVI__PAIR_VQ, x, matrix, by_q, by_p);
  if (returned == 0) returned = add_products(scene, DVI__PAIR_VV, x, matrix, by_v, by_p);
  return returned;
}

/* ---- objectives ---- */

static int objective(const dvi_scene *scene, dvi__scene_term *term, double t, const double *q,
                     const double *second, double *value, double *by_q, double *by_second,
                     double *by_theta)
{
  const double *x[DVI__BLOCKS] = {&t, q, second, NULL, scene->inputs};
  int returned = dvi__fault_check(term, 1, x, 0, dvi__function_value(term->function, 1, x, value));
  if (returned == 0) {
    double *gradient[DVI__BLOCKS] = {
        [DVI__COORDINATES] = by_q, [DVI__VELOCITIES] = by_second, [DVI__INPUTS] = scene->room};
    returned = dvi__fault_check(term, 1, x, 0,
                                dvi__function_gradient(term->function, 1, x, gradient));
  }
  memcpy(by_theta, scene->room + scene->control_count,
         (size_t)scene->parameter_count * sizeof *by_theta);
  return returned;
}

static int objective_end(double t, const double *q, const double *p, double *value, double *by_q,
                         double *by_p, double *by_theta, void *user)
{
  const dvi_scene *scene = user;
  return objective(scene, scene->objective_end, t, q, p, value, by_q, by_p, by_theta);
}

static int objective_rate(double t, const double *q, const double *v, double *value, double *by_q,
                          double *by_v, double *by_theta, void *user)
{
  const dvi_scene *scene = user;
  return objective(scene, scene->objective_rate, t, q, v, value, by_q, by_v, by_theta);
}

bool dvi__make_objective(dvi_scene *scene)
{
  scene->objective = (dvi_objective){scene->objective_end != NULL ? objective_end : NULL,
                                     scene->objective_rate != NULL ? objective_rate : NULL, scene};
  return true;
}
