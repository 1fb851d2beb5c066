/* labels: slow */
/* Kinks on moving meshes: their errors, and what they conserve. */
#include <math.h>

#include "support/field/journeys.h"
#include "support/field/moving_fields.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* ---- a kink ---- */

static int kink_monitor(int64_t count, const double *x, double *m, void *user)
{
  const kink *k = user;
  const double g = 1 / sqrt(1 - k->v * k->v);
  for (int64_t i = 0; i < count; i++) {
    const double u_x = 2 * g / cosh(g * (x[i] - k->x0));
    m[i] = sqrt(1 + u_x * u_x);
  }
  return 0;
}

static double kink_error(const journey *j, const kink *k, int cells, double t)
{
  const kink here = {.v = k->v};
  double worst = 0;
  for (int i = 0; i < cells; i++) {
    const double at = j->x[i] - k->v * t, turn = floor((at + 10) / 20);
    worst = fmax(worst, fabs(j->u[i] - 2 * pi * turn - kink_value(&here, 0, at - 20 * turn)));
  }
  return worst;
}

/* Follow a kink once around, 64 cells, with nodes that rest or that travel with it. */
static void follow_kink(dvi_moving_motion motion, journey *j)
{
  kink fast = {.v = 0.9};
  const double jump = 2 * pi;
  const int moves = motion == DVI_MOVING_FREE;
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .axis = {.from = -10, .to = 10, .periodic = 1},
                                  .cells = 64,
                                  .part = &free_wave,
                                  .mean = &sine_gordon_mean,
                                  .translations = 1,
                                  .motion = motion,
                                  .mu = moves ? 0.01 : 0,
                                  .kappa = moves ? 0.05 : 0,
                                  .monitor = moves ? kink_monitor : NULL,
                                  .jump = &jump,
                                  .user = &fast};
  depart(&terms, kink_wave, &fast, "midpoint", j);
  travel(j, 400, 0.05);
  j->error = kink_error(j, &fast, 64, 20);
}

/* The numbers are those of a program in numpy with derivatives by complex steps, whose mesh is
 * graded on a finer grid. */
START_TEST(kink_travels_with_its_nodes)
{
  journey j;
  follow_kink(DVI_MOVING_FREE, &j);
  ck_assert_double_eq_tol(j.error, 0.076272, 2e-6);
  ck_assert_double_eq_tol(j.first[0], 18.563297, 1e-6);
  ck_assert_double_eq_tol(j.first[1], 17.031876, 1e-6);
  ck_assert(j.drift[0] < 2e-7);
  arrive(&j);
}
END_TEST

START_TEST(momentum_of_a_kink_is_exact)
{
  journey j;
  follow_kink(DVI_MOVING_FREE, &j);
  ck_assert_str_eq(dvi_system_invariant_name(j.system, 1), "momentum_x");
  ck_assert_msg(j.drift[1] < 1e-13, "%g", j.drift[1]);
  arrive(&j);
}
END_TEST

START_TEST(kink_outruns_nodes_that_rest)
{
  journey j;
  follow_kink(DVI_MOVING_PRESCRIBED, &j);
  ck_assert_double_eq_tol(j.error, 0.8367, 1e-3);
  ck_assert_double_eq_tol(j.drift[0], 9.4e-4, 1e-5);
  ck_assert_int_eq(dvi_system_invariant_count(j.system), 1);
  arrive(&j);
}
END_TEST

/* ---- arcs of one length ---- */

/* Give the largest difference of two arcs beside their length. */
static double arc_error(const journey *j, int cells, double stretch)
{
  double least = INFINITY, most = 0;
  for (int k = 0; k < cells; k++) {
    const double l = hypot(j->x[k + 1] - j->x[k], stretch * (j->u[k + 1] - j->u[k]));
    least = fmin(least, l);
    most = fmax(most, l);
  }
  return most / least - 1;
}

START_TEST(arcs_stay_of_one_length_with_exact_momentum)
{
  kink fast = {.v = 0.9};
  const double jump = 2 * pi;
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .axis = {.from = -10, .to = 10, .periodic = 1},
                                  .cells = 64,
                                  .part = &free_wave,
                                  .mean = &sine_gordon_mean,
                                  .translations = 1,
                                  .motion = DVI_MOVING_EQUAL,
                                  .stretch = 1,
                                  .mu = 0.01,
                                  .monitor = kink_monitor,
                                  .jump = &jump,
                                  .user = &fast};
  journey j;
  depart(&terms, kink_wave, &fast, "midpoint", &j);
  travel(&j, 400, 0.05);
  ck_assert(arc_error(&j, 64, 1) < 1e-12);
  ck_assert_double_eq_tol(kink_error(&j, &fast, 64, 20), 0.0654, 1e-4);
  ck_assert(j.drift[0] < 1e-9 && j.drift[1] < 1e-12);
  arrive(&j);
}
END_TEST

/* Give the error of a kink that passes from x = -5 to 4 between walls. */
static double passing_error(int cells, dvi_moving_motion motion)
{
  kink fast = {.v = 0.9, .x0 = -5};
  const int even = motion == DVI_MOVING_EQUAL;
  const double end[2] = {kink_value(&fast, 0, -10), 2 * pi};
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .axis = {.from = -10, .to = 10},
                                  .cells = cells,
                                  .part = &free_wave,
                                  .mean = &sine_gordon_mean,
                                  .translations = 1,
                                  .motion = motion,
                                  .stretch = even,
                                  .mu = even ? 0.4096 / cells / cells : 0,
                                  .monitor = even ? kink_monitor : NULL,
                                  .left = {.kind = DVI_FIXED, .value = end},
                                  .right = {.kind = DVI_FIXED, .value = end + 1},
                                  .user = &fast};
  double worst = 0;
  journey j;
  depart(&terms, kink_wave, &fast, "midpoint", &j);
  travel(&j, 3 * cells, 10. / (3 * cells));
  for (int k = 0; k <= cells; k++)
    worst = fmax(worst, fabs(j.u[k] - kink_value(&fast, 10, j.x[k])));
  if (even) ck_assert(arc_error(&j, cells, 1) < 1e-12);
  arrive(&j);
  return worst;
}

/* Nodes flow into the kink in front of it, and out of it behind. The constraints hand the forces
 * on the masses mu to the field, so that all masses together must vanish with the cells. */
START_TEST(arcs_follow_a_kink_between_walls_to_second_order)
{
  double order = 0, last = passing_error(32, DVI_MOVING_EQUAL);
  ck_assert_double_eq_tol(last, 0.126, 1e-3);
  for (int cells = 64; cells <= 256; cells *= 2) {
    const double error = passing_error(cells, DVI_MOVING_EQUAL), before = order;
    order = log2(last / error);
    ck_assert_msg(order > before, "order %g with %d cells", order, cells);
    last = error;
  }
  ck_assert_double_eq_tol(order, 2, 0.05);
}
END_TEST

START_TEST(nodes_that_rest_follow_a_kink_less)
{
  ck_assert_double_eq_tol(passing_error(64, DVI_MOVING_PRESCRIBED), 0.4247, 1e-3);
  ck_assert(passing_error(64, DVI_MOVING_EQUAL) < 0.04);
}
END_TEST

SUITE(moving_kinks)
{
  tcase_add_test(tests, kink_travels_with_its_nodes);
  tcase_add_test(tests, momentum_of_a_kink_is_exact);
  tcase_add_test(tests, kink_outruns_nodes_that_rest);
  tcase_add_test(tests, arcs_stay_of_one_length_with_exact_momentum);
  tcase_add_test(tests, arcs_follow_a_kink_between_walls_to_second_order);
  tcase_add_test(tests, nodes_that_rest_follow_a_kink_less);
}
