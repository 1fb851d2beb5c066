/** One run of a search for resonances: how far does an invariant move, and does it grow? */
#ifndef RESONANCE_POINT_H
#define RESONANCE_POINT_H
#include "problem.h"
#include "load/scene.h"

/** An invariant that has moved by so many times its start is beyond all bounds: the run ends. */
#define RESONANCE_LIMIT 1e30

/** What is the same at all points. */
typedef struct resonance_task {
  const char *operand; /**< a name of the catalogue, or the path that the text was read from */
  scene_text text;     /**< of a scene; else empty */
  const char *method;
  words settings;   /**< of the other parameters */
  const char *name; /**< of the parameter that varies; "h": the step */
  bool steps_vary;
  double h, t_end;
  int watched; /**< which invariant */
} resonance_task;

/** What became of the run with one value. */
typedef struct resonance_point {
  double value;
  /** DVI_OK, unbounded, why it failed, or refused where the problem cannot be made; static
   * storage */
  const char *status;
  /** the invariant moved by RESONANCE_LIMIT times its start, and the run was ended */
  bool unbounded;
  bool failed; /**< it is neither DVI_OK nor unbounded */
  long steps;
  double t;
  /** largest change of the invariant over the run, relative to its start if that is not 0; NaN:
   * there was none */
  double error;
  /** (d/dt) ln error, over the last half to three quarters of the run; NaN: not known */
  double growth;
} resonance_point;

/** Run with point->value and fill in the rest. What fails is told by a complaint, too. May be
 * called from several threads at once. */
void resonance_run(const resonance_task *task, resonance_point *point);
#endif
