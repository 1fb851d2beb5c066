/* The start. The kicks of t_0 are half as large as the later ones, so that the run begins with the
 * given velocities, not with those half a step before. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/elastic/cell.h"
#include "field/elastic/contacts.h"
#include "field/elastic_avi/borders.h"
#include "field/mesh/share.h"
#include "field/step/decay.h"

static const double roundings = 1e-12;

void dvi__solid_keep(dvi__solid_avi *avi)
{
  memcpy(avi->kept, avi->block, avi->size);
  avi->kept_clock = avi->clock;
}

void dvi__solid_take_back(dvi__solid_avi *avi)
{
  memcpy(avi->block, avi->kept, avi->size);
  avi->clock = avi->kept_clock;
  avi->view->t = (double)NAN;
  dvi__solid_order(avi);
}

/* Refuse a node that is deeper in an obstacle than roundings are. */
static dvi_status check_place(const dvi__solid_avi *avi, int64_t vertex, const double *u)
{
  const dvi_elastic *e = avi->solid;
  const int n = avi->n;
  for (int k = 0; k < e->obstacles; k++) {
    const dvi_obstacle *o = e->obstacle + k;
    double x[DVI__SOLID_AXES], normal[DVI__SOLID_AXES], size = o->radius;
    for (int i = 0; i < n; i++) {
      x[i] = e->point[vertex * n + i] + u[i];
      size += fabs(x[i]) + fabs(o->point[i]);
    }
    const double gap = dvi__solid_gap(o, n, x, normal);
    if (gap >= -roundings * size) continue;
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "%s: at the start %s is inside of the obstacle \"%s\", %g deep: nodes start "
                     "outside, or on the surface",
                     avi->method, dvi__name_cell(e->mesh, 0, vertex).text, o->name, -gap);
  }
  return DVI_OK;
}

/* Set the view to the start, with what is given, and find its energy. */
static dvi_status check_nodes(const dvi__solid_avi *avi, double t)
{
  dvi__solid_view *view = avi->view;
  for (int64_t v = 0; v < avi->vertices && !avi->is_linear; v++) {
    const int returned = dvi__solid_given(avi->solid, v, t, view->u + v * avi->n,
                                          view->rate + v * avi->n);
    if (returned != 0) return dvi__solid_refuse_given(avi->solid, v, returned);
    if (avi->node_kind[v] & DVI__NODE_MEETS) DVI_TRY(check_place(avi, v, view->u + v * avi->n));
  }
  return DVI_OK;
}

static dvi_status check(const dvi__solid_avi *avi, double t, const double *u, const double *rate)
{
  dvi__solid_view *view = avi->view;
  const size_t size = (size_t)(avi->vertices * avi->n) * sizeof(double);
  view->t = (double)NAN;
  if (u != NULL)
    memcpy(view->u, u, size);
  else
    memset(view->u, 0, size);
  if (rate != NULL)
    memcpy(view->rate, rate, size);
  else
    memset(view->rate, 0, size);
  DVI_TRY(dvi__solid_refresh(avi, view->u));
  DVI_TRY(dvi__solid_refresh(avi, view->rate));
  DVI_TRY(dvi__agree(avi->solid->mesh, check_nodes(avi, t)));
  DVI_TRY(dvi_elastic_energy(avi->solid, t, view->u, view->rate, NULL, &view->energies));
  if (isfinite(view->energies.kinetic + view->energies.stored + view->energies.load)) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "%s: the energy of the start is not finite", avi->method);
}

static void take_values(dvi__solid_avi *avi, double t)
{
  const int n = avi->n;
  memset(avi->block, 0, avi->size);
  for (int64_t v = 0; v < avi->vertices; v++) {
    dvi__solid_node *node = avi->state.node + v;
    for (int i = 0; i < n; i++) {
      node->u[i] = avi->view->u[v * n + i];
      node->v[i] = avi->view->rate[v * n + i];
    }
    node->tau = t;
    node->inverse = 1 / avi->solid->mass[v];
  }
}

/* Kick by what a cell owes at the start, the half of a kick where nothing decays. */
static int kick_first(dvi__solid_avi *avi, int64_t c, double t)
{
  const int n = avi->n, *corner = avi->cell[c].corner;
  double u[DVI__SOLID_NUMBERS] = {0}, w[DVI__SOLID_NUMBERS] = {0}, f[DVI__SOLID_NUMBERS] = {0},
         load[DVI__SOLID_NUMBERS], answer[DVI__SOLID_NUMBERS] = {0};
  dvi__solid_gather(avi->solid, avi->cell[c].name, avi->view->u, u);
  dvi__solid_gather(avi->solid, avi->cell[c].name, avi->view->rate, w);
  const int returned = dvi__solid_pull(avi, c, t, u, f, load);
  if (returned != 0) return returned;
  if (avi->cell[c].kind & DVI__CELL_VISCOUS) {
    double *paid = avi->state.stretch + (int64_t)DVI__SOLID_NUMBERS * avi->cell[c].viscous;
    for (int k = 0; k < (n + 1) * n; k++) {
      w[k] *= 0.5 * avi->cell[c].step;
      paid[k] = u[k] + w[k];
    }
    dvi__solid_resist(avi, c, w, answer);
  }
  for (int a = 0; a <= n; a++) {
    dvi__solid_node *node = avi->state.node + corner[a];
    const double part = -dvi__decay_owed(avi->decay != NULL ? avi->decay[corner[a]] : 0,
                                         avi->cell[c].step, 0);
    for (int i = 0; i < n; i++)
      if (!(avi->node_kind[corner[a]] & 1 << i))
        node->v[i] += node->inverse * (part * f[a * n + i] + answer[a * n + i]);
  }
  for (int k = 0; k < (n + 1) * n; k++) f[k] += 2 * answer[k] / avi->cell[c].step;
  dvi__solid_note(avi, c, t, u, f);
  return 0;
}

static dvi_status kick_all(dvi__solid_avi *avi, double t)
{
  for (int64_t c = 0; c < avi->active; c++) {
    const int returned = kick_first(avi, c, t);
    if (returned != 0) return dvi__solid_refuse(avi->solid, avi->cell[c].name, returned);
  }
  return DVI_OK;
}

/* A march that has lost the values of other processes has them again. */
dvi_status dvi__solid_avi_start(dvi__solid_avi *avi, double t, const double *u, const double *rate)
{
  const int was_lost = avi->is_lost;
  DVI_TRY(check(avi, t, u, rate));
  dvi__solid_keep(avi);
  take_values(avi, t);
  avi->clock = (dvi__solid_clock){.t0 = t,
                                  .t = t,
                                  .start_energy = avi->view->energies.kinetic +
                                                  avi->view->energies.stored,
                                  .allowed = avi->band};
  avi->is_lost = 0;
  dvi_status status = dvi__agree(avi->solid->mesh, kick_all(avi, t));
  if (status == DVI_OK) status = dvi__solid_complete(avi);
  if (status != DVI_OK) {
    dvi__solid_take_back(avi);
    avi->is_lost = was_lost;
    return status;
  }
  dvi__solid_keep(avi);
  dvi__solid_order(avi);
  return DVI_OK;
}
