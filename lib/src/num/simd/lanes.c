#include "num/simd/lanes.h"

#include <math.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "num/simd/width.h"

int dvi__lanes_for(int stages)
{
  return stages <= 2 ? stages : stages <= 4 ? 4 : (stages + 7) / 8 * 8;
}

enum { FETCH_AHEAD = 1024 }; /* bytes: half of it is as good, twice as much is worse */

#define LOOPS "num/simd/lanes_width.h"
#include "num/simd/each_width.h"

/* Rows of eight lanes are the most common ones, and their few terms are worth knowing at compile
 * time. */
INLINE void product_of_eight(int n, int terms, int width, const double *matrix, const double *x,
                             double *out)
{
  switch (terms) {
  case 5: product8(n, 5, 8, width, matrix, x, out); break;
  case 6: product8(n, 6, 8, width, matrix, x, out); break;
  case 7: product8(n, 7, 8, width, matrix, x, out); break;
  case 8: product8(n, 8, 8, width, matrix, x, out); break;
  default: product8(n, terms, 8, width, matrix, x, out);
  }
}

/* Vectors as wide as the target has them, at most as wide as a row. */
INLINE void product(int widest, int n, int terms, int lanes, int width, const double *matrix,
                    const double *x, double *out)
{
  const int W = lanes < widest ? lanes : widest;
  if (W == 1)
    product1(n, terms, lanes, width, matrix, x, out);
  else if (W == 2)
    product2(n, terms, lanes, width, matrix, x, out);
  else if (W == 4)
    product4(n, terms, lanes, width, matrix, x, out);
  else if (lanes == 8)
    product_of_eight(n, terms, width, matrix, x, out);
  else
    product8(n, terms, lanes, width, matrix, x, out);
}

#define SWEEP(width)                       \
  switch (s->lanes == 8 ? s->stages : 0) { \
  case 5: sweep_known##width(s, 5); break; \
  case 6: sweep_known##width(s, 6); break; \
  case 7: sweep_known##width(s, 7); break; \
  case 8: sweep_known##width(s, 8); break; \
  default: sweep##width(s);                \
  }

INLINE void sweep(int widest, dvi__sweep *s)
{
  const int W = s->lanes < widest ? s->lanes : widest;
  if (W == 1)
    sweep1(s);
  else if (W == 2)
    SWEEP(2)
  else if (W == 4)
    SWEEP(4)
  else
    SWEEP(8)
}

INLINE void begin(int widest, const dvi__sweep *s)
{
  const int W = s->lanes < widest ? s->lanes : widest;
  if (W == 1)
    begin1(s);
  else if (W == 2)
    begin2(s);
  else if (W == 4)
    begin4(s);
  else
    begin8(s);
}

INLINE void weigh(int n, int stages, const double *weight, double *x)
{
  stages == 8 ? weigh1(n, 8, weight, x) : weigh1(n, stages, weight, x);
}

/* A fused product tells what rounding takes from one; where the processor has none, the library
 * function gives the same bits. */
INLINE void split(const dvi__sweep *s)
{
  for (int i = 0; i < s->n; i++) {
    s->start[i] = s->factor[i] * s->p0[i];
    s->low[i] = __builtin_fma(s->factor[i], s->p0[i], -s->start[i]);
  }
}

/* The error of p0 + half is Knuth's (1969), sec. 4.2.2. */
INLINE void ends(const dvi__ends *e, const int stages)
{
  const double *g = e->g;
  for (int i = 0; i < e->n; i++, g += stages) {
    double sum = 0, slanted = 0;
    for (int j = 0; j < stages; j++) {
      sum += g[j];
      slanted += e->slant[j] * g[j];
    }
    const double half = 0.5 * sum, middle = e->p0[i] + half, back = middle - e->p0[i];
    const double rest = (e->p0[i] - (middle - back)) + (half - back);
    e->sum[i] = sum;
    e->moved[i] = e->factor[i] * middle;
    e->low[i] = __builtin_fma(e->factor[i], middle, -e->moved[i]) + e->factor[i] * (rest + slanted);
  }
}

/* The exponent bits are all set in NaN and Inf alone; one more in the last of them then runs over
 * into the sign's place. */
INLINE int all_finite(size_t count, const double *x)
{
  const uint64_t exponent = UINT64_C(0x7ff0000000000000), last = UINT64_C(0x0010000000000000);
  uint64_t overflow = 0;
  for (size_t i = 0; i < count; i++) {
    uint64_t bits;
    memcpy(&bits, x + i, sizeof bits);
    overflow |= (bits & exponent) + last;
  }
  return overflow >> 63 == 0;
}

/* Magnitudes are ordered as their bits are, with Inf above all numbers and NaN above Inf. */
INLINE double largest(size_t count, const double *x)
{
  uint64_t most = 0;
  for (size_t i = 0; i < count; i++) {
    uint64_t bits;
    memcpy(&bits, x + i, sizeof bits);
    bits &= INT64_MAX;
    most = bits > most ? bits : most;
  }
  double magnitude;
  memcpy(&magnitude, &most, sizeof magnitude);
  return magnitude;
}

INLINE void leap_as(int widest, const dvi__moser_veselov *l, const int kicks,
                    const dvi__division by)
{
  size_t i = 0;
  if (widest == 8)
    i = leap8(l, i, kicks, by);
  else if (widest == 4)
    i = leap4(l, i, kicks, by);
  else
    i = leap2(l, i, kicks, by);
  (void)leap1(l, i, kicks, by);
}

INLINE void leap_by(int widest, const dvi__moser_veselov *l, const dvi__division by)
{
  l->kicks == 2 ? leap_as(widest, l, 2, by) : leap_as(widest, l, 1, by);
}

INLINE void leap(int widest, const dvi__moser_veselov *l)
{
  if (l->by == DVI__TIMES_SCALAR)
    leap_by(widest, l, DVI__TIMES_SCALAR);
  else if (l->by == DVI__BY_SCALAR)
    leap_by(widest, l, DVI__BY_SCALAR);
  else
    leap_by(widest, l, DVI__BY_ARRAY);
}

INLINE void add_scaled(int widest, size_t count, double factor, const double *x, double *sum,
                       double *carry)
{
  size_t i = 0;
  if (widest == 8)
    i = add_scaled8(i, count, factor, x, sum, carry);
  else if (widest == 4)
    i = add_scaled4(i, count, factor, x, sum, carry);
  else
    i = add_scaled2(i, count, factor, x, sum, carry);
  (void)add_scaled1(i, count, factor, x, sum, carry);
}

/* ---- instruction sets ---- */

typedef struct level {
  const char *name;
  void (*sweep)(dvi__sweep *s);
  void (*weigh)(int n, int stages, const double *weight, double *x);
  void (*split)(const dvi__sweep *s);
  void (*begin)(const dvi__sweep *s);
  void (*ends)(const dvi__ends *e);
  void (*product)(int n, int terms, int lanes, int width, const double *matrix, const double *x,
                  double *out);
  int (*all_finite)(size_t count, const double *x);
  double (*largest)(size_t count, const double *x);
  void (*leap)(const dvi__moser_veselov *l);
  void (*add_scaled)(size_t count, double factor, const double *x, double *sum, double *carry);
} level;

#define LEVEL(suffix, target, widest)                                                     \
  target static void sweep_##suffix(dvi__sweep *s)                                        \
  {                                                                                       \
    sweep(widest, s);                                                                     \
  }                                                                                       \
  target static void weigh_##suffix(int n, int stages, const double *weight, double *x)   \
  {                                                                                       \
    weigh(n, stages, weight, x);                                                          \
  }                                                                                       \
  target static void split_##suffix(const dvi__sweep *s)                                  \
  {                                                                                       \
    split(s);                                                                             \
  }                                                                                       \
  target static void begin_##suffix(const dvi__sweep *s)                                  \
  {                                                                                       \
    begin(widest, s);                                                                     \
  }                                                                                       \
  target static void ends_##suffix(const dvi__ends *e)                                    \
  {                                                                                       \
    e->stages == 8 ? ends(e, 8) : ends(e, e->stages);                                     \
  }                                                                                       \
  target static void product_##suffix(int n, int terms, int lanes, int width,             \
                                      const double *matrix, const double *x, double *out) \
  {                                                                                       \
    product(widest, n, terms, lanes, width, matrix, x, out);                              \
  }                                                                                       \
  target static int all_finite_##suffix(size_t count, const double *x)                    \
  {                                                                                       \
    return all_finite(count, x);                                                          \
  }                                                                                       \
  target static double largest_##suffix(size_t count, const double *x)                    \
  {                                                                                       \
    return largest(count, x);                                                             \
  }                                                                                       \
  target static void leap_##suffix(const dvi__moser_veselov *l)                           \
  {                                                                                       \
    leap(widest, l);                                                                      \
  }                                                                                       \
  target static void add_scaled_##suffix(size_t count, double factor, const double *x,    \
                                         double *sum, double *carry)                      \
  {                                                                                       \
    add_scaled(widest, count, factor, x, sum, carry);                                     \
  }

LEVEL(baseline, , 2)
#ifdef __x86_64__
LEVEL(avx2, __attribute__((target("avx2,fma"))), 4)
LEVEL(avx512, __attribute__((target("fma,avx512f,avx512dq,avx512vl"))), 8)
#endif

static const level levels[] = {
    {"baseline", sweep_baseline, weigh_baseline, split_baseline, begin_baseline, ends_baseline,
     product_baseline, all_finite_baseline, largest_baseline, leap_baseline, add_scaled_baseline},
#ifdef __x86_64__
    {"avx2", sweep_avx2, weigh_avx2, split_avx2, begin_avx2, ends_avx2, product_avx2,
     all_finite_avx2, largest_avx2, leap_avx2, add_scaled_avx2},
    {"avx512", sweep_avx512, weigh_avx512, split_avx512, begin_avx512, ends_avx512, product_avx512,
     all_finite_avx512, largest_avx512, leap_avx512, add_scaled_avx512},
#endif
};

int dvi__lanes_levels(void)
{
#ifdef __x86_64__
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return 1;
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                 __builtin_cpu_supports("avx512vl")
             ? 3
             : 2;
#else
  return 1;
#endif
}

const char *dvi__lanes_level_name(int number)
{
  return number >= 0 && number < (int)(sizeof levels / sizeof *levels) ? levels[number].name : NULL;
}

static _Atomic(const level *) chosen;

void dvi__lanes_choose(int number)
{
  atomic_store_explicit(&chosen, &levels[number >= 0 ? number : dvi__lanes_levels() - 1],
                        memory_order_relaxed);
}

/* Two threads may both choose the best at first: they choose the same. */
static const level *best(void)
{
  const level *found = atomic_load_explicit(&chosen, memory_order_relaxed);
  if (found != NULL) return found;
  dvi__lanes_choose(-1);
  return atomic_load_explicit(&chosen, memory_order_relaxed);
}

int dvi__lanes_level(void)
{
  return (int)(best() - levels);
}

void dvi__lanes_sweep(dvi__sweep *s)
{
  best()->sweep(s);
}

void dvi__lanes_weigh(int n, int stages, const double *weight, double *x)
{
  best()->weigh(n, stages, weight, x);
}

void dvi__lanes_split(const dvi__sweep *s)
{
  best()->split(s);
}

void dvi__lanes_begin(const dvi__sweep *s)
{
  best()->begin(s);
}

void dvi__lanes_ends(const dvi__ends *ends)
{
  best()->ends(ends);
}

void dvi__lanes_product(int n, int terms, int lanes, int width, const double *matrix,
                        const double *x, double *out)
{
  best()->product(n, terms, lanes, width, matrix, x, out);
}

int dvi__lanes_all_finite(size_t count, const double *x)
{
  return best()->all_finite(count, x);
}

double dvi__lanes_largest(size_t count, const double *x)
{
  return best()->largest(count, x);
}

void dvi__lanes_kick_drift(const dvi__moser_veselov *leap)
{
  best()->leap(leap);
}

void dvi__lanes_add_scaled(size_t count, double factor, const double *x, double *sum, double *carry)
{
  best()->add_scaled(count, factor, x, sum, carry);
}

dvi__division dvi__division_by(double mass, double *scalar)
{
  int exponent;
  const int power_of_two = fabs(frexp(mass, &exponent)) == 0.5 && isnormal(1 / mass);
  *scalar = power_of_two ? 1 / mass : mass;
  return power_of_two ? DVI__TIMES_SCALAR : DVI__BY_SCALAR;
}
