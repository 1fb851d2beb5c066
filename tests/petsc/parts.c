/* Shares that are read from a file in parts are those that are cut out of the whole mesh, in every
 * number, and fields have the same bits on them. */
#include "parts.h"

#include <dvi/petsc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/memory.h"
#include "expect.h"
#include "field/mesh/share.h"
#include "support/field/generated.h"
#include "support/meshes.h"
#include "support/shares/shares.h"

/* PETSc includes complex.h, whose I is no name for a parameter: libdvi's headers come first. */
#include <petscsys.h>

static char path[64];

/* The first process writes the file. */
static void write_file(const dvi_mesh *mesh)
{
  const dvi_status status = rank == 0 ? dvi_mesh_write_divided(mesh, path) : DVI_OK;
  expect(status == DVI_OK, "not written", "file");
}

/* ---- comparison ---- */

static int differ(const void *a, const void *b, int64_t count, size_t size)
{
  if (a == NULL || b == NULL) return a != b;
  return count > 0 && memcmp(a, b, (size_t)count * size) != 0;
}

static int compare_degree(const dvi_mesh *a, const dvi_mesh *b, int k)
{
  int width, other;
  const int64_t count = dvi_mesh_count(a, k);
  if (count != dvi_mesh_count(b, k)) return 1;
  int wrong = differ(dvi_mesh_share_numbers(a, k), dvi_mesh_share_numbers(b, k), count, 8) +
              differ(dvi_mesh_share_owners(a, k), dvi_mesh_share_owners(b, k), count, sizeof(int));
  const int *corner = dvi_mesh_vertices(a, k, &width),
            *other_corner = dvi_mesh_vertices(b, k, &other);
  wrong += width != other || differ(corner, other_corner, count * width, sizeof *corner);
  return wrong + (dvi__whole_count(a, k) != dvi__whole_count(b, k));
}

static int compare_parts(const dvi_mesh *a, const dvi_mesh *b)
{
  int wrong = 0, p = 0;
  for (; dvi_mesh_part_name(a, p) != NULL && dvi_mesh_part_name(b, p) != NULL; p++) {
    const char *name = dvi_mesh_part_name(a, p);
    wrong += strcmp(name, dvi_mesh_part_name(b, p)) != 0;
    wrong += dvi_mesh_part_degree(a, p) != dvi_mesh_part_degree(b, p);
    for (int k = 0; k <= dvi_mesh_part_degree(a, p); k++) {
      int64_t count, other;
      const int *cell = dvi_mesh_part_cells(a, name, k, &count),
                *other_cell = dvi_mesh_part_cells(b, name, k, &other);
      wrong += count != other || differ(cell, other_cell, count, sizeof *cell);
      wrong += dvi__part_total(a, name, k) != dvi__part_total(b, name, k);
    }
  }
  return wrong + (dvi_mesh_part_name(a, p) != dvi_mesh_part_name(b, p));
}

int share_differs(const dvi_mesh *a, const dvi_mesh *b)
{
  const int n = dvi_mesh_dimension(a), space = dvi_mesh_space(a);
  if (n != dvi_mesh_dimension(b) || space != dvi_mesh_space(b)) return 1;
  int wrong = dvi_mesh_kind(a) != dvi_mesh_kind(b);
  for (int k = 0; k <= n; k++) wrong += compare_degree(a, b, k);
  if (wrong > 0) return wrong;
  wrong += differ(dvi_mesh_points(a), dvi_mesh_points(b), dvi_mesh_count(a, 0) * space, 8);
  wrong += differ(dvi_mesh_orientation(a), dvi_mesh_orientation(b), dvi_mesh_count(a, n), 1);
  for (int l = 0; l < space; l++)
    wrong += dvi__least_coordinate(a, l, 0) != dvi__least_coordinate(b, l, 0);
  wrong += differ(a->metric, b->metric, space, 8) + differ(a->period, b->period, space, 8);
  return wrong + compare_parts(a, b);
}

/* ---- the whole mesh's own share ---- */

static int sum(int count, int64_t *number, void *user)
{
  (void)user;
  return MPI_Allreduce(MPI_IN_PLACE, number, count, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
}

static int largest(int count, double *number, void *user)
{
  (void)user;
  return MPI_Allreduce(MPI_IN_PLACE, number, count, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
}

static int refresh(int k, double *values, void *user)
{
  (void)k;
  (void)values;
  (void)user;
  return 0;
}

/* Cut out of the whole mesh what was read: PT-Scotch divides no mesh twice in the same way. */
static dvi_mesh *cut_same(const dvi_mesh *mesh, const dvi_mesh *read)
{
  const int n = dvi_mesh_dimension(mesh);
  const int64_t cells = dvi_mesh_count(mesh, n), *number = dvi_mesh_share_numbers(read, n);
  const dvi_ranks all = {.size = sizeof all,
                         .rank = rank,
                         .count = ranks,
                         .refresh = refresh,
                         .sum = sum,
                         .largest = largest};
  int *owner = DVI_NEW(int, cells);
  dvi_mesh *cut = NULL;
  for (int64_t c = 0; c < dvi_mesh_count(read, n); c++)
    if (dvi_mesh_share_owners(read, n)[c] == rank) owner[number[c]] = rank;
  (void)MPI_Allreduce(MPI_IN_PLACE, owner, (int)cells, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  (void)dvi_mesh_cut(mesh, owner, &all, &cut);
  dvi__release(owner);
  return cut;
}

/* All cells have one owner, and the ghosts are the other ones. */
static int compare_facts(const dvi_division *division, const dvi_mesh *cut, const char *name)
{
  dvi_division_facts facts;
  int wrong = 0;
  dvi_division_facts_of(division, &facts);
  for (int k = 0; k <= dvi_mesh_dimension(cut); k++) {
    int64_t own = 0;
    for (int64_t c = 0; c < dvi_mesh_count(cut, k); c++)
      own += dvi_mesh_share_owners(cut, k)[c] == rank;
    wrong += facts.owned[k] != own || facts.ghosts[k] != dvi_mesh_count(cut, k) - own;
  }
  return wrong + (strcmp(facts.partitioner, name) != 0);
}

/* ---- tests ---- */

/* Read a share, and run a field on it. */
static void check_division(const dvi_mesh *mesh, const whole_run *whole, const char *partitioner)
{
  const dvi_division_options options = {.size = sizeof options, .partitioner = partitioner};
  dvi_mesh *read;
  dvi_division *division;
  const dvi_status status = dvi_mesh_read_divided(path, &options, &read, &division);
  expect(status == DVI_OK, "no share", partitioner);
  if (status != DVI_OK) return;
  dvi_mesh *cut = cut_same(mesh, read);
  expect(cut != NULL && share_differs(cut, read) == 0, "another share", partitioner);
  expect(cut != NULL && compare_facts(division, cut, partitioner) == 0, "wrong facts", partitioner);
  if (whole != NULL) expect(run_share(read, rank, whole) == 0, "other bits", partitioner);
  dvi_mesh_destroy(&cut);
  dvi_mesh_destroy(&read);
  dvi_division_destroy(&division);
}

/* Each process reads the whole mesh, too. */
static void check_whole(const dvi_mesh *mesh)
{
  dvi_mesh *read = NULL;
  expect(dvi_mesh_read_whole(path, &read) == DVI_OK, "not read", "whole file");
  expect(read != NULL && share_differs(mesh, read) == 0, "another mesh", "whole file");
  dvi_mesh_destroy(&read);
}

/* The mesh is destroyed. `make` is NULL if there is no field on it. */
static void check_mesh(dvi_mesh *mesh, dvi_field *(*make)(const dvi_mesh *mesh))
{
  whole_run whole = {.make = make};
  if (make != NULL) run_whole(mesh, &whole);
  write_file(mesh);
  check_whole(mesh);
  check_division(mesh, make != NULL ? &whole : NULL, "blocks");
  check_division(mesh, make != NULL ? &whole : NULL, "ptscotch");
  if (make != NULL) whole_run_clear(&whole);
  dvi_mesh_destroy(&mesh);
}

static void check_meshes(void)
{
  const dvi_generator_options bcc = {.cells = {3, 3, 3}, .extent = {1, 1, 1}},
                              box = {.cells = {5, 4, 3}, .grading = {1.2, 1, 1.4}},
                              line = {.cells = {40}, .grading = {1.3}}, plain = {.size = 0};
  const double period[] = {1, 1, 1};
  check_mesh(with_core_and_exit(generated("bcc-torus", bcc), period), lossy_field);
  check_mesh(with_core_and_exit(staggered_mesh(9, 10), NULL), lossy_field);
  check_mesh(equilateral_torus(6, 8), cavity_field);
  check_mesh(with_core_and_exit(generated("box", box), NULL), lossy_field);
  check_mesh(with_core_and_exit(generated("interval", line), NULL), lossy_field);
  check_mesh(with_core_and_exit(staggered_mesh(8, 9), NULL), driven_wave);
  check_mesh(generated("icosphere", plain), NULL);
  check_mesh(generated("torus", plain), NULL);
  check_mesh(generated("cell-16", plain), NULL);
  check_mesh(jittered_mesh(4, 4, 2, 0.1, 7), NULL);
  check_mesh(jittered_mesh(3, 4, 3, 0.1, 8), NULL);
}

void parts_path(char *text, size_t size, const char *name)
{
  int process = (int)getpid();
  (void)MPI_Bcast(&process, 1, MPI_INT, 0, MPI_COMM_WORLD);
  (void)snprintf(text, size, "%s-%d.h5", name, process);
}

void check_parts(void)
{
  parts_path(path, sizeof path, "parts");
  check_meshes();
  if (rank == 0) (void)unlink(path);
}
