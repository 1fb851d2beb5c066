/* Callbacks that misbehave are named, with the place of the number that is not finite. */
#include <math.h>

#include "support/suite.h"
#include "support/systems/systems.h"
#include "system/evaluate/evaluator.h"
#include "evaluation.h"

typedef struct fault {
  int answer;
  double lie;
  dvi_status status;
} fault;

static const fault faults[] = {{0, (double)NAN, DVI_NOT_FINITE},
                               {0, HUGE_VAL, DVI_NOT_FINITE},
                               {3, 0, DVI_CALLBACK_RETRY},
                               {-3, 0, DVI_CALLBACK_FAILED}};

static void check_sentence(dvi_status found, dvi_status expected, const char *words)
{
  ck_assert_msg(found == expected, "%s, not %s", dvi_status_name(found), dvi_status_name(expected));
  check_words(words);
}

START_TEST(a_potential_that_misbehaves_is_named)
{
  const fault f = faults[_i % 4];
  static evaluation x;
  behaviour b = {
      .answer = f.answer, .value_lie = f.lie, .gradient_lie = f.lie, .hessian_lie = f.lie, .at = 2};
  const dvi_potential p = springs(&b, _i < 4 ? ONE_POINT : BATCH);
  dvi_system *s = make_system(&(dvi_system_terms){
      .dimension = SITES, .mass.scalar = 1, .potentials = &p, .potential_count = 1});
  dvi__evaluator *e = make(s, NULL);
  allocate_evaluation(&x);
  check_sentence(dvi__lagrangian_value(e, POINTS, x.t, x.q, x.v, x.L), f.status,
                 "springs: the value callback");
  check_sentence(dvi__lagrangian_gradient(e, POINTS, x.t, x.q, x.v, x.L_q, NULL), f.status,
                 "springs: the gradient callback");
  if (f.answer == 0) check_sentence(DVI_OK, DVI_OK, "(entry 2, point 0 of 5)");
  check_sentence(dvi__lagrangian_hessian(e, POINTS, x.t, x.q, x.v, x.L_qq, NULL, NULL), f.status,
                 "springs: the Hessian callback");
  dvi__evaluator_destroy(&e);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(a_lagrangian_that_misbehaves_is_named)
{
  const fault f = faults[_i % 4];
  const char *const gradients[] = {" in L_q (entry 1, point 0 of 5)",
                                   " in L_v (entry 1, point 0 of 5)"},
                    *const hessians[] = {" in L_qq", " in L_qv", " in L_vv"};
  static evaluation x;
  behaviour b = {
      .answer = f.answer, .value_lie = f.lie, .gradient_lie = f.lie, .hessian_lie = f.lie, .at = 1};
  const dvi_lagrangian l = rotors(&b, _i < 4 ? ONE_POINT : BATCH);
  dvi_system *s = make_system(&(dvi_system_terms){.dimension = SITES, .lagrangian = &l});
  dvi__evaluator *e = make(s, NULL);
  allocate_evaluation(&x);
  check_sentence(dvi__lagrangian_value(e, POINTS, x.t, x.q, x.v, x.L), f.status,
                 "Lagrangian: the value callback");
  for (b.block = 0; b.block < 3; b.block++) {
    if (b.block < 2) {
      check_sentence(dvi__lagrangian_gradient(e, POINTS, x.t, x.q, x.v, x.L_q, x.L_v), f.status,
                     "Lagrangian: the gradient callback");
      if (f.answer == 0) check_sentence(DVI_OK, DVI_OK, gradients[b.block]);
    }
    check_sentence(dvi__lagrangian_hessian(e, POINTS, x.t, x.q, x.v, x.L_qq, x.L_qv, x.L_vv),
                   f.status, "Lagrangian: the Hessian callback");
    if (f.answer == 0) check_sentence(DVI_OK, DVI_OK, hessians[b.block]);
  }
  dvi__evaluator_destroy(&e);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(faults_show_through_differences)
{
  const fault f = faults[_i];
  static evaluation x;
  behaviour b = {.answer = f.answer, .value_lie = f.lie};
  dvi_potential p = springs(&b, BATCH);
  p.gradient_batch = NULL;
  p.hessian_batch = NULL;
  dvi_system *s = make_system(&(dvi_system_terms){
      .dimension = SITES, .mass.scalar = 1, .potentials = &p, .potential_count = 1});
  dvi__evaluator *e = make(s, NULL);
  allocate_evaluation(&x);
  check_sentence(dvi__lagrangian_gradient(e, POINTS, x.t, x.q, x.v, x.L_q, NULL), f.status,
                 "springs: the value callback");
  check_sentence(dvi__lagrangian_hessian(e, POINTS, x.t, x.q, x.v, x.L_qq, NULL, NULL), f.status,
                 "springs: the value callback");
  dvi__evaluator_destroy(&e);
  dvi_system_destroy(&s);
}
END_TEST

SUITE(evaluator_faults)
{
  tcase_add_loop_test(tests, a_potential_that_misbehaves_is_named, 0, 8);
  tcase_add_loop_test(tests, a_lagrangian_that_misbehaves_is_named, 0, 8);
  tcase_add_loop_test(tests, faults_show_through_differences, 0, 4);
}
