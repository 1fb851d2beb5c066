/* The section report. */
#include <string.h>

#include "scene/sections/sections.h"

/* Limit the columns, since each is searched for among all that there are. */
enum { COLUMNS_MAX = 1000 };

/* List all columns that dvi run may show of the scene, if `known` is not NULL. Returns how many
 * they are. Only some methods have the last of them. */
static int list_columns(const dvi_scene *scene, const char **known)
{
  static const char *const others[] = {
      "t", "energy", "energy_balance", "constraint", "distance", "gap", "temperature", "h", "jump"};
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

/* Return true for the balance of a symmetry's momentum, where forces act. */
static bool is_balance(const dvi_scene *scene, const char *text)
{
  static const char suffix[] = "_balance";
  const size_t length = strlen(text), end = sizeof suffix - 1;
  if (length <= end || strcmp(text + length - end, suffix) != 0) return false;
  const bool acts = scene->terms.force_count > 0 || scene->terms.damping > 0;
  for (int i = 0; i < scene->terms.symmetry_count && acts; i++)
    if (strlen(scene->terms.symmetries[i].name) == length - end &&
        strncmp(text, scene->terms.symmetries[i].name, length - end) == 0)
      return true;
  return false;
}

/* Return true for lambda_NAME of a constraint, or lambda_NAME_k of row k of a joint. */
static bool is_multiplier(const dvi_scene *scene, const char *text)
{
  static const char prefix[] = "lambda_";
  if (strncmp(text, prefix, sizeof prefix - 1) != 0) return false;
  text += sizeof prefix - 1;
  const dvi__tree *constraints = dvi__tree_find(scene->tree, "constraints");
  if (scene->terms.holonomic_count > 0 && constraints != NULL &&
      dvi__tree_find(constraints, text) != NULL)
    return true;
  const dvi__tree *nonholonomic = dvi__tree_find(scene->tree, "nonholonomic");
  if (nonholonomic != NULL && dvi__tree_find(nonholonomic, text) != NULL) return true;
  for (int k = 0; k < scene->joint_count; k++) {
    const size_t length = strlen(scene->joint[k].name);
    if (strncmp(text, scene->joint[k].name, length) != 0) continue;
    const char *rest = text + length;
    if (*rest == '\0' || (rest[0] == '_' && rest[1] >= '1' && rest[1] <= '6' && rest[2] == '\0'))
      return true;
  }
  return false;
}

/* Return true for force_NAME of a contact that may be held. */
static bool is_force(const dvi_scene *scene, const char *text)
{
  static const char prefix[] = "force_";
  if (strncmp(text, prefix, sizeof prefix - 1) != 0) return false;
  for (int k = 0; k < scene->terms.contact_count; k++)
    if (strcmp(text + sizeof prefix - 1, scene->contacts[k].name) == 0)
      return scene->contacts[k].hold;
  return false;
}

static bool all_columns(dvi_scene *scene, const dvi__tree *columns)
{
  char hint[256];
  const bool is_field = scene->field != NULL;
  if (!is_field && (dvi_scene_coordinate(scene, 0) == NULL ||
                    dvi_scene_velocity(scene, 0) == NULL || dvi_scene_momentum(scene, 0) == NULL))
    return dvi__scene_no_memory(scene);
  int (*const list)(const dvi_scene *, const char **) = is_field ? dvi__list_field_columns
                                                                 : list_columns;
  const int count = list(scene, NULL);
  const char **known = dvi__arena_take(&scene->arena, (size_t)count, sizeof *known);
  if (known == NULL) return dvi__scene_no_memory(scene);
  (void)list(scene, known);
  for (int i = 0; i < columns->count; i++) {
    const char *name = columns->child[i]->text;
    int k = 0;
    while (k < count && strcmp(known[k], name) != 0) k++;
    if (k == count && !is_balance(scene, name) && !is_multiplier(scene, name) &&
        !is_force(scene, name) && !(is_field && dvi__is_mechanical_column(scene, name)) &&
        !(scene->density != NULL && dvi__density_has_column(scene, name)))
      return dvi__scene_refuse(scene, columns->child[i]->span, "there is no column '%s'%s", name,
                               dvi__nearest_or_all(name, count, known, hint, sizeof hint));
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
  scene->plan.usual_columns = 0;
  return all_columns(scene, columns);
}

bool dvi__choose_field_columns(dvi_scene *scene)
{
  const int momenta = scene->terms.symmetry_count,
            count = 1 + momenta + scene->terms.invariant_count;
  const char **column = dvi__arena_take(&scene->arena, (size_t)count, sizeof *column);
  if (column == NULL) return dvi__scene_no_memory(scene);
  column[0] = "energy";
  for (int i = 1; i < count; i++)
    column[i] = i <= momenta ? scene->terms.symmetries[i - 1].name
                             : scene->terms.invariants[i - 1 - momenta].name;
  scene->plan.column = column;
  scene->plan.column_count = count;
  scene->plan.usual_columns = 1;
  return true;
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
