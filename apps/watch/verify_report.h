/** What --verify tells: a table of digits, and how it came to them. */
#ifndef VERIFY_REPORT_H
#define VERIFY_REPORT_H
#include "csv/columns.h"
#include "study/trust_levels.h"
#include "watch/run_request.h"

/** The other method is asked for systems up to here. */
enum { WITNESS_COORDINATES = 500 };

/** Numbers of an end: t, q, p, and the shown columns. */
typedef struct trust_numbers {
  int count;
  const double *value, *size, *error; /**< [count] size: the largest magnitude on the way */
} trust_numbers;

/** How the runs went. */
typedef struct verify_verdict {
  trust_verdict trust; /**< the witness is the other method */
  bool by_event;       /**< an event ended a run */
  bool too_large;      /**< the system, for the other method */
} verify_verdict;

/** Print the table, or write it as CSV, and the verdict. Returns DONE, CHECK_FAILED for fewer
 *  digits than are asked for, or FAILED. */
int verify_tell(const run_request *request, const problem *scene, const dvi_integrator *integrator,
                const run_columns *columns, const trust_numbers *numbers,
                const verify_verdict *verdict);
#endif
