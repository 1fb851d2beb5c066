/* Function spaces of a program's own, for tests. */
#ifndef SUPPORT_SPACES_H
#define SUPPORT_SPACES_H
#include <dvi/shapes.h>

#include "problem.h"

/* An integrator of functions of a program's own. */
dvi_status create_shaped(const dvi_system *system, const dvi_shapes *shapes, const char *method,
                         dvi_integrator **integrator);

/* An integrator that must be made; shaped_started() puts it at the problem's start. */
dvi_integrator *shaped_integrator(const dvi_system *system, const dvi_shapes *shapes,
                                  const char *method);
dvi_integrator *shaped_started(const problem *of, const dvi_shapes *shapes, const char *method);

/* tau^2, .., tau^(functions+1): with the polynomials of degree 1 those of degree functions+1. */
dvi_shapes powers(int functions);

/* sin(omega h tau) and cos(omega h tau). */
dvi_shapes oscillation(const double *omega);

/* exp(-h tau): with steps back its space is its mirror image. exp(-tau): it is not. */
extern const dvi_shapes decay, lopsided;

/* tanh(20 tau - 8), which few points integrate badly. */
extern const dvi_shapes steep;

/* exp(-tau) by Milne's rule, whose middle weight is negative. */
extern const dvi_shapes milne;

/* max(0, tau - 1/2)^3 by a Gauss rule of four points on either half: with degree=3, cubic splines
 * with a knot in the middle. */
extern const dvi_shapes spline;

/* The cubic B-splines of that knot that vanish at both ends: with degree=1 the same space. */
extern const dvi_shapes b_splines;

#endif
