/** Plots, drawn by gnuplot into SVG files. */
#ifndef PLOT_H
#define PLOT_H
#include <stdbool.h>

/** One curve. Points with a NaN, or on a logarithmic axis with a number that is not positive, are
 * left out. */
typedef struct plot_curve {
  const char *label; /**< label in the legend, or NULL for none */
  int count;
  const double *x, *y;
  bool guide; /**< a thin dashed line without points, for comparison with the others */
} plot_curve;

/** One pair of axes. */
typedef struct plot_panel {
  const char *title, *x_label, *y_label;
  bool logarithmic; /**< logarithmic scale on both axes */
  bool smooth;      /**< lines without points, for many points */
  bool dots;        /**< dots without lines, for many points */
  bool equal;       /**< same scale on both axes */
  int curves;
  const plot_curve *curve;
} plot_panel;

/** Draw panels, one above the other, into an SVG file that is whole or not there.
 *
 *  @return false, with a complaint, if there is no picture, because gnuplot is missing or failed,
 *          there is nothing to draw, or the file cannot be written. An old file at the path is then
 *          still there. */
bool plot_write(const char *path, int panels, const plot_panel *panel);
#endif
