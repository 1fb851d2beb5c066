/* Kinds of solvers behind num/linear.h, one const struct and one file each. Those of matrices see
 * finite values, equilibrated unless they are free of scales. */
#ifndef DVI_NUM_FACTOR_H
#define DVI_NUM_FACTOR_H
#include <float.h>

#include "num/linear.h"

/* Smallest reciprocal condition of an equilibrated matrix that is not called singular. Solutions
 * have no right digit left there. */
#define DVI__LEAST_RCOND (16 * DBL_EPSILON)

/* The matrix or operator that a factor is made for. */
typedef struct dvi__factor_form {
  const dvi__pattern *pattern; /* NULL for an operator */
  /* a sparse factor of the same pattern, or NULL; it outlives this one, which uses its analysis */
  const void *like;
  int border; /* number of last rows and columns that may be full */
  const dvi__operator *A;
} dvi__factor_form;

typedef struct dvi__factor_kind {
  const char *name;
  int scale_free; /* rows and columns need no equilibration */
  /* Analyse the matrix. Memory for numbers may wait for the first `refactor`. */
  dvi_status (*create)(const dvi__factor_form *form, void **factor);
  void (*destroy)(void *factor);
  /* Factor. DVI_SINGULAR with a sentence if the reciprocal condition is below DVI__LEAST_RCOND. */
  dvi_status (*refactor)(void *factor, const dvi__pattern *pattern, const double *values);
  /* DVI_NOT_CONVERGED with a sentence if an iteration leaves too much. */
  dvi_status (*solve)(void *factor, const dvi__pattern *pattern, double *b);
  /* dvi__linear_sign and dvi__linear_is_definite, or NULL if not known. */
  int (*sign)(const void *factor, const dvi__pattern *pattern);
  int (*is_definite)(const void *factor, const dvi__pattern *pattern, int sign);
  /* dvi__linear_condition, or NULL if not known */
  double (*condition)(const void *factor);
  /* The logarithm of |det| of the matrix that was factored last, or NULL if not known. */
  double (*log_determinant)(const void *factor, const dvi__pattern *pattern);
  /* NULL if not known. */
  dvi__linear_cost (*cost)(const void *factor, const dvi__pattern *pattern);
} dvi__factor_kind;

extern const dvi__factor_kind dvi__dense_factor;     /* dense.c */
extern const dvi__factor_kind dvi__sparse_factor;    /* klu.c */
extern const dvi__factor_kind dvi__complex_factor;   /* klu.c; values and b in pairs of numbers */
extern const dvi__factor_kind dvi__definite_factor;  /* ldl.c */
extern const dvi__factor_kind dvi__bordered_factor;  /* border.c */
extern const dvi__factor_kind dvi__iterative_factor; /* iterative.c */

/* The order [columns] in which dvi__definite_factor eliminates the columns of a pattern.
 * DVI_NO_MEMORY. */
dvi_status dvi__definite_order(const dvi__pattern *pattern, int *order);

/* dvi__linear_share for a factor of dvi__definite_factor. DVI_NO_MEMORY. */
dvi_status dvi__definite_share(const void *factored, const dvi__pattern *pattern, void **factor);

#endif
