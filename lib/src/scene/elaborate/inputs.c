/* Inputs of kernels. They are variables by their numbers, and rows of data. Each is there once. */
#include <string.h>

#include "scene/elaborate/context.h"
#include "text/heap.h"

static int block_size(const dvi_scene *scene, int block)
{
  if (block == DVI__TIME) return 1;
  if (block == DVI__INPUTS) return scene->control_count + scene->parameter_count;
  return block == DVI__MULTIPLIERS  ? 2 * scene->n
         : block == DVI__VELOCITIES ? scene->velocities
                                    : scene->n; /* at most 2 n constraints */
}

bool dvi__context_make(dvi__context *c, dvi_scene *scene, unsigned may, const char *where)
{
  *c = (dvi__context){.scene = scene, .may = may, .where = where, .elements = 1};
  c->graph = dvi__heap_take(1, sizeof *c->graph);
  c->definition = dvi__heap_take((size_t)scene->definition_count + 1, sizeof *c->definition);
  if (c->graph == NULL || c->definition == NULL) {
    dvi__context_free(c);
    return dvi__scene_no_memory(scene);
  }
  for (int i = 0; i < scene->definition_count; i++) c->definition[i].shape.rank = -1;
  return true;
}

void dvi__context_free(dvi__context *c)
{
  if (c->graph != NULL) dvi__graph_free(c->graph);
  dvi__heap_free(c->graph);
  dvi__heap_free(c->definition);
  dvi__heap_free(c->input);
  dvi__heap_free(c->numbering);
  for (int b = 0; b < DVI__BLOCKS; b++) dvi__heap_free(c->of_number[b]);
  *c = (dvi__context){0};
}

/* Return the node of a new input. */
static dvi__node add_input(dvi__context *c, const dvi__kernel_input *input)
{
  dvi__kernel_input *list = dvi__heap_grow(c->input, (size_t)c->input_count, sizeof *list);
  if (list == NULL) {
    (void)dvi__scene_no_memory(c->scene);
    return dvi__constant(c->graph, 0);
  }
  c->input = list;
  list[c->input_count] = *input;
  return dvi__input(c->graph, c->input_count++);
}

/* Return a variable that is the same for all elements. It is found by a table, since there may be
 * as many as coordinates. */
static dvi__node fixed_variable(dvi__context *c, int block, int number)
{
  if (c->of_number[block] == NULL)
    c->of_number[block] = dvi__heap_take((size_t)block_size(c->scene, block),
                                         sizeof **c->of_number);
  if (c->of_number[block] == NULL) {
    (void)dvi__scene_no_memory(c->scene);
    return dvi__constant(c->graph, 0);
  }
  int *known = &c->of_number[block][number];
  if (*known != 0) return dvi__input(c->graph, *known - 1);
  const dvi__node node = add_input(c, &(dvi__kernel_input){.block = block, .base = number});
  *known = c->input_count;
  return node;
}

static int same_variable(const dvi__kernel_input *a, int block, dvi__numbering n, int offset)
{
  return !a->is_data && a->block == block && a->number == n.number && a->base == n.base &&
         a->stride == n.stride && a->offset == offset;
}

dvi__node dvi__variable_node(dvi__context *c, int block, dvi__numbering n, int offset)
{
  if (n.number == NULL && n.stride == 0) return fixed_variable(c, block, n.base + offset);
  for (int i = 0; i < c->input_count; i++)
    if (same_variable(&c->input[i], block, n, offset)) return dvi__input(c->graph, i);
  return add_input(c, &(dvi__kernel_input){.block = block,
                                           .number = n.number,
                                           .base = n.base,
                                           .stride = n.stride,
                                           .offset = offset});
}

dvi__node dvi__sibling_node(dvi__context *c, int input, int block)
{
  const dvi__kernel_input of = c->input[input];
  return dvi__variable_node(c, block, (dvi__numbering){of.number, of.base, of.stride}, of.offset);
}

dvi__node dvi__data_node(dvi__context *c, const double *row)
{
  const size_t bytes = (size_t)c->elements * sizeof *row;
  for (int i = 0; i < c->input_count; i++)
    if (c->input[i].is_data && memcmp(c->input[i].data, row, bytes) == 0)
      return dvi__input(c->graph, i);
  double *copy = dvi__arena_take(&c->scene->arena, (size_t)c->elements, sizeof *copy);
  if (copy == NULL) {
    (void)dvi__scene_no_memory(c->scene);
    return dvi__constant(c->graph, 0);
  }
  memcpy(copy, row, bytes);
  return add_input(c, &(dvi__kernel_input){.is_data = 1, .data = copy, .stride = 1});
}

/* ---- numberings ---- */

/* Keep a list of numbers, once. Numbers in even steps need no list. */
static bool keep_list(dvi__context *c, const int *number, dvi__numbering *numbering)
{
  const size_t bytes = (size_t)c->elements * sizeof *number;
  for (int i = 0; i < c->numbering_count; i++)
    if (memcmp(c->numbering[i].number, number, bytes) == 0) {
      *numbering = c->numbering[i];
      return true;
    }
  dvi__numbering *list = dvi__heap_grow(c->numbering, (size_t)c->numbering_count, sizeof *list);
  int *copy = dvi__arena_take(&c->scene->arena, (size_t)c->elements, sizeof *copy);
  if (list != NULL) c->numbering = list;
  if (list == NULL || copy == NULL) return dvi__scene_no_memory(c->scene);
  memcpy(copy, number, bytes);
  *numbering = list[c->numbering_count++] = (dvi__numbering){.number = copy};
  return true;
}

bool dvi__numbering_of(dvi__context *c, const int *each, int all, int shift, int scale,
                       dvi__numbering *numbering)
{
  *numbering = (dvi__numbering){.base = scale * all + shift};
  if (each == NULL) return true;
  int *number = dvi__heap_take((size_t)c->elements, sizeof *number);
  if (number == NULL) return dvi__scene_no_memory(c->scene);
  for (int e = 0; e < c->elements; e++) number[e] = scale * each[e] + shift;
  const int stride = c->elements > 1 ? number[1] - number[0] : 0;
  int even = 1;
  for (int e = 1; e < c->elements && even; e++) even = number[e] - number[e - 1] == stride;
  *numbering = (dvi__numbering){.base = number[0], .stride = stride};
  const bool kept = even || keep_list(c, number, numbering);
  dvi__heap_free(number);
  return kept;
}
