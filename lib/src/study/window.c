/* The range of step sizes that shows an order. */
#include <dvi/study.h>
#include <math.h>
#include <stdbool.h>

/* Half of the tolerance of an order, because the slope still moves beyond the window. */
static const double half_tolerance = 0.1;
/* a quarter of the tolerance of an order, four standard errors */
static const double error_tolerance = 0.05;

/* Fit the slope to levels first to last, whatever their errors. */
static double fitted_slope(const double *h, const double *error, int first, int last)
{
  dvi_order_fit fit;
  (void)dvi_order(last - first + 1, h + first, error + first, 0.0, 0.0, &fit);
  return fit.slope;
}

/* Compute the standard error of that slope, from the distances of the points to the fitted line. */
static double slope_error(const double *h, const double *error, int first, int last)
{
  const int count = last - first + 1;
  const double fitted = fitted_slope(h, error, first, last);
  double x_mean = 0.0, rest_mean = 0.0, spread = 0.0, squares = 0.0;
  for (int i = first; i <= last; i++) {
    x_mean += log(h[i]) / count;
    rest_mean += (log(error[i]) - fitted * log(h[i])) / count;
  }
  for (int i = first; i <= last; i++) {
    const double x = log(h[i]) - x_mean;
    const double rest = log(error[i]) - fitted * log(h[i]) - rest_mean;
    spread += x * x;
    squares += rest * rest;
  }
  return sqrt(squares / ((count - 2) * spread));
}

static bool is_settled(const double *h, const double *error, int first, int last)
{
  const int half = (last - first + 2) / 2;
  const double coarse = fitted_slope(h, error, first, first + half - 1);
  const double fine = fitted_slope(h, error, last - half + 1, last);
  return fabs(coarse - fine) <= half_tolerance &&
         slope_error(h, error, first, last) <= error_tolerance;
}

int dvi_study_fit(int levels, const double *h, const double *error, double floor, double ceiling,
                  dvi_order_fit *fit)
{
  bool found = false;
  (void)dvi_order(levels, h, error, floor, ceiling, fit);
  for (int count = levels; count >= DVI_STUDY_FIT_LEAST && !found; count--)
    for (int first = levels - count; first >= 0 && !found; first--) {
      const int last = first + count - 1;
      bool usable = true;
      for (int i = first; i <= last; i++) usable = usable && error[i] > floor && error[i] < ceiling;
      found = usable && is_settled(h, error, first, last);
      if (found)
        *fit = (dvi_order_fit){
            .slope = fitted_slope(h, error, first, last), .first = first, .last = last};
    }
  return found;
}
