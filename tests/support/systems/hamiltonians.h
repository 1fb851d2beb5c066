/* Hamiltonians without constraints: regular ones, and degenerate ones that have no Lagrangian. */
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
  double step_factor; /* multiplies the number of steps of an order study (usually 1) */
  void (*exact)(double t, double *q, double *p);
} hamiltonian_problem;

/* The problems, ended by one without a name.
 * "adjoint": H = p q (1-q), logistic growth and its adjoint equation, degenerate: linear in p.
 * "stiffness": H = p^2/2 + k q^2/2, degenerate: H lacks the momentum of the coordinate k.
 * "driven": H = p^2/2 + q^2/2 - q cos 2t, regular.
 * "curved": H = (1 + q^2) p^2/2, regular, a free motion with a mass that depends on q. */
extern const hamiltonian_problem hamiltonian_problems[];

/* Find a problem, and create its system, which the caller destroys. */
const hamiltonian_problem *find_hamiltonian_problem(const char *name);
dvi_system *create_hamiltonian_system(const hamiltonian_problem *model);

/* Creates an integrator, and starts it at the problem's start. */
dvi_integrator *start_hamiltonian_integrator(const dvi_system *system,
                                             const hamiltonian_problem *model, const char *method);

/* Creates the system with H = p.v - L of a problem of the catalogue. v comes from the inverse
 * Legendre map at every point, and the Hessian from differences. The problem must outlive the
 * system. */
dvi_system *create_legendre_transform(problem *model);

#endif
