/* The first guess, which continues the last step beyond its end. */
#include <math.h>

#include "step/element/action_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/cholesky.h"
#include "num/simd/lanes.h"
#include "space/legendre.h"
#include "space/trial.h"

/* Largest degree that is continued. Continuing a polynomial of degree d one step further multiplies
 * rounding errors by about 6^d and gains little beyond this degree. */
enum { CONTINUED_DEGREE = 10 };

/* Find the table for this ratio. If it is not known, the oldest one is to be filled. */
static double *table_for(dvi__shifts *shifts, size_t size, double ratio, int *known)
{
  for (size_t k = 0; k < DVI__SHIFTS; k++)
    if (shifts->ratio[k] == ratio) {
      *known = 1;
      return shifts->table + k * size;
    }
  const int place = shifts->oldest;
  *known = 0;
  shifts->ratio[place] = ratio;
  shifts->oldest = (place + 1) % DVI__SHIFTS;
  return shifts->table + (size_t)place * size;
}

/* ---- paths ---- */

static void fill_path_shift(const dvi__action *a, double ratio, double *shift)
{
  const size_t s = (size_t)a->s, lanes = (size_t)a->path_lanes;
  dvi__trial_shift(a->space.basis, a->s, a->s < CONTINUED_DEGREE ? a->s : CONTINUED_DEGREE, ratio,
                   a->shift_rows);
  for (size_t k = 0; k < s; k++)
    for (size_t l = 0; l < s; l++) shift[l * lanes + k] = a->shift_rows[k * s + l];
}

const double *dvi__action_path_shift(dvi__action *a, double ratio)
{
  int known;
  double *shift = table_for(&a->shift, (size_t)a->s * (size_t)a->path_lanes, ratio, &known);
  if (!known) fill_path_shift(a, ratio, shift);
  return shift;
}

void dvi__action_continue(dvi__action *a, double ratio, const double *last, double *Y)
{
  const size_t of_path = (size_t)a->n * (size_t)a->s;
  dvi__lanes_product(a->n, a->s, a->path_lanes, a->s, dvi__action_path_shift(a, ratio), last, Y);
  for (size_t k = 0; k < (size_t)a->terms.unknowns; k++) Y[of_path + k] = last[of_path + k];
}

/* ---- forces ---- */

/* A polynomial in the Legendre basis fitted to values at the nodes, evaluated at the nodes of the
 * next step,
 *
 *     value_j = sum_k b_k U_j.W_k value_k,    W_k = C^{-1} P(c_k),   U_j = C^{-1} P(1 + ratio c_j),
 *     C C^T = sum_k b_k P(c_k) P(c_k)^T. */
typedef long double continued[DVI_QUADRATURE_MAX][CONTINUED_DEGREE];

dvi_status dvi__action_prepare_continuation(dvi__action *a)
{
  long double difference[CONTINUED_DEGREE];
  const int terms = a->fit_terms = a->r < CONTINUED_DEGREE ? a->r : CONTINUED_DEGREE;
  long double *C = a->fit_factor = DVI_NEW(long double, terms *(terms + a->r));
  if (C == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d nodes", a->r);
  a->fit_nodes = C + terms * terms;
  for (int j = 0; j < a->r; j++) {
    long double *W = a->fit_nodes + j * terms;
    dvi__legendre(terms - 1, 1 - (long double)a->node[j], W, difference);
    for (int k = 0; k < terms; k++)
      for (int l = 0; l <= k; l++) C[k * terms + l] += a->weight[j] * W[k] * W[l];
  }
  dvi__cholesky(terms, C);
  for (int j = 0; j < a->r; j++) dvi__cholesky_half(terms, C, a->fit_nodes + j * terms);
  return DVI_OK;
}

static void continue_nodes(const dvi__action *a, double ratio, continued U)
{
  long double difference[CONTINUED_DEGREE];
  for (int j = 0; j < a->r; j++) {
    dvi__legendre(a->fit_terms - 1, -ratio * (long double)a->node[j], U[j], difference);
    dvi__cholesky_half(a->fit_terms, a->fit_factor, U[j]);
  }
}

/* Make the table from g of the last step to sum_j (c_i - P_ij) g_j of this one. With g_j = h b_j
 * L_q_j the weights b_k of the fit cancel. Those of a vector potential, which have no h, are the
 * second half of the columns. */
static void fill_force_shift(const dvi__action *a, continued U, int first, double ratio,
                             double *shift)
{
  const int lanes = a->fixed_point.lanes;
  for (int i = 0; i < a->fixed_point.stages; i++) {
    long double row[CONTINUED_DEGREE] = {0};
    for (int j = 0; j < a->r; j++)
      for (int m = 0; m < a->fit_terms; m++)
        row[m] += a->fixed_point.matrix[(first + j) * lanes + i] * ratio * a->weight[j] * U[j][m];
    for (int k = 0; k < a->r; k++) {
      long double sum = 0;
      for (int m = 0; m < a->fit_terms; m++) sum += row[m] * a->fit_nodes[k * a->fit_terms + m];
      shift[(first + k) * lanes + i] = (double)sum;
    }
  }
}

static void fill_force_shifts(const dvi__action *a, double ratio, double *shift)
{
  continued U;
  continue_nodes(a, ratio, U);
  fill_force_shift(a, U, 0, ratio, shift);
  if (a->fixed_point.stages > a->r) fill_force_shift(a, U, a->r, 1.0, shift);
}

const double *dvi__action_stage_shift(dvi__action *a, dvi__shifts *shifts, double ratio)
{
  int known;
  double *shift = table_for(shifts, (size_t)a->r * (size_t)a->lanes, ratio, &known);
  if (known) return shift;
  continued U;
  continue_nodes(a, ratio, U);
  for (int k = 0; k < a->r; k++)
    for (int j = 0; j < a->r; j++) {
      long double sum = 0;
      for (int m = 0; m < a->fit_terms; m++) sum += U[j][m] * a->fit_nodes[k * a->fit_terms + m];
      shift[k * a->lanes + j] = (double)(ratio * a->weight[j] * sum);
    }
  return shift;
}

const double *dvi__action_fixed_point_shift(dvi__action *a, double ratio)
{
  int known;
  const size_t size = (size_t)a->fixed_point.stages * (size_t)a->fixed_point.lanes;
  double *shift = table_for(&a->fixed_point.shift, size, ratio, &known);
  if (!known) fill_force_shifts(a, ratio, shift);
  return shift;
}
