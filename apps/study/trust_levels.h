/** The number of trusted digits of a result. It is found from the result at a level and at two
 * finer levels, and from a witness, which is another subject with the same result. */
#ifndef TRUST_LEVELS_H
#define TRUST_LEVELS_H
#include "study/subject.h"
#include "study/trust.h"

/** Numbers of a result whose errors turn into each other and fall together, such as coordinates or
 * momenta. */
typedef struct trust_group {
  const char *name;
  int first, count;
} trust_group;

/** The verdict on a result. */
typedef struct trust_verdict {
  double ratio;         /**< factor by which the errors of the groups fell from level to level */
  bool witness;         /**< there is a witness */
  const char *part;     /**< name of the judged group */
  double apart;         /**< distance of the witness from the result in the group */
  double witness_error; /**< witness's own error in the group */
  bool contradicted;    /**< the distance is too large */
} trust_verdict;

/** Results, as numbers. The vectors have room for `count` of them, and belong to the caller. */
typedef struct trust_study {
  int count;
  double *number[TRUST_LEVELS];  /**< numbers of the subject, the first level first */
  double *witness[TRUST_LEVELS]; /**< numbers of the witness, the finest one first */
  double *witness_error;         /**< remaining uncertainty of the witness */
  double *size;                  /**< largest magnitudes during the run, set by the caller */
  double *error;                 /**< errors of the first level's numbers */
  const trust_group *group;      /**< [2] only the second one may be empty */
  trust_verdict verdict;
} trust_study;

enum { TRUST_GROUPS = 2 };

/** Run the subject at its refinements 1, 2 and 4. Fills number. */
dvi_status trust_run(trust_study *t, const study_subject *subject);

/** Estimate the errors. Fills error and the verdict's ratio. */
void trust_estimate(trust_study *t);

/** Run the witness at its refinements 1, 10 and 1/10, which show its own error, and compare. The
 * larger error counts, as far as the witness's own error leaves it certain. Without a result the
 * verdict says that there is no witness. */
void trust_hear(trust_study *t, const study_subject *witness);
#endif
