/* Products with a matrix whose rows repeat, as those of equal cells do. One row serves for all of
 * them, so that neither their values nor their columns come from memory. */
#include <string.h>

#include "field/density/density.h"
#include "num/simd/wide.h"

enum { PERIOD_MOST = 32, BLOCK = 512 /* rows */ };

static int is_repeated(const dvi__csr *A, int64_t i, int period)
{
  const int64_t one = A->start[i - period], other = A->start[i], count = A->start[i + 1] - other;
  if (A->start[i - period + 1] - one != count) return 0;
  for (int64_t e = 0; e < count; e++)
    if (A->column[other + e] != A->column[one + e] + period ||
        A->value[other + e] != A->value[one + e])
      return 0;
  return 1;
}

/* Take the least period by which at least half of the rows repeat, around the middle one. */
void dvi__find_repeated_rows(const dvi__csr *A, dvi__repeated_rows *repeated)
{
  const int64_t middle = A->rows / 2;
  *repeated = (dvi__repeated_rows){0};
  for (int period = 1; period <= PERIOD_MOST && 2 * period < middle; period++) {
    int64_t first = middle, last = middle;
    while (last < A->rows && is_repeated(A, last, period)) last++;
    while (first > period && is_repeated(A, first - 1, period)) first--;
    if (last - first < middle) continue;
    *repeated = (dvi__repeated_rows){.first = first - period, .last = last, .period = period};
    return;
  }
}

static void multiply_any(const dvi__csr *A, int64_t first, int64_t last, const double *q, double *y)
{
  for (int64_t i = first; i < last; i++) {
    double sum = 0;
    for (int64_t e = A->start[i]; e < A->start[i + 1]; e++) sum += A->value[e] * q[A->column[e]];
    y[i - first] = sum;
  }
}

/* A row of one matrix: entries of which the columns count from the row. */
typedef struct stencil {
  int64_t row, count;
  const double *value;
  const int *column;
} stencil;

static stencil stencil_of(const dvi__csr *A, int64_t row)
{
  const int64_t start = A->start[row];
  return (stencil){row, A->start[row + 1] - start, A->value + start, A->column + start};
}

WIDE static void add_column(int64_t count, double value, const double *restrict q,
                            double *restrict y)
{
  for (int64_t k = 0; k < count; k++) y[k] += value * q[k];
}

/* Set y to the sum of three products, in this order, from 0 on. */
WIDE static void add_three(int64_t count, const double *restrict value, const double *restrict one,
                           const double *restrict two, const double *restrict three,
                           double *restrict y)
{
  for (int64_t k = 0; k < count; k++)
    y[k] = ((0 + value[0] * one[k]) + value[1] * two[k]) + value[2] * three[k];
}

/* Multiply rows first to last-1, which are all the same one. Rows of three entries are common. */
static void multiply_equal(const stencil *s, int64_t first, int64_t last, const double *q,
                           double *y)
{
  for (int64_t i = first; i < last; i += BLOCK, y += BLOCK) {
    const int64_t count = last - i < BLOCK ? last - i : BLOCK;
    const double *at = q + i - s->row;
    int64_t e = 0;
    if (s->count < 3) {
      memset(y, 0, (size_t)count * sizeof *y);
    } else {
      add_three(count, s->value, at + s->column[0], at + s->column[1], at + s->column[2], y);
      e = 3;
    }
    for (; e < s->count; e++) add_column(count, s->value[e], at + s->column[e], y);
  }
}

/* Multiply each of the rows of a period in turn. */
static void multiply_repeated(const dvi__csr *A, const dvi__repeated_rows *r, int64_t first,
                              int64_t last, const double *q, double *y)
{
  for (int64_t start = first; start < first + r->period && start < last; start++) {
    const stencil s = stencil_of(A, r->first + (start - r->first) % r->period);
    for (int64_t i = start; i < last; i += r->period) {
      double sum = 0;
      for (int64_t e = 0; e < s.count; e++) sum += s.value[e] * q[i + s.column[e] - s.row];
      y[i - first] = sum;
    }
  }
}

void dvi__multiply_rows(const dvi__csr *A, const dvi__repeated_rows *r, int64_t first, int64_t last,
                        const double *q, double *y)
{
  const int64_t from = first > r->first ? first : r->first, to = last < r->last ? last : r->last;
  if (from >= to) {
    multiply_any(A, first, last, q, y);
    return;
  }
  multiply_any(A, first, from, q, y);
  if (r->period == 1) {
    const stencil s = stencil_of(A, r->first);
    multiply_equal(&s, from, to, q, y + (from - first));
  } else {
    multiply_repeated(A, r, from, to, q, y + (from - first));
  }
  multiply_any(A, to, last, q, y + (to - first));
}
