/* Events part by part, on one or several threads, with the bits of the order by time.
 *
 * The bits are those of this order if each node gets its kicks in it. So an event may happen as
 * soon as no earlier one of a cell with a common node is left, and independent ones in any order
 * (Kale and Lew 2007). Every member visits its part of the cells over and over, and there is no
 * barrier.
 *
 * In a visit it takes events in the order of their times, and puts off those that have to wait: for
 * a cell of another part, or for an event that was put off before. To know this, each node of the
 * part has a hold, the first event there that has not happened and cannot in this visit. At nodes
 * of the edge, those of foreign cells are found at most once a visit. An event is put off if a hold
 * of its nodes is earlier, and then holds its other nodes. A visit ends when too many were put off.
 * Nodes that have a hold, or may have one, are marked. An event of a cell without a marked node, as
 * nearly all are, can happen without a question, and no other part asks for it.
 *
 * A cell publishes its next event (release) after the present one has happened, and others look at
 * it (acquire) before they touch a common node. Next events only become later, so that a hold stays
 * safe. Nobody waits forever: the first of all events that are left is the first one of its part,
 * and no node holds it.
 *
 * An event that fails is never followed by another one of its cell. All members end when they see
 * the sign that it leaves. Then what is stored is of no single time.
 *
 * Free steps of many cells jump through memory. So cells and nodes of the events that follow in the
 * calendar are fetched before they are needed. */
#include <math.h>
#include <stdatomic.h>

#include "field/elastic_avi/parts.h"

/* A visit ends when this many more events were put off than happened of late. */
enum { PATIENCE = 16 };

typedef struct run {
  dvi__solid_avi *avi;
  double end; /* the last slot or time */
  atomic_int is_stopped;
} run;

static int is_before(dvi__part_event a, dvi__part_event b)
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

/* Give the next event that was never put off. Returns 0 if there is none up to the end. */
static int find_next(const run *r, dvi__solid_part *p, dvi__part_event *event)
{
  if (r->avi->is_free) {
    const dvi__calendar_event *first = dvi__calendar_next(p->calendar);
    if (first == NULL || !(first->t <= r->end)) return 0;
    *event = (dvi__part_event){first->t, first->number};
    return 1;
  }
  while ((double)p->slot <= r->end && p->next == p->due) open_slot(r->avi, p, p->slot + 1);
  if (!((double)p->slot <= r->end)) return 0;
  *event = (dvi__part_event){(double)p->slot, p->cell[p->next]};
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

/* ---- holds ---- */

/* Find the first event of foreign cells at a node. */
static dvi__part_event first_foreign(const dvi__solid_parts *all, const dvi__solid_part *p,
                                     int64_t node)
{
  dvi__part_event first = {.at = INFINITY};
  for (int64_t k = p->foreign_start[node]; k < p->foreign_start[node + 1]; k++) {
    const int cell = p->foreign[k];
    const dvi__part_event next = {atomic_load_explicit(&all->after[cell], memory_order_acquire),
                                  cell};
    if (is_before(next, first)) first = next;
  }
  return first;
}

/* The hold of a node. It is found when it is asked for the first time in a visit: that of foreign
 * cells at the edge, and else none. */
static dvi__part_event *hold_of(const dvi__solid_avi *avi, const dvi__solid_part *p, int node)
{
  dvi__part_hold *hold = p->hold + node;
  if (hold->visit != p->visits) {
    hold->first = node < p->edge ? first_foreign(avi->parts, p, node)
                                 : (dvi__part_event){.at = INFINITY};
    hold->visit = p->visits;
  }
  return &hold->first;
}

static int is_held(const dvi__solid_avi *avi, const dvi__solid_part *p, dvi__part_event event)
{
  const int *corner = avi->parts->corner + event.cell * (avi->n + 1);
  for (int a = 0; a <= avi->n; a++)
    if (is_before(*hold_of(avi, p, corner[a]), event)) return 1;
  return 0;
}

/* ---- marks ---- */

static int is_marked(const dvi__solid_part *p, const dvi__solid_cell *cell, int corners)
{
  uint64_t marks = 0;
  for (int a = 0; a < corners; a++)
    marks |= p->mark[cell->corner[a] >> 6] >> (cell->corner[a] & 63);
  return marks & 1;
}

static void mark(const dvi__solid_part *p, int node)
{
  p->mark[node >> 6] |= UINT64_C(1) << (node & 63);
}

/* Take the marks of the last visit from nodes that are not at the edge. */
static void clear_marks(const dvi__solid_avi *avi, const dvi__solid_part *p)
{
  for (int64_t i = 0; i < p->lates; i++) {
    const int64_t c = p->late[i].cell;
    for (int a = 0; a <= avi->n; a++) {
      const int node = avi->cell[c].corner[a];
      if (avi->parts->corner[c * (avi->n + 1) + a] >= p->edge)
        p->mark[node >> 6] &= ~(UINT64_C(1) << (node & 63));
    }
  }
}

static void put_off(const dvi__solid_avi *avi, const dvi__solid_part *p, dvi__part_event event)
{
  const int *corner = avi->parts->corner + event.cell * (avi->n + 1);
  for (int a = 0; a <= avi->n; a++) {
    dvi__part_event *hold = hold_of(avi, p, corner[a]);
    if (is_before(event, *hold)) *hold = event;
    mark(p, avi->cell[event.cell].corner[a]);
  }
}

/* ---- visits ---- */

static void publish(const dvi__solid_avi *avi, int64_t cell, double after)
{
  if (avi->parts->team != NULL)
    atomic_store_explicit(&avi->parts->after[cell], after, memory_order_release);
}

/* Let an event happen, and tell other parts of it if they may ask. Returns 0 if it fails. */
static int act(const run *r, dvi__solid_part *p, dvi__part_event event, int is_shared)
{
  dvi__solid_avi *avi = r->avi;
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
    if (is_shared) publish(avi, event.cell, after);
    dvi__calendar_put(p->calendar, after, event.cell);
  } else if (is_shared) {
    publish(avi, event.cell, event.at + avi->cell[event.cell].step / avi->shortest);
  }
  return 1;
}

/* Let the events of a part that has no edge happen. */
static void run_alone(const run *r, dvi__solid_part *p)
{
  for (dvi__part_event event; find_next(r, p, &event);) {
    take_next(r, p);
    if (!act(r, p, event, 0)) return;
  }
}

/* Take the next event, from those that were put off, of which `first` are left behind, or the
 * others, if there is room for one more. Returns 0 if there is none. */
static int take(const run *r, dvi__solid_part *p, int64_t *first, int64_t kept,
                dvi__part_event *event)
{
  const int has_late = *first < p->lates,
            has_next = kept + p->lates - *first < p->room && find_next(r, p, event);
  if (has_late && !(has_next && is_before(*event, p->late[*first]))) {
    *event = p->late[(*first)++];
    return 1;
  }
  if (has_next) take_next(r, p);
  return has_next;
}

static void keep_lates(dvi__solid_part *p, int64_t first, int64_t kept)
{
  dvi__part_event *late = p->later;
  while (first < p->lates) late[kept++] = p->late[first++];
  p->later = p->late;
  p->late = late;
  p->lates = kept;
}

/* Visit a part. Returns 0 if an event fails. */
static int visit(const run *r, dvi__solid_part *p)
{
  int64_t first = 0, kept = 0;
  dvi__part_event event;
  p->visits++;
  clear_marks(r->avi, p);
  for (int64_t balance = PATIENCE; balance > 0 && take(r, p, &first, kept, &event);) {
    const int marked = is_marked(p, r->avi->cell + event.cell, r->avi->n + 1);
    if (marked && is_held(r->avi, p, event)) {
      put_off(r->avi, p, event);
      p->later[kept++] = event;
      p->delays++;
      balance--;
    } else {
      if (!act(r, p, event, marked)) return 0;
      if (balance < PATIENCE) balance++;
    }
  }
  keep_lates(p, first, kept);
  return 1;
}

/* Whether a part has events left up to the end. */
static int has_events(const run *r, dvi__solid_part *p)
{
  dvi__part_event event;
  return p->lates > 0 || find_next(r, p, &event);
}

/* Wait until the foreign event has happened that holds the first one of a part. */
static void await_foreign(const run *r, const dvi__solid_part *p)
{
  const dvi__solid_parts *all = r->avi->parts;
  const dvi__part_event first = p->late[0];
  const int *corner = all->corner + first.cell * (r->avi->n + 1);
  int a = 0;
  while (a < r->avi->n && !is_before(p->hold[corner[a]].first, first)) a++;
  const dvi__part_event hold = p->hold[corner[a]].first;
  for (int waited = 0;
       atomic_load_explicit(&all->after[hold.cell], memory_order_acquire) <= hold.at; waited++) {
    if (atomic_load_explicit(&r->is_stopped, memory_order_relaxed)) return;
    dvi__team_pause(waited);
  }
}

/* Visit the part of a member until it is done. */
static void work(void *user, int number)
{
  run *r = user;
  dvi__solid_part *p = r->avi->parts->part + number;
  while (has_events(r, p) && !atomic_load_explicit(&r->is_stopped, memory_order_relaxed)) {
    const int64_t events = p->events;
    if (!visit(r, p))
      atomic_store(&r->is_stopped, 1);
    else if (p->events == events)
      await_foreign(r, p);
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
  for (int64_t i = 0; i < p->count; i++) publish(avi, p->cell[i], next_of(avi, p->cell[i]));
  p->lates = 0;
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
    is_left |= has_events(&r, all->part + k);
    avi->clock.events -= all->part[k].events;
  }
  if (is_left && all->team != NULL) dvi__team_run(all->team, all->count, work, &r);
  if (is_left && all->team == NULL) run_alone(&r, all->part);
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
static dvi__solid_part *find_first(const run *r, dvi__part_event *first)
{
  dvi__solid_part *found = NULL;
  for (int k = 0; k < r->avi->parts->count; k++) {
    dvi__part_event next;
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
  const run r = run_to(avi, limit);
  dvi__part_event event;
  for (dvi__solid_part *p; (p = find_first(&r, &event)) != NULL;) {
    take_next(&r, p);
    if (!act(&r, p, event, 0)) return p->halt;
    avi->clock.events++;
    avi->clock.t = p->t;
  }
  return (dvi__solid_halt){0};
}

dvi__solid_halt dvi__solid_run_in_order(dvi__solid_avi *avi, double limit)
{
  return (avi->is_free ? run_calendars : dvi__solid_run_slots)(avi, limit);
}
