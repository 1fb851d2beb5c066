/* Parts of the constraints phi(q,p) = 0 of a Hamiltonian at one point, for elements on phase
 * space. */
#ifndef DVI_SYSTEM_DYNAMICS_CONSTRAINED_HAMILTONIAN_H
#define DVI_SYSTEM_DYNAMICS_CONSTRAINED_HAMILTONIAN_H
#include "system/evaluate/evaluator.h"
#include "system/term/constraint.h"

/* Compute phi [m], and its gradients in the order of their pattern, at one point. */
dvi_status dvi__constraint_value(dvi__evaluator *e, const double *q, const double *p, double *phi);
dvi_status dvi__constraint_gradients(dvi__evaluator *e, const double *q, const double *p,
                                     double *phi_z);

/* Compute the Hessian of phi.w, w [m], in the order of the weighted term's patterns. */
dvi_status dvi__constraint_hessian(dvi__evaluator *e, const double *q, const double *p,
                                   const double *w, double *qq, double *qp, double *pp);

/* Add factor (phi_p^T w, -phi_q^T w) to z [2n]. */
void dvi__constraint_push(const dvi__constraint_term *c, const double *phi_z, const double *w,
                          double factor, double *z);

#endif
