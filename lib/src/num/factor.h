/* The two kinds of factorisation behind num/linear.h. They see finite, equilibrated values. */
#ifndef DVI_NUM_FACTOR_H
#define DVI_NUM_FACTOR_H
#include <float.h>

#include "num/linear.h"

/* Smallest reciprocal condition of an equilibrated matrix that is not called singular: its solutions have no right digit left. */
#define DVI__LEAST_RCOND (16 * DBL_EPSILON)

typedef struct dvi__factor_operations {
  /* `like`: a sparse factor of the same pattern, which outlives this one and whose analysis serves it, too; or NULL. */
  dvi_status (*create)(const dvi__pattern *pattern, const void *like, void **factor);
  /* Returns DVI_SINGULAR with a sentence if the reciprocal condition is below DVI__LEAST_RCOND. */
  dvi_status (*refactor)(void *factor, const dvi__pattern *pattern, const double *values);
  void (*solve)(void *factor, const dvi__pattern *pattern, double *b);
  void (*destroy)(void *factor);
  int (*sign)(const void *factor, const dvi__pattern *pattern); /* of the determinant; real factors without a border have it */
  /* dvi__linear_is_definite; NULL: not known */
  int (*is_definite)(const void *factor, const dvi__pattern *pattern, int sign);
} dvi__factor_operations;

extern const dvi__factor_operations dvi__dense_factor;   /* dense.c */
extern const dvi__factor_operations dvi__sparse_factor;  /* klu.c */
extern const dvi__factor_operations dvi__complex_factor; /* klu.c; values and b in pairs of numbers */

/* Of a matrix with a border; it has no `create`. */
extern const dvi__factor_operations dvi__bordered_factor; /* border.c */
dvi_status dvi__bordered_factor_create(const dvi__pattern *pattern, int border, void **factor);

#endif
