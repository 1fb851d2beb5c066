/* A torque swings a pendulum up at the least cost: declare the pendulum and its control, solve, and
 * print the torque. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

static int value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -cos(q[0]);
  return 0;
}

static int gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = sin(q[0]);
  return 0;
}

static int hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)user;
  V_qq[0] = cos(q[0]);
  return 0;
}

/* The cost u^2/2, and the force u. Derivatives that are not set are 0. */
static int cost(double t, const double *q, const double *v, const double *u, double *C, double *C_q,
                double *C_v, double *C_u, void *user)
{
  (void)t, (void)q, (void)v, (void)C_q, (void)C_v, (void)user;
  *C = u[0] * u[0] / 2;
  C_u[0] = u[0];
  return 0;
}

static int force(double t, const double *q, const double *v, const double *u, double *F,
                 double *F_q, double *F_v, double *F_u, void *user)
{
  (void)t, (void)q, (void)v, (void)F_q, (void)F_v, (void)user;
  F[0] = u[0];
  F_u[0] = 1;
  return 0;
}

static dvi_status print_torque(dvi_control *control)
{
  dvi_status status = DVI_OK;
  for (int k = 0; k <= dvi_control_steps(control) && status == DVI_OK; k += 10) {
    double u;
    status = dvi_control_u(control, k, &u);
    if (status == DVI_OK)
      printf("t = %.2f: angle %.6f, torque %.6f\n", dvi_control_time(control, k),
             dvi_control_q(control, k)[0], u);
  }
  return status;
}

int main(void)
{
  const dvi_potential gravity = {
      .name = "gravity", .value = value, .gradient = gradient, .hessian = hessian};
  const dvi_system_terms terms = {
      .dimension = 1, .mass = {.scalar = 1}, .potentials = &gravity, .potential_count = 1};
  const dvi_controls torque = {.count = 1, .cost = cost, .force = force};
  const double hanging = 0, upright = 3.14159265358979323846, rest = 0;
  const dvi_control_options options = {.steps = 40,
                                       .span = 5,
                                       .dimension = 1,
                                       .q0 = &hanging,
                                       .p0 = &rest,
                                       .q1 = &upright,
                                       .p1 = &rest};
  dvi_system *system = NULL;
  dvi_control *control = NULL;
  dvi_control_report report = {.cost = HUGE_VAL};
  dvi_status status = dvi_system_create(&terms, &system);
  if (status == DVI_OK)
    status = dvi_control_create(system, "galerkin:degree=4", &torque, &options, &control);
  if (status == DVI_OK) status = dvi_control_solve(control, &report);
  if (status == DVI_OK) status = print_torque(control);
  if (status == DVI_OK)
    printf("cost %.12f, a %s\n", report.cost, report.is_minimum == 1 ? "minimum" : "saddle");
  else
    fprintf(stderr, "%s: %s\n", dvi_status_name(status), dvi_last_error());
  dvi_control_destroy(&control);
  dvi_system_destroy(&system);
  return fabs(report.cost - 1.21259059572144) < 1e-12 ? 0 : 1;
}
