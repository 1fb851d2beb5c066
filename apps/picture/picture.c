#include "picture/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "picture/raster.h"
#include "plot/gnuplot.h"
#include "plot/palette.h"
#include "plot/plot.h"

enum { WIDE = 640, PANELS_WIDE = 400, MARGIN_X = 150, MARGIN_Y = 90, LINES_MOST = 60000 };
enum { PIXELS = 400, PIXELS_OF_SEVERAL = 160 };

/* A picture with its surface and its pixels. */
typedef struct canvas {
  const vtu_grid *g;
  const picture *p;
  skin s;
  raster pixels; /* of the field that is being drawn */
} canvas;

/* ---- lines ---- */

/* Write the parts of a line that are not hidden, as runs of points. */
static void write_line(FILE *script, const canvas *c, const double *a, const double *b)
{
  const double length = hypot(b[0] - a[0], b[1] - a[1]);
  const int pieces = c->p->from.is_flat ? 1 : 1 + (int)(length / (4 * c->pixels.pixel));
  double kept[2] = {0, 0};
  bool drawing = false;
  for (int i = 0; i <= pieces; i++) {
    double x[3];
    for (int l = 0; l < 3; l++) x[l] = a[l] + (b[l] - a[l]) * i / pieces;
    const bool seen = c->p->from.is_flat || !raster_hides(&c->pixels, x);
    if (seen && (!drawing || i == pieces)) (void)fprintf(script, "%.7g %.7g\n", x[0], x[1]);
    if (!seen && drawing) (void)fprintf(script, "%.7g %.7g\n\n", kept[0], kept[1]);
    drawing = seen;
    kept[0] = x[0];
    kept[1] = x[1];
  }
  (void)fputs("\n", script);
}

static void write_edges(FILE *script, const canvas *c)
{
  (void)fputs("$edges << END\n", script);
  for (int64_t e = 0; e < c->s.edges && c->p->edges; e++)
    write_line(script, c, c->s.point + 3 * c->s.edge[2 * e], c->s.point + 3 * c->s.edge[2 * e + 1]);
  (void)fputs("END\n", script);
}

/* Find the circumcentre of a face, the centre of a rectangle. Returns false if it has none. */
static bool find_centre(const skin *s, const skin_face *face, double *centre)
{
  const double *a = s->point + 3 * face->vertex[0], *b = s->point + 3 * face->vertex[1],
               *c = s->point + 3 * face->vertex[2];
  double bb = 0, bc = 0, cc = 0;
  for (int l = 0; l < 3; l++) {
    bb += (b[l] - a[l]) * (b[l] - a[l]);
    bc += (b[l] - a[l]) * (c[l] - a[l]);
    cc += (c[l] - a[l]) * (c[l] - a[l]);
  }
  const double determinant = 2 * (bb * cc - bc * bc), x = cc * (bb - bc) / determinant,
               y = bb * (cc - bc) / determinant;
  for (int l = 0; l < 3; l++) centre[l] = a[l] + x * (b[l] - a[l]) + y * (c[l] - a[l]);
  return isfinite(x) && isfinite(y);
}

/* Return whether the dual edge of side i goes from the centre away from the face's other corners,
 * so that it counts as negative. */
static bool is_negative(const skin *s, const skin_face *face, int i, const double *centre,
                        const double *middle)
{
  const double *other = s->point + 3 * face->vertex[(i + 2) % face->corners];
  const double *corner = s->point + 3 * face->vertex[i];
  double along = 0, outward = 0, edge[3], square = 0;
  for (int l = 0; l < 3; l++) {
    edge[l] = s->point[3 * face->vertex[(i + 1) % face->corners] + l] - corner[l];
    square += edge[l] * edge[l];
    along += edge[l] * (other[l] - corner[l]);
  }
  for (int l = 0; l < 3; l++) {
    const double inward = other[l] - corner[l] - along / square * edge[l];
    outward += inward * (middle[l] - centre[l]);
  }
  return outward > 0;
}

/* Write the dual edges of one sign, from the centres of the faces to the middles of their sides.
 * Returns their number. */
static int64_t write_duals(FILE *script, const canvas *c, bool negative)
{
  int64_t count = 0;
  (void)fprintf(script, "$%s << END\n", negative ? "negative" : "duals");
  for (int64_t f = 0; f < c->s.faces && c->p->duals; f++) {
    const skin_face *face = c->s.face + f;
    double centre[3], middle[3];
    if (!find_centre(&c->s, face, centre)) continue;
    for (int i = 0; i < face->corners; i++) {
      const double *a = c->s.point + 3 * face->vertex[i],
                   *b = c->s.point + 3 * face->vertex[(i + 1) % face->corners];
      for (int l = 0; l < 3; l++) middle[l] = (a[l] + b[l]) / 2;
      if (is_negative(&c->s, face, i, centre, middle) != negative) continue;
      write_line(script, c, centre, middle);
      count++;
    }
  }
  (void)fputs("END\n", script);
  return count;
}

static int64_t write_strokes(FILE *script, const canvas *c)
{
  const picture *p = c->p;
  (void)fputs("$strokes << END\n", script);
  const int64_t count = p->strokes != NULL
                            ? strokes_write(script, c->g, p->strokes, &p->from, &c->s, &c->pixels)
                            : 0;
  (void)fputs("END\n", script);
  return count;
}

/* ---- maps ---- */

/* The pixels follow the command as bytes, because gnuplot warns of NaN in texts. */
static void write_map(FILE *script, const raster *r)
{
  for (size_t i = 0; i < (size_t)r->width * (size_t)r->height; i++)
    (void)fwrite(&r->value[i], sizeof r->value[i], 1, script);
}

/* Set the colours, greys for a slope. */
static void write_colours(FILE *script, const canvas *c, const vtu_field *field)
{
  double least = HUGE_VAL, most = -HUGE_VAL;
  const int64_t count = field == NULL ? 0 : field->is_by_cell ? c->g->cells : c->g->points;
  for (int64_t i = 0; i < count; i++) {
    if (!isfinite(field->value[i])) continue;
    least = fmin(least, field->value[i]);
    most = fmax(most, field->value[i]);
  }
  palette_set(script, least, most);
  if (field == NULL) (void)fputs("set cbrange [0:1]\nunset colorbox\n", script);
}

static void write_axes(FILE *script, const canvas *c)
{
  const skin *s = &c->s;
  const double edge = 0.02 * fmax(s->most[0] - s->least[0], s->most[1] - s->least[1]);
  (void)fprintf(script, "set xrange [%.9g:%.9g]\nset yrange [%.9g:%.9g]\n", s->least[0] - edge,
                s->most[0] + edge, s->least[1] - edge, s->most[1] + edge);
  (void)fputs("set size ratio -1\nunset key\n", script);
  (void)fputs(c->p->from.is_flat ? "set border lc rgb '#404040'\n"
                                 : "unset border\nunset xtics\nunset ytics\n",
              script);
}

/* Return what joins a plot to those before it. */
static const char *next(const char **joint)
{
  const char *now = *joint;
  *joint = ", ";
  return now;
}

static bool write_panel(FILE *script, const canvas *bare, const vtu_field *field, const char *title)
{
  canvas painted = *bare;
  const canvas *c = &painted;
  const raster *r = &painted.pixels;
  if (!raster_make(&c->s, field, c->p->fields > 1 ? PIXELS_OF_SEVERAL : PIXELS, &painted.pixels))
    return false;
  const bool filled = field != NULL || !c->p->from.is_flat;
  gnuplot_setting(script, "title", title);
  write_colours(script, c, field);
  write_edges(script, c);
  const int64_t duals = write_duals(script, c, false), negative = write_duals(script, c, true),
                strokes = write_strokes(script, c);
  const char *joint = "plot ";
  if (filled)
    (void)fprintf(script,
                  "%s'-' binary array=(%d,%d) origin=(%.9g,%.9g) dx=%.9g dy=%.9g "
                  "format='%%double' notitle with image",
                  next(&joint), r->width, r->height, r->least[0], r->least[1], r->pixel, r->pixel);
  if (c->p->edges)
    (void)fprintf(script, "%s$edges notitle with lines lw 0.6 lc rgb '#404040'", next(&joint));
  if (duals > 0)
    (void)fprintf(script, "%s$duals notitle with lines lw 0.6 lc rgb '#0072B2'", next(&joint));
  if (negative > 0)
    (void)fprintf(script, "%s$negative notitle with lines lw 1.2 lc rgb '#D55E00'", next(&joint));
  if (strokes > 0)
    (void)fprintf(script,
                  "%s$strokes notitle with vectors head nofilled size screen 0.008,20 lw 1 "
                  "lc rgb '#0072B2'",
                  next(&joint));
  (void)fputs("\n", script);
  if (filled) write_map(script, r);
  raster_clear(&painted.pixels);
  return true;
}

static void write_script(FILE *script, const void *drawing)
{
  const canvas *c = drawing;
  const picture *p = c->p;
  const int panels = p->fields > 0 ? p->fields : 1,
            columns = panels < 4 ? panels : (int)ceil(sqrt(panels)),
            rows = (panels + columns - 1) / columns, wide = panels > 1 ? PANELS_WIDE : WIDE;
  const double shape = (c->s.most[1] - c->s.least[1]) / (c->s.most[0] - c->s.least[0]);
  const int high = MARGIN_Y + (int)((wide - MARGIN_X) * fmin(fmax(shape, 0.1), 4));
  (void)fprintf(script,
                "set terminal svg size %d,%d enhanced background rgb 'white' font 'Helvetica,%d'\n",
                columns * wide, rows * high, panels > 1 ? 11 : 13);
  write_axes(script, c);
  if (panels > 1) (void)fprintf(script, "set multiplot layout %d,%d\n", rows, columns);
  for (int i = 0; i < panels; i++)
    if (!write_panel(script, c, p->fields > 0 ? p->field[i] : NULL,
                     panels > 1 ? p->field[i]->name : p->title))
      break;
  if (panels > 1) (void)fputs("unset multiplot\n", script);
}

/* ---- curves over a line ---- */

static int compare_points(const void *first, const void *second)
{
  const double *a = first, *b = second;
  return a[0] < b[0] ? -1 : a[0] > b[0];
}

/* Sort the points of a line along it, with the values of a field at them. */
static double *sort_line(const vtu_grid *g, const vtu_field *field)
{
  const size_t points = (size_t)g->points;
  double *pair = calloc(4 * points + 1, sizeof *pair), *x = pair + 2 * points;
  for (size_t i = 0; i < points && pair != NULL; i++) {
    pair[2 * i] = g->point[3 * i];
    pair[2 * i + 1] = field->value[i];
  }
  if (pair != NULL) qsort(pair, points, 2 * sizeof *pair, compare_points);
  for (size_t i = 0; i < points && pair != NULL; i++) {
    x[i] = pair[2 * i];
    x[points + i] = pair[2 * i + 1];
  }
  return pair;
}

static int draw_curves(const char *path, const vtu_grid *g, const picture *p)
{
  plot_curve curve[VTU_FIELDS];
  double *points[VTU_FIELDS] = {NULL};
  bool good = p->fields > 0;
  if (!good) complain("no plot in '%s': a line without a field has nothing to draw", path);
  for (int i = 0; i < p->fields && good; i++) {
    points[i] = p->field[i]->is_by_cell ? NULL : sort_line(g, p->field[i]);
    good = points[i] != NULL;
    if (!good) complain("no plot in '%s': '%s' has no values at points", path, p->field[i]->name);
    curve[i] = (plot_curve){.label = p->fields > 1 ? p->field[i]->name : NULL,
                            .count = (int)g->points,
                            .x = points[i] + 2 * g->points,
                            .y = points[i] + 3 * g->points};
  }
  const plot_panel panel = {.title = p->title,
                            .x_label = "x",
                            .y_label = p->fields == 1 ? p->field[0]->name : "",
                            .smooth = true,
                            .curves = p->fields,
                            .curve = curve};
  good = good && plot_write(path, 1, &panel);
  for (int i = 0; i < p->fields; i++) free(points[i]);
  return good ? DONE : FAILED;
}

/* ---- all ---- */

static int check(const vtu_grid *g, const picture *p, const skin *s)
{
  if (p->duals && g->kind != VTU_TRIANGLE && g->kind != VTU_PIXEL)
    return usage_error("plot: --duals is for triangles and rectangles");
  if (!(s->most[0] > s->least[0]) || !(s->most[1] > s->least[1]))
    return usage_error("plot: from this side nothing is seen of the grid; take another --view");
  if (p->strokes != NULL && s->faces > LINES_MOST)
    return usage_error("plot: %lld strokes, %d can be drawn", (long long)s->faces, LINES_MOST);
  if ((p->edges || p->duals) && s->edges > LINES_MOST)
    return usage_error("plot: %lld edges, %d can be drawn; name a --field, without --edges",
                       (long long)s->edges, LINES_MOST);
  return DONE;
}

int picture_draw(const char *path, const vtu_grid *g, const picture *p)
{
  canvas c = {.g = g, .p = p};
  if (g->kind == VTU_LINE) return draw_curves(path, g, p);
  if (!skin_make(g, &p->from, &c.s)) return FAILED;
  int code = check(g, p, &c.s);
  if (code == DONE && !gnuplot_draw(path, write_script, &c)) code = FAILED;
  skin_clear(&c.s);
  return code;
}
