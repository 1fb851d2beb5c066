#include "num/simd/rescaled.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "num/simd/width.h"

#define LOOPS "num/simd/rescaled_width.h"
#include "num/simd/each_width.h"

/* Take vectors as wide as the target has them, and at most as wide as a row. Eight stages are known
 * at compile time. */
#define IN_VECTORS(function)                                        \
  const int W = s->lanes < widest ? s->lanes : widest;              \
  if (W == 1)                                                       \
    function##1(s, s->stages);                                      \
  else if (W == 2)                                                  \
    function##2(s, s->stages);                                      \
  else if (W == 4)                                                  \
    s->stages == 8 ? function##4(s, 8) : function##4(s, s->stages); \
  else                                                              \
    s->stages == 8 ? function##8(s, 8) : function##8(s, s->stages);

INLINE void iterate(int widest, dvi__rescaled_sums *s){IN_VECTORS(rescaled_iterate)}

INLINE void begin(int widest, const dvi__rescaled_sums *s){IN_VECTORS(rescaled_begin)}

/* Compilers make vectors of this loop where sqrt need not set errno (lib/CMakeLists.txt). */
INLINE void distances(size_t count, const double *restrict x, double *restrict power)
{
  for (size_t k = 0; k < count; k++) power[k] = 1 / sqrt(x[k] * sqrt(x[k]));
}

typedef struct level {
  void (*iterate)(dvi__rescaled_sums *s);
  void (*begin)(const dvi__rescaled_sums *s);
  void (*distances)(size_t count, const double *x, double *power);
} level;

#define LEVEL(suffix, target, widest)                                                 \
  target static void iterate_##suffix(dvi__rescaled_sums *s)                          \
  {                                                                                   \
    iterate(widest, s);                                                               \
  }                                                                                   \
  target static void begin_##suffix(const dvi__rescaled_sums *s)                      \
  {                                                                                   \
    begin(widest, s);                                                                 \
  }                                                                                   \
  target static void distances_##suffix(size_t count, const double *x, double *power) \
  {                                                                                   \
    distances(count, x, power);                                                       \
  }

LEVEL(baseline, , 2)
#ifdef __x86_64__
LEVEL(avx2, __attribute__((target("avx2"))), 4)
LEVEL(avx512, __attribute__((target("avx512f,avx512dq,avx512vl"))), 8)
#endif

/* Levels in the order of num/simd/lanes.c. */
static const level levels[] = {
    {iterate_baseline, begin_baseline, distances_baseline},
#ifdef __x86_64__
    {iterate_avx2, begin_avx2, distances_avx2},
    {iterate_avx512, begin_avx512, distances_avx512},
#endif
};

void dvi__rescaled_iterate(dvi__rescaled_sums *sums)
{
  levels[dvi__lanes_level()].iterate(sums);
}

void dvi__rescaled_begin(const dvi__rescaled_sums *sums)
{
  levels[dvi__lanes_level()].begin(sums);
}

void dvi__rescaled_distances(size_t count, const double *x, double *power)
{
  levels[dvi__lanes_level()].distances(count, x, power);
}
