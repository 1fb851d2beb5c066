/** Marches of a field on a whole mesh or on shares of it, whose steps are timed. */
#ifndef TIMED_H
#define TIMED_H
#include <dvi/march.h>
#include <dvi/scene.h>
#include <dvi/study.h>

#include "cli/options.h"
#include "problem.h"

/** What is timed. */
typedef struct timed_request {
  const char *scene; /**< the path */
  const words *settings;
  double h;    /**< the step, NaN for the scene's */
  long rounds; /**< 1 to DVI_STUDY_ROUNDS_MAX */
  long steps;  /**< that are timed at once */
} timed_request;

/** A march that has been started. */
typedef struct timed_march {
  problem *scene;
  dvi_march *march;
  double h;
} timed_march;

/** Open a scene on the share that a division cuts, or on the whole mesh if that is NULL, and start
 * leapfrog. Returns DONE, or complains and returns the exit code. Call timed_close in any case. */
int timed_open(const timed_request *request, const dvi_scene_division *division,
               timed_march *timed);
void timed_close(timed_march *timed);

/** Measure the elapsed time of a step over the rounds, of as many processes as work (ranks_among),
 * the slowest of which counts. Returns DONE, or complains and returns the exit code. */
int timed_steps(const timed_request *request, const timed_march *timed, int workers,
                dvi_study_spread *seconds);

/** Give the largest of the working processes' numbers. They wait for each other. Returns whether
 * they could be reached, and complains otherwise. */
bool slowest_of(int workers, double seconds, double *most);
#endif
