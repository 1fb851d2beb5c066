/* What a step of a divided grid of boxes costs, and the part of it in which planes go to
 * neighbours: a cube, or with PLANES a slab of it, with some numbers of steps together, of which 0
 * is the default. The triad a = b + 3 c of all processes measures the memory. The best of some
 * blocks of steps counts. The energy has the same digits for any number of processes.
 * Usage: mpirun -np N test_petsc_box_cost [CELLS [PLANES [around]]]. "around" lets the grid repeat
 * itself, so that each process has two neighbours.
 *
 * test_petsc_box_cost CELLS alone ROWS COLUMNS measures one of ROWS x COLUMNS processes that divide
 * y and z of the cube, without the others and MPI: what it would send comes to it at once. It has
 * neighbours on all sides. */
#include <dvi/march.h>
#include <dvi/petsc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/ranks.h"

enum { BLOCKS = 16, STEPS = 12, TRIAD = 12000000, CHOICES = 5 };

static const int together[CHOICES] = {1, 2, 4, 6, 0};

static int pulse(double t, double *value, void *user)
{
  (void)user;
  *value = exp(-(t - 5) * (t - 5));
  return 0;
}

static void need(dvi_status status)
{
  if (status == DVI_OK) return;
  (void)fprintf(stderr, "box_cost: %s\n", dvi_last_error());
  (void)MPI_Abort(MPI_COMM_WORLD, 1);
}

/* A grid of which one axis, or y and z, repeat themselves. */
static dvi_march *make(int cells, int planes, int around, int steps, const dvi_yee_ranks *ranks)
{
  const dvi_yee_dipole dipole = {
      .at = {cells / 2., cells / 2., planes / 2.}, .along = {1, 2, 3}, .signal = pulse};
  const dvi_yee_end ends[] = {{.kind = DVI_YEE_PEC}, {.kind = DVI_YEE_PERIODIC}},
                    up = ends[around > 0], across = ends[ranks->parts[1] > 1];
  const dvi_march_state start = {.size = sizeof start};
  const dvi_yee_terms terms = {.size = sizeof terms,
                               .axes = 3,
                               .degree = 1,
                               .axis = {{.cells = cells, .upper = cells},
                                        {.cells = cells, .upper = cells, .end = {across, across}},
                                        {.cells = planes, .upper = planes, .end = {up, up}}},
                               .together = steps,
                               .dipole = &dipole,
                               .dipoles = 1,
                               .ranks = ranks};
  dvi_march *march;
  need(dvi_yee_create(&terms, &march));
  need(dvi_march_start(march, &start));
  return march;
}

/* Advance by a block, and return its seconds. */
static double take_block(dvi_march *march)
{
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  (void)MPI_Barrier(MPI_COMM_WORLD);
  const double start = MPI_Wtime();
  need(dvi_march_advance(march, ((double)facts.steps + STEPS + 0.2) * facts.step));
  (void)MPI_Barrier(MPI_COMM_WORLD);
  return MPI_Wtime() - start;
}

static void measure(int cells, int planes, int around, int steps, const dvi_yee_ranks *ranks)
{
  watched_ranks watched = {.ranks = ranks};
  const dvi_yee_ranks here = watch_ranks(&watched);
  dvi_march *march = make(cells, planes, around, steps, &here);
  double best = (double)INFINITY, on_way = 0, bytes = 0, energy;
  for (int block = 0; block < BLOCKS; block++) {
    watched = (watched_ranks){.ranks = ranks};
    const double seconds = take_block(march);
    if (seconds < best)
      best = seconds, on_way = watched.seconds, bytes = 8 * (double)watched.numbers;
  }
  need(dvi_march_observe(march, 0, &energy));
  if (ranks->rank == 0)
    printf("together %d: %.3f ms/step, of which planes take %.3f ms for %.0f kB each way, "
           "energy %.17g\n",
           steps, 1e3 * best / STEPS, 1e3 * on_way / STEPS, bytes / STEPS / 2e3, energy);
  dvi_march_destroy(&march);
}

static void measure_triad(const dvi_yee_ranks *ranks)
{
  const size_t count = TRIAD / (size_t)ranks->count;
  double *a = malloc(3 * count * sizeof *a), best = (double)INFINITY;
  if (a == NULL) (void)MPI_Abort(MPI_COMM_WORLD, 1);
  double *b = a + count, *c = b + count;
  for (size_t i = 0; i < 3 * count; i++) a[i] = (double)i;
  for (int run = 0; run < BLOCKS; run++) {
    (void)MPI_Barrier(MPI_COMM_WORLD);
    const double start = MPI_Wtime();
    for (size_t i = 0; i < count; i++) a[i] = b[i] + (3 + run) * c[i];
    (void)MPI_Barrier(MPI_COMM_WORLD);
    best = fmin(best, MPI_Wtime() - start);
  }
  if (ranks->rank == 0 && a[count / 2] > 0)
    printf("triad of %d processes: %.1f GB/s\n", ranks->count, 24e-9 * TRIAD / best);
  free(a);
}

/* ---- a process alone ---- */

static int come_back(int to, int from, int64_t count, const double *sent, double *received,
                     void *user)
{
  (void)to, (void)from, (void)user;
  memcpy(received, sent, (size_t)count * sizeof *sent);
  return 0;
}

static int only(int count, double *number, void *user)
{
  (void)count, (void)number, (void)user;
  return 0;
}

static int only_of(int count, int64_t *number, void *user)
{
  (void)count, (void)number, (void)user;
  return 0;
}

static void measure_alone(int cells, int rows, int columns)
{
  const dvi_yee_ranks ranks = {.size = sizeof ranks,
                               .count = rows * columns,
                               .parts = {1, rows, columns},
                               .pass = come_back,
                               .sum = only_of,
                               .largest = only};
  for (size_t i = 0; i < CHOICES; i++) measure(cells, cells, columns > 1, together[i], &ranks);
}

int main(int argc, char **argv)
{
  dvi_yee_ranks *ranks = NULL;
  if (MPI_Init(&argc, &argv) != MPI_SUCCESS) return 1;
  if (argc > 4 && strcmp(argv[2], "alone") == 0) {
    measure_alone(atoi(argv[1]), atoi(argv[3]), atoi(argv[4]));
    return MPI_Finalize() != MPI_SUCCESS;
  }
  const int cells = argc > 1 ? atoi(argv[1]) : 100, planes = argc > 2 ? atoi(argv[2]) : cells,
            around = argc > 3 && strcmp(argv[3], "around") == 0;
  need(dvi_yee_ranks_create(MPI_COMM_WORLD, &ranks));
  measure_triad(ranks);
  for (size_t i = 0; i < CHOICES; i++) measure(cells, planes, around, together[i], ranks);
  dvi_yee_ranks_destroy(&ranks);
  (void)MPI_Finalize();
  return 0;
}
