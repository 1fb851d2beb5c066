/** The watch of a conservative system's energy along a run, which reports at its end if the step is
 * too large.
 *
 * The error is |E(t) - E(0)|. Its scale does not depend on a constant in the potential. For a
 * Lagrangian system it is the mean kinetic energy of the run, or the kinetic energy at that time if
 * it is larger. Near a pericentre both terms of the energy are large, and so is the energy that a
 * good method exchanges between them. A Hamiltonian or a one-form has no kinetic energy. Its scale
 * is the mean change of the energy if coordinates and momenta go back, one at a time, to their
 * start. A Lagrangian system whose coordinates do not move beyond their rounding is at rest, and
 * has no errors to report.
 *
 * Systems that depend on time have no such watch, but that of growth_watch.h. The first 32 steps
 * are looked at, every 61st later on, and the last. */
#ifndef ENERGY_WATCH_H
#define ENERGY_WATCH_H
#include <stdbool.h>

#include "problem.h"

enum { ENERGY_LOOKS_MAX = 256, ENERGY_EVERY_STEP = 32 };

/** The energy at one time. */
typedef struct energy_look {
  double t, error, local; /**< local is the kinetic energy there, or 0 without one */
} energy_look;

typedef struct energy_watch {
  const problem *scene;
  dvi_integrator *integrator;
  double bound;
  bool blind;            /**< the energy is not conserved, or cannot be evaluated */
  long steps;            /**< number of steps so far */
  double *room;          /**< [nq + nv] a velocity, or a point with one number set back, owned */
  const double *start;   /**< [nq + nv] q and p of the start, in the memory of room */
  double t_start, first; /**< time and energy at the start */
  double t, exchanged; /**< time of the last look, and integral of the kinetic energy until then */
  /** number of looks that are kept, and the number that is set back at the next look */
  int looks, next;
  double moved, largest; /**< largest change of a coordinate, and largest coordinate */
  double passed; /**< time when the bound was first passed, in the scale until then, or NaN */
  energy_look look[ENERGY_LOOKS_MAX];
} energy_watch;

/** The verdict on a run. */
typedef struct energy_verdict {
  double ratio;     /**< ratio of the largest error to its scale, or NaN if nothing was seen */
  double t, passed; /**< time of that error, and time when the bound was first passed or NaN */
} energy_verdict;

/** Return whether to look at a run after so many steps. In the beginning this is every step,
 * because it reveals a step that is far too large. Later it is so rare that it costs little. */
bool energy_look_due(long steps);

/** Start at the integrator's state. An error above `bound` times its scale is reported. Complains
 * and returns false without memory. */
bool energy_watch_start(energy_watch *watch, const problem *scene, dvi_integrator *integrator,
                        double bound);
void energy_watch_clear(energy_watch *watch);

/** Return the scale in words, such as "kinetic energy". */
const char *energy_scale_name(const problem *scene);

/** Note a step. */
void energy_watch_step(energy_watch *watch);

/** Look at the end of the run, and judge. */
energy_verdict energy_watch_end(energy_watch *watch);
#endif
