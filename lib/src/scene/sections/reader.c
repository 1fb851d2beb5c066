/* Functions shared by the readers of sections. */
#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "scene/elaborate/shape.h"
#include "scene/sections/sections.h"

bool dvi__want_mapping(dvi_scene *scene, const dvi__tree *tree, const char *what)
{
  return tree->kind == DVI__MAPPING ||
         dvi__scene_refuse(scene, tree->span, "%s is a mapping, as in 'name: value'", what);
}

bool dvi__want_text(dvi_scene *scene, const dvi__tree *tree, const char *what)
{
  return tree->kind == DVI__SCALAR || dvi__scene_refuse(scene, tree->span, "%s is one line", what);
}

bool dvi__want_name(dvi_scene *scene, const char *text, dvi__span span)
{
  return dvi__is_identifier(text) ||
         dvi__scene_refuse(scene, span, "'%s' is no name: letters, digits and _, a letter first",
                           text);
}

/* Tell if a key is the rest of a text that YAML has cut at a comma, as of {a: f(x,y)}. */
static bool is_rest(const char *key)
{
  const char *close = strpbrk(key, ")]");
  return close != NULL && (strpbrk(key, "([") == NULL || strpbrk(key, "([") > close);
}

bool dvi__want_keys(dvi_scene *scene, const dvi__tree *mapping, const char *what, int count,
                    const char *const *known)
{
  char hint[256];
  for (int i = 0; i < mapping->count; i++) {
    int k = 0;
    while (k < count && strcmp(known[k], mapping->key[i]->text) != 0) k++;
    if (k == count)
      return dvi__scene_refuse(
          scene, mapping->key[i]->span, "%s has no '%s'%s", what, mapping->key[i]->text,
          is_rest(mapping->key[i]->text)
              ? "; within {..} or [..] a text with commas needs quotes"
              : dvi__nearest_or_all(mapping->key[i]->text, count, known, hint, sizeof hint));
  }
  return true;
}

/* Read a list in block style, or with comments in it, item by item. */
static bool list_expression(dvi_scene *scene, const dvi__tree *tree, const dvi__expression **e)
{
  const dvi__expression **part = dvi__arena_take(&scene->arena, (size_t)tree->count + 1,
                                                 sizeof(*part));
  dvi__expression *list = dvi__arena_take(&scene->arena, 1, sizeof *list);
  if (part == NULL || list == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < tree->count; i++)
    if (!dvi__tree_expression(scene, tree->child[i], &part[i])) return false;
  *list = (dvi__expression){.form = DVI__FORM_LIST,
                            .span = tree->span,
                            .count = tree->count,
                            .part = (dvi__expression *const *)part};
  *e = list;
  return true;
}

/* Return true if a list can be read as an expression as it stands. Commas inside of parentheses
 * then do not end items. */
static bool is_expression_as_it_stands(const dvi_scene *scene, const dvi__tree *tree)
{
  const char *text = scene->source.text + tree->span.first;
  return tree->span.size > 0 && text[0] == '[' && memchr(text, '#', tree->span.size) == NULL;
}

/* Read the sum of the expressions that several files hold, as a chain that is nested to the
 * left. */
static bool sum_expression(dvi_scene *scene, const dvi__tree *tree, const dvi__expression **e)
{
  if (!dvi__tree_expression(scene, tree->child[0], e)) return false;
  for (int i = 1; i < tree->count; i++) {
    const dvi__expression **part = dvi__arena_take(&scene->arena, 2, sizeof(*part));
    dvi__expression *sum = dvi__arena_take(&scene->arena, 1, sizeof *sum);
    if (part == NULL || sum == NULL) return dvi__scene_no_memory(scene);
    part[0] = *e;
    if (!dvi__tree_expression(scene, tree->child[i], &part[1])) return false;
    *sum = (dvi__expression){.form = DVI__FORM_ADD,
                             .span = part[1]->span,
                             .count = 2,
                             .part = (dvi__expression *const *)part};
    *e = sum;
  }
  return true;
}

bool dvi__tree_expression(dvi_scene *scene, const dvi__tree *tree, const dvi__expression **e)
{
  if (tree->kind == DVI__MAPPING)
    return dvi__scene_refuse(scene, tree->span, "an expression belongs here");
  if (tree->kind == DVI__SUM) return sum_expression(scene, tree, e);
  if (tree->kind == DVI__SEQUENCE && !is_expression_as_it_stands(scene, tree))
    return list_expression(scene, tree, e);
  return dvi__expression_parse(&scene->source, tree->span, &scene->arena, scene->complaint, e);
}

const char *dvi__word_of(const dvi_scene *scene, const dvi__expression *e)
{
  const dvi__source_part *part = dvi__source_part_at(&scene->source, e->span.first);
  const size_t size = part != NULL && e->form == DVI__FORM_NAME ? strlen(part->prefix) : 0;
  return size > 0 && strncmp(e->name, part->prefix, size) == 0 ? e->name + size : e->name;
}

static bool read_number(dvi_scene *scene, const dvi__expression *e, const char *what,
                        double *number)
{
  dvi__context c;
  dvi__node node;
  if (!dvi__context_make(&c, scene, 0, what)) return false;
  const bool good = dvi__elaborate_number(&c, e, &node) &&
                    dvi__constants_of(&c, e, dvi__number_value(node), number);
  dvi__context_free(&c);
  return good;
}

bool dvi__tree_number(dvi_scene *scene, const dvi__tree *tree, const char *what, double *number)
{
  const dvi__expression *e = NULL;
  return dvi__tree_expression(scene, tree, &e) && read_number(scene, e, what, number);
}

bool dvi__tree_whole(dvi_scene *scene, const dvi__tree *tree, const char *what, int least,
                     int *number)
{
  double x;
  if (!dvi__tree_number(scene, tree, what, &x)) return false;
  if (!(x >= least && x <= INT_MAX) || (double)(int)x < x)
    return dvi__scene_refuse(scene, tree->span, "%s is a whole number from %d to %d, not %.17g",
                             what, least, INT_MAX, x);
  *number = (int)x;
  return true;
}

bool dvi__point_read(dvi_scene *scene, const dvi__tree *tree, int count, const char *what,
                     double *point)
{
  const dvi__expression *e = NULL;
  if (!dvi__tree_expression(scene, tree, &e) || e == NULL) return false;
  const bool is_list = e->form == DVI__FORM_LIST;
  if ((is_list ? e->count : 1) != count)
    return dvi__scene_refuse(scene, tree->span, "%s has %d coordinate%s here, not %d", what, count,
                             count == 1 ? "" : "s", is_list ? e->count : 1);
  for (int l = 0; l < count; l++)
    if (!read_number(scene, is_list ? e->part[l] : e, "a coordinate", point + l)) return false;
  return true;
}

bool dvi__tree_word(dvi_scene *scene, const dvi__tree *tree, const char *what, int count,
                    const char *const *word, int *which)
{
  if (!dvi__want_text(scene, tree, what)) return false;
  for (*which = 0; *which < count; ++*which)
    if (strcmp(tree->text, word[*which]) == 0) return true;
  char list[128], hint[64];
  (void)dvi__list_words(count, word, " or ", list, sizeof list);
  return dvi__scene_refuse(scene, tree->span, "%s is %s%s", what, list,
                           dvi__nearest(tree->text, count, word, hint, sizeof hint));
}
