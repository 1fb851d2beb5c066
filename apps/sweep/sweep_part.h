/** The rows of a sweep under way, in the file FILE.part beside FILE, from which an interrupted
 * sweep goes on. */
#ifndef SWEEP_PART_H
#define SWEEP_PART_H
#include <stdint.h>

#include "sweep/sweep_point.h"

/** The file. It is written row by row, in the order in which rows are found; its lines have a sum,
 * so that one that was cut short is known. */
typedef struct sweep_part {
  char *path;
  FILE *stream;
  uint64_t key; /**< of the sweep: rows of another one are not taken */
} sweep_part;

/** What makes a sweep the same: the version of dvi, the problem with a scene's text, the method,
 * the step, the end, all values. */
uint64_t sweep_key(const sweep_task *task);

/** Open the file for `out` and take the rows that are there into row [points], all empty before.
 *  False, with a complaint: it is another sweep's, or another process writes it, or it cannot be
 *  written. */
bool sweep_part_open(sweep_part *part, const char *out, uint64_t key, long points, sweep_row *row);

/** Add a row. False, with a complaint, if it cannot be written. */
bool sweep_part_add(sweep_part *part, long k, const sweep_row *row);

/** Close it, and remove it if the sweep is complete. */
void sweep_part_close(sweep_part *part, bool complete);
#endif
