/** How large the terms are that make an invariant: a sum whose terms cancel is 0 up to rounding,
 *  and no part of that is an error.
 *
 *  The scale is by how much the invariant changes, on average, if each number of the state, by
 *  chance, goes back to the start or not. A constant that the invariant may hold plays no part. */
#ifndef NATURAL_SCALE_H
#define NATURAL_SCALE_H
#include <stdbool.h>

#include "problem.h"

typedef struct natural_scale {
  const problem *scene;
  int invariants, looks;
  unsigned chance;
  double *room;            /**< owned; the others are in it */
  double *start, *mixed;   /**< [nq + nv] */
  double *value, *changed; /**< [invariants] mixed; the sum of changes */
} natural_scale;

/** Begin at a state. False without memory, with a complaint; clear it in any case. */
bool natural_scale_start(natural_scale *scale, const problem *scene,
                         const dvi_integrator *integrator);
void natural_scale_clear(natural_scale *scale);

/** Look at the integrator's state. Where the mixed one is not possible (of a manifold), nothing
 *  is seen. */
void natural_scale_look(natural_scale *scale, dvi_integrator *integrator);

/** Of an invariant; 0 where nothing was seen. */
double natural_scale_of(const natural_scale *scale, int invariant);
#endif
