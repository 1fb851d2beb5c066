/* Iteration with the kinetic part of the Jacobian (residual.c) for members of an ensemble side by
 * side. General Lagrangians have a mass of their own in the middle of each member's path. */
#include <math.h>
#include <string.h>

#include "step/element/action_struct.h"
#include "step/element/members.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/simd/members.h"
#include "num/simd/members_chord.h"
#include "system/evaluate/velocity_hessians.h"
#include "system/rescale/transformed.h"

/* The mass of a general Lagrangian. */
typedef struct middle_mass {
  double *t, *q, *v;          /* [n*capacity] points */
  double *L_qq, *L_qv, *L_vv; /* [entries*capacity] */
  double *inverse;            /* [n*n*capacity] */
  char *sound;                /* [capacity] the inverse is one */
} middle_mass;

struct dvi__chord_members {
  double *q0, *p0;           /* [n*capacity] starts of the members that still iterate */
  double *Y, *R, *rows;      /* [n*s*capacity] */
  double *Q, *V, *L_q, *L_v; /* [n*r*capacity] */
  int is_prepared;           /* the masses are those of the members' paths */
  middle_mass mass;
};

int dvi__action_has_chord_members(const dvi__action *a)
{
  const dvi_system *system = a->system;
  if (a->by_user || a->terms.count > 0 || a->centred != NULL || dvi__transformed_of(system) != NULL)
    return 0;
  return system->lagrangian == NULL
             ? (system->terms & DVI__CONSTANT_MASS) != 0
             : a->chord_inverse != NULL && dvi__system_has_smooth_lagrangian(system);
}

/* ---- create ---- */

static dvi_status mass_create(const dvi__action *a, size_t capacity, middle_mass *mass)
{
  const dvi_system *system = a->system;
  if (system->lagrangian == NULL) return DVI_OK;
  const size_t n = (size_t)a->n, qq = (size_t)dvi__pattern_entries(&system->lagrangian->qq),
               qv = (size_t)dvi__pattern_entries(&system->lagrangian->qv),
               vv = (size_t)dvi__pattern_entries(&system->lagrangian->vv);
  mass->t = DVI_NEW(double, capacity);
  mass->q = DVI_NEW(double, n *capacity);
  mass->v = DVI_NEW(double, n *capacity);
  mass->L_qq = DVI_NEW(double, qq *capacity);
  mass->L_qv = DVI_NEW(double, qv *capacity);
  mass->L_vv = DVI_NEW(double, vv *capacity);
  mass->inverse = DVI_NEW(double, n *n *capacity);
  mass->sound = DVI_NEW(char, capacity);
  if (mass->t && mass->q && mass->v && mass->L_qq && mass->L_qv && mass->L_vv && mass->inverse &&
      mass->sound)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "action: no memory for %zu members", capacity);
}

dvi_status dvi__chord_members_create(dvi__action_members *m, size_t capacity)
{
  const dvi__action *a = m->action;
  const size_t n = (size_t)a->n, s = (size_t)a->s, r = (size_t)a->r;
  struct dvi__chord_members *c = m->chord = DVI_NEW(struct dvi__chord_members, 1);
  if (c == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory");
  double **const starts[] = {&c->q0, &c->p0}, **const paths[] = {&c->Y, &c->R, &c->rows},
                 **const nodes[] = {&c->Q, &c->V, &c->L_q, &c->L_v};
  int complete = 1;
  for (int i = 0; i < 2; i++) complete &= (*starts[i] = DVI_NEW(double, n *capacity)) != NULL;
  for (int i = 0; i < 3; i++) complete &= (*paths[i] = DVI_NEW(double, n *s *capacity)) != NULL;
  for (int i = 0; i < 4; i++) complete &= (*nodes[i] = DVI_NEW(double, n *r *capacity)) != NULL;
  if (!complete) return dvi__fail(DVI_NO_MEMORY, "action: no memory for %zu members", capacity);
  return mass_create(a, capacity, &c->mass);
}

void dvi__chord_members_clear(dvi__action_members *m)
{
  struct dvi__chord_members *c = m->chord;
  if (c == NULL) return;
  double *const owned[] = {c->q0,        c->p0,        c->Y,         c->R,
                           c->rows,      c->Q,         c->V,         c->L_q,
                           c->L_v,       c->mass.t,    c->mass.q,    c->mass.v,
                           c->mass.L_qq, c->mass.L_qv, c->mass.L_vv, c->mass.inverse};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
  dvi__release(c->mass.sound);
  dvi__release(c);
  m->chord = NULL;
}

/* ---- begin ---- */

void dvi__action_continue_members(dvi__action *a, double ratio, int width, const double *last,
                                  double *Y)
{
  dvi__members_product(a->n, a->s, a->path_lanes, a->s, dvi__action_path_shift(a, ratio), width,
                       last, Y);
}

/* Continue the last paths, which are kept in m->forces. */
void dvi__chord_members_place(dvi__action_members *m, double ratio)
{
  m->start = m->p;
  m->chord->is_prepared = 0;
  dvi__action_continue_members(m->action, ratio, m->width, m->forces, m->chord->Y);
}

void dvi__chord_members_pack(dvi__action_members *m, int before)
{
  const int n = m->action->n;
  struct dvi__chord_members *c = m->chord;
  dvi__action_members_pack(m, n * m->action->s, before, c->Y, c->Y);
  dvi__action_members_pack(m, n, before, m->origin, c->q0);
  dvi__action_members_pack(m, n, before, m->start, c->p0);
  if (c->is_prepared && c->mass.inverse != NULL)
    dvi__action_members_pack(m, n * n, before, c->mass.inverse, c->mass.inverse);
  m->origin = c->q0;
  m->start = c->p0;
}

/* Find sum_k function_k Y_ik of all lanes, in the order of dvi__action_path. */
static void add_functions(const dvi__action_members *m, size_t i, const double *function,
                          double *restrict sum)
{
  const size_t width = (size_t)m->width, s = (size_t)m->action->s;
  memset(sum, 0, width * sizeof *sum);
  for (size_t k = 0; k < s; k++) {
    const double *restrict Y = m->chord->Y + (i * s + k) * width;
    for (size_t lane = 0; lane < width; lane++) sum[lane] += function[k] * Y[lane];
  }
}

/* Find the middle of each path as dvi__action_prepare_chord. */
static void find_middles(const dvi__action_members *m)
{
  const size_t width = (size_t)m->width;
  const middle_mass *mass = &m->chord->mass;
  const double h = m->action->h;
  for (size_t lane = 0; lane < width; lane++) mass->t[lane] = m->t0[m->member[lane]] + 0.5 * h;
  for (size_t i = 0; i < (size_t)m->action->n; i++) {
    double *q = mass->q + i * width, *v = mass->v + i * width;
    const double *q0 = m->origin + i * width;
    add_functions(m, i, m->action->middle_basis, q);
    add_functions(m, i, m->action->middle_basis + m->action->s, v);
    for (size_t lane = 0; lane < width; lane++) q[lane] += q0[lane];
    for (size_t lane = 0; lane < width; lane++) v[lane] /= h;
  }
}

/* Invert the masses. One that needs exchanges ends the iteration of its lane by NaN. */
static void invert_masses(const dvi__action_members *m)
{
  const middle_mass *mass = &m->chord->mass;
  const dvi__pattern *vv = &m->action->system->vv;
  const size_t width = (size_t)m->width, n = (size_t)m->action->n;
  memset(mass->inverse, 0, n * n * width * sizeof(double));
  for (size_t j = 0; j < n; j++)
    for (int e = vv->start[j]; e < vv->start[j + 1]; e++)
      memcpy(mass->inverse + (j * n + (size_t)vv->row[e]) * width, mass->L_vv + (size_t)e * width,
             width * sizeof(double));
  dvi__members_inverse(m->action->n, m->width, mass->inverse, mass->q, mass->sound);
  for (size_t lane = 0; lane < width; lane++)
    if (!mass->sound[lane]) mass->inverse[lane] = (double)NAN;
}

static dvi_status prepare_masses(const dvi__action_members *m)
{
  const middle_mass *mass = &m->chord->mass;
  find_middles(m);
  DVI_TRY(dvi__velocity_hessians(m->evaluator, m->width, mass->t, mass->q, mass->v, mass->L_qq,
                                 mass->L_qv, mass->L_vv));
  invert_masses(m);
  return DVI_OK;
}

/* ---- iterations ---- */

void dvi__action_members_tables(const dvi__action *a, dvi__members_chord *loops)
{
  loops->n = a->n;
  loops->s = a->s;
  loops->r = a->r;
  loops->h = a->h;
  loops->inverse_h = 1.0 / a->h;
  loops->lanes = a->lanes;
  loops->path_lanes = a->path_lanes;
  loops->psi = a->psi;
  loops->dpsi = a->dpsi;
  loops->bar_row = a->bar_row;
  loops->slope_row = a->slope_row;
  loops->stiffness_row = a->stiffness_row;
  loops->weight = a->weight;
  loops->end = a->end;
}

static dvi__members_chord loops_of(const dvi__action_members *m)
{
  const struct dvi__chord_members *c = m->chord;
  dvi__members_chord loops = {.width = m->width,
                              .q0 = m->origin,
                              .p0 = m->start,
                              .Y = c->Y,
                              .Q = c->Q,
                              .V = c->V,
                              .L_q = c->L_q,
                              .L_v = c->L_v,
                              .R = c->R,
                              .rows = c->rows,
                              .inverse = c->mass.inverse,
                              .change = m->change,
                              .largest = m->largest};
  dvi__action_members_tables(m->action, &loops);
  return loops;
}

dvi_status dvi__chord_members_iterate(dvi__action_members *m)
{
  const dvi__action *a = m->action;
  struct dvi__chord_members *c = m->chord;
  const dvi__members_chord loops = loops_of(m);
  if (!c->is_prepared && c->mass.inverse != NULL) DVI_TRY(prepare_masses(m));
  c->is_prepared = 1;
  dvi__members_chord_stages(&loops);
  DVI_TRY(
      dvi__lagrangian_gradient(m->evaluator, a->r * m->width, m->t, c->Q, c->V, c->L_q, c->L_v));
  dvi__members_chord_residual(&loops);
  if (c->mass.inverse != NULL)
    dvi__members_chord_invert(&loops);
  else
    dvi__mass_solve(m->evaluator, a->s * m->width, c->R, c->R);
  dvi__members_chord_correct(&loops);
  return DVI_OK;
}

/* Keep the path of a lane, and the ends as dvi__action_ends. */
void dvi__chord_members_keep(dvi__action_members *m, int lane)
{
  const dvi__action *a = m->action;
  const struct dvi__chord_members *c = m->chord;
  const size_t s = (size_t)a->s, r = (size_t)a->r, width = (size_t)m->width,
               count = (size_t)m->count, member = (size_t)m->member[lane];
  const double *Y = c->Y + lane, *L_q = c->L_q + lane;
  for (size_t i = 0; i < (size_t)a->n; i++) {
    double moved = 0, force = 0;
    for (size_t k = i * s; k < (i + 1) * s; k++) {
      m->forces[k * count + member] = Y[k * width];
      moved += a->end[k - i * s] * Y[k * width];
    }
    for (size_t j = i * r; j < (i + 1) * r; j++) force += L_q[j * width];
    m->dq[i * count + member] = moved;
    m->dq_low[i * count + member] = 0;
    m->dp[i * count + member] = a->h * force;
  }
}
