/* The flight of a node among rigid obstacles.
 *
 * Between two events a node flies straight, so that it meets a plane or a ball at a time t which is
 * the root of a polynomial of degree 1 or 2. The velocity of this flight is that of the middle of a
 * step, and a reflection of it would err by O(h). What jumps is the velocity at t,
 *
 *     w = v + d,    d = sum over the cells K of the node of  f_K (t - t_K - h_K/2)/m,
 *
 * since the last kicks, at t_K, pay for t_K - h_K/2 < t < t_K + h_K/2. The forces f_K are those at
 * t. With the ones at t_K, which differ by O(h), w would still be right to order 2, but its error
 * has a mean, by which hits would gain energy. Nodes of a cell are taken to fly on from its last
 * event, so that a hit needs nothing that other cells change.
 *
 * The part of w along the outer normal N changes from -w_N to e w_N, and Coulomb's friction takes
 * at most mu (1 + e) w_N along the surface (Fetecau, Marsden, Ortiz and West 2003). The node flies
 * on with w - d. Components that are given stay as they are: N is replaced by its free part.
 *
 * With S = sum f_K/m, the surface presses with p = -S.N on a node that lies on it, and with |v|^2/R
 * more inside of a ball and less outside. A node rests if p >= 0 and it would rise for less than
 * half of its shortest step, or if its flight would not rise at all. Then it stays on the surface
 * until p < 0, and friction slows it down by mu p or holds it. Here the forces are those of the
 * last events, for which friction has an error of O(h). So nothing sinks, trembles or gains energy.
 * A rest takes at most the energy of such a hop, O(h^2). */
#include <math.h>
#include <string.h>

#include "field/elastic/contacts.h"
#include "field/elastic_avi/engine.h"
#include "field/step/decay.h"

/* Hits of one flight. More are a rest in a wedge. */
enum { HITS_MOST = 32 };

/* Below this part of its speed, a node does not approach a surface. */
static const double least_approach = 1e-14;

typedef struct flight {
  const dvi__solid_avi *avi;
  int vertex, given; /* bits of components */
  double decay, t;   /* where it began */
  double flown;      /* so far, in units of v */
  dvi__solid_node *node;
  dvi__solid_touch *touch;
} flight;

/* Where a node meets an obstacle, and what its cells do there. Velocities are those at the begin of
 * the flight. */
typedef struct meeting {
  double gap, normal[DVI__SOLID_AXES], free[DVI__SOLID_AXES]; /* and the free part of the normal */
  double square;                                              /* of the free part */
  double debt[DVI__SOLID_AXES], pull[DVI__SOLID_AXES];        /* d and S */
  double shortest;                                            /* step of the cells */
  double pressure;                                            /* p, along the free part */
} meeting;

static double dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void add(double *a, double factor, const double *b)
{
  for (int i = 0; i < DVI__SOLID_AXES; i++) a[i] += factor * b[i];
}

/* ---- geometry ---- */

/* Give the free distance, below 0 inside of the obstacle, and its gradient. */
static double gap_of(const flight *f, const dvi_obstacle *o, double normal[DVI__SOLID_AXES])
{
  const int n = f->avi->n;
  double x[DVI__SOLID_AXES] = {0};
  for (int i = 0; i < n; i++)
    x[i] = f->avi->solid->point[(int64_t)f->vertex * n + i] + f->node->u[i];
  normal[n - 1] = normal[2] = 0;
  return dvi__solid_gap(o, n, x, normal);
}

/* Give the path length, in units of v, up to the obstacle, or infinity. */
static double length_to(const flight *f, const dvi_obstacle *o)
{
  double normal[DVI__SOLID_AXES];
  const double *v = f->node->v, gap = gap_of(f, o, normal), rate = dot(v, normal), a = dot(v, v);
  const int approaches = -rate > least_approach * sqrt(a);
  if (gap <= 0 && approaches) return 0;
  if (o->kind == DVI_OBSTACLE_PLANE) return approaches ? gap / -rate : (double)INFINITY;
  const int is_ball = o->kind == DVI_OBSTACLE_BALL;
  if (is_ball && !approaches) return INFINITY;
  /* |d + v s|^2 = R^2, with b = d.v and c = |d|^2 - R^2 */
  const double r = is_ball ? o->radius + gap : o->radius - gap, b = is_ball ? r * rate : -r * rate,
               c = is_ball ? gap * (gap + 2 * o->radius) : -gap * (2 * o->radius - gap),
               square = b * b - a * c;
  if (!(a > 0) || !(square >= 0)) return INFINITY;
  if (is_ball) return fmax(c / (sqrt(square) - b), 0);
  return fmax(b > 0 ? -c / (b + sqrt(square)) : (sqrt(square) - b) / a, 0);
}

/* Find the first obstacle on the way, but for one. */
static const dvi_obstacle *find_first(const flight *f, const dvi_obstacle *but, double *length)
{
  const dvi_obstacle *first = NULL;
  for (int i = 0; i < f->avi->solid->obstacles; i++) {
    const dvi_obstacle *o = f->avi->solid->obstacle + i;
    const double to = o != but ? length_to(f, o) : (double)INFINITY;
    if (!(to <= *length)) continue;
    *length = to;
    first = o;
  }
  return first;
}

/* ---- what cells do ---- */

/* Give the forces of a cell now, when the node is at u. Those of the last event stand in where they
 * cannot be computed. */
static void pull_now(const flight *f, int64_t c, int corner, double now, double *force)
{
  const dvi__solid_avi *avi = f->avi;
  const int n = avi->n, numbers = (n + 1) * n;
  const dvi__solid_push *push = avi->state.push + avi->cell[c].meeting;
  double u[DVI__SOLID_NUMBERS], load[DVI__SOLID_NUMBERS];
  for (int k = 0; k < numbers; k++) u[k] = push->u[k] + push->v[k] * (now - push->t);
  for (int i = 0; i < n; i++) u[corner * n + i] = f->node->u[i];
  if (dvi__solid_pull(avi, c, now, u, force, load) != 0) {
    memcpy(force, push->f, (size_t)numbers * sizeof *force);
    return;
  }
  if (!(avi->cell[c].kind & DVI__CELL_VISCOUS)) return;
  dvi__solid_resist(avi, c, push->v, load);
  for (int k = 0; k < numbers; k++) force[k] += load[k];
}

/* Set d and S, divided by what the velocity has decayed to. */
static void gather_pushes(const flight *f, int is_hit, meeting *at)
{
  const dvi__solid_avi *avi = f->avi;
  const int n = avi->n;
  const double left = 1 - f->decay * f->flown,
               now = f->t + (f->decay > 0 ? -log1p(-f->decay * f->flown) / f->decay : f->flown);
  at->shortest = INFINITY;
  for (int64_t k = avi->cell_start[f->vertex]; k < avi->cell_start[f->vertex + 1]; k++) {
    const int c = avi->cell_of[k], *corner = avi->cell[c].corner;
    const dvi__solid_push *push = avi->state.push + avi->cell[c].meeting;
    const double owed = dvi__decay_owed(f->decay, avi->cell[c].step, now - push->t);
    double fresh[DVI__SOLID_NUMBERS];
    int a = 0;
    while (corner[a] != f->vertex) a++;
    const double *force = push->f;
    if (is_hit) pull_now(f, c, a, now, fresh), force = fresh;
    at->shortest = fmin(at->shortest, avi->cell[c].step);
    for (int i = 0; i < n; i++) {
      const double rate = (f->given & 1 << i) ? 0 : f->node->inverse / left * force[a * n + i];
      at->debt[i] += owed * rate;
      at->pull[i] += rate;
    }
  }
}

static void find_pressure(const flight *f, const dvi_obstacle *o, meeting *at)
{
  double along[DVI__SOLID_AXES] = {0}, bend = 0;
  add(along, 1, f->node->v);
  add(along, -dot(along, at->normal), at->normal);
  if (o->kind == DVI_OBSTACLE_BALL) bend = -dot(along, along) / o->radius;
  if (o->kind == DVI_OBSTACLE_HOLLOW) bend = dot(along, along) / o->radius;
  at->pressure = (bend - dot(at->pull, at->normal)) / at->square;
}

/* Returns 0 if all of the normal is given. */
static int find_normal(const flight *f, const dvi_obstacle *o, meeting *at)
{
  *at = (meeting){0};
  at->gap = gap_of(f, o, at->normal);
  for (int i = 0; i < DVI__SOLID_AXES; i++) at->free[i] = (f->given & 1 << i) ? 0 : at->normal[i];
  at->square = dot(at->free, at->free);
  return at->square > 1e-12;
}

static int meet(const flight *f, const dvi_obstacle *o, int is_hit, meeting *at)
{
  if (!find_normal(f, o, at)) return 0;
  gather_pushes(f, is_hit, at);
  find_pressure(f, o, at);
  return 1;
}

/* Take the velocity along the normal, beside `rate`. */
static void set_normal_rate(const meeting *at, double rate, double *v)
{
  add(v, (rate - dot(v, at->normal)) / at->square, at->free);
}

/* Give the free part of a vector along the surface, and its length. */
static double along_surface(const flight *f, const meeting *at, const double *v, double *along)
{
  const double through = dot(v, at->free) / at->square;
  for (int i = 0; i < DVI__SOLID_AXES; i++)
    along[i] = (f->given & 1 << i) ? 0 : v[i] - through * at->free[i];
  return sqrt(dot(along, along));
}

static void stop(const flight *f)
{
  for (int i = 0; i < DVI__SOLID_AXES; i++)
    if (!(f->given & 1 << i)) f->node->v[i] = 0;
}

/* Tell if friction can hold the node. */
static int holds(const flight *f, const dvi_obstacle *o, const meeting *at)
{
  double along[DVI__SOLID_AXES];
  return o->friction > 0 && along_surface(f, at, at->pull, along) <= o->friction * at->pressure;
}

/* ---- hits ---- */

/* Reflect a velocity. What friction takes is at most all of it along the surface. Returns not 0 if
 * it takes all. */
static int reflect(const flight *f, const dvi_obstacle *o, const meeting *at, double *w)
{
  double along[DVI__SOLID_AXES];
  const double towards = -dot(w, at->normal);
  if (!(towards > 0)) return 0;
  set_normal_rate(at, o->restitution * towards, w);
  if (!(o->friction > 0)) return 0;
  const double speed = along_surface(f, at, w, along),
               loss = fmin(o->friction * (1 + o->restitution) * towards, speed);
  if (speed > 0) add(w, -loss / speed, along);
  return loss == speed;
}

/* Move a node that is inside of an obstacle, by a rounding or so, to the surface. */
static void lift(const flight *f, const dvi_obstacle *o)
{
  meeting at;
  if (find_normal(f, o, &at) && at.gap < 0) add(f->node->u, -at.gap / at.square, at.free);
}

/* Hit an obstacle. */
static void land(const flight *f, const dvi_obstacle *o)
{
  meeting at;
  double *v = f->node->v;
  if (!meet(f, o, 1, &at)) return;
  add(v, 1, at.debt);
  const double towards = -dot(v, at.normal),
               hop = 0.5 * fmax(at.pressure, 0) * at.square * at.shortest;
  const int is_caught = reflect(f, o, &at, v);
  const double rise = dot(v, at.normal);
  add(v, -1, at.debt);
  f->touch->hits += towards > hop;
  find_pressure(f, o, &at);
  if (at.pressure >= 0 && (rise <= hop || !(dot(v, at.normal) > 0))) {
    f->touch->rests = 1 + (int32_t)(o - f->avi->solid->obstacle);
    f->touch->is_stuck = is_caught && holds(f, o, &at);
    set_normal_rate(&at, 0, v);
    if (f->touch->is_stuck) stop(f);
  } else if (dot(v, at.normal) < 0)
    set_normal_rate(&at, 0, v);
}

/* Fly for a length, or up to an obstacle, which is returned, or NULL. */
static const dvi_obstacle *fly(flight *f, double length)
{
  const dvi_obstacle *o = find_first(f, NULL, &length);
  add(f->node->u, length, f->node->v);
  f->flown += length;
  return o;
}

/* ---- rest ---- */

/* Slide by a length with the deceleration a along a direction, and stay on the surface. */
static void slide(flight *f, const dvi_obstacle *o, double length, double a,
                  const double *direction)
{
  double *v = f->node->v;
  meeting at;
  add(f->node->u, length, v);
  add(f->node->u, -0.5 * a * length * length, direction);
  add(v, -a * length, direction);
  f->flown += length;
  if (!find_normal(f, o, &at)) return;
  const double speed = sqrt(dot(v, v));
  add(f->node->u, -at.gap / at.square, at.free);
  set_normal_rate(&at, 0, v);
  const double less = sqrt(dot(v, v));
  for (int i = 0; i < DVI__SOLID_AXES && f->given == 0 && less > 0; i++) v[i] *= speed / less;
}

/* Slide by a length. Friction acts against the velocity w until there is none. */
static void rub(flight *f, const dvi_obstacle *o, const meeting *at, double length)
{
  double w[DVI__SOLID_AXES] = {0}, direction[DVI__SOLID_AXES];
  add(w, 1, f->node->v);
  add(w, 1, at->debt);
  double speed = along_surface(f, at, w, direction);
  if (!(speed > 0)) {
    speed = along_surface(f, at, at->pull, direction);
    for (int i = 0; i < DVI__SOLID_AXES && speed > 0; i++) direction[i] /= speed;
    slide(f, o, length, o->friction * at->pressure, direction);
    return;
  }
  for (int i = 0; i < DVI__SOLID_AXES; i++) direction[i] /= speed;
  const double a = o->friction * at->pressure, slowing = a - dot(at->pull, direction);
  const int stops = slowing * length > speed;
  slide(f, o, stops ? speed / slowing : length, a, direction);
  if (!stops) return;
  f->touch->is_stuck = holds(f, o, at);
  stop(f);
  if (!f->touch->is_stuck) (void)along_surface(f, at, at->debt, w), add(f->node->v, -1, w);
}

/* Take what the surface takes from a node that rests. Returns 0 if it leaves the surface. */
static int stay(const flight *f, const dvi_obstacle *o, meeting *at)
{
  double *v = f->node->v, along[DVI__SOLID_AXES];
  const int is_stuck = f->touch->is_stuck;
  if (!meet(f, o, 0, at) || !(at->pressure >= 0)) {
    f->touch->rests = f->touch->is_stuck = 0;
    if (at->square > 0) set_normal_rate(at, fmax(-dot(at->debt, at->normal), 0), v);
    return 0;
  }
  set_normal_rate(at, 0, v);
  if (!is_stuck) return 1;
  stop(f);
  if (holds(f, o, at)) return 1;
  f->touch->is_stuck = 0;
  (void)along_surface(f, at, at->debt, along);
  add(v, -1, along);
  return 1;
}

/* Go on from a rest, up to a length or another obstacle, which is returned, or NULL. */
static const dvi_obstacle *go_on(flight *f, const dvi_obstacle *o, const meeting *at, double length)
{
  const double nowhere[DVI__SOLID_AXES] = {0};
  const dvi_obstacle *other = find_first(f, o, &length);
  if (f->touch->is_stuck) return NULL;
  if (o->friction > 0)
    rub(f, o, at, length);
  else
    slide(f, o, length, 0, nowhere);
  return other;
}

void dvi__solid_note(dvi__solid_avi *avi, int64_t c, double t, const double *u, const double *f)
{
  const int n = avi->n, *corner = avi->cell[c].corner;
  if (!(avi->cell[c].kind & DVI__CELL_MEETS)) return;
  dvi__solid_push *push = avi->state.push + avi->cell[c].meeting;
  push->t = t;
  for (int k = 0; k < (n + 1) * n; k++) {
    push->u[k] = u[k];
    push->v[k] = avi->state.node[corner[k / n]].v[k % n];
    push->f[k] = f[k];
  }
}

/* The obstacle on which the node rests, or NULL. */
static const dvi_obstacle *seat_of(const dvi_elastic *e, const dvi__solid_touch *touch)
{
  return touch->rests > 0 ? e->obstacle + touch->rests - 1 : NULL;
}

void dvi__solid_bounce(const dvi__solid_avi *avi, int vertex, double t, double length,
                       dvi__solid_node *node, dvi__solid_touch *touch)
{
  flight f = {.avi = avi,
              .vertex = vertex,
              .given = avi->node_kind[vertex] & DVI__NODE_GIVEN,
              .decay = avi->node_kind[vertex] & DVI__NODE_DECAYS ? avi->decay[vertex] : 0,
              .t = t,
              .node = node,
              .touch = touch};
  for (int hit = 0; hit < HITS_MOST; hit++) {
    meeting at;
    const dvi_obstacle *seat = seat_of(avi->solid, touch), *o;
    if (seat != NULL && stay(&f, seat, &at))
      o = go_on(&f, seat, &at, length - f.flown);
    else
      o = fly(&f, length - f.flown);
    if (o == NULL) return;
    lift(&f, o);
    land(&f, o);
  }
  stop(&f);
}

void dvi__solid_rest(const dvi__solid_avi *avi, int vertex, const dvi__solid_node *node,
                     const dvi__solid_touch *touch, double *rate)
{
  const dvi_obstacle *seat = seat_of(avi->solid, touch);
  dvi__solid_node copy = *node;
  const flight f = {.avi = avi,
                    .vertex = vertex,
                    .given = avi->node_kind[vertex] & DVI__NODE_GIVEN,
                    .node = &copy};
  meeting at;
  if (seat == NULL || !find_normal(&f, seat, &at)) return;
  for (int i = 0; i < DVI__SOLID_AXES; i++) copy.v[i] = i < avi->n ? rate[i] : 0;
  set_normal_rate(&at, 0, copy.v);
  if (touch->is_stuck) stop(&f);
  for (int i = 0; i < avi->n; i++) rate[i] = copy.v[i];
}
