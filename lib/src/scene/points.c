/* The public function of points, which are definitions of places that move with the coordinates. */
#include "scene/elaborate/kernels.h"
#include "scene/elaborate/model.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"
#include "text/heap.h"

static int is_point(const dvi__definition *d)
{
  const unsigned others = DVI__MENTIONS_V | DVI__MENTIONS_P | DVI__MENTIONS_U;
  return d->shape.rank == 1 && (d->shape.rows == 2 || d->shape.rows == 3) &&
         (d->mentions & DVI__MENTIONS_Q) != 0 && (d->mentions & others) == 0;
}

static const dvi__definition *find_point(const dvi_scene *scene, int i)
{
  for (int k = 0; k < scene->definition_count && i >= 0; k++)
    if (is_point(&scene->definition[k]) && i-- == 0) return &scene->definition[k];
  return NULL;
}

/* Write the expression name[k], with k from 1. */
static const dvi__expression *component_of(dvi_scene *scene, const dvi__definition *d, int k)
{
  dvi__expression *parts = dvi__arena_take(&scene->arena, 3, sizeof *parts);
  dvi__expression **list = dvi__arena_take(&scene->arena, 2, sizeof *list);
  if (parts == NULL || list == NULL) return NULL;
  parts[0] = (dvi__expression){.form = DVI__FORM_NAME, .span = d->span, .name = d->name};
  parts[1] = (dvi__expression){.form = DVI__FORM_NUMBER, .span = d->span, .number = k};
  list[0] = &parts[0];
  list[1] = &parts[1];
  parts[2] = (dvi__expression){.form = DVI__FORM_INDEX, .span = d->span, .count = 2, .part = list};
  return &parts[2];
}

static bool derive_component(dvi_scene *scene, const dvi__definition *d, int k,
                             dvi__scene_term **term)
{
  dvi__kernels list = {0};
  const dvi__expression *e = component_of(scene, d, k);
  if (e == NULL) return dvi__scene_no_memory(scene);
  const bool good = dvi__kernels_add(scene, DVI__MENTIONS_Q | DVI__MENTIONS_T, "a point", e, 0,
                                     &list) &&
                    dvi__kernels_function(scene, &list, 0, term);
  dvi__kernels_free(&list);
  if (good) (*term)->role = DVI__ROLE_AUXILIARY;
  return good;
}

dvi_status dvi_scene_point_of(dvi_scene *scene, int i, dvi_scene_point *point)
{
  if (scene == NULL || point == NULL || dvi__is_of_field(scene)) return DVI_BAD_ARGUMENT;
  const dvi__definition *d = find_point(scene, i);
  if (d == NULL) return DVI_BAD_ARGUMENT;
  dvi__complaint complaint = {.source = &scene->source};
  dvi__ledger *const other = dvi__heap_charge(&scene->ledger);
  bool good = true;
  *point = (dvi_scene_point){.name = d->name, .size = d->shape.rows, .value = dvi__term_value};
  scene->complaint = &complaint;
  for (int k = 0; k < point->size && good; k++) {
    dvi__scene_term *term = NULL;
    good = derive_component(scene, d, k + 1, &term);
    point->user[k] = term;
  }
  scene->complaint = NULL;
  (void)dvi__heap_charge(other);
  return good ? DVI_OK : complaint.status != DVI_OK ? complaint.status : DVI_NO_MEMORY;
}
