/** The order of a method from single steps in quadruple precision: for orders whose errors over a
 * span reach the rounding of doubles before their leading term rules. */
#ifndef SINGLE_STEPS_H
#define SINGLE_STEPS_H
#include <dvi/dvi.h>
#include <stdbool.h>

#include "cli/options.h"
#include "problem.h"
#include "study/order.h"
#include "cli/progress.h"

enum { SINGLE_LEVELS = 8, SINGLE_POINTS = 5 };

/** Measure them, at points on the way to t_end. Errors are those of q and of p, relative to each,
 * and the root of the mean of their squares over the points from which steps are taken.
 *
 *  @param settings  of the problem's parameters
 *  @param method    a specification that makes an integrator
 *  @retval DVI_OK  *found is filled, or says what is missing */
dvi_status single_steps_measure(const problem *scene, const words *settings, const char *method,
                                double t_end, progress_line *progress, closer_look *found);
#endif
