/* The action, its gradient and its Hessian.
 *
 *     S = sum_h |h| eps_h - Lambda V,    dS/dl_e = sum_h eps_h d|h|/dl_e - Lambda dV/dl_e,
 *     d2S/dl_e dl_f = sum_h (eps_h d2|h|/dl_e dl_f + d|h|/dl_e d eps_h/dl_f) - Lambda d2V/dl_e dl_f
 *
 * The second derivatives of angles drop out as their first ones do. Source: Regge 1961; Hartle and
 * Sorkin 1981 for the boundary. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/regge/regge.h"
#include "num/finite.h"

static const double pi = 3.14159265358979323846;

dvi_status dvi__regge_check(const dvi_regge *regge, const double *length)
{
  return regge != NULL && length != NULL
             ? DVI_OK
             : dvi__fail(DVI_BAD_ARGUMENT, "regge: a complex and its lengths are needed");
}

/* ---- the parts of a simplex ---- */

/* Sum up volumes and angles. */
static dvi_status add_angles(const dvi_regge *r, const double *length, dvi__regge_sums *sums)
{
  dvi__measured_simplex m;
  sums->volume = 0;
  for (int64_t h = 0; h < r->hinges; h++) sums->deficit[h] = r->outer[h] ? pi : 2 * pi;
  for (int64_t c = 0; c < r->cells; c++) {
    DVI_TRY(dvi__regge_measure_cell(r, length, c, &m));
    sums->volume += m.cell.volume;
    for (int i = 0; i < r->pairs; i++) {
      const int h = r->hinge[c * r->pairs + i];
      sums->deficit[h] -= m.hinge[i].angle;
      sums->size[h] = m.hinge[i].face.volume;
    }
  }
  return DVI_OK;
}

/* Add eps_h d|h| for the hinges that the cell owns, S where it owns them, and -Lambda dV. */
static void add_gradient(const dvi_regge *r, int64_t cell, const dvi__measured_simplex *m,
                         dvi__regge_sums *sums)
{
  const int *edge = r->edge + cell * r->pairs, *hinge = r->hinge + cell * r->pairs;
  double slope[DVI__PAIRS], gradient[DVI__PAIRS] = {0}, terms[DVI__PAIRS] = {0};
  for (int i = 0; i < r->pairs; i++) {
    if (r->owner[hinge[i]] != cell * r->pairs + i) continue;
    dvi__hinge_slopes(m, i, slope);
    for (int e = 0; e < r->pairs; e++) {
      gradient[e] += sums->deficit[hinge[i]] * slope[e];
      terms[e] += 2 * pi * fabs(slope[e]);
    }
  }
  dvi__volume_slopes(m, slope);
  for (int e = 0; e < r->pairs; e++) {
    sums->gradient[edge[e]] += gradient[e] - r->lambda * slope[e];
    if (sums->terms != NULL) sums->terms[edge[e]] += terms[e] + fabs(r->lambda * slope[e]);
  }
}

/* Add the same for the Hessian, with the changes of the angles of this cell. */
static void add_hessian(const dvi_regge *r, int64_t cell, const dvi__measured_simplex *m,
                        dvi__regge_sums *sums)
{
  const int *edge = r->edge + cell * r->pairs, *hinge = r->hinge + cell * r->pairs;
  const int pairs = r->pairs;
  double all[DVI__PAIRS * DVI__PAIRS], bend[DVI__PAIRS * DVI__PAIRS], turn[DVI__PAIRS],
      slope[DVI__PAIRS];
  dvi__volume_bends(m, all);
  for (int i = 0; i < pairs * pairs; i++) all[i] *= -r->lambda;
  for (int i = 0; i < pairs; i++) {
    const int is_owner = r->owner[hinge[i]] == cell * pairs + i;
    const double deficit = is_owner ? sums->deficit[hinge[i]] : 0;
    dvi__hinge_slopes(m, i, slope);
    dvi__angle_slopes(m, i, turn);
    if (is_owner) dvi__hinge_bends(m, i, bend);
    for (int e = 0; e < pairs; e++)
      for (int f = 0; f < pairs; f++)
        all[e * pairs + f] += (is_owner ? deficit * bend[e * pairs + f] : 0) - slope[e] * turn[f];
  }
  for (int e = 0; e < pairs; e++)
    for (int f = 0; f < pairs; f++)
      sums->hessian[dvi__csr_find(&r->pattern, edge[e], edge[f])] += 0.5 * (all[e * pairs + f] +
                                                                            all[f * pairs + e]);
}

/* Lambda may be so large that products overflow. */
static dvi_status check_finite(const dvi_regge *r, const dvi__regge_sums *sums)
{
  const size_t edges = (size_t)r->edges, entries = (size_t)r->pattern.start[r->edges];
  if (isfinite(sums->action) &&
      (sums->gradient == NULL || dvi__first_not_finite(edges, sums->gradient) < 0) &&
      (sums->hessian == NULL || dvi__first_not_finite(entries, sums->hessian) < 0))
    return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE,
                   "regge: the action or a derivative is not finite with Lambda = %g: take lengths "
                   "near 1",
                   r->lambda);
}

dvi_status dvi__regge_evaluate(const dvi_regge *r, const double *length, dvi__regge_sums *sums)
{
  dvi__measured_simplex m;
  DVI_TRY(add_angles(r, length, sums));
  sums->action = -r->lambda * sums->volume;
  for (int64_t h = 0; h < r->hinges; h++) sums->action += sums->size[h] * sums->deficit[h];
  if (sums->gradient != NULL) memset(sums->gradient, 0, (size_t)r->edges * sizeof(double));
  if (sums->terms != NULL) memset(sums->terms, 0, (size_t)r->edges * sizeof(double));
  if (sums->hessian != NULL)
    memset(sums->hessian, 0, (size_t)r->pattern.start[r->edges] * sizeof(double));
  for (int64_t c = 0; c < r->cells && (sums->gradient != NULL || sums->hessian != NULL); c++) {
    DVI_TRY(dvi__regge_measure_cell(r, length, c, &m));
    if (sums->gradient != NULL) add_gradient(r, c, &m, sums);
    if (sums->hessian != NULL) add_hessian(r, c, &m, sums);
  }
  return check_finite(r, sums);
}

/* ---- public functions ---- */

/* Evaluate with memory for deficits and volumes of hinges. */
static dvi_status evaluate(const dvi_regge *r, const double *length, dvi__regge_sums *sums)
{
  dvi__regge_sums own = *sums;
  if (sums->deficit == NULL) own.deficit = DVI_NEW(double, r->hinges);
  if (sums->size == NULL) own.size = DVI_NEW(double, r->hinges);
  dvi_status status = own.deficit != NULL && own.size != NULL
                          ? dvi__regge_evaluate(r, length, &own)
                          : dvi__fail(DVI_NO_MEMORY, "regge: no memory for deficits");
  sums->action = own.action;
  sums->volume = own.volume;
  if (sums->deficit == NULL) dvi__release(own.deficit);
  if (sums->size == NULL) dvi__release(own.size);
  return status;
}

dvi_status dvi_regge_action(const dvi_regge *regge, const double *length, double *action,
                            double *gradient)
{
  DVI_TRY(dvi__regge_check(regge, length));
  dvi__regge_sums sums = {.gradient = gradient};
  DVI_TRY(evaluate(regge, length, &sums));
  if (action != NULL) *action = sums.action;
  return DVI_OK;
}

dvi_status dvi_regge_hinges(const dvi_regge *regge, const double *length, double *volume,
                            double *deficit)
{
  DVI_TRY(dvi__regge_check(regge, length));
  return evaluate(regge, length, &(dvi__regge_sums){.size = volume, .deficit = deficit});
}

dvi_status dvi_regge_hessian_create(const dvi_regge *regge, const double *length,
                                    dvi_matrix **hessian)
{
  if (hessian == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "regge: a matrix is needed");
  *hessian = NULL;
  DVI_TRY(dvi__regge_check(regge, length));
  const dvi_matrix pattern = dvi__csr_view(&regge->pattern, 1);
  dvi__csr H = {0};
  DVI_TRY(dvi__csr_copy(&pattern, &H));
  dvi_status status = evaluate(regge, length, &(dvi__regge_sums){.hessian = H.value});
  if (status == DVI_OK) return dvi__csr_give(&H, 1, hessian);
  dvi__csr_clear(&H);
  return status;
}
