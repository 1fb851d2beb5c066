/** The size of the terms that make an invariant. A sum whose terms cancel is 0 up to rounding, and
 * no part of it could serve as a scale.
 *
 * The scale is the mean change of the invariant if each number of the state is replaced at random
 * by its value at the start. A constant in the invariant plays no part. For the energy, but that of
 * one-forms, all coordinates go back at once: a net or a field that is mixed point by point is
 * rough, and its energy far above that of the motion. */
#ifndef NATURAL_SCALE_H
#define NATURAL_SCALE_H
#include <stdbool.h>

#include "problem.h"

typedef struct natural_scale {
  const problem *scene;
  int invariants, looks;
  int apart, energy_looks; /**< 1 if the energy, invariant 0, is mixed otherwise, or 0 */
  unsigned chance;
  double *room;            /**< owned memory of the following arrays */
  double *start, *mixed;   /**< [nq + nv] */
  double *value, *changed; /**< [invariants] value at the mixed state, and sum of changes */
} natural_scale;

/** Start at a state. Complains and returns false without memory. Clear it in any case. */
bool natural_scale_start(natural_scale *scale, const problem *scene,
                         const dvi_integrator *integrator);
void natural_scale_clear(natural_scale *scale);

/** Sample the integrator's state. Nothing is sampled if the mixed state is not possible on a
 * manifold. */
void natural_scale_look(natural_scale *scale, dvi_integrator *integrator);

/** Return the scale of an invariant, 0 without samples. */
double natural_scale_of(const natural_scale *scale, int invariant);
#endif
