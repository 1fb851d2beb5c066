/* Levi and Civita's connection: through a facet with the orthonormal vectors f_k, and with the
 * outer normals n_s and n_t of its cells s and t, in the frames of s and of t,
 *
 *     R_ts = sum_k f_k(t) f_k(s)^T - n_t n_s^T
 *
 * (Froehlich 1992; Stern 2009, sec. 4.3.2). */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/connection/cell.h"
#include "field/connection/connection.h"
#include "field/connection/lengths.h"
#include "field/mesh/share.h"
#include "num/simd/fused.h"

/* Own rotations may be wrong by this. */
static const double rotation_slack = 1e-8;

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "curvature: no memory for a connection");
}

/* ---- rotations ---- */

/* `s` [n*n] and t are the bases in both cells. */
FUSED static void join_bases(int n, const dvi__twofold *s, dvi__twofold t[][DVI_MESH_DIMENSION_MAX],
                             double *R)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      dvi__twofold sum = {0, 0};
      for (int k = 0; k + 1 < n; k++) sum = dvi__twofold_add_product(sum, t[k][i], s[k * n + j]);
      R[i * n + j] = dvi__twofold_less_product(sum, t[n - 1][i], s[(n - 1) * n + j]).head;
    }
}

/* Join the bases of the facets of a cell to those of cells before it, which `first` [facets*n*n]
 * keeps. */
static void join_cell(dvi_connection *c, int64_t cell, const dvi__laid_cell *laid,
                      dvi__twofold *first)
{
  const int n = c->n;
  for (int slot = 0; slot <= n; slot++) {
    const int64_t facet = c->mesh->facet[n][cell * (n + 1) + slot];
    const int *pair = c->mesh->coface + 2 * facet;
    dvi__twofold basis[DVI_MESH_DIMENSION_MAX][DVI_MESH_DIMENSION_MAX];
    if (pair[1] < 0) continue;
    dvi__facet_basis(laid, slot, basis);
    for (int k = 0; k < n && pair[0] == cell; k++)
      memcpy(first + (facet * n + k) * n, basis[k], (size_t)n * sizeof *first);
    if (pair[1] == cell) join_bases(n, first + facet * n * n, basis, c->rotation + facet * n * n);
  }
}

/* Lay out each cell once, for its frame in space and, with `first`, its rotations. */
static dvi_status lay_cells(dvi_connection *c, dvi__twofold *first)
{
  const size_t space = (size_t)c->mesh->space;
  dvi__laid_cell laid;
  for (int64_t cell = 0; cell < c->mesh->count[c->n]; cell++) {
    DVI_TRY(dvi__lay_cell(c->mesh, c->length, cell, &laid));
    for (int i = 0; i < c->n && c->frame != NULL; i++)
      memcpy(c->frame + (size_t)(cell * c->n + i) * space, laid.frame[i], space * sizeof(double));
    if (first != NULL) join_cell(c, cell, &laid, first);
  }
  return DVI_OK;
}

static dvi_status set_rotations(dvi_connection *c)
{
  dvi__twofold *first = DVI_NEW(dvi__twofold, c->mesh->count[c->n - 1] * c->n * c->n);
  const dvi_status status = first != NULL ? lay_cells(c, first) : no_memory();
  dvi__release(first);
  return status;
}

static dvi_status copy_rotations(dvi_connection *c, const double *rotation)
{
  const int entries = c->n * c->n;
  c->is_own = 1;
  for (int64_t f = 0; f < c->mesh->count[c->n - 1]; f++) {
    if (c->mesh->coface[2 * f + 1] < 0) continue;
    const double defect = dvi__rotation_defect(c->n, rotation + f * entries);
    if (!(defect <= rotation_slack))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "curvature: the matrix given for %s is no rotation, R R^T - 1 has an entry "
                       "of %g, %g at most",
                       dvi__name_cell(c->mesh, c->n - 1, f).text, defect, rotation_slack);
    memcpy(c->rotation + f * entries, rotation + f * entries, (size_t)entries * sizeof *rotation);
  }
  return DVI_OK;
}

/* ---- all ---- */

static dvi_status allocate(dvi_connection *c, const double *length)
{
  const int64_t cells = c->mesh->count[c->n], facets = c->mesh->count[c->n - 1];
  c->rotation = DVI_NEW(double, facets * c->n * c->n);
  if (length != NULL)
    c->length = dvi__duplicate(length, (size_t)c->mesh->count[1], sizeof *length);
  else
    c->frame = DVI_NEW(double, cells * c->n * c->mesh->space);
  if (c->rotation == NULL || (c->length == NULL && c->frame == NULL)) return no_memory();
  return DVI_OK;
}

static dvi_status fill(dvi_connection *c, const dvi_connection_options *options)
{
  DVI_TRY(allocate(c, options->length));
  DVI_TRY(dvi__rings_create(c->mesh, &c->rings));
  if (options->rotation != NULL) {
    DVI_TRY(copy_rotations(c, options->rotation));
    DVI_TRY(lay_cells(c, NULL));
  } else {
    DVI_TRY(set_rotations(c));
  }
  DVI_TRY(dvi__find_loops(c));
  return options->spin ? dvi__connection_lift(c) : DVI_OK;
}

dvi_status dvi_connection_create(const dvi_mesh *mesh, const dvi_connection_options *options,
                                 dvi_connection **connection)
{
  const dvi_connection_options defaults = {.size = sizeof defaults};
  if (connection == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "curvature: a place for the connection is needed");
  *connection = NULL;
  if (options == NULL) options = &defaults;
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT, "curvature: options of size %zu, %zu expected",
                     options->size, sizeof *options);
  DVI_TRY(dvi__check_metric(mesh, options->length));
  DVI_TRY(dvi__refuse_share(mesh, "curvature: a connection"));
  dvi_connection *c = DVI_NEW(dvi_connection, 1);
  if (c == NULL) return no_memory();
  c->mesh = dvi_mesh_share(mesh);
  c->n = mesh->n;
  const dvi_status status = fill(c, options);
  if (status != DVI_OK) dvi_connection_destroy(&c);
  *connection = c;
  return status;
}

void dvi_connection_destroy(dvi_connection **connection)
{
  if (connection == NULL || *connection == NULL) return;
  dvi_connection *c = *connection;
  dvi__release(c->length);
  dvi__release(c->frame);
  dvi__release(c->gauge);
  dvi__release(c->rotation);
  dvi__release(c->lifted);
  dvi__rings_clear(&c->rings);
  dvi__release(c->loop_start);
  dvi__release(c->loop_cell);
  dvi_mesh_destroy(&c->mesh);
  dvi__release(c);
  *connection = NULL;
}

/* ---- copies ---- */

/* Copy an array that may be missing. Returns 0 without memory. */
static int copy_array(const double *from, int64_t count, double **to)
{
  if (from == NULL) return 1;
  *to = dvi__duplicate(from, (size_t)count, sizeof *from);
  return *to != NULL;
}

static int copy_arrays(const dvi_connection *from, dvi_connection *to)
{
  const int entries = from->n * from->n;
  const int64_t cells = from->mesh->count[from->n], facets = from->mesh->count[from->n - 1];
  const size_t steps = from->loops > 0 ? (size_t)from->loop_start[from->loops] : 0;
  if (from->loops > 0) {
    to->loops = from->loops;
    to->loop_start = dvi__duplicate(from->loop_start, (size_t)from->loops + 1,
                                    sizeof *from->loop_start);
    to->loop_cell = dvi__duplicate(from->loop_cell, steps, sizeof *from->loop_cell);
    if (to->loop_start == NULL || to->loop_cell == NULL) return 0;
  }
  return copy_array(from->length, from->mesh->count[1], &to->length) &&
         copy_array(from->frame, cells * from->n * from->mesh->space, &to->frame) &&
         copy_array(from->gauge, cells * entries, &to->gauge) &&
         copy_array(from->rotation, facets * entries, &to->rotation);
}

dvi_status dvi__connection_copy(const dvi_connection *connection, dvi_connection **copy)
{
  dvi_connection *c = DVI_NEW(dvi_connection, 1);
  dvi_status status = DVI_OK;
  *copy = NULL;
  if (c == NULL) return no_memory();
  c->mesh = dvi_mesh_share(connection->mesh);
  c->n = connection->n;
  c->is_own = connection->is_own;
  if (!copy_arrays(connection, c)) status = no_memory();
  if (status == DVI_OK) status = dvi__rings_copy(c->mesh, &connection->rings, &c->rings);
  if (status != DVI_OK) dvi_connection_destroy(&c);
  *copy = c;
  return status;
}
