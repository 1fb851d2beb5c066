#include "load/density.h"

#include <dvi/diagnostics.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "csv/table.h"
#include "load/elastic.h"
#include "load/quantity.h"

enum { TEXT_SIZE = 4096, NAME_SIZE = QUANTITY_NAME + 24 };

const dvi_density *density_of(const problem *scene)
{
  return dvi_scene_density(scene->scene);
}

bool has_field(const problem *scene)
{
  return density_of(scene) != NULL || dvi_scene_field(scene->scene) != NULL ||
         elastic_of(scene) != NULL;
}

/* Of the domains with axes only those of rotations have neither a space nor a moving mesh. */
bool has_rotations(const problem *scene)
{
  return dvi_scene_axis(scene->scene, 0) != NULL && density_of(scene) == NULL &&
         dvi_scene_moving(scene->scene) == NULL;
}

static bool lacks_hessian(const problem *scene)
{
  bool lacks = false;
  for (int k = 0; k < scene->terms->potential_count; k++)
    lacks = lacks || scene->terms->potentials[k].without_hessian;
  return lacks;
}

/* Tell if the method takes the system of the scene, whatever else may be wrong with it. */
static bool takes_system(const problem *scene, const char *method)
{
  dvi_integrator *tried = NULL;
  const dvi_status status = dvi_integrator_create(dvi_scene_system(scene->scene), method, &tried);
  dvi_integrator_destroy(&tried);
  return status != DVI_UNSUPPORTED;
}

int density_judge(const char *command, const problem *scene, const char *method)
{
  if (dvi_scene_schroedinger(scene->scene) == NULL) return DONE;
  const bool large = lacks_hessian(scene);
  if (strncmp(method, "vprk", 4) == 0)
    return large ? usage_error("%s: vprk needs the Hessian, which so many modes do not give; "
                               "split:order=4, gauss:stages=2 and midpoint take fields of any size",
                               command)
                 : DONE;
  complain("%s: %s does not keep the norm of the wave function; midpoint, gauss:stages=2%s",
           command, method, large ? " and split:order=4 do" : ", split:order=4 and vprk do");
  return takes_system(scene, method) ? DONE : USAGE;
}

/* One entry of the diagonal tells the sign of a definite mass. */
static bool has_negative_mass(const dvi_density *density)
{
  dvi_matrix M;
  if (dvi_density_matrix(density, DVI_FIELD_MASS, &M) != DVI_OK || M.rows == 0) return false;
  int64_t e = 0;
  while (M.column != NULL && M.column[e] != 0 && e + 1 < M.start[1]) e++;
  return M.value[e] < 0.0;
}

/* Potentials beside the quadratic one, and general Lagrangians, may stop what grows, if the mass is
 * not negative. */
bool density_grows(const problem *scene, double *least)
{
  const dvi_density *density = density_of(scene);
  dvi_system_terms terms;
  *least = 0.0;
  if (density == NULL || dvi_density_system_terms(density, &terms) != DVI_OK) return false;
  if (terms.lagrangian != NULL || (terms.potential_count > 1 && !has_negative_mass(density)))
    return false;
  return dvi_density_least(density, least) == DVI_OK && *least < 0.0;
}

void density_warn_growth(const char *command, const problem *scene)
{
  double least;
  if (!density_grows(scene, &least)) return;
  complain("%s: the energy is not bounded from below: the least omega^2 of the quadratic part is "
           "%.6g, and modes grow as exp(%.6g t); is a sign of the density wrong, as in "
           "u'^2/2 - d(u,x)^2/2?",
           command, least, sqrt(-least));
}

int64_t field_unknowns(const problem *scene)
{
  int64_t unknowns = 0;
  if (density_of(scene) != NULL)
    (void)dvi_density_unknowns(density_of(scene), &unknowns);
  else if (elastic_of(scene) != NULL)
    (void)dvi_elastic_unknowns(elastic_of(scene), &unknowns);
  else
    (void)dvi_field_unknowns(dvi_scene_field(scene->scene), &unknowns);
  return unknowns;
}

/* Above this the Hessian at a state is full, or takes as long as the start of the run. */
enum { UNKNOWNS_MOST = 100000 };

/* Give the largest frequency at the start with all potentials, or 0 where the quadratic part alone
 * has it already, whose bound the method's steps are held to. */
static double fastest_at_start(const problem *scene)
{
  const dvi_density *density = density_of(scene);
  double quadratic = 0.0, whole = 0.0;
  if (density == NULL || scene->system == NULL || field_unknowns(scene) > UNKNOWNS_MOST) return 0.0;
  if (dvi_density_fastest(density, &quadratic) != DVI_OK) return 0.0;
  if (dvi_density_fastest_at(density, scene->q, &whole) != DVI_OK) return 0.0;
  return whole > 1.002 * quadratic ? whole : 0.0;
}

/* A method is tried on a spring of that frequency. */
void density_warn_step(const char *command, const problem *scene, const char *method, double h)
{
  const double omega = fastest_at_start(scene);
  double turn, rate;
  if (!(omega * fabs(h) >= 1.0) || !(omega * fabs(h) < 1e5)) return;
  if (dvi_exchange(method, omega * fabs(h), &turn, &rate) != DVI_BAD_ARGUMENT) return;
  complain(
      "%s: %s is unstable with h = %g at t = 0, where all potentials together have frequencies "
      "up to %.6g%s",
      command, method, h, omega,
      strncmp(method, "verlet", 6) == 0 ? "; take h below 2/omega, or midpoint" : "");
}

void density_tell(const problem *scene)
{
  char text[TEXT_SIZE];
  double omega = 0.0;
  dvi_scene_density_explain(scene->scene, text, sizeof text);
  (void)fputs(text, stdout);
  if (density_of(scene) != NULL && dvi_density_fastest(density_of(scene), &omega) == DVI_OK &&
      omega > 0.0)
    (void)printf("largest frequency of the quadratic part: %.6g; verlet is stable below h = %.6g\n",
                 omega, 2.0 / omega);
  omega = fastest_at_start(scene);
  if (omega > 0.0)
    (void)printf("largest frequency with all potentials, at t = 0: %.6g; there verlet is stable "
                 "below h = %.6g\n",
                 omega, 2.0 / omega);
}

int64_t density_coefficients(const dvi_density *density)
{
  return dvi_density_components(density) * dvi_space_functions(dvi_density_space(density));
}

/* ---- values ---- */

/* The values behind views. */
struct density_values {
  const problem *scene;
  const dvi_mesh *mesh;
  int fields, shown;
  quantity quantity[QUANTITIES_MAX]; /* [shown] of each field */
  int64_t points;
  double *x;     /* [axes*points] axis by axis */
  double *value; /* [fields][shown][points] */
  char (*name)[NAME_SIZE];
};

static int out_of_memory(void)
{
  complain("out of memory");
  return FAILED;
}

static void choose_quantities(struct density_values *v)
{
  quantity all[QUANTITIES_MAX];
  const int count = quantities_of(v->scene, all);
  for (int k = 0; k < count; k++)
    if (quantity_is_usual(all + k)) v->quantity[v->shown++] = all[k];
}

/* Take the vertices axis by axis. */
static bool place_points(struct density_values *v)
{
  const int axes = dvi_mesh_space(v->mesh);
  const double *point = dvi_mesh_points(v->mesh);
  v->points = dvi_mesh_count(v->mesh, 0);
  v->x = calloc((size_t)v->points * (size_t)axes, sizeof *v->x);
  for (int64_t i = 0; i < v->points && v->x != NULL; i++)
    for (int d = 0; d < axes; d++) v->x[d * v->points + i] = point[i * axes + d];
  return v->x != NULL;
}

static void name_views(density_views *views)
{
  struct density_values *v = views->values;
  for (int k = 0; k < views->count; k++) {
    const char *shown = v->quantity[k % v->shown].name;
    if (v->fields > 1)
      (void)snprintf(v->name[k], NAME_SIZE, "%s_mode_%d", shown, k / v->shown + 1);
    else
      (void)snprintf(v->name[k], NAME_SIZE, "%s", shown);
    views->view[k] = (dvi_view){
        .name = v->name[k], .values = v->value + k * v->points, .components = 1};
  }
}

int density_views_make(const problem *scene, int fields, density_views *views)
{
  dvi_scene *own = scene->scene;
  *views = (density_views){.values = calloc(1, sizeof *views->values)};
  struct density_values *v = views->values;
  if (v == NULL) return out_of_memory();
  *v = (struct density_values){.scene = scene, .mesh = dvi_scene_mesh(own), .fields = fields};
  if (v->mesh == NULL) return library_error(DVI_NO_MEMORY);
  choose_quantities(v);
  views->count = fields * v->shown;
  if (!place_points(v)) return out_of_memory();
  const size_t count = (size_t)views->count + 1;
  views->view = calloc(count, sizeof *views->view);
  v->value = calloc(count * (size_t)v->points, sizeof *v->value);
  v->name = calloc(count, sizeof *v->name);
  if (views->view == NULL || v->value == NULL || v->name == NULL) return out_of_memory();
  name_views(views);
  return DONE;
}

void density_views_clear(density_views *views)
{
  if (views->values != NULL) {
    free(views->values->x);
    free(views->values->value);
    free(views->values->name);
  }
  free(views->values);
  free(views->view);
  *views = (density_views){0};
}

int density_views_fill(density_views *views, const double *U)
{
  struct density_values *v = views->values;
  const dvi_density *density = density_of(v->scene);
  int code = DONE;
  for (int k = 0; k < views->count && code == DONE; k++) {
    const quantity_state at = {.U = U + k / v->shown * density_coefficients(density)};
    code = quantity_evaluate(v->quantity + k % v->shown, dvi_density_space(density), at, v->points,
                             v->x, v->value + k * v->points);
  }
  return code;
}

/* ---- files ---- */

static int write_rows(const density_views *views, const char *path)
{
  const struct density_values *v = views->values;
  const dvi_space *space = dvi_density_space(density_of(v->scene));
  const int axes = dvi_space_dimension(space);
  table_column *column = calloc((size_t)(axes + views->count) + 1, sizeof *column);
  if (column == NULL) return out_of_memory();
  for (int d = 0; d < axes; d++) column[d] = (table_column){dvi_space_axis(space, d), ""};
  for (int k = 0; k < views->count; k++) column[axes + k] = (table_column){v->name[k], ""};
  result_table *rows = table_create(column);
  for (int64_t i = 0; i < v->points; i++) {
    for (int d = 0; d < axes; d++) table_number(rows, v->x[d * v->points + i]);
    for (int k = 0; k < views->count; k++) table_number(rows, v->value[k * v->points + i]);
  }
  const bool good = table_finish(&rows, path);
  free(column);
  return good ? DONE : FAILED;
}

static int write_grid(const density_views *views, const char *path)
{
  const dvi_status status = dvi_mesh_write(views->values->mesh, path, views->count, views->view);
  return status == DVI_OK ? DONE : library_error(status);
}

static int write_file(const problem *scene, const char *path, int fields, const double *U,
                      int (*write)(const density_views *views, const char *path))
{
  density_views views;
  int code = density_views_make(scene, fields, &views);
  if (code == DONE) code = density_views_fill(&views, U);
  if (code == DONE) code = write(&views, path);
  density_views_clear(&views);
  return code;
}

int density_write(const problem *scene, const char *path, int fields, const double *U)
{
  return write_file(scene, path, fields, U, write_rows);
}

int density_view(const problem *scene, const char *path, int fields, const double *U)
{
  return write_file(scene, path, fields, U, write_grid);
}
