/* labels: invariant order reference */
/* Long strings of fast springs: trig, mollified and respa by polynomials. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/systems/necklace.h"
#include "support/runs.h"
#include "support/suite.h"

static const char *const filters[] = {"deuflhard",       "garcia-archilla", "grimm-hochbruck",
                                      "hairer-lubich",   "exact",           "gautschi",
                                      "hochbruck-lubich"};
enum { FILTERS = sizeof filters / sizeof *filters, VARIATIONAL = 2, WITHOUT_POLES = 4 };

/* ---- the motion ---- */

/* One step by each, relative to the largest. */
static double difference(const necklace *string, const char *filter, double h)
{
  dvi_integrator *modes = necklace_integrator(string,
                                              method_spec("trig:filter=%s,motion=modes", filter));
  dvi_integrator *sums = necklace_integrator(
      string, method_spec("trig:filter=%s,motion=polynomials", filter));
  advance(modes, h, 1);
  advance(sums, h, 1);
  const double *const q = dvi_integrator_q(modes), *const p = dvi_integrator_p(modes);
  const double found = fmax(
      distance(string->n, q, dvi_integrator_q(sums)) / magnitude(string->n, q),
      distance(string->n, p, dvi_integrator_p(sums)) / magnitude(string->n, p));
  dvi_integrator_destroy(&modes);
  dvi_integrator_destroy(&sums);
  return found;
}

/* h omega goes up to 0.9, 2.7, 11 and 72. The difference is the error of the modes: sums of n
 * numbers, and a rounding of the largest omega^2, which rotates h^2 times as much. A string that is
 * pushed grows. */
START_TEST(polynomials_move_as_modes_do)
{
  const double h[] = {0.5, 1.5, 6, 40};
  const int n[] = {7, 50, 151};
  for (int kind = 0; kind < NECKLACES; kind++)
    for (int k = 0; k < 3; k++) {
      necklace string;
      make_necklace(n[k], (necklace_kind)kind, 1, &string);
      for (int j = 0; j < (_i >= WITHOUT_POLES || kind == PUSHED ? 2 : 4); j++) {
        const double found = difference(&string, filters[_i], h[j]);
        ck_assert_msg(found <= (kind == PUSHED ? 4 : 1) * 4e-15 * (1 + h[j] * h[j]) * sqrt(n[k]),
                      "%s, kind %d, n = %d, h = %g: %g", filters[_i], kind, n[k], h[j], found);
      }
      destroy_necklace(&string);
    }
}
END_TEST

START_TEST(a_string_of_five_hundred_moves_as_modes_do)
{
  necklace string;
  make_necklace(500, HELD, 1, &string);
  ck_assert_double_le(difference(&string, "garcia-archilla", 1.5), 2e-13);
  destroy_necklace(&string);
}
END_TEST

/* The even string has the modes sin(i a_k), lambda_k = 4 sin^2(a_k/2), a_k = k pi/(n+1). Gives its
 * motion over h in long double. */
static double exactly(const necklace *string, double h, int i, double *p)
{
  const int n = string->n;
  const long double pi = 3.14159265358979323846264338327950288L;
  long double q_sum = 0, p_sum = 0;
  for (int k = 1; k <= n; k++) {
    const long double a = k * pi / (n + 1), omega = 2 * sinl(a / 2);
    long double y = 0, w = 0;
    for (int j = 0; j < n; j++) {
      y += sinl((j + 1) * a) * string->q[j];
      w += sinl((j + 1) * a) * string->p[j];
    }
    q_sum += 2 * sinl((i + 1) * a) / (n + 1) * (cosl(h * omega) * y + sinl(h * omega) / omega * w);
    p_sum += 2 * sinl((i + 1) * a) / (n + 1) * (cosl(h * omega) * w - sinl(h * omega) * omega * y);
  }
  *p = (double)p_sum;
  return (double)q_sum;
}

/* A rounding of the largest omega^2 turns slow modes by h^2 times as much. */
START_TEST(the_fast_motion_is_exact_to_rounding)
{
  const double h[] = {0.5, 5, 50, 400};
  necklace string;
  make_necklace(90, HELD, 0, &string);
  string.slow_off = 1;
  dvi_integrator *integrator = necklace_integrator(&string,
                                                   "trig:filter=deuflhard,motion=polynomials");
  advance(integrator, h[_i], 1);
  for (int i = 0; i < string.n; i++) {
    double p;
    const double q = exactly(&string, h[_i], i, &p),
                 most = 1e-15 * (1 + h[_i]) + 3e-17 * h[_i] * h[_i];
    ck_assert_double_eq_tol(dvi_integrator_q(integrator)[i], q, most);
    ck_assert_double_eq_tol(dvi_integrator_p(integrator)[i], p, most);
  }
  dvi_integrator_destroy(&integrator);
  destroy_necklace(&string);
}
END_TEST

START_TEST(methods_with_one_filter_are_symplectic)
{
  const char *const methods[] = {
      "trig:motion=polynomials", "trig:filter=deuflhard,motion=polynomials",
      "trig:filter=exact,motion=polynomials", "trig:filter=hairer-lubich,motion=polynomials"};
  necklace string;
  double defect;
  make_necklace(18, FREE, 1, &string);
  dvi_integrator *integrator = necklace_integrator(&string, methods[_i]);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, string.q, string.p, 1.2, &defect), DVI_OK);
  if (_i < 3)
    ck_assert_double_le(defect, 2e-10); /* the differences' own error */
  else
    ck_assert_double_gt(defect, 1e-6);
  dvi_integrator_destroy(&integrator);
  destroy_necklace(&string);
}
END_TEST

/* The fast motion alone is linear. Tests its matrix J, column by column from rest at 0, against the
 * symplectic form. */
START_TEST(the_fast_motion_is_symplectic_to_rounding)
{
  enum { N = 30 };
  const double h[] = {1, 10, 100};
  static double J[2 * N][2 * N];
  necklace string;
  make_necklace(N, FREE, 1, &string);
  string.slow_off = 1;
  dvi_integrator *integrator = create_integrator(string.system,
                                                 "trig:filter=deuflhard,motion=polynomials");
  for (int k = 0; k < 2 * N; k++) {
    double z[2 * N] = {0};
    z[k] = 1;
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, z, z + N), DVI_OK);
    advance(integrator, h[_i], 1);
    memcpy(J[k], dvi_integrator_q(integrator), N * sizeof(double));
    memcpy(J[k] + N, dvi_integrator_p(integrator), N * sizeof(double));
  }
  for (int k = 0; k < 2 * N; k++)
    for (int l = 0; l < k; l++) {
      double form = k == l + N ? -1 : 0;
      for (int i = 0; i < N; i++) form += J[l][i] * J[k][N + i] - J[k][i] * J[l][N + i];
      ck_assert_double_le(fabs(form), 4e-15 * (1 + h[_i])); /* J has entries of size 1 to h */
    }
  dvi_integrator_destroy(&integrator);
  destroy_necklace(&string);
}
END_TEST

/* ---- runs ---- */

/* Gives the state at t = 3 of a run by steps of h. */
static void run(const necklace *string, const char *method, double h, double *q)
{
  dvi_integrator *integrator = necklace_integrator(string, method);
  advance(integrator, h, lround(3 / h));
  memcpy(q, dvi_integrator_q(integrator), (size_t)string->n * sizeof(double));
  dvi_integrator_destroy(&integrator);
}

START_TEST(the_order_is_2)
{
  enum { N = 150 };
  static double coarse[N], fine[N], finest[N];
  necklace string;
  make_necklace(N, HELD, 1, &string);
  run(&string, method_spec("trig:filter=%s,motion=polynomials", filters[_i]), 0.1, coarse);
  run(&string, method_spec("trig:filter=%s,motion=polynomials", filters[_i]), 0.05, fine);
  run(&string, "trig:motion=polynomials", 0.005, finest);
  ck_assert_double_eq_tol(log2(distance(N, coarse, finest) / distance(N, fine, finest)), 2, 0.05);
  destroy_necklace(&string);
}
END_TEST

/* 20000 steps. A rounding of the momentum in each step would add up to 1.5e-13. */
START_TEST(energy_and_momentum_are_kept_for_long)
{
  necklace string;
  double before[2], after[2], most = 0;
  make_necklace(66, FREE, 1, &string);
  for (int i = 0; i < string.n; i++) string.q[i] *= 0.1, string.p[i] *= 0.1;
  dvi_integrator *integrator = necklace_integrator(&string,
                                                   method_spec("trig:filter=%s", filters[_i]));
  ck_assert_int_eq(dvi_integrator_invariants(integrator, before), DVI_OK);
  for (int k = 0; k < 100; k++) {
    advance(integrator, 0.3, repeats(200));
    ck_assert_int_eq(dvi_integrator_invariants(integrator, after), DVI_OK);
    most = fmax(most, fabs(after[0] - before[0]));
  }
  ck_assert_double_le(most, 1e-3 * before[0]);
  ck_assert_double_le(fabs(after[1] - before[1]), 1e-13);
  dvi_integrator_destroy(&integrator);
  destroy_necklace(&string);
}
END_TEST

START_TEST(a_step_back_undoes_a_step)
{
  necklace string;
  make_necklace(500, HELD, 1, &string);
  dvi_integrator *integrator = necklace_integrator(
      &string, method_spec("trig:filter=%s,motion=polynomials", filters[_i]));
  advance(integrator, 0.8, 10);
  advance(integrator, -0.8, 10);
  ck_assert_double_le(distance(string.n, dvi_integrator_q(integrator), string.q), 1e-13);
  ck_assert_double_le(distance(string.n, dvi_integrator_p(integrator), string.p), 1e-13);
  dvi_integrator_destroy(&integrator);
  destroy_necklace(&string);
}
END_TEST

/* Other lengths in between leave no trace. */
START_TEST(a_step_depends_on_its_state_and_its_length_alone)
{
  necklace string;
  make_necklace(99, HELD, 1, &string);
  const size_t size = (size_t)string.n * sizeof(double);
  dvi_integrator *mixed = necklace_integrator(
      &string, method_spec("trig:filter=%s,motion=polynomials", filters[_i]));
  dvi_integrator *fresh = necklace_integrator(
      &string, method_spec("trig:filter=%s,motion=polynomials", filters[_i]));
  advance(mixed, 0.3, 1);
  advance(mixed, 0.8, 1);
  ck_assert_int_eq(dvi_integrator_start(mixed, 0, string.q, string.p), DVI_OK);
  advance(mixed, 0.5, 3);
  advance(fresh, 0.5, 3);
  ck_assert_mem_eq(dvi_integrator_q(mixed), dvi_integrator_q(fresh), size);
  ck_assert_mem_eq(dvi_integrator_p(mixed), dvi_integrator_p(fresh), size);
  dvi_integrator_destroy(&mixed);
  dvi_integrator_destroy(&fresh);
  destroy_necklace(&string);
}
END_TEST

/* ---- a hundred thousand ---- */

/* 0 <= omega^2 <= 4 and h omega <= 10. The motion takes two products for each of 18 degrees, phi
 * and psi take one for each of 17. */
START_TEST(a_step_of_a_long_string_takes_two_gradients_and_few_products)
{
  const char *const methods[] = {"trig", "mollified", "respa:substeps=exact"};
  const long products[] = {36 + 34, 36 + 34, 36};
  necklace string;
  dvi_counters first, after;
  char text[2000];
  make_necklace(repeats(100000), HELD, 0, &string);
  dvi_integrator *integrator = necklace_integrator(&string, methods[_i]);
  advance(integrator, 5, 1);
  dvi_integrator_counters(integrator, &first);
  advance(integrator, 5, 5);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.gradients - first.gradients, 5 * 2);
  ck_assert_int_eq(after.products - first.products, 5 * products[_i]);
  advance(integrator, -2, 1);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.allocations, first.allocations);
  ck_assert_int_eq(after.solves + after.factorizations, 0);
  (void)dvi_integrator_explain(integrator, text, sizeof text);
  ck_assert_ptr_nonnull(strstr(text, "the fast ones move exactly, by polynomials"));
  ck_assert_ptr_nonnull(strstr(text, "whose omega^2 lie between 0 and 4: for steps with h omega = "
                                     "1, 10, 100 of degree 7, 18, 77, which"));
  dvi_integrator_destroy(&integrator);
  destroy_necklace(&string);
}
END_TEST

/* ---- refusals ---- */

static void check_step(const necklace *string, const char *method, double h, const char *because,
                       double possible)
{
  dvi_integrator *integrator = necklace_integrator(string, method);
  ck_assert_int_eq(dvi_integrator_step(integrator, h), DVI_NOT_CONVERGED);
  check_words("trig: step 1 from t = 0");
  check_words(because);
  ck_assert_mem_eq(dvi_integrator_q(integrator), string->q, (size_t)string->n * sizeof(double));
  advance(integrator, possible, 1);
  dvi_integrator_destroy(&integrator);
}

START_TEST(steps_for_which_there_is_no_polynomial_fail_and_those_that_are_named_do_not)
{
  necklace string;
  make_necklace(70, HELD, 0, &string);
  check_step(&string, "trig", 2000,
             "polynomials need the degree 2069, of 1000 at most; h = 870 is possible", 870);
  check_step(&string, "trig:filter=gautschi,motion=polynomials", 2,
             "h omega = 4 may be of a fast mode, where this filter does not exist: it divides by "
             "sinc(h omega), or by its root; h "
             "= 1.5 is "
             "possible",
             1.5);
  check_step(&string, "trig:filter=exact,motion=polynomials", 1.5707963,
             "h omega = 3.14159 may be of a fast mode", 1.5);
  destroy_necklace(&string);
  make_necklace(70, PUSHED, 0, &string);
  check_step(&string, "trig", 6,
             "it is only known that it is above -5, and exp(13.4) is too much for polynomials; h = "
             "4.02 is possible",
             4.02);
  destroy_necklace(&string);
}
END_TEST

START_TEST(a_filter_that_jumps_has_no_polynomial)
{
  necklace string;
  dvi_integrator *integrator = NULL;
  make_necklace(2001, HELD, 0, &string);
  ck_assert_int_eq(dvi_integrator_create(string.system, "mollified:filter=projection", &integrator),
                   DVI_BAD_SIZE);
  check_words("mollified: polynomials: the filter jumps, they cannot follow it; take another one: "
              "normal modes: 2001 coordinates "
              "are coupled");
  destroy_necklace(&string);
}
END_TEST

/* Beads that are pushed away grow. The sentence names the longest step, which works, and a longer
 * one does not. */
START_TEST(steps_are_explained_as_far_as_they_are_possible)
{
  static const char words[] = " of the motion; steps are at most ";
  necklace string;
  char text[2000];
  make_necklace(90, PUSHED, 1, &string);
  dvi_integrator *integrator = necklace_integrator(&string, "trig:motion=polynomials");
  (void)dvi_integrator_explain(integrator, text, sizeof text);
  ck_assert_ptr_nonnull(strstr(text, ": for steps with h omega = 1 of degree"));
  const char *found = strstr(text, words);
  ck_assert_ptr_nonnull(found);
  const double longest = strtod(found + strlen(words), NULL);
  ck_assert_int_eq(dvi_integrator_step(integrator, 0.99 * longest), DVI_OK);
  ck_assert_int_eq(dvi_integrator_step(integrator, 1.01 * longest), DVI_NOT_CONVERGED);
  dvi_integrator_destroy(&integrator);
  destroy_necklace(&string);
}
END_TEST

/* Filters with poles by modes, which may lie between them. */
START_TEST(blocks_of_more_than_64_go_by_polynomials_where_they_serve)
{
  necklace string;
  char text[2000];
  make_necklace(64 + _i % 2, HELD, 0, &string);
  dvi_integrator *integrator = necklace_integrator(&string,
                                                   _i < 2 ? "trig" : "trig:filter=gautschi");
  (void)dvi_integrator_explain(integrator, text, sizeof text);
  ck_assert_ptr_nonnull(strstr(text, _i == 1 ? "by polynomials" : "by their normal modes"));
  dvi_integrator_destroy(&integrator);
  destroy_necklace(&string);
}
END_TEST

SUITE(polynomials)
{
  tcase_add_loop_test(tests, polynomials_move_as_modes_do, 0, FILTERS);
  tcase_add_test(tests, a_string_of_five_hundred_moves_as_modes_do);
  tcase_add_loop_test(tests, the_fast_motion_is_exact_to_rounding, 0, 4);
  tcase_add_loop_test(tests, methods_with_one_filter_are_symplectic, 0, 4);
  tcase_add_loop_test(tests, the_fast_motion_is_symplectic_to_rounding, 0, 3);
  tcase_add_loop_test(tests, the_order_is_2, 0, FILTERS);
  tcase_add_loop_test(tests, energy_and_momentum_are_kept_for_long, 0, VARIATIONAL);
  tcase_add_loop_test(tests, a_step_back_undoes_a_step, 0, FILTERS);
  tcase_add_loop_test(tests, a_step_depends_on_its_state_and_its_length_alone, 0, FILTERS);
  tcase_add_loop_test(tests, a_step_of_a_long_string_takes_two_gradients_and_few_products, 0, 3);
  tcase_add_test(tests, steps_are_explained_as_far_as_they_are_possible);
  tcase_add_test(tests,
                 steps_for_which_there_is_no_polynomial_fail_and_those_that_are_named_do_not);
  tcase_add_test(tests, a_filter_that_jumps_has_no_polynomial);
  tcase_add_loop_test(tests, blocks_of_more_than_64_go_by_polynomials_where_they_serve, 0, 4);
}
