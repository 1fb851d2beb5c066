/* Constraints phi(q,p) = 0 of a Hamiltonian as a term, and the functions phi.w of fixed weights. */
#ifndef DVI_SYSTEM_TERM_CONSTRAINT_H
#define DVI_SYSTEM_TERM_CONSTRAINT_H
#include "system/term/term.h"

/* The function phi(q,p).w of q and p, for fixed w. */
typedef struct dvi__weighted {
  dvi__lagrangian_term term; /* its `user` is this struct, which must not move */
  const dvi__constraint_term *constraint;
  const double *w;     /* weights [m] */
  double *phi, *phi_z; /* phi [m], and its gradients in the order of their pattern */
} dvi__weighted;

dvi_status dvi__weighted_open(const dvi_system *system, dvi__weighted *weighted);
void dvi__weighted_close(dvi__weighted *weighted);

/* Copy the constraints as a term of a system. */
dvi_status dvi__constraint_copy(const dvi_constraint *given, int n, dvi__constraint_term **term);
void dvi__constraint_clear(dvi__constraint_term **term);

#endif
