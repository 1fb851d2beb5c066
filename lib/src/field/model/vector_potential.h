/* Potentials of a field B on the shares of several processes. */
#ifndef DVI_FIELD_MODEL_VECTOR_POTENTIAL_H
#define DVI_FIELD_MODEL_VECTOR_POTENTIAL_H
#include "field/model/field.h"

/* Equations K A = d^T M_{k+1} B of a potential, with room. */
typedef struct dvi__inverse {
  const dvi_field *field;
  dvi_matrix d, M;
  const double *B;
  double *right, *x; /* [unknowns] */
  double *H, *curl;  /* [(k+1)-cells], [k-cells] */
} dvi__inverse;

/* Solve on all processes together. B of others' cells has been refreshed. Of all potentials x is
 * the one without charge, or of 0-forms without a mean, by M_k. */
dvi_status dvi__potential_on_all(dvi__inverse *inverse);

#endif
