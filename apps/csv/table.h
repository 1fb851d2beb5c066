/** Tables, printed with aligned columns, or written as CSV with all 17 digits. */
#ifndef TABLE_H
#define TABLE_H
#include <stdbool.h>
#include <stdio.h>

/** One column. */
typedef struct table_column {
  const char *title;
  /** format of printed numbers, such as "%.3e". "" for a column of CSV files only, NULL for
   * text. */
  const char *format;
} table_column;

typedef struct result_table result_table;

/** Create a table without rows. The columns, which end with one without a title, must outlive it.
 * NULL without memory. */
result_table *table_create(const table_column *columns);
void table_destroy(result_table **table);

/** Fill the next cell, row by row. A NaN makes an empty cell. A failed allocation is remembered,
 * and table_good returns false. */
void table_number(result_table *table, double number);
void table_text(result_table *table, const char *text);

/** Fill the next two cells, of a table whose rows have a name and a number. */
void table_quantity(result_table *table, const char *name, double value);

/** Return whether all cells had memory. Complains if not. */
bool table_good(const result_table *table);

int table_rows(const result_table *table);

/** Return the title of a column, a number (NaN if its cell is empty), or a text of a column of
 * text. */
const char *table_title(const result_table *table, int column);
double table_number_at(const result_table *table, int row, int column);
const char *table_text_at(const result_table *table, int row, int column);

/** Write the table as CSV (RFC 4180, lines ended by a plain newline). */
void table_csv(const result_table *table, FILE *stream);

/** Write the CSV into a file, whole or not at all. The path "-" is standard output. Complains and
 * returns false if it cannot be written. */
bool table_write(const result_table *table, const char *path);

/** Write the table as table_write does if all cells had memory, and destroy it in any case. */
bool table_finish(result_table **table, const char *path);

/** Print the rows first to last-1 from column `skip` on, aligned under their titles. Columns of CSV
 * files only are left out. */
void table_print(const result_table *table, FILE *stream, int skip, int first, int last);

/** Write one CSV field, quoted if necessary. */
void csv_text(FILE *stream, const char *text);
#endif
