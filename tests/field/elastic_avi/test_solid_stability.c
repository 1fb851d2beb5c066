/* The growth of small vibrations of solids under their steps, before a run shows it. */
#include <math.h>
#include <string.h>

#include "support/field/generated.h"
#include "support/field/marches.h"
#include "support/field/solids.h"
#include "support/suite.h"

/* A cube of 2 x 2 x 2 boxes of tetrahedra of the linear law, which get shorter along x. */
typedef struct sample {
  double grading, alpha, beta;
  int is_held; /* at the left */
} sample;

static dvi_elastic *cube(sample of)
{
  static const dvi_elastic_condition hold = {.part = "left", .is_steady = 1};
  const dvi_generator_options options = {.cells = {2, 2, 2}, .grading = {of.grading}};
  dvi_elastic_material material = unit_material(DVI_ELASTIC_LINEAR);
  material.alpha = of.alpha;
  material.beta = of.beta;
  return solid_on(generated("kuhn", options), material,
                  (dvi_elastic_terms){.condition = &hold, .conditions = of.is_held});
}

static dvi_stability stability_of(sample of, const char *method, double fraction, double span)
{
  const dvi_march_options how = {.size = sizeof how, .method = method, .fraction = fraction};
  dvi_stability report;
  dvi_elastic *solid = cube(of);
  ck_assert_msg(dvi_elastic_stability(solid, &how, span, &report) == DVI_OK, "%s",
                dvi_last_error());
  dvi_elastic_destroy(&solid);
  return report;
}

/* A march stops at growth, and can go on. */
static void advance(dvi_march *march, double t)
{
  dvi_status status = DVI_STEP_TOO_LARGE;
  while (status == DVI_STEP_TOO_LARGE) status = dvi_march_advance(march, t);
  ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
}

/* The rate at which the logarithm of the amplitude grows in the second half of a run. */
static double rate_of_run(sample of, const char *method, double fraction, double span)
{
  double u[81];
  dvi_elastic *solid = cube(of);
  dvi_march *march = march_of_solid(solid, method, fraction);
  for (int i = 0; i < 81; i++) u[i] = 1e-3 * sin(1.7 * i * i);
  start_march_of_solid(march, u, NULL);
  advance(march, span / 2);
  const double half = observe_march(march, "energy");
  advance(march, span);
  const double rate = log(observe_march(march, "energy") / half) / span;
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
  return rate;
}

/* Rigid motions, which grow linearly with time, do not count, and only roundings are left. */
START_TEST(half_of_the_bounds_is_stable_in_classes)
{
  static const double grading[] = {1, 2, 3, 3.5};
  for (int is_held = 0; is_held < 2; is_held++) {
    const dvi_stability report = stability_of((sample){.grading = grading[_i], .is_held = is_held},
                                              "avi", 0.5, 0);
    ck_assert(report.is_stable);
    ck_assert_double_lt(report.growth - 1, 1e-9);
    ck_assert_double_lt(report.resolution, 1e-5);
    ck_assert_int_eq(report.followed, is_held ? 2 * (81 - 27) : 2 * (81 - 6));
  }
}
END_TEST

/* A run's energy is that of a mode that grows, up to what it has of others and of its phase. */
START_TEST(classes_in_resonance_grow_as_runs_do)
{
  const sample of = {.grading = 3.5};
  const dvi_stability report = stability_of(of, "avi", 0.9, 0);
  const double rate = log(report.growth), span = repeats(1000);
  ck_assert(!report.is_stable);
  ck_assert_ptr_nonnull(strstr(report.schedule, "3 classes of steps"));
  ck_assert_double_eq_tol(rate_of_run(of, "avi", 0.9, span), rate, 4 / span);
}
END_TEST

/* Free steps have no common period here. */
START_TEST(free_steps_in_resonance_are_found_before_a_run)
{
  const sample of = {.grading = 3};
  const dvi_stability report = stability_of(of, "avi:classes=no", 0.9, 1500);
  const double run = rate_of_run(of, "avi:classes=no", 0.9, 1500);
  ck_assert(!report.is_stable);
  ck_assert(report.period == 0);
  ck_assert_ptr_nonnull(strstr(report.schedule, "without a common period"));
  ck_assert_double_gt(run, 0.01);
  ck_assert_double_eq_tol(log(report.growth), run, 0.1 * run);
}
END_TEST

/* A damping beta, which remembers, is searched by Arnoldi's method, and hardly any changes
 * nothing. */
START_TEST(both_searches_find_the_same_growth)
{
  const dvi_stability all = stability_of((sample){.grading = 3.5}, "avi", 0.98, 0),
                      few = stability_of((sample){.grading = 3.5, .beta = 1e-12}, "avi", 0.98, 0);
  ck_assert(!all.is_stable && !few.is_stable);
  ck_assert_double_eq_tol(few.growth, all.growth, 1e-8);
}
END_TEST

START_TEST(dampings_hold_growth_down)
{
  const sample light = {.grading = 3.5, .alpha = 0.05}, heavy = {.grading = 3.5, .alpha = 0.5},
               viscous = {.grading = 3.5, .beta = 1e-4};
  const dvi_stability bare = stability_of((sample){.grading = 3.5}, "avi", 0.98, 0),
                      less = stability_of(light, "avi", 0.98, 0),
                      none = stability_of(heavy, "avi", 0.98, 0),
                      some = stability_of(viscous, "avi", 0.98, 0);
  ck_assert_double_lt(less.growth, bare.growth - 0.01);
  ck_assert(!less.is_stable && none.is_stable);
  ck_assert_double_lt(none.growth - 1, 1e-9);
  ck_assert_double_eq_tol(rate_of_run(light, "avi", 0.98, 400), log(less.growth), 0.01);
  ck_assert_double_lt(rate_of_run(heavy, "avi", 0.98, 40), -0.01);
  ck_assert_double_eq_tol(rate_of_run(viscous, "avi", 0.98, 400), log(some.growth), 0.01);
}
END_TEST

START_TEST(equal_steps_and_spans_below_0_are_refused)
{
  dvi_elastic *solid = cube((sample){.grading = 1});
  const dvi_march_options how = {.size = sizeof how, .method = "verlet"};
  dvi_stability report;
  ck_assert_int_eq(dvi_elastic_stability(solid, &how, 0, &report), DVI_UNSUPPORTED);
  check_words("verlet has equal steps");
  ck_assert_int_eq(dvi_elastic_stability(solid, NULL, -1, &report), DVI_BAD_ARGUMENT);
  check_words("the span is -1");
  dvi_elastic_destroy(&solid);
}
END_TEST

SUITE(solid_stability)
{
  tcase_add_loop_test(tests, half_of_the_bounds_is_stable_in_classes, 0, 4);
  tcase_add_test(tests, classes_in_resonance_grow_as_runs_do);
  tcase_add_test(tests, free_steps_in_resonance_are_found_before_a_run);
  tcase_add_test(tests, both_searches_find_the_same_growth);
  tcase_add_test(tests, dampings_hold_growth_down);
  tcase_add_test(tests, equal_steps_and_spans_below_0_are_refused);
}
