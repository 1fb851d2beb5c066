/* Other frames: with a rotation g_s of the frame of each cell s, R_ts becomes g_t R_ts g_s^-1, and
 * the vectors E_i of the frame sum_j g_ij E_j. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/connection/connection.h"
#include "field/mesh/volume.h"

static const double rotation_slack = 1e-8;

static double determinant(int n, const double *R)
{
  double a[DVI__ROTATION_MAX];
  memcpy(a, R, (size_t)(n * n) * sizeof *a);
  return dvi__determinant(n, a);
}

static dvi_status check(const dvi_connection *connection, const double *gauge)
{
  if (connection == NULL || gauge == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "curvature: a connection and rotations are needed");
  const int n = connection->n;
  for (int64_t c = 0; c < connection->mesh->count[n]; c++)
    if (!(dvi__rotation_defect(n, gauge + c * n * n) <= rotation_slack) ||
        determinant(n, gauge + c * n * n) < 0)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "curvature: the matrix given for the frame of %s is no rotation up to %g",
                       dvi__name_cell(connection->mesh, n, c).text, rotation_slack);
  return DVI_OK;
}

/* Set c = b a^-1, then with a rotation of the target's frame a times that. */
static void change_rotations(dvi_connection *c, const double *gauge)
{
  const int n = c->n, entries = n * n;
  double inverse[DVI__ROTATION_MAX], half[DVI__ROTATION_MAX];
  for (int64_t f = 0; f < c->mesh->count[n - 1]; f++) {
    const int *cell = c->mesh->coface + 2 * f;
    if (cell[1] < 0) continue;
    dvi__rotation_inverse(n, gauge + (int64_t)cell[0] * entries, inverse);
    dvi__rotation_times(n, c->rotation + f * entries, inverse, half);
    dvi__rotation_times(n, gauge + (int64_t)cell[1] * entries, half, c->rotation + f * entries);
  }
}

static void change_lifts(dvi_connection *c, const double *old, const double *gauge)
{
  const int n = c->n, size = dvi__spin_size(n);
  double source[DVI__SPIN_MAX], target[DVI__SPIN_MAX], half[DVI__SPIN_MAX];
  for (int64_t f = 0; f < c->mesh->count[n - 1]; f++) {
    const int *cell = c->mesh->coface + 2 * f;
    if (cell[1] < 0) continue;
    dvi__spin_of(n, gauge + (int64_t)cell[0] * n * n, half);
    dvi__spin_inverse(n, half, source);
    dvi__spin_of(n, gauge + (int64_t)cell[1] * n * n, target);
    dvi__spin_times(n, old + f * size, source, half);
    dvi__spin_times(n, target, half, c->lifted + f * size);
  }
}

/* Multiply what stands in `block` [n*width] of each cell from the left. */
static void change_blocks(const dvi_connection *c, const double *gauge, int width, double *block)
{
  const int n = c->n;
  double old[DVI_MESH_DIMENSION_MAX * DVI_MESH_SPACE_MAX];
  for (int64_t cell = 0; cell < c->mesh->count[n]; cell++) {
    const double *g = gauge + cell * n * n;
    double *of = block + cell * n * width;
    memcpy(old, of, (size_t)(n * width) * sizeof *old);
    for (int i = 0; i < n; i++)
      for (int l = 0; l < width; l++) {
        double sum = 0;
        for (int j = 0; j < n; j++) sum += g[i * n + j] * old[j * width + l];
        of[i * width + l] = sum;
      }
  }
}

static dvi_status change(const dvi_connection *old, const double *gauge, dvi_connection *c)
{
  const int n = c->n;
  const size_t entries = (size_t)(c->mesh->count[n] * n * n);
  const int64_t lifts = c->mesh->count[n - 1] * dvi__spin_size(n);
  if (old->lifted != NULL) c->lifted = DVI_NEW(double, lifts);
  const int had_gauge = c->gauge != NULL;
  if (!had_gauge) c->gauge = dvi__duplicate(gauge, entries, sizeof *gauge);
  if (c->gauge == NULL || (old->lifted != NULL && c->lifted == NULL))
    return dvi__fail(DVI_NO_MEMORY, "curvature: no memory for a connection");
  if (had_gauge) change_blocks(c, gauge, n, c->gauge);
  if (c->frame != NULL) change_blocks(c, gauge, c->mesh->space, c->frame);
  change_rotations(c, gauge);
  if (c->lifted != NULL) change_lifts(c, old->lifted, gauge);
  return DVI_OK;
}

dvi_status dvi_connection_gauge(const dvi_connection *connection, const double *gauge,
                                dvi_connection **changed)
{
  if (changed == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "curvature: a place for the connection is needed");
  *changed = NULL;
  DVI_TRY(check(connection, gauge));
  DVI_TRY(dvi__connection_copy(connection, changed));
  const dvi_status status = change(connection, gauge, *changed);
  if (status != DVI_OK) dvi_connection_destroy(changed);
  return status;
}
