#include "view/stored_grids.h"

#include <stdlib.h>
#include <string.h>

#include "cli/command.h"

static int refuse(const char *path, const char *reason)
{
  complain("cannot read '%s': %s", path, reason);
  return FAILED;
}

bool stored_grids_are_wanted(const char *path)
{
  static const char ending[] = ".vtkhdf";
  const size_t length = strlen(path), end = sizeof ending - 1;
  return length > end && strcmp(path + length - end, ending) == 0;
}

int stored_grids_open(stored_grids *grids, const char *path)
{
  *grids = (stored_grids){.module = store_module(path)};
  if (grids->module == NULL) return FAILED;
  grids->file = grids->module->open_views(path, &grids->content);
  if (grids->file == NULL) return refuse(path, grids->module->reason());
  const hdf5_grid *grid = &grids->content.grid;
  if (vtu_corners(grid->type) != grid->corners || grid->corners == 0)
    return refuse(path, "its cells are no lines, triangles, pixels, tetrahedra or voxels");
  return DONE;
}

void stored_grids_close(stored_grids *grids)
{
  if (grids->file != NULL) grids->module->close_views(&grids->file);
  *grids = (stored_grids){.file = NULL};
}

/* Begin a grid, and make room for the values of the file's fields. False without memory. */
static bool take_room(const hdf5_views_content *content, vtu_grid *g, double **value)
{
  const hdf5_grid *from = &content->grid;
  *g = (vtu_grid){.kind = (vtu_cell)from->type,
                  .corners = from->corners,
                  .points = from->points,
                  .cells = from->cells};
  const size_t ids = (size_t)(g->cells * g->corners);
  g->point = calloc((size_t)g->points * 3, sizeof *g->point);
  g->vertex = calloc(ids, sizeof *g->vertex);
  if (g->point == NULL || g->vertex == NULL) return false;
  memcpy(g->vertex, from->vertex, ids * sizeof *g->vertex);
  for (int i = 0; i < content->fields; i++) {
    const hdf5_field *field = &content->field[i];
    const int64_t count = field->is_by_cell ? g->cells : g->points;
    value[i] = calloc((size_t)count * (size_t)field->components, sizeof *value[i]);
    if (value[i] == NULL) return false;
  }
  return true;
}

static int read_grid(const stored_grids *grids, int64_t step, const char *path, vtu_grid *g,
                     double **value)
{
  const hdf5_views_content *content = &grids->content;
  if (!take_room(content, g, value)) return refuse(path, "out of memory");
  if (!grids->module->read_view(grids->file, step, g->point, value))
    return refuse(path, grids->module->reason());
  const char *flaw = vtu_flaw(g);
  if (flaw != NULL) return refuse(path, flaw);
  for (int i = 0; i < content->fields; i++) {
    const hdf5_field *field = &content->field[i];
    if (!vtu_add_fields(g, field->name, field->is_by_cell, field->components, value[i]))
      return FAILED;
  }
  return DONE;
}

int stored_grids_read(const stored_grids *grids, int64_t step, const char *path, vtu_grid *grid)
{
  const int fields = grids->content.fields;
  double **value = calloc((size_t)fields + 1, sizeof *value);
  *grid = (vtu_grid){.points = 0};
  const int code = value != NULL ? read_grid(grids, step, path, grid, value)
                                 : refuse(path, "out of memory");
  for (int i = 0; i < fields && value != NULL; i++) free(value[i]);
  free(value);
  return code;
}
