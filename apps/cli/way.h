/** The steps of a run from a time to its end. */
#ifndef WAY_H
#define WAY_H
#include <stdbool.h>

/** Refuse a step that does not lead to the end, or needs more steps than can be counted.
 *
 *  @param command  the name of the command in messages
 *  @param way      the time left to t_end
 *  @param counted  the steps are steps of time, so that their number is known
 *  @return DONE, or complains and returns USAGE */
int way_check(const char *command, double h, double way, double t_end, bool counted);
#endif
