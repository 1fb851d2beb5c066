/* Manifold coordinates. An expression names one, or its velocity or momentum.
 *
 * A Lagrangian has velocities of two sorts, since the mass is constant in both. Numbers 0 .. n-1 of
 * their block are the rates of the stored numbers (x', and R' of a matrix R, entry by entry). After
 * them stand the velocities of the state, omega(R) and rate(u). Elsewhere there are the velocities
 * of the state alone, and rates are made of them by R' = R hat(omega), (cos, sin)' = (-sin, cos)
 * rate. */
#include <string.h>

#include "scene/elaborate/elaborate.h"
#include "text/heap.h"

/* ---- named coordinates ---- */

static const dvi__coordinate *coordinate_named(const dvi_scene *scene, const dvi__expression *e)
{
  const dvi__name *name = e->form == DVI__FORM_NAME ? dvi__names_find(&scene->names, e->name)
                                                    : NULL;
  return name != NULL && name->sort == DVI__COORDINATE ? &scene->coordinate[name->number] : NULL;
}

const dvi__coordinate *dvi__part_of_motion(const dvi__coordinate *x, const char *name)
{
  if (x->kind != DVI__MOTION) return NULL;
  return strcmp(name, "R") == 0 ? &x->part[0] : strcmp(name, "x") == 0 ? &x->part[1] : NULL;
}

bool dvi__subscripts_of(const dvi__expression *e, dvi__subscripts *index)
{
  *index = (dvi__subscripts){.count = e->count - 1};
  for (int k = 0; k < index->count && k < 2; k++) index->of[k] = e->part[k + 1];
  return index->count <= 2;
}

bool dvi__refuse_family(const dvi__context *c, const dvi__coordinate *x, const char *part,
                        dvi__span span)
{
  if (x->family > 1)
    return dvi__refuse(c, span, "%s is a family of %d x %d; take one of it, as %s[1,1]%s", x->name,
                       dvi__extent(x, 0), dvi__extent(x, 1), x->name, part);
  return dvi__refuse(c, span, "%s is a family of %d; take one of it, as %s[1]%s", x->name, x->size,
                     x->name, part);
}

const dvi__coordinate *dvi__member_named(const dvi_scene *scene, const dvi__expression *e,
                                         dvi__subscripts *index)
{
  const char *part = NULL;
  *index = (dvi__subscripts){0};
  if (e->form == DVI__FORM_MEMBER) {
    part = e->name;
    e = e->part[0];
  }
  if (e->form == DVI__FORM_INDEX) {
    if (!dvi__subscripts_of(e, index)) return NULL;
    e = e->part[0];
  }
  const dvi__coordinate *x = coordinate_named(scene, e);
  if (x == NULL || x->family != index->count) return NULL;
  return part == NULL ? x : dvi__part_of_motion(x, part);
}

dvi__value dvi__member_value(dvi__context *c, const dvi__expression *e)
{
  dvi__subscripts index;
  const dvi__expression *whole = e->part[0];
  const dvi__coordinate *x = dvi__member_named(c->scene, e, &index);
  if (x != NULL) return dvi__coordinate_value(c, x, &index, e->span);
  if (whole->form == DVI__FORM_INDEX) whole = whole->part[0];
  x = coordinate_named(c->scene, whole);
  if (x == NULL || x->kind != DVI__MOTION)
    return dvi__refused(dvi__refuse(c, e->span, "only rigid motions have parts, B.R and B.x"));
  if (x->family > 0 && e->part[0]->form == DVI__FORM_NAME) {
    const char part[3] = {'.', e->name[0], '\0'};
    return dvi__refused(dvi__refuse_family(c, x, part, e->span));
  }
  return dvi__refused(dvi__refuse(c, e->span,
                                  "the parts of %s are %s.R, its rotation, and %s.x, its place",
                                  x->name, x->name, x->name));
}

int dvi__coordinate_at(const dvi_scene *scene, int number, int of_v)
{
  int low = 0, high = scene->coordinate_count;
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    if ((of_v ? scene->coordinate[middle].v.first : scene->coordinate[middle].q.first) <= number)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* ---- velocities and momenta of a state ---- */

/* An input as number k of members of a coordinate, one for each element or `all`. */
typedef struct member_number {
  const dvi__coordinate *x;
  int k, *each, all;
} member_number;

/* Return the coordinate, or the part of a motion, to which a stored number belongs. */
static const dvi__coordinate *part_at(const dvi_scene *scene, int number)
{
  const dvi__coordinate *x = &scene->coordinate[dvi__coordinate_at(scene, number, 0)];
  if (x->kind != DVI__MOTION) return x;
  return &x->part[(number - x->q.first) % x->q.stride >= x->part[0].q.components];
}

static bool member_number_of(dvi__context *c, int input, member_number *w)
{
  const dvi__kernel_input of = c->input[input];
  const int number = dvi__input_number(&of, 0);
  const dvi__coordinate *x = part_at(c->scene, number);
  *w = (member_number){
      .x = x, .k = (number - x->q.first) % x->q.stride, .all = (number - x->q.first) / x->q.stride};
  if (of.number == NULL && of.stride == 0) return true;
  w->each = dvi__heap_take((size_t)c->elements, sizeof *w->each);
  if (w->each == NULL) return dvi__scene_no_memory(c->scene);
  for (int e = 0; e < c->elements; e++)
    w->each[e] = (dvi__input_number(&of, e) - x->q.first) / x->q.stride;
  return true;
}

static bool first_numbers(dvi__context *c, const member_number *w, const dvi__slots *places,
                          dvi__numbering *numbering)
{
  return dvi__numbering_of(c, w->each, w->all, places->first, places->stride, numbering);
}

static dvi__node multiply_nodes(const dvi__context *c, dvi__node a, dvi__node b)
{
  return dvi__apply(c->graph, DVI__OP_MULTIPLY, a, b);
}

/* Return the rate of number k of a member with numbers q and velocities v. */
static dvi__node rate_of(dvi__context *c, const member_number *w, dvi__numbering q,
                         dvi__numbering v)
{
  const int k = w->k;
  if (w->x->kind == DVI__ANGLE) {
    const dvi__node rate = dvi__variable_node(c, DVI__VELOCITIES, v, 0);
    const dvi__node moved = multiply_nodes(c, dvi__variable_node(c, DVI__COORDINATES, q, 1 - k),
                                           rate);
    return k == 0 ? dvi__apply(c->graph, DVI__OP_NEGATE, moved, 0) : moved;
  }
  if (w->x->kind != DVI__ROTATION) return dvi__variable_node(c, DVI__VELOCITIES, v, k);
  const int row = k - k % 3, next = (k + 1) % 3, last = (k + 2) % 3;
  const dvi__node ahead = multiply_nodes(c, dvi__variable_node(c, DVI__COORDINATES, q, row + next),
                                         dvi__variable_node(c, DVI__VELOCITIES, v, last)),
                  behind = multiply_nodes(c, dvi__variable_node(c, DVI__COORDINATES, q, row + last),
                                          dvi__variable_node(c, DVI__VELOCITIES, v, next));
  return dvi__apply(c->graph, DVI__OP_SUBTRACT, ahead, behind);
}

bool dvi__input_velocity(dvi__context *c, int input, dvi__node *rate)
{
  member_number w;
  dvi__numbering q, v;
  if (!member_number_of(c, input, &w)) return false;
  const bool good = first_numbers(c, &w, &w.x->q, &q) && first_numbers(c, &w, &w.x->v, &v);
  if (good) *rate = rate_of(c, &w, q, v);
  dvi__heap_free(w.each);
  return good;
}

bool dvi__input_momentum(dvi__context *c, int input, dvi__node *momentum)
{
  member_number w;
  dvi__numbering v;
  if (!member_number_of(c, input, &w)) return false;
  const bool good = w.x->kind != DVI__ROTATION && w.x->kind != DVI__ANGLE &&
                    first_numbers(c, &w, &w.x->v, &v);
  if (good) *momentum = dvi__variable_node(c, DVI__VELOCITIES, v, w.k);
  dvi__heap_free(w.each);
  return good;
}

/* Return the velocities or momenta of a coordinate, or of a member of a family. `before` numbers
 * stand in front of the state's. */
static dvi__value state_value(dvi__context *c, const dvi__coordinate *x,
                              const dvi__subscripts *index, int before)
{
  dvi__numbering numbering;
  dvi__slots places = x->v;
  places.first += before;
  if (!dvi__member_numbering(c, x, index, &places, &numbering)) return DVI__NO_VALUE;
  if (x->v.components == 1)
    return dvi__number_value(dvi__variable_node(c, DVI__VELOCITIES, numbering, 0));
  dvi__value value = dvi__value_make(c, 1, x->v.components, 1);
  for (int k = 0; !dvi__failed(value) && k < x->v.components; k++)
    value.node[k] = dvi__variable_node(c, DVI__VELOCITIES, numbering, k);
  return value;
}

static const dvi__coordinate *argument_of(dvi__context *c, const dvi__expression *e,
                                          dvi__subscripts *index)
{
  if (e->count == 1) return dvi__member_named(c->scene, e->part[0], index);
  (void)dvi__refuse(c, e->span, "%s takes 1 argument, not %d", e->name, e->count);
  return NULL;
}

dvi__value dvi__velocity_value(dvi__context *c, const dvi__expression *e)
{
  dvi__subscripts index;
  const int omega = strcmp(e->name, "omega") == 0;
  if (!dvi__check_mention(c, DVI__MENTIONS_V, e->span)) return DVI__NO_VALUE;
  const dvi__coordinate *x = argument_of(c, e, &index);
  if (c->scene->complaint->status != DVI_OK) return DVI__NO_VALUE;
  if (x != NULL && x->kind == DVI__MOTION) x = &x->part[0];
  if (x == NULL || x->kind != (omega ? DVI__ROTATION : DVI__ANGLE))
    return dvi__refused(
        dvi__refuse(c, e->part[0]->span,
                    omega ? "omega is taken of a rotation, or of a rigid motion"
                          : "rate is taken of an angle; of numbers and vectors it is x'"));
  if ((c->may & DVI__MENTIONS_P) != 0 && !c->sample)
    return dvi__refused(dvi__refuse(
        c, e->span,
        "velocities of rotations and angles cannot stand in %s; say it by momenta, p(%s)", c->where,
        x->name));
  return state_value(c, x, &index, (c->may & DVI__OF_STATE) != 0 ? 0 : c->scene->n);
}

dvi__value dvi__whole_momentum(dvi__context *c, const dvi__expression *e)
{
  dvi__subscripts index;
  const dvi__coordinate *x = argument_of(c, e, &index);
  if (x != NULL && x->kind == DVI__MOTION)
    return dvi__refused(dvi__refuse(c, e->part[0]->span,
                                    "%s is a rigid motion; its momenta are p(%s.R) and p(%s.x)",
                                    x->name, x->name, x->name));
  return x == NULL ? DVI__NO_VALUE : state_value(c, x, &index, 0);
}
