/* The Lagrangian's derivatives in quadruple precision. */
#include <math.h>

#include "expr/function/function_quad.h"
#include "scene/elaborate/model.h"
#include "text/heap.h"

#ifdef DVI__QUAD
typedef dvi__quad quad;

static quad pair_joined(dvi_pair x)
{
  return (quad)x.high + (quad)x.low;
}

static dvi_pair pair_parted(quad x)
{
  const double high = (double)x;
  return (dvi_pair){high, (double)(x - (quad)high)};
}

/* Add sign times the derivatives of a term. */
static dvi_status add_term(const dvi__scene_term *term, quad sign, quad *const *x,
                           quad *const *gradient)
{
  return dvi__function_quad_add(term->function, sign, x, NULL, gradient);
}

/* Add a force to L_q. It is the derivative of its function by the multipliers, or by v. */
static dvi_status add_force(const dvi_force *force, quad *const *x, quad *const *gradient)
{
  const dvi__scene_term *term = force->user;
  quad *to[DVI__BLOCKS] = {NULL};
  to[term->count > 0 ? DVI__MULTIPLIERS : DVI__VELOCITIES] = gradient[DVI__COORDINATES];
  return add_term(term, 1, x, to);
}

static dvi_status add_terms(const dvi_scene *scene, quad *const *x, quad *const *gradient)
{
  dvi_status status = DVI_OK;
  for (int k = 0; k < scene->terms.force_count && status == DVI_OK; k++)
    status = add_force(&scene->force[k], x, gradient);
  if (status != DVI_OK) return status;
  if (scene->terms.lagrangian != NULL)
    return add_term(scene->terms.lagrangian->user, 1, x, gradient);
  status = add_term(scene->kinetic, 1, x, gradient);
  for (int k = 0; k < scene->terms.potential_count && status == DVI_OK; k++)
    status = add_term(scene->terms.potentials[k].user, -1, x, gradient);
  return status;
}

dvi_status dvi_scene_quad_gradient(const dvi_scene *scene, dvi_pair t, const dvi_pair *q,
                                   const dvi_pair *v, dvi_pair *L_q, dvi_pair *L_v)
{
  if (scene == NULL || q == NULL || v == NULL || L_q == NULL || L_v == NULL)
    return DVI_BAD_ARGUMENT;
  if (dvi__has_factors(scene) || scene->density != NULL || scene->terms.holonomic_count > 0 ||
      scene->terms.nonholonomic_count > 0 || scene->terms.contact_count > 0 ||
      (scene->terms.lagrangian == NULL && scene->kinetic == NULL))
    return DVI_UNSUPPORTED;
  const size_t n = (size_t)scene->n;
  const size_t inputs = (size_t)scene->control_count + (size_t)scene->parameter_count;
  quad *room = dvi__heap_take(5 * n + 1 + inputs, sizeof *room);
  if (room == NULL) return DVI_NO_MEMORY;
  quad *const x[DVI__BLOCKS] = {room + 4 * n, room, room + n, room + 4 * n + 1, room + 5 * n + 1};
  quad *const gradient[DVI__BLOCKS] = {NULL, room + 2 * n, room + 3 * n};
  *x[DVI__TIME] = pair_joined(t);
  for (size_t i = 0; i < n; i++) {
    x[DVI__COORDINATES][i] = pair_joined(q[i]);
    x[DVI__VELOCITIES][i] = pair_joined(v[i]);
  }
  dvi_status status = add_terms(scene, x, gradient);
  for (size_t i = 0; i < n && status == DVI_OK; i++) {
    gradient[DVI__COORDINATES][i] -= scene->terms.damping * gradient[DVI__VELOCITIES][i];
    L_q[i] = pair_parted(gradient[DVI__COORDINATES][i]);
    L_v[i] = pair_parted(gradient[DVI__VELOCITIES][i]);
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
