/* Maxwell's fields take implicit steps on the shares of MPI's processes, with the same bits for any
 * number of processes and any division, and these are the steps of one process by a factor up to
 * roundoff. It prints hashes, which implicit.sh compares. Usage: mpirun -np N edges [all] */
#include <dvi/integrator.h>
#include <dvi/petsc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "expect.h"
#include "field/model/on_all.h"
#include "support/field/generated.h"
#include "support/meshes.h"
#include "support/shares/shares.h"

/* PETSc includes complex.h, whose I is no name for a parameter: libdvi's headers come first. */
#include <petscsys.h>

/* ---- motions ---- */

enum { STEPS = 5 };

/* A start of an edge, which has charge. */
static double start_of(int64_t number)
{
  return sin(0.37 * (double)number);
}

/* Move the whole mesh by the integrator's method, with a shorter step at the end. */
static void move_whole(dvi_field *field, double h, double *A)
{
  int64_t n;
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  const int *cell = dvi_field_unknowns(field, &n);
  double *q = DVI_NEW(double, 2 * n);
  for (int64_t i = 0; i < n; i++) q[n + i] = -start_of(cell[i]);
  dvi_status status = dvi_field_system(field, &system);
  if (status == DVI_OK) status = dvi_integrator_create(system, "midpoint", &integrator);
  if (status == DVI_OK) status = dvi_integrator_start_velocity(integrator, 0, q, q + n);
  for (int i = 0; i < STEPS && status == DVI_OK; i++) status = dvi_integrator_step(integrator, h);
  if (status == DVI_OK) status = dvi_integrator_step(integrator, h / 3);
  if (status == DVI_OK) status = dvi_field_lift(field, dvi_integrator_q(integrator), A);
  expect(status == DVI_OK, "no motion", "the whole mesh");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi__release(q);
}

/* Start a march of a share. */
static dvi_march *begin(const dvi_mesh *share, const dvi_field *field, double h, const char *name)
{
  const dvi_march_options options = {.size = sizeof options, .method = "midpoint", .step = h};
  const int64_t edges = dvi_mesh_count(share, 1);
  double *E = DVI_NEW(double, edges);
  dvi_march *march = NULL;
  for (int64_t e = 0; e < edges; e++) E[e] = start_of(dvi_mesh_share_numbers(share, 1)[e]);
  const dvi_march_state state = {.size = sizeof state, .E = E};
  expect(dvi_march_create(field, &options, &march) == DVI_OK, "no march", name);
  expect(dvi_march_start(march, &state) == DVI_OK, "no start", name);
  dvi__release(E);
  return march;
}

/* Print what must be the same on any number of processes. */
static void tell(const char *name, uint64_t bits)
{
  if (rank == 0) (void)printf("%s %016llx\n", name, (unsigned long long)bits);
}

/* Give the sum of hashes of the values of own k-cells, with their numbers. */
static uint64_t hash_of(const dvi_mesh *share, int k, const double *A)
{
  uint64_t hash = 0, all;
  for (int64_t c = 0; c < dvi_mesh_count(share, k); c++) {
    uint64_t bits;
    if (dvi_mesh_share_owners(share, k)[c] != rank) continue;
    memcpy(&bits, A + c, sizeof bits);
    bits ^= (uint64_t)dvi_mesh_share_numbers(share, k)[c] * UINT64_C(0x9e3779b97f4a7c15);
    bits = (bits ^ bits >> 31) * UINT64_C(0xff51afd7ed558ccd);
    hash += bits ^ bits >> 33;
  }
  (void)MPI_Allreduce(&hash, &all, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  return all;
}

/* Print a hash of A, and what is observed. */
static void tell_state(const dvi_march *march, const dvi_mesh *share, const double *A,
                       const char *name)
{
  tell(name, hash_of(share, 1, A));
  for (int i = 0; dvi_march_observable(march, i) != NULL; i++) {
    double value = (double)NAN;
    uint64_t bits;
    expect(dvi_march_observe(march, i, &value) == DVI_OK, "nothing observed", name);
    memcpy(&bits, &value, sizeof bits);
    tell(name, bits);
  }
}

typedef dvi_field *maker(const dvi_mesh *mesh);

static void check_motion(const dvi_mesh *mesh, maker *make, double h, const char *partitioner,
                         const char *name)
{
  const dvi_division_options options = {.size = sizeof options, .partitioner = partitioner};
  const int64_t edges = dvi_mesh_count(mesh, 1);
  double *A = DVI_NEW(double, edges), *whole = DVI_NEW(double, edges), apart = 0, size = 0,
         gauss = 1;
  dvi_mesh *share;
  dvi_division *division;
  dvi_field *all = make(mesh);
  expect(dvi_mesh_divide(mesh, &options, &share, &division) == DVI_OK, "no division", name);
  dvi_field *field = make(share);
  move_whole(all, h, whole);
  dvi_march *march = begin(share, field, h, name);
  expect(dvi_march_advance(march, STEPS * h + h / 3) == DVI_OK, "no step", name);
  expect(dvi_march_sample(march, DVI_FORM_A, 0, NULL, A) == DVI_OK, "no A", name);
  for (int64_t e = 0; e < dvi_mesh_count(share, 1); e++) {
    const double there = whole[dvi_mesh_share_numbers(share, 1)[e]];
    apart = fmax(apart, fabs(A[e] - there));
    size = fmax(size, fabs(there));
  }
  expect(apart <= 1e-13 * size, "another motion", name);
  expect(dvi_march_observe(march, 1, &gauss) == DVI_OK && gauss < 2e-15, "a charge", name);
  if (getenv("DVI_TELL") != NULL)
    (void)fprintf(stderr, "%s: difference %.2g of %.2g, charge %.2g\n", name, apart, size, gauss);
  tell_state(march, share, A, name);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
  dvi_field_destroy(&all);
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
  dvi__release(A);
  dvi__release(whole);
}

static double energy_of(const dvi_march *march, const char *name)
{
  double energy = (double)NAN;
  expect(dvi_march_observe(march, 0, &energy) == DVI_OK, "no energy", name);
  return energy;
}

/* A start by B = dA has the motion of that by A, and so has a state that is saved between steps. */
static void check_starts(void)
{
  static const char name[] = "lossy triangles, started again";
  static unsigned char bytes[1 << 18];
  const double h = 0.3, end = 5 * h;
  size_t size = 0;
  dvi_mesh *mesh = with_core_and_exit(staggered_mesh(9, 10), NULL), *share;
  dvi_division *division;
  expect(dvi_mesh_divide(mesh, NULL, &share, &division) == DVI_OK, "no division", name);
  dvi_field *field = lossy_field(share);
  double *A = DVI_NEW(double, dvi_mesh_count(share, 1)),
         *B = DVI_NEW(double, dvi_mesh_count(share, 2));
  for (int64_t e = 0; e < dvi_mesh_count(share, 1); e++)
    A[e] = start_of(dvi_mesh_share_numbers(share, 1)[e]);
  const dvi_march_state by_A = {.size = sizeof by_A, .A = A}, by_B = {.size = sizeof by_B, .B = B};
  dvi_march *march[3];
  for (int i = 0; i < 3; i++) march[i] = begin(share, field, h, name);
  expect(dvi_march_start(march[0], &by_A) == DVI_OK, "no start by A", name);
  expect(dvi_march_sample(march[0], DVI_FORM_B, 0, NULL, B) == DVI_OK, "no B", name);
  expect(dvi_march_start(march[1], &by_B) == DVI_OK, "no start by B", name);
  expect(dvi_march_advance(march[0], 2.4 * h) == DVI_OK, "no step", name);
  expect(dvi_march_save_memory(march[0], bytes, sizeof bytes, &size) == DVI_OK, "no state", name);
  expect(dvi_march_load_memory(march[2], bytes, size) == DVI_OK, "a refused state", name);
  expect(energy_of(march[0], name) == energy_of(march[2], name), "another state", name);
  const long blocks = dvi__allocation_count();
  for (int i = 0; i < 3; i++) expect(dvi_march_advance(march[i], end) == DVI_OK, "no step", name);
  expect(dvi__allocation_count() == blocks, "a step allocates", name);
  expect(energy_of(march[0], name) > 0.1, "no energy", name);
  for (int i = 1; i < 3; i++) {
    expect(energy_of(march[0], name) == energy_of(march[i], name), "another motion", name);
    dvi_march_destroy(march + i);
  }
  dvi_march_destroy(march);
  dvi_field_destroy(&field);
  dvi_mesh_destroy(&share);
  dvi_mesh_destroy(&mesh);
  dvi_division_destroy(&division);
  dvi__release(A);
  dvi__release(B);
}

/* The mesh is destroyed. */
static void check_mesh(dvi_mesh *mesh, maker *make, double h, const char *name)
{
  check_motion(mesh, make, h, "blocks", name);
  check_motion(mesh, make, h, "ptscotch", name);
  dvi_mesh_destroy(&mesh);
}

/* ---- potentials of B ---- */

/* A field of vertices without walls. */
static dvi_field *scalar_field(const dvi_mesh *mesh)
{
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  (void)dvi_star_create(mesh, NULL, &star);
  const dvi_maxwell_terms terms = {.size = sizeof terms, .star = star, .scalar = 1};
  (void)dvi_maxwell_create(&terms, &field);
  dvi_star_destroy(&star);
  return field;
}

/* Set B to d of a form of the unknowns, of the numbers in the whole mesh. */
static void fill_B(const dvi_mesh *mesh, const dvi_field *field, double *B)
{
  dvi_matrix d;
  int64_t n;
  const int k = dvi_field_degree(field), *cell = dvi_field_unknowns(field, &n);
  const int64_t *number = dvi_mesh_share_numbers(mesh, k);
  double *A = DVI_NEW(double, dvi_mesh_count(mesh, k));
  (void)dvi_mesh_incidence(mesh, k, &d);
  for (int64_t i = 0; i < n; i++) A[cell[i]] = start_of(number != NULL ? number[cell[i]] : cell[i]);
  dvi_matrix_multiply(&d, 0, A, B);
  dvi__release(A);
}

/* A potential of B is that of one process, which has no charge, and a B without one is refused. On
 * a torus roundings leave a field that is neither a curl nor a gradient. */
static void check_potential(dvi_mesh *mesh, maker *make, double most, const char *name)
{
  dvi_mesh *share;
  dvi_division *division;
  double apart = 0, size = 0;
  expect(dvi_mesh_divide(mesh, NULL, &share, &division) == DVI_OK, "no division", name);
  dvi_field *field = make(share), *all = make(mesh);
  const int k = dvi_field_degree(all);
  const int64_t cells = dvi_mesh_count(mesh, k), faces = dvi_mesh_count(mesh, k + 1);
  double *A = DVI_NEW(double, cells), *B = DVI_NEW(double, faces), *whole = DVI_NEW(double, cells);
  fill_B(mesh, all, B);
  expect(dvi_field_vector_potential(all, B, whole) == DVI_OK, "no potential of one", name);
  fill_B(share, field, B);
  for (int64_t b = 0; b < dvi_mesh_count(share, k + 1); b++)
    if (dvi_mesh_share_owners(share, k + 1)[b] != rank) B[b] = 7; /* not looked at */
  expect(dvi_field_vector_potential(field, B, A) == DVI_OK, "no potential", name);
  for (int64_t c = 0; c < dvi_mesh_count(share, k); c++) {
    apart = fmax(apart, fabs(A[c] - whole[dvi_mesh_share_numbers(share, k)[c]]));
    size = fmax(size, fabs(whole[dvi_mesh_share_numbers(share, k)[c]]));
  }
  expect(apart <= most * size, "another potential", name);
  if (getenv("DVI_TELL") != NULL)
    (void)fprintf(stderr, "%s: potentials differ by %.2g of %.2g\n", name, apart, size);
  tell(name, hash_of(share, k, A));
  for (int64_t b = 0; b < dvi_mesh_count(share, k + 1); b++)
    B[b] = start_of(dvi_mesh_share_numbers(share, k + 1)[b]);
  expect(dvi_field_vector_potential(field, B, A) == DVI_BAD_ARGUMENT, "a potential", name);
  expect(strstr(dvi_last_error(), "no potential has this field B") != NULL, "no sentence", name);
  dvi_field_destroy(&field);
  dvi_field_destroy(&all);
  dvi_mesh_destroy(&share);
  dvi_mesh_destroy(&mesh);
  dvi_division_destroy(&division);
  dvi__release(A);
  dvi__release(B);
  dvi__release(whole);
}

/* ---- iterations ---- */

/* M x + h^2/4 K x = b. */
typedef struct equation {
  const dvi_field *field;
  double stiffness;
} equation;

static dvi_status residual(void *of, const double *x, double *r)
{
  const equation *e = of;
  const dvi_matrix K = dvi__csr_view(&e->field->stiffness, 1);
  dvi_matrix_multiply(&K, 0, x, r);
  for (int64_t i = 0; i < e->field->unknowns; i++) {
    const int64_t number = dvi_mesh_share_numbers(e->field->mesh, 1)[e->field->unknown[i]];
    r[i] = e->field->mass.value[i] * (x[i] - start_of(number)) + e->stiffness * r[i];
  }
  return DVI_OK;
}

/* Give the iterations of a step of h. */
static int iterations(dvi_mesh *mesh, maker *make, double h, const char *name)
{
  dvi_mesh *share;
  dvi_division *division;
  dvi__elliptic_report report = {0};
  expect(dvi_mesh_divide(mesh, NULL, &share, &division) == DVI_OK, "no division", name);
  dvi_field *field = make(share);
  equation e = {.field = field, .stiffness = h * h / 4};
  const dvi__field_equations equations = {
      .field = field, .mass = 1, .stiffness = h * h / 4, .residual = residual, .of = &e};
  double *x = DVI_NEW(double, field->unknowns), fastest = 0;
  (void)dvi_field_fastest(field, &fastest);
  const dvi_status status = dvi__field_solve_on_all(&equations, x, &report);
  expect(status == DVI_OK, "no solution", name);
  if (getenv("DVI_TELL") != NULL && rank == 0)
    (void)fprintf(stderr, "%s: %lld unknowns, h = %g, %.1f times leapfrog's bound: %lld\n", name,
                  (long long)field->whole_unknowns, h, h * fastest / 2,
                  (long long)report.iterations);
  dvi__release(x);
  dvi_field_destroy(&field);
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
  dvi_mesh_destroy(&mesh);
  return (int)report.iterations;
}

/* Iterations grow neither with the mesh nor with the step. The smallest box has as many edges as
 * functions of vertices. */
static void check_growth(void)
{
  for (int cells = 4; cells <= 16; cells *= 2) {
    const dvi_generator_options cube = {.cells = {cells, cells, cells}},
                                plane = {.cells = {4 * cells, 4 * cells}};
    for (int k = 0; k < 3; k++) {
      const double h = pow(10, k - 1);
      const int counts[] = {
          iterations(generated("box", cube), cavity_field, h, "boxes"),
          iterations(staggered_mesh(4 * cells, 4 * cells), cavity_field, h, "triangles"),
          iterations(generated("bcc-torus", cube), cavity_field, h, "tetrahedra"),
          iterations(generated("box", plane), cavity_field, h, "squares")};
      for (int i = 0; i < 4; i++) expect(counts[i] <= 30, "iterations", "growth");
    }
  }
}

int main(int argc, char **argv)
{
  const dvi_generator_options box = {.cells = {9, 8, 7}, .grading = {1.2, 1, 1.1}},
                              cube = {.cells = {3, 3, 3}};
  if (PetscInitialize(&argc, &argv, NULL, NULL) != 0) return 1;
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  (void)MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  check_mesh(with_core_and_exit(staggered_mesh(9, 10), NULL), lossy_field, 0.3, "lossy triangles");
  check_mesh(generated("bcc-torus", cube), cavity_field, 0.3, "torus");
  check_starts();
  check_potential(staggered_mesh(9, 10), cavity_field, 1e-12, "potential on triangles");
  if (argc > 1 && strcmp(argv[1], "all") == 0) {
    check_mesh(with_core_and_exit(generated("box", box), NULL), lossy_field, 0.5, "lossy boxes");
    check_mesh(generated("box", box), cavity_field, 0.5, "boxes");
    check_potential(generated("box", box), cavity_field, 1e-12, "potential on boxes");
    check_potential(with_core_and_exit(generated("box", box), NULL), lossy_field, 1e-12,
                    "potential on boxes without walls");
    check_potential(generated("bcc-torus", cube), cavity_field, 1e-8, "potential on a torus");
    check_potential(staggered_mesh(9, 10), scalar_field, 1e-12, "potential of vertices");
    if (ranks < 3) check_growth(); /* it takes long */
  }
  (void)PetscFinalize();
  return failures > 0;
}
