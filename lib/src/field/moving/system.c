/* The field as a mechanical system. */
#include <stdio.h>

#include "core/status.h"
#include "field/moving/moving.h"

/* ---- callbacks ---- */

static int value(double t, const double *q, const double *v, double *L, void *user)
{
  return dvi__moving_sum(user, &(dvi__moving_state){t, q, v}, &(dvi__moving_sums){.L = L});
}

static int gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                    void *user)
{
  return dvi__moving_sum(user, &(dvi__moving_state){t, q, v},
                         &(dvi__moving_sums){.L_q = L_q, .L_v = L_v});
}

static int hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                   double *L_vv, void *user)
{
  return dvi__moving_sum(user, &(dvi__moving_state){t, q, v},
                         &(dvi__moving_sums){.L_qq = L_qq, .L_qv = L_qv, .L_vv = L_vv});
}

static int admit(double t, const double *q, void *user)
{
  return dvi__moving_admit(user, &(dvi__moving_state){.t = t, .q = q});
}

/* ---- symmetries ---- */

static int translate(const double *q, double *xi, void *user)
{
  const dvi__number_translation *of = user;
  const dvi_moving *m = of->moving;
  (void)q;
  for (int i = 0; i < m->nodes * m->numbers; i++)
    if (m->unknown[i] >= 0) xi[m->unknown[i]] = i % m->numbers == of->number;
  return 0;
}

/* Tell if the density has a variable of a component: its value, or its rate. */
static int has_variable(const dvi_moving *m, int component, int rate)
{
  for (int j = 0; j < m->part.variables; j++) {
    const dvi_jet *z = &m->part.variable[j];
    if (z->component == component && z->order[0] + z->order[1] == 0 && !z->rate == !rate) return 1;
  }
  return 0;
}

/* Tell if a translation of one number of all nodes leaves the Lagrangian as it is. */
static int is_symmetry(const dvi_moving *m, int number)
{
  for (int k = 0; k < m->nodes; k++)
    if (m->unknown[k * m->numbers + number] < 0) return 0;
  if (number < m->dimension) return m->translations;
  return m->mean.mean == NULL && !has_variable(m, number - m->dimension, 0);
}

static int find_symmetries(dvi_moving *m, dvi_symmetry *symmetry)
{
  int count = 0;
  for (int k = 0; k < m->numbers; k++) {
    dvi__number_translation *of = &m->translation[count];
    if (!is_symmetry(m, k)) continue;
    *of = (dvi__number_translation){.moving = m, .number = k};
    const int component = k - m->dimension;
    if (component >= 0 && m->components > 1)
      (void)snprintf(of->name, sizeof of->name, "momentum_u%d", component + 1);
    else
      (void)snprintf(of->name, sizeof of->name, "momentum_%c", component >= 0 ? 'u' : "xy"[k]);
    symmetry[count++] = (dvi_symmetry){.name = of->name, .generator = translate, .user = of};
  }
  return count;
}

/* ---- the system ---- */

static dvi_pattern view(const dvi__pattern *pattern)
{
  return (dvi_pattern){.start = pattern->start, .row = pattern->row};
}

static dvi_status check_rates(const dvi_moving *m)
{
  for (int c = 0; c < m->components; c++)
    if (!has_variable(m, c, 1))
      return dvi__fail(DVI_SINGULAR,
                       "moving: the density has no rate of component %d, so that it has no mass: "
                       "add one, or look for static states by dvi_moving_solve",
                       c);
  return DVI_OK;
}

static dvi_lagrangian lagrangian_of(dvi_moving *m)
{
  const dvi_pattern pattern = view(&m->pattern);
  return (dvi_lagrangian){.value = value,
                          .gradient = gradient,
                          .hessian = hessian,
                          .admit = admit,
                          .qq = pattern,
                          .qv = pattern,
                          .vv = pattern,
                          .user = m};
}

static dvi_force viscosity_of(dvi_moving *m)
{
  const dvi_pattern pattern = view(&m->drag_pattern);
  return (dvi_force){.name = "viscosity",
                     .value = dvi__moving_drag,
                     .jacobian = dvi__moving_drag_jacobian,
                     .by_q = pattern,
                     .by_v = pattern,
                     .user = m};
}

static dvi_holonomic arcs_of(dvi_moving *m)
{
  return (dvi_holonomic){.name = "arcs",
                         .count = m->cells - 1,
                         .value = dvi__moving_arc_value,
                         .gradient = dvi__moving_arc_gradient,
                         .hessian = dvi__moving_arc_hessian,
                         .gradients = view(&m->arcs),
                         .qq = view(&m->pattern),
                         .user = m};
}

dvi_status dvi_moving_system_terms(dvi_moving *moving, dvi_system_terms *terms)
{
  if (moving == NULL || terms == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a field and a place for terms are needed");
  DVI_TRY(check_rates(moving));
  const int symmetries = find_symmetries(moving, moving->symmetry);
  const int is_viscous = moving->viscosity > 0, is_equal = moving->motion == DVI_MOVING_EQUAL;
  moving->lagrangian = lagrangian_of(moving);
  moving->viscous = viscosity_of(moving);
  moving->equal = arcs_of(moving);
  *terms = (dvi_system_terms){.dimension = moving->unknowns,
                              .lagrangian = &moving->lagrangian,
                              .symmetries = symmetries > 0 ? moving->symmetry : NULL,
                              .symmetry_count = symmetries,
                              .forces = is_viscous ? &moving->viscous : NULL,
                              .force_count = is_viscous,
                              .holonomics = is_equal ? &moving->equal : NULL,
                              .holonomic_count = is_equal,
                              .autonomous = moving->path == NULL && !moving->part.depends_on_time};
  return DVI_OK;
}

dvi_status dvi_moving_system(dvi_moving *moving, dvi_system **system)
{
  dvi_system_terms terms;
  if (system == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a field and a place for the system are needed");
  *system = NULL;
  DVI_TRY(dvi_moving_system_terms(moving, &terms));
  return dvi_system_create(&terms, system);
}
