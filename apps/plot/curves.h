/** Columns of a CSV file as curves. */
#ifndef CURVES_H
#define CURVES_H
#include "cli/options.h"
#include "csv/series.h"

/** One column against another. */
typedef struct curve_points {
  int panel; /**< index of the pair of axes, from 0 */
  int x_column, y_column;
  const char *x_name, *y_name;
  const double *x, *y; /**< [count] NaN where a cell is no number */
} curve_points;

/** The curves to be drawn, and their points. */
typedef struct curve_list {
  int panels, curves, count;
  curve_points curve[WORDS_MAX];
  series_table table;
} curve_list;

/** Read the words of --axes, each "X:Y[,X:Y...]" for one panel. A single Y means t:Y. Returns DONE,
 * or complains and returns USAGE. */
int curves_ask(const words *asked, curve_list *list);

/** Read the columns that are asked for from a CSV file with a header. Returns DONE, or complains
 * and returns the exit code. */
int curves_read(const char *path, curve_list *list);

void curves_clear(curve_list *list);
#endif
