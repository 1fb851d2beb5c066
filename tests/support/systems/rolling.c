#include "rolling.h"

#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

/* ---- a plate that moves: sin(a) (x' - u(t)) - cos(a) y' = 0, with u = 0.6 cos 2t ---- */

static int plate_rows(double t, const double *q, double *A, void *user)
{
  (void)t, (void)user;
  A[0] = sin(q[2]);
  A[1] = -cos(q[2]);
  A[2] = 0;
  return 0;
}

static int plate_affine(double t, const double *q, double *a, void *user)
{
  (void)user;
  a[0] = -0.6 * cos(2 * t) * sin(q[2]);
  return 0;
}

static int plate_derivative(double t, const double *q, const double *v, double *Av_q, void *user)
{
  (void)user;
  Av_q[0] = Av_q[1] = 0;
  Av_q[2] = cos(q[2]) * (v[0] - 0.6 * cos(2 * t)) + sin(q[2]) * v[1];
  return 0;
}

static int friction(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)q, (void)user;
  for (int i = 0; i < 3; i++) F[i] = -0.2 * v[i];
  return 0;
}

static const dvi_force friction_force = {.name = "friction", .value = friction};

static dvi_status create_plate(int differenced, rolling *made)
{
  const dvi_nonholonomic rows = {.name = "blade",
                                 .count = 1,
                                 .value = plate_rows,
                                 .affine = plate_affine,
                                 .derivative = differenced ? NULL : plate_derivative};
  const dvi_system_terms terms = {.dimension = 3,
                                  .mass = {.diagonal = (const double[]){1, 1, 0.5}},
                                  .forces = &friction_force,
                                  .force_count = 1,
                                  .nonholonomics = &rows,
                                  .nonholonomic_count = 1};
  *made = (rolling){.name = "plate", .n = 3, .v = {1, 0, 1.5}, .span = 2};
  return dvi_system_create(&terms, &made->system);
}

/* ---- cosines ---- */

static int downhill(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -9.81 * sin(0.3) * q[0];
  return 0;
}

static int downhill_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  memset(V_q, 0, 4 * sizeof *V_q);
  V_q[0] = -9.81 * sin(0.3);
  return 0;
}

static int cosine_rows(double t, const double *q, double *A, void *user)
{
  (void)t, (void)user;
  A[0] = q[3];
  A[1] = -q[2];
  return 0;
}

static int cosine_derivative(double t, const double *q, const double *v, double *Av_q, void *user)
{
  (void)t, (void)q, (void)user;
  Av_q[0] = -v[1];
  Av_q[1] = v[0];
  return 0;
}

static int circle(double t, const double *q, double *phi, void *user)
{
  (void)t, (void)user;
  phi[0] = (q[2] * q[2] + q[3] * q[3] - 1) / 2;
  return 0;
}

static int circle_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)user;
  phi_q[0] = phi_q[1] = 0;
  phi_q[2] = q[2];
  phi_q[3] = q[3];
  return 0;
}

static dvi_status create_cosines(int differenced, rolling *made)
{
  static const int start[] = {0, 2}, row[] = {0, 1}, by_start[] = {0, 0, 0, 1, 2},
                   by_row[] = {0, 0};
  const dvi_potential slope = {.value = downhill, .gradient = downhill_gradient};
  const dvi_nonholonomic rows = {.name = "blade",
                                 .count = 1,
                                 .value = cosine_rows,
                                 .derivative = differenced ? NULL : cosine_derivative,
                                 .transposed = {start, row},
                                 .by_q = {by_start, by_row}};
  const dvi_holonomic unit = {
      .name = "unit", .count = 1, .value = circle, .gradient = circle_gradient};
  const dvi_system_terms terms = {.dimension = 4,
                                  .mass = {.diagonal = (const double[]){1, 1, 0.5, 0.5}},
                                  .potentials = &slope,
                                  .potential_count = 1,
                                  .holonomics = &unit,
                                  .holonomic_count = 1,
                                  .nonholonomics = &rows,
                                  .nonholonomic_count = 1,
                                  .autonomous = 1};
  *made = (rolling){.name = "cosines", .n = 4, .q = {0, 0, 1, 0}, .v = {1, 0, 0, 2}, .span = 5};
  return dvi_system_create(&terms, &made->system);
}

void make_rolling(rolling_kind kind, int differenced, rolling *made)
{
  const dvi_status status = kind == ROLLING_PLATE ? create_plate(differenced, made)
                                                  : create_cosines(differenced, made);
  ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
}

void destroy_rolling(rolling *made)
{
  dvi_system_destroy(&made->system);
}

dvi_integrator *rolling_integrator(const rolling *model, const char *method)
{
  dvi_integrator *integrator = create_integrator(model->system, method);
  const dvi_status status = dvi_integrator_start_velocity(integrator, 0, model->q, model->v);
  ck_assert_msg(status == DVI_OK, "%s: %s", model->name, dvi_last_error());
  return integrator;
}
