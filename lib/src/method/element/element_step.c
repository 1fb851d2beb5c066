/* Step of one element, by a guess, the ladder of solvers, the branch from shorter steps if that
 * fails, and the new state. */
#include "method/element/element_struct.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "step/element/fixed_point.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/compensated.h"
#include "num/finite.h"
#include "solve/certify.h"

/* Largest number of steps that skip an iteration after it failed. It is one at first, and doubles
 * with each failure. */
static const double longest_wait = 64;

/* Tell whether the rungs follow one after the other. */
int dvi__element_is_ladder(const dvi__element *own)
{
  return own->choice == DVI__SOLVER_AUTO || own->choice == DVI__SOLVER_CERTIFIED;
}

/* ---- create ---- */

static dvi_status element_residual(void *of, const double *Y, double *R)
{
  return dvi__action_residual(((const dvi__element *)of)->action, Y, R);
}

static dvi_status element_prepare_chord(void *of, const double *Y)
{
  return dvi__action_prepare_chord(((const dvi__element *)of)->action, Y);
}

static void element_chord(void *of, double *R)
{
  dvi__action_chord(((const dvi__element *)of)->action, R);
}

static dvi_status element_row_scale(void *of, double *scale, int *unchanged)
{
  *unchanged = !dvi__action_row_scale(((const dvi__element *)of)->action, scale);
  return DVI_OK;
}

static void element_magnitudes(void *of, double *magnitude)
{
  const dvi__element *own = of;
  dvi__action_magnitudes(own->action, magnitude);
  if (own->in_blocks)
    dvi__blocks_add_moved(own->blocks, own->frozen + DVI__FROZEN_POINT, own->Y, magnitude);
}

static void element_fixed_point_begin(void *of, const double *Y)
{
  const dvi__element *own = of;
  if (own->forces_of != NULL)
    dvi__action_fixed_point_continue(own->action, own->forces_of->h / own->forces_of->last_h,
                                     own->forces_of->last_g);
  else
    dvi__action_fixed_point_begin(own->action, Y);
}

static dvi_status element_fixed_point_iterate(void *of, double *change, double *largest)
{
  return dvi__action_iterate(((const dvi__element *)of)->action, change, largest);
}

static void element_fixed_point_end(void *of, double *Y)
{
  const dvi__element *own = of;
  if (!own->late_paths) dvi__action_fixed_point_path(own->action, Y);
}

static const double *element_own_point(void *of)
{
  int count;
  return dvi__action_offsets(((const dvi__element *)of)->action, &count);
}

static dvi_status element_own_residual(void *of, const double *z, double *r)
{
  return dvi__action_iteration_residual(((const dvi__element *)of)->action, z, r);
}

static void element_count_memory(dvi__stepper *self, const dvi__element *own)
{
  self->memory_count = dvi__element_forces(self) + (size_t)dvi__action_forces_count(own->action);
  if (own->decoupled != NULL)
    self->memory_count += DVI__FROZEN_POINT + (size_t)dvi__decoupled_point_size(own->decoupled);
  if (own->keeps_whole)
    self->memory_count += DVI__FROZEN_POINT +
                          (size_t)dvi__pattern_entries(dvi__action_pattern(own->action));
  if (own->blocks != NULL)
    self->memory_count += DVI__FROZEN_POINT + dvi__blocks_numbers(own->blocks);
  if (own->centred) self->memory_count += (size_t)dvi__action_unknowns(own->action);
}

static int element_allocate(dvi__stepper *self, dvi__element *own)
{
  const size_t n = (size_t)self->system->n, unknowns = (size_t)dvi__action_unknowns(own->action);
  element_count_memory(self, own);
  own->Y = DVI_NEW(double, 2 * unknowns + 3 * n + 1 + (size_t)self->system->symmetry_count);
  if (own->Y == NULL) return 0;
  own->guess = own->Y + unknowns;
  own->dq = own->guess + unknowns;
  own->dq_low = own->dq + n;
  own->dp = own->dq_low + n;
  own->supply = own->dp + n;
  return 1;
}

/* Decouple the Jacobian for solvers that may use simplified Newton's method. In a space without a
 * full set of eigenvectors the ladder goes without it. */
static dvi_status element_decouple(dvi__stepper *self, dvi__element *own)
{
  if (own->without_hessian != NULL) return DVI_OK;
  if (!dvi__element_is_ladder(own) && own->choice != DVI__SOLVER_SIMPLIFIED) return DVI_OK;
  const dvi_status status = dvi__decoupled_create(own->action, self->counters, &own->decoupled);
  if (status != DVI_SINGULAR) return status;
  return dvi__element_is_ladder(own)
             ? DVI_OK
             : dvi__fail_in(DVI_BAD_OPTION, "%s: solver=simplified", self->method->name);
}

static dvi_status element_create_solver(dvi__stepper *self, dvi__element *own)
{
  const int has_fixed_point = dvi__action_has_fixed_point(own->action);
  dvi__equations equations = {
      .unknowns = dvi__action_unknowns(own->action),
      .group = dvi__action_space_of(own->action).degree,
      .pattern = dvi__action_pattern(own->action),
      .of = own,
      .residual = element_residual,
      .prepare_chord = element_prepare_chord,
      .chord = element_chord,
      .row_scale = element_row_scale,
      .fixed_point_begin = has_fixed_point ? element_fixed_point_begin : NULL,
      .fixed_point_iterate = has_fixed_point ? element_fixed_point_iterate : NULL,
      .fixed_point_end = has_fixed_point ? element_fixed_point_end : NULL,
      .magnitudes = dvi__action_has_terms(own->action) || self->system->damping > 0
                        ? element_magnitudes
                        : NULL};
  if (dvi__action_has_offsets(own->action)) {
    equations.own_point = element_own_point;
    equations.own_residual = element_own_residual;
    (void)dvi__action_offsets(own->action, &equations.own_unknowns);
  }
  /* unknowns of terms, such as multipliers, have no pivots of their own */
  if (equations.unknowns > self->system->n * equations.group)
    equations.linear = dvi__linear_for_exchanges(equations.unknowns);
  dvi__element_set_newton(&equations);
  dvi__element_admit_march(self);
  return dvi__solver_create(&equations, self->counters, &own->solver);
}

/* Create blocks for the ladder in charts. Forces may be as large as what the blocks hold, and need
 * the whole Jacobian. */
static dvi_status element_create_blocks(const dvi__stepper *self, dvi__element *own)
{
  const int s = dvi__action_space_of(own->action).degree;
  dvi__blocks_destroy(&own->blocks);
  if (!own->centred || !dvi__element_is_ladder(own) || own->has_forces) return DVI_OK;
  return dvi__blocks_create(&self->system->vv, dvi__action_pattern(own->action), s, &own->blocks);
}

/* Take account of a new term, or of weights that depend on h. The ladder begins with the whole
 * Jacobian, and ends with the rounding of rows, because roundings would err to one side otherwise.
 * Unknowns of a term are for Newton's method. */
static dvi_status element_renew_solver(dvi__stepper *self)
{
  dvi__element *own = self->own;
  const dvi__action_space space = dvi__action_space_of(own->action);
  if (dvi__action_unknowns(own->action) > self->system->n * space.degree)
    own->choice = DVI__SOLVER_NEWTON;
  own->keeps_whole = dvi__element_is_ladder(own) || own->choice == DVI__SOLVER_SIMPLIFIED;
  dvi__element_clear_newton(own);
  dvi__decoupled_destroy(&own->decoupled);
  dvi__solver_destroy(&own->solver);
  dvi__release(own->branch);
  own->branch = NULL;
  dvi__release(own->Y);
  own->Y = NULL;
  /* for the memory's count */
  if (own->keeps_whole) DVI_TRY(dvi__action_prepare_jacobian(own->action));
  DVI_TRY(element_create_blocks(self, own));
  if (!element_allocate(self, own))
    return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  return element_create_solver(self, own);
}

/* Leave out what needs Hessians where a potential has none. Solvers that do refuse it. */
static dvi_status element_refuse_hessians(dvi__stepper *self, dvi__element *own)
{
  own->without_hessian = dvi__system_without_hessian(self->system);
  if (own->without_hessian == NULL) return DVI_OK;
  self->follows = self->late_hessians = 0;
  if (own->choice == DVI__SOLVER_AUTO || own->choice == DVI__SOLVER_FIXED_POINT) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED,
                   "%s: solver=%s needs the Hessian of potential '%s', which is declared without "
                   "one; auto and fixed-point need none",
                   self->method->name, dvi__solver_choice(own->choice), own->without_hessian);
}

dvi_status dvi__element_create(dvi__stepper *self, const dvi__action_space *space, int solver)
{
  dvi__element *own = self->own = DVI_NEW(dvi__element, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  self->order = dvi__element_order(space);
  self->symmetric = dvi__symmetric_rule(space->rule);
  self->follows = 1;
  self->late_hessians = 1;
  own->choice = solver;
  own->counters = self->counters;
  DVI_TRY(element_refuse_hessians(self, own));
  DVI_TRY(dvi__action_create(self->system, space, self->counters, &own->action));
  self->bound = dvi__action_has_preconditioner(own->action);
  own->has_forces = self->system->force_count > 0;
  own->has_rates = !self->system->autonomous && dvi__system_has_rates(self->system) == DVI_OK;
  own->quadratic = dvi__element_is_quadratic(self->system);
  own->definite = dvi__element_is_definite(self->system, dvi__action_evaluator(own->action));
  self->weighs_damping = self->system->damping > 0;
  own->late_paths = dvi__action_has_offsets(own->action) && !self->bound && !own->has_forces &&
                    !own->has_rates;
  if (self->system->place_rows > 0) DVI_TRY(dvi__action_constrain(own->action));
  if (self->system->place_rows > 0 || self->weighs_damping) return element_renew_solver(self);
  DVI_TRY(element_decouple(self, own));
  if (!element_allocate(self, own))
    return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  return element_create_solver(self, own);
}

void dvi__element_destroy(dvi__stepper *self)
{
  dvi__element *own = self->own;
  if (own == NULL) return;
  dvi__solver_destroy(&own->solver);
  dvi__element_clear_newton(own);
  dvi__decoupled_destroy(&own->decoupled);
  dvi__blocks_destroy(&own->blocks);
  dvi__action_destroy(&own->action);
  dvi__release(own->branch);
  dvi__release(own->Y);
  dvi__release(own);
}

dvi_status dvi__element_centre(dvi__stepper *self, const dvi__centring *centring)
{
  dvi__element *own = self->own;
  own->centred = 1;
  DVI_TRY(dvi__action_centre(own->action, centring));
  DVI_TRY(dvi__action_carry_forces(own->action));
  return element_renew_solver(self);
}

dvi_status dvi__element_constrain_velocities(dvi__stepper *self, dvi__velocity_rule rule)
{
  dvi__element *own = self->own;
  own->definite = own->quadratic = 0;
  DVI_TRY(dvi__action_constrain_velocities(own->action, rule));
  return element_renew_solver(self);
}

dvi_status dvi__element_add_term(dvi__stepper *self, const dvi__row_term *term)
{
  dvi__element *own = self->own;
  own->definite = own->quadratic = 0;
  DVI_TRY(dvi__action_add_term(own->action, term));
  return element_renew_solver(self);
}

dvi_status dvi__element_keep_lengths(dvi__stepper *self, int count)
{
  return dvi__action_keep_lengths(dvi__element_action(self), count);
}

dvi__action *dvi__element_action(const dvi__stepper *self)
{
  return ((const dvi__element *)self->own)->action;
}

size_t dvi__element_forces(const dvi__stepper *self)
{
  return DVI__LAST_Y + (size_t)dvi__action_unknowns(dvi__element_action(self));
}

int dvi__element_solver(const dvi__stepper *self)
{
  return ((const dvi__element *)self->own)->choice;
}

void dvi__element_start(dvi__stepper *self, const double *v)
{
  memcpy(self->memory + DVI__LAST_Y, v, (size_t)self->system->n * sizeof(double));
}

void dvi__element_put(dvi__element *own, const dvi__element_place *at, double h)
{
  dvi__action_place(own->action, at->t, h, at->q, at->p);
  own->newton.is_frozen = 0;
}

/* ---- solution ---- */

/* Try one rung from the guess. Each rung has its own counter. */
static dvi_status element_solve_by(dvi__stepper *self, const dvi__element_place *at, dvi__rung rung,
                                   double *Y, dvi__solve_report *report)
{
  dvi__element *own = self->own;
  const double size = dvi__largest((size_t)self->system->n, at->q);
  const int patient = own->choice == DVI__SOLVER_FIXED_POINT || own->without_hessian != NULL;
  own->forces_of = rung == DVI__FIXED_POINT && at->last_g != NULL ? at : NULL;
  if (own->forces_of == NULL) DVI_TRY(dvi__element_guess(self, at, Y));
  if (own->centred)
    memcpy(own->guess, Y, (size_t)dvi__action_unknowns(own->action) * sizeof(double));
  const dvi_status status = dvi__solve(own->solver, rung, size, 1, patient, Y, report);
  own->rung = rung;
  if (status == DVI_OK && rung == DVI__FIXED_POINT) self->counters->fixed_points++;
  if (status == DVI_OK && rung == DVI__SIMPLIFIED) self->counters->simplified++;
  if (status == DVI_OK && rung == DVI__NEWTON) self->counters->newtons++;
  return status;
}

/* Tell whether the user, or the steps before, want this iteration. A step without it is counted
 * down. */
static int element_is_due(const dvi__element *own, int choice, double *steps_without)
{
  if (own->choice != choice && !dvi__element_is_ladder(own)) return 0;
  if (*steps_without == 0 || own->choice == choice) return 1;
  --*steps_without;
  return 0;
}

/* Back off. Skip an iteration that failed for 1, 2, 4 ... 64 steps. Success resets the wait. */
static void update_backoff(dvi__stepper *self, dvi_status status, int steps, int wait)
{
  double *last = &self->memory[wait];
  *last = status == DVI_OK ? 0 : *last == 0 ? 1 : fmin(2 * *last, longest_wait);
  self->memory[steps] = *last;
}

/* Solve with the factor of earlier steps as long as that is as good as a new one. `frozen` has all
 * that this depends on, and belongs to the memory, so that a restored run finds the same digits. */
static dvi_status element_solve_simplified(dvi__stepper *self, const dvi__element_place *at,
                                           double *frozen, double *Y, dvi__solve_report *report)
{
  dvi__element *own = self->own;
  own->frozen = frozen;
  own->keeps = frozen[DVI__FROZEN_H] == at->h;
  dvi_status status = element_solve_by(self, at, DVI__SIMPLIFIED, Y, report);
  if (status > 0 && own->keeps) {
    own->keeps = 0;
    status = element_solve_by(self, at, DVI__SIMPLIFIED, Y, report);
  }
  const int good = status == DVI_OK &&
                   (!own->keeps ||
                    dvi__element_keeps(frozen[DVI__FROZEN_ITERATIONS], report->iterations));
  frozen[DVI__FROZEN_H] = good ? at->h : 0;
  if (!own->keeps) frozen[DVI__FROZEN_ITERATIONS] = report->iterations;
  return status;
}

static double *element_frozen_part(const dvi__stepper *self)
{
  const dvi__element *own = self->own;
  return self->memory + dvi__element_forces(self) + dvi__action_forces_count(own->action);
}

/* It is the last but one of the memory. */
size_t dvi__element_blocks_part(const dvi__stepper *self)
{
  const dvi__element *own = self->own;
  return self->memory_count - DVI__FROZEN_POINT - dvi__blocks_numbers(own->blocks) -
         (size_t)dvi__action_unknowns(own->action);
}

static dvi_status element_solve_by_blocks(dvi__stepper *self, const dvi__element_place *at,
                                          double *Y, dvi__solve_report *report)
{
  dvi__element *own = self->own;
  own->by_blocks = own->in_blocks = 1;
  const dvi_status status = element_solve_simplified(
      self, at, self->memory + dvi__element_blocks_part(self), Y, report);
  own->in_blocks = 0;
  return status;
}

/* Solve by the only rung without Hessians. */
static dvi_status element_solve_without(dvi__stepper *self, const dvi__element_place *at, double *Y,
                                        dvi__solve_report *report)
{
  const dvi_status status = element_solve_by(self, at, DVI__FIXED_POINT, Y, report);
  if (status <= 0 || status == DVI_NOT_FINITE) return status;
  return dvi__fail(status,
                   "fixed-point iteration does not converge (last change %.1e), and potential '%s' "
                   "is declared without the Hessian of other solvers; try a step below %.3g",
                   report->correction, ((const dvi__element *)self->own)->without_hessian,
                   fabs(at->h) / 2);
}

/* Solve the element at its place, from a first guess, by the rung that the user or the measured
 * contraction chooses. */
static dvi_status element_solve(dvi__stepper *self, const dvi__element_place *at, double *Y,
                                dvi__solve_report *report)
{
  dvi__element *own = self->own;
  dvi__element_put(own, at, at->h);
  own->by_blocks = 0;
  if (own->without_hessian != NULL) return element_solve_without(self, at, Y, report);
  if ((own->blocks != NULL || !own->keeps_whole || !dvi__element_is_ladder(own)) &&
      element_is_due(own, DVI__SOLVER_FIXED_POINT, &self->memory[DVI__NEWTON_STEPS])) {
    const dvi_status status = own->blocks != NULL
                                  ? element_solve_by_blocks(self, at, Y, report)
                                  : element_solve_by(self, at, DVI__FIXED_POINT, Y, report);
    update_backoff(self, status, DVI__NEWTON_STEPS, DVI__NEWTON_WAIT);
    if (status <= 0) return status;
    own->by_blocks = 0;
  }
  if (dvi__element_is_ladder(own)) DVI_TRY(dvi__element_weigh(own));
  const int can_freeze = own->keeps_whole || (own->decoupled != NULL && !own->is_dear);
  if (can_freeze && element_is_due(own, DVI__SOLVER_SIMPLIFIED, &self->memory[DVI__FULL_STEPS])) {
    const dvi_status status = element_solve_simplified(self, at, element_frozen_part(self), Y,
                                                       report);
    update_backoff(self, status, DVI__FULL_STEPS, DVI__FULL_WAIT);
    if (status <= 0) return status;
  }
  return element_solve_by(self, at, own->choice == DVI__SOLVER_KINSOL ? DVI__KINSOL : DVI__NEWTON,
                          Y, report);
}

/* ---- step ---- */

/* Keep the unknowns, or what they are made of. */
static void element_keep_path(dvi__stepper *self, const double *p0)
{
  const dvi__element *own = self->own;
  const int late = own->late_paths && dvi__action_is_iterated(own->action);
  const size_t numbers = (size_t)(late ? self->system->n : dvi__action_unknowns(own->action));
  self->memory[DVI__LATE] = late;
  memcpy(self->memory + DVI__LAST_Y, late ? p0 : own->Y, numbers * sizeof(double));
}

/* Add the increments to all coordinates and momenta. */
static void add_increments(int n, const dvi__element *own, dvi__state *state)
{
  const double *restrict dq = own->dq, *restrict low = own->dq_low, *restrict dp = own->dp;
  double *restrict q = state->q, *restrict q_compensation = state->q_compensation,
                   *restrict p = state->p, *restrict p_compensation = state->p_compensation;
  for (int i = 0; i < n; i++) {
    dvi__add_compensated(q + i, q_compensation + i, dq[i]);
    dvi__add_compensated(q + i, q_compensation + i, low[i]);
    dvi__add_compensated(p + i, p_compensation + i, dp[i]);
  }
}

void dvi__element_advance(dvi__stepper *self, dvi__state *state, double h)
{
  const dvi__element *own = self->own;
  element_keep_path(self, state->p);
  add_increments(self->system->n, own, state);
  dvi__add_compensated(&state->t, &state->t_compensation, own->duration);
  if (state->supplied != NULL)
    dvi__add_compensated_all(1 + self->system->symmetry_count, state->supplied,
                             state->supplied_compensation, own->supply);
  dvi__element_note_bending(self, h);
  self->memory[DVI__LAST_H] = h;
}

static dvi_status element_ends(dvi__element *own, const double *Y)
{
  dvi__action_ends(own->action, Y, own->dq, own->dq_low, own->dp);
  DVI_TRY(dvi__action_duration(own->action, Y, &own->duration));
  return dvi__action_constrain_end(own->action, Y, own->dp);
}

/* Let KINSOL test the solution. The step keeps the solution of the iteration. KINSOL itself solves
 * those that do not pass. */
static dvi_status element_certify(dvi__stepper *self, const dvi__element_place *at, double *Y,
                                  dvi__solve_report *report)
{
  dvi__element *own = self->own;
  const double size = dvi__largest((size_t)self->system->n, at->q);
  const int has_offsets = dvi__action_has_offsets(own->action) &&
                          dvi__action_is_iterated(own->action);
  const dvi_status status = dvi__certify(own->solver, size, has_offsets ? NULL : Y, report);
  if (status != DVI_NOT_CONVERGED) return status;
  if (has_offsets) dvi__action_fixed_point_path(own->action, Y);
  DVI_TRY(dvi__solve(own->solver, DVI__KINSOL, size, 0, 0, Y, report));
  return element_ends(own, Y);
}

static dvi__element_place element_place(const dvi__stepper *self, const dvi__state *state, double h)
{
  const int continues = self->memory[DVI__LAST_H] != 0 &&
                        dvi__action_has_fixed_point(dvi__element_action(self));
  return (dvi__element_place){state->t,
                              h,
                              state->q,
                              state->p,
                              self->memory[DVI__LAST_H],
                              self->memory + DVI__LAST_Y,
                              continues ? self->memory + dvi__element_forces(self) : NULL};
}

/* Find the path by the ladder, and along the branch where the ladder fails, or is not certain. */
static dvi_status element_find_path(dvi__stepper *self, const dvi__element_place *at,
                                    dvi__solve_report *report)
{
  dvi__element *own = self->own;
  const dvi_status status = self->follow ? DVI_OK : element_solve(self, at, own->Y, report);
  if (status < 0 || own->without_hessian != NULL) return status;
  if (status != DVI_OK || self->follow || (own->centred && dvi__element_strays(self, at)))
    return dvi__element_follow(self, at, status, own->Y);
  if (!own->centred) self->doubt = dvi__element_doubt(self, at, report);
  self->bend = report->bend;
  return DVI_OK;
}

/* Give the sign of the determinant of the Jacobian that solved the step, 0 if not known. */
static int element_sign(const dvi__stepper *self)
{
  const dvi__element *own = self->own;
  const int by_newton = !self->follow && own->choice == DVI__SOLVER_NEWTON;
  return by_newton ? dvi__linear_sign(dvi__solver_linear(own->solver)) : 0;
}

/* Find what forces supply, for the user's balances, and with what time supplies for the test of a
 * solution in doubt. */
static dvi_status element_supply(dvi__stepper *self, const dvi__state *state)
{
  dvi__element *own = self->own;
  const int is_balanced = own->has_forces || self->system->damping > 0 || own->has_rates,
            is_tested = is_balanced && (self->doubt != DVI__SURE || self->asks_work);
  double driving = 0;
  if (!is_tested && state->supplied == NULL) return DVI_OK;
  DVI_TRY(dvi__action_supplies(own->action, own->Y, own->supply));
  if (!is_tested) return DVI_OK;
  if (own->has_rates) DVI_TRY(dvi__action_driving(own->action, own->Y, &driving));
  own->work = own->supply[0] + driving;
  self->work = &own->work;
  return DVI_OK;
}

dvi_status dvi__element_step(dvi__stepper *self, dvi__state *state, double h)
{
  dvi__element *own = self->own;
  dvi__solve_report report = {0};
  const dvi__element_place at = element_place(self, state, h);
  if (own->choice == DVI__SOLVER_CERTIFIED && dvi__element_shows_residuals(own))
    DVI_TRY(dvi__certify_prepare(own->solver, own->most_together));
  dvi__action_soften(own->action, state->side > 1);
  DVI_TRY(element_find_path(self, &at, &report));
  DVI_TRY(element_ends(own, own->Y));
  DVI_TRY(dvi__action_stays_regular(own->action, element_sign(self)));
  dvi__action_forces(own->action, self->memory + dvi__element_forces(self));
  if (own->choice == DVI__SOLVER_CERTIFIED) DVI_TRY(element_certify(self, &at, own->Y, &report));
  DVI_TRY(element_supply(self, state));
  dvi__element_advance(self, state, h);
  return DVI_OK;
}

void dvi__element_path(const dvi__stepper *self, const double *q0, double h, double tau, double *q,
                       double *v)
{
  const dvi__element *own = self->own;
  dvi__action_path(own->action, dvi__element_last_path(self), h, tau, q, v);
  for (int i = 0; q != NULL && i < self->system->n; i++) q[i] += q0[i];
}
