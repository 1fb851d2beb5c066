/** Work against error. Each subject at each level is a job that is run repeatedly, and the costs of
 * small errors are found. */
#ifndef WORK_H
#define WORK_H
#include <dvi/study.h>
#include <stdbool.h>

#include "cli/numbers.h"
#include "cli/progress.h"
#include "study/subject.h"

enum { SETTING_SIZE = 32, WORK_LEVELS_MAX = 20, WORK_LONGER_MAX = 8 };

/** A subject at a level. */
typedef struct work_job {
  const study_subject *subject;
  char setting[SETTING_SIZE];               /**< "h=0.05" or "tol=1e-08" */
  study_level level;                        /**< result of the first run */
  long repeats;                             /**< number of runs in one measurement */
  double cpu[DVI_STUDY_ROUNDS_MAX];         /**< seconds of one run, in each round */
  dvi_study_spread seconds;                 /**< seconds over all rounds, set at their end */
  double preparation[DVI_STUDY_ROUNDS_MAX]; /**< seconds before the first part, NaN if not known */
  double preparation_seconds;               /**< median over all rounds, set at their end */
} work_job;

/** All jobs in the order of the table, which is all levels of one subject, then of the next. */
typedef struct work {
  const char *command;  /**< command in messages, such as "bench" */
  const char *shown;    /**< text beside the progress, such as "dvi bench" */
  double judge_error;   /**< error of the solution to compare with */
  const numbers *asked; /**< errors whose cost is asked for */
  long rounds;
  progress_line *progress; /**< progress that is shown during the measurement */
  int jobs, room;
  work_job *job; /**< [room] */
  double sample[DVI_STUDY_ROUNDS_MAX];
  /** seconds of the machine's calibration, one in each round, set at their end */
  dvi_study_spread calibration;
} work;

/** Return the smallest error that is asked for, infinite if none is. */
double work_smallest_asked(const numbers *asked);

/** Add a level of a subject. A level without a result is left out with a message, and DVI_OK is
 * returned. */
dvi_status work_add(work *w, const study_subject *subject, double refinement);

/** Add so many levels. The default 0 is six levels, larger parts as far as they are about as good,
 * and smaller ones to the smallest asked error. `search`, with equal parts, finds the levels. *lost
 * is set if the search found nothing, and nothing is added. */
dvi_status work_add_levels(work *w, const study_subject *search, const study_subject *subject,
                           int levels, bool *lost);

/** Add a subject at tolerances in descending order, the first `always` of them, and the others
 * until the smallest asked error is met. A level that fails in any way is left out. */
void work_add_tolerances(work *w, const study_subject *subject, int count, const double *tolerance,
                         int always);

/** Measure all jobs. Every round runs every job once, so that whatever slows the machine for a
 * while slows all of them. `calibrate` measures the machine, and may be NULL. */
dvi_status work_run(work *w, double (*calibrate)(void));

/** Return one past the last job of the subject that job `first` belongs to, by its name. */
int work_group_end(const work *w, int first);
#endif
