/* The kind of march with steps of their own for all cells. */
#ifndef DVI_FIELD_AVI_MARCH_H
#define DVI_FIELD_AVI_MARCH_H
#include <dvi/march.h>

#include "field/step/bound.h"

/* Create a march. Options are "classes=yes" or "no", and "band=NUMBER". DVI_BAD_OPTION,
 * DVI_UNSUPPORTED for stars that are not diagonal, DVI_BAD_ARGUMENT if the steps are not stable. */
dvi_status dvi__avi_march_create(const dvi_field *field, const dvi__march_plan *plan,
                                 dvi_march **march);

/* Find the growth under the steps of such a march, for dvi_field_stability. */
dvi_status dvi__avi_march_stability(const dvi_field *field, const dvi__march_plan *plan,
                                    double span, dvi_stability *report);

#endif
