/* labels: slow */
/* Waves and kinks on meshes of triangles that move: their errors, and what they conserve. */
#include <math.h>
#include <string.h>

#include "support/field/journeys.h"
#include "support/field/planes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* ---- conservation ---- */

/* Energy is off by the square of the step, and does not drift. */
START_TEST(three_momenta_are_exact_and_energy_is_bounded)
{
  double speed = 0.2;
  const dvi_generator_options torus = {
      .size = sizeof torus, .cells = {3, 3}, .extent = {1, 1}, .periodic = {1, 1}};
  dvi_mesh *mesh = plane_mesh(&torus, shake, NULL);
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .mesh = mesh,
                                  .part = &plane_quartic,
                                  .translations = 1,
                                  .points = 3,
                                  .mu = 0.02,
                                  .kappa = 0.05};
  journey j;
  depart(&terms, plane_bump, &speed, "midpoint", &j);
  const char *name[] = {"energy", "momentum_x", "momentum_y", "momentum_u"};
  for (int i = 0; i < 4; i++) ck_assert_str_eq(dvi_system_invariant_name(j.system, i), name[i]);
  travel(&j, repeats(10000), 0.01);
  for (int i = 1; i < 4; i++) ck_assert_msg(j.drift[i] < 1e-13, "drift %d: %g", i, j.drift[i]);
  ck_assert_msg(j.drift[0] < 0.02 * j.first[0], "%g of %g", j.drift[0], j.first[0]);
  arrive(&j);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- a kink along the diagonal ---- */

/* Follow a kink of speed 0.9 along the diagonal of a torus, with nodes that rest on equal cells, or
 * travel with it. */
static void follow_kink(int cells, dvi_moving_motion motion, journey *j)
{
  plane_kink fast = {.v = 0.9, .period = 10};
  const double jump[2] = {2 * pi, 2 * pi}, length = 10 * sqrt(2);
  const int moves = motion == DVI_MOVING_FREE, nodes = cells * cells;
  const dvi_generator_options torus = {.size = sizeof torus,
                                       .cells = {cells, cells},
                                       .extent = {length, length},
                                       .periodic = {1, 1}};
  dvi_mesh *mesh = plane_mesh(&torus, moves ? grade_for_kink : NULL, &fast);
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .mesh = mesh,
                                  .part = &plane_sine_gordon,
                                  .translations = 1,
                                  .points = 6,
                                  .motion = motion,
                                  .mu = moves ? 0.01 : 0,
                                  .kappa = moves ? 0.05 : 0,
                                  .jump = jump};
  depart(&terms, plane_kink_wave, &fast, "midpoint", j);
  travel(j, 100, 0.1);
  for (int k = 0; k < nodes; k++) {
    const double place[2] = {j->x[k], j->x[nodes + k]};
    j->error = fmax(j->error, fabs(j->u[k] - plane_kink_value(&fast, 10, place)));
  }
  dvi_mesh_destroy(&mesh);
}

/* Momenta are 221. */
START_TEST(kink_travels_with_its_nodes)
{
  journey j;
  follow_kink(16, DVI_MOVING_FREE, &j);
  ck_assert_double_eq_tol(j.error, 0.4685, 1e-3);
  ck_assert_msg(j.drift[1] < 1e-12 && j.drift[2] < 1e-12, "%g %g", j.drift[1], j.drift[2]);
  arrive(&j);
}
END_TEST

START_TEST(kink_outruns_nodes_that_rest)
{
  journey j;
  follow_kink(16, DVI_MOVING_PRESCRIBED, &j);
  ck_assert_double_eq_tol(j.error, 2.4957, 1e-3);
  arrive(&j);
}
END_TEST

/* ---- order ---- */

static const double amplitude = 0.1, omega = 2 * 3.14159265358979323846 * 1.41421356237309504880;

static int standing(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                    double *velocity, void *user)
{
  (void)u_t, (void)user;
  for (int64_t k = 0; k < count; k++) {
    const double a = 2 * pi * x[k], b = 2 * pi * x[count + k];
    u[k] = amplitude * cos(a) * cos(b);
    u_x[k] = -2 * pi * amplitude * sin(a) * cos(b);
    u_x[count + k] = -2 * pi * amplitude * cos(a) * sin(b);
    velocity[k] = 0.3 * sin(b);
    velocity[count + k] = 0.2;
  }
  return 0;
}

/* Give the root of the mean square error at nodes of a standing wave on a torus. */
static double standing_error(int cells, dvi_moving_motion motion)
{
  double t = 0.25, gently = 0.3;
  const int moves = motion == DVI_MOVING_FREE, nodes = cells * cells;
  const dvi_generator_options torus = {
      .size = sizeof torus, .cells = {cells, cells}, .extent = {1, 1}, .periodic = {1, 1}};
  dvi_mesh *mesh = plane_mesh(&torus, shake, &gently);
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .mesh = mesh,
                                  .part = &plane_wave,
                                  .translations = 1,
                                  .points = 3,
                                  .motion = motion,
                                  .path = moves ? NULL : plane_sway,
                                  .mu = moves ? 1.0 / nodes : 0,
                                  .kappa = moves ? 1 : 0};
  journey j;
  depart(&terms, standing, NULL, "midpoint", &j);
  travel(&j, 2 * cells, t / (2 * cells));
  double sum = 0;
  for (int k = 0; k < nodes; k++) {
    const double a = 2 * pi * j.x[k], b = 2 * pi * j.x[nodes + k];
    sum += pow(j.u[k] - amplitude * cos(a) * cos(b) * cos(omega * t), 2) / nodes;
  }
  arrive(&j);
  dvi_mesh_destroy(&mesh);
  return sqrt(sum);
}

/* The mesh is coarse for the first of the sizes, whose order is below 2. */
static void check_order(dvi_moving_motion motion)
{
  double order = 0, last = standing_error(6, motion);
  for (int cells = 12; cells <= 24; cells *= 2) {
    const double error = standing_error(cells, motion), before = order;
    order = log2(last / error);
    ck_assert_msg(order > before, "order %g with %d cells", order, cells);
    last = error;
  }
  ck_assert_double_eq_tol(order, 2, 0.15);
}

START_TEST(waves_have_second_order_on_free_nodes)
{
  check_order(DVI_MOVING_FREE);
}
END_TEST

START_TEST(waves_have_second_order_on_nodes_with_a_path)
{
  check_order(DVI_MOVING_PRESCRIBED);
}
END_TEST

enum { BUMP = 3 * 16 /* coordinates */ };

/* Take a bump on free nodes to t = 0.5, and give the coordinates there. */
static void pass(int steps, double *q)
{
  double speed = 0.2;
  const dvi_generator_options torus = {
      .size = sizeof torus, .cells = {4, 4}, .extent = {1, 1}, .periodic = {1, 1}};
  dvi_mesh *mesh = plane_mesh(&torus, shake, NULL);
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .mesh = mesh,
                                  .part = &plane_quartic,
                                  .translations = 1,
                                  .mu = 0.02,
                                  .kappa = 0.05};
  journey j;
  depart(&terms, plane_bump, &speed, "midpoint", &j);
  travel(&j, steps, 0.5 / steps);
  memcpy(q, dvi_integrator_q(j.integrator), BUMP * sizeof *q);
  arrive(&j);
  dvi_mesh_destroy(&mesh);
}

/* The state that is compared has 8 times the steps of the last one, so that its error adds 0.02 to
 * the last order. */
START_TEST(midpoint_has_second_order_in_time)
{
  double exact[BUMP], q[BUMP], last = 0;
  pass(1280, exact);
  for (int steps = 20; steps <= 160; steps *= 2) {
    double error = 0;
    pass(steps, q);
    for (int i = 0; i < BUMP; i++) error = fmax(error, fabs(q[i] - exact[i]));
    if (steps > 20) ck_assert_double_eq_tol(log2(last / error), 2, 0.1);
    last = error;
  }
}
END_TEST

SUITE(moving_plane_waves)
{
  tcase_add_test(tests, three_momenta_are_exact_and_energy_is_bounded);
  tcase_add_test(tests, kink_travels_with_its_nodes);
  tcase_add_test(tests, kink_outruns_nodes_that_rest);
  tcase_add_test(tests, waves_have_second_order_on_free_nodes);
  tcase_add_test(tests, waves_have_second_order_on_nodes_with_a_path);
  tcase_add_test(tests, midpoint_has_second_order_in_time);
}
