/* Holonomic constraints phi(t,q) = 0. */
#ifndef DVI_SYSTEM_TERM_HOLONOMIC_H
#define DVI_SYSTEM_TERM_HOLONOMIC_H
#include "system/term/term.h"

/* Check and copy the constraints. */
dvi_status dvi__holonomics_copy(dvi_system *system, const dvi_system_terms *terms);

/* Join the patterns of all rows, those of nonholonomic constraints included. */
dvi_status dvi__rows_join(dvi_system *system);
void dvi__holonomic_clear(dvi__holonomic_term *term);

/* Compute phi [count*points] and its gradients [entries*points] in the order of the term's pattern,
 * of one term at up to DVI_HOLONOMIC_POINTS points. work [n + the longer result] has one point. */
dvi_status dvi__holonomic_values(const dvi__holonomic_term *term, int points, const double *t,
                                 const double *q, double *work, double *phi);
dvi_status dvi__holonomic_gradients(const dvi__holonomic_term *term, int points, const double *t,
                                    const double *q, double *work, double *phi_q);

/* Compute phi [count], its gradients, and its rates [count] at one point. */
dvi_status dvi__holonomic_value(const dvi__holonomic_term *term, double t, const double *q,
                                double *phi);
dvi_status dvi__holonomic_gradient(const dvi__holonomic_term *term, double t, const double *q,
                                   double *phi_q);
dvi_status dvi__holonomic_rate(const dvi__holonomic_term *term, double t, const double *q,
                               double *phi_t);

/* The function phi.w of q, whose gradient is differenced, in the shape of
 * system/term/difference.h. `function` is a dvi__holonomic_at with room for one point. */
typedef struct dvi__holonomic_at {
  const dvi__holonomic_term *term;
  double t;
  const double *w;
  double *point, *phi_q, *sum; /* [n], [entries], [n] */
} dvi__holonomic_at;

dvi_status dvi__holonomic_gradient_of_q(const void *function, int count, const double *q,
                                        double *first, double *none);

/* Compute the Hessian of phi.w in the order of the term's qq. */
dvi_status dvi__holonomic_hessian(const dvi__holonomic_at *at, dvi__scratch *scratch,
                                  const double *q, double *phi_w_qq);

#endif
