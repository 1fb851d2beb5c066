/* Nonholonomic constraints A(t,q) v + a(t,q) = 0. */
#ifndef DVI_SYSTEM_TERM_NONHOLONOMIC_H
#define DVI_SYSTEM_TERM_NONHOLONOMIC_H
#include "system/term/term.h"

/* Check and copy the constraints, after the holonomic ones. */
dvi_status dvi__nonholonomics_copy(dvi_system *system, const dvi_system_terms *terms);
void dvi__nonholonomic_clear(dvi__nonholonomic_term *term);

/* Compute A in the order of the term's pattern, and a [count], of one term at one point. */
dvi_status dvi__nonholonomic_value(const dvi__nonholonomic_term *term, double t, const double *q,
                                   double *A);
dvi_status dvi__nonholonomic_affine(const dvi__nonholonomic_term *term, double t, const double *q,
                                    double *a);

/* The function A v + a of q in the shape of system/term/difference.h, with n results, of which the
 * first `count` are those of the rows and the others are 0. `function` is a
 * dvi__nonholonomic_at. */
typedef struct dvi__nonholonomic_at {
  const dvi__nonholonomic_term *term;
  double t;
  const double *v;
  double *A; /* [entries] work */
} dvi__nonholonomic_at;

dvi_status dvi__nonholonomic_of_q(const void *function, int count, const double *q, double *rows,
                                  double *none);

/* Compute d(A v + a)/dq in the order of by_q. */
dvi_status dvi__nonholonomic_derivative(const dvi__nonholonomic_at *at, dvi__scratch *scratch,
                                        const double *q, double *Av_q);

#endif
