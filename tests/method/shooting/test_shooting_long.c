/* labels: invariant slow long */
/* Shooting over a million steps. Explicit one-step methods keep the energy, if the search for the
 * velocity is tight. */
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"

/* Energies every twenty steps. */
static dvi_drift_fit energy_of(const char *method, double h, int steps)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *integrator = start_integrator(model, method);
  double value[8];
  dvi_drift energy;
  dvi_drift_fit fit;
  dvi_drift_init(&energy);
  for (int step = 0; step <= steps; step += 20) {
    ck_assert_int_eq(dvi_integrator_invariants(integrator, value), DVI_OK);
    dvi_drift_add(&energy, dvi_integrator_time(integrator), value[0]);
    advance(integrator, h, 20);
  }
  dvi_drift_result(&energy, &fit);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
  return fit;
}

static const struct {
  const char *method;
  double bound; /* on the oscillation at h = 0.1, twice the measured size */
} run[] = {{"shooting", 3e-6}, {"shooting:onestep=heun,quadrature=trapezoid", 2.2e-2}};
enum { RUNS = sizeof run / sizeof *run };

/* 3 is the usual threshold of significance, as in test_drift.c. */
START_TEST(explicit_one_step_methods_do_not_drift)
{
  const dvi_drift_fit fit = energy_of(run[_i].method, 0.1, repeats(1000000));
  ck_assert_msg(fit.largest <= run[_i].bound, "%s: energy error %g", run[_i].method, fit.largest);
  ck_assert_msg(fit.significance < 3 || fabs(fit.change) < 1e-3 * fit.largest,
                "%s: change %g, significance %g", run[_i].method, fit.change, fit.significance);
}
END_TEST

/* A search that ends early leaves a part of the one-step method's own error, and that adds up. */
START_TEST(a_loose_search_drifts)
{
  const dvi_drift_fit tight = energy_of("shooting", 0.1, 20000),
                      loose = energy_of("shooting:tolerance=1e-6", 0.1, 20000);
  ck_assert_double_le(tight.largest, run[0].bound);
  ck_assert_double_ge(loose.significance, 10);
  ck_assert_double_ge(fabs(loose.change), 10 * tight.largest);
}
END_TEST

SUITE(shooting_long)
{
  tcase_set_timeout(tests, 300);
  tcase_add_loop_test(tests, explicit_one_step_methods_do_not_drift, 0, RUNS);
  tcase_add_test(tests, a_loose_search_drifts);
}
