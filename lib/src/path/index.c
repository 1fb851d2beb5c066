/* The signs of the second variation, by spectrum slicing: H + lambda W with the weight W of the kinetic energy has as many negative eigenvalues as H v = mu W v
 * has mu < -lambda (Sylvester's law of inertia; Parlett 1998, sec. 3.3), and a factorisation with pivots on the diagonal counts them. Two slices beside 0
 * tell what is negative and what is zero. */
#include <float.h>
#include <math.h>

#include "core/status.h"
#include "path/path_struct.h"

/* A slice that the pivots do not tell of is moved: a part of the path may happen to have conjugate ends there. */
static const double moved[] = {1.0, 0.83, 1.21, 0.61, 1.57};

/* Eigenvalues below -lift; -1: not found. */
static dvi_status slice(dvi_path *path, const double *x, double lift, int *below)
{
  *below = -1;
  for (size_t k = 0; k < sizeof moved / sizeof *moved && *below < 0; k++) {
    path->lift = lift * moved[k];
    DVI_TRY(dvi__solver_negative(path->solver, x, below));
  }
  return DVI_OK;
}

static dvi_status both_slices(dvi_path *path, const double *x, dvi_path_report *report)
{
  int negative, not_positive = -1;
  DVI_TRY(slice(path, x, report->zero_below, &negative));
  if (negative >= 0) DVI_TRY(slice(path, x, -report->zero_below, &not_positive));
  if (not_positive < 0) return DVI_OK;
  report->negative = negative;
  report->zero = not_positive - negative;
  return DVI_OK;
}

/* Roundoff in an entry, epsilon |L_vv| / h, is epsilon N^2 in units of the weight over span^2. */
dvi_status dvi__path_index(dvi_path *path, const double *x, dvi_path_report *report)
{
  report->negative = report->zero = -1;
  report->zero_below = fmax(1e-6, 10 * DBL_EPSILON * path->steps * path->steps);
  if (path->ends == DVI_ENDS_INITIAL) return DVI_OK;
  path->bare = 1;
  const dvi_status status = both_slices(path, x, report);
  path->bare = 0;
  path->lift = 0;
  return status;
}
