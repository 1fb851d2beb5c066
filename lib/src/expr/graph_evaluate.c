/* Values of nodes, one operation after the other. They serve constants and the location of
 * faults. */
#include <math.h>
#include <string.h>

#include "expr/graph_make.h"
#include "text/heap.h"

static double sign_of_number(double x)
{
  return (double)((x > 0) - (x < 0));
}

double dvi__operate(dvi__op op, double value, double a, double b)
{
  switch (op) {
  case DVI__OP_CONSTANT:
  case DVI__OP_INPUT: return value;
  case DVI__OP_NEGATE: return -a;
  case DVI__OP_SQUARE: return a * a;
  case DVI__OP_POWER: return pow(a, value);
  case DVI__OP_SQRT: return sqrt(a);
  case DVI__OP_EXP: return exp(a);
  case DVI__OP_LOG: return log(a);
  case DVI__OP_SIN: return sin(a);
  case DVI__OP_COS: return cos(a);
  case DVI__OP_TAN: return tan(a);
  case DVI__OP_ASIN: return asin(a);
  case DVI__OP_ACOS: return acos(a);
  case DVI__OP_ATAN: return atan(a);
  case DVI__OP_SINH: return sinh(a);
  case DVI__OP_COSH: return cosh(a);
  case DVI__OP_TANH: return tanh(a);
  case DVI__OP_ASINH: return asinh(a);
  case DVI__OP_ACOSH: return acosh(a);
  case DVI__OP_ATANH: return atanh(a);
  case DVI__OP_ABS: return fabs(a);
  case DVI__OP_SIGN: return sign_of_number(a);
  case DVI__OP_ADD: return a + b;
  case DVI__OP_SUBTRACT: return a - b;
  case DVI__OP_MULTIPLY: return a * b;
  case DVI__OP_DIVIDE: return a / b;
  case DVI__OP_RAISE: return pow(a, b);
  case DVI__OP_ATAN2: return atan2(a, b);
  case DVI__OP_HYPOT: return hypot(a, b);
  case DVI__OP_FLOOR: return floor(a);
  case DVI__OP_POSITIVE: return a > 0 ? 1 : a <= 0 ? 0 : a;
  case DVI__OP_WHERE: return a > 0 ? b : a <= 0 ? 0 : a;
  case DVI__OP_COUNT: break;
  }
  return 0;
}

char *dvi__parts(const dvi__graph *graph, int root_count, const dvi__node *root, int *size)
{
  int last = -1;
  for (int k = 0; k < root_count; k++) last = root[k] > last ? root[k] : last;
  *size = last + 1;
  char *part = dvi__heap_take((size_t)*size + 1, 1);
  if (part == NULL) return NULL;
  for (int k = 0; k < root_count; k++) part[root[k]] = 1;
  for (int n = last; n >= 0; n--) {
    const int operands = part[n] ? dvi__operands(graph->node[n].op) : 0;
    if (operands > 0) part[graph->node[n].a] = 1;
    if (operands > 1) part[graph->node[n].b] = 1;
  }
  return part;
}

void dvi__inputs_used(const dvi__graph *graph, int root_count, const dvi__node *root, int count,
                      char *used)
{
  int size = 0;
  char *part = graph->failed == DVI_OK ? dvi__parts(graph, root_count, root, &size) : NULL;
  /* all may be used if there is no memory */
  for (int i = 0; i < count; i++) used[i] = part == NULL;
  for (int n = 0; n < size && part != NULL; n++)
    if (part[n] && graph->node[n].op == DVI__OP_INPUT && graph->node[n].a < count)
      used[graph->node[n].a] = 1;
  dvi__heap_free(part);
}

/* Return the value of a node whose operands have values. */
static double value_of(const dvi__graph_node *node, const double *x, const double *at)
{
  if (node->op == DVI__OP_INPUT) return x[node->a];
  const int operands = dvi__operands(node->op);
  return dvi__operate(node->op, node->value, operands > 0 ? at[node->a] : 0,
                      operands > 1 ? at[node->b] : 0);
}

void dvi__mark_taken(const dvi__graph *graph, const double *at, int root_count,
                     const dvi__node *root, int size, char *part)
{
  memset(part, 0, (size_t)size);
  for (int k = 0; k < root_count; k++) part[root[k]] = 1;
  for (int n = size - 1; n >= 0; n--) {
    const dvi__graph_node *node = graph->node + n;
    const int operands = part[n] ? dvi__operands(node->op) : 0;
    if (operands > 0) part[node->a] = 1;
    if (operands > 1 && !(node->op == DVI__OP_WHERE && at[node->a] <= 0)) part[node->b] = 1;
  }
}

dvi_status dvi__evaluate(const dvi__graph *graph, const double *x, int root_count,
                         const dvi__node *root, double *value, dvi__node *not_finite)
{
  if (graph->failed != DVI_OK) return graph->failed;
  int size;
  char *part = dvi__parts(graph, root_count, root, &size);
  double *at = part == NULL ? NULL : dvi__heap_take((size_t)size + 1, sizeof *at);
  int finite = 1;
  for (int n = 0; n < size && at != NULL; n++) {
    if (!part[n]) continue;
    at[n] = value_of(graph->node + n, x, at);
    finite &= isfinite(at[n]) != 0;
  }
  *not_finite = -1;
  if (at != NULL && !finite) {
    dvi__mark_taken(graph, at, root_count, root, size, part);
    for (int n = 0; n < size && *not_finite < 0; n++)
      if (part[n] && !isfinite(at[n])) *not_finite = n;
  }
  for (int k = 0; k < root_count && at != NULL; k++) value[k] = at[root[k]];
  const dvi_status status = at == NULL ? DVI_NO_MEMORY : DVI_OK;
  dvi__heap_free(part);
  dvi__heap_free(at);
  return status;
}
