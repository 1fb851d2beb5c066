/* A machine with parameters in complex arithmetic: its Lagrangian's derivatives, forces included,
 * and its discrete map. Derivatives by complex steps are exact beside rounding (Squire and Trapp
 * 1998). No code is shared with the library, but the quadrature's numbers. */
#ifndef TESTS_SUPPORT_MACHINE_H
#define TESTS_SUPPORT_MACHINE_H
#include <dvi/dvi.h>

/* The imaginary unit I of this header would be read in prototypes of the library. */
#include <complex.h>

enum { MACHINE_N = 2, MACHINE_PARAMETERS = 4 };

/* theta = mass, coupling of the velocities, stiffness, friction. L_q + F and L_v of
 *
 *     L = m (2 + bend cos q1) v0^2/2 + v1^2/2 + coupling bend sin(q0) v0 v1
 *         - k (q0^4/4 + q0 q1/2 + q1^2),     F = (-c v0 + sin t, -c v1 q0^2),
 *
 * where bend is 1, or 0 for a constant mass. */
typedef struct machine {
  double theta[MACHINE_PARAMETERS], bend;
} machine;

extern const machine bent_machine, straight_machine;

/* Make the system, perhaps with one more force. */
dvi_system *machine_system(machine *m);
dvi_system *machine_system_with(machine *m, const dvi_force *more);

dvi_dependence machine_dependence(machine *m);

/* Computes (q, p) after some steps of a method of degree s with Gauss or Lobatto points. z [4] is
 * the start and becomes the end. */
void machine_run(const double complex *theta, double bend, dvi_rule rule, int s, int r, double h,
                 int steps, double complex *z);

#endif
