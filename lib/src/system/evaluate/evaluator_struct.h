/* The inside of an evaluator, for its own files and the kinds of dynamics. */
#ifndef DVI_SYSTEM_EVALUATE_EVALUATOR_STRUCT_H
#define DVI_SYSTEM_EVALUATE_EVALUATOR_STRUCT_H
#include "system/evaluate/evaluator.h"
#include "system/term/term.h"

struct dvi__evaluator {
  const dvi_system *system;
  int capacity;
  dvi_counters *counters;
  dvi_counters own_counters; /* used if the caller passes none */
  dvi__scratch scratch;
  double *term;       /* one term's gradient or Hessian, before addition to the others */
  double *force_by_v; /* F_v of one force, or NULL */
  int has_hessians;   /* scratch and term have room for potentials' Hessians */
  /* work [n] at one point; for a diagonal mass and potentials NULL, but for the last one, which
   * dvi__evaluator_prepare_symmetries makes */
  double *point[3];
  /* Factors the matrix by which the kind of dynamics finds velocities, or NULL. */
  dvi__linear *velocity;
  /* Receives the half of a general Lagrangian's gradient that nobody needs. */
  double *unwanted;
  /* L_qq, L_qv, L_vv of a general Lagrangian at one point, for the inverse Legendre map. */
  double *hessian[3];
  double *velocity_search; /* work [6 n] of general Lagrangians */
  void *own;               /* memory of the kind of dynamics */
  void *rows;              /* memory of holonomic constraints, or NULL */
  /* A time in which the motion bends little, or 0 if none is known. Derivatives along the motion
   * are then differences over a part of it. */
  double span;
};

/* Add the points at which differences evaluated a function to the counters. */
void dvi__count_differences(dvi__evaluator *e);

/* Move the entries of the Lagrangian's own block, which are packed at the front of the whole L_qq,
 * to their places, from the back. */
void dvi__spread_entries(const dvi_system *system, size_t points, double *L_qq);

#endif
