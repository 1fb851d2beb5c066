/** The order of a method from single steps in quadruple precision: for orders whose errors over a
 * span reach the rounding of doubles before their leading term rules. */
#ifndef SINGLE_STEPS_H
#define SINGLE_STEPS_H
#include <dvi/dvi.h>
#include <stdbool.h>

#include "cli/options.h"
#include "problem.h"
#include "cli/progress.h"

enum { SINGLE_LEVELS = 8, SINGLE_POINTS = 5 };

/** What they show. Errors are those of q and of p, relative to each, and the root of the mean of
 * their squares over the points from which steps are taken. */
typedef struct single_steps {
  bool asked;
  const char *missing; /**< why there are none; NULL: they are below */
  double h[SINGLE_LEVELS], error[SINGLE_LEVELS];
  double judge_error; /**< the largest of the solutions that the smallest steps are compared with */
  double common_h, common_error; /**< of larger steps, which doubles show, too */
  double apart; /**< the largest distance of the library's own steps of that length from these */
  dvi_order_fit fit; /**< of the order: one less than the slope of these errors */
  bool settled;
} single_steps;

/** Measure them, at points on the way to t_end.
 *
 *  @param settings  of the problem's parameters
 *  @param method    a specification that makes an integrator
 *  @retval DVI_OK  they are filled, or `missing` is */
dvi_status single_steps_measure(const problem *scene, const words *settings, const char *method,
                                double t_end, progress_line *progress, single_steps *found);
#endif
