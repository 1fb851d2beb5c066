/* Two bodies in a plane on a stiff bond, which attract each other softly, too: q = (x1, y1, x2,
 * y2), masses 1 and 2, r the distance,
 *
 *     fast: stiffness (r^2/2 + bend r^4/4),      slow: -1/sqrt(1 + r^2).
 *
 * Both momenta and the angular momentum are conserved. */
#ifndef SUPPORT_BOND_H
#define SUPPORT_BOND_H
#include <dvi/dvi.h>

typedef struct bond {
  double stiffness, bend; /* without a bend the fast potential is quadratic, and is declared so */
  dvi_system *system;
  double q[4], p[4]; /* a start */
} bond;

/* `made` must stay where it is. */
void make_bond(double stiffness, double bend, bond *made);
void destroy_bond(bond *made);

/* An integrator at the start. */
dvi_integrator *bond_integrator(const bond *of, const char *method);

#endif
