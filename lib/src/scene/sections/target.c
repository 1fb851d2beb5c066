/* Coordinates as keys, x, x[3], x[i], B.R, x', omega(R), rate(u), p(x). */
#include <stdio.h>
#include <string.h>

#include "scene/elaborate/elaborate.h"
#include "scene/sections/sections.h"
#include "scene/sections/target.h"
#include "scene/elaborate/shape.h"
#include "scene/elaborate/words.h"

/* Take x', omega(R), rate(u) or p(x) apart. */
static const dvi__expression *strip_key(const dvi__expression *e, dvi__target *target)
{
  target->mentions = DVI__MENTIONS_Q;
  if (e->form == DVI__FORM_RATE) {
    target->mentions = DVI__MENTIONS_V;
    return e->part[0];
  }
  if (e->form != DVI__FORM_CALL || e->count != 1) return e;
  const int momentum = strcmp(e->name, "p") == 0,
            velocity = strcmp(e->name, "omega") == 0 || strcmp(e->name, "rate") == 0;
  if (!momentum && !velocity) return e;
  target->mentions = momentum ? DVI__MENTIONS_P : DVI__MENTIONS_V;
  if (velocity) target->call = e->name;
  return e->part[0];
}

/* Find the coordinate, or the part of a motion, and the index that stands with it. */
static bool find_coordinate(dvi_scene *scene, const dvi__tree *key, const dvi__expression *e,
                            dvi__target *target)
{
  const dvi__expression *whole = e->form == DVI__FORM_MEMBER ? e->part[0] : e, *name = whole;
  if (whole->form == DVI__FORM_INDEX && dvi__subscripts_of(whole, &target->index))
    name = whole->part[0];
  if (name->form != DVI__FORM_NAME)
    return dvi__scene_refuse(scene, key->span, "this is no coordinate, as x, x[3] or x[i] are");
  const dvi__name *known = dvi__names_find(&scene->names, name->name);
  const bool word = known == NULL && dvi__is_word(name->name);
  if (known == NULL && !word)
    return dvi__names_unknown(&scene->names, &scene->arena, scene->complaint, name->name,
                              name->span);
  if (word || known->sort != DVI__COORDINATE)
    return dvi__scene_refuse(scene, name->span, "'%s' is a %s, no coordinate", name->name,
                             word ? "word of the language" : dvi__sort_name(known->sort));
  target->x = &scene->coordinate[known->number];
  if (target->index.count > 0 && target->x->family == 0)
    return dvi__scene_refuse(scene, whole->span, "'%s' is no family, and is given as a whole",
                             name->name);
  if (target->index.count > 0 && target->index.count != target->x->family)
    return dvi__scene_refuse(scene, whole->span, "'%s' has %d ind%s, not %d", name->name,
                             target->x->family, target->x->family == 1 ? "ex" : "ices",
                             target->index.count);
  if (e->form != DVI__FORM_MEMBER) return true;
  target->x = dvi__part_of_motion(target->x, e->name);
  return target->x != NULL ||
         dvi__scene_refuse(scene, e->span, "'%s' has no part %s; rigid motions have R and x",
                           name->name, e->name);
}

/* Check that the key is the right one for the kind, x', omega(R) or rate(u), and for a motion its
 * parts. */
static bool right_key(dvi_scene *scene, dvi__span span, dvi__target *target)
{
  const char *name = target->x->name;
  if (target->x->kind == DVI__MOTION) {
    if (target->call == NULL || strcmp(target->call, "omega") != 0)
      return dvi__scene_refuse(
          scene, span, "'%s' is a rigid motion: what is given is of %s.R or %s.x, and omega(%s)",
          name, name, name, name);
    target->x = &target->x->part[0];
  }
  if (target->mentions != DVI__MENTIONS_V) return true;
  const dvi__kind kind = target->x->kind;
  const char *wanted = kind == DVI__ROTATION ? "omega" : kind == DVI__ANGLE ? "rate" : NULL;
  if (wanted == NULL)
    return target->call == NULL ||
           dvi__scene_refuse(scene, span, "the velocity of %s is its rate, x'", name);
  return (target->call != NULL && strcmp(target->call, wanted) == 0) ||
         dvi__scene_refuse(scene, span, "the velocity of %s is %s(%s)", name, wanted, name);
}

bool dvi__read_target(dvi_scene *scene, const dvi__tree *key, dvi__target *target)
{
  const dvi__expression *e;
  if (!dvi__tree_expression(scene, key, &e)) return false;
  *target = (dvi__target){.span = key->span};
  if (!find_coordinate(scene, key, strip_key(e, target), target) ||
      !right_key(scene, key->span, target))
    return false;
  target->places = target->mentions == DVI__MENTIONS_Q ? &target->x->q : &target->x->v;
  for (int k = 0; k < target->index.count; k++) {
    const dvi__expression *index = target->index.of[k];
    const bool runs = index->form == DVI__FORM_NAME &&
                      dvi__names_find(&scene->names, index->name) == NULL;
    if (runs) target->each[k] = index->name;
    target->fixed += !runs;
  }
  return true;
}

int dvi__target_place(const dvi__target *target, int k)
{
  return k / target->places->components * target->places->stride + k % target->places->components;
}

/* Bind an index of a formula. It has values for `elements`, and its value changes with every
 * `run`. */
static bool bind_each(dvi__context *c, const dvi__target *target, int k, int run)
{
  int *each = dvi__arena_take(&c->scene->arena, (size_t)c->elements, sizeof *each);
  if (each == NULL) return dvi__scene_no_memory(c->scene);
  for (int e = 0; e < c->elements; e++) each[e] = e / run % dvi__extent(target->x, k) + 1;
  if (!dvi__index_bind(c, target->span, target->each[k])) return false;
  if (c->elements > 1)
    c->index[c->index_count - 1].each = each;
  else
    c->index[c->index_count - 1].all = 1;
  return true;
}

/* Bind the indices that run over all their values, the last one first. */
static bool bind_all(dvi__context *c, const dvi__target *target)
{
  int run[2] = {1, 1};
  for (int k = target->index.count - 1; k >= 0; k--) {
    run[k] = c->elements;
    if (target->each[k] != NULL) c->elements *= dvi__extent(target->x, k);
  }
  for (int k = 0; k < target->index.count; k++)
    if (target->each[k] != NULL && !bind_each(c, target, k, run[k])) return false;
  return true;
}

/* Return the shape of a target's value, of a member or of the family as a list. An angle has the
 * shape of its number. */
static dvi__shape wanted_shape(const dvi__target *target)
{
  const dvi__coordinate *x = target->x;
  dvi__shape one = x->shape;
  if (x->kind == DVI__ANGLE) one = (dvi__shape){.rank = 0, .rows = 1, .columns = 1};
  if (x->kind == DVI__ROTATION && target->places == &x->v)
    one = (dvi__shape){.rank = 1, .rows = 3, .columns = 1};
  if (x->family == 0 || target->index.count > 0) return one;
  if (x->family > 1) return (dvi__shape){one.rank + 2, dvi__extent(x, 0), dvi__extent(x, 1)};
  return (dvi__shape){one.rank + 1, x->size, one.rows};
}

static bool right_shape(dvi_scene *scene, const dvi__target *target, dvi__shape shape,
                        dvi__span span)
{
  char here[48], there[48];
  const dvi__shape wanted = wanted_shape(target);
  if (wanted.rank > 2)
    return dvi__scene_refuse(
        scene, target->span,
        "%s is more than a matrix: give it by a formula, %s[%s], or one by one, %s[%s]",
        target->x->name, target->x->name, target->x->family > 1 ? "i,j" : "i", target->x->name,
        target->x->family > 1 ? "1,1" : "1");
  if (dvi__same_shape(shape, wanted)) return true;
  return dvi__scene_refuse(scene, span, "%s for %s, which is %s",
                           dvi__shape_text(shape, here, sizeof here), target->x->name,
                           dvi__shape_text(wanted, there, sizeof there));
}

bool dvi__target_value(dvi__context *c, const dvi__target *target, const dvi__tree *tree,
                       dvi__value *value, dvi__numbering *numbering, const dvi__expression **e)
{
  if (!bind_all(c, target)) return false;
  if (!dvi__member_numbering(c, target->x, &target->index, target->places, numbering) ||
      !dvi__tree_expression(c->scene, tree, e))
    return false;
  *value = dvi__elaborate(c, *e);
  if (dvi__failed(*value) && c->uneven)
    return dvi__scene_refuse(c->scene, (*e)->span, "the sum in this has other bounds for each %s",
                             target->each[target->each[0] == NULL]);
  return !dvi__failed(*value) && right_shape(c->scene, target, value->shape, (*e)->span);
}
