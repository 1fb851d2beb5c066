/* Derivatives by central differences, for a batch of points at once. */
#ifndef DVI_SYSTEM_TERM_DIFFERENCE_H
#define DVI_SYSTEM_TERM_DIFFERENCE_H
#include "system/term/term.h"

/* A scalar function at a batch of points, and a gradient at a batch of points (second may be NULL
 * where there is none). */
typedef dvi_status (*dvi__batch_value)(const void *function, int count, const double *x,
                                       double *value);
typedef dvi_status (*dvi__batch_gradient)(const void *function, int count, const double *x,
                                          double *first, double *second);

/* Compute the gradient, 6th order, relative error about 1e-13, by 6 n evaluations. */
dvi_status dvi__difference_gradient(dvi__batch_value value, const void *function,
                                    dvi__differences *d, int n, int count, const double *x,
                                    double *gradient);

/* Compute first[i] = d first_i / d x_j and second[i] = d second_i / d x_j of all rows at one point,
 * 6th order, by 6 evaluations. Afterwards d->step[j] is the step, and d->plus, d->plus_v hold the
 * gradients at its outermost point. */
dvi_status dvi__difference_column(dvi__batch_gradient gradient, const void *function,
                                  dvi__differences *d, int n, int j, const double *x, double *first,
                                  double *second);

/* Compute Hessian blocks by column groups. Entry (i,j) of the first is d first_i / d x_j, of the
 * second d second_i / d x_j. The order is 2, the relative error about 1e-10 (1e-7 if the gradient
 * is itself differenced, `noisy`). Either pattern may be NULL. */
dvi_status dvi__difference_hessian(dvi__batch_gradient gradient, const void *function,
                                   dvi__differences *d, const dvi__groups *groups, int noisy,
                                   int count, const double *x, const dvi__pattern *first,
                                   double *first_values, const dvi__pattern *second,
                                   double *second_values);

#endif
