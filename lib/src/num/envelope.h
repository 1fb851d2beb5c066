/* Cholesky's factor of a sparse symmetric positive definite matrix, within its envelope: row i of C
 * begins where row i of the matrix does. Source: George and Liu 1981, sec. 4.2. */
#ifndef DVI_NUM_ENVELOPE_H
#define DVI_NUM_ENVELOPE_H
#include "core/status.h"
#include "num/pattern.h"

typedef struct dvi__envelope dvi__envelope;

/* Factor the matrix C C^T of a symmetric pattern and its values. The caller owns the factor.
 * DVI_SINGULAR if the matrix is not positive definite. The sentence names the row. */
dvi_status dvi__envelope_create(const dvi__pattern *pattern, const double *values,
                                dvi__envelope **factor);
void dvi__envelope_destroy(dvi__envelope **factor);

/* Replace x [n] by C x. */
void dvi__envelope_product(const dvi__envelope *factor, double *x);

#endif
