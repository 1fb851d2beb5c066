/* Linear systems A x = b behind one door. A is a matrix with a pattern that is fixed at create, or
 * an operator that is known by its products.
 *
 * A solver takes memory when it is first needed: at create it only notes what it is for. The first
 * factorisation analyses the pattern and makes room for the factor, once; all later ones find
 * it. */
#ifndef DVI_NUM_LINEAR_H
#define DVI_NUM_LINEAR_H
#include <dvi/integrator.h>

#include "num/pattern.h"

typedef struct dvi__linear dvi__linear;

typedef enum dvi__linear_kind {
  DVI__LINEAR_AUTO,
  DVI__LINEAR_DENSE,     /* LU by LAPACK */
  DVI__LINEAR_SPARSE,    /* LU by KLU */
  DVI__LINEAR_COMPLEX,   /* the same of pairs of numbers: real part, imaginary part */
  DVI__LINEAR_ITERATIVE, /* GMRES, of an operator */
} dvi__linear_kind;

/* A matrix that is known by its products, with one that is near its inverse. */
typedef struct dvi__operator {
  int size;
  void *of; /* first argument of the functions */
  /* y [size] = A x. */
  void (*times)(void *of, const double *x, double *y);
  /* A is another one from now on: make ready for both functions. DVI_SINGULAR. May be NULL. */
  dvi_status (*renew)(void *of);
  /* r [size] <- P^-1 r with P near A. NULL: P is the identity. */
  void (*precondition)(void *of, double *r);
  /* Of P, for A is near it: as dvi__linear_sign and dvi__linear_is_definite. NULL: not known. */
  int (*sign)(void *of);
  int (*is_definite)(void *of, int sign);
} dvi__operator;

/* The pattern must outlive the solver. counters (symbolic, factorizations, solves, preparations)
 * may be NULL. AUTO is dense for nearly full matrices that are not small. */
dvi_status dvi__linear_create(const dvi__pattern *pattern, dvi__linear_kind kind,
                              dvi_counters *counters, dvi__linear **linear);

/* Sparse, but for the last `border` rows and columns, which may be full; work and memory in
 * proportion to the size all the same. */
dvi_status dvi__linear_create_bordered(const dvi__pattern *pattern, int border,
                                       dvi_counters *counters, dvi__linear **linear);

/* For the pattern of another solver, SPARSE or COMPLEX, which must outlive this one: its analysis
 * serves both. `kind` is one of these two. */
dvi_status dvi__linear_create_like(dvi__linear *like, dvi__linear_kind kind, dvi_counters *counters,
                                   dvi__linear **linear);

/* The operator is copied. Values for dvi__linear_factor are not asked for. */
dvi_status dvi__linear_create_iterative(const dvi__operator *A, dvi_counters *counters,
                                        dvi__linear **linear);

/* The kind for a matrix that may have zeros on its diagonal: the order of the pivots, on which KLU
 * settles once, would fail it, and each factorisation would search for another one, on the heap.
 * Dense, with LAPACK's row exchanges, as long as that is no slower. */
dvi__linear_kind dvi__linear_for_exchanges(const dvi__pattern *pattern);

void dvi__linear_destroy(dvi__linear **linear);

/* Not DVI__LINEAR_AUTO. */
dvi__linear_kind dvi__linear_kind_of(const dvi__linear *linear);

/* What a factor costs; 0: not known. */
typedef struct dvi__linear_cost {
  double entries;    /* of L and U */
  double operations; /* of a factorisation: additions and multiplications of its numbers */
} dvi__linear_cost;

/* Analyse the pattern now, if it is not, and take no memory for a factor. DVI_NO_MEMORY,
 * DVI_SOLVER_FAILED. */
dvi_status dvi__linear_analyse(dvi__linear *linear);

/* The solver in words; and its cost, as far as the analysis tells it. */
const char *dvi__linear_name(const dvi__linear *linear);
dvi__linear_cost dvi__linear_cost_of(const dvi__linear *linear);

/* Factor the matrix with these values, in the order of the pattern; rows and columns are
 * equilibrated first. DVI_SINGULAR if it is singular to working precision, DVI_NOT_FINITE,
 * DVI_NO_MEMORY (the first time; later KLU's own), DVI_BAD_SIZE; the old factor is lost then. */
dvi_status dvi__linear_factor(dvi__linear *linear, const double *values);

/* The sign of the determinant of the matrix that was factored last, 1 or -1; it must be real. 0:
 * not known, of a matrix with a border, and of operators that do not say it. */
int dvi__linear_sign(const dvi__linear *linear);

/* Whether the matrix that was factored last, a symmetric one, is positive (sign 1) or negative (-1)
 * definite; 0, too, where that is not known. It is known of SPARSE ones without a border, and of
 * operators that say it; of full ones num/eigen.h tells. */
int dvi__linear_is_definite(const dvi__linear *linear, int sign);
int dvi__linear_tells_definite(const dvi__linear *linear);

/* Overwrite b [rows, or pairs of them] by the solution. Needs a factor. An iterative solver may
 * stop short of it where P is far from A: b is the best one found then. */
void dvi__linear_solve(dvi__linear *linear, double *b);

#endif
