#define _POSIX_C_SOURCE 200809L
#include "frames/stored_views.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"
#include "module/ranks.h"

static const char place_name[] = "vertex";

dvi_status stored_views_write(const dvi_mesh *mesh, const double *point, const char *path,
                              int views, const dvi_view *view)
{
  return point != NULL ? dvi_mesh_write_moved(mesh, point, path, views, view)
                       : dvi_mesh_write(mesh, path, views, view);
}

/* ---- the grid ---- */

/* Read the grid back from a .vtu file, as which the library writes meshes: where space repeats
 * itself the grid has more points than the mesh. A field has the number of each point's vertex. */
static bool read_grid(const char *temporary, const dvi_mesh *mesh, const double *point,
                      vtu_grid *grid)
{
  const int64_t vertices = dvi_mesh_count(mesh, 0);
  double *number = calloc((size_t)vertices + 1, sizeof *number);
  if (number == NULL) {
    complain("out of memory");
    return false;
  }
  for (int64_t i = 0; i < vertices; i++) number[i] = (double)i;
  const dvi_view place = {place_name, number, 1, 0};
  const dvi_status status = stored_views_write(mesh, point, temporary, 1, &place);
  const bool good = status == DVI_OK ? vtu_read(temporary, grid) == DONE
                                     : library_error(status) == DONE;
  (void)unlink(temporary);
  free(number);
  return good;
}

/* Name a file beside the path, to be freed. Complains and returns NULL without memory. */
static char *name_beside(const char *path)
{
  const size_t size = strlen(path) + sizeof ".grid-.vtu" + 24;
  char *name = malloc(size);
  if (name != NULL)
    (void)snprintf(name, size, "%s.grid-%ld.vtu", path, (long)getpid());
  else
    complain("out of memory");
  return name;
}

static bool make_grid(const frame_place *place, const dvi_mesh *mesh, vtu_grid *grid)
{
  char *temporary = name_beside(place->path);
  vtu_clear(grid);
  const bool good = temporary != NULL && read_grid(temporary, mesh, place->point, grid);
  free(temporary);
  return good;
}

/* ---- fields ---- */

/* Give the values of a view at the grid's points, to be freed. NULL without memory. */
static double *place_values(const vtu_grid *grid, const dvi_view *view)
{
  const double *place = vtu_find(grid, place_name)->value;
  const size_t components = (size_t)view->components;
  double *value = calloc((size_t)grid->points * components + 1, sizeof *value);
  for (int64_t i = 0; i < grid->points && value != NULL; i++)
    memcpy(value + (size_t)i * components, view->values + (size_t)place[i] * components,
           components * sizeof *value);
  return value;
}

static void free_fields(int views, const dvi_view *view, hdf5_field *field)
{
  for (int i = 0; i < views && field != NULL; i++)
    if (field[i].value != view[i].values) free((void *)field[i].value);
  free(field);
}

/* Give the views as fields of the grid. NULL without memory, which is complained of. */
static hdf5_field *make_fields(const vtu_grid *grid, int64_t vertices, int views,
                               const dvi_view *view)
{
  hdf5_field *field = calloc((size_t)views + 1, sizeof *field);
  bool good = field != NULL;
  for (int i = 0; i < views && good; i++) {
    const bool is_placed = view[i].degree == 0 && grid->points != vertices;
    field[i] = (hdf5_field){.name = view[i].name,
                            .components = view[i].components,
                            .is_by_cell = view[i].degree > 0,
                            .value = is_placed ? place_values(grid, &view[i]) : view[i].values};
    good = field[i].value != NULL;
  }
  if (good) return field;
  complain("out of memory");
  free_fields(views, view, field);
  return NULL;
}

/* ---- the file ---- */

static bool create(stored_views *stored, const char *path, const hdf5_head *head,
                   const hdf5_grid *grid, int views, const hdf5_field *field)
{
  const hdf5_module *module = store_module(path);
  if (stored->frames != NULL) return true;
  if (!store_begin(&stored->file, path)) return false;
  stored->frames = module->create_frames(stored->file.temporary, head, grid, views, field);
  return stored->frames != NULL || store_refuse(path);
}

/* Write fields, on the grid if it is new or has moved. */
static bool add(stored_views *stored, const frame_place *place, bool has_grid, int views,
                const hdf5_field *field)
{
  const hdf5_module *module = store_module(place->path);
  const vtu_grid *drawn = &stored->grid;
  const hdf5_grid grid = {.points = drawn->points,
                          .cells = drawn->cells,
                          .corners = drawn->corners,
                          .type = (int)drawn->kind,
                          .point = drawn->point,
                          .vertex = drawn->vertex};
  const bool good = create(stored, place->path, place->head, &grid, views, field) &&
                    (module->add_frame(stored->frames, place->t, has_grid ? &grid : NULL, field) ||
                     store_refuse(place->path));
  /* With its first views the file comes to its place, where it grows. */
  return good && (stored->file.stream == NULL || file_keep(&stored->file));
}

static bool add_whole(stored_views *stored, const frame_place *place, const dvi_mesh *mesh,
                      int views, const dvi_view *view)
{
  const bool has_grid = place->point != NULL || stored->frames == NULL;
  if (has_grid && !make_grid(place, mesh, &stored->grid)) return false;
  hdf5_field *field = make_fields(&stored->grid, dvi_mesh_count(mesh, 0), views, view);
  const bool good = field != NULL && add(stored, place, has_grid, views, field);
  free_fields(views, view, field);
  return good;
}

/* ---- several processes ---- */

static bool read_rows(const hdf5_field *field, int64_t first, int64_t rows, double *value)
{
  return vtu_read_rows(field->of, field->is_by_cell, field->name, first, rows, value);
}

/* Add what a .vtu file has, block by block. */
static bool copy_views(stored_views *stored, const frame_place *place, const char *from, int views,
                       const dvi_view *view)
{
  const bool has_grid = place->point != NULL || stored->frames == NULL;
  hdf5_field *field = calloc((size_t)views + 1, sizeof *field);
  vtu_file *file = field != NULL ? vtu_open(from) : NULL;
  if (field == NULL) complain("out of memory");
  for (int i = 0; i < views && field != NULL; i++)
    field[i] = (hdf5_field){.name = view[i].name,
                            .components = view[i].components,
                            .is_by_cell = view[i].degree > 0,
                            .read = read_rows,
                            .of = file};
  const bool good = file != NULL && (!has_grid || vtu_read_grid(file, &stored->grid)) &&
                    add(stored, place, has_grid, views, field);
  vtu_clear(&stored->grid);
  vtu_close(&file);
  free(field);
  return good;
}

/* The first process gathers the views in a file beside its place, because it may have no memory
 * for those of the whole mesh. */
static bool add_shares(stored_views *stored, const frame_place *place, const dvi_mesh *mesh,
                       int views, const dvi_view *view)
{
  char *temporary = name_beside(place->path);
  if (ranks_agree(temporary != NULL ? DONE : FAILED) != DONE) {
    free(temporary);
    return false;
  }
  const dvi_status status = stored_views_write(mesh, place->point, temporary, views, view);
  bool good = status == DVI_OK || library_error(status) == DONE;
  if (ranks_is_first()) {
    good = good && copy_views(stored, place, temporary, views, view);
    (void)unlink(temporary);
  }
  free(temporary);
  return ranks_agree(good ? DONE : FAILED) == DONE;
}

bool stored_views_add(stored_views *stored, const frame_place *place, const dvi_mesh *mesh,
                      int views, const dvi_view *view)
{
  return (dvi_mesh_share_owners(mesh, 0) != NULL ? add_shares : add_whole)(stored, place, mesh,
                                                                           views, view);
}

bool stored_views_close(stored_views *stored, const char *path)
{
  bool good = true;
  if (stored->frames != NULL && !store_module(path)->close_frames(&stored->frames))
    good = store_refuse(path);
  file_discard(&stored->file);
  vtu_clear(&stored->grid);
  return good;
}
