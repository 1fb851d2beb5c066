/* Transport along paths of cells. Matrices of later steps stand to the left. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/connection/cell.h"
#include "field/connection/connection.h"

const dvi_mesh *dvi_connection_mesh(const dvi_connection *connection)
{
  return connection != NULL ? connection->mesh : NULL;
}

const int *dvi_connection_ring(const dvi_connection *connection, int64_t hinge, int64_t *count)
{
  if (count != NULL) *count = 0;
  if (connection == NULL || hinge < 0 || hinge >= connection->mesh->count[connection->n - 2])
    return NULL;
  const dvi__rings *r = &connection->rings;
  if (count != NULL) *count = r->start[hinge + 1] - r->start[hinge];
  return r->cell + r->start[hinge];
}

/* ---- frames ---- */

const double *dvi_connection_frame(const dvi_connection *connection, int64_t cell)
{
  if (connection == NULL || connection->frame == NULL || cell < 0 ||
      cell >= connection->mesh->count[connection->n])
    return NULL;
  return connection->frame + cell * connection->n * connection->mesh->space;
}

/* Rotations of larger components might overflow. */
static const double largest_component = 1e300;

static dvi_status check_components(size_t count, const double *component)
{
  for (size_t i = 0; i < count; i++)
    if (!(fabs(component[i]) <= largest_component))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "curvature: component %zu of the vectors is %g, and %g is the largest size",
                       i, component[i], largest_component);
  return DVI_OK;
}

dvi_status dvi_connection_vectors(const dvi_connection *connection, const double *component,
                                  double *vector)
{
  if (connection == NULL || component == NULL || vector == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "curvature: a connection, components and a place for vectors are needed");
  if (connection->frame == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "curvature: the metric is that of lengths, and has no vectors in space");
  const int n = connection->n, space = connection->mesh->space;
  DVI_TRY(check_components((size_t)(connection->mesh->count[n] * n), component));
  for (int64_t c = 0; c < connection->mesh->count[n]; c++)
    for (int l = 0; l < space; l++) {
      double sum = 0;
      for (int i = 0; i < n; i++)
        sum += component[c * n + i] * connection->frame[(c * n + i) * space + l];
      vector[c * space + l] = sum;
    }
  return DVI_OK;
}

/* ---- steps ---- */

void dvi__connection_step(const dvi_connection *c, int64_t cell, int slot, double *R, double *lift)
{
  const int n = c->n, entries = n * n, size = dvi__spin_size(n);
  const int64_t facet = c->mesh->facet[n][cell * (n + 1) + slot];
  const int is_forward = c->mesh->coface[2 * facet] == cell;
  double step[DVI__ROTATION_MAX], old[DVI__ROTATION_MAX];
  memcpy(old, R, (size_t)entries * sizeof *R);
  memcpy(step, c->rotation + facet * entries, (size_t)entries * sizeof *R);
  if (!is_forward) dvi__rotation_inverse(n, c->rotation + facet * entries, step);
  dvi__rotation_times(n, step, old, R);
  if (lift == NULL) return;
  memcpy(old, lift, (size_t)size * sizeof *lift);
  memcpy(step, c->lifted + facet * size, (size_t)size * sizeof *lift);
  if (!is_forward) dvi__spin_inverse(n, c->lifted + facet * size, step);
  dvi__spin_times(n, step, old, lift);
}

static dvi_status check_lift(const dvi_connection *connection, const void *lifted)
{
  if (lifted != NULL && connection->lifted == NULL)
    return dvi__fail(DVI_BAD_STATE,
                     "curvature: the connection has no lift; create it with the option spin");
  return DVI_OK;
}

static dvi_status check_path(const dvi_connection *connection, int64_t count, const int *cell)
{
  if (connection == NULL || cell == NULL || count < 1)
    return dvi__fail(DVI_BAD_ARGUMENT, "curvature: a connection and a path of cells are needed");
  for (int64_t i = 0; i < count; i++)
    if (cell[i] < 0 || cell[i] >= connection->mesh->count[connection->n])
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "curvature: the path has cell %d, and the mesh has those from 0 to %lld",
                       cell[i], (long long)connection->mesh->count[connection->n] - 1);
  return DVI_OK;
}

/* Find the facet to the next cell. */
static dvi_status find_slot(const dvi_connection *c, int cell, int next, int *slot)
{
  for (*slot = 0; *slot <= c->n; ++*slot)
    if (dvi__cell_behind(c->mesh, cell, *slot) == next) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "curvature: the path goes from %s to %s, which share no %s",
                   dvi__name_cell(c->mesh, c->n, cell).text,
                   dvi__name_cell(c->mesh, c->n, next).text,
                   dvi__degree_name(DVI_SIMPLICES, c->n - 1));
}

/* ---- paths ---- */

dvi_status dvi_connection_along(const dvi_connection *connection, int64_t count, const int *cell,
                                double *rotation, double *lifted)
{
  double R[DVI__ROTATION_MAX], lift[DVI__SPIN_MAX];
  int slot;
  DVI_TRY(check_path(connection, count, cell));
  DVI_TRY(check_lift(connection, lifted));
  const int n = connection->n;
  dvi__rotation_one(n, R);
  dvi__spin_one(n, lift);
  for (int64_t i = 0; i + 1 < count; i++) {
    DVI_TRY(find_slot(connection, cell[i], cell[i + 1], &slot));
    dvi__connection_step(connection, cell[i], slot, R, lifted != NULL ? lift : NULL);
  }
  if (rotation != NULL) memcpy(rotation, R, (size_t)(n * n) * sizeof *R);
  if (lifted != NULL) memcpy(lifted, lift, (size_t)dvi__spin_size(n) * sizeof *lift);
  return DVI_OK;
}

dvi_status dvi_connection_transport(const dvi_connection *connection, int64_t count,
                                    const int *cell, const double *vector, double *moved)
{
  DVI_TRY(check_path(connection, count, cell));
  if (vector == NULL || moved == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "curvature: a vector and a place for it are needed");
  const int n = connection->n;
  DVI_TRY(check_components((size_t)n, vector));
  memcpy(moved, vector, (size_t)n * sizeof *moved);
  for (int64_t i = 0; i + 1 < count; i++) {
    double R[DVI__ROTATION_MAX];
    int slot;
    DVI_TRY(find_slot(connection, cell[i], cell[i + 1], &slot));
    dvi__rotation_one(n, R);
    dvi__connection_step(connection, cell[i], slot, R, NULL);
    for (int k = 0; k < n; k++) {
      double sum = 0;
      for (int l = 0; l < n; l++) sum += R[k * n + l] * moved[i * n + l];
      moved[(i + 1) * n + k] = sum;
    }
  }
  return DVI_OK;
}

/* ---- hinges ---- */

static dvi_status check_hinge(const dvi_connection *connection, int64_t hinge)
{
  if (connection == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "curvature: a connection is needed");
  const int n = connection->n;
  const int64_t hinges = connection->mesh->count[n - 2];
  if (hinge < 0 || hinge >= hinges)
    return dvi__fail(DVI_BAD_ARGUMENT, "curvature: hinge %lld, and the mesh has 0 to %lld",
                     (long long)hinge, (long long)hinges - 1);
  if (connection->rings.is_open[hinge])
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "curvature: %s is on the boundary, and no loop of cells goes around it",
                     dvi__name_cell(connection->mesh, n - 2, hinge).text);
  return DVI_OK;
}

dvi_status dvi_connection_holonomy(const dvi_connection *connection, int64_t hinge,
                                   double *rotation, double *lifted)
{
  double R[DVI__ROTATION_MAX], lift[DVI__SPIN_MAX];
  DVI_TRY(check_hinge(connection, hinge));
  DVI_TRY(check_lift(connection, lifted));
  const int n = connection->n;
  const dvi__rings *r = &connection->rings;
  dvi__rotation_one(n, R);
  dvi__spin_one(n, lift);
  for (int64_t at = r->start[hinge]; at < r->start[hinge + 1]; at++)
    dvi__connection_step(connection, r->cell[at], r->leave[at], R, lifted != NULL ? lift : NULL);
  if (rotation != NULL) memcpy(rotation, R, (size_t)(n * n) * sizeof *R);
  if (lifted != NULL) memcpy(lifted, lift, (size_t)dvi__spin_size(n) * sizeof *lift);
  return DVI_OK;
}

static void turn_vector(int n, const double *R, double *v)
{
  double turned[DVI_MESH_DIMENSION_MAX] = {0};
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) turned[i] += R[i * n + j] * v[j];
  memcpy(v, turned, (size_t)n * sizeof *v);
}

dvi_status dvi__hinge_plane(const dvi_connection *c, int64_t hinge, dvi__plane *plane)
{
  const int64_t at = c->rings.start[hinge], cell = c->rings.cell[at];
  dvi__laid_cell laid;
  DVI_TRY(dvi__lay_cell(c->mesh, c->length, cell, &laid));
  dvi__normal_plane(&laid, c->rings.leave[at], c->rings.enter[at], plane->first, plane->second);
  if (c->gauge == NULL) return DVI_OK;
  turn_vector(c->n, c->gauge + cell * c->n * c->n, plane->first);
  turn_vector(c->n, c->gauge + cell * c->n * c->n, plane->second);
  return DVI_OK;
}

static double distance(int count, const double *a, const double *b)
{
  double most = 0;
  for (int i = 0; i < count; i++) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

dvi_status dvi_connection_turn(const dvi_connection *connection, int64_t hinge, double *angle,
                               double *rest)
{
  double R[DVI__ROTATION_MAX], lift[DVI__SPIN_MAX] = {0}, turn[DVI__ROTATION_MAX];
  dvi__plane plane;
  DVI_TRY(check_hinge(connection, hinge));
  if (angle == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "curvature: a place for it is needed");
  const int n = connection->n, is_lifted = connection->lifted != NULL;
  DVI_TRY(dvi_connection_holonomy(connection, hinge, R, is_lifted ? lift : NULL));
  DVI_TRY(dvi__hinge_plane(connection, hinge, &plane));
  *angle = is_lifted ? dvi__spin_angle(n, &plane, lift) : dvi__rotation_angle(n, &plane, R);
  if (rest == NULL) return DVI_OK;
  dvi__rotation_turn(n, &plane, *angle, turn);
  *rest = distance(n * n, R, turn);
  if (!is_lifted) return DVI_OK;
  dvi__spin_turn(n, &plane, *angle, turn);
  *rest = fmax(*rest, distance(dvi__spin_size(n), lift, turn));
  return DVI_OK;
}
