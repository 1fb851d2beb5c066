#include "num/simd/lanes.h"

#include <math.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __x86_64__
#include <emmintrin.h>
#endif

#include "num/simd/width.h"

int dvi__lanes_for(int stages)
{
  return stages <= 2 ? stages : stages <= 4 ? 4 : (stages + 7) / 8 * 8;
}

enum { FETCH_AHEAD = 1536 }; /* in bytes; half of it is nearly as good */

#define LOOPS "num/simd/kick_drift_width.h"
#include "num/simd/each_width.h"

/* Rows of eight lanes are the most common ones, and their few terms are worth knowing at compile
 * time. */
#define PRODUCT_OF_EIGHT(width)                                                          \
  INLINE void product_of_eight##width(int n, int terms, int count, const double *matrix, \
                                      const double *x, double *out)                      \
  {                                                                                      \
    switch (terms) {                                                                     \
    case 5: known_product##width(n, 5, count, matrix, x, out); break;                    \
    case 6: known_product##width(n, 6, count, matrix, x, out); break;                    \
    case 7: known_product##width(n, 7, count, matrix, x, out); break;                    \
    case 8:                                                                              \
      count == 8 ? known_product##width(n, 8, 8, matrix, x, out)                         \
                 : known_product##width(n, 8, count, matrix, x, out);                    \
      break;                                                                             \
    default: product##width(n, terms, 8, count, matrix, x, out);                         \
    }                                                                                    \
  }
PRODUCT_OF_EIGHT(2)
PRODUCT_OF_EIGHT(4)
PRODUCT_OF_EIGHT(8)

/* Multiply in vectors as narrow as a row. */
INLINE void product_of_few(int n, int terms, int lanes, int width, const double *matrix,
                           const double *x, double *out)
{
  if (lanes == 1)
    product1(n, terms, lanes, width, matrix, x, out);
  else if (lanes == 2)
    product2(n, terms, lanes, width, matrix, x, out);
  else
    product4(n, terms, lanes, width, matrix, x, out);
}

INLINE void iterate(int widest, dvi__fixed_point *s)
{
  const int W = s->lanes < widest ? s->lanes : widest;
  if (W == 2)
    iterate2(s);
  else if (W == 4)
    iterate4(s);
  else
    iterate8(s);
}

INLINE void begin(int widest, const dvi__fixed_point *s)
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

INLINE void split(const dvi__fixed_point *s)
{
  for (size_t i = 0; i < (size_t)s->n; i++) split_one1(s, i);
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

/* The exponent bits are all set in NaN and Inf alone. Adding one to the last of them then carries
 * into the sign bit. */
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

INLINE int kick_drift_with_kicks(int widest, const dvi__kick_drift *l, const int kicks,
                                 const dvi__division by, const int far)
{
  int64_t doubt = 0;
  size_t i = 0;
  if (widest == 8)
    i = kick_drift8(l, i, kicks, by, far, &doubt);
  else if (widest == 4)
    i = kick_drift4(l, i, kicks, by, far, &doubt);
  else
    i = kick_drift2(l, i, kicks, by, far, &doubt);
  (void)kick_drift1(l, i, kicks, by, far, &doubt);
  return (doubt & INT64_MAX) == 0;
}

/* Only the first operation on a step's state, of one kick, finds it far away. */
INLINE int kick_drift_with_division(int widest, const dvi__kick_drift *l, const dvi__division by)
{
  return l->kicks == 2         ? kick_drift_with_kicks(widest, l, 2, by, 0)
         : l->far == DVI__NEAR ? kick_drift_with_kicks(widest, l, 1, by, 0)
                               : kick_drift_with_kicks(widest, l, 1, by, 1);
}

INLINE int kick_drift(int widest, const dvi__kick_drift *l)
{
  return l->by == DVI__TIMES_SCALAR ? kick_drift_with_division(widest, l, DVI__TIMES_SCALAR)
         : l->by == DVI__BY_SCALAR  ? kick_drift_with_division(widest, l, DVI__BY_SCALAR)
                                    : kick_drift_with_division(widest, l, DVI__BY_ARRAY);
}

INLINE void add_scaled(int widest, size_t count, double factor, const double *x, double *sum,
                       double *compensation)
{
  size_t i = 0;
  if (widest == 8)
    i = add_scaled8(i, count, factor, x, sum, compensation);
  else if (widest == 4)
    i = add_scaled4(i, count, factor, x, sum, compensation);
  else
    i = add_scaled2(i, count, factor, x, sum, compensation);
  (void)add_scaled1(i, count, factor, x, sum, compensation);
}

INLINE void last_kick_past(int widest, const dvi__last_kick *l, const int past, const int in_pairs,
                           int64_t *doubt)
{
  size_t i = 0, j = 0;
  if (widest == 8) {
    i = last_kick8(l, i, past, in_pairs, doubt);
    j = last_q8(l, j, past, in_pairs, doubt);
  } else if (widest == 4) {
    i = last_kick4(l, i, past, in_pairs, doubt);
    j = last_q4(l, j, past, in_pairs, doubt);
  } else {
    i = last_kick2(l, i, past, in_pairs, doubt);
    j = last_q2(l, j, past, in_pairs, doubt);
  }
  (void)last_kick1(l, i, past, in_pairs, doubt);
  (void)last_q1(l, j, past, in_pairs, doubt);
}

/* Pairs of numbers are stored past the caches if no pair straddles lines. */
INLINE int last_kick(int widest, const dvi__last_kick *l)
{
  const uintptr_t all = (uintptr_t)l->to.q | (uintptr_t)l->to.p | (uintptr_t)l->to.q_compensation |
                        (uintptr_t)l->to.p_compensation | (uintptr_t)l->force_to;
  int64_t doubt = 0;
  if (!l->past)
    last_kick_past(widest, l, 0, 0, &doubt);
  else if (all % (2 * sizeof(double)) == 0)
    last_kick_past(widest, l, 1, 1, &doubt);
  else
    last_kick_past(widest, l, 1, 0, &doubt);
  return (doubt & INT64_MAX) == 0;
}

/* ---- instruction sets ---- */

typedef struct level {
  const char *name;
  /* by the number of stages, the first one for more than eight */
  void (*iterate[9])(dvi__fixed_point *s);
  void (*weigh)(int n, int stages, const double *weight, double *x);
  void (*split)(const dvi__fixed_point *s);
  void (*begin)(const dvi__fixed_point *s);
  void (*begin_from)(const dvi__fixed_point *s, const double *table, const double *g);
  void (*ends)(const dvi__ends *e);
  void (*product)(int n, int terms, int lanes, int width, const double *matrix, const double *x,
                  double *out);
  int (*all_finite)(size_t count, const double *x);
  double (*largest)(size_t count, const double *x);
  int (*kick_drift)(const dvi__kick_drift *l);
  int (*last_kick)(const dvi__last_kick *l);
  void (*add_scaled)(size_t count, double factor, const double *x, double *sum,
                     double *compensation);
} level;

/* Each number of stages has a function of its own, whose few registers are soon saved. */
#define KNOWN(suffix, target, width, stages, lanes)                   \
  target static void iterate_##stages##_##suffix(dvi__fixed_point *s) \
  {                                                                   \
    iterate_known##width(s, stages, lanes);                           \
  }

#define LEVEL(suffix, target, widest, of_four)                                            \
  target static void iterate_0_##suffix(dvi__fixed_point *s)                              \
  {                                                                                       \
    iterate(widest, s);                                                                   \
  }                                                                                       \
  KNOWN(suffix, target, 1, 1, 1)                                                          \
  KNOWN(suffix, target, 2, 2, 2)                                                          \
  KNOWN(suffix, target, of_four, 3, 4)                                                    \
  KNOWN(suffix, target, of_four, 4, 4)                                                    \
  KNOWN(suffix, target, widest, 5, 8)                                                     \
  KNOWN(suffix, target, widest, 6, 8)                                                     \
  KNOWN(suffix, target, widest, 7, 8)                                                     \
  KNOWN(suffix, target, widest, 8, 8)                                                     \
  target static void weigh_##suffix(int n, int stages, const double *weight, double *x)   \
  {                                                                                       \
    weigh(n, stages, weight, x);                                                          \
  }                                                                                       \
  target static void split_##suffix(const dvi__fixed_point *s)                            \
  {                                                                                       \
    split(s);                                                                             \
  }                                                                                       \
  target static void begin_##suffix(const dvi__fixed_point *s)                            \
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
    if (lanes == 8)                                                                       \
      product_of_eight##widest(n, terms, width, matrix, x, out);                          \
    else if (lanes > 8)                                                                   \
      product##widest(n, terms, lanes, width, matrix, x, out);                            \
    else                                                                                  \
      product_of_few(n, terms, lanes, width, matrix, x, out);                             \
  }                                                                                       \
  target static void begin_from_##suffix(const dvi__fixed_point *s, const double *table,  \
                                         const double *g)                                 \
  {                                                                                       \
    if (s->stages == 8)                                                                   \
      begin_eight##widest(s, table, g);                                                   \
    else {                                                                                \
      split(s);                                                                           \
      product_##suffix(s->n, s->stages, s->lanes, s->lanes, table, g, s->Z);              \
      begin(widest, s);                                                                   \
    }                                                                                     \
  }                                                                                       \
  target static int all_finite_##suffix(size_t count, const double *x)                    \
  {                                                                                       \
    return all_finite(count, x);                                                          \
  }                                                                                       \
  target static double largest_##suffix(size_t count, const double *x)                    \
  {                                                                                       \
    return largest(count, x);                                                             \
  }                                                                                       \
  target static int kick_drift_##suffix(const dvi__kick_drift *l)                         \
  {                                                                                       \
    return kick_drift(widest, l);                                                         \
  }                                                                                       \
  target static int last_kick_##suffix(const dvi__last_kick *l)                           \
  {                                                                                       \
    return last_kick(widest, l);                                                          \
  }                                                                                       \
  target static void add_scaled_##suffix(size_t count, double factor, const double *x,    \
                                         double *sum, double *compensation)               \
  {                                                                                       \
    add_scaled(widest, count, factor, x, sum, compensation);                              \
  }

LEVEL(baseline, , 2, 2)
#ifdef __x86_64__
LEVEL(avx2, __attribute__((target("avx2,fma"))), 4, 4)
LEVEL(avx512, __attribute__((target("fma,avx512f,avx512dq,avx512vl"))), 8, 4)
#endif

#define FUNCTIONS(suffix)                                                                       \
  {                                                                                             \
    .name = #suffix, .weigh = weigh_##suffix, .split = split_##suffix, .begin = begin_##suffix, \
    .begin_from = begin_from_##suffix, .ends = ends_##suffix, .product = product_##suffix,      \
    .all_finite = all_finite_##suffix, .largest = largest_##suffix,                             \
    .kick_drift = kick_drift_##suffix, .last_kick = last_kick_##suffix,                         \
    .add_scaled = add_scaled_##suffix, .iterate = {                                             \
      iterate_0_##suffix,                                                                       \
      iterate_1_##suffix,                                                                       \
      iterate_2_##suffix,                                                                       \
      iterate_3_##suffix,                                                                       \
      iterate_4_##suffix,                                                                       \
      iterate_5_##suffix,                                                                       \
      iterate_6_##suffix,                                                                       \
      iterate_7_##suffix,                                                                       \
      iterate_8_##suffix                                                                        \
    }                                                                                           \
  }

static const level levels[] = {
    FUNCTIONS(baseline),
#ifdef __x86_64__
    FUNCTIONS(avx2),
    FUNCTIONS(avx512),
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

/* Give the level in use. Two threads may both choose the best at first, and choose the same. */
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

void dvi__lanes_iterate(dvi__fixed_point *s)
{
  best()->iterate[s->stages <= 8 ? s->stages : 0](s);
}

void dvi__lanes_weigh(int n, int stages, const double *weight, double *x)
{
  best()->weigh(n, stages, weight, x);
}

void dvi__lanes_split(const dvi__fixed_point *s)
{
  best()->split(s);
}

void dvi__lanes_begin(const dvi__fixed_point *s)
{
  best()->begin(s);
}

void dvi__lanes_begin_from(const dvi__fixed_point *s, const double *table, const double *g)
{
  best()->begin_from(s, table, g);
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

int dvi__lanes_kick_drift(const dvi__kick_drift *kick_drift)
{
  return best()->kick_drift(kick_drift);
}

void dvi__lanes_await_stores(void)
{
#ifdef __x86_64__
  _mm_sfence();
#endif
}

int dvi__lanes_last_kick(const dvi__last_kick *last_kick)
{
  return best()->last_kick(last_kick);
}

/* So few numbers cost less than the choice of a loop. */
enum { FEW = 8 };

void dvi__lanes_add_scaled(size_t count, double factor, const double *x, double *sum,
                           double *compensation)
{
  if (count <= FEW)
    (void)add_scaled1(0, count, factor, x, sum, compensation);
  else
    best()->add_scaled(count, factor, x, sum, compensation);
}

dvi__division dvi__division_by(double mass, double *scalar)
{
  int exponent;
  const int power_of_two = fabs(frexp(mass, &exponent)) == 0.5 && isnormal(1 / mass);
  *scalar = power_of_two ? 1 / mass : mass;
  return power_of_two ? DVI__TIMES_SCALAR : DVI__BY_SCALAR;
}
