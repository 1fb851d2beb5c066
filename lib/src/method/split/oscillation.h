/* Kicks by the slow potentials, and between them the exact motion of quadratic fast ones, mode by
 * mode (step/split/modes.h) or by polynomials (step/split/polynomials.h). What kicks is the slow
 * gradient at a place near the state, and comes through a filter:
 *
 *     p <- p - h/2 Psi_1 U'(A(q)),      A(q) the filter Phi of a state at rest: q - X diag((1 - phi)/lambda) X^T W'(q).
 *
 * Phi and Psi_1 are functions of the modes' x = h omega. The method is symplectic where they are
 * one. */
#ifndef DVI_METHOD_OSCILLATION_H
#define DVI_METHOD_OSCILLATION_H
#include "step/split/modes.h"
#include "step/split/polynomials.h"
#include "method/split/impulse.h"

/* What the filters do to a mode: phi, (1 - phi)/x^2 and psi_1. */
typedef struct dvi__filter {
  double phi, shift, psi;
} dvi__filter;

/* A pair of filters: their values at s = x^2, which is negative where the fast potentials push (0:
 * there are none at this s), and how they grow. */
typedef struct dvi__filters {
  int (*at)(int number, double s, dvi__filter *filter);
  int number;
  dvi__growth phi, psi; /* of mass 0: they are no functions that polynomials can follow */
} dvi__filters;

/* How the fast motion is found. */
typedef enum dvi__motion {
  DVI__MOTION_AUTO,
  DVI__MOTION_MODES,
  DVI__MOTION_POLYNOMIALS
} dvi__motion;

/* A stepper's own struct. */
typedef struct dvi__oscillation {
  dvi__impulse impulse;
  dvi__modes *modes; /* one of these two; NULL: the other one */
  dvi__polynomials *polynomials;
  dvi__evaluator *fast_forces;
  const dvi__filters *filters; /* NULL: kicks as they are */
  /* not 0: the fast gradient serves a filter and the next move, for it does not depend on t */
  int keeps;
  double h;                 /* of the filters below, or of their polynomials; 0: of none */
  dvi__filter *filter;      /* [n] of the modes */
  double *V_q, *y, *nearby; /* [n] work */
} dvi__oscillation;

/* DVI_UNSUPPORTED if a fast potential is not declared quadratic, and `remedy` says what else can be
 * done, or if polynomials cannot serve; DVI_SINGULAR if a mass is not positive. The filters must
 * outlive it. */
dvi_status dvi__oscillation_create(dvi__stepper *self, const dvi__filters *filters,
                                   dvi__motion motion, const char *remedy);
void dvi__oscillation_destroy(dvi__stepper *self);
void dvi__oscillation_explain(const dvi__stepper *self, dvi__text *text);

#endif
