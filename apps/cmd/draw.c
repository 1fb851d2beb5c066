/* dvi plot, which draws columns of a CSV file against each other. */
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "plot/curves.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "plot/plot.h"

typedef struct plot_request {
  words axes;
  const char *out, *title;
  bool dots, equal, logarithmic;
} plot_request;

/* Return the name that all curves of a panel have on one axis, or "" if they differ, because the
 * legend then has them. */
static const char *name_axis(const curve_list *list, int first, int count, bool of_x)
{
  const char *name = of_x ? list->curve[first].x_name : list->curve[first].y_name;
  for (int k = first + 1; k < first + count; k++)
    if (strcmp(name, of_x ? list->curve[k].x_name : list->curve[k].y_name) != 0) return "";
  return name;
}

static const char *name_pair(const curve_points *curve, char name[2 * FIELD_SIZE])
{
  (void)snprintf(name, 2 * FIELD_SIZE, "%s:%s", curve->x_name, curve->y_name);
  return name;
}

static bool plot_draw(const plot_request *request, const curve_list *list, const char *path)
{
  plot_curve curve[WORDS_MAX];
  plot_panel panel[WORDS_MAX];
  char pair[WORDS_MAX][2 * FIELD_SIZE];
  int first = 0;
  for (int k = 0; k < list->curves; k++)
    curve[k] = (plot_curve){.count = list->count, .x = list->curve[k].x, .y = list->curve[k].y};
  for (int i = 0; i < list->panels; i++) {
    int count = 0;
    while (first + count < list->curves && list->curve[first + count].panel == i) count++;
    const char *x = name_axis(list, first, count, true);
    const bool over_time = strcmp(x, "t") == 0;
    for (int k = first; count > 1 && k < first + count; k++)
      curve[k].label = over_time ? list->curve[k].y_name : name_pair(&list->curve[k], pair[k]);
    panel[i] = (plot_panel){.title = i > 0                    ? ""
                                     : request->title != NULL ? request->title
                                                              : path,
                            .x_label = x,
                            .y_label = name_axis(list, first, count, false),
                            .logarithmic = request->logarithmic,
                            .smooth = !request->logarithmic,
                            .dots = request->dots,
                            .equal = request->equal && !over_time,
                            .curves = count,
                            .curve = &curve[first]};
    first += count;
  }
  return plot_write(request->out, list->panels, panel);
}

static int plot_file(const plot_request *request, const char *path)
{
  curve_list list;
  if (request->out == NULL) return usage_error("plot: --out FILE.svg is missing");
  int code = outputs_plot("plot", "out", request->out);
  if (code == DONE) code = curves_ask(&request->axes, &list);
  if (code != DONE) return code;
  code = curves_read(path, &list);
  if (code == DONE && !plot_draw(request, &list, path)) code = FAILED;
  curves_clear(&list);
  return code;
}

static const char *const details[] = {
    "Several pairs with commas between them share a pair of axes; with --axes again there is one "
    "more, below. Y alone is t:Y.\n"
    "Rows whose cells are no numbers are left out. Lines have as many points as can be seen.\n",
    "Examples:\n"
    "  dvi run kepler --method galerkin:degree=4 --h 0.1 --t-end 10 --out orbit.csv\n"
    "  dvi plot orbit.csv --axes x:y --equal --out orbit.svg\n"
    "  dvi plot orbit.csv --axes x,y --axes energy --out time.svg\n"
    "  dvi run figure-eight --method verlet --h 0.01 --t-end 6 | dvi plot - --axes x1:y1 --out "
    "eight.svg\n",
    NULL,
};

static const option command_options[] = {
    {.name = "axes",
     OPTION_AT(plot_request, axes),
     .value = "X:Y[,X:Y..]",
     .help = "the columns to draw; may be repeated"},
    {.name = "out", OPTION_AT(plot_request, out), .value = "FILE.svg", .help = "the picture"},
    {.name = "title",
     OPTION_AT(plot_request, title),
     .value = "TEXT",
     .help = "what stands above it; default: the file's name"},
    {.name = "dots", OPTION_AT(plot_request, dots), .help = "a dot for each row instead of lines"},
    {.name = "equal",
     OPTION_AT(plot_request, equal),
     .help = "the same scale on both axes, but for those over time"},
    {.name = "log",
     OPTION_AT(plot_request, logarithmic),
     .help = "logarithmic axes; rows with numbers that are not positive are left out"},
    {.name = NULL},
};

static const command_line command = {
    .name = "plot",
    .synopsis = "FILE.csv --axes X:Y[,X:Y..] --out FILE.svg [OPTIONS]",
    .operand = "FILE",
    .summary = "Draw columns of a CSV file that dvi has written against each other; - is "
               "standard input.\n",
    .options = command_options,
    .details = details,
};

int plot_command(int argc, char **argv)
{
  plot_request r = {0};
  const char *path;
  int code;
  if (!options_parse(&command, argc, argv, &r, &path, &code)) return code;
  return plot_file(&r, path);
}
