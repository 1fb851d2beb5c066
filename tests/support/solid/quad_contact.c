#include "support/solid/quad_contact.h"

#include <check.h>
#include <stdlib.h>
#include <string.h>

static quad dot(int n, const quad *a, const quad *b)
{
  quad sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

quad quad_gap(const quad_solid *s, const dvi_obstacle *o, int node, const quad *u, quad *normal)
{
  const int n = s->n;
  quad d[3] = {0};
  for (int i = 0; i < n; i++) {
    d[i] = s->point[node * n + i] + u[node * n + i] - o->point[i];
    normal[i] = o->normal[i];
  }
  if (o->kind == DVI_OBSTACLE_PLANE) {
    const quad length = quad_sqrt(dot(n, normal, normal));
    for (int i = 0; i < n; i++) normal[i] /= length;
    return dot(n, d, normal);
  }
  const int sign = o->kind == DVI_OBSTACLE_BALL ? 1 : -1;
  const quad r = quad_sqrt(dot(n, d, d));
  for (int i = 0; i < n; i++) normal[i] = sign * d[i] / r;
  return sign * (r - o->radius);
}

static quad rate_of_gap(const quad_solid *s, const dvi_obstacle *o, int node, const quad *u,
                        const quad *v)
{
  quad normal[3] = {0};
  (void)quad_gap(s, o, node, u, normal);
  return dot(s->n, normal, v + node * s->n);
}

/* A state at a time, and room for another one. */
typedef struct path {
  const quad_solid *s;
  quad t, *u, *v, *later_u, *later_v;
} path;

static void look_ahead(const path *p, quad span)
{
  const size_t bytes = (size_t)p->s->size * sizeof *p->u;
  memcpy(p->later_u, p->u, bytes);
  memcpy(p->later_v, p->v, bytes);
  (void)quad_solid_advance(p->s, p->t, p->t + span, p->later_u, p->later_v);
}

/* Give the time after which a node, which is inside at the end of the span, meets the obstacle. */
static quad time_to(const path *p, const dvi_obstacle *o, int node, quad span)
{
  quad at = span, normal[3];
  for (int i = 0; i < 40; i++) {
    look_ahead(p, at);
    const quad change = quad_gap(p->s, o, node, p->later_u, normal) /
                        rate_of_gap(p->s, o, node, p->later_u, p->later_v);
    at -= change;
    if (at < 0) at = 0;
    if (quad_abs(change) < 1e-24) return at;
  }
  ck_abort_msg("the judge finds no time of the hit of node %d after t = %g", node, (double)p->t);
  return at;
}

static void reflect(const path *p, const dvi_obstacle *o, int node)
{
  const int n = p->s->n;
  quad normal[3] = {0}, along[3] = {0}, *v = p->v + node * n;
  (void)quad_gap(p->s, o, node, p->u, normal);
  const quad towards = -dot(n, v, normal);
  for (int i = 0; i < n; i++) {
    along[i] = v[i] + towards * normal[i];
    v[i] += (1 + (quad)o->restitution) * towards * normal[i];
  }
  const quad speed = quad_sqrt(dot(n, along, along)),
             most = o->friction * (1 + (quad)o->restitution) * towards,
             loss = most < speed ? most : speed;
  for (int i = 0; i < n && speed > 0; i++) v[i] -= loss * along[i] / speed;
}

/* Find the first hit in a span. Returns the node, or -1. */
static int first_hit(const path *p, const dvi_obstacle *obstacle, int obstacles, quad *span,
                     int *which)
{
  int first = -1;
  look_ahead(p, *span);
  for (int o = 0; o < obstacles; o++)
    for (int node = 0; node < p->s->vertices; node++) {
      quad normal[3];
      if (quad_gap(p->s, obstacle + o, node, p->later_u, normal) >= 0) continue;
      *span = time_to(p, obstacle + o, node, *span);
      look_ahead(p, *span);
      first = node;
      *which = o;
    }
  return first;
}

static void move_to(path *p, quad span)
{
  look_ahead(p, span);
  memcpy(p->u, p->later_u, (size_t)p->s->size * sizeof *p->u);
  memcpy(p->v, p->later_v, (size_t)p->s->size * sizeof *p->v);
  p->t += span;
}

void quad_solid_advance_among(const quad_solid *s, const dvi_obstacle *obstacle, int obstacles,
                              quad t, int pieces, quad *u, quad *v, quad_hits *hits)
{
  const size_t size = (size_t)s->size;
  path p = {s, 0, u, v, calloc(size, sizeof *u), calloc(size, sizeof *v)};
  if (hits) hits->count = 0;
  for (int piece = 1; piece <= pieces;) {
    quad span = t * piece / pieces - p.t;
    int which = 0;
    const int node = first_hit(&p, obstacle, obstacles, &span, &which);
    move_to(&p, span);
    if (node < 0) {
      piece++;
      continue;
    }
    reflect(&p, obstacle + which, node);
    if (!hits) continue;
    ck_assert_int_lt(hits->count, QUAD_HITS_MOST);
    hits->node[hits->count] = node;
    hits->t[hits->count++] = p.t;
  }
  free(p.later_u), free(p.later_v);
}
