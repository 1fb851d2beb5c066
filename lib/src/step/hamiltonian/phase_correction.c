/* Simplified Newton's method for an element on phase space. With the derivatives at the guess, S of
 * the vector field and G of the constraints, a correction solves
 *
 *     dW = r_W + S A dW + X_phi dLambda,            sum_i b_i P_l(c_i) G A dW = r_moment,
 *     dD = r_D + S dD/2 + X_phi dmu/2 + sum_i b_i dW_i,            G dD = r_end,
 *
 * where S is of the size of the step. Sweeps over S dW and S dD leave two small matrices,
 * sum_ij b_i P_l(c_i) a_ij P_l'(c_j) G_i X_phi_j of the moments and G X_phi/2 of the end. */
#include <string.h>

#include "step/hamiltonian/rows.h"
#include "step/hamiltonian/phase_struct.h"
#include "core/status.h"
#include "num/simd/small_inverse.h"
#include "num/simd/wide.h"

/* Sweeps over the stages, and over the end. A residual costs as much as two or three of them. */
enum { SWEEPS = 2, END_SWEEPS = 1 };

/* ---- matrices of the guess ---- */

/* Spread the gradients of a point, whose numbers are `stride` apart, and those of the field. */
static void spread_gradients(const dvi__phase_element *f, const double *phi_z, int stride,
                             double *gradient, double *field)
{
  const dvi__pattern *gradients = &f->system->constraint->gradients;
  const int z = 2 * f->n;
  for (int a = 0; a < f->m; a++)
    for (int e = gradients->start[a]; e < gradients->start[a + 1]; e++) {
      const int row = gradients->row[e];
      gradient[(a * z + row) * stride] = phi_z[e];
      if (row < f->n)
        field[(a * z + f->n + row) * stride] = -phi_z[e];
      else
        field[(a * z + row - f->n) * stride] = phi_z[e];
    }
}

INLINE void fill_moments(const dvi__phase_element *f, const dvi__phase_iteration *own, int lanes)
{
  const int z = 2 * f->n, d = f->d, k = f->k, m = f->m;
  double dot[2 * BLOCK];
  for (int b = 0; b < m * k; b++) {
    double *moved = own->moved + b * z * lanes;
    for (int c = 0; c < z; c++)
      row_product(d, lanes, own->a_moment + b % k * d * lanes, own->field + (b / k * z + c) * lanes,
                  moved + c * lanes);
    for (int a = 0; a < m; a++) {
      derivative_along(z, lanes, own->gradient + a * z * lanes, moved, dot);
      for (int l = 0; l < k; l++)
        own->moments[(a * k + l) * m * k + b] = sum_of_products(d, own->moment + l * lanes, dot);
    }
  }
}

WIDE static void fill_moments_of(const dvi__phase_element *f)
{
  const dvi__phase_iteration own = f->iteration; /* stores do not alias a copy */
  if (own.lanes == BLOCK)
    fill_moments(f, &own, BLOCK);
  else
    fill_moments(f, &own, 2 * BLOCK);
}

static void fill_end(const dvi__phase_element *f, const dvi__phase_iteration *own)
{
  const int z = 2 * f->n, m = f->m;
  for (int a = 0; a < m; a++)
    for (int b = 0; b < m; b++)
      own->end[a * m + b] = 0.5 *
                            sum_of_products(z, own->end_gradient + a * z, own->end_field + b * z);
}

dvi_status dvi__phase_freeze(dvi__phase_element *f)
{
  dvi__phase_iteration *own = &f->iteration;
  const size_t entries = (size_t)dvi__pattern_entries(&f->joint);
  const int gradients = dvi__pattern_entries(&f->system->constraint->gradients);
  DVI_TRY(dvi__phase_slopes(f, own->multipliers));
  for (int i = 0; i < f->d; i++) {
    const double *slope = f->slope + (size_t)i * entries;
    for (int e = 0; e < own->entries; e++) own->slope[e * own->lanes + i] = slope[own->entry[e]];
    if (f->k > 0)
      spread_gradients(f, f->phi_z + i * gradients, own->lanes, own->gradient + i, own->field + i);
  }
  for (int e = 0; e < own->entries; e++)
    own->end_slope[e] = 0.5 * f->slope[(size_t)f->d * entries + (size_t)own->entry[e]];
  spread_gradients(f, f->phi_z + f->d * gradients, 1, own->end_gradient, own->end_field);
  fill_end(f, own);
  if (f->k > 0) fill_moments_of(f);
  /* a product with an inverse of a few rows costs less than a solution */
  if (dvi__small_invert(f->m, own->end) == 0 || dvi__small_invert(f->m * f->k, own->moments) == 0)
    return dvi__fail(DVI_NOT_CONVERGED, "a frozen matrix cannot be inverted");
  own->is_frozen = 1;
  return DVI_OK;
}

/* ---- corrections ---- */

/* Set base to r_W + S there, where `there` is A dW. */
INLINE void set_base(const dvi__phase_iteration *own, int z, int lanes)
{
  for (int i = 0; i < z * lanes; i += BLOCK) memcpy(own->base + i, own->of_W + i, sizeof(block));
  for (int e = 0; e < own->entries; e++)
    add_row(lanes, own->slope + e * lanes, own->there + own->column[e] * lanes,
            own->base + own->row[e] * lanes);
}

/* Find the multipliers with which dW = base + X_phi dLambda fulfils the equations of the moments.
 * `there` is A base. */
INLINE void set_multipliers(const dvi__phase_element *f, const dvi__phase_iteration *own, int lanes)
{
  const int z = 2 * f->n, k = f->k, count = f->m * f->k;
  double dot[2 * BLOCK], left[DVI__PHASE_ROWS_MOST] = {0};
  for (int a = 0; a < f->m; a++) {
    derivative_along(z, lanes, own->gradient + a * z * lanes, own->there, dot);
    for (int l = 0; l < k; l++)
      left[a * k + l] = own->of_moment[a * k + l] -
                        sum_of_products(f->d, own->moment + l * lanes, dot);
  }
  for (int b = 0; b < count; b++)
    own->multiplier[b] = sum_of_products(count, own->moments + b * count, left);
}

/* Replace the residual of W and that of the moments by their corrections. */
INLINE void correct_stages(const dvi__phase_element *f, const dvi__phase_iteration *own, int lanes)
{
  const int z = 2 * f->n, k = f->k, count = f->m * k;
  for (int sweep = 0; sweep <= SWEEPS; sweep++) {
    if (sweep > 0) set_base(own, z, lanes);
    if (k == 0 && sweep == SWEEPS) break;
    const double *base = sweep > 0 ? own->base : own->of_W;
    for (int c = 0; c < z; c++)
      row_product(f->d, lanes, own->a, base + c * lanes, own->there + c * lanes);
    if (k == 0) continue;
    set_multipliers(f, own, lanes);
    for (int c = 0; sweep < SWEEPS && c < z; c++)
      add_rows(count, lanes, own->multiplier, own->moved + c * lanes, z * lanes,
               own->there + c * lanes);
  }
  for (int a = 0; a < f->m && k > 0; a++) {
    double at_stage[2 * BLOCK] = {0};
    add_rows(k, lanes, own->multiplier + a * k, own->legendre, lanes, at_stage);
    for (int c = 0; c < z; c++)
      add_row(lanes, own->field + (a * z + c) * lanes, at_stage, own->base + c * lanes);
  }
  memcpy(own->of_W, own->base, (size_t)(z * lanes) * sizeof(double));
  memcpy(own->of_moment, own->multiplier, (size_t)count * sizeof(double));
}

WIDE static void correct_stages_of(const dvi__phase_element *f)
{
  const dvi__phase_iteration own = f->iteration; /* stores do not alias a copy */
  if (own.lanes == BLOCK)
    correct_stages(f, &own, BLOCK);
  else
    correct_stages(f, &own, 2 * BLOCK);
}

/* Replace the residual of D and that of the end by their corrections, after those of W. */
static void correct_end(const dvi__phase_element *f)
{
  const dvi__phase_iteration own = f->iteration;
  const int z = 2 * f->n, m = f->m;
  double *base = own.base, *D = own.there, left[DVI__PHASE_ROWS_MOST] = {0};
  for (int c = 0; c < z; c++) own.of_D[c] += sum_of_products(f->d, f->b, own.of_W + c * own.lanes);
  for (int sweep = 0; sweep <= END_SWEEPS; sweep++) {
    for (int c = 0; c < z; c++) base[c] = own.of_D[c];
    for (int e = 0; sweep > 0 && e < own.entries; e++)
      base[own.row[e]] += own.end_slope[e] * D[own.column[e]];
    for (int a = 0; a < m; a++)
      left[a] = own.of_end[a] - sum_of_products(z, own.end_gradient + a * z, base);
    for (int c = 0; c < z; c++) D[c] = base[c];
    for (int a = 0; a < m; a++) {
      const double half = 0.5 * sum_of_products(m, own.end + a * m, left);
      own.multiplier[a] = 2 * half;
      for (int c = 0; c < z; c++) D[c] += half * own.end_field[a * z + c];
    }
  }
  for (int c = 0; c < z; c++) own.of_D[c] = D[c];
  memcpy(own.of_end, own.multiplier, (size_t)m * sizeof(double));
}

void dvi__phase_correct(dvi__phase_element *f)
{
  correct_stages_of(f);
  correct_end(f);
}
