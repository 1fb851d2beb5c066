#include "space/user_basis.h"

#include <math.h>
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "space/user_basis_struct.h"
#include "space/legendre.h"

static const long double least_part = 1e-8L;

/* ---- creation ---- */

/* Take an array of `count` numbers from the block of memory that is left. */
static double *take_array(double **left, size_t count)
{
  double *array = *left;
  *left += count;
  return array;
}

static void tables_lay_out(dvi__user_basis_tables *t, size_t points, size_t count, double **left)
{
  t->node = take_array(left, points);
  t->weight = take_array(left, points);
  t->psi = take_array(left, points * count);
  t->dpsi = take_array(left, points * count);
  t->end = take_array(left, count);
  t->slopes[0] = take_array(left, count);
  t->slopes[1] = take_array(left, count);
  t->lean = take_array(left, count);
}

static int user_basis_allocate(dvi__user_basis *g)
{
  const size_t points = (size_t)g->points, count = (size_t)g->count,
               functions = (size_t)g->shapes->functions;
  double *left = g->numbers = DVI_NEW(double, 2 * (2 * points * (1 + count) + 4 * count) +
                                                  2 * points + 2 * functions);
  long double *longs = g->long_numbers = DVI_NEW(long double, 2 * (count + count * count) +
                                                                  2 * points * count + 2 * count);
  if (left == NULL || longs == NULL) return 0;
  tables_lay_out(&g->now, points, count, &left);
  tables_lay_out(&g->spare, points, count, &left);
  g->node = take_array(&left, points);
  g->weight = take_array(&left, points);
  g->f = take_array(&left, functions);
  g->df = take_array(&left, functions);
  g->now.start = longs;
  g->spare.start = longs + count;
  g->now.matrix = longs + 2 * count;
  g->spare.matrix = g->now.matrix + count * count;
  g->value = g->spare.matrix + count * count;
  g->slope = g->value + points * count;
  g->at_value = g->slope + points * count;
  g->at_slope = g->at_value + count;
  return 1;
}

/* A space without a length of its own is the same at every h. */
static double length_of_tables(const dvi__user_basis *g, double h)
{
  return g->shapes->h != 0 ? h : 1;
}

static dvi_status user_basis_make(dvi__user_basis *g, dvi_rule rule)
{
  if (!user_basis_allocate(g))
    return dvi__fail(DVI_NO_MEMORY, "shapes %s: no memory", g->shapes->name);
  if (g->shapes->point == NULL) DVI_TRY(dvi_quadrature(rule, g->points, g->node, g->weight));
  DVI_TRY(dvi__user_basis_prepare(g, g->shapes->h));
  DVI_TRY(dvi__user_basis_check(g));
  g->order = g->now.order;
  g->symmetric = dvi__user_basis_mirrors(g);
  return DVI_OK;
}

dvi_status dvi__user_basis_create(const dvi_shapes *shapes, int degree, dvi_rule rule, int nodes,
                                  dvi__user_basis **basis)
{
  dvi__user_basis *g = *basis = DVI_NEW(dvi__user_basis, 1);
  if (g == NULL) return dvi__fail(DVI_NO_MEMORY, "shapes %s: no memory", shapes->name);
  g->shapes = shapes;
  g->degree = degree;
  g->count = degree + shapes->functions;
  g->points = shapes->point != NULL ? shapes->points : nodes;
  const dvi_status status = user_basis_make(g, rule);
  if (status != DVI_OK) dvi__user_basis_destroy(basis);
  return status;
}

void dvi__user_basis_destroy(dvi__user_basis **basis)
{
  if (*basis == NULL) return;
  dvi__release((*basis)->numbers);
  dvi__release((*basis)->long_numbers);
  dvi__release(*basis);
  *basis = NULL;
}

/* ---- the functions ---- */

static dvi_status check_answer(const dvi__user_basis *g, const char *callback, double h, int answer)
{
  if (answer == 0) return DVI_OK;
  return dvi__fail(answer > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                   "shapes %s: %s returned %d for a step of h = %.3g", g->shapes->name, callback,
                   answer, h);
}

/* Set the results to NaN, which marks numbers that a callback does not write. */
static void forget_answers(const dvi__user_basis *g)
{
  for (int i = 0; i < g->shapes->functions; i++) g->f[i] = g->df[i] = (double)NAN;
}

static dvi_status take_answers(const dvi__user_basis *g, const char *callback, double h, double tau)
{
  for (int i = 0; i < g->shapes->functions; i++) {
    if (!isfinite(g->f[i]) || !isfinite(g->df[i]))
      return dvi__fail(DVI_NOT_FINITE,
                       "shapes %s: %s gave %s[%d] = %g at tau = %.6g of a step of h = %.3g",
                       g->shapes->name, callback, isfinite(g->f[i]) ? "derivative" : "value", i,
                       isfinite(g->f[i]) ? g->df[i] : g->f[i], tau, h);
    g->at_value[g->degree + i] = (long double)g->f[i];
    g->at_slope[g->degree + i] = (long double)g->df[i];
  }
  return DVI_OK;
}

/* Compute tau, and the integrals of Legendre's polynomials from 0 on. */
static void evaluate_polynomials(const dvi__user_basis *g, double tau)
{
  long double P[DVI_SHAPES_MOST + 2], difference[DVI_SHAPES_MOST + 2];
  dvi__legendre(g->degree, 1 - (long double)tau, P, difference);
  g->at_value[0] = (long double)tau;
  g->at_slope[0] = 1;
  for (int k = 1; k < g->degree; k++) {
    g->at_value[k] = (P[k + 1] - P[k - 1]) / (long double)(4 * k + 2);
    g->at_slope[k] = P[k];
  }
}

dvi_status dvi__user_basis_evaluate(const dvi__user_basis *g, double h, double tau)
{
  evaluate_polynomials(g, tau);
  forget_answers(g);
  DVI_TRY(
      check_answer(g, "evaluate", h, g->shapes->evaluate(h, tau, g->f, g->df, g->shapes->user)));
  return take_answers(g, "evaluate", h, tau);
}

/* ---- at the points ---- */

static dvi_status ask_point(const dvi__user_basis *g, double h, int j, double *node, double *weight)
{
  *node = *weight = (double)NAN;
  forget_answers(g);
  DVI_TRY(check_answer(g, "point", h,
                       g->shapes->point(h, j, node, weight, g->f, g->df, g->shapes->user)));
  if (!(*node >= 0 && *node <= 1))
    return dvi__fail(
        isfinite(*node) ? DVI_BAD_ARGUMENT : DVI_NOT_FINITE,
        "shapes %s: point %d is at tau = %g of a step of h = %.3g; 0 to 1 are possible",
        g->shapes->name, j, *node, h);
  if (!isfinite(*weight))
    return dvi__fail(DVI_NOT_FINITE, "shapes %s: point %d has the weight %g for a step of h = %.3g",
                     g->shapes->name, j, *weight, h);
  evaluate_polynomials(g, *node);
  return take_answers(g, "point", h, *node);
}

static dvi_status ask_points(const dvi__user_basis *g, double h, const dvi__user_basis_tables *t)
{
  double sum = 0;
  for (int j = 0; j < g->points; j++) {
    t->node[j] = g->node[j];
    t->weight[j] = g->weight[j];
    DVI_TRY(g->shapes->point != NULL ? ask_point(g, h, j, &t->node[j], &t->weight[j])
                                     : dvi__user_basis_evaluate(g, h, t->node[j]));
    sum += t->weight[j];
    for (int k = 0; k < g->count; k++) {
      g->value[k * g->points + j] = g->at_value[k] - t->start[k];
      g->slope[k * g->points + j] = g->at_slope[k];
    }
  }
  if (fabs(sum - 1) <= 1e-12) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "shapes %s: the weights sum to %.15g for a step of h = %.3g; they must sum to 1",
                   g->shapes->name, sum, h);
}

static void fingerprint_add(double number, dvi__user_basis_fingerprint *to)
{
  const double part = dvi__weight(to->count++) * number;
  to->sum += part;
  to->size += fabs(part);
}

/* Sum up the user's numbers as they are. An orthonormal basis would amplify the different rounding
 * of other machines. */
static void fingerprint_points(const dvi__user_basis *g, dvi__user_basis_tables *t)
{
  t->fingerprint = (dvi__user_basis_fingerprint){0};
  for (int j = 0; j < g->points; j++) {
    fingerprint_add(t->node[j], &t->fingerprint);
    fingerprint_add(t->weight[j], &t->fingerprint);
  }
  for (int e = g->degree * g->points; e < g->count * g->points; e++) {
    fingerprint_add((double)g->value[e], &t->fingerprint);
    fingerprint_add((double)g->slope[e], &t->fingerprint);
  }
}

/* ---- an orthonormal basis ---- */

static long double user_basis_inner(const dvi__user_basis *g, const dvi__user_basis_tables *t,
                                    int k, int l)
{
  const long double *a = g->slope + k * g->points, *b = g->slope + l * g->points;
  long double sum = 0;
  for (int j = 0; j < g->points; j++) sum += dvi__user_basis_measure(g, t, j, l) * a[j] * b[j];
  return sum;
}

static void multiply_function(const dvi__user_basis *g, const dvi__user_basis_tables *t, int k,
                              long double factor)
{
  for (int j = k * g->points; j < (k + 1) * g->points; j++) {
    g->value[j] *= factor;
    g->slope[j] *= factor;
  }
  for (int i = 0; i <= k; i++) t->matrix[k * g->count + i] *= factor;
}

static void subtract_function(const dvi__user_basis *g, const dvi__user_basis_tables *t, int k,
                              long double factor, int l)
{
  for (int j = 0; j < g->points; j++) {
    g->value[k * g->points + j] -= factor * g->value[l * g->points + j];
    g->slope[k * g->points + j] -= factor * g->slope[l * g->points + j];
  }
  for (int i = 0; i <= l; i++) t->matrix[k * g->count + i] -= factor * t->matrix[l * g->count + i];
}

/* Orthonormalise the derivatives by Gram and Schmidt, each function three times. The first function
 * tau stays as it is, because the weights sum to 1. */
static void orthogonalize_functions(const dvi__user_basis *g, const dvi__user_basis_tables *t)
{
  memset(t->matrix, 0, (size_t)g->count * (size_t)g->count * sizeof *t->matrix);
  for (int k = 0; k < g->count; k++) {
    const long double size = user_basis_inner(g, t, k, k);
    t->matrix[k * g->count + k] = 1;
    for (int pass = 0; pass < 3; pass++)
      for (int l = 0; l < k; l++) subtract_function(g, t, k, user_basis_inner(g, t, k, l), l);
    const long double left = user_basis_inner(g, t, k, k);
    if (k > 0)
      multiply_function(g, t, k, left > least_part * least_part * size ? 1 / sqrtl(left) : 0);
  }
}

/* Store the final derivatives at the points. */
static void write_slopes(const dvi__user_basis *g, const dvi__user_basis_tables *t)
{
  for (int k = 0; k < g->count; k++) {
    long double lean = 0;
    for (int j = 0; j < g->points; j++) {
      t->dpsi[j * g->count + k] = (double)g->slope[k * g->points + j];
      lean += dvi__user_basis_measure(g, t, j, k) * g->slope[k * g->points + j] *
              (long double)t->node[j];
    }
    t->lean[k] = (double)lean;
  }
}

/* Find the order of the quadrature, as far as the polynomials need it. */
static int order_of_points(const dvi__user_basis *g, const dvi__user_basis_tables *t)
{
  for (int power = 0; power < 2 * g->degree; power++) {
    double sum = 0;
    for (int j = 0; j < g->points; j++) sum += t->weight[j] * pow(t->node[j], power);
    if (fabs(sum - 1.0 / (power + 1)) > 1e-12) return power;
  }
  return 2 * g->degree;
}

/* Compute psi_k(1) from the e_k(1) in at_value. */
static long double value_at_end(const dvi__user_basis *g, const dvi__user_basis_tables *t, int k)
{
  long double sum = 0;
  for (int i = 0; i <= k; i++) sum += t->matrix[k * g->count + i] * (g->at_value[i] - t->start[i]);
  return sum;
}

/* Compute sum_j b_j psi_k psi_l'. */
static long double mixed_product(const dvi__user_basis *g, const dvi__user_basis_tables *t, int k,
                                 int l)
{
  long double sum = 0;
  for (int j = 0; j < g->points; j++)
    sum += (long double)t->weight[j] * g->value[k * g->points + j] * g->slope[l * g->points + j];
  return sum;
}

/* Correct the values of function k. A stationary path of polynomials must stay stationary, or there
 * is no order. This needs sum_j b_j (psi_k f)' = psi_k(1) f(1) for f of degree less than d and
 * every function. The integrals of derivatives are 0 already. The quadrature's error in the other
 * integrals is subtracted from the values as a polynomial of degree d. The correction is as small
 * as that error, and 0 where functions are integrated exactly. psi_m meets psi_{m-1}' and
 * psi_{m+1}' alone, so one is corrected after the other. */
static void match_polynomials(const dvi__user_basis *g, const dvi__user_basis_tables *t, int k)
{
  for (int m = 0; m < g->degree && 2 * m < t->order; m++) {
    const long double part = m == 0 ? value_at_end(g, t, k)
                                    : mixed_product(g, t, k, m - 1) / mixed_product(g, t, m, m - 1);
    for (int j = 0; j < g->points; j++)
      g->value[k * g->points + j] -= part * g->value[m * g->points + j];
    for (int i = 0; i <= m; i++) t->matrix[k * g->count + i] -= part * t->matrix[m * g->count + i];
  }
}

static void write_values(const dvi__user_basis *g, const dvi__user_basis_tables *t)
{
  for (int k = 0; k < g->count; k++) {
    if (k >= g->degree && t->matrix[k * g->count + k] != 0) match_polynomials(g, t, k);
    for (int j = 0; j < g->points; j++)
      t->psi[j * g->count + k] = (double)g->value[k * g->points + j];
  }
}

/* Compute psi_k and psi_k' [count] at tau. dpsi may be NULL. */
static dvi_status evaluate_basis(const dvi__user_basis *g, const dvi__user_basis_tables *t,
                                 double tau, double *psi, double *dpsi)
{
  DVI_TRY(dvi__user_basis_evaluate(g, t->h, tau));
  for (int k = 0; k < g->count; k++) {
    const long double *row = t->matrix + k * g->count;
    long double value = 0, slope = 0;
    for (int i = 0; i <= k; i++) {
      value += row[i] * (g->at_value[i] - t->start[i]);
      slope += row[i] * g->at_slope[i];
    }
    psi[k] = (double)value;
    if (dpsi != NULL) dpsi[k] = (double)slope;
  }
  return DVI_OK;
}

dvi_status dvi__user_basis_fill(const dvi__user_basis *g, double h, dvi__user_basis_tables *t)
{
  t->h = length_of_tables(g, h);
  DVI_TRY(dvi__user_basis_evaluate(g, t->h, 0));
  memcpy(t->start, g->at_value, (size_t)g->count * sizeof *t->start);
  DVI_TRY(ask_points(g, t->h, t));
  fingerprint_points(g, t);
  t->order = order_of_points(g, t);
  orthogonalize_functions(g, t);
  write_slopes(g, t);
  DVI_TRY(dvi__user_basis_evaluate(g, t->h, 1));
  for (int k = g->degree; k < g->count; k++)
    fingerprint_add((double)(g->at_value[k] - t->start[k]), &t->fingerprint);
  write_values(g, t);
  DVI_TRY(evaluate_basis(g, t, 0, t->end, t->slopes[0]));
  return evaluate_basis(g, t, 1, t->end, t->slopes[1]);
}

dvi_status dvi__user_basis_prepare(dvi__user_basis *g, double h)
{
  if (g->now.h == length_of_tables(g, h)) return DVI_OK;
  DVI_TRY(dvi__user_basis_fill(g, h, &g->spare));
  const dvi__user_basis_tables before = g->now;
  g->now = g->spare;
  g->spare = before;
  return DVI_OK;
}

/* ---- the space as shapes ---- */

/* The method has prepared this length, when a failure could be reported. A callback that now fails
 * or answers otherwise marks the space as broken. */
static void user_basis_set(void *of, double h)
{
  dvi__user_basis *g = of;
  g->broken = dvi__user_basis_prepare(g, h) != DVI_OK;
}

static void user_basis_point(const void *of, int j, double *tau, double *weight, double *psi,
                             double *dpsi)
{
  const dvi__user_basis *g = of;
  *tau = g->now.node[j];
  *weight = g->broken ? (double)NAN : g->now.weight[j];
  memcpy(psi, g->now.psi + j * g->count, (size_t)g->count * sizeof *psi);
  memcpy(dpsi, g->now.dpsi + j * g->count, (size_t)g->count * sizeof *dpsi);
}

/* Evaluate at tau, which rounding may move beyond the ends of a step. NaN reports a failed
 * callback. */
static void user_basis_path(const void *of, double tau, double *psi, double *dpsi)
{
  const dvi__user_basis *g = of;
  if (!g->broken && evaluate_basis(g, &g->now, fmin(1, fmax(0, tau)), psi, dpsi) == DVI_OK) return;
  for (int k = 0; k < g->count; k++) {
    psi[k] = (double)NAN;
    if (dpsi != NULL) dpsi[k] = (double)NAN;
  }
}

static int user_basis_present(const void *of, int k)
{
  const dvi__user_basis *g = of;
  return g->now.matrix[k * g->count + k] != 0;
}

static double dot_functions(int count, const double *a, const double *b)
{
  double sum = 0;
  for (int k = 0; k < count; k++) sum += a[k] * b[k];
  return sum;
}

/* Continue the velocities beyond the end, where nothing else of the path is known. They change as
 * they changed from one end to the other. */
static void user_basis_next(const void *of, const double *last, double *Y)
{
  const dvi__user_basis *g = of;
  const double first = dot_functions(g->count, g->now.slopes[0], last),
               end = dot_functions(g->count, g->now.slopes[1], last);
  for (int k = 0; k < g->count; k++) Y[k] = (k == 0 ? end : 0) + g->now.lean[k] * (end - first);
}

dvi__shapes dvi__user_basis_shapes(dvi__user_basis *basis)
{
  return (dvi__shapes){.functions = basis->count,
                       .points = basis->points,
                       .of = basis,
                       .set = user_basis_set,
                       .point = user_basis_point,
                       .path = user_basis_path,
                       .present = user_basis_present,
                       .next = user_basis_next};
}

int dvi__user_basis_symmetric(const dvi__user_basis *basis)
{
  return basis->symmetric;
}

int dvi__user_basis_quadrature_order(const dvi__user_basis *basis)
{
  return basis->order;
}

dvi__user_basis_fingerprint dvi__user_basis_fingerprint_of(const dvi__user_basis *basis)
{
  return basis->now.fingerprint;
}
