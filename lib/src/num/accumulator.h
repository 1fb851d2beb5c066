/* Sums without rounding, whatever the order of their terms: a number of 2144 bits, which takes
 * doubles as they are. Its value is the sum rounded once. Threads and processes that add up parts
 * of a sum have the same bits for any division of it.
 * Source: Kulisch 2002; Neal 2015, "Fast exact summation using small and large superaccumulators".
 */
#ifndef DVI_NUM_ACCUMULATOR_H
#define DVI_NUM_ACCUMULATOR_H
#include <stdint.h>
#include <string.h>

enum {
  DVI__DIGITS = 68, /* of 32 bits. The unit of digit k is 2^(32 k - 1074) */
  /* behind them, the number of terms that are infinite, minus infinite, and no numbers */
  DVI__INFINITE = DVI__DIGITS,
  DVI__MINUS_INFINITE,
  DVI__NOT_A_NUMBER,
  DVI__SUM_NUMBERS,
  DVI__SUM_TERMS = 256,      /* that are added at once */
  DVI__CARRY_AFTER = 1 << 10 /* terms. Digits would take twice as many */
};

/* All zero for an empty sum. Digits may have signs, and carries that are not done yet. After a
 * carry, the numbers of sums can be added up, number by number. */
typedef struct dvi__accumulator {
  int64_t number[DVI__SUM_NUMBERS];
  int terms; /* since the last carry */
} dvi__accumulator;

/* Carry until all digits but the last are from 0 to 2^32 - 1. The last one has the sign. */
void dvi__accumulator_carry(dvi__accumulator *sum);

/* Count a term that is not finite. */
static inline void dvi__accumulate_other(dvi__accumulator *sum, double term)
{
  sum->number[term > 0 ? DVI__INFINITE : term < 0 ? DVI__MINUS_INFINITE : DVI__NOT_A_NUMBER]++;
}

/* Add a term. */
static inline void dvi__accumulate(dvi__accumulator *sum, double term)
{
  uint64_t bits;
  memcpy(&bits, &term, sizeof bits);
  const int exponent = (int)(bits >> 52 & 0x7ff);
  uint64_t mantissa = bits & 0xfffffffffffff;
  if (exponent == 0x7ff) {
    dvi__accumulate_other(sum, term);
    return;
  }
  if (exponent != 0) mantissa |= UINT64_C(1) << 52;
  const int place = exponent != 0 ? exponent - 1 : 0, shift = place & 31;
  int64_t *digit = sum->number + (place >> 5);
  const int64_t low = (int64_t)(mantissa << shift & 0xffffffff),
                high = (int64_t)(mantissa >> (32 - shift));
  digit[0] += bits >> 63 ? -low : low;
  digit[1] += bits >> 63 ? -high : high;
  if (++sum->terms == DVI__CARRY_AFTER) dvi__accumulator_carry(sum);
}

/* Add DVI__SUM_TERMS terms, which are overwritten. It takes less time than one after the other. */
void dvi__accumulate_terms(dvi__accumulator *sum, double *term);

/* A sum of many terms, which are added in blocks. All zero for none. */
typedef struct dvi__block_sum {
  dvi__accumulator sum;
  int count; /* of terms in the block */
  double term[DVI__SUM_TERMS];
} dvi__block_sum;

static inline void dvi__block_sum_add(dvi__block_sum *s, double term)
{
  s->term[s->count++] = term;
  if (s->count < DVI__SUM_TERMS) return;
  dvi__accumulate_terms(&s->sum, s->term);
  s->count = 0;
}

/* Add the terms of the block, and return the sum. */
dvi__accumulator *dvi__block_sum_end(dvi__block_sum *s);

/* Add the products of n numbers, each rounded. `taken` [n] is not 0 for those that count. It is
 * NULL for all. */
void dvi__accumulate_products(dvi__accumulator *sum, int64_t n, const double *x, const double *y,
                              const char *taken);

/* Give the sum, rounded to the nearest double, and of two to the even one. */
double dvi__accumulator_value(const dvi__accumulator *sum);

#endif
