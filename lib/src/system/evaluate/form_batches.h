/* One-forms at the points of several members of an ensemble, which are lanes abreast
 * (num/simd/abreast.h): point k is one of lane k % DVI__ABREAST. Batches are not counted. A failure
 * does not tell at which points, and may have no sentence. */
#ifndef DVI_SYSTEM_EVALUATE_FORM_BATCHES_H
#define DVI_SYSTEM_EVALUATE_FORM_BATCHES_H
#include "system/evaluate/evaluator.h"

/* Compute alpha [n*count] and its gradients [entries*count], in the order of the system's qv, at
 * the points of lanes that go on. Others keep their numbers. Either may be NULL. */
dvi_status dvi__form_batch(dvi__evaluator *e, int count, const int *going, const double *q,
                           double *alpha, double *alpha_q);

/* Compute the gradients of alpha at one point, the mixed part of dvi__form_hessian, and count them
 * as a Hessian. */
dvi_status dvi__form_mixed_hessian(dvi__evaluator *e, const double *q, double *alpha_q);

/* Compute the Hessians of alpha(q).w [entries*count], in the order of the system's qq, and the
 * gradients of alpha, at all points. */
dvi_status dvi__form_hessian_batch(dvi__evaluator *e, int count, const double *q, const double *w,
                                   double *alpha_w_qq, double *alpha_q);

/* Subtract the gradients of the potentials from L_q [n*count], and their Hessians from L_qq
 * [entries*count]. */
dvi_status dvi__subtract_potentials(dvi__evaluator *e, int count, const double *t, const double *q,
                                    double *L_q);
dvi_status dvi__subtract_potential_hessians(dvi__evaluator *e, int count, const double *t,
                                            const double *q, double *L_qq);

#endif
