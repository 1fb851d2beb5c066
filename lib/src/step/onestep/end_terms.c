#include "step/onestep/end_terms.h"

#include <string.h>

#include "step/onestep/flow_series.h"
#include "core/memory.h"
#include "core/status.h"

struct dvi__end_terms {
  dvi__flow_series *series;
  int n, count;
  double *weight;          /* [count] */
  double *L, *L_q0, *L_v0; /* [count], [count*n] */
  double *motion;          /* [2n] */
};

static dvi_status end_terms_initialise(dvi__end_terms *e, const dvi_system *system,
                                       const double *weight, dvi_counters *counters)
{
  const size_t n = (size_t)e->n, count = (size_t)e->count;
  e->weight = DVI_NEW(double, count);
  e->L = DVI_NEW(double, count);
  e->L_q0 = DVI_NEW(double, (count * n));
  e->L_v0 = DVI_NEW(double, (count * n));
  e->motion = DVI_NEW(double, 2 * n);
  if (!e->weight || !e->L || !e->L_q0 || !e->L_v0 || !e->motion)
    return dvi__fail(DVI_NO_MEMORY, "no memory");
  memcpy(e->weight, weight, count * sizeof *weight);
  return dvi__flow_series_create(system, e->count, DVI__HESSIANS, counters, &e->series);
}

dvi_status dvi__end_terms_create(const dvi_system *system, int count, const double *weight,
                                 dvi_counters *counters, dvi__end_terms **ends)
{
  *ends = NULL;
  dvi__end_terms *e = DVI_NEW(dvi__end_terms, 1);
  if (e == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  e->n = system->n;
  e->count = count;
  const dvi_status status = end_terms_initialise(e, system, weight, counters);
  if (status != DVI_OK) dvi__end_terms_destroy(&e);
  *ends = e;
  return status;
}

void dvi__end_terms_destroy(dvi__end_terms **ends)
{
  dvi__end_terms *e = *ends;
  if (e == NULL) return;
  dvi__flow_series_destroy(&e->series);
  dvi__release(e->weight);
  dvi__release(e->L);
  dvi__release(e->L_q0);
  dvi__release(e->L_v0);
  dvi__release(e->motion);
  dvi__release(e);
  *ends = NULL;
}

/* Return sum_{j >= 1} w_j h^j c_j for coefficients of n numbers each. */
static double end_terms_sum_of(const dvi__end_terms *e, double h, int i, const double *coefficient)
{
  double sum = 0;
  for (int j = e->count - 1; j >= 1; j--)
    sum = h * (e->weight[j] * coefficient[j * e->n + i] + sum);
  return sum;
}

/* Compute the gradient in z. The dependence on v counts by the derivatives of v(q,p). */
dvi_status dvi__end_terms_gradient(dvi__end_terms *e, dvi__vector_field *field, double h,
                                   double *gradient)
{
  const int n = e->n;
  const dvi__vector_field_point at = dvi__vector_field_selected(field);
  DVI_TRY(dvi__flow_series_expand(e->series, at.t, at.q, at.v));
  DVI_TRY(dvi__flow_series_vary(e->series));
  DVI_TRY(dvi__flow_series_lagrangian(e->series, e->L, e->L_q0, e->L_v0));
  memset(e->motion, 0, (size_t)n * sizeof *e->motion);
  for (int i = 0; i < n; i++) e->motion[n + i] = end_terms_sum_of(e, h, i, e->L_v0);
  dvi__vector_field_product(field, e->motion, gradient);
  for (int i = 0; i < n; i++) gradient[i] += end_terms_sum_of(e, h, i, e->L_q0);
  return DVI_OK;
}
