/** Marches of a field, a solid or a grid, whole or on shares of it, whose steps are timed. */
#ifndef TIMED_H
#define TIMED_H
#include <dvi/march.h>
#include <dvi/scene.h>
#include <dvi/study.h>
#include <stdbool.h>

#include "cli/options.h"
#include "problem.h"

/** What is timed. */
typedef struct timed_request {
  const char *scene; /**< the path */
  const words *settings;
  const char *method; /**< leapfrog, yee or verlet, or NULL for the scene's */
  double h;           /**< the step, NaN for the scene's */
  long rounds;        /**< 1 to DVI_STUDY_ROUNDS_MAX */
  long steps;         /**< that are timed at once */
} timed_request;

/** What is shared. */
typedef enum timed_kind {
  TIMED_FIELD, /**< the mesh of a field, by leapfrog */
  TIMED_SOLID, /**< that of a solid, by verlet */
  TIMED_GRID   /**< a grid, by yee */
} timed_kind;

/** A march that has been started. */
typedef struct timed_march {
  timed_kind kind;
  const char *method;
  problem *scene;
  dvi_march *march;
  double h;
} timed_march;

/** Open a scene on the share that a division cuts, or on the whole mesh if that is NULL, and start
 * the march. Returns DONE, or complains and returns the exit code. Call timed_close in any case. */
int timed_open(const timed_request *request, const dvi_scene_division *division,
               timed_march *timed);
void timed_close(timed_march *timed);

/** Tell if the scene's mesh is a file that processes read in parts. */
bool timed_is_in_parts(const timed_request *request);

/** Return the number of values of E and B that a grid has, or the block of this process. */
double timed_values(const timed_march *timed);

/** Return the mesh of a field or a solid. */
const dvi_mesh *timed_mesh(const timed_march *timed);

/** Return the degree of the form that is exchanged, and how often in a step. */
int timed_degree(const timed_march *timed);
int timed_times(const timed_march *timed);

/** Measure the elapsed time of a step over the rounds, of as many processes as work (ranks_among),
 * the slowest of which counts. Returns DONE, or complains and returns the exit code. */
int timed_steps(const timed_request *request, const timed_march *timed, int workers,
                dvi_study_spread *seconds);

/** Give the largest of the working processes' numbers. They wait for each other. Returns whether
 * they could be reached, and complains otherwise. */
bool slowest_of(int workers, double seconds, double *most);
#endif
