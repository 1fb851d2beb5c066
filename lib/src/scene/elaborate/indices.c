/* Indices of sums, their ranges, and expressions of them. */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "scene/elaborate/context.h"
#include "text/heap.h"
#include "expr/compile/program.h"
#include "scene/elaborate/shape.h"
#include "scene/elaborate/words.h"

const dvi__index *dvi__index_find(const dvi__context *c, const char *name)
{
  for (int i = c->index_count - 1; i >= c->index_first; i--)
    if (strcmp(c->index[i].name, name) == 0) return &c->index[i];
  return NULL;
}

bool dvi__index_bind(dvi__context *c, dvi__span span, const char *name)
{
  const dvi__name *other = dvi__names_find(&c->scene->names, name);
  if (dvi__is_word(name))
    return dvi__refuse(c, span, "'%s' is a word of the language; choose another name", name);
  if (other != NULL)
    return dvi__refuse(c, span, "the index '%s' is a %s, too; choose another name", name,
                       dvi__sort_name(other->sort));
  if (dvi__index_find(c, name) != NULL)
    return dvi__refuse(c, span, "'%s' is an index around this sum already", name);
  if (c->index_count == DVI__INDICES_MAX)
    return dvi__refuse(c, span, "more than %d indices at a time", DVI__INDICES_MAX);
  c->index[c->index_count++] = (dvi__index){.name = name};
  return true;
}

/* ---- numbers for every element ---- */

/* Copy a row of data from an element on. Idle lanes at its end are filled. */
static void copy_row(const dvi__kernel_input *input, int first, int lanes, double *row)
{
  for (int k = 0; k < dvi__row_width(lanes); k++)
    row[k] = input->data[first + (k < lanes ? k : lanes - 1)];
}

/* Run a program over all elements. Its inputs are rows of data. */
static bool run_index_program(const dvi__context *c, const dvi__program *program, double *each)
{
  const size_t rows = (size_t)c->input_count + (size_t)program->row_count;
  const double **row = dvi__heap_take((size_t)c->input_count + 1, sizeof *row);
  double *numbers = dvi__heap_take(rows * DVI__LANES_MAX, sizeof *numbers);
  const bool made = row != NULL && numbers != NULL;
  double *registers = made ? numbers + (size_t)c->input_count * DVI__LANES_MAX : NULL;
  for (int first = 0; made && first < c->elements; first += DVI__LANES_MAX) {
    const int lanes = c->elements - first < DVI__LANES_MAX ? c->elements - first : DVI__LANES_MAX;
    for (int i = 0; i < c->input_count; i++) {
      copy_row(&c->input[i], first, lanes, numbers + (size_t)i * DVI__LANES_MAX);
      row[i] = numbers + (size_t)i * DVI__LANES_MAX;
    }
    dvi__program_run(program, lanes, row, registers);
    const double *out = registers +
                        (size_t)(program->row_count - 1) * (size_t)dvi__row_width(lanes);
    memcpy(each + first, out, (size_t)lanes * sizeof *each);
  }
  dvi__heap_free(row);
  dvi__heap_free(numbers);
  return made || dvi__scene_no_memory(c->scene);
}

/* Compute the node of every element by a program. The caller frees *each. */
static bool all_rows(const dvi__context *c, dvi__node node, double **each)
{
  dvi__program program = {0};
  dvi__node *input = dvi__heap_take((size_t)c->input_count, sizeof *input);
  *each = dvi__heap_take((size_t)c->elements, sizeof **each);
  bool made = *each != NULL && input != NULL;
  for (int i = 0; made && i < c->input_count; i++) input[i] = dvi__input(c->graph, i);
  made = made && dvi__program_make(c->graph, c->input_count, input, 1, &node, &program) == DVI_OK;
  made = made ? run_index_program(c, &program, *each) : dvi__scene_no_memory(c->scene);
  dvi__program_free(&program);
  dvi__heap_free(input);
  if (made) return true;
  dvi__heap_free(*each);
  *each = NULL;
  return false;
}

/* Join numbers of elements to one number if all are the same. A NaN differs from any number. */
static void join_elements(const dvi__context *c, double **each, double *all)
{
  for (int e = 1; e < c->elements; e++)
    if (!((*each)[e] >= (*each)[0] && (*each)[e] <= (*each)[0])) return;
  *all = (*each)[0];
  dvi__heap_free(*each);
  *each = NULL;
}

/* Make a context with the same elements and indices, but without variables. */
static bool make_still_context(const dvi__context *c, dvi__context *inside)
{
  if (!dvi__context_make(inside, c->scene, 0, "an index or a bound")) return false;
  inside->elements = c->elements;
  inside->index_count = c->index_count;
  inside->index_first = c->index_first;
  inside->depth = c->depth;
  memcpy(inside->index, c->index, sizeof c->index);
  return true;
}

bool dvi__node_numbers(dvi__context *c, const dvi__expression *e, dvi__node node, double **each,
                       double *all)
{
  *each = NULL;
  if (dvi__is_constant(c->graph, node, all) && isfinite(*all)) return true;
  if (c->input_count == 0) return dvi__constants_of(c, e, dvi__number_value(node), all);
  if (!all_rows(c, node, each)) return false;
  join_elements(c, each, all);
  return true;
}

bool dvi__numbers_of(const dvi__context *c, const dvi__expression *e, double **each, double *all)
{
  dvi__context inside;
  dvi__node node;
  *each = NULL;
  if (!make_still_context(c, &inside)) return false;
  bool made = dvi__elaborate_number(&inside, e, &node);
  if (made)
    made = dvi__node_numbers(&inside, e, node, each, all);
  else if (inside.uneven)
    made = dvi__refuse(c, e->span, "this differs from term to term; write it without a sum");
  dvi__context_free(&inside);
  return made;
}

static bool read_whole_number(const dvi__context *c, const dvi__expression *e, const char *what,
                              double x, int *number)
{
  if (floor(x) < x)
    return dvi__refuse(c, e->span, "%s must be a whole number, and is %.17g", what, x);
  if (!(x >= -1e9 && x <= 1e9))
    return dvi__refuse(c, e->span, "%s must be between -1e9 and 1e9, and is %.17g", what, x);
  *number = (int)x;
  return true;
}

bool dvi__whole_numbers_of(const dvi__context *c, const dvi__expression *e, const char *what,
                           int **each, int *all)
{
  double *number = NULL, same = 0;
  *each = NULL;
  *all = 0;
  if (!dvi__numbers_of(c, e, &number, &same)) return false;
  if (number == NULL) return read_whole_number(c, e, what, same, all);
  *each = dvi__heap_take((size_t)c->elements, sizeof **each);
  bool made = *each != NULL || dvi__scene_no_memory(c->scene);
  for (int k = 0; k < c->elements && made; k++)
    made = read_whole_number(c, e, what, number[k], *each + k);
  dvi__heap_free(number);
  if (made) return true;
  dvi__heap_free(*each);
  *each = NULL;
  return false;
}

/* ---- bounds ---- */

/* The limit of an index that runs over all its values. It is the size of the first family or list
 * that the index alone indexes. */
typedef struct limit {
  int size;
  const char *name;
  dvi__span span;
} limit;

/* Return how many values the k-th index of a named thing has, or 0 if that is unknown. */
static int index_extent(const dvi_scene *scene, const char *text, int k)
{
  const dvi__name *name = dvi__names_find(&scene->names, text);
  if (name == NULL) return 0;
  dvi__shape shape = {0};
  if (name->sort == DVI__PARAMETER) shape = scene->parameter[name->number].shape;
  if (name->sort == DVI__DEFINITION) shape = scene->definition[name->number].shape;
  if (name->sort == DVI__COORDINATE) {
    const dvi__coordinate *x = &scene->coordinate[name->number];
    if (k < x->family) return dvi__extent(x, k);
    shape = x->shape;
    k -= x->family;
  }
  if (k >= shape.rank) return 0;
  return k == 0 ? shape.rows : shape.columns;
}

/* Return true if two limits agree. */
static bool limits_agree(const dvi__context *c, const char *index, limit *found, limit next)
{
  if (next.size == 0 || next.size == found->size) return true;
  if (found->size != 0)
    return dvi__refuse(c, next.span,
                       "%s runs over the %d of %s, but %s has %d; give bounds: sum(%s=1..n, ..)",
                       index, found->size, found->name, next.name, next.size, index);
  *found = next;
  return true;
}

/* Find what an index alone indexes in e. Recursion goes into parts but the first, which the loop
 * follows. */
static bool find_limit(const dvi__context *c, const char *index, const dvi__expression *e,
                       limit *found)
{
  for (; e != NULL; e = e->count > 0 ? e->part[0] : NULL) {
    int before = 0; /* indices that stand further inside, as [i] of a[i][j] */
    const dvi__expression *base = e;
    if (e->form == DVI__FORM_INDEX) {
      for (base = e->part[0]; base->form == DVI__FORM_INDEX; base = base->part[0])
        before += base->count - 1;
      while (base->form == DVI__FORM_RATE) base = base->part[0];
    }
    for (int k = 1; k < e->count; k++) {
      const dvi__expression *part = e->part[k];
      const int alone = e->form == DVI__FORM_INDEX && part->form == DVI__FORM_NAME &&
                        strcmp(part->name, index) == 0;
      if (alone && base->form == DVI__FORM_NAME &&
          !limits_agree(
              c, index, found,
              (limit){index_extent(c->scene, base->name, before + k - 1), base->name, e->span}))
        return false;
      if (!find_limit(c, index, part, found)) return false;
    }
  }
  return true;
}

static bool bounds_of_families(const dvi__context *c, const dvi__expression *sum,
                               dvi__bounds *bounds)
{
  limit found = {0};
  if (!find_limit(c, sum->name, sum->part[0], &found)) return false;
  if (sum->name2 != NULL && !find_limit(c, sum->name2, sum->part[0], &found)) return false;
  if (found.size == 0)
    return dvi__refuse(
        c, sum->span,
        "nothing is indexed by %s alone, so its bounds must be given: sum(%s=1..n, ..)", sum->name,
        sum->name);
  bounds->all_first = 1;
  bounds->all_last = found.size;
  return true;
}

bool dvi__sum_bounds(const dvi__context *c, const dvi__expression *sum, dvi__bounds *bounds)
{
  *bounds = (dvi__bounds){0};
  if (sum->count == 1) return bounds_of_families(c, sum, bounds);
  if (!dvi__whole_numbers_of(c, sum->part[1], "a bound", &bounds->first, &bounds->all_first))
    return false;
  if (dvi__whole_numbers_of(c, sum->part[2], "a bound", &bounds->last, &bounds->all_last))
    return true;
  dvi__heap_free(bounds->first);
  bounds->first = NULL;
  return false;
}
