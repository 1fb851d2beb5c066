/* Coordinates as keys: x, x[3], x[i], B.R, x', omega(R), rate(u), p(x). */
#include <stdio.h>
#include <string.h>

#include "scene/elaborate.h"
#include "scene/sections.h"
#include "scene/shape.h"
#include "scene/words.h"

/* Take x', omega(R), rate(u) or p(x) apart. */
static const dvi__expression *bare(const dvi__expression *e, dvi__target *target)
{
  target->says = DVI__SAYS_Q;
  if (e->form == DVI__FORM_RATE) {
    target->says = DVI__SAYS_V;
    return e->part[0];
  }
  if (e->form != DVI__FORM_CALL || e->count != 1) return e;
  const int momentum = strcmp(e->name, "p") == 0, turns = strcmp(e->name, "omega") == 0 || strcmp(e->name, "rate") == 0;
  if (!momentum && !turns) return e;
  target->says = momentum ? DVI__SAYS_P : DVI__SAYS_V;
  if (turns) target->call = e->name;
  return e->part[0];
}

/* The coordinate, or the part of a motion, and the index that stands with it. */
static bool find_coordinate(dvi_scene *scene, const dvi__tree *key, const dvi__expression *e, dvi__target *target)
{
  const dvi__expression *whole = e->form == DVI__FORM_MEMBER ? e->part[0] : e, *name = whole;
  if (whole->form == DVI__FORM_INDEX && whole->count == 2) {
    name = whole->part[0];
    target->index = whole->part[1];
  }
  if (name->form != DVI__FORM_NAME) return dvi__scene_refuse(scene, key->span, "this is no coordinate, as x, x[3] or x[i] are");
  const dvi__name *known = dvi__names_find(&scene->names, name->name);
  const bool word = known == NULL && dvi__is_word(name->name);
  if (known == NULL && !word) return dvi__names_unknown(&scene->names, &scene->arena, scene->complaint, name->name, name->span);
  if (word || known->sort != DVI__COORDINATE)
    return dvi__scene_refuse(scene, name->span, "'%s' is a %s, no coordinate", name->name,
                             word ? "word of the language" : dvi__sort_name(known->sort));
  target->x = &scene->coordinate[known->number];
  if (target->index != NULL && !target->x->family)
    return dvi__scene_refuse(scene, whole->span, "'%s' is no family, and is given as a whole", name->name);
  if (e->form != DVI__FORM_MEMBER) return true;
  target->x = dvi__part_of_motion(target->x, e->name);
  return target->x != NULL ||
         dvi__scene_refuse(scene, e->span, "'%s' has no part %s; rigid motions have R and x", name->name, e->name);
}

/* Whether the key is the right one for the kind: x', omega(R), rate(u); of a motion its parts. */
static bool right_key(dvi_scene *scene, dvi__span span, dvi__target *target)
{
  const char *name = target->x->name;
  if (target->x->kind == DVI__MOTION) {
    if (target->call == NULL || strcmp(target->call, "omega") != 0)
      return dvi__scene_refuse(scene, span, "'%s' is a rigid motion: what is given is of %s.R or %s.x, and omega(%s)", name, name,
                               name, name);
    target->x = &target->x->part[0];
  }
  if (target->says != DVI__SAYS_V) return true;
  const dvi__kind kind = target->x->kind;
  const char *wanted = kind == DVI__ROTATION ? "omega" : kind == DVI__ANGLE ? "rate" : NULL;
  if (wanted == NULL) return target->call == NULL || dvi__scene_refuse(scene, span, "the velocity of %s is its rate, x'", name);
  return (target->call != NULL && strcmp(target->call, wanted) == 0) ||
         dvi__scene_refuse(scene, span, "the velocity of %s is %s(%s)", name, wanted, name);
}

bool dvi__read_target(dvi_scene *scene, const dvi__tree *key, dvi__target *target)
{
  const dvi__expression *e;
  if (!dvi__tree_expression(scene, key, &e)) return false;
  *target = (dvi__target){.span = key->span};
  if (!find_coordinate(scene, key, bare(e, target), target) || !right_key(scene, key->span, target)) return false;
  target->places = target->says == DVI__SAYS_Q ? &target->x->q : &target->x->v;
  if (target->index != NULL && target->index->form == DVI__FORM_NAME &&
      dvi__names_find(&scene->names, target->index->name) == NULL) {
    target->each = target->index->name;
    target->index = NULL;
  }
  return true;
}

int dvi__target_place(const dvi__target *target, int k)
{
  return k / target->places->components * target->places->stride + k % target->places->components;
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

/* The shape that belongs there: of a member, or of the family as a list. An angle is given by its number. */
static dvi__shape wanted_shape(const dvi__target *target)
{
  const dvi__coordinate *x = target->x;
  dvi__shape one = x->shape;
  if (x->kind == DVI__ANGLE) one = (dvi__shape){0, 1, 1};
  if (x->kind == DVI__ROTATION && target->places == &x->v) one = (dvi__shape){1, 3, 1};
  if (!x->family || target->each != NULL || target->index != NULL) return one;
  return (dvi__shape){one.rank + 1, x->size, one.rows};
}

static bool right_shape(dvi_scene *scene, const dvi__target *target, dvi__shape shape, dvi__span span)
{
  char here[48], there[48];
  const dvi__shape wanted = wanted_shape(target);
  if (wanted.rank > 2)
    return dvi__scene_refuse(scene, target->span, "%s is a family of matrices: give them by a formula, %s[i], or one by one, %s[1]",
                             target->x->name, target->x->name, target->x->name);
  if (shape.rank == wanted.rank && shape.rows == wanted.rows && shape.columns == wanted.columns) return true;
  return dvi__scene_refuse(scene, span, "%s for %s, which is %s", dvi__shape_text(shape, here, sizeof here), target->x->name,
                           dvi__shape_text(wanted, there, sizeof there));
}

/* Where the first number of the value is in q, v or p, for every element. */
static bool place_of(dvi__context *c, const dvi__target *target, dvi__numbering *numbering)
{
  const dvi__coordinate *x = target->x;
  const int stride = target->places->stride, before = target->places->first - stride;
  int *each = NULL, all = 1;
  if (target->each != NULL) return dvi__numbering_of(c, c->index[0].each, 1, before, stride, numbering);
  if (target->index == NULL) return dvi__numbering_of(c, NULL, 1, before, stride, numbering);
  if (!dvi__whole_numbers_of(c, target->index, "an index", &each, &all)) return false;
  if (all < 1 || all > x->size)
    return dvi__scene_refuse(c->scene, target->index->span, "the index %d is not between 1 and %d", all, x->size);
  return dvi__numbering_of(c, each, all, before, stride, numbering);
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
