/* The options of galerkin on shares. */
#ifndef DVI_FIELD_IMPLICIT_OPTIONS_H
#define DVI_FIELD_IMPLICIT_OPTIONS_H
#include "field/implicit/step.h"

/* Find the rule of galerkin with options such as "degree=2,quadrature=gauss", or "".
 * DVI_UNSUPPORTED for what there is on whole meshes alone, or nowhere. */
dvi_status dvi__galerkin_rule(const char *options, const dvi__rule **rule);

#endif
