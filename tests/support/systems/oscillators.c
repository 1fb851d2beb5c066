#include "support/systems/oscillators.h"

#include <check.h>
#include <math.h>

#include "support/runs.h"

static const double pi = 3.14159265358979323846;

static problem *create_oscillators(double h, double x)
{
  return create_problem("oscillators", method_spec("omega=%.17g", pi * x / h));
}

/* A step is a matrix of determinant 1. If half its trace r has |r| > 1, the growth is
 * |r| + sqrt(r^2 - 1). */
double oscillators_growth(const char *method, double h, double x)
{
  const double one = 1, none = 0;
  problem *model = create_oscillators(h, x);
  dvi_integrator *integrator = create_integrator(model->system, method);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &one, &none), DVI_OK);
  advance(integrator, h, 1);
  double trace = dvi_integrator_q(integrator)[0];
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &none, &one), DVI_OK);
  advance(integrator, h, 1);
  trace += dvi_integrator_p(integrator)[0];
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
  const double r = 0.5 * fabs(trace);
  return r > 1 ? r + sqrt(r * r - 1) : 1;
}

double oscillators_energy_error(const char *method, double h, double x, long steps)
{
  problem *model = create_oscillators(h, x);
  dvi_integrator *integrator = start_integrator(model, method);
  const double omega = pi * x / h, square = 1 + omega * omega;
  double worst = 0;
  for (long step = 0; step < steps && worst < 1e6; step++) {
    advance(integrator, h, 1);
    const double q = dvi_integrator_q(integrator)[0], p = dvi_integrator_p(integrator)[0];
    worst = fmax(worst, fabs((p * p + square * q * q) / square - 1));
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
  return worst;
}
