#define _POSIX_C_SOURCE 200809L
#include "store/table_output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "module/store.h"

/* The cells of all lines, the header first. */
typedef struct cell_table {
  int columns;
  long lines;      /* with the header */
  char **cell;     /* [lines*columns], each a part of `text` */
  char **text;     /* [lines] */
  bool *is_text;   /* [columns] */
  double *number;  /* [rows * columns of numbers] */
  const char **of; /* [columns + rows * columns] names, and cells of text */
} cell_table;

/* ---- cells ---- */

/* Cut the next cell out of a line, without its quotes. Returns what follows its comma, or NULL. */
static char *cut_cell(char *line, char **cell)
{
  char *to = line;
  bool quoted = false;
  *cell = line;
  for (; *line != '\0' && (quoted || *line != ','); line++) {
    if (*line == '"' && quoted && line[1] == '"')
      *to++ = *line++;
    else if (*line == '"')
      quoted = !quoted;
    else
      *to++ = *line;
  }
  char *next = *line == ',' ? line + 1 : NULL;
  *to = '\0';
  return next;
}

static int count_cells(const char *line)
{
  int count = 1;
  bool quoted = false;
  for (; *line != '\0'; line++) {
    if (*line == '"') quoted = !quoted;
    if (*line == ',' && !quoted) count++;
  }
  return count;
}

static bool split(cell_table *table, long line, const char *text)
{
  char *rest = table->text[line] = strdup(text), **cell = table->cell + line * table->columns;
  if (rest == NULL) return false;
  char *const end = rest + strlen(rest);
  for (int j = 0; j < table->columns; j++) {
    cell[j] = end;
    if (rest != NULL) rest = cut_cell(rest, &cell[j]);
  }
  return true;
}

static void clear(cell_table *table)
{
  for (long i = 0; i < table->lines && table->text != NULL; i++) free(table->text[i]);
  free(table->text);
  free(table->cell);
  free(table->is_text);
  free(table->number);
  free(table->of);
}

static bool read_lines(cell_table *table, const char *header, long rows, const char *const *line)
{
  *table = (cell_table){.columns = count_cells(header), .lines = rows + 1};
  const size_t lines = (size_t)table->lines, columns = (size_t)table->columns;
  table->text = calloc(lines, sizeof *table->text);
  table->cell = calloc(lines * columns, sizeof *table->cell);
  table->is_text = calloc(columns, sizeof *table->is_text);
  table->number = calloc(lines * columns, sizeof *table->number);
  table->of = calloc((lines + 1) * columns, sizeof *table->of);
  if (!table->text || !table->cell || !table->is_text || !table->number || !table->of) return false;
  bool good = split(table, 0, header);
  for (long i = 0; i < rows && good; i++) good = split(table, i + 1, line[i]);
  return good;
}

/* ---- columns ---- */

/* A column is one of text if a cell is neither empty nor a number. */
static void find_kinds(cell_table *table)
{
  double number;
  for (long i = 1; i < table->lines; i++)
    for (int j = 0; j < table->columns; j++) {
      const char *cell = table->cell[i * table->columns + j];
      if (cell[0] != '\0' && !parse_number(cell, &number)) table->is_text[j] = true;
    }
}

/* List the names of the columns of one kind. Returns their number. */
static int list_names(const cell_table *table, bool is_text, const char **name)
{
  int count = 0;
  for (int j = 0; j < table->columns; j++)
    if (table->is_text[j] == is_text) name[count++] = table->cell[j];
  return count;
}

/* Put the cells of each kind one after the other. */
static void sort_cells(cell_table *table, const char **text)
{
  double *number = table->number;
  for (long i = 1; i < table->lines; i++)
    for (int j = 0; j < table->columns; j++) {
      const char *cell = table->cell[i * table->columns + j];
      if (table->is_text[j])
        *text++ = cell;
      else if (!parse_number(cell, number++))
        number[-1] = (double)NAN;
    }
}

static bool write_table(const char *path, const hdf5_head *head, const cell_table *table,
                        const hdf5_texts *texts)
{
  whole_file file;
  if (!store_begin(&file, path)) return false;
  const bool good = store_module(path)->write_table(file.temporary, head, table->lines - 1,
                                                    table->number, texts);
  if (good) return file_keep(&file);
  (void)store_refuse(path);
  file_discard(&file);
  return false;
}

bool table_output_write(const char *path, const fact_list *facts, const char *header, long rows,
                        const char *const *line)
{
  cell_table table = {.lines = 0};
  bool good = store_module(path) != NULL;
  if (good && !read_lines(&table, header, rows, line)) {
    complain("out of memory");
    good = false;
  }
  if (good) {
    find_kinds(&table);
    const int numbers = list_names(&table, false, table.of),
              columns = list_names(&table, true, table.of + numbers);
    const hdf5_head head = {.layout = "dvi table 1",
                            .facts = facts->count,
                            .fact = facts->fact,
                            .columns = numbers,
                            .column = table.of,
                            .expected = (double)rows};
    const hdf5_texts texts = {
        .columns = columns, .column = table.of + numbers, .cell = table.of + table.columns};
    sort_cells(&table, table.of + table.columns);
    good = write_table(path, &head, &table, &texts);
  }
  clear(&table);
  return good;
}
