/* The inside of an evaluator, for evaluator.c, legendre.c and invariants.c. */
#ifndef DVI_SYSTEM_EVALUATOR_STRUCT_H
#define DVI_SYSTEM_EVALUATOR_STRUCT_H
#include "system/evaluate/evaluator.h"
#include "system/term/term.h"

struct dvi__evaluator {
  const dvi_system *system;
  int capacity;
  dvi_counters *counters;
  dvi_counters own; /* counts if nobody else wants them */
  dvi__scratch scratch;
  double *term;          /* one term's gradient or Hessian, before it is added to the others */
  double *point[3];      /* [n] for work at one point */
  dvi__linear *velocity; /* factors L_vv, the constant sparse mass, a two-form or a bracket matrix; NULL if there is none of them */
  double *two_form;      /* one-forms: its entries */
  double *unwanted;      /* general Lagrangians: takes the half of a gradient that nobody asked for */
  double *hessian[3];    /* general Lagrangians: its own L_qq, L_qv, L_vv at one point, for the inverse Legendre map */
  struct dvi__dirac *dirac; /* Hamiltonians: their constraints' part */
  /* With factors, if states will be asked for: the charts at a state, and the mass there, which `velocity` factors. */
  struct dvi__charted *charted;
  double *mass;
  double *rate, *local;    /* [n] work */
  double *velocity_search; /* general Lagrangians: [6 n], its work */
};

/* Move the points that differences asked for to the counters. */
void dvi__count_differences(dvi__evaluator *e);

#endif
