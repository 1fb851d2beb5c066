/** Points of a path from lists on the command line and from CSV files. */
#ifndef POINTS_H
#define POINTS_H
#include <stdbool.h>

#include "problem.h"

/** Some points of a path of a problem. */
typedef struct points {
  int count, capacity;
  double *t; /**< [count] */
  double *q; /**< [count*n], point after point */
} points;

/** Read the columns t and those of the problem's coordinates from a CSV file with a header, as `dvi
 * run` writes it. Other columns are skipped. Returns DONE, or complains and returns the exit
 * code. */
int points_read(const char *path, const problem *scene, points *read);

/** Add a point. Complains and returns false without memory. */
bool points_add(points *to, int n, double t, const double *q);

void points_clear(points *list);

/** Read a list of exactly n finite numbers, separated by commas. Returns DONE, or complains about
 * `where`, such as "path: --to", and returns USAGE. */
int list_read(const char *where, const char *text, const problem *scene, double *number);
#endif
