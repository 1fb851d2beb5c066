/* Implicit methods of shares by their names and options. */
#ifndef DVI_FIELD_IMPLICIT_METHODS_H
#define DVI_FIELD_IMPLICIT_METHODS_H
#include "field/step/bound.h"

/* Create a march. DVI_UNSUPPORTED for a whole mesh, whose system has the same methods, and for
 * options of galerkin that there are on whole meshes alone. */
dvi_status dvi__midpoint_create(const dvi_field *field, const dvi__march_plan *plan,
                                dvi_march **march);
dvi_status dvi__imex_create(const dvi_field *field, const dvi__march_plan *plan, dvi_march **march);
dvi_status dvi__galerkin_create(const dvi_field *field, const dvi__march_plan *plan,
                                dvi_march **march);

#endif
