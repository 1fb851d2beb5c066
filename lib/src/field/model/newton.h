/* Static states of a field with a potential. */
#ifndef DVI_FIELD_MODEL_NEWTON_H
#define DVI_FIELD_MODEL_NEWTON_H
#include "field/model/field.h"

/* Solve K x + w V_u(x) = load by KINSOL from x [unknowns], with a KLU factor of the Jacobian. Sets
 * iterations and residual of the report. DVI_NOT_CONVERGED, DVI_NO_MEMORY. */
dvi_status dvi__field_newton(const dvi_field *field, double *x, dvi_field_solve_report *report);

#endif
