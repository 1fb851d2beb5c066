/** Work against error: subjects at one level after another, each a job that is run again and again,
 *  and what small errors cost. */
#ifndef WORK_H
#define WORK_H
#include <stdbool.h>

#include "cli/numbers.h"
#include "cli/progress.h"
#include "study/samples.h"
#include "study/subject.h"

enum { SETTING_SIZE = 32, WORK_LEVELS_MAX = 20, WORK_LONGER_MAX = 8 };

/** A subject at a level. */
typedef struct work_job {
  const study_subject *subject;
  char setting[SETTING_SIZE];     /**< "h=0.05" or "tol=1e-08" */
  study_level level;              /**< what the first run found */
  long repeats;                   /**< runs in one measurement */
  double cpu[ROUNDS_MAX];         /**< seconds of one run, in each round */
  spread seconds;                 /**< of all rounds; set when they are over */
  double preparation[ROUNDS_MAX]; /**< the part of them before the first part; NaN if not known */
  double preparation_seconds;     /**< median of all rounds; set when they are over */
} work_job;

/** All jobs, in the order of the table: all levels of one subject, then of the next. */
typedef struct work {
  const char *command;  /**< that complains of what is default: "bench" */
  const char *shown;    /**< beside the progress: "dvi bench" */
  double judge_error;   /**< of what is taken for the solution */
  const numbers *asked; /**< errors whose cost is asked for */
  long rounds;
  progress_line *progress; /**< shown while they are measured */
  int jobs, room;
  work_job *job; /**< [room] */
  double sample[ROUNDS_MAX];
  spread calibration; /**< of the machine, once a round; set when they are over */
} work;

/** The smallest error that is asked for; infinite if none is. */
double work_smallest_asked(const numbers *asked);

/** Add a level of a subject. One that has no result is left out with a word, and DVI_OK
 *  returned. */
dvi_status work_add(work *w, const study_subject *subject, double refinement);

/** Add levels: so many of them, or, for 0, six, with larger parts as far as they are about as good,
 *  and smaller ones to the smallest asked error. Where they lie is searched with `search`, of equal
 *  parts. *lost: the search found nothing, and nothing is added. */
dvi_status work_add_levels(work *w, const study_subject *search, const study_subject *subject,
                           int levels, bool *lost);

/** Add a subject at tolerances, descending: the first `always`, and the others until the smallest
 * asked error is met. A level that fails in any way is left out. */
void work_add_tolerances(work *w, const study_subject *subject, int count, const double *tolerance,
                         int always);

/** Measure: every round runs every job once, so that whatever slows the machine for a while slows
 * all of them. `calibrate` measures the machine; NULL: nothing does. */
dvi_status work_run(work *w, double (*calibrate)(void));

/** One past the last job of the subject that job `first` belongs to, by its name. */
int work_group_end(const work *w, int first);
#endif
