/* Slabs of a solid across an axis, with equal numbers of events in a unit of time.
 *
 * Threads share the slabs, and wait for each other at their edges. With classes many cells act in
 * one slot, in the order of their numbers. Were those of both sides of an edge in turns, each side
 * would wait for the other one again and again. So in each class the cells at the edges of even
 * slabs come first, then those of odd ones, then the others, which never wait for another slab.
 * This order does not depend on the number of threads, and nor do the bits.
 *
 * With classes a slab should also have its share in each slot. So the axis is the one with the
 * least sum of the work of the busier of two halves, slot by slot, and of the events at the edge
 * between them. Free steps do not know slots. */
#include "field/elastic_avi/slabs.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/status.h"

/* Marks of nodes. */
enum { NOBODY = -1, SEVERAL = -2 };

enum { SLABS_MOST = 16 };

/* Slabs are halved as long as cells at edges have no larger share in the events. */
static const double largest_edges = 0.5;

typedef struct placed {
  double place;
  int cell;
} placed;

typedef struct survey {
  const dvi_elastic *solid;
  dvi__solid_plan *plan;
  int64_t active;
  double rate; /* events in a unit of time */
  placed *row; /* [active] cells along an axis */
  int *user;   /* [vertices] the slab of all cells of a node, or a mark */
} survey;

static int compare(const void *first, const void *second)
{
  const placed *a = first, *b = second;
  if (a->place != b->place) return a->place < b->place ? -1 : 1;
  return (a->cell > b->cell) - (a->cell < b->cell);
}

static void put_in_row(const survey *s, int axis)
{
  const dvi_elastic *e = s->solid;
  placed *next = s->row;
  for (int64_t c = 0; c < e->cells; c++) {
    double sum = 0;
    if (isinf(s->plan->step[c])) continue;
    for (int a = 0; a <= e->n; a++)
      sum += e->point[(int64_t)e->vertex[c * (e->n + 1) + a] * e->n + axis];
    *next++ = (placed){sum, (int)c};
  }
  qsort(s->row, (size_t)s->active, sizeof *s->row, compare);
}

/* Cut the row. Every slab gets a cell. */
static void cut(const survey *s, int slabs)
{
  int slab = 0;
  int64_t taken = 0;
  double sum = 0;
  for (int64_t i = 0; i < s->active; i++) {
    const int is_full = sum >= s->rate * (slab + 1) / slabs,
              is_needed = s->active - i < slabs - slab;
    if (taken > 0 && slab < slabs - 1 && (is_full || is_needed)) {
      slab++;
      taken = 0;
    }
    s->plan->slab[s->row[i].cell] = slab;
    sum += 1 / s->plan->step[s->row[i].cell];
    taken++;
  }
}

static void find_users(const survey *s)
{
  const dvi_elastic *e = s->solid;
  for (int64_t v = 0; v < e->vertices; v++) s->user[v] = NOBODY;
  for (int64_t i = 0; i < s->active * (e->n + 1); i++) {
    const int cell = s->row[i / (e->n + 1)].cell, slab = s->plan->slab[cell];
    int *user = s->user + e->vertex[(int64_t)cell * (e->n + 1) + i % (e->n + 1)];
    if (*user == NOBODY) *user = slab;
    if (*user != slab) *user = SEVERAL;
  }
}

static int is_at_edge(const survey *s, int64_t cell)
{
  const dvi_elastic *e = s->solid;
  for (int a = 0; a <= e->n; a++)
    if (s->user[e->vertex[cell * (e->n + 1) + a]] == SEVERAL) return 1;
  return 0;
}

/* Cut the row, and return the share of cells at edges in the events. */
static double share_of_edges(const survey *s, int slabs)
{
  double events = 0;
  cut(s, slabs);
  find_users(s);
  for (int64_t i = 0; i < s->active; i++)
    if (is_at_edge(s, s->row[i].cell)) events += 1 / s->plan->step[s->row[i].cell];
  return events / s->rate;
}

/* The work of the busier of two slabs in each slot, beside a half of all work. */
static double imbalance(const survey *s)
{
  const dvi__solid_plan *plan = s->plan;
  double due[2] = {0}, busier = 0;
  int64_t count[DVI__SOLID_CLASSES][2] = {{0}};
  for (int64_t i = 0; i < s->active; i++)
    count[plan->class[s->row[i].cell]][plan->slab[s->row[i].cell]]++;
  for (int j = 0; j < plan->classes; j++) {
    const double slots = ldexp(1, j < plan->classes - 1 ? -j - 1 : -j) / plan->shortest;
    for (int k = 0; k < 2; k++) due[k] += (double)count[j][k];
    busier += slots * fmax(due[0], due[1]);
  }
  return 2 * busier / s->rate;
}

static int choose_axis(const survey *s, int is_free, int slabs)
{
  double least = INFINITY;
  int best = 0;
  for (int axis = 0; axis < s->solid->n; axis++) {
    put_in_row(s, axis);
    const double edges = share_of_edges(s, slabs), cost = is_free ? edges : edges + imbalance(s);
    if (cost < least) best = axis;
    least = fmin(least, cost);
  }
  return best;
}

static void find_turns(const survey *s)
{
  for (int64_t i = 0; i < s->active; i++) {
    const int cell = s->row[i].cell;
    s->plan->turn[cell] = (uint8_t)(is_at_edge(s, cell) ? s->plan->slab[cell] % 2 : 2);
  }
}

static void make_classes(const survey *s)
{
  int slabs = s->active < SLABS_MOST ? 2 : SLABS_MOST;
  put_in_row(s, choose_axis(s, 0, 2));
  while (share_of_edges(s, slabs) > largest_edges && slabs > 2) slabs /= 2;
  s->plan->slabs = slabs;
  find_turns(s);
}

static void make_free(const survey *s, int threads)
{
  s->plan->slabs = (int)(threads < s->active ? threads : s->active);
  put_in_row(s, choose_axis(s, 1, s->plan->slabs));
  cut(s, s->plan->slabs);
}

dvi_status dvi__solid_slabs_make(const dvi_elastic *solid, const dvi__solid_request *request,
                                 dvi__solid_plan *plan)
{
  survey s = {.solid = solid, .plan = plan};
  plan->slabs = 1;
  for (int64_t c = 0; c < solid->cells; c++) {
    s.active += isfinite(plan->step[c]);
    s.rate += 1 / plan->step[c];
  }
  if (s.active < 2 || (request->is_free && request->threads < 2)) return DVI_OK;
  s.row = DVI_NEW(placed, s.active);
  s.user = DVI_NEW(int, solid->vertices);
  const int has_memory = s.row != NULL && s.user != NULL;
  if (has_memory && request->is_free) make_free(&s, request->threads);
  if (has_memory && !request->is_free) make_classes(&s);
  dvi__release(s.row);
  dvi__release(s.user);
  return has_memory ? DVI_OK
                    : dvi__fail(DVI_NO_MEMORY, "avi: no memory for the slabs of %lld cells",
                                (long long)s.active);
}
