/** The way of a run, from a time to its end, in steps. */
#ifndef WAY_H
#define WAY_H
#include <stdbool.h>

/** Refuse a step that does not lead to the end, or not in as many steps as can be counted.
 *
 *  @param command  who asks, for messages
 *  @param way      what is left to t_end
 *  @param counted  the steps are steps of time, so that their number is known
 *  @return DONE, or complains and returns USAGE */
int way_check(const char *command, double h, double way, double t_end, bool counted);
#endif
