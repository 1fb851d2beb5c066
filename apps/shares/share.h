/** The mesh or grid of a scene's field, which several processes share (module/ranks.h). */
#ifndef SHARE_OF_SCENE_H
#define SHARE_OF_SCENE_H
#include <dvi/march.h>
#include <stdbool.h>

#include "cli/options.h"
#include "problem.h"

/** Tell if the steps of a method solve equations: midpoint, imex, galerkin and its options. */
bool share_is_implicit(const char *method);

/** Check that processes can share a scene by a method, which is NULL for the scene's: leapfrog,
 *  midpoint, of waves all that is implicit, on grids yee, of solids avi and verlet. Returns DONE,
 *  or complains and returns USAGE. */
int share_check(const char *command, const problem *scene, const char *method, int processes);

/** What is told of shares. */
typedef struct share_request {
  const char *path; /**< of the scene */
  const words *settings;
  const char *method;
  double h;        /**< NaN for the scene's step */
  const char *csv; /**< the path of a table, "-" for standard output, or NULL */
} share_request;

/** Print how the processes share the mesh or grid, what a step makes them exchange, and what they
 *  are counted to receive in the first steps of the march. Called by all of them. Returns DONE, or
 *  complains and returns the exit code. */
int share_tell(const share_request *request, const problem *scene, dvi_march *march);

/** Foresee the same for processes that are not there, whose shares this one cuts
 *  (ranks_begin_alone). `march` is that of the whole mesh, or NULL. */
int share_foresee(const share_request *request, const problem *scene, const dvi_march *march,
                  int processes);
#endif
