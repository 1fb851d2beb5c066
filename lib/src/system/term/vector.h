/* The vector potential A(t,q) of a system with a constant mass, at a batch of points. */
#ifndef DVI_SYSTEM_TERM_VECTOR_H
#define DVI_SYSTEM_TERM_VECTOR_H
#include "system/term/term.h"

/* Check and copy the terms' vector potential, if there is one, with its pattern as the system's qv.
 * Free it. Complete the pattern of its Hessian, and the groups of columns. */
dvi_status dvi__vector_copy(dvi_system *system, const dvi_system_terms *terms);
void dvi__vector_clear(dvi__vector_term **vector);
dvi_status dvi__vector_complete(dvi__vector_term *vector, int n);

int dvi__vector_has_hessian(const dvi__vector_term *vector);
int dvi__vector_has_rate(const dvi__vector_term *vector);

/* Compute A [n*count], its gradients [entries*count] in the order of the pattern, and its rate A_t
 * [n*count]. Shapes are as in system/evaluate/evaluator.h. */
dvi_status dvi__vector_value(const dvi__vector_term *vector, dvi__scratch *scratch, int count,
                             const double *t, const double *q, double *A);
dvi_status dvi__vector_gradients(const dvi__vector_term *vector, dvi__scratch *scratch, int count,
                                 const double *t, const double *q, double *A_q);
dvi_status dvi__vector_rate(const dvi__vector_term *vector, dvi__scratch *scratch, int count,
                            const double *t, const double *q, double *A_t);

/* Compute the gradient [n*count] and the Hessian [entries*count] of the function A(t,q).w,
 * w [n*count] fixed. */
dvi_status dvi__vector_forces(const dvi__vector_term *vector, dvi__scratch *scratch, int count,
                              const double *t, const double *q, const double *w, double *A_w_q);
dvi_status dvi__vector_hessian(const dvi__vector_term *vector, dvi__scratch *scratch, int count,
                               const double *t, const double *q, const double *w, double *A_w_qq);

/* The gradient of A.w, and A itself unless it is NULL, as functions of q alone in the shape of a
 * gradient of system/term/difference.h. `function` is a dvi__vector_at. */
typedef struct dvi__vector_at {
  const dvi__vector_term *term;
  dvi__scratch *scratch;
  const double *t, *w;
} dvi__vector_at;

dvi_status dvi__vector_of_q(const void *function, int count, const double *q, double *A_w_q,
                            double *A);

#endif
