/* The coefficient in the fine cells of a box. */
#ifndef DVI_FIELD_MULTISCALE_SAMPLE_H
#define DVI_FIELD_MULTISCALE_SAMPLE_H
#include "field/multiscale/coefficient.h"
#include "field/multiscale/fine_axis.h"

/* Set a [parts of axis 0 * parts of axis 1] to the coefficient at the centres of the fine cells,
 * and `defect` to the largest change of the means of a and 1/a over a coarse cell when there are
 * twice as many parts. DVI_BAD_OPTION if it shows that the coefficient is not resolved,
 * DVI_CALLBACK_FAILED, DVI_NOT_FINITE, DVI_NO_MEMORY. */
dvi_status dvi__coefficient_of_cells(const dvi__fine_axis axis[2],
                                     const dvi__coefficient *coefficient, double *a,
                                     double *defect);

#endif
