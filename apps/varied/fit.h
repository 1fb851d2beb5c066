/** Least squares: the parameters and starts for which a run comes nearest to measurements.
 *
 *  The sum of the squares of all differences is made least by the method of Levenberg and Marquardt
 *  (More 1978), with Jacobians that are exact for the discrete run. Quantities stay within their
 *  bounds by projection. */
#ifndef FIT_H
#define FIT_H
#include "varied/fit_data.h"
#include "varied/varied.h"

/** A quantity that is varied. */
typedef struct fit_quantity {
  char name[64];
  int index;          /**< as in varied_name */
  double value;       /**< start, then result */
  double least, most; /**< bounds */
  double error;       /**< standard error, NaN at a bound */
} fit_quantity;

/** A fit. */
typedef struct fit {
  const char *path, *method;
  const scene_text *text;
  words settings; /**< those of the command line, without varied parameters */
  const fit_data *data;
  fit_quantity *quantity;   /**< [count] */
  int n, count, iterations; /* coordinates, quantities */
  double squares;           /**< sum of squares at the result */
} fit;

/** Return the number of differences. */
int fit_differences(const fit *f);

/** Find the result and its standard errors. Returns DONE, or complains and returns the exit
 * code. */
int fit_solve(fit *f);
#endif
