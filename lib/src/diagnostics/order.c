/* Orders of convergence. */
#include <dvi/diagnostics.h>
#include <math.h>

#include "core/status.h"

static dvi_status order_check(int count, const double *h, const double *error,
                              const dvi_order_fit *fit)
{
  if (!h || !error || !fit)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "order: the steps, the errors or the place for the fit are NULL");
  for (int i = 0; i < count; i++)
    if (!(h[i] > 0 && isfinite(h[i])) || (i > 0 && !(h[i] < h[i - 1])))
      return dvi__fail(DVI_BAD_ARGUMENT, "order: step %d is %g; steps must be positive and descend",
                       i, h[i]);
  return DVI_OK;
}

static int error_is_usable(double error, double floor, double ceiling)
{
  return isfinite(error) && error > 0 && error > floor && (ceiling == 0 || error < ceiling);
}

/* Choose the longest window, of equally long ones the last, whose steps are smallest. first = -1 if
 * no error is usable. */
static void choose_window(int count, const double *error, double floor, double ceiling,
                          dvi_order_fit *fit)
{
  int first = 0;
  fit->first = fit->last = -1;
  for (int i = 0; i < count; i++) {
    if (!error_is_usable(error[i], floor, ceiling)) {
      first = i + 1;
    } else if (fit->first < 0 || i - first >= fit->last - fit->first) {
      fit->first = first;
      fit->last = i;
    }
  }
}

static double log_slope(const dvi_order_fit *window, const double *h, const double *error)
{
  const int count = window->last - window->first + 1;
  double x_mean = 0, y_mean = 0, product = 0, spread = 0;
  for (int i = window->first; i <= window->last; i++) {
    x_mean += log(h[i]) / count;
    y_mean += log(error[i]) / count;
  }
  for (int i = window->first; i <= window->last; i++) {
    product += (log(h[i]) - x_mean) * (log(error[i]) - y_mean);
    spread += (log(h[i]) - x_mean) * (log(h[i]) - x_mean);
  }
  return product / spread;
}

dvi_status dvi_order(int count, const double *h, const double *error, double floor, double ceiling,
                     dvi_order_fit *fit)
{
  DVI_TRY(order_check(count, h, error, fit));
  choose_window(count, error, floor, ceiling, fit);
  if (fit->last <= fit->first) {
    fit->slope = (double)NAN;
    fit->first = fit->last = -1;
    return dvi__fail(
        DVI_BAD_SIZE,
        "order: of %d errors no two neighbours lie above the floor %g%s; try larger steps", count,
        floor, ceiling > 0 ? " and below the ceiling" : "");
  }
  fit->slope = log_slope(fit, h, error);
  return DVI_OK;
}
