#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/connection/connection.h"
#include "field/connection/surface.h"

static const double two_pi = 6.28318530717958647693;

static void times(const double *R, const double *v, double *turned)
{
  turned[0] = R[0] * v[0] + R[1] * v[1];
  turned[1] = R[2] * v[0] + R[3] * v[1];
}

/* Take the direction of each triangle from its parent in the tree, with a length of 1. */
static void spread(const dvi_connection *c, const dvi__surface *s, double *direction)
{
  for (int64_t i = 1; i < c->mesh->count[2]; i++) {
    const int cell = s->order[i], slot = s->parent[cell],
              parent = dvi__cell_behind(c->mesh, cell, slot);
    const int64_t edge = c->mesh->facet[2][3 * (int64_t)cell + slot];
    double R[4], v[2];
    memcpy(R, c->rotation + 4 * edge, sizeof R);
    if (c->mesh->coface[2 * edge] == cell) dvi__rotation_inverse(2, c->rotation + 4 * edge, R);
    times(R, direction + 2 * (int64_t)parent, v);
    const double length = hypot(v[0], v[1]);
    direction[2 * (int64_t)cell] = v[0] / length;
    direction[2 * (int64_t)cell + 1] = v[1] / length;
  }
}

static double largest_mismatch(const dvi_connection *c, int symmetry, const double *direction)
{
  double most = 0;
  for (int64_t e = 0; e < c->mesh->count[1]; e++) {
    const int *pair = c->mesh->coface + 2 * e;
    double v[2];
    if (pair[1] < 0) continue;
    const double *there = direction + 2 * (int64_t)pair[1];
    times(c->rotation + 4 * e, direction + 2 * (int64_t)pair[0], v);
    const double angle = atan2(v[0] * there[1] - v[1] * there[0],
                               v[0] * there[0] + v[1] * there[1]);
    most = fmax(most, fabs(remainder(angle, two_pi / symmetry)));
  }
  return most;
}

dvi_status dvi_connection_directions(const dvi_connection *connection, int64_t root, double angle,
                                     int symmetry, double *direction, double *mismatch)
{
  dvi__surface s;
  if (connection == NULL || direction == NULL || symmetry < 0 || !isfinite(angle))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "curvature: a connection, a finite angle and a place for directions are "
                     "needed");
  DVI_TRY(dvi__check_surface(connection->mesh));
  if (root < 0 || root >= connection->mesh->count[2])
    return dvi__fail(DVI_BAD_ARGUMENT, "curvature: triangle %lld, and the mesh has 0 to %lld",
                     (long long)root, (long long)connection->mesh->count[2] - 1);
  DVI_TRY(dvi__surface_create(connection->mesh, root, &s));
  direction[2 * root] = cos(angle);
  direction[2 * root + 1] = sin(angle);
  spread(connection, &s, direction);
  if (mismatch != NULL)
    *mismatch = largest_mismatch(connection, symmetry > 0 ? symmetry : 1, direction);
  dvi__surface_clear(&s);
  return DVI_OK;
}
