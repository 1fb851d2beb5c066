/* Marches of waves on shares of a mesh by implicit steps (field/implicit/step.h), with potentials,
 * too. */
#ifndef DVI_FIELD_IMPLICIT_MARCH_H
#define DVI_FIELD_IMPLICIT_MARCH_H
#include "field/implicit/step.h"
#include "march/kind.h"

/* Methods by their names. */
typedef enum dvi__implicit_method {
  DVI__IMPLICIT_MIDPOINT,
  DVI__IMPLICIT_IMEX,
  DVI__IMPLICIT_GALERKIN
} dvi__implicit_method;

typedef struct dvi__implicit_plan {
  dvi__implicit_method method;
  const dvi__rule *rule;
  double dt;
} dvi__implicit_plan;

/* Create a march of a share. Called on all processes. */
dvi_status dvi__implicit_create(const dvi_field *field, const dvi__implicit_plan *plan,
                                dvi_march **march);

#endif
