/* A field that advances over an unstructured mesh of spacetime, which grows tent by tent. */
#ifndef DVI_FIELD_TENTS_TENTS_H
#define DVI_FIELD_TENTS_TENTS_H
#include <dvi/march.h>

#include "field/step/bound.h"

/* How tents are pitched. Zero means the default. */
typedef struct dvi__tents_options {
  /* of light's slope and of local stable steps, by which ends of an edge may be apart. Default:
   * 0.5 */
  double fraction;
  double least;  /* tents rise at random by this part of what is allowed, or more. Default: 1 */
  uint64_t seed; /* of the random rises */
  double band;   /* by which the energy of a march may grow until it stops. Default: 2 */
} dvi__tents_options;

/* What tents are pitched over, and which form. All arrays are copied. */
typedef struct dvi__tents_terms {
  /* circumcentric, on simplices of space. factor[k] is eps, and factor[k+1] is 1/mu */
  const dvi_star *star;
  int k;               /* degree, from 0 to n - 1 */
  const int8_t *held;  /* [k-cells] 1 where A keeps its start, or NULL */
  const double *force; /* [k-cells] constant, on waves: the action has force.A. NULL for 0 */
} dvi__tents_terms;

typedef struct dvi__tents dvi__tents;

/* Prepare, with A = 0 at t = 0. DVI_BAD_ARGUMENT, DVI_UNSUPPORTED, DVI_SINGULAR if an entry of M_k
 * is not positive, DVI_NO_MEMORY. */
dvi_status dvi__tents_create(const dvi__tents_terms *terms, const dvi__tents_options *options,
                             dvi__tents **tents);
void dvi__tents_destroy(dvi__tents **tents);

/* Start from values that are finite (dvi_march_start). */
void dvi__tents_start(dvi__tents *tents, const dvi_march_state *state);

/* Pitch all tents whose tops are not above t. DVI_SINGULAR, with the place, if the row of a cell
 * does not determine its value. DVI_NOT_FINITE. On failure nothing changes. */
dvi_status dvi__tents_advance(dvi__tents *tents, double t);

/* Pitch one tent, and tell its vertex and the new time there. Statuses as above. */
dvi_status dvi__tents_pitch(dvi__tents *tents, int *vertex, double *top);

/* Give a form at the time of the last call of dvi__tents_advance. Statuses as there. */
dvi_status dvi__tents_sample(const dvi__tents *tents, dvi_march_form form, int64_t count,
                             const int *cell, double *values);

/* Give the energy E.M_k E/2 + B.M_{k+1} B/2 - force.A then. */
dvi_status dvi__tents_energy(const dvi__tents *tents, double *energy);

/* Return -force.A of the last call of dvi__tents_energy. */
double dvi__tents_force_energy(const dvi__tents *tents);

/* Give the largest change of a charge since the start, d_{k-1}^T M_k E on cells of degree k - 1 at
 * which nothing is held, beside the largest sum of the sizes of its terms. 0 for k = 0. */
double dvi__tents_charge_error(const dvi__tents *tents);

/* Find the growth of fields, as dvi_field_stability does, under tents. Their state and force are
 * lost. */
dvi_status dvi__tents_stability(dvi__tents *tents, double span, dvi_stability *report);

/* Create a march of tents, whose options are "least=0.5,seed=3,band=2" or a part of them.
 * DVI_BAD_OPTION, DVI_UNSUPPORTED for fields with currents or losses, and as dvi__tents_create. The
 * field outlives the march. Its energy is judged by dvi__judge_growth once in 64 of the highest
 * tents. */
dvi_status dvi__tents_march(const dvi_field *field, const dvi__march_plan *plan, dvi_march **march);

/* Find the growth under the tents of such a march, for dvi_field_stability. */
dvi_status dvi__tents_march_stability(const dvi_field *field, const dvi__march_plan *plan,
                                      double span, dvi_stability *report);

#endif
