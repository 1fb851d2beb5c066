/* Events part by part, on one or several threads, with the bits of the order by time.
 *
 * The bits are those of this order if each node gets its kicks in it. So an event may happen as
 * soon as no earlier one of a cell with a common node is left, and independent ones in any order
 * (Kale and Lew 2007). Every member lets the events of its part happen in their order, and there is
 * no barrier: before an event of a cell at the edge it waits for the earlier ones of foreign cells
 * there. Putting such events off, to go on with others meanwhile, costs more than it saves.
 *
 * A cell at the edge publishes its next event (release) after the present one has happened, and
 * others look at it (acquire) before they touch a common node. Nobody waits forever: the first of
 * all events that are left waits for none.
 *
 * An event that fails is never followed by another one of its cell. All members end when they see
 * the sign that it leaves. Then what is stored is of no single time.
 *
 * Free steps of many cells jump through memory. So cells and nodes of the events that follow in the
 * calendar are fetched before they are needed. */
#include <math.h>
#include <stdatomic.h>

#include "field/elastic_avi/neighbours.h"

/* An event: its slot, or with free steps its time, and the own number of its cell. */
typedef struct part_event {
  double at;
  int64_t cell;
} part_event;

typedef struct run {
  dvi__solid_avi *avi;
  double end; /* the last slot or time */
  atomic_int is_stopped;
} run;

static int is_before(part_event a, part_event b)
{
  return a.at == b.at ? a.cell < b.cell : a.at < b.at;
}

/* ---- the events of a part in their order ---- */

static void open_slot(const dvi__solid_avi *avi, dvi__solid_part *p, int64_t slot)
{
  p->slot = slot;
  p->next = 0;
  p->due = p->class_end[dvi__solid_class_of_slot(avi, slot)];
}

/* Give the next event of a part. Returns 0 if there is none up to the end. */
static int find_next(const run *r, dvi__solid_part *p, part_event *event)
{
  if (r->avi->is_free) {
    const dvi__calendar_event *first = dvi__calendar_next(p->calendar);
    if (first == NULL || !(first->t <= r->end)) return 0;
    *event = (part_event){first->t, first->number};
    return 1;
  }
  while ((double)p->slot <= r->end && p->next == p->due) open_slot(r->avi, p, p->slot + 1);
  if (!((double)p->slot <= r->end)) return 0;
  *event = (part_event){(double)p->slot, p->cell[p->next]};
  return 1;
}

static void take_slot(const dvi__solid_avi *avi, dvi__solid_part *p)
{
  p->next++;
  if (p->next + DVI__CELL_AHEAD < p->due)
    DVI__FETCH_CELL(avi->cell + p->cell[p->next + DVI__CELL_AHEAD]);
}

/* Take the next event, and fetch cells and nodes of later ones. */
static void take_free(const dvi__solid_avi *avi, dvi__calendar *calendar)
{
  dvi__calendar_take(calendar);
  const dvi__calendar_event *far = dvi__calendar_ahead(calendar, DVI__CELL_AHEAD),
                            *near = dvi__calendar_ahead(calendar, DVI__NODES_AHEAD);
  if (far != NULL) {
    DVI__FETCH_CELL(avi->cell + far->number);
    DVI__FETCH(avi->state.count + far->number);
  }
  for (int a = 0; a <= avi->n && near != NULL; a++)
    DVI__FETCH(avi->state.node + avi->cell[near->number].corner[a]);
}

static void take_next(const run *r, dvi__solid_part *p)
{
  if (r->avi->is_free)
    take_free(r->avi, p->calendar);
  else
    take_slot(r->avi, p);
}

/* ---- edges ---- */

/* Wait until the earlier events of foreign cells at the nodes of a cell have happened. Returns 0 if
 * the run is stopped. */
static int await_foreign(run *r, part_event event, int edge)
{
  const dvi__solid_parts *all = r->avi->parts;
  for (int64_t k = all->foreign_start[edge]; k < all->foreign_start[edge + 1]; k++) {
    const int foreign = all->foreign[k];
    for (int waited = 0;; waited++) {
      const double after = atomic_load_explicit(all->after + foreign, memory_order_acquire);
      if (!is_before((part_event){after, all->cell_at[foreign]}, event)) break;
      if (atomic_load_explicit(&r->is_stopped, memory_order_relaxed)) return 0;
      dvi__team_pause(waited);
    }
  }
  return 1;
}

static void publish(const dvi__solid_avi *avi, int edge, double after)
{
  atomic_store_explicit(avi->parts->after + edge, after, memory_order_release);
}

/* ---- events ---- */

/* Let an event happen, and tell other parts of it if they may ask. Returns 0 if it fails. */
static int act(run *r, dvi__solid_part *p, part_event event)
{
  dvi__solid_avi *avi = r->avi;
  const int edge = avi->cell[event.cell].edge;
  const double t = avi->is_free ? event.at : dvi__solid_slot_time(avi, (int64_t)event.at);
  const int returned = dvi__solid_act(avi, event.cell, t);
  if (returned != 0) {
    p->halt = (dvi__solid_halt){returned, event.cell, t};
    return 0;
  }
  p->t = fmax(p->t, t);
  p->events++;
  if (avi->is_free) {
    const int64_t count = ++avi->state.count[event.cell];
    const double after = dvi__solid_event_time(avi, event.cell, count + 1);
    if (edge >= 0) publish(avi, edge, after);
    dvi__calendar_put(p->calendar, after, event.cell);
  } else if (edge >= 0) {
    publish(avi, edge, event.at + avi->cell[event.cell].step / avi->shortest);
  }
  return 1;
}

/* Let the events of a member's part happen. */
static void work(void *user, int number)
{
  run *r = user;
  dvi__solid_part *p = r->avi->parts->part + number;
  for (part_event event; find_next(r, p, &event);) {
    const int edge = r->avi->cell[event.cell].edge;
    if (edge >= 0 && !await_foreign(r, event, edge)) return;
    take_next(r, p);
    if (act(r, p, event)) continue;
    atomic_store(&r->is_stopped, 1);
    return;
  }
}

/* ---- runs ---- */

/* The slot or time of the next event of a cell. */
static double next_of(const dvi__solid_avi *avi, int64_t c)
{
  if (avi->is_free) return dvi__solid_event_time(avi, c, avi->state.count[c] + 1);
  const double period = avi->cell[c].step / avi->shortest;
  return (floor((double)avi->clock.slot / period) + 1) * period;
}

static void order_part(const dvi__solid_avi *avi, dvi__solid_part *p)
{
  double first = INFINITY;
  for (int64_t i = 0; i < p->count; i++) {
    const int edge = avi->cell[p->cell[i]].edge;
    if (edge >= 0) publish(avi, edge, next_of(avi, p->cell[i]));
  }
  open_slot(avi, p, avi->clock.slot + 1);
  if (!avi->is_free) return;
  for (int64_t i = 0; i < p->count; i++) first = fmin(first, next_of(avi, p->cell[i]));
  dvi__calendar_clear(p->calendar, first);
  for (int64_t i = 0; i < p->count; i++)
    dvi__calendar_put(p->calendar, next_of(avi, p->cell[i]), p->cell[i]);
}

void dvi__solid_order(dvi__solid_avi *avi)
{
  for (int k = 0; avi->parts != NULL && k < avi->parts->count; k++)
    order_part(avi, avi->parts->part + k);
}

static run run_to(dvi__solid_avi *avi, double limit)
{
  int64_t slot = avi->clock.slot;
  while (!avi->is_free && dvi__solid_slot_time(avi, slot + 1) <= limit) slot++;
  run r = {.avi = avi, .end = avi->is_free ? limit : (double)slot};
  for (int k = 0; k < avi->parts->count; k++) {
    avi->parts->part[k].halt = (dvi__solid_halt){0};
    avi->parts->part[k].t = avi->clock.t;
  }
  return r;
}

dvi__solid_halt dvi__solid_run_parts(dvi__solid_avi *avi, double limit)
{
  dvi__solid_parts *all = avi->parts;
  dvi__solid_halt halt = {0};
  run r = run_to(avi, limit);
  int is_left = 0;
  for (int k = 0; k < all->count; k++) {
    part_event event;
    is_left |= find_next(&r, all->part + k, &event);
    avi->clock.events -= all->part[k].events;
  }
  if (is_left && all->team != NULL) dvi__team_run(all->team, all->count, work, &r);
  if (is_left && all->team == NULL) work(&r, 0);
  for (int k = 0; k < all->count; k++) {
    const dvi__solid_part *p = all->part + k;
    if (p->halt.returned != 0) halt = p->halt;
    avi->clock.t = fmax(avi->clock.t, p->t);
    avi->clock.events += p->events;
  }
  if (!avi->is_free) avi->clock.slot = (int64_t)r.end;
  return halt;
}

/* Find the part with the first event of all, or NULL. */
static dvi__solid_part *find_first(const run *r, part_event *first)
{
  dvi__solid_part *found = NULL;
  for (int k = 0; k < r->avi->parts->count; k++) {
    part_event next;
    if (!find_next(r, r->avi->parts->part + k, &next)) continue;
    if (found != NULL && !is_before(next, *first)) continue;
    found = r->avi->parts->part + k;
    *first = next;
  }
  return found;
}

/* The calendars of the parts are one. */
static dvi__solid_halt run_calendars(dvi__solid_avi *avi, double limit)
{
  run r = run_to(avi, limit);
  part_event event;
  for (dvi__solid_part *p; (p = find_first(&r, &event)) != NULL;) {
    take_next(&r, p);
    if (!act(&r, p, event)) return p->halt;
    avi->clock.events++;
    avi->clock.t = p->t;
  }
  return (dvi__solid_halt){0};
}

dvi__solid_halt dvi__solid_run_in_order(dvi__solid_avi *avi, double limit)
{
  if (avi->neighbours != NULL) return dvi__solid_run_shared(avi, limit);
  return (avi->is_free ? run_calendars : dvi__solid_run_slots)(avi, limit);
}
