/* The sections domain, space and fields, and the names that they bring. */
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"

enum { NODES_MAX = 1000000 };

static bool begin(dvi_scene *scene, const dvi__tree *section)
{
  scene->density = dvi__arena_take(&scene->arena, 1, sizeof *scene->density);
  if (scene->density == NULL) return dvi__scene_no_memory(scene);
  scene->density->place = section;
  return true;
}

/* ---- domain ---- */

/* Read an axis, [from, to], or the ends of its cells from the first to the last. */
static bool read_axis(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree)
{
  struct dvi__scene_density *s = scene->density;
  const int d = s->jets.dimension++, count = tree->count;
  if (!dvi__want_name(scene, key->text, key->span)) return false;
  if (tree->kind != DVI__SEQUENCE || count < 2 || count > NODES_MAX)
    return dvi__scene_refuse(scene, tree->span,
                             "an axis is a list of its ends, as in [0, 2*pi], or of all ends of "
                             "cells between them");
  double *node = dvi__arena_take(&scene->arena, (size_t)count, sizeof *node);
  if (node == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < count; i++) {
    if (!dvi__tree_number(scene, tree->child[i], "an end of an axis", node + i)) return false;
    if (i > 0 && !(node[i] > node[i - 1]))
      return dvi__scene_refuse(scene, tree->child[i]->span,
                               "the ends of an axis ascend, and %.17g is not above %.17g", node[i],
                               node[i - 1]);
  }
  s->jets.axis[d] = key->text;
  s->axis_span[d] = key->span;
  s->axis[d] = (dvi_axis){.name = key->text,
                          .from = node[0],
                          .to = node[count - 1],
                          .node = count > 2 ? node : NULL,
                          .nodes = count > 2 ? count : 0};
  return true;
}

bool dvi__read_domain(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "domain") || !begin(scene, section)) return false;
  if (section->count < 1 || section->count > DVI_AXES_MAX)
    return dvi__scene_refuse(scene, section->span,
                             "a domain has one to three axes, as in 'domain: {x: [0, 1]}'");
  for (int i = 0; i < section->count; i++)
    if (!read_axis(scene, section->key[i], section->child[i])) return false;
  return true;
}

bool dvi__density_take_mesh(dvi_scene *scene, const dvi__tree *section, dvi_mesh *mesh)
{
  static const char *const axis[] = {"x", "y", "z"};
  const int dimension = dvi_mesh_dimension(mesh);
  if (!begin(scene, section)) {
    dvi_mesh_destroy(&mesh);
    return false;
  }
  scene->density->mesh = mesh;
  if (dimension < 2 || dimension > 3 || dvi_mesh_space(mesh) != dimension)
    return dvi__scene_refuse(scene, section->span,
                             "the mesh of a density consists of triangles in a plane or of "
                             "tetrahedra in space");
  scene->density->jets.dimension = dimension;
  for (int d = 0; d < dimension; d++) {
    scene->density->jets.axis[d] = axis[d];
    scene->density->axis_span[d] = section->span;
  }
  return true;
}

int dvi__axis_named(const dvi_scene *scene, const char *name)
{
  const dvi__jets *jets = &scene->density->jets;
  for (int d = 0; d < jets->dimension; d++)
    if (strcmp(jets->axis[d], name) == 0) return d;
  return -1;
}

/* ---- space ---- */

/* A space is one kind for all axes, or a kind for each axis of a domain. */
bool dvi__read_space(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_density *s = scene->density;
  if (section->kind == DVI__SCALAR) {
    s->kind = section->text;
    for (int d = 0; d < s->jets.dimension; d++) s->axis[d].kind = section->text;
    return true;
  }
  if (!dvi__want_mapping(scene, section, "space")) return false;
  if (s->mesh != NULL)
    return dvi__scene_refuse(scene, section->span,
                             "a mesh has no axes; its space is one text, as in 'fem:degree=2'");
  if (!dvi__want_keys(scene, section, "the domain", s->jets.dimension, s->jets.axis)) return false;
  for (int i = 0; i < section->count; i++) {
    if (!dvi__want_text(scene, section->child[i], "the space of an axis")) return false;
    s->axis[dvi__axis_named(scene, section->key[i]->text)].kind = section->child[i]->text;
  }
  for (int d = 0; d < s->jets.dimension; d++)
    if (s->axis[d].kind == NULL)
      return dvi__scene_refuse(scene, section->span, "the axis %s has no space", s->jets.axis[d]);
  return true;
}

/* ---- fields ---- */

/* Read scalar, complex, or vector(d). */
static bool read_kind(dvi_scene *scene, const dvi__tree *tree, dvi__declared_field *field)
{
  const dvi__expression *e;
  if (!dvi__tree_expression(scene, tree, &e)) return false;
  const bool has_size = (e->form == DVI__FORM_CALL && e->count == 1) ||
                        (e->form == DVI__FORM_INDEX && e->count == 2);
  const dvi__expression *word = e->form == DVI__FORM_INDEX ? e->part[0] : e;
  const char *name = word->form == DVI__FORM_NAME || has_size ? word->name : NULL;
  if (name != NULL && has_size && strcmp(name, "vector") == 0) {
    const dvi__tree size = {.kind = DVI__SCALAR, .span = e->part[e->count - 1]->span};
    field->is_vector = true;
    return dvi__tree_whole(scene, &size, "the size of a vector", 1, &field->components);
  }
  field->is_rotation = name != NULL && !has_size && strcmp(name, "rotation") == 0;
  field->components = DVI__TURN_COMPONENTS;
  if (field->is_rotation) return true;
  field->is_complex = field->is_vector = name != NULL && !has_size && strcmp(name, "complex") == 0;
  field->components = field->is_complex ? 2 : 1;
  return field->is_complex || (name != NULL && !has_size && strcmp(name, "scalar") == 0) ||
         dvi__scene_refuse(scene, tree->span, "a field is scalar, complex, vector(d) or rotation");
}

static bool count_components(dvi_scene *scene, dvi__declared_field *field)
{
  struct dvi__scene_density *s = scene->density;
  field->first = s->jets.components;
  if (field->components > DVI_COMPONENTS_MAX - field->first)
    return dvi__complain(scene->complaint, DVI_BAD_SIZE, field->span,
                         "more than %d components of fields", (int)DVI_COMPONENTS_MAX);
  s->jets.components += field->components;
  return true;
}

/* Read what is declared. Without the section Schroedinger's equation is that of psi. */
static bool list_fields(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_density *s = scene->density;
  const dvi__tree *schroedinger = dvi__tree_find(scene->tree, "schroedinger");
  s->field = dvi__arena_take(&scene->arena, (size_t)section->count + 1, sizeof *s->field);
  if (s->field == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++) {
    dvi__declared_field *field = s->field + s->fields++;
    *field = (dvi__declared_field){.name = section->key[i]->text, .span = section->key[i]->span};
    if (!read_kind(scene, section->child[i], field) || !count_components(scene, field))
      return false;
  }
  if (s->fields == 0 && schroedinger != NULL) {
    s->field[s->fields++] = (dvi__declared_field){.name = "psi",
                                                  .span = schroedinger->span,
                                                  .is_complex = true,
                                                  .is_vector = true,
                                                  .components = 2};
    s->jets.components = 2;
  }
  if (s->fields == 0)
    return dvi__scene_refuse(scene, s->place->span,
                             "the section 'fields' is missing, as in 'fields: {u: scalar}'");
  for (int i = 0; i < s->fields; i++) s->jets.is_rotation |= s->field[i].is_rotation;
  if (s->jets.is_rotation && s->fields > 1)
    return dvi__scene_refuse(scene, section->span,
                             "a field of rotations is the only one of its scene");
  return schroedinger == NULL || (s->fields == 1 && s->field->is_complex) ||
         dvi__scene_refuse(scene, section->span,
                           "beside 'schroedinger' there is one field, which is complex");
}

/* Write names for the components of a field, psi_re and psi_im, or w_1, w_2. */
static bool name_components(dvi_scene *scene, const dvi__declared_field *field)
{
  for (int k = 0; k < field->components; k++) {
    const size_t size = strlen(field->name) + 24;
    char *label = dvi__arena_take(&scene->arena, size, 1);
    if (label == NULL) return dvi__scene_no_memory(scene);
    if (field->is_complex)
      (void)dvi__print(label, size, "%s_%s", field->name, k == 0 ? "re" : "im");
    else if (field->is_vector || field->is_rotation)
      (void)dvi__print(label, size, "%s_%d", field->name, k + 1);
    else
      (void)dvi__print(label, size, "%s", field->name);
    scene->density->component[field->first + k] = label;
  }
  return true;
}

static bool name_place(dvi_scene *scene)
{
  struct dvi__scene_density *s = scene->density;
  const int dimension = s->jets.dimension;
  scene->n = scene->nv = scene->velocities = dvi__jet_count(&s->jets);
  scene->coordinate = dvi__arena_take(&scene->arena, (size_t)dimension + (size_t)s->fields,
                                      sizeof *scene->coordinate);
  scene->zeros = dvi__arena_take(&scene->arena, 2 * (size_t)scene->n, sizeof *scene->zeros);
  s->component = dvi__arena_take(&scene->arena, (size_t)s->jets.components, sizeof *s->component);
  if (scene->coordinate == NULL || scene->zeros == NULL || s->component == NULL)
    return dvi__scene_no_memory(scene);
  scene->jets = &s->jets;
  for (int d = 0; d < dimension; d++)
    if (!dvi__add_lines(scene, s->jets.axis[d], s->axis_span[d], 0, d, 1)) return false;
  for (int i = 0; i < s->fields; i++) {
    const dvi__declared_field *field = s->field + i;
    if (!dvi__add_lines(scene, field->name, field->span, field->is_vector, dimension + field->first,
                        field->components) ||
        !name_components(scene, field))
      return false;
    if (field->is_rotation)
      scene->coordinate[scene->coordinate_count - 1].shape = (dvi__shape){2, 3, 3};
  }
  return true;
}

bool dvi__read_fields(dvi_scene *scene, const dvi__tree *section)
{
  if (scene->density == NULL) return true; /* a scene of something else */
  return dvi__want_mapping(scene, section, "fields") && list_fields(scene, section) &&
         name_place(scene);
}

const dvi__declared_field *dvi__field_named(const dvi_scene *scene, const char *name)
{
  const struct dvi__scene_density *s = scene->density;
  for (int i = 0; i < s->fields; i++)
    if (strcmp(s->field[i].name, name) == 0) return s->field + i;
  return NULL;
}
