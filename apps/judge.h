/** The judge of a study: where the solution truly is at the end. */
#ifndef JUDGE_H
#define JUDGE_H
#include "problem.h"

/** The best answer there is, and how good it is. */
typedef struct judgement {
  const char *kind; /**< what it rests on, in words */
  double *q, *p;    /**< [n], owned */
  double error;     /**< its own error in q, in the maximum norm */
} judgement;

/** Ask the exact solution; or the problem's own digits, if parameters and time are theirs; or IDA.
 *
 *  @retval DVI_REFERENCE_FAILED  only IDA could be asked, and it failed */
dvi_status judge_init(judgement *judge, const problem *scene, double t_end);

/** Free what judge_init made; allowed on a judge that is all zero. */
void judge_clear(judgement *judge);

/** Distance of q [n] from the judge's answer, in the maximum norm. */
double judge_error(const judgement *judge, const problem *scene, const double *q);
#endif
