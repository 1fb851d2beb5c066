/** The rows of an unfinished sweep, in the file FILE.part beside FILE, from which an interrupted
 * sweep is continued. */
#ifndef SWEEP_PART_H
#define SWEEP_PART_H
#include <stdint.h>

#include "sweep/sweep_point.h"

/** The file. Rows are written in the order in which they are found. Each line has a sum, which
 * reveals a line that was cut short. */
typedef struct sweep_part {
  char *path;
  FILE *stream;
  uint64_t key; /**< key of the sweep. Rows of another sweep are not read. */
} sweep_part;

/** Return a key of the version of dvi, the problem with a scene's text, the method, the step, the
 * end, and all values. Sweeps with equal keys are the same. */
uint64_t sweep_key(const sweep_task *task);

/** Open the file for `out` and read its rows into row [points], which are empty before. Complains
 * and returns false if the file is another sweep's, if another process writes it, or if it cannot
 * be written. */
bool sweep_part_open(sweep_part *part, const char *out, uint64_t key, long points, sweep_row *row);

/** Add a row. Complains and returns false if it cannot be written. */
bool sweep_part_add(sweep_part *part, long k, const sweep_row *row);

/** Close the file, and remove it if the sweep is complete. */
void sweep_part_close(sweep_part *part, bool complete);
#endif
