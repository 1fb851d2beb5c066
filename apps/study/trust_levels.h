/** How many digits of a result can be trusted: the result at a level and at two finer ones, and
 * that of a witness, which is another subject with the same result. */
#ifndef TRUST_LEVELS_H
#define TRUST_LEVELS_H
#include "study/subject.h"
#include "study/trust.h"

/** Numbers of a result whose errors turn into each other, and fall together: coordinates,
 *  momenta. */
typedef struct trust_group {
  const char *name;
  int first, count;
} trust_group;

/** What was found. */
typedef struct trust_verdict {
  double ratio;         /**< by which the errors of the groups fell from level to level */
  bool witness;         /**< there is a witness, */
  const char *part;     /**< in this group, */
  double apart;         /**< so far from the result, */
  double witness_error; /**< with such an error of its own, */
  bool contradicted;    /**< and that is too far */
} trust_verdict;

/** Results, as numbers; the vectors have room for `count` of them, and are the caller's. */
typedef struct trust_study {
  int count;
  double *number[TRUST_LEVELS];  /**< of the subject, the first level first */
  double *witness[TRUST_LEVELS]; /**< of the witness, the finest one first */
  double *witness_error;         /**< what it leaves uncertain */
  double *size;                  /**< largest magnitudes on the way; the caller knows them */
  double *error;                 /**< what was found of the first level's numbers */
  const trust_group *group;      /**< [2], not empty but for the second one */
  trust_verdict verdict;
} trust_study;

enum { TRUST_GROUPS = 2 };

/** Run the subject at its refinements 1, 2 and 4: fills number. */
dvi_status trust_run(trust_study *t, const study_subject *subject);

/** Estimate the errors: fills error and the verdict's ratio. */
void trust_estimate(trust_study *t);

/** Run the witness at its refinements 1, 10 and 1/10, of which its own error is seen, and take its
 *  opinion: the larger error counts, as far as the witness's own leaves it certain. Without a
 * result the verdict says that there is none. */
void trust_hear(trust_study *t, const study_subject *witness);
#endif
