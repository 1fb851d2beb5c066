/* Functions in quadruple precision. They are slow, and serve errors below the rounding of a
 * double. */
#ifndef DVI_EXPR_FUNCTION_FUNCTION_QUAD_H
#define DVI_EXPR_FUNCTION_FUNCTION_QUAD_H
#include "expr/function/function.h"
#include "expr/quad.h"

#ifdef DVI__QUAD
/* Add sign times the value at the point x to *value, if that is not NULL. Add sign times the
 * derivatives by block b to gradient[b], [width[b]], if that is not NULL. gradient may be NULL.
 * x[b] are the variables of block b, [width[b]]. The derivatives are found by the reverse mode over
 * the values of a kernel's nodes. They are those of that same expression to its last digit.
 * Allocates. DVI_NO_MEMORY. */
dvi_status dvi__function_quad_add(dvi__function *function, dvi__quad sign, dvi__quad *const *x,
                                  dvi__quad *value, dvi__quad *const *gradient);
#endif

#endif
