#include "num/lanes.h"

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "num/width.h"

int dvi__lanes_for(int stages)
{
  return stages <= 2 ? stages : stages <= 4 ? 4 : (stages + 7) / 8 * 8;
}

#define WIDTH 1
#include "num/lanes_width.h"
#undef WIDTH
#define WIDTH 2
#include "num/lanes_width.h"
#undef WIDTH
#define WIDTH 4
#include "num/lanes_width.h"
#undef WIDTH
#define WIDTH 8
#include "num/lanes_width.h"
#undef WIDTH

/* Vectors as wide as the target has them, at most as wide as a row. Eight stages are so common, and so small, that their loops are worth knowing at
 * compile time. */
INLINE void product(int widest, int n, int terms, int lanes, int width, const double *matrix, const double *x, double *out)
{
  const int W = lanes < widest ? lanes : widest, eight = lanes == 8 && width == 8 && terms == 8;
  if (W == 1)
    product1(n, terms, lanes, width, matrix, x, out);
  else if (W == 2)
    product2(n, terms, lanes, width, matrix, x, out);
  else if (W == 4)
    product4(n, terms, lanes, width, matrix, x, out);
  else if (eight)
    product8(n, 8, 8, 8, matrix, x, out);
  else
    product8(n, terms, lanes, width, matrix, x, out);
}

INLINE void sweep(int widest, dvi__sweep *s)
{
  const int W = s->lanes < widest ? s->lanes : widest, eight = s->lanes == 8 && s->stages == 8;
  if (W == 1)
    sweep1(s, 1, 1);
  else if (W == 2)
    eight ? sweep2(s, 8, 8) : sweep2(s, s->stages, s->lanes);
  else if (W == 4)
    eight ? sweep4(s, 8, 8) : sweep4(s, s->stages, s->lanes);
  else
    eight ? sweep8(s, 8, 8) : sweep8(s, s->stages, s->lanes);
}

/* The exponent bits are all set in NaN and Inf alone; one more in the last of them then runs over into the sign's place. */
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

/* ---- instruction sets ---- */

typedef struct level {
  const char *name;
  void (*sweep)(dvi__sweep *s);
  void (*product)(int n, int terms, int lanes, int width, const double *matrix, const double *x, double *out);
  int (*all_finite)(size_t count, const double *x);
} level;

#define LEVEL(suffix, target, widest)                                                                                             \
  target static void sweep_##suffix(dvi__sweep *s)                                                                                \
  {                                                                                                                               \
    sweep(widest, s);                                                                                                             \
  }                                                                                                                               \
  target static void product_##suffix(int n, int terms, int lanes, int width, const double *matrix, const double *x, double *out) \
  {                                                                                                                               \
    product(widest, n, terms, lanes, width, matrix, x, out);                                                                      \
  }                                                                                                                               \
  target static int all_finite_##suffix(size_t count, const double *x)                                                            \
  {                                                                                                                               \
    return all_finite(count, x);                                                                                                  \
  }

LEVEL(baseline, , 2)
#ifdef __x86_64__
LEVEL(avx2, __attribute__((target("avx2"))), 4)
LEVEL(avx512, __attribute__((target("avx512f,avx512dq,avx512vl"))), 8)
#endif

static const level levels[] = {
    {"baseline", sweep_baseline, product_baseline, all_finite_baseline},
#ifdef __x86_64__
    {"avx2", sweep_avx2, product_avx2, all_finite_avx2},
    {"avx512", sweep_avx512, product_avx512, all_finite_avx512},
#endif
};

int dvi__lanes_levels(void)
{
#ifdef __x86_64__
  if (!__builtin_cpu_supports("avx2")) return 1;
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") ? 3 : 2;
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
  atomic_store_explicit(&chosen, &levels[number >= 0 ? number : dvi__lanes_levels() - 1], memory_order_relaxed);
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

void dvi__lanes_product(int n, int terms, int lanes, int width, const double *matrix, const double *x, double *out)
{
  best()->product(n, terms, lanes, width, matrix, x, out);
}

int dvi__lanes_all_finite(size_t count, const double *x)
{
  return best()->all_finite(count, x);
}
