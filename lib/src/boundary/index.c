/* The signs of the second variation, by spectrum slicing. With the weight W of the kinetic energy,
 * H + lambda W has as many negative eigenvalues as H v = mu W v has mu < -lambda (Sylvester's law
 * of inertia, Parlett 1998, sec. 3.3). Two slices beside 0 count the negative and the zero
 * eigenvalues. */
#include <float.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "boundary/inertia.h"
#include "boundary/path_struct.h"

/* Largest block of elimination, which has one step's unknowns. Larger blocks would take far longer
 * than the solve. */
enum { LARGEST_BLOCK = 512 };

/* Count the eigenvalues below -lambda. */
static dvi_status count_eigenvalues_below(dvi_path *path, double *values, double lambda,
                                          long *below)
{
  const double unit = lambda / (dvi__path_span(path, path->trial) * path->steps);
  for (int k = 0; k <= path->steps; k++) {
    const int node = dvi__path_node(path, k);
    for (int i = 0; node >= 0 && i < path->n; i++)
      values[dvi__pattern_find(&path->pattern, node + i, node + i)] += unit * path->kinetic[i];
  }
  return dvi__inertia(&path->pattern, values, path->core, path->n * path->s, below);
}

/* Return the limit of zero eigenvalues. Roundoff in an entry, epsilon |L_vv| / h, is epsilon N^2 in
 * units of the weight over span^2. */
static double zero_below(const dvi_path *path)
{
  return fmax(1e-6, 10 * DBL_EPSILON * path->steps * path->steps);
}

static dvi_status slice_spectrum(dvi_path *path, double *values, dvi_path_report *report)
{
  long negative, not_positive;
  DVI_TRY(dvi__path_jacobian(path, path->trial, values));
  DVI_TRY(count_eigenvalues_below(path, values, report->zero_below, &negative));
  DVI_TRY(count_eigenvalues_below(path, values, -2 * report->zero_below, &not_positive));
  report->zero = not_positive - negative;
  /* Steps that move the eigenvalue of a symmetry away from 0 may move others across 0. */
  report->negative = report->zero < report->symmetries ? -1 : negative;
  return DVI_OK;
}

dvi_status dvi__path_index(dvi_path *path, dvi_path_report *report)
{
  report->negative = report->zero = -1;
  report->zero_below = zero_below(path);
  if (path->ends == DVI_ENDS_INITIAL || path->n * path->s > LARGEST_BLOCK) return DVI_OK;
  const int entries = dvi__pattern_entries(&path->pattern);
  double *values = DVI_NEW(double, entries);
  if (values == NULL)
    return dvi__fail(DVI_NO_MEMORY, "no memory for a Hessian of %d entries", entries);
  const dvi_status status = slice_spectrum(path, values, report);
  dvi__release(values);
  return status == DVI_SINGULAR ? DVI_OK : status;
}
