/* Quadrature rules in long double, before rounding. */
#ifndef DVI_SPACE_QUADRATURE_H
#define DVI_SPACE_QUADRATURE_H
#include <dvi/quadrature.h>

/* Most points of a rule in long double. Spectral elements have more nodes than methods. */
enum { DVI__QUADRATURE_MOST = 512 };

/* Compute a rule like dvi_quadrature, in long double. n is at most DVI__QUADRATURE_MOST. */
dvi_status dvi__quadrature_long(dvi_rule rule, int n, long double *node, long double *weight);

#endif
