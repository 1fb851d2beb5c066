/* The order of tents. The lowest vertex is the next one to rise, of equal ones that with the lowest
 * number, and the front alone tells how far: as far above each end of its edges as that edge
 * reaches, its own end among them. So the tents of a way do not depend on how it is cut, and on a
 * regular mesh a level front rises in layers, whose prisms have the star of leapfrog.
 *
 * At a time t the front is below t. To see the field then, a copy of the front is raised until it
 * is level, by tents that end at t. It holds A(t), and M_k E(t) in its rows. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/step/heap.h"
#include "field/tents/front.h"
#include "num/philox.h"

/* A vertex is level if it lacks this part of a tent. Thinner tents would be null by roundings. */
static const double level_part = 1e-12;

/* A tent that leaves less than this part of itself below a level rises to it. */
static const double overshoot = 1e-6;

/* ---- order ---- */

/* Put the lowest vertex, whose time has grown, in its place. */
static void sink_first(const dvi__tents *tents, dvi__front *front)
{
  dvi__heap_sink(front->time, tents->mesh->count[0], front->heap, 0);
}

void dvi__front_order(const dvi__tents *tents, dvi__front *front)
{
  dvi__heap_order(front->time, tents->mesh->count[0], front->heap);
}

/* ---- tops ---- */

/* Return a random number of [0,1) for a tent. */
static double random_part(const dvi__tents *tents, const dvi__front *front, int vertex)
{
  const uint64_t rise = (uint64_t)front->rises[vertex];
  uint32_t x[4] = {(uint32_t)vertex, 0, (uint32_t)rise, (uint32_t)(rise >> 32)};
  dvi__philox(x, tents->seed);
  return ldexp((double)(((uint64_t)x[0] << 32 | x[1]) >> 11), -53);
}

/* Return the time to which a vertex may rise. */
static double top_of(const dvi__tents *tents, const dvi__front *front, int vertex)
{
  const dvi_mesh *mesh = tents->mesh;
  double top = INFINITY;
  for (int64_t i = tents->edges.start[vertex]; i < tents->edges.start[vertex + 1]; i++) {
    const int edge = tents->edges.cell[i], *end = mesh->corner[1] + (ptrdiff_t)edge * 2;
    top = fmin(top, tents->reach[edge] + fmin(front->time[end[0]], front->time[end[1]]));
  }
  if (tents->least == 1) return top;
  const double part = tents->least + (1 - tents->least) * random_part(tents, front, vertex),
               now = front->time[vertex];
  return now + part * (top - now);
}

/* ---- advance ---- */

void dvi__front_copy(const dvi__tents *tents, const dvi__front *from, dvi__front *to)
{
  const size_t vertices = (size_t)tents->mesh->count[0],
               values = (size_t)tents->mesh->count[tents->k];
  memcpy(to->time, from->time, vertices * sizeof *to->time);
  memcpy(to->rises, from->rises, vertices * sizeof *to->rises);
  memcpy(to->heap, from->heap, vertices * sizeof *to->heap);
  memcpy(to->A, from->A, values * sizeof *to->A);
  memcpy(to->row, from->row, values * sizeof *to->row);
  to->tents = from->tents;
}

/* A tent whose height is lost in the roundings of the time would be repeated for ever. */
static dvi_status pitch_first(const dvi__tents *tents, dvi__front *front, double top)
{
  const int vertex = front->heap[0];
  if (!(top > front->time[vertex])) {
    const dvi__cell_name name = dvi__name_cell(tents->mesh, 0, vertex);
    return dvi__fail(DVI_SINGULAR,
                     "tents: %s cannot rise at t = %.17g: its edges are shorter than roundings of "
                     "the time",
                     name.text, front->time[vertex]);
  }
  DVI_TRY(dvi__tent_pitch(tents, front, vertex, top));
  sink_first(tents, front);
  return DVI_OK;
}

dvi_status dvi__tents_pitch(dvi__tents *tents, int *vertex, double *top)
{
  *vertex = tents->front.heap[0];
  *top = top_of(tents, &tents->front, *vertex);
  DVI_TRY(pitch_first(tents, &tents->front, *top));
  tents->t = fmax(tents->t, *top);
  *tents->level_time = (double)NAN;
  return DVI_OK;
}

static dvi_status pitch_below(dvi__tents *tents, double t)
{
  dvi__front *front = &tents->front;
  for (double top; (top = top_of(tents, front, front->heap[0])) <= t;)
    DVI_TRY(pitch_first(tents, front, top));
  return DVI_OK;
}

dvi_status dvi__tents_advance(dvi__tents *tents, double t)
{
  dvi__front_copy(tents, &tents->front, tents->level);
  *tents->level_time = (double)NAN;
  const dvi_status status = pitch_below(tents, t);
  if (status == DVI_OK)
    tents->t = t;
  else
    dvi__front_copy(tents, tents->level, &tents->front);
  return status;
}

static dvi_status raise_to_level(const dvi__tents *tents)
{
  dvi__front *front = tents->level;
  const double t = tents->t;
  while (front->time[front->heap[0]] < t) {
    const int vertex = front->heap[0];
    const double now = front->time[vertex], top = top_of(tents, front, vertex), rise = top - now;
    if (t - now > level_part * rise) {
      DVI_TRY(pitch_first(tents, front, t - top > overshoot * rise ? top : t));
      continue;
    }
    front->time[vertex] = t;
    sink_first(tents, front);
  }
  return DVI_OK;
}

dvi_status dvi__tents_level(const dvi__tents *tents)
{
  if (*tents->level_time == tents->t) return DVI_OK;
  *tents->level_time = (double)NAN;
  dvi__front_copy(tents, &tents->front, tents->level);
  DVI_TRY(raise_to_level(tents));
  *tents->level_time = tents->t;
  return DVI_OK;
}
