/* The flight of a node among rigid obstacles.
 *
 * Between two events a node flies straight, so that it meets a plane or a ball at a time which is
 * the root of a polynomial of degree 1 or 2. There its velocity v changes along the outer normal N
 * from -v_N to e v_N, and friction takes at most mu (1 + e) v_N from its velocity along the surface
 * (Fetecau, Marsden, Ortiz and West 2003, with Coulomb's friction). Components that are given stay
 * as they are: N is replaced by its free part.
 *
 * A node that is on the surface and was pushed into it by its cells did not fly there. The surface
 * answers the push, without a bounce, so that nothing sinks, trembles or gains energy. */
#include <math.h>

#include "field/elastic_avi/engine.h"

/* Hits of one flight. More are a rest in a wedge or a glide along the inside of a ball. */
enum { HITS_MOST = 32 };

typedef struct flight {
  const dvi_elastic *solid;
  int vertex, given; /* bits of components */
  dvi__solid_node *node;
} flight;

static double dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Set d to the place of the node, seen from the obstacle's point. */
static void place_of(const flight *f, const dvi_obstacle *o, double d[DVI__SOLID_AXES])
{
  const int n = f->solid->n;
  for (int i = 0; i < DVI__SOLID_AXES; i++)
    d[i] = i < n ? f->solid->point[(int64_t)f->vertex * n + i] + f->node->u[i] - o->point[i] : 0;
}

/* Give the free distance, below 0 inside of the obstacle, and its gradient, the outer normal. */
static double gap_of(const flight *f, const dvi_obstacle *o, double normal[DVI__SOLID_AXES])
{
  double d[DVI__SOLID_AXES];
  const int n = f->solid->n;
  place_of(f, o, d);
  for (int i = 0; i < DVI__SOLID_AXES; i++) normal[i] = i < n ? o->normal[i] : 0;
  if (o->kind == DVI_OBSTACLE_PLANE) return dot(d, normal);
  const double r = sqrt(dot(d, d)), sign = o->kind == DVI_OBSTACLE_BALL ? 1 : -1;
  for (int i = 0; i < DVI__SOLID_AXES; i++) normal[i] = r > 0 ? sign * d[i] / r : 0;
  return sign * (r - o->radius);
}

/* Give the path length, in units of v, up to the obstacle, or infinity. */
static double length_to(const flight *f, const dvi_obstacle *o)
{
  double normal[DVI__SOLID_AXES], d[DVI__SOLID_AXES];
  const double *v = f->node->v, gap = gap_of(f, o, normal), approach = -dot(v, normal);
  if (gap <= 0) {
    if (approach > 0) return 0;
    if (o->kind != DVI_OBSTACLE_HOLLOW) return INFINITY;
  }
  if (o->kind == DVI_OBSTACLE_PLANE) return approach > 0 ? gap / approach : (double)INFINITY;
  place_of(f, o, d);
  const double a = dot(v, v), b = dot(d, v), c = dot(d, d) - o->radius * o->radius,
               square = b * b - a * c;
  if (!(a > 0) || !(square >= 0)) return INFINITY;
  if (o->kind == DVI_OBSTACLE_BALL)
    return b < 0 ? fmax(c / (sqrt(square) - b), 0) : (double)INFINITY;
  return fmax(b > 0 ? -c / (b + sqrt(square)) : (sqrt(square) - b) / a, 0);
}

static const dvi_obstacle *find_first(const flight *f, double *length)
{
  const dvi_obstacle *first = NULL;
  for (int i = 0; i < f->solid->obstacles; i++) {
    const double to = length_to(f, f->solid->obstacle + i);
    if (!(to <= *length)) continue;
    *length = to;
    first = f->solid->obstacle + i;
  }
  return first;
}

/* Take the components that are given out of the normal. Returns its square then. */
static double free_part(const flight *f, double normal[DVI__SOLID_AXES])
{
  for (int i = 0; i < DVI__SOLID_AXES; i++)
    if (f->given & 1 << i) normal[i] = 0;
  return dot(normal, normal);
}

/* Reflect with a restitution. What friction takes is at most all of the velocity along the surface,
 * in free components. */
static void reflect(const flight *f, const dvi_obstacle *o, double restitution)
{
  double normal[DVI__SOLID_AXES], along[DVI__SOLID_AXES], *v = f->node->v;
  (void)gap_of(f, o, normal);
  const double towards = -dot(v, normal), square = free_part(f, normal);
  if (!(square > 1e-12)) return;
  const double impulse = (1 + restitution) * towards / square;
  for (int i = 0; i < DVI__SOLID_AXES; i++) v[i] += impulse * normal[i];
  if (!(o->friction > 0)) return;
  const double through = dot(v, normal) / square;
  for (int i = 0; i < DVI__SOLID_AXES; i++)
    along[i] = f->given & 1 << i ? 0 : v[i] - through * normal[i];
  const double speed = sqrt(dot(along, along)),
               loss = fmin(o->friction * (1 + restitution) * towards, speed);
  for (int i = 0; i < DVI__SOLID_AXES && speed > 0; i++) v[i] -= loss / speed * along[i];
}

static void move(const flight *f, double length)
{
  for (int i = 0; i < DVI__SOLID_AXES; i++) f->node->u[i] += f->node->v[i] * length;
}

/* Move a node that is inside of an obstacle, by a rounding or so, to the surface. */
static void lift(const flight *f, const dvi_obstacle *o)
{
  double normal[DVI__SOLID_AXES];
  const double gap = gap_of(f, o, normal), square = free_part(f, normal);
  if (!(gap < 0) || !(square > 1e-12)) return;
  for (int i = 0; i < DVI__SOLID_AXES; i++) f->node->u[i] -= gap * normal[i] / square;
}

/* Glide along the inside of a ball, on a great circle, at the speed along the surface. */
static void glide(const flight *f, const dvi_obstacle *o, double length)
{
  double normal[DVI__SOLID_AXES], *v = f->node->v;
  (void)gap_of(f, o, normal);
  const double through = dot(v, normal);
  for (int i = 0; i < DVI__SOLID_AXES; i++) v[i] -= through * normal[i];
  const double speed = sqrt(dot(v, v)), angle = speed * length / o->radius, s = sin(angle),
               less = 2 * sin(0.5 * angle) * sin(0.5 * angle); /* 1 - cos(angle) */
  for (int i = 0; i < DVI__SOLID_AXES && speed > 0; i++) {
    const double direction = v[i] / speed;
    f->node->u[i] += o->radius * (s * direction + less * normal[i]);
    v[i] = speed * ((1 - less) * direction + s * normal[i]);
  }
}

/* A node that hits again and again rests in a wedge, or glides. */
static void settle(const flight *f, const dvi_obstacle *o, double length)
{
  if (o->kind == DVI_OBSTACLE_HOLLOW && f->given == 0) {
    glide(f, o, length);
    return;
  }
  for (int i = 0; i < DVI__SOLID_AXES; i++)
    if (!(f->given & 1 << i)) f->node->v[i] = 0;
}

void dvi__solid_bounce(const dvi__solid_avi *avi, int vertex, double length, dvi__solid_node *node,
                       int64_t *hits)
{
  const flight f = {.solid = avi->solid,
                    .vertex = vertex,
                    .given = avi->node_kind[vertex] & DVI__NODE_GIVEN,
                    .node = node};
  double flown = 0;
  for (int hit = 0;; hit++) {
    double to = length;
    const dvi_obstacle *o = find_first(&f, &to);
    if (o == NULL) break;
    if (hit == HITS_MOST) {
      settle(&f, o, length);
      return;
    }
    move(&f, to);
    lift(&f, o);
    length -= to;
    flown += to;
    reflect(&f, o, flown > 0 ? o->restitution : 0);
    if (hits != NULL && flown > 0) ++*hits;
  }
  move(&f, length);
}
