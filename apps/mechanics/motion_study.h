/** A method on a problem as a subject of studies: refined by its steps, judged at the end of the
 *  motion. */
#ifndef MOTION_STUDY_H
#define MOTION_STUDY_H
#include "cli/progress.h"
#include "load/open.h"
#include "mechanics/judge.h"
#include "problem.h"
#include "study/subject.h"

/** The motion of a problem to a time, and who says where it ends. */
typedef struct judged_motion {
  const problem *scene;
  const judgement *judge;
  double t_end;
} judged_motion;

/** The subject, and what its callbacks work with. */
typedef struct motion_study {
  study_subject subject; /**< its errors are those of q at t_end, in the maximum norm */
  judged_motion motion;
  dvi_integrator *integrator; /**< owned */
  progress_line *progress;    /**< shown while it runs; NULL: none */
} motion_study;

/** Words for studies of motions: levels have the energy_error, and the counts residuals, jacobians,
 *  factorizations and, of problems with factors, distance: from their manifold, over the run. */
const study_words *motion_words(const problem *scene);

/** What a sentence says of a motion, see study_words. */
const char *motion_say(study_phrase phrase, double t_end, char *text, size_t size);

/** Begin a study of a method, whose steps may follow a monitor. Its name in tables is `name`.
 * Returns DONE, or complains and returns the exit code. The study stays where it is. */
int motion_study_init(motion_study *study, const judged_motion *motion, const char *method,
                      const pacing *how, const char *name);

/** Complain that the monitor leads nowhere, and return FAILED. */
int motion_study_refuse(const char *name, double t_end);

void motion_study_clear(motion_study *study);
#endif
