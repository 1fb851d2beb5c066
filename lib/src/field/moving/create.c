#include <dvi/quadrature.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

enum { CELLS_MAX = 10000000, POINTS = 3 };

/* ---- checks ---- */

static int terms_components(const dvi_moving_terms *t)
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

static dvi_status check_sizes(const dvi_moving_terms *t)
{
  const int cells = t->axis.node != NULL ? t->axis.nodes - 1 : t->cells;
  if (t->axis.node != NULL && t->cells != 0 && t->cells != cells)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: %d cells are asked, but the axis has %d", t->cells,
                     cells);
  if (cells < 2 || cells > CELLS_MAX)
    return dvi__fail(DVI_BAD_SIZE, "moving: %d cells asked, 2 to %d possible", cells, CELLS_MAX);
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
  if (z->component < 0 || z->component >= terms_components(t))
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: variable %d is of component %d, but there are %d",
                     j, z->component, terms_components(t));
  if (z->order[0] < 0 || z->order[0] + (z->rate != 0) > 1 || z->order[1] != 0 || z->order[2] != 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: variable %d of the density has order %d%s, but a linear field has u, "
                     "u_t and u_x alone%s",
                     j, z->order[0], z->rate ? " of the rate" : "",
                     z->order[0] == 2 ? ": use dispersion" : "");
  for (int i = 0; i < j; i++) {
    const dvi_jet *other = &t->part->variable[i];
    if (other->component == z->component && !other->rate == !z->rate &&
        other->order[0] == z->order[0])
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
  if (p->variables < 1 || p->variables > 3 * terms_components(t))
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: the density has %d variables, 1 to %d possible",
                     p->variables, 3 * terms_components(t));
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

static dvi_status check_values(const dvi_moving_terms *t, const char *name, const double *value)
{
  for (int c = 0; value != NULL && c < terms_components(t); c++)
    if (!isfinite(value[c]))
      return dvi__fail(DVI_BAD_ARGUMENT, "moving: %s of component %d is %g", name, c, value[c]);
  return DVI_OK;
}

static dvi_status check_ends(const dvi_moving_terms *t)
{
  const int fixed = t->left.kind == DVI_FIXED || t->right.kind == DVI_FIXED;
  if (t->axis.periodic && fixed)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a periodic axis has no ends at which u is fixed");
  if (!t->axis.periodic && t->jump != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a jump needs a periodic axis");
  DVI_TRY(check_values(t, "the left end's value", t->left.value));
  DVI_TRY(check_values(t, "the right end's value", t->right.value));
  return check_values(t, "the jump", t->jump);
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

static dvi_status check(const dvi_moving_terms *t)
{
  if (t->size != sizeof *t)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: set terms.size to sizeof(dvi_moving_terms)");
  DVI_TRY(check_axis(t));
  DVI_TRY(check_sizes(t));
  DVI_TRY(check_motion(t));
  DVI_TRY(check_density(t));
  return check_ends(t);
}

/* ---- create ---- */

static void copy_density(const dvi_moving_terms *t, dvi_moving *m)
{
  m->part = *t->part;
  memcpy(m->variable, t->part->variable, (size_t)m->part.variables * sizeof *m->variable);
  m->part.variable = m->variable;
  if (m->part.pair != NULL)
    memcpy(m->pair, m->part.pair, (size_t)m->part.pairs * sizeof *m->pair);
  else
    m->part.pairs = m->part.variables * (m->part.variables + 1) / 2;
  for (int a = 0, p = 0; a < m->part.variables && m->part.pair == NULL; a++)
    for (int b = 0; b <= a; b++, p++) m->pair[p][0] = a, m->pair[p][1] = b;
  m->part.pair = NULL;
  if (t->mean != NULL) m->mean = *t->mean;
  m->translations = t->translations != 0;
  m->space_derivative = t->motion == DVI_MOVING_FREE && !t->translations ? t->space_derivative
                                                                         : NULL;
}

static void copy_ends(const dvi_moving_terms *t, dvi_moving *m)
{
  const dvi_moving_end *end[2] = {&t->left, &t->right};
  for (int side = 0; side < 2; side++) {
    m->fixed[side] = end[side]->kind == DVI_FIXED;
    for (int c = 0; c < m->components && end[side]->value != NULL; c++)
      m->end[side][c] = end[side]->value[c];
  }
  for (int c = 0; c < m->components && t->jump != NULL; c++) m->jump[c] = t->jump[c];
}

static dvi_status place_nodes(const dvi_moving_terms *t, dvi_moving *m)
{
  m->node = DVI_NEW(double, m->cells + 1);
  if (m->node == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for nodes");
  for (int k = 0; k <= m->cells; k++)
    m->node[k] = t->axis.node != NULL ? t->axis.node[k] : m->from + m->length * k / m->cells;
  m->node[m->cells] = t->axis.to;
  return t->monitor != NULL ? dvi__moving_grade(t, m) : DVI_OK;
}

static dvi_status make(const dvi_moving_terms *t, dvi_moving *m)
{
  m->cells = t->axis.node != NULL ? t->axis.nodes - 1 : t->cells;
  m->periodic = t->axis.periodic != 0;
  m->nodes = m->cells + !m->periodic;
  m->components = terms_components(t);
  m->numbers = 1 + m->components;
  m->points = t->points != 0 ? t->points : POINTS;
  m->from = t->axis.from;
  m->length = t->axis.to - t->axis.from;
  m->motion = t->motion;
  m->stretch = t->stretch;
  m->mu = t->mu;
  m->kappa = t->kappa;
  m->viscosity = t->viscosity;
  m->dispersion = t->dispersion;
  m->path = t->path;
  m->path_step = t->path_step;
  m->user = t->user;
  copy_density(t, m);
  copy_ends(t, m);
  DVI_TRY(dvi_quadrature(DVI_GAUSS, m->points, m->gauss, m->weight));
  DVI_TRY(place_nodes(t, m));
  return dvi__moving_lay_out(m);
}

dvi_status dvi_moving_create(const dvi_moving_terms *terms, dvi_moving **moving)
{
  if (terms == NULL || moving == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: terms and a place for the field are needed");
  *moving = NULL;
  DVI_TRY(check(terms));
  dvi_moving *m = DVI_NEW(dvi_moving, 1);
  if (m == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory");
  const dvi_status status = make(terms, m);
  *moving = m;
  if (status != DVI_OK) dvi_moving_destroy(moving);
  return status;
}

void dvi_moving_destroy(dvi_moving **moving)
{
  if (moving == NULL || *moving == NULL) return;
  dvi_moving *m = *moving;
  dvi__release(m->node);
  dvi__release(m->unknown);
  dvi__release(m->cell.entry);
  dvi__release(m->bend.entry);
  dvi__release(m->drag.entry);
  dvi__pattern_clear(&m->pattern);
  dvi__pattern_clear(&m->drag_pattern);
  dvi__pattern_clear(&m->arcs);
  dvi__release(m);
  *moving = NULL;
}

const double *dvi_moving_nodes(const dvi_moving *moving, int *cells)
{
  if (cells != NULL) *cells = moving != NULL ? moving->cells : 0;
  return moving != NULL ? moving->node : NULL;
}
