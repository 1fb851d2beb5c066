/* The section include: components, which are scenes in the scene's own folder or below, each under
 * a name. All names that a component declares get this name and _ in front. Its sections are merged
 * with those of the scene, so that all other readers see one scene.
 *
 * The texts of all files stand one after the other in the scene's source. A place in it tells its
 * file, the file's prefix, and the line in messages. Names in expressions get their prefix from the
 * parser, those that are keys get it here. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/elaborate/words.h"
#include "scene/sections/sections.h"
#include "scene/text/lexer.h"
#include "scene/text/parser.h"
#include "text/heap.h"
#include "text/utf8.h"

enum { COMPONENTS_MAX = 256, DEPTH_MAX = 8, FILE_MAX = 1 << 20, TEXT_MAX = 1 << 22 };

/* What becomes of a component's section. */
typedef enum taking {
  LEFT_OUT,  /* it belongs to the component's own run */
  INHERITED, /* an entry of the scene that includes replaces the component's */
  NAMED,     /* entries by name, each with its own one */
  SUMMED,    /* entries of one coordinate are added, since readers add them */
  ADDED      /* one expression, added to those of the others */
} taking;

static const struct {
  const char *section;
  taking taking;
} takings[] = {
    {"title", LEFT_OUT},     {"method", LEFT_OUT},     {"step", LEFT_OUT},
    {"until", LEFT_OUT},     {"symmetries", LEFT_OUT}, {"invariants", LEFT_OUT},
    {"final", LEFT_OUT},     {"objective", LEFT_OUT},  {"report", LEFT_OUT},
    {"sweep", LEFT_OUT},     {"include", LEFT_OUT},    {"parameters", INHERITED},
    {"initial", INHERITED},  {"coordinates", NAMED},   {"definitions", NAMED},
    {"controls", NAMED},     {"potentials", NAMED},    {"constraints", NAMED},
    {"nonholonomic", NAMED}, {"contacts", NAMED},      {"events", NAMED},
    {"joints", NAMED},       {"forces", SUMMED},       {"one_form", SUMMED},
    {"lagrangian", ADDED},   {"kinetic", ADDED},       {"hamiltonian", ADDED},
    {"dissipation", ADDED},
};

enum { TAKINGS = sizeof takings / sizeof *takings };

/* Return the row of a section, or -1 if no component may have it. */
static int row_of(const char *section)
{
  int k = TAKINGS - 1;
  while (k >= 0 && strcmp(takings[k].section, section) != 0) k--;
  return k;
}

/* The text of all files, as it grows. */
typedef struct joined {
  char *text;
  size_t room;
  dvi__source_part *part;
} joined;

/* ---- files ---- */

/* Append a file's text to the scene's source. The part's name and prefix are kept as they are. */
static bool append_file(dvi_scene *scene, joined *all, const char *text, dvi__source_part part)
{
  dvi__source *source = &scene->source;
  part.first = source->size + (source->part_count > 0);
  if (all->text == NULL || part.first + part.size > all->room) {
    all->room = 2 * (part.first + part.size);
    char *grown = dvi__arena_take(&scene->arena, all->room, 1);
    if (grown == NULL) return dvi__scene_no_memory(scene);
    if (all->text != NULL) memcpy(grown, source->text, source->size);
    all->text = grown;
  }
  dvi__source_part *parts = dvi__arena_grow(&scene->arena, all->part, (size_t)source->part_count,
                                            sizeof *parts);
  if (parts == NULL) return dvi__scene_no_memory(scene);
  if (part.first > 0) all->text[part.first - 1] = '\n';
  if (part.size > 0) memcpy(all->text + part.first, text, part.size);
  parts[source->part_count] = part;
  all->part = parts;
  source->text = all->text;
  source->size = part.first + part.size;
  source->part = parts;
  source->part_count++;
  return true;
}

/* Read a file into memory of the heap, with one character more than is allowed if it is longer. */
static bool read_text(dvi_scene *scene, dvi__span span, const char *path, char **text, size_t *size)
{
  FILE *file = fopen(path, "rb");
  *text = file != NULL ? dvi__heap_take(FILE_MAX + 1, 1) : NULL;
  *size = *text != NULL ? fread(*text, 1, FILE_MAX + 1, file) : 0;
  const bool failed = file == NULL || ferror(file) != 0;
  if (file != NULL) (void)fclose(file);
  if (!failed) return *text != NULL || dvi__scene_no_memory(scene);
  return dvi__scene_refuse(scene, span, "'%s' is no file that can be read", path);
}

static void move_spans(dvi__tree *tree, size_t by)
{
  tree->span.first += by;
  for (int i = 0; i < tree->count; i++) {
    if (tree->kind == DVI__MAPPING) move_spans(tree->key[i], by);
    move_spans(tree->child[i], by);
  }
}

/* Read a file's tree, with places in the whole source. While it is read its text stands alone. */
static bool read_file_tree(dvi_scene *scene, const dvi__tree **tree)
{
  const dvi__source_part *part = &scene->source.part[scene->source.part_count - 1];
  const dvi__source alone = {part->name, scene->source.text + part->first, part->size, NULL, 0};
  scene->complaint->source = &alone;
  const bool good = dvi__tree_read(&alone, &scene->arena, scene->complaint, tree);
  scene->complaint->source = &scene->source;
  if (good) move_spans((dvi__tree *)*tree, part->first);
  return good;
}

static bool open_component(dvi_scene *scene, joined *all, const dvi__tree *file, const char *prefix,
                           const dvi__tree **tree)
{
  const char *path;
  char *text = NULL;
  dvi__source_part part = {.prefix = prefix, .keeps = dvi__is_word};
  if (!dvi__scene_place_component(scene, file->span, file->text, &path)) return false;
  bool good = read_text(scene, file->span, path, &text, &part.size);
  if (good &&
      (scene->source.part_count > COMPONENTS_MAX || scene->source.size + part.size > TEXT_MAX))
    good = dvi__complain(scene->complaint, DVI_BAD_SIZE, file->span,
                         "more than %d components, or more than 4 MiB of them", COMPONENTS_MAX);
  part.name = path;
  good = good && append_file(scene, all, text, part) && read_file_tree(scene, tree);
  dvi__heap_free(text);
  return good;
}

/* ---- keys ---- */

/* Return true if a bracket follows, so that a name is that of a function. */
static bool is_called(const dvi__source *source, size_t at, size_t end)
{
  while (at < end && dvi__is_blank(source->text[at])) at++;
  return at < end && source->text[at] == '(';
}

/* Give a key's text with the prefix of its file in front of all names, and without blanks. */
static bool key_text(dvi_scene *scene, const dvi__tree *key, const char **text)
{
  const dvi__source *source = &scene->source;
  const size_t end = key->span.first + key->span.size;
  const char *written = "";
  dvi__token token = {.span = {key->span.first, 0}};
  for (int before = 0;; before = token.kind) {
    if (!dvi__token_read(source, token.span.first + token.span.size, end, scene->complaint, &token))
      return false;
    if (token.kind == DVI__TOKEN_END) break;
    const char *word = dvi__arena_text(&scene->arena, source->text + token.span.first,
                                       token.span.size);
    if (word != NULL && token.kind == DVI__TOKEN_NAME && before != '.' &&
        !is_called(source, token.span.first + token.span.size, end))
      word = dvi__prefixed_name(source, &scene->arena, token.span.first, word);
    char *longer = word == NULL
                       ? NULL
                       : dvi__arena_take(&scene->arena, strlen(written) + strlen(word) + 1, 1);
    if (longer == NULL) return dvi__scene_no_memory(scene);
    (void)sprintf(longer, "%s%s", written, word);
    written = longer;
  }
  *text = written;
  return true;
}

/* Return true for slow and fast, which hold potentials by name. */
static bool is_group(const dvi__tree *key, const dvi__tree *child)
{
  return child->kind == DVI__MAPPING &&
         (strcmp(key->text, "slow") == 0 || strcmp(key->text, "fast") == 0);
}

static bool rename_keys(dvi_scene *scene, const dvi__tree *mapping, bool has_groups)
{
  for (int i = 0; i < mapping->count; i++) {
    const bool group = has_groups && is_group(mapping->key[i], mapping->child[i]);
    if (group ? !rename_keys(scene, mapping->child[i], false)
              : !key_text(scene, mapping->key[i], &mapping->key[i]->text))
      return false;
  }
  return true;
}

/* Rename the keys of all sections of one file. Refuses sections that no component has. */
static bool rename_sections(dvi_scene *scene, const dvi__tree *tree)
{
  for (int i = 0; i < tree->count; i++) {
    const dvi__tree *key = tree->key[i], *section = tree->child[i];
    const int row = row_of(key->text);
    if (row < 0)
      return dvi__scene_refuse(
          scene, key->span,
          "a component has no '%s'; it stands in the scene that includes the component", key->text);
    if (takings[row].taking == LEFT_OUT || takings[row].taking == ADDED) continue;
    if (!dvi__want_mapping(scene, section, key->text) ||
        !rename_keys(scene, section, strcmp(key->text, "potentials") == 0))
      return false;
  }
  return true;
}

/* ---- merging ---- */

static bool append_entry(dvi_scene *scene, dvi__tree *mapping, dvi__tree *key, dvi__tree *child)
{
  const size_t count = (size_t)mapping->count;
  dvi__tree **keys = dvi__arena_grow(&scene->arena, (void *)mapping->key, count, sizeof *keys);
  dvi__tree **children = dvi__arena_grow(&scene->arena, (void *)mapping->child, count,
                                         sizeof *children);
  if (keys == NULL || children == NULL) return dvi__scene_no_memory(scene);
  keys[count] = key;
  children[count] = child;
  mapping->key = keys;
  mapping->child = children;
  mapping->count++;
  return true;
}

/* Append all entries of a section. Groups of potentials are one group. */
static bool append_entries(dvi_scene *scene, dvi__tree *into, const dvi__tree *from)
{
  for (int i = 0; i < from->count; i++) {
    dvi__tree *key = from->key[i], *child = from->child[i];
    dvi__tree *group = is_group(key, child) ? (dvi__tree *)dvi__tree_find(into, key->text) : NULL;
    if (group != NULL && group->kind == DVI__MAPPING ? !append_entries(scene, group, child)
                                                     : !append_entry(scene, into, key, child))
      return false;
  }
  return true;
}

/* An entry of a mapping, to be sorted. */
typedef struct entry {
  const dvi__tree *key;
  int at;
} entry;

static int compare_entries(const void *a, const void *b)
{
  const entry *left = a, *right = b;
  const int order = strcmp(left->key->text, right->key->text);
  return order != 0 ? order : left->at < right->at ? -1 : 1;
}

/* Drop the entries that have been replaced, which have no child. */
static void drop_replaced(dvi__tree *mapping)
{
  dvi__tree **key = (void *)mapping->key, **child = (void *)mapping->child;
  int kept = 0;
  for (int i = 0; i < mapping->count; i++) {
    if (child[i] == NULL) continue;
    key[kept] = key[i];
    child[kept++] = child[i];
  }
  mapping->count = kept;
}

/* Let the first of entries with one name replace the others, or refuse these. */
static bool resolve_names(dvi_scene *scene, dvi__tree *mapping, taking how)
{
  const int count = mapping->count;
  entry *sorted = dvi__arena_take(&scene->arena, (size_t)count + 1, sizeof *sorted);
  if (sorted == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < count; i++) sorted[i] = (entry){mapping->key[i], i};
  qsort(sorted, (size_t)count, sizeof *sorted, compare_entries);
  for (int k = 1; k < count; k++) {
    const dvi__tree *first = sorted[k - 1].key, *second = sorted[k].key;
    if (strcmp(first->text, second->text) != 0) continue;
    if (how == NAMED)
      return dvi__scene_refuse(scene, second->span, "the name '%s' stands in '%s' already",
                               second->text, dvi__source_name(&scene->source, first->span.first));
    ((dvi__tree **)(void *)mapping->child)[sorted[k].at] = NULL;
  }
  drop_replaced(mapping);
  for (int i = 0; i < mapping->count; i++)
    if (is_group(mapping->key[i], mapping->child[i]) &&
        !resolve_names(scene, mapping->child[i], how))
      return false;
  return true;
}

static bool resolve_all(dvi_scene *scene, const dvi__tree *tree)
{
  for (int i = 0; i < tree->count; i++) {
    const int row = row_of(tree->key[i]->text);
    const taking how = row >= 0 ? takings[row].taking : LEFT_OUT;
    if ((how == INHERITED || how == NAMED) && !resolve_names(scene, tree->child[i], how))
      return false;
  }
  return true;
}

/* Make a section a sum, and add an expression to it. */
static bool add_expression(dvi_scene *scene, dvi__tree *into, dvi__tree *expression)
{
  if (into->kind != DVI__SUM) {
    dvi__tree *first = dvi__arena_take(&scene->arena, 1, sizeof *first);
    if (first == NULL) return dvi__scene_no_memory(scene);
    *first = *into;
    *into = (dvi__tree){.kind = DVI__SUM, .span = first->span, .text = first->text};
    if (!append_entry(scene, into, NULL, first)) return false;
  }
  if (expression->kind != DVI__SUM) return append_entry(scene, into, NULL, expression);
  for (int i = 0; i < expression->count; i++)
    if (!append_entry(scene, into, NULL, expression->child[i])) return false;
  return true;
}

/* Merge the sections of a tree that are inherited, or all others. */
static bool merge(dvi_scene *scene, dvi__tree *into, const dvi__tree *from, bool inherited,
                  bool of_component)
{
  for (int i = 0; i < from->count; i++) {
    dvi__tree *section = from->child[i];
    const char *name = from->key[i]->text;
    const int row = row_of(name);
    const taking how = row >= 0 ? takings[row].taking : LEFT_OUT;
    if ((how == INHERITED) != inherited || strcmp(name, "include") == 0) continue;
    if (how == LEFT_OUT && of_component) continue;
    dvi__tree *there = (dvi__tree *)dvi__tree_find(into, name);
    if (there == NULL) {
      if (!append_entry(scene, into, from->key[i], section)) return false;
    } else if (how == ADDED ? !add_expression(scene, there, section)
                            : !append_entries(scene, there, section)) {
      return false;
    }
  }
  return true;
}

/* ---- components ---- */

static bool include_all(dvi_scene *scene, joined *all, const dvi__tree **tree, const char *prefix,
                        int depth);

/* Read one component with those that it includes. */
static bool read_component(dvi_scene *scene, joined *all, const dvi__tree *key,
                           const dvi__tree *file, const char *outer, int depth,
                           const dvi__tree **tree)
{
  const size_t size = strlen(outer) + strlen(key->text) + 2;
  char *prefix = dvi__arena_take(&scene->arena, size, 1);
  if (prefix == NULL) return dvi__scene_no_memory(scene);
  (void)snprintf(prefix, size, "%s%s_", outer, key->text);
  if (!dvi__want_name(scene, key->text, key->span) ||
      !dvi__want_text(scene, file, "the file of a component"))
    return false;
  if (depth > DEPTH_MAX)
    return dvi__complain(scene->complaint, DVI_BAD_SIZE, file->span,
                         "more than %d levels of components; does one include itself?", DEPTH_MAX);
  return open_component(scene, all, file, prefix, tree) && dvi__check_section_names(scene, *tree) &&
         rename_sections(scene, *tree) && include_all(scene, all, tree, prefix, depth);
}

/* Merge a tree with its components. Parameters and starts of the tree come first, and replace those
 * of the components. All else of the components comes first, so that the tree may name it. */
static bool include_all(dvi_scene *scene, joined *all, const dvi__tree **tree, const char *prefix,
                        int depth)
{
  const dvi__tree *section = dvi__tree_find(*tree, "include");
  if (section == NULL) return true;
  dvi__tree *merged = dvi__arena_take(&scene->arena, 1, sizeof *merged);
  if (merged == NULL) return dvi__scene_no_memory(scene);
  if (!dvi__want_mapping(scene, section, "include")) return false;
  *merged = (dvi__tree){.kind = DVI__MAPPING, .span = (*tree)->span};
  bool good = merge(scene, merged, *tree, true, false);
  for (int i = 0; i < section->count && good; i++) {
    static const dvi__tree empty = {.kind = DVI__MAPPING};
    const dvi__tree *component = &empty;
    good = read_component(scene, all, section->key[i], section->child[i], prefix, depth + 1,
                          &component) &&
           merge(scene, merged, component, true, true) &&
           merge(scene, merged, component, false, true);
  }
  good = good && merge(scene, merged, *tree, false, false) && resolve_all(scene, merged);
  *tree = merged;
  return good;
}

/* Check the sections of the scene itself that are merged. */
static bool check_sections(dvi_scene *scene)
{
  for (int i = 0; i < scene->tree->count; i++) {
    const dvi__tree *key = scene->tree->key[i];
    const int row = row_of(key->text);
    if (row >= 0 && takings[row].taking != LEFT_OUT && takings[row].taking != ADDED &&
        !dvi__want_mapping(scene, scene->tree->child[i], key->text))
      return false;
  }
  return true;
}

bool dvi__read_include(dvi_scene *scene, const dvi__tree *section)
{
  joined all = {0};
  const dvi__source whole = scene->source;
  (void)section;
  scene->source.size = 0;
  const dvi__source_part own = {
      .name = whole.name, .size = whole.size, .prefix = "", .keeps = dvi__is_word};
  return append_file(scene, &all, whole.text, own) && check_sections(scene) &&
         include_all(scene, &all, &scene->tree, "", 0);
}
