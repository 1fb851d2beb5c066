#include <float.h>
#include <math.h>
#include <string.h>

#include "step/element/action_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/simd/lanes.h"
#include "space/quadrature.h"
#include "space/trial.h"

static int tables_allocate(dvi__action *a)
{
  a->lanes = dvi__lanes_for(a->r);
  a->path_lanes = dvi__lanes_for(a->s);
  const size_t s = (size_t)a->s, r = (size_t)a->r, lanes = (size_t)a->lanes,
               path_lanes = (size_t)a->path_lanes;
  a->psi = DVI_NEW(double, s *lanes);
  a->dpsi = DVI_NEW(double, s *lanes);
  a->bar = DVI_NEW(double, s *lanes);
  a->node = DVI_NEW(double, r);
  a->weight = DVI_NEW(double, r);
  if (a->system->damping > 0) a->undamped = DVI_NEW(double, r);
  a->end = DVI_NEW(double, s);
  a->stiffness = DVI_NEW(double, s *s);
  a->stiffness_inverse = DVI_NEW(double, s *s);
  a->fit_point = DVI_NEW(double, s);
  a->fit = DVI_NEW(double, s *(s + path_lanes));
  a->straight = DVI_NEW(double, s);
  a->at_fit = a->fit != NULL ? a->fit + s * s : NULL;
  a->shift.table = DVI_NEW(double, DVI__SHIFTS *s *path_lanes);
  a->shift_rows = DVI_NEW(double, s *s);
  a->bar_row = DVI_NEW(double, r *path_lanes);
  a->slope_row = DVI_NEW(double, r *path_lanes);
  a->stiffness_row = DVI_NEW(double, s *path_lanes);
  return a->psi && a->dpsi && a->bar && a->node && a->weight && a->end &&
         (a->undamped || a->system->damping == 0) && a->stiffness && a->stiffness_inverse &&
         a->fit_point && a->fit && a->straight && a->shift.table && a->shift_rows && a->bar_row &&
         a->slope_row && a->stiffness_row;
}

static double largest_with(int count, const double *x, double size)
{
  for (int i = 0; i < count; i++) size = fmax(size, fabs(x[i]));
  return size;
}

/* Round psi and psi(1) to one grid on which their difference is exact. The rows of the stationarity
 * conditions are then the derivatives of one discrete action to the last bit, however the tables
 * are rounded. Else momenta and energy drift by a part of an epsilon in every step (measured on
 * outer-solar, angular momentum by 2e-18 of itself a step). */
static void make_differences_exact(dvi__action *a)
{
  const int last = a->s * a->lanes;
  const double grid = ldexp(
      1.0, ilogb(largest_with(a->s, a->end,
                              largest_with(last, a->bar, largest_with(last, a->psi, 1.0)))) +
               1 - DBL_MANT_DIG);
  for (int k = 0; k < a->s; k++) a->end[k] = grid * nearbyint(a->end[k] / grid);
  for (int k = 0; k < a->s; k++)
    for (int j = k * a->lanes; j < k * a->lanes + a->r; j++) {
      a->psi[j] = grid * nearbyint(a->psi[j] / grid);
      a->bar[j] = a->psi[j] - a->end[k];
    }
}

static dvi_status fill_nodes(dvi__action *a)
{
  long double node[DVI_QUADRATURE_MAX], weight[DVI_QUADRATURE_MAX];
  double psi[DVI_DEGREE_MAX], bar[DVI_DEGREE_MAX], dpsi[DVI_DEGREE_MAX];
  DVI_TRY(dvi__quadrature_long(a->space.rule, a->r, node, weight));
  for (int j = 0; j < a->r; j++) {
    a->node[j] = (double)node[j];
    a->weight[j] = (double)weight[j];
    dvi__trial_in(&a->trial, node[j], psi, bar, dpsi);
    for (int k = 0; k < a->s; k++) {
      a->psi[k * a->lanes + j] = psi[k];
      a->bar[k * a->lanes + j] = bar[k];
      a->dpsi[k * a->lanes + j] = dpsi[k];
    }
  }
  if (a->undamped != NULL) memcpy(a->undamped, a->weight, (size_t)a->r * sizeof(double));
  dvi__trial_in(&a->trial, 1.0L, a->end, NULL, NULL);
  make_differences_exact(a);
  return DVI_OK;
}

/* Invert the positive definite stiffness by Gauss-Jordan elimination. An iteration's matrix needs
 * no pivoting and no last digit. */
static void invert_stiffness(int s, const double *matrix, double *inverse)
{
  double m[DVI_DEGREE_MAX][DVI_DEGREE_MAX];
  for (int k = 0; k < s; k++)
    for (int l = 0; l < s; l++) m[k][l] = matrix[k * s + l], inverse[k * s + l] = k == l;
  for (int c = 0; c < s; c++) {
    const double pivot = m[c][c];
    for (int l = 0; l < s; l++) m[c][l] /= pivot, inverse[c * s + l] /= pivot;
    for (int k = 0; k < s; k++) {
      const double factor = m[k][c];
      if (k == c) continue;
      for (int l = 0; l < s; l++)
        m[k][l] -= factor * m[c][l], inverse[k * s + l] -= factor * inverse[c * s + l];
    }
  }
}

static void fill_stiffness(dvi__action *a)
{
  for (int k = 0; k < a->s; k++)
    for (int l = 0; l < a->s; l++)
      for (int j = 0; j < a->r; j++)
        a->stiffness[k * a->s + l] += a->weight[j] * a->dpsi[k * a->lanes + j] *
                                      a->dpsi[l * a->lanes + j];
  invert_stiffness(a->s, a->stiffness, a->stiffness_inverse);
}

/* Fit paths at the right Radau nodes, which are well spread and include the end. */
static dvi_status fill_fit_table(dvi__action *a)
{
  double weight[DVI_QUADRATURE_MAX], psi[DVI_DEGREE_MAX], dpsi[DVI_DEGREE_MAX];
  DVI_TRY(dvi_quadrature(DVI_RADAU_RIGHT, a->s, a->fit_point, weight));
  dvi__trial_fit(a->space.basis, a->s, a->s, a->fit_point, a->fit);
  for (int k = 0; k < a->s; k++)
    for (int m = 0; m < a->s; m++) a->straight[k] += a->fit[k * a->s + m] * a->fit_point[m];
  for (int m = 0; m < a->s; m++) {
    dvi__trial_in(&a->trial, a->fit_point[m], psi, NULL, dpsi);
    for (int k = 0; k < a->s; k++) a->at_fit[k * a->path_lanes + m] = psi[k];
  }
  return DVI_OK;
}

static void fill_rows(dvi__action *a)
{
  for (int k = 0; k < a->s; k++) {
    for (int j = 0; j < a->r; j++) {
      a->bar_row[j * a->path_lanes + k] = a->bar[k * a->lanes + j];
      a->slope_row[j * a->path_lanes + k] = a->dpsi[k * a->lanes + j];
    }
    for (int l = 0; l < a->s; l++)
      a->stiffness_row[l * a->path_lanes + k] = a->stiffness_inverse[k * a->s + l];
  }
}

dvi_status dvi__action_fill_tables(dvi__action *a)
{
  if (!tables_allocate(a))
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for tables of degree %d", a->s);
  if (a->by_user) return DVI_OK;
  dvi__space_init(&a->trial, a->space.basis, a->s);
  DVI_TRY(fill_nodes(a));
  fill_stiffness(a);
  fill_rows(a);
  return fill_fit_table(a);
}

void dvi__action_damp(dvi__action *a, double h)
{
  const double rate = a->system->damping * h;
  if (a->undamped == NULL || a->damped_h == h) return;
  for (int j = 0; j < a->r; j++) a->weight[j] = a->undamped[j] * exp(rate * (a->node[j] - 0.5));
  a->damped_h = h;
}
