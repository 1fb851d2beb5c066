/** The rows of a run, which become lines of CSV, or rows in a file of HDF5. */
#ifndef ROW_OUTPUT_H
#define ROW_OUTPUT_H
#include <stdbool.h>

#include "module/store.h"

/** Where rows go. All zero is nowhere. */
typedef struct row_output {
  const char *path;
  whole_file file; /**< of CSV, or of HDF5 before its first row */
  hdf5_rows *rows; /**< of HDF5, or NULL */
  int columns;
  double *row;      /**< [columns] to be filled in before a row is added */
  bool is_appended; /**< the file has rows of an earlier run */
  bool has_row;     /**< and the last one is that of the state */
  bool lost;        /**< a row could not be written, which was told */
} row_output;

/** Open a file, or standard output ("-"), and write the head. With a state the rows are appended to
 * those of the run that led to it, if the file is one of HDF5 and there; else, and with NULL, the
 * file begins anew. Complains and returns false if that is impossible. Call row_output_close
 * afterwards in any case. */
bool row_output_open(row_output *out, const char *path, const hdf5_head *head,
                     const hdf5_state *state);

/** Write the row. Complains and returns false if it is lost; main complains about standard
 * output. */
bool row_output_add(row_output *out);

/** Let a file of HDF5 have all rows, even if the process is killed. */
bool row_output_flush(row_output *out);

/** Close the output. CSV that is not kept leaves what was in its place, and HDF5 keeps its rows.
 * Complains and returns false if rows that are kept are lost. */
bool row_output_close(row_output *out, bool keep);
#endif
