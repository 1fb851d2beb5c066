#include "varied/fit_data.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"
#include "csv/rows.h"

/* Kinds of columns beside those that measure. */
enum { OF_TIME = -1, SKIPPED = -2 };

typedef struct reader {
  row_file file;
  const problem *scene;
  const char *columns; /* those that are asked for, or NULL */
  int fields;
  int *of_field; /* [fields] column of the data, OF_TIME or SKIPPED */
  int has_time;
  double *row; /* [columns] */
} reader;

void fit_data_clear(fit_data *data)
{
  free(data->state);
  free(data->t);
  free(data->value);
  *data = (fit_data){0};
}

static int state_of_title(const problem *scene, const char *title)
{
  for (int i = 0; i < scene->nq; i++) {
    if (strcmp(title, scene->coordinate[i]) == 0) return i;
    if (strcmp(title, scene->momentum[i]) == 0) return scene->nq + i;
  }
  return -1;
}

/* Tell whether a title is in the list of columns. Without a list all are. */
static bool is_wanted(const char *columns, const char *title)
{
  char field[FIELD_SIZE];
  const char *text = columns;
  while (text != NULL) {
    rows_field(&text, field);
    if (strcmp(field, title) == 0) return true;
  }
  return columns == NULL;
}

/* ---- the header ---- */

static int add_column(reader *r, fit_data *read, const char *title, int *column)
{
  const int state = state_of_title(r->scene, title);
  if (state < 0)
    return usage_error("fit: '%s': line %d: column '%s' is no coordinate and no momentum of %s; "
                       "name those to be used by --columns",
                       r->file.path, r->file.row, title, r->scene->name);
  for (int c = 0; c < read->columns; c++)
    if (read->state[c] == state)
      return usage_error("fit: '%s': line %d: two columns '%s'", r->file.path, r->file.row, title);
  int *grown = realloc(read->state, ((size_t)read->columns + 1) * sizeof *grown);
  if (grown == NULL) return complain("out of memory"), FAILED;
  read->state = grown;
  *column = read->columns;
  read->state[read->columns++] = state;
  return DONE;
}

static int read_title(reader *r, fit_data *read, const char *title)
{
  int *grown = realloc(r->of_field, ((size_t)r->fields + 1) * sizeof *grown);
  if (grown == NULL) return complain("out of memory"), FAILED;
  r->of_field = grown;
  int *column = &r->of_field[r->fields++];
  if (strcmp(title, "t") == 0) {
    if (r->has_time++)
      return usage_error("fit: '%s': line %d: two columns 't'", r->file.path, r->file.row);
    *column = OF_TIME;
    return DONE;
  }
  *column = SKIPPED;
  return is_wanted(r->columns, title) ? add_column(r, read, title, column) : DONE;
}

static int read_header(reader *r, fit_data *read)
{
  char title[FIELD_SIZE];
  int code = DONE, wanted = 0;
  if (!rows_next(&r->file))
    return rows_complete(&r->file) ? usage_error("fit: '%s' is empty", r->file.path) : FAILED;
  for (const char *text = r->file.line; text != NULL && code == DONE;) {
    rows_field(&text, title);
    code = read_title(r, read, title);
  }
  for (const char *text = r->columns; text != NULL; wanted++) rows_field(&text, title);
  if (code != DONE) return code;
  if (!r->has_time)
    return usage_error("fit: '%s': line %d: there is no column 't'", r->file.path, r->file.row);
  if (read->columns == 0 || (r->columns != NULL && wanted != read->columns))
    return usage_error("fit: '%s': line %d: %d of the %d columns that are asked for are there",
                       r->file.path, r->file.row, read->columns, wanted);
  r->row = calloc((size_t)read->columns, sizeof *r->row);
  return r->row != NULL ? DONE : (complain("out of memory"), FAILED);
}

/* ---- the rows ---- */

static int grow(fit_data *read)
{
  if (read->rows < read->capacity) return DONE;
  if (read->capacity > INT_MAX / 2) return complain("fit: too many rows"), FAILED;
  const int capacity = read->capacity > 0 ? 2 * read->capacity : 64;
  double *t = realloc(read->t, (size_t)capacity * sizeof *t);
  if (t != NULL) read->t = t;
  const size_t columns = read->columns > 0 ? (size_t)read->columns : 1;
  double *value = realloc(read->value, (size_t)capacity * columns * sizeof *value);
  if (value != NULL) read->value = value;
  if (t == NULL || value == NULL) return complain("out of memory"), FAILED;
  read->capacity = capacity;
  return DONE;
}

static int keep_row(const reader *r, fit_data *read, double t)
{
  if (t < 0)
    return usage_error("fit: '%s': line %d: the time %g comes before the start at 0", r->file.path,
                       r->file.row, t);
  if (read->rows > 0 && !(t > read->t[read->rows - 1]))
    return usage_error("fit: '%s': line %d: the time %g does not come after %g", r->file.path,
                       r->file.row, t, read->t[read->rows - 1]);
  const int code = grow(read);
  if (code != DONE) return code;
  memcpy(read->value + (size_t)read->rows * (size_t)read->columns, r->row,
         (size_t)read->columns * sizeof *r->row);
  read->t[read->rows++] = t;
  return DONE;
}

static int read_row(reader *r, fit_data *read)
{
  char field[FIELD_SIZE];
  double t = 0.0;
  int at = 0;
  const char *text = r->file.line;
  for (; text != NULL && at < r->fields; at++) {
    rows_field(&text, field);
    const int column = r->of_field[at];
    if (column != SKIPPED && !parse_number(field, column == OF_TIME ? &t : &r->row[column]))
      return usage_error("fit: '%s': line %d: '%s' is no number", r->file.path, r->file.row, field);
  }
  if (text != NULL || at < r->fields)
    return usage_error("fit: '%s': line %d does not have the header's %d fields", r->file.path,
                       r->file.row, r->fields);
  return keep_row(r, read, t);
}

int fit_data_read(const char *path, const problem *scene, const char *columns, fit_data *read)
{
  reader r = {.scene = scene, .columns = columns};
  int code = rows_open(&r.file, path) ? rows_of_run("fit", &r.file) : FAILED;
  if (code == DONE) code = read_header(&r, read);
  while (code == DONE && rows_next(&r.file)) code = read_row(&r, read);
  if (code == DONE && !rows_complete(&r.file)) code = FAILED;
  if (code == DONE && read->rows == 0) code = usage_error("fit: '%s' has no rows", path);
  rows_close(&r.file);
  free(r.of_field);
  free(r.row);
  return code;
}
