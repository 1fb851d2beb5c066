/* Reversibility: steps of h and as many of -h. */
#include <dvi/diagnostics.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"

static dvi_status take_equal_steps(dvi_integrator *integrator, double h, long steps)
{
  for (long i = 0; i < steps; i++) DVI_TRY(dvi_integrator_step(integrator, h));
  return DVI_OK;
}

static double largest_difference(int count, const double *x, const double *start)
{
  double largest = 0;
  for (int i = 0; i < count; i++)
    largest = fmax(largest, fabs(x[i] - start[i]) / fmax(1, fabs(start[i])));
  return largest;
}

dvi_status dvi_reversibility(dvi_integrator *integrator, double t, const double *q, const double *p,
                             double h, long steps, double *defect)
{
  if (!integrator || !q || !p || !defect)
    return dvi__fail(DVI_BAD_ARGUMENT, "reversibility: an argument is NULL");
  if (steps < 1)
    return dvi__fail(DVI_BAD_SIZE, "reversibility: %ld steps asked, at least 1 needed", steps);
  const int nq = dvi_system_nq(dvi_integrator_system(integrator));
  /* q may be the integrator's own */
  double *start = (double *)dvi__duplicate(q, (size_t)nq, sizeof *q);
  if (!start) return dvi__fail(DVI_NO_MEMORY, "reversibility: no memory for %d coordinates", nq);
  dvi_status status = dvi_integrator_start(integrator, t, q, p);
  if (status == DVI_OK) status = take_equal_steps(integrator, h, steps);
  if (status == DVI_OK) status = take_equal_steps(integrator, -h, steps);
  if (status == DVI_OK) *defect = largest_difference(nq, dvi_integrator_q(integrator), start);
  dvi__release(start);
  return status;
}
