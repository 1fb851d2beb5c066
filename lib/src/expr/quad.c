#include "expr/quad.h"

#include <math.h>

#ifdef DVI__QUAD
typedef dvi__quad quad;

/* Return a constant as the sum of three doubles. */
static quad quad_constant(double high, double middle, double low)
{
  return (quad)high + (quad)middle + (quad)low;
}

static quad quad_magnitude(quad x)
{
  return x < 0 ? -x : x;
}

static quad quad_sign(quad x)
{
  return (quad)((x > 0) - (x < 0));
}

/* Return the square root by Newton's method, which doubles the digits of the double that it starts
 * at. */
static quad quad_root(quad x)
{
  quad y = (quad)sqrt((double)x);
  if (!(y > 0) || !isfinite((double)y)) return y;
  for (int i = 0; i < 2; i++) y = (y + x / y) / 2;
  return y;
}

/* Return exp(r) - 1 by its series for r/256, doubled eight times by e(2 + e), which keeps digits
 * near 0. */
static quad quad_exponential_less_one(quad r)
{
  enum { DOUBLINGS = 8, TERMS = 14 };
  quad sum = 0;
  r /= 1 << DOUBLINGS;
  for (int k = TERMS; k > 0; k--) sum = r * (1 + sum) / k;
  for (int i = 0; i < DOUBLINGS; i++) sum *= 2 + sum;
  return sum;
}

/* Return exp(r) 2^k with x = r + k log 2. */
static quad quad_exponential(quad x)
{
  const quad log_two = quad_constant(0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56,
                                     0x1.7b57a079a1934p-111);
  const double k = nearbyint((double)(x / log_two));
  if (!(fabs(k) < 1000)) return (quad)exp((double)x);
  return (quad)ldexp(1, (int)k) * (1 + quad_exponential_less_one(x - (quad)k * log_two));
}

static quad quad_logarithm(quad x)
{
  quad y = (quad)log((double)x);
  if (!isfinite((double)y)) return y;
  for (int i = 0; i < 2; i++) y += x * quad_exponential(-y) - 1;
  return y;
}

#define INVERSES(n) (quad)1 / (n), (quad)1 / ((n) + 1), (quad)1 / ((n) + 2), (quad)1 / ((n) + 3)
static const quad inverse_number[] = {INVERSES(1),  INVERSES(5),  INVERSES(9),
                                      INVERSES(13), INVERSES(17), INVERSES(21),
                                      INVERSES(25), INVERSES(29), INVERSES(33)};
enum { TERMS = sizeof inverse_number / sizeof *inverse_number };

/* Compute sine and cosine by their series, after whole quarters of a turn are taken off. */
static void compute_sine_and_cosine(quad x, quad *sine, quad *cosine)
{
  const quad quarter = quad_constant(0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54,
                                     -0x1.f1976b7ed8fbcp-110);
  const double quarters = nearbyint((double)(x / quarter)), least = 1e-36;
  const quad r = x - (quad)quarters * quarter;
  quad term = 1, sum[2] = {0, 0};
  for (int k = 0; k < TERMS && fabs((double)term) > least; k++) {
    sum[k % 2] += k / 2 % 2 == 0 ? term : -term;
    term = term * r * inverse_number[k];
  }
  const double left = fmod(quarters, 4);
  const int whole = isfinite(left) ? ((int)left + 4) % 4 : 0;
  const quad c = whole % 2 == 0 ? sum[0] : sum[1], s = whole % 2 == 0 ? sum[1] : sum[0];
  *sine = whole >= 2 ? -s : s;
  *cosine = whole == 1 || whole == 2 ? -c : c;
}

/* Return sine and cosine, and keep the last angle. An angle's sine, cosine and slopes are asked for
 * one after the other. */
static void sine_and_cosine(quad x, quad *sine, quad *cosine)
{
  static _Thread_local quad angle, angle_sine, angle_cosine = 1;
  if (!(x >= angle && x <= angle)) {
    compute_sine_and_cosine(x, &angle_sine, &angle_cosine);
    angle = x;
  }
  *sine = angle_sine;
  *cosine = angle_cosine;
}

static quad sine_of(quad x)
{
  quad s, c;
  sine_and_cosine(x, &s, &c);
  return s;
}

static quad cosine_of(quad x)
{
  quad s, c;
  sine_and_cosine(x, &s, &c);
  return c;
}

/* Return the double's angle, corrected by the small angle that it is off, whose sine is known. */
static quad angle_of(quad y, quad x)
{
  quad angle = (quad)atan2((double)y, (double)x), s, c;
  const quad length = quad_root(x * x + y * y);
  for (int i = 0; i < 2 && length > 0; i++) {
    sine_and_cosine(angle, &s, &c);
    angle += (y * c - x * s) / length;
  }
  return angle;
}

static quad whole_below(quad x)
{
  quad whole = (quad)floor((double)x); /* the rounded x may be beyond the next one */
  if (whole > x) whole -= 1;
  return whole + 1 <= x ? whole + 1 : whole;
}

static quad hyperbolic_sine(quad x)
{
  if (quad_magnitude(x) > 1) return (quad_exponential(x) - quad_exponential(-x)) / 2;
  const quad e = quad_exponential_less_one(x);
  return (e + e / (1 + e)) / 2;
}

static quad hyperbolic_cosine(quad x)
{
  return (quad_exponential(x) + quad_exponential(-x)) / 2;
}

static quad quad_whole_power(quad x, unsigned n)
{
  quad product = 1;
  for (; n != 0; n /= 2, x *= x)
    if (n % 2 != 0) product *= x;
  return product;
}

/* Return x to a whole exponent, or half of an odd one. */
static quad quad_power(quad x, double exponent)
{
  const double size = fabs(exponent), whole = floor(size);
  quad product = quad_whole_power(x, (unsigned)whole);
  if (size > whole) product *= quad_root(x);
  return exponent < 0 ? 1 / product : product;
}

quad dvi__quad_operate(dvi__op op, double number, quad a, quad b)
{
  switch (op) {
  case DVI__OP_CONSTANT:
  case DVI__OP_INPUT: return (quad)number;
  case DVI__OP_NEGATE: return -a;
  case DVI__OP_SQUARE: return a * a;
  case DVI__OP_POWER: return quad_power(a, number);
  case DVI__OP_SQRT: return quad_root(a);
  case DVI__OP_EXP: return quad_exponential(a);
  case DVI__OP_LOG: return quad_logarithm(a);
  case DVI__OP_SIN: return sine_of(a);
  case DVI__OP_COS: return cosine_of(a);
  case DVI__OP_TAN: return sine_of(a) / cosine_of(a);
  case DVI__OP_ASIN: return angle_of(a, quad_root((1 - a) * (1 + a)));
  case DVI__OP_ACOS: return angle_of(quad_root((1 - a) * (1 + a)), a);
  case DVI__OP_ATAN: return angle_of(a, 1);
  case DVI__OP_SINH: return hyperbolic_sine(a);
  case DVI__OP_COSH: return hyperbolic_cosine(a);
  case DVI__OP_TANH: return hyperbolic_sine(a) / hyperbolic_cosine(a);
  case DVI__OP_ASINH:
    return quad_sign(a) * quad_logarithm(quad_magnitude(a) + quad_root(a * a + 1));
  case DVI__OP_ACOSH: return quad_logarithm(a + quad_root((a - 1) * (a + 1)));
  case DVI__OP_ATANH: return quad_logarithm((1 + a) / (1 - a)) / 2;
  case DVI__OP_ABS: return quad_magnitude(a);
  case DVI__OP_SIGN: return quad_sign(a);
  case DVI__OP_ADD: return a + b;
  case DVI__OP_SUBTRACT: return a - b;
  case DVI__OP_MULTIPLY: return a * b;
  case DVI__OP_DIVIDE: return a / b;
  case DVI__OP_RAISE: return quad_exponential(b * quad_logarithm(a));
  case DVI__OP_ATAN2: return angle_of(a, b);
  case DVI__OP_HYPOT: return quad_root(a * a + b * b);
  case DVI__OP_FLOOR: return whole_below(a);
  case DVI__OP_POSITIVE: return a > 0 ? 1 : a <= 0 ? 0 : a;
  case DVI__OP_WHERE: return a > 0 ? b : a <= 0 ? 0 : a;
  case DVI__OP_COUNT: break;
  }
  return 0;
}

void dvi__quad_slopes(dvi__op op, double number, quad value, quad a, quad b, quad *slope)
{
  switch (op) {
  case DVI__OP_NEGATE: slope[0] = -1; break;
  case DVI__OP_SQUARE: slope[0] = 2 * a; break;
  case DVI__OP_POWER: slope[0] = (quad)number * quad_power(a, number - 1); break;
  case DVI__OP_SQRT: slope[0] = 1 / (2 * value); break;
  case DVI__OP_EXP: slope[0] = value; break;
  case DVI__OP_LOG: slope[0] = 1 / a; break;
  case DVI__OP_SIN: slope[0] = cosine_of(a); break;
  case DVI__OP_COS: slope[0] = -sine_of(a); break;
  case DVI__OP_TAN: slope[0] = 1 + value * value; break;
  case DVI__OP_ASIN: slope[0] = 1 / quad_root((1 - a) * (1 + a)); break;
  case DVI__OP_ACOS: slope[0] = -1 / quad_root((1 - a) * (1 + a)); break;
  case DVI__OP_ATAN: slope[0] = 1 / (1 + a * a); break;
  case DVI__OP_SINH: slope[0] = hyperbolic_cosine(a); break;
  case DVI__OP_COSH: slope[0] = hyperbolic_sine(a); break;
  case DVI__OP_TANH: slope[0] = (1 - value) * (1 + value); break;
  case DVI__OP_ASINH: slope[0] = 1 / quad_root(a * a + 1); break;
  case DVI__OP_ACOSH: slope[0] = 1 / quad_root((a - 1) * (a + 1)); break;
  case DVI__OP_ATANH: slope[0] = 1 / ((1 - a) * (1 + a)); break;
  case DVI__OP_ABS: slope[0] = quad_sign(a); break;
  case DVI__OP_SUBTRACT: slope[0] = 1, slope[1] = -1; break;
  case DVI__OP_MULTIPLY: slope[0] = b, slope[1] = a; break;
  case DVI__OP_DIVIDE: slope[0] = 1 / b, slope[1] = -value / b; break;
  case DVI__OP_RAISE: slope[0] = b * value / a, slope[1] = value * quad_logarithm(a); break;
  case DVI__OP_ATAN2: slope[0] = b / (a * a + b * b), slope[1] = -a / (a * a + b * b); break;
  case DVI__OP_HYPOT: slope[0] = a / value, slope[1] = b / value; break;
  case DVI__OP_WHERE: slope[0] = 0, slope[1] = a; break;
  case DVI__OP_SIGN:
  case DVI__OP_FLOOR:
  case DVI__OP_POSITIVE: slope[0] = 0; break;
  default: slope[0] = slope[1] = 1; /* of ADD */
  }
}
#endif
