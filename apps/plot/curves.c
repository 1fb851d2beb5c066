#include "plot/curves.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/spelling.h"

/* Limit of the characters of a header in a message. */
enum { SHOWN = 200, HINT_SIZE = 128 };

/* The names of a header's columns. */
typedef struct title_list {
  int count;
  char (*title)[FIELD_SIZE];
} title_list;

static int curves_ask_pair(const char *pair, int panel, curve_list *list)
{
  if (list->curves == WORDS_MAX) return usage_error("plot: more than %d curves", (int)WORDS_MAX);
  curve_points *curve = &list->curve[list->curves++];
  *curve = (curve_points){.panel = panel, .x_column = -1, .y_column = -1};
  const char *colon = strchr(pair, ':'), *y = colon != NULL ? colon + 1 : pair;
  (void)snprintf(curve->x_name, FIELD_SIZE, "%.*s", colon != NULL ? (int)(colon - pair) : 1,
                 colon != NULL ? pair : "t");
  (void)snprintf(curve->y_name, FIELD_SIZE, "%s", y);
  if (curve->x_name[0] != '\0' && curve->y_name[0] != '\0') return DONE;
  return usage_error("plot: --axes wants columns, X:Y, for example x:y, or t:energy, not '%s'",
                     pair);
}

int curves_ask(const words *asked, curve_list *list)
{
  char pair[FIELD_SIZE];
  *list = (curve_list){.panels = asked->count};
  if (asked->count == 0)
    return usage_error("plot: --axes X:Y is missing: which columns are drawn against each other");
  for (int k = 0; k < asked->count; k++)
    for (const char *text = asked->word[k]; text != NULL;) {
      rows_field(&text, pair);
      if (curves_ask_pair(pair, k, list) != DONE) return USAGE;
    }
  return DONE;
}

static const char *header_title_at(int k, const void *list)
{
  const title_list *titles = list;
  return k < titles->count ? titles->title[k] : NULL;
}

/* Refuse a column that the header lacks. The message names the nearest column, or else all columns
 * as far as a line holds them. */
static int refuse_missing_column(const row_file *file, int columns, const char *name)
{
  char hint[HINT_SIZE] = "";
  title_list titles = {.title = calloc((size_t)columns, sizeof *titles.title)};
  const char *text = file->line;
  while (titles.title != NULL && text != NULL && titles.count < columns)
    rows_field(&text, titles.title[titles.count++]);
  (void)suggestion(name, header_title_at, &titles, hint, sizeof hint);
  free(titles.title);
  if (hint[0] != '\0')
    return usage_error("plot: '%s' has no column '%s'%s", file->path, name, hint);
  int length = 0;
  while (file->line != NULL && length < SHOWN && isprint((unsigned char)file->line[length]))
    length++;
  return usage_error("plot: '%s' has no column '%s'; it has %.*s%s", file->path, name, length,
                     file->line != NULL ? file->line : "", length < SHOWN ? "" : "..");
}

/* Find the columns by name, and refuse the first one that is missing. */
static int find_columns(row_file *file, curve_list *list)
{
  char title[FIELD_SIZE];
  if (!rows_next(file))
    return rows_complete(file) ? usage_error("plot: '%s' is empty", file->path) : FAILED;
  const char *text = file->line;
  int column = 0;
  do {
    rows_field(&text, title);
    for (int k = 0; k < list->curves; k++) {
      if (strcmp(title, list->curve[k].x_name) == 0) list->curve[k].x_column = column;
      if (strcmp(title, list->curve[k].y_name) == 0) list->curve[k].y_column = column;
    }
    column++;
  } while (text != NULL);
  for (int k = 0; k < list->curves; k++) {
    const curve_points *curve = &list->curve[k];
    if (curve->x_column >= 0 && curve->y_column >= 0) continue;
    return refuse_missing_column(file, column, curve->x_column < 0 ? curve->x_name : curve->y_name);
  }
  return DONE;
}

static bool curves_grow(curve_list *list)
{
  if (list->count < list->capacity) return true;
  const int capacity = list->capacity > 0 ? 2 * list->capacity : 1024;
  for (int k = 0; k < list->curves; k++) {
    curve_points *curve = &list->curve[k];
    double *x = realloc(curve->x, (size_t)capacity * sizeof *x);
    if (x != NULL) curve->x = x;
    double *y = x != NULL ? realloc(curve->y, (size_t)capacity * sizeof *y) : NULL;
    if (y == NULL) {
      complain("out of memory for %d points", capacity);
      return false;
    }
    curve->y = y;
  }
  list->capacity = capacity;
  return true;
}

static void curves_read_row(const char *text, curve_list *list)
{
  char field[FIELD_SIZE];
  for (int k = 0; k < list->curves; k++)
    list->curve[k].x[list->count] = list->curve[k].y[list->count] = (double)NAN;
  for (int column = 0; text != NULL; column++) {
    double number;
    rows_field(&text, field);
    if (!parse_number(field, &number)) continue;
    for (int k = 0; k < list->curves; k++) {
      if (list->curve[k].x_column == column) list->curve[k].x[list->count] = number;
      if (list->curve[k].y_column == column) list->curve[k].y[list->count] = number;
    }
  }
  list->count++;
}

int curves_read(const char *path, curve_list *list)
{
  row_file file;
  int code = rows_open(&file, path) ? find_columns(&file, list) : FAILED;
  while (code == DONE && rows_next(&file)) {
    if (curves_grow(list))
      curves_read_row(file.line, list);
    else
      code = FAILED;
  }
  if (code == DONE && !rows_complete(&file)) code = FAILED;
  rows_close(&file);
  return code;
}

void curves_clear(curve_list *list)
{
  for (int k = 0; k < list->curves; k++) {
    free(list->curve[k].x);
    free(list->curve[k].y);
  }
  *list = (curve_list){0};
}
