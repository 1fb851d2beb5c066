/** The page of a run: what was laid out and read, as the numbers that the page draws. */
#ifndef VIEW_SHOW_H
#define VIEW_SHOW_H
#include "csv/series.h"
#include "view/grids.h"
#include "view/layout.h"

enum { VIEW_CURVES = 12 };

/** A run to be shown. */
typedef struct view_run {
  const char *title, *made; /**< what it is, and which command made the page */
  int frames;
  int *row;                  /**< [frames] rows of the table, or grids of the series */
  const series_table *table; /**< its rows. NULL without */
  const double *time;        /**< of each row, or grid */
  const view_layout *layout; /**< NULL for a field */
  const int *column;         /**< columns of the layout's coordinates */
  int curves;
  int curve[VIEW_CURVES];   /**< [curves] columns over time */
  const grid_frames *grids; /**< the field. NULL without */
} view_run;

/** Choose some of the rows, at equal distances, with the first and the last one: at most `most`.
 * Returns their number, and sets the list, which the caller frees. Returns 0 without memory. */
int view_thin(int rows, long most, int **row);

/** Write the page to a file. Returns DONE, or complains and returns FAILED. */
int view_write(const view_run *run, const char *path);
#endif
