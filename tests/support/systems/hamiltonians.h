/* Hamiltonians without constraints: those of Lagrangians, and degenerate ones that have none. */
#ifndef SUPPORT_HAMILTONIANS_H
#define SUPPORT_HAMILTONIANS_H
#include "support/runs.h"

enum { HAMILTONIAN_MOST = 3 };

/* A system with a start and its exact solution. */
typedef struct hamiltonian_problem {
  const char *name;
  int n, degenerate;
  dvi_hamiltonian hamiltonian;
  double q[HAMILTONIAN_MOST], p[HAMILTONIAN_MOST];
  double pace; /* how many steps, beside the others, show an order */
  void (*exact)(double t, double *q, double *p);
} hamiltonian_problem;

/* degenerate: "adjoint", H = p q (1-q), linear in the momentum: logistic growth and its adjoint
 * equation. "stiffness", H = p^2/2 + k q^2/2, k a coordinate whose momentum is not in H: an
 * oscillator, and what its stiffness does to the action. regular: "driven", H = p^2/2 + q^2/2 - q
 * cos 2t; "curved", H = (1 + q^2) p^2/2, a free motion with a mass that depends on the place. Ended
 * by one without a name. */
extern const hamiltonian_problem hamiltonian_problems[];

/* One that must be there, and its system; the caller's. */
const hamiltonian_problem *hamiltonian_problem_of(const char *name);
dvi_system *hamiltonian_system(const hamiltonian_problem *of);

/* An integrator at its start. */
dvi_integrator *hamiltonian_started(const dvi_system *system, const hamiltonian_problem *of,
                                    const char *method);

/* H = p.v - L of a problem of the catalogue, v by the inverse Legendre map at every point; its
 * Hessian is differenced. The problem must stay. */
dvi_system *legendre_transform(problem *of);

#endif
