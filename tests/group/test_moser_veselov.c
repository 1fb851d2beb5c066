/* labels: unit */
#include <check.h>
#include <math.h>
#include <string.h>

#include "group/moser_veselov.h"
#include "group/turn.h"
#include "group/vector.h"
#include "support/suite.h"

/* Numbers between -1 and 1 that are the same on every machine. */
static double next_number(unsigned *seed)
{
  *seed = 1664525u * *seed + 1013904223u;
  return (double)(*seed >> 8) / (1u << 23) - 1;
}

/* Gives Jd = B B^T of a body of any shape, or thin by 1e-3 a direction. */
static void some_moments(unsigned *seed, int thin, double Jd[9])
{
  double B[9];
  for (int i = 0; i < 9; i++)
    B[i] = next_number(seed) * (thin ? (i < 3 ? 1 : i < 6 ? 1e-3 : 1e-6) : 1);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) Jd[3 * i + j] = dvi__dot(B + 3 * i, B + 3 * j);
}

/* The largest of |F Jd - Jd F^T - g^|. */
static double residual(const double Jd[9], const double w[3], const double g[3])
{
  double F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, carry[9] = {0}, A[9] = {0};
  const dvi__turn turn = dvi__turn_of(w);
  dvi__turn_rows(&turn, 9, F, carry);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) A[3 * i + j] += F[3 * i + k] * Jd[3 * k + j];
  return fmax(fmax(fabs(A[7] - A[5] - g[0]), fabs(A[2] - A[6] - g[1])), fabs(A[3] - A[1] - g[2]));
}

enum { CASES = 4000, PARTS = 100 };

/* If h Pi has a Moser-Veselov step, all fractions of it have one, and it depends continuously on
 * the fraction from 0 on. No other branch is ever taken. */
static void check_branch(const dvi__body *body, dvi__moser_veselov_map by, const double g[3])
{
  double last[3] = {0};
  for (int part = 1; part <= PARTS; part++) {
    const double some[] = {g[0] * part / PARTS, g[1] * part / PARTS, g[2] * part / PARTS};
    double w[3], angle[3];
    ck_assert_int_gt(dvi__body_moser_veselov(body, by, some, w), 0);
    for (int i = 0; i < 3; i++) {
      angle[i] = atan(w[i]);
      ck_assert_double_le(fabs(angle[i] - last[i]), .3);
    }
    memcpy(last, angle, sizeof last);
  }
}

START_TEST(a_leap_solves_its_equation_on_the_branch_of_short_steps)
{
  const dvi__moser_veselov_map by = _i == 0 ? DVI__BY_EXPONENTIAL : DVI__BY_CAYLEY;
  unsigned seed = 12345;
  long iterations = 0, solved = 0;
  for (int n = 0; n < CASES; n++) {
    double Jd[9], w[3], g[3];
    dvi__body body;
    some_moments(&seed, n % 2, Jd);
    ck_assert_int_eq(dvi__body_of(Jd, &body), 1);
    for (int i = 0; i < 3; i++) g[i] = body.largest * next_number(&seed);
    const int taken = dvi__body_moser_veselov(&body, by, g, w);
    if (taken == 0) continue;
    iterations += taken;
    solved++;
    ck_assert_double_le(residual(Jd, w, g), 1e-14 * body.largest);
    if (n % 20 == 0) check_branch(&body, by, g);
  }
  ck_assert_int_gt(solved, CASES / 20);     /* most others are beyond the bound */
  ck_assert_int_le(iterations, 4 * solved); /* up to the bound, and short steps take two */
}
END_TEST

START_TEST(short_leaps_take_two_iterations)
{
  const double Jd[] = {.25, 0, 0, 0, 1.25, 0, 0, 0, 1.75}, g[] = {.15, -.1, .06};
  dvi__body body;
  double w[3];
  ck_assert_int_eq(dvi__body_of(Jd, &body), 1);
  ck_assert_int_le(dvi__body_moser_veselov(&body, DVI__BY_CAYLEY, g, w), 2);
}
END_TEST

START_TEST(a_sphere_can_be_solved_up_to_a_quarter_turn)
{
  const double Jd[] = {.5, 0, 0, 0, .5, 0, 0, 0, .5};
  const dvi__moser_veselov_map by = _i == 0 ? DVI__BY_EXPONENTIAL : DVI__BY_CAYLEY;
  dvi__body body;
  double w[3];
  ck_assert_int_eq(dvi__body_of(Jd, &body), 1);
  for (int k = 0; k < 150; k++) {
    const double size = 1 - pow(.9, k + 1);
    ck_assert_int_gt(
        dvi__body_moser_veselov(&body, by, (const double[]){0, .6 * size, .8 * size}, w), 0);
    ck_assert_double_eq_tol(2 * atan(sqrt(dvi__dot(w, w))), asin(size), 1e-15 / sqrt(1 - size));
  }
  ck_assert_int_eq(dvi__body_moser_veselov(&body, by, (const double[]){0, .6001, .8001}, w), 0);
}
END_TEST

/* |R^T R - I| of a million turns by w, up to an eighth and a sixth of a full one, is that of the
 * last rounding. With s rounded to one double the same defect in all of them is 1e-11 and more;
 * with w of simple fractions, as .025, one-sided rounding of plain products is 1e-13. */
START_TEST(a_million_equal_turns_keep_to_the_group)
{
  static const double turns[][3] = {{.025, -.03, .035}, {0, .3, 0}, {.3, .4, .1}, {0, 0, .05}};
  double R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, carry[9] = {0};
  const dvi__turn turn = dvi__turn_of(turns[_i]);
  const int count = repeats(1000000);
  for (int i = 0; i < count; i++) dvi__turn_rows(&turn, 9, R, carry);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      ck_assert_double_eq_tol(R[i] * R[j] + R[3 + i] * R[3 + j] + R[6 + i] * R[6 + j], i == j,
                              4e-16);
}
END_TEST

START_TEST(turns_back_undo_turns)
{
  const double x[] = {.3, -.5, .7};
  const dvi__turn turn = dvi__turn_of((const double[]){.3, .8, -.4}), back = dvi__turn_back(&turn);
  double there[3], again[3];
  dvi__turn_change(&turn, x, there);
  for (int i = 0; i < 3; i++) there[i] += x[i];
  dvi__turn_change(&back, there, again);
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(there[i] + again[i], x[i], 4e-16);
}
END_TEST

SUITE(moser_veselov)
{
  tcase_add_loop_test(tests, a_leap_solves_its_equation_on_the_branch_of_short_steps, 0, 2);
  tcase_add_test(tests, short_leaps_take_two_iterations);
  tcase_add_loop_test(tests, a_sphere_can_be_solved_up_to_a_quarter_turn, 0, 2);
  tcase_add_loop_test(tests, a_million_equal_turns_keep_to_the_group, 0, 4);
  tcase_add_test(tests, turns_back_undo_turns);
}
