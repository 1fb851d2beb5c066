#include "watch/field_map.h"

#include <dvi/scene.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "load/density.h"
#include "load/elastic.h"
#include "load/field.h"
#include "module/ranks.h"

static int out_of_memory(void)
{
  complain("out of memory");
  return FAILED;
}

static int refuse(const problem *scene, const char *reason)
{
  return usage_error("run: --map is for fields on a line, and that of %s %s; --pvd writes it for "
                     "maps of space by dvi plot",
                     scene->name, reason);
}

static bool take_state(field_map *m)
{
  const size_t n = (size_t)field_unknowns(m->scene);
  m->q = calloc(3 * n, sizeof *m->q);
  m->p = m->q + n;
  m->v = m->p + n;
  return m->q != NULL;
}

/* ---- fields with a density ---- */

static int start_places(field_map *m, double from, double to)
{
  if (!space_map_start(&m->map, from, to)) return FAILED;
  for (int i = 0; i < m->map.width; i++) {
    const double part = (double)i / (m->map.width - 1);
    m->x[i] = (1 - part) * from + part * to;
  }
  return DONE;
}

static int start_density(field_map *m, const dvi_density *density, const char *name)
{
  const dvi_space *space = dvi_density_space(density);
  if (dvi_space_dimension(space) > 1)
    return refuse(m->scene, dvi_space_dimension(space) == 2 ? "is in a plane" : "is in space");
  const int code = quantity_choose(m->scene, "run: --map-of", name, &m->shown);
  if (code != DONE) return code;
  const dvi_mesh *mesh = dvi_scene_mesh(m->scene->scene);
  if (mesh == NULL) return library_error(DVI_NO_MEMORY);
  const double *point = dvi_mesh_points(mesh);
  const size_t coefficients = (size_t)density_coefficients(density);
  m->axis = dvi_space_axis(space, 0);
  m->U = calloc(2 * coefficients, sizeof *m->U);
  m->x = calloc(SPACE_MAP_WIDTH, sizeof *m->x);
  if (m->U == NULL || m->x == NULL || !take_state(m)) return out_of_memory();
  m->rate = m->U + coefficients;
  return start_places(m, point[0], point[dvi_mesh_count(mesh, 0) - 1]);
}

/* ---- meshes that move ---- */

/* Places rest between the ends of the start. Nodes pass them. */
static int start_moving(field_map *m, const char *name)
{
  if (dvi_scene_axis(m->scene->scene, 1) != NULL) return refuse(m->scene, "is in a plane");
  const int code = quantity_choose(m->scene, "run: --map-of", name, &m->shown);
  if (code != DONE) return code;
  if (m->shown.order[0] > 1)
    return usage_error("run: --map-of %s: a mesh that moves has linear cells, and first "
                       "derivatives alone",
                       m->shown.name);
  int cells;
  (void)dvi_moving_nodes(m->moving, &cells);
  m->axis = dvi_scene_axis(m->scene->scene, 0);
  m->U = calloc((size_t)SPACE_MAP_WIDTH * DVI_MOVING_COMPONENTS_MAX, sizeof *m->U);
  m->x = calloc(SPACE_MAP_WIDTH, sizeof *m->x);
  m->q = calloc((size_t)cells + 1, sizeof *m->q);
  if (m->U == NULL || m->x == NULL || m->q == NULL) return out_of_memory();
  const dvi_status status = dvi_moving_lift(m->moving, 0, m->scene->q, m->q, NULL);
  return status == DVI_OK ? start_places(m, m->q[0], m->q[cells]) : library_error(status);
}

static bool put_moving(field_map *m, double t, const double *q, double *row)
{
  const int width = m->map.width;
  const dvi_status status = dvi_moving_evaluate(m->moving, t, q, m->shown.order[0], width, m->x,
                                                m->U);
  if (status != DVI_OK) return library_error(status) == DONE;
  memcpy(row, m->U + m->shown.component * width, (size_t)width * sizeof *row);
  return true;
}

/* ---- waves on a mesh ---- */

static int compare_places(const void *first, const void *second)
{
  const double *const *a = first, *const *b = second;
  return **a < **b ? -1 : **a > **b;
}

/* Order the vertices along the line. */
static void sort_vertices(field_map *m, const double **list)
{
  const size_t count = (size_t)m->vertices;
  for (size_t i = 0; i < count; i++) list[i] = m->whole + i;
  qsort(list, count, sizeof *list, compare_places);
  for (size_t i = 0; i < count; i++) {
    m->order[i] = (int)(list[i] - m->whole);
    m->place[i] = *list[i];
  }
}

/* Take the vertices of the line, of which other processes have some. Complains and returns false if
 * that fails, on all of them. */
static bool take_vertices(field_map *m, const dvi_mesh *mesh)
{
  if (!line_values_start(&m->line, mesh)) return false;
  const size_t count = (size_t)m->line.vertices;
  const double **list = calloc(count, sizeof *list);
  m->vertices = m->line.vertices;
  m->U = calloc((size_t)dvi_mesh_count(mesh, 0), sizeof *m->U);
  m->order = calloc(count, sizeof *m->order);
  m->place = calloc(3 * count, sizeof *m->place);
  bool good = m->U != NULL && list != NULL && m->order != NULL && m->place != NULL && take_state(m);
  if (ranks_agree(good ? DONE : out_of_memory()) != DONE) good = false;
  m->ascend = good ? m->place + count : NULL;
  m->whole = good ? m->ascend + count : NULL;
  good = good && line_values_gather(&m->line, dvi_mesh_points(mesh), m->whole);
  if (good) sort_vertices(m, list);
  free(list);
  return good;
}

static int start_wave(field_map *m, const dvi_field *field, const char *name)
{
  const dvi_mesh *mesh = field_mesh(field);
  if (dvi_field_degree(field) != 0) return refuse(m->scene, "has no values at points");
  if (dvi_mesh_dimension(mesh) > 1 || dvi_mesh_space(mesh) > 1)
    return refuse(m->scene, "is on a mesh of more dimensions");
  if (name != NULL && strcmp(name, "u") != 0)
    return usage_error("run: --map-of %s: a wave on a mesh shows u alone", name);
  m->axis = "x";
  (void)strcpy(m->shown.name, "u");
  if (!take_vertices(m, mesh)) return FAILED;
  return space_map_start(&m->map, m->place[0], m->place[m->vertices - 1]) ? DONE : FAILED;
}

/* ---- all of them ---- */

int field_map_start(field_map *m, const problem *scene, const char *path, const char *name)
{
  *m = (field_map){.scene = scene, .path = path};
  if (path == NULL) return DONE;
  const dvi_density *density = density_of(scene);
  const dvi_field *field = dvi_scene_field(scene->scene);
  m->moving = dvi_scene_moving(scene->scene);
  if (density != NULL) return start_density(m, density, name);
  if (m->moving != NULL) return start_moving(m, name);
  if (field != NULL) return start_wave(m, field, name);
  if (elastic_of(scene) != NULL) return refuse(scene, "is a solid");
  if (has_rotations(scene))
    return usage_error("run: --map is not for fields of rotations, as that of %s; --plot draws its "
                       "columns over time",
                       scene->name);
  return usage_error("run: --map is for fields, and %s is none; --plot draws its columns over time",
                     scene->name);
}

void field_map_clear(field_map *m)
{
  space_map_clear(&m->map);
  line_values_clear(&m->line);
  free(m->x);
  free(m->q);
  free(m->U);
  free(m->order);
  free(m->place);
}

/* ---- rows ---- */

static bool put_density(field_map *m, double t, const double *q, const double *p, double *row)
{
  const dvi_density *density = density_of(m->scene);
  dvi_status status = dvi_density_lift(density, t, q, m->U);
  if (status == DVI_OK && m->shown.kind == QUANTITY_RATE) {
    status = dvi_system_velocity(dvi_scene_system(m->scene->scene), t, q, p, m->v);
    if (status == DVI_OK) status = dvi_density_lift_rate(density, t, m->v, m->rate);
  }
  if (status != DVI_OK) return library_error(status) == DONE;
  return quantity_evaluate(&m->shown, dvi_density_space(density), (quantity_state){m->U, m->rate},
                           m->map.width, m->x, row) == DONE;
}

/* Interpolate between neighbours. */
static bool put_wave(field_map *m, const double *q, double *row)
{
  const space_map *map = &m->map;
  const dvi_status status = dvi_field_lift(dvi_scene_field(m->scene->scene), q, m->U);
  if (status != DVI_OK) return library_error(status) == DONE;
  if (!line_values_gather(&m->line, m->U, m->whole)) return false;
  for (int64_t i = 0; i < m->vertices; i++) m->ascend[i] = m->whole[m->order[i]];
  for (int64_t i = 0, right = 1; i < map->width; i++) {
    const double x = map->from + (map->to - map->from) * (double)i / (map->width - 1);
    while (right + 1 < m->vertices && m->place[right] < x) right++;
    const double *place = m->place + right - 1, *value = m->ascend + right - 1;
    row[i] = value[0] + (value[1] - value[0]) * (x - place[0]) / (place[1] - place[0]);
  }
  return true;
}

static bool put(field_map *m, double t, const double *q, const double *p, double *row)
{
  if (m->moving != NULL) return put_moving(m, t, q, row);
  return m->vertices == 0 ? put_density(m, t, q, p, row) : put_wave(m, q, row);
}

bool field_map_add_state(field_map *m, double t, const double *q, const double *p)
{
  double *row = m->path != NULL ? space_map_row(&m->map, t) : NULL;
  return row == NULL || put(m, t, q, p, row);
}

bool field_map_add_march(field_map *m, const dvi_march *march)
{
  const double t = dvi_march_time(march);
  double *row = m->path != NULL ? space_map_row(&m->map, t) : NULL;
  if (row == NULL) return true;
  const bool needs_p = m->vertices == 0 && m->shown.kind == QUANTITY_RATE;
  const dvi_status status = dvi_scene_march_state(m->scene->scene, march, m->q,
                                                  needs_p ? m->p : NULL);
  return ranks_agree(status == DVI_OK ? DONE : library_error(status)) == DONE &&
         put(m, t, m->q, m->p, row);
}

bool field_map_draw(const field_map *m)
{
  if (m->path == NULL) return true;
  if (!space_map_draw(&m->map, m->path, m->shown.name, m->axis)) return false;
  complain("run: --map %s draws %s over %s and t", m->path, m->shown.name, m->axis);
  return true;
}
