/* Fluxes g and Robin's terms a through the boundary, where l gets g u - a u^2/2. The sides of a box
 * have the quadrature of their axes, and the facets of a mesh one of Gauss. */
#include <dvi/quadrature.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/density/density.h"
#include "field/mesh/mesh.h"
#include "field/space/kind.h"

enum { FACET_POINTS = 4 /* of Gauss along an edge, and along two directions of a triangle */ };

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "density: no memory for a boundary");
}

/* ---- the term ---- */

static int boundary_density(int count, double t, const double *x, const double *z, double *l,
                            double *l_z, double *l_zz, void *user)
{
  const dvi__boundary_term *term = user;
  const dvi_density_condition *c = &term->given;
  double datum[DVI__BLOCK_MOST] = {0};
  if (c->datum != NULL && (l != NULL || l_z != NULL)) {
    const int failed = c->datum(count, term->is_moving ? t : 0, x, datum, c->user);
    if (failed != 0) return failed;
  }
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = z[k] * (datum[k] - 0.5 * c->robin * z[k]);
    if (l_z != NULL) l_z[k] = datum[k] - c->robin * z[k];
    if (l_zz != NULL) l_zz[k] = -c->robin;
  }
  return 0;
}

static int boundary_rate(int count, double t, const double *x, const double *z, double *l_t,
                         void *user)
{
  const dvi_density_condition *c = &((const dvi__boundary_term *)user)->given;
  const int failed = c->rate(count, t, x, l_t, NULL, c->user);
  for (int k = 0; k < count && failed == 0; k++) l_t[k] *= z[k];
  return failed;
}

/* ---- sides of boxes ---- */

static const char *const side_name[DVI_AXES_MAX][2] = {
    {"left", "right"}, {"bottom", "top"}, {"back", "front"}};

static int is_of_part(const dvi_space *space, const char *part, int d, int end)
{
  return !space->line[d].periodic &&
         (strcmp(part, "boundary") == 0 || strcmp(part, side_name[d][end]) == 0);
}

/* Return the number of points along an axis of a side that is across axis `across`. */
static int64_t points_along(const dvi_space *space, int across, int d)
{
  return d < space->lines && d != across ? dvi__line_points(space->line + d) : 1;
}

static int64_t points_of_side(const dvi_space *space, int across)
{
  int64_t points = 1;
  for (int d = 0; d < space->lines; d++) points *= points_along(space, across, d);
  return points;
}

/* Fill in the points of a side from point `first` of the part on. */
static void fill_side(const dvi_space *space, int across, int end, int64_t first,
                      dvi__density_part *part)
{
  const int64_t points = points_of_side(space, across);
  double *x = part->own, *weight = part->own + space->dimension * part->points;
  for (int64_t i = 0; i < points; i++) {
    int64_t rest = i;
    weight[first + i] = 1;
    for (int d = space->lines - 1; d >= 0; d--) {
      const int64_t along = points_along(space, across, d);
      const dvi__line *line = space->line + d;
      double factor = 1;
      x[d * part->points + first + i] = d != across ? dvi__line_point(line, rest % along, &factor)
                                        : end == 0  ? line->from
                                                    : line->to;
      weight[first + i] *= factor;
      rest /= along;
    }
  }
}

static dvi_status allocate_points(const dvi_density *density, int64_t points,
                                  dvi__density_part *part)
{
  part->points = points;
  part->own = DVI_NEW(double, (density->dimension + 1) * points);
  if (part->own == NULL) return no_memory();
  part->x = part->own;
  part->weight = part->own + density->dimension * points;
  return DVI_OK;
}

static dvi_status make_sides(const dvi_density *density, const char *name, dvi__density_part *part)
{
  const dvi_space *space = density->space;
  int64_t points = 0, first = 0;
  for (int d = 0; d < space->lines; d++)
    for (int end = 0; end < 2; end++)
      if (is_of_part(space, name, d, end)) points += points_of_side(space, d);
  DVI_TRY(allocate_points(density, points, part));
  for (int d = 0; d < space->lines; d++)
    for (int end = 0; end < 2; end++) {
      if (!is_of_part(space, name, d, end)) continue;
      fill_side(space, d, end, first, part);
      first += points_of_side(space, d);
    }
  return DVI_OK;
}

/* ---- facets of meshes ---- */

/* Place points on an edge or a triangle, from point `first` on. */
static void fill_facet(const dvi_mesh *mesh, const int *corner, int64_t first, const double *s,
                       const double *w, dvi__density_part *part)
{
  const int n = mesh->n, points = n == 2 ? FACET_POINTS : FACET_POINTS * FACET_POINTS;
  const double *from = mesh->point + (int64_t)corner[0] * n;
  double *x = part->own, *weight = part->own + n * part->points, along[2][DVI_AXES_MAX] = {{0}};
  for (int b = 0; b + 1 < n; b++) dvi__mesh_difference(mesh, corner[0], corner[b + 1], along[b]);
  const double *a = along[0], *b = along[1];
  const double size = n == 2 ? hypot(a[0], a[1])
                             : sqrt(pow(a[1] * b[2] - a[2] * b[1], 2) +
                                    pow(a[2] * b[0] - a[0] * b[2], 2) +
                                    pow(a[0] * b[1] - a[1] * b[0], 2));
  for (int i = 0; i < points; i++) {
    const int k = i % FACET_POINTS, m = i / FACET_POINTS;
    const double u = s[k], v = n == 2 ? 0 : s[m] * (1 - u);
    for (int d = 0; d < n; d++) x[d * part->points + first + i] = from[d] + u * a[d] + v * b[d];
    weight[first + i] = size * w[k] * (n == 2 ? 1 : w[m] * (1 - u));
  }
}

/* Tell if a facet is one of some ascending ones. */
static int has_facet(const int *facet, int64_t count, int of)
{
  int64_t low = 0, high = count;
  while (low < high) {
    const int64_t middle = (low + high) / 2;
    if (facet[middle] < of)
      low = middle + 1;
    else
      high = middle;
  }
  return low < count && facet[low] == of;
}

static dvi_status make_facets(const dvi_density *density, const char *name, dvi__density_part *part)
{
  const dvi_mesh *mesh = density->space->mesh;
  const int n = density->dimension, each = n == 2 ? FACET_POINTS : FACET_POINTS * FACET_POINTS;
  int64_t count, outer, points = 0, first = 0;
  int width;
  double s[FACET_POINTS], w[FACET_POINTS];
  const int *facet = dvi_mesh_part_cells(mesh, name, n - 1, &count),
            *boundary = dvi_mesh_part_cells(mesh, "boundary", n - 1, &outer),
            *vertex = dvi_mesh_vertices(mesh, n - 1, &width);
  DVI_TRY(dvi_quadrature(DVI_GAUSS, FACET_POINTS, s, w));
  for (int64_t i = 0; i < count; i++) points += each * has_facet(boundary, outer, facet[i]);
  if (points == 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "density: a flux is given on \"%s\", which has no facet of the boundary",
                     name);
  DVI_TRY(allocate_points(density, points, part));
  for (int64_t i = 0; i < count; i++) {
    if (!has_facet(boundary, outer, facet[i])) continue;
    fill_facet(mesh, vertex + (int64_t)facet[i] * width, first, s, w, part);
    first += each;
  }
  return DVI_OK;
}

/* ---- rows ---- */

static dvi_status add_row(const dvi_density *density, const double *x, dvi__density_part *part,
                          int64_t k)
{
  const int order[DVI_AXES_MAX] = {0};
  const int64_t first = part->trace.start[k], most = dvi__space_row_entries(density->space);
  int64_t count;
  DVI_TRY(dvi__space_row(density->space, order, x, most, part->trace.column + first,
                         part->trace.value + first, &count));
  part->trace.start[k + 1] = first + count;
  if (count > 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "density: a point of the boundary at x = %.6g is in no cell",
                   x[0]);
}

static dvi_status make_trace(const dvi_density *density, dvi__density_part *part)
{
  const int64_t entries = part->points * dvi__space_row_entries(density->space);
  DVI_TRY(dvi__csr_allocate(part->points, density->functions, entries, &part->trace));
  for (int64_t k = 0; k < part->points; k++) {
    double x[DVI_AXES_MAX] = {0};
    for (int d = 0; d < density->dimension; d++) x[d] = part->x[d * part->points + k];
    DVI_TRY(add_row(density, x, part, k));
  }
  return DVI_OK;
}

/* ---- parts ---- */

static dvi_status check_start(const dvi_density *density, const dvi_density_condition *condition,
                              const dvi__density_part *part)
{
  double *datum = DVI_NEW(double, part->points);
  if (datum == NULL) return no_memory();
  const int failed = condition->datum != NULL
                         ? condition->datum(part->points, 0, part->x, datum, condition->user)
                         : 0;
  const dvi_status status = dvi__density_check_datum(density, condition, failed, part->points,
                                                     part->x, datum);
  dvi__release(datum);
  return status;
}

static dvi_status add_flux(dvi_density *density, const dvi_density_condition *condition, int c)
{
  static const char name[] = "boundary";
  static const int pair[1][2] = {{0, 0}};
  dvi__density_part *part = density->part + density->parts++;
  const dvi_jet jet = {.component = c};
  part->boundary = DVI_NEW(dvi__boundary_term, 1);
  part->name = dvi__duplicate(name, sizeof name, 1);
  part->given = (dvi_density_part){.name = part->name,
                                   .kind = DVI_DENSITY_QUADRATIC,
                                   .variable = dvi__duplicate(&jet, 1, sizeof jet),
                                   .variables = 1,
                                   .pair = dvi__duplicate(pair, 1, sizeof pair),
                                   .pairs = 1,
                                   .density = boundary_density,
                                   .time_derivative = condition->rate ? boundary_rate : NULL,
                                   .user = part->boundary,
                                   .depends_on_time = condition->rate != NULL};
  if (!part->boundary || !part->name || !part->given.variable || !part->given.pair)
    return no_memory();
  *part->boundary = (dvi__boundary_term){.given = *condition, .is_moving = condition->rate != NULL};
  DVI_TRY(density->space->mesh != NULL ? make_facets(density, condition->part, part)
                                       : make_sides(density, condition->part, part));
  DVI_TRY(make_trace(density, part));
  density->count[DVI_DENSITY_QUADRATIC]++;
  return check_start(density, condition, part);
}

dvi_status dvi__density_add_fluxes(dvi_density *density, const dvi_density_terms *terms)
{
  for (int i = 0; i < terms->conditions; i++) {
    const dvi_density_condition *condition = terms->condition + i;
    if (condition->kind != DVI_FREE || (condition->datum == NULL && condition->robin == 0))
      continue;
    for (int c = 0; c < density->components; c++)
      if (condition->component < 0 || condition->component == c)
        DVI_TRY(add_flux(density, condition, c));
  }
  return DVI_OK;
}
