#include "step/onestep/taylor.h"

#include <string.h>

#include "step/onestep/flow_series.h"
#include "core/memory.h"
#include "core/status.h"

struct dvi__taylor {
  dvi__vector_field *field;
  dvi__flow_series *series; /* series to one degree more, because v has one degree less */
  int n, degree;
  /* [2n*2n*pieces] derivative of (q1,v1) in (q,v), column by column, minus the identity */
  double *change;
  double *end;            /* [2n] */
  double *motion, *image; /* [2n] */
};

dvi_status dvi__taylor_create(const dvi_system *system, dvi__vector_field *field, int degree,
                              int pieces, dvi_counters *counters, dvi__taylor **taylor)
{
  const size_t z = 2 * (size_t)system->n;
  *taylor = NULL;
  dvi__taylor *t = DVI_NEW(dvi__taylor, 1);
  if (t == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  t->field = field;
  t->n = system->n;
  t->degree = degree;
  t->change = DVI_NEW(double, (z * z * (size_t)pieces));
  t->end = DVI_NEW(double, z);
  t->motion = DVI_NEW(double, z);
  t->image = DVI_NEW(double, z);
  dvi_status status = t->change && t->end && t->motion && t->image
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "no memory");
  if (status == DVI_OK)
    status = dvi__flow_series_create(system, degree + 1, DVI__HESSIANS, counters, &t->series);
  if (status != DVI_OK) dvi__taylor_destroy(&t);
  *taylor = t;
  return status;
}

void dvi__taylor_destroy(dvi__taylor **taylor)
{
  dvi__taylor *t = *taylor;
  if (t == NULL) return;
  dvi__flow_series_destroy(&t->series);
  dvi__release(t->change);
  dvi__release(t->end);
  dvi__release(t->motion);
  dvi__release(t->image);
  dvi__release(t);
  *taylor = NULL;
}

/* Compute sum_k h^k c_k without c_0. Each c_k is [count], at a distance of `stride`. */
static void sum_series(const dvi__taylor *t, double h, int count, size_t stride, const double *c,
                       double *sum)
{
  for (int i = 0; i < count; i++) {
    sum[i] = 0;
    for (int k = t->degree; k >= 1; k--) sum[i] = h * (c[(size_t)k * stride + (size_t)i] + sum[i]);
  }
}

static dvi_status taylor_expand(dvi__taylor *t, int piece)
{
  const dvi__vector_field_point at = dvi__vector_field_point_at(t->field, piece);
  return dvi__flow_series_expand(t->series, at.t, at.q, at.v);
}

dvi_status dvi__taylor_advance(dvi__taylor *t, int piece, double h, double *moved)
{
  const int n = t->n;
  const dvi__vector_field_point at = dvi__vector_field_point_at(t->field, piece);
  DVI_TRY(taylor_expand(t, piece));
  sum_series(t, h, n, (size_t)n, dvi__flow_series_q(t->series), moved);
  sum_series(t, h, n, (size_t)n, dvi__flow_series_v(t->series), t->end + n);
  for (int i = 0; i < n; i++) t->end[i] = at.q[i] + moved[i];
  return dvi__vector_field_impulse(t->field, piece, at.t + h, t->end, t->end + n, moved + n);
}

dvi_status dvi__taylor_trace(dvi__taylor *t, int piece, double h)
{
  const int n = t->n, z = 2 * n;
  const size_t stride = (size_t)z * (size_t)n;
  DVI_TRY(taylor_expand(t, piece));
  DVI_TRY(dvi__flow_series_vary(t->series));
  for (int c = 0; c < z; c++) {
    double *column = t->change + (size_t)(piece * z + c) * (size_t)z;
    sum_series(t, h, n, stride, dvi__flow_series_dq(t->series) + c * n, column);
    sum_series(t, h, n, stride, dvi__flow_series_dv(t->series) + c * n, column + n);
  }
  return DVI_OK;
}

static double taylor_entry(const dvi__taylor *t, int piece, int row, int column)
{
  const int z = 2 * t->n;
  return t->change[(piece * z + column) * z + row];
}

dvi_status dvi__taylor_push(dvi__taylor *t, int piece, const double *motion, double *change)
{
  const int n = t->n, z = 2 * n;
  DVI_TRY(dvi__vector_field_select(t->field, piece));
  dvi__vector_field_product(t->field, motion, t->image);
  memcpy(t->motion, motion, (size_t)n * sizeof *motion);
  memcpy(t->motion + n, t->image + n, (size_t)n * sizeof *motion);
  for (int i = 0; i < z; i++) {
    double sum = 0;
    for (int c = 0; c < z; c++) sum += taylor_entry(t, piece, i, c) * t->motion[c];
    t->end[i] = t->motion[i] + sum;
    change[i] = sum;
  }
  dvi__vector_field_lift(t->field, piece + 1, t->end, t->image);
  for (int i = 0; i < n; i++) change[n + i] = t->image[i] - motion[n + i];
  return DVI_OK;
}

dvi_status dvi__taylor_pull(dvi__taylor *t, int piece, const double *costate, double *change)
{
  const int n = t->n, z = 2 * n;
  dvi__vector_field_lower(t->field, piece + 1, costate + n, t->end);
  for (int i = 0; i < n; i++) {
    change[i] = t->end[i];
    t->end[i] += costate[i];
  }
  for (int c = 0; c < z; c++) {
    double sum = 0;
    for (int i = 0; i < z; i++) sum += taylor_entry(t, piece, i, c) * t->end[i];
    if (c < n)
      change[c] += sum;
    else
      t->motion[c] = t->end[c] + sum;
  }
  memset(t->motion, 0, (size_t)n * sizeof *t->motion);
  DVI_TRY(dvi__vector_field_select(t->field, piece));
  dvi__vector_field_product(t->field, t->motion, t->image);
  for (int i = 0; i < n; i++) {
    change[i] += t->image[i];
    change[n + i] = t->image[n + i] - costate[n + i];
  }
  return DVI_OK;
}
