/* Linear systems A x = b behind one interface. A is a matrix with a pattern that is fixed at
 * create, or an operator that is known by its products.
 *
 * A solver allocates memory when it is first needed. Create only notes the arguments. The first
 * factorisation analyses the pattern and allocates the factor once for all later ones. */
#ifndef DVI_NUM_LINEAR_H
#define DVI_NUM_LINEAR_H
#include <dvi/integrator.h>

#include "num/pattern.h"

typedef struct dvi__linear dvi__linear;

typedef enum dvi__linear_kind {
  DVI__LINEAR_AUTO,
  DVI__LINEAR_DENSE,  /* LU by LAPACK */
  DVI__LINEAR_SPARSE, /* LU by KLU */
  /* LU by KLU of entries that are pairs of numbers, real part and imaginary part */
  DVI__LINEAR_COMPLEX,
  DVI__LINEAR_DEFINITE,  /* LDL^T by LDL of symmetric positive definite matrices */
  DVI__LINEAR_ITERATIVE, /* GMRES with an operator */
} dvi__linear_kind;

/* A matrix that is known by its products, with another one that is near its inverse. */
typedef struct dvi__operator {
  int size;
  void *of; /* first argument of the functions */
  /* Set y [size] to A x. */
  void (*times)(void *of, const double *x, double *y);
  /* Prepare both functions for another A. DVI_SINGULAR. May be NULL. */
  dvi_status (*renew)(void *of);
  /* Replace r [size] by P^-1 r with P near A. NULL if P is the identity. */
  void (*precondition)(void *of, double *r);
  /* dvi__linear_sign and dvi__linear_is_definite of P, because A is near it. NULL if not known. */
  int (*sign)(void *of);
  int (*is_definite)(void *of, int sign);
} dvi__operator;

/* Create a solver of a matrix. The pattern must outlive the solver. counters (symbolic,
 * factorizations, solves, preparations) may be NULL. AUTO is dense for nearly full matrices that
 * are not small. */
dvi_status dvi__linear_create(const dvi__pattern *pattern, dvi__linear_kind kind,
                              dvi_counters *counters, dvi__linear **linear);

/* Create a solver of a symmetric matrix, and factor the matrix with these values. The kind is
 * DEFINITE where a sparse one is positive definite, which saves half of the work or more, else that
 * of AUTO. Fails like dvi__linear_factor. */
dvi_status dvi__linear_create_symmetric(const dvi__pattern *pattern, const double *values,
                                        dvi_counters *counters, dvi__linear **linear);

/* Create a sparse solver of a matrix whose last `border` rows and columns may be full. Work and
 * memory are in proportion to the size all the same. */
dvi_status dvi__linear_create_bordered(const dvi__pattern *pattern, int border,
                                       dvi_counters *counters, dvi__linear **linear);

/* Create a solver for the pattern of another one, SPARSE or COMPLEX, which must outlive this one
 * and whose analysis serves both. `kind` is one of these two. */
dvi_status dvi__linear_create_like(dvi__linear *like, dvi__linear_kind kind, dvi_counters *counters,
                                   dvi__linear **linear);

/* Create a DEFINITE solver of the matrix that another one has factored. It has work of its own, so
 * that threads may solve beside each other, and is not to factor. The other one must outlive it,
 * with its factor. */
dvi_status dvi__linear_share(const dvi__linear *factored, dvi_counters *counters,
                             dvi__linear **linear);

/* Create a solver of an operator, which is copied. dvi__linear_factor does not read values then. */
dvi_status dvi__linear_create_iterative(const dvi__operator *A, dvi_counters *counters,
                                        dvi__linear **linear);

/* Give the kind for a matrix that may have zeros on its diagonal. KLU settles on an order of the
 * pivots once, which would fail for this matrix. Each factorisation would search for another one,
 * on the heap. The kind is dense, with LAPACK's row exchanges, as long as that is no slower. */
dvi__linear_kind dvi__linear_for_exchanges(int columns);

void dvi__linear_destroy(dvi__linear **linear);

/* Give the kind of a solver, which is never DVI__LINEAR_AUTO. */
dvi__linear_kind dvi__linear_kind_of(const dvi__linear *linear);

/* Cost of a factor, 0 where not known. */
typedef struct dvi__linear_cost {
  double entries;    /* numbers in L and U */
  double operations; /* additions and multiplications of its numbers in a factorisation */
} dvi__linear_cost;

/* Analyse the pattern now, unless that is done, without memory for a factor. DVI_NO_MEMORY,
 * DVI_SOLVER_FAILED. */
dvi_status dvi__linear_analyse(dvi__linear *linear);

/* Describe the solver in words, and its cost as far as the analysis tells it. */
const char *dvi__linear_name(const dvi__linear *linear);
dvi__linear_cost dvi__linear_cost_of(const dvi__linear *linear);

/* Factor the matrix with these values, in the order of the pattern. Rows and columns are
 * equilibrated first. DVI_SINGULAR if it is singular to working precision, or a DEFINITE one is not
 * positive definite, DVI_NOT_FINITE,
 * DVI_NO_MEMORY (the first time, later KLU's own), DVI_BAD_SIZE. A failure loses the old factor. */
dvi_status dvi__linear_factor(dvi__linear *linear, const double *values);

/* Give the sign, 1 or -1, of the determinant of the matrix that was factored last, which must be
 * real. 0 if not known, as for a matrix with a border and for operators without a sign. */
int dvi__linear_sign(const dvi__linear *linear);

/* Give the logarithm of |det| of a COMPLEX matrix, which was factored last. */
double dvi__linear_log_determinant(const dvi__linear *linear);

/* Give an estimate of the reciprocal condition of the equilibrated matrix that was factored last, 1
 * if none is known. That of a sparse one is the ratio of its smallest and largest pivot, that of a
 * DEFINITE one the smallest ratio of a pivot and its entry of the diagonal. */
double dvi__linear_condition(const dvi__linear *linear);

/* Tell whether the matrix that was factored last, a symmetric one, is positive (sign 1) or negative
 * (-1) definite. 0 also where that is not known. It is known for SPARSE ones without a border, and
 * for operators with that function. num/eigen.h tests full ones. */
int dvi__linear_is_definite(const dvi__linear *linear, int sign);
int dvi__linear_tells_definite(const dvi__linear *linear);

/* Overwrite b [rows, or pairs of them] by the solution. Needs a factor. DVI_OK for matrices.
 * DVI_NOT_CONVERGED if an iterative solver stops early, as it does where A is singular or P is far
 * from A. b is the best solution found then. */
dvi_status dvi__linear_solve(dvi__linear *linear, double *b);

#endif
