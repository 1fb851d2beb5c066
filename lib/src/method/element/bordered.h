/* The element's rows and its energy row in one system. The step's length is an unknown.
 *
 *     R(Y, h) = 0,   E-(Y, h) = E+ of the step before,      ( dR/dY   dR/dh  )
 *     with the Jacobian                                     ( dE-/dY  dE-/dh ).
 *
 * Where h hardly shows in the energy only a few of its digits are known, and of those of Y, which
 * moves with h, too. So the unknowns are y = Y - T (h - h0) with the tangent T = -(dR/dY)^{-1}
 * dR/dh of the rows' solutions Y(h) at a length h0. All digits of y are known.
 *
 * Along the solutions Y(h) of the rows alone the mismatch is D(h) = E-(Y(h), h) - E+. Its slope is
 * the Schur complement dD/dh = dE-/dh - dE-/dY (dR/dY)^{-1} dR/dh. */
#ifndef DVI_METHOD_ELEMENT_BORDERED_H
#define DVI_METHOD_ELEMENT_BORDERED_H
#include "step/element/energy.h"
#include "method/element/element_step.h"
#include "solve/nonlinear.h"

typedef struct dvi__bordered {
  dvi__stepper element; /* the ordinary step of a given length, whose memory is the caller's */
  dvi__action *action;
  int rows;             /* rows of the element, as many as its unknowns */
  dvi__pattern pattern; /* pattern of the bordered Jacobian */
  dvi__solver *solver;
  dvi__linear *schur; /* factors dR/dY alone */
  /* [rows+1] y, and h - h0 in units in which its roundings are those of y */
  double *x;
  double *Y, *tangent;             /* [rows] path of x, and T */
  double *values, *column;         /* values of dR/dY, and [rows] dR/dh */
  double *direction;               /* [rows+1] work */
  dvi__energy_gradient start, end; /* gradients of E- and E+ */
  const dvi__state *state;         /* state at the step's start */
  /* E+ before; x[rows] = (h - h0) unit; size of the energy row per unit of an unknown */
  double target, h0, unit, row;
} dvi__bordered;

/* A point on the branch of the rows' solutions. */
typedef struct dvi__mismatch {
  double h, value, slope; /* D, dD/dh */
  dvi__energies E;
} dvi__mismatch;

/* Create the system for a stepper of this space. `self` gives system and counters. On failure the
 * caller clears it. */
dvi_status dvi__bordered_create(const dvi__stepper *self, const dvi__action_space *space,
                                dvi__bordered *b);
void dvi__bordered_clear(dvi__bordered *b);

/* Solve rows and energy row by this rung, from a solution Y [rows] of the rows, at which the action
 * stands, with its h and energies in *found. The solution's h and slope replace these. A positive
 * status says that there is no solution. */
dvi_status dvi__bordered_solve(dvi__bordered *b, const dvi__state *state, double target,
                               dvi__rung rung, const double *Y, dvi__mismatch *found);

/* Evaluate the energies on the path Y [rows] of length h. The action stands there afterwards. */
dvi_status dvi__bordered_energies(dvi__bordered *b, const dvi__state *state, double h,
                                  const double *Y, dvi__energies *E);

/* Evaluate dD/dh on the path that the action stands at. The numbers of the last residual stay. */
dvi_status dvi__bordered_slope(dvi__bordered *b, const double *Y, double *slope);

/* Give the rounding error of an energy whose summands have this size. */
double dvi__energy_floor(const dvi__energies *E);

#endif
