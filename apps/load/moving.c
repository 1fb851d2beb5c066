#include "load/moving.h"

#include <dvi/scene.h>
#include <stdlib.h>

#include "cli/command.h"
#include "csv/table.h"

int moving_views_make(const problem *scene, double t, const double *q, moving_views *views)
{
  const dvi_moving *moving = dvi_scene_moving(scene->scene);
  const char *name;
  *views = (moving_views){.count = 0};
  dvi_status status = dvi_moving_mesh(moving, t, q, &views->mesh);
  if (status != DVI_OK) return library_error(status);
  const int64_t nodes = dvi_mesh_count(views->mesh, 0);
  views->value = calloc((size_t)nodes * DVI_MOVING_COMPONENTS_MAX, sizeof *views->value);
  if (views->value == NULL) {
    complain("out of memory");
    return FAILED;
  }
  for (int c = 0;
       c < DVI_MOVING_COMPONENTS_MAX && (name = dvi_scene_component(scene->scene, c)) != NULL; c++)
    views->view[views->count++] = (dvi_view){
        .name = name, .values = views->value + c * nodes, .components = 1};
  status = dvi_moving_lift(moving, t, q, NULL, views->value);
  return status == DVI_OK ? DONE : library_error(status);
}

void moving_views_clear(moving_views *views)
{
  dvi_mesh_destroy(&views->mesh);
  free(views->value);
  views->value = NULL;
}

int moving_write(const problem *scene, const char *path, const moving_views *views)
{
  enum { MOST = DVI_MOVING_AXES_MAX + DVI_MOVING_COMPONENTS_MAX + 1 };
  const int axes = dvi_mesh_space(views->mesh);
  const double *point = dvi_mesh_points(views->mesh);
  table_column column[MOST] = {{NULL, NULL}};
  for (int d = 0; d < axes; d++) column[d] = (table_column){dvi_scene_axis(scene->scene, d), ""};
  for (int c = 0; c < views->count; c++) column[axes + c] = (table_column){views->view[c].name, ""};
  result_table *rows = table_create(column);
  for (int64_t i = 0; i < dvi_mesh_count(views->mesh, 0); i++) {
    for (int d = 0; d < axes; d++) table_number(rows, point[i * axes + d]);
    for (int c = 0; c < views->count; c++) table_number(rows, views->view[c].values[i]);
  }
  return table_finish(&rows, path) ? DONE : FAILED;
}
