/* The registry of sections, with the known ones, the required ones, and their readers. */
#include <string.h>

#include "scene/elaborate/hints.h"
#include "scene/sections/motion.h"
#include "scene/sections/sections.h"

typedef enum presence { FIRST, OPTIONAL, REQUIRED, DEFAULTED, REFUSED } presence;

typedef struct section {
  const char *name;
  presence presence;
  const char *example; /* an example for required sections */
  const char *reason;  /* reason for refused sections */
  bool (*read)(dvi_scene *scene, const dvi__tree *section);
} section;

static const section sections[] = {
#define SECTION(name, presence, example, line) {#name, presence, example, NULL, dvi__read_##name},
#define REFUSED_SECTION(name, line) {#name, REFUSED, NULL, line, NULL},
#include "scene/sections/sections.def"
#undef SECTION
#undef REFUSED_SECTION
};

enum { SECTIONS = sizeof sections / sizeof *sections };

/* Refuse a section by the name that it has elsewhere. Keys below sections have no such names. */
static bool registry_refuse_other_names(dvi_scene *scene, const dvi__tree *tree)
{
  for (int i = 0; i < tree->count; i++) {
    const dvi__tree *key = tree->key[i];
    const char *here = dvi__hint_of_section(key->text);
    if (here != NULL)
      return dvi__scene_refuse(scene, key->span, "a scene has no '%s'; the section is %s",
                               key->text, here);
  }
  return true;
}

/* Refuse a file that is no mapping, or a mapping of several keys of which none is known. It was
 * meant for something else. */
static bool registry_knows_any(dvi_scene *scene, const dvi__tree *tree, const char *const *known)
{
  char hint[96];
  bool near = tree->count == 1;
  for (int i = 0; tree->kind == DVI__MAPPING && i < tree->count && !near; i++)
    for (int k = 0; k < SECTIONS && !near; k++)
      near = strcmp(tree->key[i]->text, known[k]) == 0 ||
             dvi__nearest(tree->key[i]->text, SECTIONS, known, hint, sizeof hint)[0] != '\0';
  if (tree->kind == DVI__MAPPING && near) return true;
  return dvi__complain_of_file(scene->complaint, tree->span,
                               tree->kind == DVI__MAPPING    ? "this is a mapping of other names"
                               : tree->kind == DVI__SEQUENCE ? "this is a list"
                                                             : "this is a text");
}

bool dvi__check_section_names(dvi_scene *scene, const dvi__tree *tree)
{
  const char *known[SECTIONS];
  for (int k = 0; k < SECTIONS; k++) known[k] = sections[k].name;
  return registry_knows_any(scene, tree, known) && registry_refuse_other_names(scene, tree) &&
         dvi__want_keys(scene, tree, "a scene", SECTIONS, known);
}

/* Read the section that brings others. */
static bool registry_read_first(dvi_scene *scene)
{
  for (int k = 0; k < SECTIONS; k++) {
    const dvi__tree *found = dvi__tree_find(scene->tree, sections[k].name);
    if (sections[k].presence == FIRST && found != NULL && !sections[k].read(scene, found))
      return false;
  }
  return true;
}

/* Sections of a scene of a field, those first that no other scene has. */
static const char *const field_sections[] = {
    "mesh",       "field",       "star",   "materials",    "boundary", "source",
    "potential",  "probes",      "solve",  "polarization", "sources",  "loads",
    "obstacles",  "title",       "method", "step",         "until",    "initial",
    "parameters", "definitions", "sweep",  "report",       "damping"};
enum { FIELD_SECTIONS = sizeof field_sections / sizeof *field_sections, OF_FIELD_ALONE = 13 };

/* Sections of a scene of a density, those first that no other scene has. */
static const char *const density_sections[] = {
    "domain",     "space",  "fields",  "density", "schroedinger", "moving", "mesh",
    "boundary",   "probes", "title",   "method",  "step",         "until",  "initial",
    "parameters", "sweep",  "damping", "report",  "definitions",  "solve",  "final"};
enum {
  DENSITY_SECTIONS = sizeof density_sections / sizeof *density_sections,
  OF_DENSITY_ALONE = 6
};

static bool is_density_section(const char *name, int count)
{
  for (int k = 0; k < count; k++)
    if (strcmp(name, density_sections[k]) == 0) return true;
  return false;
}

bool dvi__has_density(const dvi_scene *scene)
{
  return dvi__tree_find(scene->tree, "density") != NULL ||
         dvi__tree_find(scene->tree, "schroedinger") != NULL;
}

/* A density needs a domain or a mesh, and has no section of anything else. */
static bool registry_check_density(dvi_scene *scene)
{
  const dvi__tree *tree = scene->tree, *domain = dvi__tree_find(tree, "domain"),
                  *mesh = dvi__tree_find(tree, "mesh"), *density = dvi__tree_find(tree, "density"),
                  *short_form = dvi__tree_find(tree, "schroedinger");
  for (int i = 0; i < tree->count && !dvi__has_density(scene); i++)
    if (is_density_section(tree->key[i]->text, OF_DENSITY_ALONE))
      return dvi__scene_refuse(scene, tree->key[i]->span,
                               "'%s' is of fields with a density, and the section 'density' is "
                               "missing, as in 'density: u'^2/2 - d(u,x)^2/2'",
                               tree->key[i]->text);
  if (!dvi__has_density(scene)) return true;
  if (density != NULL && short_form != NULL)
    return dvi__scene_refuse(scene, short_form->span,
                             "'schroedinger' is a density; beside it there is no other one");
  if (domain != NULL && mesh != NULL)
    return dvi__scene_refuse(scene, mesh->span,
                             "beside 'domain' there is no mesh: fields live on one of them");
  if (domain == NULL && mesh == NULL)
    return dvi__scene_refuse(scene, (density != NULL ? density : short_form)->span,
                             "fields live on a domain, as in 'domain: {x: [0, 1]}', or on a mesh");
  for (int i = 0; i < tree->count; i++)
    if (!is_density_section(tree->key[i]->text, DENSITY_SECTIONS))
      return dvi__scene_refuse(scene, tree->key[i]->span,
                               "a scene with a density has no section '%s'", tree->key[i]->text);
  return true;
}

static int find_field_section(const char *name, int count)
{
  for (int k = 0; k < count; k++)
    if (strcmp(name, field_sections[k]) == 0) return k;
  return -1;
}

/* A mesh needs a field, and the other way round, and a field has no section of mechanics. */
static bool registry_check_field(dvi_scene *scene)
{
  const dvi__tree *tree = scene->tree, *mesh = dvi__tree_find(tree, "mesh");
  if (dvi__has_density(scene)) return true;
  if (mesh != NULL && dvi__tree_find(tree, "field") == NULL)
    return dvi__scene_refuse(scene, mesh->span,
                             "beside 'mesh' the section 'field' is missing, as "
                             "in 'field: wave'");
  for (int i = 0; i < tree->count; i++) {
    const dvi__tree *key = tree->key[i];
    if (mesh == NULL && find_field_section(key->text, OF_FIELD_ALONE) >= 0)
      return dvi__scene_refuse(scene, key->span, "'%s' is of a field, and the scene has no 'mesh'",
                               key->text);
    if (mesh != NULL && find_field_section(key->text, FIELD_SECTIONS) < 0)
      return dvi__scene_refuse(scene, key->span, "a scene with a mesh has no section '%s'",
                               key->text);
  }
  return true;
}

bool dvi__is_of_field(const dvi_scene *scene)
{
  return dvi__tree_find(scene->tree, "mesh") != NULL || dvi__has_density(scene);
}

/* A static problem of a field has neither steps nor a start. */
static bool is_required(const dvi_scene *scene, const section *s)
{
  return s->presence == REQUIRED && !dvi__is_of_field(scene);
}

static bool registry_check_presence(dvi_scene *scene)
{
  if (!registry_check_density(scene) || !registry_check_field(scene)) return false;
  for (int k = 0; k < SECTIONS; k++) {
    const dvi__tree *found = dvi__tree_find(scene->tree, sections[k].name);
    if (found != NULL && sections[k].presence == REFUSED)
      return dvi__scene_refuse(scene, found->span, "%s", sections[k].reason);
    if (found == NULL && is_required(scene, &sections[k]))
      return dvi__scene_refuse(scene, DVI__NOWHERE, "the section '%s' is missing, as in '%s'",
                               sections[k].name, sections[k].example);
  }
  return true;
}

bool dvi__scene_read_tree(dvi_scene *scene)
{
  static const dvi__tree empty = {.kind = DVI__MAPPING};
  if (!dvi__check_section_names(scene, scene->tree) || !registry_read_first(scene) ||
      !registry_check_presence(scene))
    return false;
  if (!dvi__is_of_field(scene) && !dvi__check_motion_section(scene)) return false;
  for (int k = 0; k < SECTIONS; k++) {
    const dvi__tree *found = dvi__tree_find(scene->tree, sections[k].name);
    if (found == NULL && sections[k].presence == DEFAULTED) found = &empty;
    scene->reads = DVI__ELSEWHERE;
    if (found != NULL && sections[k].presence != FIRST && !sections[k].read(scene, found))
      return false;
  }
  return dvi__read_uses(scene);
}
