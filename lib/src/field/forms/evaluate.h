/* Whitney's interpolation as weights. */
#ifndef DVI_FIELD_FORMS_EVALUATE_H
#define DVI_FIELD_FORMS_EVALUATE_H
#include "field/forms/assemble.h"

/* Give the faces of degree k of an n-cell, and the weights of a form's integrals over them in the
 * product of its value at a place with `along` [components]. Returns the number of faces, or 0 if
 * the cell has no volume. Arguments are those of dvi_form_evaluate. */
int dvi__form_weights(const dvi_mesh *mesh, int k, int64_t cell, const double *place,
                      const double *along, int *face, double *weight);

#endif
