/* The Lagrangian of bodies and constant masses (reduced.h) in the charts at a point of a group,
 *
 *     Omega = dexp_{-xi} xi',     L = Omega.J Omega/2 + x'.R' m rho + rate.M rate/2,
 *     R = R0 exp(xi^)
 *
 * Stored coordinates are not computed, but for bodies whose centre of mass is not their origin. At
 * a path's end the momenta are given by the discrete Euler-Poincare equation
 *
 *     mu1 = Ad*_f mu0,     f = g0^{-1} g1
 *
 * For x' in the frame of space this is p1 = p0 for x, and Pi - R0^T (x1 - x0) x p for the turn,
 * before f turns the result. */
#include <math.h>
#include <string.h>

#include <dvi/group.h>

#include "core/memory.h"
#include "core/status.h"
#include "group/vector.h"
#include "system/chart/charted_struct.h"

static const double none[DVI__CHART_POINT] = {0};

/* One body at one point of a batch. */
typedef struct spinning {
  const dvi__chart *chart;
  const dvi__factor_slot *slot, *line; /* slots of the rotation and of x, line is NULL without x */
  dvi__functions functions;
  double xi[3], rate[3], Omega[3], spin[3]; /* spin = J Omega */
  double w[DVI__CHART_POINT];               /* the matrix x' m rho^T */
} spinning;

static void matrix_times(const double *A, const double *x, double *Ax)
{
  for (int i = 0; i < 3; i++) Ax[i] = dvi__dot(A + 3 * i, x);
}

static dvi_status find_spin(dvi__charted *x, const dvi__reduced_body *body, int count, int k,
                            const double *xi, const double *rate, spinning *m)
{
  const dvi__factor_slot *slots = x->base->slots;
  *m = (spinning){.chart = &x->chart[body->slot],
                  .slot = &slots[body->slot],
                  .line = body->line >= 0 ? &slots[body->line] : NULL};
  dvi__charted_gather(m->slot, count, k, xi, m->xi);
  dvi__charted_gather(m->slot, count, k, rate, m->rate);
  const double angle = dvi__chart_angle(DVI__ROTATION, m->xi);
  if (!(angle < dvi__chart_bound(DVI__ROTATION))) return dvi__charted_too_large(angle);
  dvi__chart_functions(DVI__ROTATION, m->xi, &m->functions);
  dvi__chart_leave_velocity(m->chart, &m->functions, m->xi, m->rate, m->Omega);
  matrix_times(body->inertia, m->Omega, m->spin);
  for (int i = 0; i < 3 && m->line != NULL; i++)
    for (int j = 0; j < 3; j++)
      m->w[3 * i + j] = rate[(size_t)(m->line->x + i) * (size_t)count + (size_t)k] * body->shift[j];
  return DVI_OK;
}

/* Compute R' m rho, or the product with another matrix in the place of R'. */
static void rotate_shift(const dvi__reduced_body *body, const double *rate_of_R, double *shift)
{
  matrix_times(rate_of_R, body->shift, shift);
}

int dvi__reduced_value(int count, const double *t, const double *xi, const double *rate, double *L,
                       void *user)
{
  dvi__charted *x = user;
  const dvi__reduced *of = &x->reduced;
  const size_t points = (size_t)count;
  dvi_status status = DVI_OK;
  (void)t;
  for (size_t k = 0; k < points && status == DVI_OK; k++) {
    L[k] = 0;
    for (int e = 0; e < of->masses; e++)
      L[k] += 0.5 * of->mass[e] * rate[(size_t)of->row[e] * points + k] *
              rate[(size_t)of->column[e] * points + k];
    for (int b = 0; b < of->count && status == DVI_OK; b++) {
      double y[9], v[9];
      spinning m;
      status = find_spin(x, &of->bodies[b], count, (int)k, xi, rate, &m);
      L[k] += 0.5 * dvi__dot(m.Omega, m.spin);
      if (m.line == NULL || status != DVI_OK) continue;
      dvi__chart_point(m.chart, &m.functions, m.xi, m.rate, y, v);
      for (int i = 0; i < 9; i++) L[k] += m.w[i] * v[i];
    }
  }
  return dvi__charted_verdict(x, status);
}

static void add_masses(const dvi__reduced *of, size_t count, const double *rate, double *L_rate)
{
  for (int e = 0; e < of->masses; e++)
    for (size_t k = 0; k < count; k++)
      L_rate[(size_t)of->row[e] * count + k] += of->mass[e] *
                                                rate[(size_t)of->column[e] * count + k];
}

static void add_vector(int first, const double *vector, size_t count, size_t k, double *values)
{
  for (size_t i = 0; i < 3; i++) values[((size_t)first + i) * count + k] += vector[i];
}

/* Add the terms that couple x' and R'. */
static void add_shift(const dvi__reduced_body *body, const spinning *m, size_t count, size_t k,
                      double *L_xi, double *L_rate)
{
  double in_xi[3], in_rate[3], y[9], v[9], shift[3];
  dvi__chart_gradient(m->chart, &m->functions, m->xi, m->rate, none, m->w, in_xi, in_rate);
  dvi__chart_point(m->chart, &m->functions, m->xi, m->rate, y, v);
  rotate_shift(body, v, shift);
  add_vector(m->slot->x, in_xi, count, k, L_xi);
  add_vector(m->slot->x, in_rate, count, k, L_rate);
  add_vector(m->line->x, shift, count, k, L_rate);
}

int dvi__reduced_gradient(int count, const double *t, const double *xi, const double *rate,
                          double *L_xi, double *L_rate, void *user)
{
  dvi__charted *x = user;
  const size_t points = (size_t)count, bytes = (size_t)x->base->nx * points * sizeof(double);
  dvi_status status = DVI_OK;
  (void)t;
  memset(L_xi, 0, bytes);
  memset(L_rate, 0, bytes);
  add_masses(&x->reduced, points, rate, L_rate);
  for (int b = 0; b < x->reduced.count; b++)
    for (size_t k = 0; k < points && status == DVI_OK; k++) {
      double in_xi[3], in_rate[3];
      spinning m;
      status = find_spin(x, &x->reduced.bodies[b], count, (int)k, xi, rate, &m);
      if (status != DVI_OK) break;
      dvi__chart_turning_gradient(&m.functions, m.xi, m.rate, m.spin, in_xi, in_rate);
      add_vector(m.slot->x, in_xi, points, k, L_xi);
      add_vector(m.slot->x, in_rate, points, k, L_rate);
      if (m.line != NULL) add_shift(&x->reduced.bodies[b], &m, points, k, L_xi, L_rate);
    }
  return dvi__charted_verdict(x, status);
}

/* ---- second derivatives ---- */

/* Compute product = A^T B C. */
static void triple_product(const double *A, const double *B, const double *C, double *product)
{
  double BC[9];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      BC[3 * i + j] = B[3 * i] * C[j] + B[3 * i + 1] * C[3 + j] + B[3 * i + 2] * C[6 + j];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      product[3 * i + j] = A[i] * BC[j] + A[3 + i] * BC[3 + j] + A[6 + i] * BC[6 + j];
}

/* Compute A = dOmega/drate = dexp_{-xi}. */
static void velocity_matrix(const spinning *m, double *A)
{
  for (int j = 0; j < 3; j++) {
    double e[3] = {0}, column[3];
    e[j] = 1;
    dvi__chart_leave_velocity(m->chart, &m->functions, m->xi, e, column);
    for (int i = 0; i < 3; i++) A[3 * i + j] = column[i];
  }
}

/* Add the second derivatives of Omega.J Omega/2. With D = dOmega/dxi these are the products D^T J
 * D, D^T J A, A^T J A, and the curvature of J Omega.Omega. */
static void add_spin(dvi__charted *x, const dvi__reduced_body *body, const spinning *m,
                     size_t count, size_t k, double *L_qq, double *L_qv, double *L_vv)
{
  double A[9], D[9], in_qq[9], in_qv[9], product[9];
  velocity_matrix(m, A);
  dvi_so3_velocity_derivative(m->xi, m->rate, D);
  dvi__chart_turning_curvature(&m->functions, m->xi, m->rate, m->spin, in_qq, in_qv);
  dvi__charted_add_own_blocks(x, body->slot, in_qq, in_qv, count, k, L_qq, L_qv);
  triple_product(D, body->inertia, D, in_qq);
  triple_product(D, body->inertia, A, in_qv);
  dvi__charted_add_own_blocks(x, body->slot, in_qq, in_qv, count, k, L_qq, L_qv);
  triple_product(A, body->inertia, A, product);
  dvi__charted_add_block(&x->own_in_vv[body->slot], 3, 3, product, count, k, L_vv);
}

/* Add the second derivatives of x'.R' m rho. */
static void add_shift_blocks(dvi__charted *x, const dvi__reduced_body *body,
                             const dvi__coupling *at, const spinning *m, size_t count, size_t k,
                             double *L_qq, double *L_qv, double *L_vv)
{
  double in_qq[9], in_qv[9], T[27], S[27];
  dvi__chart_curvature(m->chart, &m->functions, m->xi, m->rate, none, m->w, in_qq, in_qv);
  dvi__charted_add_own_blocks(x, body->slot, in_qq, in_qv, count, k, L_qq, L_qv);
  dvi__chart_tangents(m->chart, &m->functions, m->xi, m->rate, T, S);
  for (int i = 0; i < 3; i++) {
    double by_xi[3] = {0}, by_rate[3] = {0}; /* row i is the derivative of R'_i m rho */
    for (int j = 0; j < 3; j++)
      for (int l = 0; l < 3; l++) {
        by_xi[l] += S[3 * (3 * i + j) + l] * body->shift[j];
        by_rate[l] += T[3 * (3 * i + j) + l] * body->shift[j];
      }
    dvi__charted_add_block(&at->qv[i], 3, 1, by_xi, count, k, L_qv);
    dvi__charted_add_block(&at->vv[i], 3, 1, by_rate, count, k, L_vv);
    dvi__charted_add_block(&at->vv_back[i], 1, 3, by_rate, count, k, L_vv);
  }
}

static void clear_blocks(const dvi__pattern *pattern, size_t count, double *values)
{
  memset(values, 0, (size_t)dvi__pattern_entries(pattern) * count * sizeof *values);
}

int dvi__reduced_hessian(int count, const double *t, const double *xi, const double *rate,
                         double *L_qq, double *L_qv, double *L_vv, void *user)
{
  dvi__charted *x = user;
  const dvi__reduced *of = &x->reduced;
  const size_t points = (size_t)count;
  dvi_status status = DVI_OK;
  (void)t;
  clear_blocks(&x->qq, points, L_qq);
  clear_blocks(&x->qv, points, L_qv);
  clear_blocks(&x->vv, points, L_vv);
  for (int e = 0; e < of->masses; e++) {
    const size_t at = (size_t)dvi__pattern_find(&x->vv, of->row[e], of->column[e]) * points;
    for (size_t k = 0; k < points; k++) L_vv[at + k] += of->mass[e];
  }
  for (int b = 0; b < of->count; b++)
    for (size_t k = 0; k < points && status == DVI_OK; k++) {
      spinning m;
      status = find_spin(x, &of->bodies[b], count, (int)k, xi, rate, &m);
      if (status != DVI_OK) break;
      add_spin(x, &of->bodies[b], &m, points, k, L_qq, L_qv, L_vv);
      if (m.line != NULL)
        add_shift_blocks(x, &of->bodies[b], &x->coupled_in[b], &m, points, k, L_qq, L_qv, L_vv);
    }
  if (dvi__charted_on_path(x, count)) {
    dvi__charted_clear_changes(x, count);
    dvi__charted_finish_changes(x, count, L_qq, L_qv);
  }
  return dvi__charted_verdict(x, status);
}

dvi_status dvi__reduced_place(dvi__charted *x)
{
  x->own_in_vv = DVI_NEW(dvi__place, x->base->slot_count);
  x->coupled_in = DVI_NEW(dvi__coupling, x->reduced.count);
  if (x->own_in_vv == NULL || x->coupled_in == NULL)
    return dvi__fail(DVI_NO_MEMORY, "charts: no memory for bodies");
  for (int c = 0; c < x->base->slot_count; c++)
    x->own_in_vv[c] = dvi__charted_place(x, &x->vv, c, c);
  for (int b = 0; b < x->reduced.count; b++) {
    const dvi__reduced_body *body = &x->reduced.bodies[b];
    for (int i = 0; i < 3 && body->line >= 0; i++) {
      x->coupled_in[b].qq[i] = dvi__charted_place(x, &x->qq, body->slot, body->line + i);
      x->coupled_in[b].qv[i] = dvi__charted_place(x, &x->qv, body->slot, body->line + i);
      x->coupled_in[b].vv[i] = dvi__charted_place(x, &x->vv, body->slot, body->line + i);
      x->coupled_in[b].vv_back[i] = dvi__charted_place(x, &x->vv, body->line + i, body->slot);
    }
  }
  return DVI_OK;
}

/* ---- paths ---- */

/* Compute R0^T v. */
static void turn_back(const double *R0, const double *v, double *turned)
{
  for (int j = 0; j < 3; j++) turned[j] = R0[j] * v[0] + R0[3 + j] * v[1] + R0[6 + j] * v[2];
}

void dvi__reduced_impulse(const dvi__charted *x, const dvi__reduced_body *body, const double *p0,
                          double *impulse)
{
  double moment[3];
  memset(impulse, 0, 3 * sizeof *impulse);
  if (body->line < 0) return;
  const int line = x->base->slots[body->line].x;
  dvi__cross(p0 + line, x->end + line, moment);
  turn_back(x->chart[body->slot].y0, moment, impulse);
}

void dvi__reduced_derive(const dvi__charted *x, const dvi__reduced_body *body,
                         const dvi__coupling *at, const double *p0, double *C_q1)
{
  const dvi__factor_slot *slot = &x->base->slots[body->slot];
  for (int i = 0; i < 3 && body->line >= 0; i++) {
    double e[3] = {0}, moment[3], turned[3], column[3];
    e[i] = -1;
    dvi__cross(e, p0 + x->base->slots[body->line].x, moment);
    turn_back(x->chart[body->slot].y0, moment, turned);
    dvi__chart_momentum(&x->chart[body->slot], x->end + slot->x, turned, column);
    dvi__charted_add_block(&at->qq[i], 3, 1, column, 1, 0, C_q1);
  }
}
