/** The rows of an unfinished sweep, or of a part of a sweep, in a file beside the sweep's own. An
 * interrupted sweep is continued from there. */
#ifndef SWEEP_PART_H
#define SWEEP_PART_H
#include "sweep/sweep_lines.h"

/** The file, FILE.part for a sweep without parts, and FILE.K-of-N for part K/N. */
typedef struct sweep_part {
  char *path;
  FILE *stream;
  char head[SWEEP_HEAD_SIZE];
} sweep_part;

/** Open the file for `out` and read its rows into row [points], which are empty before. Complains
 * and returns false if the file is another sweep's, if another process writes it, or if it cannot
 * be written. */
bool sweep_part_open(sweep_part *part, const char *out, const sweep_key *key, long points,
                     sweep_row *row);

/** Add a row. Complains and returns false if it cannot be written. */
bool sweep_part_add(sweep_part *part, long k, const sweep_row *row);

/** Close the file, and remove it if its rows are elsewhere. */
void sweep_part_close(sweep_part *part, bool elsewhere);
#endif
