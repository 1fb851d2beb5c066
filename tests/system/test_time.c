/* A system declares that it is autonomous, or its rates. */
#include <math.h>
#include <string.h>

#include "support/suite.h"
#include "support/systems/systems.h"
#include "system/evaluate/evaluator.h"

/* Rotors and wells depend on time, springs do not. */
typedef struct scene {
  behaviour rotors, springs, wells;
  dvi_lagrangian lagrangian;
  dvi_potential potentials[2];
} scene;

static dvi_system_terms build_terms(scene *c, callback_shape shape)
{
  *c = (scene){.rotors = {0}};
  c->lagrangian = rotors(&c->rotors, shape);
  c->potentials[0] = springs(&c->springs, shape);
  c->potentials[1] = wells(&c->wells, shape);
  return (dvi_system_terms){.dimension = SITES,
                            .lagrangian = &c->lagrangian,
                            .potentials = c->potentials,
                            .potential_count = 2};
}

static dvi_status check_terms(const dvi_system_terms *terms, dvi_derivative_check *found)
{
  dvi_system *system = make_system(terms);
  const dvi_status status = dvi_system_check(system, 0.3, generic_q, generic_v, 0, found);
  dvi_system_destroy(&system);
  return status;
}

static void check_contains(const char *text, const char *words)
{
  ck_assert_msg(strstr(text, words) != NULL, "\"%s\" is not in \"%s\"", words, text);
}

START_TEST(right_rates_pass)
{
  scene c;
  dvi_derivative_check found;
  const dvi_system_terms terms = build_terms(&c, (callback_shape)_i);
  ck_assert_msg(check_terms(&terms, &found) == DVI_OK, "%s", dvi_last_error());
  ck_assert_double_le(found.rate_error,
                      1e-11); /* the terms are linear in t, so only roundoff is left */
  ck_assert_int_eq(found.depends_on_time, 0);
}
END_TEST

START_TEST(a_wrong_rate_is_named_with_both_numbers)
{
  const char *const sentences[] = {"system check: Lagrangian: dL/dt is ",
                                   "system check: potential 'springs': dV/dt is 0.001 ",
                                   "system check: potential 'wells': dV/dt is "};
  scene c;
  dvi_derivative_check found;
  const dvi_system_terms terms = build_terms(&c, ONE_POINT);
  behaviour *const owner[] = {&c.rotors, &c.springs, &c.wells};
  owner[_i]->rate_lie = 1e-3;
  ck_assert_int_eq(check_terms(&terms, &found), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), sentences[_i]);
  check_contains(found.where, _i == 0 ? "Lagrangian: dL/dt is wrong" : "dV/dt is wrong");
  ck_assert_double_gt(found.rate_error, 1e-4);
}
END_TEST

/* Without rates, so that nothing but the callbacks' results can tell. */
static dvi_system_terms declared_autonomous(scene *c)
{
  dvi_system_terms terms = build_terms(c, BATCH);
  c->lagrangian.rate_batch = NULL;
  c->potentials[0].rate_batch = c->potentials[1].rate_batch = NULL;
  terms.autonomous = 1;
  return terms;
}

START_TEST(a_term_that_changes_with_time_although_the_system_is_declared_autonomous_is_named)
{
  scene c;
  dvi_derivative_check found;
  dvi_system_terms terms = declared_autonomous(&c);
  ck_assert_int_eq(check_terms(&terms, &found), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), "system check: Lagrangian: its value has ");
  check_contains(dvi_last_error(), "but the system is declared autonomous");
  ck_assert_str_eq(found.where, "Lagrangian: its value depends on t");
  ck_assert_int_eq(found.depends_on_time, 1);
  terms.lagrangian = NULL;
  terms.mass.scalar = 1;
  ck_assert_int_eq(check_terms(&terms, &found), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), "system check: potential 'wells': its value has ");
  terms.potential_count = 1;
  ck_assert_msg(check_terms(&terms, &found) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(found.depends_on_time, 0);
}
END_TEST

/* V = sin^2(2 pi t) q_0 has the same value at integer times. */
static int beat(double t, const double *q, double *V, void *user)
{
  const double wave = sin(2 * 3.14159265358979323846 * t);
  (void)user;
  *V = wave * wave * q[0];
  return 0;
}

START_TEST(a_periodic_dependence_on_time_is_seen)
{
  const dvi_potential drive = {.name = "drive", .value = beat};
  const dvi_system_terms terms = {.dimension = 1,
                                  .mass.scalar = 1,
                                  .potentials = &drive,
                                  .potential_count = 1,
                                  .autonomous = 1};
  ck_assert_int_eq(check_terms(&terms, NULL), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), "potential 'drive': its value has ");
}
END_TEST

START_TEST(a_rate_of_an_autonomous_system_is_refused)
{
  scene c;
  dvi_system *system = NULL;
  dvi_system_terms terms = build_terms(&c, ONE_POINT);
  terms.autonomous = 1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(),
                 "the Lagrangian has a rate, but the system is declared autonomous");
  c.lagrangian.rate = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), "springs has a rate, but the system is declared autonomous");
  ck_assert_ptr_null(system);
}
END_TEST

START_TEST(a_rate_in_two_shapes_is_refused)
{
  scene c;
  dvi_system *system = NULL;
  dvi_system_terms terms = build_terms(&c, ONE_POINT);
  c.potentials[1].rate_batch = wells(&c.wells, BATCH).rate_batch;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  check_contains(dvi_last_error(), "wells has its rate callback in two shapes");
}
END_TEST

/* L_t = -sum q_i^2/2 - sum q_i, by both shapes, in a batch of two points. */
START_TEST(the_evaluator_adds_up_the_rates_of_all_terms)
{
  double q[2 * SITES], v[2 * SITES] = {0}, L_t[2], expected[2] = {0};
  const double t[2] = {0.3, -1.2};
  for (int i = 0; i < SITES; i++)
    for (int k = 0; k < 2; k++) {
      const double x = q[2 * i + k] = generic_q[i] + 0.1 * k;
      expected[k] -= x * x / 2 + x;
    }
  for (int shape = ONE_POINT; shape <= BATCH; shape++) {
    scene c;
    const dvi_system_terms terms = build_terms(&c, (callback_shape)shape);
    dvi_system *system = make_system(&terms);
    dvi__evaluator *e = NULL;
    ck_assert_int_eq(dvi_system_autonomous(system), 0);
    ck_assert_int_eq(dvi__system_has_rates(system), DVI_OK);
    ck_assert_int_eq(dvi__evaluator_create(system, 2, DVI__GRADIENTS, NULL, &e), DVI_OK);
    ck_assert_int_eq(dvi__lagrangian_rate(e, 2, t, q, v, L_t), DVI_OK);
    for (int k = 0; k < 2; k++) ck_assert_double_eq_tol(L_t[k], expected[k], 1e-14);
    dvi__evaluator_destroy(&e);
    dvi_system_destroy(&system);
  }
}
END_TEST

START_TEST(the_rates_of_an_autonomous_system_are_known_to_be_zero)
{
  scene c;
  const dvi_system_terms terms = declared_autonomous(&c);
  dvi_system *system = make_system(&terms);
  dvi__evaluator *e = NULL;
  double L_t = 1;
  const double t = 0;
  ck_assert_int_eq(dvi_system_autonomous(system), 1);
  ck_assert_int_eq(dvi__system_has_rates(system), DVI_OK);
  ck_assert_int_eq(dvi__evaluator_create(system, 1, DVI__GRADIENTS, NULL, &e), DVI_OK);
  ck_assert_int_eq(dvi__lagrangian_rate(e, 1, &t, generic_q, generic_v, &L_t), DVI_OK);
  ck_assert(L_t == 0);
  dvi__evaluator_destroy(&e);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_term_without_its_rate_is_named)
{
  const char *const names[] = {"the Lagrangian has no rate", "springs has no rate",
                               "wells has no rate"};
  scene c;
  const dvi_system_terms terms = build_terms(&c, ONE_POINT);
  if (_i == 0)
    c.lagrangian.rate = NULL;
  else
    c.potentials[_i - 1].rate = NULL;
  dvi_system *system = make_system(&terms);
  ck_assert_int_eq(dvi__system_has_rates(system), DVI_UNSUPPORTED);
  check_contains(dvi_last_error(), names[_i]);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(no_system_is_not_autonomous)
{
  ck_assert_int_eq(dvi_system_autonomous(NULL), 0);
}
END_TEST

SUITE(time)
{
  tcase_add_loop_test(tests, right_rates_pass, ONE_POINT, BATCH + 1);
  tcase_add_loop_test(tests, a_wrong_rate_is_named_with_both_numbers, 0, 3);
  tcase_add_test(tests,
                 a_term_that_changes_with_time_although_the_system_is_declared_autonomous_is_named);
  tcase_add_test(tests, a_periodic_dependence_on_time_is_seen);
  tcase_add_test(tests, a_rate_of_an_autonomous_system_is_refused);
  tcase_add_test(tests, a_rate_in_two_shapes_is_refused);
  tcase_add_test(tests, the_evaluator_adds_up_the_rates_of_all_terms);
  tcase_add_test(tests, the_rates_of_an_autonomous_system_are_known_to_be_zero);
  tcase_add_loop_test(tests, a_term_without_its_rate_is_named, 0, 3);
  tcase_add_test(tests, no_system_is_not_autonomous);
}
