/* Taylor coefficients, along a curve, of a system's Lagrangian and its derivatives. They are the
 * sum of the terms' callbacks `taylor`.
 *
 * A curve is t(s), q(s) and v(s), of which coefficient k stands at t[k], q[k*n + i] and v[k*n + i].
 * v need not be the rate of q. Coefficient k of a Hessian's entry e stands at [k*entries + e]. */
#ifndef DVI_SYSTEM_EVALUATE_JET_H
#define DVI_SYSTEM_EVALUATE_JET_H
#include <dvi/taylor.h>

#include "system/evaluate/evaluator.h"

/* Arrays for the coefficients, or NULL for those that are not requested. */
typedef struct dvi__jets {
  double *L, *L_q, *L_v, *L_qq, *L_qv, *L_vv;
} dvi__jets;

/* ---- one term ---- */

int dvi__potential_has_taylor(const dvi__potential_term *p);
int dvi__general_has_taylor(const dvi__lagrangian_term *l);

/* Compute coefficients 0 to `degree` of a term that has them, in the order of the term's own
 * patterns. All are finite. */
dvi_status dvi__potential_taylor(const dvi__potential_term *p, int n, int degree, const double *t,
                                 const double *q, double *V, double *V_q, double *V_qq);
dvi_status dvi__general_taylor(const dvi__lagrangian_term *l, int n, int degree, const double *t,
                               const double *q, const double *v, const dvi__jets *wanted);

/* ---- the Lagrangian ---- */

typedef struct dvi__jet dvi__jet;

/* Create a jet for series up to `degree`, 0 to DVI_TAYLOR_MAX, of a system with
 * dvi__system_has_taylor, which must outlive the jet. `most` is DVI__HESSIANS if L_qq will be
 * requested. A series of degree d counts as d+1 values, gradients or Hessians. counters may be
 * NULL. Nothing allocates after create. */
dvi_status dvi__jet_create(const dvi_system *system, int degree, dvi__derivatives most,
                           dvi_counters *counters, dvi__jet **jet);
void dvi__jet_destroy(dvi__jet **jet);

/* Compute the requested derivatives of L along the curve, in the order of the system's patterns. A
 * constant mass has L_qv without entries and L_vv = M. */
dvi_status dvi__jet_along(dvi__jet *jet, int degree, const double *t, const double *q,
                          const double *v, const dvi__jets *wanted);

#endif
