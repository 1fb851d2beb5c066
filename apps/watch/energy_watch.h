/** Watches the energy of a conservative system along a run, and says at its end when the step is
 *  too large.
 *
 *  The error is |E(t) - E(0)|. Its scale does not depend on the constant that a potential may
 *  hold: of a Lagrangian system it is the mean kinetic energy of the run, or the kinetic energy
 *  at that time if it is larger (near a pericentre both terms of the energy are large, and so is
 *  what a good method exchanges between them). A Hamiltonian or a one-form has no kinetic
 *  energy; there the scale is by how much the energy would change, on average, if coordinates
 *  and momenta went back, one at a time, to where they started.
 *
 *  Systems that depend on time have no such watch. The first 32 steps are looked at, every 61st
 *  later on, and the last. */
#ifndef ENERGY_WATCH_H
#define ENERGY_WATCH_H
#include <stdbool.h>

#include "problem.h"

enum { ENERGY_LOOKS_MAX = 256 };

/** The energy at one time. */
typedef struct energy_look {
  double t, error, local; /**< local: the kinetic energy there; 0 where there is none */
} energy_look;

typedef struct energy_watch {
  const problem *scene;
  dvi_integrator *integrator;
  double bound;
  bool blind;            /**< the energy is not conserved, or cannot be evaluated */
  long steps;            /**< seen */
  double *room;          /**< [nq + nv] a velocity, or a point with one number set back; owned */
  const double *start;   /**< [nq + nv] q and p of the start; owned by room */
  double t_start, first; /**< when it began, and the energy then */
  double t, exchanged;   /**< the last look, and the integral of the kinetic energy up to there */
  int looks, next;       /**< kept; the number that is set back at the next look */
  double passed; /**< when the bound was first passed, in the scale up to there; NaN: not yet */
  energy_look look[ENERGY_LOOKS_MAX];
} energy_watch;

/** What a run was like. */
typedef struct energy_verdict {
  double ratio;     /**< of the largest error to its scale; NaN: nothing was seen */
  double t, passed; /**< when that was; when the bound was first passed, NaN: it was not */
} energy_verdict;

/** Whether a run is to be looked at after so many steps: after every one in the beginning, where
 *  a step that is far too large shows, then so rarely that it costs little. */
bool energy_look_due(long steps);

/** Begin at the integrator's state; an error is to be told if it is above `bound` times its
 *  scale. False without memory, with a complaint. */
bool energy_watch_start(energy_watch *watch, const problem *scene, dvi_integrator *integrator,
                        double bound);
void energy_watch_clear(energy_watch *watch);

/** What the scale is, in words: "kinetic energy". */
const char *energy_scale_name(const problem *scene);

/** A step was taken. */
void energy_watch_step(energy_watch *watch);

/** Look at the end of the run, and judge. */
energy_verdict energy_watch_end(energy_watch *watch);
#endif
