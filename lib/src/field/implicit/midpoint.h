/* The implicit midpoint rule for fields on shares of a mesh, with potentials, too. */
#ifndef DVI_FIELD_IMPLICIT_MIDPOINT_H
#define DVI_FIELD_IMPLICIT_MIDPOINT_H
#include "field/step/bound.h"

/* Create the march. DVI_UNSUPPORTED for a whole mesh, whose system has the same method. */
dvi_status dvi__midpoint_create(const dvi_field *field, const dvi__march_plan *plan,
                                dvi_march **march);

#endif
