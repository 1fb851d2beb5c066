/** Plots, drawn by gnuplot into SVG files. */
#ifndef PLOT_H
#define PLOT_H
#include <stdbool.h>

/** One curve. Points with a NaN, or on a logarithmic axis with a number that is not positive, are
 * left out. */
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
 *  @return false, with a complaint, if there is no picture: gnuplot is missing or failed, there is
 *          nothing to draw, or the file cannot be written. What was at the path is then still
 *          there. */
bool plot_write(const char *path, int panels, const plot_panel *panel);
#endif
