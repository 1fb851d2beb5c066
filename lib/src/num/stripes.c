#include "num/stripes.h"

#include <limits.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"

#define WIDTH 4
#include "num/simd/vector_width.h"

/* ---- matrix ---- */

/* Entries of four rows, in ascending order of their diagonals. */
typedef struct merge {
  const dvi__pattern *pattern;
  int at[4], beyond[4]; /* next entry of each row, and its end */
} merge;

static merge merge_begin(const dvi__pattern *pattern, int first)
{
  merge m = {.pattern = pattern};
  for (int l = 0; l < 4 && first + l < pattern->columns; l++) {
    m.at[l] = pattern->start[first + l];
    m.beyond[l] = pattern->start[first + l + 1];
  }
  return m;
}

/* Give the column in which the diagonal of row l's next entry meets the first row. */
static int merge_column_of(const merge *m, int l)
{
  return m->at[l] < m->beyond[l] ? m->pattern->row[m->at[l]] - l : INT_MAX;
}

/* Find the next diagonal, and the entry of each row on it, or -1. 0 if there is none. */
static int merge_next(merge *m, int *column, int entry[4])
{
  *column = INT_MAX;
  for (int l = 0; l < 4; l++)
    if (merge_column_of(m, l) < *column) *column = merge_column_of(m, l);
  for (int l = 0; l < 4; l++)
    entry[l] = *column != INT_MAX && merge_column_of(m, l) == *column ? m->at[l]++ : -1;
  return *column != INT_MAX;
}

static dvi_status count_stripes(dvi__stripes *s, const dvi__pattern *pattern)
{
  long stripes = 0;
  for (int f = 0; f < s->fours; f++) {
    int column, entry[4];
    for (merge m = merge_begin(pattern, 4 * f); merge_next(&m, &column, entry);) stripes++;
    if (stripes > INT_MAX / 4)
      return dvi__fail(DVI_BAD_SIZE, "a matrix of %d rows has too many entries", s->n);
    s->start[f + 1] = (int)stripes;
  }
  return DVI_OK;
}

static void put_stripes(dvi__stripes *s, const dvi__pattern *pattern, const double *values,
                        const double *scale, double shift)
{
  int at = 0;
  for (int f = 0; f < s->fours; f++) {
    int entry[4];
    for (merge m = merge_begin(pattern, 4 * f); merge_next(&m, &s->column[at], entry); at++) {
      for (int l = 0; l < 4; l++)
        if (entry[l] >= 0)
          s->value[4 * (size_t)at + (size_t)l] = scale[4 * f + l] * values[entry[l]] -
                                                 (s->column[at] == 4 * f ? shift : 0);
      const int reach = (abs(s->column[at] - 4 * f) + 3) / 4;
      if (reach > s->reach) s->reach = reach;
    }
  }
}

dvi_status dvi__stripes_fill(const dvi__pattern *pattern, const double *values, const double *scale,
                             double shift, dvi__stripes *s)
{
  *s = (dvi__stripes){.n = pattern->columns, .fours = (pattern->columns + 3) / 4};
  s->room = 4 * (size_t)s->fours + 2 * DVI__STRIPES_MARGIN;
  s->start = DVI_NEW(int, (size_t)s->fours + 1);
  if (s->start == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  DVI_TRY(count_stripes(s, pattern));
  /* one more for the last call of merge_next, which finds nothing */
  s->column = DVI_NEW(int, (size_t)s->start[s->fours] + 1);
  s->value = DVI_NEW(double, 4 * (size_t)s->start[s->fours]);
  if (s->column == NULL || s->value == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  put_stripes(s, pattern, values, scale, shift);
  return DVI_OK;
}

void dvi__stripes_clear(dvi__stripes *s)
{
  dvi__release(s->start);
  dvi__release(s->column);
  dvi__release(s->value);
  *s = (dvi__stripes){.start = NULL};
}

/* ---- sums ---- */

/* Number of fours in a piece. Forty steps of two vectors fit into a megabyte. */
enum { PIECE = 64 };

/* Add sum_j c_j x_j over the lanes of a row of C. */
INLINE void clenshaw_combine(const dvi__clenshaw *s, const int lanes, const double *c, size_t i,
                             vector4 *sum)
{
  for (int j = 0; j < lanes; j++) {
    vector4 x;
    load4(s->x + (size_t)j * s->G->room + i, &x);
    *sum += c[j] * x;
  }
}

/* Make step k of the recurrence for a piece, the fours from `first` on, up to `beyond`. Steps read
 * b where the one before has left it, and write to the other place. */
INLINE void clenshaw_step(const dvi__clenshaw *s, const int lanes, int k, int first, int beyond)
{
  const dvi__stripes G = *s->G;
  const int even = (s->degree - 1 - k) % 2 == 0;
  const double *const b = even ? s->b : s->other,
                      *const C = s->c + (size_t)k * (size_t)(lanes * lanes), part = k > 0 ? 1 : 0.5;
  double *const to = even ? s->other : s->b;
  for (int f = first; f < beyond; f++) {
    vector4 sum[2] = {{0}, {0}};
    for (int e = G.start[f]; e < G.start[f + 1]; e++) {
      vector4 value, y;
      load4(G.value + 4 * (size_t)e, &value);
      for (int l = 0; l < lanes; l++) {
        load4(b + (size_t)l * G.room + (size_t)(G.column[e] + DVI__STRIPES_MARGIN), &y);
        sum[l] += value * y;
      }
    }
    for (int l = 0; l < lanes; l++) {
      const size_t i = 4 * (size_t)f + DVI__STRIPES_MARGIN, at = (size_t)l * G.room + i;
      vector4 d, before;
      load4(s->d + at, &d);
      load4(b + at, &before);
      sum[l] = part * sum[l] - d;
      clenshaw_combine(s, lanes, C + (size_t)l * (size_t)lanes, i, &sum[l]);
      before = sum[l] - before;
      store4(s->d + at, &sum[l], 4);
      store4(to + at, &before, 4);
    }
  }
}

WIDE static void clenshaw_step_one(const dvi__clenshaw *s, int k, int first, int beyond)
{
  clenshaw_step(s, 1, k, first, beyond);
}

WIDE static void clenshaw_step_two(const dvi__clenshaw *s, int k, int first, int beyond)
{
  clenshaw_step(s, 2, k, first, beyond);
}

/* Set d = b = C x of the highest term. */
static void clenshaw_begin(const dvi__clenshaw *s)
{
  const double *c = s->c + (size_t)s->degree * (size_t)(s->lanes * s->lanes);
  for (int l = 0; l < s->lanes; l++, c += s->lanes)
    for (size_t i = DVI__STRIPES_MARGIN; i < s->G->room - DVI__STRIPES_MARGIN; i += 4) {
      vector4 sum = {0};
      clenshaw_combine(s, s->lanes, c, i, &sum);
      store4(s->d + (size_t)l * s->G->room + i, &sum, 4);
      store4(s->b + (size_t)l * s->G->room + i, &sum, 4);
    }
}

/* Sum in pieces that reach no further than their neighbours. A step is one piece behind the step
 * before, so that the numbers of all steps stay in the cache. The bits are those of one step after
 * the other. */
void dvi__stripes_sum(const dvi__clenshaw *s)
{
  const int piece = s->G->reach > PIECE ? s->G->reach : PIECE,
            pieces = (s->G->fours + piece - 1) / piece;
  clenshaw_begin(s);
  for (int front = 0; front < pieces + s->degree - 1; front++)
    for (int behind = front < pieces ? 0 : front - pieces + 1;
         behind <= front && behind < s->degree; behind++) {
      const int first = (front - behind) * piece, left = s->G->fours - first;
      (s->lanes == 1 ? clenshaw_step_one : clenshaw_step_two)(
          s, s->degree - 1 - behind, first, first + (left < piece ? left : piece));
    }
}
