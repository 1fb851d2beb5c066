#include "support/spaces.h"

#include <dvi/quadrature.h>
#include <math.h>

#include "support/suite.h"

dvi_integrator *shaped_integrator(const dvi_system *system, const dvi_shapes *shapes, const char *method)
{
  dvi_integrator *made = NULL;
  ck_assert_msg(dvi_integrator_create_shaped(system, shapes, method, &made) == DVI_OK, "%s", dvi_last_error());
  return made;
}

dvi_integrator *shaped_started(const problem *of, const dvi_shapes *shapes, const char *method)
{
  dvi_integrator *made = shaped_integrator(of->system, shapes, method);
  ck_assert_msg(dvi_integrator_start(made, 0, of->q, of->p) == DVI_OK, "%s", dvi_last_error());
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
  return (dvi_shapes){
      .name = "powers", .functions = functions, .evaluate = evaluate_powers, .user = (void *)(size_t)&counts[functions]};
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
  return (dvi_shapes){
      .name = "oscillation", .functions = 2, .evaluate = evaluate_oscillation, .h = 0.1, .user = (void *)(size_t)omega};
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

static int point_of_milne(double h, int j, double *tau, double *weight, double *value, double *derivative, void *user)
{
  *tau = 0.25 * (j + 1);
  *weight = j == 1 ? -1.0 / 3 : 2.0 / 3;
  return evaluate_decay(h, *tau, value, derivative, user);
}

const dvi_shapes milne = {.name = "milne", .functions = 1, .evaluate = evaluate_decay, .point = point_of_milne, .points = 3};

static int evaluate_spline(double h, double tau, double *value, double *derivative, void *user)
{
  (void)h, (void)user;
  const double beyond = fmax(0, tau - 0.5);
  value[0] = beyond * beyond * beyond;
  derivative[0] = 3 * beyond * beyond;
  return 0;
}

enum { EACH = 4 };

static int point_of_spline(double h, int j, double *tau, double *weight, double *value, double *derivative, void *user)
{
  double node[EACH], weights[EACH];
  if (dvi_quadrature(DVI_GAUSS, EACH, node, weights) != DVI_OK) return -1;
  *tau = 0.5 * (j / EACH + node[j % EACH]);
  *weight = 0.5 * weights[j % EACH];
  return evaluate_spline(h, *tau, value, derivative, user);
}

const dvi_shapes spline = {
    .name = "spline", .functions = 1, .evaluate = evaluate_spline, .point = point_of_spline, .points = 2 * EACH};
