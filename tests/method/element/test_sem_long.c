/* labels: invariant slow long */
/* Over 1e5 steps sem conserves its discrete energy, and the momenta of symmetries, at roundoff. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/runs.h"
#include "support/suite.h"

enum { DEGREES = 4 };

/* These steps still show in the energy, which shorter ones would not change any more. */
static const double first_step[DEGREES] = {0.05, 0.1, 0.4, 0.4};

/* No step's energy row errs by more than 16 roundings of T + |V|, 1e-13 of the energy, and these
 * errors do not add up: all rows have one target. Angular momentum is advanced by compensated sums;
 * what is left is a random walk of 1e-17 a step. */
START_TEST(energy_is_conserved_to_1e_12_over_1e5_steps)
{
  const int degree = 1 + _i % DEGREES, lobatto = _i / DEGREES;
  const char *method = method_spec("sem:degree=%d,quadrature=%s", degree,
                                   lobatto ? "lobatto" : "gauss");
  problem *model = create_problem("kepler", "e=0.1");
  dvi_integrator *integrator = start_integrator(model, method);
  dvi_energy_balance energy = {0};
  double worst = 0, start[4], end[4];
  ck_assert_int_eq(dvi_integrator_invariants(integrator, start), DVI_OK);
  for (int i = 0; i < repeats(100000); i++) {
    advance(integrator, first_step[degree - 1], 1);
    ck_assert_int_eq(dvi_integrator_energy_balance(integrator, &energy), DVI_OK);
    worst = fmax(worst, fabs(energy.energy - energy.first) / fabs(energy.first));
  }
  ck_assert_int_eq(dvi_integrator_invariants(integrator, end), DVI_OK);
  if (getenv("DVI_SHOW_ORDERS")) printf("%s: %.1e, %.1e\n", method, worst, fabs(end[1] - start[1]));
  ck_assert_int_eq(energy.fallbacks, 0);
  ck_assert_msg(worst <= 1e-12, "%s: the energy moves by %g of itself", method, worst);
  ck_assert_double_eq_tol(end[1], start[1], 1e-13);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(sem_long)
{
  tcase_add_loop_test(tests, energy_is_conserved_to_1e_12_over_1e5_steps, 0, DEGREES + 2);
}
