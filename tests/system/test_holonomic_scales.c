/* labels: unit */
/* Holonomic constraints whose size, speed or roundings the coordinates do not tell: near the
 * origin, far from it, late, at rest, and beside others in the same memory. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

/* ---- a circle of radius 1 around (c, 0), whose gradient is undefined beyond x = wall ---- */

typedef struct circle {
  double c, wall;
} circle;

static int circle_value(double t, const double *q, double *phi, void *user)
{
  const double x = q[0] - ((const circle *)user)->c;
  (void)t;
  phi[0] = (x * x + q[1] * q[1] - 1) / 2;
  return 0;
}

static int circle_gradient(double t, const double *q, double *phi_q, void *user)
{
  const circle *of = user;
  (void)t;
  if (q[0] > of->wall) return -1;
  phi_q[0] = q[0] - of->c;
  phi_q[1] = q[1];
  return 0;
}

/* ---- a rail y = c sin x, and a drive x = c sin(w t) ---- */

static int rail_value(double t, const double *q, double *phi, void *user)
{
  (void)t;
  phi[0] = q[1] - *(const double *)user * sin(q[0]);
  return 0;
}

static int rail_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t;
  phi_q[0] = -*(const double *)user * cos(q[0]);
  phi_q[1] = 1;
  return 0;
}

static int drive_value(double t, const double *q, double *phi, void *user)
{
  const double *c = user;
  phi[0] = q[0] - c[0] * sin(c[1] * t);
  return 0;
}

static int drive_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)q, (void)user;
  phi_q[0] = 1;
  phi_q[1] = 0;
  return 0;
}

static int drive_rate(double t, const double *q, double *phi_t, void *user)
{
  const double *c = user;
  (void)q;
  phi_t[0] = -c[0] * c[1] * cos(c[1] * t);
  return 0;
}

/* ---- a crank of radius 1 at (c, 0), with its angle as the third coordinate ---- */

static int crank_value(double t, const double *q, double *phi, void *user)
{
  (void)t;
  phi[0] = q[0] - *(const double *)user - cos(q[2]);
  phi[1] = q[1] - sin(q[2]);
  return 0;
}

static int crank_gradient(double t, const double *q, double *phi_q, void *user)
{
  const double entries[] = {1, 0, sin(q[2]), 0, 1, -cos(q[2])};
  (void)t, (void)user;
  memcpy(phi_q, entries, sizeof entries);
  return 0;
}

/* ---- gravity (g[0], g[1]) ---- */

static int gravity_value(double t, const double *q, double *V, void *user)
{
  const double *g = user;
  (void)t;
  *V = g[0] * q[0] + g[1] * q[1];
  return 0;
}

static int gravity_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q;
  memcpy(V_q, user, 2 * sizeof *V_q);
  return 0;
}

static int gravity_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)user;
  memset(V_qq, 0, 4 * sizeof *V_qq);
  return 0;
}

static dvi_system *system_of(int n, dvi_holonomic rows, double *g)
{
  dvi_system *system;
  const dvi_potential gravity = {
      .value = gravity_value, .gradient = gravity_gradient, .hessian = gravity_hessian, .user = g};
  const dvi_system_terms terms = {.dimension = n,
                                  .mass = {.scalar = 1},
                                  .potentials = g != NULL ? &gravity : NULL,
                                  .potential_count = g != NULL,
                                  .holonomics = &rows,
                                  .holonomic_count = 1,
                                  .autonomous = rows.rate == NULL};
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static dvi_system *circle_system(circle *of, double *g)
{
  const dvi_holonomic rows = {
      .name = "circle", .count = 1, .value = circle_value, .gradient = circle_gradient, .user = of};
  return system_of(2, rows, g);
}

/* ---- places ---- */

START_TEST(a_circle_through_the_origin_is_followed)
{
  static const int degrees[] = {2, 8, 12};
  circle of = {1, 10};
  dvi_system *system = circle_system(&of, NULL);
  for (size_t d = 0; d < sizeof degrees / sizeof *degrees; d++) {
    const double q[] = {1 - cos(1), -sin(1)}, v[] = {-sin(1), cos(1)};
    dvi_integrator *integrator = create_integrator(system,
                                                   method_spec("galerkin:degree=%d", degrees[d]));
    ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
    advance(integrator, 0.01, 150);
    /* degree 2 has order 4: it keeps the circle, and its error of the angle is below h^4 */
    const double angle = 0.5, exact[] = {1 - cos(angle), sin(angle)};
    ck_assert_double_le(distance(2, dvi_integrator_q(integrator), exact),
                        degrees[d] == 2 ? 1e-8 : 1e-13);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_start_near_the_origin_is_on_the_circle)
{
  circle of = {1, 10};
  dvi_system *system = circle_system(&of, NULL);
  dvi_integrator *integrator = create_integrator(system, "galerkin:degree=2");
  const double on[] = {1 - cos(1e-6), sin(1e-6)}, v[] = {sin(1e-6), cos(1e-6)};
  ck_assert_msg(dvi_integrator_start_velocity(integrator, 0, on, v) == DVI_OK, "%s",
                dvi_last_error());
  const double off[] = {1e-12, sin(1e-6)};
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, off, v), DVI_BAD_ARGUMENT);
  check_words("constraint 'circle' is");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_start_by_velocity_is_checked_as_one_by_momentum)
{
  circle of = {0, 10};
  dvi_system *system = circle_system(&of, NULL);
  dvi_integrator *integrator = create_integrator(system, "trapezoidal");
  const double on[] = {0, -1}, off[] = {0, -1.1}, along[] = {1, 0}, away[] = {1, 0.1};
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, off, along), DVI_BAD_ARGUMENT);
  check_words("constraint 'circle' is");
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, on, away), DVI_BAD_ARGUMENT);
  check_words("its rate along the velocity");
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, on, along), DVI_OK);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_system_at_rest_stays_at_rest)
{
  static const char *const methods[] = {"trapezoidal", "midpoint", "galerkin:degree=3",
                                        "composition"};
  circle of = {0, 10};
  double g[] = {9.81 * 0.8, 9.81 * 0.6};
  const double q[] = {-0.8, -0.6}, p[] = {0, 0};
  dvi_system *system = circle_system(&of, g);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_integrator *integrator = create_integrator(system, methods[m]);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
    advance(integrator, 0.05, 400);
    ck_assert_double_le(distance(2, dvi_integrator_q(integrator), q), 1e-13);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

/* ---- multipliers ---- */

/* The drive turns at these times, so that the velocity is 0 and says nothing about its scale. */
START_TEST(multipliers_of_fast_drives_are_right_at_late_times)
{
  static const double frequency[] = {2, 20, 200}, times[] = {0.3, 1e3, 1e4};
  for (int w = 0; w < 3; w++)
    for (int k = 0; k < 3; k++) {
      double c[] = {0.3, frequency[w]}, lambda;
      const double pi = acos(-1), turns = floor(times[k] * c[1] / (2 * pi)),
                   t = (pi / 2 + 2 * pi * turns) / c[1], q[] = {c[0] * sin(c[1] * t), 0},
                   v[] = {c[0] * c[1] * cos(c[1] * t), 0};
      const dvi_holonomic rows = {.name = "drive",
                                  .count = 1,
                                  .value = drive_value,
                                  .gradient = drive_gradient,
                                  .rate = drive_rate,
                                  .user = c};
      dvi_system *system = system_of(2, rows, NULL);
      dvi_integrator *integrator = create_integrator(system, "galerkin:degree=3");
      ck_assert_int_eq(dvi_integrator_start_velocity(integrator, t, q, v), DVI_OK);
      ck_assert_int_eq(dvi_integrator_reactions(integrator, &lambda), DVI_OK);
      /* the phase w t has a rounding of w t epsilon, and the step is some 1e-2/w */
      ck_assert_double_eq_tol(lambda, c[0] * c[1] * c[1], 1e-8 * c[0] * c[1] * c[1]);
      dvi_integrator_destroy(&integrator);
      dvi_system_destroy(&system);
    }
}
END_TEST

START_TEST(multipliers_do_not_depend_on_the_origin)
{
  for (double c = 1; c < 2e5; c *= 10) {
    const dvi_holonomic rows = {
        .name = "crank", .count = 2, .value = crank_value, .gradient = crank_gradient, .user = &c};
    dvi_system *system = system_of(3, rows, NULL);
    dvi_integrator *integrator = create_integrator(system, "galerkin:degree=3");
    const double a = 0.3, q[] = {c + cos(a), sin(a), a}, v[] = {-sin(a), cos(a), 1};
    double lambda[2];
    ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
    ck_assert_int_eq(dvi_integrator_reactions(integrator, lambda), DVI_OK);
    ck_assert_double_eq_tol(lambda[0], cos(a), 1e-10);
    ck_assert_double_eq_tol(lambda[1], sin(a), 1e-10);
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&system);
  }
}
END_TEST

/* ---- shared memory ---- */

START_TEST(members_that_start_together_have_the_bits_of_runs_alone)
{
  enum { MEMBERS = 4, STEPS = 3 };
  static double slope[MEMBERS] = {0.3, -0.5, 1, 2};
  static double g[] = {0, 9.81};
  const double origin[2 * MEMBERS] = {0};
  double q[2 * MEMBERS];
  dvi_system *systems[MEMBERS];
  for (int k = 0; k < MEMBERS; k++) {
    const dvi_holonomic rows = {.name = "rail",
                                .count = 1,
                                .value = rail_value,
                                .gradient = rail_gradient,
                                .user = &slope[k]};
    systems[k] = system_of(2, rows, g);
  }
  const dvi_ensemble_options options = {.members = MEMBERS,
                                        .systems = (const dvi_system *const *)systems};
  dvi_ensemble *e = create_ensemble(NULL, "trapezoidal", options);
  ck_assert_int_eq(dvi_ensemble_start_velocity(e, 0, origin, origin), DVI_OK);
  for (int step = 0; step < STEPS; step++)
    ck_assert_int_eq(dvi_ensemble_advance(e, 0.05, 1), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(e, NULL, q, NULL), DVI_OK);
  for (int k = 0; k < MEMBERS; k++) {
    dvi_integrator *alone = create_integrator(systems[k], "trapezoidal");
    ck_assert_int_eq(dvi_integrator_start(alone, 0, origin, origin), DVI_OK);
    advance(alone, 0.05, STEPS);
    for (int i = 0; i < 2; i++) ck_assert_double_eq(dvi_integrator_q(alone)[i], q[i * MEMBERS + k]);
    dvi_integrator_destroy(&alone);
  }
  dvi_ensemble_destroy(&e);
  for (int k = 0; k < MEMBERS; k++) dvi_system_destroy(&systems[k]);
}
END_TEST

START_TEST(a_failed_step_leaves_nothing_behind)
{
  circle of = {0, 0.9};
  double g[] = {0, 9.81}, first[2];
  dvi_system *system = circle_system(&of, g);
  dvi_integrator *integrator = create_integrator(system, "trapezoidal");
  const double q[] = {0, -1}, v[] = {1, 0}, near_wall[] = {sin(1.1), -cos(1.1)},
               towards[] = {3 * cos(1.1), 3 * sin(1.1)};
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  advance(integrator, 0.05, 1);
  memcpy(first, dvi_integrator_q(integrator), sizeof first);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, near_wall, towards), DVI_OK);
  ck_assert_int_eq(dvi_integrator_step(integrator, 0.05), DVI_CALLBACK_FAILED);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  advance(integrator, 0.05, 1);
  ck_assert_mem_eq(dvi_integrator_q(integrator), first, sizeof first);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(holonomic_scales)
{
  tcase_add_test(tests, a_circle_through_the_origin_is_followed);
  tcase_add_test(tests, a_start_near_the_origin_is_on_the_circle);
  tcase_add_test(tests, a_start_by_velocity_is_checked_as_one_by_momentum);
  tcase_add_test(tests, a_system_at_rest_stays_at_rest);
  tcase_add_test(tests, multipliers_of_fast_drives_are_right_at_late_times);
  tcase_add_test(tests, multipliers_do_not_depend_on_the_origin);
  tcase_add_test(tests, members_that_start_together_have_the_bits_of_runs_alone);
  tcase_add_test(tests, a_failed_step_leaves_nothing_behind);
}
