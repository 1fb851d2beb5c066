#include "num/accumulator.h"

#include <math.h>

static const int64_t digit_size = INT64_C(1) << 32;

void dvi__accumulator_carry(dvi__accumulator *sum)
{
  for (int k = 0; k < DVI__DIGITS - 1; k++) {
    const int64_t digit = sum->number[k] & (digit_size - 1);
    sum->number[k + 1] += (sum->number[k] - digit) / digit_size;
    sum->number[k] = digit;
  }
  sum->terms = 0;
}

/* Change the sign of a carried sum. */
static void negate(dvi__accumulator *sum)
{
  for (int k = 0; k < DVI__DIGITS; k++) sum->number[k] = -sum->number[k];
  dvi__accumulator_carry(sum);
}

/* Give the 64 bits from the leading one of digit `top` on, of which the last one is set if any bit
 * behind them is, and the power of two of the last one. */
static uint64_t leading_bits(const dvi__accumulator *sum, int top, int *power)
{
  const uint64_t first = (uint64_t)sum->number[top],
                 second = top > 0 ? (uint64_t)sum->number[top - 1] : 0,
                 third = top > 1 ? (uint64_t)sum->number[top - 2] : 0;
  int spare = 0, rest = 0; /* leading zeros of the first digit */
  while (first << spare >> 31 == 0) spare++;
  const uint64_t behind = third << spare;
  for (int k = top - 3; k >= 0; k--) rest |= sum->number[k] != 0;
  rest |= (behind & 0xffffffff) != 0;
  *power = 32 * (top - 1) - 1074 - spare;
  return (first << 32 | second) << spare | behind >> 32 | (uint64_t)rest;
}

/* ---- many terms ---- */

/* Numbers that are added, or compared, side by side. */
enum { LANES = 8 };

/* Give the largest size of terms. Those that are no numbers do not count. */
static double largest_size(int count, const double *term)
{
  double most[LANES] = {0};
  for (int i = 0; i < count; i += LANES)
    for (int l = 0; l < LANES; l++)
      most[l] = fabs(term[i + l]) > most[l] ? fabs(term[i + l]) : most[l];
  for (int l = 1; l < LANES; l++) most[0] = fmax(most[0], most[l]);
  return most[0];
}

/* Take the leading bits of all terms, up to a common place, and give their sum, which is exact
 * (Rump, Ogita and Oishi 2008, sec. 3). Terms are below 2^exponent, and keep what is left. */
static double take_leading_bits(int count, int exponent, double *term)
{
  const double shift = ldexp(1.5, exponent + 10); /* 2^8 terms of 42 bits have 50 */
  double sum[LANES] = {0};
  for (int i = 0; i < count; i += LANES)
    for (int l = 0; l < LANES; l++) {
      const double leading = (term[i + l] + shift) - shift;
      term[i + l] -= leading;
      sum[l] += leading;
    }
  for (int l = 1; l < LANES; l++) sum[0] += sum[l];
  return sum[0];
}

void dvi__accumulate_terms(dvi__accumulator *sum, double *term)
{
  const int count = DVI__SUM_TERMS;
  for (int level = 0; level < 3; level++) {
    int exponent;
    const double most = largest_size(count, term);
    if (most == 0 && level > 0)
      return; /* at first, zeros may be beside terms that are no numbers */
    if (!(most > 0x1p-900 && most < 0x1p900)) break;
    (void)frexp(most, &exponent);
    dvi__accumulate(sum, take_leading_bits(count, exponent, term));
  }
  for (int i = 0; i < count; i++)
    if (term[i] != 0) dvi__accumulate(sum, term[i]);
}

dvi__accumulator *dvi__block_sum_end(dvi__block_sum *s)
{
  while (s->count > 0 && s->count < DVI__SUM_TERMS) s->term[s->count++] = 0;
  if (s->count > 0) dvi__accumulate_terms(&s->sum, s->term);
  s->count = 0;
  return &s->sum;
}

void dvi__accumulate_products(dvi__accumulator *sum, int64_t n, const double *x, const double *y,
                              const char *taken)
{
  double term[DVI__SUM_TERMS];
  for (int64_t first = 0; first < n; first += DVI__SUM_TERMS) {
    const int count = (int)(n - first < DVI__SUM_TERMS ? n - first : DVI__SUM_TERMS);
    for (int i = count; i < DVI__SUM_TERMS; i++) term[i] = 0;
    for (int i = 0; i < count; i++) term[i] = x[first + i] * y[first + i];
    for (int i = 0; i < count && taken != NULL; i++)
      if (!taken[first + i]) term[i] = 0;
    dvi__accumulate_terms(sum, term);
  }
}

/* ---- the value ---- */

static int is_finite(const dvi__accumulator *sum)
{
  return sum->number[DVI__INFINITE] == 0 && sum->number[DVI__MINUS_INFINITE] == 0 &&
         sum->number[DVI__NOT_A_NUMBER] == 0;
}

/* Give the sum of the terms that are not finite, if there are any. */
static double value_of_others(const dvi__accumulator *sum)
{
  if (sum->number[DVI__NOT_A_NUMBER] > 0) return (double)NAN;
  if (sum->number[DVI__INFINITE] > 0 && sum->number[DVI__MINUS_INFINITE] > 0) return (double)NAN;
  return sum->number[DVI__INFINITE] > 0 ? (double)INFINITY : -(double)INFINITY;
}

double dvi__accumulator_value(const dvi__accumulator *sum)
{
  dvi__accumulator size = *sum;
  int top = DVI__DIGITS - 1, power;
  if (!is_finite(sum)) return value_of_others(sum);
  dvi__accumulator_carry(&size);
  const int is_negative = size.number[top] < 0;
  if (is_negative) negate(&size);
  while (top > 0 && size.number[top] == 0) top--;
  if (size.number[top] == 0) return 0;
  const uint64_t bits = leading_bits(&size, top, &power);
  /* 53 of the 64 bits stay, unless the sum is so small that it is exact */
  const double value = ldexp((double)bits, power);
  return is_negative ? -value : value;
}
