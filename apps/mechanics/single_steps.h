/** The order of a method from single steps in quadruple precision. It serves orders whose errors
 * over a span reach the rounding of doubles before their leading term dominates. */
#ifndef SINGLE_STEPS_H
#define SINGLE_STEPS_H
#include <dvi/dvi.h>
#include <stdbool.h>

#include "cli/options.h"
#include "problem.h"
#include "study/order.h"
#include "cli/progress.h"

enum { SINGLE_LEVELS = 8, SINGLE_POINTS = 5 };

/** Measure single steps at points of the motion to t_end. The errors of q and of p are relative to
 * the size of each. The result is the root of the mean of their squares over the points.
 *
 *  @param settings  of the problem's parameters
 *  @param method    the specification of an integrator
 *  @retval DVI_OK  *found is filled, or names what is missing */
dvi_status single_steps_measure(const problem *scene, const words *settings, const char *method,
                                double t_end, progress_line *progress, closer_look *found);
#endif
