/* Functions shared by Hamiltonians with and without constraints. */
#ifndef DVI_SYSTEM_DYNAMICS_HAMILTONIAN_H
#define DVI_SYSTEM_DYNAMICS_HAMILTONIAN_H
#include "system/evaluate/dynamics.h"

/* The sentence for a Hamiltonian's Taylor coefficients. */
extern const char dvi__no_taylor_of_hamiltonian[];

/* Declare H as a general Lagrangian, with p in the place of v. */
dvi_status dvi__declare_hamiltonian(const dvi_system_terms *terms, dvi_system *system,
                                    dvi__term term);

/* Compute Hamilton's equations q' = H_p, p' = -H_q [n] at a point. */
dvi_status dvi__hamiltonian_vector_field(dvi__evaluator *e, double t, const double *q,
                                         const double *p, double *qdot, double *pdot);

/* Compute E = H(t,q,p). v is not read. */
dvi_status dvi__energy_of_hamiltonian(dvi__evaluator *e, double t, const double *q, const double *v,
                                      const double *p, double *E);

#endif
