/* Coordinates as keys: x, x[3], x[i], x', p(x). */
#include <stdio.h>
#include <string.h>

#include "scene/sections.h"
#include "scene/shape.h"

/* Take x' or p(x) apart. */
static const dvi__expression *bare(const dvi__expression *e, unsigned *says)
{
  *says = DVI__SAYS_Q;
  if (e->form == DVI__FORM_RATE) {
    *says = DVI__SAYS_V;
    return e->part[0];
  }
  if (e->form == DVI__FORM_CALL && strcmp(e->name, "p") == 0 && e->count == 1) {
    *says = DVI__SAYS_P;
    return e->part[0];
  }
  return e;
}

bool dvi__read_target(dvi_scene *scene, const dvi__tree *key, dvi__target *target)
{
  const dvi__expression *e, *name;
  if (!dvi__tree_expression(scene, key, &e)) return false;
  *target = (dvi__target){.span = key->span};
  e = name = bare(e, &target->says);
  if (e->form == DVI__FORM_INDEX && e->count == 2) {
    name = e->part[0];
    target->index = e->part[1];
  }
  if (name->form != DVI__FORM_NAME) return dvi__scene_refuse(scene, key->span, "this is no coordinate, as x, x[3] or x[i] are");
  const dvi__name *known = dvi__names_find(&scene->names, name->name);
  if (known == NULL) return dvi__names_unknown(&scene->names, &scene->arena, scene->complaint, name->name, name->span);
  if (known->sort != DVI__COORDINATE)
    return dvi__scene_refuse(scene, name->span, "'%s' is a %s, no coordinate", name->name, dvi__sort_name(known->sort));
  target->x = &scene->coordinate[known->number];
  if (target->index != NULL && !target->x->family)
    return dvi__scene_refuse(scene, e->span, "'%s' is no family, and is given as a whole", name->name);
  if (target->index != NULL && target->index->form == DVI__FORM_NAME &&
      dvi__names_find(&scene->names, target->index->name) == NULL) {
    target->each = target->index->name;
    target->index = NULL;
  }
  return true;
}

/* Bind the index of a formula for all members. */
static bool bind_each(dvi__context *c, const dvi__target *target)
{
  int *each = dvi__arena_take(&c->scene->arena, (size_t)target->x->size, sizeof *each);
  if (each == NULL) return dvi__scene_no_memory(c->scene);
  for (int i = 0; i < target->x->size; i++) each[i] = i + 1;
  if (!dvi__index_bind(c, target->span, target->each)) return false;
  if (target->x->size > 1)
    c->index[c->index_count - 1].each = each;
  else
    c->index[c->index_count - 1].all = 1;
  c->elements = target->x->size;
  return true;
}

/* The shape that belongs there: of a member, or of the family as a list. */
static dvi__shape wanted_shape(const dvi__target *target)
{
  const dvi__coordinate *x = target->x;
  if (!x->family || target->each != NULL || target->index != NULL) return x->shape;
  return (dvi__shape){x->shape.rank + 1, x->size, x->components};
}

static bool right_shape(dvi_scene *scene, const dvi__target *target, dvi__shape shape, dvi__span span)
{
  char here[48], there[48];
  const dvi__shape wanted = wanted_shape(target);
  if (shape.rank == wanted.rank && shape.rows == wanted.rows && shape.columns == wanted.columns) return true;
  return dvi__scene_refuse(scene, span, "%s for %s, which is %s", dvi__shape_text(shape, here, sizeof here), target->x->name,
                           dvi__shape_text(wanted, there, sizeof there));
}

/* Where the first number of the value is in q, for every element. */
static bool place_of(dvi__context *c, const dvi__target *target, dvi__numbering *numbering)
{
  const dvi__coordinate *x = target->x;
  const int before = x->first - x->components;
  int *each = NULL, all = 1;
  if (target->each != NULL) return dvi__numbering_of(c, c->index[0].each, 1, before, x->components, numbering);
  if (target->index == NULL) return dvi__numbering_of(c, NULL, 1, before, x->components, numbering);
  if (!dvi__whole_numbers_of(c, target->index, "an index", &each, &all)) return false;
  if (all < 1 || all > x->size)
    return dvi__scene_refuse(c->scene, target->index->span, "the index %d is not between 1 and %d", all, x->size);
  return dvi__numbering_of(c, each, all, before, x->components, numbering);
}

bool dvi__target_value(dvi__context *c, const dvi__target *target, const dvi__tree *tree, dvi__value *value,
                       dvi__numbering *numbering, const dvi__expression **e)
{
  if (target->each != NULL && !bind_each(c, target)) return false;
  if (!place_of(c, target, numbering) || !dvi__tree_expression(c->scene, tree, e)) return false;
  *value = dvi__elaborate(c, *e);
  if (dvi__failed(*value) && c->uneven)
    return dvi__scene_refuse(c->scene, (*e)->span, "the sum in this has other bounds for each %s", target->each);
  return !dvi__failed(*value) && right_shape(c->scene, target, value->shape, (*e)->span);
}
