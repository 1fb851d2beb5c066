#include "scene/sections/sections.h"

#include <dvi/number.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "scene/elaborate/shape.h"
#include "scene/elaborate/hints.h"
#include "scene/elaborate/words.h"

/* ---- what readers share ---- */

bool(dvi__scene_refuse)(dvi_scene *scene, dvi__span span, const char *format, ...)
{
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  (void)dvi_number_vprint(text, sizeof text, format, arguments);
  va_end(arguments);
  return dvi__complain(scene->complaint, DVI_BAD_FILE, span, "%s", text);
}

bool(dvi__scene_no_memory)(dvi_scene *scene)
{
  return dvi__complain_of_memory(scene->complaint);
}

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

bool dvi__want_keys(dvi_scene *scene, const dvi__tree *mapping, const char *what, int count,
                    const char *const *known)
{
  char hint[96];
  for (int i = 0; i < mapping->count; i++) {
    int k = 0;
    while (k < count && strcmp(known[k], mapping->key[i]->text) != 0) k++;
    if (k == count)
      return dvi__scene_refuse(
          scene, mapping->key[i]->span, "%s has no '%s'%s", what, mapping->key[i]->text,
          dvi__nearest(mapping->key[i]->text, count, known, hint, sizeof hint));
  }
  return true;
}

/* A list in block style, or with comments in it: item by item. */
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

/* Whether a list can be read as an expression as it stands: commas inside of parentheses are then
 * no ends of items. */
static bool stands_as_expression(const dvi_scene *scene, const dvi__tree *tree)
{
  const char *text = scene->source.text + tree->span.first;
  return tree->span.size > 0 && text[0] == '[' && memchr(text, '#', tree->span.size) == NULL;
}

bool dvi__tree_expression(dvi_scene *scene, const dvi__tree *tree, const dvi__expression **e)
{
  if (tree->kind == DVI__MAPPING)
    return dvi__scene_refuse(scene, tree->span, "an expression belongs here");
  if (tree->kind == DVI__SEQUENCE && !stands_as_expression(scene, tree))
    return list_expression(scene, tree, e);
  return dvi__expression_parse(&scene->source, tree->span, &scene->arena, scene->complaint, e);
}

bool dvi__tree_number(dvi_scene *scene, const dvi__tree *tree, const char *what, double *number)
{
  const dvi__expression *e;
  dvi__context c;
  dvi__node node;
  if (!dvi__tree_expression(scene, tree, &e) || !dvi__context_make(&c, scene, 0, what))
    return false;
  const bool good = dvi__elaborate_number(&c, e, &node) &&
                    dvi__constants_of(&c, e, dvi__number_value(node), number);
  dvi__context_free(&c);
  return good;
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

/* ---- the plan ---- */

static bool read_text(dvi_scene *scene, const char *section, const char **text)
{
  const dvi__tree *tree = dvi__tree_find(scene->tree, section);
  if (tree == NULL) return true;
  *text = tree->text;
  return dvi__want_text(scene, tree, section);
}

static bool read_method(dvi_scene *scene, const char **method)
{
  const dvi__tree *tree = dvi__tree_find(scene->tree, "method");
  return read_text(scene, "method", method) &&
         (tree == NULL || dvi__scene_place_file(scene, tree->span, method));
}

static bool read_number(dvi_scene *scene, const char *section, double *number)
{
  const dvi__tree *tree = dvi__tree_find(scene->tree, section);
  if (!dvi__tree_number(scene, tree, section, number)) return false;
  return *number > 0 || dvi__scene_refuse(scene, tree->span, "%s must be positive, and is %.17g",
                                          section, *number);
}

/* With more steps than a double can count the time would stand still. */
static bool few_steps(dvi_scene *scene)
{
  static const double steps_max = 9007199254740992.0; /* 2^53 */
  const double steps = scene->plan.t_end / scene->plan.h;
  return steps <= steps_max ||
         dvi__complain(scene->complaint, DVI_BAD_SIZE, dvi__tree_find(scene->tree, "step")->span,
                       "a run of %.3g steps; at most %.16g (2^53) are possible", steps, steps_max);
}

static bool read_plan(dvi_scene *scene)
{
  dvi_scene_plan *plan = &scene->plan;
  return read_text(scene, "title", &plan->title) && read_method(scene, &plan->method) &&
         read_number(scene, "step", &plan->h) && read_number(scene, "until", &plan->t_end) &&
         few_steps(scene);
}

/* Each is sought among all that there are. */
enum { COLUMNS_MAX = 1000 };

/* All that dvi run may show of the scene, if `known` is not NULL; how many they are. The last of
 * them some methods alone have. */
static int list_columns(const dvi_scene *scene, const char **known)
{
  static const char *const others[] = {"t", "energy", "constraint", "distance", "h", "jump"};
  enum { OTHERS = sizeof others / sizeof *others };
  const char *(*const label[])(const dvi_scene *, int) = {dvi_scene_coordinate, dvi_scene_velocity,
                                                          dvi_scene_momentum};
  const char *name;
  int count = 0;
  for (int k = 0; k < 3; k++)
    for (int i = 0; (k != 1 || scene->terms.factors != NULL) && (name = label[k](scene, i)) != NULL;
         i++, count++)
      if (known != NULL) known[count] = name;
  for (int i = 0; i < scene->terms.symmetry_count; i++, count++)
    if (known != NULL) known[count] = scene->terms.symmetries[i].name;
  for (int i = 0; i < scene->terms.invariant_count; i++, count++)
    if (known != NULL) known[count] = scene->terms.invariants[i].name;
  for (int i = 0; i < OTHERS; i++, count++)
    if (known != NULL) known[count] = others[i];
  return count;
}

static bool all_columns(dvi_scene *scene, const dvi__tree *columns)
{
  char hint[96];
  if (dvi_scene_coordinate(scene, 0) == NULL || dvi_scene_velocity(scene, 0) == NULL ||
      dvi_scene_momentum(scene, 0) == NULL)
    return dvi__scene_no_memory(scene);
  const int count = list_columns(scene, NULL);
  const char **known = dvi__arena_take(&scene->arena, (size_t)count, sizeof *known);
  if (known == NULL) return dvi__scene_no_memory(scene);
  (void)list_columns(scene, known);
  for (int i = 0; i < columns->count; i++) {
    const char *name = columns->child[i]->text;
    int k = 0;
    while (k < count && strcmp(known[k], name) != 0) k++;
    if (k == count)
      return dvi__scene_refuse(scene, columns->child[i]->span, "there is no column '%s'%s", name,
                               dvi__nearest(name, count, known, hint, sizeof hint));
    for (k = 0; k < i; k++)
      if (strcmp(columns->child[k]->text, name) == 0)
        return dvi__scene_refuse(scene, columns->child[i]->span, "column '%s' stands here twice",
                                 name);
  }
  return true;
}

static bool read_columns(dvi_scene *scene, const dvi__tree *columns)
{
  const char **column = dvi__arena_take(&scene->arena, (size_t)columns->count + 1, sizeof *column);
  if (column == NULL) return dvi__scene_no_memory(scene);
  if (columns->kind != DVI__SEQUENCE)
    return dvi__scene_refuse(scene, columns->span, "columns is a list of names, as in [x, y]");
  if (columns->count > COLUMNS_MAX)
    return dvi__scene_refuse(scene, columns->span,
                             "at most %d columns; without a list all are shown", (int)COLUMNS_MAX);
  for (int i = 0; i < columns->count; i++) {
    if (!dvi__want_text(scene, columns->child[i], "the name of a column")) return false;
    column[i] = columns->child[i]->text;
  }
  scene->plan.column = column;
  scene->plan.column_count = columns->count;
  return all_columns(scene, columns);
}

bool dvi__read_report(dvi_scene *scene, const dvi__tree *section)
{
  static const char *const known[] = {"every", "columns"};
  int every = 0;
  if (!dvi__want_mapping(scene, section, "report") ||
      !dvi__want_keys(scene, section, "report", 2, known))
    return false;
  const dvi__tree *often = dvi__tree_find(section, "every"),
                  *columns = dvi__tree_find(section, "columns");
  if (often != NULL && !dvi__tree_whole(scene, often, "every", 1, &every)) return false;
  scene->plan.every = every;
  return columns == NULL || read_columns(scene, columns);
}

/* ---- sweeps ---- */

static bool read_values(dvi_scene *scene, const dvi__tree *list, dvi_scene_range *range)
{
  double *value = dvi__arena_take(&scene->arena, (size_t)list->count + 1, sizeof *value);
  if (value == NULL) return dvi__scene_no_memory(scene);
  if (list->count == 0)
    return dvi__scene_refuse(scene, list->span, "there is no value to sweep over");
  for (int i = 0; i < list->count; i++)
    if (!dvi__tree_number(scene, list->child[i], "a value", &value[i])) return false;
  range->count = list->count;
  range->value = value;
  return true;
}

/* from, to and count: values in even steps, both ends included. */
static bool read_steps(dvi_scene *scene, const dvi__tree *steps, dvi_scene_range *range)
{
  static const char *const known[] = {"from", "to", "count"};
  enum { COUNT_MAX = 1000000 };
  double end[2];
  int count = 0;
  if (!dvi__want_keys(scene, steps, "a range", 3, known)) return false;
  for (int k = 0; k < 3; k++)
    if (dvi__tree_find(steps, known[k]) == NULL)
      return dvi__scene_refuse(scene, steps->span, "a range needs '%s'", known[k]);
  const dvi__tree *how_many = dvi__tree_find(steps, "count");
  if (!dvi__tree_number(scene, dvi__tree_find(steps, "from"), "from", &end[0]) ||
      !dvi__tree_number(scene, dvi__tree_find(steps, "to"), "to", &end[1]) ||
      !dvi__tree_whole(scene, how_many, "count", 2, &count))
    return false;
  if (count > COUNT_MAX)
    return dvi__scene_refuse(scene, how_many->span, "at most %d values", COUNT_MAX);
  if (!isfinite((end[1] - end[0]) * count))
    return dvi__scene_refuse(scene, steps->span, "the range from %g to %g is too wide", end[0],
                             end[1]);
  double *value = dvi__arena_take(&scene->arena, (size_t)count, sizeof *value);
  if (value == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < count; i++) value[i] = end[0] + (end[1] - end[0]) * i / (count - 1);
  value[count - 1] = end[1];
  range->count = count;
  range->value = value;
  return true;
}

static bool read_range(dvi_scene *scene, const dvi__tree *key, const dvi__tree *values,
                       dvi_scene_range *range)
{
  const dvi__name *name = dvi__names_find(&scene->names, key->text);
  if (name == NULL && !dvi__is_word(key->text))
    return dvi__names_unknown(&scene->names, &scene->arena, scene->complaint, key->text, key->span);
  if (name == NULL || name->sort != DVI__PARAMETER || !scene->parameter[name->number].settable)
    return dvi__scene_refuse(scene, key->span, "'%s' is no parameter that is a number", key->text);
  range->name = key->text;
  if (values->kind == DVI__SEQUENCE) return read_values(scene, values, range);
  if (values->kind == DVI__MAPPING) return read_steps(scene, values, range);
  return dvi__scene_refuse(scene, values->span,
                           "a list of values belongs here, or {from: .., to: .., count: ..}");
}

bool dvi__read_sweep(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "sweep")) return false;
  scene->range = dvi__arena_take(&scene->arena, (size_t)section->count + 1, sizeof *scene->range);
  if (scene->range == NULL) return dvi__scene_no_memory(scene);
  scene->range_count = section->count;
  for (int i = 0; i < section->count; i++)
    if (!read_range(scene, section->key[i], section->child[i], &scene->range[i])) return false;
  return true;
}

/* ---- the order of reading ---- */

/* All sections: in the order in which they are read, which is not that of the file. Without a
 * reader they are read with another one. */
typedef struct section {
  const char *name;
  bool (*read)(dvi_scene *scene, const dvi__tree *section);
  const char *needed; /* an example of what a scene cannot do without */
  const char *refusal;
} section;

static const section sections[] = {
    {.name = "forces", .refusal = "no method here takes forces without a potential"},
    {.name = "title"},
    {.name = "method"},
    {.name = "parameters"},
    {.name = "step", .needed = "step: 0.01"},
    {.name = "until", .needed = "until: 10"},
    {.name = "coordinates", .read = dvi__read_coordinates, .needed = "coordinates: {x: scalar}"},
    {.name = "definitions", .read = dvi__read_definitions},
    {.name = "lagrangian", .read = dvi__read_lagrangian},
    {.name = "kinetic", .read = dvi__read_kinetic},
    {.name = "potentials"},
    {.name = "one_form", .read = dvi__read_one_form},
    {.name = "hamiltonian", .read = dvi__read_hamiltonian},
    {.name = "constraints", .read = dvi__read_constraints},
    {.name = "symmetries", .read = dvi__read_symmetries},
    {.name = "invariants", .read = dvi__read_invariants},
    {.name = "events", .read = dvi__read_events},
    {.name = "initial", .read = dvi__read_initial, .needed = "initial: {x: 1, x': 0}"},
    {.name = "report", .read = dvi__read_report},
    {.name = "sweep", .read = dvi__read_sweep},
};

enum { SECTIONS = sizeof sections / sizeof *sections };

/* A section that is called otherwise elsewhere; the keys below sections have no such names. */
static bool refuse_slips(dvi_scene *scene)
{
  for (int i = 0; i < scene->tree->count; i++) {
    const dvi__tree *key = scene->tree->key[i];
    const char *here = dvi__section_elsewhere(key->text);
    if (here != NULL)
      return dvi__scene_refuse(scene, key->span, "a scene has no '%s'; the section is %s",
                               key->text, here);
  }
  return true;
}

/* What is no mapping, or a mapping of several keys of which none is known, was meant for
 * something else. */
static bool is_scene(dvi_scene *scene, const char *const *known)
{
  const dvi__tree *tree = scene->tree;
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

static bool all_known(dvi_scene *scene)
{
  const char *known[SECTIONS];
  for (int k = 0; k < SECTIONS; k++) known[k] = sections[k].name;
  if (!is_scene(scene, known) || !refuse_slips(scene) ||
      !dvi__want_keys(scene, scene->tree, "a scene", SECTIONS, known))
    return false;
  for (int k = 0; k < SECTIONS; k++) {
    const dvi__tree *found = dvi__tree_find(scene->tree, sections[k].name);
    if (found != NULL && sections[k].refusal != NULL)
      return dvi__scene_refuse(scene, found->span, "%s", sections[k].refusal);
    if (found == NULL && sections[k].needed != NULL)
      return dvi__scene_refuse(scene, DVI__NOWHERE, "the section '%s' is missing, as in '%s'",
                               sections[k].name, sections[k].needed);
  }
  return true;
}

static const char *const ways_to_move[] = {"lagrangian", "kinetic", "one_form", "constraints",
                                           "hamiltonian"};

/* The last one stands with the two before it, too. */
enum { WAYS = sizeof ways_to_move / sizeof *ways_to_move, HAMILTONIAN = WAYS - 1 };

const dvi__tree *dvi__what_moves(const dvi_scene *scene)
{
  const dvi__tree *found = NULL;
  for (int k = 0; k < WAYS && found == NULL; k++)
    found = dvi__tree_find(scene->tree, ways_to_move[k]);
  return found;
}

/* A scene says what it is in one of these ways. */
static bool one_form_of_system(dvi_scene *scene)
{
  static const char *const ways = "one of these: lagrangian; kinetic and potentials; one_form and "
                                  "hamiltonian; hamiltonian, alone or with constraints";
  const dvi__tree *found = NULL;
  int count = 0, which = HAMILTONIAN;
  for (int k = 0; k < HAMILTONIAN; k++) {
    const dvi__tree *tree = dvi__tree_find(scene->tree, ways_to_move[k]);
    if (tree == NULL) continue;
    found = tree;
    which = k;
    count++;
  }
  const dvi__tree *H = dvi__tree_find(scene->tree, "hamiltonian"),
                  *V = dvi__tree_find(scene->tree, "potentials");
  if (count == 0 && H == NULL)
    return dvi__scene_refuse(scene, DVI__NOWHERE, "what moves it is missing: %s", ways);
  if (count > 1) return dvi__scene_refuse(scene, found->span, "there must be %s", ways);
  if ((H != NULL) != (which >= 2))
    return dvi__scene_refuse(scene, (H != NULL ? H : found)->span,
                             H != NULL ? "beside %s there is no hamiltonian"
                                       : "%s needs a hamiltonian",
                             ways_to_move[which]);
  return V == NULL || which == 1 ||
         dvi__scene_refuse(scene, V->span, "potentials stand beside kinetic, not beside %s",
                           ways_to_move[which]);
}

bool dvi__scene_read_tree(dvi_scene *scene, dvi__scene_settings *settings)
{
  if (!all_known(scene) || !one_form_of_system(scene)) return false;
  scene->reads = DVI__IN_PARAMETERS;
  if (!dvi__read_parameters(scene, dvi__tree_find(scene->tree, "parameters"), settings))
    return false;
  scene->reads = DVI__ELSEWHERE;
  if (!read_plan(scene)) return false;
  for (int k = 0; k < SECTIONS; k++) {
    const dvi__tree *found = dvi__tree_find(scene->tree, sections[k].name);
    scene->reads = sections[k].read == dvi__read_initial ? DVI__IN_START : DVI__ELSEWHERE;
    if (found != NULL && sections[k].read != NULL && !sections[k].read(scene, found)) return false;
  }
  return dvi__read_uses(scene, settings);
}
