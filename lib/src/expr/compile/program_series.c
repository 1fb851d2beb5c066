/* Execution on truncated power series. A row holds the coefficients of one series. */
#include <dvi/taylor.h>
#include <math.h>
#include <string.h>

#include "expr/compile/program.h"
#include "expr/compile/program_codes.h"

enum { LENGTH = DVI_TAYLOR_MAX + 1 };

/* Compute value + sign a. */
static void series_shift(int degree, double value, double sign, const double *a, double *to)
{
  to[0] = value + sign * a[0];
  for (int k = 1; k <= degree; k++) to[k] = sign * a[k];
}

static void series_fill(int degree, double value, double *to)
{
  memset(to, 0, ((size_t)degree + 1) * sizeof *to);
  to[0] = value;
}

static void series_divide_into(int degree, double value, const double *a, double *to)
{
  double numerator[LENGTH];
  series_fill(degree, value, numerator);
  dvi_taylor_divide(degree, numerator, a, to);
}

/* Compute a^n by products, since a may begin with 0. n is small. */
static void series_whole_power(int degree, int n, const double *a, double *to)
{
  double power[LENGTH], next[LENGTH];
  const size_t size = ((size_t)degree + 1) * sizeof *to;
  series_fill(degree, 1.0, power);
  for (int i = 0; i < (n < 0 ? -n : n); i++) {
    dvi_taylor_multiply(degree, power, a, next);
    memcpy(power, next, size);
  }
  if (n < 0)
    series_divide_into(degree, 1.0, power, to);
  else
    memcpy(to, power, size);
}

static double unit_sign(double x)
{
  return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x;
}

/* Return 1 if a series is only a number. */
static int series_is_constant(int degree, const double *a)
{
  int constant = 1;
  for (int k = 1; k <= degree; k++) constant &= a[k] <= 0.0 && a[k] >= 0.0;
  return constant;
}

/* Set the value of a function that is constant between its jumps. There is no series at a jump
 * through which the argument moves. */
static void series_step_function(int degree, double value, int jumps, const double *a, double *to)
{
  series_fill(degree, jumps && !series_is_constant(degree, a) ? (double)NAN : value, to);
}

/* Compute b under a condition. */
static void series_where(int degree, const double *condition, const double *b, double *to)
{
  if (condition[0] > 0.0)
    series_shift(degree, 0.0, 1.0, b, to);
  else
    series_fill(degree, isnan(condition[0]) ? condition[0] : 0.0, to);
}

/* Compute |a|, which has no series where a passes through 0. */
static void series_magnitude(int degree, const double *a, double *to)
{
  const double sign = unit_sign(a[0]);
  const int passes_zero = !(a[0] > 0.0) && !(a[0] < 0.0) && !series_is_constant(degree, a);
  series_shift(degree, 0.0, passes_zero ? (double)NAN : sign, a, to);
}

/* Compute the c that begins with c0 and has c' = (1 + sign c^2) a'. */
static void series_tangent(int degree, double c0, double sign, const double *a, double *c)
{
  double slope[LENGTH];
  c[0] = c0;
  for (int k = 1; k <= degree; k++) {
    double sum = 0.0;
    slope[k - 1] = (k == 1) + sign * dvi_taylor_product(k - 1, c, c);
    for (int j = 1; j <= k; j++) sum += j * a[j] * slope[k - j];
    c[k] = sum / k;
  }
}

/* Compute the c that begins with c0 and has c' = sign a'/b. Here b = constant + factor a^2, or the
 * root of that. */
static void series_inverse_function(int degree, double c0, double sign, double constant,
                                    double factor, int root, const double *a, double *c)
{
  double slope[LENGTH], square[LENGTH], b[LENGTH], rooted[LENGTH];
  dvi_taylor_multiply(degree, a, a, square);
  series_shift(degree, constant, factor, square, b);
  dvi_taylor_square_root(degree, b, rooted);
  dvi_taylor_differentiate(degree, a, slope);
  for (int k = 0; k < degree; k++) slope[k] *= sign;
  dvi_taylor_integrate_quotient(degree, slope, root ? rooted : b, c0, c);
}

/* Compute the angle c of (x, y) by c' = (x y' - y x')/(x^2 + y^2). */
static void series_angle(int degree, const double *y, const double *x, double *c)
{
  double y_slope[LENGTH], x_slope[LENGTH], turn[LENGTH], square[LENGTH];
  dvi_taylor_differentiate(degree, y, y_slope);
  dvi_taylor_differentiate(degree, x, x_slope);
  for (int k = 0; k < degree; k++)
    turn[k] = dvi_taylor_product(k, x, y_slope) - dvi_taylor_product(k, y, x_slope);
  dvi_taylor_multiply(degree, x, x, square);
  dvi_taylor_add_product(degree, y, y, square);
  dvi_taylor_integrate_quotient(degree, turn, square, atan2(y[0], x[0]), c);
}

/* Compute a^b. A constant b gives a power, any other b exp(b log a). */
static void series_raise(int degree, const double *a, const double *b, double *to)
{
  double logarithm[LENGTH], exponent[LENGTH];
  if (series_is_constant(degree, b)) {
    dvi_taylor_power(degree, a, b[0], to);
    return;
  }
  dvi_taylor_log(degree, a, logarithm);
  dvi_taylor_multiply(degree, b, logarithm, exponent);
  dvi_taylor_exp(degree, exponent, to);
}

/* Run an operation of one series or two that is not linear. */
static void series_run_function(int op, int degree, const double *a, const double *b, double *to)
{
  double other[LENGTH];
  switch (op) {
  case DVI__OP_EXP: dvi_taylor_exp(degree, a, to); break;
  case DVI__OP_LOG: dvi_taylor_log(degree, a, to); break;
  case DVI__OP_SIN: dvi_taylor_sin_cos(degree, a, to, other); break;
  case DVI__OP_COS: dvi_taylor_sin_cos(degree, a, other, to); break;
  case DVI__OP_SINH: dvi_taylor_sinh_cosh(degree, a, to, other); break;
  case DVI__OP_COSH: dvi_taylor_sinh_cosh(degree, a, other, to); break;
  case DVI__OP_TAN: series_tangent(degree, tan(a[0]), 1.0, a, to); break;
  case DVI__OP_TANH: series_tangent(degree, tanh(a[0]), -1.0, a, to); break;
  case DVI__OP_ASIN: series_inverse_function(degree, asin(a[0]), 1.0, 1.0, -1.0, 1, a, to); break;
  case DVI__OP_ACOS: series_inverse_function(degree, acos(a[0]), -1.0, 1.0, -1.0, 1, a, to); break;
  case DVI__OP_ATAN: series_inverse_function(degree, atan(a[0]), 1.0, 1.0, 1.0, 0, a, to); break;
  case DVI__OP_ASINH: series_inverse_function(degree, asinh(a[0]), 1.0, 1.0, 1.0, 1, a, to); break;
  case DVI__OP_ACOSH: series_inverse_function(degree, acosh(a[0]), 1.0, -1.0, 1.0, 1, a, to); break;
  case DVI__OP_ATANH: series_inverse_function(degree, atanh(a[0]), 1.0, 1.0, -1.0, 0, a, to); break;
  case DVI__OP_RAISE: series_raise(degree, a, b, to); break;
  case DVI__OP_ATAN2: series_angle(degree, a, b, to); break;
  default: break;
  }
}

static void series_run_instruction(const dvi__instruction *at, int degree, const double *a,
                                   const double *b, const double *c, double *to)
{
  const double value = at->value;
  switch (at->op) {
  case DVI__CODE_COPY: series_shift(degree, 0.0, 1.0, a, to); break;
  case DVI__CODE_FILL: series_fill(degree, value, to); break;
  case DVI__CODE_ADD_VALUE: series_shift(degree, value, 1.0, a, to); break;
  case DVI__CODE_SUBTRACT_FROM: series_shift(degree, value, -1.0, a, to); break;
  case DVI__CODE_MULTIPLY_BY: series_shift(degree, 0.0, value, a, to); break;
  case DVI__CODE_DIVIDE_BY: series_shift(degree, 0.0, 1.0 / value, a, to); break;
  case DVI__CODE_DIVIDE_INTO: series_divide_into(degree, value, a, to); break;
  case DVI__CODE_MULTIPLY_ADD:
    series_shift(degree, 0.0, 1.0, c, to);
    dvi_taylor_add_product(degree, a, b, to);
    break;
  case DVI__CODE_MULTIPLY_LESS:
    for (int k = 0; k <= degree; k++) to[k] = dvi_taylor_product(k, a, b) - c[k];
    break;
  case DVI__CODE_LESS_PRODUCT:
    for (int k = 0; k <= degree; k++) to[k] = c[k] - dvi_taylor_product(k, a, b);
    break;
  case DVI__CODE_WHOLE_POWER: series_whole_power(degree, (int)value, a, to); break;
  case DVI__CODE_ROOT_POWER:
  case DVI__CODE_INVERSE_ROOT_POWER: dvi_taylor_power(degree, a, value, to); break;
  case DVI__OP_NEGATE: series_shift(degree, 0.0, -1.0, a, to); break;
  case DVI__OP_ABS: series_magnitude(degree, a, to); break;
  case DVI__OP_SIGN:
    series_step_function(degree, unit_sign(a[0]), !(a[0] > 0.0) && !(a[0] < 0.0), a, to);
    break;
  case DVI__OP_FLOOR:
    series_step_function(degree, floor(a[0]), !(a[0] > floor(a[0])), a, to);
    break;
  case DVI__OP_POSITIVE:
    series_step_function(degree,
                         a[0] > 0.0    ? 1.0
                         : a[0] <= 0.0 ? 0.0
                                       : a[0],
                         !(a[0] > 0.0) && !(a[0] < 0.0), a, to);
    break;
  case DVI__OP_WHERE: series_where(degree, a, b, to); break;
  case DVI__OP_ADD: dvi_taylor_combine(degree, 1.0, a, 1.0, b, to); break;
  case DVI__OP_SUBTRACT: dvi_taylor_combine(degree, 1.0, a, -1.0, b, to); break;
  case DVI__OP_MULTIPLY: dvi_taylor_multiply(degree, a, b, to); break;
  case DVI__OP_DIVIDE: dvi_taylor_divide(degree, a, b, to); break;
  case DVI__OP_SQUARE: dvi_taylor_multiply(degree, a, a, to); break;
  case DVI__OP_SQRT: dvi_taylor_square_root(degree, a, to); break;
  default: series_run_function(at->op, degree, a, b, to);
  }
}

void dvi__program_run_series(const dvi__program *program, int degree, double *registers)
{
  const ptrdiff_t width = degree + 1;
  for (const dvi__instruction *at = program->instruction;
       at < program->instruction + program->instruction_count; at++) {
    double *const to = registers + at->to * width, *const b = registers + at->b * width;
    const double *const a = registers + at->a * width, *const c = registers + at->c * width;
    if (at->op == DVI__CODE_SINE_AND_COSINE)
      dvi_taylor_sin_cos(degree, a, to, b);
    else
      series_run_instruction(at, degree, a, b, c, to);
  }
}
