/* The energies of an element, which are the derivatives of its action by the times of its ends.
 *
 *     S(t0, h, q0, Y) = h sum_j b_j L_j,   L_j at t0 + c_j h
 *     E+ = -dS/dh          = sum_j b_j ( L_v V - L - c_j h L_t )_j           at the element's end,
 *     E- = dS/dt0 - dS/dh  = sum_j b_j ( L_v V - L + (1 - c_j) h L_t )_j     at its start.
 *
 * With the times of the nodes as further unknowns the action is stationary if E+ of an element is
 * E- of the next. E+ = E- for an autonomous system. Second derivatives of S commute. Therefore the
 * derivatives of E+ by Y and q0 are those of the rows dS/dY and dS/dq0 by h, but for the sign.
 * Source: Kane, Marsden and Ortiz 1999; Leok 2004, sec. 5.2. */
#ifndef DVI_STEP_ELEMENT_ENERGY_H
#define DVI_STEP_ELEMENT_ENERGY_H
#include "step/element/action.h"

typedef struct dvi__energies {
  double start, end; /* E-, E+ */
  /* size of the summands, sum_j b_j ( |L_v V| + |L| )_j, whose roundings are those of the
   * energies */
  double size;
} dvi__energies;

/* The gradient of one energy. */
typedef struct dvi__energy_gradient {
  double *Y;  /* [n*s] */
  double *q0; /* [n], with Y fixed */
  double h;
} dvi__energy_gradient;

/* Allocate memory for the energies, once, after dvi__action_prepare_jacobian. DVI_UNSUPPORTED if a
 * term of a system that is not autonomous has no rate. */
dvi_status dvi__action_prepare_energy(dvi__action *action);

/* Evaluate the energies at the point of the last residual, whose gradients they use. */
dvi_status dvi__action_energies(dvi__action *action, dvi__energies *E);

/* Evaluate their gradients at the point of the last Jacobian, whose Hessians they use. The
 * residual's forces stay. L_tq, L_tv and L_tt of a system that is not autonomous are differenced
 * over a small part of h. */
dvi_status dvi__action_energy_gradients(dvi__action *action, dvi__energy_gradient *start,
                                        dvi__energy_gradient *end);

/* Give dR/dh [n*s] of the rows of action.h at fixed Y from the gradient of E+. The momentum row's
 * part enters as it does in R. */
void dvi__action_h_column(const dvi__action *action, const dvi__energy_gradient *end,
                          double *column);

#endif
