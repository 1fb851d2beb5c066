/* Vector fields and one-forms, written by coordinate. */
#include "scene/elaborate/shape.h"
#include "scene/sections/motion.h"
#include "scene/sections/sections.h"

void dvi__add_product(dvi__context *c, dvi__value value, const dvi__target *target,
                      dvi__numbering numbering, dvi__node *total)
{
  for (int k = 0; k < dvi__value_size(value); k++) {
    const int place = target != NULL ? dvi__target_place(target, k) : k;
    const dvi__node w = dvi__variable_node(c, DVI__MULTIPLIERS, numbering, place);
    *total = dvi__apply(c->graph, DVI__OP_ADD, *total,
                        dvi__apply(c->graph, DVI__OP_MULTIPLY, dvi__value_at(value, k), w));
  }
}

/* Return true for a key of a vector field. Keys are coordinates, and for rotations and angles
 * omega(R) and rate(u). */
static bool is_of_field(dvi_scene *scene, const dvi__tree *key, const char *where,
                        dvi__target *target)
{
  const dvi__kind kind = target->x->kind;
  const int by_velocity = kind == DVI__ROTATION || kind == DVI__ANGLE;
  target->places = &target->x->v;
  if (by_velocity ? target->mentions == DVI__MENTIONS_V : target->mentions == DVI__MENTIONS_Q)
    return true;
  if (by_velocity)
    return dvi__scene_refuse(scene, key->span,
                             "%s of a rotation or an angle is given by its velocity, %s(%s)", where,
                             kind == DVI__ANGLE ? "rate" : "omega", target->x->name);
  return dvi__scene_refuse(scene, key->span,
                           "%s is given by coordinate, neither by rate nor by momentum", where);
}

bool dvi__add_target(dvi_scene *scene, const dvi__target *target, const dvi__tree *tree,
                     unsigned may, const char *where, dvi__kernels *list)
{
  dvi__context c;
  dvi__value value;
  dvi__numbering numbering;
  const dvi__expression *e;
  if (!dvi__context_make(&c, scene, may, where)) return false;
  bool good = dvi__target_value(&c, target, tree, &value, &numbering, &e);
  if (good) {
    dvi__node total = dvi__constant(c.graph, 0);
    dvi__add_product(&c, value, target, numbering, &total);
    good = dvi__kernels_add_node(&c, total, list);
  }
  dvi__context_free(&c);
  return good;
}

static bool add_component(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree,
                          unsigned may, const char *where, dvi__kernels *list)
{
  dvi__target target;
  return dvi__read_target(scene, key, &target) && is_of_field(scene, key, where, &target) &&
         dvi__add_target(scene, &target, tree, DVI__MENTIONS_Q | may, where, list);
}

bool dvi__field_read(dvi_scene *scene, const dvi__tree *field, unsigned may, const char *where,
                     dvi__scene_term **term)
{
  dvi__kernels list = {0};
  bool good = dvi__want_mapping(scene, field, where);
  for (int i = 0; good && i < field->count; i++)
    good = add_component(scene, field->key[i], field->child[i], may, where, &list);
  good = good && dvi__kernels_function(scene, &list, scene->nv, term);
  dvi__kernels_free(&list);
  return good;
}
