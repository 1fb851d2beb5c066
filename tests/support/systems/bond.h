/* Two bodies in a plane on a stiff bond, which also attract each other softly. With
 * q = (x1, y1, x2, y2), masses 1 and 2, and the distance r,
 *
 *     fast: stiffness (r^2/2 + bend r^4/4),      slow: -1/sqrt(1 + r^2).
 *
 * Both momenta and the angular momentum are conserved. */
#ifndef SUPPORT_BOND_H
#define SUPPORT_BOND_H
#include <dvi/dvi.h>

typedef struct bond {
  double stiffness, bend; /* with bend 0 the fast potential is quadratic, and is declared so */
  dvi_system *system;
  double q[4], p[4]; /* a start */
} bond;

/* The bond must not move in memory. */
void make_bond(double stiffness, double bend, bond *made);
void destroy_bond(bond *made);

/* Creates an integrator, and starts it at the bond's start. */
dvi_integrator *bond_integrator(const bond *pair, const char *method);

#endif
