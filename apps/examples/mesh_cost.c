/* What meshes of tetrahedra cost: reading, incidence and parts, the star, a wave's system, and a
 * step of Verlet's method. The step's rate is beside that of a triad, a = b + 3 c, which measures
 * the memory. The last row has the exponents of the costs, fitted to the number of tetrahedra.
 * Usage: mesh_cost [CELLS ...], for example mesh_cost 12 20 34 55 70, up to 2e6 tetrahedra */
#define _POSIX_C_SOURCE 200809L
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { READ, MESH, STAR, SYSTEM, STEP, COSTS };

static const char *const names[COSTS] = {"read", "mesh", "star", "system", "step"};
static const char file[] = "mesh_cost.msh";

/* Sums for a line through log(cost) over log(tetrahedra). */
typedef struct fit {
  double x, y, xx, xy;
  int count;
} fit;

static double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void need(dvi_status status)
{
  if (status == DVI_OK) return;
  fprintf(stderr, "mesh_cost: %s\n", dvi_last_error());
  remove(file);
  exit(1);
}

/* Bytes a second of the best of some runs through three arrays that no cache holds. */
static double triad_rate(void)
{
  enum { COUNT = 8000000, RUNS = 8 };
  double *a = (double *)malloc(3 * sizeof(double) * COUNT), best = INFINITY;
  if (a == NULL) exit(1);
  double *b = a + COUNT, *c = b + COUNT;
  for (int i = 0; i < 3 * COUNT; i++) a[i] = i;
  for (int run = 0; run < RUNS; run++) {
    const double start = seconds();
    for (int i = 0; i < COUNT; i++) a[i] = b[i] + (3 + run) * c[i];
    best = fmin(best, seconds() - start);
  }
  const double used = a[COUNT / 2];
  free(a);
  return used > 0 ? 24 * (double)COUNT / best : 0;
}

static dvi_mesh *make_mesh(int cells, double *cost)
{
  dvi_mesh *mesh = NULL, *again = NULL;
  const dvi_generator_options options = {
      .size = sizeof options, .dimension = 3, .cells = {cells, cells, cells}};
  double start = seconds();
  need(dvi_mesh_generate("kuhn", &options, &mesh));
  cost[MESH] = seconds() - start;
  need(dvi_mesh_write(mesh, file, 0, NULL));
  start = seconds();
  need(dvi_mesh_read(file, NULL, &again));
  cost[READ] = seconds() - start;
  dvi_mesh_destroy(&again);
  remove(file);
  return mesh;
}

static dvi_field *make_wave(const dvi_mesh *mesh, dvi_system **system, double *cost)
{
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  double start = seconds();
  need(dvi_star_create(mesh, NULL, &star));
  cost[STAR] = seconds() - start;
  start = seconds();
  const dvi_wave_terms terms = {.size = sizeof terms, .star = star};
  need(dvi_wave_create(&terms, &field));
  need(dvi_field_system(field, system));
  cost[SYSTEM] = seconds() - start;
  dvi_star_destroy(&star);
  return field;
}

/* The best of some steps. Returns the bytes that a step moves at least: those of the state, and of
 * the matrix with its columns, weights and load. */
static double time_steps(const dvi_field *field, const dvi_system *system, double *cost)
{
  enum { STEPS = 30 };
  const int n = dvi_system_nq(system);
  double *q = (double *)calloc(2 * (size_t)n, sizeof *q), omega;
  dvi_integrator *integrator = NULL;
  dvi_matrix K;
  if (q == NULL) exit(1);
  for (int i = 0; i < n; i++) q[i] = sin(0.01 * i);
  need(dvi_field_matrix(field, DVI_FIELD_STIFFNESS, &K));
  need(dvi_field_fastest(field, &omega));
  need(dvi_integrator_create(system, "verlet", &integrator));
  need(dvi_integrator_start(integrator, 0, q, q + n));
  cost[STEP] = INFINITY;
  for (int i = 0; i < STEPS; i++) {
    const double start = seconds();
    need(dvi_integrator_step(integrator, 1 / omega));
    cost[STEP] = fmin(cost[STEP], seconds() - start);
  }
  const double bytes = dvi_integrator_traffic(integrator) + 12.0 * (double)dvi_matrix_entries(&K) +
                       24.0 * n;
  dvi_integrator_destroy(&integrator);
  free(q);
  return bytes;
}

static void measure(int cells, double triad, fit *fits, FILE *out)
{
  double cost[COSTS];
  dvi_system *system = NULL;
  dvi_mesh *mesh = make_mesh(cells, cost);
  dvi_field *field = make_wave(mesh, &system, cost);
  const double bytes = time_steps(field, system, cost),
               tetrahedra = (double)dvi_mesh_count(mesh, 3), x = log(tetrahedra);
  fprintf(out, "%.0f,%lld", tetrahedra, (long long)dvi_mesh_count(mesh, 0));
  for (int i = 0; i < COSTS; i++) {
    const double y = log(cost[i]);
    fits[i].x += x;
    fits[i].y += y;
    fits[i].xx += x * x;
    fits[i].xy += x * y;
    fits[i].count++;
    fprintf(out, ",%.3e", cost[i]);
  }
  fprintf(out, ",%.2f\n", bytes / cost[STEP] / triad);
  dvi_system_destroy(&system);
  dvi_field_destroy(&field);
  dvi_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
  FILE *out = argc > 1 ? stdout : stderr; /* two small meshes show that it works */
  const double triad = triad_rate();
  fit fits[COSTS] = {{0}};
  fprintf(out, "tetrahedra,vertices");
  for (int i = 0; i < COSTS; i++) fprintf(out, ",%s_seconds", names[i]);
  fprintf(out, ",step_rate_of_triad\n");
  for (int i = 1; i < argc; i++) measure((int)strtol(argv[i], NULL, 10), triad, fits, out);
  if (argc < 2) measure(6, triad, fits, out), measure(10, triad, fits, out);
  fprintf(out, "exponent,");
  for (int i = 0; i < COSTS; i++) {
    const fit *f = fits + i;
    const double spread = f->xx - f->x * f->x / f->count;
    fprintf(out, ",%.2f", spread > 0 ? (f->xy - f->x * f->y / f->count) / spread : (double)NAN);
  }
  fprintf(out, ",\n");
  return 0;
}
