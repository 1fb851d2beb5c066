/** Plots of a table's columns against each other, on logarithmic axes. */
#ifndef AXES_H
#define AXES_H
#include <stdbool.h>

#include "cli/options.h"
#include "plot/plot.h"
#include "csv/table.h"

/** Two columns. */
typedef struct axes_pair {
  int x, y;
} axes_pair;

/** The pairs to be drawn, with a panel for each. */
typedef struct plot_axes {
  int count;
  axes_pair pair[WORDS_MAX];
  axes_pair usual; /**< pair that is drawn if nothing is asked for */
} plot_axes;

/** Read pairs "X:Y" of columns' titles, which --axes asked for. The default is `usual`. Returns
 * DONE, or complains about `command` and returns USAGE. Refused are pairs without a plot (its file
 * is NULL then), words that are no pair, and columns that do not exist or have no numbers. */
int axes_read(const char *command, const words *asked, const char *plot, const char *usual,
              const table_column *columns, plot_axes *axes);

/** Draw a panel for each pair into an SVG file. A panel has a curve for each run of rows that begin
 * with the same text. Signs are ignored.
 *
 *  @param subject  the text of the titles after the columns, such as "kepler, to t = 10"
 *  @param guide    [guides] curves to compare with, drawn beside the usual pair
 *  @return false, with a complaint, if the file cannot be written */
bool axes_plot(const result_table *rows, const plot_axes *axes, const char *subject, int guides,
               const plot_curve *guide, const char *path);
#endif
