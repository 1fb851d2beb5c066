/* Elaboration of if(condition, a, b). A condition is a node that is 1 or 0. If it is known when the
 * scene is read, its side is taken at once. The other side need not make sense then, as in if(n >
 * 1, x[2], 0). */
#include <string.h>

#include "scene/elaborate/elaborate.h"

/* Make the node of a comparison of a and b. As with doubles, a - b is 0 for equal numbers alone. */
static dvi__node comparison_node(dvi__graph *graph, const char *name, dvi__node a, dvi__node b)
{
  if (strcmp(name, "<") == 0) return dvi__greater(graph, b, a);
  if (strcmp(name, ">") == 0) return dvi__greater(graph, a, b);
  if (strcmp(name, "<=") == 0) return dvi__complement(graph, dvi__greater(graph, a, b));
  if (strcmp(name, ">=") == 0) return dvi__complement(graph, dvi__greater(graph, b, a));
  const dvi__node above = dvi__greater(graph, a, b), below = dvi__greater(graph, b, a);
  if (strcmp(name, "!=") == 0) return dvi__choice(graph, above, above, below);
  return dvi__both(graph, dvi__complement(graph, above), dvi__complement(graph, below));
}

static bool elaborate_condition(dvi__context *c, const dvi__expression *e, dvi__node *node);

static bool elaborate_comparison(dvi__context *c, const dvi__expression *e, dvi__node *node)
{
  dvi__node a, b;
  if (!dvi__elaborate_number(c, e->part[0], &a) || !dvi__elaborate_number(c, e->part[1], &b))
    return false;
  c->graph->here = e->span;
  *node = comparison_node(c->graph, e->name, a, b);
  return true;
}

/* Return true if a condition is known and is `value`. */
static bool condition_is_known(const dvi__context *c, dvi__node node, int value)
{
  double known;
  return dvi__is_constant(c->graph, node, &known) && (known > 0) == value;
}

/* Elaborate conditions joined by `and` or `or`, from the left, up to the first one that decides. */
static bool elaborate_joined(dvi__context *c, const dvi__expression *e, dvi__node *node)
{
  const int all = e->form == DVI__FORM_AND;
  if (!elaborate_condition(c, e->part[0], node)) return false;
  for (int k = 1; k < e->count && !condition_is_known(c, *node, !all); k++) {
    dvi__node next;
    if (!elaborate_condition(c, e->part[k], &next)) return false;
    c->graph->here = e->span;
    *node = all ? dvi__both(c->graph, *node, next)
                : dvi__choice(c->graph, *node, dvi__constant(c->graph, 1), next);
  }
  return true;
}

static bool elaborate_condition(dvi__context *c, const dvi__expression *e, dvi__node *node)
{
  switch (e->form) {
  case DVI__FORM_COMPARE: return elaborate_comparison(c, e, node);
  case DVI__FORM_AND:
  case DVI__FORM_OR: return elaborate_joined(c, e, node);
  case DVI__FORM_NOT:
    if (!elaborate_condition(c, e->part[0], node)) return false;
    c->graph->here = e->span;
    *node = dvi__complement(c->graph, *node);
    return true;
  default: return dvi__refuse(c, e->span, "a condition is needed here, as x < 0");
  }
}

/* Note the names in the side that is not taken, too. */
static bool note_names(dvi__context *c, const dvi__expression *e)
{
  bool good = true;
  for (; e != NULL && good; e = e->count > 0 ? e->part[0] : NULL) {
    const dvi__name *name = e->form == DVI__FORM_NAME ? dvi__names_find(&c->scene->names, e->name)
                                                      : NULL;
    if (name != NULL && name->sort == DVI__DEFINITION) c->scene->definition[name->number].used = 1;
    if (name != NULL && name->sort == DVI__PARAMETER)
      good = dvi__note_parameter(c->scene, &c->scene->parameter[name->number]);
    for (int k = 1; k < e->count && good; k++) good = note_names(c, e->part[k]);
  }
  return good;
}

/* Return a where the condition holds, b elsewhere, number by number. */
static dvi__value choose_value(dvi__context *c, const dvi__expression *e, dvi__node holds,
                               dvi__value a, dvi__value b)
{
  if (!dvi__same_shape(a.shape, b.shape)) {
    char first[48], second[48];
    return dvi__refused(dvi__refuse(c, e->span, "the two sides of if are %s and %s",
                                    dvi__shape_text(a.shape, first, sizeof first),
                                    dvi__shape_text(b.shape, second, sizeof second)));
  }
  if (a.shape.rank == 0) return dvi__number_value(dvi__choice(c->graph, holds, a.one, b.one));
  dvi__value result = dvi__value_make(c, a.shape.rank, a.shape.rows, a.shape.columns);
  for (int i = 0; !dvi__failed(result) && i < dvi__value_size(a); i++)
    result.node[i] = dvi__choice(c->graph, holds, a.node[i], b.node[i]);
  return result;
}

dvi__value dvi__if_value(dvi__context *c, const dvi__expression *e)
{
  dvi__node holds;
  if (!elaborate_condition(c, e->part[0], &holds)) return DVI__NO_VALUE;
  const bool yes = condition_is_known(c, holds, 1);
  if (yes || condition_is_known(c, holds, 0))
    return note_names(c, e->part[yes ? 2 : 1]) ? dvi__elaborate(c, e->part[yes ? 1 : 2])
                                               : DVI__NO_VALUE;
  const dvi__value a = dvi__elaborate(c, e->part[1]);
  const dvi__value b = dvi__failed(a) ? a : dvi__elaborate(c, e->part[2]);
  c->graph->here = e->span;
  return dvi__failed(b) ? b : choose_value(c, e, holds, a, b);
}
