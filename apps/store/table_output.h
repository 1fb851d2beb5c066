/** A table of lines of CSV that becomes a file of HDF5. */
#ifndef TABLE_OUTPUT_H
#define TABLE_OUTPUT_H
#include "store/facts.h"

/** Write the lines [rows] below a header, as RFC 4180 has them, into a file, whole or not at all.
 * Columns of numbers, NaN where a cell is empty, become the dataset `rows`, others datasets of the
 * group `text`. Complains and returns false if that fails. */
bool table_output_write(const char *path, const fact_list *facts, const char *header, long rows,
                        const char *const *line);
#endif
