/* Schroedinger's equation as a march. */
#ifndef DVI_FIELD_SCHROEDINGER_MARCH_H
#define DVI_FIELD_SCHROEDINGER_MARCH_H
#include "field/schroedinger/steps.h"
#include "march/kind.h"

/* The step by one of the methods. The other pointer is NULL. */
typedef struct dvi__wave_stepper {
  dvi__gauss *gauss;
  dvi__split *split;
} dvi__wave_stepper;

dvi_status dvi__wave_stepper_create(const dvi_schroedinger *s,
                                    const dvi__schroedinger_method *method, double h,
                                    dvi__wave_stepper *stepper);
void dvi__wave_stepper_destroy(dvi__wave_stepper *stepper);

/* What is shown at the march's time, beside its state. */
typedef struct dvi__view {
  int is_now, is_measured;
  dvi__wave_stepper stepper; /* of shorter steps, made when it is first needed */
  double *z;                 /* [2*free] */
  double *compensation;      /* [2*free] */
  double *psi;               /* [2*functions] */
  double *V, *u;             /* [points], [4*points] */
  double *work;
  dvi_schroedinger_values values;
} dvi__view;

enum { DVI__OBSERVABLE_NAME = 32 };

typedef struct dvi__wave_march {
  const dvi_schroedinger *s;
  dvi__schroedinger_method method;
  dvi__wave_stepper stepper;
  double dt, t0, t;
  double kinetic; /* the largest kinetic energy, of split with an interaction, else 0 */
  int64_t step;
  double *z, *compensation; /* [2*free] after whole steps */
  dvi__view *view;
  double *probe; /* [probes][dimension] */
  int probes, observables;
  char (*name)[DVI__OBSERVABLE_NAME]; /* [observables] */
} dvi__wave_march;

/* The sum of a few roundings of times, in steps. */
double dvi__wave_spare(const dvi__wave_march *m, double t);

/* Views, views.c. */
dvi_status dvi__wave_make_view(dvi__wave_march *m, const dvi_schroedinger_march_options *options);
void dvi__wave_clear_view(dvi__wave_march *m);
int64_t dvi__wave_size(const void *self, dvi_march_form form);
dvi_status dvi__wave_sample(const void *self, dvi_march_form form, int64_t count, const int *cell,
                            double *values);
int dvi__wave_observables(const void *self);
const char *dvi__wave_observable(const void *self, int i);
dvi_status dvi__wave_observe(const void *self, int i, double *value);

/* Files, files.c. */
dvi_status dvi__wave_save(const void *self, dvi__sections_writer *writer);
dvi_status dvi__wave_load(void *self, const dvi__sections *sections);

#endif
