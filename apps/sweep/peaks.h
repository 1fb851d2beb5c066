/** A search for resonances: runs at values of a parameter, and more of them where the invariant's
 * error has its peaks. */
#ifndef PEAKS_H
#define PEAKS_H
#include "sweep/resonance_point.h"

/** How a search goes about it. */
typedef struct peaks_search {
  double from, to;
  long grid;    /**< even points to begin with, ends included, from 3 */
  double width; /**< gaps beside a peak are halved down to this */
  long most;    /**< points, at most */
  long threads;
} peaks_search;

/** What it found. */
typedef struct peaks_found {
  int count;
  resonance_point *point; /**< [count] in the order of their values; owned */
  bool *
      /** [count] tops of peaks: more than twice the larger one of the least errors on both sides,
       * before larger ones; owned */
      top;
  bool complete; /**< not so if `most` has ended the search */
} peaks_found;

/** Search. False, with a complaint, without memory; peaks_clear afterwards in any case. */
bool peaks_find(const resonance_task *task, const peaks_search *search, peaks_found *found);

/** log10 of a point's error, no less than at 1e-12: below that may be roundoff. */
double peaks_height(const resonance_point *point);

void peaks_clear(peaks_found *found);
#endif
