#include "csv/table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/file.h"

enum { CELL_TEXT = 32 };

typedef struct table_cell {
  char *text; /* owned, NULL for a number */
  double number;
} table_cell;

struct result_table {
  const table_column *column;
  int columns;
  int cells, capacity;
  table_cell *cell;
  bool lost;
};

result_table *table_create(const table_column *columns)
{
  result_table *t = calloc(1, sizeof *t);
  if (t == NULL) return NULL;
  t->column = columns;
  while (columns[t->columns].title != NULL) t->columns++;
  return t;
}

void table_destroy(result_table **table)
{
  if (*table == NULL) return;
  for (int i = 0; i < (*table)->cells; i++) free((*table)->cell[i].text);
  free((*table)->cell);
  free(*table);
  *table = NULL;
}

static table_cell *next_cell(result_table *t)
{
  if (t == NULL || t->lost) return NULL;
  if (t->cells == t->capacity) {
    const int capacity = t->capacity > 0 ? 2 * t->capacity : 128;
    table_cell *grown = realloc(t->cell, (size_t)capacity * sizeof *grown);
    if (grown == NULL) {
      t->lost = true;
      return NULL;
    }
    t->cell = grown;
    t->capacity = capacity;
  }
  table_cell *c = &t->cell[t->cells++];
  c->text = NULL;
  c->number = (double)NAN;
  return c;
}

void table_number(result_table *table, double number)
{
  table_cell *c = next_cell(table);
  if (c != NULL) c->number = number;
}

void table_text(result_table *table, const char *text)
{
  table_cell *c = next_cell(table);
  if (c == NULL) return;
  const size_t size = strlen(text) + 1;
  c->text = malloc(size);
  if (c->text == NULL)
    table->lost = true;
  else
    memcpy(c->text, text, size);
}

void table_quantity(result_table *table, const char *name, double value)
{
  table_text(table, name);
  table_number(table, value);
}

bool table_good(const result_table *table)
{
  if (table != NULL && !table->lost) return true;
  complain("out of memory while a table was built");
  return false;
}

int table_rows(const result_table *table)
{
  return table->cells / table->columns;
}

const char *table_title(const result_table *table, int column)
{
  return table->column[column].title;
}

double table_number_at(const result_table *table, int row, int column)
{
  return table->cell[row * table->columns + column].number;
}

const char *table_text_at(const result_table *table, int row, int column)
{
  return table->cell[row * table->columns + column].text;
}

void csv_text(FILE *stream, const char *text)
{
  if (strpbrk(text, ",\"\r\n") == NULL) {
    (void)fputs(text, stream);
    return;
  }
  (void)fputc('"', stream);
  for (; *text != '\0'; text++) {
    if (*text == '"') (void)fputc('"', stream);
    (void)fputc(*text, stream);
  }
  (void)fputc('"', stream);
}

void table_csv(const result_table *table, FILE *stream)
{
  for (int j = 0; j < table->columns; j++)
    (void)fprintf(stream, "%s%s", j > 0 ? "," : "", table->column[j].title);
  for (int i = 0; i < table->cells; i++) {
    const table_cell *c = &table->cell[i];
    (void)fputc(i % table->columns == 0 ? '\n' : ',', stream);
    if (c->text != NULL)
      csv_text(stream, c->text);
    else if (!isnan(c->number))
      (void)fprintf(stream, "%.17g", c->number);
  }
  (void)fputc('\n', stream);
}

bool table_write(const result_table *table, const char *path)
{
  whole_file csv;
  if (!file_open(&csv, path)) return false;
  table_csv(table, csv.stream);
  return file_keep(&csv);
}

bool table_finish(result_table **table, const char *path)
{
  const bool good = table_good(*table) && table_write(*table, path);
  table_destroy(table);
  return good;
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored \
    "-Wformat-nonliteral" /* the formats come from the tables of this program's own columns */
static const char *cell_text(const result_table *table, int row, int column, char *text)
{
  const table_cell *c = &table->cell[row * table->columns + column];
  if (c->text != NULL) return c->text;
  text[0] = '\0';
  if (!isnan(c->number) && table->column[column].format != NULL)
    (void)snprintf(text, CELL_TEXT, table->column[column].format, c->number);
  return text;
}
#pragma GCC diagnostic pop

static int column_width(const result_table *table, int column, int first, int last)
{
  char text[CELL_TEXT];
  size_t width = strlen(table->column[column].title);
  for (int row = first; row < last; row++) {
    const size_t length = strlen(cell_text(table, row, column, text));
    width = length > width ? length : width;
  }
  return (int)width;
}

static bool is_csv_only(const table_column *column)
{
  return column->format != NULL && column->format[0] == '\0';
}

/* Return the end of the columns that are printed for people. */
static int shown_end(const result_table *table)
{
  int end = table->columns;
  while (end > 0 && is_csv_only(&table->column[end - 1])) end--;
  return end;
}

/* Return the end of the columns of one row that hold anything. The titles stand in row first-1. */
static int row_end(const result_table *table, int first, int row)
{
  char text[CELL_TEXT];
  int end = shown_end(table);
  while (row >= first && end > 0 && cell_text(table, row, end - 1, text)[0] == '\0') end--;
  return end;
}

/* Print text to the left and numbers to the right, without blanks at the end of a line. */
static void print_cell(const result_table *table, FILE *stream, int column, int width, bool last,
                       const char *text)
{
  if (table->column[column].format != NULL)
    (void)fprintf(stream, "  %*s", width, text);
  else
    (void)fprintf(stream, "  %-*s", last ? 0 : width, text);
}

void table_print(const result_table *table, FILE *stream, int skip, int first, int last)
{
  char text[CELL_TEXT];
  for (int row = first - 1; row < last; row++) {
    const int end = row_end(table, first, row);
    for (int j = skip; j < end; j++)
      print_cell(table, stream, j, column_width(table, j, first, last), j + 1 == end,
                 row < first ? table->column[j].title : cell_text(table, row, j, text));
    (void)fputc('\n', stream);
  }
}
