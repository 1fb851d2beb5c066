/* Quadrature rules before rounding. */
#ifndef DVI_SPACE_QUADRATURE_H
#define DVI_SPACE_QUADRATURE_H
#include <dvi/quadrature.h>

/* As dvi_quadrature, in long double. */
dvi_status dvi__quadrature_long(dvi_rule rule, int n, long double *node, long double *weight);

#endif
