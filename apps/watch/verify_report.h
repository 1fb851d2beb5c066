/** What --verify tells: a table of digits, and how it came to them. */
#ifndef VERIFY_REPORT_H
#define VERIFY_REPORT_H
#include "csv/columns.h"
#include "watch/run_request.h"

/** The other method is asked for systems up to here. */
enum { WITNESS_COORDINATES = 500 };

/** Numbers of an end: t, q, p, and the shown columns. */
typedef struct trust_numbers {
  int count;
  const double *value, *size, *error; /**< [count] size: the largest magnitude on the way */
} trust_numbers;

/** How the levels and the other method went. */
typedef struct trust_verdict {
  double ratio;         /**< by which the errors of the state fell from level to level */
  bool by_event;        /**< an event ended a run */
  bool too_large;       /**< the system, for the other method */
  bool witness;         /**< the other method came to the end, */
  const char *part;     /**< in the coordinates, or the momenta, */
  double apart;         /**< so far from those of the first level, */
  double witness_error; /**< with such an error of its own, */
  bool contradicted;    /**< and that is too far */
} trust_verdict;

/** Print the table, or write it as CSV, and the verdict. Returns DONE, CHECK_FAILED for fewer
 *  digits than are asked for, or FAILED. */
int verify_tell(const run_request *request, const problem *scene, const dvi_integrator *integrator, const run_columns *columns,
                const trust_numbers *numbers, const trust_verdict *verdict);
#endif
