/* Small matrices, by rows, and as the library wants them. */
#ifndef TESTS_NUM_MATRIX_H
#define TESTS_NUM_MATRIX_H
#include "core/status.h"
#include "num/linear.h"
#include "support/suite.h"

enum { LARGEST = 60 };

static const dvi__linear_kind kinds[] = {DVI__LINEAR_DENSE, DVI__LINEAR_SPARSE};

/* A matrix whose columns and rows are stored as the library wants them. */
typedef struct matrix {
  dvi__pattern pattern;
  double values[LARGEST * LARGEST];
} matrix;

/* Keeps the entries of a [n*n], by rows, that are not zero. */
static inline void compress(int n, const double *a, matrix *m)
{
  int start[LARGEST + 1] = {0}, row[LARGEST * LARGEST], count = 0;
  for (int j = 0; j < n; j++) {
    for (int i = 0; i < n; i++) {
      if (a[i * n + j] == 0) continue;
      row[count] = i;
      m->values[count++] = a[i * n + j];
    }
    start[j + 1] = count;
  }
  ck_assert_int_eq(dvi__pattern_copy(&(dvi_pattern){start, row}, n, "matrix", &m->pattern), DVI_OK);
}

static inline dvi__linear *make(const matrix *m, dvi__linear_kind kind, dvi_counters *counters)
{
  dvi__linear *linear;
  ck_assert_msg(dvi__linear_create(&m->pattern, kind, counters, &linear) == DVI_OK, "%s",
                dvi_last_error());
  return linear;
}

/* Solves A x = b, b overwritten. */
static inline void solve(int n, const double *a, dvi__linear_kind kind, double *b)
{
  matrix m;
  compress(n, a, &m);
  dvi__linear *linear = make(&m, kind, NULL);
  ck_assert_msg(dvi__linear_factor(linear, m.values) == DVI_OK, "%s", dvi_last_error());
  dvi__linear_solve(linear, b);
  dvi__linear_destroy(&linear);
  dvi__pattern_clear(&m.pattern);
}

#endif
