/* Fault location. It finds the part of an expression that is not finite or has no series. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "expr/function/function_parts.h"
#include "expr/graph_make.h"
#include "text/heap.h"

/* The first thing that a node lacks among a value, a derivative and a series. */
typedef enum lack { VALUE, DERIVATIVE, SERIES } lack;

/* A node of a kernel at one of its elements. */
typedef struct location {
  const dvi__kernel *kernel;
  dvi__node node; /* -1 if there is none */
  int element;
  double *input; /* [input_count], freed by the caller */
  lack of;
} location;

static void read_inputs(const dvi__kernel *kernel, const dvi__element_places *place, int e,
                        int count, const double *const *x, int k, double *value)
{
  for (int i = 0; i < kernel->input_count; i++)
    value[i] = kernel->input[i].is_data
                   ? kernel->input[i].data[e]
                   : x[kernel->input[i].block][(ptrdiff_t)dvi__place_at(&place[i], e) * count + k];
}

/* Return the first node below the roots that is not finite, or -1 if all roots are finite. */
static dvi__node first_below(const dvi__kernel *kernel, const double *input, int root_count,
                             const dvi__node *root)
{
  double *value = dvi__heap_take((size_t)root_count + 1, sizeof *value);
  dvi__node node = -1;
  int finite = 1;
  if (value == NULL ||
      dvi__evaluate(kernel->graph, input, root_count, root, value, &node) != DVI_OK) {
    dvi__heap_free(value);
    return -1;
  }
  for (int r = 0; r < root_count; r++) finite &= isfinite(value[r]) != 0;
  dvi__heap_free(value);
  return finite ? -1 : node;
}

/* List the known derivatives of kernel k by variables and set their number. The caller frees the
 * list. NULL if there is no memory. */
static dvi__node *known_derivatives(const dvi__function *function, int k, int *count)
{
  const dvi__kernel *kernel = &function->kernel[k];
  const dvi__derivatives *own = &function->derivatives[k];
  const int pairs = own->second != NULL ? own->pair_count : 0;
  dvi__node *root = dvi__heap_take((size_t)kernel->input_count + (size_t)pairs + 1, sizeof *root);
  *count = 0;
  if (root == NULL) return NULL;
  for (int i = 0; i < kernel->input_count && own->gradient != NULL; i++)
    if (!kernel->input[i].is_data) root[(*count)++] = own->gradient[i];
  for (int e = 0; e < pairs; e++)
    if (own->second[e] >= 0) root[(*count)++] = own->second[e];
  return root;
}

/* Return 1 if an operation that has a value has a series, too. */
static int has_series(const dvi__graph_node *node, double a, double b)
{
  const int is_zero = !(a > 0.0) && !(a < 0.0), whole = node->value - floor(node->value) < 0.25;
  switch (node->op) {
  case DVI__OP_SQRT:
  case DVI__OP_RAISE: return !is_zero;
  case DVI__OP_POWER: return !is_zero || whole;
  case DVI__OP_ABS:
  case DVI__OP_SIGN:
  case DVI__OP_POSITIVE: return !is_zero;
  case DVI__OP_FLOOR: return a > floor(a);
  case DVI__OP_ATAN2: return !is_zero || b > 0.0 || b < 0.0;
  case DVI__OP_ASIN:
  case DVI__OP_ACOS: return fabs(a) < 1.0;
  case DVI__OP_ACOSH: return a > 1.0;
  default: return 1;
  }
}

void dvi__mark_moving(const dvi__kernel *kernel, int count, char *moves)
{
  for (int n = 0; n < count; n++) {
    const dvi__graph_node *node = &kernel->graph->node[n];
    const int operands = dvi__operands(node->op);
    moves[n] = (char)(node->op == DVI__OP_INPUT
                          ? !kernel->input[node->a].is_data
                          : (operands > 0 && moves[node->a]) || (operands > 1 && moves[node->b]));
  }
}

/* Return the first operation below the root at this point that varies without a series, or -1. */
static dvi__node first_without_series(const dvi__kernel *kernel, const double *input)
{
  const dvi__graph *graph = kernel->graph;
  int count = 0;
  char *part = dvi__parts(graph, 1, &kernel->root, &count),
       *moves = dvi__heap_take((size_t)count + 1, 1);
  dvi__node *node = dvi__heap_take((size_t)count + 1, sizeof *node), unused = -1, found = -1;
  double *value = dvi__heap_take((size_t)count + 1, sizeof *value);
  const int made = part != NULL && moves != NULL && node != NULL && value != NULL;
  for (int n = 0; n < count && made; n++) node[n] = part[n] ? n : kernel->root;
  if (made && dvi__evaluate(graph, input, count, node, value, &unused) == DVI_OK) {
    dvi__mark_moving(kernel, count, moves);
    dvi__mark_taken(graph, value, 1, &kernel->root, count, part);
    for (int n = count - 1; n >= 0; n--) {
      const dvi__graph_node *at = &graph->node[n];
      const int operands = dvi__operands(at->op);
      if (part[n] && moves[n] &&
          !has_series(at, operands > 0 ? value[at->a] : 0, operands > 1 ? value[at->b] : 0))
        found = n;
    }
  }
  dvi__heap_free(part);
  dvi__heap_free(moves);
  dvi__heap_free(node);
  dvi__heap_free(value);
  return found;
}

/* Search kernel k, element by element. */
static void search_kernel(const dvi__function *function, int k, int count, const double *const *x,
                          int point, location *found)
{
  const dvi__kernel *kernel = &function->kernel[k];
  int root_count = 1;
  dvi__node *derivatives = found->of == DERIVATIVE ? known_derivatives(function, k, &root_count)
                                                   : NULL;
  const dvi__node *root = found->of == DERIVATIVE ? derivatives : &kernel->root;
  double *input = dvi__heap_take((size_t)kernel->input_count + 1, sizeof *input);
  for (int e = 0; e < kernel->elements && found->node < 0 && root != NULL && input != NULL; e++) {
    found->element = e;
    read_inputs(kernel, function->derivatives[k].place, e, count, x, point, input);
    found->node = found->of == SERIES ? first_without_series(kernel, input)
                                      : first_below(kernel, input, root_count, root);
  }
  dvi__heap_free(derivatives);
  found->kernel = kernel;
  if (found->node >= 0)
    found->input = input;
  else
    dvi__heap_free(input);
}

/* ---- words ---- */

void dvi__copy_part(const dvi__source *source, dvi__span span, char *text)
{
  int length = 0;
  text[0] = '\0';
  if (span.first >= source->size || span.size > source->size - span.first) return;
  for (size_t i = 0; i < span.size && length < DVI__PART_SIZE - 4; i++) {
    const char letter = source->text[span.first + i];
    const int blank = letter == ' ' || letter == '\n' || letter == '\r' || letter == '\t';
    if (!blank) text[length++] = letter;
    if (blank && length > 0 && text[length - 1] != ' ') text[length++] = ' ';
    if (length == DVI__PART_SIZE - 4 && i + 1 < span.size) {
      memcpy(text + length, "..", 2);
      length += 2;
    }
  }
  text[length] = '\0';
}

/* Return the operand that a sentence shows, the divisor of a quotient or else the first one. -1 if
 * there is none. */
static dvi__node operand_of(const dvi__graph_node *node)
{
  if (node->op == DVI__OP_CONSTANT || node->op == DVI__OP_INPUT) return -1;
  return node->op == DVI__OP_DIVIDE ? node->b : node->a;
}

/* List the variables that the node depends on. The operand is shown already and left out. */
static void list_variables(const location *found, dvi__node operand, dvi__fault *fault)
{
  const dvi__kernel *kernel = found->kernel;
  const dvi__graph_node *shown = operand >= 0 ? &kernel->graph->node[operand] : NULL;
  char *used = dvi__heap_take((size_t)kernel->input_count + 1, 1);
  if (used == NULL) return;
  dvi__inputs_used(kernel->graph, 1, &found->node, kernel->input_count, used);
  for (int i = 0; i < kernel->input_count && fault->count < DVI__FAULT_VARIABLES; i++) {
    if (!used[i] || kernel->input[i].is_data ||
        (shown != NULL && shown->op == DVI__OP_INPUT && shown->a == i))
      continue;
    fault->variable[fault->count].block = kernel->input[i].block;
    fault->variable[fault->count].number = dvi__input_number(&kernel->input[i], found->element);
    fault->variable[fault->count++].value = found->input[i];
  }
  dvi__heap_free(used);
}

static void describe_fault(const location *found, const dvi__source *source, char *text,
                           size_t size, dvi__fault *fault)
{
  const dvi__graph *graph = found->kernel->graph;
  const dvi__graph_node *node = &graph->node[found->node];
  const dvi__node operand = operand_of(node);
  char part[DVI__PART_SIZE], operand_part[DVI__PART_SIZE] = "";
  double value = 0.0;
  dvi__node unused = -1;
  dvi__copy_part(source, node->span, part);
  *fault = (dvi__fault){.span = node->span};
  list_variables(found, operand, fault);
  if (operand >= 0 && graph->node[operand].span.first + graph->node[operand].span.size !=
                          node->span.first + node->span.size)
    dvi__copy_part(source, graph->node[operand].span, operand_part);
  if (operand < 0) (void)dvi__evaluate(graph, found->input, 1, &found->node, &value, &unused);
  if (operand >= 0) (void)dvi__evaluate(graph, found->input, 1, &operand, &value, &unused);
  const char *prefix = found->of == DERIVATIVE ? "the derivative of " : "";
  const char *what = found->of == SERIES ? "has no Taylor series" : "is not finite";
  if (operand < 0)
    (void)dvi__print(text, size, "%s%s = %.6g %s", prefix, part, value, what);
  else if (operand_part[0] != '\0')
    (void)dvi__print(text, size, "%s%s, %s = %.6g %s", prefix, part, operand_part, value, what);
  else
    (void)snprintf(text, size, "%s%s %s", prefix, part, what);
}

void dvi__function_fault(dvi__function *function, const dvi__source *source, int count,
                         const double *const *x, int k, int of_series, char *text, size_t size,
                         dvi__fault *fault)
{
  location found = {.node = -1};
  const int passes = of_series ? SERIES + 1 : SERIES;
  pthread_mutex_lock(&function->lock);
  for (int pass = 0; pass < passes && found.node < 0; pass++)
    for (int i = 0; i < function->kernel_count && found.node < 0; i++) {
      found.of = (lack)pass;
      search_kernel(function, i, count, x, k, &found);
    }
  text[0] = '\0';
  if (found.node >= 0) describe_fault(&found, source, text, size, fault);
  pthread_mutex_unlock(&function->lock);
  dvi__heap_free(found.input);
}
