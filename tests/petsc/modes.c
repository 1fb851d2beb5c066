/* The modes of fields on the shares of MPI's processes are those of the whole mesh, which each
 * process finds, too, and those of the grid's exact waves. Usage: mpirun -np N modes */
#include <dvi/forms.h>
#include <dvi/petsc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "expect.h"
#include "modes.h"
#include "support/field/generated.h"
#include "support/meshes.h"
#include "support/shares/shares.h"

enum { MOST = 12 };

static const double pi = 3.14159265358979323846, roundoff = 1e-12;

/* ---- fields ---- */

/* A share of a mesh, and a field on it. */
typedef struct shared_field {
  dvi_mesh *share;
  dvi_division *division;
  dvi_field *field;
} shared_field;

static dvi_field *wave(const dvi_mesh *mesh, int is_fixed)
{
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  const dvi_condition fixed = {.part = "boundary", .kind = DVI_FIXED};
  (void)dvi_star_create(mesh, NULL, &star);
  const dvi_wave_terms terms = {
      .size = sizeof terms, .star = star, .condition = &fixed, .conditions = is_fixed};
  (void)dvi_wave_create(&terms, &field);
  dvi_star_destroy(&star);
  return field;
}

static dvi_field *free_membrane(const dvi_mesh *mesh)
{
  return wave(mesh, 0);
}

static dvi_field *membrane(const dvi_mesh *mesh)
{
  return wave(mesh, 1);
}

static shared_field divide(const dvi_mesh *mesh, dvi_field *(*make)(const dvi_mesh *mesh))
{
  shared_field s = {.share = NULL};
  (void)dvi_mesh_divide(mesh, NULL, &s.share, &s.division);
  if (s.share != NULL) s.field = make(s.share);
  expect(s.field != NULL, "no field", "divide");
  return s;
}

static void drop(shared_field *s)
{
  dvi_field_destroy(&s->field);
  dvi_mesh_destroy(&s->share);
  dvi_division_destroy(&s->division);
}

/* Two copies of a mesh of triangles beside each other, which have no point in common. */
static dvi_mesh *twice(dvi_mesh *mesh)
{
  int corners;
  const int *vertex = dvi_mesh_vertices(mesh, 2, &corners);
  const int64_t points = dvi_mesh_count(mesh, 0), cells = dvi_mesh_count(mesh, 2);
  double *point = calloc((size_t)points * 4, sizeof *point);
  int *both = calloc((size_t)cells * 6, sizeof *both);
  for (int64_t i = 0; i < 4 * points; i++)
    point[i] = dvi_mesh_points(mesh)[i % (2 * points)] + (i >= 2 * points && i % 2 == 0 ? 2 : 0);
  for (int64_t i = 0; i < 6 * cells; i++)
    both[i] = vertex[i % (3 * cells)] + (i >= 3 * cells ? (int)points : 0);
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .kind = dvi_mesh_kind(mesh),
                                .dimension = 2,
                                .points = 2 * points,
                                .point = point,
                                .cells = 2 * cells,
                                .vertex = both};
  dvi_mesh *made = NULL;
  (void)dvi_mesh_create(&terms, &made);
  dvi_mesh_destroy(&mesh);
  free(point);
  free(both);
  return made;
}

/* ---- the whole mesh ---- */

/* Return the largest part of x.M x that K x - lambda M x leaves, and which x.M y leaves for others,
 * over the rows of this process. */
static double defect(const shared_field *s, int count, const double *lambda, const double *mode)
{
  const int k = dvi_field_degree(s->field);
  const int64_t cells = dvi_mesh_count(s->share, k);
  const int *owner = dvi_mesh_share_owners(s->share, k);
  int64_t n;
  dvi_matrix K, M;
  const int *cell = dvi_field_unknowns(s->field, &n);
  (void)dvi_field_matrix(s->field, DVI_FIELD_STIFFNESS, &K);
  (void)dvi_field_matrix(s->field, DVI_FIELD_MASS, &M);
  double worst = 0, *x = calloc((size_t)(2 * n), sizeof *x), *Kx = x + n;
  double product[MOST * MOST] = {0};
  for (int a = 0; a < count; a++) {
    for (int64_t i = 0; i < n; i++) x[i] = mode[a * cells + cell[i]];
    dvi_matrix_multiply(&K, 0, x, Kx);
    for (int64_t i = 0; i < n; i++) {
      if (owner[cell[i]] != rank) continue;
      worst = fmax(worst, fabs(Kx[i] - lambda[a] * M.value[i] * x[i]) / lambda[a]);
      for (int b = 0; b < count; b++)
        product[a * MOST + b] += x[i] * M.value[i] * mode[b * cells + cell[i]];
    }
  }
  (void)MPI_Allreduce(MPI_IN_PLACE, product, MOST * MOST, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  for (int a = 0; a < count; a++)
    for (int b = 0; b < count; b++) worst = fmax(worst, fabs(product[a * MOST + b] - (a == b)));
  free(x);
  return worst;
}

static int are_near(int count, const double *a, const double *b)
{
  for (int i = 0; i < count; i++)
    if (!(fabs(a[i] - b[i]) <= roundoff * fabs(b[i]))) return 0;
  return 1;
}

/* Compare the modes near a shift of shares and of the whole mesh, with factors or without. The mesh
 * is destroyed. */
typedef struct comparison {
  const char *name;
  dvi_field *(*make)(const dvi_mesh *mesh);
  int count;
  double shift;
  const char *solver;
} comparison;

static void compare(dvi_mesh *mesh, const comparison *c)
{
  const dvi_modes_options options = {.size = sizeof options, .count = c->count, .shift = c->shift};
  const int is_iterated = strcmp(c->solver, "mumps") != 0;
  double expected[MOST], found[MOST];
  int64_t zeros = -1;
  dvi_modes_facts facts = {.zeros = -2};
  dvi_field *whole = c->make(mesh);
  shared_field s = divide(mesh, c->make);
  double *mode = calloc((size_t)(c->count * dvi_mesh_count(s.share, dvi_field_degree(s.field))),
                        sizeof *mode);
  (void)dvi_field_modes(whole, &options, expected, NULL, &zeros);
  const dvi__modes_request request = {.division = s.division,
                                      .field = s.field,
                                      .options = &options,
                                      .most = is_iterated ? 0 : 1000};
  expect(dvi__find_modes(&request, found, mode, &facts) == DVI_OK, "no modes", c->name);
  expect(are_near(c->count, found, expected), "other eigenvalues", c->name);
  expect(facts.zeros == zeros, "other zeros", c->name);
  expect(strcmp(facts.solver, c->solver) == 0, "another solver", c->name);
  expect((facts.iterations > 0) == is_iterated, "iterations", c->name);
  expect(facts.residual < (is_iterated ? 1e-6 : 1e-10), "residual", c->name);
  expect(defect(&s, c->count, found, mode) < (is_iterated ? 1e-6 : 1e-10), "modes", c->name);
  free(mode);
  drop(&s);
  dvi_field_destroy(&whole);
  dvi_mesh_destroy(&mesh);
}

static void compare_all(void)
{
  const dvi_generator_options box = {.cells = {5, 3, 4}, .extent = {1, 1, 1}},
                              cubes = {.cells = {7, 7, 7}, .extent = {1, 1, 1}},
                              bcc = {.cells = {3, 3, 3}, .extent = {1, 1, 1}};
  const double period[] = {1, 1, 1};
  compare(twice(staggered_mesh(9, 8)),
          &(comparison){"two membranes", free_membrane, 9, 0, "mumps"});
  compare(staggered_mesh(9, 8), &(comparison){"membrane", membrane, 5, 100, "mumps"});
  compare(generated("box", cubes), &(comparison){"box", membrane, 7, 0, "boomeramg"});
  compare(generated("box", box), &(comparison){"cavity", cavity_field, 8, 0, "mumps"});
  compare(generated("box", box), &(comparison){"cavity", cavity_field, 5, 40, "mumps"});
  compare(generated("box", box), &(comparison){"cavity", cavity_field, 8, 0, "ams"});
  compare(with_core_and_exit(generated("bcc-torus", bcc), period),
          &(comparison){"torus", lossy_field, 5, 0, "mumps"});
}

/* ---- exact waves ---- */

/* The eigenvalue of n cubes along each axis for waves with these numbers of half waves. */
static double exact(int n, int a, int b, int c)
{
  const int half[] = {a, b, c};
  double sum = 0;
  for (int i = 0; i < 3; i++) sum += pow(2 * n * sin(half[i] * pi / (2 * n)), 2);
  return sum;
}

/* Eight modes of a cube: three times 2 pi^2, twice 3 pi^2, three of six times 5 pi^2. They are
 * those of the grid. Return how far the first one is from that of the cube. */
static double check_cube(int n)
{
  const double grid[] = {exact(n, 1, 1, 0), exact(n, 1, 1, 1), exact(n, 2, 1, 0)};
  const double expected[] = {grid[0], grid[0], grid[0], grid[1],
                             grid[1], grid[2], grid[2], grid[2]};
  const dvi_generator_options box = {.cells = {n, n, n}, .extent = {1, 1, 1}};
  const dvi_modes_options eight = {.size = sizeof eight, .count = 8};
  double found[8];
  dvi_mesh *mesh = generated("box", box);
  shared_field s = divide(mesh, cavity_field);
  expect(dvi_division_modes(s.division, s.field, &eight, found, NULL, NULL) == DVI_OK, "no modes",
         "cube");
  expect(are_near(8, found, expected), "not the grid's", "cube");
  drop(&s);
  dvi_mesh_destroy(&mesh);
  return 2 * pi * pi - found[0];
}

static void check_order(void)
{
  double error = check_cube(3);
  for (int n = 4; n < 7 && ranks < 3; n++) {
    const double finer = check_cube(n), order = log(error / finer) / log(n / (n - 1.));
    expect(fabs(order - 2) < 0.1, "not of order 2", "cube");
    error = finer;
  }
}

/* ---- failures ---- */

static void refuse(const shared_field *s, const dvi_modes_options *options, dvi_status status,
                   const char *word)
{
  double found[MOST] = {-1};
  const int is_refused = dvi_division_modes(s->division, s->field, options, found, NULL, NULL) ==
                         status;
  expect(is_refused && found[0] == -1 && strstr(dvi_last_error(), word) != NULL, word, "refusal");
}

static void check_refusals(void)
{
  const dvi_generator_options line = {.cells = {8}};
  dvi_mesh *mesh = generated("interval", line);
  shared_field s = divide(mesh, free_membrane), none = {.share = NULL}, other = s;
  dvi_modes_options options = {.size = 1};
  refuse(&none, NULL, DVI_BAD_ARGUMENT, "are needed");
  refuse(&s, &options, DVI_BAD_ARGUMENT, "options.size");
  options = (dvi_modes_options){.size = sizeof options, .shift = NAN};
  refuse(&s, &options, DVI_BAD_ARGUMENT, "the shift is nan");
  options = (dvi_modes_options){.size = sizeof options, .count = 9};
  refuse(&s, &options, DVI_BAD_SIZE, "take 1 to 8");
  options.count = -1;
  refuse(&s, &options, DVI_BAD_SIZE, "take 1 to 8");
  other.field = free_membrane(mesh);
  refuse(&other, NULL, DVI_BAD_ARGUMENT, "not on the share");
  dvi_field_destroy(&other.field);
  drop(&s);
  dvi_mesh_destroy(&mesh);
}

/* All modes of a line. A shift at an eigenvalue is moved. */
static void check_line(void)
{
  const dvi_generator_options line = {.cells = {8}, .extent = {1}};
  const dvi_modes_options all = {.size = sizeof all, .count = 7},
                          near = {.size = sizeof near, .count = 2, .shift = exact(8, 2, 0, 0)};
  dvi_mesh *mesh = generated("interval", line);
  shared_field s = divide(mesh, membrane);
  double found[7], expected[7];
  for (int i = 0; i < 7; i++) expected[i] = exact(8, i + 1, 0, 0);
  expect(dvi_division_modes(s.division, s.field, &all, found, NULL, NULL) == DVI_OK &&
             are_near(7, found, expected),
         "not all", "line");
  expect(dvi_division_modes(s.division, s.field, &near, found, NULL, NULL) == DVI_OK &&
             are_near(2, found, expected),
         "not those near an eigenvalue", "line");
  drop(&s);
  dvi_mesh_destroy(&mesh);
}

/* If memory fails on the last process alone, all of them fail alike. */
static void check_memory(dvi_mesh *mesh, dvi_field *(*make)(const dvi_mesh *mesh))
{
  const dvi_modes_options options = {.size = sizeof options, .count = 1};
  shared_field s = divide(mesh, make);
  double found = -1;
  dvi_status status = DVI_NO_MEMORY;
  for (int successes = 0; status == DVI_NO_MEMORY; successes++) {
    if (rank == ranks - 1) dvi__fail_allocations_after(successes);
    status = dvi_division_modes(s.division, s.field, &options, &found, NULL, NULL);
    dvi__fail_allocations_after(-1);
    expect(status == DVI_OK || (status == DVI_NO_MEMORY && found == -1), "memory", "failures");
  }
  drop(&s);
  dvi_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
  const dvi_generator_options box = {.cells = {3, 2, 2}};
  if (PetscInitialize(&argc, &argv, NULL, NULL) != 0) return 1;
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  (void)MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  compare_all();
  check_order();
  check_line();
  check_refusals();
  check_memory(staggered_mesh(3, 3), free_membrane);
  check_memory(generated("box", box), cavity_field);
  (void)PetscFinalize();
  return failures > 0;
}
