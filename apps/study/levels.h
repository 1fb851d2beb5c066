/** The levels of a study, which the library searches for. */
#ifndef LEVELS_H
#define LEVELS_H
#include <dvi/study.h>

#include "study/subject.h"

/** Choose the number of parts of each level, so that the errors lie above the floor
 * (dvi_study_search_levels). `wish` has what is asked for: the number of levels, and perhaps the
 * length of the first level's parts, the ratio and the first error. */
dvi_status levels_choose(const study_subject *subject, const dvi_study_search *wish,
                         dvi_study_levels *choice);
#endif
