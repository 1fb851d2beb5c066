/* The start where values are fixed. A field that jumps there has an energy that no run should have:
 * the jump is a wave, which is the steeper the finer the cells are. */
#include <math.h>

#include "scene/density/moving.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

/* Part of a component's size by which its start may be off a fixed value. Tails of waves and kinks
 * that a domain cuts off are below. The energy of such a jump is that of the square of it, divided
 * by the length of a cell. */
static const double same_value = 1e-3;

/* The values at the start: as it is given, and as it is with those that are fixed. */
typedef struct start_values {
  const double *given, *fixed; /* [components*functions] */
} start_values;

static bool refuse(dvi_scene *scene, int component, const char *part, double given, double fixed)
{
  const dvi__tree *initial = dvi__tree_find(scene->tree, "initial"),
                  *section = initial != NULL ? initial : dvi__tree_find(scene->tree, "boundary");
  return dvi__scene_refuse(scene, section->span,
                           "the start of %s is %.6g at '%s', where %.6g is fixed at t = 0; they "
                           "must agree",
                           scene->density->component[component], given, part, fixed);
}

/* Check the functions of a part. Of several conditions the first one counts, as in `fixed`. */
static bool check_part(dvi_scene *scene, const dvi_density_condition *condition,
                       const start_values *start)
{
  const struct dvi__scene_density *s = scene->density;
  const int64_t first = condition->component * s->functions;
  double size = 0;
  int64_t count;
  const int *function = dvi_space_boundary(s->space, condition->part, &count);
  for (int64_t i = first; i < first + s->functions; i++)
    size = fmax(size, fmax(fabs(start->given[i]), fabs(start->fixed[i])));
  for (int64_t i = 0; function != NULL && i < count; i++) {
    const double given = start->given[first + function[i]],
                 fixed = start->fixed[first + function[i]];
    if (fabs(given - fixed) > same_value * size)
      return refuse(scene, condition->component, condition->part, given, fixed);
  }
  return true;
}

/* Without a start, fixed values that rest may be those of a static state. */
static bool is_run(const struct dvi__scene_density *s)
{
  bool moves = false;
  for (int i = 0; i < s->conditions; i++)
    moves = moves || (s->condition[i].kind == DVI_FIXED && s->condition[i].rate != NULL);
  return !s->is_static && (s->start != NULL || moves);
}

bool dvi__density_check_ends(dvi_scene *scene, const double *U)
{
  const struct dvi__scene_density *s = scene->density;
  bool good = true;
  if (!is_run(s)) return true;
  double *fixed = dvi__heap_take((size_t)(s->jets.components * s->functions), sizeof *fixed);
  if (fixed == NULL) return dvi__scene_no_memory(scene);
  const dvi_status status = dvi_density_lift(s->density, 0, scene->q, fixed);
  if (status != DVI_OK)
    good = dvi__density_complain(scene, dvi__tree_find(scene->tree, "boundary"), status);
  for (int i = 0; i < s->conditions && good; i++)
    if (s->condition[i].kind == DVI_FIXED)
      good = check_part(scene, s->condition + i, &(start_values){U, fixed});
  dvi__heap_free(fixed);
  return good;
}

/* ---- meshes that move ---- */

static bool refuse_node(dvi_scene *scene, int component, double x, double given, double fixed)
{
  return dvi__scene_refuse(scene, dvi__tree_find(scene->tree, "initial")->span,
                           "the start of %s is %.6g at %s = %.6g, where %.6g is fixed at t = 0; "
                           "they must agree",
                           scene->density->component[component], given,
                           scene->density->jets.axis[0], x, fixed);
}

/* Compare a component [count] at the first `nodes` of all nodes, where it is no unknown. */
static bool check_component(dvi_scene *scene, int c, int nodes, int count, const double *x,
                            const double *fixed, double *given)
{
  const struct dvi__scene_density *s = scene->density;
  const int numbers = s->jets.dimension + s->jets.components;
  const int *unknown = dvi_moving_unknowns(s->moving->made, NULL);
  double size = 0;
  if (dvi__local_value(s->start[c], count, 0, x, given) != 0)
    return dvi__density_complain(scene, dvi__tree_find(scene->tree, "initial"),
                                 DVI_CALLBACK_FAILED);
  for (int i = 0; i < count; i++) size = fmax(size, fmax(fabs(given[i]), fabs(fixed[i])));
  for (int i = 0; i < nodes; i++)
    if (unknown[(ptrdiff_t)i * numbers + s->jets.dimension + c] < 0 &&
        fabs(given[i] - fixed[i]) > same_value * size)
      return refuse_node(scene, c, x[i], given[i], fixed[i]);
  return true;
}

bool dvi__moving_check_ends(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  const int components = s->jets.components;
  int nodes, cells;
  bool good = true;
  if (s->is_static || s->start == NULL || s->conditions == 0) return true;
  (void)dvi_moving_unknowns(s->moving->made, &nodes);
  (void)dvi_moving_nodes(s->moving->made, &cells);
  const int count = s->jets.dimension == 1 ? cells + 1 : nodes;
  double *x = dvi__heap_take((size_t)(s->jets.dimension + components + 1) * (size_t)count,
                             sizeof *x);
  if (x == NULL) return dvi__scene_no_memory(scene);
  double *const u = x + s->jets.dimension * count, *const given = u + components * count;
  const dvi_status status = dvi_moving_lift(s->moving->made, 0, scene->q, x, u);
  if (status != DVI_OK) good = dvi__density_complain(scene, s->moving->section, status);
  for (int c = 0; c < components && good; c++)
    good = check_component(scene, c, nodes, count, x, u + c * count, given);
  dvi__heap_free(x);
  return good;
}
