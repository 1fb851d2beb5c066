/* The inside of an evaluator, for its own files and the kinds of dynamics. */
#ifndef DVI_SYSTEM_EVALUATOR_STRUCT_H
#define DVI_SYSTEM_EVALUATOR_STRUCT_H
#include "system/evaluate/evaluator.h"
#include "system/term/term.h"

struct dvi__evaluator {
  const dvi_system *system;
  int capacity;
  dvi_counters *counters;
  dvi_counters own_counters; /* counts if nobody else wants them */
  dvi__scratch scratch;
  double *term;     /* one term's gradient or Hessian, before it is added to the others */
  int has_hessians; /* both have room for potentials' Hessians */
  double *point[3]; /* [n] for work at one point */
  /* factors the matrix by which the kind of dynamics finds velocities; NULL: there is none */
  dvi__linear *velocity;
  /* general Lagrangians: takes the half of a gradient that nobody asked for */
  double *unwanted;
  /* general Lagrangians: its own L_qq, L_qv, L_vv at one point, for the inverse Legendre map */
  double *hessian[3];
  double *velocity_search; /* general Lagrangians: [6 n], its work */
  void *own;               /* the memory of the kind of dynamics */
};

/* Move the points that differences asked for to the counters. */
void dvi__count_differences(dvi__evaluator *e);

#endif
