/** The levels of a study. */
#ifndef LEVELS_H
#define LEVELS_H
#include "study/subject.h"

/** The most parts of a first level that is asked for; the most levels. */
enum { FIRST_PARTS_MAX = 1 << 24, STUDY_LEVELS_MAX = 40 };

/** What is asked for. */
typedef struct levels_request {
  double length;      /**< of the first level's parts, at most FIRST_PARTS_MAX; 0: searched */
  double ratio;       /**< of neighbouring lengths; 0: chosen */
  double first_error; /**< of a level that is searched, relative to the solution; 0: the rougher the
                           lower the order */
  int count;          /**< of levels */
} levels_request;

/** What was chosen. */
typedef struct levels_choice {
  long parts[STUDY_LEVELS_MAX]; /**< ascending; the first one is 0, and nothing else known, if all
                                   that a search tried fail or miss the solution altogether */
  double ceiling;               /**< errors from this on are too large to tell an order */
  double floor;                 /**< errors up to this belong to roundoff or to the judge */
  bool room; /**< false: so few parts meet the floor that the levels do not fit above it */
} levels_choice;

/** Choose how many parts each level has, so that the errors lie above the floor: each level at most
 *  halves the length, and less for high orders, of which a halving would cross the floor at
 *  once. */
dvi_status levels_choose(const study_subject *subject, const levels_request *request,
                         levels_choice *choice);
#endif
