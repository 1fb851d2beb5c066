/* Coefficients of functions on products of axes. */
#ifndef DVI_FIELD_SPACE_INTERPOLATE_H
#define DVI_FIELD_SPACE_INTERPOLATE_H
#include "field/space/kind.h"

/* dvi__domain's `interpolate` of boxes. */
dvi_status dvi__box_interpolate(const dvi_space *space, const dvi__sampled *sampled, double *U);

#endif
