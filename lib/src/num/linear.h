/* Linear systems A x = b with a pattern that is fixed at create: dense LU (LAPACK) or sparse LU (KLU). */
#ifndef DVI_NUM_LINEAR_H
#define DVI_NUM_LINEAR_H
#include <dvi/integrator.h>

#include "num/pattern.h"

typedef struct dvi__linear dvi__linear;

typedef enum dvi__linear_kind {
  DVI__LINEAR_AUTO,
  DVI__LINEAR_DENSE,
  DVI__LINEAR_SPARSE,
  DVI__LINEAR_COMPLEX /* sparse; an entry, and a number of b, is a pair: real part, imaginary part */
} dvi__linear_kind;

/* The pattern must outlive the solver. counters (symbolic, factorizations, solves) may be NULL. AUTO is dense for nearly
 * full matrices that are not small. The symbolic analysis happens here, once. */
dvi_status dvi__linear_create(const dvi__pattern *pattern, dvi__linear_kind kind, dvi_counters *counters, dvi__linear **linear);

/* Sparse, but for the last `border` rows and columns, which may be full; work and memory in proportion to the size all the same. */
dvi_status dvi__linear_create_bordered(const dvi__pattern *pattern, int border, dvi_counters *counters, dvi__linear **linear);

/* For the pattern of another solver, sparse or complex, which must outlive this one: its analysis serves both. Not AUTO or DENSE. */
dvi_status dvi__linear_create_like(const dvi__linear *like, dvi__linear_kind kind, dvi_counters *counters, dvi__linear **linear);

/* The kind for a matrix that may have zeros on its diagonal: the order of the pivots, on which KLU settles at create, would fail it, and each
 * factorisation would search for another one, on the heap. Dense, with LAPACK's row exchanges, as long as that is no slower. */
dvi__linear_kind dvi__linear_for_exchanges(const dvi__pattern *pattern);

void dvi__linear_destroy(dvi__linear **linear);

/* Not DVI__LINEAR_AUTO. */
dvi__linear_kind dvi__linear_kind_of(const dvi__linear *linear);

/* Factor the matrix with these values, in the order of the pattern; rows and columns are equilibrated first. DVI_SINGULAR if it is
 * singular to working precision, DVI_NOT_FINITE, DVI_NO_MEMORY (KLU's own); the old factor is lost then. */
dvi_status dvi__linear_factor(dvi__linear *linear, const double *values);

/* The sign of the determinant of the matrix that was factored last, 1 or -1; it must be real, and without a border. */
int dvi__linear_sign(const dvi__linear *linear);

/* Whether the matrix that was factored last, a symmetric one, is positive (sign 1) or negative (-1)
 * definite; 0, too, where that is not known: of all that are not DVI__LINEAR_SPARSE (num/eigen.h). */
int dvi__linear_is_definite(const dvi__linear *linear, int sign);

/* Overwrite b [rows, or pairs of them] by the solution. Needs a factor. */
void dvi__linear_solve(dvi__linear *linear, double *b);

#endif
