/* A field on a moving mesh from its terms. */
#include <dvi/quadrature.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"
#include "field/space/simplex_rule.h"

enum { POINTS = 3 };

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
  m->space_derivative = t->motion != DVI_MOVING_PRESCRIBED && !t->translations ? t->space_derivative
                                                                               : NULL;
}

dvi_status dvi__moving_rule(int dimension, int points, double (*place)[DVI__CELL_NODES],
                            double *weight)
{
  if (dimension == 2) {
    const dvi__simplex_rule *rule = dvi__simplex_rule_of(2, 0, points);
    for (int k = 0; k < points; k++) {
      memcpy(place[k], rule->place[k], sizeof place[k]);
      weight[k] = rule->weight[k];
    }
    return DVI_OK;
  }
  double gauss[DVI_MOVING_POINTS_MAX];
  DVI_TRY(dvi_quadrature(DVI_GAUSS, points, gauss, weight));
  for (int k = 0; k < points; k++) place[k][0] = 1 - gauss[k], place[k][1] = gauss[k];
  return DVI_OK;
}

static dvi_status make(const dvi_moving_terms *t, dvi_moving *m)
{
  m->dimension = t->mesh != NULL ? 2 : 1;
  m->components = dvi__moving_components(t);
  m->numbers = m->dimension + m->components;
  m->points = t->points != 0 ? t->points : POINTS;
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
  for (int k = 0; k < m->dimension * m->components && t->jump != NULL; k++) m->jump[k] = t->jump[k];
  DVI_TRY(dvi__moving_rule(m->dimension, m->points, m->place, m->weight));
  DVI_TRY(t->mesh != NULL ? dvi__moving_take_mesh(t, m) : dvi__moving_take_axis(t, m));
  return dvi__moving_lay_out(m);
}

dvi_status dvi_moving_create(const dvi_moving_terms *terms, dvi_moving **moving)
{
  if (terms == NULL || moving == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: terms and a place for the field are needed");
  *moving = NULL;
  DVI_TRY(dvi__moving_check_terms(terms));
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
  dvi__release(m->known);
  const dvi__stencils *stencils[] = {&m->cell, &m->bend, &m->drag};
  for (size_t k = 0; k < sizeof stencils / sizeof *stencils; k++) {
    dvi__release(stencils[k]->corner);
    dvi__release(stencils[k]->entry);
  }
  dvi_mesh_destroy(&m->mesh);
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

const int *dvi_moving_unknowns(const dvi_moving *moving, int *nodes)
{
  if (nodes != NULL) *nodes = moving != NULL ? moving->nodes : 0;
  return moving != NULL ? moving->unknown : NULL;
}
