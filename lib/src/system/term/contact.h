/* Contacts phi(t,q) >= 0. Their gaps are evaluated as holonomic constraints are
 * (system/term/holonomic.h, the member `gap`). */
#ifndef DVI_SYSTEM_TERM_CONTACT_H
#define DVI_SYSTEM_TERM_CONTACT_H
#include "system/term/holonomic.h"

/* Check and copy the contacts. */
dvi_status dvi__contacts_copy(dvi_system *system, const dvi_system_terms *terms);
void dvi__contact_clear(dvi__contact_term *term);

/* Compute the entries of T in the order of the term's tangents. */
dvi_status dvi__contact_tangent(const dvi__contact_term *term, double t, const double *q,
                                double *T);

/* A contact at a state. The rate is that of the gap along the motion, G v + phi_t. `size` measures
 * the roundings of the gap, sum |G_i q_i|, and `speed` those of the rate, sum |G_i v_i| +
 * |phi_t|. */
typedef struct dvi__touch {
  double gap, rate, size, speed;
} dvi__touch;

/* Evaluate a contact at a point with the velocity v. The gradient's entries stay in G. */
dvi_status dvi__contact_touch(const dvi__contact_term *term, double t, const double *q,
                              const double *v, double *G, dvi__touch *touch);

/* Return 1 if a body has gone farther into the other one than roundings of the gap explain. */
int dvi__contact_is_inside(const dvi__touch *touch);

#endif
