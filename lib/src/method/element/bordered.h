/* The element's rows and its energy row in one: the step's length is an unknown.
 *
 *     R(Y, h) = 0,   E-(Y, h) = E+ of the step before,      ( dR/dY   dR/dh  )
 *     with the Jacobian                                     ( dE-/dY  dE-/dh ).
 *
 * Where h hardly shows in the energy it is known to a few digits only, and Y, which moves with it,
 * too. So the unknowns are y = Y - T (h - h0) with the tangent T = -(dR/dY)^{-1} dR/dh of the rows'
 * solutions Y(h) at a length h0: y is known to all digits.
 *
 * Along the solutions Y(h) of the rows alone the mismatch is D(h) = E-(Y(h), h) - E+; its slope is
 * the Schur complement dD/dh = dE-/dh - dE-/dY (dR/dY)^{-1} dR/dh. */
#ifndef DVI_METHOD_BORDERED_H
#define DVI_METHOD_BORDERED_H
#include "step/element/energy.h"
#include "method/element/element_step.h"
#include "solve/nonlinear.h"

typedef struct dvi__bordered {
  dvi__stepper element; /* the ordinary step of a given length; its memory is the caller's */
  dvi__action *action;
  int rows;             /* of the element: its unknowns */
  dvi__pattern pattern; /* bordered */
  dvi__solver *solver;
  dvi__linear *schur; /* factors dR/dY alone */
  /* [rows+1] y, and h - h0 in units in which its roundings are those of y */
  double *x;
  double *Y, *tangent;             /* [rows] the path of x; T */
  double *values, *column;         /* of dR/dY; [rows] dR/dh */
  double *direction;               /* [rows+1] work */
  dvi__energy_gradient start, end; /* of E-, E+ */
  const dvi__state *state;         /* where the step begins */
  /* E+ before; x[rows] = (h - h0) unit; size of the energy row per unit of an unknown */
  double target, h0, unit, row;
} dvi__bordered;

/* One point on the branch of the rows' solutions. */
typedef struct dvi__mismatch {
  double h, value, slope; /* D, dD/dh */
  dvi__energies E;
} dvi__mismatch;

/* For a stepper of this space; `self` gives system and counters. On failure clear it. */
dvi_status dvi__bordered_create(const dvi__stepper *self, const dvi__action_space *space,
                                dvi__bordered *b);
void dvi__bordered_clear(dvi__bordered *b);

/* Solve rows and energy row by this rung, from a solution Y [rows] of the rows, at which the action
 * stands, with its h and energies in *found; the solution's h and slope are there then. A positive
 * status: not solved. */
dvi_status dvi__bordered_solve(dvi__bordered *b, const dvi__state *state, double target,
                               dvi__rung rung, const double *Y, dvi__mismatch *found);

/* The energies on the path Y [rows] of length h; the action then stands there. */
dvi_status dvi__bordered_energies(dvi__bordered *b, const dvi__state *state, double h,
                                  const double *Y, dvi__energies *E);

/* dD/dh on the path that the action stands at; what the last residual left stays. */
dvi_status dvi__bordered_slope(dvi__bordered *b, const double *Y, double *slope);

/* Roundings of an energy whose summands have this size. */
double dvi__energy_floor(const dvi__energies *E);

#endif
