/* Nodes that are faster than waves.
 *
 * Along the path of a node u_t = u' - s x', with the derivative s of u along x'. With the direction
 * n of x' the density has by s the second derivative
 *
 *     a = |x'|^2 l_tt - 2 |x'| l_ts + l_ss,
 *
 * which is below 0 where waves are faster than the node. Where it is not, long waves go on as they
 * do, held by the products u' s. The shortest ones of straight cells, whose values alternate, have
 * no such product, and grow as exp(t sqrt(12 a/l_tt)/h). */
#include <dvi/scene.h>
#include <math.h>

#include "scene/density/moving.h"
#include "text/heap.h"

/* Part of the other terms by which a may be off zero. */
static const double near_zero = 1e-9;

/* The start at the nodes, each array axis by axis or component by component, and the second
 * derivatives of the density there. */
typedef struct start {
  int nodes, axes;
  double *x, *velocity, *unread, *u, *u_x, *u_t, *z, *l_zz;
} start;

/* Find where the nodes are, and their velocities, those of the state or of the path. */
static int take_nodes(const dvi_scene *scene, start *s)
{
  const dvi__scene_moving *m = scene->density->moving;
  int nodes;
  const int *unknown = dvi_moving_unknowns(m->made, &nodes);
  if (m->terms.path != NULL)
    return m->terms.path(s->nodes, 0, dvi_moving_nodes(m->made, NULL), s->x, s->velocity,
                         m->terms.user);
  const int numbers = s->axes + scene->density->jets.components;
  for (int k = 0; k < s->axes * nodes; k++) {
    const int at = unknown[(ptrdiff_t)(k % nodes) * numbers + k / nodes];
    s->velocity[k / nodes * s->nodes + k % nodes] = at >= 0 ? scene->v[at] : 0;
  }
  return (int)dvi_moving_lift(m->made, 0, scene->q, s->x, NULL);
}

/* Return the values of a variable of the density. */
static const double *values_of(const start *s, const dvi_jet *jet)
{
  const ptrdiff_t c = jet->component;
  if (jet->rate) return s->u_t + c * s->nodes;
  if (jet->order[0] + jet->order[1] == 0) return s->u + c * s->nodes;
  return s->u_x + (c * s->axes + (jet->order[1] > 0)) * s->nodes;
}

static int evaluate(const dvi_scene *scene, start *s)
{
  const dvi__scene_moving *m = scene->density->moving;
  const dvi__local *whole = m->whole;
  int failed = take_nodes(scene, s);
  if (failed == 0)
    failed = dvi__moving_wave(s->nodes, s->x, s->u, s->u_x, s->u_t, s->unread, (void *)m);
  for (int j = 0; j < whole->variables && failed == 0; j++) {
    const double *of = values_of(s, whole->variable + j);
    for (int k = 0; k < s->nodes; k++) s->z[(ptrdiff_t)j * s->nodes + k] = of[k];
  }
  return failed != 0
             ? failed
             : dvi__local_density(s->nodes, 0, s->x, s->z, NULL, NULL, s->l_zz, (void *)whole);
}

/* Return the coefficient of a variable in the derivative by s along n, as a node with the velocity
 * |x'| sees it. */
static double share(const dvi_jet *jet, int component, double speed, const double *n)
{
  if (jet->component != component) return 0;
  if (jet->rate) return -speed;
  return jet->order[0] > 0 ? n[0] : jet->order[1] > 0 ? n[1] : 0;
}

/* Tell if a node is at least as fast as waves of a component. */
static bool is_fast(const start *s, const dvi__local *whole, int node, int component)
{
  double n[DVI_MOVING_AXES_MAX] = {0}, speed = 0, a = 0, size = 0;
  for (int i = 0; i < s->axes; i++) n[i] = s->velocity[i * s->nodes + node];
  for (int i = 0; i < s->axes; i++) speed = hypot(speed, n[i]);
  for (int i = 0; i < s->axes && speed > 0; i++) n[i] /= speed;
  for (int e = 0; e < whole->pairs && speed > 0; e++) {
    const int j = whole->pair[e][0], k = whole->pair[e][1];
    const double term = s->l_zz[(ptrdiff_t)e * s->nodes + node] *
                        share(whole->variable + j, component, speed, n) *
                        share(whole->variable + k, component, speed, n) * (j == k ? 1 : 2);
    a += term;
    size += fabs(term);
  }
  return a >= -near_zero * size && size > 0;
}

/* Count the nodes that are too fast, and give the first one. */
static int count_fast(const start *s, const struct dvi__scene_density *of, int *first)
{
  int count = 0;
  for (int node = 0; node < s->nodes; node++) {
    bool fast = false;
    for (int c = 0; c < of->jets.components; c++)
      fast = fast || is_fast(s, of->moving->whole, node, c);
    if (fast && count++ == 0) *first = node;
  }
  return count;
}

int dvi__moving_fast_nodes(const dvi_scene *scene, double *x)
{
  const struct dvi__scene_density *of = scene->density;
  const dvi__local *whole = of->moving->whole;
  start s = {.axes = of->jets.dimension};
  int cells, first = 0, count = 0;
  (void)dvi_moving_nodes(of->moving->made, &cells);
  (void)dvi_moving_unknowns(of->moving->made, &s.nodes);
  if (s.axes == 1) s.nodes = cells + 1;
  const size_t nodes = (size_t)s.nodes, places = nodes * (size_t)s.axes,
               values = nodes * (size_t)of->jets.components,
               all = nodes * (size_t)(whole->variables + whole->pairs);
  double *room = dvi__heap_take(3 * places + (2 + (size_t)s.axes) * values + all, sizeof *room);
  if (room == NULL) return 0;
  s.x = room;
  s.velocity = s.x + places;
  s.unread = s.velocity + places;
  s.u = s.unread + places;
  s.u_t = s.u + values;
  s.u_x = s.u_t + values;
  s.z = s.u_x + values * (size_t)s.axes;
  s.l_zz = s.z + nodes * (size_t)whole->variables;
  if (evaluate(scene, &s) == 0) count = count_fast(&s, of, &first);
  for (int i = 0; i < s.axes && count > 0; i++) x[i] = s.x[i * s.nodes + first];
  dvi__heap_free(room);
  return count;
}
