/* Neighbouring slots of one kind with one mass, such as the links of a chain, drift as lanes. */
#include <string.h>

#include "step/lie/lie_drift_struct.h"
#include "core/memory.h"
#include "core/status.h"

/* Shorter runs do not pay for being put in rows. The rows of longer ones leave the nearest cache.
 * Rows consist of whole vectors. */
enum { RUN_LEAST = 4, RUN_MOST = 64, VECTOR = 8 };

enum { STORED_MOST = 12, VELOCITIES_MOST = 6 };

static int stored(const dvi__mass_block *block)
{
  return dvi__chart_stored(block->slot->kind) + (block->rigid ? 3 : 0);
}

static int velocities(const dvi__mass_block *block)
{
  return dvi__chart_velocities(block->slot->kind) + (block->rigid ? 3 : 0);
}

static int same_numbers(int count, const double *a, const double *b)
{
  for (int i = 0; i < count; i++)
    if (a[i] != b[i]) return 0;
  return 1;
}

static int same_bodies(const dvi__body *a, const dvi__body *b)
{
  return a->turned == b->turned && same_numbers(3, a->second, b->second) &&
         same_numbers(3, a->into.w, b->into.w);
}

/* Tell whether block b follows block a and drifts as it does. */
static int goes_on(const dvi__mass_block *a, const dvi__mass_block *b)
{
  return a->slot->kind == b->slot->kind && a->rigid == b->rigid && a->mass == b->mass &&
         b->slot->q == a->slot->q + stored(a) && b->slot->v == a->slot->v + velocities(a) &&
         (a->slot->kind != DVI__ROTATION ||
          (same_numbers(3, a->centre, b->centre) && same_bodies(a->body, b->body)));
}

dvi_status dvi__lie_drift_find_runs(dvi__lie_drift *l)
{
  const dvi__mass_block *block = l->blocks.block;
  int longest = 0;
  l->run = DVI_NEW(int, l->blocks.alone);
  if (l->run == NULL) return dvi__fail(DVI_NO_MEMORY, "drift: no memory");
  for (int i = l->blocks.alone - 1; i >= 0; i--) {
    const int in_lanes = block[i].slot->kind != DVI__ROTATION || l->by == DVI__BY_CAYLEY;
    l->run[i] = in_lanes && i + 1 < l->blocks.alone && goes_on(&block[i], &block[i + 1])
                    ? l->run[i + 1] + 1
                    : 1;
    if (l->run[i] > longest) longest = l->run[i];
  }
  for (int i = 0; i < l->blocks.alone; i++) {
    if (l->run[i] > RUN_MOST) l->run[i] = RUN_MOST;
    if (l->run[i] < RUN_LEAST) l->run[i] = 1;
  }
  if (longest < RUN_LEAST) return DVI_OK;
  l->rows = DVI_NEW(double,
                    (2 * STORED_MOST + 3 * VELOCITIES_MOST + DVI__LIE_DRIFT_WORK) * RUN_MOST);
  return l->rows != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "drift: no memory");
}

/* Put the numbers of `count` slots in rows. The last slot fills the idle lanes. */
static void to_rows(int numbers, size_t count, size_t width, const double *x, double *rows)
{
  for (size_t k = 0; k < width; k++)
    for (size_t i = 0, at = k < count ? k : count - 1; i < (size_t)numbers; i++)
      rows[i * width + k] = x[at * (size_t)numbers + i];
}

static void from_rows(int numbers, size_t count, size_t width, const double *rows, double *x)
{
  for (size_t k = 0; k < count; k++)
    for (size_t i = 0; i < (size_t)numbers; i++) x[k * (size_t)numbers + i] = rows[i * width + k];
}

int dvi__lie_drift_run(const dvi__lie_drift *l, int i, double h, const dvi__phase *state,
                       double *displacement)
{
  const dvi__mass_block *block = &l->blocks.block[i];
  const size_t count = (size_t)l->run[i], width = (count + VECTOR - 1) / VECTOR * VECTOR;
  const int q = block->slot->q, v = block->slot->v, nq = stored(block), nv = velocities(block);
  char left[RUN_MOST] = {0};
  dvi__slot_lanes lanes = {.block = block, .count = width, .h = h, .left = left, .y = l->rows};
  lanes.y_low = lanes.y + STORED_MOST * width;
  lanes.p = lanes.y_low + STORED_MOST * width;
  lanes.p_low = lanes.p + VELOCITIES_MOST * width;
  lanes.moved = lanes.p_low + VELOCITIES_MOST * width;
  lanes.work = lanes.moved + VELOCITIES_MOST * width;
  to_rows(nq, count, width, state->q + q, lanes.y);
  to_rows(nq, count, width, state->q_compensation + q, lanes.y_low);
  to_rows(nv, count, width, state->p + v, lanes.p);
  to_rows(nv, count, width, state->p_compensation + v, lanes.p_low);
  dvi__slot_lanes_drift(&lanes);
  if (memchr(left, 1, width) != NULL) return 0;
  from_rows(nq, count, width, lanes.y, state->q + q);
  from_rows(nq, count, width, lanes.y_low, state->q_compensation + q);
  from_rows(nv, count, width, lanes.p, state->p + v);
  from_rows(nv, count, width, lanes.p_low, state->p_compensation + v);
  from_rows(nv, count, width, lanes.moved, displacement + v);
  return 1;
}
