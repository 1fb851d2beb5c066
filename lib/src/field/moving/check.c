/* What is wrong with the terms of a field. */
#include <math.h>

#include "core/status.h"
#include "field/moving/moving.h"
#include "field/space/simplex_rule.h"

enum { CELLS_MAX = 10000000 };

int dvi__moving_components(const dvi_moving_terms *t)
{
  return t->components != 0 ? t->components : 1;
}

static dvi_status check_axis(const dvi_moving_terms *t)
{
  const dvi_axis *axis = &t->axis;
  if (!(isfinite(axis->from) && isfinite(axis->to) && axis->from < axis->to))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: the axis reaches from %g to %g, but it must ascend and be finite",
                     axis->from, axis->to);
  if (axis->kind != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: the axis has the kind '%.40s', but cells that move are linear: leave "
                     "the kind out",
                     axis->kind);
  if (axis->node == NULL) return DVI_OK;
  if (t->monitor != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: both nodes and a monitor are given: leave one of them out");
  for (int k = 0; k + 1 < axis->nodes; k++)
    if (!(axis->node[k] < axis->node[k + 1]))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "moving: cell %d of the axis reaches from %g to %g: sort the nodes", k,
                       axis->node[k], axis->node[k + 1]);
  if (axis->nodes > 2 && axis->node[0] == axis->from && axis->node[axis->nodes - 1] == axis->to)
    return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "moving: the axis has %d nodes, but at least 3 are needed, the first at %g and "
                   "the last at %g",
                   axis->nodes, axis->from, axis->to);
}

static dvi_status check_cells(const dvi_moving_terms *t)
{
  const int cells = t->axis.node != NULL ? t->axis.nodes - 1 : t->cells;
  if (t->axis.node != NULL && t->cells != 0 && t->cells != cells)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: %d cells are asked, but the axis has %d", t->cells,
                     cells);
  if (cells < 2 || cells > CELLS_MAX)
    return dvi__fail(DVI_BAD_SIZE, "moving: %d cells asked, 2 to %d possible", cells, CELLS_MAX);
  return DVI_OK;
}

/* Refuse what an axis has and a mesh has not. */
static dvi_status check_plane(const dvi_moving_terms *t)
{
  const char *extra = t->axis.from != 0 || t->axis.to != 0 || t->cells != 0 ? "an axis"
                      : t->mean != NULL                                     ? "a mean over cells"
                      : t->monitor != NULL                                  ? "a monitor"
                      : t->left.kind == DVI_FIXED || t->right.kind == DVI_FIXED ? "ends"
                      : t->viscosity != 0                                       ? "viscosity"
                      : t->dispersion != 0                                      ? "dispersion"
                      : t->motion == DVI_MOVING_EQUAL                           ? "equal arcs"
                                                                                : NULL;
  if (extra != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: a mesh is given, and %s, which fields of one dimension alone have: "
                     "leave one of them out",
                     extra);
  if (t->conditions < 0 || (t->conditions > 0 && t->condition == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: %d conditions are not given", t->conditions);
  if (t->points != 0 && dvi__simplex_rule_of(2, 0, t->points) == NULL)
    return dvi__fail(DVI_BAD_SIZE, "moving: %d points a triangle asked, 1, 3 or 6 possible",
                     t->points);
  return DVI_OK;
}

static dvi_status check_sizes(const dvi_moving_terms *t)
{
  if (t->mesh == NULL && (t->conditions != 0 || t->slide))
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "moving: conditions and nodes that slide need a mesh: set the ends of an axis");
  if (t->components < 0 || t->components > DVI_MOVING_COMPONENTS_MAX)
    return dvi__fail(DVI_BAD_SIZE, "moving: %d components asked, 1 to %d possible", t->components,
                     DVI_MOVING_COMPONENTS_MAX);
  if (t->points < 0 || t->points > DVI_MOVING_POINTS_MAX)
    return dvi__fail(DVI_BAD_SIZE, "moving: %d points a cell asked, 1 to %d possible", t->points,
                     DVI_MOVING_POINTS_MAX);
  return DVI_OK;
}

static dvi_status check_variable(const dvi_moving_terms *t, int j)
{
  const dvi_jet *z = &t->part->variable[j];
  if (z->component < 0 || z->component >= dvi__moving_components(t))
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: variable %d is of component %d, but there are %d",
                     j, z->component, dvi__moving_components(t));
  const int order = z->order[0] + z->order[1] + z->order[2], plane = t->mesh != NULL;
  if (z->order[0] < 0 || z->order[1] < 0 || order + (z->rate != 0) > 1 || z->order[2] != 0 ||
      (!plane && z->order[1] != 0))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: variable %d of the density has order %d%s, but a linear field has u, "
                     "u_t%s and u_%c alone%s",
                     j, order, z->rate ? " of the rate" : "", plane ? ", u_x" : "",
                     plane ? 'y' : 'x', !plane && z->order[0] == 2 ? ": use dispersion" : "");
  for (int i = 0; i < j; i++) {
    const dvi_jet *other = &t->part->variable[i];
    if (other->component == z->component && !other->rate == !z->rate &&
        other->order[0] == z->order[0] && other->order[1] == z->order[1])
      return dvi__fail(DVI_BAD_ARGUMENT, "moving: variables %d and %d of the density are the same",
                       i, j);
  }
  return DVI_OK;
}

static dvi_status check_density(const dvi_moving_terms *t)
{
  const dvi_density_part *p = t->part;
  if (p == NULL || p->density == NULL || (p->variables > 0 && p->variable == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a density with its variables is needed");
  const int variables = (t->mesh != NULL ? 4 : 3) * dvi__moving_components(t);
  if (p->variables < 1 || p->variables > variables)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: the density has %d variables, 1 to %d possible",
                     p->variables, variables);
  for (int j = 0; j < p->variables; j++) DVI_TRY(check_variable(t, j));
  const int most = p->variables * (p->variables + 1) / 2;
  if (p->pair != NULL && (p->pairs < 0 || p->pairs > most))
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: the density has %d pairs, 0 to %d possible",
                     p->pairs, most);
  for (int i = 0; p->pair != NULL && i < p->pairs; i++)
    if (p->pair[i][1] < 0 || p->pair[i][0] < p->pair[i][1] || p->pair[i][0] >= p->variables)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "moving: pair %d of the density is (%d,%d), but variables are 0 to %d, the "
                       "larger one first",
                       i, p->pair[i][0], p->pair[i][1], p->variables - 1);
  if (t->mean != NULL && t->mean->mean == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: the mean has no callback");
  if (t->motion != DVI_MOVING_PRESCRIBED && !t->translations && t->space_derivative == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: free nodes need the derivative of the density by x: give "
                     "space_derivative, or set translations if l does not depend on x");
  return DVI_OK;
}

static dvi_status check_number(const char *name, double value)
{
  if (value >= 0 && isfinite(value)) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "moving: %s is %g, but it must be at least 0 and finite", name,
                   value);
}

static dvi_status check_values(const dvi_moving_terms *t, const char *name, int axes,
                               const double *value)
{
  const int components = dvi__moving_components(t);
  for (int k = 0; value != NULL && k < axes * components; k++)
    if (!isfinite(value[k]))
      return dvi__fail(DVI_BAD_ARGUMENT, "moving: %s of component %d is %g", name, k % components,
                       value[k]);
  return DVI_OK;
}

static dvi_status check_ends(const dvi_moving_terms *t)
{
  if (t->mesh != NULL) return check_values(t, "the jump", DVI_MOVING_AXES_MAX, t->jump);
  const int fixed = t->left.kind == DVI_FIXED || t->right.kind == DVI_FIXED;
  if (t->axis.periodic && fixed)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a periodic axis has no ends at which u is fixed");
  if (!t->axis.periodic && t->jump != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a jump needs a periodic axis");
  DVI_TRY(check_values(t, "the left end's value", 1, t->left.value));
  DVI_TRY(check_values(t, "the right end's value", 1, t->right.value));
  return check_values(t, "the jump", 1, t->jump);
}

static dvi_status check_motion(const dvi_moving_terms *t)
{
  const int cells = t->axis.node != NULL ? t->axis.nodes - 1 : t->cells;
  if (t->motion < DVI_MOVING_FREE || t->motion > DVI_MOVING_EQUAL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: there is no motion %d", (int)t->motion);
  if (t->motion != DVI_MOVING_PRESCRIBED && t->path != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: free nodes have no path: choose DVI_MOVING_PRESCRIBED");
  if (t->motion != DVI_MOVING_EQUAL && t->stretch != 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a stretch needs DVI_MOVING_EQUAL");
  if (t->motion == DVI_MOVING_EQUAL && cells < 3)
    return dvi__fail(DVI_BAD_SIZE, "moving: arcs of one length need at least 3 cells, not %d",
                     cells);
  DVI_TRY(check_number("the stretch", t->stretch));
  if (t->motion == DVI_MOVING_PRESCRIBED && (t->mu != 0 || t->kappa != 0))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: mu and kappa act on free nodes, but the nodes are prescribed: leave "
                     "both out");
  if (t->path_step != 0 && t->path == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a path_step needs a path");
  DVI_TRY(check_number("path_step", t->path_step));
  DVI_TRY(check_number("mu", t->mu));
  DVI_TRY(check_number("kappa", t->kappa));
  DVI_TRY(check_number("the viscosity", t->viscosity));
  return check_number("the dispersion", t->dispersion);
}

dvi_status dvi__moving_check_terms(const dvi_moving_terms *t)
{
  if (t->size != sizeof *t)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: set terms.size to sizeof(dvi_moving_terms)");
  if (t->mesh != NULL) DVI_TRY(check_plane(t));
  if (t->mesh == NULL) DVI_TRY(check_axis(t));
  if (t->mesh == NULL) DVI_TRY(check_cells(t));
  DVI_TRY(check_sizes(t));
  DVI_TRY(check_motion(t));
  DVI_TRY(check_density(t));
  return check_ends(t);
}
