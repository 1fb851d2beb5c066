/** A method on a problem as a subject of studies. Its steps refine it, and it is judged at the end
 * of the motion. */
#ifndef MOTION_STUDY_H
#define MOTION_STUDY_H
#include "cli/progress.h"
#include "load/open.h"
#include "mechanics/judge.h"
#include "problem.h"
#include "study/subject.h"

/** The motion of a problem to a time, and the judge of its end. */
typedef struct judged_motion {
  const problem *scene;
  const judgement *judge;
  double t_end;
} judged_motion;

/** The subject, and the state of its callbacks. */
typedef struct motion_study {
  study_subject subject; /**< errors are those of q at t_end, in the maximum norm */
  judged_motion motion;
  dvi_integrator *integrator; /**< owned, NULL for a march of a field */
  const char *march;          /**< its specification, or NULL */
  progress_line *progress;    /**< progress of a run, or NULL */
} motion_study;

/** Return the words for studies of motions. Levels have the energy_error, and the counts residuals,
 * jacobians and factorizations. For problems with factors there is also distance, the largest one
 * from their manifold over the run. */
const study_words *motion_words(const problem *scene);

/** Return the words of a motion in a sentence, see study_words. */
const char *motion_say(study_phrase phrase, double t_end, char *text, size_t size);

/** The further error of a motion, energy_error. */
extern const table_column motion_further[];

/** Initialise study_words of motions, with the title of the column of subjects and with counts. */
#define MOTION_WORDS(title, counts)                                                  \
  {                                                                                  \
    .subject = (title), .problem = "problem", .length = "h", .parts = "steps",       \
    .preparation = "create_seconds", .further = motion_further, .counted = (counts), \
    .say = motion_say                                                                \
  }

/** Begin a study of a method, whose steps may follow a monitor. Its name in tables is `name`.
 * Returns DONE, or complains and returns the exit code. The study must not be moved. */
int motion_study_init(motion_study *study, const judged_motion *motion, const char *method,
                      const pacing *how, const char *name);

/** Complain that the monitor's steps do not lead to the end, and return FAILED. */
int motion_study_refuse(const char *name, double t_end);

void motion_study_clear(motion_study *study);
#endif
