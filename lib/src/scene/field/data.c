/* The sections that say what the field is made of: star, materials, boundary, source, potential,
 * and those of static problems and of the start. */
#include <math.h>
#include <string.h>

#include "scene/field/maxwell.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

enum { PARTS_MOST = 16 };

bool dvi__read_star(dvi_scene *scene, const dvi__tree *section)
{
  static const char *const word[] = {"circumcentric", "barycentric", "whitney", "spectral"};
  static const dvi_star_kind kind[] = {DVI_CIRCUMCENTRIC, DVI_BARYCENTRIC, DVI_WHITNEY,
                                       DVI_SPECTRAL};
  int which;
  if (!dvi__elastic_refuse_section(scene, section, "star") ||
      !dvi__tree_word(scene, section, "star", 4, word, &which))
    return false;
  scene->field->kind = kind[which];
  return true;
}

/* ---- materials ---- */

/* Find the centres of all cells, once. */
static bool find_centres(dvi_scene *scene)
{
  struct dvi__scene_field *field = scene->field;
  const int n = dvi_mesh_dimension(field->mesh);
  const size_t numbers = (size_t)dvi_mesh_count(field->mesh, n) * (size_t)field->space;
  if (field->centre != NULL) return true;
  field->centre = dvi__arena_take(&scene->arena, numbers, sizeof *field->centre);
  if (field->centre == NULL) return dvi__scene_no_memory(scene);
  return dvi_mesh_centres(field->mesh, n, field->centre) == DVI_OK;
}

/* Take room for values of the cells, unless there is some. Returns it, or complains. */
static double *reserve(dvi_scene *scene, double value, double **values)
{
  const dvi_mesh *mesh = scene->field->mesh;
  const int64_t cells = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
  if (*values != NULL) return *values;
  double *made = *values = dvi__arena_take(&scene->arena, (size_t)cells, sizeof *made);
  for (int64_t c = 0; c < cells && made != NULL; c++) made[c] = value;
  if (made == NULL) (void)dvi__scene_no_memory(scene);
  return made;
}

bool dvi__quantity_set(dvi_scene *scene, const dvi__quantity *of, const char *part, dvi__span span,
                       const dvi__place *place, double **values)
{
  const struct dvi__scene_field *field = scene->field;
  int64_t count;
  const int *cell = dvi_mesh_part_cells(field->mesh, part, field->dimension, &count);
  double *const all = reserve(scene, of->usual, values);
  if (all == NULL || !find_centres(scene)) return false;
  for (int64_t i = 0; i < count; i++) {
    double *value = all + cell[i];
    const double *x = field->centre + (ptrdiff_t)cell[i] * field->space;
    *value = (double)NAN;
    if (dvi__place_value(place, x, NULL, value) != 0 || !(*value >= 0) || *value > 1e300 ||
        (*value < 1e-300 && !of->may_vanish))
      return dvi__scene_refuse(scene, span, "%s is %g in cell %d, where a number %s is wanted",
                               of->name, *value, cell[i],
                               of->may_vanish ? "of at least 0" : "above 0");
  }
  return true;
}

bool dvi__has_part_of_cells(const dvi_mesh *mesh, const char *part)
{
  const int n = dvi_mesh_dimension(mesh);
  const char *name;
  int64_t count;
  (void)dvi_mesh_part_cells(mesh, part, n, &count);
  if (count != 0 || dvi_mesh_share_numbers(mesh, 0) == NULL) return count > 0;
  for (int i = 0; (name = dvi_mesh_part_name(mesh, i)) != NULL; i++)
    if (strcmp(name, part) == 0) return dvi_mesh_part_degree(mesh, i) == n;
  return false;
}

bool dvi__refuse_part(dvi_scene *scene, dvi__span span, const char *name, bool of_cells)
{
  char list[160];
  const char *part[PARTS_MOST], *next;
  int64_t count;
  int parts = 0;
  const dvi_mesh *mesh = scene->field->mesh;
  for (int i = 0; parts < PARTS_MOST && (next = dvi_mesh_part_name(mesh, i)) != NULL; i++) {
    (void)dvi_mesh_part_cells(mesh, next, of_cells ? dvi_mesh_dimension(mesh) : 0, &count);
    if (count > 0) part[parts++] = next;
  }
  return dvi__scene_refuse(scene, span, "the mesh has no part '%s'%s; it has %s", name,
                           of_cells ? " of cells" : "",
                           dvi__list_words(parts, part, " and ", list, sizeof list));
}

static bool read_material(dvi_scene *scene, const char *part, dvi__span span, const dvi__tree *tree)
{
  static const char *const known[] = {"rho", "a"};
  dvi__place *place;
  if (!dvi__has_part_of_cells(scene->field->mesh, part))
    return dvi__refuse_part(scene, span, part, true);
  if (!dvi__want_mapping(scene, tree, "a material") ||
      !dvi__want_keys(scene, tree, "a material", 2, known))
    return false;
  for (int k = 0; k < 2; k++) {
    const dvi__tree *value = dvi__tree_find(tree, known[k]);
    const dvi__quantity quantity = {known[k], false, 1};
    if (value != NULL &&
        (!dvi__place_read(scene, value, 0, "a material", &place) ||
         !dvi__quantity_set(scene, &quantity, part, value->span, place, &scene->field->factor[k])))
      return false;
  }
  return true;
}

bool dvi__read_all_first(dvi_scene *scene, const dvi__tree *section, dvi__part_reader *read)
{
  if (!dvi__want_mapping(scene, section, "materials")) return false;
  for (int special = 0; special < 2; special++)
    for (int i = 0; i < section->count; i++)
      if ((strcmp(section->key[i]->text, "all") != 0) == special &&
          !read(scene, section->key[i]->text, section->key[i]->span, section->child[i]))
        return false;
  return true;
}

bool dvi__read_materials(dvi_scene *scene, const dvi__tree *section)
{
  if (dvi__is_elastic(scene)) return dvi__elastic_read_materials(scene, section);
  if (scene->field->maxwell != NULL) return dvi__maxwell_read_materials(scene, section);
  return dvi__read_all_first(scene, section, read_material);
}

/* ---- the boundary ---- */

static const char *const condition_word[] = {"free", "fixed"};

/* A condition is a word, or a word with its datum. */
static bool read_condition(dvi_scene *scene, const char *part, dvi__span span,
                           const dvi__tree *tree)
{
  dvi_condition *condition = scene->field->condition + scene->field->conditions++;
  dvi__place *place;
  int64_t count;
  int which;
  (void)dvi_mesh_part_cells(scene->field->mesh, part, 0, &count);
  if (count < 0) return dvi__refuse_part(scene, span, part, false);
  *condition = (dvi_condition){.part = part};
  if (tree->kind == DVI__SCALAR) {
    if (!dvi__tree_word(scene, tree, "a condition", 2, condition_word, &which)) return false;
    condition->kind = which ? DVI_FIXED : DVI_FREE;
    return true;
  }
  if (!dvi__want_mapping(scene, tree, "a condition") ||
      !dvi__want_keys(scene, tree, "a condition", 2, condition_word))
    return false;
  if (tree->count != 1)
    return dvi__scene_refuse(scene, tree->span,
                             "a condition is fixed or free, perhaps with its value or its flux, as "
                             "in '{fixed: x^2}'");
  condition->kind = strcmp(tree->key[0]->text, "fixed") == 0 ? DVI_FIXED : DVI_FREE;
  const int is_free = condition->kind == DVI_FREE;
  if (!dvi__place_read(scene, tree->child[0], is_free ? DVI__OF_NORMAL : 0,
                       is_free ? "a flux" : "a fixed value", &place))
    return false;
  condition->datum = dvi__place_datum;
  condition->user = place;
  return true;
}

bool dvi__read_by_part(dvi_scene *scene, const dvi__tree *section, dvi__part_reader *read)
{
  if (section->kind == DVI__SCALAR) return read(scene, "boundary", section->span, section);
  if (!dvi__want_mapping(scene, section, "boundary")) return false;
  for (int i = 0; i < section->count; i++)
    if (!read(scene, section->key[i]->text, section->key[i]->span, section->child[i])) return false;
  return true;
}

bool dvi__read_boundary(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_field *field = scene->field;
  if (scene->density != NULL) return dvi__density_read_boundary(scene, section);
  if (dvi__is_elastic(scene)) return dvi__elastic_read_boundary(scene, section);
  if (field->maxwell != NULL) return dvi__maxwell_read_walls(scene, section);
  field->condition = dvi__arena_take(&scene->arena, (size_t)section->count + 1,
                                     sizeof *field->condition);
  if (field->condition == NULL) return dvi__scene_no_memory(scene);
  return dvi__read_by_part(scene, section, read_condition);
}

/* ---- the rest ---- */

static bool of_wave(dvi_scene *scene, const dvi__tree *section, const char *name)
{
  return (scene->field->maxwell == NULL && !dvi__is_elastic(scene)) ||
         dvi__scene_refuse(scene, section->span, "'%s' is of 'field: wave'", name);
}

bool dvi__read_source(dvi_scene *scene, const dvi__tree *section)
{
  if (!of_wave(scene, section, "source")) return false;
  return dvi__place_read(scene, section, 0, "a source", &scene->field->source);
}

bool dvi__read_potential(dvi_scene *scene, const dvi__tree *section)
{
  return of_wave(scene, section, "potential") && dvi__place_potential(scene, section);
}

bool dvi__read_solve(dvi_scene *scene, const dvi__tree *section)
{
  static const char *const known[] = {"mean", "imbalance"};
  if (scene->density != NULL) return dvi__density_read_solve(scene, section);
  if (!of_wave(scene, section, "solve")) return false;
  double *const number[] = {&scene->field->solve.mean, &scene->field->solve.imbalance};
  if (!dvi__want_mapping(scene, section, "solve") ||
      !dvi__want_keys(scene, section, "solve", 2, known))
    return false;
  for (int k = 0; k < 2; k++) {
    const dvi__tree *value = dvi__tree_find(section, known[k]);
    if (value != NULL && !dvi__tree_number(scene, value, known[k], number[k])) return false;
  }
  return scene->field->solve.imbalance >= 0 ||
         dvi__scene_refuse(scene, section->span, "imbalance is 0 or more");
}

bool dvi__read_field_start(dvi_scene *scene, const dvi__tree *section)
{
  if (dvi__is_elastic(scene)) return dvi__elastic_read_start(scene, section);
  if (scene->field->maxwell != NULL) return dvi__maxwell_read_start(scene, section);
  static const char *const known[] = {"u", "u'"};
  dvi__place **const place[] = {&scene->field->value, &scene->field->rate};
  if (!dvi__want_mapping(scene, section, "initial") ||
      !dvi__want_keys(scene, section, "the start of a field", 2, known))
    return false;
  for (int k = 0; k < 2; k++) {
    const dvi__tree *value = dvi__tree_find(section, known[k]);
    if (value != NULL && !dvi__place_read(scene, value, 0, "a start", place[k])) return false;
  }
  return true;
}
