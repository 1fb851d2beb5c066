/* Paths with a fast oscillation, p(t) + r(t) sin(omega t) + s(t) cos(omega t), and a quadrature for
 * Lagrangians of them. p has one degree, r and s another. With constant amplitudes the second
 * harmonic may be added.
 *
 * The points are Lobatto nodes with 5 phases each, 9 for two harmonics (space/filon.h). There are
 * degree + 1 nodes for constant amplitudes and one more for others. Products of two functions are
 * integrated exactly as long as no oscillating amplitude is of a higher degree than degree + 1,
 * that of p r. While as many points resolve the oscillation, they are Gauss's on the path, which
 * asks nothing of the Lagrangian.
 *
 * The functions are made orthonormal in the integral of psi_k' psi_l' over a step. As h omega goes
 * to 0, sin and cos are polynomials but for rounding. A function is not present if less than 1e-8
 * of itself is left. An action errs by the square of that. So the space becomes that of the
 * polynomials. */
#ifndef DVI_SPACE_OSCILLATING_H
#define DVI_SPACE_OSCILLATING_H
#include "space/shapes.h"

typedef struct dvi__oscillating dvi__oscillating;

enum {
  DVI__OSCILLATING_DEGREE_MOST = 6,
  DVI__OSCILLATING_FUNCTIONS = 3 * DVI__OSCILLATING_DEGREE_MOST + 4
};

/* Create a space with degree 1 to DVI__OSCILLATING_DEGREE_MOST, amplitude 0 to degree, harmonics 1
 * or 2, omega > 0. Return NULL if there is no memory. */
dvi__oscillating *dvi__oscillating_create(int degree, int amplitude, int harmonics, double omega);
void dvi__oscillating_destroy(dvi__oscillating **space);

/* Change omega. The shapes must be set again afterwards. */
void dvi__oscillating_tune(dvi__oscillating *space, double omega);

/* Return the space as shapes, of which the first `degree` are polynomials. The shapes live as long
 * as the space. */
dvi__shapes dvi__oscillating_shapes(dvi__oscillating *space);

/* Return the largest h omega at which the points are on the path. */
double dvi__oscillating_resolved(const dvi__oscillating *space);

#endif
