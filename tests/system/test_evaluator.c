#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "support/suite.h"
#include "support/systems/systems.h"
#include "system/evaluate/evaluator.h"
#include "evaluation.h"

static void evaluate(const dvi_system *s, evaluation *x)
{
  dvi__evaluator *e = make(s, NULL);
  allocate_evaluation(x);
  ck_assert_msg(dvi__lagrangian_value(e, POINTS, x->t, x->q, x->v, x->L) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_msg(dvi__lagrangian_gradient(e, POINTS, x->t, x->q, x->v, x->L_q, x->L_v) == DVI_OK,
                "%s", dvi_last_error());
  ck_assert_msg(dvi__lagrangian_hessian(e, POINTS, x->t, x->q, x->v, x->L_qq, x->L_qv, x->L_vv) ==
                    DVI_OK,
                "%s", dvi_last_error());
  dvi__evaluator_destroy(&e);
  ck_assert_ptr_null(e);
}

static void evaluate_terms(const dvi_lagrangian *l, const dvi_potential *potentials, int count,
                           evaluation *x)
{
  dvi_system_terms terms = {
      .dimension = SITES, .lagrangian = l, .potentials = potentials, .potential_count = count};
  if (l == NULL) terms.mass = (dvi_mass){.values = tridiagonal_mass, .pattern = tridiagonal};
  dvi_system *s = make_system(&terms);
  memset(x, 0, sizeof *x);
  evaluate(s, x);
  dvi_system_destroy(&s);
}

/* Largest difference of two arrays, relative to the largest entry of the second. */
static double distance(int count, const double *a, const double *b)
{
  double difference = 0, largest = 0;
  for (int i = 0; i < count; i++) {
    difference = fmax(difference, fabs(a[i] - b[i]));
    largest = fmax(largest, fabs(b[i]));
  }
  return difference / largest;
}

START_TEST(one_point_and_batch_callbacks_agree_bit_for_bit)
{
  static evaluation one, batch;
  behaviour b = {0};
  const dvi_lagrangian l[] = {rotors(&b, ONE_POINT), rotors(&b, BATCH)};
  const dvi_potential p[2][2] = {{springs(&b, ONE_POINT), wells(&b, ONE_POINT)},
                                 {springs(&b, BATCH), wells(&b, BATCH)}};
  for (int general = 0; general < 2; general++) {
    evaluate_terms(general ? &l[0] : NULL, p[0], 2, &one);
    evaluate_terms(general ? &l[1] : NULL, p[1], 2, &batch);
    ck_assert_mem_eq(&one, &batch, sizeof one);
  }
}
END_TEST

START_TEST(a_batch_is_its_points_one_by_one)
{
  static evaluation x;
  behaviour b = {0};
  const dvi_lagrangian l = rotors(&b, BATCH);
  const dvi_potential p = springs(&b, BATCH);
  evaluate_terms(&l, &p, 1, &x);
  dvi_system *s = make_system(&(dvi_system_terms){
      .dimension = SITES, .lagrangian = &l, .potentials = &p, .potential_count = 1});
  dvi__evaluator *e = make(s, NULL);
  for (int k = 0; k < POINTS; k++) {
    double q[SITES], v[SITES], L, L_q[SITES], L_v[SITES], L_qq[QQ], L_qv[QV], L_vv[VV];
    for (int i = 0; i < SITES; i++) {
      q[i] = x.q[i * POINTS + k];
      v[i] = x.v[i * POINTS + k];
    }
    ck_assert_int_eq(dvi__lagrangian_value(e, 1, x.t + k, q, v, &L), DVI_OK);
    ck_assert_int_eq(dvi__lagrangian_gradient(e, 1, x.t + k, q, v, L_q, L_v), DVI_OK);
    ck_assert_int_eq(dvi__lagrangian_hessian(e, 1, x.t + k, q, v, L_qq, L_qv, L_vv), DVI_OK);
    ck_assert(L == x.L[k]);
    for (int i = 0; i < SITES; i++)
      ck_assert(L_q[i] == x.L_q[i * POINTS + k] && L_v[i] == x.L_v[i * POINTS + k]);
    for (int i = 0; i < QQ; i++) ck_assert(L_qq[i] == x.L_qq[i * POINTS + k]);
    for (int i = 0; i < QV; i++) ck_assert(L_qv[i] == x.L_qv[i * POINTS + k]);
    for (int i = 0; i < VV; i++) ck_assert(L_vv[i] == x.L_vv[i * POINTS + k]);
  }
  dvi__evaluator_destroy(&e);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(several_potentials_sum_with_a_minus_sign)
{
  static evaluation both, first, second, none;
  behaviour b = {0};
  const dvi_potential p[] = {springs(&b, BATCH), wells(&b, BATCH)};
  evaluate_terms(NULL, p, 2, &both);
  evaluate_terms(NULL, p, 1, &first);
  /* its diagonal Hessian stands in the first SITES entries */
  evaluate_terms(NULL, p + 1, 1, &second);
  evaluate_terms(NULL, NULL, 0, &none);
  for (int k = 0; k < POINTS; k++) {
    double V;
    p[0].value_batch(1, none.t,
                     (double[]){both.q[k], both.q[POINTS + k], both.q[2 * POINTS + k],
                                both.q[3 * POINTS + k], both.q[4 * POINTS + k],
                                both.q[5 * POINTS + k]},
                     &V, &b);
    ck_assert_double_eq_tol(first.L[k], none.L[k] - V, 1e-14 * fabs(V));
    /* sums of O(10) reordered */
    ck_assert_double_eq_tol(both.L[k] - none.L[k], first.L[k] + second.L[k] - 2 * none.L[k], 1e-13);
  }
  for (int i = 0; i < SITES * POINTS; i++) {
    ck_assert_double_eq_tol(both.L_q[i], first.L_q[i] + second.L_q[i], 1e-13);
    ck_assert_double_eq(none.L_q[i], 0);
    ck_assert_double_eq(both.L_v[i], none.L_v[i]);
  }
  for (int j = 0, entry = 0; j < SITES; j++)
    for (int e = tridiagonal.start[j]; e < tridiagonal.start[j + 1]; e++, entry++)
      for (int k = 0; k < POINTS; k++) {
        const double well = tridiagonal.row[e] == j ? second.L_qq[j * POINTS + k] : 0;
        ck_assert_double_eq_tol(both.L_qq[entry * POINTS + k],
                                first.L_qq[entry * POINTS + k] + well, 1e-13);
      }
}
END_TEST

START_TEST(a_potential_adds_to_a_general_lagrangian)
{
  static evaluation both, general, potential, mass;
  behaviour b = {0};
  const dvi_lagrangian l = rotors(&b, ONE_POINT);
  const dvi_potential p = springs(&b, BATCH);
  evaluate_terms(&l, &p, 1, &both);
  evaluate_terms(&l, NULL, 0, &general);
  evaluate_terms(NULL, &p, 1, &potential);
  evaluate_terms(NULL, NULL, 0, &mass);
  for (int k = 0; k < POINTS; k++)
    ck_assert_double_eq_tol(both.L[k], general.L[k] + potential.L[k] - mass.L[k], 1e-13);
  for (int i = 0; i < SITES * POINTS; i++)
    ck_assert_double_eq_tol(both.L_q[i], general.L_q[i] + potential.L_q[i], 1e-13);
  ck_assert_mem_eq(both.L_v, general.L_v, sizeof both.L_v);
  ck_assert_mem_eq(both.L_qv, general.L_qv, sizeof both.L_qv);
  ck_assert_mem_eq(both.L_vv, general.L_vv, sizeof both.L_vv);
  for (int j = 0, entry = 0; j < SITES; j++)
    for (int e = tridiagonal.start[j]; e < tridiagonal.start[j + 1]; e++, entry++)
      for (int k = 0; k < POINTS; k++) {
        const double own = tridiagonal.row[e] == j ? general.L_qq[j * POINTS + k] : 0;
        ck_assert_double_eq_tol(both.L_qq[entry * POINTS + k],
                                potential.L_qq[entry * POINTS + k] + own, 1e-13);
      }
}
END_TEST

START_TEST(a_constant_mass_has_its_own_derivatives)
{
  static evaluation x;
  evaluate_terms(NULL, NULL, 0, &x);
  for (int k = 0; k < POINTS; k++) {
    double T = 0;
    for (int i = 0; i < SITES; i++) {
      double p = 0;
      for (int e = tridiagonal.start[i]; e < tridiagonal.start[i + 1]; e++)
        p += tridiagonal_mass[e] * x.v[tridiagonal.row[e] * POINTS + k];
      ck_assert_double_eq_tol(x.L_v[i * POINTS + k], p, 1e-14);
      T += 0.5 * p * x.v[i * POINTS + k];
    }
    ck_assert_double_eq_tol(x.L[k], T, 1e-13);
    for (int e = 0; e < VV; e++) ck_assert_double_eq(x.L_vv[e * POINTS + k], tridiagonal_mass[e]);
  }
}
END_TEST

/* The tolerances are those of system/term/difference.h. These functions vary over lengths of about
 * 1, and so do their steps. */
START_TEST(what_is_missing_is_differenced_to_the_stated_accuracy)
{
  static evaluation exact, differenced;
  behaviour b = {0};
  dvi_lagrangian l = rotors(&b, ONE_POINT);
  dvi_potential p = springs(&b, BATCH);
  evaluate_terms(&l, &p, 1, &exact);
  for (int missing = 1; missing <= 2; missing++) {
    const double first = missing == 2 ? 2e-12 : 0, second = missing == 2 ? 1e-6 : 1e-9;
    l.hessian = NULL;
    p.hessian_batch = NULL;
    if (missing == 2) {
      l.gradient = NULL;
      p.gradient_batch = NULL;
    }
    evaluate_terms(&l, &p, 1, &differenced);
    ck_assert_mem_eq(differenced.L, exact.L, sizeof exact.L);
    ck_assert_double_le(distance(SITES * POINTS, differenced.L_q, exact.L_q), first);
    ck_assert_double_le(distance(SITES * POINTS, differenced.L_v, exact.L_v), first);
    ck_assert_double_le(distance(QQ * POINTS, differenced.L_qq, exact.L_qq), second);
    ck_assert_double_le(distance(QV * POINTS, differenced.L_qv, exact.L_qv), second);
    ck_assert_double_le(distance(VV * POINTS, differenced.L_vv, exact.L_vv), second);
  }
}
END_TEST

/* L = -sqrt(1 - v^2), as near to the speed of light as the first column says. Steps made for v
 * itself would lead close to it. The remaining error is the values' roundoff over steps that shrink
 * with the distance. */
static int moving_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)q, (void)user;
  *L = -sqrt(1 - v[0] * v[0]);
  return 0;
}

START_TEST(missing_gradients_are_differenced_with_care_near_a_singularity)
{
  static const double cases[][2] = {{0.5, 1e-12}, {0.1, 1e-11}, {0.05, 1e-11}, {0.03, 1e-10}};
  const dvi_lagrangian l = {.value = moving_value};
  const double v = 1 - cases[_i][0], exact = v / sqrt(1 - v * v);
  double p;
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = 1, .lagrangian = &l});
  ck_assert_int_eq(dvi_system_momentum(s, 0, &(double){0}, &v, &p), DVI_OK);
  ck_assert_double_eq_tol(p, exact, cases[_i][1] * exact);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(differences_work_at_the_origin_and_next_to_it)
{
  const double sizes[] = {0, 1e-310};
  behaviour b = {0};
  dvi_potential p = springs(&b, ONE_POINT);
  p.gradient = NULL;
  p.hessian = NULL;
  dvi_system *s = make_system(&(dvi_system_terms){
      .dimension = SITES, .mass.scalar = 1, .potentials = &p, .potential_count = 1});
  dvi__evaluator *e = make(s, NULL);
  double t = 0, q[SITES], L_q[SITES], L_qq[QQ];
  for (int i = 0; i < SITES; i++) q[i] = sizes[_i] * (1 + i);
  ck_assert_int_eq(dvi__lagrangian_gradient(e, 1, &t, q, generic_v, L_q, NULL), DVI_OK);
  for (int i = 0; i < SITES; i++) ck_assert_double_eq_tol(L_q[i], 0, 1e-13);
  ck_assert_int_eq(dvi__lagrangian_hessian(e, 1, &t, q, generic_v, L_qq, NULL, NULL), DVI_OK);
  ck_assert_double_eq_tol(L_qq[0], -1, 1e-6);
  dvi__evaluator_destroy(&e);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(a_tridiagonal_hessian_costs_two_gradients_for_each_of_three_groups)
{
  behaviour b = {0};
  dvi_potential p = springs(&b, BATCH);
  p.hessian_batch = NULL;
  static evaluation x;
  evaluate_terms(NULL, &p, 1, &x);
  ck_assert_int_eq(b.gradients, 1 + 2 * 3);
  ck_assert_int_eq(b.hessians, 0);
}
END_TEST

/* qq is diagonal, and has one group. The bidiagonal qv and the tridiagonal vv share their columns
 * in three groups. */
START_TEST(a_general_hessian_is_grouped_by_its_patterns)
{
  behaviour b = {0};
  dvi_lagrangian l = rotors(&b, BATCH);
  l.hessian_batch = NULL;
  static evaluation x;
  evaluate_terms(&l, NULL, 0, &x);
  ck_assert_int_eq(b.gradients, 1 + 2 * 1 + 2 * 3);
}
END_TEST

START_TEST(a_missing_gradient_costs_6n_values_a_term_or_12n_for_a_lagrangian)
{
  static evaluation x;
  behaviour b = {0};
  dvi_potential p = springs(&b, BATCH);
  dvi_lagrangian l = rotors(&b, BATCH);
  p.gradient_batch = NULL;
  l.gradient_batch = NULL;
  evaluate_terms(NULL, &p, 1, &x);
  ck_assert_int_eq(b.values, 1 + 6 * SITES);
  b = (behaviour){0};
  evaluate_terms(&l, NULL, 0, &x);
  ck_assert_int_eq(b.values, 1 + 12 * SITES);
}
END_TEST

/* But by the first factor of L_vv. */
START_TEST(points_are_counted_and_nothing_is_allocated_after_create)
{
  static evaluation x;
  behaviour of_l = {0}, of_p = {0};
  dvi_counters counters = {0};
  dvi_lagrangian l = rotors(&of_l, ONE_POINT);
  dvi_potential p = springs(&of_p, ONE_POINT);
  p.hessian = NULL;
  l.gradient = NULL;
  dvi_system *s = make_system(&(dvi_system_terms){
      .dimension = SITES, .lagrangian = &l, .potentials = &p, .potential_count = 1});
  dvi__evaluator *e = make(s, &counters);
  const long before = dvi__allocation_count();
  double momentum[SITES] = {1}, v[SITES] = {0};
  allocate_evaluation(&x);
  ck_assert_int_eq(dvi__lagrangian_value(e, POINTS, x.t, x.q, x.v, x.L), DVI_OK);
  ck_assert_int_eq(dvi__lagrangian_gradient(e, POINTS, x.t, x.q, x.v, x.L_q, NULL), DVI_OK);
  ck_assert_int_eq(dvi__lagrangian_hessian(e, POINTS, x.t, x.q, x.v, x.L_qq, x.L_qv, x.L_vv),
                   DVI_OK);
  /* of them one a point were asked for, the others by the missing gradient */
  ck_assert_int_eq(counters.values, of_l.values);
  ck_assert_int_eq(counters.gradients, of_p.gradients);
  ck_assert_int_gt(counters.gradients, POINTS);
  ck_assert_int_eq(counters.hessians, POINTS);
  ck_assert_int_eq(dvi__allocation_count(), before);
  ck_assert_int_eq(dvi__legendre_inverse(e, 0, generic_q, momentum, v), DVI_OK);
  ck_assert_int_ge(counters.factorizations, 1);
  ck_assert_int_eq(counters.preparations, 1);
  const long prepared = dvi__allocation_count();
  ck_assert_int_eq(dvi__legendre_inverse(e, 0, generic_v, momentum, v), DVI_OK);
  ck_assert_int_eq(dvi__allocation_count(), prepared);
  ck_assert_int_eq(counters.preparations, 1);
  dvi__evaluator_destroy(&e);
  dvi_system_destroy(&s);
}
END_TEST

/* With a constant mass L_v costs no callback, and either part of the gradient can be left out. */
START_TEST(only_what_is_asked_is_evaluated)
{
  static evaluation x;
  behaviour b = {0};
  const dvi_potential p = springs(&b, BATCH);
  dvi_system *s = make_system(&(dvi_system_terms){
      .dimension = SITES, .mass.scalar = 1, .potentials = &p, .potential_count = 1});
  dvi__evaluator *e = make(s, NULL);
  allocate_evaluation(&x);
  ck_assert_int_eq(dvi__lagrangian_gradient(e, POINTS, x.t, x.q, x.v, NULL, x.L_v), DVI_OK);
  ck_assert_int_eq(b.gradients, 0);
  ck_assert_mem_eq(x.L_v, x.v, sizeof x.v);
  ck_assert_int_eq(dvi__lagrangian_gradient(e, POINTS, x.t, x.q, x.v, x.L_q, NULL), DVI_OK);
  ck_assert_int_eq(b.gradients, 1);
  ck_assert_int_eq(dvi__lagrangian_hessian(e, POINTS, x.t, x.q, x.v, x.L_qq, NULL, NULL), DVI_OK);
  ck_assert_int_eq(b.hessians, 1);
  dvi__evaluator_destroy(&e);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(the_mass_is_solved_in_place_for_a_batch)
{
  static evaluation x;
  const double diagonal[SITES] = {1, 2, 3, 4, 5, 6};
  const dvi_mass masses[] = {
      {.scalar = 3}, {.diagonal = diagonal}, {.values = tridiagonal_mass, .pattern = tridiagonal}};
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = SITES, .mass = masses[_i]});
  dvi__evaluator *e = make(s, NULL);
  allocate_evaluation(&x);
  ck_assert_int_eq(dvi__lagrangian_gradient(e, POINTS, x.t, x.q, x.v, NULL, x.L_v), DVI_OK);
  dvi__mass_solve(e, POINTS, x.L_v, x.L_v);
  ck_assert_double_le(distance(SITES * POINTS, x.L_v, x.v), 1e-15);
  dvi__evaluator_destroy(&e);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(an_evaluator_of_a_degenerate_lagrangian_can_be_made)
{
  const int n = 30, none[31] = {0};
  behaviour b = {0};
  dvi_lagrangian l = rotors(&b, BATCH);
  l.qq = l.qv = l.vv = (dvi_pattern){none, NULL};
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = n, .lagrangian = &l});
  dvi__evaluator *e = make(s, NULL);
  dvi__evaluator_destroy(&e);
  dvi_system_destroy(&s);
}
END_TEST

SUITE(evaluator)
{
  tcase_add_test(tests, one_point_and_batch_callbacks_agree_bit_for_bit);
  tcase_add_test(tests, a_batch_is_its_points_one_by_one);
  tcase_add_test(tests, several_potentials_sum_with_a_minus_sign);
  tcase_add_test(tests, a_potential_adds_to_a_general_lagrangian);
  tcase_add_test(tests, a_constant_mass_has_its_own_derivatives);
  tcase_add_test(tests, what_is_missing_is_differenced_to_the_stated_accuracy);
  tcase_add_loop_test(tests, missing_gradients_are_differenced_with_care_near_a_singularity, 0, 4);
  tcase_add_loop_test(tests, differences_work_at_the_origin_and_next_to_it, 0, 2);
  tcase_add_test(tests, a_tridiagonal_hessian_costs_two_gradients_for_each_of_three_groups);
  tcase_add_test(tests, a_general_hessian_is_grouped_by_its_patterns);
  tcase_add_test(tests, a_missing_gradient_costs_6n_values_a_term_or_12n_for_a_lagrangian);
  tcase_add_test(tests, points_are_counted_and_nothing_is_allocated_after_create);
  tcase_add_test(tests, only_what_is_asked_is_evaluated);
  tcase_add_loop_test(tests, the_mass_is_solved_in_place_for_a_batch, 0, 3);
  tcase_add_test(tests, an_evaluator_of_a_degenerate_lagrangian_can_be_made);
}
