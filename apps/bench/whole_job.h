/** Whole jobs as subjects of studies: a method, from the creation of its integrator to the last
 * step; and a peer at its tolerances. */
#ifndef WHOLE_JOB_H
#define WHOLE_JOB_H
#include "load/pacing.h"
#include "mechanics/motion_study.h"

/** The times at which the energy of a peer's run is looked at: so many, evenly spaced, the last one
 * the end. */
enum { ENERGY_TIMES = 8 };

/** What the callbacks work with; it stays where it is. */
typedef struct whole_job {
  study_subject subject;
  judged_motion motion;
  const char *method;  /**< its specification */
  pacing how;          /**< what its steps follow */
  double span;         /**< of its own time */
  motion_study *study; /**< watches the energy; NULL once all levels are there */
  int peer;            /**< of a peer: its number */
  double *room;        /**< [2 n] of a peer; owned */
} whole_job;

/** Titles and counts of whole jobs: energy_error, and evaluations. */
extern const study_words whole_job_words;

/** A method: levels are steps, watched by a study of the same method. */
void whole_job_of_method(whole_job *job, motion_study *study, const char *method,
                         const pacing *how);

/** A peer: levels are tolerances. DVI_NO_MEMORY. */
dvi_status whole_job_of_peer(whole_job *job, int peer, const judged_motion *motion);

void whole_job_clear(whole_job *job);
#endif
