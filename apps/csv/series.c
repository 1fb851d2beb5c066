#include "csv/series.h"

#include <ctype.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"
#include "cli/spelling.h"

/* Limit of the characters of a header in a message. */
enum { SHOWN = 200, HINT_SIZE = 128, ROWS_FIRST = 1024 };

/* The names of a header's columns. */
typedef struct title_list {
  int count;
  char (*title)[FIELD_SIZE];
} title_list;

int series_want(series_table *table, const char *name)
{
  for (int k = 0; k < table->columns; k++)
    if (strcmp(table->column[k].name, name) == 0) return k;
  series_column *grown = realloc(table->column,
                                 (size_t)(table->columns + 1) * sizeof *table->column);
  if (grown == NULL) {
    complain("out of memory");
    return -1;
  }
  table->column = grown;
  grown[table->columns] = (series_column){.field = -1};
  (void)snprintf(grown[table->columns].name, FIELD_SIZE, "%s", name);
  return table->columns++;
}

void series_clear(series_table *table)
{
  for (int k = 0; k < table->columns; k++) free(table->column[k].value);
  free(table->column);
  *table = (series_table){0};
}

/* ---- the header ---- */

static const char *header_title_at(int k, const void *list)
{
  const title_list *titles = list;
  return k < titles->count ? titles->title[k] : NULL;
}

/* Refuse a column that the header lacks. The message names the nearest column, or else all columns
 * as far as a line holds them. */
static int refuse_missing_column(const char *command, const row_file *file, int columns,
                                 const char *name)
{
  char hint[HINT_SIZE] = "";
  title_list titles = {.title = calloc((size_t)columns, sizeof *titles.title)};
  const char *text = file->line;
  while (titles.title != NULL && text != NULL && titles.count < columns)
    rows_field(&text, titles.title[titles.count++]);
  (void)suggestion(name, header_title_at, &titles, hint, sizeof hint);
  free(titles.title);
  if (hint[0] != '\0')
    return usage_error("%s: '%s' has no column '%s'%s", command, file->path, name, hint);
  int length = 0;
  while (file->line != NULL && length < SHOWN && isprint((unsigned char)file->line[length]))
    length++;
  return usage_error("%s: '%s' has no column '%s'; it has %.*s%s", command, file->path, name,
                     length, file->line != NULL ? file->line : "", length < SHOWN ? "" : "..");
}

/* Want all columns of a header. */
static bool want_titles(const char *header, series_table *table)
{
  char title[FIELD_SIZE];
  while (header != NULL) {
    rows_field(&header, title);
    if (title[0] != '\0' && series_want(table, title) < 0) return false;
  }
  return true;
}

/* Find the columns by name, and refuse the first one that is missing. */
static int find_columns(const char *command, row_file *file, series_table *table)
{
  char title[FIELD_SIZE];
  int field = 0;
  if (!rows_next(file))
    return rows_complete(file) ? usage_error("%s: '%s' is empty", command, file->path) : FAILED;
  if (table->columns == 0 && !want_titles(file->line, table)) return FAILED;
  const char *text = file->line;
  do {
    rows_field(&text, title);
    for (int k = 0; k < table->columns; k++)
      if (strcmp(title, table->column[k].name) == 0) table->column[k].field = field;
    field++;
  } while (text != NULL);
  for (int k = 0; k < table->columns; k++)
    if (table->column[k].field < 0)
      return refuse_missing_column(command, file, field, table->column[k].name);
  return DONE;
}

/* ---- rows ---- */

static bool series_grow(series_table *table)
{
  if (table->rows < table->capacity) return true;
  if (table->capacity > INT_MAX / 2)
    return complain("%d rows are too many", table->rows + 1), false;
  const int capacity = table->capacity > 0 ? 2 * table->capacity : ROWS_FIRST;
  for (int k = 0; k < table->columns; k++) {
    double *grown = realloc(table->column[k].value, (size_t)capacity * sizeof *grown);
    if (grown == NULL) {
      complain("out of memory for %d rows", capacity);
      return false;
    }
    table->column[k].value = grown;
  }
  table->capacity = capacity;
  return true;
}

static void read_row(const char *text, series_table *table)
{
  char cell[FIELD_SIZE];
  for (int k = 0; k < table->columns; k++) table->column[k].value[table->rows] = (double)NAN;
  for (int field = 0; text != NULL; field++) {
    double number;
    rows_field(&text, cell);
    if (!parse_number(cell, &number)) continue;
    for (int k = 0; k < table->columns; k++)
      if (table->column[k].field == field) table->column[k].value[table->rows] = number;
  }
  table->rows++;
}

/* Take a row of numbers. Infinite ones are none, as in CSV. */
static void take_row(const double *number, series_table *table)
{
  for (int k = 0; k < table->columns; k++) {
    const double value = number[table->column[k].field];
    table->column[k].value[table->rows] = isfinite(value) ? value : (double)NAN;
  }
  table->rows++;
}

static int read_rows(row_file *file, series_table *table)
{
  const double *number = NULL;
  while (file->is_hdf5 ? (number = rows_numbers(file)) != NULL : rows_next(file)) {
    if (!series_grow(table)) return FAILED;
    if (number != NULL)
      take_row(number, table);
    else
      read_row(file->line, table);
  }
  return rows_complete(file) ? DONE : FAILED;
}

int series_read(const char *command, const char *path, series_table *table)
{
  row_file file;
  int code = rows_open(&file, path) ? DONE : FAILED;
  if (code == DONE && table->of_run) code = rows_of_run(command, &file);
  if (code == DONE) code = find_columns(command, &file, table);
  if (code == DONE) code = read_rows(&file, table);
  rows_close(&file);
  return code;
}
