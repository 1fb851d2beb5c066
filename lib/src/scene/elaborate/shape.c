#include "scene/elaborate/shape.h"

#include <string.h>

#include "scene/elaborate/elaborate.h"
#include "scene/elaborate/words.h"

bool dvi__want_shape(const dvi__context *c, dvi__span span, dvi__shape found, dvi__shape right)
{
  char shape[48], needed[48];
  if (found.rank == right.rank && (right.rank == 0 || found.rows == right.rows) &&
      (right.rank < 2 || found.columns == right.columns))
    return true;
  return dvi__scene_refuse(c->scene, span, "%s is %s here, where %s is needed", c->where,
                           dvi__shape_text(found, shape, sizeof shape),
                           dvi__shape_text(right, needed, sizeof needed));
}

int dvi__value_size(dvi__value value)
{
  return value.shape.rank == 0 ? 1 : value.shape.rows * value.shape.columns;
}

dvi__node dvi__value_at(dvi__value value, int i)
{
  return value.node == NULL ? value.one : value.node[i];
}

dvi__value dvi__number_value(dvi__node node)
{
  return (dvi__value){.shape = {0, 1, 1}, .one = node};
}

dvi__value dvi__value_make(dvi__context *c, int rank, int rows, int columns)
{
  dvi__value value = {.shape = {rank, rows, columns}};
  if (rank == 0) return value;
  value.node = dvi__arena_take(&c->scene->arena, (size_t)rows * (size_t)columns,
                               sizeof *value.node);
  if (value.node != NULL) return value;
  (void)dvi__scene_no_memory(c->scene);
  return DVI__NO_VALUE;
}

static void set_node(dvi__value *value, int i, dvi__node node)
{
  if (value->node == NULL)
    value->one = node;
  else
    value->node[i] = node;
}

/* Refuse two values for an operation, as "a vector of 3 plus a number". */
static dvi__value refuse_shapes(const dvi__context *c, dvi__value a, const char *word, dvi__value b,
                                dvi__span span, const char *remedy)
{
  char left[48], right[48];
  (void)dvi__refuse(c, span, "%s %s %s%s", dvi__shape_text(a.shape, left, sizeof left), word,
                    dvi__shape_text(b.shape, right, sizeof right), remedy);
  return DVI__NO_VALUE;
}

dvi__value dvi__value_negate(dvi__context *c, dvi__value a)
{
  dvi__value result = dvi__value_make(c, a.shape.rank, a.shape.rows, a.shape.columns);
  if (result.shape.rank < 0) return result;
  for (int i = 0; i < dvi__value_size(a); i++)
    set_node(&result, i, dvi__apply(c->graph, DVI__OP_NEGATE, dvi__value_at(a, i), 0));
  return result;
}

dvi__value dvi__value_add(dvi__context *c, dvi__op op, dvi__value a, dvi__value b, dvi__span span)
{
  if (!dvi__same_shape(a.shape, b.shape))
    return refuse_shapes(c, a, op == DVI__OP_ADD ? "plus" : "minus", b, span, "");
  dvi__value result = dvi__value_make(c, a.shape.rank, a.shape.rows, a.shape.columns);
  if (result.shape.rank < 0) return result;
  for (int i = 0; i < dvi__value_size(a); i++)
    set_node(&result, i, dvi__apply(c->graph, op, dvi__value_at(a, i), dvi__value_at(b, i)));
  return result;
}

/* Multiply or divide every number of a by a number. */
static dvi__value scale_value(dvi__context *c, dvi__op op, dvi__value a, dvi__node b, int turned)
{
  dvi__value result = dvi__value_make(c, a.shape.rank, a.shape.rows, a.shape.columns);
  if (result.shape.rank < 0) return result;
  for (int i = 0; i < dvi__value_size(a); i++)
    set_node(&result, i,
             turned ? dvi__apply(c->graph, op, b, dvi__value_at(a, i))
                    : dvi__apply(c->graph, op, dvi__value_at(a, i), b));
  return result;
}

/* Return sum_k a[first + k*step] b[other + k*other_step], from the left. */
static dvi__node inner_product(dvi__context *c, int count, dvi__value a, int first, int step,
                               dvi__value b, int other, int other_step)
{
  dvi__node total = dvi__constant(c->graph, 0);
  for (int k = 0; k < count; k++) {
    const dvi__node product = dvi__apply(c->graph, DVI__OP_MULTIPLY,
                                         dvi__value_at(a, first + k * step),
                                         dvi__value_at(b, other + k * other_step));
    total = k == 0 ? product : dvi__apply(c->graph, DVI__OP_ADD, total, product);
  }
  return total;
}

static dvi__value matrix_product(dvi__context *c, dvi__value a, dvi__value b)
{
  const int columns = b.shape.columns;
  dvi__value result = dvi__value_make(c, b.shape.rank, a.shape.rows, columns);
  if (result.shape.rank < 0) return result;
  for (int i = 0; i < a.shape.rows; i++)
    for (int j = 0; j < columns; j++)
      set_node(&result, i * columns + j,
               inner_product(c, a.shape.columns, a, i * a.shape.columns, 1, b, j, columns));
  return result;
}

dvi__value dvi__value_multiply(dvi__context *c, dvi__value a, dvi__value b, dvi__span span)
{
  if (b.shape.rank == 0) return scale_value(c, DVI__OP_MULTIPLY, a, b.one, 0);
  if (a.shape.rank == 0) return scale_value(c, DVI__OP_MULTIPLY, b, a.one, 1);
  if (a.shape.rank == 2 && a.shape.columns == b.shape.rows) return matrix_product(c, a, b);
  return refuse_shapes(c, a, "times", b, span,
                       a.shape.rank == 1 && b.shape.rank == 1 ? ": say dot(a,b) or cross(a,b)"
                                                              : "");
}

dvi__value dvi__value_divide(dvi__context *c, dvi__value a, dvi__value b, dvi__span span)
{
  return b.shape.rank == 0 ? scale_value(c, DVI__OP_DIVIDE, a, b.one, 0)
                           : refuse_shapes(c, a, "by", b, span, "");
}

dvi__value dvi__value_power(dvi__context *c, dvi__value a, dvi__value b, dvi__span span)
{
  double exponent;
  if (a.shape.rank != 0 || b.shape.rank != 0)
    return refuse_shapes(c, a, "to the power of", b, span,
                         a.shape.rank == 1 && b.shape.rank == 0 ? ": say dot(a,a), or norm(a)"
                                                                : "");
  if (dvi__is_constant(c->graph, b.one, &exponent))
    return dvi__number_value(dvi__power(c->graph, a.one, exponent));
  return dvi__number_value(dvi__apply(c->graph, DVI__OP_RAISE, a.one, b.one));
}

/* ---- functions ---- */

static dvi__node node_difference(dvi__context *c, dvi__node a, dvi__node b)
{
  return dvi__apply(c->graph, DVI__OP_SUBTRACT, a, b);
}

/* Return a_i b_j - a_j b_i. */
static dvi__node minor_determinant(dvi__context *c, dvi__value a, dvi__value b, int i, int j)
{
  return node_difference(
      c, dvi__apply(c->graph, DVI__OP_MULTIPLY, dvi__value_at(a, i), dvi__value_at(b, j)),
      dvi__apply(c->graph, DVI__OP_MULTIPLY, dvi__value_at(a, j), dvi__value_at(b, i)));
}

static dvi__value cross_product(dvi__context *c, dvi__value a, dvi__value b)
{
  if (a.shape.rows == 2) return dvi__number_value(minor_determinant(c, a, b, 0, 1));
  dvi__value result = dvi__value_make(c, 1, 3, 1);
  for (int i = 0; i < 3 && result.shape.rank >= 0; i++)
    set_node(&result, i, minor_determinant(c, a, b, (i + 1) % 3, (i + 2) % 3));
  return result;
}

static dvi__value transpose_value(dvi__context *c, dvi__value a)
{
  const int rows = a.shape.rows, columns = a.shape.columns;
  dvi__value result = dvi__value_make(c, 2, columns, rows);
  for (int i = 0; i < rows && result.shape.rank >= 0; i++)
    for (int j = 0; j < columns; j++)
      set_node(&result, j * rows + i, dvi__value_at(a, i * columns + j));
  return result;
}

/* Return the rotation about an axis by an angle, cos I + sin e^ + (1 - cos) e e^T, e = axis/|axis|
 * (Rodrigues). */
static dvi__value rotation_about(dvi__context *c, dvi__value axis, dvi__node angle)
{
  dvi__graph *g = c->graph;
  const dvi__node length = dvi__apply(g, DVI__OP_SQRT, inner_product(c, 3, axis, 0, 1, axis, 0, 1),
                                      0);
  const dvi__value e = scale_value(c, DVI__OP_DIVIDE, axis, length, 0);
  const dvi__node cosine = dvi__apply(g, DVI__OP_COS, angle, 0),
                  sine = dvi__apply(g, DVI__OP_SIN, angle, 0);
  dvi__value R = dvi__value_make(c, 2, 3, 3);
  if (R.shape.rank < 0 || e.shape.rank < 0) return DVI__NO_VALUE;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const dvi__node along = dvi__apply(
          g, DVI__OP_MULTIPLY, node_difference(c, dvi__constant(g, 1), cosine),
          dvi__apply(g, DVI__OP_MULTIPLY, dvi__value_at(e, i), dvi__value_at(e, j)));
      const dvi__node around =
          i == j ? cosine : dvi__apply(g, DVI__OP_MULTIPLY, sine, dvi__value_at(e, 3 - i - j));
      const int falls = i != j && (j + 1) % 3 != i; /* e^ has -e_3 at (1,2), e_3 at (2,1) */
      set_node(&R, 3 * i + j, dvi__apply(g, falls ? DVI__OP_SUBTRACT : DVI__OP_ADD, along, around));
    }
  return R;
}

/* A function of vectors, with the number and the ranks of its arguments. */
typedef struct vector_word {
  const char *name, *wants;
  int arguments, rank[2];
} vector_word;

static const vector_word vector_words[] = {
    {"dot", "two vectors of one size", 2, {1, 1}},
    {"cross", "two vectors of 2, or of 3", 2, {1, 1}},
    {"norm", "a vector", 1, {1, 0}},
    {"transpose", "a matrix", 1, {2, 0}},
    {"turn", "an axis, which is a vector of 3, and an angle", 2, {1, 0}},
};

static bool arguments_fit(const vector_word *word, const dvi__value *a)
{
  for (int k = 0; k < word->arguments; k++)
    if (a[k].shape.rank != word->rank[k]) return false;
  if (word->rank[1] == 1 && a[0].shape.rows != a[1].shape.rows) return false;
  if (strcmp(word->name, "turn") == 0) return a[0].shape.rows == 3;
  return strcmp(word->name, "cross") != 0 || a[0].shape.rows == 2 || a[0].shape.rows == 3;
}

static dvi__value vector_call(dvi__context *c, const vector_word *word, const dvi__value *a)
{
  if (strcmp(word->name, "cross") == 0) return cross_product(c, a[0], a[1]);
  if (strcmp(word->name, "transpose") == 0) return transpose_value(c, a[0]);
  if (strcmp(word->name, "turn") == 0) return rotation_about(c, a[0], a[1].one);
  const dvi__node product = inner_product(c, a[0].shape.rows, a[0], 0, 1, a[word->arguments - 1], 0,
                                          1);
  return dvi__number_value(word->arguments == 2 ? product
                                                : dvi__apply(c->graph, DVI__OP_SQRT, product, 0));
}

static bool right_count(const dvi__context *c, const dvi__expression *call, int wanted)
{
  if (call->count == wanted) return true;
  return dvi__refuse(c, call->span, "%s takes %d argument%s, not %d", call->name, wanted,
                     wanted == 1 ? "" : "s", call->count);
}

/* Return a hint if an argument is an angle, which is (cos, sin). */
static const char *hint_of_angle(const dvi__context *c, const dvi__expression *e)
{
  dvi__subscripts index;
  const dvi__coordinate *x = dvi__member_named(c->scene, e, &index);
  return x != NULL && x->kind == DVI__ANGLE ? ": the cosine of an angle u is u[1], its sine u[2]"
                                            : "";
}

static bool are_numbers(const dvi__context *c, const dvi__expression *call, const dvi__value *a)
{
  char shape[48];
  for (int k = 0; k < call->count; k++)
    if (a[k].shape.rank != 0)
      return dvi__refuse(c, call->part[k]->span, "%s is taken of a number, not of %s%s", call->name,
                         dvi__shape_text(a[k].shape, shape, sizeof shape),
                         hint_of_angle(c, call->part[k]));
  return true;
}

/* Call a function of numbers. */
static dvi__value number_call(dvi__context *c, const dvi__expression *call,
                              const dvi__function_word *word, const dvi__value *a)
{
  if (!right_count(c, call, word->arguments) || !are_numbers(c, call, a)) return DVI__NO_VALUE;
  const bool turned = strcmp(word->name, "ceil") == 0; /* ceil(x) = -floor(-x) */
  const dvi__node first = turned ? dvi__apply(c->graph, DVI__OP_NEGATE, a[0].one, 0) : a[0].one;
  const dvi__node made = dvi__apply(c->graph, word->op, first, call->count == 2 ? a[1].one : 0);
  return dvi__number_value(turned ? dvi__apply(c->graph, DVI__OP_NEGATE, made, 0) : made);
}

/* Return the largest or the smallest of some numbers, and of equal ones the last. */
static dvi__value extreme_number(dvi__context *c, const dvi__expression *call, int largest,
                                 const dvi__value *a)
{
  if (call->count < 2)
    return dvi__refused(
        dvi__refuse(c, call->span, "%s takes 2 arguments or more, not 1", call->name));
  if (!are_numbers(c, call, a)) return DVI__NO_VALUE;
  dvi__node best = a[0].one;
  for (int k = 1; k < call->count; k++) {
    const dvi__node next = a[k].one;
    const dvi__node stays = largest ? dvi__greater(c->graph, best, next)
                                    : dvi__greater(c->graph, next, best);
    best = dvi__choice(c->graph, stays, best, next);
  }
  return dvi__number_value(best);
}

/* Refuse a call of a coordinate before a parenthesis, or of an unknown name. */
static dvi__value no_function(const dvi__context *c, const dvi__expression *call)
{
  const dvi__span where = {call->span.first, strlen(call->name)};
  const dvi__name *name = dvi__names_find(&c->scene->names, call->name);
  if (name == NULL && c->scene->jets != NULL && strcmp(call->name, "diff") == 0)
    return dvi__refused(dvi__refuse(c, where, "there is no 'diff'; write d(u,%s), or u' for a rate",
                                    c->scene->jets->axis[0]));
  const char *what = name != NULL ? dvi__sort_name(name->sort) : "number"; /* t, pi, an index */
  if (name == NULL && !dvi__is_word(call->name) && dvi__index_find(c, call->name) == NULL)
    return dvi__refused(dvi__names_unknown(&c->scene->names, &c->scene->arena, c->scene->complaint,
                                           call->name, where));
  return dvi__refused(
      dvi__refuse(c, where, "'%s' is a %s, no function; write * for a product, [..] for an element",
                  call->name, what));
}

dvi__value dvi__value_call(dvi__context *c, const dvi__expression *call, const dvi__value *argument)
{
  const dvi__function_word *word = dvi__function_word_of(call->name);
  if (word != NULL) return number_call(c, call, word, argument);
  const int largest = strcmp(call->name, "max") == 0;
  if (largest || strcmp(call->name, "min") == 0) return extreme_number(c, call, largest, argument);
  for (size_t i = 0; i < sizeof vector_words / sizeof *vector_words; i++) {
    if (strcmp(vector_words[i].name, call->name) != 0) continue;
    if (!right_count(c, call, vector_words[i].arguments)) return DVI__NO_VALUE;
    if (arguments_fit(&vector_words[i], argument))
      return vector_call(c, &vector_words[i], argument);
    (void)dvi__refuse(c, call->span, "%s takes %s", call->name, vector_words[i].wants);
    return DVI__NO_VALUE;
  }
  return no_function(c, call);
}
