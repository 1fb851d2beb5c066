/* A chain of rods that hangs at an angle, by Verlet's method with constraints, and its masses in
 * free fall. Prints the largest |phi| at the end, and what both steps cost to the standard error.
 * Usage: rods [RODS [STEPS]] */
#include <dvi/dvi.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static const double gravity = 9.81;

/* n rods of length 1/n in the plane, with masses 1/n at their ends. */
static int rods_weight(double t, const double *q, double *V, void *user)
{
  const int n = *(const int *)user;
  (void)t;
  *V = 0;
  for (int k = 0; k < n; k++) *V += gravity / n * q[2 * k + 1];
  return 0;
}

static int rods_weight_gradient(double t, const double *q, double *V_q, void *user)
{
  const int n = *(const int *)user;
  (void)t, (void)q;
  for (int i = 0; i < 2 * n; i++) V_q[i] = i % 2 == 0 ? 0 : gravity / n;
  return 0;
}

static int rods_length(double t, const double *q, double *phi, void *user)
{
  const int n = *(const int *)user;
  const double square = 1.0 / n / n;
  double x = 0, y = 0; /* the end of the rod before */
  (void)t;
  for (int k = 0; k < n; k++) {
    const double dx = q[2 * k] - x, dy = q[2 * k + 1] - y;
    phi[k] = 0.5 * (dx * dx + dy * dy - square);
    x = q[2 * k];
    y = q[2 * k + 1];
  }
  return 0;
}

static int rods_length_gradient(double t, const double *q, double *phi_q, void *user)
{
  const int n = *(const int *)user;
  double x = 0, y = 0;
  (void)t;
  for (int k = 0; k < n; k++) {
    const double dx = q[2 * k] - x, dy = q[2 * k + 1] - y;
    if (k > 0) {
      *phi_q++ = -dx;
      *phi_q++ = -dy;
    }
    *phi_q++ = dx;
    *phi_q++ = dy;
    x = q[2 * k];
    y = q[2 * k + 1];
  }
  return 0;
}

/* A rod's row depends on the two ends of the rod. */
static dvi_pattern rods_pattern(int n, int *start, int *row)
{
  int entries = 0;
  for (int k = 0; k < n; k++) {
    for (int i = k > 0 ? 2 * k - 2 : 0; i < 2 * k + 2; i++) row[entries++] = i;
    start[k + 1] = entries;
  }
  const dvi_pattern pattern = {start, row};
  return pattern;
}

/* Return the processor time of a step in microseconds, or -1 after a message. *off becomes the
 * largest |phi| at the end, if it is asked for. */
static double rods_time(const dvi_system *system, const double *q, const double *p, long steps,
                        double *off)
{
  const double h = 0.2 / dvi_system_nq(system); /* 0.6 radians of the fastest wave */
  dvi_integrator *integrator = NULL;
  dvi_status status = dvi_integrator_create(system, "verlet", &integrator);
  if (status == DVI_OK) status = dvi_integrator_start(integrator, 0, q, p);
  for (int i = 0; i < 10 && status == DVI_OK; i++) status = dvi_integrator_step(integrator, h);
  const clock_t from = clock();
  for (long i = 0; i < steps && status == DVI_OK; i++) status = dvi_integrator_step(integrator, h);
  const double seconds = (double)(clock() - from) / CLOCKS_PER_SEC;
  if (status == DVI_OK && off != NULL) status = dvi_integrator_constraint(integrator, off);
  dvi_integrator_destroy(&integrator);
  if (status == DVI_OK) return 1e6 * seconds / (double)steps;
  (void)fprintf(stderr, "rods: %s\n", dvi_last_error());
  return -1;
}

static int rods_compare(int n, long steps, double *numbers, int *places)
{
  double *q = numbers, *p = numbers + 2 * n, off = 0;
  const dvi_potential weight = {
      .name = "weight", .value = rods_weight, .gradient = rods_weight_gradient, .user = &n};
  const dvi_holonomic rods = {.name = "rods",
                              .count = n,
                              .value = rods_length,
                              .gradient = rods_length_gradient,
                              .gradients = rods_pattern(n, places, places + n + 1),
                              .user = &n};
  dvi_system_terms terms = {.dimension = 2 * n,
                            .mass = {.scalar = 1.0 / n},
                            .potentials = &weight,
                            .potential_count = 1,
                            .autonomous = 1};
  dvi_system *without = NULL, *with = NULL;
  for (int k = 0; k < n; k++) { /* sin 0.3, cos 0.3 */
    q[2 * k] = (k + 1.0) / n * 0.29552020666133957;
    q[2 * k + 1] = -(k + 1.0) / n * 0.95533648912560602;
  }
  double fall = -1, hang = -1;
  if (dvi_system_create(&terms, &without) == DVI_OK)
    fall = rods_time(without, q, p, 10 * steps, NULL);
  terms.holonomics = &rods;
  terms.holonomic_count = 1;
  if (dvi_system_create(&terms, &with) == DVI_OK) hang = rods_time(with, q, p, steps, &off);
  dvi_system_destroy(&without);
  dvi_system_destroy(&with);
  if (fall < 0 || hang < 0) return EXIT_FAILURE;
  printf("%d rods after %ld steps: |phi| is at most %.1e\n", n, steps, off);
  (void)fprintf(stderr, "microseconds a step: %.3f in free fall, %.3f with rods, ratio %.1f\n",
                fall, hang, hang / fall);
  return EXIT_SUCCESS;
}

int main(int count, char **argument)
{
  const long n = count > 1 ? strtol(argument[1], NULL, 10) : 100,
             steps = count > 2 ? strtol(argument[2], NULL, 10) : 20000;
  if (n < 1 || n > 100000 || steps < 1) {
    (void)fprintf(stderr, "usage: rods [RODS [STEPS]], both 1 or more\n");
    return EXIT_FAILURE;
  }
  double *numbers = (double *)calloc(4 * (size_t)n, sizeof *numbers);
  int *places = (int *)calloc(5 * (size_t)n + 1, sizeof *places);
  const int failed = numbers == NULL || places == NULL
                         ? EXIT_FAILURE
                         : rods_compare((int)n, steps, numbers, places);
  free(numbers);
  free(places);
  return failed;
}
