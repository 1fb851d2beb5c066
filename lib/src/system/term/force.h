/* Forces F(t,q,v) without a potential. */
#ifndef DVI_SYSTEM_TERM_FORCE_H
#define DVI_SYSTEM_TERM_FORCE_H
#include "system/term/term.h"

/* Check and copy the forces. */
dvi_status dvi__forces_copy(dvi_system *system, const dvi_system_terms *terms);
void dvi__force_clear(dvi__force_term *force);

/* Make patterns that were not declared full, and group the columns of derivatives that are
 * differenced. */
dvi_status dvi__force_complete(dvi__force_term *force, int n);

/* Return DVI__FRICTION if the force depends on the velocity, else DVI__FORCE. */
unsigned dvi__force_kind(const dvi__force_term *force);

int dvi__force_has_jacobian(const dvi__force_term *force);

/* Compute F [n*count], and F_q and F_v [entries*count] in the order of the force's patterns. Shapes
 * are as in system/evaluate/evaluator.h. A force without velocity takes v = NULL and F_v = NULL. */
dvi_status dvi__force_value(const dvi__force_term *force, dvi__scratch *scratch, int count,
                            const double *t, const double *q, const double *v, double *F);
dvi_status dvi__force_jacobian(const dvi__force_term *force, dvi__scratch *scratch, int count,
                               const double *t, const double *q, const double *v, double *F_q,
                               double *F_v);

/* A force as a function of q alone, or of v alone, in the shape of a gradient of
 * system/term/difference.h. `function` is a dvi__force_at. */
typedef struct dvi__force_at {
  const dvi__force_term *term;
  dvi__scratch *scratch;
  const double *t, *q, *v;
} dvi__force_at;

dvi_status dvi__force_of_q(const void *function, int count, const double *q, double *F,
                           double *none);
dvi_status dvi__force_of_v(const void *function, int count, const double *v, double *F,
                           double *none);

#endif
