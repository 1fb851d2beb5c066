/** The progress of a long computation, shown on standard error if that is a terminal. */
#ifndef PROGRESS_H
#define PROGRESS_H
#include <stdbool.h>

/** A progress line. All zero is silent. */
typedef struct progress_line {
  bool shown, dirty;    /**< standard error is a terminal, and a line stands on it */
  double began, spoken; /**< seconds of the monotonic clock */
} progress_line;

/** Start the clock. If `shown` is false, nothing is shown even on a terminal, for output that goes
 * to the same one. */
void progress_start(progress_line *progress, bool shown);

/** Show `what`, the fraction done (negative if unknown) and the time left, a few times a second at
 * most. */
void progress_show(progress_line *progress, double fraction, const char *what);

/** Clear the line. */
void progress_end(progress_line *progress);
#endif
