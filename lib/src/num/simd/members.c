#include "num/simd/members.h"

#include <stdint.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "num/simd/tails.h"
#include "num/simd/width.h"

#define LOOPS "num/simd/members_width.h"
#include "num/simd/each_width.h"

/* Members are lanes where stages are few, and these loops are worth knowing at compile time. */
#define ITERATE(width)                                             \
  INLINE void iterate_by##width(const dvi__members_fixed_point *s) \
  {                                                                \
    switch (s->stages) {                                           \
    case 1: ALL(width, iterate, s, 1); break;                      \
    case 2: ALL(width, iterate, s, 2); break;                      \
    case 3: ALL(width, iterate, s, 3); break;                      \
    case 4: ALL(width, iterate, s, 4); break;                      \
    case 5: ALL(width, iterate, s, 5); break;                      \
    case 6: ALL(width, iterate, s, 6); break;                      \
    case 7: ALL(width, iterate, s, 7); break;                      \
    case 8: ALL(width, iterate, s, 8); break;                      \
    default: ALL(width, iterate, s, s->stages);                    \
    }                                                              \
  }
ITERATE(2)
ITERATE(4)
ITERATE(8)

/* Split as in lanes.c. */
INLINE void split(int n, int width, const double *factor, const double *restrict p0,
                  double *restrict start, double *restrict low)
{
  for (int i = 0; i < n; i++, p0 += width, start += width, low += width)
    for (int k = 0; k < width; k++) {
      start[k] = factor[i] * p0[k];
      low[k] = __builtin_fma(factor[i], p0[k], -start[k]);
    }
}

/* Find the end values as in lanes.c, from the sums on. */
INLINE void finish(int width, double factor, const double *restrict sum, const double *restrict p0,
                   double *restrict moved, double *restrict low)
{
  for (int k = 0; k < width; k++) {
    const double half = 0.5 * sum[k], middle = p0[k] + half, back = middle - p0[k];
    const double rest = (p0[k] - (middle - back)) + (half - back);
    moved[k] = factor * middle;
    low[k] = __builtin_fma(factor, middle, -moved[k]) + factor * (rest + low[k]);
  }
}

#define ENDS(suffix)                                                                        \
  INLINE void ends_by##suffix(const dvi__members_ends *e)                                   \
  {                                                                                         \
    const size_t row = (size_t)e->width;                                                    \
    ALL(suffix, sums, e);                                                                   \
    for (size_t i = 0; i < (size_t)e->n; i++)                                               \
      finish(e->width, e->factor[i], e->sum + i * row, e->p0 + i * row, e->moved + i * row, \
             e->low + i * row);                                                             \
  }
ENDS(2)
ENDS(4)
ENDS(8)

/* ---- instruction sets ---- */

typedef struct level {
  void (*iterate)(const dvi__members_fixed_point *s);
  void (*split)(int n, int width, const double *factor, const double *p0, double *start,
                double *low);
  void (*begin)(const dvi__members_fixed_point *s);
  void (*ends)(const dvi__members_ends *e);
  void (*product)(int n, int terms, int lanes, int rows, const double *matrix, int width,
                  const double *x, double *out);
} level;

#define LEVEL(suffix, target, width)                                                               \
  target static void iterate_##suffix(const dvi__members_fixed_point *s)                           \
  {                                                                                                \
    iterate_by##width(s);                                                                          \
  }                                                                                                \
  target static void split_##suffix(int n, int members, const double *factor, const double *p0,    \
                                    double *start, double *low)                                    \
  {                                                                                                \
    split(n, members, factor, p0, start, low);                                                     \
  }                                                                                                \
  target static void begin_##suffix(const dvi__members_fixed_point *s)                             \
  {                                                                                                \
    ALL(width, begin, s);                                                                          \
  }                                                                                                \
  target static void ends_##suffix(const dvi__members_ends *e)                                     \
  {                                                                                                \
    ends_by##width(e);                                                                             \
  }                                                                                                \
  target static void product_##suffix(int n, int terms, int lanes, int rows, const double *matrix, \
                                      int members, const double *x, double *out)                   \
  {                                                                                                \
    ALL(width, product, n, terms, lanes, rows, matrix, members, x, out);                           \
  }

LEVEL(baseline, , 2)
#ifdef __x86_64__
LEVEL(avx2, __attribute__((target("avx2,fma"))), 4)
LEVEL(avx512, __attribute__((target("fma,avx512f,avx512dq,avx512vl"))), 8)
#endif

/* Levels in the order of num/simd/lanes.c. */
static const level levels[] = {
    {iterate_baseline, split_baseline, begin_baseline, ends_baseline, product_baseline},
#ifdef __x86_64__
    {iterate_avx2, split_avx2, begin_avx2, ends_avx2, product_avx2},
    {iterate_avx512, split_avx512, begin_avx512, ends_avx512, product_avx512},
#endif
};

static const level *level_in_use(void)
{
  return &levels[dvi__lanes_level()];
}

void dvi__members_iterate(const dvi__members_fixed_point *s)
{
  level_in_use()->iterate(s);
}

void dvi__members_split(int n, int width, const double *factor, const double *p0, double *start,
                        double *low)
{
  level_in_use()->split(n, width, factor, p0, start, low);
}

void dvi__members_begin(const dvi__members_fixed_point *s)
{
  level_in_use()->begin(s);
}

void dvi__members_ends_of(const dvi__members_ends *ends)
{
  level_in_use()->ends(ends);
}

void dvi__members_product(int n, int terms, int lanes, int rows, const double *matrix, int width,
                          const double *x, double *out)
{
  level_in_use()->product(n, terms, lanes, rows, matrix, width, x, out);
}
