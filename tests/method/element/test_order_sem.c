/* labels: order */
/* sem has its order in (t,q,p). The points that it reaches, at the times that it chooses, lie on
 * the exact trajectory up to O(h^2s). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <dvi/diagnostics.h>

#include "support/runs.h"
#include "support/suite.h"

enum { DEGREES = 4, LEVELS = 5 };

/* The largest distance in q and p, over a revolution of kepler with e = 0.1, of the points from
 * where the exact solution is at their times. */
static double error_of(const problem *model, const char *method, double h)
{
  dvi_integrator *integrator = start_integrator(model, method);
  dvi_energy_balance energy = {0};
  double worst = 0, q[2], p[2];
  while (dvi_integrator_time(integrator) < 6.3) {
    advance(integrator, h, 1);
    ck_assert_int_eq(model->exact(model, dvi_integrator_time(integrator), q, p), 0);
    worst = fmax(worst, distance(2, q, dvi_integrator_q(integrator)));
    worst = fmax(worst, distance(2, p, dvi_integrator_p(integrator)));
  }
  ck_assert_int_eq(dvi_integrator_energy_balance(integrator, &energy), DVI_OK);
  ck_assert_int_eq(energy.fallbacks, 0);
  dvi_integrator_destroy(&integrator);
  return worst;
}

START_TEST(degree_s_has_order_2s)
{
  static const double first_step[DEGREES] = {0.05, 0.2, 0.4, 0.5};
  const int degree = 1 + _i % DEGREES;
  const char *method = method_spec("sem:degree=%d,quadrature=%s", degree,
                                   _i < DEGREES ? "gauss" : "lobatto");
  problem *model = create_problem("kepler", "e=0.1");
  double h[LEVELS], error[LEVELS];
  for (int k = 0; k < LEVELS; k++) {
    h[k] = first_step[degree - 1] * pow(degree < 3 ? 0.5 : 0.8, k);
    error[k] = error_of(model, method, h[k]);
    if (getenv("DVI_SHOW_ORDERS")) printf("%s: %g %.2e\n", method, h[k], error[k]);
  }
  dvi_order_fit fit;
  ck_assert_int_eq(dvi_order(LEVELS, h, error, 1e-13, 0, &fit), DVI_OK);
  if (getenv("DVI_SHOW_ORDERS")) printf("%s: %.2f\n", method, fit.slope);
  ck_assert_int_ge(fit.last - fit.first, 3);
  ck_assert_msg(fabs(fit.slope - 2 * degree) <= 0.2, "%s: order %.2f", method, fit.slope);
  problem_destroy(&model);
}
END_TEST

SUITE(order_sem)
{
  tcase_add_loop_test(tests, degree_s_has_order_2s, 0, 2 * DEGREES);
}
