#include "support/spaces.h"

#include <dvi/quadrature.h>
#include <math.h>

#include "support/suite.h"

dvi_status create_with_shapes(const dvi_system *system, const dvi_shapes *shapes,
                              const char *method, dvi_integrator **integrator)
{
  const dvi_integrator_options options = {
      .size = sizeof options, .method = method, .shapes = shapes};
  return dvi_integrator_create_with(system, &options, integrator);
}

dvi_integrator *create_integrator_with_shapes(const dvi_system *system, const dvi_shapes *shapes,
                                              const char *method)
{
  dvi_integrator *made = NULL;
  ck_assert_msg(create_with_shapes(system, shapes, method, &made) == DVI_OK, "%s",
                dvi_last_error());
  return made;
}

dvi_integrator *start_integrator_with_shapes(const problem *model, const dvi_shapes *shapes,
                                             const char *method)
{
  dvi_integrator *made = create_integrator_with_shapes(model->system, shapes, method);
  ck_assert_msg(dvi_integrator_start(made, 0, model->q, model->p) == DVI_OK, "%s",
                dvi_last_error());
  return made;
}

static const int counts[] = {0, 1, 2, 3, 4, 5, 6, 7};

static int evaluate_powers(double h, double tau, double *value, double *derivative, void *user)
{
  (void)h;
  for (int k = 0; k < *(const int *)user; k++) {
    value[k] = pow(tau, k + 2);
    derivative[k] = (k + 2) * pow(tau, k + 1);
  }
  return 0;
}

dvi_shapes powers(int functions)
{
  return (dvi_shapes){.name = "powers",
                      .functions = functions,
                      .evaluate = evaluate_powers,
                      .user = (void *)(size_t)&counts[functions]};
}

static int evaluate_oscillation(double h, double tau, double *value, double *derivative, void *user)
{
  const double nu = *(const double *)user * h;
  value[0] = sin(nu * tau), value[1] = cos(nu * tau);
  derivative[0] = nu * cos(nu * tau), derivative[1] = -nu * sin(nu * tau);
  return 0;
}

dvi_shapes oscillation(const double *omega)
{
  return (dvi_shapes){.name = "oscillation",
                      .functions = 2,
                      .evaluate = evaluate_oscillation,
                      .h = 0.1,
                      .user = (void *)(size_t)omega};
}

static int evaluate_decay(double h, double tau, double *value, double *derivative, void *user)
{
  (void)user;
  value[0] = exp(-h * tau);
  derivative[0] = -h * exp(-h * tau);
  return 0;
}

const dvi_shapes decay = {.name = "decay", .functions = 1, .evaluate = evaluate_decay, .h = 0.5};
const dvi_shapes lopsided = {.name = "lopsided", .functions = 1, .evaluate = evaluate_decay};

static int evaluate_steep(double h, double tau, double *value, double *derivative, void *user)
{
  (void)h, (void)user;
  *value = tanh(20 * tau - 8);
  *derivative = 20 * (1 - *value * *value);
  return 0;
}

const dvi_shapes steep = {.name = "steep", .functions = 1, .evaluate = evaluate_steep};

static int point_of_milne(double h, int j, double *tau, double *weight, double *value,
                          double *derivative, void *user)
{
  *tau = 0.25 * (j + 1);
  *weight = j == 1 ? -1.0 / 3 : 2.0 / 3;
  return evaluate_decay(h, *tau, value, derivative, user);
}

const dvi_shapes milne = {.name = "milne",
                          .functions = 1,
                          .evaluate = evaluate_decay,
                          .point = point_of_milne,
                          .points = 3};

static int evaluate_spline(double h, double tau, double *value, double *derivative, void *user)
{
  (void)h, (void)user;
  const double beyond = fmax(0, tau - 0.5);
  value[0] = beyond * beyond * beyond;
  derivative[0] = 3 * beyond * beyond;
  return 0;
}

enum { EACH = 4 };

/* Gives B-spline i of a degree, 0 to 3, by de Boor's recursion. */
static double b_spline(int degree, int i, double tau)
{
  static const double knot[] = {0, 0, 0, 0, 0.5, 1, 1, 1, 1};
  if (degree == 0)
    return knot[i] < knot[i + 1] && tau >= knot[i] && (tau < knot[i + 1] || knot[i + 1] == 1);
  const double rises = knot[i + degree] - knot[i], falls = knot[i + degree + 1] - knot[i + 1];
  return (rises > 0 ? (tau - knot[i]) / rises * b_spline(degree - 1, i, tau) : 0) +
         (falls > 0 ? (knot[i + degree + 1] - tau) / falls * b_spline(degree - 1, i + 1, tau) : 0);
}

static int evaluate_b_splines(double h, double tau, double *value, double *derivative, void *user)
{
  static const double rises[] = {0.5, 1, 1}, falls[] = {1, 1, 0.5};
  (void)h, (void)user;
  for (int k = 0; k < 3; k++) {
    value[k] = b_spline(3, k + 1, tau);
    derivative[k] = 3 * (b_spline(2, k + 1, tau) / rises[k] - b_spline(2, k + 2, tau) / falls[k]);
  }
  return 0;
}

static int place_of_point(int j, double *tau, double *weight)
{
  double node[EACH], weights[EACH];
  if (dvi_quadrature(DVI_GAUSS, EACH, node, weights) != DVI_OK) return -1;
  *tau = 0.5 * (j / EACH + node[j % EACH]);
  *weight = 0.5 * weights[j % EACH];
  return 0;
}

static int point_of_spline(double h, int j, double *tau, double *weight, double *value,
                           double *derivative, void *user)
{
  return place_of_point(j, tau, weight) != 0 ? -1
                                             : evaluate_spline(h, *tau, value, derivative, user);
}

static int point_of_b_splines(double h, int j, double *tau, double *weight, double *value,
                              double *derivative, void *user)
{
  return place_of_point(j, tau, weight) != 0 ? -1
                                             : evaluate_b_splines(h, *tau, value, derivative, user);
}

const dvi_shapes spline = {.name = "spline",
                           .functions = 1,
                           .evaluate = evaluate_spline,
                           .point = point_of_spline,
                           .points = 2 * EACH};

const dvi_shapes b_splines = {.name = "b-splines",
                              .functions = 3,
                              .evaluate = evaluate_b_splines,
                              .point = point_of_b_splines,
                              .points = 2 * EACH,
                              .order = 6};
