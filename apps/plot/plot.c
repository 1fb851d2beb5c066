#include "plot/plot.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/command.h"
#include "plot/gnuplot.h"
#include "plot/thin.h"

enum { WIDTH = 860, PANEL_HEIGHT = 560, COLOURS = 8 };

/* What a script draws. */
typedef struct panel_list {
  int panels;
  const plot_panel *panel;
} panel_list;

/* Smallest visible distance, in pixels. */
static const double SEEN = 0.2;

/* Okabe and Ito's colours, which the colour-blind can tell apart. Their yellow is too pale for
 * lines. */
static const char *const colour[COLOURS] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                            "#56B4E9", "#E69F00", "#000000", "#7F3C8D"};

static bool is_drawable(const plot_panel *panel, const plot_curve *curve, int i)
{
  const double x = curve->x[i];
  const double y = curve->y[i];
  return isfinite(x) && isfinite(y) && (!panel->logarithmic || (x > 0.0 && y > 0.0));
}

static int count_drawable(const plot_panel *panel, const plot_curve *curve)
{
  int count = 0;
  for (int i = 0; i < curve->count; i++) count += is_drawable(panel, curve, i);
  return count;
}

/* Find the range [least, most] of x, then of y, over the drawable points of all curves. Returns
 * whether y is constant up to the digits of its labels. The range is then widened. */
static bool find_range(const plot_panel *panel, double range[4])
{
  range[0] = range[2] = HUGE_VAL;
  range[1] = range[3] = -HUGE_VAL;
  for (int k = 0; k < panel->curves; k++)
    for (int i = 0; i < panel->curve[k].count; i++) {
      if (!is_drawable(panel, &panel->curve[k], i)) continue;
      range[0] = fmin(range[0], panel->curve[k].x[i]);
      range[1] = fmax(range[1], panel->curve[k].x[i]);
      range[2] = fmin(range[2], panel->curve[k].y[i]);
      range[3] = fmax(range[3], panel->curve[k].y[i]);
    }
  const double size = fmax(fabs(range[2]), fabs(range[3]));
  const bool stays = !(range[3] - range[2] > 1e-9 * size);
  if (stays) {
    range[2] -= fmax(0.01 * size, 1e-16);
    range[3] += fmax(0.01 * size, 1e-16);
  }
  return stays;
}

/* Mark the points of a smooth curve without which it would look different. Returns an array to be
 * freed, or NULL for all points. */
static bool *needed_points(const plot_panel *panel, const plot_curve *curve)
{
  const size_t count = (size_t)curve->count;
  double range[4];
  bool *needed = calloc(count + 1, sizeof *needed);
  double *x = calloc(2 * count + 1, sizeof *x), *y = x != NULL ? x + count : NULL;
  (void)find_range(panel, range);
  for (int i = 0; i < curve->count && needed != NULL && x != NULL; i++) {
    needed[i] = is_drawable(panel, curve, i);
    x[i] = (curve->x[i] - range[0]) / fmax(range[1] - range[0], DBL_MIN) * WIDTH;
    y[i] = (curve->y[i] - range[2]) / fmax(range[3] - range[2], DBL_MIN) * PANEL_HEIGHT;
  }
  if (needed != NULL && x != NULL) thin_curve(curve->count, x, y, SEEN, needed);
  free(x);
  return needed;
}

/* Write each curve's points as a block of numbers, named by panel and curve. */
static void write_blocks(FILE *script, int index, const plot_panel *panel)
{
  for (int k = 0; k < panel->curves; k++) {
    const plot_curve *curve = &panel->curve[k];
    (void)fprintf(script, "$panel%d_curve%d << END\n", index, k);
    bool *needed = panel->smooth && !panel->dots ? needed_points(panel, curve) : NULL;
    for (int i = 0; i < curve->count; i++)
      if (needed != NULL ? needed[i] : is_drawable(panel, curve, i))
        (void)fprintf(script, "%.9g %.9g\n", curve->x[i], curve->y[i]);
    (void)fputs("END\n", script);
    free(needed);
  }
}

static void write_curve(FILE *script, int index, const plot_panel *panel, int k, int style)
{
  const plot_curve *curve = &panel->curve[k];
  (void)fprintf(script, "$panel%d_curve%d using 1:2 ", index, k);
  if (curve->label != NULL) {
    (void)fputs("title ", script);
    gnuplot_quoted(script, curve->label);
    (void)fputs(" noenhanced with ", script);
  } else {
    (void)fputs("notitle with ", script);
  }
  if (curve->guide)
    (void)fputs("lines lw 1 dt 2 lc rgb '#808080'", script);
  else if (panel->dots)
    (void)fprintf(script, "points pt 7 ps 0.25 lc rgb '%s'", colour[style % COLOURS]);
  else if (panel->smooth)
    (void)fprintf(script, "lines lw 1.2 lc rgb '%s'", colour[style % COLOURS]);
  else
    (void)fprintf(script, "linespoints lw 1.6 ps 0.7 pt %d lc rgb '%s'", 4 + style,
                  colour[style % COLOURS]);
}

/* Set the range of y. gnuplot would warn of a curve that stays at one number, and guess a range. */
static void fix_range(FILE *script, const plot_panel *panel)
{
  double range[4];
  if (find_range(panel, range) && !panel->logarithmic)
    (void)fprintf(script, "set yrange [%.17g:%.17g]\n", range[2], range[3]);
  else
    (void)fputs("set autoscale y\n", script);
}

static void write_panel(FILE *script, int index, const plot_panel *panel)
{
  gnuplot_setting(script, "title", panel->title);
  gnuplot_setting(script, "xlabel", panel->x_label);
  (void)fputs("set xlabel offset 0,0.6\n", script);
  gnuplot_setting(script, "ylabel", panel->y_label);
  (void)fputs(panel->logarithmic
                  ? "set logscale xy 10\nset format x '10^{%L}'\nset format y '10^{%L}'\n"
                  : "unset logscale\nset format '%g'\n",
              script);
  (void)fputs(panel->logarithmic ? "unset offsets\n"
                                 : "set offsets graph 0, 0, graph 0.03, graph 0.03\n",
              script);
  fix_range(script, panel);
  (void)fputs(panel->equal ? "set size ratio -1\n" : "set size noratio\n", script);
  const char *joint = "plot ";
  for (int k = 0, style = 0; k < panel->curves; k++) {
    if (count_drawable(panel, &panel->curve[k]) == 0) continue;
    (void)fputs(joint, script);
    write_curve(script, index, panel, k, style);
    joint = ", \\\n     ";
    style += !panel->curve[k].guide;
  }
  (void)fputc('\n', script);
}

static void write_script(FILE *script, const void *drawing)
{
  const panel_list *list = drawing;
  const int panels = list->panels;
  const plot_panel *panel = list->panel;
  (void)fprintf(script,
                "set terminal svg size %d,%d enhanced background rgb 'white' font 'Helvetica,13'\n",
                WIDTH, panels * PANEL_HEIGHT);
  (void)fputs("set grid lt 1 lw 0.5 lc rgb '#d8d8d8'\nset border lc rgb '#404040'\nset key outside "
              "below center horizontal maxcols "
              "2 Left reverse samplen 3\n",
              script);
  for (int i = 0; i < panels; i++) write_blocks(script, i, &panel[i]);
  if (panels > 1) (void)fprintf(script, "set lmargin 12\nset multiplot layout %d,1\n", panels);
  for (int i = 0; i < panels; i++) write_panel(script, i, &panel[i]);
  if (panels > 1) (void)fputs("unset multiplot\n", script);
}

static bool anything_to_draw(int panels, const plot_panel *panel)
{
  for (int i = 0; i < panels; i++) {
    int count = 0;
    for (int k = 0; k < panel[i].curves; k++)
      count += count_drawable(&panel[i], &panel[i].curve[k]);
    if (count == 0) return false;
  }
  return true;
}

bool plot_write(const char *path, int panels, const plot_panel *panel)
{
  if (anything_to_draw(panels, panel))
    return gnuplot_draw(path, write_script, &(panel_list){panels, panel});
  complain("no plot in '%s': there is no point that its axes can show", path);
  return false;
}
