/* Fields on the shares of MPI's processes have every bit of the whole mesh, which each process
 * advances, too. Usage: mpirun -np N shares */
#include <dvi/elastic.h>
#include <dvi/petsc.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "expect.h"
#include "parts.h"
#include "states.h"
#include "support/field/generated.h"
#include "support/meshes.h"
#include "support/shares/shares.h"

/* PETSc includes complex.h, whose I is no name for a parameter: libdvi's headers come first. */
#include <petscsys.h>

/* Count the other processes that own cells of a degree. There are a few processes. */
static int count_owners(const dvi_mesh *share, int k)
{
  unsigned long owners = 0;
  int count = 0;
  for (int64_t c = 0; c < dvi_mesh_count(share, k); c++)
    owners |= 1UL << dvi_mesh_share_owners(share, k)[c];
  for (int r = 0; r < ranks; r++) count += r != rank && (owners >> r & 1) != 0;
  return count;
}

/* All cells have one owner, and the ghosts are the other ones. */
static int64_t count_wrong(const dvi_division_facts *facts, const dvi_mesh *share,
                           const dvi_mesh *mesh)
{
  int64_t wrong = 0;
  for (int k = 0; k <= dvi_mesh_dimension(mesh); k++) {
    int64_t owned = facts->owned[k];
    (void)MPI_Allreduce(MPI_IN_PLACE, &owned, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    wrong += owned != dvi_mesh_count(mesh, k);
    wrong += facts->owned[k] + facts->ghosts[k] != dvi_mesh_count(share, k);
    wrong += facts->bytes_in[k] != 8 * facts->ghosts[k];
    wrong += facts->messages_in[k] != count_owners(share, k);
  }
  return wrong + (facts->rank != rank) + (facts->ranks != ranks);
}

/* A partition has as many owners as it is asked for, whatever the number of processes. */
static void check_partition(const dvi_mesh *mesh, const char *partitioner)
{
  enum { PARTS = 5 };
  const dvi_division_options options = {.size = sizeof options, .partitioner = partitioner};
  const int64_t cells = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
  int64_t owned[PARTS] = {0}, wrong = 0;
  int *owner = DVI_NEW(int, cells);
  expect(dvi_mesh_partition(mesh, &options, PARTS, owner) == DVI_OK, "no partition", partitioner);
  for (int64_t c = 0; c < cells; c++) {
    wrong += owner[c] < 0 || owner[c] >= PARTS;
    if (owner[c] >= 0 && owner[c] < PARTS) owned[owner[c]]++;
  }
  for (int p = 0; p < PARTS; p++) wrong += owned[p] < cells / PARTS / 2;
  expect(wrong == 0, "a wrong partition", partitioner);
  expect(dvi_mesh_partition(mesh, &options, 0, owner) == DVI_BAD_ARGUMENT, "0 parts", partitioner);
  expect(dvi_mesh_partition(mesh, &options, (int)cells + 1, owner) == DVI_BAD_ARGUMENT,
         "too many parts", partitioner);
  dvi__release(owner);
}

/* What a refresh brings is what PETSc counts. */
static void check_traffic(const dvi_mesh *share, dvi_division *division)
{
  dvi_division_facts before, after;
  for (int k = 0; k <= dvi_mesh_dimension(share); k++) {
    double *values = DVI_NEW(double, dvi_mesh_count(share, k));
    dvi_division_facts_of(division, &before);
    (void)dvi_division_refresh(division, k, values);
    dvi_division_facts_of(division, &after);
    expect(after.traffic.bytes - before.traffic.bytes == after.bytes_in[k], "other bytes", "");
    expect(after.traffic.messages - before.traffic.messages == after.messages_in[k],
           "other messages", "");
    dvi__release(values);
  }
}

/* The owners' values come to all others, as from the library's own refresh. */
static void check_refresh(const dvi_mesh *share, dvi_division *division)
{
  int64_t wrong = 0;
  for (int k = 0; k <= dvi_mesh_dimension(share); k++) {
    double *values = DVI_NEW(double, dvi_mesh_count(share, k));
    for (int64_t c = 0; c < dvi_mesh_count(share, k); c++)
      values[c] = dvi_mesh_share_owners(share, k)[c] == rank
                      ? (double)dvi_mesh_share_numbers(share, k)[c]
                      : -1;
    wrong += dvi_division_refresh(division, k, values) != DVI_OK;
    for (int64_t c = 0; c < dvi_mesh_count(share, k); c++)
      wrong += values[c] != (double)dvi_mesh_share_numbers(share, k)[c];
    dvi__release(values);
  }
  expect(wrong == 0, "a wrong refresh", "");
  expect(dvi_division_refresh(division, 9, NULL) == DVI_BAD_ARGUMENT, "no values", "");
}

static void check_division(const dvi_mesh *mesh, const whole_run *whole, const char *partitioner)
{
  const dvi_division_options options = {.size = sizeof options, .partitioner = partitioner};
  dvi_mesh *share = NULL;
  dvi_division *division = NULL;
  dvi_division_facts facts;
  const dvi_status status = dvi_mesh_divide(mesh, &options, &share, &division);
  expect(status == DVI_OK, "no division", partitioner);
  if (status != DVI_OK) return;
  dvi_division_facts_of(division, &facts);
  expect(count_wrong(&facts, share, mesh) == 0, "wrong facts", partitioner);
  expect(strcmp(facts.partitioner, partitioner) == 0, "wrong name", partitioner);
  expect(run_share(share, rank, whole) == 0, "other bits", partitioner);
  const int64_t agreements = facts.agreements;
  dvi_division_facts_of(division, &facts);
  expect(facts.agreements > agreements, "no agreements are counted", partitioner);
  check_refresh(share, division);
  check_traffic(share, division);
  check_partition(mesh, partitioner);
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
}

/* The mesh is destroyed. */
static void check_field(dvi_mesh *mesh, dvi_field *(*make)(const dvi_mesh *mesh))
{
  whole_run whole = {.make = make};
  run_whole(mesh, &whole);
  check_division(mesh, &whole, "blocks");
  check_division(mesh, &whole, "ptscotch");
  whole_run_clear(&whole);
  dvi_mesh_destroy(&mesh);
}

static void check_fields(void)
{
  const dvi_generator_options bcc = {.cells = {3, 3, 3}, .extent = {1, 1, 1}},
                              box = {.cells = {5, 4, 3}, .grading = {1.2, 1, 1.4}},
                              line = {.cells = {40}, .grading = {1.3}};
  const double period[] = {1, 1, 1};
  check_field(with_core_and_exit(generated("bcc-torus", bcc), period), lossy_field);
  check_field(with_core_and_exit(staggered_mesh(9, 10), NULL), lossy_field);
  check_field(equilateral_torus(6, 8), cavity_field);
  check_field(generated("box", box), cavity_field);
  check_field(with_core_and_exit(generated("box", box), NULL), lossy_field);
  check_field(with_core_and_exit(generated("interval", line), NULL), lossy_field);
  check_field(with_core_and_exit(staggered_mesh(8, 9), NULL), driven_wave);
}

/* ---- solids ---- */

enum { SEEN = 8 };

/* Give what a march of a solid observes after some steps. */
static dvi_status watch_solid(const dvi_mesh *mesh, const char *method, double seen[SEEN])
{
  const dvi_elastic_material rubber = {
      .part = "all", .law = DVI_ELASTIC_NEO_HOOKEAN, .lambda = 1, .mu = 1, .rho = 1};
  const dvi_elastic_terms terms = {
      .size = sizeof terms, .mesh = mesh, .material = &rubber, .materials = 1};
  const dvi_march_options options = {.size = sizeof options, .method = method, .fraction = 0.5};
  const int64_t vertices = dvi_mesh_count(mesh, 0);
  const double *X = dvi_mesh_points(mesh);
  double *E = DVI_NEW(double, 3 * vertices);
  dvi_elastic *solid = NULL;
  dvi_march *march = NULL;
  for (int64_t v = 0; E != NULL && v < vertices; v++) E[3 * v] = 0.2 * X[3 * v + 1] * X[3 * v];
  const dvi_march_state state = {.size = sizeof state, .E = E};
  dvi_status status = dvi_elastic_create(&terms, &solid);
  if (status == DVI_OK) status = dvi_elastic_march_create(solid, &options, &march);
  if (status == DVI_OK) status = dvi_march_start(march, &state);
  if (status == DVI_OK) status = dvi_march_advance(march, 0.05);
  for (int i = 0; i < SEEN && status == DVI_OK; i++) status = dvi_march_observe(march, i, seen + i);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
  dvi__release(E);
  return status;
}

static void check_solid(const char *partitioner, const char *method)
{
  const dvi_generator_options block = {.cells = {5, 3, 3}, .grading = {2, 1, 1}};
  const dvi_division_options options = {.size = sizeof options, .partitioner = partitioner};
  dvi_mesh *mesh = generated("kuhn", block), *share = NULL;
  dvi_division *division = NULL;
  double whole[SEEN] = {0}, seen[SEEN] = {0};
  expect(watch_solid(mesh, method, whole) == DVI_OK, "no solid", method);
  expect(dvi_mesh_divide(mesh, &options, &share, &division) == DVI_OK, "no division", partitioner);
  expect(watch_solid(share, method, seen) == DVI_OK, "no solid", method);
  int differ = 0;
  for (int i = 0; i < SEEN; i++) differ |= whole[i] != seen[i];
  expect(!differ, "other bits", method);
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
  dvi_mesh_destroy(&mesh);
}

static void check_solids(void)
{
  check_solid("blocks", "verlet");
  check_solid("ptscotch", "avi");
  check_solid("blocks", "avi:classes=no");
  check_solid("ptscotch", "avi:classes=no");
}

/* The status and a word of its sentence are those of all processes. */
static void refuse(const dvi_mesh *mesh, const dvi_division_options *options, dvi_status status,
                   const char *word)
{
  dvi_mesh *share;
  dvi_division *division;
  const int is_refused = dvi_mesh_divide(mesh, options, &share, &division) == status &&
                         share == NULL && division == NULL;
  expect(is_refused && strstr(dvi_last_error(), word) != NULL, word, "refusal");
}

static void check_refusals(void)
{
  const dvi_generator_options line = {.cells = {3}}, other = {.cells = {3 + rank}};
  dvi_mesh *mesh = generated("interval", line), *mine = generated("interval", other);
  dvi_division_options options = {.size = sizeof options, .partitioner = "nobody"};
  if (ranks > 1) refuse(mine, NULL, DVI_BAD_ARGUMENT, "not the same");
  if (ranks > 3) refuse(mesh, NULL, DVI_BAD_ARGUMENT, "cannot share 3 cells");
  if (ranks > 1 && ranks < 4) refuse(mesh, &options, DVI_BAD_OPTION, "\"nobody\"");
  options.partitioner = "a name that is longer than any partitioner's";
  refuse(mesh, &options, DVI_BAD_OPTION, "longer");
  options.size = 1;
  refuse(mesh, &options, DVI_BAD_ARGUMENT, "options.size");
  dvi_mesh_destroy(&mesh);
  dvi_mesh_destroy(&mine);
}

/* If memory fails on the last process alone, all of them fail alike. */
static void check_memory(const char *partitioner)
{
  const dvi_generator_options line = {.cells = {12}};
  const dvi_division_options options = {.size = sizeof options, .partitioner = partitioner};
  dvi_mesh *mesh = generated("interval", line), *share;
  dvi_division *division;
  dvi_status status = DVI_NO_MEMORY;
  for (int successes = 0; status == DVI_NO_MEMORY; successes++) {
    if (rank == ranks - 1) dvi__fail_allocations_after(successes);
    status = dvi_mesh_divide(mesh, &options, &share, &division);
    dvi__fail_allocations_after(-1);
    expect(status == DVI_OK || (status == DVI_NO_MEMORY && share == NULL), "memory", partitioner);
    dvi_mesh_destroy(&share);
    dvi_division_destroy(&division);
  }
  dvi_mesh_destroy(&mesh);
}

/* Return whether a division before PETSc's start is refused. */
static int is_too_early(void)
{
  const dvi_generator_options line = {.cells = {3}};
  dvi_mesh *mesh = generated("interval", line), *share;
  dvi_division *division;
  const dvi_status status = dvi_mesh_divide(mesh, NULL, &share, &division);
  dvi_mesh_destroy(&mesh);
  return status == DVI_BAD_ARGUMENT && strstr(dvi_last_error(), "start PETSc") != NULL;
}

int main(int argc, char **argv)
{
  const int early = is_too_early();
  if (PetscInitialize(&argc, &argv, NULL, NULL) != 0) return 1;
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  (void)MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  expect(early, "divided before PETSc's start", "start");
  check_fields();
  check_solids();
  check_refusals();
  check_memory("blocks");
  check_memory("ptscotch");
  check_parts();
  check_states();
  if (ranks % 2 > 0) check_refused_parts(); /* two and four fail as three do */
  (void)PetscFinalize();
  return failures > 0;
}
