/* Sums that keep what rounding drops (Kahan 1965). */
#ifndef DVI_NUM_COMPENSATED_H
#define DVI_NUM_COMPENSATED_H

/* *sum += term; *carry holds what the sum is too large by. Over N steps the error stays at one rounding instead of N. */
static inline void dvi__add_compensated(double *sum, double *carry, double term)
{
  const double wanted = term - *carry;
  const double next = *sum + wanted;
  *carry = (next - *sum) - wanted;
  *sum = next;
}

/* The same for every component. */
static inline void dvi__add_compensated_all(int count, double *sum, double *carry, const double *term)
{
  for (int i = 0; i < count; i++) dvi__add_compensated(sum + i, carry + i, term[i]);
}

#endif
