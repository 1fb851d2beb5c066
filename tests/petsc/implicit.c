/* Equations that are solved on the shares of MPI's processes have the same bits for any number of
 * processes and any division, and are the solutions of one process by a factor up to roundoff. It
 * prints hashes, which implicit.sh compares, or with `table` the iterations of larger meshes alone.
 * Usage: mpirun -np N implicit [all|table] */
#include "implicit.h"

#include <dvi/petsc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "support/field/generated.h"
#include "support/meshes.h"
#include "support/shares/shares.h"

/* PETSc includes complex.h, whose I is no name for a parameter: libdvi's headers come first. */
#include <petscsys.h>

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

enum mood mood;
int slopes;

static int quartic(int64_t count, const double *x, const double *u, double *V, double *V_u,
                   double *V_uu, void *user)
{
  (void)x, (void)user;
  if (mood == FAILING && rank == ranks - 1) return -7;
  slopes += V_u != NULL;
  for (int64_t i = 0; i < count; i++) {
    const double s = u[i] * u[i];
    if (V != NULL) V[i] = s / 2 + s * s / 4;
    if (V_u != NULL) V_u[i] = u[i] + s * u[i] + (mood == JUMPING ? slopes % 7 : 0);
    if (V_uu != NULL) V_uu[i] = mood == PUSHING ? -1e6 : 1 + 3 * s;
  }
  return 0;
}

dvi_field *make_field(const dvi_mesh *mesh, const problem *p)
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
double distance(const dvi_mesh *share, const double *u, const double *whole)
{
  double most = 0;
  for (int64_t v = 0; v < dvi_mesh_count(share, 0); v++)
    most = fmax(most, fabs(u[v] - whole[dvi_mesh_share_numbers(share, 0)[v]]));
  return most;
}

void expect_below(double number, double bound, const char *what, const char *where)
{
  char found[96];
  (void)snprintf(found, sizeof found, "%.60s is %.3g", what, number);
  expect(fabs(number) < bound, found, where);
}

/* Give the sum of hashes of the values of owned vertices, with their numbers. */
uint64_t hash_values(const dvi_mesh *share, const double *u)
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
void tell(const char *what, uint64_t hash, int iterations)
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
  expect(dvi_mesh_divide(mesh, &options, &share, &division) == DVI_OK, "no division", partitioner);
  expect(solve(mesh, p, whole, &serial) == DVI_OK, "no solution", "the whole mesh");
  expect(solve(share, p, u, &report) == DVI_OK, "no solution", partitioner);
  expect_below(distance(share, u, whole), 1e-12, "the difference", partitioner);
  expect_below(report.residual, p->has_potential ? 1e-8 : 1e-12, "the residual", partitioner);
  expect_below(report.imbalance - serial.imbalance, 1e-14, "the imbalance", partitioner);
  expect(report.unknowns == serial.unknowns, "other unknowns", partitioner);
  tell("static", hash_values(share, u), report.iterations);
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
  free(u);
  free(whole);
}

/* ---- meshes ---- */

/* The mesh is destroyed. */
static void check_mesh(dvi_mesh *mesh, int is_long)
{
  static const char *const partitioners[] = {"blocks", "ptscotch"};
  for (int k = 0; k < 2; k++) {
    check_problem(mesh, &(problem){.is_fixed = 1}, partitioners[k]);
    check_problem(mesh, &(problem){0}, partitioners[k]);
    check_problem(mesh, &(problem){.is_fixed = 1, .has_potential = 1}, partitioners[k]);
    check_motions(mesh, partitioners[k], is_long);
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
  expect(dvi_mesh_divide(mesh, NULL, &share, &division) == DVI_OK, "no division", generator);
  expect(solve(share, &(problem){.is_fixed = 1}, u, &report) == DVI_OK, "no solution", generator);
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
    expect(count <= 18 + 4 && count <= few + 4, "more iterations", "growth");
  }
}

int main(int argc, char **argv)
{
  const dvi_generator_options box = {.cells = {9, 8, 7}, .grading = {1.2, 1, 1.1}};
  const int is_long = argc > 1 && strcmp(argv[1], "all") == 0;
  if (PetscInitialize(&argc, &argv, NULL, NULL) != 0) return 1;
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  (void)MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (argc > 1 && strcmp(argv[1], "table") == 0) {
    print_table();
    (void)PetscFinalize();
    return failures > 0;
  }
  check_mesh(staggered_mesh(18, 20), is_long);
  check_failures();
  check_costs();
  if (is_long) {
    check_mesh(generated("box", box), 1);
    check_orders();
    check_growth();
  }
  (void)PetscFinalize();
  return failures > 0;
}
