#include "plot/trace.h"

#include <dvi/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "plot/plot.h"

enum { MOTION, ENERGY, INVARIANTS };
enum { USUAL_CURVES = 6, NAMES_SIZE = 512 };

/* The order of choice. Places and angles come first, then directions. Entries of matrices come
 * last, because nine of them hold as much as three angles. */
typedef enum coordinate_rank { PLACE, DIRECTION, ENTRY } coordinate_rank;

/* ---- choice of curves ---- */

static coordinate_rank rank_of(const dvi_system_terms *terms, int i)
{
  static const int entries[] = {[DVI_SO3] = 9, [DVI_SE3] = 9, [DVI_S2] = 0, [DVI_U1] = 0},
                   stored[] = {[DVI_SO3] = 9, [DVI_SE3] = 12, [DVI_S2] = 3, [DVI_U1] = 2};
  for (int f = 0; f < terms->factor_count; f++) {
    const dvi_factor_kind kind = terms->factors[f].kind;
    const int size = kind == DVI_RN ? terms->factors[f].size : stored[kind];
    if (i < size) return kind == DVI_S2 ? DIRECTION : i < entries[kind] ? ENTRY : PLACE;
    i -= size;
  }
  return PLACE;
}

static void panel_add_column(trace_panel *panel, int column, int most)
{
  if (panel->curves < most)
    panel->column[panel->curves++] = column;
  else
    panel->left_out++;
}

/* Choose the coordinates of a rank from all columns. */
static void choose_rank(run_trace *trace, coordinate_rank rank)
{
  const run_columns *c = trace->columns;
  for (int k = 0; k < c->count; k++)
    if (c->column[k].kind == COLUMN_COORDINATE &&
        rank_of(c->scene->terms, c->column[k].index) == rank)
      panel_add_column(&trace->panel[MOTION], k, USUAL_CURVES);
}

static void choose_motion(run_trace *trace)
{
  const run_columns *c = trace->columns;
  choose_rank(trace, PLACE);
  choose_rank(trace, DIRECTION);
  const bool turns_only = trace->panel[MOTION].curves == 0;
  for (int k = 0; k < c->count && turns_only; k++)
    if (c->column[k].kind == COLUMN_VELOCITY)
      panel_add_column(&trace->panel[MOTION], k, USUAL_CURVES);
}

/* Test whether the balance of an invariant is shown, which is drawn in its place. */
static bool shows_balance(const run_columns *c, int invariant)
{
  for (int k = 0; k < c->count; k++)
    if (c->column[k].kind == COLUMN_BALANCE && c->column[k].index == invariant) return true;
  return false;
}

/* The probes of a field, behind its energy and momenta, are signals and no invariants. */
static bool is_probe(const run_columns *c, const shown_column *column)
{
  const dvi_scene *scene = c->scene->scene;
  return (dvi_scene_field(scene) != NULL || dvi_scene_density(scene) != NULL ||
          dvi_scene_elastic(scene) != NULL) &&
         column->kind == COLUMN_INVARIANT && column->index > c->scene->terms->symmetry_count;
}

static void choose_curves(run_trace *trace, bool chosen)
{
  const run_columns *c = trace->columns;
  if (!chosen) choose_motion(trace);
  for (int k = 0; k < c->count; k++) {
    const shown_column *column = &c->column[k];
    if (is_probe(c, column)) {
      panel_add_column(&trace->panel[MOTION], k, TRACE_CURVES);
      continue;
    }
    if (column->kind == COLUMN_INVARIANT && shows_balance(c, column->index)) continue;
    if (column->kind == COLUMN_INVARIANT || column->kind == COLUMN_BALANCE)
      panel_add_column(&trace->panel[column->index == 0 ? ENERGY : INVARIANTS], k, TRACE_CURVES);
    else if (chosen)
      panel_add_column(&trace->panel[MOTION], k, TRACE_CURVES);
  }
}

/* ---- the record ---- */

static bool panel_allocate(trace_panel *panel)
{
  bool good = true;
  for (int i = 0; i < panel->curves; i++) {
    panel->y[i] = calloc(TRACE_MAX, sizeof *panel->y[i]);
    good = good && panel->y[i] != NULL;
  }
  return good;
}

bool trace_init(run_trace *trace, const run_columns *columns, bool chosen)
{
  *trace = (run_trace){.columns = columns, .stride = 1};
  choose_curves(trace, chosen);
  trace->t = calloc(TRACE_MAX, sizeof *trace->t);
  bool good = trace->t != NULL;
  for (int i = 0; i < TRACE_PANELS; i++) good = panel_allocate(&trace->panel[i]) && good;
  if (!good) complain("out of memory for the plot");
  return good;
}

void trace_clear(run_trace *trace)
{
  free(trace->t);
  for (int i = 0; i < TRACE_PANELS; i++)
    for (int k = 0; k < trace->panel[i].curves; k++) free(trace->panel[i].y[k]);
  *trace = (run_trace){.count = 0};
}

static void keep_every_other(double *x)
{
  for (int k = 0; k < TRACE_MAX / 2; k++) x[k] = x[2 * k];
}

/* Keep every other sample, and from now on record only every other one. */
static void trace_halve(run_trace *trace)
{
  keep_every_other(trace->t);
  for (int i = 0; i < TRACE_PANELS; i++)
    for (int k = 0; k < trace->panel[i].curves; k++) keep_every_other(trace->panel[i].y[k]);
  trace->count = TRACE_MAX / 2;
  trace->stride *= 2;
}

void trace_add(run_trace *trace, const dvi_integrator *integrator)
{
  if (trace->seen++ % trace->stride != 0) return;
  if (trace->count == TRACE_MAX) {
    trace_halve(trace);
    if ((trace->seen - 1) % trace->stride != 0) return;
  }
  trace->t[trace->count] = dvi_integrator_time(integrator);
  for (int i = 0; i < TRACE_PANELS; i++)
    for (int k = 0; k < trace->panel[i].curves; k++)
      trace->panel[i].y[k][trace->count] = columns_number(trace->columns, integrator,
                                                          trace->panel[i].column[k]);
  trace->count++;
}

/* ---- the picture ---- */

static const char *curve_name(const run_trace *trace, int panel, int k)
{
  return trace->columns->column[trace->panel[panel].column[k]].name;
}

/* Write the names as "x, y", as far as there is room. */
static void list_names(const run_trace *trace, int panel, char names[NAMES_SIZE])
{
  size_t length = 0;
  names[0] = '\0';
  for (int k = 0; k < trace->panel[panel].curves && length < NAMES_SIZE; k++)
    length += (size_t)snprintf(names + length, NAMES_SIZE - length, "%s%s", k > 0 ? ", " : "",
                               curve_name(trace, panel, k));
}

static void print_drawn(const run_trace *trace, const char *path)
{
  static const char *const what[] = {
      [MOTION] = "over t: ", [ENERGY] = "change since the start: ", [INVARIANTS] = ", "};
  char text[TRACE_PANELS * (NAMES_SIZE + 64)] = "", names[NAMES_SIZE];
  size_t length = 0;
  int left_out = 0;
  for (int i = 0; i < TRACE_PANELS; i++) {
    left_out += trace->panel[i].left_out;
    if (trace->panel[i].curves == 0) continue;
    const bool begins = i != INVARIANTS || trace->panel[ENERGY].curves == 0;
    list_names(trace, i, names);
    length += (size_t)snprintf(text + length, sizeof text - length, "%s%s%s",
                               begins && length > 0 ? "; " : "",
                               what[begins && i == INVARIANTS ? ENERGY : i], names);
  }
  complain("run: --plot %s draws %s%s", path, text,
           left_out > 0 ? "; --columns chooses others" : "");
}

/* Subtract the value at the start, because an invariant's change is drawn. */
static void subtract_start(const run_trace *trace, const trace_panel *panel)
{
  for (int k = 0; k < panel->curves; k++) {
    const double start = panel->y[k][0];
    for (int i = 0; i < trace->count; i++) panel->y[k][i] -= start;
  }
}

static void fill_panel(const run_trace *trace, int i, plot_curve *curve, plot_panel *made)
{
  static const char *const titles[] = {[ENERGY] = "energy - energy at the start",
                                       [INVARIANTS] = "invariants: change since the start"};
  const trace_panel *panel = &trace->panel[i];
  const bool balanced = trace->columns->column[panel->column[0]].kind == COLUMN_BALANCE;
  if (i != MOTION) subtract_start(trace, panel);
  for (int k = 0; k < panel->curves; k++)
    curve[k] = (plot_curve){.label = i == ENERGY ? NULL : curve_name(trace, i, k),
                            .count = trace->count,
                            .x = trace->t,
                            .y = panel->y[k]};
  const bool coordinates = trace->columns->column[panel->column[0]].kind == COLUMN_COORDINATE;
  *made = (plot_panel){.title = i == MOTION               ? trace->columns->scene->name
                                : i == ENERGY && balanced ? "energy - its start - the forces' work"
                                                          : titles[i],
                       .x_label = "t",
                       .y_label = i != MOTION   ? "error"
                                  : coordinates ? "coordinates"
                                                : "columns",
                       .smooth = true,
                       .curves = panel->curves,
                       .curve = curve};
}

bool trace_plot(const run_trace *trace, const char *path)
{
  plot_curve curves[TRACE_PANELS][TRACE_CURVES];
  plot_panel panels[TRACE_PANELS];
  int count = 0;
  for (int i = 0; i < TRACE_PANELS; i++)
    if (trace->panel[i].curves > 0) fill_panel(trace, i, curves[i], &panels[count++]);
  if (count == 0) {
    complain("run: no plot in '%s': --columns names nothing to draw", path);
    return true;
  }
  print_drawn(trace, path);
  return plot_write(path, count, panels);
}
