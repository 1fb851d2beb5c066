/** The levels of a study. */
#ifndef LEVELS_H
#define LEVELS_H
#include "study/subject.h"

/** Largest number of parts of a requested first level, and largest number of levels. */
enum { FIRST_PARTS_MAX = 1 << 24, STUDY_LEVELS_MAX = 40 };

/** The levels that are requested. */
typedef struct levels_request {
  /** length of the first level's parts, at most FIRST_PARTS_MAX parts (default searched) */
  double length;
  double ratio; /**< ratio of neighbouring lengths (default chosen) */
  /** error of a first level that is searched, relative to the solution (default the larger, the
   * lower the order) */
  double first_error;
  int count; /**< number of levels */
} levels_request;

/** The levels that were chosen. */
typedef struct levels_choice {
  /** ascending. The first is 0, and nothing else is known, if all levels of a search fail or miss
   * the solution altogether. */
  long parts[STUDY_LEVELS_MAX];
  double ceiling; /**< errors from this one on are too large to tell an order */
  double floor;   /**< errors up to this one belong to roundoff or to the judge */
  bool room; /**< the levels fit above the floor. Else so few parts reach it that they do not. */
} levels_choice;

/** Choose the number of parts of each level, so that the errors lie above the floor. Each level at
 * most halves the length, and less for high orders, of which a halving would cross the floor at
 * once. */
dvi_status levels_choose(const study_subject *subject, const levels_request *request,
                         levels_choice *choice);
#endif
