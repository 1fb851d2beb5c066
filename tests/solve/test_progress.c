/* labels: unit */
/* One verdict for one iteration and for many side by side, at every instruction set. */
#include <float.h>
#include <math.h>

#include "num/simd/lanes.h"
#include "solve/progress.h"
#include "support/suite.h"

/* Iterations whose corrections lie on both sides of every limit that a verdict knows: above the
 * noise they shrink by one factor, or by several modes that hide each other; then there are only
 * roundings. */
enum { ITERATIONS = 40, COURSES = 600 };

static double course[ITERATIONS][COURSES], unknown[COURSES], size[COURSES];

static double number(int seed)
{
  return fabs(sin(12.9898 * seed + 78.233));
}

static void make_courses(void)
{
  for (int k = 0; k < COURSES; k++) {
    const double contraction = 0.001 + 0.6 * number(k) * number(k + 5000),
                 turn = k % 3 == 0 ? 0 : 3 * number(k + 1000);
    const double first = pow(10, -16 * number(k + 2000)),
                 rounding = k % 5 == 0 ? 0 : pow(10, -15 - 4 * number(k + 3000));
    unknown[k] = k % 11 == 0 ? 0 : ldexp(1.0, k % 3 - 1);
    size[k] = k % 7 == 0 ? 1000 : 0;
    for (int i = 0; i < ITERATIONS; i++)
      course[i][k] = first * pow(contraction, i) * fabs(cos(turn * i)) +
                     rounding * number(7 * i + k);
    if (k % 50 == 49) course[3 + k % 7][k] = k % 100 == 49 ? HUGE_VAL : (double)NAN;
  }
}

START_TEST(many_are_judged_as_each_alone)
{
  const int level = _i / 4, patient = _i % 2, sweeps = _i / 2 % 2;
  const dvi__criteria pace = dvi__fixed_point_criteria(patient, sweeps);
  static double last[COURSES], ratio[COURSES], contraction[COURSES], own[COURSES];
  static dvi__history alone[COURSES];
  static int64_t verdicts[COURSES];
  long seen[3] = {0};
  make_courses();
  const dvi__histories trails = {last, ratio, contraction, own, size};
  for (int i = 0; i < ITERATIONS; i++) {
    dvi__lanes_choose(level);
    dvi__test_corrections(COURSES, course[i], unknown, &pace, &trails, verdicts);
    dvi__lanes_choose(-1);
    for (int k = 0; k < COURSES; k++) {
      const dvi__progress verdict = dvi__test_correction(course[i][k], &alone[k], &pace, unknown[k],
                                                         size[k]);
      ck_assert_int_eq(verdicts[k], verdict);
      seen[verdict]++;
    }
  }
  ck_assert(seen[DVI__GO_ON] > 0 && seen[DVI__CONVERGED] > 0 && seen[DVI__STALLED] > 0);
}
END_TEST

/* How many corrections were judged until the verdict, and the verdict itself. */
static int judged(const double *corrections, int count, const dvi__criteria *pace,
                  dvi__progress *verdict)
{
  dvi__history trail = {0};
  int i = 0;
  do *verdict = dvi__test_correction(corrections[i++], &trail, pace, 1, 1);
  while (*verdict == DVI__GO_ON && i < count);
  return i;
}

/* A complex pair of modes: the correction at which they hide each other is small by chance, and the
 * next ones are not. */
START_TEST(a_correction_that_is_small_by_chance_ends_nothing)
{
  enum { MOST = 60 };
  const dvi__criteria pace = dvi__fixed_point_criteria(0, 1);
  double corrections[MOST];
  dvi__progress verdict;
  const double contraction = 0.05 + 0.05 * _i;
  for (int zero = 3; zero < 12; zero++) {
    const double turn = acos(0) / zero; /* cos(turn zero) = 0 */
    for (int i = 0; i < MOST; i++)
      corrections[i] = pow(contraction, i) * (fabs(cos(turn * i)) + 1e-9);
    const int count = judged(corrections, MOST, &pace, &verdict);
    ck_assert_int_eq(verdict, DVI__CONVERGED);
    ck_assert_double_le(pow(contraction, count), DBL_EPSILON / 64);
  }
}
END_TEST

/* Roundings do not keep an iteration from its end: its own part is below a rounding after six
 * corrections, and known to be after ten at most. */
START_TEST(noise_does_not_keep_an_iteration_from_its_end)
{
  enum { MOST = 30 };
  double corrections[MOST];
  dvi__progress verdict;
  for (int sweeps = 0; sweeps < 2; sweeps++) {
    const dvi__criteria pace = dvi__fixed_point_criteria(0, sweeps);
    for (int i = 0; i < MOST; i++)
      corrections[i] = pow(0.002, i) + 4 * DBL_EPSILON * (0.5 + number(i + _i));
    ck_assert_int_le(judged(corrections, MOST, &pace, &verdict), 10);
    ck_assert_int_eq(verdict, DVI__CONVERGED);
  }
}
END_TEST

START_TEST(slow_contraction_is_given_up)
{
  const dvi__criteria pace = dvi__fixed_point_criteria(0, 1);
  const double slow[] = {1, 0.5, 0.25}, growing[] = {1, 1.5}, bad[] = {1, (double)NAN},
               worse[] = {1, HUGE_VAL};
  dvi__progress verdict;
  ck_assert_int_eq(judged(slow, 3, &pace, &verdict), 2);
  ck_assert_int_eq(verdict, DVI__STALLED);
  ck_assert_int_eq(judged(growing, 2, &pace, &verdict), 2);
  ck_assert_int_eq(verdict, DVI__STALLED);
  ck_assert_int_eq(judged(bad, 2, &pace, &verdict), 2);
  ck_assert_int_eq(verdict, DVI__STALLED);
  ck_assert_int_eq(judged(worse, 2, &pace, &verdict), 2);
  ck_assert_int_eq(verdict, DVI__STALLED);
}
END_TEST

SUITE(progress)
{
  tcase_add_loop_test(tests, many_are_judged_as_each_alone, 0, 4 * dvi__lanes_levels());
  tcase_add_loop_test(tests, a_correction_that_is_small_by_chance_ends_nothing, 0, 4);
  tcase_add_loop_test(tests, noise_does_not_keep_an_iteration_from_its_end, 0, 50);
  tcase_add_test(tests, slow_contraction_is_given_up);
}
