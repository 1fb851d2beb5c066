/* A rod whose stiffness a(x) rises and falls 40 times: its shape under a load by few cells, its
 * lowest frequency, and its motion. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

enum { MOST = 41 };

static double stiffness(double x)
{
  return 10 / (1 + .95 * sin(2 * 3.14159265358979 * x / .025));
}

static int sample(int64_t count, const double *x, double *a, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) a[i] = stiffness(x[i]);
  return 0;
}

/* l = u_t^2/2 */
static int kinetic(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int i = 0; i < count; i++) {
    if (l) l[i] = z[i] * z[i] / 2;
    if (l_z) l_z[i] = z[i];
    if (l_zz) l_zz[i] = 1;
  }
  return 0;
}

/* l = -a(x) u_x^2/2 */
static int elastic(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < count; i++) {
    const double a = stiffness(x[i]);
    if (l) l[i] = -a * z[i] * z[i] / 2;
    if (l_z) l_z[i] = -a * z[i];
    if (l_zz) l_zz[i] = -a;
  }
  return 0;
}

/* l = -x^2 u */
static int load(int count, double t, const double *x, const double *z, double *l, double *l_z,
                double *l_zz, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < count; i++) {
    if (l) l[i] = -x[i] * x[i] * z[i];
    if (l_z) l_z[i] = -x[i] * x[i];
    if (l_zz) l_zz[i] = 0;
  }
  return 0;
}

static dvi_status make(const char *kind, int parts, dvi_density **rod)
{
  static const dvi_jet u = {0, 0, {0}}, rate = {0, 1, {0}}, slope = {0, 0, {1}};
  const dvi_density_part part[] = {
      {.kind = DVI_DENSITY_KINETIC, .variable = &rate, .variables = 1, .density = kinetic},
      {.kind = DVI_DENSITY_QUADRATIC, .variable = &slope, .variables = 1, .density = elastic},
      {.kind = DVI_DENSITY_QUADRATIC, .variable = &u, .variables = 1, .density = load}};
  const dvi_density_condition fixed = {.part = "boundary", .kind = DVI_FIXED};
  const dvi_axis axis = {.from = 0, .to = 1};
  const dvi_space_options options = {
      .size = sizeof options, .kind = kind, .axis = &axis, .axes = 1, .coefficient = sample};
  dvi_space *space = NULL;
  dvi_density_terms terms = {.size = sizeof terms,
                             .components = 1,
                             .part = part,
                             .parts = parts,
                             .condition = &fixed,
                             .conditions = 1};
  dvi_status status = dvi_space_create(&options, &space);
  terms.space = space;
  if (!status) status = dvi_density_create(&terms, rod);
  dvi_space_destroy(&space); /* the field shares it */
  return status;
}

/* Print the middle of the rod under its load. */
static dvi_status bend(const char *kind)
{
  double U[MOST] = {0}, middle;
  const double x = .5;
  const int value = 0;
  dvi_density *rod = NULL;
  dvi_status status = make(kind, 3, &rod);
  if (!status) status = dvi_density_solve(rod, U, NULL);
  if (!status) status = dvi_space_evaluate(dvi_density_space(rod), &value, U, 1, &x, &middle);
  if (!status) printf("%-24s u(1/2) = %.12e\n", kind, middle);
  dvi_density_destroy(&rod);
  return status;
}

static int arch(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) f[i] = sin(3.14159265358979 * x[i]);
  return 0;
}

/* Print the lowest frequency, and the energy before and after the rod was let go as sin(pi x). */
static dvi_status ring(const char *kind)
{
  const dvi_modes_options one = {.size = sizeof one, .count = 1};
  double U[MOST], q[MOST], p[MOST], eigenvalue, fastest, energy[2];
  dvi_density *rod = NULL;
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  dvi_status status = make(kind, 2, &rod);
  if (!status) status = dvi_density_modes(rod, &one, NULL, &eigenvalue, NULL);
  if (!status) status = dvi_density_fastest(rod, &fastest);
  if (!status) status = dvi_space_interpolate(dvi_density_space(rod), arch, NULL, U);
  if (!status) status = dvi_density_project(rod, U, NULL, q, NULL, p);
  if (!status) status = dvi_density_system(rod, &system);
  if (!status) status = dvi_integrator_create(system, "verlet", &integrator);
  if (!status) status = dvi_integrator_start(integrator, 0, q, p);
  if (!status) status = dvi_integrator_invariant(integrator, 0, &energy[0]);
  for (int i = 0; i < 1000 && !status; i++) status = dvi_integrator_step(integrator, .5 / fastest);
  if (!status) status = dvi_integrator_invariant(integrator, 0, &energy[1]);
  if (!status)
    printf("%-24s omega = %.9f, steps below %.4f, energy %.4f, %.4f at t = %.2f\n", kind,
           sqrt(eigenvalue), 2 / fastest, energy[0], energy[1], dvi_integrator_time(integrator));
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi_density_destroy(&rod);
  return status;
}

int main(void)
{
  static const char *const kinds[] = {"msfem:cells=4,fine=40", "msfem:cells=8,fine=20",
                                      "msfem:cells=16,fine=10", "fem:cells=40,points=80"};
  const dvi_axis period = {.from = 0, .to = .025};
  const dvi_effective_options options = {
      .size = sizeof options, .axis = &period, .axes = 1, .coefficient = sample};
  double effective;
  dvi_status status = dvi_effective_tensor(&options, &effective);
  if (!status) printf("effective stiffness %.12f\n", effective);
  for (int i = 0; i < 4 && !status; i++) status = bend(kinds[i]);
  for (int i = 0; i < 4 && !status; i++) status = ring(kinds[i]);
  if (status) fprintf(stderr, "%s\n", dvi_last_error());
  return status != 0;
}
