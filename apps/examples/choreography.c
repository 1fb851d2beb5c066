/* Three equal masses that chase each other along one curve. The path leads from three rough points
 * to the figure eight of Chenciner and Montgomery (2000), by all steps at once. Steps forward then
 * show that it closes. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

enum { BODIES = 3, N = 2 * BODIES, STEPS = 10, POINTS = 3 };

static int choreography_potential(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0;
  for (int a = 0; a < BODIES; a++)
    for (int b = 0; b < a; b++) *V -= 1 / hypot(q[2 * a] - q[2 * b], q[2 * a + 1] - q[2 * b + 1]);
  return 0;
}

static int choreography_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < N; i++) V_q[i] = 0;
  for (int a = 0; a < BODIES; a++)
    for (int b = 0; b < a; b++) {
      const double x = q[2 * a] - q[2 * b], y = q[2 * a + 1] - q[2 * b + 1], r = hypot(x, y),
                   pull = 1 / (r * r * r);
      V_q[2 * a] += pull * x;
      V_q[2 * a + 1] += pull * y;
      V_q[2 * b] -= pull * x;
      V_q[2 * b + 1] -= pull * y;
    }
  return 0;
}

/* Declared symmetries are directions in which a closed path may be moved. The solver holds it in
 * place along them. */
static int choreography_shift_x(const double *q, double *xi, void *user)
{
  (void)q, (void)user;
  for (int i = 0; i < N; i++) xi[i] = i % 2 == 0;
  return 0;
}

static int choreography_shift_y(const double *q, double *xi, void *user)
{
  (void)q, (void)user;
  for (int i = 0; i < N; i++) xi[i] = i % 2 == 1;
  return 0;
}

static int choreography_rotation(const double *q, double *xi, void *user)
{
  (void)user;
  for (int i = 0; i < N; i += 2) xi[i] = -q[i + 1], xi[i + 1] = q[i];
  return 0;
}

static dvi_status choreography_system(dvi_system **system)
{
  const dvi_potential gravity = {
      .name = "gravity", .value = choreography_potential, .gradient = choreography_gradient};
  const dvi_symmetry symmetries[] = {{"momentum_x", choreography_shift_x, NULL},
                                     {"momentum_y", choreography_shift_y, NULL},
                                     {"angular_momentum", choreography_rotation, NULL}};
  const dvi_system_terms terms = {.dimension = N,
                                  .mass = {.scalar = 1},
                                  .potentials = &gravity,
                                  .potential_count = 1,
                                  .symmetries = symmetries,
                                  .symmetry_count = 3,
                                  .autonomous = 1};
  return dvi_system_create(&terms, system);
}

/* Make a path on which after a third of the period each body stands where the next one stood. The
 * condition is q_N = A q_0, with one entry in each column of A. */
static dvi_status choreography_path(const dvi_system *system, dvi_path **path)
{
  static const double ones[N] = {1, 1, 1, 1, 1, 1};
  static const int start[N + 1] = {0, 1, 2, 3, 4, 5, 6}, row[N] = {4, 5, 0, 1, 2, 3};
  static const double t[POINTS] = {0, 1, 2};
  static const double q[POINTS * N] = {0, 0,    0.9,  -0.3, -0.9, 0.3,  0.9, 0.3, 0,
                                       0, -0.9, -0.3, 0.9,  -0.3, -0.9, 0.3, 0,   0};
  const dvi_path_options options = {.ends = DVI_ENDS_PERIODIC,
                                    .steps = STEPS,
                                    .span = 6.32591398 / 3,
                                    .dimension = N,
                                    .symmetry = ones,
                                    .symmetry_pattern = {start, row}};
  const dvi_status status = dvi_path_create(system, "galerkin:degree=8", &options, path);
  return status == DVI_OK ? dvi_path_guess(*path, POINTS, N, t, q) : status;
}

/* Take three times as many steps forward from the path's first node, and measure how far they end
 * from it. */
static dvi_status choreography_gap(const dvi_system *system, const dvi_path *path, double *gap)
{
  dvi_integrator *integrator = NULL;
  const double h = (dvi_path_time(path, STEPS) - dvi_path_time(path, 0)) / (double)STEPS;
  dvi_status status = dvi_integrator_create(system, dvi_path_method(path), &integrator);
  if (status == DVI_OK)
    status = dvi_integrator_start(integrator, 0, dvi_path_q(path, 0), dvi_path_p(path, 0));
  for (int k = 0; k < BODIES * STEPS && status == DVI_OK; k++)
    status = dvi_integrator_step(integrator, h);
  for (int i = 0; i < N && status == DVI_OK; i++)
    *gap = fmax(*gap, fabs(dvi_integrator_q(integrator)[i] - dvi_path_q(path, 0)[i]));
  dvi_integrator_destroy(&integrator);
  return status;
}

int main(void)
{
  dvi_system *system = NULL;
  dvi_path *path = NULL;
  dvi_path_report found = {0};
  double gap = 0;
  dvi_status status = choreography_system(&system);
  if (status == DVI_OK) status = choreography_path(system, &path);
  if (status == DVI_OK) status = dvi_path_solve(path, &found);
  if (status == DVI_OK) status = choreography_gap(system, path, &gap);
  if (status == DVI_OK) {
    printf("action %.11f over the whole curve, energy %.11f\n", 3 * found.action, found.energy);
    printf("%ld negative and %ld zero eigenvalues, %d of symmetry\n", found.negative, found.zero,
           found.symmetries);
    printf("after one turn it is %.0e from its start\n", gap);
  } else {
    fprintf(stderr, "%s: %s\n", dvi_status_name(status), dvi_last_error());
  }
  dvi_path_destroy(&path);
  dvi_system_destroy(&system);
  /* Roundoff, and its growth over one turn of a stable orbit. */
  return status == DVI_OK && gap < 1e-12 && found.negative == 0 ? 0 : 1;
}
