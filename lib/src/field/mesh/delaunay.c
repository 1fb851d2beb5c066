/* Delaunay's triangulation of points in two to four dimensions, by qhull (Barber, Dobkin and
 * Huhdanpaa 1996), as the lower convex hull of the points lifted to a paraboloid. */
#include <libqhull_r/qhull_ra.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/volume.h"

/* Qhull's simplices before they become a mesh. */
typedef struct triangulation {
  int n;
  int64_t points, cells;
  const double *point;
  int *vertex; /* [cells*(n+1)] */
} triangulation;

/* Tell whether the volume of a simplex vanishes, as those of points on a line of the hull do. */
static int is_flat(const triangulation *t, const int *vertex)
{
  double edge[DVI_MESH_DIMENSION_MAX * DVI_MESH_DIMENSION_MAX], size = 1;
  for (int i = 0; i < t->n; i++) {
    double square = 0;
    for (int l = 0; l < t->n; l++) {
      const double difference = t->point[(int64_t)vertex[i + 1] * t->n + l] -
                                t->point[(int64_t)vertex[0] * t->n + l];
      edge[i * t->n + l] = difference;
      square += difference * difference;
    }
    size *= sqrt(square);
  }
  return fabs(dvi__determinant(t->n, edge)) <= 1e-12 * size;
}

/* Take the simplices of the lower hull. Without room for them they are only counted. */
static int64_t take_simplices(qhT *qh, const triangulation *t, int *into)
{
  facetT *facet;
  vertexT *vertex, **vertexp;
  int64_t count = 0;
  FORALLfacets
  {
    int corner[DVI_MESH_DIMENSION_MAX + 2], corners = 0;
    if (facet->upperdelaunay) continue;
    FOREACHvertex_(facet->vertices) if (corners <= t->n)
        corner[corners++] = qh_pointid(qh, vertex->point);
    if (corners != t->n + 1 || is_flat(t, corner)) continue;
    if (into != NULL) memcpy(into + count * corners, corner, (size_t)corners * sizeof *corner);
    count++;
  }
  return count;
}

/* Qhull writes into its copy of the points, and to a stream of its own. */
static dvi_status triangulate(triangulation *t, double *copy, FILE *silence)
{
  char command[] = "qhull d Qt Qbb Qc Q12";
  qhT qh;
  int short_memory, blocks;
  memset(&qh, 0, sizeof qh);
  qh_zero(&qh, silence);
  const int failed = qh_new_qhull(&qh, t->n, (int)t->points, copy, 0, command, NULL, silence);
  if (failed == 0) {
    t->cells = take_simplices(&qh, t, NULL);
    t->vertex = DVI_NEW(int, t->cells *(t->n + 1));
    if (t->vertex != NULL) (void)take_simplices(&qh, t, t->vertex);
  }
  qh_freeqhull(&qh, !qh_ALL);
  qh_memfreeshort(&qh, &short_memory, &blocks);
  if (failed != 0)
    return dvi__fail(
        failed == qh_ERRmem ? DVI_NO_MEMORY : DVI_BAD_ARGUMENT,
        "delaunay: qhull does not triangulate these %lld points (%d): do they lie in a "
        "plane?",
        (long long)t->points, failed);
  return t->vertex != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "delaunay: no memory");
}

/* Of as few points as corners there is one simplex. */
static dvi_status take_simplex(triangulation *t)
{
  t->cells = 1;
  t->vertex = DVI_NEW(int, t->n + 1);
  for (int i = 0; t->vertex != NULL && i <= t->n; i++) t->vertex[i] = i;
  return t->vertex != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "delaunay: no memory");
}

static dvi_status check_points(const triangulation *t)
{
  if (t->n < 2 || t->n > DVI_MESH_DIMENSION_MAX)
    return dvi__fail(DVI_BAD_SIZE, "delaunay: the dimension is %d, and must be 2 to %d", t->n,
                     (int)DVI_MESH_DIMENSION_MAX);
  if (t->points <= t->n || t->points >= INT_MAX)
    return dvi__fail(DVI_BAD_SIZE, "delaunay: %lld points are not enough, or too many",
                     (long long)t->points);
  for (int64_t i = 0; i < t->points * t->n; i++)
    if (!isfinite(t->point[i]))
      return dvi__fail(DVI_BAD_ARGUMENT, "delaunay: coordinate %d of point %lld is %g",
                       (int)(i % t->n), (long long)(i / t->n), t->point[i]);
  return DVI_OK;
}

dvi_status dvi_mesh_delaunay(int dimension, int64_t points, const double *point, dvi_mesh **mesh)
{
  triangulation t = {.n = dimension, .points = points, .point = point};
  if (point == NULL || mesh == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "delaunay: points and mesh are needed");
  *mesh = NULL;
  DVI_TRY(check_points(&t));
  double *copy = dvi__duplicate(point, (size_t)(points * dimension), sizeof *point);
  FILE *silence = fopen("/dev/null", "w");
  dvi_status status = dvi__fail(DVI_NO_MEMORY, "delaunay: no memory");
  if (points == dimension + 1)
    status = take_simplex(&t);
  else if (copy != NULL && silence != NULL)
    status = triangulate(&t, copy, silence);
  if (silence != NULL) (void)fclose(silence);
  dvi__release(copy);
  if (status == DVI_OK) {
    const dvi_mesh_terms terms = {.size = sizeof terms,
                                  .dimension = dimension,
                                  .points = points,
                                  .point = point,
                                  .cells = t.cells,
                                  .vertex = t.vertex};
    status = dvi_mesh_create(&terms, mesh);
    if (status != DVI_OK) dvi__fail_in(status, "delaunay");
  }
  dvi__release(t.vertex);
  return status;
}
