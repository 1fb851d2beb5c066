/* Elaboration of names and of their elements. */
#include <stdio.h>
#include <string.h>

#include "scene/elaborate/elaborate.h"
#include "text/heap.h"
#include "scene/elaborate/words.h"

/* ---- names ---- */

static bool is_function(const char *name)
{
  int k = 0;
  while (k < dvi__word_count() && strcmp(dvi__word(k), name) != 0) k++;
  return k < dvi__word_count();
}

/* Tell if a name is written as u_x for a derivative of the field u. */
static bool is_subscript(const dvi__context *c, const char *name)
{
  const dvi__jets *jets = c->scene->jets;
  const char *axis = strrchr(name, '_');
  for (int d = 0; jets != NULL && axis != NULL && d < jets->dimension; d++)
    if (axis > name && strcmp(axis + 1, jets->axis[d]) == 0) return true;
  return false;
}

/* Tell if a name is written as u_t for the rate of the field u. */
static bool is_rate(const dvi__context *c, const char *name)
{
  const size_t length = strlen(name);
  return c->scene->jets != NULL && length > 2 && strcmp(name + length - 2, "_t") == 0;
}

/* Complain of a name that is unknown, or not known yet. Expressions of parameters alone are read
 * before there are coordinates and definitions. */
static dvi__value refuse_unknown_name(dvi__context *c, const dvi__expression *e)
{
  static const char *const section[] = {"parameters", "coordinates", "definitions"};
  const bool there[] = {true, c->scene->coordinate != NULL, c->scene->definition != NULL};
  if (is_function(e->name))
    return dvi__refused(
        dvi__refuse(c, e->span, "'%s' is a function; write %s(..)", e->name, e->name));
  if (is_subscript(c, e->name))
    return dvi__refused(dvi__refuse(c, e->span, "there is no '%s'; a derivative is d(%.*s,%s)",
                                    e->name, (int)(strrchr(e->name, '_') - e->name), e->name,
                                    strrchr(e->name, '_') + 1));
  if (is_rate(c, e->name))
    return dvi__refused(dvi__refuse(c, e->span, "there is no '%s'; a rate is %.*s'", e->name,
                                    (int)strlen(e->name) - 2, e->name));
  for (int k = 0; k < 3; k++) {
    const dvi__tree *names = dvi__tree_find(c->scene->tree, section[k]);
    if (names == NULL || names->kind != DVI__MAPPING || dvi__tree_find(names, e->name) == NULL)
      continue;
    if (!there[k])
      return dvi__refused(dvi__refuse(c, e->span, "%s cannot stand in %s", section[k], c->where));
    return dvi__refused(
        dvi__refuse(c, e->span, "'%s' cannot stand in %s: it is not known yet, for it comes later",
                    e->name, c->where));
  }
  return dvi__refused(dvi__names_unknown(&c->scene->names, &c->scene->arena, c->scene->complaint,
                                         e->name, e->span));
}

static dvi__value index_number(dvi__context *c, const dvi__index *index)
{
  if (index->each == NULL) return dvi__number_value(dvi__constant(c->graph, index->all));
  double *row = dvi__heap_take((size_t)c->elements, sizeof *row);
  if (row == NULL) return dvi__refused(dvi__scene_no_memory(c->scene));
  for (int e = 0; e < c->elements; e++) row[e] = index->each[e];
  const dvi__value value = dvi__number_value(dvi__data_node(c, row));
  dvi__heap_free(row);
  return value;
}

/* Return a parameter as a variable, or as the expression of the parameters that it is made of. */
static dvi__value varied_parameter(dvi__context *c, dvi__parameter *p)
{
  if (!dvi__note_parameter(c->scene, p)) return DVI__NO_VALUE;
  if (p->source != NULL && p->is != NULL) return dvi__elaborate(c, p->is);
  const int number = c->scene->control_count + (int)(p - c->scene->parameter);
  return dvi__number_value(dvi__variable_node(c, DVI__INPUTS, (dvi__numbering){.base = number}, 0));
}

/* Tell whether a parameter is a variable here, a number or made of others. */
static bool is_varied(const dvi__context *c, const dvi__parameter *p)
{
  return (c->may & DVI__OF_PARAMETERS) != 0 &&
         (p->shape.rank == 0 || (p->source != NULL && p->is != NULL));
}

static dvi__value parameter_value(dvi__context *c, dvi__parameter *p)
{
  if (is_varied(c, p)) return varied_parameter(c, p);
  if (!dvi__note_parameter(c->scene, p)) return DVI__NO_VALUE;
  dvi__value value = dvi__value_make(c, p->shape.rank, p->shape.rows, p->shape.columns);
  if (dvi__failed(value)) return value;
  if (p->shape.rank == 0) return dvi__number_value(dvi__constant(c->graph, p->value[0]));
  for (int i = 0; i < dvi__value_size(value); i++)
    value.node[i] = dvi__constant(c->graph, p->value[i]);
  return value;
}

/* Compute an index for every element, between 1 and `count`. */
static bool element_index(const dvi__context *c, const dvi__expression *e, int count, int **each,
                          int *all);

/* Find the member, from 1, that two indices name. Sets *each, freed by the caller, if it differs
 * from element to element, or else *all. */
static bool member_of_two(const dvi__context *c, const dvi__coordinate *x,
                          const dvi__subscripts *index, int **each, int *all)
{
  int *row = NULL, *column = NULL, all_row = 1, all_column = 1;
  bool good = element_index(c, index->of[0], dvi__extent(x, 0), &row, &all_row) &&
              element_index(c, index->of[1], dvi__extent(x, 1), &column, &all_column);
  *all = (all_row - 1) * x->columns + all_column;
  *each = NULL;
  if (good && (row != NULL || column != NULL)) {
    *each = dvi__heap_take((size_t)c->elements, sizeof **each);
    good = *each != NULL || dvi__scene_no_memory(c->scene);
    for (int e = 0; *each != NULL && e < c->elements; e++)
      (*each)[e] = ((row != NULL ? row[e] : all_row) - 1) * x->columns +
                   (column != NULL ? column[e] : all_column);
  }
  dvi__heap_free(row);
  dvi__heap_free(column);
  return good;
}

/* Replace members, from 1, by their first numbers. */
static void look_up(const dvi__context *c, const dvi__slots *places, int *each, int *all)
{
  for (int e = 0; each != NULL && e < c->elements; e++)
    each[e] = dvi__slots_at(places, each[e] - 1);
  if (each == NULL) *all = dvi__slots_at(places, *all - 1);
}

bool dvi__member_numbering(dvi__context *c, const dvi__coordinate *x, const dvi__subscripts *index,
                           const dvi__slots *places, dvi__numbering *numbering)
{
  int *each = NULL, all = 1;
  const bool good = index->count == 0   ? true
                    : index->count == 1 ? element_index(c, index->of[0], x->size, &each, &all)
                                        : member_of_two(c, x, index, &each, &all);
  if (good) look_up(c, places, each, &all);
  const bool made = good && dvi__numbering_of(c, each, all, 0, 1, numbering);
  dvi__heap_free(each);
  return made;
}

dvi__value dvi__coordinate_value(dvi__context *c, const dvi__coordinate *x,
                                 const dvi__subscripts *index, dvi__span span)
{
  dvi__numbering numbering;
  if (!dvi__check_mention(c, DVI__MENTIONS_Q, index->count > 0 ? index->of[0]->span : span))
    return DVI__NO_VALUE;
  if (x->kind == DVI__MOTION)
    return dvi__refused(
        dvi__refuse(c, span, "%s is a rigid motion; take its rotation, %s.R, or its place, %s.x",
                    x->name, x->name, x->name));
  if (!dvi__member_numbering(c, x, index, &x->q, &numbering)) return DVI__NO_VALUE;
  dvi__value value = dvi__value_make(c, x->shape.rank, x->shape.rows, x->shape.columns);
  if (dvi__failed(value)) return value;
  if (x->shape.rank == 0)
    return dvi__number_value(dvi__variable_node(c, DVI__COORDINATES, numbering, 0));
  for (int i = 0; i < dvi__value_size(value); i++)
    value.node[i] = dvi__variable_node(c, DVI__COORDINATES, numbering, i);
  return value;
}

/* Return the value of a definition. It is elaborated once in a context, without the indices around
 * its use. */
static dvi__value definition_value(dvi__context *c, int number)
{
  if (c->definition[number].shape.rank >= 0) return c->definition[number];
  const int seen = c->index_first;
  c->index_first = c->index_count;
  const dvi__value value = dvi__elaborate(c, c->scene->definition[number].is);
  c->index_first = seen;
  if (!dvi__failed(value)) c->definition[number] = value;
  return value;
}

dvi__value dvi__name_value(dvi__context *c, const dvi__expression *e)
{
  const dvi__index *index = dvi__index_find(c, e->name);
  if (index != NULL) return index_number(c, index);
  if (strcmp(e->name, "pi") == 0)
    return dvi__number_value(dvi__constant(c->graph, 3.14159265358979323846));
  if (strcmp(e->name, "t") == 0) {
    if (!dvi__check_mention(c, DVI__MENTIONS_T, e->span)) return DVI__NO_VALUE;
    return dvi__number_value(dvi__variable_node(c, DVI__TIME, (dvi__numbering){0}, 0));
  }
  const dvi__name *name = dvi__names_find(&c->scene->names, e->name);
  if (name == NULL) return refuse_unknown_name(c, e);
  if (name->sort == DVI__PARAMETER) return parameter_value(c, &c->scene->parameter[name->number]);
  if (name->sort == DVI__DEFINITION) {
    c->scene->definition[name->number].used = 1;
    return definition_value(c, name->number);
  }
  if (name->sort == DVI__CONTROL) {
    if (!dvi__check_mention(c, DVI__MENTIONS_U, e->span)) return DVI__NO_VALUE;
    return dvi__number_value(
        dvi__variable_node(c, DVI__INPUTS, (dvi__numbering){.base = name->number}, 0));
  }
  const dvi__coordinate *x = &c->scene->coordinate[name->number];
  if (!dvi__check_mention(c, DVI__MENTIONS_Q, e->span)) return DVI__NO_VALUE;
  if (x->family > 0) return dvi__refused(dvi__refuse_family(c, x, "", e->span));
  return dvi__coordinate_value(c, x, &(dvi__subscripts){0}, e->span);
}

/* ---- indices ---- */

/* Write the values of the indices around an element, as ", where i = 3, j = 4". */
static const char *write_index_values(const dvi__context *c, int element_number, char *text,
                                      size_t size)
{
  size_t used = 0;
  text[0] = '\0';
  for (int i = c->index_first; i < c->index_count && used < size; i++) {
    const dvi__index *index = &c->index[i];
    used += (size_t)snprintf(text + used, size - used, "%s%s = %d",
                             i == c->index_first ? ", where " : ", ", index->name,
                             index->each != NULL ? index->each[element_number] : index->all);
  }
  return text;
}

static bool element_index(const dvi__context *c, const dvi__expression *e, int count, int **each,
                          int *all)
{
  char text[120];
  const dvi__index *index = e->form == DVI__FORM_NAME ? dvi__index_find(c, e->name) : NULL;
  *each = NULL;
  if (index != NULL && index->each != NULL) {
    *each = dvi__heap_take((size_t)c->elements, sizeof **each);
    if (*each == NULL) return dvi__scene_no_memory(c->scene);
    memcpy(*each, index->each, (size_t)c->elements * sizeof **each);
  } else if (index != NULL)
    *all = index->all;
  else if (!dvi__whole_numbers_of(c, e, "an index", each, all))
    return false;
  for (int k = 0; k < c->elements; k++) {
    const int i = *each != NULL ? (*each)[k] : *all;
    if (i >= 1 && i <= count) continue;
    dvi__heap_free(*each);
    *each = NULL;
    return dvi__refuse(c, e->span, "the index %d is not between 1 and %d%s", i, count,
                       write_index_values(c, k, text, sizeof text));
  }
  return true;
}

/* Return one number of a list for every element, value[position + shift]. */
static dvi__node list_number(dvi__context *c, const double *value, const int *position, int shift)
{
  double *row = dvi__heap_take((size_t)c->elements, sizeof *row);
  if (row == NULL) {
    (void)dvi__scene_no_memory(c->scene);
    return dvi__constant(c->graph, 0);
  }
  int even = 1;
  for (int e = 0; e < c->elements; e++) {
    row[e] = value[position[e] + shift];
    even = even && !(row[e] < row[0]) && !(row[e] > row[0]);
  }
  const dvi__node node = even ? dvi__constant(c->graph, row[0]) : dvi__data_node(c, row);
  dvi__heap_free(row);
  return node;
}

/* Compute the positions in a parameter for every element. A matrix is numbered row by row, and a
 * row has the position of its first number. */
static bool find_positions(const dvi__context *c, const dvi__parameter *p, int count,
                           const dvi__expression *const *index, int *position)
{
  for (int k = 0; k < count; k++) {
    int *each = NULL, all = 0;
    if (!element_index(c, index[k], k == 0 ? p->shape.rows : p->shape.columns, &each, &all))
      return false;
    const int stride = k == 0 && p->shape.rank == 2 ? p->shape.columns : 1;
    for (int e = 0; e < c->elements; e++)
      position[e] += ((each != NULL ? each[e] : all) - 1) * stride;
    dvi__heap_free(each);
  }
  return true;
}

/* Return a number of a list, or a row of a matrix. */
static dvi__value parameter_element(dvi__context *c, dvi__parameter *p, int count,
                                    const dvi__expression *const *index, dvi__span span)
{
  const int rest = p->shape.rank - count;
  if (!dvi__note_parameter(c->scene, p)) return DVI__NO_VALUE;
  if (rest < 0)
    return dvi__refused(dvi__refuse(c, span, "%s has %d ind%s, not %d", p->name, p->shape.rank,
                                    p->shape.rank == 1 ? "ex" : "ices", count));
  int *position = dvi__heap_take((size_t)c->elements, sizeof *position);
  if (position == NULL) return dvi__refused(dvi__scene_no_memory(c->scene));
  dvi__value value = find_positions(c, p, count, index, position)
                         ? dvi__value_make(c, rest, rest == 0 ? 1 : p->shape.columns, 1)
                         : DVI__NO_VALUE;
  if (!dvi__failed(value) && rest == 0) value.one = list_number(c, p->value, position, 0);
  for (int k = 0; value.node != NULL && k < value.shape.rows; k++)
    value.node[k] = list_number(c, p->value, position, k);
  dvi__heap_free(position);
  return value;
}

/* Return elements of a value. The indices must be the same for all elements. */
static dvi__value part_of_value(dvi__context *c, dvi__value value, int count,
                                const dvi__expression *const *index, dvi__span span)
{
  char shape[48];
  for (int k = 0; k < count && !dvi__failed(value); k++) {
    int *each = NULL, i = 0;
    if (value.shape.rank == 0)
      return dvi__refused(dvi__refuse(c, span, "%s has no elements",
                                      dvi__shape_text(value.shape, shape, sizeof shape)));
    if (!element_index(c, index[k], value.shape.rows, &each, &i)) return DVI__NO_VALUE;
    if (each != NULL) {
      dvi__heap_free(each);
      c->uneven = 1;
      return DVI__NO_VALUE;
    }
    if (value.shape.rank == 1)
      value = dvi__number_value(value.node[i - 1]);
    else
      value = (dvi__value){.shape = {1, value.shape.columns, 1},
                           .node = value.node + (i - 1) * value.shape.columns};
  }
  return value;
}

enum { INDICES_OF_ONE = 4 };

/* Return a member of a family, or an element of a member. The family's indices come first. */
static dvi__value family_element(dvi__context *c, const dvi__coordinate *x, int count,
                                 const dvi__expression *const *index, dvi__span span)
{
  if (count < x->family) return dvi__refused(dvi__refuse_family(c, x, "", span));
  const dvi__subscripts own = {x->family, {index[0], x->family > 1 ? index[1] : NULL}};
  const dvi__value member = dvi__coordinate_value(c, x, &own, span);
  return dvi__failed(member) ? member
                             : part_of_value(c, member, count - x->family, index + x->family, span);
}

dvi__value dvi__index_value(dvi__context *c, const dvi__expression *e)
{
  const dvi__expression *index[INDICES_OF_ONE] = {e, e, e, e}, *base = e;
  int count = 0;
  for (; base->form == DVI__FORM_INDEX; base = base->part[0]) {
    if (count + base->count - 1 > INDICES_OF_ONE)
      return dvi__refused(dvi__refuse(c, e->span, "more than %d indices", INDICES_OF_ONE));
    memmove(index + base->count - 1, index, (size_t)count * sizeof *index);
    for (int k = 1; k < base->count; k++) index[k - 1] = base->part[k];
    count += base->count - 1;
  }
  const dvi__name *name = base->form == DVI__FORM_NAME
                              ? dvi__names_find(&c->scene->names, base->name)
                              : NULL;
  dvi__parameter *list = name != NULL && name->sort == DVI__PARAMETER
                             ? &c->scene->parameter[name->number]
                             : NULL;
  if (list != NULL && !is_varied(c, list)) return parameter_element(c, list, count, index, e->span);
  if (name != NULL && name->sort == DVI__COORDINATE &&
      c->scene->coordinate[name->number].family > 0)
    return family_element(c, &c->scene->coordinate[name->number], count, index, e->span);
  const dvi__value value = dvi__elaborate(c, base);
  return dvi__failed(value) ? value : part_of_value(c, value, count, index, e->span);
}
