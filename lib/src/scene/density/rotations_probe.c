/* Probes of a field of rotations: functions of its entries and of omega(R) at a node. */
#include <math.h>
#include <string.h>

#include "scene/density/rotations.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

enum { ENTRIES = 9, NUMBERS = 3 };

static const double *nodes_of(const dvi_scene *scene, int64_t *count)
{
  const double *x;
  *count = dvi_rotations_nodes(dvi__rotations_made(scene), &x, NULL);
  return x;
}

static double distance(int axes, const double *a, const double *b)
{
  double most = 0;
  for (int d = 0; d < axes; d++) most = fmax(most, fabs(a[d] - b[d]));
  return most;
}

/* Find the node at a point. */
static bool find_node(dvi_scene *scene, const char *name, dvi__span span, const double *point,
                      int *node)
{
  const struct dvi__scene_density *s = scene->density;
  const int axes = s->jets.dimension;
  int64_t count;
  const double *x = nodes_of(scene, &count);
  *node = 0;
  for (int a = 1; a < count; a++)
    if (distance(axes, x + (ptrdiff_t)axes * a, point) <
        distance(axes, x + (ptrdiff_t)axes * *node, point))
      *node = a;
  const double *nearest = x + (ptrdiff_t)axes * *node;
  if (distance(axes, nearest, point) <= 1e-9 * (s->axis[0].to - s->axis[0].from)) return true;
  char place[128];
  size_t used = 0;
  for (int d = 0; d < axes && used < sizeof place; d++)
    used += (size_t)dvi__print(place + used, sizeof place - used, "%s%s = %.9g", d > 0 ? ", " : "",
                               s->jets.axis[d], nearest[d]);
  return dvi__scene_refuse(scene, span,
                           "rotations are at nodes, and '%s' is between them; the nearest one "
                           "that moves is at %s",
                           name, place);
}

bool dvi__rotations_check_probe(dvi_scene *scene, const dvi__local *function, const char *name,
                                dvi__span span, const double *point, int *node)
{
  for (int k = 0; k < function->variables; k++) {
    const dvi_jet *jet = function->variable + k;
    const int total = jet->order[0] + jet->order[1] + jet->order[2];
    if (total > 0 || jet->rate != (jet->component >= ENTRIES))
      return dvi__scene_refuse(scene, span,
                               "a probe of rotations has the entries of %s and omega(%s), and "
                               "'%s' has others",
                               scene->density->field->name, scene->density->field->name, name);
  }
  return find_node(scene, name, span, point, node);
}

/* Find the angular velocity of a node. */
static dvi_status find_turn(const dvi_scene *scene, double t, int node, const double *q,
                            const double *p, double *omega)
{
  double *v;
  const dvi_status status = dvi__density_velocity(scene, t, q, p, &v);
  if (status == DVI_OK) memcpy(omega, v + (ptrdiff_t)NUMBERS * node, NUMBERS * sizeof *omega);
  dvi__heap_free(v);
  return status;
}

int dvi__rotations_value(const dvi_scene *scene, const dvi__local *function, double t, int node,
                         const double *q, const double *p, double *value)
{
  double z[ENTRIES + NUMBERS], omega[NUMBERS];
  bool has_turn = false;
  int64_t count;
  const double *x = nodes_of(scene, &count) + (ptrdiff_t)scene->density->jets.dimension * node;
  for (int k = 0; k < function->variables; k++)
    has_turn = has_turn || function->variable[k].component >= ENTRIES;
  if (has_turn) {
    const dvi_status status = find_turn(scene, t, node, q, p, omega);
    if (status != DVI_OK) return (int)status;
  }
  for (int k = 0; k < function->variables; k++) {
    const int i = function->variable[k].component;
    z[k] = i < ENTRIES ? q[(ptrdiff_t)ENTRIES * node + i] : omega[i - ENTRIES];
  }
  *value = 0;
  return function->term == NULL
             ? 0
             : dvi__local_density(1, t, x, z, value, NULL, NULL, (void *)function);
}
