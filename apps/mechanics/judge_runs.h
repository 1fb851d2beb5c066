/** Two Galerkin runs that agree, as the judge of spans that are too long for IDA. */
#ifndef JUDGE_RUNS_H
#define JUDGE_RUNS_H
#include "mechanics/judge.h"

/** Run degree 16, and degree 12 with other steps. Schroedinger's equation with many
 * coordinates is marched by gauss of 6 and 5 stages. Steps get smaller until the ends of two levels
 * come no closer. Fills q, error and words, and allocates and fills other.
 *
 *  @retval DVI_NO_MEMORY
 *  @return the last failure, if no pair of runs came to the end */
dvi_status judge_by_runs(judgement *judge, const problem *scene, double t_end,
                         progress_line *progress);
#endif
