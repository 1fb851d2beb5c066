/* Gauss collocation of i hbar M psi' = H(t,psi) psi.
 *
 * Space: psi is a polynomial of degree s in each step. Quadrature: s Gauss points c_i.
 *     Ld = h sum_i b_i ( Re <Psi_i, i hbar psi'_i> - E(t_i, Psi_i) )
 * For a Lagrangian that is linear in rates this is the collocation method
 *     Psi_i = psi0 + Z_i,   M Z_i + i h/hbar sum_j a_ij H(t_j,Psi_j) Psi_j = 0,
 *     psi1 = psi0 + sum_i d_i Z_i,   d = b^T A^-1,
 * which for s = 1 is the midpoint rule. A quadratic invariant, such as the norm, stays. With
 * eigenvalues lambda_j of A and a constant H the equations are s separate ones with M + i h/hbar
 * lambda_j H, and a step multiplies each mode by the diagonal Pade approximant of its phase. What H
 * does not hold of the true one, interaction and change in time, and for fourier the potential, is
 * iterated. Order 2s. Source: Hairer, Lubich and Wanner 2006, secs. II.1.3, IV.2.1 and VI.6. */
#include <dvi/quadrature.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/schroedinger/shifted.h"
#include "field/schroedinger/steps.h"
#include "num/compensated.h"
#include "num/dense.h"
#include "num/eigen.h"
#include "num/finite.h"

enum { MOST = DVI__STAGES_MAX, ITERATIONS = 200 };

struct dvi__gauss {
  const dvi_schroedinger *s;
  int stages;
  double h, node[MOST], A[MOST][MOST], d[MOST];
  double complex lambda[MOST], X[MOST][MOST], inverse[MOST][MOST];
  dvi__shifted *solver;
  dvi__schroedinger_room room;
  double *V;                  /* [stages][points] if it depends on time */
  double *Z, *R, *mixed, *HZ; /* [stages][2*free] */
  double *stage;              /* [2*free] */
};

/* ---- coefficients ---- */

/* a_ij, the integral of Lagrange's polynomial j from 0 to c_i, by the rule, which is exact. */
static void integrate_basis(int s, const double *c, const double *b, double (*A)[MOST])
{
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) {
      A[i][j] = 0;
      for (int m = 0; m < s; m++) {
        double l = 1;
        for (int k = 0; k < s; k++)
          if (k != j) l *= (c[i] * c[m] - c[k]) / (c[j] - c[k]);
        A[i][j] += c[i] * b[m] * l;
      }
    }
}

/* Solve A^T d = b. */
static void find_weights(dvi__gauss *g, const double *b)
{
  double transposed[MOST * MOST];
  int pivot[MOST];
  for (int j = 0; j < g->stages; j++) {
    g->d[j] = b[j];
    for (int i = 0; i < g->stages; i++) transposed[i * g->stages + j] = g->A[i][j];
  }
  (void)dvi__dense_solve(g->stages, transposed, pivot, g->d); /* A of Gauss is regular */
}

/* Put a pair a +- ib, whose real vectors are columns j and j+1 of X and rows of its inverse. */
static void put_pair(dvi__gauss *g, int j, const double *X, const double *inverse)
{
  const int s = g->stages;
  for (int i = 0; i < s; i++) {
    const double x = X[j * s + i], y = X[(j + 1) * s + i];
    const double p = inverse[i * s + j], q = inverse[i * s + j + 1];
    g->X[i][j] = dvi__of_parts(x, y);
    g->X[i][j + 1] = dvi__of_parts(x, -y);
    g->inverse[j][i] = dvi__of_parts(0.5 * p, -0.5 * q);
    g->inverse[j + 1][i] = dvi__of_parts(0.5 * p, 0.5 * q);
  }
}

static void put_one(dvi__gauss *g, int j, const double *X, const double *inverse)
{
  const int s = g->stages;
  for (int i = 0; i < s; i++) {
    g->X[i][j] = X[j * s + i];
    g->inverse[j][i] = inverse[i * s + j];
  }
}

static dvi_status diagonalise(dvi__gauss *g)
{
  const int s = g->stages;
  double T[MOST * MOST] = {0}, X[MOST * MOST], inverse[MOST * MOST], re[MOST], im[MOST];
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) T[j * s + i] = g->A[i][j];
  DVI_TRY(dvi__eigen(s, T, re, im, X, inverse));
  for (int j = 0; j < s; j++) {
    g->lambda[j] = dvi__of_parts(re[j], im[j]);
    if (im[j] == 0)
      put_one(g, j, X, inverse);
    else if (im[j] > 0)
      put_pair(g, j, X, inverse);
  }
  return DVI_OK;
}

static dvi_status find_coefficients(dvi__gauss *g)
{
  double b[MOST];
  DVI_TRY(dvi_quadrature(DVI_GAUSS, g->stages, g->node, b));
  integrate_basis(g->stages, g->node, b, g->A);
  find_weights(g, b);
  return diagonalise(g);
}

/* ---- creation ---- */

static dvi_status make_room(dvi__gauss *g)
{
  const int64_t n = 2 * g->s->free;
  DVI_TRY(dvi__schroedinger_make_room(g->s, &g->room));
  g->V = DVI_NEW(double, g->s->depends_on_time ? g->stages * g->s->points : 1);
  g->Z = DVI_NEW(double, (4 * g->stages + 1) * n);
  if (g->V == NULL || g->Z == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %d stages of %lld functions",
                     g->stages, (long long)g->s->free);
  g->R = g->Z + g->stages * n;
  g->mixed = g->R + g->stages * n;
  g->HZ = g->mixed + g->stages * n;
  g->stage = g->HZ + g->stages * n;
  return DVI_OK;
}

dvi_status dvi__gauss_create(const dvi_schroedinger *s, int stages, dvi__gauss **made)
{
  dvi__gauss *g = DVI_NEW(dvi__gauss, 1);
  *made = NULL;
  if (g == NULL) return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for a step");
  g->s = s;
  g->stages = stages;
  dvi_status status = find_coefficients(g);
  if (status == DVI_OK) status = make_room(g);
  if (status == DVI_OK) status = dvi__shifted_create(s, stages, &g->solver);
  if (status == DVI_OK)
    *made = g;
  else
    dvi__gauss_destroy(&g);
  return status;
}

void dvi__gauss_destroy(dvi__gauss **gauss)
{
  if (gauss == NULL || *gauss == NULL) return;
  dvi__gauss *g = *gauss;
  dvi__shifted_destroy(&g->solver);
  dvi__schroedinger_clear_room(&g->room);
  dvi__release(g->V);
  dvi__release(g->Z);
  dvi__release(g);
  *gauss = NULL;
}

static dvi_status factor(dvi__gauss *g, const double *V)
{
  double complex c[MOST];
  for (int j = 0; j < g->stages; j++)
    c[j] = dvi__of_parts(0, 1) * (g->h / g->s->hbar) * g->lambda[j];
  return dvi__shifted_factor(g->solver, c, V);
}

dvi_status dvi__gauss_prepare(dvi__gauss *g, double h)
{
  if (g->h == h) return DVI_OK;
  g->h = h;
  const dvi_status status = factor(g, g->s->still);
  if (status != DVI_OK) g->h = 0;
  return status;
}

/* ---- the step ---- */

/* HZ_j = H(t_j,Psi_j) Psi_j. A potential that stands still is evaluated once. */
static void act(dvi__gauss *g, const double *z)
{
  const int64_t n = 2 * g->s->free;
  for (int j = 0; j < g->stages; j++) {
    const double *Z = g->Z + j * n,
                 *V = g->s->depends_on_time ? g->V + j * g->s->points : g->s->still;
    for (int64_t i = 0; i < n; i++) g->stage[i] = z[i] + Z[i];
    dvi__schroedinger_act(g->s, V, 1, 2, g->stage, g->HZ + j * n, &g->room);
  }
}

/* R_i = M Z_i + i h/hbar sum_j a_ij HZ_j, with i (x + iy) = -y + ix. */
static void find_residual(dvi__gauss *g)
{
  const int64_t n = g->s->free;
  for (int i = 0; i < g->stages; i++) {
    double *R = g->R + 2 * i * n;
    for (int c = 0; c < 2; c++) dvi__schroedinger_mass(g->s, g->Z + (2 * i + c) * n, R + c * n);
    for (int j = 0; j < g->stages; j++) {
      const double by = g->h / g->s->hbar * g->A[i][j], *H = g->HZ + 2 * j * n;
      for (int64_t k = 0; k < n; k++) {
        R[k] -= by * H[n + k];
        R[n + k] += by * H[k];
      }
    }
  }
}

/* to_i += sum_j C_ij from_j of complex vectors. */
static void mix(const dvi__gauss *g, double complex (*C)[MOST], const double *from, double *to)
{
  const int64_t n = g->s->free;
  memset(to, 0, (size_t)(2 * g->stages * n) * sizeof *to);
  for (int i = 0; i < g->stages; i++)
    for (int j = 0; j < g->stages; j++) {
      const double a = creal(C[i][j]), b = cimag(C[i][j]), *x = from + 2 * j * n;
      double *y = to + 2 * i * n;
      for (int64_t k = 0; k < n; k++) {
        y[k] += a * x[k] - b * x[n + k];
        y[n + k] += a * x[n + k] + b * x[k];
      }
    }
}

/* Replace R by the correction of Z, apply it, and return its largest component. */
static double correct(dvi__gauss *g)
{
  const int64_t n = 2 * g->s->free, all = g->stages * n;
  mix(g, g->inverse, g->R, g->mixed);
  for (int j = 0; j < g->stages; j++) dvi__shifted_solve(g->solver, j, g->mixed + j * n);
  mix(g, g->X, g->mixed, g->R);
  for (int64_t i = 0; i < all; i++) g->Z[i] -= g->R[i];
  return dvi__largest((size_t)all, g->R);
}

static dvi_status refuse_step(const dvi__gauss *g, double t)
{
  return dvi__fail(DVI_NOT_CONVERGED,
                   "schroedinger: the iteration of the step of %g at t = %g does not converge, "
                   "because potential or interaction turn phases by too much in it; take a shorter "
                   "step, or the method split",
                   g->h, t);
}

/* Tell if the next correction would be below a rounding of z, or if corrections are roundings that
 * no longer shrink. */
static int is_settled(double change, double before, double size)
{
  return change * change <= 1e-17 * size * before || (change <= 1e-13 * size && change >= before);
}

/* Iterate until corrections have settled. What the iteration has not reached yet has the same sign
 * in each step, and adds up in the norm: some more corrections make it small against roundings. */
static dvi_status iterate(dvi__gauss *g, double t, const double *z)
{
  const double size = dvi__largest(2 * (size_t)g->s->free, z);
  double before = size;
  int settled = 0;
  memset(g->Z, 0, (size_t)(2 * g->stages * g->s->free) * sizeof *g->Z);
  for (int i = 0; i < ITERATIONS || settled > 0; i++) {
    act(g, z);
    find_residual(g);
    const double change = correct(g);
    if (i > 0 && settled == 0 && is_settled(change, before, size)) settled = i;
    if (settled > 0 && i >= settled + settled / 6) return DVI_OK;
    if (!(change <= 1e6 * size)) break;
    before = change;
  }
  return refuse_step(g, t);
}

dvi_status dvi__gauss_step(dvi__gauss *g, double t, double *z, double *compensation)
{
  const int64_t n = 2 * g->s->free;
  if (g->s->depends_on_time) {
    DVI_TRY(dvi__schroedinger_potential(g->s, t + 0.5 * g->h, g->V));
    DVI_TRY(factor(g, g->V));
    for (int j = 0; j < g->stages; j++)
      DVI_TRY(dvi__schroedinger_potential(g->s, t + g->node[j] * g->h, g->V + j * g->s->points));
  }
  DVI_TRY(iterate(g, t, z));
  for (int64_t i = 0; i < n; i++) {
    double change = 0;
    for (int j = 0; j < g->stages; j++) change += g->d[j] * g->Z[j * n + i];
    dvi__add_compensated(z + i, compensation + i, change);
  }
  return DVI_OK;
}
