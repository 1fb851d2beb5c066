/* Sums that keep what rounding drops (Kahan 1965). */
#ifndef DVI_NUM_COMPENSATED_H
#define DVI_NUM_COMPENSATED_H

/* *sum += term; *carry holds what the sum is too large by. Over N steps the error stays at one
 * rounding instead of N. */
static inline void dvi__add_compensated(double *sum, double *carry, double term)
{
  const double wanted = term - *carry;
  const double next = *sum + wanted;
  *carry = (next - *sum) - wanted;
  *sum = next;
}

/* The same for every component. */
static inline void dvi__add_compensated_all(int count, double *sum, double *carry,
                                            const double *term)
{
  for (int i = 0; i < count; i++) dvi__add_compensated(sum + i, carry + i, term[i]);
}

/* head + tail: a number of twice the digits (Dekker 1971). A sum with its carry is one, with the
 * tail -carry. */
typedef struct dvi__twofold {
  double head, tail;
} dvi__twofold;

/* a + b and a b, without an error. */
static inline dvi__twofold dvi__exact_sum(double a, double b)
{
  const double head = a + b, added = head - a;
  return (dvi__twofold){head, (a - (head - added)) + (b - added)};
}

static inline dvi__twofold dvi__exact_product(double a, double b)
{
  const double head = a * b;
  return (dvi__twofold){head, __builtin_fma(a, b, -head)};
}

/* The tail may be as large as a few roundings of the head. */
static inline dvi__twofold dvi__twofold_sum(dvi__twofold a, dvi__twofold b)
{
  const dvi__twofold sum = dvi__exact_sum(a.head, b.head);
  return (dvi__twofold){sum.head, sum.tail + (a.tail + b.tail)};
}

/* Sums with their carries as such numbers, and back, where the tail is at most half a rounding. */
static inline void dvi__twofold_get(int count, const double *sum, const double *carry,
                                    dvi__twofold *x)
{
  for (int i = 0; i < count; i++) x[i] = (dvi__twofold){sum[i], -carry[i]};
}

static inline void dvi__twofold_put(int count, const dvi__twofold *x, double *sum, double *carry)
{
  for (int i = 0; i < count; i++) {
    const dvi__twofold rounded = dvi__exact_sum(x[i].head, x[i].tail);
    sum[i] = rounded.head;
    carry[i] = -rounded.tail;
  }
}

#endif
