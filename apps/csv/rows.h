/** Files of rows: CSV files, which are read as lines of any length, and their fields. The rows of a
 * file of HDF5 are numbers, which are spelled as the same run's lines of CSV. */
#ifndef ROWS_H
#define ROWS_H
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "csv/row_source.h"

enum { FIELD_SIZE = 64 };

/** A file being read. */
typedef struct row_file {
  const char *path;
  FILE *stream;
  char *line; /**< last line that was read */
  size_t size;
  int row;           /**< number of the line, from 1 */
  bool is_hdf5;      /**< the rows come from the source, and there is no stream */
  row_source source; /**< a file of HDF5 */
} row_file;

/** Open a file for reading: one of HDF5 if its name ends in .h5. The path "-" is standard input.
 * Complains and returns false if it cannot be read. */
bool rows_open(row_file *file, const char *path);

/** Refuse a file that is the table of a sweep, as far as that can be told, where the rows of a run
 * are wanted. Returns DONE, or complains and returns the exit code. */
int rows_of_run(const char *command, const row_file *file);

/** Read the next line of any length. Returns false at the end, and if the file cannot be read. */
bool rows_next(row_file *file);

/** Read the next row of a file of HDF5 as numbers [columns], after the header. They stay until the
 * next call. Returns NULL at the end, and if the file cannot be read. */
const double *rows_numbers(row_file *file);

/** Complain and return false if the reading did not end at the end of the file. */
bool rows_complete(const row_file *file);

void rows_close(row_file *file);

/** Copy the next field of a line. *text moves behind its comma, or becomes NULL at the end. */
void rows_field(const char **text, char field[FIELD_SIZE]);
#endif
