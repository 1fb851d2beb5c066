/** Plots, drawn by gnuplot into SVG files. */
#ifndef PLOT_H
#define PLOT_H
#include <stdbool.h>

/** One curve. Points with a NaN, or on a logarithmic axis with a number that is not positive, are left out. */
typedef struct plot_curve {
  const char *label; /**< NULL: not in the legend */
  int count;
  const double *x, *y;
  bool guide; /**< a thin dashed line without points, for comparison with the others */
} plot_curve;

/** One pair of axes. */
typedef struct plot_panel {
  const char *title, *x_label, *y_label;
  bool logarithmic; /**< both axes */
  bool smooth;      /**< many points: lines alone */
  bool dots;        /**< many points: dots alone */
  bool equal;       /**< the same scale on both axes */
  int curves;
  const plot_curve *curve;
} plot_panel;

/** Draw panels, one above the other, into an SVG file that is whole or not there.
 *
 *  Without gnuplot it says so on standard error and returns true: a missing plot spoils no result.
 *  @return false, with a complaint, if the file cannot be written */
bool plot_write(const char *path, int panels, const plot_panel *panel);
#endif
