/** The judge of a study, which knows the true solution at the end. */
#ifndef JUDGE_H
#define JUDGE_H
#include "problem.h"
#include "cli/progress.h"

enum { JUDGE_WORDS = 256 };

/** The kind of judge. */
typedef enum judge_kind {
  /** the first of the following kinds that is available, and of IDA and the runs the one with the
   * smaller error */
  JUDGE_AUTO,
  JUDGE_EXACT,  /**< the exact solution */
  JUDGE_STORED, /**< the catalogue's digits, for the problem's own parameters and end */
  JUDGE_IDA,    /**< IDA at two tolerances */
  JUDGE_RUNS    /**< two Galerkin runs of high degree, different in degree and step */
} judge_kind;

/** A request. All zero asks for the best judge. */
typedef struct judge_request {
  judge_kind kind;
  double wanted;           /**< error of IDA up to which JUDGE_AUTO does not ask the runs */
  progress_line *progress; /**< progress of the judge, or NULL */
} judge_request;

/** The best available answer, and its quality. */
typedef struct judgement {
  char words[JUDGE_WORDS]; /**< description of its basis */
  double *q;               /**< [n] owned */
  double *other;           /**< [n] owned second answer at the distance `error`, or NULL */
  double error;            /**< own error in q, in the maximum norm */
} judgement;

/** Read the name of a kind. Returns DONE, or complains about `where`, such as "bench: --judge", and
 * returns USAGE. */
int judge_read(const char *where, const char *name, judge_kind *kind);

/** Ask the judge. Returns DONE, or complains and returns the exit code if there is no such judge
 * for this problem and end, or if it failed. */
int judge_init(judgement *judge, const problem *scene, double t_end, const judge_request *request);

/** Free the memory of a judge. Allowed on a judge that is all zero. */
void judge_clear(judgement *judge);

/** Return the distance of q [n] from the judge's answer in the maximum norm, and from the farther
 * one if there are two. */
double judge_error(const judgement *judge, const problem *scene, const double *q);
#endif
