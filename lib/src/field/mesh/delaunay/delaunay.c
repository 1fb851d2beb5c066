/* Delaunay's triangulation of points in two to four dimensions. The points are first moved and
 * scaled to a box of edge 1, with coordinates that are multiples of 2^-60. Of these the
 * triangulation is exact. Where points lie on common spheres up to rounding, it may have simplices
 * of hardly any volume between others. The points then get small weights, which decide on
 * which side of all spheres they are (Cheng, Dey, Edelsbrunner, Facello and Teng 2000). */
#include <limits.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/delaunay/insertion.h"
#include "field/mesh/delaunay/peel.h"
#include "field/mesh/volume.h"

/* An attempt takes weights of at most `weight` times the square of the distance to the next point.
 * Spheres are then empty up to this part, and simplices between others are hardly flatter. At the
 * hull those that are flatter than `peel` are removed, which is much more than weights change. The
 * attempt counts if no simplex is left that is flatter than `least`. Rounding errors of coordinates
 * make simplices of 1e-15, and dvi_mesh_create refuses those of 1e-14. */
typedef struct tolerance {
  double weight, peel, least;
} tolerance;

/* The last two attempts are for points that are moved out of a plane by as much as is removed. */
static const tolerance attempts[] = {
    {0, 1e-12, 1e-13},           {0x1p-38, 0x1p-30, 0x1p-30}, {0x1p-34, 0x1p-26, 0x1p-26},
    {0x1p-32, 0x1p-24, 0x1p-24}, {0x1p-30, 0x1p-22, 0x1p-22}, {0x1p-36, 0x1p-28, 1e-13},
    {0x1p-30, 0x1p-22, 1e-13},
};

enum { ATTEMPTS = sizeof attempts / sizeof *attempts };

/* ---- points ---- */

static dvi_status check_points(const dvi__sites *s, const double *point)
{
  if (s->n < 2 || s->n > DVI_MESH_DIMENSION_MAX)
    return dvi__fail(DVI_BAD_SIZE, "the dimension is %d, and must be 2 to %d", s->n,
                     (int)DVI_MESH_DIMENSION_MAX);
  if (s->points <= s->n || s->points >= INT_MAX)
    return dvi__fail(DVI_BAD_SIZE, "%lld points are not enough, or too many", (long long)s->points);
  for (int64_t i = 0; i < s->points * s->n; i++)
    if (!(fabs(point[i]) <= 0x1p1000))
      return dvi__fail(DVI_BAD_ARGUMENT, "coordinate %d of point %lld is %g", (int)(i % s->n),
                       (long long)(i / s->n), point[i]);
  return DVI_OK;
}

/* Give the middle of the points' box, and a power of two that is larger than its longest edge. */
static double find_box(const dvi__sites *s, const double *point, double *middle)
{
  double extent = 0;
  int exponent;
  for (int l = 0; l < s->n; l++) {
    double least = point[l], most = point[l];
    for (int64_t i = 1; i < s->points; i++) {
      least = fmin(least, point[i * s->n + l]);
      most = fmax(most, point[i * s->n + l]);
    }
    middle[l] = least + (most - least) / 2;
    extent = fmax(extent, most - least);
  }
  (void)frexp(extent, &exponent);
  return ldexp(1, exponent);
}

/* Move by multiples of the box's size, which keeps the digits of points near the origin and of
 * those far from it, and scale by a power of two. */
static void take_points(const dvi__sites *s, const double *point, double *x)
{
  double middle[DVI_MESH_DIMENSION_MAX] = {0};
  const double size = find_box(s, point, middle);
  for (int64_t i = 0; i < s->points * s->n; i++) {
    const double origin = size * ceil(middle[i % s->n] / size - 0.5);
    x[i] = nearbyint((point[i] - origin) / size * 0x1p60) * 0x1p-60;
  }
}

/* ---- weights ---- */

static double square_between(const dvi__sites *s, int a, int b)
{
  double square = 0;
  for (int l = 0; l < s->n; l++) {
    const double difference = s->x[(int64_t)a * s->n + l] - s->x[(int64_t)b * s->n + l];
    square += difference * difference;
  }
  return square;
}

/* Give the squares of the distances to the next points, which are Delaunay's neighbours. */
static void find_distances(const dvi__triangulation *t, double *square)
{
  const int n = t->sites->n;
  for (int64_t i = 0; i < t->sites->points; i++) square[i] = n;
  for (int c = 0; c < t->count; c++) {
    const int *vertex = t->simplex[c].vertex;
    for (int i = 0; i <= n && dvi__is_finite(t, c); i++)
      for (int j = 0; j < i; j++) {
        const double d = square_between(t->sites, vertex[i], vertex[j]);
        square[vertex[i]] = fmin(square[vertex[i]], d);
        square[vertex[j]] = fmin(square[vertex[j]], d);
      }
  }
}

/* Give weights that look random, and depend on the numbers of points and attempt. */
static void choose_weights(int64_t points, int number, const double *square, double *weight)
{
  for (int64_t i = 0; i < points; i++) {
    uint64_t bits = (uint64_t)(i * ATTEMPTS + number) * UINT64_C(0x9E3779B97F4A7C15);
    bits ^= bits >> 32;
    bits *= UINT64_C(0xD6E8FEB86659FD93);
    const double part = (double)(bits >> 32) * 0x1p-32 * attempts[number].weight;
    weight[i] = nearbyint(square[i] * part * 0x1p120) * 0x1p-120;
  }
}

/* ---- the mesh ---- */

/* Count the simplices of the hull, and the facets that only one of them has. */
static int64_t count_simplices(const dvi__triangulation *t, int64_t *outer)
{
  int64_t count = 0;
  *outer = 0;
  for (int c = 0; c < t->count; c++) {
    if (!dvi__is_finite(t, c)) continue;
    count++;
    for (int slot = 0; slot <= t->sites->n; slot++)
      *outer += !dvi__is_finite(t, t->simplex[c].neighbour[slot]);
  }
  return count;
}

static int *list_simplices(const dvi__triangulation *t, int64_t count)
{
  const int corners = t->sites->n + 1;
  int *list = DVI_NEW(int, count *corners), *to = list;
  for (int c = 0; c < t->count && list != NULL; c++)
    for (int i = 0; i < corners && dvi__is_finite(t, c); i++) *to++ = t->simplex[c].vertex[i];
  return list;
}

/* Give n! times the volume of the pyramid over all vertices but one, with its top in point p. Its
 * sign is that of the orientation of the simplex with p instead of this vertex. */
static double pyramid(const dvi__sites *s, const int *vertex, int slot, int p)
{
  double edge[DVI_MESH_DIMENSION_MAX * DVI_MESH_DIMENSION_MAX];
  for (int i = 0, k = 0; i <= s->n; i++)
    for (int l = 0; l < s->n && i != slot; l++)
      edge[k++] = s->x[(int64_t)vertex[i] * s->n + l] - s->x[(int64_t)p * s->n + l];
  const double determinant = dvi__determinant(s->n, edge);
  return slot % 2 ? -determinant : determinant;
}

/* Sum the pyramids from the first point to the sides of the hull, inside of which it lies. */
static double hull_volume(const dvi__triangulation *t)
{
  double sum = 0;
  for (int c = 0; c < t->count; c++) {
    const int *vertex = t->simplex[c].vertex;
    if (vertex[0] != DVI__UNUSED && !dvi__is_finite(t, c))
      sum -= pyramid(t->sites, vertex, dvi__slot_of(vertex, DVI__INFINITE), 0);
  }
  return sum;
}

/* Give the volume of the box around the points. */
static double box_volume(const dvi__sites *s)
{
  double volume = 1;
  for (int l = 0; l < s->n; l++) {
    double least = s->x[l], most = s->x[l];
    for (int64_t i = 1; i < s->points; i++) {
      least = fmin(least, s->x[i * s->n + l]);
      most = fmax(most, s->x[i * s->n + l]);
    }
    volume *= most - least;
  }
  return volume;
}

/* Compare the volume of the cells, and of what was removed, with the hull's. The errors of a
 * pyramid are below 1e-13 of the box. Only roundings may be removed. */
static dvi_status check_volume(const dvi__triangulation *t, const dvi_mesh *mesh)
{
  const int n = t->sites->n, *vertex = dvi_mesh_vertices(mesh, n, NULL);
  const int64_t cells = dvi_mesh_count(mesh, n);
  const double hull = hull_volume(t), error = 1e-13 * (double)cells * box_volume(t->sites),
               negligible = 1e-5;
  double filled = t->peeled;
  for (int64_t c = 0; c < cells; c++, vertex += n + 1)
    filled += fabs(pyramid(t->sites, vertex, 0, vertex[0]));
  if (fabs(filled - hull) <= 1e-9 * hull + error && t->peeled <= negligible * hull) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "the simplices fill %.12g of their hull: do the points nearly lie in a plane?",
                   (filled - t->peeled) / hull);
}

/* The mesh found its facets by comparing vertices. Compare them with the neighbours that the
 * triangulation knows. */
static dvi_status check_mesh(const dvi__triangulation *t, const dvi_mesh *mesh, int64_t outer)
{
  const int n = t->sites->n;
  const int64_t cells = dvi_mesh_count(mesh, n), facets = dvi_mesh_count(mesh, n - 1);
  int64_t boundary;
  (void)dvi_mesh_part_cells(mesh, "boundary", n - 1, &boundary);
  if (boundary == outer && 2 * facets == cells * (n + 1) + outer) return check_volume(t, mesh);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "%lld of %lld facets are at the boundary of the mesh, and %lld at that of the "
                   "triangulation: are points too close to each other?",
                   (long long)boundary, (long long)facets, (long long)outer);
}

static dvi_status make_mesh(const dvi__triangulation *t, const double *point, dvi_mesh **mesh)
{
  int64_t outer;
  const int64_t cells = count_simplices(t, &outer);
  int *vertex = list_simplices(t, cells);
  if (vertex == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = t->sites->n,
                                .points = t->sites->points,
                                .point = point,
                                .cells = cells,
                                .vertex = vertex};
  dvi_status status = dvi_mesh_create(&terms, mesh);
  dvi__release(vertex);
  if (status == DVI_OK) status = check_mesh(t, *mesh, outer);
  if (status != DVI_OK) dvi_mesh_destroy(mesh);
  return status;
}

/* ---- attempts ---- */

/* Triangulate, and remove the flat simplices at the hull. Gives the number of flat ones that stay,
 * and the squares of the distances to the next points if there is one. */
static dvi_status triangulate(const dvi__sites *s, const tolerance *allowed, dvi__triangulation *t,
                              double *square, int64_t *left)
{
  dvi__places flat = {0};
  dvi_status status = dvi__triangulate(s, t);
  if (status == DVI_OK) status = dvi__list_flat(t, allowed->peel, &flat);
  if (status == DVI_OK && flat.count > 0) {
    if (s->weight == NULL) find_distances(t, square);
    status = dvi__peel(t, allowed->least, &flat);
  }
  *left = flat.count;
  dvi__release(flat.at);
  return status;
}

/* After the last attempt dvi_mesh_create may still take the cells. */
static dvi_status try_weights(dvi__sites *s, double *square, const double *point, dvi_mesh **mesh)
{
  double *weight = square + s->points;
  dvi_status status = DVI_OK;
  int64_t flat = 1;
  for (int i = 0; i < ATTEMPTS && flat > 0 && status == DVI_OK; i++) {
    dvi__triangulation t;
    if (i > 0) {
      choose_weights(s->points, i, square, weight);
      s->weight = weight;
    }
    status = triangulate(s, &attempts[i], &t, square, &flat);
    if (status == DVI_OK && (flat == 0 || i == ATTEMPTS - 1)) status = make_mesh(&t, point, mesh);
    dvi__triangulation_clear(&t);
  }
  return status;
}

static dvi_status check_and_triangulate(dvi__sites *s, const double *point, dvi_mesh **mesh)
{
  DVI_TRY(check_points(s, point));
  double *x = DVI_NEW(double, s->points * s->n), *square = DVI_NEW(double, 2 * s->points);
  dvi_status status = dvi__fail(DVI_NO_MEMORY, "no memory for %lld points", (long long)s->points);
  if (x != NULL && square != NULL) {
    take_points(s, point, x);
    s->x = x;
    status = try_weights(s, square, point, mesh);
  }
  dvi__release(x);
  dvi__release(square);
  return status;
}

dvi_status dvi_mesh_delaunay(int dimension, int64_t points, const double *point, dvi_mesh **mesh)
{
  dvi__sites sites = {.n = dimension, .points = points};
  if (point == NULL || mesh == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "delaunay: points and mesh are needed");
  *mesh = NULL;
  const dvi_status status = check_and_triangulate(&sites, point, mesh);
  return status == DVI_OK ? status : dvi__fail_in(status, "delaunay");
}
