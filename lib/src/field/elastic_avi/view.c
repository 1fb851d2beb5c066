/* What can be seen at a time between events, beside the state.
 *
 * Nodes fly on from their last event, and cells pay for what lies between t and the middle of the
 * interval that they have paid for,
 *
 *     u_a(t) = u_a + v_a (t - tau_a),
 *     v_a(t) = v_a + sum over K of f_K(u(t)) (t - t_K - h_K/2)/m_a,
 *
 * which is of order 2 at any t. A damping beta has answered w of event.c, and owes what u(t)
 * differs from it. A node that rests on an obstacle has no velocity through it. Where alpha is not
 * 0, what cells owe is that of field/step/decay.h. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/elastic/system.h"
#include "field/elastic_avi/borders.h"
#include "field/mesh/share.h"
#include "field/step/decay.h"

/* The time of the last event of a cell. */
static double time_of_cell(const dvi__solid_avi *avi, int64_t c)
{
  if (avi->is_free) return dvi__solid_event_time(avi, c, avi->state.count[c]);
  const int j = dvi__solid_class_of(avi, c);
  return dvi__solid_slot_time(avi, avi->clock.slot >> j << j);
}

/* Give a node at the march's time, and how it touches obstacles. */
static dvi_status see_touch(const dvi__solid_avi *avi, int vertex, dvi__solid_node *node,
                            dvi__solid_touch *touch)
{
  const dvi__solid_touch *own = dvi__solid_touch_of(avi, vertex);
  *node = avi->state.node[vertex];
  *touch = own != NULL ? *own : (dvi__solid_touch){0};
  const int returned = dvi__solid_fly(avi, vertex, avi->clock.t, node, touch);
  return returned == 0 ? DVI_OK : dvi__solid_refuse_given(avi->solid, vertex, returned);
}

static dvi_status see_node(const dvi__solid_avi *avi, int vertex, dvi__solid_node *node)
{
  dvi__solid_touch touch;
  return see_touch(avi, vertex, node, &touch);
}

/* What a cell owes to its nodes, over their masses [(n+1)*n]. */
static dvi_status see_debt(const dvi__solid_avi *avi, int64_t c, const double *u, double *debt)
{
  const int n = avi->n;
  const double since = avi->clock.t - time_of_cell(avi, c);
  double f[DVI__SOLID_NUMBERS], load[DVI__SOLID_NUMBERS], answer[DVI__SOLID_NUMBERS] = {0};
  const int returned = dvi__solid_pull(avi, c, avi->clock.t, u, f, load);
  if (returned != 0) return dvi__solid_refuse(avi->solid, avi->cell[c].name, returned);
  if (avi->cell[c].kind & DVI__CELL_VISCOUS) {
    const double *paid = avi->state.stretch + (int64_t)DVI__SOLID_NUMBERS * avi->cell[c].viscous;
    double w[DVI__SOLID_NUMBERS];
    for (int k = 0; k < (n + 1) * n; k++) w[k] = u[k] - paid[k];
    dvi__solid_resist(avi, c, w, answer);
  }
  for (int a = 0; a <= n; a++) {
    const int vertex = avi->cell[c].corner[a];
    const double owed = dvi__decay_owed(avi->decay != NULL ? avi->decay[vertex] : 0,
                                        avi->cell[c].step, since);
    for (int i = 0; i < n; i++)
      debt[a * n + i] = (avi->node_kind[vertex] & 1 << i)
                            ? 0
                            : avi->state.node[vertex].inverse *
                                  (owed * f[a * n + i] + answer[a * n + i]);
  }
  return DVI_OK;
}

static dvi_status see_rate(const dvi__solid_avi *avi, int vertex, double *rate)
{
  const int n = avi->n;
  dvi__solid_node node, own;
  dvi__solid_touch touch;
  DVI_TRY(see_touch(avi, vertex, &own, &touch));
  for (int i = 0; i < n; i++) rate[i] = own.v[i];
  for (int64_t k = avi->cell_start[vertex]; k < avi->cell_start[vertex + 1]; k++) {
    const int64_t c = avi->cell_of[k];
    const int *corner = avi->cell[c].corner;
    double u[DVI__SOLID_NUMBERS] = {0}, debt[DVI__SOLID_NUMBERS] = {0};
    for (int a = 0; a <= n; a++) {
      DVI_TRY(see_node(avi, corner[a], &node));
      for (int i = 0; i < n; i++) u[a * n + i] = node.u[i];
    }
    DVI_TRY(see_debt(avi, c, u, debt));
    for (int a = 0; a <= n; a++)
      for (int i = 0; i < n && corner[a] == vertex; i++) rate[i] += debt[a * n + i];
  }
  dvi__solid_rest(avi, vertex, &own, &touch, rate);
  return DVI_OK;
}

/* ---- all of it ---- */

static dvi_status see_nodes(const dvi__solid_avi *avi)
{
  avi->view->hits = 0;
  for (int64_t v = 0; v < avi->vertices; v++) {
    dvi__solid_node node;
    dvi__solid_touch touch;
    DVI_TRY(see_touch(avi, (int)v, &node, &touch));
    avi->view->hits += (double)touch.hits;
    for (int i = 0; i < avi->n; i++) {
      avi->view->u[v * avi->n + i] = node.u[i];
      avi->view->rate[v * avi->n + i] = node.v[i];
    }
  }
  return DVI_OK;
}

static dvi_status see_debts(const dvi__solid_avi *avi)
{
  const int n = avi->n;
  for (int64_t c = 0; c < avi->active; c++) {
    double u[DVI__SOLID_NUMBERS] = {0}, debt[DVI__SOLID_NUMBERS] = {0};
    dvi__solid_gather(avi->solid, avi->cell[c].name, avi->view->u, u);
    DVI_TRY(see_debt(avi, c, u, debt));
    for (int a = 0; a <= n; a++)
      for (int i = 0; i < n; i++)
        avi->view->rate[(int64_t)avi->cell[c].corner[a] * n + i] += debt[a * n + i];
  }
  return DVI_OK;
}

static dvi_status see_rests(const dvi__solid_avi *avi)
{
  for (int64_t v = 0; v < avi->vertices; v++) {
    dvi__solid_node node;
    dvi__solid_touch touch;
    if (!(avi->node_kind[v] & DVI__NODE_MEETS)) continue;
    DVI_TRY(see_touch(avi, (int)v, &node, &touch));
    dvi__solid_rest(avi, (int)v, &node, &touch, avi->view->rate + v * avi->n);
  }
  return DVI_OK;
}

/* Give the energy of the start, and the sizes of all that loads and driven nodes worked. */
static dvi_status find_reference(const dvi__solid_avi *avi, double *reference)
{
  const dvi_mesh *mesh = avi->solid->mesh;
  const int n = avi->n;
  dvi__block_sum sum = {.count = 0};
  *reference = avi->clock.start_energy;
  if (avi->state.worked == NULL) return DVI_OK;
  for (int64_t v = 0; v < avi->vertices; v++) {
    dvi__solid_node now = avi->state.node[v];
    if (!dvi__owns(mesh, 0, v)) continue;
    dvi__block_sum_add(&sum, avi->state.worked[v]);
    const double before = dvi__solid_driven_energy(avi, v, &now);
    for (int i = 0; i < n; i++) now.v[i] = avi->view->rate[v * n + i];
    const double change = dvi__solid_driven_energy(avi, v, &now) - before;
    if (change != 0) dvi__block_sum_add(&sum, fabs(change));
  }
  DVI_TRY(dvi__sum_of_all(mesh, dvi__block_sum_end(&sum), reference));
  *reference += avi->clock.start_energy;
  return DVI_OK;
}

/* See what is here. Rates of other processes' nodes are not complete. */
static dvi_status see_own(const dvi__solid_avi *avi)
{
  DVI_TRY(see_nodes(avi));
  DVI_TRY(see_debts(avi));
  return see_rests(avi);
}

dvi_status dvi__solid_avi_see(const dvi__solid_avi *avi)
{
  avi->view->t = (double)NAN;
  DVI_TRY(dvi__agree(avi->solid->mesh, see_own(avi)));
  return dvi__solid_refresh(avi, avi->view->rate);
}

dvi_status dvi__solid_avi_look(const dvi__solid_avi *avi)
{
  dvi__solid_view *view = avi->view;
  if (view->t == avi->clock.t) return DVI_OK;
  DVI_TRY(dvi__solid_avi_see(avi));
  DVI_TRY(dvi_elastic_energy(avi->solid, avi->clock.t, view->u, view->rate, NULL, &view->energies));
  double reference;
  DVI_TRY(find_reference(avi, &reference));
  view->growth = reference > 0 ? (view->energies.kinetic + view->energies.stored) / reference : 1;
  view->t = avi->clock.t;
  return DVI_OK;
}

dvi_status dvi__solid_momentum(const dvi__solid_avi *avi, int k, double *value, double *size)
{
  const dvi_elastic *e = avi->solid;
  const int n = avi->n, is_turn = k >= n, i = n == 3 ? (k + 1) % 3 : 0,
            j = n == 3 ? (k + 2) % 3 : 1, is_small = dvi__solid_is_linear(e);
  dvi__block_sum sum = {.count = 0};
  *size = 0;
  for (int64_t v = 0; v < avi->vertices; v++) {
    if (!dvi__owns(e->mesh, 0, v)) continue;
    const double *u = avi->view->u + v * n, *X = e->point + v * n, *rate = avi->view->rate + v * n;
    const double xi = X[i] + (is_small ? 0 : u[i]), xj = X[j] + (is_small ? 0 : u[j]),
                 first = e->mass[v] * (is_turn ? xi * rate[j] : rate[k]),
                 second = e->mass[v] * (is_turn ? -xj * rate[i] : 0);
    dvi__block_sum_add(&sum, first + second);
    *size += fabs(first) + fabs(second);
  }
  return dvi__sum_of_all(e->mesh, dvi__block_sum_end(&sum), value);
}

/* Refuse single components of other processes' nodes, for whose rates cells may be missing. */
static dvi_status check_owners(const dvi__solid_avi *avi, int64_t count, const int *component)
{
  for (int64_t i = 0; i < count && component != NULL; i++) {
    const int vertex = component[i] / avi->n;
    DVI_TRY(dvi__check_owned(avi->solid->mesh, 0, 1, &vertex));
  }
  return DVI_OK;
}

/* A few values are computed by themselves, with the same bits. */
dvi_status dvi__solid_avi_sample(const dvi__solid_avi *avi, int64_t count, const int *component,
                                 double *u, double *rate)
{
  const int n = avi->n;
  if (component == NULL && rate != NULL) DVI_TRY(dvi__solid_avi_look(avi));
  DVI_TRY(check_owners(avi, count, component));
  if (component == NULL) count = avi->vertices * n;
  const int is_seen = avi->view->t == avi->clock.t;
  double rates[DVI__SOLID_AXES] = {0};
  dvi__solid_node node = {0};
  int64_t seen = -1;
  for (int64_t k = 0; k < count; k++) {
    const int64_t at = component != NULL ? component[k] : k, vertex = at / n;
    if (is_seen && u != NULL) u[k] = avi->view->u[at];
    if (is_seen && rate != NULL) rate[k] = avi->view->rate[at];
    if (is_seen) continue;
    if (vertex != seen && u != NULL) DVI_TRY(see_node(avi, (int)vertex, &node));
    if (vertex != seen && rate != NULL) DVI_TRY(see_rate(avi, (int)vertex, rates));
    seen = vertex;
    if (u != NULL) u[k] = node.u[at % n];
    if (rate != NULL) rate[k] = rates[at % n];
  }
  return DVI_OK;
}
