/* Systems on groups and spheres, and whether a step on them is symplectic. */
#ifndef TESTS_SUPPORT_FACTORS_H
#define TESTS_SUPPORT_FACTORS_H
#include <dvi/integrator.h>

/* Numbers of a state at most. */
enum { BODIES_MOST = 32 };

/* A system with a state, q and v. */
typedef struct bodies {
  dvi_system *system;
  double q[BODIES_MOST], v[BODIES_MOST];
} bodies;

/* J = diag(3, 2, 1.5), Omega = (.5, -.5, .4). At T = 10 Omega is free_body_end, by Jacobi's elliptic functions. */
bodies free_body(void);
extern const double free_body_moments[3], free_body_end[3];

/* A body of mass 1 that hangs from a point at (0, 0, .3) of its frame, J = diag(.13, .28, .17) about it; Omega = 4.14 (1, 1, 1). At T = 1 Omega is
 * pendulum_end. Its vertical angular momentum is a symmetry. */
bodies pendulum_in_space(void);
extern const double pendulum_moments[3], pendulum_end[3];

/* A direction, an angle, two coordinates, and a rigid motion whose centre of mass is not its origin, in a common potential; no mass couples them. */
bodies loose_cells(void);

/* Two directions that a mass couples as in a double pendulum, the second to the place of a rigid motion; an angle with a mass that is not a multiple of the
 * identity; a rotation whose mass is not that of a body. In a common potential. */
bodies tied_cells(void);

/* A free body; its inertia may be any. */
bodies body_of(const double inertia[9], const double Omega[3]);

void bodies_clear(bodies *of);

/* An integrator at its start. */
dvi_integrator *body_started(const bodies *of, const char *method);

/* The largest entry of D^T J D - J, D the derivative of one step of the method from this state. Both ends have the canonical coordinates of natural charts: xi,
 * and the momentum of xi, A(xi)^T p with the velocity v = A(xi) xi'. D is differenced, right to about 1e-11. */
double symplecticity_of_step(const bodies *of, const char *method, double h);

#endif
