/* Free steps of a solid that processes share (field/elastic_avi/neighbours.h tells how). */
#include <math.h>

#include "field/elastic_avi/borders.h"
#include "field/elastic_avi/neighbours.h"
#include "field/mesh/share.h"

typedef struct run {
  dvi__solid_avi *avi;
  double limit;
  dvi__solid_halt halt; /* what stopped this process, which goes on to speak with the others */
  int64_t events;       /* of own cells */
} run;

/* ---- messages ---- */

static void send(const run *r, dvi__solid_link *link)
{
  const dvi_ranks *ranks = &r->avi->solid->mesh->share->ranks;
  if (link->count == 0 || r->avi->is_lost) return;
  r->avi->is_lost = ranks->send(link->rank, link->count, link->out, ranks->user) != 0;
  link->count = 0;
}

static void send_all(const run *r)
{
  for (int k = 0; k < r->avi->neighbours->links; k++) send(r, r->avi->neighbours->link + k);
}

/* Take the places in a message: the number of a cell among those of the link, that of its event,
 * and the components of each node that the sender owns. */
static void take_places(const run *r, const dvi__solid_link *link, int count)
{
  const dvi__solid_avi *avi = r->avi;
  const int n = avi->n, *owner = avi->solid->mesh->share->owner[0];
  for (int at = 0; at + 1 < count;) {
    const int64_t place = (int64_t)link->in[at++], event = (int64_t)link->in[at++];
    if (place < 0 || place >= link->cells) return;
    const int c = link->cell[place], *corner = avi->cell[c].corner;
    dvi__solid_edge *e = avi->neighbours->edge + avi->neighbours->edge_of[c];
    for (int a = 0; a <= n; a++) {
      if (owner[corner[a]] != link->rank || at + n > count) continue;
      for (int i = 0; i < n; i++) e->place[event & 1][a * n + i] = link->in[at++];
      e->got[event & 1] |= (uint8_t)(1U << a);
    }
  }
}

static void receive(const run *r, const dvi__solid_link *link)
{
  const dvi_ranks *ranks = &r->avi->solid->mesh->share->ranks;
  int count = 0;
  send_all(r);
  if (r->avi->is_lost) return;
  const int failed = ranks->receive(link->rank, DVI__SOLID_MESSAGE, link->in, &count, ranks->user);
  r->avi->is_lost = failed != 0 || count < 1 || count > DVI__SOLID_MESSAGE;
  if (!r->avi->is_lost) take_places(r, link, count);
}

/* ---- telling ---- */

static double next_of(const dvi__solid_avi *avi, int64_t c)
{
  return dvi__solid_event_time(avi, c, avi->state.count[c] + 1);
}

/* Find the cell of a node that has its next event. */
static int find_first(const dvi__solid_avi *avi, int vertex)
{
  int first = -1;
  double t = INFINITY;
  for (int64_t k = avi->cell_start[vertex]; k < avi->cell_start[vertex + 1]; k++) {
    const int c = avi->cell_of[k];
    const double next = next_of(avi, c);
    if (!(next < t)) continue;
    t = next;
    first = c;
  }
  return first;
}

static void add_places(const run *r, const dvi__solid_edge *e, int64_t event, const double *places,
                       int count)
{
  for (int k = 0; k < e->links; k++) {
    dvi__solid_link *link = r->avi->neighbours->link + e->link[k];
    if (link->count + 2 + count > DVI__SOLID_MESSAGE) send(r, link);
    link->out[link->count++] = (double)e->place_in[k];
    link->out[link->count++] = (double)event;
    for (int i = 0; i < count; i++) link->out[link->count++] = places[i];
  }
}

/* Tell where the own nodes of a cell are at its next event, unless other events come before. */
static void tell(const run *r, int c)
{
  const dvi__solid_avi *avi = r->avi;
  const dvi__solid_neighbours *s = avi->neighbours;
  const int n = avi->n, *corner = avi->cell[c].corner;
  const int64_t event = avi->state.count[c] + 1;
  const double t = next_of(avi, c);
  if (s->edge_of[c] < 0 || !(t <= r->limit)) return;
  dvi__solid_edge *e = s->edge + s->edge_of[c];
  if (e->told >= event) return;
  double places[DVI__SOLID_NUMBERS];
  int count = 0;
  for (int a = 0; a <= n; a++)
    if ((e->own >> a & 1) && s->first[corner[a]] != c) return;
  e->told = event;
  e->returned = 0;
  for (int a = 0; a <= n; a++) {
    if (!(e->own >> a & 1)) continue;
    dvi__solid_node node = avi->state.node[corner[a]];
    const int returned = dvi__solid_fly(avi, corner[a], t, &node, NULL);
    if (returned != 0) e->returned = returned;
    for (int i = 0; i < n; i++) places[count++] = node.u[i];
  }
  add_places(r, e, event, places, count);
}

/* After an event of a cell: its nodes have other next events. */
static void tell_next(const run *r, int c)
{
  const dvi__solid_avi *avi = r->avi;
  int *first = avi->neighbours->first;
  const int *corner = avi->cell[c].corner;
  for (int a = 0; a <= avi->n; a++)
    if (first[corner[a]] >= 0) first[corner[a]] = find_first(avi, corner[a]);
  for (int a = 0; a <= avi->n; a++)
    if (first[corner[a]] >= 0) tell(r, first[corner[a]]);
}

/* ---- events ---- */

/* Wait for the places of the nodes that others own, and put them there. Returns what a condition
 * of an own node has returned. */
static int learn(const run *r, int c, double t)
{
  const dvi__solid_avi *avi = r->avi;
  const int n = avi->n, edge = avi->neighbours->edge_of[c], *corner = avi->cell[c].corner;
  if (edge < 0) return 0;
  dvi__solid_edge *e = avi->neighbours->edge + edge;
  const int which = (int)((avi->state.count[c] + 1) & 1);
  for (int a = 0; a <= n; a++) {
    if (e->own >> a & 1) continue;
    const int owner = avi->solid->mesh->share->owner[0][corner[a]];
    int k = 0;
    while (avi->neighbours->link[e->link[k]].rank != owner) k++;
    while (!(e->got[which] >> a & 1) && !avi->is_lost)
      receive(r, avi->neighbours->link + e->link[k]);
    dvi__solid_node *node = avi->state.node + corner[a];
    node->tau = t;
    for (int i = 0; i < n; i++) {
      node->u[i] = e->place[which][a * n + i];
      node->v[i] = 0;
    }
  }
  e->got[which] = 0;
  return e->returned;
}

static void happen(run *r, dvi__calendar *calendar, dvi__calendar_event event)
{
  dvi__solid_avi *avi = r->avi;
  const int c = (int)event.number;
  int returned = learn(r, c, event.t);
  if (avi->is_lost) return;
  if (returned == 0 && r->halt.returned == 0) returned = dvi__solid_act(avi, c, event.t);
  if (returned != 0 && r->halt.returned == 0) r->halt = (dvi__solid_halt){returned, c, event.t};
  avi->clock.t = fmax(avi->clock.t, event.t);
  avi->state.count[c]++;
  r->events += dvi__owns(avi->solid->mesh, avi->n, avi->cell[c].name);
  dvi__calendar_put(calendar, next_of(avi, c), c);
  tell_next(r, c);
}

/* Forget what has been told, as after a state was taken back, and begin. */
static void begin(const run *r)
{
  const dvi__solid_avi *avi = r->avi;
  const dvi__solid_neighbours *s = avi->neighbours;
  for (int64_t k = 0; k < s->edges; k++) {
    s->edge[k].told = 0;
    s->edge[k].got[0] = s->edge[k].got[1] = 0;
  }
  for (int k = 0; k < s->links; k++) s->link[k].count = 0;
  for (int v = 0; v < avi->vertices; v++)
    if (s->first[v] >= 0) s->first[v] = find_first(avi, v);
  for (int64_t c = 0; c < avi->active; c++) tell(r, (int)c);
}

/* Count the events of own cells of which no node is owned here, and so all events, and find the
 * time of the last one. */
static void count_events(run *r)
{
  dvi__solid_avi *avi = r->avi;
  for (int64_t c = avi->active; c < avi->cells; c++) {
    if (isinf(avi->step[c]) || !dvi__owns(avi->solid->mesh, avi->n, avi->cell[c].name)) continue;
    for (; next_of(avi, c) <= r->limit; avi->state.count[c]++) r->events++;
  }
  avi->is_lost |= dvi__count_all(avi->solid->mesh, 1, &r->events) != DVI_OK;
  avi->is_lost |= dvi__largest_of_all(avi->solid->mesh, 1, &avi->clock.t) != DVI_OK;
  avi->clock.events += r->events;
}

dvi__solid_halt dvi__solid_run_shared(dvi__solid_avi *avi, double limit)
{
  run r = {.avi = avi, .limit = limit};
  dvi__calendar *calendar = avi->parts->part[0].calendar;
  if (avi->is_lost) return r.halt;
  begin(&r);
  for (const dvi__calendar_event *next; (next = dvi__calendar_next(calendar)) != NULL;) {
    const dvi__calendar_event event = *next;
    if (!(event.t <= limit) || avi->is_lost) break;
    dvi__calendar_take(calendar);
    happen(&r, calendar, event);
  }
  send_all(&r);
  if (!avi->is_lost) count_events(&r);
  return r.halt;
}
