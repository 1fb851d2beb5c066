/* Functions that are watched along a run, that is symmetries, invariants and events. */
#include <string.h>

#include "scene/terms/callbacks.h"
#include "scene/sections/columns.h"
#include "scene/sections/motion.h"
#include "scene/sections/sections.h"

bool dvi__read_symmetries(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "symmetries")) return false;
  dvi_symmetry *list = dvi__arena_take(&scene->arena, (size_t)section->count + 1, sizeof *list);
  if (list == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++) {
    dvi__scene_term *term;
    if (!dvi__column_is_new(scene, section->key[i]->text, section->key[i]->span, NULL))
      return false;
    if (!dvi__field_read(scene, section->child[i], 0, "a symmetry", &term)) return false;
    term->role = DVI__ROLE_WATCHED;
    list[i] = (dvi_symmetry){
        .name = section->key[i]->text, .generator = dvi__term_generator, .user = term};
  }
  scene->terms.symmetries = list;
  scene->terms.symmetry_count = section->count;
  return true;
}

/* Read a function of t, q and the variables in `may`. */
static bool read_function(dvi_scene *scene, const dvi__tree *tree, unsigned may, const char *where,
                          dvi__scene_term **term)
{
  const dvi__expression *e;
  dvi__kernels list = {0};
  const bool good = dvi__tree_expression(scene, tree, &e) &&
                    dvi__kernels_add(scene, may, where, e, 0, &list) &&
                    dvi__kernels_function(scene, &list, 0, term);
  dvi__kernels_free(&list);
  if (good) (*term)->role = DVI__ROLE_WATCHED;
  return good;
}

/* Check that an invariant's name is no symmetry's, since symmetries have columns, too. */
static bool invariant_is_new(dvi_scene *scene, const dvi__tree *key)
{
  const dvi__tree *symmetries = dvi__tree_find(scene->tree, "symmetries");
  if (symmetries == NULL || dvi__tree_find(symmetries, key->text) == NULL)
    return dvi__column_is_new(scene, key->text, key->span, NULL);
  return dvi__scene_refuse(scene, key->span,
                           "there is a symmetry '%s' already; choose another name", key->text);
}

bool dvi__read_invariants(dvi_scene *scene, const dvi__tree *section)
{
  const unsigned may = DVI__MENTIONS_Q | DVI__MENTIONS_P | DVI__MENTIONS_T |
                       (scene->terms.hamiltonian == NULL ? DVI__MENTIONS_V : 0U);
  if (!dvi__want_mapping(scene, section, "invariants")) return false;
  dvi_invariant *list = dvi__arena_take(&scene->arena, (size_t)section->count + 1, sizeof *list);
  if (list == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < section->count; i++) {
    dvi__scene_term *term;
    if (!invariant_is_new(scene, section->key[i])) return false;
    if (!read_function(scene, section->child[i], may, "an invariant", &term)) return false;
    list[i] = (dvi_invariant){
        .name = section->key[i]->text, .value = dvi__term_value, .user = term};
  }
  scene->terms.invariants = list;
  scene->terms.invariant_count = section->count;
  return true;
}

static bool read_event(dvi_scene *scene, const char *name, const dvi__tree *tree,
                       dvi_scene_event *event)
{
  static const char *const known[] = {"zero", "direction", "stop"},
                           *const direction_word[] = {"rising", "falling", "both"},
                           *const stop_word[] = {"no", "yes"};
  static const int sign[] = {1, -1, 0};
  int direction = 2, stop = 0;
  dvi__scene_term *term;
  if (!dvi__want_mapping(scene, tree, "an event") ||
      !dvi__want_keys(scene, tree, "an event", 3, known))
    return false;
  const dvi__tree *zero = dvi__tree_find(tree, "zero"), *falls = dvi__tree_find(tree, "direction"),
                  *stops = dvi__tree_find(tree, "stop");
  if (zero == NULL)
    return dvi__scene_refuse(scene, tree->span,
                             "an event needs 'zero', the expression that changes its sign");
  if (falls != NULL && !dvi__tree_word(scene, falls, "direction", 3, direction_word, &direction))
    return false;
  if (stops != NULL && !dvi__tree_word(scene, stops, "stop", 2, stop_word, &stop)) return false;
  if (!read_function(scene, zero,
                     DVI__MENTIONS_Q | DVI__MENTIONS_V | DVI__MENTIONS_T | DVI__OF_STATE,
                     "an event", &term))
    return false;
  term->role = DVI__ROLE_AUXILIARY;
  *event = (dvi_scene_event){.name = name,
                             .value = dvi__term_value,
                             .user = term,
                             .direction = sign[direction],
                             .terminal = stop};
  return true;
}

bool dvi__read_events(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "events")) return false;
  scene->event = dvi__arena_take(&scene->arena, (size_t)section->count + 1, sizeof *scene->event);
  if (scene->event == NULL) return dvi__scene_no_memory(scene);
  scene->event_count = section->count;
  for (int i = 0; i < section->count; i++)
    if (!dvi__want_name(scene, section->key[i]->text, section->key[i]->span) ||
        !read_event(scene, section->key[i]->text, section->child[i], &scene->event[i]))
      return false;
  return true;
}
