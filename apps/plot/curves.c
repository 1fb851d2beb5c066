#include "plot/curves.h"

#include <stdio.h>
#include <string.h>

#include "cli/command.h"

static int curves_ask_pair(const char *pair, int panel, curve_list *list)
{
  char x[FIELD_SIZE], y[FIELD_SIZE];
  if (list->curves == WORDS_MAX) return usage_error("plot: more than %d curves", (int)WORDS_MAX);
  const char *colon = strchr(pair, ':');
  (void)snprintf(x, FIELD_SIZE, "%.*s", colon != NULL ? (int)(colon - pair) : 1,
                 colon != NULL ? pair : "t");
  (void)snprintf(y, FIELD_SIZE, "%s", colon != NULL ? colon + 1 : pair);
  if (x[0] == '\0' || y[0] == '\0')
    return usage_error("plot: --axes wants columns, X:Y, for example x:y, or t:energy, not '%s'",
                       pair);
  curve_points *curve = &list->curve[list->curves++];
  *curve = (curve_points){.panel = panel,
                          .x_column = series_want(&list->table, x),
                          .y_column = series_want(&list->table, y)};
  return curve->x_column < 0 || curve->y_column < 0 ? FAILED : DONE;
}

int curves_ask(const words *asked, curve_list *list)
{
  char pair[FIELD_SIZE];
  int code = DONE;
  *list = (curve_list){.panels = asked->count};
  if (asked->count == 0)
    return usage_error("plot: --axes X:Y is missing: which columns are drawn against each other");
  for (int k = 0; k < asked->count && code == DONE; k++)
    for (const char *text = asked->word[k]; text != NULL && code == DONE;) {
      rows_field(&text, pair);
      code = curves_ask_pair(pair, k, list);
    }
  if (code != DONE) curves_clear(list);
  return code;
}

int curves_read(const char *path, curve_list *list)
{
  const int code = series_read("plot", path, &list->table);
  if (code != DONE) return code;
  list->count = list->table.rows;
  for (int k = 0; k < list->curves; k++) {
    curve_points *curve = &list->curve[k];
    const series_column *x = &list->table.column[curve->x_column],
                        *y = &list->table.column[curve->y_column];
    curve->x_name = x->name;
    curve->y_name = y->name;
    curve->x = x->value;
    curve->y = y->value;
  }
  return DONE;
}

void curves_clear(curve_list *list)
{
  series_clear(&list->table);
  *list = (curve_list){0};
}
