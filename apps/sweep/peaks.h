/** A search for resonances, by runs at values of a parameter and at more values near the peaks of
 * the invariant's error. */
#ifndef PEAKS_H
#define PEAKS_H
#include "sweep/resonance_point.h"

/** The parameters of a search. */
typedef struct peaks_search {
  double from, to;
  long grid;    /**< number of equidistant first points, at least 3 with the ends */
  double width; /**< width down to which gaps beside a peak are halved */
  long most;    /**< largest number of points */
  long threads;
} peaks_search;

/** The result of a search. */
typedef struct peaks_found {
  int count;
  resonance_point *point; /**< [count] in the order of their values, owned */
  /** [count] tops of peaks, more than twice the larger one of the least errors on both sides,
   * before larger ones. Owned. */
  bool *top;
  bool complete; /**< false if `most` ended the search */
} peaks_found;

/** Search for peaks. Complains and returns false without memory. Call peaks_clear afterwards in any
 * case. */
bool peaks_find(const resonance_task *task, const peaks_search *search, peaks_found *found);

/** Return log10 of a point's error, or of 1e-12 if the error is less, because it may be
 * roundoff. */
double peaks_height(const resonance_point *point);

void peaks_clear(peaks_found *found);
#endif
