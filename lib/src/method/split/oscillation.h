/* The slow potentials kick. Between the kicks stands the exact motion of quadratic fast potentials,
 * mode by mode (step/split/modes.h) or by polynomials (step/split/polynomials.h). The kicks are the
 * filtered slow gradient at a place near the state.
 *
 *     p <- p - h/2 Psi_1 U'(A(q)),
 *     A(q) = q - X diag((1 - phi)/lambda) X^T W'(q),   the filter Phi of a state at rest
 *
 * Phi and Psi_1 are functions of x = h omega of each mode. The method is symplectic where they are
 * equal. */
#ifndef DVI_METHOD_SPLIT_OSCILLATION_H
#define DVI_METHOD_SPLIT_OSCILLATION_H
#include "step/split/modes.h"
#include "step/split/polynomials.h"
#include "method/split/impulse.h"

/* The filters multiply a mode by phi, (1 - phi)/x^2 and psi_1. */
typedef struct dvi__filter {
  double phi, shift, psi;
} dvi__filter;

/* A pair of filters. `at` gives their values at s = x^2, and returns 0 if there are none at this s.
 * s is negative where the fast potentials are repulsive. The growth bounds the filters. */
typedef struct dvi__filters {
  int (*at)(int number, double s, dvi__filter *filter);
  int number;
  /* growth; a mass of 0 marks functions that polynomials cannot approximate */
  dvi__growth phi, psi;
} dvi__filters;

/* The representation of the fast motion. */
typedef enum dvi__motion {
  DVI__MOTION_AUTO,
  DVI__MOTION_MODES,
  DVI__MOTION_POLYNOMIALS
} dvi__motion;

/* The own struct of a stepper. */
typedef struct dvi__oscillation {
  dvi__impulse impulse;
  dvi__modes *modes; /* one of these two; the other is NULL */
  dvi__polynomials *polynomials;
  dvi__evaluator *fast_forces;
  const dvi__filters *filters; /* NULL for plain kicks */
  /* not 0 if the fast gradient, which does not depend on t, serves a filter and the next move */
  int keeps;
  double h; /* length of step of the filters below, or of their polynomials (0 before the first) */
  dvi__filter *filter;      /* [n] filters of the modes */
  double *V_q, *y, *nearby; /* [n] work */
} dvi__oscillation;

/* Create the own struct. The filters must outlive it. DVI_UNSUPPORTED if a fast potential is not
 * declared quadratic, for which `remedy` names another way, or if polynomials are not possible.
 * DVI_SINGULAR if a mass is not positive. */
dvi_status dvi__oscillation_create(dvi__stepper *self, const dvi__filters *filters,
                                   dvi__motion motion, const char *remedy);
void dvi__oscillation_destroy(dvi__stepper *self);
void dvi__oscillation_explain(const dvi__stepper *self, dvi__text *text);

#endif
