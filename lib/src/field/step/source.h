/* The source of a wave. */
#ifndef DVI_FIELD_STEP_SOURCE_H
#define DVI_FIELD_STEP_SOURCE_H
#include "field/model/field.h"

/* Give W f + b [unknowns], which the caller releases. NULL if it is zero, and for other fields. */
dvi_status dvi__wave_source(const dvi_field *field, double **source);

#endif
