/* The loops over coordinates of lanes.c, for vectors of WIDTH numbers, after vector_width.h. Each
 * goes on from coordinate i as far as whole vectors reach and returns where it stopped. The rest is
 * for width 1. Every lane does what core and num do for one number, in the same order. */
#include "num/simd/lanes_width.h"

/* Add as dvi__add_compensated does. */
INLINE void NAME(add)(NAME(vector) * sum, NAME(vector) * compensation, const NAME(vector) * term)
{
  const NAME(vector) wanted = *term - *compensation, next = *sum + wanted;
  *compensation = (next - *sum) - wanted;
  *sum = next;
}

INLINE void NAME(kick_by)(double factor, const NAME(vector) * force, NAME(vector) * p,
                          NAME(vector) * compensation)
{
  const NAME(vector) term = factor * *force;
  NAME(add)(p, compensation, &term);
}

/* Fetch numbers that the loop gets to soon. A loop over nine streams of memory outruns the
 * hardware's own look-ahead, which stops at the end of each page. Nothing is read here, so the end
 * of the arrays does not matter. */
INLINE void NAME(fetch)(const dvi__kick_drift *l, size_t i)
{
  const double *const read[] = {l->force, l->from.p, l->from.p_compensation, l->from.q,
                                l->from.q_compensation};
  const double *const written[] = {l->to.p, l->to.p_compensation, l->to.q, l->to.q_compensation};
  for (int k = 0; k < 5; k++)
    __builtin_prefetch((const void *)((uintptr_t)(read[k] + i) + FETCH_AHEAD), 0);
  for (int k = 0; k < 4 && l->far == DVI__FAR_BOTH; k++)
    __builtin_prefetch((const void *)((uintptr_t)(written[k] + i) + FETCH_AHEAD), 1);
}

/* Unite the bits of products of 0 with some numbers. Only the sign bit may be set if all numbers
 * are finite. */
INLINE void NAME(add_doubts)(const NAME(mask) * products, int64_t *doubt)
{
  for (int k = 0; k < WIDTH; k++) *doubt |= (*products)[k];
}

INLINE size_t NAME(kick_drift)(const dvi__kick_drift *whole, size_t i, const int kicks,
                               const dvi__division by, const int far, int64_t *doubt)
{
  /* a copy, because the compiler cannot know that no store changes it */
  const dvi__kick_drift l = *whole;
  NAME(mask) doubts = {0};
  for (; i + WIDTH <= l.count; i += WIDTH) {
    NAME(vector) force, p, p_compensation, q, q_compensation, v;
    if (far) NAME(fetch)(&l, i);
    NAME(load)(l.force + i, &force);
    NAME(load)(l.from.p + i, &p);
    NAME(load)(l.from.p_compensation + i, &p_compensation);
    for (int k = 0; k < kicks; k++) NAME(kick_by)(l.kick[k], &force, &p, &p_compensation);
    NAME(store)(l.to.p + i, &p, WIDTH);
    NAME(store)(l.to.p_compensation + i, &p_compensation, WIDTH);
    doubts |= (NAME(mask))(0 * p);
    if (by == DVI__BY_ARRAY) NAME(load)(l.mass + i, &v);
    v = by == DVI__BY_ARRAY ? p / v : by == DVI__BY_SCALAR ? p / l.scalar : p * l.scalar;
    v *= l.drift;
    NAME(load)(l.from.q + i, &q);
    NAME(load)(l.from.q_compensation + i, &q_compensation);
    NAME(add)(&q, &q_compensation, &v);
    NAME(store)(l.to.q + i, &q, WIDTH);
    NAME(store)(l.to.q_compensation + i, &q_compensation, WIDTH);
  }
  NAME(add_doubts)(&doubts, doubt);
  return i;
}

INLINE size_t NAME(add_scaled)(size_t i, size_t count, double factor, const double *x, double *sum,
                               double *compensation)
{
  for (; i + WIDTH <= count; i += WIDTH) {
    NAME(vector) term, s, c;
    NAME(load)(x + i, &term);
    NAME(load)(sum + i, &s);
    NAME(load)(compensation + i, &c);
    NAME(kick_by)(factor, &term, &s, &c);
    NAME(store)(sum + i, &s, WIDTH);
    NAME(store)(compensation + i, &c, WIDTH);
  }
  return i;
}

/* Store past the caches, in pairs of numbers if `in_pairs`. */
INLINE void NAME(store_past)(double *out, const NAME(vector) * x, const int in_pairs)
{
#ifdef __x86_64__
  for (int k = 0; k + 1 < WIDTH && in_pairs; k += 2)
    _mm_stream_pd(out + k, (__m128d){((const double *)x)[k], ((const double *)x)[k + 1]});
  for (int k = 0; k < WIDTH && (WIDTH == 1 || !in_pairs); k++) {
    long long bits;
    memcpy(&bits, (const double *)x + k, sizeof bits);
    _mm_stream_si64((long long *)(out + k), bits);
  }
#else
  (void)in_pairs;
  NAME(store)(out, x, WIDTH);
#endif
}

INLINE size_t NAME(last_kick)(const dvi__last_kick *whole, size_t i, const int past,
                              const int in_pairs, int64_t *doubt)
{
  const dvi__last_kick l = *whole;
  NAME(mask) doubts = {0};
  for (; i + WIDTH <= l.count; i += WIDTH) {
    NAME(vector) force, p, p_compensation;
    NAME(load)(l.force + i, &force);
    NAME(load)(l.from.p + i, &p);
    NAME(load)(l.from.p_compensation + i, &p_compensation);
    NAME(kick_by)(l.kick, &force, &p, &p_compensation);
    doubts |= (NAME(mask))(0 * p);
    if (!past) {
      NAME(store)(l.to.p + i, &p, WIDTH);
      NAME(store)(l.to.p_compensation + i, &p_compensation, WIDTH);
      continue;
    }
    NAME(store_past)(l.to.p + i, &p, in_pairs);
    NAME(store_past)(l.to.p_compensation + i, &p_compensation, in_pairs);
    NAME(store_past)(l.force_to + i, &force, in_pairs);
  }
  NAME(add_doubts)(&doubts, doubt);
  return i;
}

/* Look at q, and store it. */
INLINE size_t NAME(last_q)(const dvi__last_kick *whole, size_t i, const int past,
                           const int in_pairs, int64_t *doubt)
{
  const dvi__last_kick l = *whole;
  NAME(mask) doubts = {0};
  for (; i + WIDTH <= l.count; i += WIDTH) {
    NAME(vector) q, q_compensation;
    NAME(load)(l.from.q + i, &q);
    doubts |= (NAME(mask))(0 * q);
    if (!past) continue;
    NAME(load)(l.from.q_compensation + i, &q_compensation);
    NAME(store_past)(l.to.q + i, &q, in_pairs);
    NAME(store_past)(l.to.q_compensation + i, &q_compensation, in_pairs);
  }
  NAME(add_doubts)(&doubts, doubt);
  return i;
}
