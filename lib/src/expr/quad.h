/* The operations of expressions on numbers of 113 bits, for errors that lie below the rounding of a
 * double. Only the doubles to begin with come from the C library. */
#ifndef DVI_EXPR_QUAD_H
#define DVI_EXPR_QUAD_H
#include <float.h>

#include "expr/graph.h"

#if LDBL_MANT_DIG == 113
#define DVI__QUAD
typedef long double dvi__quad;
#elif defined(__SIZEOF_FLOAT128__)
#define DVI__QUAD
typedef __float128 dvi__quad;
#endif

#ifdef DVI__QUAD
/* Apply an operation. `number` is the value of a constant, or the exponent of a power. */
dvi__quad dvi__quad_operate(dvi__op op, double number, dvi__quad a, dvi__quad b);

/* Derive an operation by its operands, slope[2]. value is its result. Derivatives by operands that
 * it does not have stay unchanged. */
void dvi__quad_slopes(dvi__op op, double number, dvi__quad value, dvi__quad a, dvi__quad b,
                      dvi__quad *slope);
#endif

#endif
