/* A kink and an antikink of the phi^4 theory, l = u'^2/2 - u_x^2/2 - (u^2 - 1)^2/4, collide at 0.3
 * of the speed of light, and part again. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* z holds the variables of a part, [variable][point]. */
static int motion(int count, double t, const double *x, const double *z, double *l, double *l_z,
                  double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = z[k] * z[k] / 2;
    if (l_z != NULL) l_z[k] = z[k];
    if (l_zz != NULL) l_zz[k] = 1;
  }
  return 0;
}

static int strain(int count, double t, const double *x, const double *z, double *l, double *l_z,
                  double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = -z[k] * z[k] / 2;
    if (l_z != NULL) l_z[k] = -z[k];
    if (l_zz != NULL) l_zz[k] = -1;
  }
  return 0;
}

static int wells(int count, double t, const double *x, const double *z, double *l, double *l_z,
                 double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    const double u = z[k], w = u * u - 1;
    if (l != NULL) l[k] = -w * w / 4;
    if (l_z != NULL) l_z[k] = -u * w;
    if (l_zz != NULL) l_zz[k] = 1 - 3 * u * u;
  }
  return 0;
}

static const double v = 0.3, apart = 8;

static int start(int64_t count, const double *x, double *u, void *user)
{
  const double gamma = 1 / sqrt(1 - v * v);
  (void)user;
  for (int64_t k = 0; k < count; k++)
    u[k] = tanh(gamma * (x[k] + apart) / sqrt(2)) - tanh(gamma * (x[k] - apart) / sqrt(2)) - 1;
  return 0;
}

static int start_rate(int64_t count, const double *x, double *rate, void *user)
{
  const double gamma = 1 / sqrt(1 - v * v), slope = gamma * v / sqrt(2);
  (void)user;
  for (int64_t k = 0; k < count; k++)
    rate[k] = -slope * (pow(cosh(gamma * (x[k] + apart) / sqrt(2)), -2) +
                        pow(cosh(gamma * (x[k] - apart) / sqrt(2)), -2));
  return 0;
}

/* Follow the field, and print its value at the origin. */
static dvi_status follow(dvi_integrator *integrator, const dvi_density *field, double *U)
{
  const int value[1] = {0};
  const double origin = 0;
  double u = 0, energy = 0, first = 0;
  dvi_status status = dvi_integrator_invariant(integrator, 0, &first);
  for (int n = 0; n <= 800 && status == DVI_OK; n++) {
    if (n % 100 == 0) {
      status = dvi_density_lift(field, 0, dvi_integrator_q(integrator), U);
      if (!status) status = dvi_space_evaluate(dvi_density_space(field), value, U, 1, &origin, &u);
      if (!status) status = dvi_integrator_invariant(integrator, 0, &energy);
      if (!status)
        printf("t = %2.0f: u(0) = %9.6f, energy %.9f\n", dvi_integrator_time(integrator), u,
               energy);
    }
    if (!status) status = dvi_integrator_step(integrator, 0.1);
  }
  if (!status && !(fabs(energy - first) < 1e-6)) status = DVI_NOT_CONVERGED;
  return status;
}

int main(void)
{
  const dvi_axis line = {.from = -40, .to = 40};
  const dvi_jet rate = {.rate = 1}, slope = {.order = {1}}, value = {0};
  const dvi_density_part parts[] = {
      {.kind = DVI_DENSITY_KINETIC, .variable = &rate, .variables = 1, .density = motion},
      {.kind = DVI_DENSITY_QUADRATIC, .variable = &slope, .variables = 1, .density = strain},
      {.kind = DVI_DENSITY_POTENTIAL, .variable = &value, .variables = 1, .density = wells}};
  const dvi_space_options elements = {.size = sizeof elements,
                                      .kind = "fem:degree=4,cells=160,lumped=yes",
                                      .axis = &line,
                                      .axes = 1};
  dvi_density_terms terms = {.size = sizeof terms, .components = 1, .part = parts, .parts = 3};
  dvi_space *space = NULL;
  dvi_density *field = NULL;
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  double *U = NULL;
  dvi_status status = dvi_space_create(&elements, &space);
  const size_t n = (size_t)dvi_space_functions(space);
  if (!status && !(U = (double *)calloc(4 * n, sizeof *U))) status = DVI_NO_MEMORY;
  if (!status) status = dvi_space_interpolate(space, start, NULL, U);
  if (!status) status = dvi_space_interpolate(space, start_rate, NULL, U + n);
  terms.space = space;
  if (!status) status = dvi_density_create(&terms, &field);
  if (!status) status = dvi_density_project(field, U, U + n, U + 2 * n, NULL, U + 3 * n);
  if (!status) status = dvi_density_system(field, &system);
  if (!status) status = dvi_integrator_create(system, "galerkin:degree=3", &integrator);
  if (!status) status = dvi_integrator_start(integrator, 0, U + 2 * n, U + 3 * n);
  if (!status) status = follow(integrator, field, U);
  if (status) fprintf(stderr, "%s: %s\n", dvi_status_name(status), dvi_last_error());
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi_density_destroy(&field);
  dvi_space_destroy(&space);
  free(U);
  return status != DVI_OK;
}
