/** The watch of a system that depends on time, whose energy is not conserved. It tells of momenta
 * that grow from step to step as those of an unstable method do.
 *
 * Powers of the time, as of a force that sets in, do not grow by a million in neighbouring steps
 * that each multiply by more than 1.5, from the fourth step on. Later looks are 61 steps apart, and
 * each must multiply by more than a thousand. */
#ifndef GROWTH_WATCH_H
#define GROWTH_WATCH_H
#include <stdbool.h>

#include "problem.h"

typedef struct growth_watch {
  const problem *scene;
  dvi_integrator *integrator;
  bool is_on;
  long steps;
  double last;            /**< sum of the momenta's sizes at the last look */
  double factor, passed;  /**< growth of this row of looks, and the largest that raised the alarm */
  double from, passed_at; /**< times at the start of the row, and at the alarm */
} growth_watch;

void growth_watch_start(growth_watch *watch, const problem *scene, dvi_integrator *integrator);

/** Note a step. */
void growth_watch_step(growth_watch *watch);

/** Say once at the end of a run if the momenta grew so. */
void growth_watch_tell(const growth_watch *watch, const char *method, double h);
#endif
