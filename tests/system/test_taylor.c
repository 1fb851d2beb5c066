/* The arithmetic of truncated series, and a system's Taylor coefficients along a curve. */
#include <dvi/taylor.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "support/runs.h"
#include "support/suite.h"
#include "system/evaluate/jet.h"

enum { DEGREE = 20, LENGTH = DEGREE + 1 };

/* A series in general position that does not begin at 0. */
static const double general[LENGTH] = {0.7,   -0.4,  0.3,   0.25,  -0.2,  0.1,  0.15,
                                       -0.05, 0.08,  0.02,  -0.03, 0.01,  0.02, 0.01,
                                       -0.01, 0.005, 0.003, 0.002, 0.001, 0.0,  0.0005};

/* Rounding in sums of 20 products of numbers that are not larger than `size`. */
static void check_near(const double *found, const double *expected, double size)
{
  for (int k = 0; k < LENGTH; k++)
    ck_assert_double_eq_tol(found[k], expected[k], 100 * DBL_EPSILON * size);
}

static long double factorial(int k)
{
  return k < 2 ? 1 : (long double)k * factorial(k - 1);
}

/* exp(c + s), sin(c + s), ... have the derivatives of the function at c. */
START_TEST(series_of_the_variable_itself_are_those_of_the_books)
{
  const double line[LENGTH] = {0.6, 1}, c = 0.6;
  double exponential[LENGTH], logarithm[LENGTH], sine[LENGTH], cosine[LENGTH], up[LENGTH],
      down[LENGTH], root[LENGTH], power[LENGTH];
  dvi_taylor_exp(DEGREE, line, exponential);
  dvi_taylor_log(DEGREE, line, logarithm);
  dvi_taylor_sin_cos(DEGREE, line, sine, cosine);
  dvi_taylor_sinh_cosh(DEGREE, line, up, down);
  dvi_taylor_square_root(DEGREE, line, root);
  dvi_taylor_power(DEGREE, line, -1.5, power);
  long double binomial_root = sqrtl(c), binomial_power = powl(c, -1.5L);
  for (int k = 0; k < LENGTH; k++) {
    const long double turn = (long double)c + k * 1.57079632679489661923132169163975L,
                      over = 1 / factorial(k);
    ck_assert_double_eq_tol(exponential[k], (double)(expl(c) * over), 4 * DBL_EPSILON);
    ck_assert_double_eq_tol(sine[k], (double)(sinl(turn) * over), 4 * DBL_EPSILON);
    ck_assert_double_eq_tol(cosine[k], (double)(cosl(turn) * over), 4 * DBL_EPSILON);
    ck_assert_double_eq_tol(up[k], (double)((k % 2 ? coshl(c) : sinhl(c)) * over), 4 * DBL_EPSILON);
    ck_assert_double_eq_tol(down[k], (double)((k % 2 ? sinhl(c) : coshl(c)) * over),
                            4 * DBL_EPSILON);
    const long double of_log = k == 0 ? logl(c) : (k % 2 ? 1 : -1) / (k * powl(c, k));
    ck_assert_double_eq_tol(logarithm[k], (double)of_log, 1e-14 * fabs((double)of_log));
    ck_assert_double_eq_tol(root[k], (double)binomial_root, 1e-14 * fabs((double)binomial_root));
    ck_assert_double_eq_tol(power[k], (double)binomial_power, 1e-14 * fabs((double)binomial_power));
    binomial_root *= (0.5L - k) / (k + 1) / c;
    binomial_power *= (-1.5L - k) / (k + 1) / c;
  }
}
END_TEST

START_TEST(operations_undo_each_other)
{
  double there[LENGTH], back[LENGTH], other[LENGTH], one[LENGTH] = {1}, sum[LENGTH] = {0};
  dvi_taylor_exp(DEGREE, general, there);
  dvi_taylor_log(DEGREE, there, back);
  check_near(back, general, 10);
  dvi_taylor_divide(DEGREE, one, general, there);
  dvi_taylor_multiply(DEGREE, there, general, back);
  check_near(back, one, 1e3); /* the quotient's coefficients grow to some hundreds */
  dvi_taylor_square_root(DEGREE, general, there);
  dvi_taylor_multiply(DEGREE, there, there, back);
  check_near(back, general, 1e3);
  dvi_taylor_sin_cos(DEGREE, general, there, other);
  dvi_taylor_add_product(DEGREE, there, there, sum);
  dvi_taylor_add_product(DEGREE, other, other, sum);
  check_near(sum, one, 10);
  dvi_taylor_power(DEGREE, general, 3, there);
  dvi_taylor_multiply(DEGREE, general, general, other);
  dvi_taylor_multiply(DEGREE, other, general, back);
  check_near(back, there, 10);
}
END_TEST

/* tan(atan(x)) = x. */
START_TEST(the_integral_of_a_quotient_is_the_arc_tangent)
{
  double slope[LENGTH], square[LENGTH], angle[LENGTH], sine[LENGTH], cosine[LENGTH],
      tangent[LENGTH];
  dvi_taylor_differentiate(DEGREE, general, slope);
  dvi_taylor_multiply(DEGREE, general, general, square);
  square[0] += 1;
  dvi_taylor_integrate_quotient(DEGREE, slope, square, atan(general[0]), angle);
  dvi_taylor_sin_cos(DEGREE, angle, sine, cosine);
  dvi_taylor_divide(DEGREE, sine, cosine, tangent);
  check_near(tangent, general, 100);
}
END_TEST

START_TEST(what_has_no_series_is_not_finite)
{
  const double zero[LENGTH] = {0, 1}, below[LENGTH] = {-1, 1};
  double c[LENGTH];
  dvi_taylor_divide(DEGREE, general, zero, c);
  ck_assert(!isfinite(c[0]));
  dvi_taylor_square_root(DEGREE, below, c);
  ck_assert(isnan(c[0]));
  dvi_taylor_log(DEGREE, below, c);
  ck_assert(isnan(c[0]));
}
END_TEST

/* ---- systems ---- */

/* The double pendulum with the well of Henon and Heiles beside it. */
static dvi_system *general_with_potential(const problem *pendulum, const problem *star)
{
  dvi_system_terms terms = *pendulum->terms;
  terms.potentials = star->terms->potentials;
  terms.potential_count = 1;
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  return system;
}

static double sum_of(int degree, int count, int i, const double *series, double s)
{
  double sum = 0;
  for (int k = degree; k >= 0; k--) sum = series[k * count + i] + s * sum;
  return sum;
}

/* A curve of degree 2 at s = 1/20. The remainder has the size (s/rho)^17, far below rounding. */
static void compare_with_points(const dvi_system *system)
{
  enum { D = 16, MOST = 128 };
  const int n = dvi_system_nq(system);
  const double s = 0.05;
  dvi__jet *jet = NULL;
  dvi__evaluator *e = NULL;
  ck_assert_int_eq(dvi__evaluator_create(system, 1, DVI__HESSIANS, NULL, &e), DVI_OK);
  ck_assert_int_eq(dvi__jet_create(system, D, DVI__HESSIANS, NULL, &jet), DVI_OK);
  double t[D + 1] = {0.3, 1}, q[(D + 1) * MOST] = {0}, v[(D + 1) * MOST] = {0}, at_q[MOST],
               at_v[MOST], at[6][MOST];
  static double series[6][(D + 1) * MOST];
  for (int i = 0; i < 3 * n; i++) q[i] = (i < n ? 1 : 0.3) * cos(3 * i), v[i] = 0.5 * sin(2 * i);
  for (int i = 0; i < n; i++) at_q[i] = sum_of(D, n, i, q, s), at_v[i] = sum_of(D, n, i, v, s);
  const dvi__jets wanted = {series[0], series[1], series[2], series[3], series[4], series[5]};
  ck_assert_int_eq(dvi__jet_along(jet, D, t, q, v, &wanted), DVI_OK);
  ck_assert_int_eq(dvi__lagrangian_value(e, 1, &(double){t[0] + s}, at_q, at_v, at[0]), DVI_OK);
  ck_assert_int_eq(dvi__lagrangian_gradient(e, 1, &(double){t[0] + s}, at_q, at_v, at[1], at[2]),
                   DVI_OK);
  ck_assert_int_eq(
      dvi__lagrangian_hessian(e, 1, &(double){t[0] + s}, at_q, at_v, at[3], at[4], at[5]), DVI_OK);
  const int count[6] = {1,
                        n,
                        n,
                        dvi__pattern_entries(&system->qq),
                        dvi__pattern_entries(&system->qv),
                        dvi__pattern_entries(&system->vv)};
  for (int b = 0; b < 6; b++)
    for (int i = 0; i < count[b]; i++)
      ck_assert_double_eq_tol(sum_of(D, count[b], i, series[b], s), at[b][i],
                              1e-14 * (1 + fabs(at[b][i])) * 10);
  dvi__jet_destroy(&jet);
  dvi__evaluator_destroy(&e);
}

START_TEST(series_of_all_terms_sum_to_what_the_points_have)
{
  static const char *const names[] = {"oscillators",  "pendulum",        "kepler",
                                      "henon-heiles", "driven-pendulum", "double-pendulum",
                                      "toda"};
  problem *model = create_problem(names[_i], NULL);
  compare_with_points(model->system);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_general_lagrangian_and_a_potential_are_added)
{
  problem *pendulum = create_problem("double-pendulum", NULL),
          *star = create_problem("henon-heiles", NULL);
  dvi_system *system = general_with_potential(pendulum, star);
  compare_with_points(system);
  dvi_system_destroy(&system);
  problem_destroy(&pendulum);
  problem_destroy(&star);
}
END_TEST

START_TEST(wanting_less_gives_the_same_numbers)
{
  problem *model = create_problem("toda", NULL);
  dvi__jet *jet = NULL;
  dvi_counters counters = {0};
  enum { D = 3, N = 20 };
  double t[D + 1] = {0, 1}, all[(D + 1) * N], alone[(D + 1) * N], value[D + 1], curve[(D + 1) * N],
               hessian[(D + 1) * 3 * N];
  for (int i = 0; i < (D + 1) * N; i++) curve[i] = sin(i);
  ck_assert_int_eq(dvi__jet_create(model->system, D, DVI__HESSIANS, &counters, &jet), DVI_OK);
  ck_assert_int_eq(dvi__jet_along(jet, D, t, curve, curve,
                                  &(dvi__jets){.L = value, .L_q = all, .L_qq = hessian}),
                   DVI_OK);
  ck_assert_int_eq(counters.values, D + 1);
  ck_assert_int_eq(counters.gradients, D + 1);
  ck_assert_int_eq(counters.hessians, D + 1);
  ck_assert_int_eq(dvi__jet_along(jet, D, t, curve, curve, &(dvi__jets){.L_q = alone}), DVI_OK);
  ck_assert_mem_eq(all, alone, sizeof all);
  ck_assert_int_eq(counters.gradients, 2 * (D + 1));
  dvi__jet_destroy(&jet);
  problem_destroy(&model);
}
END_TEST

/* ---- what is wrong ---- */

/* Honest callbacks, which keep their `user`, with planted faults beside them. */
static struct {
  dvi_potential potential;
  dvi_lagrangian lagrangian;
  int block, coefficient, entries; /* the wrong coefficient of the block's first entry */
  double by;                       /* the error of that coefficient */
  int degree;                      /* the error is made for this degree (default 0, any) */
  int alone;                       /* the error is made only if the value is not wanted */
  int returned;                    /* by every call */
} lie;

static void lie_in(double *block, const double *value, int degree)
{
  if ((lie.degree != 0 && lie.degree != degree) || (lie.alone && value != NULL)) return;
  if (block != NULL && lie.coefficient <= degree) block[lie.coefficient * lie.entries] += lie.by;
}

static int lying_potential(int degree, const double *t, const double *q, double *V, double *V_q,
                           double *V_qq, void *user)
{
  double *const block[] = {V, V_q, V_qq};
  const int returned = lie.potential.taylor(degree, t, q, V, V_q, V_qq, user);
  lie_in(block[lie.block], block[0], degree);
  return lie.returned != 0 ? lie.returned : returned;
}

static int lying_lagrangian(int degree, const double *t, const double *q, const double *v,
                            double *L, double *L_q, double *L_v, double *L_qq, double *L_qv,
                            double *L_vv, void *user)
{
  double *const block[] = {L, L_q, L_v, L_qq, L_qv, L_vv};
  const int returned = lie.lagrangian.taylor(degree, t, q, v, L, L_q, L_v, L_qq, L_qv, L_vv, user);
  lie_in(block[lie.block], block[0], degree);
  return lie.returned != 0 ? lie.returned : returned;
}

/* The system of a problem with one potential or a Lagrangian alone, which lies. */
static dvi_system *lying_system(const problem *model, int block, int coefficient, int entries,
                                double by)
{
  dvi_system_terms terms = *model->terms;
  dvi_potential potential = {0};
  dvi_lagrangian lagrangian = {0};
  dvi_system *system = NULL;
  lie.block = block, lie.coefficient = coefficient, lie.entries = entries, lie.by = by;
  if (terms.lagrangian != NULL) {
    lagrangian = lie.lagrangian = *terms.lagrangian;
    lagrangian.taylor = lying_lagrangian;
    terms.lagrangian = &lagrangian;
  } else {
    potential = lie.potential = terms.potentials[0];
    potential.taylor = lying_potential;
    terms.potentials = &potential;
  }
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  return system;
}

static void check_named(const char *name, const char *owner, int block, int coefficient,
                        int entries, const char *what)
{
  problem *model = create_problem(name, NULL);
  dvi_system *system = lying_system(model, block, coefficient, entries, 0.1);
  dvi_derivative_check found;
  ck_assert_int_eq(dvi_system_check(system, 0.4, model->q, model->v, 0, &found), DVI_BAD_ARGUMENT);
  check_words(method_spec("%s: Taylor coefficient %d of %s", owner, coefficient, what));
  ck_assert_ptr_nonnull(strstr(found.where, method_spec("%s: Taylor coefficient %d of %s is wrong",
                                                        owner, coefficient, what)));
  ck_assert_double_gt(found.taylor_error, 1e-6);
  lie.by = 0;
  ck_assert_msg(dvi_system_check(system, 0.4, model->q, model->v, 0, &found) == DVI_OK, "%s",
                dvi_last_error());
  /* differences of 6th order over a 128th of the curve's length */
  ck_assert_double_lt(found.taylor_error, 1e-8);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}

START_TEST(a_wrong_coefficient_of_a_potential_is_named)
{
  static const char *const what[] = {"V", "V_q", "V_qq"};
  static const int entries[] = {1, 2, 4};
  check_named("kepler", "potential 'gravity'", _i / 4, _i % 4, entries[_i / 4], what[_i / 4]);
}
END_TEST

START_TEST(a_wrong_coefficient_of_a_lagrangian_is_named)
{
  static const char *const what[] = {"L", "L_q", "L_v", "L_qq", "L_qv", "L_vv"};
  check_named("driven-pendulum", "Lagrangian", _i / 4, _i % 4, 1, what[_i / 4]);
}
END_TEST

static dvi_status check_lying(const char *name, int block, int coefficient, int entries, double by)
{
  dvi_derivative_check found;
  problem *model = create_problem(name, NULL);
  dvi_system *system = lying_system(model, block, coefficient, entries, by);
  const dvi_status status = dvi_system_check(system, 0.4, model->q, model->v, 0, &found);
  dvi_system_destroy(&system);
  problem_destroy(&model);
  return status;
}

/* The planet passes in a fifth of a unit of time. Coefficients grow by 5 or so each, and rounding
 * hides none. */
START_TEST(a_wrong_coefficient_of_any_degree_is_found)
{
  for (int coefficient = 5; coefficient <= DVI_TAYLOR_MAX; coefficient += 5) {
    ck_assert_int_eq(check_lying("kepler", 1, coefficient, 2, 0.1 * pow(5, coefficient)),
                     DVI_BAD_ARGUMENT);
    check_words(method_spec("Taylor coefficient %d of V_q", coefficient));
  }
}
END_TEST

START_TEST(a_callback_that_gives_no_number_or_refuses_is_no_good_one)
{
  for (int coefficient = 1; coefficient <= DVI_TAYLOR_MAX; coefficient += 13) {
    ck_assert_int_eq(check_lying("kepler", 1, coefficient, 2, (double)NAN), DVI_NOT_FINITE);
    check_words(method_spec("gave nan for coefficient %d of V_q", coefficient));
  }
  lie.returned = 1;
  ck_assert_int_eq(check_lying("kepler", 1, 0, 2, 0), DVI_CALLBACK_RETRY);
  lie.returned = -1;
  ck_assert_int_eq(check_lying("kepler", 1, 0, 2, 0), DVI_CALLBACK_FAILED);
  lie.returned = 0;
}
END_TEST

START_TEST(results_that_depend_on_what_else_is_asked_are_found)
{
  for (lie.degree = 1; lie.degree < DVI_TAYLOR_MAX; lie.degree++) {
    ck_assert_int_eq(check_lying("kepler", 1, 1, 2, 0.1), DVI_BAD_ARGUMENT);
    check_words(method_spec("if degree %d is asked for", lie.degree));
  }
  lie.degree = 0;
  lie.alone = 1;
  ck_assert_int_eq(check_lying("kepler", 1, 3, 2, 0.1), DVI_BAD_ARGUMENT);
  check_words("Taylor coefficient 3 of V_q (entry 0)");
  check_words("and other results are NULL");
  ck_assert_int_eq(check_lying("driven-pendulum", 5, 12, 1, 0.1), DVI_BAD_ARGUMENT);
  check_words("Taylor coefficient 12 of L_vv (entry 0)");
  lie.alone = 0;
}
END_TEST

/* V = x^3/6, whose callback for series takes roots that there are not at 0. */
static int cube_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = *q * *q * *q / 6;
  return 0;
}

static int cube_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  *V_q = *q * *q / 2;
  return 0;
}

static int cube_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)user;
  *V_qq = *q;
  return 0;
}

static int cube_taylor(int degree, const double *t, const double *q, double *V, double *V_q,
                       double *V_qq, void *user)
{
  double square[DVI_TAYLOR_MAX + 1], cube[DVI_TAYLOR_MAX + 1];
  (void)t, (void)user;
  dvi_taylor_multiply(degree, q, q, square);
  dvi_taylor_multiply(degree, square, q, cube);
  dvi_taylor_put(degree, 1, cube, 1.0 / 6, 0, V);
  dvi_taylor_put(degree, 1, square, 0.5, 0, V_q);
  dvi_taylor_put(degree, 1, q, 1, 0, V_qq);
  return q[0] > 0 || q[0] < 0 ? 0 : 1;
}

START_TEST(where_a_callback_has_no_series_one_beside_is_checked)
{
  const dvi_potential potential = {.name = "cube",
                                   .value = cube_value,
                                   .gradient = cube_gradient,
                                   .hessian = cube_hessian,
                                   .taylor = cube_taylor};
  const dvi_system_terms terms = {
      .dimension = 1, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  const double zero = 0, v = 0.7;
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_msg(dvi_system_check(system, 0, &zero, &v, 0, NULL) == DVI_OK, "%s", dvi_last_error());
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_coefficient_that_is_not_finite_is_named)
{
  const double t[3] = {0, 1}, q[6] = {1, 0.2}, v[6] = {0};
  double V_q[6];
  problem *model = create_problem("kepler", NULL);
  dvi_system *system = lying_system(model, 1, 2, 2, (double)NAN);
  dvi__jet *jet = NULL;
  ck_assert_int_eq(dvi__jet_create(system, 2, DVI__GRADIENTS, NULL, &jet), DVI_OK);
  ck_assert_int_eq(dvi__jet_along(jet, 2, t, q, v, &(dvi__jets){.L_q = V_q}), DVI_NOT_FINITE);
  check_words("gravity: the taylor callback gave ");
  check_words("for coefficient 2 of V_q (entry 0)");
  dvi__jet_destroy(&jet);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_term_without_coefficients_is_named)
{
  problem *model = create_problem("oscillators", NULL);
  dvi_system_terms terms = *model->terms;
  dvi_potential potentials[2] = {terms.potentials[0], terms.potentials[1]};
  dvi_system *system = NULL;
  dvi__jet *jet = NULL;
  potentials[1].taylor = NULL;
  terms.potentials = potentials;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi__jet_create(system, 2, DVI__GRADIENTS, NULL, &jet), DVI_UNSUPPORTED);
  ck_assert_ptr_null(jet);
  check_words("'fast' has no taylor callback");
  ck_assert_int_eq(dvi__system_alike(system, model->system), DVI_BAD_ARGUMENT);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

START_TEST(every_failure_of_memory_is_survived)
{
  problem *model = create_problem("kepler", NULL);
  dvi_status status = DVI_NO_MEMORY;
  for (int successes = 0; status != DVI_OK; successes++) {
    dvi__jet *jet = NULL;
    dvi__fail_allocations_after(successes);
    status = dvi__jet_create(model->system, 3, DVI__HESSIANS, NULL, &jet);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || (status == DVI_NO_MEMORY && jet == NULL));
    dvi__jet_destroy(&jet);
  }
  status = DVI_NO_MEMORY;
  for (int successes = 0; status != DVI_OK; successes++) {
    dvi__fail_allocations_after(successes);
    status = dvi_system_check(model->system, 0, model->q, model->v, 0, NULL);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
  }
  problem_destroy(&model);
}
END_TEST

SUITE(taylor)
{
  tcase_add_test(tests, series_of_the_variable_itself_are_those_of_the_books);
  tcase_add_test(tests, operations_undo_each_other);
  tcase_add_test(tests, the_integral_of_a_quotient_is_the_arc_tangent);
  tcase_add_test(tests, what_has_no_series_is_not_finite);
  tcase_add_loop_test(tests, series_of_all_terms_sum_to_what_the_points_have, 0, 7);
  tcase_add_test(tests, a_general_lagrangian_and_a_potential_are_added);
  tcase_add_test(tests, wanting_less_gives_the_same_numbers);
  tcase_add_loop_test(tests, a_wrong_coefficient_of_a_potential_is_named, 0, 12);
  tcase_add_loop_test(tests, a_wrong_coefficient_of_a_lagrangian_is_named, 0, 24);
  tcase_add_test(tests, a_wrong_coefficient_of_any_degree_is_found);
  tcase_add_test(tests, a_callback_that_gives_no_number_or_refuses_is_no_good_one);
  tcase_add_test(tests, results_that_depend_on_what_else_is_asked_are_found);
  tcase_add_test(tests, where_a_callback_has_no_series_one_beside_is_checked);
  tcase_add_test(tests, a_coefficient_that_is_not_finite_is_named);
  tcase_add_test(tests, a_term_without_coefficients_is_named);
  tcase_add_test(tests, every_failure_of_memory_is_survived);
}
