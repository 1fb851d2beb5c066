/* A reference solution by two runs. The distance of the two results is taken as its error.
 *
 * If the error falls with the tolerance, the distance is the first run's error up to the second's,
 * and so an upper estimate of the second's. The result is that of the second run. */
#include <dvi/reference.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "reference/run.h"

static double largest_distance(int n, const double *a, const double *b)
{
  double largest = 0;
  for (int i = 0; i < n; i++) largest = fmax(largest, fabs(a[i] - b[i]));
  return largest;
}

/* Run at both tolerances. The loose and the tight result start as copies of q and p, which are
 * written only when both runs succeed. */
static dvi_status run_twice(const dvi_system *system, double t, double t_end, double *loose,
                            double *tight, double *q, double *p,
                            const dvi_reference_options *options, dvi_reference_report *report)
{
  const size_t nq = (size_t)dvi_system_nq(system), nv = (size_t)dvi_system_nv(system);
  dvi_reference_options tenth = *options;
  tenth.relative_tolerance /= 10;
  tenth.absolute_tolerance /= 10;
  DVI_TRY(dvi_reference_solve(system, t, t_end, loose, loose + nq, options, report));
  const dvi_status status = dvi_reference_solve(system, t, t_end, tight, tight + nq, &tenth,
                                                report);
  if (status != DVI_OK)
    return dvi__fail_in(status, "judge: the second run, at tolerance %g", tenth.relative_tolerance);
  if (report != NULL) report->error = largest_distance((int)nq, loose, tight);
  memcpy(q, tight, nq * sizeof *q);
  memcpy(p, tight + nq, nv * sizeof *p);
  return DVI_OK;
}

dvi_status dvi_reference_judge(const dvi_system *system, double t, double t_end, double *q,
                               double *p, const dvi_reference_options *options,
                               dvi_reference_report *report)
{
  dvi_reference_options complete;
  if (system == NULL || q == NULL || p == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "judge: system, q and p are needed");
  DVI_TRY(dvi__reference_complete(system, options, &complete));
  const size_t nq = (size_t)dvi_system_nq(system), nv = (size_t)dvi_system_nv(system);
  double *copies = DVI_NEW(double, 2 * (nq + nv));
  if (copies == NULL)
    return dvi__fail(DVI_NO_MEMORY, "judge: no memory for %zu numbers", 2 * (nq + nv));
  double *loose = copies, *tight = copies + nq + nv;
  memcpy(loose, q, nq * sizeof *q);
  memcpy(loose + nq, p, nv * sizeof *p);
  memcpy(tight, loose, (nq + nv) * sizeof *loose);
  const dvi_status status = run_twice(system, t, t_end, loose, tight, q, p, &complete, report);
  dvi__release(copies);
  return status;
}
