/* Measuring orders against the quadruple-precision judge. */
#ifndef SUPPORT_ORDER_H
#define SUPPORT_ORDER_H
#include "problem.h"

/* A problem of the catalogue with at most one setting "name=value" (NULL: none), and a span of time. */
typedef struct span {
  const char *problem, *setting;
  double length;
} span;

/* The error at the end of the span, as every user sees it: the slope over the finest five of the step sizes span/first, span/(2 first), ...
 * whose errors are above roundoff must be within 0.2 of `order`. For low orders: a high one is down at roundoff before its slope settles. */
void check_global_order(const span *of, const char *method, int first, int order);

/* The error of one step, which falls as h^(order+1), down to roundoff: see order.c. Its order must be within 0.2 of `order`. `h` is a
 * step at which the method still works. For symmetric methods. */
void check_local_order(const span *of, const char *method, double h, int order);

#endif
