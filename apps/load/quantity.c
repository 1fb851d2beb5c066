#include "load/quantity.h"

#include <dvi/moving.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/spelling.h"

typedef struct quantity_list {
  int count;
  quantity *item; /* [QUANTITIES_MAX] */
} quantity_list;

/* ---- names ---- */

static void add(quantity_list *list, quantity_kind kind, int component, const char *before,
                const char *name, const char *after)
{
  quantity *made = list->item + list->count++;
  *made = (quantity){.kind = kind, .component = component};
  (void)snprintf(made->name, sizeof made->name, "%s%s%s", before, name, after);
}

static void add_field(const dvi_scene *scene, const dvi_scene_declared *field, bool has_rates,
                      quantity_list *list)
{
  const int end = field->first + field->components;
  for (int c = field->first; c < end; c++)
    add(list, QUANTITY_VALUE, c, "", dvi_scene_component(scene, c), "");
  if (field->is_complex) {
    add(list, QUANTITY_SQUARE, field->first, "|", field->name, "|^2");
    add(list, QUANTITY_PHASE, field->first, "phase(", field->name, ")");
  }
  for (int c = field->first; c < end && has_rates; c++)
    add(list, QUANTITY_RATE, c, "", dvi_scene_component(scene, c), "'");
}

int quantities_of(const problem *scene, quantity item[QUANTITIES_MAX])
{
  quantity_list list = {0, item};
  dvi_scene_declared field;
  const bool has_rates = scene->terms->one_form == NULL && dvi_scene_system(scene->scene) != NULL;
  for (int i = 0; dvi_scene_declared_of(scene->scene, i, &field); i++)
    add_field(scene->scene, &field, has_rates, &list);
  for (int c = 0; dvi_scene_moving(scene->scene) != NULL &&
                  dvi_scene_component(scene->scene, c) != NULL && c < DVI_COMPONENTS_MAX;
       c++)
    add(&list, QUANTITY_VALUE, c, "", dvi_scene_component(scene->scene, c), "");
  return list.count;
}

bool quantity_is_usual(const quantity *shown)
{
  return shown->kind == QUANTITY_VALUE || shown->kind == QUANTITY_SQUARE;
}

/* ---- choice ---- */

static const char *name_at(int k, const void *list)
{
  const quantity_list *all = list;
  return k < all->count ? all->item[k].name : NULL;
}

static int refuse(const problem *scene, const quantity_list *list, const char *option,
                  const char *name)
{
  char near[2 * QUANTITY_NAME], names[1024] = "";
  size_t used = 0;
  for (int k = 0; k < list->count && used < sizeof names; k++)
    used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", k > 0 ? ", " : "",
                             list->item[k].name);
  return usage_error(
      "%s %s: there is no such quantity%s; the fields show %s, and derivatives such as "
      "d(%s,%s)",
      option, name, suggestion(name, name_at, list, near, sizeof near), names, list->item[0].name,
      dvi_scene_axis(scene->scene, 0));
}

/* ---- derivatives ---- */

/* Return the axis of a name, -1 if there is none. */
static int axis_of(const problem *scene, const char *name)
{
  const char *axis;
  for (int d = 0; (axis = dvi_scene_axis(scene->scene, d)) != NULL; d++)
    if (strcmp(axis, name) == 0) return d;
  return -1;
}

/* Find a component or a rate. */
static const quantity *differentiable(const quantity_list *list, const char *name)
{
  for (int k = 0; k < list->count; k++)
    if ((list->item[k].kind == QUANTITY_VALUE || list->item[k].kind == QUANTITY_RATE) &&
        strcmp(list->item[k].name, name) == 0)
      return list->item + k;
  return NULL;
}

/* Copy "d(u,x)" without blanks. Returns false if the text has another form. */
static bool take_derivative(const char *text, char word[QUANTITY_NAME])
{
  size_t length = 0;
  for (const char *c = text; *c != '\0' && length + 1 < QUANTITY_NAME; c++)
    if (*c != ' ') word[length++] = *c;
  word[length] = '\0';
  return strncmp(word, "d(", 2) == 0 && strchr(word, ',') != NULL && word[length - 1] == ')';
}

/* Read "d(u,x)", "d(u',x,x)" and so on. */
static bool read_derivative(const problem *scene, const quantity_list *list, const char *text,
                            quantity *chosen)
{
  char name[QUANTITY_NAME] = "", word[QUANTITY_NAME];
  if (!take_derivative(text, name)) return false;
  memcpy(word, name, sizeof word);
  word[strlen(word) - 1] = '\0';
  char *axis = strchr(word, ',');
  *axis++ = '\0';
  const quantity *of = differentiable(list, word + 2);
  if (of == NULL) return false;
  *chosen = *of;
  memcpy(chosen->name, name, sizeof name);
  while (axis != NULL) {
    char *next = strchr(axis, ',');
    if (next != NULL) *next++ = '\0';
    const int d = axis_of(scene, axis);
    if (d < 0) return false;
    chosen->order[d]++;
    axis = next;
  }
  return true;
}

int quantity_choose(const problem *scene, const char *option, const char *name, quantity *chosen)
{
  quantity item[QUANTITIES_MAX];
  const quantity_list list = {quantities_of(scene, item), item};
  dvi_scene_declared first = {.name = NULL};
  (void)dvi_scene_declared_of(scene->scene, 0, &first);
  for (int k = 0; k < list.count; k++) {
    const bool is_main = item[k].kind == (first.is_complex ? QUANTITY_SQUARE : QUANTITY_VALUE);
    if (name != NULL ? strcmp(item[k].name, name) != 0 : !is_main) continue;
    *chosen = item[k];
    return DONE;
  }
  if (name != NULL && read_derivative(scene, &list, name, chosen)) return DONE;
  return refuse(scene, &list, option, name != NULL ? name : "");
}

/* ---- values ---- */

/* Put the real and the imaginary part together. */
static void combine(quantity_kind kind, int64_t count, const double *im, double *value)
{
  for (int64_t i = 0; i < count; i++)
    value[i] = kind == QUANTITY_SQUARE ? value[i] * value[i] + im[i] * im[i]
                                       : atan2(im[i], value[i]);
}

int quantity_evaluate(const quantity *shown, const dvi_space *space, quantity_state at,
                      int64_t count, const double *x, double *value)
{
  const int64_t functions = dvi_space_functions(space);
  const double *part = (shown->kind == QUANTITY_RATE ? at.rate : at.U) +
                       shown->component * functions;
  dvi_status status = dvi_space_evaluate(space, shown->order, part, count, x, value);
  if (status == DVI_OK && (shown->kind == QUANTITY_SQUARE || shown->kind == QUANTITY_PHASE)) {
    double *im = calloc((size_t)count + 1, sizeof *im);
    if (im == NULL) return library_error(DVI_NO_MEMORY);
    status = dvi_space_evaluate(space, shown->order, part + functions, count, x, im);
    if (status == DVI_OK) combine(shown->kind, count, im, value);
    free(im);
  }
  return status == DVI_OK ? DONE : library_error(status);
}
