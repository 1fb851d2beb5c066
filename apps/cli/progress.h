/** How far a long computation is, on standard error, if that is a terminal. */
#ifndef PROGRESS_H
#define PROGRESS_H
#include <stdbool.h>

/** All zero: silent. */
typedef struct progress_line {
  bool shown, dirty;    /**< a terminal is there; a line stands on it */
  double began, spoken; /**< seconds of the monotonic clock */
} progress_line;

/** Start the clock. `shown` false keeps silent even on a terminal, for output that goes to the same
 * one. */
void progress_start(progress_line *progress, bool shown);

/** Say `what`, the fraction done (negative: unknown) and the time left, a few times a second at
 * most. */
void progress_show(progress_line *progress, double fraction, const char *what);

/** Wipe the line. */
void progress_end(progress_line *progress);
#endif
