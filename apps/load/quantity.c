#include "load/quantity.h"

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

static int refuse(const quantity_list *list, const char *option, const char *name)
{
  char near[2 * QUANTITY_NAME], names[1024] = "";
  size_t used = 0;
  for (int k = 0; k < list->count && used < sizeof names; k++)
    used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", k > 0 ? ", " : "",
                             list->item[k].name);
  return usage_error("%s %s: there is no such quantity%s; the fields show %s", option, name,
                     suggestion(name, name_at, list, near, sizeof near), names);
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
  return refuse(&list, option, name != NULL ? name : "");
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
  static const int none[DVI_AXES_MAX] = {0};
  const int64_t functions = dvi_space_functions(space);
  const double *part = (shown->kind == QUANTITY_RATE ? at.rate : at.U) +
                       shown->component * functions;
  dvi_status status = dvi_space_evaluate(space, none, part, count, x, value);
  if (status == DVI_OK && (shown->kind == QUANTITY_SQUARE || shown->kind == QUANTITY_PHASE)) {
    double *im = calloc((size_t)count + 1, sizeof *im);
    if (im == NULL) return library_error(DVI_NO_MEMORY);
    status = dvi_space_evaluate(space, none, part + functions, count, x, im);
    if (status == DVI_OK) combine(shown->kind, count, im, value);
    free(im);
  }
  return status == DVI_OK ? DONE : library_error(status);
}
