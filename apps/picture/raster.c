#include "picture/raster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"

/* A triangle with the values at its corners. */
typedef struct triangle {
  const double *corner[3];
  double value[3];
} triangle;

static bool allocate(const skin *s, int pixels, raster *r)
{
  const double width = s->most[0] - s->least[0], height = s->most[1] - s->least[1];
  r->pixel = fmax(fmax(width, height), 1e-300) / pixels;
  r->width = (int)ceil(width / r->pixel) + 1;
  r->height = (int)ceil(height / r->pixel) + 1;
  r->least[0] = s->least[0];
  r->least[1] = s->least[1];
  const size_t all = (size_t)r->width * (size_t)r->height;
  r->value = calloc(all, sizeof *r->value);
  r->depth = calloc(all, sizeof *r->depth);
  if (r->value == NULL || r->depth == NULL) return false;
  for (size_t i = 0; i < all; i++) {
    r->value[i] = (double)NAN;
    r->depth[i] = -HUGE_VAL;
  }
  return true;
}

/* Twice the area of the triangle with the corners a, b and (x, y), with a sign. */
static double area_of(const double *a, const double *b, double x, double y)
{
  return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

static void draw_pixel(raster *r, const triangle *t, double whole, int i, int j)
{
  const double slack = -1e-9, x = r->least[0] + i * r->pixel, y = r->least[1] + j * r->pixel;
  double depth = 0, value = 0;
  for (int c = 0; c < 3; c++) {
    const double part = area_of(t->corner[(c + 1) % 3], t->corner[(c + 2) % 3], x, y) / whole;
    if (!(part >= slack)) return;
    depth += part * t->corner[c][2];
    value += part * t->value[c];
  }
  const size_t at = (size_t)j * (size_t)r->width + (size_t)i;
  if (!(depth > r->depth[at])) return;
  r->depth[at] = depth;
  r->value[at] = value;
}

static int pixel_of(double x, double least, double pixel, int count)
{
  const double at = floor((x - least) / pixel);
  return at < 0 ? 0 : at < count ? (int)at : count - 1;
}

static void draw_triangle(raster *r, const triangle *t)
{
  double least[2], most[2];
  for (int l = 0; l < 2; l++) {
    least[l] = fmin(fmin(t->corner[0][l], t->corner[1][l]), t->corner[2][l]);
    most[l] = fmax(fmax(t->corner[0][l], t->corner[1][l]), t->corner[2][l]);
  }
  const double whole = area_of(t->corner[0], t->corner[1], t->corner[2][0], t->corner[2][1]);
  if (whole == 0) return;
  const int left = pixel_of(least[0], r->least[0], r->pixel, r->width),
            right = pixel_of(most[0], r->least[0], r->pixel, r->width),
            low = pixel_of(least[1], r->least[1], r->pixel, r->height),
            high = pixel_of(most[1], r->least[1], r->pixel, r->height);
  for (int j = low; j <= high; j++)
    for (int i = left; i <= right; i++) draw_pixel(r, t, whole, i, j);
}

/* The cosine between the normal of a face and the rays. */
static double slope_of(const triangle *t)
{
  double u[3], v[3];
  for (int l = 0; l < 3; l++) {
    u[l] = t->corner[1][l] - t->corner[0][l];
    v[l] = t->corner[2][l] - t->corner[0][l];
  }
  const double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2],
               z = u[0] * v[1] - u[1] * v[0], length = sqrt(x * x + y * y + z * z);
  return length > 0 ? fabs(z) / length : 0;
}

/* Draw a face as triangles that begin at its first corner. */
static void draw_face(const skin *s, const vtu_field *field, const skin_face *face, raster *r)
{
  for (int i = 1; i + 1 < face->corners; i++) {
    const int64_t corner[3] = {face->vertex[0], face->vertex[i], face->vertex[i + 1]};
    triangle t;
    for (int c = 0; c < 3; c++) t.corner[c] = s->point + 3 * corner[c];
    const double slope = slope_of(&t);
    for (int c = 0; c < 3; c++)
      t.value[c] = field == NULL ? slope : field->value[field->is_by_cell ? face->cell : corner[c]];
    draw_triangle(r, &t);
  }
}

bool raster_make(const skin *s, const vtu_field *field, int pixels, raster *r)
{
  memset(r, 0, sizeof *r);
  if (!allocate(s, pixels, r)) {
    complain("out of memory");
    raster_clear(r);
    return false;
  }
  for (int64_t f = 0; f < s->faces; f++) draw_face(s, field, s->face + f, r);
  return true;
}

bool raster_hides(const raster *r, const double *point)
{
  const double clearly = 4 * r->pixel;
  const int i = pixel_of(point[0] + 0.5 * r->pixel, r->least[0], r->pixel, r->width),
            j = pixel_of(point[1] + 0.5 * r->pixel, r->least[1], r->pixel, r->height);
  return r->depth[(size_t)j * (size_t)r->width + (size_t)i] > point[2] + clearly;
}

void raster_clear(raster *r)
{
  free(r->value);
  free(r->depth);
  memset(r, 0, sizeof *r);
}
