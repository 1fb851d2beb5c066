/* Events on several threads, with the bits of one.
 *
 * The bits are those of one thread if each node gets its kicks in the order of the events, by time
 * and then by the cells' own numbers. Every member lets the events of its part of the cells happen
 * in this order. A cell at the edge of a part has nodes in common with cells of others, the foreign
 * ones. It waits until the next event of each of them is later than its own. All others never look
 * at what the other members do, and there is no barrier (Kale and Lew 2007).
 *
 * The foreign cells of a cell have it among their own foreign ones. So of two events with a common
 * node the later one waits for the earlier one, and sees what that wrote, because a cell publishes
 * its next event (release) only after the present one, and others look at it (acquire) before they
 * touch a node. Nobody waits forever: of all events that are left the first one of all is the first
 * one of its member, and no foreign cell has an earlier one.
 *
 * An event that fails is never followed by another one of its cell, so others may wait for it. They
 * end, too, when they see the sign that it leaves. Then what is stored is of no single time. */
#include "field/elastic_avi/members.h"

#include <math.h>
#include <stdatomic.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic_avi/parts.h"
#include "num/team.h"

/* A cell at the edge of a part. */
typedef struct edge_cell {
  int cell;
  double period;       /* slots between two events, of classes */
  int64_t foreign_end; /* of its foreign cells, which begin where those of the last edge end */
} edge_cell;

typedef struct member {
  int64_t count;
  int *cell; /* [count] own numbers, ascending */
  int *edge; /* [count] or -1 */
  int64_t class_end[DVI__SOLID_CLASSES];
  dvi__calendar *calendar; /* of free steps. Its numbers are places in `cell` */
} member;

/* What a member did in a run. Only it writes there. */
typedef struct outcome {
  dvi__solid_halt halt;
  int64_t slot, events;
  double t;
  char rest_of_lines[128 - sizeof(dvi__solid_halt) - 2 * sizeof(int64_t) - sizeof(double)];
} outcome;

typedef struct dvi__solid_members {
  int count;
  dvi__team *team;
  member *member;   /* [count] */
  outcome *outcome; /* [count] */
  int64_t edges;
  edge_cell *edge;       /* [edges] member by member */
  int *foreign;          /* edges */
  _Atomic double *after; /* [edges] slots or times of the next events */
  atomic_int is_stopped;
} dvi__solid_members;

/* ---- a run ---- */

typedef struct run {
  dvi__solid_avi *avi;
  dvi__solid_members *all;
  double limit;
} run;

/* Whether the next event of an edge is later than that of a cell at a slot or time. */
static int is_later(const dvi__solid_members *all, int edge, double at, int cell)
{
  const double next = atomic_load_explicit(&all->after[edge], memory_order_acquire);
  return next > at || (next == at && all->edge[edge].cell > cell);
}

/* Wait until an edge's event may happen. Returns 0 if the run has stopped. */
static int await_foreign(dvi__solid_members *all, int own, double at)
{
  const int cell = all->edge[own].cell;
  const int64_t end = all->edge[own].foreign_end;
  for (int64_t k = own > 0 ? all->edge[own - 1].foreign_end : 0; k < end; k++)
    for (int waited = 0; !is_later(all, all->foreign[k], at, cell); waited++) {
      if (atomic_load_explicit(&all->is_stopped, memory_order_relaxed)) return 0;
      dvi__team_pause(waited);
    }
  return 1;
}

static void publish(dvi__solid_members *all, int edge, double next)
{
  atomic_store_explicit(&all->after[edge], next, memory_order_release);
}

/* Let an event happen at a time, which is `at` in slots or the same. Returns 0 if the run stops. */
static int act(const run *r, outcome *out, int cell, int edge, double at, double t)
{
  if (edge >= 0 && !await_foreign(r->all, edge, at)) return 0;
  const int returned = dvi__solid_act(r->avi, cell, t);
  if (returned == 0) return 1;
  out->halt = (dvi__solid_halt){returned, cell, t};
  atomic_store(&r->all->is_stopped, 1);
  return 0;
}

/* Let the events of a member in a slot happen. Returns 0 if the run stops. */
static int run_slot(const run *r, const member *own, outcome *out, int64_t slot)
{
  const double t = dvi__solid_slot_time(r->avi, slot), at = (double)slot;
  const int64_t end = own->class_end[dvi__solid_class_of_slot(r->avi, slot)];
  for (int64_t i = 0; i < end; i++) {
    const int edge = own->edge[i];
    if (!act(r, out, own->cell[i], edge, at, t)) return 0;
    if (edge >= 0) publish(r->all, edge, at + r->all->edge[edge].period);
  }
  out->events += end;
  out->slot = slot;
  out->t = t;
  return 1;
}

static void run_slots(void *user, int number)
{
  const run *r = user;
  const member *own = r->all->member + number;
  outcome *out = r->all->outcome + number;
  for (int64_t slot = r->avi->clock.slot + 1; dvi__solid_slot_time(r->avi, slot) <= r->limit;
       slot++)
    if (!run_slot(r, own, out, slot)) return;
}

static void run_calendar(void *user, int number)
{
  const run *r = user;
  const member *own = r->all->member + number;
  outcome *out = r->all->outcome + number;
  for (;;) {
    const dvi__calendar_event *first = dvi__calendar_next(own->calendar);
    if (first == NULL || !(first->t <= r->limit)) return;
    const dvi__calendar_event next = *first;
    const int cell = own->cell[next.number], edge = own->edge[next.number];
    if (!act(r, out, cell, edge, next.t, next.t)) return;
    const int64_t count = ++r->avi->state.count[cell];
    const double after = dvi__solid_event_time(r->avi, cell, count + 1);
    if (edge >= 0) publish(r->all, edge, after);
    dvi__calendar_take(own->calendar);
    dvi__calendar_put(own->calendar, after, next.number);
    out->events++;
    out->t = next.t;
  }
}

/* The slot or time of the next event. */
static double next_of(const dvi__solid_avi *avi, const edge_cell *e)
{
  if (avi->is_free) return dvi__solid_event_time(avi, e->cell, avi->state.count[e->cell] + 1);
  return (floor((double)avi->clock.slot / e->period) + 1) * e->period;
}

static int has_events_before(const dvi__solid_avi *avi, double limit)
{
  const dvi__solid_members *all = avi->members;
  if (!avi->is_free) return dvi__solid_slot_time(avi, avi->clock.slot + 1) <= limit;
  for (int i = 0; i < all->count; i++) {
    const dvi__calendar_event *first = dvi__calendar_next(all->member[i].calendar);
    if (first != NULL && first->t <= limit) return 1;
  }
  return 0;
}

dvi__solid_halt dvi__solid_run_members(dvi__solid_avi *avi, double limit)
{
  dvi__solid_members *all = avi->members;
  run r = {avi, all, limit};
  dvi__solid_halt halt = {0};
  if (!has_events_before(avi, limit)) return halt;
  atomic_store(&all->is_stopped, 0);
  for (int64_t k = 0; k < all->edges; k++) publish(all, (int)k, next_of(avi, all->edge + k));
  for (int i = 0; i < all->count; i++)
    all->outcome[i] = (outcome){.slot = avi->clock.slot, .t = avi->clock.t};
  dvi__team_run(all->team, all->count, avi->is_free ? run_calendar : run_slots, &r);
  for (int i = 0; i < all->count; i++) {
    const outcome *out = all->outcome + i;
    if (out->halt.returned != 0) halt = out->halt;
    avi->clock.slot = out->slot;
    avi->clock.events += out->events;
    avi->clock.t = fmax(avi->clock.t, out->t);
  }
  return halt;
}

void dvi__solid_members_order(dvi__solid_avi *avi)
{
  const dvi__solid_members *all = avi->members;
  for (int i = 0; i < all->count; i++)
    dvi__solid_order_some(avi, all->member[i].count, all->member[i].cell, all->member[i].calendar);
}

/* ---- create ---- */

void dvi__solid_members_destroy(dvi__solid_members **members)
{
  dvi__solid_members *all = *members;
  if (all == NULL) return;
  dvi__team_destroy(&all->team);
  for (int i = 0; i < all->count && all->member != NULL; i++) {
    dvi__release(all->member[i].cell);
    dvi__release(all->member[i].edge);
    dvi__calendar_destroy(&all->member[i].calendar);
  }
  dvi__release(all->member);
  dvi__release(all->outcome);
  dvi__release(all->edge);
  dvi__release(all->foreign);
  dvi__release(all->after);
  dvi__release(all);
  *members = NULL;
}

static dvi_status no_memory(const dvi__solid_avi *avi)
{
  return dvi__fail(DVI_NO_MEMORY, "%s: no memory for %d threads", avi->method, avi->threads);
}

static dvi_status make_calendar(const dvi__solid_avi *avi, member *own)
{
  double rate = 0;
  for (int64_t k = 0; k < own->count; k++) rate += 1 / avi->step[own->cell[k]];
  return dvi__calendar_create(own->count, avi->longest, rate, &own->calendar);
}

/* List the cells of a member, and number its edges. */
static dvi_status list_cells(const dvi__solid_avi *avi, dvi__solid_members *all, int number,
                             const int *owner, const uint8_t *is_edge)
{
  member *own = all->member + number;
  for (int64_t c = 0; c < avi->active; c++) own->count += owner[c] == number;
  own->cell = DVI_NEW(int, own->count);
  own->edge = DVI_NEW(int, own->count);
  if (own->cell == NULL || own->edge == NULL) return no_memory(avi);
  int64_t i = 0;
  for (int64_t c = 0; c < avi->active; c++) {
    if (owner[c] != number) continue;
    const int j = dvi__solid_class_of(avi, c);
    own->cell[i] = (int)c;
    own->edge[i] = -1;
    if (is_edge[c]) {
      own->edge[i] = (int)all->edges;
      all->edge[all->edges++] = (edge_cell){.cell = (int)c, .period = ldexp(1, j)};
    }
    i++;
    for (int k = j; k < avi->classes; k++) own->class_end[k] = i;
  }
  return avi->is_free ? make_calendar(avi, own) : DVI_OK;
}

/* The numbers of edges by cells, and the last edge that has seen each of them. */
typedef struct survey {
  const int *owner;
  int *edge_of, *seen_by; /* [active] */
} survey;

/* List the foreign cells of an edge, or with NULL count them. */
static int64_t find_foreign(const dvi__solid_avi *avi, const survey *s, int64_t own, int cell,
                            int *foreign)
{
  const int *corner = avi->corner + (int64_t)cell * (avi->n + 1);
  int64_t count = 0;
  for (int a = 0; a <= avi->n; a++)
    for (int64_t k = avi->cell_start[corner[a]]; k < avi->cell_start[corner[a] + 1]; k++) {
      const int other = avi->cell_of[k];
      if (s->owner[other] == s->owner[cell] || s->seen_by[other] == own) continue;
      s->seen_by[other] = (int)own;
      if (foreign != NULL) foreign[count] = s->edge_of[other];
      count++;
    }
  return count;
}

static dvi_status list_foreign(const dvi__solid_avi *avi, dvi__solid_members *all, const survey *s)
{
  int64_t count = 0;
  for (int64_t c = 0; c < avi->active; c++) s->seen_by[c] = -1;
  for (int64_t k = 0; k < all->edges; k++) {
    s->edge_of[all->edge[k].cell] = (int)k;
    count += find_foreign(avi, s, k, all->edge[k].cell, NULL);
    all->edge[k].foreign_end = count;
  }
  all->foreign = DVI_NEW(int, count);
  all->after = DVI_NEW(_Atomic double, all->edges);
  if (all->foreign == NULL || all->after == NULL) return no_memory(avi);
  for (int64_t c = 0; c < avi->active; c++) s->seen_by[c] = -1;
  for (int64_t k = 0; k < all->edges; k++)
    (void)find_foreign(avi, s, k, all->edge[k].cell,
                       all->foreign + (k > 0 ? all->edge[k - 1].foreign_end : 0));
  return DVI_OK;
}

/* Fill the members, with memory [active] for a while. */
static dvi_status fill(const dvi__solid_avi *avi, dvi__solid_members *all, int *owner,
                       uint8_t *is_edge, const survey *s)
{
  int64_t edges = 0;
  DVI_TRY(dvi__solid_share_out(avi, all->count, owner, is_edge));
  for (int64_t c = 0; c < avi->active; c++) edges += is_edge[c];
  all->edge = DVI_NEW(edge_cell, edges);
  if (all->edge == NULL) return no_memory(avi);
  for (int i = 0; i < all->count; i++) DVI_TRY(list_cells(avi, all, i, owner, is_edge));
  DVI_TRY(list_foreign(avi, all, s));
  return dvi__team_create(all->count, &all->team);
}

dvi_status dvi__solid_members_create(dvi__solid_avi *avi)
{
  dvi__solid_members *all = avi->members = DVI_NEW(dvi__solid_members, 1);
  int *numbers = DVI_NEW(int, 3 * avi->active);
  uint8_t *is_edge = DVI_NEW(uint8_t, avi->active);
  dvi_status status;
  if (all == NULL || numbers == NULL || is_edge == NULL) {
    status = no_memory(avi);
  } else {
    const survey s = {numbers, numbers + avi->active, numbers + 2 * avi->active};
    all->count = (int)(avi->threads < avi->active ? avi->threads : avi->active);
    all->member = DVI_NEW(member, all->count);
    all->outcome = DVI_NEW(outcome, all->count);
    status = all->member && all->outcome ? fill(avi, all, numbers, is_edge, &s) : no_memory(avi);
  }
  dvi__release(numbers);
  dvi__release(is_edge);
  if (status != DVI_OK) dvi__solid_members_destroy(&avi->members);
  return status;
}
