#include "num/envelope.h"

#include <math.h>

#include "core/memory.h"

struct dvi__envelope {
  int n;
  int *first;    /* [n] first column of each row */
  size_t *start; /* [n+1] place of the first number of each row */
  double *C;     /* [start[n]] rows from the first column to the diagonal */
};

static double *row_of(const dvi__envelope *f, int i)
{
  return f->C + f->start[i];
}

static dvi_status envelope_lay_out(dvi__envelope *f, const dvi__pattern *pattern)
{
  const size_t n = (size_t)f->n;
  f->first = DVI_NEW(int, n);
  f->start = DVI_NEW(size_t, n + 1);
  if (f->first == NULL || f->start == NULL) return DVI_NO_MEMORY;
  for (int i = 0; i < f->n; i++) { /* row i is column i */
    const int begin = pattern->start[i];
    f->first[i] = begin < pattern->start[i + 1] && pattern->row[begin] < i ? pattern->row[begin]
                                                                           : i;
    f->start[i + 1] = f->start[i] + (size_t)(i - f->first[i]) + 1;
  }
  f->C = DVI_NEW(double, f->start[n]);
  return f->C != NULL ? DVI_OK : DVI_NO_MEMORY;
}

/* C_ij = (A_ij - sum_k C_ik C_jk)/C_jj, and on the diagonal the square root of the difference. */
static dvi_status envelope_factor(dvi__envelope *f)
{
  for (int i = 0; i < f->n; i++) {
    double *at_i = row_of(f, i);
    for (int j = f->first[i]; j <= i; j++) {
      const double *at_j = row_of(f, j);
      double sum = at_i[j - f->first[i]];
      for (int k = f->first[i] > f->first[j] ? f->first[i] : f->first[j]; k < j; k++)
        sum -= at_i[k - f->first[i]] * at_j[k - f->first[j]];
      if (j == i && !(sum > 0))
        return dvi__fail(DVI_SINGULAR, "the matrix is not positive definite (row %d)", i);
      at_i[j - f->first[i]] = j == i ? sqrt(sum) : sum / at_j[j - f->first[j]];
    }
  }
  return DVI_OK;
}

dvi_status dvi__envelope_create(const dvi__pattern *pattern, const double *values,
                                dvi__envelope **factor)
{
  dvi__envelope *f = *factor = DVI_NEW(dvi__envelope, 1);
  if (f == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory for a factor");
  f->n = pattern->columns;
  dvi_status status = envelope_lay_out(f, pattern);
  if (status != DVI_OK) (void)dvi__fail(status, "no memory for a factor of %d rows", f->n);
  for (int i = 0; i < f->n && status == DVI_OK; i++)
    for (int e = pattern->start[i]; e < pattern->start[i + 1]; e++)
      if (pattern->row[e] <= i) row_of(f, i)[pattern->row[e] - f->first[i]] = values[e];
  if (status == DVI_OK) status = envelope_factor(f);
  if (status != DVI_OK) dvi__envelope_destroy(factor);
  return status;
}

void dvi__envelope_destroy(dvi__envelope **factor)
{
  dvi__envelope *f = *factor;
  if (f == NULL) return;
  dvi__release(f->first);
  dvi__release(f->start);
  dvi__release(f->C);
  dvi__release(f);
  *factor = NULL;
}

void dvi__envelope_product(const dvi__envelope *f, double *x)
{
  for (int i = f->n - 1; i >= 0; i--) {
    const double *C = row_of(f, i);
    double sum = 0;
    for (int j = f->first[i]; j <= i; j++) sum += C[j - f->first[i]] * x[j];
    x[i] = sum;
  }
}
