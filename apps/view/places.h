/** Points that a scene's definitions give, as those of pendulums whose coordinates are angles. */
#ifndef VIEW_PLACES_H
#define VIEW_PLACES_H
#include "cli/options.h"
#include "csv/series.h"
#include "problem.h"

/** Evaluate points at all rows of a table, whose columns of the coordinates are `column` [nq], and
 * add their columns, NAME_x and so on. Those of the names, or without any all of them. *first is
 * the first column of them. Returns DONE, or complains and returns the exit code. */
int places_add(const problem *scene, const words *names, const int *column, series_table *table,
               int *first);
#endif
