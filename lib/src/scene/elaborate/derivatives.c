/* Derivatives in space, d(u,x) and grad(u), and the parts re(psi) and im(psi) of complex fields, in
 * the expressions of a density. Of a field of rotations they are omega(R) and kappa(R,x).
 *
 * The derivative of an expression along an axis is the total one, by the chain rule: the position
 * along the axis has the derivative 1, the time and other positions 0, and a derivative of a field
 * of some order, or its rate, has the one of the next order. */
#include <string.h>

#include "scene/elaborate/elaborate.h"

static const char *const words[] = {"d", "grad", "re", "im"}, *const of_rotation[] = {"omega",
                                                                                      "kappa"};

bool dvi__is_word_of_field(const dvi__context *c, const dvi__expression *call)
{
  for (size_t k = 0; k < sizeof words / sizeof *words; k++)
    if (strcmp(words[k], call->name) == 0) return c->scene->jets != NULL;
  for (size_t k = 0; k < 2 && c->scene->jets != NULL && c->scene->jets->is_rotation; k++)
    if (strcmp(of_rotation[k], call->name) == 0) return true;
  return false;
}

/* ---- jets by their numbers ---- */

int dvi__jet_number(const dvi__jets *jets, int component, const int *order)
{
  const int side = DVI__JET_ORDER_MAX + 1, index = order[0] + side * (order[1] + side * order[2]);
  return jets->dimension + index * jets->components + component;
}

bool dvi__jet_at(const dvi__jets *jets, int number, int *component, int *order)
{
  const int side = DVI__JET_ORDER_MAX + 1;
  if (number < jets->dimension) return false;
  int index = (number - jets->dimension) / jets->components;
  *component = (number - jets->dimension) % jets->components;
  for (int d = 0; d < 3; d++, index /= side) order[d] = index % side;
  return true;
}

int dvi__jet_count(const dvi__jets *jets)
{
  int indices = 1;
  for (int d = 0; d < jets->dimension; d++) indices *= DVI__JET_ORDER_MAX + 1;
  return jets->dimension + indices * jets->components;
}

/* ---- derivatives ---- */

static int find_axis(const dvi__context *c, const dvi__expression *e)
{
  const dvi__jets *jets = c->scene->jets;
  for (int d = 0; d < jets->dimension && e->form == DVI__FORM_NAME; d++)
    if (strcmp(jets->axis[d], e->name) == 0) return d;
  return -1;
}

static bool refuse_axis(const dvi__context *c, dvi__span span)
{
  char list[120];
  const dvi__jets *jets = c->scene->jets;
  return dvi__refuse(c, span, "a derivative is taken along an axis, %s",
                     dvi__list_words(jets->dimension, jets->axis, " or ", list, sizeof list));
}

static bool input_derivative(dvi__context *c, int input, dvi__span span, int axis, dvi__node *to)
{
  const dvi__kernel_input of = c->input[input];
  const dvi__jets *jets = c->scene->jets;
  const int number = dvi__input_number(&of, 0);
  int component, order[3], total = 0;
  *to = dvi__constant(c->graph, 0);
  if (of.is_data || (of.block != DVI__COORDINATES && of.block != DVI__VELOCITIES)) return true;
  if (!dvi__jet_at(jets, number, &component, order)) {
    if (number == axis) *to = dvi__constant(c->graph, 1);
    return true;
  }
  order[axis]++;
  for (int d = 0; d < 3; d++) total += order[d];
  if (total > DVI__JET_ORDER_MAX)
    return dvi__refuse(c, span, "derivatives of more than order %d in space",
                       (int)DVI__JET_ORDER_MAX);
  *to = dvi__variable_node(c, of.block,
                           (dvi__numbering){.base = dvi__jet_number(jets, component, order)}, 0);
  return true;
}

dvi__value dvi__derivative_along(dvi__context *c, dvi__value value, int axis, dvi__span span)
{
  c->graph->here = span;
  return dvi__chain_rule(c, value, span, input_derivative, axis);
}

/* Return d(e, x, y, ..). */
static dvi__value derivative_value(dvi__context *c, const dvi__expression *e)
{
  if (e->count < 2)
    return dvi__refused(dvi__refuse(c, e->span, "d takes an expression and axes, as in d(u,x)"));
  dvi__value value = dvi__elaborate(c, e->part[0]);
  for (int k = 1; k < e->count && !dvi__failed(value); k++) {
    const int axis = find_axis(c, e->part[k]);
    if (axis < 0) return dvi__refused(refuse_axis(c, e->part[k]->span));
    value = dvi__derivative_along(c, value, axis, e->span);
  }
  return value;
}

/* Return the vector of the derivatives along all axes. */
static dvi__value gradient_value(dvi__context *c, const dvi__expression *e, dvi__value a)
{
  if (a.shape.rank != 0)
    return dvi__refused(dvi__refuse(c, e->span, "grad is taken of a number, as of u[1]"));
  dvi__value result = dvi__value_make(c, 1, c->scene->jets->dimension, 1);
  for (int d = 0; d < c->scene->jets->dimension && !dvi__failed(result); d++) {
    const dvi__value one = dvi__derivative_along(c, a, d, e->span);
    if (dvi__failed(one)) return one;
    result.node[d] = one.one;
  }
  return result;
}

/* Return omega(R), or kappa(R,x) along an axis. */
static dvi__value turn_value(dvi__context *c, const dvi__expression *e)
{
  enum { FIRST = 9, NUMBERS = 3 };
  const bool bends = strcmp(e->name, "kappa") == 0;
  int order[3] = {0};
  const dvi__name *name = e->count == 1 + bends && e->part[0]->form == DVI__FORM_NAME
                              ? dvi__names_find(&c->scene->names, e->part[0]->name)
                              : NULL;
  if (name == NULL || name->sort != DVI__COORDINATE ||
      c->scene->coordinate[name->number].shape.rank != 2)
    return dvi__refused(dvi__refuse(c, e->span, "%s is taken of a field of rotations%s", e->name,
                                    bends ? " and an axis, as in kappa(R,x)" : ""));
  const int axis = bends ? find_axis(c, e->part[1]) : 0;
  if (axis < 0) return dvi__refused(refuse_axis(c, e->part[1]->span));
  if (bends) order[axis] = 1;
  if (!dvi__check_mention(c, bends ? DVI__MENTIONS_Q : DVI__MENTIONS_V, e->span))
    return DVI__NO_VALUE;
  dvi__value value = dvi__value_make(c, 1, NUMBERS, 1);
  for (int k = 0; k < NUMBERS && !dvi__failed(value); k++)
    value.node[k] = dvi__variable_node(
        c, bends ? DVI__COORDINATES : DVI__VELOCITIES,
        (dvi__numbering){.base = dvi__jet_number(c->scene->jets, FIRST + k, order)}, 0);
  return value;
}

dvi__value dvi__field_word_value(dvi__context *c, const dvi__expression *e)
{
  for (size_t k = 0; k < 2; k++)
    if (strcmp(of_rotation[k], e->name) == 0) return turn_value(c, e);
  if (strcmp(e->name, "d") == 0) return derivative_value(c, e);
  if (e->count != 1)
    return dvi__refused(dvi__refuse(c, e->span, "%s takes 1 argument, not %d", e->name, e->count));
  const dvi__value a = dvi__elaborate(c, e->part[0]);
  if (dvi__failed(a)) return a;
  if (strcmp(e->name, "grad") == 0) return gradient_value(c, e, a);
  if (a.shape.rank != 1 || a.shape.rows != 2)
    return dvi__refused(
        dvi__refuse(c, e->span, "%s is taken of a complex field, a vector of 2", e->name));
  return dvi__number_value(a.node[strcmp(e->name, "im") == 0]);
}
