/** Measurements of a run, from a CSV file. */
#ifndef FIT_DATA_H
#define FIT_DATA_H
#include "problem.h"

/** Numbers of some columns at some times. */
typedef struct fit_data {
  int rows, columns, capacity;
  int *state;    /**< [columns] which number of (q,p) a column measures */
  double *t;     /**< [rows] ascending, from 0 on */
  double *value; /**< [rows*columns], row after row */
} fit_data;

/** Read a CSV file with a header that has t and coordinates or momenta, as `dvi run` writes it.
 *  `columns` is a list of those to be used, separated by commas, or NULL for all of the file's.
 *  Returns DONE, or complains with the line and returns the exit code. */
int fit_data_read(const char *path, const problem *scene, const char *columns, fit_data *read);
void fit_data_clear(fit_data *data);
#endif
