/* Kernels of an expression. It is taken apart into sums, through + and -, definitions, and products
 * by factors without coordinates.
 *
 * This gives leaves, each in the group of the sums around it. A group becomes one kernel, whose
 * elements are the values that the indices of these sums take. */
#include "scene/elaborate/kernels.h"

#include <string.h>

#include "text/heap.h"

enum { LEAVES_MAX = 100000, LEVELS_MAX = 512 };
static const long elements_max = 200000000;

/* A factor or divisor of a leaf, with so many indices in sight. `next` is the next one further
 * out. */
typedef struct factor {
  const dvi__expression *is;
  int divides, indices;
  const struct factor *next;
} factor;

typedef struct leaf {
  const dvi__expression *is;
  const factor *factor;
  int negative;
  struct leaf *next;
} leaf;

typedef struct group {
  struct group *around;       /* the sum outside, or NULL */
  const dvi__expression *sum; /* NULL if there is no sum */
  int indices;
  leaf *first, *last;
  struct group *next;
} group;

typedef struct walk {
  dvi_scene *scene;
  group *first, *last;
  int leaves, level;
} walk;

typedef struct place {
  group *group;
  int negative;
  const factor *factor;
} place;

static bool gather_leaves(walk *w, const dvi__expression *e, place at);

/* ---- decomposition ---- */

static group *group_of(walk *w, group *around, const dvi__expression *sum)
{
  for (group *g = w->first; g != NULL; g = g->next)
    if (g->around == around && g->sum == sum) return g;
  group *made = dvi__arena_take(&w->scene->arena, 1, sizeof *made);
  if (made == NULL) {
    (void)dvi__scene_no_memory(w->scene);
    return NULL;
  }
  made->around = around;
  made->sum = sum;
  if (around != NULL) made->indices = around->indices + (sum->name2 != NULL ? 2 : 1);
  if (w->last != NULL)
    w->last->next = made;
  else
    w->first = made;
  w->last = made;
  return made;
}

static bool add_leaf(walk *w, const dvi__expression *e, place at)
{
  leaf *made = dvi__arena_take(&w->scene->arena, 1, sizeof *made);
  if (made == NULL) return dvi__scene_no_memory(w->scene);
  if (++w->leaves > LEAVES_MAX)
    return dvi__complain(w->scene->complaint, DVI_BAD_SIZE, e->span, "more than %d added terms",
                         LEAVES_MAX);
  *made = (leaf){.is = e, .factor = at.factor, .negative = at.negative};
  if (at.group->last != NULL)
    at.group->last->next = made;
  else
    at.group->first = made;
  at.group->last = made;
  return true;
}

static bool gather_sum(walk *w, const dvi__expression *e, place at)
{
  int count = 0;
  const dvi__expression **spine = dvi__spine(w->scene, e, &count);
  bool good = count > 0 && gather_leaves(w, spine[0]->part[0], at);
  for (int k = 0; k < count && good; k++) {
    place next = at;
    if (spine[k]->form == DVI__FORM_SUBTRACT) next.negative = !at.negative;
    good = gather_leaves(w, spine[k]->part[1], next);
  }
  return good;
}

/* Return operand k of a chain of products, and set whether it divides. */
static const dvi__expression *chain_operand(const dvi__expression *const *spine, int k,
                                            int *divides)
{
  *divides = k > 0 && spine[k - 1]->form == DVI__FORM_DIVIDE;
  return k == 0 ? spine[0]->part[0] : spine[k - 1]->part[1];
}

/* Take apart a product of one sum and of factors without coordinates. Any other product is a
 * leaf. */
static bool gather_product(walk *w, const dvi__expression *e, place at)
{
  int count = 0, sums = 0, fits = 1, divides;
  const dvi__expression **spine = dvi__spine(w->scene, e, &count), *sum = NULL;
  if (count == 0) return false;
  const factor *outside = at.factor, *last = NULL;
  for (int k = count; k >= 0; k--) {
    const dvi__expression *is = chain_operand(spine, k, &divides);
    const unsigned mentions = dvi__mentions(w->scene, is);
    if ((mentions & DVI__MENTIONS_SUM) != 0) {
      sums++;
      sum = is;
      fits = fits && !divides;
      continue;
    }
    fits = fits && (mentions &
                    (DVI__MENTIONS_Q | DVI__MENTIONS_V | DVI__MENTIONS_P | DVI__MENTIONS_U)) == 0;
    factor *made = dvi__arena_take(&w->scene->arena, 1, sizeof *made);
    if (made == NULL) return dvi__scene_no_memory(w->scene);
    *made = (factor){is, divides, at.group->indices, last != NULL ? last : outside};
    last = made;
  }
  if (!fits || sums != 1) return add_leaf(w, e, at);
  if (last != NULL) at.factor = last;
  return gather_leaves(w, sum, at);
}

static bool gather_form(walk *w, const dvi__expression *e, place at)
{
  if (e->form == DVI__FORM_ADD || e->form == DVI__FORM_SUBTRACT) return gather_sum(w, e, at);
  if (e->form == DVI__FORM_MULTIPLY || e->form == DVI__FORM_DIVIDE) return gather_product(w, e, at);
  if (e->form == DVI__FORM_NEGATIVE) {
    at.negative = !at.negative;
    return gather_leaves(w, e->part[0], at);
  }
  if (e->form == DVI__FORM_SUM) {
    at.group = group_of(w, at.group, e);
    return at.group != NULL && gather_leaves(w, e->part[0], at);
  }
  const dvi__name *name = e->form == DVI__FORM_NAME ? dvi__names_find(&w->scene->names, e->name)
                                                    : NULL;
  if (name != NULL && name->sort == DVI__DEFINITION && at.group->sum == NULL) {
    w->scene->definition[name->number].used = 1;
    return gather_leaves(w, w->scene->definition[name->number].is, at);
  }
  return add_leaf(w, e, at);
}

static bool gather_leaves(walk *w, const dvi__expression *e, place at)
{
  if ((dvi__mentions(w->scene, e) & DVI__MENTIONS_SUM) == 0 || w->level == LEVELS_MAX)
    return add_leaf(w, e, at);
  w->level++;
  const bool good = gather_form(w, e, at);
  w->level--;
  return good;
}

/* ---- elements ---- */

static long run_length(const dvi__bounds *bounds, int e)
{
  const int first = bounds->first != NULL ? bounds->first[e] : bounds->all_first;
  const int last = bounds->last != NULL ? bounds->last[e] : bounds->all_last;
  return last < first ? 0 : (long)last - first + 1;
}

static long count_choices(const dvi__bounds *bounds, int pairs, int e)
{
  const long length = run_length(bounds, e);
  if (pairs && length > 100000) return elements_max + 1;
  return pairs ? length * (length - 1) / 2 : length;
}

/* Fill in the values of the new index, or of two. */
static void fill_new_index(const dvi__bounds *bounds, int elements, int *first_index,
                           int *second_index)
{
  for (int e = 0, k = 0; e < elements; e++) {
    const int first = bounds->first != NULL ? bounds->first[e] : bounds->all_first;
    const int last = bounds->last != NULL ? bounds->last[e] : bounds->all_last;
    for (int i = first; i <= last; i++) {
      if (second_index == NULL) first_index[k++] = i;
      for (int j = i + 1; second_index != NULL && j <= last; j++, k++) {
        first_index[k] = i;
        second_index[k] = j;
      }
    }
  }
}

static bool widen_index(dvi__context *c, dvi__index *index, const dvi__bounds *bounds, int pairs,
                        long total)
{
  if (index->each == NULL) return true;
  int *wide = dvi__arena_take(&c->scene->arena, (size_t)total, sizeof *wide);
  if (wide == NULL) return dvi__scene_no_memory(c->scene);
  long k = 0;
  for (int e = 0; e < c->elements; e++)
    for (long m = count_choices(bounds, pairs, e); m > 0; m--) wide[k++] = index->each[e];
  index->each = wide;
  return true;
}

/* Make each element into as many as the sum has terms there. */
static bool widen_elements(dvi__context *c, const dvi__expression *sum, const dvi__bounds *bounds)
{
  const int pairs = sum->name2 != NULL, before = c->index_count;
  long total = 0;
  for (int e = 0; e < c->elements && total <= elements_max; e++)
    total += count_choices(bounds, pairs, e);
  if (total > elements_max)
    return dvi__complain(c->scene->complaint, DVI_BAD_SIZE, sum->span,
                         "a sum of more than %ld terms", elements_max);
  for (int i = 0; i < before; i++)
    if (!widen_index(c, &c->index[i], bounds, pairs, total)) return false;
  if (!dvi__index_bind(c, sum->span, sum->name) ||
      (pairs && !dvi__index_bind(c, sum->span, sum->name2)))
    return false;
  int *first = dvi__arena_take(&c->scene->arena, (size_t)total, sizeof *first);
  int *second = pairs ? dvi__arena_take(&c->scene->arena, (size_t)total, sizeof *second) : NULL;
  if (first == NULL || (pairs && second == NULL)) return dvi__scene_no_memory(c->scene);
  fill_new_index(bounds, c->elements, first, second);
  c->index[before].each = first;
  if (pairs) c->index[before + 1].each = second;
  c->elements = (int)total;
  return true;
}

/* Bind the indices of a group's sums, from the outer ones on. */
static bool bind_group(dvi__context *c, const group *g)
{
  const group *chain[DVI__INDICES_MAX];
  int depth = 0;
  for (; g->sum != NULL; g = g->around) {
    if (depth == DVI__INDICES_MAX)
      return dvi__refuse(c, g->sum->span, "more than %d sums in each other", DVI__INDICES_MAX);
    chain[depth++] = g;
  }
  bool good = true;
  while (depth > 0 && good && c->elements > 0) {
    dvi__bounds bounds;
    const dvi__expression *sum = chain[--depth]->sum;
    good = dvi__sum_bounds(c, sum, &bounds) && widen_elements(c, sum, &bounds);
    dvi__heap_free(bounds.first);
    dvi__heap_free(bounds.last);
  }
  for (int i = 0; i < c->index_count && c->elements == 1; i++) {
    if (c->index[i].each != NULL) c->index[i].all = c->index[i].each[0];
    c->index[i].each = NULL;
  }
  return good;
}

/* ---- kernels ---- */

/* Elaborate a leaf with its factors. */
static bool leaf_node(dvi__context *c, const leaf *l, dvi__node *node)
{
  const int indices = c->index_count;
  bool good = dvi__elaborate_number(c, l->is, node);
  for (const factor *f = l->factor; f != NULL && good; f = f->next) {
    dvi__node by;
    c->index_count = f->indices;
    good = dvi__elaborate_number(c, f->is, &by);
    c->graph->here = f->is->span;
    if (good)
      *node = f->divides ? dvi__apply(c->graph, DVI__OP_DIVIDE, *node, by)
                         : dvi__apply(c->graph, DVI__OP_MULTIPLY, by, *node);
  }
  c->index_count = indices;
  return good;
}

/* Add a group's leaves to a total. */
static bool add_leaves(dvi__context *c, const group *g, int negative, dvi__node *total)
{
  for (const leaf *l = g->first; l != NULL; l = l->next) {
    dvi__node node;
    if (!leaf_node(c, l, &node)) return false;
    c->graph->here = l->is->span;
    *total = dvi__apply(c->graph, l->negative != negative ? DVI__OP_SUBTRACT : DVI__OP_ADD, *total,
                        node);
  }
  return true;
}

/* Add a kernel of one element that holds all elements of a sum, written out. */
static bool write_out(const dvi__context *of, const group *g, int negative, const char *where,
                      dvi__kernels *list)
{
  dvi__context c;
  if (!dvi__context_make(&c, of->scene, of->may, where)) return false;
  dvi__node total = dvi__constant(c.graph, 0);
  bool good = true;
  c.index_count = of->index_count;
  memcpy(c.index, of->index, sizeof c.index);
  for (int e = 0; e < of->elements && good; e++) {
    for (int i = 0; i < c.index_count; i++) {
      if (of->index[i].each != NULL) c.index[i].all = of->index[i].each[e];
      c.index[i].each = NULL;
    }
    good = add_leaves(&c, g, negative, &total);
  }
  good = good && dvi__kernels_add_node(&c, total, list);
  dvi__context_free(&c);
  return good;
}

static bool add_group(dvi_scene *scene, unsigned may, const char *where, const group *g,
                      int negative, dvi__kernels *list)
{
  dvi__context c;
  if (g->first == NULL) return true;
  if (!dvi__context_make(&c, scene, may, where)) return false;
  bool good = bind_group(&c, g);
  if (good && c.elements > 0) {
    dvi__node total = dvi__constant(c.graph, 0);
    good = add_leaves(&c, g, negative, &total);
    if (good)
      good = dvi__kernels_add_node(&c, total, list);
    else if (c.uneven)
      good = write_out(&c, g, negative, where, list);
  }
  dvi__context_free(&c);
  return good;
}

bool dvi__kernels_add(dvi_scene *scene, unsigned may, const char *where, const dvi__expression *e,
                      int negative, dvi__kernels *list)
{
  walk w = {.scene = scene};
  group *outside = group_of(&w, NULL, NULL);
  bool good = outside != NULL && gather_leaves(&w, e, (place){.group = outside});
  if (may & DVI__OF_STATE) list->of_state = 1;
  for (const group *g = w.first; g != NULL && good; g = g->next)
    good = add_group(scene, may, where, g, negative, list);
  return good;
}

bool dvi__kernels_function(dvi_scene *scene, dvi__kernels *list, int count, dvi__scene_term **term)
{
  const int inputs = scene->control_count + scene->parameter_count;
  const int velocities = list->of_state ? scene->nv : scene->velocities;
  const int width[DVI__BLOCKS] = {1, scene->n, velocities, count, inputs};
  const dvi__blocks blocks = {DVI__BLOCKS, width, DVI__PAIRS, dvi__scene_pairs};
  dvi__scene_term *made = dvi__arena_take(&scene->arena, 1, sizeof *made);
  *term = made;
  if (made == NULL) return dvi__scene_no_memory(scene);
  const dvi_status status = dvi__function_create(list->count, list->kernel, &blocks,
                                                 &made->function);
  if (status != DVI_OK) return dvi__scene_no_memory(scene);
  dvi__heap_free(list->kernel);
  *list = (dvi__kernels){0};
  made->scene = scene;
  made->n = scene->n;
  made->count = count;
  made->none = scene->zeros;
  made->next = scene->functions;
  scene->functions = made;
  return true;
}
