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
 * iterated (stages.c). Order 2s. Source: Hairer, Lubich and Wanner 2006, secs. II.1.3, IV.2.1 and
 * VI.6. */
#include "field/schroedinger/gauss.h"

#include <dvi/quadrature.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/compensated.h"
#include "num/dense.h"
#include "num/eigen.h"

enum { MOST = DVI__STAGES_MAX };

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

/* Choose what is missing of a_ij and a_ji so that b_i a_ij + b_j a_ji = b_i b_j. */
static void find_rests(dvi__gauss *g, const double *b)
{
  for (int i = 0; i < g->stages; i++)
    for (int j = 0; j <= i; j++) {
      const dvi__twofold ij = dvi__exact_product(b[i], g->A[i][j]),
                         ji = dvi__exact_product(b[j], g->A[j][i]),
                         wanted = dvi__exact_product(b[i], b[j]),
                         more = dvi__twofold_plus(dvi__twofold_plus(ij, ji),
                                                  dvi__twofold_scaled(wanted, -1));
      g->A_rest[i][j] = -more.head / (2 * b[i]);
      g->A_rest[j][i] = -more.head / (2 * b[j]);
    }
}

/* Solve A^T x = y, in place. */
static void solve_transposed(const dvi__gauss *g, double *x)
{
  double transposed[MOST * MOST];
  int pivot[MOST];
  for (int j = 0; j < g->stages; j++)
    for (int i = 0; i < g->stages; i++) transposed[i * g->stages + j] = g->A[i][j];
  (void)dvi__dense_solve(g->stages, transposed, pivot, x); /* A of Gauss is regular */
}

/* Solve A^T d = b, with one correction beyond roundings. */
static void find_weights(dvi__gauss *g, const double *b)
{
  for (int j = 0; j < g->stages; j++) g->d[j] = b[j];
  solve_transposed(g, g->d);
  for (int j = 0; j < g->stages; j++) {
    dvi__twofold left = {b[j], 0};
    for (int i = 0; i < g->stages; i++)
      left = dvi__twofold_less_product(left, (dvi__twofold){g->A[i][j], g->A_rest[i][j]},
                                       (dvi__twofold){g->d[i], 0});
    g->d_rest[j] = left.head;
  }
  solve_transposed(g, g->d_rest);
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
  find_rests(g, b);
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
  g->psi = DVI_NEW(double, g->s->beta != NULL ? 2 * g->stages * g->s->points : 1);
  if (g->V == NULL || g->Z == NULL || g->psi == NULL)
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
  if (status == DVI_OK) status = dvi__gauss_create_newton(g);
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
  dvi__krylov_destroy(&g->newton);
  dvi__shifted_destroy(&g->solver);
  dvi__schroedinger_clear_room(&g->room);
  dvi__release(g->V);
  dvi__release(g->Z);
  dvi__release(g->psi);
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

dvi_status dvi__gauss_step(dvi__gauss *g, double t, double *z, double *compensation)
{
  const int64_t n = 2 * g->s->free;
  if (g->s->depends_on_time) {
    DVI_TRY(dvi__schroedinger_potential(g->s, t + 0.5 * g->h, g->V));
    DVI_TRY(factor(g, g->V));
    for (int j = 0; j < g->stages; j++)
      DVI_TRY(dvi__schroedinger_potential(g->s, t + g->node[j] * g->h, g->V + j * g->s->points));
  }
  DVI_TRY(dvi__gauss_solve_stages(g, t, z));
  for (int64_t i = 0; i < n; i++) {
    double change = 0, rest = 0;
    for (int j = 0; j < g->stages; j++) {
      change += g->d[j] * g->Z[j * n + i];
      rest += g->d_rest[j] * g->Z[j * n + i];
    }
    dvi__add_compensated(z + i, compensation + i, change);
    dvi__add_compensated(z + i, compensation + i, rest);
  }
  return DVI_OK;
}
