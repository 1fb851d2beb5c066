/* Execution. Each case of one switch is a loop over whole blocks of lanes. Functions of the C
 * library are called for the lanes in use alone. */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "expr/compile/lanes.h"
#include "expr/compile/program.h"
#include "expr/compile/program_codes.h"
#include "expr/compile/sines.h"

/* Return 1 if inverse_powers can find the root of x. Such an x has a root and is not near the ends
 * of the range. */
DVI__EXPR_INLINE int is_plain(double x)
{
  return (x >= DBL_MIN) & (x <= 1e300);
}

/* Compute x^-(1/2 + factors) of plain numbers, right to two roundings for each root in it. A square
 * root and a division take longer. The exponent's bits, halved and negated, give y right to 3.5 %
 * (Lomont 2003). The series of (1 - e)^(-1/2) then shrinks e = 1 - x y^2. Returns the number of
 * plain ones. */
DVI__EXPR_INLINE int inverse_powers(int width, const int factors, const double *restrict x,
                                    double *restrict to)
{
  uint64_t plain[DVI__LANES] = {0};
  for (int first = 0; first < width; first += DVI__LANES)
    DVI__EXPR_INDEPENDENT for (int k = 0; k < DVI__LANES; k++)
    {
      const double at = x[first + k];
      uint64_t bits;
      double y;
      memcpy(&bits, &at, sizeof bits);
      plain[k] += (uint64_t)is_plain(at);
      bits = UINT64_C(0x5fe6eb50c7b537a9) - (bits >> 1);
      memcpy(&y, &bits, sizeof y);
      const double wide = 1.0 - at * (y * y);
      y += y * (wide * (0.5 + wide * (0.375 + wide * 0.3125)));
      const double e = 1.0 - at * (y * y);
      y += y * (e * (0.5 + e * (0.375 + e * 0.3125)));
      const double square = y * y;
      for (int i = 0; i < factors; i++) y *= square;
      to[first + k] = y;
    }
  return dvi__sum_lanes(plain);
}

/* Compute x^n, n = 1, 2, .. or x^-n. */
DVI__EXPR_INLINE void signed_powers(int width, const int exponent, const double *restrict x,
                                    double *restrict to)
{
  const unsigned power = exponent < 0 ? 0U - (unsigned)exponent : (unsigned)exponent;
  for (int at = 0; at < width; at += DVI__LANES) {
    double base[DVI__LANES], product[DVI__LANES];
    for (int k = 0; k < DVI__LANES; k++) base[k] = x[at + k];
    for (int k = 0; k < DVI__LANES; k++) product[k] = 1.0;
    for (unsigned left = power; left != 0; left /= 2) {
      if (left % 2 != 0)
        for (int k = 0; k < DVI__LANES; k++) product[k] *= base[k];
      for (int k = 0; k < DVI__LANES; k++) base[k] *= base[k];
    }
    for (int k = 0; k < DVI__LANES; k++) to[at + k] = exponent < 0 ? 1.0 / product[k] : product[k];
  }
}

/* Compute x^exponent. The compiler makes vectors of the powers that it knows. */
DVI__EXPR_INLINE void whole_powers(int width, double exponent, const double *restrict x,
                                   double *restrict to)
{
  switch ((int)exponent) {
  case 3: signed_powers(width, 3, x, to); break;
  case 4: signed_powers(width, 4, x, to); break;
  case -2: signed_powers(width, -2, x, to); break;
  case -3: signed_powers(width, -3, x, to); break;
  default: signed_powers(width, (int)exponent, x, to);
  }
}

/* Compute x^(n + 1/2), n = 1, 2, .. */
DVI__EXPR_INLINE void root_powers(int width, double exponent, const double *restrict x,
                                  double *restrict to)
{
  const int factors = (int)exponent;
  for (int at = 0; at < width; at += DVI__LANES) {
    double product[DVI__LANES];
    for (int k = 0; k < DVI__LANES; k++) product[k] = sqrt(x[at + k]);
    for (int i = 0; i < factors; i++)
      for (int k = 0; k < DVI__LANES; k++) product[k] *= x[at + k];
    for (int k = 0; k < DVI__LANES; k++) to[at + k] = product[k];
  }
}

/* Compute x^-(n + 1/2), n = 0, 1, .. */
DVI__EXPR_INLINE void inverse_root_powers(int width, double exponent, const double *restrict x,
                                          double *restrict to)
{
  const int factors = (int)-exponent;
  const int plain = factors == 0   ? inverse_powers(width, 0, x, to)
                    : factors == 1 ? inverse_powers(width, 1, x, to)
                    : factors == 2 ? inverse_powers(width, 2, x, to)
                                   : inverse_powers(width, factors, x, to);
  for (int k = 0; plain < width && k < width; k++) {
    if (is_plain(x[k])) continue;
    to[k] = 1.0 / sqrt(x[k]);
    const double square = to[k] * to[k];
    for (int i = 0; i < factors; i++) to[k] *= square;
  }
}

/* Fill the idle lanes of a result of the C library with the last lane. */
DVI__EXPR_INLINE void fill_up(int lanes, int width, double *to)
{
  for (int k = lanes; k < width; k++) to[k] = to[lanes - 1];
}

DVI__EXPR_INLINE void sines_and_cosines(int width, const double *restrict angle,
                                        double *restrict sine, double *restrict cosine)
{
  const int plain = dvi__plain_sines(width, angle, sine, cosine);
  for (int k = 0; plain < width && k < width; k++) {
    sine[k] = dvi_sin(angle[k]);
    cosine[k] = dvi_cos(angle[k]);
  }
}

DVI__EXPR_INLINE void sines(int width, const double *restrict angle, double *restrict sine)
{
  const int plain = dvi__plain_sine(width, 0, angle, sine);
  for (int k = 0; plain < width && k < width; k++) sine[k] = dvi_sin(angle[k]);
}

DVI__EXPR_INLINE void cosines(int width, const double *restrict angle, double *restrict cosine)
{
  const int plain = dvi__plain_sine(width, 1, angle, cosine);
  for (int k = 0; plain < width && k < width; k++) cosine[k] = dvi_cos(angle[k]);
}

/* Return x where a condition holds. Its operands are read before anything is decided. gcc 12 takes
 * the wrong lanes where it makes vectors of four for AVX2 of c[k] > 0.0 ? x[k] : .., which reads
 * x[k] for some lanes alone. */
DVI__EXPR_INLINE double value_if(double condition, double x)
{
  return condition > 0.0 ? x : condition <= 0.0 ? 0.0 : condition;
}

/* List the operations that are loops over whole blocks as X(name, code, result of lane k). */
#define LOOPS(X)                                                             \
  X(copy, DVI__CODE_COPY, a[k])                                              \
  X(fill, DVI__CODE_FILL, value)                                             \
  X(add_value, DVI__CODE_ADD_VALUE, a[k] + value)                            \
  X(subtract_from, DVI__CODE_SUBTRACT_FROM, value - a[k])                    \
  X(multiply_by, DVI__CODE_MULTIPLY_BY, a[k] * value)                        \
  X(divide_by, DVI__CODE_DIVIDE_BY, a[k] / value)                            \
  X(divide_into, DVI__CODE_DIVIDE_INTO, value / a[k])                        \
  X(multiply_add, DVI__CODE_MULTIPLY_ADD, a[k] * b[k] + c[k])                \
  X(multiply_less, DVI__CODE_MULTIPLY_LESS, a[k] * b[k] - c[k])              \
  X(less_product, DVI__CODE_LESS_PRODUCT, c[k] - a[k] * b[k])                \
  X(add, DVI__OP_ADD, a[k] + b[k])                                           \
  X(subtract, DVI__OP_SUBTRACT, a[k] - b[k])                                 \
  X(multiply, DVI__OP_MULTIPLY, a[k] * b[k])                                 \
  X(divide, DVI__OP_DIVIDE, a[k] / b[k])                                     \
  X(negate, DVI__OP_NEGATE, -a[k])                                           \
  X(square, DVI__OP_SQUARE, a[k] * a[k])                                     \
  X(root, DVI__OP_SQRT, sqrt(a[k]))                                          \
  X(magnitude, DVI__OP_ABS, fabs(a[k]))                                      \
  X(sign, DVI__OP_SIGN, a[k] > 0.0 ? 1.0 : a[k] < 0.0 ? -1.0 : a[k])         \
  X(whole, DVI__OP_FLOOR, floor(a[k]))                                       \
  X(positive, DVI__OP_POSITIVE, a[k] > 0.0 ? 1.0 : a[k] <= 0.0 ? 0.0 : a[k]) \
  X(where, DVI__OP_WHERE, value_if(a[k], b[k]))

/* Rows are computed by `block` lanes, known at compile time. A long loop of few lanes each ends
 * unforeseen. */
#define LOOP(name, code, expression)                                                          \
  DVI__EXPR_INLINE void name##_rows(const int block, int width, double value,                 \
                                    const double *restrict a, const double *restrict b,       \
                                    const double *restrict c, double *restrict to)            \
  {                                                                                           \
    (void)value, (void)a, (void)b, (void)c;                                                   \
    for (int first = 0; first < width; first += block)                                        \
      DVI__EXPR_INDEPENDENT for (int k = first; k < first + block; k++) to[k] = (expression); \
  }
LOOPS(LOOP)
#undef LOOP

/* Call the C library for an operation. */
#define CALL(code, expression)                            \
  case code:                                              \
    for (int k = 0; k < lanes; k++) to[k] = (expression); \
    break;
static void call_library(int op, int lanes, int width, const double *restrict a,
                         const double *restrict b, double *restrict to)
{
  switch (op) {
    CALL(DVI__OP_EXP, exp(a[k]))
    CALL(DVI__OP_LOG, log(a[k]))
    CALL(DVI__OP_TAN, tan(a[k]))
    CALL(DVI__OP_ASIN, asin(a[k]))
    CALL(DVI__OP_ACOS, acos(a[k]))
    CALL(DVI__OP_ATAN, atan(a[k]))
    CALL(DVI__OP_SINH, sinh(a[k]))
    CALL(DVI__OP_COSH, cosh(a[k]))
    CALL(DVI__OP_TANH, tanh(a[k]))
    CALL(DVI__OP_ASINH, asinh(a[k]))
    CALL(DVI__OP_ACOSH, acosh(a[k]))
    CALL(DVI__OP_ATANH, atanh(a[k]))
    CALL(DVI__OP_RAISE, pow(a[k], b[k]))
    CALL(DVI__OP_ATAN2, atan2(a[k], b[k]))
  default: break;
  }
  fill_up(lanes, width, to);
}

/* Run all instructions. `below` is 1 if the rows of inputs stand below the registers. */
DVI__EXPR_INLINE void run_instructions(const int below, const int block,
                                       const dvi__program *program, int lanes, int width,
                                       const double *const *input, double *registers)
{
  const dvi__instruction *const end = program->instruction + program->instruction_count;
#define ROW(i) (below || (i) >= 0 ? registers + (ptrdiff_t)(i)*width : input[~(i)])
  for (const dvi__instruction *at = program->instruction; at < end; at++) {
    double *restrict const to = registers + (ptrdiff_t)at->to * width;
    const double *restrict const a = ROW(at->a), *restrict const b = ROW(at->b),
                                 *restrict const c = ROW(at->c);
    const double value = at->value;
    switch (at->op) {
#define CASE(name, code, expression) \
  case code: name##_rows(block, width, value, a, b, c, to); break;
      LOOPS(CASE)
#undef CASE
    case DVI__CODE_WHOLE_POWER: whole_powers(width, value, a, to); break;
    case DVI__CODE_ROOT_POWER: root_powers(width, value, a, to); break;
    case DVI__CODE_INVERSE_ROOT_POWER: inverse_root_powers(width, value, a, to); break;
    case DVI__CODE_SINE_AND_COSINE:
      sines_and_cosines(width, a, to, registers + (ptrdiff_t)at->b * width);
      break;
    case DVI__OP_SIN: sines(width, a, to); break;
    case DVI__OP_COS: cosines(width, a, to); break;
    default: call_library(at->op, lanes, width, a, b, to);
    }
  }
#undef ROW
}

DVI__EXPR_INLINE void run_body(const dvi__program *program, int lanes, const double *const *input,
                               double *registers)
{
  run_instructions(0, DVI__LANES, program, lanes, dvi__row_width(lanes), input, registers);
}

DVI__EXPR_VERSIONS(run,
                   (const dvi__program *program, int lanes, const double *const *input,
                    double *registers),
                   (program, lanes, input, registers))

DVI__EXPR_INLINE void run_long_body(const dvi__program *program, int lanes,
                                    const double *const *input, double *registers)
{
  run_instructions(0, DVI__LONG_BLOCK, program, lanes, lanes, input, registers);
}

DVI__EXPR_VERSIONS(run_long,
                   (const dvi__program *program, int lanes, const double *const *input,
                    double *registers),
                   (program, lanes, input, registers))

DVI__EXPR_INLINE void run_block_body(const dvi__program *program, int lanes, double *registers)
{
  run_instructions(1, DVI__LANES, program, lanes, DVI__LANES, NULL, registers);
}

DVI__EXPR_VERSIONS(run_block, (const dvi__program *program, int lanes, double *registers),
                   (program, lanes, registers))

/* A function of its own, since clang does not export a function that is compiled more than once. */
void dvi__program_run(const dvi__program *program, int lanes, const double *const *input,
                      double *registers)
{
  if (lanes % DVI__LONG_BLOCK == 0)
    run_long(program, lanes, input, registers);
  else
    run(program, lanes, input, registers);
}

void dvi__program_run_block(const dvi__program *program, int lanes, double *registers)
{
  run_block(program, lanes, registers);
}
