/* Equations that are solved on the shares of MPI's processes have the same bits for any number of
 * processes and any division, and are the solutions of one process by a factor up to roundoff. It
 * prints hashes, which implicit.sh compares, or with `table` the iterations of larger meshes alone.
 * Usage: mpirun -np N implicit [all|table] */
#include <dvi/integrator.h>
#include <dvi/march.h>
#include <dvi/petsc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/generated.h"
#include "support/meshes.h"
#include "support/shares/shares.h"

/* PETSc includes complex.h, whose I is no name for a parameter: libdvi's headers come first. */
#include <petscsys.h>

static int rank, ranks, failures;

static void expect(int holds, const char *what, double value)
{
  int all = holds;
  (void)MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (all) return;
  failures++;
  if (!holds)
    (void)fprintf(stderr, "process %d of %d: %s: %g (%s)\n", rank, ranks, what, value,
                  dvi_last_error());
}

/* ---- problems ---- */

static int uneven(const double *x, double *value, void *user)
{
  (void)user;
  *value = sin(3 * x[0]) * exp(x[1]);
  return 0;
}

static int square(const double *x, const double *normal, double *value, void *user)
{
  (void)normal, (void)user;
  *value = x[0] * x[0];
  return 0;
}

/* What the potential does: it is u^2 (1 + u^2/2)/2, fails on the last process, or pushes apart. */
static enum { GOOD, FAILING, PUSHING } mood;

static int quartic(int64_t count, const double *x, const double *u, double *V, double *V_u,
                   double *V_uu, void *user)
{
  (void)x, (void)user;
  if (mood == FAILING && rank == ranks - 1) return -7;
  for (int64_t i = 0; i < count; i++) {
    const double s = u[i] * u[i];
    if (V != NULL) V[i] = s / 2 + s * s / 4;
    if (V_u != NULL) V_u[i] = u[i] + s * u[i];
    if (V_uu != NULL) V_uu[i] = mood == PUSHING ? -1e6 : 1 + 3 * s;
  }
  return 0;
}

/* What is solved: with fixed values all around or without any, and with a potential. */
typedef struct problem {
  int is_fixed, has_potential;
} problem;

static dvi_field *make_field(const dvi_mesh *mesh, const problem *p)
{
  const dvi_condition edge = {.part = "boundary", .kind = DVI_FIXED, .datum = square};
  const dvi_field_potential potential = {.density = quartic};
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  if (dvi_star_create(mesh, NULL, &star) != DVI_OK) return NULL;
  const dvi_wave_terms terms = {.size = sizeof terms,
                                .star = star,
                                .source = uneven,
                                .condition = &edge,
                                .conditions = p->is_fixed,
                                .potential = p->has_potential ? &potential : NULL};
  (void)dvi_wave_create(&terms, &field);
  dvi_star_destroy(&star);
  return field;
}

/* ---- solutions ---- */

static dvi_status solve(const dvi_mesh *mesh, const problem *p, double *u,
                        dvi_field_solve_report *report)
{
  const dvi_field_solve_options options = {.size = sizeof options, .imbalance = 2, .mean = 0.5};
  dvi_field *field = make_field(mesh, p);
  memset(u, 0, (size_t)dvi_mesh_count(mesh, 0) * sizeof *u);
  const dvi_status status = dvi_field_solve(field, &options, u, report);
  dvi_field_destroy(&field);
  return status;
}

/* Give the largest distance of own values of a share from those of the whole mesh. */
static double distance(const dvi_mesh *share, const double *u, const double *whole)
{
  double most = 0;
  for (int64_t v = 0; v < dvi_mesh_count(share, 0); v++)
    most = fmax(most, fabs(u[v] - whole[dvi_mesh_share_numbers(share, 0)[v]]));
  return most;
}

/* Give the sum of hashes of the values of owned vertices, with their numbers. */
static uint64_t hash_values(const dvi_mesh *share, const double *u)
{
  uint64_t hash = 0;
  for (int64_t v = 0; v < dvi_mesh_count(share, 0); v++) {
    uint64_t bits;
    if (dvi_mesh_share_owners(share, 0)[v] != rank) continue;
    memcpy(&bits, u + v, sizeof bits);
    bits ^= (uint64_t)dvi_mesh_share_numbers(share, 0)[v] * UINT64_C(0x9e3779b97f4a7c15);
    bits = (bits ^ bits >> 31) * UINT64_C(0xff51afd7ed558ccd);
    hash += bits ^ bits >> 33;
  }
  (void)MPI_Allreduce(MPI_IN_PLACE, &hash, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  return hash;
}

/* Print what must be the same on any number of processes. */
static void tell(const char *what, uint64_t hash, int iterations)
{
  if (rank == 0) (void)printf("%s %016llx %d\n", what, (unsigned long long)hash, iterations);
}

static void tell_count(const char *mesh, int cells, int iterations)
{
  if (rank == 0)
    (void)printf("%s, %d cells along an axis: %d iterations\n", mesh, cells, iterations);
}

static void check_problem(const dvi_mesh *mesh, const problem *p, const char *partitioner)
{
  const dvi_division_options options = {.size = sizeof options, .partitioner = partitioner};
  const size_t vertices = (size_t)dvi_mesh_count(mesh, 0);
  double *u = calloc(vertices, sizeof *u), *whole = calloc(vertices, sizeof *u);
  dvi_mesh *share;
  dvi_division *division;
  dvi_field_solve_report report = {0}, serial = {0};
  expect(dvi_mesh_divide(mesh, &options, &share, &division) == DVI_OK, "no division", 0);
  expect(solve(mesh, p, whole, &serial) == DVI_OK, "no solution of the whole mesh", 0);
  expect(solve(share, p, u, &report) == DVI_OK, "no solution on shares", 0);
  expect(distance(share, u, whole) < 1e-12, "another solution", distance(share, u, whole));
  expect(report.residual < (p->has_potential ? 1e-8 : 1e-12), "a residual", report.residual);
  expect(fabs(report.imbalance - serial.imbalance) < 1e-14, "an imbalance", report.imbalance);
  expect(report.unknowns == serial.unknowns, "unknowns", (double)report.unknowns);
  tell("static", hash_values(share, u), report.iterations);
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
  free(u);
  free(whole);
}

/* ---- motions ---- */

enum { STEPS = 20 };

/* Heights at the start. */
static double height(const double *x)
{
  return 0.3 * cos(3.14159265 * x[0]) * cos(3.14159265 * x[1]);
}

/* Fill in the start of all unknowns. The others have what is fixed. */
static void fill(const dvi_mesh *mesh, const dvi_field *field, double *q)
{
  int64_t n;
  const double *point = dvi_mesh_points(mesh);
  const int *cell = dvi_field_unknowns(field, &n);
  for (int64_t i = 0; i < n; i++) q[i] = height(point + cell[i] * dvi_mesh_space(mesh));
}

/* Move the whole mesh by the integrator's method, whose factors are KLU's. */
static dvi_status move_whole(const dvi_mesh *mesh, const problem *p, double h, double *u,
                             double *energy)
{
  int64_t n;
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  dvi_field *field = make_field(mesh, p);
  (void)dvi_field_unknowns(field, &n);
  double *q = calloc((size_t)(2 * n), sizeof *q);
  fill(mesh, field, q);
  dvi_status status = dvi_field_system(field, &system);
  if (status == DVI_OK) status = dvi_integrator_create(system, "midpoint", &integrator);
  if (status == DVI_OK) status = dvi_integrator_start_velocity(integrator, 0, q, q + n);
  for (int i = 0; i < STEPS && status == DVI_OK; i++) status = dvi_integrator_step(integrator, h);
  double invariant[8] = {0}; /* the energy is the first one */
  if (status == DVI_OK)
    status = dvi_system_invariants(system, STEPS * h, dvi_integrator_q(integrator),
                                   dvi_integrator_p(integrator), invariant);
  *energy = invariant[0];
  if (status == DVI_OK) status = dvi_field_lift(field, dvi_integrator_q(integrator), u);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi_field_destroy(&field);
  free(q);
  return status;
}

/* Start a march of a share. */
static dvi_status begin(const dvi_mesh *share, const dvi_field *field, double h, dvi_march **march)
{
  int64_t n;
  const dvi_march_options options = {.size = sizeof options, .method = "midpoint", .step = h};
  double *u = calloc((size_t)dvi_mesh_count(share, 0), sizeof *u);
  const int *cell = dvi_field_unknowns(field, &n);
  double *q = calloc((size_t)n + 1, sizeof *q);
  fill(share, field, q);
  for (int64_t i = 0; i < n; i++) u[cell[i]] = q[i];
  dvi_status status = dvi_march_create(field, &options, march);
  const dvi_march_state state = {.size = sizeof state, .A = u};
  if (status == DVI_OK) status = dvi_march_start(*march, &state);
  free(q);
  free(u);
  return status;
}

/* A second march that loads the state halfway goes on with the same bits. */
static void check_saved(const dvi_mesh *share, const dvi_field *field, double h, dvi_march *march)
{
  static unsigned char bytes[1 << 20];
  size_t size = 0;
  double here = 0, there = 0;
  dvi_march *other = NULL;
  dvi_status status = begin(share, field, h, &other);
  if (status == DVI_OK) status = dvi_march_save_memory(march, bytes, sizeof bytes, &size);
  if (status == DVI_OK) status = dvi_march_load_memory(other, bytes, size);
  if (status == DVI_OK) status = dvi_march_advance(other, STEPS * h);
  if (status == DVI_OK) status = dvi_march_observe(other, 0, &there);
  expect(status == DVI_OK, "a saved state", (double)status);
  status = dvi_march_advance(march, STEPS * h);
  expect(status == DVI_OK && dvi_march_observe(march, 0, &here) == DVI_OK, "a march", 0);
  expect(here == there, "a saved state goes on otherwise", here - there);
  dvi_march_destroy(&other);
}

/* A step that fails tells why on all processes alike, and leaves the state. */
static void check_failures(void)
{
  const double h = 0.125;
  dvi_mesh *mesh = staggered_mesh(8, 8), *share;
  dvi_division *division;
  dvi_march *march = NULL;
  double before = 0, after = 0;
  expect(dvi_mesh_divide(mesh, NULL, &share, &division) == DVI_OK, "no division", 0);
  dvi_field *field = make_field(share, &(problem){.has_potential = 1});
  expect(begin(share, field, h, &march) == DVI_OK, "no march", 0);
  expect(dvi_march_advance(march, 3 * h) == DVI_OK, "no step", 0);
  expect(dvi_march_observe(march, 0, &before) == DVI_OK, "no energy", 0);
  mood = FAILING;
  dvi_status status = dvi_march_advance(march, 9 * h);
  expect(status == DVI_CALLBACK_FAILED, "a potential that fails", (double)status);
  expect(strstr(dvi_last_error(),
                "step 4 from t = 0.375 with h = 0.125 failed; the state is unch") != NULL,
         "no sentence on step 4", 0);
  mood = PUSHING;
  status = dvi_march_advance(march, 9 * h);
  expect(status == DVI_NOT_CONVERGED, "an indefinite Jacobian", (double)status);
  expect(strstr(dvi_last_error(), "left a residual of") != NULL, "no sentence", 0);
  mood = GOOD;
  expect(dvi_march_time(march) == 3 * h, "a time that moved", dvi_march_time(march));
  expect(dvi_march_observe(march, 0, &after) == DVI_OK && before == after, "another state", after);
  expect(dvi_march_advance(march, 9 * h) == DVI_OK, "it does not go on", 0);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
  dvi_mesh_destroy(&share);
  dvi_mesh_destroy(&mesh);
  dvi_division_destroy(&division);
}

/* Move to t = 0.25, and give the value of each vertex. */
static void move_by(const dvi_mesh *share, const dvi_field *field, double h, double *u)
{
  dvi_march *march = NULL;
  expect(begin(share, field, h, &march) == DVI_OK, "no march", 0);
  expect(dvi_march_advance(march, 0.25) == DVI_OK, "no step", 0);
  expect(dvi_march_sample(march, DVI_FORM_A, 0, NULL, u) == DVI_OK, "no values", 0);
  dvi_march_destroy(&march);
}

/* Errors shrink as h^2. */
static void check_order(void)
{
  dvi_mesh *mesh = staggered_mesh(8, 8), *share;
  const int64_t vertices = dvi_mesh_count(mesh, 0);
  double *u = calloc((size_t)(3 * vertices), sizeof *u), change[2] = {0, 0};
  dvi_division *division;
  expect(dvi_mesh_divide(mesh, NULL, &share, &division) == DVI_OK, "no division", 0);
  dvi_field *field = make_field(share, &(problem){.has_potential = 1});
  for (int k = 0; k < 3; k++) move_by(share, field, 1.0 / (128 << k), u + k * vertices);
  for (int64_t v = 0; v < dvi_mesh_count(share, 0); v++)
    for (int k = 0; k < 2; k++)
      change[k] = fmax(change[k], fabs(u[(k + 1) * vertices + v] - u[k * vertices + v]));
  (void)MPI_Allreduce(MPI_IN_PLACE, change, 2, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  expect(fabs(change[0] / change[1] - 4) < 0.3, "an order", change[0] / change[1]);
  dvi_field_destroy(&field);
  dvi_mesh_destroy(&share);
  dvi_mesh_destroy(&mesh);
  dvi_division_destroy(&division);
  free(u);
}

static void check_motion(const dvi_mesh *mesh, const problem *p, const char *partitioner)
{
  const double h = 0.125; /* several times what leapfrog takes */
  const dvi_division_options options = {.size = sizeof options, .partitioner = partitioner};
  const size_t vertices = (size_t)dvi_mesh_count(mesh, 0);
  double *u = calloc(vertices, sizeof *u), *whole = calloc(vertices, sizeof *u), energy = 0,
         first = 0, last = 0;
  uint64_t bits;
  dvi_mesh *share;
  dvi_division *division;
  dvi_march *march = NULL;
  expect(dvi_mesh_divide(mesh, &options, &share, &division) == DVI_OK, "no division", 0);
  dvi_field *field = make_field(share, p);
  expect(move_whole(mesh, p, h, whole, &energy) == DVI_OK, "no motion of the whole mesh", 0);
  expect(begin(share, field, h, &march) == DVI_OK, "no march", 0);
  expect(dvi_march_observe(march, 0, &first) == DVI_OK, "no energy", 0);
  expect(dvi_march_advance(march, STEPS / 2 * h) == DVI_OK, "no step", 0);
  check_saved(share, field, h, march);
  expect(dvi_march_observe(march, 0, &last) == DVI_OK, "no energy", 0);
  expect(dvi_march_sample(march, DVI_FORM_A, 0, NULL, u) == DVI_OK, "no values", 0);
  expect(distance(share, u, whole) < 2e-13, "another motion", distance(share, u, whole));
  expect(fabs(last - energy) < 1e-12, "another energy than the system's", last - energy);
  expect(fabs(last - first) < (p->has_potential ? 1e-2 : 1e-13), "a drift", last - first);
  tell("motion", hash_values(share, u), 0);
  memcpy(&bits, &last, sizeof bits);
  tell("energy", bits, 0);
  if (getenv("DVI_TELL") != NULL && rank == 0)
    (void)fprintf(stderr, "difference %.2g, energy %.17g, of the system %.17g, drift %.2g\n",
                  distance(share, u, whole), last, energy, last - first);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
  free(u);
  free(whole);
}

/* ---- meshes ---- */

/* The mesh is destroyed. */
static void check_mesh(dvi_mesh *mesh)
{
  static const char *const partitioners[] = {"blocks", "ptscotch"};
  for (int k = 0; k < 2; k++) {
    check_problem(mesh, &(problem){.is_fixed = 1}, partitioners[k]);
    check_problem(mesh, &(problem){0}, partitioners[k]);
    check_problem(mesh, &(problem){.is_fixed = 1, .has_potential = 1}, partitioners[k]);
    check_motion(mesh, &(problem){.is_fixed = 1}, partitioners[k]);
    check_motion(mesh, &(problem){.has_potential = 1}, partitioners[k]);
  }
  dvi_mesh_destroy(&mesh);
}

/* Iterations on a generated mesh. */
static int iterations_on(const char *generator, dvi_generator_options size)
{
  dvi_mesh *mesh = generated(generator, size), *share;
  dvi_division *division;
  dvi_field_solve_report report = {0};
  double *u = calloc((size_t)dvi_mesh_count(mesh, 0), sizeof *u);
  expect(dvi_mesh_divide(mesh, NULL, &share, &division) == DVI_OK, "no division", size.cells[0]);
  expect(solve(share, &(problem){.is_fixed = 1}, u, &report) == DVI_OK, "no solution",
         size.cells[0]);
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
  dvi_mesh_destroy(&mesh);
  free(u);
  return report.iterations;
}

static int iterations_of_triangles(int cells)
{
  return iterations_on("kuhn", (dvi_generator_options){.cells = {cells, cells}});
}

/* Print the table of docs/fields/implicit-shares.md. */
static void print_table(void)
{
  for (int n = 20; n <= 320; n *= 2) tell_count("triangles", n, iterations_of_triangles(n));
  for (int n = 20; n <= 320; n *= 2)
    tell_count("boxes of 10:1", n,
               iterations_on("box", (dvi_generator_options){.cells = {n, n}, .extent = {10, 1}}));
  for (int n = 12; n <= 48; n *= 2)
    tell_count("cubes", n, iterations_on("box", (dvi_generator_options){.cells = {n, n, n}}));
}

/* Iterations do not grow with the mesh. */
static void check_growth(void)
{
  const int few = iterations_of_triangles(20);
  for (int cells = 20; cells <= 160; cells *= 2) {
    const int count = iterations_of_triangles(cells);
    tell("iterations", (uint64_t)cells, count);
    expect(count <= 18 + 4 && count <= few + 4, "iterations", count);
  }
}

int main(int argc, char **argv)
{
  const dvi_generator_options box = {.cells = {9, 8, 7}, .grading = {1.2, 1, 1.1}};
  if (PetscInitialize(&argc, &argv, NULL, NULL) != 0) return 1;
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  (void)MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (argc > 1 && strcmp(argv[1], "table") == 0) {
    print_table();
    (void)PetscFinalize();
    return failures > 0;
  }
  check_mesh(staggered_mesh(18, 20));
  check_failures();
  if (argc > 1 && strcmp(argv[1], "all") == 0) {
    check_mesh(generated("box", box));
    check_order();
    check_growth();
  }
  (void)PetscFinalize();
  return failures > 0;
}
