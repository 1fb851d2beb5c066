/* Sums that keep what rounding drops (Kahan 1965). */
#ifndef DVI_NUM_COMPENSATED_H
#define DVI_NUM_COMPENSATED_H

/* Add `term` to *sum. *compensation holds the excess of the sum over its exact value. Over N steps
 * the error stays at one rounding instead of N. */
static inline void dvi__add_compensated(double *sum, double *compensation, double term)
{
  const double wanted = term - *compensation;
  const double next = *sum + wanted;
  *compensation = (next - *sum) - wanted;
  *sum = next;
}

/* Add to every component. */
static inline void dvi__add_compensated_all(int count, double *sum, double *compensation,
                                            const double *term)
{
  for (int i = 0; i < count; i++) dvi__add_compensated(sum + i, compensation + i, term[i]);
}

/* A number head + tail of twice the digits (Dekker 1971). A sum with its compensation is one, with
 * the tail -compensation. */
typedef struct dvi__twofold {
  double head, tail;
} dvi__twofold;

/* Give a + b and a b without an error. */
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

/* Add two such numbers. The tail may be as large as a few roundings of the head. */
static inline dvi__twofold dvi__twofold_sum(dvi__twofold a, dvi__twofold b)
{
  const dvi__twofold sum = dvi__exact_sum(a.head, b.head);
  return (dvi__twofold){sum.head, sum.tail + (a.tail + b.tail)};
}

/* Arithmetic of such numbers, whose tails are at most half a rounding of their heads. Relative
 * errors are some 1e-32, unless the terms of a sum cancel. */
static inline dvi__twofold dvi__twofold_plus(dvi__twofold a, dvi__twofold b)
{
  const dvi__twofold sum = dvi__exact_sum(a.head, b.head), tails = dvi__exact_sum(a.tail, b.tail),
                     most = dvi__exact_sum(sum.head, sum.tail + tails.head);
  return dvi__exact_sum(most.head, most.tail + tails.tail);
}

static inline dvi__twofold dvi__twofold_times(dvi__twofold a, dvi__twofold b)
{
  const dvi__twofold product = dvi__exact_product(a.head, b.head);
  return dvi__exact_sum(product.head, product.tail + (a.head * b.tail + a.tail * b.head));
}

static inline dvi__twofold dvi__twofold_scaled(dvi__twofold a, double power_of_two)
{
  return (dvi__twofold){a.head * power_of_two, a.tail * power_of_two};
}

/* Give a + b c and a - b c. */
static inline dvi__twofold dvi__twofold_add_product(dvi__twofold a, dvi__twofold b, dvi__twofold c)
{
  return dvi__twofold_plus(a, dvi__twofold_times(b, c));
}

static inline dvi__twofold dvi__twofold_less_product(dvi__twofold a, dvi__twofold b, dvi__twofold c)
{
  return dvi__twofold_add_product(a, dvi__twofold_scaled(b, -1), c);
}

/* Give 1/a, by Newton's step from the inverse of the head. */
static inline dvi__twofold dvi__twofold_inverse(dvi__twofold a)
{
  const dvi__twofold first = {1 / a.head, 0},
                     rest = dvi__twofold_less_product((dvi__twofold){1, 0}, a, first);
  return dvi__twofold_add_product(first, first, rest);
}

/* Convert sums with their compensations to such numbers, and back to tails of at most half a
 * rounding. */
static inline void dvi__twofold_get(int count, const double *sum, const double *compensation,
                                    dvi__twofold *x)
{
  for (int i = 0; i < count; i++) x[i] = (dvi__twofold){sum[i], -compensation[i]};
}

static inline void dvi__twofold_put(int count, const dvi__twofold *x, double *sum,
                                    double *compensation)
{
  for (int i = 0; i < count; i++) {
    const dvi__twofold rounded = dvi__exact_sum(x[i].head, x[i].tail);
    sum[i] = rounded.head;
    compensation[i] = -rounded.tail;
  }
}

#endif
