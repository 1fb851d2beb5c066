/* The section mesh, and the names that it brings. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/field/maxwell.h"
#include "scene/sections/sections.h"

/* ---- numbers ---- */

/* What the library takes for its default must not come from a scene that says 0. */
static bool read_positive(dvi_scene *scene, const dvi__tree *entry, const char *name,
                          double *number)
{
  if (!dvi__tree_number(scene, entry, name, number)) return false;
  return (*number > 0 && isfinite(*number)) ||
         dvi__scene_refuse(scene, entry->span, "%s is a finite number above 0, and cannot be %g",
                           name, *number);
}

/* Read a list of one to four numbers, or a number, which stands for a list of one. Whole ones from
 * `least` on if `whole` is not NULL, otherwise positive ones if `least` is. */
static bool read_list(dvi_scene *scene, const dvi__tree *mesh, const char *name, int least,
                      double *number, int *whole)
{
  const dvi__tree *tree = dvi__tree_find(mesh, name);
  if (tree == NULL) return true;
  const int is_list = tree->kind == DVI__SEQUENCE, count = is_list ? tree->count : 1;
  if (count < 1 || count > 4 || tree->kind == DVI__MAPPING)
    return dvi__scene_refuse(scene, tree->span, "%s is a list of one to four numbers", name);
  for (int i = 0; i < count; i++) {
    const dvi__tree *entry = is_list ? tree->child[i] : tree;
    const bool good = whole != NULL ? dvi__tree_whole(scene, entry, name, least, whole + i)
                      : least > 0   ? read_positive(scene, entry, name, number + i)
                                    : dvi__tree_number(scene, entry, name, number + i);
    if (!good) return false;
  }
  return true;
}

static bool report(dvi_scene *scene, const dvi__tree *section, dvi_status status)
{
  return status == DVI_OK ||
         dvi__complain(scene->complaint, status, section->span, "%s", dvi_last_error());
}

/* A file that is cut short is one that cannot be read, and no mistake of the scene. */
static bool report_file(dvi_scene *scene, const dvi__tree *file, dvi_status status)
{
  return report(scene, file, status == DVI_BAD_FILE ? DVI_IO_ERROR : status);
}

/* Refuse lists of some of the axes, whose other ones would be as long as 1, say. One number of
 * cells may stand for all axes, and of a solid one grading is that of the first axis. Shapes have
 * lengths of other kinds. */
static bool has_all_axes(dvi_scene *scene, const dvi__tree *section, const char *generator)
{
  static const char *const grid[] = {"box", "kuhn", "kuhn-torus", "staggered", "bcc-torus"},
                           *const list[] = {"size", "origin", "grading", "periodic"};
  const struct dvi__scene_field *f = scene->field;
  const int axes = f->mesh != NULL ? dvi_mesh_dimension(f->mesh) : f->dimension;
  bool is_grid = false;
  for (size_t k = 0; k < sizeof grid / sizeof *grid; k++)
    is_grid = is_grid || strcmp(grid[k], generator) == 0;
  for (size_t k = 0; k < sizeof list / sizeof *list && is_grid; k++) {
    const dvi__tree *tree = dvi__tree_find(section, list[k]);
    const int count = tree == NULL ? axes : tree->kind == DVI__SEQUENCE ? tree->count : 1;
    const bool is_first = dvi__is_elastic(scene) && tree != NULL && tree->kind == DVI__SCALAR &&
                          list[k] == list[2];
    if (count < axes && !is_first)
      return dvi__scene_refuse(scene, tree->span,
                               "%s has a number for each axis of a mesh, and this one has %d axes, "
                               "as in '%s'",
                               list[k], axes, axes == 2 ? "[1, 1]" : "[1, 1, 1]");
  }
  return true;
}

static bool generate(dvi_scene *scene, const dvi__tree *section, const dvi__tree *generator)
{
  static const char *const known[] = {"generator", "cells",   "size",
                                      "origin",    "grading", "periodic"};
  dvi_generator_options *options = &scene->field->grid;
  *options = (dvi_generator_options){.size = sizeof *options};
  if (!dvi__want_keys(scene, section, "a generated mesh", 6, known) ||
      !dvi__want_text(scene, generator, "generator") ||
      !read_list(scene, section, "cells", 1, NULL, options->cells) ||
      !read_list(scene, section, "size", 1, options->extent, NULL) ||
      !read_list(scene, section, "origin", 0, options->origin, NULL) ||
      !read_list(scene, section, "grading", 1, options->grading, NULL) ||
      !read_list(scene, section, "periodic", 0, NULL, options->periodic))
    return false;
  scene->field->is_grid = strcmp(generator->text, "box") == 0;
  if (!dvi__maxwell_read_periodic(scene)) return false;
  return (dvi__is_grid_alone(scene) ||
          report(scene, section,
                 dvi_mesh_generate(generator->text, options, &scene->field->mesh))) &&
         has_all_axes(scene, section, generator->text);
}

static bool is_in_parts(const char *path)
{
  const size_t length = strlen(path);
  return length > 3 && strcmp(path + length - 3, ".h5") == 0;
}

/* Read this process's share of a mesh from a file of which each process reads a part. */
static bool read_parts(dvi_scene *scene, const dvi__tree *file, const char *path, int space)
{
  const dvi_scene_division *division = scene->division;
  dvi_mesh **mesh = &scene->field->mesh;
  if (space != 0)
    return dvi__complain(scene->complaint, DVI_BAD_OPTION, file->span,
                         "the points of '%s' have the coordinates that were written: leave space "
                         "out",
                         file->text);
  if (division != NULL && division->read != NULL &&
      !report_file(scene, file, division->read(path, mesh, division->user)))
    return false;
  return *mesh != NULL ||
         dvi__complain(scene->complaint, DVI_UNSUPPORTED, file->span,
                       "'%s' is a mesh in parts, which dvi run reads if it is built with "
                       "-DDVI_PETSC=ON; dvi mesh writes a file of MSH, OFF or PLY of it",
                       file->text);
}

static bool read_file(dvi_scene *scene, const dvi__tree *section, const dvi__tree *file)
{
  static const char *const known[] = {"file", "space"};
  dvi_mesh_read_options options = {.size = sizeof options};
  const char *path;
  const dvi__tree *space = dvi__tree_find(section, "space");
  if (!dvi__want_keys(scene, section, "a mesh from a file", 2, known) ||
      !dvi__want_text(scene, file, "file") ||
      (space != NULL && !dvi__tree_whole(scene, space, "space", 1, &options.space)) ||
      !dvi__scene_place_mesh(scene, file->span, file->text, &path))
    return false;
  return is_in_parts(path)
             ? read_parts(scene, file, path, options.space)
             : report_file(scene, file, dvi_mesh_read(path, &options, &scene->field->mesh));
}

/* ---- names ---- */

static bool add_name(dvi_scene *scene, const char *name, dvi__span span, int rank, int size)
{
  const int first = scene->n;
  scene->n += size;
  return dvi__add_lines(scene, name, span, rank, first, size);
}

static bool name_place(dvi_scene *scene, const dvi__tree *section)
{
  static const char *const axis[] = {"x", "y", "z", "w"};
  const int space = scene->field->space;
  scene->coordinate = dvi__arena_take(&scene->arena, (size_t)space + 2, sizeof *scene->coordinate);
  scene->zeros = dvi__arena_take(&scene->arena, 2 * (size_t)DVI__PLACE_NUMBERS,
                                 sizeof *scene->zeros);
  if (scene->coordinate == NULL || scene->zeros == NULL) return dvi__scene_no_memory(scene);
  for (int l = 0; l < space; l++)
    if (!add_name(scene, axis[l], section->span, 0, 1)) return false;
  scene->nv = scene->velocities = scene->n;
  if (scene->field->maxwell != NULL) return true;
  if (!add_name(scene, "normal", section->span, 1, space) ||
      !add_name(scene, "u", section->span, 0, 1))
    return false;
  scene->nv = scene->velocities = scene->n;
  return true;
}

/* Let the share of this process replace the mesh. */
static bool take_share(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_field *f = scene->field;
  dvi_mesh *share = NULL;
  if (scene->division == NULL || scene->division->divide == NULL) return true;
  if (f->is_grid && f->maxwell != NULL) f->ranks = scene->division->grid;
  if (f->mesh == NULL && f->ranks != NULL) return true;
  if (dvi__has_density(scene))
    return dvi__complain(scene->complaint, DVI_UNSUPPORTED, dvi__motion_section(scene)->span,
                         "several processes share fields of waves, Maxwell's and solids, and no "
                         "densities: run this one in one process");
  if (f->mesh == NULL)
    return dvi__complain(scene->complaint, DVI_UNSUPPORTED, section->span,
                         "several processes share a grid of yee if their division has its ranks");
  if (dvi_mesh_share_numbers(f->mesh, 0) != NULL) return true;
  if (!report(scene, section, scene->division->divide(f->mesh, &share, scene->division->user)))
    return false;
  dvi_mesh_destroy(&f->mesh);
  f->mesh = share;
  return true;
}

bool dvi__is_share(const dvi_scene *scene)
{
  return scene->field != NULL && dvi_mesh_share_numbers(scene->field->mesh, 0) != NULL;
}

bool dvi__has_divided_grid(const dvi_scene *scene)
{
  return scene->field != NULL && scene->field->ranks != NULL;
}

/* A density takes the mesh, and the scene has no field of this room. */
static bool hand_over(dvi_scene *scene, const dvi__tree *section)
{
  dvi_mesh *mesh = scene->field->mesh;
  scene->field = NULL;
  return dvi__density_take_mesh(scene, section, mesh);
}

bool dvi__read_mesh(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "mesh")) return false;
  scene->field = dvi__arena_take(&scene->arena, 1, sizeof *scene->field);
  if (scene->field == NULL) return dvi__scene_no_memory(scene);
  scene->field->solve.size = sizeof scene->field->solve;
  const dvi__tree *generator = dvi__tree_find(section, "generator"),
                  *file = dvi__tree_find(section, "file");
  if ((generator == NULL) == (file == NULL))
    return dvi__scene_refuse(scene, section->span,
                             "a mesh has a generator or a file, as in 'mesh: {generator: disk}'");
  if (!dvi__maxwell_begin(scene) || !dvi__elastic_begin(scene)) return false;
  if (!(generator != NULL ? generate(scene, section, generator) : read_file(scene, section, file)))
    return false;
  if (!take_share(scene, section)) return false;
  if (dvi__has_density(scene)) return hand_over(scene, section);
  if (scene->field->mesh != NULL) {
    scene->field->space = dvi_mesh_space(scene->field->mesh);
    scene->field->dimension = dvi_mesh_dimension(scene->field->mesh);
  }
  if (scene->field->space > DVI__PLACE_SPACE)
    return dvi__scene_refuse(scene, section->span, "a scene's mesh has at most %d coordinates",
                             DVI__PLACE_SPACE);
  if (scene->field->maxwell != NULL && scene->field->space > 3)
    return dvi__scene_refuse(scene, section->span,
                             "an electromagnetic field has a mesh in at most 3 coordinates, and "
                             "this one has %d",
                             scene->field->space);
  if (!dvi__is_elastic(scene)) return name_place(scene, section);
  return dvi__elastic_check_mesh(scene, section) && dvi__elastic_name_place(scene, section);
}
