#include "picture/strokes.h"

#include <math.h>
#include <string.h>

#include "cli/command.h"

/* Length of a stroke, beside the root of its face's area. */
static const double part = 0.8;

int strokes_find(const vtu_grid *g, const char *name, stroke_field *field)
{
  for (int l = 0; l < 3; l++) {
    char full[VTU_NAME + 3];
    (void)snprintf(full, sizeof full, "%s_%c", name, "xyz"[l]);
    field->component[l] = vtu_find(g, full);
    if (l < 2 && (field->component[l] == NULL || !field->component[l]->is_by_cell))
      return usage_error("plot: --strokes %s: the grid has no vectors of this name in its cells",
                         name);
  }
  return DONE;
}

static void vector_of(const stroke_field *field, int64_t cell, double *vector)
{
  for (int l = 0; l < 3; l++)
    vector[l] = field->component[l] != NULL ? field->component[l]->value[cell] : 0;
}

static double length_of(const double *v)
{
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static double longest_of(const vtu_grid *g, const stroke_field *field)
{
  double most = 0;
  for (int64_t c = 0; c < g->cells; c++) {
    double v[3];
    vector_of(field, c, v);
    most = fmax(most, length_of(v));
  }
  return most;
}

/* Set the middle of a face, and return the root of its area. */
static double measure(const skin *s, const skin_face *face, double *middle)
{
  const double *corner[4];
  double u[3], v[3], normal[3];
  for (int i = 0; i < 4; i++)
    corner[i] = s->point + 3 * face->vertex[i < 3 || face->corners == 4 ? i : 2];
  for (int l = 0; l < 3; l++) {
    middle[l] = 0;
    for (int i = 0; i < face->corners; i++) middle[l] += corner[i][l] / face->corners;
    u[l] = corner[1][l] - corner[0][l];
    v[l] = corner[3][l] - corner[0][l];
  }
  for (int l = 0; l < 3; l++)
    normal[l] = u[(l + 1) % 3] * v[(l + 2) % 3] - u[(l + 2) % 3] * v[(l + 1) % 3];
  return sqrt(length_of(normal) * (face->corners == 3 ? 0.5 : 1));
}

int64_t strokes_write(FILE *script, const vtu_grid *g, const stroke_field *field,
                      const viewpoint *from, const skin *s, const raster *pixels)
{
  const double longest = longest_of(g, field);
  int64_t count = 0;
  for (int64_t f = 0; f < s->faces; f++) {
    const skin_face *face = s->face + f;
    double vector[3], turned[3], middle[3];
    vector_of(field, face->cell, vector);
    skin_turn(from, vector, turned);
    const double scale = part * measure(s, face, middle) / longest;
    if (!isfinite(scale) || (!from->is_flat && raster_hides(pixels, middle))) continue;
    (void)fprintf(script, "%.7g %.7g %.7g %.7g\n", middle[0] - 0.5 * scale * turned[0],
                  middle[1] - 0.5 * scale * turned[1], scale * turned[0], scale * turned[1]);
    count++;
  }
  return count;
}
