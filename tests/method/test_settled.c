/* labels: unit */
/* Multipliers of dependent rows may no longer shrink while a step's path is still far from its
 * solution. Newton's method goes on until the path is on the constraints to rounding. */
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"

static const double mass = 7040.5, small_row = 4.0911606e-7;

/* T = m/2 (v.v + w^2), V = m (cos(x - y) + z^2),   w = sum_i sin(q_i) v_i */
static double sum_of(const double *q, const double *v)
{
  return sin(q[0]) * v[0] + sin(q[1]) * v[1] + sin(q[2]) * v[2];
}

static int value(double t, const double *q, const double *v, double *L, void *user)
{
  const double w = sum_of(q, v);
  (void)t, (void)user;
  *L = mass / 2 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + w * w) -
       mass * (cos(q[0] - q[1]) + q[2] * q[2]);
  return 0;
}

static int gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                    void *user)
{
  const double w = sum_of(q, v), s = sin(q[0] - q[1]), force[] = {s, -s, -2 * q[2]};
  (void)t, (void)user;
  for (int i = 0; i < 3; i++) {
    L_q[i] = mass * (w * cos(q[i]) * v[i] + force[i]);
    L_v[i] = mass * (v[i] + w * sin(q[i]));
  }
  return 0;
}

/* A sphere, and its row times a small function. */
static int sphere_rows(double t, const double *q, double *phi, void *user)
{
  (void)t, (void)user;
  phi[0] = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1;
  phi[1] = small_row * phi[0] * (1 + q[0] * q[0]);
  return 0;
}

static int sphere_gradients(double t, const double *q, double *phi_q, void *user)
{
  double phi[2];
  (void)sphere_rows(t, q, phi, user);
  for (int i = 0; i < 3; i++) {
    phi_q[i] = 2 * q[i];
    phi_q[3 + i] = small_row * (phi_q[i] * (1 + q[0] * q[0]) + (i == 0 ? 2 * q[0] * phi[0] : 0));
  }
  return 0;
}

START_TEST(every_step_ends_on_the_constraints)
{
  static const char *const methods[] = {"galerkin:degree=2", "galerkin:degree=2,quadrature=lobatto",
                                        "galerkin:degree=3"};
  const dvi_lagrangian lagrangian = {.value = value, .gradient = gradient};
  const dvi_holonomic rows = {
      .name = "sphere", .count = 2, .value = sphere_rows, .gradient = sphere_gradients};
  const dvi_system_terms terms = {.dimension = 3,
                                  .lagrangian = &lagrangian,
                                  .holonomics = &rows,
                                  .holonomic_count = 1,
                                  .autonomous = 1};
  const double q[] = {1, 0, 0}, v[] = {0, 1.487, 0.3};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, methods[_i]);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  for (int k = 0; k < 20; k++) {
    double off;
    advance(integrator, 0.389, 1);
    ck_assert_int_eq(dvi_integrator_constraint(integrator, &off), DVI_OK);
    ck_assert_double_le(off, 1e-13);
  }
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(settled)
{
  tcase_add_loop_test(tests, every_step_ends_on_the_constraints, 0, 3);
}
