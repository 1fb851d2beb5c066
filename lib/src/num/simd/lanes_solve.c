#include "num/simd/lanes_solve.h"

#include <stdint.h>
#include <string.h>

#include "num/simd/width.h"

#define LOOPS "num/simd/lanes_width.h"
#include "num/simd/each_width.h"

/* Compiled into a function for each kind of iteration, of which each calls its own. */
#define SOLVE(suffix, target, name, iterate)                                               \
  target static int solve_##name##_##suffix(const dvi__lanes_solving *solving)             \
  {                                                                                        \
    const dvi__lanes_solving s = *solving; /* a copy, which nothing else writes */         \
    dvi__fixed_point *const own = s.iteration;                                             \
    const size_t numbers = (size_t)own->n * (size_t)own->lanes;                            \
    dvi__history history = {0};                                                            \
    for (int i = 1; i <= s.most; i++) {                                                    \
      if (s.evaluate(own->stages, s.t, own->Q, own->force, s.of) != 0) return -i;          \
      if (s.before != NULL)                                                                \
        for (size_t k = 0; k < numbers; k++) s.before[k] = own->Z[k];                      \
      iterate;                                                                             \
      const dvi__progress progress = dvi__settling_test(own->change, &history, s.criteria, \
                                                        own->largest, s.size);             \
      if (progress != DVI__GO_ON) return progress == DVI__CONVERGED ? i : -i;              \
    }                                                                                      \
    return -s.most;                                                                        \
  }

#define KNOWN(suffix, target, width, stages, lanes) \
  SOLVE(suffix, target, stages, iterate_known##width(own, stages, lanes))

#define LEVEL(suffix, target, widest, of_four)   \
  SOLVE(suffix, target, 0, iterate##widest(own)) \
  KNOWN(suffix, target, 1, 1, 1)                 \
  KNOWN(suffix, target, 2, 2, 2)                 \
  KNOWN(suffix, target, of_four, 3, 4)           \
  KNOWN(suffix, target, of_four, 4, 4)           \
  KNOWN(suffix, target, widest, 5, 8)            \
  KNOWN(suffix, target, widest, 6, 8)            \
  KNOWN(suffix, target, widest, 7, 8)            \
  KNOWN(suffix, target, widest, 8, 8)

LEVEL(baseline, , 2, 2)
#ifdef __x86_64__
LEVEL(avx2, __attribute__((target("avx2,fma"))), 4, 4)
LEVEL(avx512, __attribute__((target("fma,avx512f,avx512dq,avx512vl"))), 8, 4)
#endif

#define FUNCTIONS(suffix)                                                                     \
  {                                                                                           \
    solve_0_##suffix, solve_1_##suffix, solve_2_##suffix, solve_3_##suffix, solve_4_##suffix, \
        solve_5_##suffix, solve_6_##suffix, solve_7_##suffix, solve_8_##suffix                \
  }

/* By level, and by the number of stages, the first one for more than eight. */
static int (*const levels[][9])(const dvi__lanes_solving *solving) = {
    FUNCTIONS(baseline),
#ifdef __x86_64__
    FUNCTIONS(avx2),
    FUNCTIONS(avx512),
#endif
};

int dvi__lanes_solve(const dvi__lanes_solving *solving)
{
  const int stages = solving->iteration->stages;
  return levels[dvi__lanes_level()][stages <= 8 ? stages : 0](solving);
}
