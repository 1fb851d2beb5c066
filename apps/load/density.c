#include "load/density.h"

#include <dvi/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "csv/table.h"

enum { TEXT_SIZE = 4096, NAME_SIZE = 64 };

const dvi_density *density_of(const problem *scene)
{
  return dvi_scene_density(scene->scene);
}

bool has_field(const problem *scene)
{
  return density_of(scene) != NULL || dvi_scene_field(scene->scene) != NULL;
}

void density_warn(const char *command, const problem *scene, const char *method)
{
  if (dvi_scene_schroedinger(scene->scene) == NULL || strncmp(method, "vprk", 4) == 0) return;
  complain("%s: %s does not keep the norm of the wave function; midpoint, gauss:stages=2, "
           "split:order=4 and vprk do",
           command, method);
}

int64_t field_unknowns(const problem *scene)
{
  int64_t unknowns = 0;
  if (density_of(scene) != NULL)
    (void)dvi_density_unknowns(density_of(scene), &unknowns);
  else
    (void)dvi_field_unknowns(dvi_scene_field(scene->scene), &unknowns);
  return unknowns;
}

void density_tell(const problem *scene)
{
  char text[TEXT_SIZE];
  double omega = 0.0;
  dvi_scene_density_explain(scene->scene, text, sizeof text);
  (void)fputs(text, stdout);
  if (dvi_density_fastest(density_of(scene), &omega) == DVI_OK && omega > 0.0)
    (void)printf("largest frequency of the quadratic part: %.6g; verlet is stable below h = %.6g\n",
                 omega, 2.0 / omega);
}

int64_t density_coefficients(const dvi_density *density)
{
  return dvi_density_components(density) * dvi_space_functions(dvi_density_space(density));
}

/* ---- values ---- */

/* The values of some fields at points, with names for columns. */
typedef struct sampled {
  const problem *scene;
  int count, components;
  int64_t points;
  const double *x;
  double *value; /* [count][components][points] */
  char (*name)[NAME_SIZE];
} sampled;

static int out_of_memory(void)
{
  complain("out of memory");
  return FAILED;
}

static void name_values(sampled *s)
{
  for (int i = 0; i < s->count; i++)
    for (int c = 0; c < s->components; c++) {
      const char *component = dvi_scene_component(s->scene->scene, c);
      char *name = s->name[i * s->components + c];
      if (s->count > 1)
        (void)snprintf(name, NAME_SIZE, "%s_mode_%d", component, i + 1);
      else
        (void)snprintf(name, NAME_SIZE, "%s", component);
    }
}

static int sampled_make(const problem *scene, int count, int64_t points, const double *x,
                        sampled *s)
{
  const int components = dvi_density_components(density_of(scene));
  const size_t series = (size_t)count * (size_t)components;
  *s = (sampled){
      .scene = scene, .count = count, .components = components, .points = points, .x = x};
  s->value = calloc(series * (size_t)points, sizeof *s->value);
  s->name = calloc(series, sizeof *s->name);
  if (s->value == NULL || s->name == NULL) return out_of_memory();
  name_values(s);
  return DONE;
}

static void sampled_clear(sampled *s)
{
  free(s->value);
  free(s->name);
}

/* Evaluate all components at the quadrature points, or at vertices. */
static int sample(sampled *s, bool at_vertices, const double *U)
{
  static const int none[DVI_AXES_MAX] = {0};
  const dvi_space *space = dvi_density_space(density_of(s->scene));
  const int64_t functions = dvi_space_functions(space);
  dvi_status status = DVI_OK;
  for (int k = 0; k < s->count * s->components && status == DVI_OK; k++) {
    double *value = s->value + k * s->points;
    status = at_vertices
                 ? dvi_space_evaluate(space, none, U + k * functions, s->points, s->x, value)
                 : dvi_space_apply(space, none, U + k * functions, value);
  }
  return status == DVI_OK ? DONE : library_error(status);
}

/* ---- files ---- */

static int write_rows(const sampled *s, const char *path)
{
  const dvi_space *space = dvi_density_space(density_of(s->scene));
  const int axes = dvi_space_dimension(space), series = s->count * s->components;
  table_column *column = calloc((size_t)(axes + series) + 1, sizeof *column);
  if (column == NULL) return out_of_memory();
  for (int d = 0; d < axes; d++) column[d] = (table_column){dvi_space_axis(space, d), ""};
  for (int k = 0; k < series; k++) column[axes + k] = (table_column){s->name[k], ""};
  result_table *rows = table_create(column);
  for (int64_t i = 0; i < s->points; i++) {
    for (int d = 0; d < axes; d++) table_number(rows, s->x[d * s->points + i]);
    for (int k = 0; k < series; k++) table_number(rows, s->value[k * s->points + i]);
  }
  const bool good = table_good(rows) && table_write(rows, path);
  table_destroy(&rows);
  free(column);
  return good ? DONE : FAILED;
}

int density_write(const problem *scene, const char *path, int count, const double *U)
{
  const double *x;
  const int64_t points = dvi_space_points(dvi_density_space(density_of(scene)), &x, NULL);
  sampled s;
  int code = sampled_make(scene, count, points, x, &s);
  if (code == DONE) code = sample(&s, false, U);
  if (code == DONE) code = write_rows(&s, path);
  sampled_clear(&s);
  return code;
}

/* ---- views ---- */

/* The values behind views. */
struct density_values {
  sampled s;
  double *x;
};

void density_views_clear(density_views *views)
{
  if (views->values != NULL) {
    sampled_clear(&views->values->s);
    free(views->values->x);
  }
  free(views->values);
  free(views->view);
  *views = (density_views){0};
}

/* Take the vertices axis by axis. */
static double *vertices_of(const dvi_mesh *mesh)
{
  const int axes = dvi_mesh_space(mesh);
  const int64_t vertices = dvi_mesh_count(mesh, 0);
  double *x = calloc((size_t)vertices * (size_t)axes, sizeof *x);
  for (int64_t v = 0; v < vertices && x != NULL; v++)
    for (int d = 0; d < axes; d++) x[d * vertices + v] = dvi_mesh_points(mesh)[v * axes + d];
  return x;
}

int density_views_make(const problem *scene, int count, const double *U, density_views *views)
{
  dvi_scene *own = scene->scene;
  const dvi_mesh *mesh = dvi_scene_mesh(own);
  const int series = count * dvi_density_components(density_of(scene));
  *views = (density_views){.count = series};
  views->view = calloc((size_t)series, sizeof *views->view);
  views->values = calloc(1, sizeof *views->values);
  if (views->view == NULL || views->values == NULL) return out_of_memory();
  sampled *s = &views->values->s;
  views->values->x = vertices_of(mesh);
  if (views->values->x == NULL) return out_of_memory();
  int code = sampled_make(scene, count, dvi_mesh_count(mesh, 0), views->values->x, s);
  if (code == DONE) code = sample(s, true, U);
  for (int k = 0; k < series && code == DONE; k++)
    views->view[k] = (dvi_view){
        .name = s->name[k], .values = s->value + k * s->points, .components = 1};
  return code;
}

int density_view(const problem *scene, const char *path, int count, const double *U)
{
  dvi_scene *own = scene->scene;
  density_views views;
  if (dvi_scene_mesh(own) == NULL)
    return usage_error("%s: a .vtu file needs a mesh, and %s has a domain; --csv has the values",
                       path, scene->name);
  int code = density_views_make(scene, count, U, &views);
  if (code == DONE) {
    const dvi_status status = dvi_mesh_write(dvi_scene_mesh(own), path, views.count, views.view);
    code = status == DVI_OK ? DONE : library_error(status);
  }
  density_views_clear(&views);
  return code;
}
