/** The judge of a study: where the solution truly is at the end. */
#ifndef JUDGE_H
#define JUDGE_H
#include "problem.h"
#include "cli/progress.h"

enum { JUDGE_WORDS = 256 };

/** Who is asked. */
typedef enum judge_kind {
  JUDGE_AUTO,   /**< the first of these that is there; of IDA and the runs the one of the smaller
                   error */
  JUDGE_EXACT,  /**< the exact solution */
  JUDGE_STORED, /**< the catalogue's digits, for the problem's own parameters and end */
  JUDGE_IDA,    /**< IDA at two tolerances */
  JUDGE_RUNS    /**< two Galerkin runs of high degree, different in degree and step */
} judge_kind;

/** What is asked for; all zero: the best judge that there is. */
typedef struct judge_request {
  judge_kind kind;
  double wanted;           /**< auto: with an error of IDA up to this the runs are not asked */
  progress_line *progress; /**< shown while the judge works; NULL: none */
} judge_request;

/** The best answer there is, and how good it is. */
typedef struct judgement {
  char words[JUDGE_WORDS]; /**< what it rests on */
  double *q;               /**< [n], owned */
  double
      *other; /**< [n], owned: a second answer, which is `error` away; NULL if there is one alone */
  double error; /**< its own error in q, in the maximum norm */
} judgement;

/** Read the name of a kind. Returns DONE; or complains, about `where` ("bench: --judge"), and
 * returns USAGE. */
int judge_read(const char *where, const char *name, judge_kind *kind);

/** Ask. Returns DONE, or complains and returns the exit code: there is no such judge for this
 * problem and end, or it failed. */
int judge_init(judgement *judge, const problem *scene, double t_end, const judge_request *request);

/** Free what judge_init made; allowed on a judge that is all zero. */
void judge_clear(judgement *judge);

/** Distance of q [n] from the judge's answer, in the maximum norm; from the farther one if there
 * are two. */
double judge_error(const judgement *judge, const problem *scene, const double *q);
#endif
