/* Elaboration from syntax to graphs, for operators, calls, lists and sums. Names are in access.c,
 * rates in rates.c, arithmetic in shape.c. */
#include "scene/elaborate/elaborate.h"

#include <dvi/number.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "text/heap.h"

enum { DEPTH_MAX = 512 };
static const long work_max = 10000000;

bool(dvi__refuse)(const dvi__context *c, dvi__span span, const char *format, ...)
{
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  (void)dvi_number_vprint(text, sizeof text, format, arguments);
  va_end(arguments);
  return dvi__complain(c->scene->complaint, DVI_BAD_FILE, span, "%s", text);
}

bool dvi__check_mention(const dvi__context *c, unsigned mentions, dvi__span span)
{
  const char *what = mentions == DVI__MENTIONS_Q   ? "coordinates"
                     : mentions == DVI__MENTIONS_V ? "velocities"
                     : mentions == DVI__MENTIONS_P ? "momenta"
                     : mentions == DVI__MENTIONS_U ? "controls"
                                                   : "the time";
  return (c->may & mentions) != 0 || dvi__refuse(c, span, "%s cannot stand in %s", what, c->where);
}

/* ---- calls, lists, sums ---- */

/* Return 1 for omega(R) and rate(u). */
static int is_velocity(const dvi__expression *call)
{
  return strcmp(call->name, "omega") == 0 || strcmp(call->name, "rate") == 0;
}

static dvi__value call_value(dvi__context *c, const dvi__expression *e)
{
  if (strcmp(e->name, "p") == 0) return dvi__momentum_value(c, e);
  if (dvi__is_word_of_field(c, e)) return dvi__field_word_value(c, e);
  if (is_velocity(e)) return dvi__velocity_value(c, e);
  dvi__value *argument = dvi__arena_take(&c->scene->arena, (size_t)e->count + 1, sizeof *argument);
  if (argument == NULL) return dvi__refused(dvi__scene_no_memory(c->scene));
  for (int k = 0; k < e->count; k++) {
    argument[k] = dvi__elaborate(c, e->part[k]);
    if (dvi__failed(argument[k])) return DVI__NO_VALUE;
  }
  c->graph->here = e->span;
  return dvi__value_call(c, e, argument);
}

static dvi__value list_value(dvi__context *c, const dvi__expression *e)
{
  dvi__value list = DVI__NO_VALUE;
  for (int i = 0; i < e->count; i++) {
    const dvi__value row = dvi__elaborate(c, e->part[i]);
    if (dvi__failed(row)) return row;
    const int size = dvi__value_size(row);
    if (i == 0)
      list = dvi__value_make(c, row.shape.rank + 1, e->count,
                             row.shape.rank == 0 ? 1 : row.shape.rows);
    if (dvi__failed(list)) return list;
    if (row.shape.rank + 1 != list.shape.rank || size != list.shape.columns || row.shape.rank > 1)
      return dvi__refused(
          dvi__refuse(c, e->part[i]->span, "a list holds numbers, or vectors of one size"));
    for (int k = 0; k < size; k++) list.node[i * size + k] = dvi__value_at(row, k);
  }
  if (e->count == 0) return dvi__refused(dvi__refuse(c, e->span, "the list is empty"));
  return list;
}

/* Add the body for one choice of the indices. */
static bool add_body(dvi__context *c, const dvi__expression *e, int first, int second,
                     dvi__value *total)
{
  const int base = c->index_count - (e->name2 != NULL ? 2 : 1);
  c->index[base].all = first;
  if (e->name2 != NULL) c->index[base + 1].all = second;
  const dvi__value next = dvi__elaborate(c, e->part[0]);
  if (dvi__failed(next)) return false;
  *total = dvi__failed(*total) ? next : dvi__value_add(c, DVI__OP_ADD, *total, next, e->span);
  return !dvi__failed(*total);
}

/* Elaborate a sum inside of something, term for term. */
static dvi__value sum_value(dvi__context *c, const dvi__expression *e)
{
  dvi__bounds bounds;
  const int bound = c->index_count;
  if (!dvi__sum_bounds(c, e, &bounds)) return DVI__NO_VALUE;
  const int uneven = bounds.first != NULL || bounds.last != NULL;
  dvi__heap_free(bounds.first);
  dvi__heap_free(bounds.last);
  if (uneven) {
    c->uneven = 1;
    return DVI__NO_VALUE;
  }
  if (!dvi__index_bind(c, e->span, e->name) ||
      (e->name2 != NULL && !dvi__index_bind(c, e->span, e->name2)))
    return DVI__NO_VALUE;
  const int first = bounds.all_first, last = bounds.all_last;
  dvi__value total = DVI__NO_VALUE;
  bool good = true;
  for (int i = first; i <= last && good; i++) {
    if (c->sample && i > first && i < last) continue;
    if (e->name2 == NULL) good = add_body(c, e, i, 0, &total);
    for (int j = i + 1; e->name2 != NULL && j <= last && good; j++)
      if (!c->sample || j == i + 1 || j == last) good = add_body(c, e, i, j, &total);
  }
  c->index_count = bound;
  if (!good) return DVI__NO_VALUE;
  return dvi__failed(total) ? dvi__number_value(dvi__constant(c->graph, 0)) : total;
}

/* ---- operators ---- */

static int is_chain(dvi__form form)
{
  return form >= DVI__FORM_ADD && form <= DVI__FORM_DIVIDE;
}

static int same_chain(dvi__form a, dvi__form b)
{
  const int a_adds = a == DVI__FORM_ADD || a == DVI__FORM_SUBTRACT,
            b_adds = b == DVI__FORM_ADD || b == DVI__FORM_SUBTRACT;
  return is_chain(a) && is_chain(b) && a_adds == b_adds;
}

const dvi__expression **dvi__spine(dvi_scene *scene, const dvi__expression *e, int *count)
{
  int length = 0;
  for (const dvi__expression *at = e; same_chain(at->form, e->form); at = at->part[0]) length++;
  const dvi__expression **spine = dvi__arena_take(&scene->arena, (size_t)length, sizeof *spine);
  *count = spine == NULL ? 0 : length;
  for (const dvi__expression *at = e; length > 0 && spine != NULL; at = at->part[0])
    spine[--length] = at;
  if (spine == NULL) (void)dvi__scene_no_memory(scene);
  return spine;
}

static dvi__value apply_operator(dvi__context *c, const dvi__expression *e, dvi__value a,
                                 dvi__value b)
{
  c->graph->here = e->span;
  switch (e->form) {
  case DVI__FORM_ADD: return dvi__value_add(c, DVI__OP_ADD, a, b, e->span);
  case DVI__FORM_SUBTRACT: return dvi__value_add(c, DVI__OP_SUBTRACT, a, b, e->span);
  case DVI__FORM_MULTIPLY: return dvi__value_multiply(c, a, b, e->span);
  case DVI__FORM_DIVIDE: return dvi__value_divide(c, a, b, e->span);
  default: return dvi__value_power(c, a, b, e->span);
  }
}

/* Elaborate a chain. It may be long but is not deep, so a loop takes the first operand and then one
 * operator after the other. */
static dvi__value chain_value(dvi__context *c, const dvi__expression *e)
{
  int count = 0;
  const dvi__expression **spine = dvi__spine(c->scene, e, &count);
  dvi__value value = count > 0 ? dvi__elaborate(c, spine[0]->part[0]) : DVI__NO_VALUE;
  for (int k = 0; k < count && !dvi__failed(value); k++) {
    const dvi__value next = dvi__elaborate(c, spine[k]->part[1]);
    value = dvi__failed(next) ? next : apply_operator(c, spine[k], value, next);
  }
  return value;
}

static dvi__value power_value(dvi__context *c, const dvi__expression *e)
{
  const dvi__value a = dvi__elaborate(c, e->part[0]);
  const dvi__value b = dvi__failed(a) ? a : dvi__elaborate(c, e->part[1]);
  return dvi__failed(b) ? b : apply_operator(c, e, a, b);
}

static dvi__value negative_value(dvi__context *c, const dvi__expression *e)
{
  const dvi__value a = dvi__elaborate(c, e->part[0]);
  c->graph->here = e->span;
  return dvi__failed(a) ? a : dvi__value_negate(c, a);
}

static dvi__value expression_value(dvi__context *c, const dvi__expression *e)
{
  switch (e->form) {
  case DVI__FORM_NUMBER: return dvi__number_value(dvi__constant(c->graph, e->number));
  case DVI__FORM_NAME: return dvi__name_value(c, e);
  case DVI__FORM_INDEX: return dvi__index_value(c, e);
  case DVI__FORM_MEMBER: return dvi__member_value(c, e);
  case DVI__FORM_RATE: return dvi__rate_value(c, e);
  case DVI__FORM_NEGATIVE: return negative_value(c, e);
  case DVI__FORM_POWER: return power_value(c, e);
  case DVI__FORM_CALL: return call_value(c, e);
  case DVI__FORM_LIST: return list_value(c, e);
  case DVI__FORM_SUM: return sum_value(c, e);
  case DVI__FORM_IF: return dvi__if_value(c, e);
  case DVI__FORM_COMPARE:
  case DVI__FORM_NOT:
  case DVI__FORM_AND:
  case DVI__FORM_OR:
    return dvi__refused(
        dvi__refuse(c, e->span, "a condition where a number is needed; write if(.., a, b)"));
  default: return chain_value(c, e);
  }
}

/* Return true if the graph took all nodes so far. */
static bool graph_has_room(const dvi__context *c, dvi__span span)
{
  if (c->graph->failed == DVI_OK) return true;
  if (c->graph->failed == DVI_NO_MEMORY) return dvi__scene_no_memory(c->scene);
  return dvi__complain(c->scene->complaint, DVI_BAD_SIZE, span,
                       "more than 2000000 parts of expressions, with all sums written out");
}

dvi__value dvi__elaborate(dvi__context *c, const dvi__expression *e)
{
  if (c->scene->complaint->status != DVI_OK) return DVI__NO_VALUE;
  if (++c->scene->work > work_max)
    return dvi__refused(
        dvi__complain(c->scene->complaint, DVI_BAD_SIZE, e->span,
                      "more than %ld parts of expressions, with all sums written out", work_max));
  if (c->depth == 0) c->whole = e->span;
  if (++c->depth > DEPTH_MAX)
    return dvi__refused(dvi__refuse(
        c, c->whole, "definitions of definitions, more than %d levels deep", DEPTH_MAX));
  c->graph->here = e->span;
  const dvi__value value = expression_value(c, e);
  c->depth--;
  return graph_has_room(c, e->span) ? value : DVI__NO_VALUE;
}

bool dvi__elaborate_number(dvi__context *c, const dvi__expression *e, dvi__node *node)
{
  char shape[48];
  const dvi__value value = dvi__elaborate(c, e);
  *node = value.one;
  if (dvi__failed(value)) return false;
  return value.shape.rank == 0 || dvi__refuse(c, e->span, "%s where a number is needed",
                                              dvi__shape_text(value.shape, shape, sizeof shape));
}

bool dvi__constants_of(dvi__context *c, const dvi__expression *e, dvi__value value, double *number)
{
  for (int i = 0; i < dvi__value_size(value); i++) {
    const dvi__node node = dvi__value_at(value, i);
    dvi__node bad = -1;
    if (dvi__is_constant(c->graph, node, &number[i]) && isfinite(number[i])) continue;
    if (dvi__evaluate(c->graph, NULL, 1, &node, &number[i], &bad) != DVI_OK)
      return dvi__scene_no_memory(c->scene);
    if (bad >= 0) return dvi__refuse(c, c->graph->node[bad].span, "this is not a finite number");
    if (!isfinite(number[i])) return dvi__refuse(c, e->span, "this is not a finite number");
  }
  return true;
}

/* ---- mentions ---- */

static unsigned name_mentions(const dvi_scene *scene, const char *text)
{
  if (strcmp(text, "t") == 0) return DVI__MENTIONS_T;
  const dvi__name *name = dvi__names_find(&scene->names, text);
  if (name == NULL || name->sort == DVI__PARAMETER) return 0;
  if (name->sort == DVI__CONTROL) return DVI__MENTIONS_U;
  return name->sort == DVI__COORDINATE ? DVI__MENTIONS_Q : scene->definition[name->number].mentions;
}

unsigned dvi__mentions(const dvi_scene *scene, const dvi__expression *e)
{
  unsigned mentions = 0;
  for (; e != NULL; e = e->count > 0 ? e->part[0] : NULL) {
    if (e->form == DVI__FORM_NAME) mentions |= name_mentions(scene, e->name);
    if (e->form == DVI__FORM_RATE || (e->form == DVI__FORM_CALL && is_velocity(e)))
      mentions |= DVI__MENTIONS_V;
    if (e->form == DVI__FORM_SUM) mentions |= DVI__MENTIONS_SUM;
    if (e->form == DVI__FORM_CALL && strcmp(e->name, "p") == 0) mentions |= DVI__MENTIONS_P;
    for (int k = 1; k < e->count; k++) mentions |= dvi__mentions(scene, e->part[k]);
  }
  return mentions;
}
