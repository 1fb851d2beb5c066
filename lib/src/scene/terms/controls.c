/* The callbacks of controls, on functions of a scene. `user` is the scene. */
#include <math.h>
#include <string.h>

#include "scene/terms/callbacks.h"
#include "scene/terms/fault.h"
#include "text/heap.h"

/* ---- costs ---- */

static int control_cost(double t, const double *q, const double *v, const double *u, double *C,
                        double *C_q, double *C_v, double *C_u, void *user)
{
  const dvi_scene *scene = user;
  dvi__scene_term *term = scene->cost;
  const double *x[DVI__BLOCKS] = {&t, q, v, NULL, u};
  int returned = dvi__fault_check(term, 1, x, 0, dvi__function_value(term->function, 1, x, C));
  if (returned == 0) {
    double *gradient[DVI__BLOCKS] = {
        [DVI__COORDINATES] = C_q, [DVI__VELOCITIES] = C_v, [DVI__INPUTS] = scene->room};
    returned = dvi__fault_check(term, 1, x, 0,
                                dvi__function_gradient(term->function, 1, x, gradient));
  }
  memcpy(C_u, scene->room, (size_t)scene->control_count * sizeof *C_u);
  return returned;
}

/* ---- forces: those with the controls less those without ---- */

static int component_difference(const dvi_scene *scene, const double *const *with,
                                const double *const *without, double *F)
{
  dvi__scene_term *term = scene->control_force;
  double *gradient[DVI__BLOCKS] = {[DVI__MULTIPLIERS] = F};
  int returned = dvi__function_gradient(term->function, 1, with, gradient);
  if (returned == 0) {
    double *rest[DVI__BLOCKS] = {[DVI__MULTIPLIERS] = scene->room};
    returned = dvi__function_gradient(term->function, 1, without, rest);
  }
  for (int i = 0; i < scene->n; i++) F[i] -= scene->room[i];
  return returned;
}

int dvi__term_add_matrix(dvi__scene_term *term, int pair, const double *const *x, double factor,
                         int first, int columns, double *to)
{
  const int n = term->n;
  double *room = term->scene->room;
  dvi_pattern pattern;
  int full;
  double *values[DVI__PAIRS] = {[0] = NULL};
  values[pair] = room;
  int returned = dvi__function_pattern(term->function, pair, &pattern, &full);
  if (returned == 0) returned = dvi__function_second(term->function, 1, x, values);
  for (int j = 0; j < columns && returned == 0; j++) {
    const int c = first + j, begin = full ? c * n : pattern.start[c],
              end = full ? begin + n : pattern.start[c + 1];
    for (int e = begin; e < end; e++)
      to[j * n + (full ? e - begin : pattern.row[e])] += factor * room[e];
  }
  return returned;
}

static int add_matrix(const dvi_scene *scene, int pair, const double *const *x, double factor,
                      int columns, double *to)
{
  return dvi__term_add_matrix(scene->control_force, pair, x, factor, 0, columns, to);
}

static int control_force(double t, const double *q, const double *v, const double *u, double *F,
                         double *F_q, double *F_v, double *F_u, void *user)
{
  const dvi_scene *scene = user;
  dvi__scene_term *term = scene->control_force;
  const double *with[DVI__BLOCKS] = {&t, q, v, term->none, u},
               *without[DVI__BLOCKS] = {&t, q, v, term->none, scene->inputs};
  int returned = component_difference(scene, with, without, F);
  if (returned == 0) returned = add_matrix(scene, DVI__PAIR_WQ, with, 1, scene->n, F_q);
  if (returned == 0) returned = add_matrix(scene, DVI__PAIR_WQ, without, -1, scene->n, F_q);
  if (returned == 0) returned = add_matrix(scene, DVI__PAIR_WV, with, 1, scene->n, F_v);
  if (returned == 0) returned = add_matrix(scene, DVI__PAIR_WV, without, -1, scene->n, F_v);
  if (returned == 0) returned = add_matrix(scene, DVI__PAIR_WU, with, 1, scene->control_count, F_u);
  return dvi__fault_check(term, 1, with, 0, returned);
}

/* ---- making them ---- */

bool dvi__make_inputs(dvi_scene *scene)
{
  const size_t inputs = (size_t)scene->control_count + (size_t)scene->parameter_count,
               n = (size_t)scene->n;
  if (scene->inputs != NULL) return true;
  scene->inputs = dvi__arena_take(&scene->arena, inputs + 1, sizeof *scene->inputs);
  scene->room = dvi__arena_take(&scene->arena, n * (n + inputs) + inputs, sizeof *scene->room);
  if (scene->inputs == NULL || scene->room == NULL) return dvi__scene_no_memory(scene);
  for (int k = 0; k < scene->parameter_count; k++)
    if (scene->parameter[k].settable)
      scene->inputs[scene->control_count + k] = scene->parameter[k].value[0];
  return true;
}

bool dvi__make_control_cost(dvi_scene *scene, dvi__scene_term *term)
{
  scene->cost = term;
  term->role = DVI__ROLE_AUXILIARY;
  if (!dvi__make_inputs(scene)) return false;
  scene->controls = (dvi_controls){.count = scene->control_count,
                                   .cost = control_cost,
                                   .least = scene->control_least,
                                   .most = scene->control_most,
                                   .user = scene};
  return true;
}

static int has_controls(const dvi__scene_term *term)
{
  for (int k = 0; k < dvi__function_kernel_count(term->function); k++) {
    const dvi__kernel *kernel = dvi__function_kernel(term->function, k);
    for (int i = 0; i < kernel->input_count; i++)
      if (!kernel->input[i].is_data && kernel->input[i].block == DVI__INPUTS) return 1;
  }
  return 0;
}

bool dvi__make_control_force(dvi_scene *scene, dvi__scene_term *term)
{
  if (!has_controls(term)) return true;
  scene->control_force = term;
  scene->controls.force = control_force;
  return true;
}
