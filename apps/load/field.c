#include "load/field.h"

#include <dvi/scene.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/command.h"
#include "load/density.h"
#include "load/elastic.h"
#include "load/open.h"

enum { NAME_SIZE = 32 };

/* Refuse a field of rotations, of which a command knows nothing. */
static int refuse_rotations(const char *command, problem **scene)
{
  const int code = usage_error(
      "%s: not for fields of rotations, as that of %s; dvi run, check and order take it", command,
      (*scene)->name);
  problem_destroy(scene);
  return code;
}

/* Refuse a mesh that moves, of which a command knows nothing. */
static int refuse_moving(const char *command, problem **scene)
{
  const int code = usage_error(
      "%s: the mesh of %s moves; dvi run and dvi solve are for such scenes", command,
      (*scene)->name);
  problem_destroy(scene);
  return code;
}

/* Refuse a solid, of which a command knows nothing. */
static int refuse_solid(const char *command, problem **scene)
{
  const int code = usage_error("%s: not for solids, as that of %s; a run whose materials have an "
                               "'alpha' comes to rest",
                               command, (*scene)->name);
  problem_destroy(scene);
  return code;
}

int field_choose(const char *command, const char *name, problem **scene, const dvi_field **field,
                 const dvi_density **density, const dvi_elastic **solid)
{
  if (dvi_scene_grid_only((*scene)->scene) != NULL) return refuse_grid(scene, false);
  *field = dvi_scene_field((*scene)->scene);
  if (density != NULL) *density = NULL;
  if (solid != NULL) *solid = NULL;
  if (*field != NULL || (density != NULL && (*density = density_of(*scene)) != NULL)) return DONE;
  if (solid != NULL && (*solid = elastic_of(*scene)) != NULL) return DONE;
  if (elastic_of(*scene) != NULL) return refuse_solid(command, scene);
  if (dvi_scene_moving((*scene)->scene) != NULL) return refuse_moving(command, scene);
  if (has_rotations(*scene)) return refuse_rotations(command, scene);
  const bool has_density = density_of(*scene) != NULL;
  problem_destroy(scene);
  if (has_density)
    return usage_error(
        "%s: this is of local steps of fields on meshes; all steps of the density of "
        "'%s' are equal, and dvi explain tells below which bound they are stable",
        command, name);
  return usage_error("%s: '%s' has no field; a scene with the sections mesh and field has one",
                     command, name);
}

const dvi_mesh *field_mesh(const dvi_field *field)
{
  return dvi_star_mesh(dvi_field_star(field));
}

/* Count the entries of M_{k+1} below zero, beyond which waves may grow. */
static int64_t count_negative(const dvi_field *field)
{
  dvi_matrix M;
  int64_t count = 0;
  if (dvi_star_matrix(dvi_field_star(field), dvi_field_degree(field) + 1, &M) != DVI_OK) return 0;
  for (int64_t e = 0; e < M.rows && M.column == NULL; e++) count += M.value[e] < 0.0;
  return count;
}

void field_tell(const dvi_field *field)
{
  const dvi_mesh *mesh = field_mesh(field);
  const int n = dvi_mesh_dimension(mesh), k = dvi_field_degree(field);
  int64_t unknowns;
  double omega = 0.0;
  (void)dvi_field_unknowns(field, &unknowns);
  (void)printf("mesh: dimension %d, %lld vertices, %lld edges, %lld cells; parts", n,
               (long long)dvi_mesh_count(mesh, 0), (long long)dvi_mesh_count(mesh, 1),
               (long long)dvi_mesh_count(mesh, n));
  for (int i = 0; dvi_mesh_part_name(mesh, i) != NULL; i++)
    (void)printf("%s %s", i > 0 ? "," : "", dvi_mesh_part_name(mesh, i));
  (void)printf("\nfield: %lld unknowns %s, %lld fixed\n", (long long)unknowns,
               k == 0 ? "at vertices" : "on edges",
               (long long)(dvi_mesh_count(mesh, k) - unknowns));
  const int64_t negative = count_negative(field);
  if (negative > 0)
    (void)printf("star: %lld entries of M_%d are negative, so that waves may grow: dvi mesh tells "
                 "what helps\n",
                 (long long)negative, k + 1);
  if (dvi_field_fastest(field, &omega) == DVI_OK && omega > 0.0)
    (void)printf("largest frequency without a potential: %.6g; verlet and leapfrog are stable "
                 "below h = %.6g\n",
                 omega, 2.0 / omega);
}

int field_view_make(const dvi_field *field, const char *name, const double *form, field_view *view)
{
  const dvi_mesh *mesh = field_mesh(field);
  const int n = dvi_mesh_dimension(mesh), k = dvi_field_degree(field),
            components = dvi_form_components(dvi_mesh_space(mesh), k);
  *view = (field_view){.view = {.name = name, .values = form, .components = 1}};
  if (k == 0) return DONE;
  view->values = calloc((size_t)(dvi_mesh_count(mesh, n) * components), sizeof *view->values);
  if (view->values == NULL) {
    complain("out of memory");
    return FAILED;
  }
  view->view.values = view->values;
  view->view.components = components;
  view->view.degree = n;
  const dvi_status status = dvi_form_at_centres(mesh, k, form, view->values);
  return status == DVI_OK ? DONE : library_error(status);
}

void field_view_clear(field_view *view)
{
  free(view->values);
  view->values = NULL;
}

/* Write views that have been made. */
static int write_views(const dvi_field *field, const char *path, int count, const field_view *made)
{
  dvi_view *view = calloc((size_t)count, sizeof *view);
  if (view == NULL) {
    complain("out of memory");
    return FAILED;
  }
  for (int i = 0; i < count; i++) view[i] = made[i].view;
  const dvi_status status = dvi_mesh_write(field_mesh(field), path, count, view);
  free(view);
  return status == DVI_OK ? DONE : library_error(status);
}

int field_write(const dvi_field *field, const char *path, const char *name, int count,
                const double *values)
{
  const int64_t cells = dvi_mesh_count(field_mesh(field), dvi_field_degree(field));
  field_view *view = calloc((size_t)count, sizeof *view);
  char(*names)[NAME_SIZE] = calloc((size_t)count, sizeof *names);
  int code = view != NULL && names != NULL ? DONE : FAILED;
  if (code != DONE) complain("out of memory");
  for (int i = 0; i < count && code == DONE; i++) {
    if (count > 1)
      (void)snprintf(names[i], NAME_SIZE, "%s_%d", name, i + 1);
    else
      (void)snprintf(names[i], NAME_SIZE, "%s", name);
    code = field_view_make(field, names[i], values + i * cells, view + i);
  }
  if (code == DONE) code = write_views(field, path, count, view);
  for (int i = 0; i < count && view != NULL; i++) field_view_clear(view + i);
  free(view);
  free(names);
  return code;
}
