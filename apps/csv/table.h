/** Tables: written for people, with aligned columns, or as CSV with all 17 digits. */
#ifndef TABLE_H
#define TABLE_H
#include <stdbool.h>
#include <stdio.h>

/** One column. */
typedef struct table_column {
  const char *title;
  /** how people read its numbers: "%.3e"; "": they stand in CSV alone; NULL: a column of text */
  const char *format;
} table_column;

typedef struct result_table result_table;

/** A table without rows. The columns, ended by one without a title, must outlive it. NULL without
 * memory. */
result_table *table_create(const table_column *columns);
void table_destroy(result_table **table);

/** Fill the next cell, row by row. A NaN makes an empty cell. Without memory the table remembers
 * and table_good is false. */
void table_number(result_table *table, double number);
void table_text(result_table *table, const char *text);

/** Whether no cell was lost for want of memory; complains if so. */
bool table_good(const result_table *table);

int table_rows(const result_table *table);

/** Its parts: the title of a column; a cell of a column of numbers, NaN if it is empty; one of a
 * column of text. */
const char *table_title(const result_table *table, int column);
double table_number_at(const result_table *table, int row, int column);
const char *table_text_at(const result_table *table, int row, int column);

/** Write all of it as CSV (RFC 4180, lines ended by a plain newline). */
void table_csv(const result_table *table, FILE *stream);

/** Write that into a file, whole or not at all; "-" is standard output. False, with a complaint, if
 * it cannot be. */
bool table_write(const result_table *table, const char *path);

/** Print to a stream rows first to last-1 from column `skip` on, but for those of CSV alone,
 * aligned, under their titles. */
void table_print(const result_table *table, FILE *stream, int skip, int first, int last);

/** Write one CSV field: quoted if it must be. */
void csv_text(FILE *stream, const char *text);
#endif
