/* The kind of march with equal steps for all cells. */
#ifndef DVI_FIELD_STEP_LEAPFROG_H
#define DVI_FIELD_STEP_LEAPFROG_H
#include "field/step/bound.h"

/* Create a march. DVI_BAD_ARGUMENT if the step is not stable. */
dvi_status dvi__leapfrog_create(const dvi_field *field, const dvi__march_plan *plan,
                                dvi_march **march);

#endif
