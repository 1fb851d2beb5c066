/** Plots of a table: its columns against each other, on logarithmic axes. */
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

/** What is to be drawn: a panel for each pair. */
typedef struct plot_axes {
  int count;
  axes_pair pair[WORDS_MAX];
  axes_pair usual; /**< what is drawn if nothing is asked for */
} plot_axes;

/** Read pairs "X:Y" of columns' titles, asked for by --axes; left out, `usual` is the one. Returns
 *  DONE; or complains, about `command`, and returns USAGE: pairs without a plot (its file, NULL:
 *  none), a word that is no pair, a column that is not there or has no numbers. */
int axes_read(const char *command, const words *asked, const char *plot, const char *usual,
              const table_column *columns, plot_axes *axes);

/** Draw into an SVG file a panel for each pair, in it a curve for each run of rows that begin with
 * the same text. Signs are left aside.
 *
 *  @param subject  what the titles say after the columns: "kepler, to t = 10"
 *  @param guide    [guides] curves to compare with, drawn beside the usual pair
 *  @return false, with a complaint, if the file cannot be written */
bool axes_plot(const result_table *rows, const plot_axes *axes, const char *subject, int guides,
               const plot_curve *guide, const char *path);
#endif
