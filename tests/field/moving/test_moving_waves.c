/* labels: slow */
/* Waves on moving meshes: waves that break, fronts, viscosity and dispersion, and given paths. */
#include <math.h>

#include "support/field/journeys.h"
#include "support/field/moving_fields.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* ---- a wave that breaks ---- */

/* e_t + (1 + e) e_x = 0 for e = u_x, e = A sin x at t = 0. */
static int steepening(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                      double *velocity, void *user)
{
  const double A = *(const double *)user;
  for (int64_t i = 0; i < count; i++) {
    const double e = A * sin(x[i]);
    u[i] = -A * cos(x[i]);
    u_x[i] = e;
    u_t[i] = -(e + e * e / 2);
    velocity[i] = 0;
  }
  return 0;
}

static double steep_value(double A, double t, double x)
{
  double low = x - t - A * t, high = x - t + A * t;
  for (int i = 0; i < 60; i++) {
    const double xi = (low + high) / 2;
    if (xi + (1 + A * sin(xi)) * t < x)
      low = xi;
    else
      high = xi;
  }
  const double xi = (low + high) / 2;
  const double e = A * sin(xi);
  return -A * cos(xi) + e * e * t / 2;
}

/* Give the root of the mean square error at the nodes shortly before the wave breaks at 1/A. */
static double steep_error(int cells, dvi_moving_motion motion, double *drift)
{
  double A = 0.3, sum = 0;
  const int moves = motion == DVI_MOVING_FREE;
  const double t = 0.8 / A;
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .axis = {.to = 2 * pi, .periodic = 1},
                                  .cells = cells,
                                  .part = &breaking,
                                  .translations = 1,
                                  .motion = motion,
                                  .mu = moves ? 0.02 : 0,
                                  .kappa = moves ? 0.02 : 0};
  journey j;
  depart(&terms, steepening, &A, "midpoint", &j);
  travel(&j, 4 * cells, t / (4 * cells));
  for (int i = 0; i < cells; i++) sum += pow(j.u[i] - steep_value(A, t, j.x[i]), 2);
  *drift = moves ? fmax(j.drift[1], j.drift[2]) : j.drift[1];
  arrive(&j);
  return sqrt(sum / cells);
}

static void check_steep_order(dvi_moving_motion motion)
{
  double drift, last = steep_error(16, motion, &drift);
  for (int cells = 32; cells <= 128; cells *= 2) {
    const double error = steep_error(cells, motion, &drift), order = log2(last / error);
    ck_assert_msg(order > 1.85 && order < 2.1, "order %g with %d cells", order, cells);
    ck_assert_msg(drift < 1e-13, "drift %g with %d cells", drift, cells);
    last = error;
  }
}

START_TEST(breaking_wave_has_second_order_on_resting_nodes)
{
  check_steep_order(DVI_MOVING_PRESCRIBED);
}
END_TEST

START_TEST(breaking_wave_has_second_order_and_exact_momenta_on_free_nodes)
{
  check_steep_order(DVI_MOVING_FREE);
}
END_TEST

/* ---- a front ---- */

static const double front_speed = 1.2583057392117916; /* sqrt(19/12) */

/* u_t^2/2 - W, W' = ((1 + u_x)^3 - 1.5^3)/3, so that an end with u_x = 1/2 is free. */
static int front_density(int count, double t, const double *x, const double *z, double *l,
                         double *l_z, double *l_zz, void *user)
{
  const int returned = breaking.density(count, t, x, z, l, l_z, l_zz, user);
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] += 1.125 * z[count + k];
    if (l_z != NULL) l_z[count + k] += 1.125;
  }
  return returned;
}

static int front_wave(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                      double *velocity, void *user)
{
  const double width = *(const double *)user;
  for (int64_t i = 0; i < count; i++) {
    const double a = x[i] / width;
    u[i] = -width * log1p(exp(-2 * a)) / 4;
    u_x[i] = 0.5 / (1 + exp(2 * a));
    u_t[i] = -front_speed * u_x[i];
    velocity[i] = 0;
  }
  return 0;
}

static double front_place(const journey *j, int cells)
{
  for (int k = cells - 2; k >= 0; k--) {
    const double s = (j->u[k + 1] - j->u[k]) / (j->x[k + 1] - j->x[k]);
    const double next = (j->u[k + 2] - j->u[k + 1]) / (j->x[k + 2] - j->x[k + 1]);
    const double at = (j->x[k] + j->x[k + 1]) / 2, beside = (j->x[k + 1] + j->x[k + 2]) / 2;
    if (s >= 0.25 && next < 0.25) return at + (beside - at) * (s - 0.25) / (s - next);
  }
  return NAN;
}

/* Give the mean speed of a front from t = 4 to 8. */
static double speed_of_front(int cells, dvi_moving_motion motion, double viscosity)
{
  double width = 0.4;
  dvi_density_part part = breaking;
  part.density = front_density;
  const int moves = motion == DVI_MOVING_FREE;
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .axis = {.from = -5, .to = 15},
                                  .cells = cells,
                                  .part = &part,
                                  .translations = 1,
                                  .motion = motion,
                                  .mu = moves ? 0.02 : 0,
                                  .kappa = moves ? 0.02 : 0,
                                  .right = {.kind = DVI_FIXED},
                                  .viscosity = viscosity};
  journey j;
  depart(&terms, front_wave, &width, "midpoint", &j);
  travel(&j, cells, 4. / cells);
  const double from = front_place(&j, cells);
  travel(&j, cells, 4. / cells);
  const double to = front_place(&j, cells);
  arrive(&j);
  return (to - from) / 4;
}

/* The speed is that of Rankine and Hugoniot, sqrt([W']/[u_x]). The profile at the start is not that
 * of this viscosity, which the speed remembers by some 1e-4. */
START_TEST(viscous_front_has_the_speed_of_its_jump)
{
  for (int moves = 0; moves < 2; moves++) {
    const dvi_moving_motion motion = moves ? DVI_MOVING_FREE : DVI_MOVING_PRESCRIBED;
    ck_assert_double_eq_tol(speed_of_front(100, motion, 0.1), front_speed, 5e-4);
    ck_assert_double_eq_tol(speed_of_front(200, motion, 0.1), front_speed, 2e-4);
  }
}
END_TEST

/* ---- viscosity and dispersion ---- */

/* Turn amplitude and rate of M u'' + C u' + K u = 0 by a step of midpoint. */
static void damp(double M, double C, double K, double dt, double *u, double *rate)
{
  const double force = dt * (K * (*u + dt / 2 * *rate) + C * *rate);
  const double change = -force / (M + dt / 2 * C + dt * dt / 4 * K);
  *u += dt * (*rate + change / 2);
  *rate += change;
}

static int standing(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                    double *velocity, void *user)
{
  (void)u_t, (void)velocity, (void)user;
  for (int64_t i = 0; i < count; i++) {
    u[i] = cos(2 * x[i]);
    u_x[i] = -2 * sin(2 * x[i]);
  }
  return 0;
}

/* On equal cells that rest the force on a mode is nu a/h times its rate, a = 2 - 2 cos(k h). */
START_TEST(viscosity_damps_modes)
{
  const double nu = 0.3, h = 2 * pi / 16, a = 2 - 2 * cos(2 * h), dt = 0.05;
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .axis = {.to = 2 * pi, .periodic = 1},
                                  .cells = 16,
                                  .part = &free_wave,
                                  .translations = 1,
                                  .motion = DVI_MOVING_PRESCRIBED,
                                  .viscosity = nu};
  double amplitude = 1, rate = 0;
  journey j;
  depart(&terms, standing, NULL, "midpoint", &j);
  travel(&j, 100, dt);
  for (int k = 0; k < 100; k++) damp(h * (1 - a / 6), nu * a / h, a / h, dt, &amplitude, &rate);
  for (int k = 0; k <= 16; k++) ck_assert_double_eq_tol(j.u[k], amplitude * cos(2 * k * h), 1e-13);
  arrive(&j);
}
END_TEST

START_TEST(viscosity_takes_energy_and_no_vertical_momentum)
{
  double A = 0.3;
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .axis = {.to = 2 * pi, .periodic = 1},
                                  .cells = 32,
                                  .part = &breaking,
                                  .translations = 1,
                                  .mu = 0.02,
                                  .kappa = 0.02,
                                  .viscosity = 0.1};
  double last = INFINITY, energy;
  journey j;
  depart(&terms, steepening, &A, "midpoint", &j);
  for (int k = 0; k < 100; k++) {
    travel(&j, 1, 0.05);
    ck_assert(!dvi_integrator_invariant(j.integrator, 0, &energy));
    ck_assert(energy < last);
    last = energy;
  }
  ck_assert(j.first[0] - energy > 0.02);
  ck_assert_msg(j.drift[2] < 1e-13, "%g", j.drift[2]);
  arrive(&j);
}
END_TEST

/* With a = 2 - 2 cos(k h) the stiffness of a mode is (a + eps^2 a^2/h^2)/h, its mass h (1 - a/6),
 * and midpoint turns it by 2 atan(omega dt/2) a step. */
START_TEST(dispersion_has_its_frequency)
{
  const double eps = 0.3, h = 2 * pi / 16, a = 2 - 2 * cos(2 * h), dt = 0.05;
  const double omega = sqrt((a + eps * eps * a * a / (h * h)) / (1 - a / 6)) / h;
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .axis = {.to = 2 * pi, .periodic = 1},
                                  .cells = 16,
                                  .part = &free_wave,
                                  .translations = 1,
                                  .motion = DVI_MOVING_PRESCRIBED,
                                  .dispersion = eps};
  journey j;
  depart(&terms, standing, NULL, "midpoint", &j);
  travel(&j, 100, dt);
  const double amplitude = cos(100 * 2 * atan(omega * dt / 2));
  for (int k = 0; k <= 16; k++) ck_assert_double_eq_tol(j.u[k], amplitude * cos(2 * k * h), 1e-12);
  arrive(&j);
}
END_TEST

/* At t = 1.5/A the slope would have two values without dispersion. Midpoint keeps the energy within
 * the square of the step, here 1.6e-4. */
START_TEST(dispersion_leads_past_breaking_with_exact_momenta)
{
  double A = 0.3;
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .axis = {.to = 2 * pi, .periodic = 1},
                                  .cells = 64,
                                  .part = &breaking,
                                  .translations = 1,
                                  .mu = 0.02,
                                  .kappa = 0.02,
                                  .dispersion = 0.1};
  journey j;
  depart(&terms, steepening, &A, "midpoint", &j);
  travel(&j, 200, 1.5 / A / 200);
  for (int i = 0; i < 3; i++)
    ck_assert_msg(j.drift[i] < (i == 0 ? 2e-4 : 1e-13), "drift %d: %g", i, j.drift[i]);
  arrive(&j);
}
END_TEST

/* ---- paths that are given ---- */

static int sway(int count, double t, const double *X, double *x, double *rate, void *user)
{
  (void)user;
  for (int k = 0; k < count; k++) {
    x[k] = X[k] + 0.3 * sin(X[k] + 2 * t);
    rate[k] = 0.6 * cos(X[k] + 2 * t);
  }
  return 0;
}

static const double affine_rate = 0.7, affine_slope = 1.3;

static int affine(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                  double *velocity, void *user)
{
  (void)velocity, (void)user;
  for (int64_t i = 0; i < count; i++) {
    u[i] = affine_slope * x[i];
    u_x[i] = affine_slope;
    u_t[i] = affine_rate;
  }
  return 0;
}

/* Give the largest distance of u from an affine field at t = 1. */
static double affine_error(double dt, double path_step)
{
  const double jump = 2 * pi * affine_slope;
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .axis = {.to = 2 * pi, .periodic = 1},
                                  .cells = 16,
                                  .part = &free_wave,
                                  .translations = 1,
                                  .motion = DVI_MOVING_PRESCRIBED,
                                  .path = sway,
                                  .path_step = path_step,
                                  .jump = &jump};
  journey j;
  double worst = 0;
  depart(&terms, affine, NULL, "midpoint", &j);
  travel(&j, (int)lround(1 / dt), dt);
  for (int k = 0; k <= 16; k++)
    worst = fmax(worst, fabs(j.u[k] - affine_rate - affine_slope * j.x[k]));
  arrive(&j);
  return worst;
}

/* The field is 14 at most, and takes a rounding of its size each step. */
START_TEST(prescribed_nodes_keep_affine_fields)
{
  ck_assert(affine_error(0.05, 0.05) < 5e-15);
}
END_TEST

/* ---- tangled meshes ---- */

static int crash(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                 double *velocity, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) {
    u[i] = sin(x[i]);
    u_x[i] = cos(x[i]);
    u_t[i] = 0;
    velocity[i] = -5 * sin(x[i]);
  }
  return 0;
}

/* Otherwise u is straight over a step, and the nodes are not. */
START_TEST(nodes_on_curved_paths_keep_affine_fields_to_second_order)
{
  double last = affine_error(0.01, 0);
  for (int steps = 200; steps <= 800; steps *= 2) {
    const double error = affine_error(1. / steps, 0);
    ck_assert_double_eq_tol(log2(last / error), 2, 0.01);
    last = error;
  }
}
END_TEST

START_TEST(tangled_mesh_is_named)
{
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .axis = {.to = 2 * pi, .periodic = 1},
                                  .cells = 16,
                                  .part = &free_wave,
                                  .translations = 1,
                                  .mu = 1};
  journey j;
  depart(&terms, crash, NULL, "midpoint", &j);
  dvi_status status = DVI_OK;
  for (int k = 0; k < 100 && !status; k++) status = dvi_integrator_step(j.integrator, 0.05);
  ck_assert_int_eq(status, DVI_CALLBACK_RETRY);
  check_words("the mesh is tangled, cell 0 of 16 reaches from");
  check_words("take a smaller step or a larger kappa");
  arrive(&j);
}
END_TEST

SUITE(moving_waves)
{
  tcase_add_test(tests, breaking_wave_has_second_order_on_resting_nodes);
  tcase_add_test(tests, breaking_wave_has_second_order_and_exact_momenta_on_free_nodes);
  tcase_add_test(tests, viscous_front_has_the_speed_of_its_jump);
  tcase_add_test(tests, viscosity_damps_modes);
  tcase_add_test(tests, viscosity_takes_energy_and_no_vertical_momentum);
  tcase_add_test(tests, dispersion_has_its_frequency);
  tcase_add_test(tests, dispersion_leads_past_breaking_with_exact_momenta);
  tcase_add_test(tests, prescribed_nodes_keep_affine_fields);
  tcase_add_test(tests, nodes_on_curved_paths_keep_affine_fields_to_second_order);
  tcase_add_test(tests, tangled_mesh_is_named);
}
