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
 * between them. Free steps do not know slots.
 *
 * Work is counted in integers, and processes that share a mesh add up theirs. So all of them find
 * the slabs of the whole mesh. */
#include "field/elastic_avi/slabs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"

/* Marks of nodes. */
enum { NOBODY = -1, SEVERAL = -2 };

enum { SLABS_MOST = 16, LIMITS_MOST = 256 };

/* Slabs are halved as long as cells at edges have no larger share in the events. */
static const double largest_edges = 0.5;

/* A cell along an axis: its place, as an integer of the same order, and its number in the whole
 * mesh. */
typedef struct placed {
  uint64_t place;
  int64_t number;
} placed;

/* A cell of this process in the row. */
typedef struct item {
  placed at;
  int64_t before; /* work of those before it */
  int cell;
} item;

typedef struct survey {
  const dvi_elastic *solid;
  dvi__solid_plan *plan;
  int is_free;
  int64_t active, all;       /* own cells with events, and those of all processes */
  int64_t work;              /* of all processes */
  item *row;                 /* [active] along an axis */
  placed limit[LIMITS_MOST]; /* where each slab but the first begins */
  int *user;                 /* [vertices] the slab of all cells of a node, or a mark */
} survey;

/* ---- the row ---- */

/* Events of a cell beside those of the one with the longest step, or of free steps, in units of
 * 2^-30 of the most. */
static int64_t work_of(const survey *s, int64_t cell)
{
  if (s->is_free) return (int64_t)ldexp(s->plan->shortest / s->plan->step[cell], 30);
  return INT64_C(1) << (s->plan->classes - 1 - s->plan->class[cell]);
}

static int is_active(const survey *s, int64_t cell)
{
  return isfinite(s->plan->step[cell]);
}

/* Cells are counted where they are owned. */
static int counts(const survey *s, int64_t cell)
{
  return is_active(s, cell) && dvi__owns(s->solid->mesh, s->solid->n, cell);
}

static placed place_of(const survey *s, int axis, int64_t cell)
{
  const dvi_elastic *e = s->solid;
  double sum = 0;
  uint64_t bits;
  for (int a = 0; a <= e->n; a++)
    sum += e->point[(int64_t)e->vertex[cell * (e->n + 1) + a] * e->n + axis];
  memcpy(&bits, &sum, sizeof bits);
  bits = bits >> 63 ? ~bits : bits | UINT64_C(1) << 63;
  return (placed){bits, dvi__whole_number(e->mesh, e->n, cell)};
}

static int is_before(placed a, placed b)
{
  return a.place == b.place ? a.number < b.number : a.place < b.place;
}

static int compare(const void *first, const void *second)
{
  const item *a = first, *b = second;
  return is_before(b->at, a->at) - is_before(a->at, b->at);
}

static void put_in_row(const survey *s, int axis)
{
  item *next = s->row;
  int64_t before = 0;
  for (int64_t c = 0; c < s->solid->cells; c++)
    if (counts(s, c)) *next++ = (item){.at = place_of(s, axis, c), .cell = (int)c};
  qsort(s->row, (size_t)s->active, sizeof *s->row, compare);
  for (int64_t i = 0; i < s->active; i++) {
    s->row[i].before = before;
    before += work_of(s, s->row[i].cell);
  }
}

/* The work of this process's cells before a place. */
static int64_t work_before(const survey *s, placed at)
{
  int64_t low = 0, high = s->active;
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    if (is_before(s->row[middle].at, at))
      low = middle + 1;
    else
      high = middle;
  }
  if (low < s->active) return s->row[low].before;
  return low > 0 ? s->row[low - 1].before + work_of(s, s->row[low - 1].cell) : 0;
}

/* ---- limits ---- */

/* The work that is due before the slab k, rounded up. */
static int64_t due_before(const survey *s, int k, int slabs)
{
  return s->work / slabs * k + (s->work % slabs * k + slabs - 1) / slabs;
}

/* Halve intervals of places or numbers, with the work of all processes before their middles, until
 * each has the first one with enough work before it. */
static dvi_status halve(survey *s, int slabs, int of_numbers)
{
  uint64_t low[LIMITS_MOST] = {0}, high[LIMITS_MOST];
  const int64_t cells = dvi__whole_count(s->solid->mesh, s->solid->n);
  for (int k = 0; k < slabs - 1; k++) high[k] = of_numbers ? (uint64_t)cells : UINT64_MAX;
  for (int is_left = 1; is_left;) {
    int64_t work[LIMITS_MOST];
    is_left = 0;
    for (int k = 0; k < slabs - 1; k++) {
      const uint64_t middle = low[k] + (high[k] - low[k]) / 2;
      work[k] = work_before(s, of_numbers ? (placed){s->limit[k].place, (int64_t)middle}
                                          : (placed){middle, INT64_MAX});
    }
    DVI_TRY(dvi__count_all(s->solid->mesh, slabs - 1, work));
    for (int k = 0; k < slabs - 1; k++) {
      const uint64_t middle = low[k] + (high[k] - low[k]) / 2;
      if (low[k] == high[k]) continue;
      if (work[k] >= due_before(s, k + 1, slabs))
        high[k] = middle;
      else
        low[k] = middle + 1;
      is_left |= low[k] < high[k];
    }
  }
  for (int k = 0; k < slabs - 1; k++) {
    if (of_numbers)
      s->limit[k].number = (int64_t)low[k];
    else
      s->limit[k].place = low[k];
  }
  return DVI_OK;
}

/* Cut the row: a slab begins at the first cell before which there is enough work. */
static dvi_status cut(survey *s, int axis, int slabs)
{
  DVI_TRY(halve(s, slabs, 0));
  DVI_TRY(halve(s, slabs, 1));
  for (int64_t c = 0; c < s->solid->cells; c++) {
    int slab = 0;
    if (!is_active(s, c)) continue;
    const placed at = place_of(s, axis, c);
    while (slab < slabs - 1 && !is_before(at, s->limit[slab])) slab++;
    s->plan->slab[c] = slab;
  }
  return DVI_OK;
}

/* ---- edges ---- */

static void find_users(const survey *s)
{
  const dvi_elastic *e = s->solid;
  for (int64_t v = 0; v < e->vertices; v++) s->user[v] = NOBODY;
  for (int64_t i = 0; i < e->cells * (e->n + 1); i++) {
    const int64_t cell = i / (e->n + 1);
    if (!is_active(s, cell)) continue;
    const int slab = s->plan->slab[cell];
    int *user = s->user + e->vertex[i];
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

/* Cut the row, and give the share of cells at edges in the events. */
static dvi_status find_edges(survey *s, int axis, int slabs, double *share)
{
  int64_t work = 0;
  DVI_TRY(cut(s, axis, slabs));
  find_users(s);
  for (int64_t i = 0; i < s->active; i++)
    if (is_at_edge(s, s->row[i].cell)) work += work_of(s, s->row[i].cell);
  DVI_TRY(dvi__count_all(s->solid->mesh, 1, &work));
  *share = (double)work / (double)s->work;
  return DVI_OK;
}

/* Give the work of the busier of two slabs in each slot, beside a half of all work. */
static dvi_status find_imbalance(const survey *s, double *imbalance)
{
  const dvi__solid_plan *plan = s->plan;
  double due[2] = {0}, busier = 0;
  int64_t count[DVI__SOLID_CLASSES][2] = {{0}};
  for (int64_t i = 0; i < s->active; i++)
    count[plan->class[s->row[i].cell]][plan->slab[s->row[i].cell]]++;
  DVI_TRY(dvi__count_all(s->solid->mesh, 2 * DVI__SOLID_CLASSES, count[0]));
  for (int j = 0; j < plan->classes; j++) {
    const double slots = ldexp(1, plan->classes - 1 - (j < plan->classes - 1 ? j + 1 : j));
    for (int k = 0; k < 2; k++) due[k] += (double)count[j][k];
    busier += slots * fmax(due[0], due[1]);
  }
  *imbalance = 2 * busier / (double)s->work;
  return DVI_OK;
}

static dvi_status choose_axis(survey *s, int slabs, int *best)
{
  double least = INFINITY;
  *best = 0;
  for (int axis = 0; axis < s->solid->n; axis++) {
    double cost, imbalance = 0;
    put_in_row(s, axis);
    DVI_TRY(find_edges(s, axis, slabs, &cost));
    if (!s->is_free) DVI_TRY(find_imbalance(s, &imbalance));
    cost += imbalance;
    if (cost < least) *best = axis;
    least = fmin(least, cost);
  }
  return DVI_OK;
}

/* Cells of other processes have the turns that their owners find. `turn` [cells] is room. */
static dvi_status find_turns(const survey *s, double *turn)
{
  const dvi_elastic *e = s->solid;
  for (int64_t c = 0; c < e->cells; c++)
    turn[c] = is_active(s, c) && is_at_edge(s, c) ? s->plan->slab[c] % 2 : 2;
  DVI_TRY(dvi__refresh(e->mesh, e->n, turn));
  for (int64_t c = 0; c < e->cells; c++) s->plan->turn[c] = (uint8_t)turn[c];
  return DVI_OK;
}

/* ---- slabs ---- */

static dvi_status make_classes(survey *s, double *room)
{
  double share;
  int axis, slabs = s->all < SLABS_MOST ? 2 : SLABS_MOST;
  DVI_TRY(choose_axis(s, 2, &axis));
  put_in_row(s, axis);
  DVI_TRY(find_edges(s, axis, slabs, &share));
  for (; share > largest_edges && slabs > 2; slabs /= 2)
    DVI_TRY(find_edges(s, axis, slabs / 2, &share));
  s->plan->slabs = slabs;
  return find_turns(s, room);
}

static dvi_status make_free(survey *s, int threads)
{
  int axis;
  s->plan->slabs = threads < s->active ? threads : (int)s->active;
  DVI_TRY(choose_axis(s, s->plan->slabs, &axis));
  put_in_row(s, axis);
  return cut(s, axis, s->plan->slabs);
}

dvi_status dvi__solid_slabs_make(const dvi_elastic *solid, const dvi__solid_request *request,
                                 dvi__solid_plan *plan)
{
  const dvi_mesh *mesh = solid->mesh;
  survey s = {.solid = solid, .plan = plan, .is_free = request->is_free};
  plan->slabs = 1;
  for (int64_t c = 0; c < solid->cells; c++) {
    s.active += counts(&s, c);
    s.work += counts(&s, c) ? work_of(&s, c) : 0;
  }
  int64_t sums[2] = {s.active, s.work};
  DVI_TRY(dvi__count_all(mesh, 2, sums));
  s.all = sums[0], s.work = sums[1];
  if (s.all < 2 || (request->is_free && request->threads < 2)) return DVI_OK;
  double *room = DVI_NEW(double, solid->cells);
  s.row = DVI_NEW(item, s.active);
  s.user = DVI_NEW(int, solid->vertices);
  dvi_status status = dvi__agree(mesh, room && s.row && s.user
                                           ? DVI_OK
                                           : dvi__fail(DVI_NO_MEMORY,
                                                       "avi: no memory for the slabs of %lld cells",
                                                       (long long)s.active));
  if (status == DVI_OK && room != NULL)
    status = request->is_free ? make_free(&s, request->threads) : make_classes(&s, room);
  dvi__release(room);
  dvi__release(s.row);
  dvi__release(s.user);
  return status;
}
