/* Modes of fields. */
#ifndef DVI_FIELD_MODEL_SPECTRUM_H
#define DVI_FIELD_MODEL_SPECTRUM_H
#include "field/algebra/modes.h"
#include "field/model/field.h"

/* Give a shift below 0 of the size of the lowest eigenvalues, which makes K definite. */
double dvi__shift_below_zero(const dvi_field *field);

/* Spread vectors of unknowns over all cells, `mode` [count*cells], with 0 where the field is held.
 * NULL is left alone. */
void dvi__spread_modes(const dvi_field *field, int count, const double *vector, double *mode);

/* Find the modes of a form of degree 1, without those of frequency zero. The arguments are those of
 * dvi_field_modes. */
dvi_status dvi__field_modes_of_form(const dvi_field *field, const dvi_modes_options *options,
                                    double *eigenvalue, double *mode, int64_t *zeros);

#endif
