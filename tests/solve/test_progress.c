/* labels: unit */
/* One verdict for one iteration and for many side by side, at every instruction set. */
#include <float.h>
#include <math.h>

#include "num/lanes.h"
#include "solve/progress.h"
#include "support/suite.h"

/* Corrections, and sizes of unknowns, on both sides of every limit that a verdict knows. */
static const double corrections[] = {0,     1e-300, 1e-21, 1e-20,   1.3e-20, 3e-17, 2.7e-17,  2.8e-17,
                                     1e-16, 8e-16,  9e-16, 1.4e-14, 1.5e-14, 1e-13, 1e-9,     0.1,
                                     0.34,  0.35,   0.36,  1,       2,       1e300, HUGE_VAL, (double)NAN};
enum { CORRECTIONS = sizeof corrections / sizeof *corrections, CASES = CORRECTIONS * CORRECTIONS * CORRECTIONS };

static double now[CASES], last[CASES], before[CASES], unknown[CASES], size[CASES];
static int64_t verdicts[CASES];

/* Trails hold what did not stall: finite numbers. */
static int make_cases(void)
{
  int count = 0;
  for (int i = 0; i < CORRECTIONS; i++)
    for (int j = 0; j < CORRECTIONS - 2; j++)
      for (int k = 0; k < CORRECTIONS - 2; k++, count++) {
        now[count] = corrections[i];
        last[count] = corrections[j];
        before[count] = corrections[k];
        unknown[count] = count % 5 == 0 ? 0 : ldexp(1.0, count % 3 - 1);
        size[count] = count % 7 == 0 ? 1000 : 0;
      }
  return count;
}

START_TEST(many_are_judged_as_each_alone)
{
  const int level = _i / 4, patient = _i % 2, sweeps = _i / 2 % 2;
  const dvi__pace pace = dvi__fixed_point_pace(patient, sweeps);
  long seen[3] = {0};
  if (level >= dvi__lanes_levels()) return;
  const int count = make_cases();
  const dvi__trails trails = {last, before, size};
  dvi__lanes_choose(level);
  dvi__judge_all(count, now, unknown, &pace, &trails, verdicts);
  dvi__lanes_choose(-1);
  for (int k = 0, i = 0; i < CORRECTIONS; i++)
    for (int j = 0; j < CORRECTIONS - 2; j++)
      for (int l = 0; l < CORRECTIONS - 2; l++, k++) {
        dvi__trail trail = {corrections[j], corrections[l]};
        const dvi__progress alone = dvi__judge(corrections[i], &trail, &pace, unknown[k], size[k]);
        ck_assert_int_eq(verdicts[k], alone);
        ck_assert(last[k] == corrections[i] || isnan(corrections[i]));
        ck_assert_double_eq(before[k], corrections[j]);
        seen[alone]++;
      }
  ck_assert(seen[DVI__GO_ON] > 0 && seen[DVI__CONVERGED] > 0 && seen[DVI__STALLED] > 0);
}
END_TEST

/* What the fixed point rung of one problem said before there was a loop for many. */
static dvi__progress spelled_out(double correction, double at_last, double at_before, const dvi__pace *pace, double x, double place)
{
  const double own = at_before == 0 ? correction : fmin(correction, at_last * fmin(at_last / at_before, 1));
  if (!isfinite(correction)) return DVI__STALLED;
  if (correction <= 4 * DBL_EPSILON * x && own <= 0.125 * DBL_EPSILON * x) return DVI__CONVERGED;
  if (pace->ahead && at_last > 0 && correction <= 64 * DBL_EPSILON * x &&
      fmin(correction, correction * fmin(correction / at_last, 1)) <= DBL_EPSILON / 16384 * x)
    return DVI__CONVERGED;
  if (at_last == 0) return DVI__GO_ON;
  if (correction >= pace->stagnant * at_last && correction <= pace->noise * (x + place)) return DVI__CONVERGED;
  return correction > pace->slowest * at_last ? DVI__STALLED : DVI__GO_ON;
}

START_TEST(a_verdict_is_what_its_rules_say)
{
  const dvi__pace pace = dvi__fixed_point_pace(_i % 2, _i / 2);
  const int count = make_cases();
  for (int k = 0; k < count; k++) {
    dvi__trail trail = {last[k], before[k]};
    ck_assert_int_eq(dvi__judge(now[k], &trail, &pace, unknown[k], size[k]),
                     spelled_out(now[k], last[k], before[k], &pace, unknown[k], size[k]));
  }
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("progress");
  tcase_add_loop_test(tests, many_are_judged_as_each_alone, 0, 12);
  tcase_add_loop_test(tests, a_verdict_is_what_its_rules_say, 0, 4);
  return run_tests("solve/progress", tests);
}
