/* Quadrature rules in long double, before rounding. */
#ifndef DVI_SPACE_QUADRATURE_H
#define DVI_SPACE_QUADRATURE_H
#include <dvi/quadrature.h>

/* Compute a rule like dvi_quadrature, in long double. */
dvi_status dvi__quadrature_long(dvi_rule rule, int n, long double *node, long double *weight);

#endif
