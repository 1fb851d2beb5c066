#include "expr/function/function_quad.h"

#include <string.h>

#include "expr/function/function_parts.h"
#include "expr/graph_make.h"
#include "text/heap.h"

#ifdef DVI__QUAD
typedef dvi__quad quad;

static quad input_at(const dvi__kernel *kernel, int i, int e, quad *const *x)
{
  const dvi__kernel_input *input = &kernel->input[i];
  return input->is_data ? (quad)input->data[e] : x[input->block][dvi__input_number(input, e)];
}

/* Compute the values of all nodes up to the root. */
static void kernel_values(const dvi__kernel *kernel, int e, quad *const *x, quad *value)
{
  const dvi__graph_node *node = kernel->graph->node;
  for (int n = 0; n <= kernel->root; n++) {
    const int operands = dvi__operands(node[n].op);
    value[n] = node[n].op == DVI__OP_INPUT ? input_at(kernel, node[n].a, e, x)
                                           : dvi__quad_operate(node[n].op, node[n].value,
                                                               operands > 0 ? value[node[n].a] : 0,
                                                               operands > 1 ? value[node[n].b] : 0);
  }
}

/* Hand the root's derivative by each node on to its operands, from the root down. Nodes that the
 * root does not depend on are not evaluated, since they may have no value. */
static void kernel_pull_back(const dvi__kernel *kernel, int e, const quad *value, quad sign,
                             quad *adjoint, quad *const *gradient)
{
  const dvi__graph_node *node = kernel->graph->node;
  memset(adjoint, 0, ((size_t)kernel->root + 1) * sizeof *adjoint);
  adjoint[kernel->root] = sign;
  for (int n = kernel->root; n >= 0; n--) {
    const int operands = dvi__operands(node[n].op);
    quad slope[2] = {0, 0};
    if (!(adjoint[n] < 0) && !(adjoint[n] > 0)) continue;
    if (node[n].op == DVI__OP_INPUT && !kernel->input[node[n].a].is_data) {
      const dvi__kernel_input *input = &kernel->input[node[n].a];
      if (gradient[input->block] != NULL)
        gradient[input->block][dvi__input_number(input, e)] += adjoint[n];
    }
    if (operands == 0) continue;
    dvi__quad_slopes(node[n].op, node[n].value, value[n], value[node[n].a],
                     operands > 1 ? value[node[n].b] : 0, slope);
    adjoint[node[n].a] += adjoint[n] * slope[0];
    if (operands > 1) adjoint[node[n].b] += adjoint[n] * slope[1];
  }
}

static dvi_status kernel_add(const dvi__kernel *kernel, quad sign, quad *const *x, quad *sum,
                             quad *const *gradient)
{
  quad *value = dvi__heap_take(2 * ((size_t)kernel->root + 1), sizeof *value);
  if (value == NULL) return DVI_NO_MEMORY;
  for (int e = 0; e < kernel->elements; e++) {
    kernel_values(kernel, e, x, value);
    if (sum != NULL) *sum += sign * value[kernel->root];
    if (gradient != NULL)
      kernel_pull_back(kernel, e, value, sign, value + kernel->root + 1, gradient);
  }
  dvi__heap_free(value);
  return DVI_OK;
}

dvi_status dvi__function_quad_add(dvi__function *function, quad sign, quad *const *x, quad *value,
                                  quad *const *gradient)
{
  dvi_status status = DVI_OK;
  dvi__function_enter(function);
  for (int k = 0; k < function->kernel_count && status == DVI_OK; k++)
    status = kernel_add(&function->kernel[k], sign, x, value, gradient);
  return dvi__function_leave(function, status);
}
#endif
