/* Parts of the cells, one for each thread, with equal numbers of events in a unit of time.
 *
 * The cuts are across an axis, the one which leaves the fewest events to cells at the edge of a
 * part. Parts need not have as much to do as others in each slot. What matters is that the edges
 * are short, because they wait for each other. */
#include "field/elastic_avi/parts.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/status.h"

/* Marks of nodes. */
enum { NOBODY = -1, SEVERAL = -2 };

typedef struct placed {
  double place;
  int cell;
} placed;

typedef struct survey {
  const dvi__solid_avi *avi;
  dvi__solid_parts *all;
  placed *row; /* [active] cells along an axis */
  int *owner;  /* [active] */
  int *user;   /* [vertices] the part of all cells of a node, or a mark */
  int *number; /* [vertices] the number of a node in a part */
  int *seen;   /* [vertices] the last part that has numbered a node */
} survey;

static dvi_status no_memory(const dvi__solid_avi *avi)
{
  return dvi__fail(DVI_NO_MEMORY, "%s: no memory for the events of %lld cells on %d threads",
                   avi->method, (long long)avi->active, avi->threads);
}

/* ---- cuts ---- */

static int compare(const void *first, const void *second)
{
  const placed *a = first, *b = second;
  if (a->place != b->place) return a->place < b->place ? -1 : 1;
  return (a->cell > b->cell) - (a->cell < b->cell);
}

static void put_in_row(const survey *s, int axis)
{
  const dvi__solid_avi *avi = s->avi;
  for (int64_t c = 0; c < avi->active; c++) {
    double sum = 0;
    for (int a = 0; a <= avi->n; a++)
      sum += avi->solid->point[(int64_t)avi->cell[c].corner[a] * avi->n + axis];
    s->row[c] = (placed){sum, (int)c};
  }
  qsort(s->row, (size_t)avi->active, sizeof *s->row, compare);
}

/* Cut the row. Every part gets a cell. */
static void cut(const survey *s)
{
  const dvi__solid_avi *avi = s->avi;
  const int parts = s->all->count;
  double whole = 0, sum = 0;
  for (int64_t c = 0; c < avi->active; c++) whole += 1 / avi->step[c];
  int part = 0;
  int64_t taken = 0;
  for (int64_t i = 0; i < avi->active; i++) {
    const int is_full = sum >= whole * (part + 1) / parts,
              is_needed = avi->active - i < parts - part;
    if (taken > 0 && part < parts - 1 && (is_full || is_needed)) {
      part++;
      taken = 0;
    }
    s->owner[s->row[i].cell] = part;
    sum += 1 / avi->step[s->row[i].cell];
    taken++;
  }
}

static void find_users(const survey *s)
{
  const dvi__solid_avi *avi = s->avi;
  for (int64_t v = 0; v < avi->vertices; v++) s->user[v] = s->seen[v] = NOBODY;
  for (int64_t c = 0; c < avi->active; c++)
    for (int a = 0; a <= avi->n; a++) {
      int *user = s->user + avi->cell[c].corner[a];
      if (*user == NOBODY) *user = s->owner[c];
      if (*user != s->owner[c]) *user = SEVERAL;
    }
}

static int is_at_edge(const survey *s, int64_t c)
{
  for (int a = 0; a <= s->avi->n; a++)
    if (s->user[s->avi->cell[c].corner[a]] == SEVERAL) return 1;
  return 0;
}

/* Cut across an axis. Returns the events of cells at the edges in a unit of time. */
static double cut_across(const survey *s, int axis)
{
  double events = 0;
  put_in_row(s, axis);
  cut(s);
  find_users(s);
  for (int64_t c = 0; c < s->avi->active; c++)
    if (is_at_edge(s, c)) events += 1 / s->avi->step[c];
  return events;
}

/* Find the owners of cells and the users of nodes. */
static void share_out(const survey *s)
{
  double least = INFINITY;
  int best = 0;
  for (int axis = 0; axis < s->avi->n; axis++) {
    const double events = cut_across(s, axis);
    if (events < least) best = axis;
    least = fmin(least, events);
  }
  (void)cut_across(s, best);
}

/* ---- cells and nodes of parts ---- */

/* List the cells of each part. */
static void list_cells(const survey *s)
{
  const dvi__solid_avi *avi = s->avi;
  int *begin = s->all->cell;
  for (int k = 0; k < s->all->count; k++) {
    dvi__solid_part *p = s->all->part + k;
    p->cell = begin;
    for (int j = 0; j < avi->classes; j++) {
      for (int64_t c = j > 0 ? avi->class_end[j - 1] : 0; c < avi->class_end[j]; c++)
        if (s->owner[c] == k) *begin++ = (int)c;
      p->class_end[j] = p->count = begin - p->cell;
    }
  }
}

/* Number the nodes of the edge of a part, or the others. */
static void number_nodes(const survey *s, int k, int is_edge)
{
  const dvi__solid_avi *avi = s->avi;
  dvi__solid_part *p = s->all->part + k;
  for (int64_t i = 0; i < p->count; i++)
    for (int a = 0; a <= avi->n; a++) {
      const int v = avi->cell[p->cell[i]].corner[a];
      if ((s->user[v] == SEVERAL) != is_edge) continue;
      if (s->seen[v] != k) s->number[v] = (int)p->nodes++;
      s->seen[v] = k;
      s->all->corner[(int64_t)p->cell[i] * (avi->n + 1) + a] = s->number[v];
    }
  if (is_edge) p->edge = p->nodes;
}

/* List the cells of others at a node, or without a list count them. */
static int64_t list_foreign_of(const survey *s, int k, int v, int *foreign)
{
  const dvi__solid_avi *avi = s->avi;
  int64_t count = 0;
  for (int64_t j = avi->cell_start[v]; j < avi->cell_start[v + 1]; j++) {
    if (s->owner[avi->cell_of[j]] == k) continue;
    if (foreign != NULL) foreign[count] = avi->cell_of[j];
    count++;
  }
  return count;
}

/* List those of the edge, whose nodes are met in the order of their numbers. */
static void list_foreign(const survey *s, int k)
{
  const dvi__solid_avi *avi = s->avi;
  dvi__solid_part *p = s->all->part + k;
  int64_t count = 0, node = 0;
  for (int64_t i = 0; i < p->count; i++)
    for (int a = 0; a <= avi->n; a++) {
      const int64_t c = p->cell[i];
      if (node == p->edge || s->all->corner[c * (avi->n + 1) + a] != node) continue;
      p->foreign_start[node++] = count;
      count += list_foreign_of(s, k, avi->cell[c].corner[a],
                               p->foreign != NULL ? p->foreign + count : NULL);
    }
  p->foreign_start[p->edge] = count;
}

static void mark_edge(const survey *s, const dvi__solid_part *p)
{
  for (int64_t v = 0; v < s->avi->vertices; v++)
    if (s->user[v] == SEVERAL) p->mark[v / 64] |= UINT64_C(1) << v % 64;
}

static dvi_status make_edge(const survey *s, int k)
{
  dvi__solid_part *p = s->all->part + k;
  number_nodes(s, k, 1);
  number_nodes(s, k, 0);
  p->room = 2 * p->count;
  p->hold = DVI_NEW(dvi__part_hold, p->nodes);
  p->mark = DVI_NEW(uint64_t, s->avi->vertices / 64 + 1);
  p->late = DVI_NEW(dvi__part_event, p->room);
  p->later = DVI_NEW(dvi__part_event, p->room);
  p->foreign_start = DVI_NEW(int64_t, p->edge + 1);
  if (!p->hold || !p->mark || !p->late || !p->later || !p->foreign_start) return no_memory(s->avi);
  list_foreign(s, k);
  p->foreign = DVI_NEW(int, p->foreign_start[p->edge]);
  if (p->foreign == NULL) return no_memory(s->avi);
  list_foreign(s, k);
  mark_edge(s, p);
  return DVI_OK;
}

static dvi_status make_calendar(const dvi__solid_avi *avi, dvi__solid_part *p)
{
  double rate = 0, longest = 0;
  for (int64_t i = 0; i < p->count; i++) {
    rate += 1 / avi->step[p->cell[i]];
    longest = fmax(longest, avi->step[p->cell[i]]);
  }
  return dvi__calendar_create(p->count, longest, rate, DVI__CELL_AHEAD, &p->calendar);
}

/* ---- create ---- */

void dvi__solid_parts_destroy(dvi__solid_parts **parts)
{
  dvi__solid_parts *all = *parts;
  if (all == NULL) return;
  dvi__team_destroy(&all->team);
  for (int k = 0; k < all->count && all->part != NULL; k++) {
    dvi__solid_part *p = all->part + k;
    dvi__calendar_destroy(&p->calendar);
    dvi__release(p->hold);
    dvi__release(p->mark);
    dvi__release(p->foreign_start);
    dvi__release(p->foreign);
    dvi__release(p->late);
    dvi__release(p->later);
  }
  dvi__release(all->part);
  dvi__release(all->cell);
  dvi__release(all->corner);
  dvi__release(all->after);
  dvi__release(all);
  *parts = NULL;
}

static dvi_status fill(const survey *s)
{
  const int count = s->all->count;
  if (count > 1) share_out(s);
  list_cells(s);
  for (int k = 0; k < count && s->avi->is_free; k++)
    DVI_TRY(make_calendar(s->avi, s->all->part + k));
  if (count == 1) return DVI_OK;
  for (int k = 0; k < count; k++) DVI_TRY(make_edge(s, k));
  return dvi__team_create(count, &s->all->team);
}

/* Returns 0 without memory. */
static int allocate(const survey *s)
{
  const dvi__solid_avi *avi = s->avi;
  dvi__solid_parts *all = s->all;
  const int64_t shared = all->count > 1 ? avi->active : 0;
  all->part = DVI_NEW(dvi__solid_part, all->count);
  all->cell = DVI_NEW(int, avi->active);
  all->corner = DVI_NEW(int, shared *(avi->n + 1));
  all->after = DVI_NEW(_Atomic double, shared);
  return all->part && all->cell && all->corner && all->after && s->row && s->owner && s->user &&
         s->number && s->seen;
}

dvi_status dvi__solid_parts_create(dvi__solid_avi *avi)
{
  const int64_t active = avi->active, vertices = avi->vertices;
  dvi__solid_parts *all = avi->parts = DVI_NEW(dvi__solid_parts, 1);
  if (all == NULL) return no_memory(avi);
  all->count = (int)(avi->threads < active ? avi->threads : active);
  const survey s = {.avi = avi,
                    .all = all,
                    .row = DVI_NEW(placed, active),
                    .owner = DVI_NEW(int, active),
                    .user = DVI_NEW(int, vertices),
                    .number = DVI_NEW(int, vertices),
                    .seen = DVI_NEW(int, vertices)};
  const dvi_status status = allocate(&s) ? fill(&s) : no_memory(avi);
  dvi__release(s.row);
  dvi__release(s.owner);
  dvi__release(s.user);
  dvi__release(s.number);
  dvi__release(s.seen);
  if (status != DVI_OK) dvi__solid_parts_destroy(&avi->parts);
  return status;
}
