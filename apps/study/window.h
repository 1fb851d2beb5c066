/** The range of step sizes that shows an order. */
#ifndef WINDOW_H
#define WINDOW_H
#include <dvi/dvi.h>
#include <stdbool.h>

/** Fewer levels than this decide nothing. */
enum { WINDOW_LEVELS = 4 };

/** Fit an order to the longest run of levels over which the slope is settled: its coarser and its
 * finer half show the same slope within 0.1, and the standard error of the fitted slope is 0.05 at
 * most. Of equally long runs the finest is taken. Nothing here knows which order is claimed.
 *
 *  @param      levels    how many
 *  @param      h, error  [levels], h positive and descending
 *  @param      floor     errors up to this are left out
 *  @param      ceiling   errors from this on are left out
 *  @param[out] fit       if there is no such run, the fit to the longest run between floor and
 * ceiling
 *  @return whether there is such a run */
bool window_fit(int levels, const double *h, const double *error, double floor, double ceiling,
                dvi_order_fit *fit);
#endif
