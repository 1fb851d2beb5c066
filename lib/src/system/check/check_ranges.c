/* The check of gradients by ranges. Each range must equal that part of the whole gradient, bit by
 * bit, and depend only on the coordinates within its reach. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/status.h"
#include "system/check/check_struct.h"

/* Copy the coordinates that the range may read from `from` to `to`. If from is NULL, all of them
 * become NaN. */
static void expose_range(const dvi__check *c, int reach, int first, int last, const double *from,
                         double *to)
{
  const int begin = first > reach ? first - reach : 0,
            end = last < c->n - reach ? last + reach : c->n;
  for (int i = begin; i < end; i++) to[i] = from != NULL ? from[i] : (double)NAN;
}

/* Compare bits, so that zeros of two signs differ. */
static int same_bits(double a, double b)
{
  uint64_t bits_of_a, bits_of_b;
  memcpy(&bits_of_a, &a, sizeof a);
  memcpy(&bits_of_b, &b, sizeof b);
  return bits_of_a == bits_of_b;
}

static dvi_status refuse_range(const dvi__potential_term *p, int returned, int first, int last)
{
  char reason[DVI__SENTENCE_SIZE];
  dvi__take_reason(reason);
  return dvi__fail(
      returned < 0 ? DVI_CALLBACK_FAILED : DVI_CALLBACK_RETRY,
      "system check: %s: the gradient_range callback returned %d for coordinates %d to %d%s%s",
      p->name, returned, first, last - 1, reason[0] != '\0' ? ": " : "", reason);
}

/* Compare one range with the whole gradient. The callback sees NaN beyond its reach and on both
 * sides of the range. `hidden` holds NaN before and after the call. */
static dvi_status compare_range(dvi__check *c, const dvi__potential_term *p, int first, int last,
                                const double *whole, double *hidden)
{
  const dvi_potential *asked = &p->callbacks;
  double *part = c->column[1] + 1;
  const int count = last - first;
  for (int i = -1; i <= count; i++) part[i] = (double)NAN;
  expose_range(c, asked->reach, first, last, c->q, hidden);
  const int returned = asked->gradient_range(c->t, hidden, first, last, part, asked->user);
  expose_range(c, asked->reach, first, last, NULL, hidden);
  if (returned != 0) return refuse_range(p, returned, first, last);
  for (int i = 0; i < count && c->range.row < 0; i++)
    if (!same_bits(whole[first + i], part[i]))
      c->range = (dvi__broken_range){.term = p,
                                     .row = first + i,
                                     .first = first,
                                     .last = last,
                                     .whole = whole[first + i],
                                     .part = part[i]};
  if (c->range.row < 0 && !isnan(part[count]))
    c->range = (dvi__broken_range){
        .term = p, .row = last, .outside = 1, .first = first, .last = last};
  if (c->range.row < 0 && !isnan(part[-1]))
    c->range = (dvi__broken_range){
        .term = p, .row = first, .outside = -1, .first = first, .last = last};
  return DVI_OK;
}

dvi_status dvi__check_ranges(dvi__check *c, const dvi__potential_term *p, const double *whole)
{
  const int lengths[] = {1, 3, c->n / 2 + 1, c->n};
  double *hidden = c->column[0];
  for (int i = 0; i < c->n; i++) hidden[i] = (double)NAN;
  for (int k = 0; k < 4 && c->range.row < 0; k++)
    for (int first = 0; first < c->n; first += lengths[k])
      DVI_TRY(compare_range(c, p, first, lengths[k] < c->n - first ? first + lengths[k] : c->n,
                            whole, hidden));
  return DVI_OK;
}
