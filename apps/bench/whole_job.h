/** Whole jobs as subjects of studies. They are a method from the creation of its integrator to the
 * last step, a bare loop at the same steps, and a peer at its tolerances. */
#ifndef WHOLE_JOB_H
#define WHOLE_JOB_H
#include "load/pacing.h"
#include "mechanics/motion_study.h"

/** Number of times at which the energy of a run of a peer or a bare loop is evaluated. They are
 * evenly spaced, and the last one is the end. */
enum { ENERGY_TIMES = 8, BARE_NAME = 32 };

/** The state of the callbacks. It must not be moved. */
typedef struct whole_job {
  study_subject subject;
  judged_motion motion;
  const char *method;  /**< specification of the method */
  pacing how;          /**< monitor of its steps */
  double span;         /**< span of its own time */
  motion_study *study; /**< study that watches the energy, NULL once all levels are there */
  int peer;            /**< number of a peer, or -1 */
  double *room;        /**< [2 n] owned, for a peer or a bare loop */
  /* of a bare loop: its degree and name, and the job of the method that has the same steps */
  int degree;
  char name[BARE_NAME];
  const struct whole_job *beside;
} whole_job;

/** Titles and counts of whole jobs, namely energy_error and evaluations. */
extern const study_words whole_job_words;

/** Make the job of a method. Its levels are steps, watched by a study of the same method. */
void whole_job_of_method(whole_job *job, motion_study *study, const char *method,
                         const pacing *how);

/** Make the job of a peer. Its levels are tolerances. DVI_NO_MEMORY. */
dvi_status whole_job_of_peer(whole_job *job, int peer, const judged_motion *motion);

/** Make the job of a bare loop of Gauss' method, beside a method with the same steps. Its levels
 * are steps. DVI_NO_MEMORY. */
dvi_status whole_job_of_bare(whole_job *job, int degree, const whole_job *beside,
                             const judged_motion *motion);

void whole_job_clear(whole_job *job);
#endif
