/* The operations are those of charted_lagrangian.c and charted_path.c. */
#include "system/chart/charted_members.h"

#include <string.h>

#include "core/memory.h"
#include "group/chart_members.h"
#include "system/chart/charted_struct.h"
#include "system/system.h"

struct dvi__charted_members {
  dvi__charted *charted;
  dvi__evaluator *evaluator; /* evaluator of the base, which does not count */
  int nodes, width;
  dvi__chart *chart;        /* [capacity*slots] */
  double *y0, *basis;       /* rows [n] and [6*slots] of the charts */
  double *functions;        /* [DVI__NODE_FUNCTIONS*slots] rows at all nodes */
  double *y, *v, *L_y, *w;  /* [n] rows at all nodes */
  double *moment, *impulse; /* [3*slots] rows at all nodes, and [3*slots] rows */
  double *kept;             /* [capacity*3*slots] impulses of solutions */
};

typedef dvi__charted_members members;

int dvi__charted_has_members(const dvi__charted *x)
{
  return x->reduced.bodies == NULL && x->base->force_count == 0 && x->base->holonomic_count == 0 &&
         dvi__system_has_gradients(x->base);
}

/* ---- create, destroy ---- */

static dvi_status members_allocate(members *m, size_t capacity)
{
  const size_t n = (size_t)m->charted->base->n, slots = (size_t)m->charted->base->slot_count,
               points = (size_t)m->nodes * capacity;
  m->chart = DVI_NEW(dvi__chart, capacity * slots);
  m->y0 = DVI_NEW(double, n *capacity);
  m->basis = DVI_NEW(double, 6 * slots * capacity);
  m->functions = DVI_NEW(double, DVI__NODE_FUNCTIONS *slots *points);
  m->y = DVI_NEW(double, n *points);
  m->v = DVI_NEW(double, n *points);
  m->L_y = DVI_NEW(double, n *points);
  m->w = DVI_NEW(double, n *points);
  m->moment = DVI_NEW(double, 3 * slots * points);
  m->impulse = DVI_NEW(double, 3 * slots * capacity);
  m->kept = DVI_NEW(double, 3 * slots * capacity);
  if (m->chart && m->y0 && m->basis && m->functions && m->y && m->v && m->L_y && m->w &&
      m->moment && m->impulse && m->kept)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "charts: no memory for %zu members", capacity);
}

dvi_status dvi__charted_members_create(dvi__charted *charted, int nodes, int capacity,
                                       dvi__charted_members **made)
{
  members *m = *made = DVI_NEW(members, 1);
  if (m == NULL) return dvi__fail(DVI_NO_MEMORY, "charts: no memory");
  m->charted = charted;
  m->nodes = nodes;
  DVI_TRY(
      dvi__evaluator_create(charted->base, nodes * capacity, DVI__GRADIENTS, NULL, &m->evaluator));
  return members_allocate(m, (size_t)capacity);
}

void dvi__charted_members_destroy(dvi__charted_members **made)
{
  members *m = *made;
  if (m == NULL) return;
  void *const own[] = {m->chart, m->y0, m->basis,  m->functions, m->y,   m->v,
                       m->L_y,   m->w,  m->moment, m->impulse,   m->kept};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++) dvi__release(own[i]);
  dvi__evaluator_destroy(&m->evaluator);
  dvi__release(m);
  *made = NULL;
}

/* ---- charts ---- */

void dvi__charted_members_begin(dvi__charted_members *m, int width)
{
  m->width = width;
}

void dvi__charted_members_take(dvi__charted_members *m, int k)
{
  const dvi__charted *x = m->charted;
  const size_t slots = (size_t)x->base->slot_count, width = (size_t)m->width;
  memcpy(m->chart + (size_t)k * slots, x->chart, slots * sizeof *x->chart);
  for (size_t c = 0; c < slots; c++) {
    const dvi__factor_slot *slot = &x->base->slots[c];
    double *y0 = m->y0 + (size_t)slot->q * width + k, *basis = m->basis + 6 * c * width + k;
    for (size_t i = 0; i < (size_t)dvi__chart_stored(slot->kind); i++)
      y0[i * width] = x->chart[c].y0[i];
    for (size_t i = 0; i < 3; i++) {
      basis[i * width] = x->chart[c].basis[0][i];
      basis[(i + 3) * width] = x->chart[c].basis[1][i];
    }
  }
}

void dvi__charted_members_keep(dvi__charted_members *m, int k)
{
  const size_t count = 3 * (size_t)m->charted->base->slot_count, width = (size_t)m->width;
  for (size_t i = 0; i < count; i++)
    m->kept[(size_t)k * count + i] = m->impulse[i * width + (size_t)k];
}

void dvi__charted_members_give(const dvi__charted_members *m, int k)
{
  dvi__charted *x = m->charted;
  const size_t slots = (size_t)x->base->slot_count;
  memcpy(x->chart, m->chart + (size_t)k * slots, slots * sizeof *x->chart);
  memcpy(x->impulse, m->kept + 3 * (size_t)k * slots, 3 * slots * sizeof *x->impulse);
  memset(x->kick, 0, 3 * slots * sizeof *x->kick);
  x->failure = DVI_OK;
}

static dvi__chart_members charts_of(const members *m, int c)
{
  const dvi__factor_slot *slot = &m->charted->base->slots[c];
  const size_t width = (size_t)m->width;
  return (dvi__chart_members){.kind = slot->kind,
                              .width = m->width,
                              .y0 = m->y0 + (size_t)slot->q * width,
                              .basis = m->basis + 6 * (size_t)c * width};
}

/* ---- gradients ---- */

/* Give the numbers of slot c at all nodes. */
static dvi__chart_nodes nodes_of(const members *m, int c, const double *xi, const double *rate,
                                 double *L_xi, double *L_rate)
{
  const dvi__factor_slot *slot = &m->charted->base->slots[c];
  const size_t points = (size_t)m->nodes * (size_t)m->width, local = (size_t)slot->x * points,
               stored = (size_t)slot->q * points;
  return (dvi__chart_nodes){.count = m->nodes * m->width,
                            .local = points,
                            .xi = xi + local,
                            .rate = rate + local,
                            .functions = m->functions + DVI__NODE_FUNCTIONS * (size_t)c * points,
                            .y = m->y + stored,
                            .v = m->v + stored,
                            .a = m->L_y + stored,
                            .b = m->w + stored,
                            .in_xi = L_xi + local,
                            .in_rate = L_rate + local};
}

static dvi_status place_members(const members *m, const double *xi, const double *rate,
                                double *L_xi, double *L_rate)
{
  const dvi__charted *x = m->charted;
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__chart_members charts = charts_of(m, c);
    dvi__chart_nodes nodes = nodes_of(m, c, xi, rate, L_xi, L_rate);
    if (x->inertia != NULL) nodes.v = NULL;
    const double beyond = dvi__chart_place_members(&charts, &nodes);
    if (beyond != 0) return dvi__charted_too_large(beyond);
  }
  return DVI_OK;
}

dvi_status dvi__charted_members_gradient(dvi__charted_members *m, const double *t, const double *xi,
                                         const double *rate, double *L_xi, double *L_rate)
{
  const dvi__charted *x = m->charted;
  const int apart = x->inertia != NULL, points = m->nodes * m->width;
  DVI_TRY(place_members(m, xi, rate, L_xi, L_rate));
  DVI_TRY(dvi__lagrangian_gradient(m->evaluator, points, t, m->y, apart ? NULL : m->v, m->L_y,
                                   apart ? NULL : m->w));
  for (int c = 0; c < x->base->slot_count; c++) {
    const dvi__chart_members charts = charts_of(m, c);
    const dvi__chart_nodes nodes = nodes_of(m, c, xi, rate, L_xi, L_rate);
    dvi__chart_move_members(&charts, apart ? x->inertia + 9 * c : NULL, &nodes);
    if (dvi__turns(&x->base->slots[c]))
      dvi__chart_moments_of_nodes(&x->chart[c], apart ? NULL : x->own_mass + 3 * c, &nodes,
                                  (size_t)points, m->moment + 3 * (size_t)c * (size_t)points);
  }
  return DVI_OK;
}

/* ---- ends of paths ---- */

void dvi__charted_members_correct(dvi__charted_members *m, double h, const double *weight,
                                  const double *end, const double *p0, const double *dp, double *C)
{
  const dvi_system *base = m->charted->base;
  const size_t width = (size_t)m->width, points = (size_t)m->nodes * width;
  memset(C, 0, (size_t)base->nx * width * sizeof *C);
  for (int c = 0; c < base->slot_count; c++) {
    const dvi__chart_members charts = charts_of(m, c);
    const size_t local = (size_t)base->slots[c].x * width;
    if (dvi__turns(&base->slots[c]))
      dvi__chart_correct_members(&charts,
                                 &(dvi__chart_paths){.nodes = m->nodes,
                                                     .h = h,
                                                     .weight = weight,
                                                     .moment = m->moment + 3 * (size_t)c * points,
                                                     .xi = end + local,
                                                     .p0 = p0 + local,
                                                     .dp = dp + local,
                                                     .impulse = m->impulse + 3 * (size_t)c * width,
                                                     .correction = C + local});
  }
}
