/* The state of a march by implicit steps, and what can be seen of it. */
#ifndef DVI_FIELD_IMPLICIT_STATE_H
#define DVI_FIELD_IMPLICIT_STATE_H
#include "field/implicit/step.h"
#include "field/step/observables.h"
#include "field/step/saved.h"
#include "march/kind.h"

typedef struct dvi__implicit_march {
  const dvi__march_kind *kind;
  const dvi__rule *rule;
  const dvi_field *field;
  dvi__sweep sweep; /* neighbours of cells and faces, and M_{k+1} of Maxwell's fields */
  int64_t faces;    /* with B: of Maxwell's fields */
  dvi__implicit_step *step, *shorter; /* the latter is made where it is needed */
  dvi__march_place at;
  double *numbers;
  dvi__implicit_state last, shown; /* at t_n, and at the march's time */
  dvi__charge charge;
  double *E, *spare; /* [cells] */
  int is_lost;       /* values have overflowed, or processes could not exchange them */
} dvi__implicit_march;

/* Take the charge of what is shown as that of the start. */
void dvi__implicit_begin_charge(dvi__implicit_march *m);

/* The functions of dvi__march_kind. */
dvi_status dvi__implicit_sample(const void *self, dvi_march_form form, int64_t count,
                                const int *cell, double *values);
int dvi__implicit_observables(const void *self);
const char *dvi__implicit_observable(const void *self, int i);
dvi_status dvi__implicit_observe(const void *self, int i, double *value);

#endif
