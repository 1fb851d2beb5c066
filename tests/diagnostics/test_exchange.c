/* labels: unit */
#include <math.h>
#include <string.h>

#include <dvi/diagnostics.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"

static const double pi = 3.14159265358979323846;

static const double products[] = {0.01, 0.5, 1, 1.5, 2, 5, 20, 100, 1000};
enum { PRODUCTS = sizeof products / sizeof *products };

/* The rate is differenced, with the error of a thousandth of a slope's relative change, squared,
 * and rounding. */
static void check_exchange(const char *method, double x, double turn, double rate)
{
  double angle, found;
  ck_assert_msg(dvi_exchange(method, x, &angle, &found) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(fabs(angle - turn) <= 1e-9, "%s, h omega = %g: turns by %.12g, not %.12g", method,
                x, angle, turn);
  ck_assert_msg(fabs(found - rate) <= 1e-6 * (1 + fabs(rate)),
                "%s, h omega = %g: %.9g of the rate, not %.9g", method, x, found, rate);
}

/* Stern 2009, sec. 2.2.5. */
START_TEST(imex_turns_springs_by_twice_the_arc_tangent_and_exchanges_at_the_exact_rate)
{
  const double x = products[_i];
  check_exchange("imex", x, 2 * atan(x / 2), 1);
}
END_TEST

START_TEST(the_midpoint_rule_turns_them_alike_and_exchanges_too_slowly)
{
  const double x = products[_i];
  check_exchange("midpoint", x, 2 * atan(x / 2), 1 / (1 + x * x / 4));
}
END_TEST

START_TEST(verlet_exchanges_too_fast)
{
  const double x = products[_i];
  if (x < 2) check_exchange("verlet", x, 2 * asin(x / 2), 1 / sqrt(1 - x * x / 4));
}
END_TEST

/* Gives psi phi/sinc (Hairer, Lubich and Wanner 2006, sec. XIII.4). */
START_TEST(filters_exchange_at_the_rate_of_their_product)
{
  const double x = products[_i], s = sin(x) / x, half = 2 * sin(x / 2) / x, turn = fmod(x, 2 * pi);
  check_exchange("respa:substeps=exact", x, turn, 1);
  check_exchange("mollified", x, turn, s * s);
  check_exchange("trig:filter=deuflhard", x, turn, 1);
  check_exchange("trig:filter=gautschi", x, turn, half * half / s);
  check_exchange("trig:filter=hochbruck-lubich", x, turn,
                 half * half * (1 + pow(sin(x / 2), 2) / 3));
  check_exchange("trig:filter=grimm-hochbruck", x, turn, s * s * s);
  check_exchange("trig:filter=hairer-lubich", x, turn, s);
  if (s > 0) check_exchange("trig:filter=exact", x, turn, half * half / s);
}
END_TEST

START_TEST(what_does_not_turn_is_refused)
{
  double turn = 7, rate = 8;
  ck_assert_int_eq(dvi_exchange("verlet", 2.5, &turn, &rate), DVI_BAD_ARGUMENT);
  check_words("does not turn a spring");
  ck_assert_int_eq(dvi_exchange("respa:substeps=exact", pi, &turn, &rate), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_exchange("imex", 0, &turn, &rate), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_exchange("imex", NAN, &turn, &rate), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_exchange(NULL, 1, &turn, &rate), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_exchange("vprk", 1, &turn, &rate), DVI_UNSUPPORTED);
  ck_assert_int_eq(dvi_exchange("trig:filter=exact", 5, &turn, &rate), DVI_NOT_CONVERGED);
  ck_assert_double_eq(turn, 7);
  ck_assert_double_eq(rate, 8);
}
END_TEST

/* ---- two stiff springs, omega = 50, with a soft one between them ---- */

static const double omega = 50;

static int stiff(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = omega * omega * (q[0] * q[0] + q[1] * q[1]) / 2;
  return 0;
}

static int stiff_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < 2; i++) V_q[i] = omega * omega * q[i];
  return 0;
}

static int soft(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = (q[0] - q[1]) * (q[0] - q[1]) / 2;
  return 0;
}

static int soft_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = q[0] - q[1];
  V_q[1] = q[1] - q[0];
  return 0;
}

/* The square of the amplitude of x = Re z exp(i k turn), between step k and the next. */
static double amplitude(double before, double now, double turn)
{
  return (before * before + now * now - 2 * before * now * cos(turn)) / (sin(turn) * sin(turn));
}

/* Gives the time when the second spring swings as far as the first, which swings alone at the
 * start. The modes are at kappa = 0 and 2, so the time is exactly pi omega/2. */
static double time_to_share(const char *method, double h, double turn)
{
  const dvi_potential springs[] = {
      {.name = "stiff", .value = stiff, .gradient = stiff_gradient, .fast = 1, .quadratic = 1},
      {.name = "soft", .value = soft, .gradient = soft_gradient},
  };
  dvi_system *system = make_system(&(dvi_system_terms){
      .dimension = 2, .mass.scalar = 1, .potentials = springs, .potential_count = 2});
  dvi_integrator *integrator = create_integrator(system, method);
  const double q[] = {1, 0}, p[] = {0, 0};
  double before[2], ahead = 1;
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  while (ahead > 0) {
    memcpy(before, dvi_integrator_q(integrator), sizeof before);
    advance(integrator, h, 1);
    const double *now = dvi_integrator_q(integrator);
    ahead = amplitude(before[0], now[0], turn) - amplitude(before[1], now[1], turn);
  }
  const double t = dvi_integrator_time(integrator);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  return t;
}

/* 1 per cent, because the exchange's own error is of the relative size kappa/omega^2 and h^2 kappa,
 * and the time is known to h */
START_TEST(a_run_exchanges_energy_at_the_predicted_rate)
{
  static const struct {
    const char *method;
    double h;
  } run[] = {
      {"imex", 0.03},
      {"imex", 0.1},
      {"imex", 0.2},
      {"verlet", 0.03},
      {"midpoint", 0.03},
      {"galerkin:degree=2", 0.03},
      {"trig:filter=gautschi", 0.04},
      {"trig:filter=hairer-lubich", 0.04},
      {"respa:substeps=4", 0.04},
  };
  double turn, rate;
  for (size_t k = 0; k < sizeof run / sizeof *run; k++) {
    ck_assert_int_eq(dvi_exchange(run[k].method, run[k].h * omega, &turn, &rate), DVI_OK);
    const double t = time_to_share(run[k].method, run[k].h, turn),
                 predicted = pi * omega / 2 / rate;
    ck_assert_msg(fabs(t / predicted - 1) <= 0.01, "%s, h = %g: t = %g, predicted %g",
                  run[k].method, run[k].h, t, predicted);
  }
}
END_TEST

/* ---- frequencies ---- */

START_TEST(fast_frequencies_are_those_of_the_declared_potentials)
{
  double least, most;
  problem *chain = create_problem("fpu", "omega=70");
  ck_assert_int_eq(dvi_fast_frequencies(chain->system, &least, &most), DVI_OK);
  ck_assert_double_eq_tol(least, 70, 1e-12);
  ck_assert_double_eq_tol(most, 70, 1e-12);
  problem_destroy(&chain);
}
END_TEST

START_TEST(a_system_without_them_is_refused)
{
  double least = 7, most = 8;
  problem *orbit = create_problem("kepler", NULL);
  dvi_system *far = runaway(1);
  ck_assert_int_eq(dvi_fast_frequencies(orbit->system, &least, &most), DVI_UNSUPPORTED);
  ck_assert_int_eq(dvi_fast_frequencies(far, &least, &most), DVI_UNSUPPORTED);
  check_words("declared fast and quadratic");
  ck_assert_int_eq(dvi_fast_frequencies(NULL, &least, &most), DVI_BAD_ARGUMENT);
  ck_assert_double_eq(least, 7);
  ck_assert_double_eq(most, 8);
  dvi_system_destroy(&far);
  problem_destroy(&orbit);
}
END_TEST

SUITE(exchange)
{
  tcase_add_loop_test(tests,
                      imex_turns_springs_by_twice_the_arc_tangent_and_exchanges_at_the_exact_rate,
                      0, PRODUCTS);
  tcase_add_loop_test(tests, the_midpoint_rule_turns_them_alike_and_exchanges_too_slowly, 0,
                      PRODUCTS);
  tcase_add_loop_test(tests, verlet_exchanges_too_fast, 0, PRODUCTS);
  tcase_add_loop_test(tests, filters_exchange_at_the_rate_of_their_product, 0, PRODUCTS);
  tcase_add_test(tests, what_does_not_turn_is_refused);
  tcase_add_test(tests, a_run_exchanges_energy_at_the_predicted_rate);
  tcase_add_test(tests, fast_frequencies_are_those_of_the_declared_potentials);
  tcase_add_test(tests, a_system_without_them_is_refused);
}
