/** The step sizes of a study. */
#ifndef LEVELS_H
#define LEVELS_H
#include <stdbool.h>

#include "mechanics/order_study.h"

/** The most steps of a first level that is asked for. */
enum { FIRST_STEPS_MAX = 1 << 24 };

/** Choose how many steps each level takes, so that the errors lie above the floor: each level at
 * most halves h, and less for high orders, of which a halving would cross the floor at once. Sets
 * study->floor.
 *
 *  @param      h       the first step, of which at most FIRST_STEPS_MAX reach the end; 0: searched,
 * the rougher the lower the order
 *  @param      ratio   of neighbouring steps; 0: chosen
 *  @param      levels  how many
 *  @param[out] steps   [levels], ascending; the first one is 0, and nothing else known, if steps
 * follow a monitor and all that a search tried fail or miss the solution altogether
 *  @param[out] room    false if the time is too short: so few steps meet the floor that the levels
 * do not fit above it */
dvi_status choose_levels(order_study *study, double h, double ratio, int levels, long *steps,
                         bool *room);
#endif
