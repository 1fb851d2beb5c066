/** Points that a scene's definitions give, as those of pendulums whose coordinates are angles. */
#ifndef VIEW_PLACES_H
#define VIEW_PLACES_H
#include <dvi/scene.h>

#include "cli/options.h"
#include "csv/series.h"
#include "problem.h"

/** Return the scene whose definitions a problem has: its own, or of a problem of the catalogue the
 * one of the same name and start, with the same settings, which *made owns. NULL without one. */
dvi_scene *places_scene(const problem *scene, const words *settings, dvi_scene **made);

/** Evaluate points at all rows of a table, whose columns of the coordinates are `column` [nq], and
 * add their columns, NAME_x and so on. Those of the names, or without any all of them. *first is
 * the first column of them. `expressions` is as above. Returns DONE, or complains and returns the
 * exit code. */
int places_add(const problem *scene, dvi_scene *expressions, const words *names, const int *column,
               series_table *table, int *first);
#endif
