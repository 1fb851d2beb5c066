/* dvi plot, which draws columns of a CSV file against each other, or a grid and its fields. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/spelling.h"
#include "picture/picture.h"
#include "plot/curves.h"
#include "plot/plot.h"

typedef struct plot_request {
  words axes, fields;
  const char *out, *title, *view, *strokes;
  bool dots, equal, logarithmic, edges, duals;
} plot_request;

/* ---- columns ---- */

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

static int plot_columns(const plot_request *request, const char *path)
{
  curve_list list;
  if (request->fields.count > 0 || request->edges || request->duals || request->view != NULL ||
      request->strokes != NULL)
    return usage_error("plot: --field, --edges, --duals, --strokes and --view are for .vtu files");
  int code = curves_ask(&request->axes, &list);
  if (code != DONE) return code;
  code = curves_read(path, &list);
  if (code == DONE && !plot_draw(request, &list, path)) code = FAILED;
  curves_clear(&list);
  return code;
}

/* ---- grids ---- */

/* Read "AZIMUTH,ELEVATION". Without it flat grids are seen from above. */
static int read_view(const plot_request *request, const vtu_grid *g, viewpoint *from)
{
  char angle[48];
  *from = (viewpoint){.is_flat = skin_is_flat(g), .azimuth = 30, .elevation = 30};
  if (request->view == NULL) return DONE;
  const char *comma = strchr(request->view, ',');
  const size_t length = comma != NULL ? (size_t)(comma - request->view) : sizeof angle;
  if (length < sizeof angle) {
    memcpy(angle, request->view, length);
    angle[length] = '\0';
    from->is_flat = false;
    if (parse_number(angle, &from->azimuth) && parse_number(comma + 1, &from->elevation))
      return DONE;
  }
  return usage_error("plot: --view %s: two angles in degrees are wanted, as in 30,30",
                     request->view);
}

static const char *field_name(int k, const void *list)
{
  const vtu_grid *g = list;
  return k < g->fields ? g->field[k].name : NULL;
}

/* Find the fields that are asked for, or take the first one if there is nothing else to draw. */
static int choose_fields(const plot_request *request, const vtu_grid *g, const vtu_field **field,
                         int *fields)
{
  char near[2 * VTU_NAME];
  *fields = request->fields.count;
  for (int i = 0; i < *fields; i++) {
    const char *name = request->fields.word[i];
    field[i] = vtu_find(g, name);
    if (field[i] == NULL) {
      if (g->fields == 0) return usage_error("plot: --field %s: the grid has no fields", name);
      return usage_error("plot: there is no field '%s' among %d, of which '%s' is the first%s",
                         name, g->fields, g->field[0].name,
                         suggestion(name, field_name, g, near, sizeof near));
    }
  }
  if (*fields == 0 && g->fields > 0 && request->strokes == NULL) field[(*fields)++] = &g->field[0];
  return DONE;
}

static int plot_grid(const plot_request *request, const char *path)
{
  vtu_grid g;
  const vtu_field *field[WORDS_MAX];
  stroke_field strokes;
  picture p = {.title = request->title, .field = field, .duals = request->duals};
  if (request->axes.count > 0 || request->dots || request->equal || request->logarithmic)
    return usage_error("plot: --axes, --dots, --equal and --log are for columns of CSV files");
  int code = vtu_read(path, &g);
  if (code != DONE) return code;
  code = choose_fields(request, &g, field, &p.fields);
  if (code == DONE) code = read_view(request, &g, &p.from);
  if (code == DONE && request->strokes != NULL) {
    code = strokes_find(&g, request->strokes, &strokes);
    p.strokes = &strokes;
  }
  p.edges = request->edges || (p.fields == 0 && p.strokes == NULL);
  if (code == DONE) {
    if (p.title == NULL)
      p.title = p.fields > 0 ? field[0]->name : request->strokes != NULL ? request->strokes : path;
    code = picture_draw(request->out, &g, &p);
  }
  vtu_clear(&g);
  return code;
}

static int plot_file(const plot_request *request, const char *path)
{
  const size_t length = strlen(path);
  if (request->out == NULL) return usage_error("plot: --out FILE.svg is missing");
  const int code = outputs_plot("plot", "out", request->out);
  if (code != DONE) return code;
  if (length > 4 && strcmp(path + length - 4, ".pvd") == 0)
    return usage_error("plot: %s lists .vtu files; name one of them", path);
  if (length > 7 && strcmp(path + length - 7, ".vtkhdf") == 0)
    return usage_error("plot: %s has fields at the times of a run, which dvi view shows; dvi plot "
                       "draws a .vtu file, and dvi run --pvd FILE.pvd writes them",
                       path);
  const bool is_grid = length > 4 && strcmp(path + length - 4, ".vtu") == 0;
  return is_grid ? plot_grid(request, path) : plot_columns(request, path);
}

static const char *const details[] = {
    "Several pairs with commas between them share a pair of axes; with --axes again there is one "
    "more, below. Y alone is t:Y.\n"
    "Rows whose cells are no numbers are left out. Lines have as many points as can be seen.\n",
    "A grid in a .vtu file, as run --pvd, solve --vtu, modes --vtu and mesh --write make it, is "
    "drawn as a filled map of a field, or of several, each in a panel. Without a field it is drawn "
    "as the edges of its cells. Surfaces in space are seen from a side, and of tetrahedra and "
    "boxes "
    "the outside. Dual edges between circumcentres are blue, and those that count as negative are "
    "orange.\n",
    "Examples:\n"
    "  dvi run kepler --method galerkin:degree=4 --h 0.1 --t-end 10 --out orbit.csv\n"
    "  dvi plot orbit.csv --axes x:y --equal --out orbit.svg\n"
    "  dvi plot orbit.csv --axes x,y --axes energy --out time.svg\n"
    "  dvi run figure-eight --method verlet --h 0.01 --t-end 6 | dvi plot - --axes x1:y1 --out "
    "eight.svg\n"
    "  dvi modes drum.yaml --vtu modes.vtu\n"
    "  dvi plot modes.vtu --field mode_1 --field mode_2 --out modes.svg\n"
    "  dvi mesh disk --write disk.vtu\n"
    "  dvi plot disk.vtu --duals --out disk.svg\n"
    "  dvi plot field.vtu --strokes direction --out field.svg\n",
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
    {.name = "field",
     OPTION_AT(plot_request, fields),
     .value = "NAME",
     .help = "a field of a grid, or a component of vectors, as E_z; may be repeated; default: the "
             "first one"},
    {.name = "edges",
     OPTION_AT(plot_request, edges),
     .help = "draw the edges of a grid's cells over the fields"},
    {.name = "duals",
     OPTION_AT(plot_request, duals),
     .help = "draw the dual edges of triangles and rectangles"},
    {.name = "strokes",
     OPTION_AT(plot_request, strokes),
     .value = "NAME",
     .help = "draw the vectors of a grid's cells as short strokes"},
    {.name = "view",
     OPTION_AT(plot_request, view),
     .value = "A,E",
     .help = "azimuth and elevation of the eye in degrees; default: 30,30"},
    {.name = NULL},
};

static const command_line command = {
    .name = "plot",
    .synopsis = "FILE.csv|FILE.h5 --axes X:Y[,X:Y..] --out FILE.svg [OPTIONS]\n"
                "       dvi plot FILE.vtu [--field NAME] --out FILE.svg [OPTIONS]",
    .operand = "FILE",
    .summary =
        "Draw columns of a CSV file, or of HDF5, that dvi has written against each other; - is "
        "standard input. Or draw a grid and its fields.\n",
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
