/* The event of a cell.
 *
 * Loads act at the cell's times, as its stored energy does. A damping alpha acts in the flight of a
 * node, v' = -c v with c the mean of alpha over the masses of its cells, whose solution is exact:
 *
 *     u += phi1(c s) v s,  v *= exp(-c s),     phi1(z) = (1 - exp(-z))/z.
 *
 * The damping -beta K u' of a cell with the stiffness K at rest pushes in the time from t to t' by
 * exactly -beta K (u' - u). At an event a cell pays all of this so far, and half a step in advance,
 * for which its nodes are taken to fly on:
 *
 *     w = u + v h/2,    m_a v_a += -beta K (w - w_before),    w_before = u at the start.
 *
 * What it has paid is right to order 2 at all times. A single mode is stable for
 * h^2 omega^2 + 4 h beta omega^2 < 4 (plan.c). */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/elastic_avi/engine.h"
#include "field/step/decay.h"

/* ---- flights ---- */

int dvi__solid_guide(const dvi__solid_avi *avi, int vertex, double t, dvi__solid_node *node,
                     dvi__solid_touch *touch)
{
  const int kind = avi->node_kind[vertex];
  const double from = node->tau, span = t - from;
  if (!(span > 0)) return 0;
  const double z = kind & DVI__NODE_DECAYS ? avi->decay[vertex] * span : 0,
               length = span * dvi__decay_mean(z);
  node->tau = t;
  if (kind & DVI__NODE_MEETS)
    dvi__solid_bounce(avi, vertex, from, length, node, touch);
  else
    for (int i = 0; i < DVI__SOLID_AXES; i++) node->u[i] += node->v[i] * length;
  if (kind & DVI__NODE_DECAYS)
    for (int i = 0; i < DVI__SOLID_AXES; i++) node->v[i] *= exp(-z);
  return kind & DVI__NODE_DRIVEN ? dvi__solid_given(avi->solid, vertex, t, node->u, node->v) : 0;
}

/* ---- forces ---- */

static int force_of(const dvi__solid_avi *avi, const dvi__solid_cell *cell, const double *u,
                    double *f)
{
  return dvi__solid_force_of(avi->n, avi->solid->materials + cell->material, cell->volume,
                             cell->gradient, u, f);
}

void dvi__solid_resist(const dvi__solid_avi *avi, int64_t c, const double *w, double *f)
{
  const dvi_elastic *e = avi->solid;
  const int64_t cell = avi->cell[c].name;
  memset(f, 0, DVI__SOLID_NUMBERS * sizeof *f);
  dvi__solid_rest_force(e, cell, w, f);
  for (int k = 0; k < (avi->n + 1) * avi->n; k++) f[k] *= e->materials[e->material[cell]].beta;
}

int dvi__solid_pull(const dvi__solid_avi *avi, int64_t c, double t, const double *u, double *f,
                    double *load)
{
  const int numbers = (avi->n + 1) * avi->n;
  memset(load, 0, DVI__SOLID_NUMBERS * sizeof *load);
  if (avi->is_linear) {
    dvi__solid_rest_force(avi->solid, avi->cell[c].name, u, f);
    return 0;
  }
  const int returned = force_of(avi, avi->cell + c, u, f);
  if (returned != 0 || !(avi->cell[c].kind & DVI__CELL_LOADED)) return returned;
  const int of_load = dvi__solid_add_load(avi->solid, avi->cell[c].name, t, load);
  if (of_load != 0) return of_load < 0 ? of_load : -of_load;
  for (int k = 0; k < numbers; k++) {
    if (!isfinite(load[k])) return -1;
    f[k] += load[k];
  }
  return 0;
}

/* ---- what is special ---- */

/* Add the answer of the damping to f. */
static void pay_damping(dvi__solid_avi *avi, int64_t c, const double *u, const double *v, double *f)
{
  const int numbers = (avi->n + 1) * avi->n;
  double *paid = avi->state.stretch + (int64_t)DVI__SOLID_NUMBERS * avi->cell[c].viscous,
         w[DVI__SOLID_NUMBERS], answer[DVI__SOLID_NUMBERS];
  for (int k = 0; k < numbers; k++) {
    const double stretch = u[k] + 0.5 * avi->cell[c].step * v[k];
    w[k] = stretch - paid[k];
    paid[k] = stretch;
  }
  dvi__solid_resist(avi, c, w, answer);
  for (int k = 0; k < numbers; k++) f[k] += answer[k] / avi->cell[c].step;
}

/* Add the sizes of what loads and driven nodes work to those of the nodes. */
static void add_works(dvi__solid_avi *avi, int64_t c, const double *v, const double *f,
                      const double *load)
{
  const int n = avi->n;
  for (int a = 0; a <= n; a++) {
    const int vertex = avi->cell[c].corner[a], kind = avi->node_kind[vertex];
    double sum = 0;
    for (int i = 0; i < n; i++) {
      const int is_driven = (kind & DVI__NODE_DRIVEN) && (kind & 1 << i);
      sum += fabs((is_driven ? f[a * n + i] : load[a * n + i]) * v[a * n + i]);
    }
    avi->state.worked[vertex] += sum * avi->cell[c].step;
  }
}

static int act_guarded(dvi__solid_avi *avi, int64_t c, double t)
{
  const int n = avi->n, *corner = avi->cell[c].corner;
  double u[DVI__SOLID_NUMBERS] = {0}, v[DVI__SOLID_NUMBERS] = {0}, f[DVI__SOLID_NUMBERS],
         load[DVI__SOLID_NUMBERS];
  for (int a = 0; a <= n; a++) {
    dvi__solid_node *node = avi->state.node + corner[a];
    const double before = dvi__solid_driven_energy(avi, corner[a], node);
    const int returned = dvi__solid_fly(avi, corner[a], t, node,
                                        dvi__solid_touch_of(avi, corner[a]));
    if (returned != 0) return returned;
    if (avi->state.worked != NULL)
      avi->state.worked[corner[a]] += fabs(dvi__solid_driven_energy(avi, corner[a], node) - before);
    for (int i = 0; i < n; i++) {
      u[a * n + i] = node->u[i];
      v[a * n + i] = node->v[i];
    }
  }
  const int returned = dvi__solid_pull(avi, c, t, u, f, load);
  if (returned != 0) return returned;
  if (avi->state.worked != NULL) add_works(avi, c, v, f, load);
  if (avi->cell[c].kind & DVI__CELL_VISCOUS) pay_damping(avi, c, u, v, f);
  for (int a = 0; a <= n; a++) {
    dvi__solid_node *node = avi->state.node + corner[a];
    const double kick = avi->cell[c].step * node->inverse;
    for (int i = 0; i < n; i++)
      if (!(avi->node_kind[corner[a]] & 1 << i)) node->v[i] += kick * f[a * n + i];
  }
  dvi__solid_note(avi, c, t, u, f);
  return 0;
}

int dvi__solid_act(dvi__solid_avi *avi, int64_t c, double t)
{
  const dvi__solid_cell *cell = avi->cell + c;
  if (cell->kind != 0 || avi->is_linear) return act_guarded(avi, c, t);
  const int n = avi->n;
  double u[DVI__SOLID_NUMBERS] = {0}, f[DVI__SOLID_NUMBERS];
  for (int a = 0; a <= n; a++) {
    dvi__solid_node *node = avi->state.node + cell->corner[a];
    const double span = t - node->tau;
    for (int i = 0; i < DVI__SOLID_AXES; i++) node->u[i] += node->v[i] * span;
    node->tau = t;
    for (int i = 0; i < n; i++) u[a * n + i] = node->u[i];
  }
  const int returned = force_of(avi, cell, u, f);
  if (returned != 0) return returned;
  for (int a = 0; a <= n; a++) {
    dvi__solid_node *node = avi->state.node + cell->corner[a];
    const double kick = cell->step * node->inverse;
    for (int i = 0; i < n; i++) node->v[i] += kick * f[a * n + i];
  }
  return 0;
}
