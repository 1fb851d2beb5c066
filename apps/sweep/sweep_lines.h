/** The text of a file that keeps rows of a sweep in the order in which they are found. A head says
 * which sweep, and which part of it. Each line has a sum, which reveals a line that was cut
 * short. */
#ifndef SWEEP_LINES_H
#define SWEEP_LINES_H
#include <stdint.h>

#include "cli/part.h"
#include "sweep/sweep_point.h"

enum { SWEEP_HEAD_SIZE = 256 };

/** Everything that decides about the rows of a file, beside the version of dvi. */
typedef struct sweep_key {
  study_part part;
  uint64_t scene; /**< sum of the problem with a scene's text and its components */
  uint64_t run;   /**< sum of the method, the step and the end */
  uint64_t grid;  /**< sum of the names and values of all axes */
} sweep_key;

/** The first difference between the key of a file and another one. */
typedef enum sweep_difference {
  SWEEP_SAME,
  SWEEP_NO_HEAD, /**< the file has no head */
  SWEEP_OTHER_VERSION,
  SWEEP_OTHER_SCENE,
  SWEEP_OTHER_RUN,
  SWEEP_OTHER_GRID
} sweep_difference;

/** Return the key of a part of a sweep. */
sweep_key sweep_key_of(const sweep_task *task, const study_part *part);

/** Spell a head, a line that ends with a newline, to head [SWEEP_HEAD_SIZE]. */
void sweep_head(const sweep_key *key, char *head);

/** Compare a file's first line with a key. Fills the part that the line names, unless there is no
 * head. */
sweep_difference sweep_compare(const char *head, const sweep_key *key, study_part *part);

/** Read lines up to the first one that is not complete into row [points]. Rows that are there
 * already are replaced.
 *
 *  @param head  the first line, which has been read
 *  @param[out] size  bytes of the lines that were read
 *  @return false without memory */
bool sweep_read_lines(FILE *stream, const char *head, const study_part *part, long points,
                      sweep_row *row, long *size);

/** Write a line. */
void sweep_write_line(FILE *stream, const char *head, long k, const sweep_row *row);
#endif
