/** One run of a search for resonances. It measures the change of an invariant, and its growth. */
#ifndef RESONANCE_POINT_H
#define RESONANCE_POINT_H
#include "problem.h"
#include "load/scene.h"

/** Limit of an invariant's change, as a multiple of its start. Beyond it the run ends as
 * unbounded. */
#define RESONANCE_LIMIT 1e30

/** The part of a run that is the same at all points. */
typedef struct resonance_task {
  const char *operand; /**< name of the catalogue, or path of the text */
  scene_text text;     /**< text of a scene, empty for the catalogue */
  const char *method;
  words settings;   /**< settings of the other parameters */
  const char *name; /**< name of the parameter that varies, or "h" for the step */
  bool steps_vary;
  double h, t_end;
  int watched; /**< index of the invariant */
} resonance_task;

/** The result of the run with one value. */
typedef struct resonance_point {
  double value;
  /** DVI_OK, unbounded, the status of a failure, or refused if the problem cannot be created. In
   * static storage. */
  const char *status;
  /** the invariant moved by RESONANCE_LIMIT times its start, which ended the run */
  bool unbounded;
  bool failed; /**< neither DVI_OK nor unbounded */
  long steps;
  double t;
  /** largest change of the invariant over the run, relative to its start if that is not 0, or NaN
   * without one */
  double error;
  /** (d/dt) ln error over the last half to three quarters of the run, or NaN if it is not known */
  double growth;
} resonance_point;

/** Run with point->value and fill in the other members. Failures are also complained about. May be
 * called from several threads at once. */
void resonance_run(const resonance_task *task, resonance_point *point);
#endif
