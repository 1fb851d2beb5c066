/* Rates by the chain rule, and momenta. */

#include "scene/elaborate/elaborate.h"
#include "text/heap.h"

/* ---- rates and momenta ---- */

/* Return a velocity where the state has momenta. It is p/m, if the mass is a number for each
 * coordinate. */
static dvi__node from_momentum(dvi__context *c, int input, dvi__span span)
{
  const dvi__kernel_input of = c->input[input];
  const double *mass = c->scene->mass_diagonal;
  const dvi__node p = dvi__sibling_node(c, input, DVI__VELOCITIES);
  if (c->sample) return p;
  if (mass == NULL) {
    (void)dvi__refuse(c, span,
                      "velocities can stand in %s only if the mass is one number for each "
                      "coordinate; say it by momenta, p(x)",
                      c->where);
    return p;
  }
  if (of.number == NULL && of.stride == 0)
    return dvi__apply(c->graph, DVI__OP_DIVIDE, p,
                      dvi__constant(c->graph, mass[dvi__input_number(&of, 0)]));
  double *row = dvi__heap_take((size_t)c->elements, sizeof *row);
  if (row == NULL) {
    (void)dvi__scene_no_memory(c->scene);
    return p;
  }
  int even = 1;
  for (int e = 0; e < c->elements; e++) {
    row[e] = mass[dvi__input_number(&of, e)];
    even = even && !(row[e] < row[0]) && !(row[e] > row[0]);
  }
  const dvi__node m = even ? dvi__constant(c->graph, row[0]) : dvi__data_node(c, row);
  dvi__heap_free(row);
  return dvi__apply(c->graph, DVI__OP_DIVIDE, p, m);
}

/* Tell if an input is the position of a density, which does not move. */
static bool is_position(const dvi__context *c, const dvi__kernel_input *of)
{
  return c->scene->jets != NULL && of->block == DVI__COORDINATES &&
         dvi__input_number(of, 0) < c->scene->jets->dimension;
}

/* Find the rate of an input. That of a coordinate is its velocity, of the time 1, of data and of
 * positions 0. */
static bool input_rate(dvi__context *c, int input, dvi__span span, int unused, dvi__node *rate)
{
  const dvi__kernel_input *of = &c->input[input];
  (void)unused;
  if (of->is_data || is_position(c, of))
    *rate = dvi__constant(c->graph, 0);
  else if (of->block == DVI__TIME)
    *rate = dvi__constant(c->graph, 1);
  else if (of->block == DVI__VELOCITIES)
    return dvi__refuse(c, span, "the rate of a rate: there are no accelerations here");
  else if ((c->may & DVI__MENTIONS_P) != 0)
    *rate = from_momentum(c, input, span);
  else if ((c->may & DVI__OF_STATE) != 0 && dvi__has_factors(c->scene))
    return dvi__input_velocity(c, input, rate);
  else
    *rate = dvi__sibling_node(c, input, DVI__VELOCITIES);
  return true;
}

/* Find the rates of all inputs that occur in a value. Others are 0. */
static bool input_rates(dvi__context *c, dvi__value value, dvi__span span, int count,
                        dvi__input_rule *rule, int axis, char *used, dvi__node *rate)
{
  const int size = dvi__value_size(value);
  dvi__node *root = dvi__heap_take((size_t)size, sizeof *root);
  if (root == NULL) return dvi__scene_no_memory(c->scene);
  for (int i = 0; i < size; i++) root[i] = dvi__value_at(value, i);
  dvi__inputs_used(c->graph, size, root, count, used);
  dvi__heap_free(root);
  const dvi__node zero = dvi__constant(c->graph, 0);
  for (int i = 0; i < count; i++) {
    rate[i] = zero;
    if (used[i] && !rule(c, i, span, axis, &rate[i])) return false;
  }
  return true;
}

dvi__value dvi__chain_rule(dvi__context *c, dvi__value value, dvi__span span, dvi__input_rule *rule,
                           int axis)
{
  const int count = c->input_count;
  char *used = dvi__heap_take((size_t)count + 1, 1);
  dvi__node *rate = dvi__heap_take((size_t)count + 1, sizeof *rate);
  dvi__value result = dvi__value_make(c, value.shape.rank, value.shape.rows, value.shape.columns);
  if (used == NULL || rate == NULL) result = dvi__refused(dvi__scene_no_memory(c->scene));
  if (!dvi__failed(result) && !input_rates(c, value, span, count, rule, axis, used, rate))
    result = DVI__NO_VALUE;
  if (!dvi__failed(result) && result.shape.rank == 0)
    dvi__rates(c->graph, 1, &value.one, count, rate, &result.one);
  if (!dvi__failed(result) && result.shape.rank > 0)
    dvi__rates(c->graph, dvi__value_size(value), value.node, count, rate, result.node);
  dvi__heap_free(used);
  dvi__heap_free(rate);
  return result;
}

/* Find the momentum, or in Lagrangians the rate, of every number of a value. Returns false if one
 * is no coordinate, or has none of its own. */
static bool find_siblings(dvi__context *c, dvi__value value, dvi__value *result)
{
  const int size = dvi__value_size(value),
            of_state = (c->may & (DVI__MENTIONS_P | DVI__OF_STATE)) != 0 &&
                       dvi__has_factors(c->scene);
  *result = dvi__value_make(c, value.shape.rank, value.shape.rows, value.shape.columns);
  for (int i = 0; i < size && !dvi__failed(*result); i++) {
    const dvi__graph_node *node = &c->graph->node[dvi__value_at(value, i)];
    if (node->op != DVI__OP_INPUT || c->input[node->a].is_data ||
        c->input[node->a].block != DVI__COORDINATES || is_position(c, &c->input[node->a]))
      return false;
    dvi__node *to = result->node == NULL ? &result->one : &result->node[i];
    const int input = node->a;
    if (of_state && !dvi__input_momentum(c, input, to)) return false;
    if (!of_state) *to = dvi__sibling_node(c, input, DVI__VELOCITIES);
  }
  return true;
}

dvi__value dvi__rate_value(dvi__context *c, const dvi__expression *e)
{
  dvi__value result;
  if (e->part[0]->form == DVI__FORM_RATE)
    return dvi__refused(
        dvi__refuse(c, e->span, "the rate of a rate: there are no accelerations here"));
  if (!dvi__check_mention(c, DVI__MENTIONS_V, e->span)) return DVI__NO_VALUE;
  const dvi__value value = dvi__elaborate(c, e->part[0]);
  if (dvi__failed(value)) return DVI__NO_VALUE;
  if ((c->may & DVI__MENTIONS_P) == 0 && find_siblings(c, value, &result)) return result;
  return dvi__chain_rule(c, value, e->span, input_rate, 0);
}

dvi__value dvi__momentum_value(dvi__context *c, const dvi__expression *e)
{
  dvi__value result;
  if (!dvi__check_mention(c, DVI__MENTIONS_P, e->span)) return DVI__NO_VALUE;
  result = dvi__whole_momentum(c, e);
  if (!dvi__failed(result) || c->scene->complaint->status != DVI_OK) return result;
  const dvi__value value = dvi__elaborate(c, e->part[0]);
  if (dvi__failed(value)) return DVI__NO_VALUE;
  if (find_siblings(c, value, &result)) return result;
  return dvi__refused(dvi__refuse(c, e->part[0]->span, "p is taken of a coordinate"));
}
