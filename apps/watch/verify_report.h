/** The report of --verify, with a table of digits and the evidence. */
#ifndef VERIFY_REPORT_H
#define VERIFY_REPORT_H
#include "csv/columns.h"
#include "study/trust_levels.h"
#include "watch/run_request.h"

/** largest number of coordinates for which the other method is asked */
enum { WITNESS_COORDINATES = 500 };

/** The numbers of an end, which are t, q, p, and the shown columns. */
typedef struct trust_numbers {
  int count;
  const double *value, *size, *error; /**< [count] size is the largest magnitude during the run */
} trust_numbers;

/** The outcome of the runs. */
typedef struct verify_verdict {
  trust_verdict trust; /**< the witness is the other method */
  bool by_event;       /**< an event ended a run */
  bool too_large;      /**< the system is too large for the other method */
  bool refused;        /**< the other method does not take the system */
} verify_verdict;

/** Print the table, or write it as CSV, and the verdict. Returns DONE, CHECK_FAILED for fewer
 * digits than were asked for, or FAILED. */
int verify_tell(const run_request *request, const problem *scene, const dvi_integrator *integrator,
                const run_columns *columns, const trust_numbers *numbers,
                const verify_verdict *verdict);
#endif
