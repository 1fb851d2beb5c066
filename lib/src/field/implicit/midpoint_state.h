/* The state of a march by the implicit midpoint rule, and what can be seen of it. */
#ifndef DVI_FIELD_IMPLICIT_MIDPOINT_STATE_H
#define DVI_FIELD_IMPLICIT_MIDPOINT_STATE_H
#include "field/implicit/midpoint_step.h"
#include "field/step/observables.h"
#include "field/step/saved.h"

typedef struct dvi__midpoint_march {
  const dvi_field *field;
  dvi__sweep sweep; /* neighbours of cells and faces, and M_{k+1} of Maxwell's fields */
  int64_t faces;    /* with B: of Maxwell's fields */
  dvi__midpoint_step *step, *shorter; /* the latter is made where it is needed */
  dvi__march_place at;
  double *numbers;
  dvi__midpoint_state last, shown; /* at t_n, and at the march's time */
  dvi__charge charge;
  double *E, *spare; /* [cells] */
  int is_lost;       /* processes could not give each other their values */
} dvi__midpoint_march;

/* Take the charge of what is shown as that of the start. */
void dvi__midpoint_begin_charge(dvi__midpoint_march *m);

/* The functions of dvi__march_kind. */
dvi_status dvi__midpoint_sample(const void *self, dvi_march_form form, int64_t count,
                                const int *cell, double *values);
int dvi__midpoint_observables(const void *self);
const char *dvi__midpoint_observable(const void *self, int i);
dvi_status dvi__midpoint_observe(const void *self, int i, double *value);

#endif
