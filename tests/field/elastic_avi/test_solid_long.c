/* labels: invariant long */
/* Long marches of the block with layers at (i/2)^g: momenta, energies, and growth that is foreseen.
 * With DVI_SHOW_ORDERS in the environment the numbers are printed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/field/marches.h"
#include "support/field/solids.h"
#include "support/suite.h"

static dvi_march *begin(const dvi_elastic *elastic, const char *method, double fraction,
                        double size)
{
  double rate[81];
  dvi_march *march = march_of_solid(elastic, method, fraction);
  spin_block(elastic, size, rate);
  start_march_of_solid(march, NULL, rate);
  return march;
}

/* ---- momenta ---- */

static const char *const momenta[] = {"momentum_x", "momentum_y", "momentum_z",
                                      "angular_x",  "angular_y",  "angular_z"};

static void take_momenta(const dvi_march *march, double *value)
{
  for (int k = 0; k < 6; k++) value[k] = observe_march(march, momenta[k]);
}

/* The distance from the origin. */
static double place_of(const dvi_march *march)
{
  double *u = sample_march(march, DVI_FORM_A);
  const double place = hypot(hypot(u[0], u[1]), u[2]);
  free(u);
  return place;
}

static double change_of(int from, int to, const double *before, const double *after)
{
  double most = 0;
  for (int k = from; k < to; k++) most = fmax(most, fabs(after[k] - before[k]));
  return most;
}

static void check_momenta(const char *method, double events)
{
  dvi_elastic *elastic = block(3, 2, 2, DVI_ELASTIC_SVK);
  dvi_march *march = begin(elastic, method, 0.5, 1);
  dvi_march_facts facts = {0};
  double before[6], after[6];
  take_momenta(march, before);
  for (double t = 10; (double)facts.updates < events; t += 10) {
    advance_march(march, t);
    dvi_march_facts_of(march, &facts);
  }
  take_momenta(march, after);
  const double linear = change_of(0, 3, before, after), angular = change_of(3, 6, before, after),
               lever = 1 + place_of(march);
  if (getenv("DVI_SHOW_ORDERS"))
    fprintf(stderr,
            "%s: momenta change by %.2e, angular ones by %.2e with a lever of %g, in %lld "
            "events\n",
            method, linear, angular, lever, (long long)facts.updates);
  ck_assert_double_le(linear, 3e-12);
  ck_assert_double_le(angular, 3e-12 * lever);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&elastic);
}

/* Each event leaves a rounding of 1e-17 in a momentum of 0.1, and their sum walks at random. Of the
 * angular one the distance that the block has gone is a factor. */
START_TEST(momenta_stay_over_ten_million_events)
{
  const double events = is_short_run() ? 1e5 : 1e7;
  check_momenta("avi", events);
  check_momenta("avi:classes=no", events);
}
END_TEST

/* ---- energies ---- */

typedef struct drift {
  double between_halves, most; /* beside the energy at the start, of its mean and of its change */
  int failed;
} drift;

static drift drift_of(const dvi_elastic *elastic, const char *method, double fraction, double size,
                      double span)
{
  enum { SAMPLES = 2000 };
  dvi_march *march = begin(elastic, method, fraction, size);
  const double first = observe_march(march, "energy");
  double half[2] = {0};
  drift d = {0};
  for (int i = 1; i <= SAMPLES && !d.failed; i++) {
    d.failed = dvi_march_advance(march, span * i / SAMPLES) != DVI_OK;
    if (d.failed) break;
    const double energy = observe_march(march, "energy");
    half[2 * i > SAMPLES] += 2 * energy / SAMPLES;
    d.most = fmax(d.most, fabs(energy / first - 1));
  }
  d.between_halves = fabs(half[1] - half[0]) / first;
  if (getenv("DVI_SHOW_ORDERS"))
    fprintf(stderr, "%s, %g, size %g: halves %.2e, most %.2e%s\n", method, fraction, size,
            d.between_halves, d.most, d.failed ? ", failed" : "");
  dvi_march_destroy(&march);
  return d;
}

static double span_of_run(void)
{
  return is_short_run() ? 100 : 4000;
}

/* Classes have a common period, after which small vibrations return to their
 * energy. Free steps have not. */
START_TEST(small_vibrations_keep_their_energy)
{
  dvi_elastic *elastic = block(3, 2, 2, DVI_ELASTIC_SVK);
  const drift classes = drift_of(elastic, "avi", 0.5, 0.01, span_of_run()),
              free_steps = drift_of(elastic, "avi:classes=no", 0.5, 0.01, span_of_run());
  ck_assert_double_le(classes.between_halves, is_short_run() ? 1e-5 : 2e-6);
  ck_assert_double_le(free_steps.between_halves, 3e-3);
  dvi_elastic_destroy(&elastic);
}
END_TEST

START_TEST(large_motions_keep_their_energy)
{
  dvi_elastic *elastic = block(3, 2, 2, DVI_ELASTIC_SVK);
  const drift classes = drift_of(elastic, "avi", 0.5, 1, span_of_run()),
              free_steps = drift_of(elastic, "avi:classes=no", 0.7, 1, span_of_run());
  ck_assert_double_le(classes.most, 1.75e-3);
  ck_assert_double_le(free_steps.most, 0.035);
  dvi_elastic_destroy(&elastic);
}
END_TEST

/* ---- blow-ups ---- */

static dvi_stability stability_of(const dvi_elastic *elastic, const char *method, double fraction)
{
  const dvi_march_options options = {
      .size = sizeof options, .method = method, .fraction = fraction};
  dvi_stability report = {0};
  ck_assert_msg(dvi_elastic_stability(elastic, &options, 0, &report) == DVI_OK, "%s",
                dvi_last_error());
  if (getenv("DVI_SHOW_ORDERS"))
    fprintf(stderr, "%s, %g: growth %.9f, resolution %.1e, period %g, %s\n", method, fraction,
            report.growth, report.resolution, report.period, report.schedule);
  return report;
}

/* Free steps of 0.9 of the bounds make the energy grow, and the checker says so before. */
START_TEST(growing_vibrations_are_foreseen)
{
  dvi_elastic *elastic = block(3, 2, 3, DVI_ELASTIC_SVK);
  const dvi_stability report = stability_of(elastic, "avi:classes=no", 0.9);
  ck_assert_int_eq(report.is_stable, 0);
  ck_assert_double_gt(report.growth, 1 + report.resolution);
  const drift d = drift_of(elastic, "avi:classes=no", 0.9, 0.01, span_of_run());
  ck_assert(is_short_run() || d.failed || d.most > 1);
  dvi_elastic_destroy(&elastic);
}
END_TEST

START_TEST(classes_are_stable)
{
  for (int grading = 2; grading <= 3; grading++) {
    dvi_elastic *elastic = block(3, 2, grading, DVI_ELASTIC_NEO_HOOKEAN);
    ck_assert_int_eq(stability_of(elastic, "avi", 0.5).is_stable, 1);
    dvi_elastic_destroy(&elastic);
  }
}
END_TEST

SUITE(solid_long)
{
  tcase_add_test(tests, momenta_stay_over_ten_million_events);
  tcase_add_test(tests, small_vibrations_keep_their_energy);
  tcase_add_test(tests, large_motions_keep_their_energy);
  tcase_add_test(tests, growing_vibrations_are_foreseen);
  tcase_add_test(tests, classes_are_stable);
}
