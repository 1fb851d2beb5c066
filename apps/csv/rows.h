/** CSV files that are read: lines of any length, and their fields. */
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
  char *line; /**< the last one that was read */
  size_t size;
  int row; /**< its number, from 1 */
} row_file;

/** Begin to read; path "-" is standard input. False, with a complaint, if it cannot be read. */
bool rows_open(row_file *file, const char *path);

/** The next line, however long. False at the end, and if it cannot be read. */
bool rows_next(row_file *file);

/** False, with a complaint, if the end was not that of the file. */
bool rows_complete(const row_file *file);

void rows_close(row_file *file);

/** The next field of a line; *text moves behind its comma, or becomes NULL at the end. */
void rows_field(const char **text, char field[FIELD_SIZE]);
#endif
