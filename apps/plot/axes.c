#include "plot/axes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/spelling.h"

enum { NAME_SIZE = 32, HINT_SIZE = 64, TITLE_SIZE = 160 };

static const char *table_title_at(int k, const void *list)
{
  return ((const table_column *)list)[k].title;
}

static int find_column(const char *command, const char *title, const table_column *columns,
                       int *column)
{
  for (*column = 0; columns[*column].title != NULL; ++*column)
    if (strcmp(columns[*column].title, title) == 0) break;
  if (columns[*column].title == NULL) {
    char hint[HINT_SIZE];
    return usage_error("%s: --axes: the table has no column '%s'%s; dvi %s --help has their names",
                       command, title,
                       suggestion(title, table_title_at, columns, hint, sizeof hint), command);
  }
  return columns[*column].format != NULL
             ? DONE
             : usage_error("%s: --axes: column '%s' has no numbers", command, title);
}

static int axes_read_pair(const char *command, const char *text, const table_column *columns,
                          axes_pair *pair)
{
  char name[NAME_SIZE];
  const size_t length = strcspn(text, ":");
  if (length == 0 || length >= sizeof name || text[length] == '\0' || text[length + 1] == '\0')
    return usage_error("%s: --axes wants two columns, X:Y, for example h:energy_error, not '%s'",
                       command, text);
  (void)snprintf(name, sizeof name, "%.*s", (int)length, text);
  const int code = find_column(command, name, columns, &pair->x);
  return code == DONE ? find_column(command, text + length + 1, columns, &pair->y) : code;
}

int axes_read(const char *command, const words *asked, const char *plot, const char *usual,
              const table_column *columns, plot_axes *axes)
{
  if (asked->count > 0 && plot == NULL)
    return usage_error("%s: --axes draws nothing without --plot FILE.svg", command);
  int code = axes_read_pair(command, usual, columns, &axes->usual);
  axes->count = asked->count > 0 ? asked->count : 1;
  axes->pair[0] = axes->usual;
  for (int k = 0; k < asked->count && code == DONE; k++)
    code = axes_read_pair(command, asked->word[k], columns, &axes->pair[k]);
  return code;
}

/* Return one past the last row that begins with the same text as row `first`. */
static int curve_end(const result_table *rows, int first)
{
  int end = first;
  while (end < table_rows(rows) &&
         strcmp(table_text_at(rows, end, 0), table_text_at(rows, first, 0)) == 0)
    end++;
  return end;
}

/* Make the curves of a pair, with their numbers in number [2 rows]. Returns the number of
 * curves. */
static int add_curves(const result_table *rows, axes_pair pair, double *number, plot_curve *curve)
{
  const int n = table_rows(rows);
  int curves = 0;
  for (int i = 0; i < n; i++) {
    number[i] = fabs(table_number_at(rows, i, pair.x));
    number[n + i] = fabs(table_number_at(rows, i, pair.y));
  }
  for (int first = 0; first < n; first += curve[curves++].count)
    curve[curves] = (plot_curve){.label = table_text_at(rows, first, 0),
                                 .count = curve_end(rows, first) - first,
                                 .x = number + first,
                                 .y = number + n + first};
  return curves;
}

/* Draw every pair. `number` has [2 rows] numbers and `curve` [rows + guides] curves for each
 * pair. */
static bool axes_draw(const result_table *rows, const plot_axes *axes, const char *subject,
                      int guides, const plot_curve *guide, double *number, plot_curve *curve,
                      const char *path)
{
  plot_panel panel[WORDS_MAX];
  char title[WORDS_MAX][TITLE_SIZE];
  for (int k = 0; k < axes->count;
       k++, number += 2 * table_rows(rows), curve += table_rows(rows) + guides) {
    const axes_pair pair = axes->pair[k];
    const char *x = table_title(rows, pair.x), *y = table_title(rows, pair.y);
    int curves = add_curves(rows, pair, number, curve);
    for (int i = 0; i < guides && pair.x == axes->usual.x && pair.y == axes->usual.y; i++)
      curve[curves++] = guide[i];
    (void)snprintf(title[k], sizeof title[k], "%s against %s: %s", y, x, subject);
    panel[k] = (plot_panel){.title = title[k],
                            .x_label = x,
                            .y_label = y,
                            .logarithmic = true,
                            .curves = curves,
                            .curve = curve};
  }
  return plot_write(path, axes->count, panel);
}

bool axes_plot(const result_table *rows, const plot_axes *axes, const char *subject, int guides,
               const plot_curve *guide, const char *path)
{
  const size_t pairs = (size_t)axes->count, n = (size_t)table_rows(rows);
  double *number = calloc(pairs * 2 * n, sizeof *number);
  plot_curve *curve = calloc(pairs * (n + (size_t)guides), sizeof *curve);
  bool good = number != NULL && curve != NULL;
  if (good)
    good = axes_draw(rows, axes, subject, guides, guide, number, curve, path);
  else
    complain("out of memory for the plot");
  free(number);
  free(curve);
  return good;
}
