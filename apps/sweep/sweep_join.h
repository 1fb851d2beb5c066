/** The parts of a sweep, put together. */
#ifndef SWEEP_JOIN_H
#define SWEEP_JOIN_H
#include "cli/options.h"
#include "sweep/sweep_lines.h"

/** Read the files of all parts of a sweep into row [points], which are empty before. Complains and
 * returns false if a file cannot be read, or is no part of this sweep by this version of dvi, or is
 * not complete; and if a part is missing or given twice. */
bool sweep_join(const sweep_key *key, const word_list *files, long points, sweep_row *row);
#endif
