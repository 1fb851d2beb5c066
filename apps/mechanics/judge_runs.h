/** Two Galerkin runs that agree: the judge of spans that are too long for IDA. */
#ifndef JUDGE_RUNS_H
#define JUDGE_RUNS_H
#include "mechanics/judge.h"

/** Run degree 16, and degree 12 with other steps, with ever smaller steps until the ends of two
 * levels come no closer: fills other, which it allocates, and q, error and words.
 *
 *  @retval DVI_NO_MEMORY
 *  @return of the last failure, if not one pair of runs came to the end */
dvi_status judge_by_runs(judgement *judge, const problem *scene, double t_end,
                         progress_line *progress);
#endif
