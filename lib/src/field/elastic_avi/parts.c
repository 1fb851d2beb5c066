/* Parts of the cells, one for each thread. */
#include "field/elastic_avi/parts.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"

typedef struct survey {
  const dvi__solid_avi *avi;
  dvi__solid_parts *all;
  int *owner; /* [active] */
  int *seen;  /* [active] the last cell that has found another */
  int *found; /* [active] */
} survey;

static dvi_status no_memory(const dvi__solid_avi *avi)
{
  return dvi__fail(DVI_NO_MEMORY, "%s: no memory for the events of %lld cells on %d threads",
                   avi->method, (long long)avi->active, avi->threads);
}

/* Number the slabs of which this process has cells. Returns how many. */
static int number_slabs(const survey *s, const dvi__solid_plan *plan, int number[])
{
  int count = 0;
  for (int k = 0; k < plan->slabs; k++) number[k] = 0;
  for (int64_t c = 0; c < s->avi->active; c++) number[plan->slab[s->avi->cell[c].name]] = 1;
  for (int k = 0; k < plan->slabs; k++) count += number[k], number[k] = count - 1;
  return count > 0 ? count : 1;
}

/* Every part gets slabs in a row. Where processes share the solid, a process has few of them. */
static void share_out(const survey *s, const dvi__solid_plan *plan, int number[])
{
  const int slabs = number_slabs(s, plan, number);
  for (int64_t c = 0; c < s->avi->active; c++)
    s->owner[c] = number[plan->slab[s->avi->cell[c].name]] * s->all->count / slabs;
}

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

/* ---- edges ---- */

/* Find the cells of other parts at the nodes of a cell, each of them once. */
static int64_t find_foreign(const survey *s, int64_t c)
{
  const dvi__solid_avi *avi = s->avi;
  int64_t count = 0;
  for (int a = 0; a <= avi->n; a++) {
    const int v = avi->cell[c].corner[a];
    for (int64_t j = avi->cell_start[v]; j < avi->cell_start[v + 1]; j++) {
      const int other = avi->cell_of[j];
      if (s->owner[other] == s->owner[c] || s->seen[other] == c) continue;
      s->seen[other] = (int)c;
      s->found[count++] = other;
    }
  }
  return count;
}

/* Whether a cell c that waits for all others found waits for `cell`, too. Cells of a part and class
 * act in the order of their numbers, those after c last in the step before. */
static int is_implied(const survey *s, int64_t c, int cell, int64_t count)
{
  const dvi__solid_avi *avi = s->avi;
  for (const int *other = s->found; other < s->found + count; other++)
    if (*other > cell && (*other < c) == (cell < c) && s->owner[*other] == s->owner[cell] &&
        avi->cell[*other].step == avi->cell[cell].step)
      return !avi->is_free;
  return 0;
}

/* List the edges that a cell has to wait for, or without a list count them. */
static int64_t list_foreign(const survey *s, int64_t c, int *foreign)
{
  const int64_t found = find_foreign(s, c);
  int64_t count = 0;
  for (int64_t k = 0; k < found; k++) {
    if (is_implied(s, c, s->found[k], found)) continue;
    if (foreign != NULL) foreign[count] = s->avi->cell[s->found[k]].edge;
    count++;
  }
  return count;
}

static void forget_seen(const survey *s)
{
  for (int64_t c = 0; c < s->avi->active; c++) s->seen[c] = -1;
}

/* Number the cells at edges. Returns for how many foreign ones they wait. */
static int64_t number_edges(const survey *s)
{
  int64_t foreign = 0;
  forget_seen(s);
  for (int64_t c = 0; c < s->avi->active; c++) {
    const int64_t count = list_foreign(s, c, NULL);
    if (count > 0) s->avi->cell[c].edge = (int)s->all->edges++;
    foreign += count;
  }
  return foreign;
}

static void list_edges(const survey *s)
{
  dvi__solid_parts *all = s->all;
  int64_t count = 0;
  forget_seen(s);
  for (int64_t c = 0; c < s->avi->active; c++) {
    const int edge = s->avi->cell[c].edge;
    if (edge < 0) continue;
    all->cell_at[edge] = (int)c;
    all->foreign_start[edge] = count;
    count += list_foreign(s, c, all->foreign + count);
  }
  all->foreign_start[all->edges] = count;
}

static dvi_status make_edges(const survey *s)
{
  dvi__solid_parts *all = s->all;
  const int64_t foreign = number_edges(s);
  all->cell_at = DVI_NEW(int, all->edges);
  all->foreign_start = DVI_NEW(int64_t, all->edges + 1);
  all->foreign = DVI_NEW(int, foreign);
  all->after = DVI_NEW(_Atomic double, all->edges);
  if (!all->cell_at || !all->foreign_start || !all->foreign || !all->after)
    return no_memory(s->avi);
  list_edges(s);
  return DVI_OK;
}

/* ---- create ---- */

static dvi_status make_calendar(const dvi__solid_avi *avi, dvi__solid_part *p)
{
  double rate = 0, longest = 0;
  for (int64_t i = 0; i < p->count; i++) {
    rate += 1 / avi->step[p->cell[i]];
    longest = fmax(longest, avi->step[p->cell[i]]);
  }
  if (p->count == 0) rate = longest = avi->longest;
  return dvi__calendar_create(p->count, longest, rate, DVI__CELL_AHEAD, &p->calendar);
}

void dvi__solid_parts_destroy(dvi__solid_parts **parts)
{
  dvi__solid_parts *all = *parts;
  if (all == NULL) return;
  dvi__team_destroy(&all->team);
  for (int k = 0; k < all->count && all->part != NULL; k++)
    dvi__calendar_destroy(&all->part[k].calendar);
  dvi__release(all->part);
  dvi__release(all->cell);
  dvi__release(all->cell_at);
  dvi__release(all->foreign_start);
  dvi__release(all->foreign);
  dvi__release(all->after);
  dvi__release(all);
  *parts = NULL;
}

static dvi_status fill(const survey *s, const dvi__solid_plan *plan)
{
  const int count = s->all->count;
  if (count > 1) {
    int *number = DVI_NEW(int, plan->slabs);
    if (number == NULL) return no_memory(s->avi);
    share_out(s, plan, number);
    dvi__release(number);
  }
  list_cells(s);
  for (int k = 0; k < count && s->avi->is_free; k++)
    DVI_TRY(make_calendar(s->avi, s->all->part + k));
  if (count == 1) return DVI_OK;
  DVI_TRY(make_edges(s));
  return dvi__team_create(count, &s->all->team);
}

dvi_status dvi__solid_parts_create(const dvi__solid_plan *plan, dvi__solid_avi *avi)
{
  dvi__solid_parts *all = avi->parts = DVI_NEW(dvi__solid_parts, 1);
  if (all == NULL) return no_memory(avi);
  all->count = avi->threads < plan->slabs ? avi->threads : plan->slabs;
  all->part = DVI_NEW(dvi__solid_part, all->count);
  all->cell = DVI_NEW(int, avi->active);
  const survey s = {.avi = avi,
                    .all = all,
                    .owner = DVI_NEW(int, avi->active),
                    .seen = DVI_NEW(int, avi->active),
                    .found = DVI_NEW(int, avi->active)};
  const int has_memory = all->part && all->cell && s.owner && s.seen && s.found;
  const dvi_status status = has_memory ? fill(&s, plan) : no_memory(avi);
  dvi__release(s.owner);
  dvi__release(s.seen);
  dvi__release(s.found);
  if (status != DVI_OK) dvi__solid_parts_destroy(&avi->parts);
  return status;
}
