/** Columns of numbers of a CSV file with a header, or of a file of HDF5. */
#ifndef SERIES_H
#define SERIES_H
#include "csv/rows.h"

/** One column. */
typedef struct series_column {
  char name[FIELD_SIZE];
  int field;     /**< place in the file's rows, from 0 */
  double *value; /**< [rows] NaN where a cell is no number */
} series_column;

/** The columns that are wanted, and their numbers. All zero is none. */
typedef struct series_table {
  bool of_run; /**< the rows of a run are wanted: the table of a sweep is refused */
  int columns, rows, capacity;
  series_column *column; /**< [columns] */
} series_table;

/** Want a column, once or several times. Returns its index, or -1 without memory. */
int series_want(series_table *table, const char *name);

/** Read the columns that are wanted, or all columns if none is. Returns DONE, or complains and
 * returns the exit code. Messages begin with the name of the command. */
int series_read(const char *command, const char *path, series_table *table);

void series_clear(series_table *table);
#endif
