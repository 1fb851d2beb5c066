/** CSV files that are read as lines of any length, and their fields. */
#ifndef ROWS_H
#define ROWS_H
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { FIELD_SIZE = 64 };

/** A file being read. */
typedef struct row_file {
  const char *path;
  FILE *stream;
  char *line; /**< last line that was read */
  size_t size;
  int row; /**< number of the line, from 1 */
} row_file;

/** Open a file for reading. The path "-" is standard input. Complains and returns false if it
 * cannot be read. */
bool rows_open(row_file *file, const char *path);

/** Read the next line of any length. Returns false at the end, and if the file cannot be read. */
bool rows_next(row_file *file);

/** Complain and return false if the reading did not end at the end of the file. */
bool rows_complete(const row_file *file);

void rows_close(row_file *file);

/** Copy the next field of a line. *text moves behind its comma, or becomes NULL at the end. */
void rows_field(const char **text, char field[FIELD_SIZE]);
#endif
