/** The cost of a small error, read from a work-precision curve between its settings. */
#ifndef FRONTIER_H
#define FRONTIER_H

/** The way in which a cost was found. */
typedef enum frontier_answer {
  FRONTIER_NOT_REACHED, /**< no setting has so small an error */
  FRONTIER_BETWEEN,     /**< interpolated between the two neighbouring settings */
  FRONTIER_AT_MOST /**< an upper bound, because even the cheapest setting has a smaller error */
} frontier_answer;

/** Compute the least cost of an error.
 *
 * The curve consists of the settings that no other one beats, that is, no other setting has both a
 * smaller or equal error and a smaller or equal cost. Between two neighbours the logarithm of the
 * cost is taken as linear in the logarithm of the error. Nothing is extrapolated beyond the ends.
 *  @param      error, cost  [count] points that are not finite and positive are left out
 *  @param      asked        the error, positive
 *  @param[out] least        the cost, NaN if the error is not reached */
frontier_answer frontier_cost(int count, const double *error, const double *cost, double asked,
                              double *least);
#endif
