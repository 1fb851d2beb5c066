/* The Lagrangian's derivatives in quadruple precision: by the reverse mode over the values of a
 * kernel's nodes, so that they are the derivatives of that same expression to its last digit. */
#include <math.h>
#include <string.h>

#include "expr/function/function_parts.h"
#include "expr/graph_make.h"
#include "text/heap.h"
#include "scene/elaborate/model.h"
#include "expr/quad.h"

#ifdef DVI__QUAD
typedef dvi__quad quad;

/* A point, or derivatives by its variables, block by block. */
typedef struct blocks {
  quad *of[DVI__BLOCKS];
} blocks;

static quad joined(dvi_pair x)
{
  return (quad)x.high + (quad)x.low;
}

static dvi_pair parted(quad x)
{
  const double high = (double)x;
  return (dvi_pair){high, (double)(x - (quad)high)};
}

static quad input_at(const dvi__kernel *kernel, int i, int e, const blocks *x)
{
  const dvi__kernel_input *input = &kernel->input[i];
  return input->is_data ? (quad)input->data[e] : x->of[input->block][dvi__input_number(input, e)];
}

/* The values of all nodes up to the root. */
static void evaluate(const dvi__kernel *kernel, int e, const blocks *x, quad *value)
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

/* Hand the root's derivative by each node on to its operands, from the root down. What the root
 * does not depend on has none: nothing is evaluated for it, for it may have no value. */
static void pull_back(const dvi__kernel *kernel, int e, const quad *value, quad sign, quad *adjoint,
                      const blocks *gradient)
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
      if (gradient->of[input->block] != NULL)
        gradient->of[input->block][dvi__input_number(input, e)] += adjoint[n];
    }
    if (operands == 0) continue;
    dvi__quad_slopes(node[n].op, node[n].value, value[n], value[node[n].a],
                     operands > 1 ? value[node[n].b] : 0, slope);
    adjoint[node[n].a] += adjoint[n] * slope[0];
    if (operands > 1) adjoint[node[n].b] += adjoint[n] * slope[1];
  }
}

static dvi_status add_kernel(const dvi__kernel *kernel, const blocks *x, quad sign,
                             const blocks *gradient)
{
  quad *value = dvi__heap_take(2 * ((size_t)kernel->root + 1), sizeof *value);
  if (value == NULL) return DVI_NO_MEMORY;
  for (int e = 0; e < kernel->elements; e++) {
    evaluate(kernel, e, x, value);
    pull_back(kernel, e, value, sign, value + kernel->root + 1, gradient);
  }
  dvi__heap_free(value);
  return DVI_OK;
}

/* Add sign times the derivatives of a term. */
static dvi_status add_term(const dvi__term *term, const blocks *x, quad sign,
                           const blocks *gradient)
{
  dvi__function *function = term->function;
  dvi_status status = DVI_OK;
  dvi__function_enter(function);
  for (int k = 0; k < function->kernel_count && status == DVI_OK; k++)
    status = add_kernel(dvi__function_kernel(function, k), x, sign, gradient);
  return dvi__function_leave(function, status);
}

static dvi_status add_terms(const dvi_scene *scene, const blocks *x, const blocks *gradient)
{
  if (scene->terms.lagrangian != NULL)
    return add_term(scene->terms.lagrangian->user, x, 1, gradient);
  dvi_status status = add_term(scene->kinetic, x, 1, gradient);
  for (int k = 0; k < scene->terms.potential_count && status == DVI_OK; k++)
    status = add_term(scene->terms.potentials[k].user, x, -1, gradient);
  return status;
}

dvi_status dvi_scene_quad_gradient(const dvi_scene *scene, dvi_pair t, const dvi_pair *q,
                                   const dvi_pair *v, dvi_pair *L_q, dvi_pair *L_v)
{
  if (scene == NULL || q == NULL || v == NULL || L_q == NULL || L_v == NULL)
    return DVI_BAD_ARGUMENT;
  if (dvi__has_factors(scene) || (scene->terms.lagrangian == NULL && scene->kinetic == NULL))
    return DVI_UNSUPPORTED;
  const size_t n = (size_t)scene->n;
  quad *room = dvi__heap_take(4 * n + 1, sizeof *room);
  if (room == NULL) return DVI_NO_MEMORY;
  const blocks x = {.of = {room + 4 * n, room, room + n}},
               gradient = {.of = {NULL, room + 2 * n, room + 3 * n}};
  *x.of[DVI__TIME] = joined(t);
  for (size_t i = 0; i < n; i++)
    x.of[DVI__COORDINATES][i] = joined(q[i]), x.of[DVI__VELOCITIES][i] = joined(v[i]);
  dvi_status status = add_terms(scene, &x, &gradient);
  for (size_t i = 0; i < n && status == DVI_OK; i++) {
    L_q[i] = parted(gradient.of[DVI__COORDINATES][i]);
    L_v[i] = parted(gradient.of[DVI__VELOCITIES][i]);
    if (!isfinite(L_q[i].high) || !isfinite(L_v[i].high)) status = DVI_NOT_FINITE;
  }
  dvi__heap_free(room);
  return status;
}
#else
dvi_status dvi_scene_quad_gradient(const dvi_scene *scene, dvi_pair t, const dvi_pair *q,
                                   const dvi_pair *v, dvi_pair *L_q, dvi_pair *L_v)
{
  (void)scene, (void)t, (void)q, (void)v, (void)L_q, (void)L_v;
  return DVI_UNSUPPORTED;
}
#endif
