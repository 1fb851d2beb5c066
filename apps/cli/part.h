/** The part of a study that one process runs, where several share it. */
#ifndef PART_H
#define PART_H
#include <stdbool.h>

/** Part `part`, from 0, of so many: items part, part + parts, .. of the study. */
typedef struct study_part {
  long part, parts;
  bool given; /**< false if nothing was said, and the part is the whole */
} study_part;

/** Read "K/N", K from 1 to N, or "slurm" for this task of a Slurm job array, whose ids may begin
 * anywhere and have equal gaps. NULL is the whole. Returns DONE, or complains and returns USAGE. */
int study_part_read(const char *command, const char *text, study_part *read);

/** Return how many of `count` items are in a part. */
long study_part_size(const study_part *part, long count);
#endif
