/* The solution that errors are measured against. */
#include <dvi/reference.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "study/trial.h"

int dvi__has_judge(const dvi_study_runs *runs)
{
  return runs->end != NULL || runs->exact != NULL || runs->reference;
}

double dvi__distance(int n, const double *a, const double *b)
{
  double size = 0.0;
  for (int i = 0; i < n; i++) size = fmax(size, fabs(a[i] - (b != NULL ? b[i] : 0.0)));
  return size;
}

/* Integrate by IDA from the start to the end. p [nv] is memory. */
static dvi_status judge_by_reference(const dvi_system *system, const dvi_study_runs *runs,
                                     double *q, double *p, double *error)
{
  const int nq = dvi_system_nq(system), nv = dvi_system_nv(system);
  dvi_reference_report report;
  memcpy(q, runs->q, (size_t)nq * sizeof *q);
  if (runs->p != NULL) memcpy(p, runs->p, (size_t)nv * sizeof *p);
  if (runs->p == NULL) DVI_TRY(dvi_system_momentum(system, runs->t, q, runs->v, p));
  DVI_TRY(dvi_reference_judge(system, runs->t, runs->t_end, q, p, NULL, &report));
  *error = report.error;
  return DVI_OK;
}

dvi_status dvi__judge(const dvi_system *system, const dvi_study_runs *runs, double *q,
                      double *error)
{
  const int nq = dvi_system_nq(system);
  *error = 0.0;
  if (runs->reference) {
    double *p = DVI_NEW(double, dvi_system_nv(system));
    if (p == NULL) return dvi__fail(DVI_NO_MEMORY, "study: no memory for the reference");
    const dvi_status status = judge_by_reference(system, runs, q, p, error);
    dvi__release(p);
    return status;
  }
  if (runs->end != NULL) memcpy(q, runs->end, (size_t)nq * sizeof *q);
  if (runs->exact != NULL && runs->exact(runs->t_end, q, runs->user) != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "study: exact failed at t = %g", runs->t_end);
  for (int i = 0; i < nq; i++)
    if (!isfinite(q[i]))
      return dvi__fail(DVI_NOT_FINITE, "study: q[%d] = %g of the solution at t = %g is not finite",
                       i, q[i], runs->t_end);
  return DVI_OK;
}
