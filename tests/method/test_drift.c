/* labels: invariant slow */
/* A million steps: the energy error stays bounded, without a trend that the scatter of its block means could not explain. */
#include <check.h>
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"

enum { STEPS = 1000000 };

static const struct {
  const char *problem, *method;
  double h, bound; /* on the oscillation: C h^order, measured and doubled */
} run[] = {
    {"pendulum", "midpoint", 0.1, 1.7e-3},
    {"pendulum", "midpoint:solver=newton", 0.1, 1.7e-3},
    {"pendulum", "midpoint:solver=kinsol", 0.1, 1.7e-3},
    {"pendulum", "verlet", 0.1, 4e-3},
    {"pendulum", "galerkin", 0.1, 5e-7},
    {"henon-heiles", "galerkin", 0.1, 1e-5},
    {"fpu", "galerkin:degree=3", 0.01, 1e-4},
    {"fpu", "verlet", 0.01, 1e-1},
    {"fpu", "midpoint", 0.01, 1e-1},
};
enum { RUNS = sizeof run / sizeof *run };

START_TEST(energy_does_not_drift_over_a_million_steps)
{
  problem *of = made_problem(run[_i].problem, NULL);
  dvi_integrator *integrator = started(of, run[_i].method);
  double value[16];
  dvi_drift energy;
  dvi_drift_fit fit;
  dvi_drift_init(&energy);
  for (int step = 0; step <= STEPS; step += 20) {
    ck_assert_int_eq(dvi_integrator_invariants(integrator, value), DVI_OK);
    dvi_drift_add(&energy, dvi_integrator_time(integrator), value[0]);
    advance(integrator, run[_i].h, 20);
  }
  dvi_drift_result(&energy, &fit);
  ck_assert_msg(fit.largest <= run[_i].bound, "%s, %s: energy error %g", run[_i].problem, run[_i].method, fit.largest);
  /* Significance 3 is the usual threshold; a trend of less than 1e-3 of the oscillation could hide, which 1e6 steps make 1e-9 of it a step. */
  ck_assert_msg(fit.significance < 3 || fabs(fit.change) < 1e-3 * fit.largest, "%s, %s: change %g, significance %g",
                run[_i].problem, run[_i].method, fit.change, fit.significance);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&of);
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("drift");
  tcase_set_timeout(tests, 200);
  tcase_add_loop_test(tests, energy_does_not_drift_over_a_million_steps, 0, RUNS);
  return run_tests("drift", tests);
}
