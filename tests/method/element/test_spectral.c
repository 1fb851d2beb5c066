/* labels: order invariant */
/* At a fixed step and growing degree the error falls geometrically for analytic solutions (Hall and
 * Leok 2015). */
#include <check.h>
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"

/* Two bodies with e = 0.6 and three steps a turn. The bounds follow from the theory, two digits for
 * eight degrees. */
static const struct {
  int degree;
  double error;
} expected[] = {{16, 1e-1}, {24, 1e-3}, {32, 1e-5}, {40, 1e-7}};
enum { DEGREES = sizeof expected / sizeof *expected };

/* Each of a hundred steps rotates it up to one rounding of 1, and roundings add up like a random
 * walk. */
static const double angular_momentum_roundoff = 1e-13;

static double position_error(const problem *kepler, double t, const double *q)
{
  double exact_q[2], exact_p[2];
  ck_assert_int_eq(kepler->exact(kepler, t, exact_q, exact_p), 0);
  return hypot(q[0] - exact_q[0], q[1] - exact_q[1]);
}

static void check_spectral(const char *basis, int degree, double bound)
{
  problem *kepler = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_integrator(
      kepler, method_spec("galerkin:degree=%d,nodes=%d,basis=%s", degree, 2 * degree, basis));
  double start[4], now[4], error = 0, momentum = 0;
  ck_assert_int_eq(dvi_integrator_invariants(integrator, start), DVI_OK);
  while (dvi_integrator_time(integrator) < 199) {
    advance(integrator, 2.0, 1);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, now), DVI_OK);
    error = fmax(error, position_error(kepler, dvi_integrator_time(integrator),
                                       dvi_integrator_q(integrator)));
    momentum = fmax(momentum, fabs(now[1] - start[1]));
  }
  ck_assert_msg(error <= bound, "degree %d, %s: position error %g, at most %g expected", degree,
                basis, error, bound);
  ck_assert_msg(momentum <= angular_momentum_roundoff, "degree %d, %s: angular momentum error %g",
                degree, basis, momentum);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}

START_TEST(three_steps_a_turn_gain_two_digits_with_eight_degrees)
{
  check_spectral("lobatto", expected[_i].degree, expected[_i].error);
}
END_TEST

START_TEST(a_modal_basis_does_the_same)
{
  check_spectral("legendre", expected[_i].degree, expected[_i].error);
}
END_TEST

SUITE(spectral)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, three_steps_a_turn_gain_two_digits_with_eight_degrees, 0, DEGREES);
  tcase_add_loop_test(tests, a_modal_basis_does_the_same, 0, DEGREES);
}
