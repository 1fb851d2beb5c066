/* Implicit marches of waves on shares of a mesh, with potentials, too. */
#ifndef DVI_FIELD_IMPLICIT_MARCH_H
#define DVI_FIELD_IMPLICIT_MARCH_H
#include "field/step/bound.h"

/* Create a march. DVI_UNSUPPORTED for a whole mesh, whose system has the same methods. */
dvi_status dvi__midpoint_create(const dvi_field *field, const dvi__march_plan *plan,
                                dvi_march **march);
dvi_status dvi__imex_create(const dvi_field *field, const dvi__march_plan *plan, dvi_march **march);
dvi_status dvi__galerkin_create(const dvi_field *field, const dvi__march_plan *plan,
                                dvi_march **march);

#endif
