#define _DEFAULT_SOURCE
#include "scaling/ranks_limits.h"

#include <limits.h>
#include <math.h>
#include <unistd.h>

#include "scaling/ranks_model.h"
#include "scaling/whole.h"

enum { SUM_BYTES = 71 * 8 /* of an exact sum (docs/fields/shares.md) */ };

static const double disk = 1e9; /* bytes a second that one process writes */

static double machine_memory(void)
{
  return (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
}

/* Find the number of ranks from which on a mesh of constant size makes them wait longer than
 * compute, by bisection, or 0 if that never happens. */
static double find_waiting(const ranks_bench *b, step_prediction *at)
{
  double none = 1, all = b->whole.cells, efficiency;
  if (!ranks_model_predict(b, all, false, at, &efficiency) || at->exchange <= at->compute) return 0;
  while (all > none * 1.001 + 1) {
    const double middle = sqrt(none * all);
    if (!ranks_model_predict(b, middle, false, at, &efficiency)) return 0;
    if (at->exchange > at->compute)
      all = middle;
    else
      none = middle;
  }
  (void)ranks_model_predict(b, all, false, at, &efficiency);
  return all;
}

/* Find the first of the numbers that are asked for, of which blocks of a grid are foreseen. */
static double find_waiting_blocks(const ranks_bench *b, step_prediction *at)
{
  double efficiency;
  for (int i = 0; i < b->asked.count; i++)
    if (ranks_model_predict(b, b->asked.number[i], false, at, &efficiency) &&
        at->exchange > at->compute)
      return b->asked.number[i];
  return 0;
}

static void print_strong(FILE *stream, const ranks_bench *b)
{
  step_prediction at = {.cells = 0};
  const double ranks = b->whole.kind == TIMED_GRID ? find_waiting_blocks(b, &at)
                                                   : find_waiting(b, &at);
  if (ranks <= 0) {
    (void)fprintf(stream, "  constant %s: the halo never takes longer than the cells\n",
                  whole_name(&b->whole));
    return;
  }
  const double latency = at.messages * (b->cost.latency + b->cost.overhead),
               bytes = at.bytes * (1 / b->cost.bandwidth + b->cost.packing);
  (void)fprintf(
      stream,
      "  constant %s: from %.0f ranks on, with %.0f %s each, a step waits longer than it "
      "computes:\n    %s of the halo is the larger part, %.1f of %.1f us. What would be done: %s\n",
      whole_name(&b->whole), ranks, at.cells, whole_unit(&b->whole),
      latency > bytes ? "latency" : "bandwidth", 1e6 * fmax(latency, bytes), 1e6 * at.exchange,
      "inner cells while messages\n    are under way, and two steps for one halo of twice "
      "the "
      "width");
}

/* A limit in weak scaling, at a number of ranks. */
typedef struct limit {
  double ranks;
  const char *what, *remedy;
} limit;

static void sort(int count, limit *list)
{
  for (int i = 1; i < count; i++)
    for (int k = i; k > 0 && list[k].ranks < list[k - 1].ranks; k--) {
      const limit earlier = list[k];
      list[k] = list[k - 1];
      list[k - 1] = earlier;
    }
}

/* A sum of all ranks takes an agreement of log2 N messages in a row, each with all digits. */
static double sum_seconds(const ranks_bench *b, double ranks)
{
  const double message = b->cost.latency + b->cost.overhead + SUM_BYTES / b->cost.bandwidth;
  return ceil(log2(ranks)) * message;
}

static void print_weak(FILE *stream, const ranks_bench *b)
{
  const double start = b->cores * b->mesh_bytes;
  limit list[] = {
      {machine_memory() / start, "the whole mesh in the memory of each rank at the start",
       "a file that ranks read in parts (dvi mesh FILE --write mesh.h5, and mesh: {file: "
       "mesh.h5})"},
      {INT_MAX / b->whole.numbered, "the numbers of the whole mesh's cells, which are ints",
       "numbers of 64 bits"},
      {machine_memory() / b->whole.state_bytes,
       "a saved state, which the first rank holds and writes alone",
       b->whole.kind == TIMED_GRID ? "files that all ranks write"
                                   : "a state in parts, which all ranks write (--checkpoint "
                                     "FILE.h5)"}};
  enum { LIMITS = sizeof list / sizeof *list };
  sort(LIMITS, list);
  if (b->is_in_parts)
    (void)fprintf(stream,
                  "  start: ranks read the mesh in parts, and none holds the whole of it\n");
  (void)fprintf(stream,
                "  %s that grows with the ranks, %.0f %s each, %d ranks on a machine of "
                "%.3g GB:\n",
                whole_name(&b->whole), b->whole.cells, whole_unit(&b->whole), b->cores,
                1e-9 * machine_memory());
  for (int i = 0; i < LIMITS; i++)
    if (isfinite(list[i].ranks))
      (void)fprintf(stream, "    beyond %.0f ranks: %s;\n      %s\n", fmax(1, floor(list[i].ranks)),
                    list[i].what, list[i].remedy);
}

void ranks_limits_print(FILE *stream, const ranks_bench *b)
{
  const double last = b->asked.number[b->asked.count - 1];
  step_prediction p;
  double efficiency;
  (void)fprintf(stream, "\nWhat breaks first\n");
  print_strong(stream, b);
  print_weak(stream, b);
  if (!ranks_model_predict(b, last, true, &p, &efficiency)) return;
  (void)fprintf(
      stream,
      "  rows: an exact sum of %.0f ranks, as that of the energy, takes %.3g us, %.2f of a "
      "step; a state of as many\n    meshes, %.3g GB, takes the first rank %.3g s at %g "
      "GB/s\n",
      last, 1e6 * sum_seconds(b, last), sum_seconds(b, last) / p.seconds,
      1e-9 * last * b->whole.state_bytes, last * b->whole.state_bytes / disk, 1e-9 * disk);
}
