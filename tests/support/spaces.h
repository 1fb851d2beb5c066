/* User bases, which are function spaces of a program's own. */
#ifndef SUPPORT_SPACES_H
#define SUPPORT_SPACES_H
#include <dvi/shapes.h>

#include "problem.h"

/* Creates an integrator with a user basis. */
dvi_status create_with_shapes(const dvi_system *system, const dvi_shapes *shapes,
                              const char *method, dvi_integrator **integrator);

/* Create an integrator, or fail the test. start_integrator_with_shapes() also starts it at the
 * problem's start. */
dvi_integrator *create_integrator_with_shapes(const dvi_system *system, const dvi_shapes *shapes,
                                              const char *method);
dvi_integrator *start_integrator_with_shapes(const problem *model, const dvi_shapes *shapes,
                                             const char *method);

/* tau^2, .., tau^(functions+1), which span the polynomials of degree functions+1 together with
 * those of degree 1. */
dvi_shapes powers(int functions);

/* sin(omega h tau) and cos(omega h tau). */
dvi_shapes oscillation(const double *omega);

/* exp(-h tau), whose space is its mirror image under a step back, and exp(-tau), whose space is
 * not. */
extern const dvi_shapes decay, lopsided;

/* tanh(20 tau - 8), which few points integrate badly. */
extern const dvi_shapes steep;

/* exp(-tau) by Milne's rule, whose middle weight is negative. */
extern const dvi_shapes milne;

/* max(0, tau - 1/2)^3 by a Gauss rule of four points on either half. With degree=3 it spans the
 * cubic splines with a knot in the middle. */
extern const dvi_shapes spline;

/* The cubic B-splines of that knot that vanish at both ends. With degree=1 they span the same
 * space. */
extern const dvi_shapes b_splines;

#endif
