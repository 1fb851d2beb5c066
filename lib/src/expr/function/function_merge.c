/* Short kernels written out. Kernels of one element, and those of a few elements that have few
 * nodes, become one kernel of one element. Running a kernel takes as long as some ten of its
 * operations. What these kernels have in common is computed once, and what they add to the same
 * entry is added before it is stored. */
#include "expr/function/function_parts.h"
#include "expr/graph_make.h"
#include "text/heap.h"

enum {
  FEW = 4,          /* most elements that are written out */
  NODES_MAX = 64,   /* most nodes of these elements */
  MERGED_MAX = 1024 /* most nodes that become one kernel */
};

typedef struct merger {
  dvi__arena *arena;
  dvi__graph *graph;
  dvi__kernel_input *input;
  int input_count;
  dvi__node root;
} merger;

static int kernel_is_short(const dvi__kernel *kernel)
{
  return kernel->elements >= 1 && kernel->elements <= FEW &&
         kernel->root < NODES_MAX / kernel->elements;
}

/* Find or make the input that reads this variable. */
static dvi__node merger_variable(merger *m, int block, int place)
{
  for (int i = 0; i < m->input_count; i++)
    if (m->input[i].block == block && m->input[i].base == place) return dvi__input(m->graph, i);
  dvi__kernel_input *grown = dvi__arena_grow(m->arena, m->input, (size_t)m->input_count,
                                             sizeof *grown);
  if (grown == NULL) {
    m->graph->failed = DVI_NO_MEMORY;
    return 0;
  }
  m->input = grown;
  m->input[m->input_count] = (dvi__kernel_input){.block = block, .base = place};
  return dvi__input(m->graph, m->input_count++);
}

static dvi__node merger_copy(merger *m, const dvi__kernel *kernel, int e,
                             const dvi__graph_node *node, const dvi__node *copied)
{
  m->graph->here = node->span;
  if (node->op == DVI__OP_CONSTANT) return dvi__constant(m->graph, node->value);
  if (node->op == DVI__OP_POWER) return dvi__power(m->graph, copied[node->a], node->value);
  if (node->op != DVI__OP_INPUT)
    return dvi__apply(m->graph, node->op, copied[node->a],
                      dvi__operands(node->op) > 1 ? copied[node->b] : 0);
  const dvi__kernel_input *input = &kernel->input[node->a];
  return input->is_data ? dvi__constant(m->graph, input->data[e])
                        : merger_variable(m, input->block, dvi__input_number(input, e));
}

/* Add element e of a short kernel. */
static void add_element(merger *m, const dvi__kernel *kernel, int e)
{
  dvi__node copied[NODES_MAX];
  for (dvi__node n = 0; n <= kernel->root && m->graph->failed == DVI_OK; n++)
    copied[n] = merger_copy(m, kernel, e, &kernel->graph->node[n], copied);
  if (m->graph->failed == DVI_OK) m->root = dvi__add(m->graph, m->root, copied[kernel->root]);
}

/* Write out short kernels until there is enough. merged[k] marks them. Returns how many elements
 * they have. */
static int merger_write_out(merger *m, int kernel_count, const dvi__kernel *kernels, char *merged)
{
  int elements = 0;
  m->root = dvi__constant(m->graph, 0.0);
  for (int k = 0; k < kernel_count && m->graph->failed == DVI_OK && m->graph->count < MERGED_MAX;
       k++) {
    if (!kernel_is_short(&kernels[k])) continue;
    for (int e = 0; e < kernels[k].elements; e++) add_element(m, &kernels[k], e);
    elements += kernels[k].elements;
    merged[k] = 1;
  }
  return elements;
}

/* Put the merged kernel in the place of its sources, and free their graphs. */
static void merger_replace(const merger *m, const char *merged, int *kernel_count,
                           dvi__kernel *kernels)
{
  int left = 0;
  for (int k = 0; k < *kernel_count; k++)
    if (merged[k])
      dvi__graph_free(kernels[k].graph);
    else
      kernels[left++] = kernels[k];
  kernels[left++] = (dvi__kernel){.graph = m->graph,
                                  .root = m->root,
                                  .elements = 1,
                                  .input_count = m->input_count,
                                  .input = m->input};
  *kernel_count = left;
}

dvi_status dvi__merge_kernels(dvi__arena *arena, int *kernel_count, dvi__kernel *kernels)
{
  merger m = {.arena = arena, .graph = dvi__arena_take(arena, 1, sizeof *m.graph)};
  char *merged = dvi__heap_take((size_t)*kernel_count, 1);
  dvi_status status = m.graph != NULL && merged != NULL ? DVI_OK : DVI_NO_MEMORY;
  const int elements = status == DVI_OK ? merger_write_out(&m, *kernel_count, kernels, merged) : 0;
  if (status == DVI_OK) status = m.graph->failed;
  if (status == DVI_OK && elements > 1)
    merger_replace(&m, merged, kernel_count, kernels);
  else if (m.graph != NULL)
    dvi__graph_free(m.graph);
  dvi__heap_free(merged);
  return status;
}
