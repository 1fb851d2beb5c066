/** The range of step sizes that shows an order. */
#ifndef WINDOW_H
#define WINDOW_H
#include <dvi/dvi.h>
#include <stdbool.h>

/** Fewer levels than this decide nothing. */
enum { WINDOW_LEVELS = 4 };

/** Fit an order to the longest run of levels with a settled slope. The slopes of its coarser and
 * its finer half agree within 0.1, and the standard error of the fitted slope is at most 0.05. Of
 * equally long runs the finest is taken. The function does not know which order is claimed.
 *
 *  @param      levels    number of levels
 *  @param      h, error  [levels] h is positive and descending
 *  @param      floor     errors up to this one are left out
 *  @param      ceiling   errors from this one on are left out
 *  @param[out] fit       the fit, to the longest run between floor and ceiling if there is no such
 *                        run
 *  @return whether there is such a run */
bool window_fit(int levels, const double *h, const double *error, double floor, double ceiling,
                dvi_order_fit *fit);
#endif
