/* The operations that programs have beside those of graphs. They have a constant for an operand, or
 * do two operations in one. */
#ifndef DVI_EXPR_COMPILE_PROGRAM_CODES_H
#define DVI_EXPR_COMPILE_PROGRAM_CODES_H
#include "expr/graph.h"

typedef enum dvi__code {
  DVI__CODE_COPY = DVI__OP_COUNT,
  DVI__CODE_FILL,              /* value */
  DVI__CODE_ADD_VALUE,         /* a + value */
  DVI__CODE_SUBTRACT_FROM,     /* value - a */
  DVI__CODE_MULTIPLY_BY,       /* a * value */
  DVI__CODE_DIVIDE_BY,         /* a / value */
  DVI__CODE_DIVIDE_INTO,       /* value / a */
  DVI__CODE_MULTIPLY_ADD,      /* a*b + c */
  DVI__CODE_MULTIPLY_LESS,     /* a*b - c */
  DVI__CODE_LESS_PRODUCT,      /* c - a*b */
  DVI__CODE_SINE_AND_COSINE,   /* to = sin a, row b = cos a */
  DVI__CODE_WHOLE_POWER,       /* a^value, value a small whole number */
  DVI__CODE_ROOT_POWER,        /* a^value, value = 3/2, 5/2, .. */
  DVI__CODE_INVERSE_ROOT_POWER /* a^value, value = -1/2, -3/2, .. */
} dvi__code;

#endif
