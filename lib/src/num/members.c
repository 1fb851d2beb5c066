#include "num/members.h"

#include <stdint.h>
#include <string.h>

#include "num/lanes.h"
#include "num/width.h"

#define WIDTH 1
#include "num/members_width.h"
#undef WIDTH
#define WIDTH 2
#include "num/members_width.h"
#undef WIDTH
#define WIDTH 4
#include "num/members_width.h"
#undef WIDTH
#define WIDTH 8
#include "num/members_width.h"
#undef WIDTH

/* Whole vectors first, the rest in shorter ones. */
#define TAIL2(name, ...) name##2(__VA_ARGS__, 0)
#define TAIL4(name, ...) name##2(__VA_ARGS__, name##4(__VA_ARGS__, 0))
#define TAIL8(name, ...) name##2(__VA_ARGS__, name##4(__VA_ARGS__, name##8(__VA_ARGS__, 0)))
#define ALL(width, name, ...) ((void)name##1(__VA_ARGS__, TAIL##width(name, __VA_ARGS__)))

/* Few stages are where members are lanes: their loops are worth knowing at compile time. */
#define SWEEP(width)                                       \
  INLINE void sweep_by##width(const dvi__members_sweep *s) \
  {                                                        \
    switch (s->stages) {                                   \
    case 1: ALL(width, sweep, s, 1); break;                \
    case 2: ALL(width, sweep, s, 2); break;                \
    case 3: ALL(width, sweep, s, 3); break;                \
    case 4: ALL(width, sweep, s, 4); break;                \
    case 8: ALL(width, sweep, s, 8); break;                \
    default: ALL(width, sweep, s, s->stages);              \
    }                                                      \
  }
SWEEP(2)
SWEEP(4)
SWEEP(8)

/* ---- instruction sets ---- */

typedef struct level {
  void (*sweep)(const dvi__members_sweep *s);
  void (*product)(int n, int terms, int lanes, int rows, const double *matrix, int width, const double *x, double *out);
  void (*add)(size_t count, double factor, const double *x, double *sum, double *carry);
  void (*drift)(size_t count, double h, double mass, const double *p, double *q, double *q_carry);
} level;

#define LEVEL(suffix, target, width)                                                                                             \
  target static void sweep_##suffix(const dvi__members_sweep *s)                                                                 \
  {                                                                                                                              \
    sweep_by##width(s);                                                                                                          \
  }                                                                                                                              \
  target static void product_##suffix(int n, int terms, int lanes, int rows, const double *matrix, int members, const double *x, \
                                      double *out)                                                                               \
  {                                                                                                                              \
    ALL(width, product, n, terms, lanes, rows, matrix, members, x, out);                                                         \
  }                                                                                                                              \
  target static void add_##suffix(size_t count, double factor, const double *x, double *sum, double *carry)                      \
  {                                                                                                                              \
    ALL(width, add, count, factor, x, sum, carry);                                                                               \
  }                                                                                                                              \
  target static void drift_##suffix(size_t count, double h, double mass, const double *p, double *q, double *q_carry)            \
  {                                                                                                                              \
    ALL(width, drift, count, h, mass, p, q, q_carry);                                                                            \
  }

LEVEL(baseline, , 2)
#ifdef __x86_64__
LEVEL(avx2, __attribute__((target("avx2"))), 4)
LEVEL(avx512, __attribute__((target("avx512f,avx512dq,avx512vl"))), 8)
#endif

/* In the order of num/lanes.c. */
static const level levels[] = {
    {sweep_baseline, product_baseline, add_baseline, drift_baseline},
#ifdef __x86_64__
    {sweep_avx2, product_avx2, add_avx2, drift_avx2},
    {sweep_avx512, product_avx512, add_avx512, drift_avx512},
#endif
};

void dvi__members_sweep_once(dvi__members_sweep *s)
{
  levels[dvi__lanes_level()].sweep(s);
}

void dvi__members_product(int n, int terms, int lanes, int rows, const double *matrix, int width, const double *x, double *out)
{
  levels[dvi__lanes_level()].product(n, terms, lanes, rows, matrix, width, x, out);
}

void dvi__members_add(size_t count, double factor, const double *x, double *sum, double *carry)
{
  levels[dvi__lanes_level()].add(count, factor, x, sum, carry);
}

void dvi__members_drift(size_t count, double h, double mass, const double *p, double *q, double *q_carry)
{
  levels[dvi__lanes_level()].drift(count, h, mass, p, q, q_carry);
}
