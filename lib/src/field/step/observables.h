/* What can be observed of every march of a field on a mesh: its probes, and the laws of charge. */
#ifndef DVI_FIELD_STEP_OBSERVABLES_H
#define DVI_FIELD_STEP_OBSERVABLES_H
#include "field/model/field.h"

/* The charge of a form of degree 1 or more, d^T M E on the cells of degree k-1 that touch no cell
 * that is held. Currents move it. Its numbers belong to the state of a march. */
typedef struct dvi__charge {
  const dvi_field *field;
  dvi_matrix d;      /* d_{k-1} */
  char *is_free;     /* [(k-1)-cells] */
  double *work;      /* [k-cells + unknowns + 2*(k-1)-cells] */
  double *delivered; /* [currents] integrals of the signals since the start */
  double *start;     /* [(k-1)-cells] the charge at the start */
} dvi__charge;

/* Return how many numbers `delivered` and `start` are together. Forms of degree 0 have no charge,
 * and only the first ones. */
int64_t dvi__charge_numbers(const dvi_field *field);

/* Prepare, with these numbers, which stay the caller's. On failure nothing is owned. */
dvi_status dvi__charge_create(const dvi_field *field, double *numbers, dvi__charge *charge);
void dvi__charge_clear(dvi__charge *charge);

/* Take the charge of E [k-cells] as that of the start. Conductors and walls let pass what S times
 * the integral of E [k-cells] changes by. It is NULL without damping. */
void dvi__charge_start(dvi__charge *charge, const double *E, const double *integral);

/* Give the largest error of the charge of E, beside the largest sum of the sizes of its terms. */
dvi_status dvi__charge_error(const dvi__charge *charge, const double *E, const double *integral,
                             double *error);

/* The observables: "energy", "gauss" of forms of degree 1 or more, and the probes. */
int dvi__field_observables(const dvi_field *field);
const char *dvi__field_observable(const dvi_field *field, int i);

/* The functions by which a march answers. */
typedef struct dvi__observed {
  dvi__field_sampler *sample;
  dvi_status (*energy)(const void *of, double *energy);
  dvi_status (*charge_error)(const void *of, double *error); /* NULL for forms of degree 0 */
  const void *of;
} dvi__observed;
dvi_status dvi__field_observe(const dvi_field *field, const dvi__observed *march, int i,
                              double *value);

#endif
