#include "step/element/action.h"

#include <string.h>

#include "step/element/action_struct.h"
#include "step/element/fixed_point.h"
#include "space/trial.h"
#include "core/memory.h"
#include "core/status.h"

static int action_allocate_batches(dvi__action *a)
{
  const size_t batch = (size_t)a->n * (size_t)a->r;
  a->t = DVI_NEW(double, a->r);
  a->Q = DVI_NEW(double, batch);
  a->V = DVI_NEW(double, batch);
  a->L_q = DVI_NEW(double, batch);
  a->L_v = DVI_NEW(double, batch);
  a->line = DVI_NEW(double, 2 * (size_t)a->s + 2 * (size_t)a->r);
  a->rows = DVI_NEW(double, (size_t)a->n *(size_t)a->s);
  return a->t && a->Q && a->V && a->L_q && a->L_v && a->line && a->rows;
}

static dvi_status action_allocate_chord(dvi__action *a, dvi_counters *counters)
{
  const dvi_system *system = a->system;
  if (system->lagrangian == NULL || system->terms & DVI__ONE_FORM) return DVI_OK;
  a->middle[0] = DVI_NEW(double, 2 * ((size_t)a->n + (size_t)a->s));
  a->middle_vv = DVI_NEW(double, dvi__pattern_entries(&system->vv));
  if (a->n <= DVI__CHORD_INVERSE) a->chord_inverse = DVI_NEW(double, (size_t)a->n *(size_t)a->n);
  if (!a->middle[0] || !a->middle_vv || (a->n <= DVI__CHORD_INVERSE && !a->chord_inverse))
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for the velocity Hessian");
  a->middle[1] = a->middle[0] + a->n;
  a->middle_basis = a->middle[1] + a->n;
  dvi__trial_in(&a->trial, 0.5L, a->middle_basis, NULL, a->middle_basis + a->s);
  return dvi__linear_create(&system->vv, DVI__LINEAR_AUTO, counters, &a->chord);
}

static dvi_status action_allocate(dvi__action *a, dvi_counters *counters)
{
  if (!a->by_user) DVI_TRY(dvi__joint_check(a->system, 1, a->r > a->s ? a->r : a->s));
  DVI_TRY(dvi__action_fill_tables(a));
  /* the chord solves for a batch of s at once */
  const int capacity = a->r > a->s ? a->r : a->s;
  DVI_TRY(dvi__evaluator_create(a->system, capacity, DVI__GRADIENTS, counters, &a->evaluator));
  if (!action_allocate_batches(a))
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d nodes in %d dimensions", a->r, a->n);
  if (a->by_user) return DVI_OK;
  DVI_TRY(dvi__action_prepare_fixed_point(a));
  DVI_TRY(dvi__action_prepare_transformed(a));
  if (a->system->mass_diagonal != NULL && dvi__action_has_fixed_point(a))
    DVI_TRY(dvi__action_prepare_preconditioner(a));
  if (dvi__action_lags(a)) DVI_TRY(dvi__lagged_create(a->system, a->r, 1, &a->fixed_point.lagged));
  if (dvi__action_has_fixed_point(a)) DVI_TRY(dvi__action_prepare_continuation(a));
  return action_allocate_chord(a, counters);
}

static dvi_status action_create(const dvi_system *system, const dvi__action_space *space,
                                int by_user, dvi_counters *counters, dvi__action **action)
{
  *action = NULL;
  dvi__action *a = DVI_NEW(dvi__action, 1);
  if (a == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory");
  a->system = system;
  a->space = *space;
  a->n = system->n;
  a->s = space->degree;
  a->r = space->nodes;
  a->by_user = by_user;
  const dvi_status status = action_allocate(a, counters);
  if (status != DVI_OK) dvi__action_destroy(&a);
  *action = a;
  return status;
}

dvi_status dvi__action_create(const dvi_system *system, const dvi__action_space *space,
                              dvi_counters *counters, dvi__action **action)
{
  return action_create(system, space, 0, counters, action);
}

dvi_status dvi__action_create_by_user(const dvi_system *system, int functions, int points,
                                      dvi_counters *counters, dvi__action **action)
{
  return action_create(system, &(dvi__action_space){.degree = functions, .nodes = points}, 1,
                       counters, action);
}

/* Free what fixed-point iterations have beside their tables. */
static void action_clear_iterations(dvi__action *a)
{
  dvi__release(a->fit_factor);
  dvi__action_clear_preconditioner(a);
  dvi__action_clear_transformed(a);
  dvi__lagged_destroy(&a->fixed_point.lagged);
}

void dvi__action_destroy(dvi__action **action)
{
  dvi__action *a = *action;
  if (a == NULL) return;
  double *const owned[] = {a->terms.numbers,
                           a->psi,
                           a->dpsi,
                           a->bar,
                           a->node,
                           a->weight,
                           a->undamped,
                           a->end,
                           a->stiffness,
                           a->stiffness_inverse,
                           a->fit_point,
                           a->fit,
                           a->straight,
                           a->shift.table,
                           a->shift_rows,
                           a->rows,
                           a->bar_row,
                           a->slope_row,
                           a->stiffness_row,
                           a->t,
                           a->Q,
                           a->V,
                           a->L_q,
                           a->L_v,
                           a->line,
                           a->middle_vv,
                           a->chord_inverse,
                           a->moved,
                           a->middle[0],
                           a->fixed_point.matrix,
                           a->fixed_point.node,
                           a->fixed_point.slant,
                           a->fixed_point.path,
                           a->fixed_point.start,
                           a->fixed_point.low,
                           a->fixed_point.factor,
                           a->fixed_point.weight,
                           a->Z,
                           a->fixed_point.shift.table,
                           a->fixed_point.kinetic,
                           a->system->vector != NULL ? a->fixed_point.force : NULL,
                           a->system->vector != NULL ? a->fixed_point.Q : NULL};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
  action_clear_iterations(a);
  dvi__action_clear_two_point(a);
  dvi__action_clear_energy(a);
  dvi__action_clear_charts(a);
  dvi__action_clear_constraints(a);
  dvi__action_clear_carried_forces(a);
  dvi__action_clear_rolling(a);
  dvi__linear_destroy(&a->chord);
  dvi__evaluator_destroy(&a->evaluator);
  dvi__action_clear_jacobian(a);
  dvi__release(a);
  *action = NULL;
}

dvi__action_space dvi__action_space_of(const dvi__action *action)
{
  return action->space;
}

int dvi__action_unknowns(const dvi__action *action)
{
  return action->n * action->s + action->terms.unknowns;
}

int dvi__action_nodes(const dvi__action *action)
{
  return action->r;
}

void dvi__action_node(const dvi__action *action, int j, double *tau, double *weight)
{
  *tau = action->node[j];
  *weight = action->undamped != NULL ? action->undamped[j] : action->weight[j];
}

double dvi__action_weight(const dvi__action *action, int j)
{
  return action->weight[j];
}

dvi__evaluator *dvi__action_evaluator(const dvi__action *action)
{
  return action->evaluator;
}

void dvi__action_place(dvi__action *action, double t0, double h, const double *q0, const double *p0)
{
  action->t0 = t0;
  action->h = h;
  action->q0 = q0;
  action->p0 = p0;
  dvi__action_forget_start(action);
  dvi__action_forget_rolling(action);
  dvi__action_damp(action, h);
  const double *restrict node = action->node;
  double *restrict t = action->t;
  for (int j = 0; j < action->r; j++) t[j] = t0 + node[j] * h;
}
