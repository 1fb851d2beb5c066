#include "space/oscillating.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "space/basis.h"
#include "space/filon.h"
#include "space/legendre.h"
#include "space/quadrature.h"

/* An oscillation that the points resolve is a sum of TERMS Legendre polynomials. The grid
 * integrates all of their products exactly. */
enum { FUNCTIONS = DVI__OSCILLATING_FUNCTIONS, GRID = 64, TERMS = 48 };

/* A Lagrangian that is quadratic in the oscillation has twice its harmonics. */
enum { POINTS = DVI__FILON_NODES_MOST * (2 * DVI__FILON_HARMONICS_MOST + 1) };

static const long double least_part = 1e-8L;

/* Beyond this h omega of the last harmonic the functions are far from dependent, and the grid does
 * not resolve them. */
static const long double orthogonal_up_to = 30;

struct dvi__oscillating {
  int degree, amplitude, harmonics, nodes, functions;
  long double omega, nu;
  dvi__space legendre;
  int on_path; /* the points are Gauss nodes on the path */
  long double node[POINTS], weight[POINTS];
  long double grid[GRID], grid_weight[GRID], on_grid[FUNCTIONS][GRID];
  long double matrix[FUNCTIONS][FUNCTIONS]; /* psi_k = sum_i matrix[k][i] (f_i - f_i(0)), i <= k */
  long double start[FUNCTIONS];             /* f_i(0) */
  /* On the path, where the points are, psi_k' = sum_i term[k][i] P_i. */
  long double term[FUNCTIONS][TERMS];
  double next[FUNCTIONS][FUNCTIONS];
};

/* Return the harmonic of a sine or cosine P_i. Amplitude w is P_w of the first harmonic, up to the
 * degree of the amplitudes, and then P_0 of the second one. */
static int harmonic_of(const dvi__oscillating *o, int oscillation)
{
  return oscillation <= o->amplitude ? 1 : oscillation - o->amplitude + 1;
}

static int power_of(const dvi__oscillating *o, int oscillation)
{
  return oscillation <= o->amplitude ? oscillation : 0;
}

/* Evaluate f_i and its derivative along the path, for the phase phi at tau. The order of the f_i is
 * P_1 to P_degree, then P_0 sin, P_0 cos, P_1 sin ..., sin 2, cos 2. */
static void oscillating_evaluate(const dvi__oscillating *o, long double tau, long double phi,
                                 long double *value, long double *slope)
{
  long double P[DVI__TRIAL_MAX], dP[DVI__TRIAL_MAX];
  dvi__space_evaluate(&o->legendre, tau, P, dP);
  for (int k = 0; k < o->degree; k++) value[k] = P[k + 1], slope[k] = dP[k + 1];
  for (int k = o->degree; k < o->functions; k += 2) {
    const int oscillation = (k - o->degree) / 2, i = power_of(o, oscillation);
    const long double times = harmonic_of(o, oscillation), sine = sinl(times * phi),
                      cosine = cosl(times * phi);
    value[k] = P[i] * sine;
    slope[k] = dP[i] * sine + times * o->nu * P[i] * cosine;
    value[k + 1] = P[i] * cosine;
    slope[k + 1] = dP[i] * cosine - times * o->nu * P[i] * sine;
  }
}

/* ---- the functions ---- */

static long double oscillating_inner(const dvi__oscillating *o, int k, int l)
{
  long double sum = 0;
  for (int g = 0; g < GRID; g++) sum += o->grid_weight[g] * o->on_grid[k][g] * o->on_grid[l][g];
  return sum;
}

static void multiply_polynomials(dvi__oscillating *o, int k, long double factor)
{
  for (int g = 0; g < GRID; g++) o->on_grid[k][g] *= factor;
  for (int i = 0; i <= k; i++) o->matrix[k][i] *= factor;
}

static void subtract_oscillation(dvi__oscillating *o, int k, long double factor, int l)
{
  for (int g = 0; g < GRID; g++) o->on_grid[k][g] -= factor * o->on_grid[l][g];
  for (int i = 0; i <= l; i++) o->matrix[k][i] -= factor * o->matrix[l][i];
}

/* Orthonormalise the derivatives by Gram and Schmidt, each function three times. */
static void orthogonalize_oscillations(dvi__oscillating *o)
{
  long double value[FUNCTIONS], slope[FUNCTIONS];
  for (int g = 0; g < GRID; g++) {
    oscillating_evaluate(o, o->grid[g], o->nu * (o->grid[g] - 0.5L), value, slope);
    for (int k = 0; k < o->functions; k++) o->on_grid[k][g] = slope[k];
  }
  for (int k = 0; k < o->functions; k++) {
    const long double size = sqrtl(oscillating_inner(o, k, k));
    for (int pass = 0; pass < 3; pass++)
      for (int l = 0; l < k; l++) subtract_oscillation(o, k, oscillating_inner(o, k, l), l);
    const long double left = sqrtl(oscillating_inner(o, k, k));
    multiply_polynomials(o, k, left > least_part * size ? 1 / left : 0);
  }
}

static void make_functions(dvi__oscillating *o)
{
  memset(o->matrix, 0, sizeof o->matrix);
  for (int k = 0; k < o->functions; k++) o->matrix[k][k] = 1;
  if (o->harmonics * fabsl(o->nu) <= orthogonal_up_to)
    orthogonalize_oscillations(o);
  else
    for (int k = 0; k < o->functions; k++)
      o->matrix[k][k] = k < o->degree ? 0.5L : 1 / (harmonic_of(o, (k - o->degree) / 2) * o->nu);
}

/* Expand psi_k in Legendre polynomials. Where sin and cos are nearly polynomials, psi_k from the
 * f_i would be a small difference of large numbers. */
static void expand_in_legendre(dvi__oscillating *o)
{
  long double P[TERMS], difference[TERMS];
  memset(o->term, 0, sizeof o->term);
  for (int g = 0; g < GRID; g++) {
    dvi__legendre(TERMS - 1, 1 - o->grid[g], P, difference);
    for (int k = 0; k < o->functions; k++)
      for (int i = 0; i < TERMS; i++)
        o->term[k][i] += o->grid_weight[g] * (long double)(2 * i + 1) * P[i] * o->on_grid[k][g];
  }
}

static void resolved_at(const dvi__oscillating *o, long double tau, double *psi, double *dpsi)
{
  long double P[TERMS + 1], difference[TERMS + 1];
  dvi__legendre(TERMS, 1 - tau, P, difference);
  for (int k = 0; k < o->functions; k++) {
    long double value = o->term[k][0] * tau, slope = o->term[k][0];
    for (int i = 1; i < TERMS; i++) {
      value += o->term[k][i] * (P[i + 1] - P[i - 1]) / (long double)(4 * i + 2);
      slope += o->term[k][i] * P[i];
    }
    psi[k] = (double)value;
    if (dpsi != NULL) dpsi[k] = (double)slope;
  }
}

static int oscillating_present(const void *of, int k)
{
  const dvi__oscillating *o = of;
  return o->matrix[k][k] != 0;
}

static void oscillating_at(const dvi__oscillating *o, long double tau, long double phi, double *psi,
                           double *dpsi)
{
  long double value[FUNCTIONS] = {0}, slope[FUNCTIONS] = {0};
  oscillating_evaluate(o, tau, phi, value, slope);
  for (int k = 0; k < o->functions; k++) {
    long double sum[2] = {0, 0};
    for (int i = 0; i <= k; i++) {
      sum[0] += o->matrix[k][i] * (value[i] - o->start[i]);
      sum[1] += o->matrix[k][i] * slope[i];
    }
    psi[k] = (double)sum[0];
    if (dpsi != NULL) dpsi[k] = (double)sum[1];
  }
}

/* ---- continuation of the last path, by amplitude polynomials and phases nu ---- */

/* Compute shift with P_k(tau + 1) = sum_i shift[i][k] P_i(tau). */
static void shift_polynomials(const dvi__oscillating *o,
                              long double shift[DVI__TRIAL_MAX][DVI__TRIAL_MAX])
{
  long double here[DVI__TRIAL_MAX], beyond[DVI__TRIAL_MAX];
  memset(shift, 0, DVI__TRIAL_MAX * sizeof *shift);
  for (int g = 0; g < GRID; g++) {
    dvi__space_evaluate(&o->legendre, o->grid[g], here, NULL);
    dvi__space_evaluate(&o->legendre, o->grid[g] + 1, beyond, NULL);
    for (int k = 0; k <= o->degree; k++)
      for (int i = 0; i <= k; i++)
        shift[i][k] += o->grid_weight[g] * (long double)(2 * i + 1) * here[i] * beyond[k];
  }
}

/* Write f of the previous step, at tau + 1, as a combination [FUNCTIONS] of the f at tau, without
 * the constant. */
static void shift_function(const dvi__oscillating *o,
                           long double shift[DVI__TRIAL_MAX][DVI__TRIAL_MAX], int k,
                           long double factor, long double *f)
{
  if (k < o->degree) {
    for (int i = 1; i <= k + 1; i++) f[i - 1] += factor * shift[i][k + 1];
    return;
  }
  const int oscillation = (k - o->degree) / 2, is_cosine = (k - o->degree) % 2,
            p = power_of(o, oscillation);
  const long double turn = harmonic_of(o, oscillation) * o->nu;
  const long double by_sine = is_cosine ? -sinl(turn) : cosl(turn),
                    by_cosine = is_cosine ? cosl(turn) : sinl(turn);
  for (int i = 0; i <= p; i++) {
    const int sine = o->degree + 2 * (oscillation - p + i);
    f[sine] += factor * shift[i][p] * by_sine;
    f[sine + 1] += factor * shift[i][p] * by_cosine;
  }
}

/* Solve sum_k Y_k matrix[k][i] = f_i for the coefficients of the psi. */
static void solve_coefficients(const dvi__oscillating *o, long double *f)
{
  for (int k = o->functions - 1; k >= 0; k--) {
    f[k] = oscillating_present(o, k) ? f[k] / o->matrix[k][k] : 0;
    for (int i = 0; i < k; i++) f[i] -= f[k] * o->matrix[k][i];
  }
}

static void make_next(dvi__oscillating *o)
{
  long double shift[DVI__TRIAL_MAX][DVI__TRIAL_MAX];
  shift_polynomials(o, shift);
  for (int l = 0; l < o->functions; l++) {
    long double f[FUNCTIONS] = {0};
    for (int k = 0; k <= l; k++) shift_function(o, shift, k, o->matrix[l][k], f);
    solve_coefficients(o, f);
    for (int k = 0; k < o->functions; k++) o->next[k][l] = (double)f[k];
  }
}

static void oscillating_next(const void *of, const double *last, double *Y)
{
  const dvi__oscillating *o = of;
  for (int k = 0; k < o->functions; k++) {
    Y[k] = 0;
    for (int l = 0; l < o->functions; l++) Y[k] += o->next[k][l] * last[l];
  }
}

/* ---- shapes ---- */

static int phase_count(const dvi__oscillating *o)
{
  return 4 * o->harmonics + 1;
}

static int point_count(const dvi__oscillating *o)
{
  return o->nodes * phase_count(o);
}

/* Products of two oscillations are exact but for rounding up to here. For e^{iax} on [-1,1], a = nu
 * for the first harmonic's square, Gauss's rule misses the terms beyond Taylor's term of degree
 * k = 2 points - 2 degree, about (e a/2k)^k. */
double dvi__oscillating_resolved(const dvi__oscillating *space)
{
  const double k = 2 * (point_count(space) - space->degree);
  return fmin(2 * k / exp(1) * pow(1e-14, 1 / k), (double)orthogonal_up_to) / space->harmonics;
}

static void set_rule(dvi__oscillating *o)
{
  o->on_path = fabsl(o->nu) <= (long double)dvi__oscillating_resolved(o);
  if (o->on_path)
    (void)dvi__quadrature_long(DVI_GAUSS, point_count(o), o->node, o->weight);
  else
    dvi__filon_rule(o->nodes, 2 * o->harmonics, o->nu, o->node, o->weight);
}

static void oscillating_set(void *of, double h)
{
  dvi__oscillating *o = of;
  long double slope[FUNCTIONS];
  o->nu = o->omega * (long double)h;
  set_rule(o);
  oscillating_evaluate(o, 0, -0.5L * o->nu, o->start, slope);
  make_functions(o);
  if (o->on_path) expand_in_legendre(o);
  make_next(o);
}

static void oscillating_point(const void *of, int j, double *tau, double *weight, double *psi,
                              double *dpsi)
{
  const dvi__oscillating *o = of;
  const int count = o->on_path ? 1 : phase_count(o), sample = j % count;
  const long double node = o->node[j / count], turn = 8 * atanl(1);
  *tau = (double)node;
  *weight = (double)o->weight[j];
  if (o->on_path)
    resolved_at(o, node, psi, dpsi);
  else
    oscillating_at(o, node, o->nu * (node - 0.5L) + turn * (long double)sample / (long double)count,
                   psi, dpsi);
}

static void oscillating_path(const void *of, double tau, double *psi, double *dpsi)
{
  const dvi__oscillating *o = of;
  if (o->on_path)
    resolved_at(o, (long double)tau, psi, dpsi);
  else
    oscillating_at(o, (long double)tau, o->nu * ((long double)tau - 0.5L), psi, dpsi);
}

dvi__oscillating *dvi__oscillating_create(int degree, int amplitude, int harmonics, double omega)
{
  dvi__oscillating *o = DVI_NEW(dvi__oscillating, 1);
  if (o == NULL) return NULL;
  o->degree = degree;
  o->amplitude = amplitude;
  o->harmonics = harmonics;
  o->nodes = degree + 1 + (amplitude > 0);
  o->functions = degree + 2 * (amplitude + harmonics);
  o->omega = (long double)omega;
  dvi__space_init(&o->legendre, DVI_LEGENDRE, degree);
  (void)dvi__quadrature_long(DVI_GAUSS, GRID, o->grid, o->grid_weight);
  return o;
}

void dvi__oscillating_destroy(dvi__oscillating **space)
{
  dvi__release(*space);
  *space = NULL;
}

void dvi__oscillating_tune(dvi__oscillating *space, double omega)
{
  space->omega = (long double)omega;
}

dvi__shapes dvi__oscillating_shapes(dvi__oscillating *space)
{
  return (dvi__shapes){.functions = space->functions,
                       .points = point_count(space),
                       .of = space,
                       .set = oscillating_set,
                       .point = oscillating_point,
                       .path = oscillating_path,
                       .present = oscillating_present,
                       .next = oscillating_next};
}
