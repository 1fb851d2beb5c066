/* labels: unit */
/* Events are located to a part of the step, in whatever unit time is measured and wherever the
 * clock stands. */
#include <float.h>
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"

/* A point moves freely, and g is a function of time alone, so only the search can err. */
typedef struct clock {
  double unit, zero;
  double found;
} clock;

/* Functions that are flat at the zero, or without a useful slope, need many bisections. */
static int cube(double t, const double *q, const double *v, double *g, void *user)
{
  const clock *c = user;
  (void)q, (void)v;
  *g = pow((t - c->zero) / c->unit, 3);
  return 0;
}

static int sign(double t, const double *q, const double *v, double *g, void *user)
{
  const clock *c = user;
  (void)q, (void)v;
  *g = t < c->zero ? -1 : 1;
  return 0;
}

static int note(double t, const double *q, const double *v, void *user)
{
  clock *c = user;
  (void)q, (void)v;
  c->found = t;
  return 0;
}

static int no_potential(double t, const double *q, double *V, void *user)
{
  (void)t, (void)q, (void)user;
  *V = 0;
  return 0;
}

/* Locate the zero 7.3 units after `begin` in steps of one unit. */
static double error_in_units(double unit, double begin,
                             int (*value)(double, const double *, const double *, double *, void *))
{
  clock c = {unit, begin + 7.3 * unit, (double)NAN};
  const double q = 1, p = 0;
  const dvi_potential free_motion = {.name = "none", .value = no_potential};
  const dvi_system_terms terms = {
      .dimension = 1, .mass.scalar = 1, .potentials = &free_motion, .potential_count = 1};
  const dvi_event event = {.name = "alarm", .value = value, .occurred = note, .user = &c};
  const dvi_run_options options = {
      .h = unit, .t_end = begin + 10 * unit, .events = &event, .event_count = 1};
  dvi_system *system = NULL;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  dvi_integrator *integrator = create_integrator(system, "verlet");
  ck_assert_int_eq(dvi_integrator_start(integrator, begin, &q, &p), DVI_OK);
  ck_assert_msg(dvi_run(integrator, &options, NULL) == DVI_OK, "%s", dvi_last_error());
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  return fabs(c.found - c.zero) / unit;
}

START_TEST(femtoseconds_are_located_as_well_as_years)
{
  static const double units[] = {1e-100, 1e-24, 1e-15, 1e-6, 1, 3e7, 1e24, 1e100};
  ck_assert_double_le(error_in_units(units[_i], 0, cube), 1e-12);
  ck_assert_double_le(error_in_units(units[_i], 0, sign), 1e-12);
}
END_TEST

/* Far from t = 0 times themselves are rounded by half an ulp, so the found times are a few of them
 * off. */
START_TEST(late_events_are_located_to_the_rounding_of_the_clock)
{
  static const double begins[] = {1e3, 1e5, 1e8, -1e5};
  ck_assert_double_le(error_in_units(1, begins[_i], cube),
                      1e-12 + 4 * DBL_EPSILON * fabs(begins[_i]));
  ck_assert_double_le(error_in_units(1, begins[_i], sign),
                      1e-12 + 4 * DBL_EPSILON * fabs(begins[_i]));
}
END_TEST

SUITE(event_scale)
{
  tcase_add_loop_test(tests, femtoseconds_are_located_as_well_as_years, 0, 8);
  tcase_add_loop_test(tests, late_events_are_located_to_the_rounding_of_the_clock, 0, 4);
}
