/* What steps of fields with densities cost, in process time, medians of interleaved rounds:
 *
 *   verlet    sine-Gordon on a circle of linear elements with a diagonal mass, by the density of a
 *             scene, by one written in C, and by a bare loop with the same arithmetic but without
 *             compensated sums. Beside them the time of 32 bytes, q and p read and written, at the
 *             rate of a triad a = b + 3 c in as much memory as an integrator has, and that of all
 *             bytes of a step by temporal blocking if no other step is taken with it
 *   fourier   the same equation by 2047 functions at 4096 points: an iteration beside two
 *             transforms
 *   imex      waves on a square of bilinear elements: a step beside the same without its system of
 *             equations
 *
 * Exponents are those of the times of whole steps, fitted to the numbers of unknowns.
 * Usage: taskset -c 1 density_cost [UNKNOWNS [SIDE]], for example density_cost 1000000 1000 */
#define _POSIX_C_SOURCE 200809L
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <dvi/sines.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 7, SIZES_MOST = 16 };

/* Loops for the instruction sets that the library chooses from. */
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__)
#define LANES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define LANES
#endif

static double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void need(dvi_status status)
{
  if (status == DVI_OK) return;
  fprintf(stderr, "density_cost: %s\n", dvi_last_error());
  exit(1);
}

static double *numbers(size_t count)
{
  double *made = (double *)calloc(count, sizeof *made);
  if (made == NULL) exit(1);
  return made;
}

static int ascending(const void *a, const void *b)
{
  return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

static double median(double *time)
{
  qsort(time, ROUNDS, sizeof *time, ascending);
  return time[ROUNDS / 2];
}

/* ---- memory ---- */

typedef struct arrays {
  long count;
  double *a, *b, *c;
} arrays;

LANES static void triad(const arrays *s)
{
  for (long i = 0; i < s->count; i++) s->a[i] = s->b[i] + 3 * s->c[i];
}

/* ---- sine-Gordon ---- */

/* The sine of plain angles, in a form of which compilers make vectors. */
static inline double plain_sine(double x)
{
  const dvi_reduced_angle angle = dvi_reduce_angle(x);
  return dvi_turned_sine(angle.quarters, dvi_sine_polynomial(angle.r, angle.tail),
                         dvi_cosine_polynomial(angle.r, angle.tail));
}

LANES static void sines(int count, const double *u, double *l_z)
{
  for (int k = 0; k < count; k++) l_z[k] = -plain_sine(u[k]);
}

static int kinetic(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = 0.5 * z[k] * z[k];
    if (l_z != NULL) l_z[k] = z[k];
    if (l_zz != NULL) l_zz[k] = 1;
  }
  return 0;
}

static int elastic(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = -0.5 * z[k] * z[k];
    if (l_z != NULL) l_z[k] = -z[k];
    if (l_zz != NULL) l_zz[k] = -1;
  }
  return 0;
}

static int pendula(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count && l != NULL; k++) l[k] = cos(z[k]) - 1;
  if (l_z != NULL) sines(count, z, l_z);
  for (int k = 0; k < count && l_zz != NULL; k++) l_zz[k] = -cos(z[k]);
  return 0;
}

static dvi_density *by_hand(long n, double length)
{
  static const dvi_jet rate = {.rate = 1}, slope = {.order = {1}}, value = {.order = {0}};
  static const dvi_density_part parts[] = {
      {.kind = DVI_DENSITY_KINETIC, .variable = &rate, .variables = 1, .density = kinetic},
      {.kind = DVI_DENSITY_QUADRATIC, .variable = &slope, .variables = 1, .density = elastic},
      {.kind = DVI_DENSITY_POTENTIAL, .variable = &value, .variables = 1, .density = pendula}};
  char kind[80];
  const dvi_axis axis = {.from = 0, .to = length, .periodic = 1};
  const dvi_space_options options = {
      .size = sizeof options, .kind = kind, .axis = &axis, .axes = 1};
  dvi_space *space = NULL;
  dvi_density *density = NULL;
  (void)snprintf(kind, sizeof kind, "fem:degree=1,cells=%ld,lumped=yes", n);
  need(dvi_space_create(&options, &space));
  const dvi_density_terms terms = {
      .size = sizeof terms, .space = space, .components = 1, .part = parts, .parts = 3};
  need(dvi_density_create(&terms, &density));
  dvi_space_destroy(&space);
  return density;
}

static dvi_scene *parse(const char *text)
{
  char message[1024];
  dvi_scene *scene = NULL;
  if (dvi_scene_parse("cost", text, strlen(text), 0, NULL, &scene, message, sizeof message) ==
      DVI_OK)
    return scene;
  fprintf(stderr, "density_cost: %s\n", message);
  exit(1);
}

static dvi_scene *by_scene(const char *space, double length)
{
  char text[512];
  (void)snprintf(text, sizeof text,
                 "domain: {x: [0, %.17g]}\nboundary: periodic\nspace: %s\n"
                 "fields: {u: scalar}\n"
                 "density: u'^2/2 - d(u,x)^2/2 - (1 - cos(u))\n",
                 length, space);
  return parse(text);
}

/* A smooth start at coordinates in any order. */
static dvi_integrator *begin(const dvi_system *system, const dvi_density *density,
                             const char *method)
{
  dvi_integrator *integrator = NULL;
  int64_t n;
  const int *place = dvi_density_unknowns(density, &n);
  double *q = numbers(2 * (size_t)n);
  for (int64_t i = 0; i < n; i++) q[i] = 2 * sin(6.283185307179586 * place[i] / (double)n);
  need(dvi_integrator_create(system, method, &integrator));
  need(dvi_integrator_start(integrator, 0, q, q + n));
  free(q);
  return integrator;
}

/* Time of a step, of some in a run. */
static double run(dvi_integrator *integrator, double h, long steps)
{
  const dvi_run_options options = {.h = h,
                                   .t_end = dvi_integrator_time(integrator) + h * (double)steps};
  const double start = seconds();
  need(dvi_run(integrator, &options, NULL));
  return (seconds() - start) / (double)steps;
}

/* Bare arithmetic: kicks by K u + w sin u and drifts, on coordinates in the order of the circle. */
typedef struct bare {
  long n;
  double h, stiffness, weight, mass;
  double *q, *p;
} bare;

static double bare_force(const bare *b, long left, long i, long right)
{
  return b->stiffness * (2 * b->q[i] - b->q[left] - b->q[right]) + b->weight * plain_sine(b->q[i]);
}

LANES static void bare_steps(const bare *b, long steps)
{
  const long n = b->n;
  const double h = b->h, stiffness = b->stiffness, weight = b->weight, by = h / b->mass;
  double *q = b->q, *p = b->p;
  for (long s = 0; s < steps; s++) {
    p[0] -= h * bare_force(b, n - 1, 0, 1);
    for (long i = 1; i < n - 1; i++)
      p[i] -= h * (stiffness * (2 * q[i] - q[i - 1] - q[i + 1]) + weight * plain_sine(q[i]));
    p[n - 1] -= h * bare_force(b, n - 2, n - 1, 0);
    for (long i = 0; i < n; i++) q[i] += by * p[i];
  }
}

static double run_bare(const bare *b, long steps)
{
  const double start = seconds();
  bare_steps(b, steps);
  return (seconds() - start) / (double)steps;
}

static double run_triad(const arrays *s, long times)
{
  const double start = seconds();
  for (long i = 0; i < times; i++) triad(s);
  return (seconds() - start) / (double)times;
}

enum { SCENE, HAND, BARE, TRIAD, COSTS };

typedef struct costs {
  double x, cost[COSTS], bytes; /* bytes of a step that goes through memory alone */
} costs;

static costs measure_verlet(long n)
{
  const double length = (double)n / 64, cell = length / (double)n, h = 0.5 * cell;
  const long all = n < 1000 ? 500000 : 50000000, steps = all / n > 8 ? all / n : 8;
  char kind[80];
  (void)snprintf(kind, sizeof kind, "fem:degree=1,cells=%ld,lumped=yes", n);
  dvi_scene *scene = by_scene(kind, length);
  dvi_density *density = by_hand(n, length);
  dvi_system *system = NULL;
  need(dvi_density_system(density, &system));
  dvi_integrator *of_scene = begin(dvi_scene_system(scene), dvi_scene_density(scene), "verlet"),
                 *of_hand = begin(system, density, "verlet");
  double *memory = numbers(20 * (size_t)n), time[COSTS][ROUNDS];
  const bare b = {n, h, 1 / cell, cell, cell, memory, memory + n};
  const arrays s = {6 * n, memory + 2 * n, memory + 8 * n, memory + 14 * n};
  for (long i = 0; i < n; i++) b.q[i] = 2 * sin(6.283185307179586 * (double)i / (double)n);
  for (int r = -1; r < ROUNDS; r++) { /* the first round makes all ready */
    const int at = r < 0 ? 0 : r;
    time[SCENE][at] = run(of_scene, h, steps);
    time[HAND][at] = run(of_hand, h, steps);
    time[BARE][at] = run_bare(&b, steps);
    time[TRIAD][at] = run_triad(&s, steps / 4) / 6;
  }
  costs c = {.x = log((double)n), .bytes = dvi_integrator_traffic(of_scene)};
  for (int k = 0; k < COSTS; k++) c.cost[k] = median(time[k]);
  dvi_integrator_destroy(&of_scene);
  dvi_integrator_destroy(&of_hand);
  dvi_scene_destroy(&scene);
  dvi_system_destroy(&system);
  dvi_density_destroy(&density);
  free(memory);
  return c;
}

/* The slope of a line through the logarithms of a cost. */
static double exponent(int count, const costs *c, int which)
{
  double x = 0, y = 0, xx = 0, xy = 0;
  for (int i = 0; i < count; i++) {
    const double value = log(c[i].cost[which]);
    x += c[i].x, y += value, xx += c[i].x * c[i].x, xy += c[i].x * value;
  }
  return (xy - x * y / count) / (xx - x * x / count);
}

static void print_verlet(FILE *out, long most)
{
  costs c[SIZES_MOST];
  int count = 0;
  fprintf(out, "verlet: unknowns,scene_ns,hand_ns,bare_ns,32_bytes_ns,one_pass_ns,scene_by_hand\n");
  for (long n = most < 1000 ? most / 4 : 1000; n <= most && count < SIZES_MOST; n *= 10) {
    c[count] = measure_verlet(n);
    const double *t = c[count].cost, each = 1e9 / (double)n, byte = t[TRIAD] / 24;
    fprintf(out, "%ld,%.3f,%.3f,%.3f,%.3f,%.3f,%.2f\n", n, each * t[SCENE], each * t[HAND],
            each * t[BARE], each * byte * 32, each * byte * c[count].bytes / (double)n,
            t[SCENE] / t[HAND]);
    fflush(out);
    count++;
  }
  if (count < 2) return;
  fprintf(out, "exponent,%.2f,%.2f,%.2f,%.2f\n", exponent(count, c, SCENE),
          exponent(count, c, HAND), exponent(count, c, BARE), exponent(count, c, TRIAD));
}

/* ---- Fourier spaces ---- */

/* Time of two transforms by the space. */
static double transform_pair(const dvi_space *space)
{
  enum { TIMES = 200 };
  const int order[DVI_AXES_MAX] = {0};
  double *U = numbers((size_t)dvi_space_functions(space)),
         *values = numbers((size_t)dvi_space_points(space, NULL, NULL));
  for (int64_t i = 0; i < dvi_space_functions(space); i++) U[i] = 1 / (1 + (double)(i * i));
  const double start = seconds();
  for (int i = 0; i < TIMES; i++) need(dvi_space_apply(space, order, U, values));
  const double taken = 2 * (seconds() - start) / (double)TIMES;
  free(U);
  free(values);
  return taken;
}

static void print_fourier(FILE *out, const char *method, long modes)
{
  char kind[80];
  double iteration[ROUNDS], pair[ROUNDS];
  (void)snprintf(kind, sizeof kind, "fourier:modes=%ld,points=%ld", modes, 4 * (modes + 1));
  dvi_scene *scene = by_scene(kind, 40);
  const dvi_density *density = dvi_scene_density(scene);
  dvi_integrator *integrator = NULL;
  int64_t n;
  (void)dvi_density_unknowns(density, &n);
  double *q = numbers(2 * (size_t)n);
  for (int64_t i = 0; i < n; i++) q[i] = 4 * exp(-0.3 * (double)i);
  need(dvi_integrator_create(dvi_scene_system(scene), method, &integrator));
  need(dvi_integrator_start(integrator, 0, q, q + n));
  dvi_counters before = {0}, after = {0};
  for (int r = -1; r < ROUNDS; r++) {
    const int at = r < 0 ? 0 : r;
    dvi_integrator_counters(integrator, &before);
    const double taken = 50 * run(integrator, 0.02, 50);
    dvi_integrator_counters(integrator, &after);
    iteration[at] = taken / (double)(after.residuals - before.residuals);
    pair[at] = transform_pair(dvi_density_space(density));
  }
  const double one = median(iteration), two = median(pair);
  fprintf(out,
          "fourier: %s,points %ld,iterations_a_step %.2f,iteration_us %.1f,pair_us "
          "%.1f,pairs_an_iteration %.2f\n",
          method, 4 * (modes + 1), (double)(after.residuals - before.residuals) / 50, 1e6 * one,
          1e6 * two, one / two);
  fflush(out);
  dvi_integrator_destroy(&integrator);
  dvi_scene_destroy(&scene);
  free(q);
}

/* ---- imex ---- */

static void print_imex(FILE *out, long side)
{
  char text[512];
  double with[ROUNDS], without[ROUNDS], h = 0.5;
  (void)snprintf(text, sizeof text,
                 "domain: {x: [0, %ld], y: [0, %ld]}\nboundary: free\n"
                 "space: fem:degree=1,cells=%ld,lumped=yes\nfields: {u: scalar}\n"
                 "density: u'^2/2 - d(u,x)^2/2 - d(u,y)^2/2 - (1 - cos(u))\n",
                 side, side, side);
  dvi_scene *scene = parse(text);
  const dvi_density *density = dvi_scene_density(scene);
  int64_t n;
  (void)dvi_density_unknowns(density, &n);
  dvi_integrator *imex = begin(dvi_scene_system(scene), density, "imex"),
                 *verlet = begin(dvi_scene_system(scene), density, "verlet:blocking=none");
  const double start = seconds();
  (void)run(imex, h, 1);
  const double first = seconds() - start;
  (void)run(verlet, h, 1);
  for (int r = 0; r < ROUNDS; r++) {
    with[r] = run(imex, h, 2);
    without[r] = run(verlet, h, 2);
  }
  const double step = median(with), rest = median(without);
  fprintf(out,
          "imex: unknowns %lld,first_step_s %.2f,step_ms %.1f,without_system_ms "
          "%.1f,share_of_system %.2f\n",
          (long long)n, first, 1e3 * step, 1e3 * rest, 1 - rest / step);
  dvi_integrator_destroy(&imex);
  dvi_integrator_destroy(&verlet);
  dvi_scene_destroy(&scene);
}

int main(int argc, char **argv)
{
  FILE *out = argc > 1 ? stdout : stderr; /* small fields show that it works */
  const long most = argc > 1 ? strtol(argv[1], NULL, 10) : 400,
             side = argc > 2 ? strtol(argv[2], NULL, 10) : 20, modes = argc > 1 ? 1023 : 31;
  print_verlet(out, most);
  print_fourier(out, "galerkin:degree=1", modes);
  print_fourier(out, "galerkin:degree=2", modes);
  print_imex(out, side);
  return 0;
}
