#include "mesh_file.h"

#include <dvi/petsc.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "core/status.h"
#include "field/mesh/given.h"

static const char layout[] = "dvi mesh 1";

const char *dvi__part_path(char path[DVI__PART_PATH], int p, const char *added)
{
  (void)snprintf(path, DVI__PART_PATH, "parts/%d%s", p, added);
  return path;
}

const char *dvi__cells_path(char path[DVI__PART_PATH], int p, int k)
{
  (void)snprintf(path, DVI__PART_PATH, "parts/%d/cells_%d", p, k);
  return path;
}

/* ---- read ---- */

static dvi_status read_kind(const dvi__slabs *file, dvi__mesh_head *head)
{
  char text[32];
  DVI_TRY(dvi__slabs_read_text(file, "layout", sizeof text, text));
  if (strcmp(text, layout) != 0)
    return dvi__slabs_refuse(file, "its layout is \"%s\" and not \"%s\"", text, layout);
  DVI_TRY(dvi__slabs_read_text(file, "kind", sizeof text, text));
  head->kind = strcmp(text, "boxes") == 0 ? DVI_BOXES : DVI_SIMPLICES;
  if (head->kind == DVI_BOXES || strcmp(text, "simplices") == 0) return DVI_OK;
  return dvi__slabs_refuse(file, "its cells are neither simplices nor boxes");
}

static dvi_status read_counts(const dvi__slabs *file, dvi__mesh_head *head)
{
  int64_t degrees, points, cells;
  int width;
  DVI_TRY(dvi__slabs_shape(file, "counts", &degrees, &width));
  DVI_TRY(dvi__slabs_shape(file, "points", &points, &head->space));
  DVI_TRY(dvi__slabs_shape(file, "cells", &cells, &head->corners));
  if (degrees < 2 || degrees > DVI_MESH_DIMENSION_MAX + 1)
    return dvi__slabs_refuse(file, "it has the counts of %lld degrees", (long long)degrees);
  head->n = (int)degrees - 1;
  DVI_TRY(dvi__slabs_read(file, &(dvi__slab){.name = "counts", .type = DVI__INT64, .rows = degrees},
                          head->count));
  if (head->space < head->n || head->space > DVI_MESH_SPACE_MAX)
    return dvi__slabs_refuse(file, "points of dimension %d have %d coordinates", head->n,
                             head->space);
  if (head->corners != (head->kind == DVI_BOXES ? 1 << head->n : head->n + 1))
    return dvi__slabs_refuse(file, "cells of dimension %d have %d corners", head->n, head->corners);
  if (head->count[0] != points || head->count[head->n] != cells || points < 1 || cells < 1)
    return dvi__slabs_refuse(file, "it has %lld points and %lld cells, and counts %lld and %lld",
                             (long long)points, (long long)cells, (long long)head->count[0],
                             (long long)head->count[head->n]);
  for (int k = 0; k <= head->n; k++)
    if (head->count[k] < 1 || head->count[k] >= INT_MAX)
      return dvi__fail(DVI_BAD_SIZE, "petsc: the mesh has %lld cells of degree %d",
                       (long long)head->count[k], k);
  return DVI_OK;
}

dvi_status dvi__read_head(const dvi__slabs *file, dvi__mesh_head *head)
{
  *head = (dvi__mesh_head){.parts = 0};
  DVI_TRY(read_kind(file, head));
  DVI_TRY(read_counts(file, head));
  DVI_TRY(dvi__slabs_read(file,
                          &(dvi__slab){.name = "metric", .type = DVI__DOUBLE, .rows = head->space},
                          head->metric));
  DVI_TRY(dvi__slabs_read(file,
                          &(dvi__slab){.name = "period", .type = DVI__DOUBLE, .rows = head->space},
                          head->period));
  head->is_oriented = dvi__slabs_have(file, "orientation");
  DVI_TRY(dvi__slabs_members(file, "parts", &head->parts));
  head->parts++;
  return DVI_OK;
}

/* ---- write ---- */

static dvi_status write_head(const dvi__slabs *file, const dvi_mesh *mesh)
{
  const int n = dvi_mesh_dimension(mesh), space = dvi_mesh_space(mesh);
  const double *metric, *period;
  int64_t count[DVI_MESH_DIMENSION_MAX + 1];
  dvi__mesh_axes(mesh, &metric, &period);
  for (int k = 0; k <= n; k++) count[k] = dvi_mesh_count(mesh, k);
  DVI_TRY(dvi__slabs_write_text(file, "layout", layout));
  DVI_TRY(dvi__slabs_write_text(file, "kind",
                                dvi_mesh_kind(mesh) == DVI_BOXES ? "boxes" : "simplices"));
  DVI_TRY(dvi__slabs_write(file, &(dvi__slab){.name = "counts", .type = DVI__INT64, .rows = n + 1},
                           count));
  DVI_TRY(dvi__slabs_write(file, &(dvi__slab){.name = "metric", .type = DVI__DOUBLE, .rows = space},
                           metric));
  return dvi__slabs_write(file, &(dvi__slab){.name = "period", .type = DVI__DOUBLE, .rows = space},
                          period);
}

static dvi_status write_cells(const dvi__slabs *file, const dvi_mesh *mesh)
{
  const int n = dvi_mesh_dimension(mesh);
  int corners;
  const int *cell = dvi_mesh_vertices(mesh, n, &corners);
  DVI_TRY(dvi__slabs_write(file,
                           &(dvi__slab){.name = "points",
                                        .type = DVI__DOUBLE,
                                        .rows = dvi_mesh_count(mesh, 0),
                                        .width = dvi_mesh_space(mesh)},
                           dvi_mesh_points(mesh)));
  dvi__slab slab = {
      .name = "cells", .type = DVI__INT32, .rows = dvi_mesh_count(mesh, n), .width = corners};
  DVI_TRY(dvi__slabs_write(file, &slab, cell));
  if (dvi_mesh_orientation(mesh) == NULL) return DVI_OK;
  slab = (dvi__slab){.name = "orientation", .type = DVI__INT8, .rows = slab.rows};
  return dvi__slabs_write(file, &slab, dvi_mesh_orientation(mesh));
}

/* Part 0 is "all". */
static dvi_status write_part(const dvi__slabs *file, const dvi_mesh *mesh, int p)
{
  char path[DVI__PART_PATH];
  const char *name = dvi_mesh_part_name(mesh, p);
  DVI_TRY(dvi__slabs_write_group(file, dvi__part_path(path, p, "")));
  DVI_TRY(dvi__slabs_write_text(file, dvi__part_path(path, p, "/name"), name));
  for (int k = 0; k <= dvi_mesh_part_degree(mesh, p); k++) {
    dvi__slab slab = {.name = dvi__cells_path(path, p, k), .type = DVI__INT32};
    const int *cell = dvi_mesh_part_cells(mesh, name, k, &slab.rows);
    DVI_TRY(dvi__slabs_write(file, &slab, cell));
  }
  return DVI_OK;
}

static dvi_status write_mesh(const dvi__slabs *file, const dvi_mesh *mesh)
{
  DVI_TRY(write_head(file, mesh));
  DVI_TRY(write_cells(file, mesh));
  DVI_TRY(dvi__slabs_write_group(file, "parts"));
  for (int p = 1; dvi_mesh_part_name(mesh, p) != NULL; p++) DVI_TRY(write_part(file, mesh, p));
  return DVI_OK;
}

dvi_status dvi_mesh_write_divided(const dvi_mesh *mesh, const char *path)
{
  dvi__slabs *file;
  if (mesh == NULL || path == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "petsc: a mesh and a path are needed");
  if (dvi_mesh_share_numbers(mesh, 0) != NULL)
    return dvi__fail(DVI_UNSUPPORTED, "petsc: a file in parts is written of a whole mesh, and this "
                                      "is a share (dvi_mesh_cut)");
  DVI_TRY(dvi__slabs_create(NULL, path, &file));
  const dvi_status status = write_mesh(file, mesh);
  const dvi_status ended = dvi__slabs_end(&file, status == DVI_OK);
  return status != DVI_OK ? status : ended;
}
