/* labels: jacobian */
/* The time-transformed Lagrangian is what it says, and its derivatives are those of its value. */
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"
#include "system/rescale/transformed.h"

/* A positive function of all coordinates, with and without derivatives of its own. */
static int bowl(double t, const double *q, double *g, void *user)
{
  const int n = *(const int *)user;
  (void)t;
  *g = 1;
  for (int i = 0; i < n; i++) *g += (1 + i) * q[i] * q[i] / 8;
  return 0;
}

static int bowl_gradient(double t, const double *q, double *g_q, void *user)
{
  const int n = *(const int *)user;
  (void)t;
  for (int i = 0; i < n; i++) g_q[i] = (1 + i) * q[i] / 4;
  return 0;
}

static const struct {
  const char *problem, *monitor; /* NULL: bowl */
  /* for Hessians that are differenced, with a relative noise of 1e-10, grown by the entries'
   * spread */
  double tolerance;
} places[] = {
    {"kepler", "distance", 1e-9},          {"kepler", "distance:power=2.5", 1e-9},
    {"kepler", "arclength", 1e-6},         {"kepler", "acceleration", 1e-6},
    {"henon-heiles", "arclength", 1e-6},   {"pythagorean", "distance:bodies=3,dimension=2", 1e-9},
    {"pythagorean", "acceleration", 1e-6}, {"figure-eight", "distance:bodies=3,power=1", 1e-9},
    {"toda", "arclength", 1e-6},           {"double-pendulum", NULL, 1e-6},
    {"stiff-pendulum", NULL, 1e-6},        {"fpu", NULL, 1e-6},
};
enum { PLACES = sizeof places / sizeof *places, MOST = 64 };

/* A point near the start, none of whose numbers is 0 or like another. */
static void generic_point(const problem *model, double *q, double *v)
{
  ck_assert_int_le(model->nq, MOST);
  for (int i = 0; i < model->nq; i++) {
    q[i] = model->q[i] + 0.1 * sin(1.0 + i);
    v[i] = model->v[i] + 0.1 * cos(2.0 + i);
  }
}

static dvi__transformed *transformed(const problem *model, const char *monitor,
                                     dvi_counters *counters)
{
  dvi__transformed *made = NULL;
  dvi_monitor chosen = {
      .function = {
          .name = "bowl", .value = bowl, .gradient = bowl_gradient, .user = (void *)&model->nq}};
  if (monitor != NULL)
    ck_assert_msg(dvi_monitor_read(monitor, &chosen) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi__transformed_create(model->system, &chosen, counters, &made) == DVI_OK, "%s",
                dvi_last_error());
  return made;
}

static double energy_at(const problem *model, const double *q, const double *v)
{
  double p[MOST], invariant[MOST];
  ck_assert_int_eq(dvi_system_momentum(model->system, 0, q, v, p), DVI_OK);
  ck_assert_int_eq(dvi_system_invariants(model->system, 0, q, p, invariant), DVI_OK);
  return invariant[0];
}

/* Off the orbit, so that the terms with E0 - E count. */
START_TEST(its_derivatives_are_those_of_its_value)
{
  problem *model = create_problem(places[_i].problem, NULL);
  dvi_counters counters = {0};
  double q[MOST], v[MOST];
  dvi_derivative_check found;
  dvi__transformed *x = transformed(model, places[_i].monitor, &counters);
  generic_point(model, q, v);
  dvi__transformed_set_energy(x, energy_at(model, q, v) + 0.3);
  const dvi_status status = dvi_system_check(dvi__transformed_system(x), 0, q, v,
                                             places[_i].tolerance, &found);
  ck_assert_msg(status == DVI_OK, "%s, %s: %s", model->name, places[_i].monitor, dvi_last_error());
  /* differences of 6th order, of values with a cancelling E0 */
  ck_assert_double_le(found.gradient_error, 1e-10);
  dvi__transformed_destroy(&x);
  problem_destroy(&model);
}
END_TEST

/* Lg(q,w) = g (L(q,w/g) + E0) for g = r^1.5 on a point of kepler, by hand. */
START_TEST(its_value_is_the_definition)
{
  problem *kepler = create_problem("kepler", NULL);
  dvi_counters counters = {0};
  dvi__transformed *x = transformed(kepler, "distance", &counters);
  const double q[2] = {0.6, -0.8}, w[2] = {0.3, 0.5}, far[2] = {2.4, -3.2}, E0 = -0.4;
  double L;
  dvi__transformed_set_energy(x, E0);
  ck_assert_int_eq(dvi_system_lagrangian(dvi__transformed_system(x), 0, q, w, &L), DVI_OK);
  ck_assert_double_eq_tol(L, (0.3 * 0.3 + 0.5 * 0.5) / 2 + 1 - 0.4, 1e-15); /* r = 1: g = 1 */
  ck_assert_int_eq(dvi_system_lagrangian(dvi__transformed_system(x), 0, far, w, &L), DVI_OK);
  /* r = 4: g = 8 */
  ck_assert_double_eq_tol(L, (0.3 * 0.3 + 0.5 * 0.5) / 2 / 8 + 8 * (0.25 - 0.4), 1e-15);
  dvi__transformed_destroy(&x);
  problem_destroy(&kepler);
}
END_TEST

START_TEST(pairs_of_bodies_are_summed)
{
  problem *model = create_problem("pythagorean", NULL);
  dvi_counters counters = {0};
  dvi_monitor chosen;
  dvi__monitor *monitor;
  double g;
  ck_assert_int_eq(dvi_monitor_read("distance:bodies=3,dimension=2,power=2", &chosen), DVI_OK);
  ck_assert_int_eq(
      dvi__monitor_create(model->system, &chosen, 1, DVI__GRADIENTS, &counters, &monitor), DVI_OK);
  ck_assert_int_eq(dvi__monitor_value(monitor, 1, model->q, &g), DVI_OK);
  /* the triangle of sides 3, 4, 5 */
  ck_assert_double_eq_tol(1 / g, 1.0 / 9 + 1.0 / 16 + 1.0 / 25, 1e-16);
  dvi__monitor_destroy(&monitor);
  problem_destroy(&model);
}
END_TEST

/* ---- the check of a user's monitor ---- */

static int wrong_gradient(double t, const double *q, double *g_q, void *user)
{
  const int n = *(const int *)user;
  const int status = bowl_gradient(t, q, g_q, user);
  g_q[n - 1] += 1e-3;
  return status;
}

START_TEST(a_wrong_gradient_of_a_monitor_is_named)
{
  problem *kepler = create_problem("kepler", NULL);
  dvi_derivative_check found;
  const double q[2] = {0.6, -0.8};
  dvi_monitor monitor = {
      .function = {
          .name = "bowl", .value = bowl, .gradient = bowl_gradient, .user = (void *)&kepler->nq}};
  ck_assert_msg(dvi_monitor_check(kepler->system, &monitor, q, 0, &found) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_double_le(found.gradient_error, 1e-11);
  monitor.function.gradient = wrong_gradient;
  ck_assert_int_eq(dvi_monitor_check(kepler->system, &monitor, q, 0, NULL), DVI_BAD_ARGUMENT);
  check_words("'bowl': dV/dq (1) is");
  ck_assert_int_eq(dvi_monitor_check(kepler->system, NULL, q, 0, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(
      dvi_monitor_check(kepler->system, &(dvi_monitor){.kind = DVI_MONITOR_DISTANCE}, q, 0, NULL),
      DVI_BAD_ARGUMENT);
  check_words("built-in");
  problem_destroy(&kepler);
}
END_TEST

/* ---- specifications ---- */

START_TEST(specifications_are_read)
{
  dvi_monitor m;
  ck_assert_int_eq(dvi_monitor_read("distance", &m), DVI_OK);
  ck_assert_int_eq(m.kind, DVI_MONITOR_DISTANCE);
  ck_assert_double_eq(m.power, 0);
  ck_assert_int_eq(dvi_monitor_read("distance:power=2,bodies=3,dimension=2", &m), DVI_OK);
  ck_assert_double_eq(m.power, 2);
  ck_assert_int_eq(m.bodies, 3);
  ck_assert_int_eq(m.dimension, 2);
  ck_assert_int_eq(dvi_monitor_read("acceleration:power=0.5", &m), DVI_OK);
  ck_assert_int_eq(m.kind, DVI_MONITOR_ACCELERATION);
  ck_assert_int_eq(dvi_monitor_read("arclength", &m), DVI_OK);
  ck_assert_int_eq(m.kind, DVI_MONITOR_ARCLENGTH);
}
END_TEST

static const char *const wrong[][2] = {
    {"", "unknown"},
    {"distances", "unknown"},
    {"distance:", "unknown key"},
    {"distance:power", "not key=value"},
    {"distance:power=", "positive number"},
    {"distance:power=0", "positive number"},
    {"distance:power=-1", "positive number"},
    {"distance:power=nan", "positive number"},
    {"distance:power=inf", "positive number"},
    {"distance:power=1.5x", "positive number"},
    {"distance:power=1,", "unknown key"},
    {"distance:bodies=1.5", "whole number"},
    {"distance:bodies=1e12", "whole number"},
    {"distance:power=1,power=2", "given twice"},
    {"distance:bodies=2,bodies=2", "given twice"},
    {"distance:speed=1", "it takes power, bodies, dimension"},
    {"acceleration:bodies=2", "it takes power"},
    {"arclength:power=1", "it takes none"},
};
enum { WRONG = sizeof wrong / sizeof *wrong };

START_TEST(wrong_specifications_are_refused_with_a_sentence)
{
  dvi_monitor m = {.power = 17};
  ck_assert_msg(dvi_monitor_read(wrong[_i][0], &m) == DVI_BAD_OPTION, "%s", wrong[_i][0]);
  check_words(wrong[_i][1]);
  ck_assert_double_eq(m.power, 17);
}
END_TEST

START_TEST(null_arguments_are_refused)
{
  dvi_monitor m;
  ck_assert_int_eq(dvi_monitor_read(NULL, &m), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_monitor_read("distance", NULL), DVI_BAD_ARGUMENT);
}
END_TEST

SUITE(transformed)
{
  tcase_add_loop_test(tests, its_derivatives_are_those_of_its_value, 0, PLACES);
  tcase_add_test(tests, its_value_is_the_definition);
  tcase_add_test(tests, pairs_of_bodies_are_summed);
  tcase_add_test(tests, a_wrong_gradient_of_a_monitor_is_named);
  tcase_add_test(tests, specifications_are_read);
  tcase_add_loop_test(tests, wrong_specifications_are_refused_with_a_sentence, 0, WRONG);
  tcase_add_test(tests, null_arguments_are_refused);
}
