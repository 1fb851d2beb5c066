/* The sections of an electromagnetic field: polarization, materials, boundary, sources, probes and
 * the start. */
#include "scene/field/maxwell.h"

#include <stdio.h>
#include <string.h>

#include "scene/sections/sections.h"

/* Cells up to which a grid for yee has a mesh, too, so that other methods and commands take it. */
static const double cells_with_mesh = 50000;

/* ---- what kind of field ---- */

bool dvi__maxwell_begin(dvi_scene *scene)
{
  const dvi__tree *field = dvi__tree_find(scene->tree, "field");
  int which;
  if (field == NULL) return true;
  if (!dvi__tree_word(scene, field, "field", DVI__FIELD_WORDS, dvi__field_word, &which))
    return false;
  if (strcmp(dvi__field_word[which], "maxwell") != 0) return true;
  scene->field->maxwell = dvi__arena_take(&scene->arena, 1, sizeof *scene->field->maxwell);
  return scene->field->maxwell != NULL || dvi__scene_no_memory(scene);
}

/* Tell if a section, or an entry of its mapping, has a key. */
static bool mentions(const dvi__tree *section, const char *key)
{
  if (section == NULL || section->kind != DVI__MAPPING) return false;
  if (dvi__tree_find(section, key) != NULL) return true;
  for (int i = 0; i < section->count; i++)
    if (section->child[i]->kind == DVI__MAPPING && dvi__tree_find(section->child[i], key) != NULL)
      return true;
  return false;
}

static bool is_yee(const dvi_scene *scene)
{
  const char *method = scene->plan.method;
  return method != NULL && strncmp(method, "yee", 3) == 0 &&
         (method[3] == '\0' || method[3] == ':');
}

/* Tell if a probe is the flux through a box. */
static bool has_box_flux(const dvi__tree *probes)
{
  for (int i = 0; probes != NULL && probes->kind == DVI__MAPPING && i < probes->count; i++) {
    const dvi__tree *probe = probes->child[i],
                    *flux = probe->kind == DVI__MAPPING ? dvi__tree_find(probe, "flux") : NULL;
    if (flux != NULL && flux->kind == DVI__MAPPING) return true;
  }
  return false;
}

/* Find what a mesh cannot have. */
static const char *find_grid_only(const dvi_scene *scene)
{
  const dvi__tree *boundary = dvi__tree_find(scene->tree, "boundary"),
                  *sources = dvi__tree_find(scene->tree, "sources"),
                  *probes = dvi__tree_find(scene->tree, "probes");
  if (mentions(sources, "wave")) return "wave";
  if (mentions(boundary, "bloch")) return "bloch";
  if (mentions(boundary, "cpml")) return "cpml";
  return is_yee(scene) && has_box_flux(probes) ? "flux" : NULL;
}

bool dvi__is_grid_alone(dvi_scene *scene)
{
  struct dvi__scene_field *f = scene->field;
  double cells = 1;
  int dimension = 0;
  if (f->maxwell == NULL || !f->is_grid) return false;
  f->maxwell->grid_only = find_grid_only(scene);
  while (dimension < 4 && f->grid.cells[dimension] > 0) cells *= f->grid.cells[dimension++];
  if (dimension < 1 || dimension > 3) return false; /* the mesh has its own sentence for that */
  f->space = f->dimension = dimension;
  return f->maxwell->grid_only != NULL || (is_yee(scene) && cells > cells_with_mesh);
}

/* Read whether E lies across the plane, and count the components. */
bool dvi__read_polarization(dvi_scene *scene, const dvi__tree *section)
{
  static const char *const word[] = {"te", "tm"};
  int which;
  if (scene->field->maxwell == NULL)
    return dvi__scene_refuse(scene, section->span, "'polarization' is of 'field: maxwell'");
  if (!dvi__tree_word(scene, section, "a polarization", 2, word, &which)) return false;
  scene->field->maxwell->is_scalar = which == 1;
  return scene->field->dimension == 2 ||
         dvi__scene_refuse(scene, section->span,
                           "a polarization is of a field in two dimensions, and the mesh has %d",
                           scene->field->dimension);
}

/* E is one number in one dimension, too. B is a vector but where all of it is across the plane. */
static void count_components(struct dvi__scene_field *f)
{
  struct dvi__scene_maxwell *m = f->maxwell;
  if (f->dimension == 1) m->is_scalar = true;
  m->E = m->is_scalar ? 1 : f->space;
  m->B = m->is_scalar ? f->space : f->space == 2 ? 1 : 3;
}

void dvi__maxwell_form(const struct dvi__scene_field *field, bool is_B, const double *vector,
                       double *form)
{
  const struct dvi__scene_maxwell *m = field->maxwell;
  const int count = is_B ? m->B : m->E;
  for (int i = 0; i < count; i++) form[i] = vector[i];
  if (!is_B || count == 1) return;
  form[0] = m->is_scalar ? -vector[1] : vector[2];
  form[1] = m->is_scalar ? vector[0] : -vector[1];
  if (count == 3) form[2] = vector[0];
}

/* ---- materials ---- */

static bool part_is_there(dvi_scene *scene, const char *part, dvi__span span)
{
  const dvi_mesh *mesh = scene->field->mesh;
  if (mesh != NULL ? dvi__has_part_of_cells(mesh, part) : strcmp(part, "all") == 0) return true;
  if (mesh != NULL) return dvi__refuse_part(scene, span, part, true);
  return dvi__scene_refuse(scene, span, "a grid has no part '%s' of cells; it has all", part);
}

static bool read_material(dvi_scene *scene, const char *part, dvi__span span, const dvi__tree *tree)
{
  static const char *const known[] = {"eps", "mu", "sigma"};
  struct dvi__scene_maxwell *m = scene->field->maxwell;
  dvi__scene_material *material = m->material + m->materials++;
  *material = (dvi__scene_material){.part = part};
  if (!part_is_there(scene, part, span) || !dvi__want_mapping(scene, tree, "a material") ||
      !dvi__want_keys(scene, tree, "a material", 3, known))
    return false;
  for (int i = 0; i < DVI__QUANTITIES; i++) {
    const dvi__tree *value = dvi__tree_find(tree, known[i]);
    if (value == NULL) continue;
    material->span[i] = value->span;
    if (!dvi__place_read(scene, value, 0, "a material", material->place + i)) return false;
  }
  return true;
}

/* Materials are those of all, or by part. */
bool dvi__maxwell_read_materials(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_maxwell *m = scene->field->maxwell;
  if (!dvi__want_mapping(scene, section, "materials")) return false;
  m->material = dvi__arena_take(&scene->arena, (size_t)section->count + 1, sizeof *m->material);
  if (m->material == NULL) return dvi__scene_no_memory(scene);
  if (section->count > 0 && section->child[0]->kind != DVI__MAPPING)
    return read_material(scene, "all", section->span, section);
  return dvi__read_all_first(scene, section, read_material);
}

/* ---- walls ---- */

const char *const dvi__grid_side[] = {"left", "right", "bottom", "top", "back", "front"};

/* Return the axis of a side of a grid, or -1. */
static int axis_of_side(const char *part)
{
  for (int i = 0; i < 6; i++)
    if (strcmp(part, dvi__grid_side[i]) == 0) return i / 2;
  return -1;
}

static bool is_periodic(const dvi__tree *tree)
{
  return tree != NULL && tree->kind == DVI__SCALAR && strcmp(tree->text, "periodic") == 0;
}

/* An axis repeats itself at both of its ends. */
static bool read_periodic_sides(dvi_scene *scene, const dvi__tree *boundary)
{
  int ends[3] = {0};
  for (int i = 0; i < boundary->count; i++) {
    const int axis = axis_of_side(boundary->key[i]->text);
    if (axis >= 0 && is_periodic(boundary->child[i])) ends[axis]++;
  }
  for (int a = 0; a < 3; a++) {
    if (ends[a] == 1)
      return dvi__scene_refuse(scene, boundary->span,
                               "an axis repeats itself at both of its ends: let %s and %s be "
                               "periodic",
                               dvi__grid_side[2 * a], dvi__grid_side[2 * a + 1]);
    if (ends[a] == 2) scene->field->grid.periodic[a] = 1;
  }
  return true;
}

bool dvi__maxwell_read_periodic(dvi_scene *scene)
{
  const dvi__tree *boundary = dvi__tree_find(scene->tree, "boundary");
  if (scene->field->maxwell == NULL || !scene->field->is_grid || boundary == NULL) return true;
  const bool all = is_periodic(boundary) || (boundary->kind == DVI__MAPPING &&
                                             is_periodic(dvi__tree_find(boundary, "boundary")));
  for (int a = 0; a < 3 && all; a++)
    scene->field->grid.periodic[a] = scene->field->grid.cells[a] > 0;
  return all || boundary->kind != DVI__MAPPING || read_periodic_sides(scene, boundary);
}

static bool side_is_there(dvi_scene *scene, const char *part, dvi__span span)
{
  char list[64];
  const int sides = 2 * scene->field->dimension;
  for (int i = 0; i < sides; i++)
    if (strcmp(part, dvi__grid_side[i]) == 0) return true;
  return strcmp(part, "boundary") == 0 ||
         dvi__scene_refuse(scene, span, "a grid has no wall '%s'; it has boundary, %s", part,
                           dvi__list_words(sides, dvi__grid_side, " and ", list, sizeof list));
}

static bool wall_is_there(dvi_scene *scene, const char *part, dvi__span span)
{
  int64_t count = -1;
  if (scene->field->mesh == NULL) return side_is_there(scene, part, span);
  (void)dvi_mesh_part_cells(scene->field->mesh, part, 0, &count);
  return count >= 0 || dvi__refuse_part(scene, span, part, false);
}

static bool refuse_wall(dvi_scene *scene, dvi__span span)
{
  return dvi__scene_refuse(scene, span,
                           "a wall is pec, pmc, absorbing, periodic, {cpml: layers} or {bloch: "
                           "phase}");
}

/* Read '{cpml: 10}' or '{bloch: 0.5}'. */
static bool read_number_wall(dvi_scene *scene, const dvi__tree *tree, dvi__scene_wall *wall)
{
  static const char *const known[] = {"cpml", "bloch"};
  int layers;
  if (tree->count != 1)
    return dvi__scene_refuse(scene, tree->span,
                             "'cpml' and 'bloch' stand alone; beside sides the wall of the others "
                             "is 'boundary', as in '{boundary: {cpml: 10}, left: pec}'");
  if (!dvi__want_keys(scene, tree, "a wall", 2, known)) return false;
  if (strcmp(tree->key[0]->text, "bloch") == 0) {
    wall->word = DVI__WALL_BLOCH;
    return dvi__tree_number(scene, tree->child[0], "bloch", &wall->number);
  }
  wall->word = DVI__WALL_CPML;
  if (!dvi__tree_whole(scene, tree->child[0], "cpml", 1, &layers)) return false;
  wall->number = layers;
  return true;
}

static bool read_word_wall(dvi_scene *scene, const dvi__tree *tree, dvi__scene_wall *wall)
{
  static const char *const word[] = {"pmc", "pec", "absorbing"};
  enum { WORDS = sizeof word / sizeof *word };
  int which = 0;
  if (is_periodic(tree))
    return dvi__scene_refuse(scene, tree->span,
                             "this mesh repeats itself by its own axes, as in 'mesh: {generator: "
                             "kuhn-torus}'; a box does so by its boundary, too");
  while (which < WORDS && (tree->kind != DVI__SCALAR || strcmp(tree->text, word[which]) != 0))
    which++;
  wall->word = (dvi__wall_word)which;
  return which < WORDS || refuse_wall(scene, tree->span);
}

static bool read_wall(dvi_scene *scene, const char *part, dvi__span span, const dvi__tree *tree)
{
  struct dvi__scene_maxwell *m = scene->field->maxwell;
  dvi__scene_wall *wall = m->wall + m->walls++;
  *wall = (dvi__scene_wall){.part = part, .span = span};
  if (is_periodic(tree) && scene->field->is_grid) {
    m->walls--; /* the axes of the grid repeat themselves, and have no wall */
    return side_is_there(scene, part, span);
  }
  return (tree->kind == DVI__MAPPING ? read_number_wall : read_word_wall)(scene, tree, wall) &&
         wall_is_there(scene, part, span);
}

/* The sides that have no wall of their own have that of the whole boundary. */
static void add_other_sides(dvi_scene *scene, int walls, const dvi__scene_wall *wall,
                            const dvi__scene_wall *whole)
{
  struct dvi__scene_maxwell *m = scene->field->maxwell;
  const dvi_mesh *mesh = scene->field->mesh;
  for (int side = 0; side < 2 * scene->field->dimension; side++) {
    int64_t count = 1;
    bool is_given = false;
    for (int i = 0; i < walls; i++)
      is_given = is_given || strcmp(wall[i].part, dvi__grid_side[side]) == 0;
    if (mesh != NULL) (void)dvi_mesh_part_cells(mesh, dvi__grid_side[side], 0, &count);
    if (is_given || count < 0 || (count == 0 && !dvi__is_share(scene))) continue;
    m->wall[m->walls] = *whole;
    m->wall[m->walls++].part = dvi__grid_side[side];
  }
}

/* Walls on sides of a grid replace that of the whole boundary. On a mesh the library takes the
 * strongest of those that a facet has. */
static bool replace_whole(dvi_scene *scene)
{
  struct dvi__scene_maxwell *m = scene->field->maxwell;
  const dvi__scene_wall *wall = m->wall;
  const int walls = m->walls;
  if (!scene->field->is_grid || walls < 2) return true;
  m->wall = dvi__arena_take(&scene->arena, (size_t)walls + 6, sizeof *m->wall);
  if (m->wall == NULL) return dvi__scene_no_memory(scene);
  m->walls = 0;
  for (int i = 0; i < walls; i++)
    if (strcmp(wall[i].part, "boundary") == 0)
      add_other_sides(scene, walls, wall, wall + i);
    else
      m->wall[m->walls++] = wall[i];
  return true;
}

/* A field has one phase over a period, which both ends of an axis tell. */
static bool phases_agree(dvi_scene *scene)
{
  const struct dvi__scene_maxwell *m = scene->field->maxwell;
  for (int i = 0; i < m->walls; i++)
    for (int k = 0; k < i; k++) {
      const dvi__scene_wall *a = m->wall + k, *b = m->wall + i;
      if (a->word == DVI__WALL_BLOCH && b->word == DVI__WALL_BLOCH && a->number != b->number &&
          axis_of_side(a->part) == axis_of_side(b->part))
        return dvi__scene_refuse(scene, b->span,
                                 "both ends of an axis have the same phase, and '%s' has %g, and "
                                 "'%s' %g",
                                 a->part, a->number, b->part, b->number);
    }
  return true;
}

/* A mapping by part has values that are words or mappings; '{cpml: 10}' alone is of the whole
 * boundary. */
bool dvi__maxwell_read_walls(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_maxwell *m = scene->field->maxwell;
  m->wall = dvi__arena_take(&scene->arena, (size_t)section->count + 1, sizeof *m->wall);
  if (m->wall == NULL) return dvi__scene_no_memory(scene);
  if (dvi__tree_find(section, "cpml") != NULL || dvi__tree_find(section, "bloch") != NULL)
    return read_wall(scene, "boundary", section->span, section);
  return dvi__read_by_part(scene, section, read_wall) && replace_whole(scene) &&
         phases_agree(scene);
}

/* ---- sources ---- */

static bool read_dipole(dvi_scene *scene, const dvi__tree *tree, dvi__scene_source *source)
{
  static const char *const known[] = {"at", "current", "moment"};
  const struct dvi__scene_maxwell *m = scene->field->maxwell;
  const dvi__tree *current = dvi__tree_find(tree, "current"),
                  *moment = dvi__tree_find(tree, "moment"),
                  *vector = current != NULL ? current : moment;
  if (!dvi__want_keys(scene, tree, "a dipole", 3, known) ||
      !dvi__point_read(scene, source->at, scene->field->space, "a dipole's place", source->point))
    return false;
  if ((current == NULL) == (moment == NULL))
    return dvi__scene_refuse(scene, tree->span,
                             "a dipole has a current or a moment, as in '{at: [0, 0], moment: [0, "
                             "sin(t)]}'");
  const bool is_list = vector->kind == DVI__SEQUENCE;
  if ((is_list ? vector->count : 1) != m->E || vector->kind == DVI__MAPPING)
    return dvi__scene_refuse(scene, vector->span, "a dipole has %d component%s here", m->E,
                             m->E == 1 ? "" : "s");
  for (int i = 0; i < m->E; i++)
    if (!dvi__signal_read(scene, is_list ? vector->child[i] : vector, moment != NULL,
                          source->signal + i))
      return false;
  return true;
}

static bool read_signal(dvi_scene *scene, const dvi__tree *tree, dvi__scene_source *source)
{
  const dvi__tree *signal = dvi__tree_find(tree, "signal");
  if (signal == NULL)
    return dvi__scene_refuse(scene, tree->span, "the source has no signal, a function of t");
  return dvi__signal_read(scene, signal, false, source->signal);
}

static bool read_density(dvi_scene *scene, const dvi__tree *tree, const dvi__tree *density,
                         dvi__scene_source *source)
{
  static const char *const known[] = {"density", "signal"};
  return dvi__want_keys(scene, tree, "a current", 2, known) &&
         dvi__place_vector_read(scene, density, scene->field->maxwell->E, "a density",
                                &source->density) &&
         read_signal(scene, tree, source);
}

/* E is along its only component, or in a plane to the left of the direction, else along z. */
static void choose_polarization(const struct dvi__scene_field *f, dvi__scene_source *source)
{
  const bool is_in_plane = f->maxwell->E == 2;
  source->polarization[0] = is_in_plane ? -source->direction[1] : 0;
  source->polarization[1] = is_in_plane ? source->direction[0] : f->dimension == 1;
  source->polarization[2] = !is_in_plane && f->dimension > 1;
}

/* Read '{wave: [1, 0], polarization: [0, 1], from: [..], to: [..], signal: ..}'. */
static bool read_wave(dvi_scene *scene, const dvi__tree *tree, dvi__scene_source *source)
{
  static const char *const known[] = {"wave", "polarization", "from", "to", "signal"};
  const int axes = scene->field->dimension;
  const dvi__tree *from = dvi__tree_find(tree, "from"), *to = dvi__tree_find(tree, "to"),
                  *along = dvi__tree_find(tree, "polarization");
  if (!dvi__want_keys(scene, tree, "a plane wave", 5, known)) return false;
  if (from == NULL || to == NULL)
    return dvi__scene_refuse(scene, tree->span,
                             "a plane wave fills a box, as in '{wave: [1, 0], from: [1, 1], to: "
                             "[3, 3], signal: sin(t)}'");
  if (!dvi__point_read(scene, source->wave, axes, "a wave's direction", source->direction))
    return false;
  choose_polarization(scene->field, source);
  return dvi__point_read(scene, from, axes, "the corner 'from'", source->lower) &&
         dvi__point_read(scene, to, axes, "the corner 'to'", source->upper) &&
         (along == NULL ||
          dvi__point_read(scene, along, 3, "a polarization", source->polarization)) &&
         read_signal(scene, tree, source);
}

static bool read_source(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree,
                        dvi__scene_source *source)
{
  *source = (dvi__scene_source){.span = key->span};
  if (!dvi__want_mapping(scene, tree, "a source")) return false;
  const dvi__tree *density = dvi__tree_find(tree, "density");
  source->at = dvi__tree_find(tree, "at");
  source->wave = dvi__tree_find(tree, "wave");
  if ((source->at != NULL) + (density != NULL) + (source->wave != NULL) != 1)
    return dvi__scene_refuse(scene, tree->span,
                             "a source is a dipole '{at: .., moment: ..}', a current '{density: "
                             ".., signal: ..}' or a plane wave '{wave: .., signal: ..}'");
  if (source->at != NULL) return read_dipole(scene, tree, source);
  return density != NULL ? read_density(scene, tree, density, source)
                         : read_wave(scene, tree, source);
}

bool dvi__read_sources(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_maxwell *m = scene->field->maxwell;
  if (m == NULL) return dvi__scene_refuse(scene, section->span, "'sources' is of 'field: maxwell'");
  count_components(scene->field);
  if (!dvi__want_mapping(scene, section, "sources")) return false;
  m->source = dvi__arena_take(&scene->arena, (size_t)section->count + 1, sizeof *m->source);
  if (m->source == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++)
    if (!read_source(scene, section->key[i], section->child[i], m->source + m->sources++))
      return false;
  return true;
}

/* ---- probes ---- */

/* Give a probe the name of its component. */
static bool name_component(dvi_scene *scene, const char *name, int axis, dvi__scene_probe *probe)
{
  char text[128];
  (void)snprintf(text, sizeof text, "%s_%c", name, "xyz"[axis]);
  probe->name = dvi__arena_text(&scene->arena, text, strlen(text));
  return probe->name != NULL || dvi__scene_no_memory(scene);
}

static bool read_value(dvi_scene *scene, const dvi__tree *tree, const dvi__tree *at,
                       dvi__scene_probe probe)
{
  static const char *const known[] = {"at", "of", "along"}, *const word[] = {"E", "B"};
  struct dvi__scene_maxwell *m = scene->field->maxwell;
  const dvi__tree *of = dvi__tree_find(tree, "of"), *along = dvi__tree_find(tree, "along");
  int is_B = 0;
  if (!dvi__want_keys(scene, tree, "a probe", 3, known) ||
      !dvi__point_read(scene, at, scene->field->space, "a probe", probe.at) ||
      (of != NULL && !dvi__tree_word(scene, of, "what a probe is of", 2, word, &is_B)))
    return false;
  const int components = is_B ? m->B : m->E;
  probe.of = word[is_B];
  probe.place = at->span;
  if (along != NULL) {
    m->probe[m->probes++] = probe;
    return dvi__point_read(scene, along, components, "a direction", m->probe[m->probes - 1].along);
  }
  for (int i = 0; i < components; i++) {
    dvi__scene_probe *one = m->probe + m->probes++;
    *one = probe;
    one->along[i] = 1;
    if (components > 1 && !name_component(scene, probe.name, i, one)) return false;
  }
  return true;
}

static bool read_part(dvi_scene *scene, const dvi__tree *tree, const dvi__tree *part,
                      dvi__scene_probe probe)
{
  static const char *const known[] = {"flux", "energy"};
  struct dvi__scene_maxwell *m = scene->field->maxwell;
  if (!dvi__want_keys(scene, tree, "a probe", 2, known) ||
      !dvi__want_text(scene, part, "a part of the mesh"))
    return false;
  probe.part = part->text;
  m->probe[m->probes++] = probe;
  return true;
}

/* Read '{flux: {from: [..], to: [..]}}', through a box of a grid. */
static bool read_box_flux(dvi_scene *scene, const dvi__tree *box, dvi__scene_probe probe)
{
  static const char *const known[] = {"from", "to"};
  struct dvi__scene_maxwell *m = scene->field->maxwell;
  const int axes = scene->field->dimension;
  const dvi__tree *from = dvi__tree_find(box, "from"), *to = dvi__tree_find(box, "to");
  if (!dvi__want_keys(scene, box, "a flux", 2, known)) return false;
  if (from == NULL || to == NULL)
    return dvi__scene_refuse(scene, box->span, "a flux goes through a box {from: .., to: ..}");
  probe.has_box = true;
  if (!dvi__point_read(scene, from, axes, "the corner 'from'", probe.lower) ||
      !dvi__point_read(scene, to, axes, "the corner 'to'", probe.upper))
    return false;
  m->probe[m->probes++] = probe;
  return true;
}

static bool read_probe(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree)
{
  if (!dvi__want_name(scene, key->text, key->span) || !dvi__want_mapping(scene, tree, "a probe"))
    return false;
  const dvi__tree *at = dvi__tree_find(tree, "at"), *flux = dvi__tree_find(tree, "flux"),
                  *energy = dvi__tree_find(tree, "energy");
  if ((at != NULL) + (flux != NULL) + (energy != NULL) != 1)
    return dvi__scene_refuse(scene, tree->span,
                             "a probe is at a point, as in '{of: E, at: [0, 1]}', or it is the "
                             "'flux' through a part, or the 'energy' in one");
  const dvi__scene_probe probe = {
      .span = key->span, .name = key->text, .of = flux != NULL ? "flux" : "energy"};
  if (at != NULL) return read_value(scene, tree, at, probe);
  if (flux != NULL && flux->kind == DVI__MAPPING) return read_box_flux(scene, flux, probe);
  return read_part(scene, tree, flux != NULL ? flux : energy, probe);
}

/* Refuse the name of another column. */
static bool name_is_new(dvi_scene *scene, int i)
{
  const struct dvi__scene_maxwell *m = scene->field->maxwell;
  const char *name = m->probe[i].name;
  bool there = strcmp(name, "t") == 0 || dvi__is_unknown(name, 'A');
  for (int k = 0; dvi__observable[k] != NULL; k++)
    there = there || strcmp(dvi__observable[k], name) == 0;
  for (int k = 0; k < i; k++) there = there || strcmp(m->probe[k].name, name) == 0;
  return !there || dvi__scene_refuse(scene, m->probe[i].span,
                                     "there is a column '%s' already; choose another name", name);
}

bool dvi__maxwell_read_probes(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_maxwell *m = scene->field->maxwell;
  count_components(scene->field);
  if (!dvi__want_mapping(scene, section, "probes")) return false;
  m->probe = dvi__arena_take(&scene->arena, 3 * (size_t)section->count + 1, sizeof *m->probe);
  if (m->probe == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++)
    if (!read_probe(scene, section->key[i], section->child[i])) return false;
  for (int i = 0; i < m->probes; i++)
    if (!name_is_new(scene, i)) return false;
  return true;
}

/* ---- the start ---- */

bool dvi__maxwell_read_start(dvi_scene *scene, const dvi__tree *section)
{
  static const char *const known[] = {"E", "B", "A"};
  struct dvi__scene_maxwell *m = scene->field->maxwell;
  count_components(scene->field);
  dvi__place_vector **const vector[] = {&m->of_E, &m->of_B, &m->of_A};
  const int components[] = {m->E, m->B, m->E};
  if (!dvi__want_mapping(scene, section, "initial") ||
      !dvi__want_keys(scene, section, "the start of a field", 3, known))
    return false;
  for (int k = 0; k < 3; k++) {
    const dvi__tree *value = dvi__tree_find(section, known[k]);
    if (value != NULL && !dvi__place_vector_read(scene, value, components[k], known[k], vector[k]))
      return false;
  }
  return m->of_A == NULL || m->of_B == NULL ||
         dvi__scene_refuse(scene, section->span, "B is that of A; give one of them");
}
