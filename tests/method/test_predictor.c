/* Errors of guesses are extrapolated from step to step. */
#include <math.h>
#include <stdlib.h>

#include "method/predictor.h"
#include "support/suite.h"

enum { UNKNOWNS = 2, NUMBERS = 100 };

/* A predictor with its memory. */
typedef struct learner {
  dvi__predictor predictor;
  double plain[UNKNOWNS], memory[NUMBERS];
} learner;

static void make_learner(learner *made)
{
  *made = (learner){.predictor.unknowns = UNKNOWNS};
  made->predictor.plain = made->plain;
  ck_assert_uint_le(dvi__predictor_memory(UNKNOWNS), NUMBERS);
}

/* Takes a step from guesses of 0 to a solution, and returns how far the corrected guess is off. */
static double step_to(learner *made, double h, const double solution[UNKNOWNS])
{
  double x[UNKNOWNS] = {0}, off = 0;
  dvi__predictor_correct(&made->predictor, made->memory, h, x);
  for (int i = 0; i < UNKNOWNS; i++) off = fmax(off, fabs(x[i] - solution[i]));
  dvi__predictor_learn(&made->predictor, made->memory, h, solution);
  return off;
}

static double step_number(learner *made, double h, int k)
{
  const double solution[UNKNOWNS] = {1 + k * (3 + k * (2 + k)), k * k - 7};
  return step_to(made, h, solution);
}

START_TEST(errors_that_change_as_a_cubic_are_known_after_five_steps)
{
  learner made;
  make_learner(&made);
  for (int k = 0; k < 5; k++) ck_assert_double_gt(step_number(&made, 0.5, k), 0);
  for (int k = 5; k < 12; k++) ck_assert_double_eq(step_number(&made, 0.5, k), 0);
}
END_TEST

START_TEST(other_lengths_and_guesses_of_another_kind_forget)
{
  learner made;
  make_learner(&made);
  for (int k = 0; k < 8; k++) (void)step_number(&made, 0.5, k);
  const double away[UNKNOWNS] = {5, 1};
  ck_assert_double_eq(step_to(&made, -0.5, away), 5);
  ck_assert_double_eq(step_to(&made, 0.5, away), 5);
  for (int k = 0; k < 8; k++) (void)step_number(&made, 0.5, k);
  dvi__predictor_leave(&made.predictor);
  dvi__predictor_learn(&made.predictor, made.memory, 0.5, away);
  ck_assert_double_eq(step_to(&made, 0.5, away), 5);
}
END_TEST

/* Errors that jump to and fro are worse when they are extrapolated. */
START_TEST(rough_errors_are_not_extrapolated)
{
  learner made;
  make_learner(&made);
  for (int k = 0; k < 20; k++) {
    const double solution[UNKNOWNS] = {k % 2 ? 1 : -1, 0};
    ck_assert_double_le(step_to(&made, 0.5, solution), 2);
  }
}
END_TEST

START_TEST(damaged_counts_count_as_none)
{
  static const double damaged[] = {(double)NAN, HUGE_VAL, -1, 1e300};
  for (int k = 0; k < 4; k++) {
    learner made;
    const double away[UNKNOWNS] = {5, 1};
    make_learner(&made);
    for (int i = 0; i < 8; i++) (void)step_number(&made, 0.5, i);
    made.memory[1] = made.memory[2] = damaged[k];
    ck_assert_double_eq(step_to(&made, 0.5, away), 5);
  }
}
END_TEST

SUITE(predictor)
{
  tcase_add_test(tests, errors_that_change_as_a_cubic_are_known_after_five_steps);
  tcase_add_test(tests, other_lengths_and_guesses_of_another_kind_forget);
  tcase_add_test(tests, rough_errors_are_not_extrapolated);
  tcase_add_test(tests, damaged_counts_count_as_none);
}
