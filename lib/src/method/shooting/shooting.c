/* Shooting makes the discrete Lagrangian, or Hamiltonian, from a one-step method and a quadrature.
 *
 *     Ld(q0,q1) = h sum_i b_i L(q^i, v^i),   q^0 = q0,   q^n = q1,
 *     (q^{i+1},v^{i+1}) = Psi_{(c_{i+1}-c_i)h}(q^i,v^i),   p0 = -D1 Ld,   p1 = D2 Ld
 *
 * The unknown is the v^0 for which the shot meets both p0 and q1 (step/onestep/shot_step.h). The
 * one-step method may be explicit. The step is symplectic, and has the symmetries under which the
 * one-step method is equivariant. The quadrature has both ends among its nodes. Discrete
 * Hamiltonians of types 2 and 3 generate the step for Hamiltonians, too, which may be degenerate.
 * Type 2 is H+(q0,p1) = p1.Q - S of the shot that ends with the momentum p1. Type 3 is
 * H-(p0,q1) = -p0.k0 - S of the shot that starts with p0. The order is the lower of the orders of
 * the one-step method and of the quadrature. Type 1 is symmetric if both are, and then types 2 and
 * 3 are adjoint to each other. Source: Leok and Shingel 2012, sec. 3; Patrick and Cuell 2009; Leok
 * and Zhang 2011 (types 2 and 3). */
#include <string.h>

#include "step/onestep/shot_step.h"
#include "step/onestep/stacked_shot.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/shooting/shooting_options.h"
#include "method/stationary.h"
#include "num/compensated.h"
#include "num/finite.h"
#include "system/rescale/transformed.h"

enum { SHOT_MOST = 2000 }; /* 128 MB a matrix */

typedef struct shooter {
  /* The unknowns are the start of the shot, or all its stages. One of the two is NULL. */
  dvi__shot_step *shot;
  dvi__stacked_shot *stacked;
  const dvi__pattern *pattern;
  dvi__stationary equations;
  int unknowns, order; /* order of the one-step method */
  double tolerance;    /* tolerance of the residual (default 0, roundoff) */
  double *values;      /* [entries] of the Jacobian, NULL without a tolerance */
  double *guess, *R;   /* [unknowns]; the arrays below lie behind guess */
  double *v, *dq, *dp; /* [n] */
} shooter;

/* ---- create ---- */

static int shooting_allocate(shooter *own, size_t n)
{
  const size_t z = (size_t)own->unknowns;
  double *at = own->guess = DVI_NEW(double, 2 * z + 3 * n);
  if (own->tolerance > 0) own->values = DVI_NEW(double, dvi__pattern_entries(own->pattern));
  if (at == NULL || (own->values == NULL && own->tolerance > 0)) return 0;
  own->R = at + z;
  own->v = own->R + z;
  own->dq = own->v + n;
  own->dp = own->dq + n;
  return 1;
}

/* Set the scale of the rows, which have units of q as the unknowns. */
static dvi_status shooting_row_scale(void *of, double *scale, int *unchanged)
{
  const shooter *own = of;
  for (int i = 0; i < own->unknowns; i++) scale[i] = 1;
  *unchanged = 1;
  return DVI_OK;
}

static dvi_status shooting_residual(void *of, const double *x, double *R)
{
  const shooter *own = of;
  return own->stacked != NULL ? dvi__stacked_shot_residual(own->stacked, x, R)
                              : dvi__shot_step_residual(own->shot, x, R);
}

static dvi_status shooting_jacobian(void *of, const double *x, double *values)
{
  const shooter *own = of;
  return own->stacked != NULL ? dvi__stacked_shot_jacobian(own->stacked, x, values)
                              : dvi__shot_step_jacobian(own->shot, x, values);
}

/* Return 1 if all stages as unknowns cost less than the start alone. This holds for sparse systems
 * with more coordinates than the system of all stages has blocks of 2n. An explicit method needs
 * six times as many, because its shot solves nothing. Both were measured with chains of masses. */
static int stages_are_cheaper(const dvi_system *system, const dvi__runge_kutta *method,
                              const dvi__course *course)
{
  enum { EXPLICIT_GAIN = 6, LEAST_EMPTY = 4 };
  const int blocks = 2 * (method->stages + 1) * course->pieces + 1;
  if (system->n > SHOT_MOST) return 1;
  return system->mass_diagonal != NULL &&
         system->n > (method->is_explicit ? EXPLICIT_GAIN : 1) * blocks &&
         (double)LEAST_EMPTY * dvi__pattern_entries(&system->qq) <= (double)system->n * system->n;
}

static dvi_status choose_solve(dvi__stepper *self, const dvi__runge_kutta *method,
                               const dvi__course *course)
{
  int *choice = &self->settings.value[DVI__SHOOTING_SOLVE];
  const int possible = self->settings.value[DVI__SHOOTING_TYPE] == 1 && method->series == 0 &&
                       course->count == 0;
  if (*choice != DVI__SHOOTING_AUTO) return DVI_OK;
  DVI_TRY(dvi__system_prepare_hessian(self->system));
  *choice = possible && stages_are_cheaper(self->system, method, course) ? DVI__SHOOTING_BY_STAGES
                                                                         : DVI__SHOOTING_BY_SHOT;
  return DVI_OK;
}

static dvi_status make_step(dvi__stepper *self, const dvi__runge_kutta *method,
                            const dvi__course *course)
{
  shooter *own = self->own;
  DVI_TRY(choose_solve(self, method, course));
  const int choice = self->settings.value[DVI__SHOOTING_SOLVE];
  if (choice == DVI__SHOOTING_BY_SHOT) {
    if (self->system->n > SHOT_MOST)
      return dvi__fail(
          DVI_UNSUPPORTED,
          "solve=shot has full matrices of 2n = %d unknowns, and is for up to %d coordinates; "
          "solve=stages, with type=1, a tableau and a quadrature by values, is sparse",
          2 * self->system->n, SHOT_MOST);
    DVI_TRY(dvi__shot_step_create(self->system, self->settings.value[DVI__SHOOTING_TYPE], method,
                                  course, self->counters, &own->shot));
    own->pattern = dvi__shot_step_pattern(own->shot);
    return DVI_OK;
  }
  if (self->settings.value[DVI__SHOOTING_TYPE] != 1)
    return dvi__fail(DVI_BAD_OPTION, "solve=stages is for type=1; leave it out");
  if (method->series > 0 || course->count > 0)
    return dvi__fail(DVI_BAD_OPTION, "solve=stages is for one-step methods with a tableau and "
                                     "quadratures by values; leave it out");
  DVI_TRY(dvi__stacked_shot_create(self->system, method, course, self->counters, &own->stacked));
  own->pattern = dvi__stacked_shot_pattern(own->stacked);
  return DVI_OK;
}

static dvi_status shooting_initialise(dvi__stepper *self, const dvi__runge_kutta *method,
                                      const dvi__course *course)
{
  shooter *own = self->own;
  DVI_TRY(make_step(self, method, course));
  own->unknowns = own->pattern->columns;
  dvi__equations equations = {.unknowns = own->unknowns,
                              .pattern = own->pattern,
                              .of = own,
                              .residual = shooting_residual,
                              .jacobian = shooting_jacobian,
                              .row_scale = shooting_row_scale,
                              .noise = dvi__hessian_noise(self->system),
                              .ahead = own->shot != NULL,
                              .rough = 1};
  DVI_TRY(dvi__stationary_create(self, &equations, &own->equations));
  return shooting_allocate(own, (size_t)self->system->n) ? DVI_OK
                                                         : dvi__fail(DVI_NO_MEMORY, "no memory");
}

static dvi_status shooting_create(dvi__stepper *self)
{
  dvi__shooting_plan plan;
  DVI_TRY(dvi__shooting_choose(self, &plan));
  shooter *own = self->own = DVI_NEW(shooter, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "shooting: no memory");
  const int order = plan.method.order;
  own->tolerance = self->settings.number[DVI__SHOOTING_TOLERANCE];
  own->order = order;
  self->order = order < plan.quadrature_order ? order : plan.quadrature_order;
  self->symmetric = plan.method.symmetric && self->settings.value[DVI__SHOOTING_TYPE] == 1;
  self->memory_count = (size_t)self->system->n;
  const dvi_status status = shooting_initialise(self, &plan.method, &plan.course);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "shooting");
}

static void shooting_destroy(dvi__stepper *self)
{
  shooter *own = self->own;
  if (own == NULL) return;
  dvi__stationary_clear(&own->equations);
  dvi__shot_step_destroy(&own->shot);
  dvi__stacked_shot_destroy(&own->stacked);
  dvi__release(own->guess);
  dvi__release(own->values);
  dvi__release(own);
}

/* ---- the step ---- */

/* Take v as the first guess for the velocity, which the memory holds. */
static void shooting_start(dvi__stepper *self, const double *v)
{
  memcpy(self->memory, v, (size_t)self->system->n * sizeof *v);
}

/* Iterate by Newton's method until the residual is below the user's tolerance. */
static dvi_status solve_loosely(shooter *own, double size)
{
  enum { MOST = 40 };
  double correction = 0, *x = own->equations.x;
  memcpy(x, own->guess, (size_t)own->unknowns * sizeof *x);
  DVI_TRY(dvi__solver_jacobian(own->equations.solver, x, own->values));
  DVI_TRY(dvi__solver_take_jacobian(own->equations.solver, own->values));
  for (int i = 0; i < MOST; i++) {
    DVI_TRY(shooting_residual(own, x, own->R));
    if (dvi__largest((size_t)own->unknowns, own->R) <= own->tolerance * size) return DVI_OK;
    dvi__solver_apply_factor(own->equations.solver, own->R);
    for (int k = 0; k < own->unknowns; k++) x[k] -= own->R[k];
    correction = dvi__largest((size_t)own->unknowns, own->R);
  }
  return dvi__fail(DVI_NOT_CONVERGED, "Newton's method does not reach the tolerance (change %.1e)",
                   correction);
}

/* Place the equations and the guess, which comes from a shot. */
static dvi_status shooting_place(dvi__stepper *self, const dvi__state *state, double h, double part)
{
  const shooter *own = self->own;
  if (own->stacked != NULL)
    return dvi__stacked_shot_place(own->stacked, state->t, h, h / part, state->q, state->p, own->v,
                                   own->guess);
  return dvi__shot_step_place(own->shot, state->t, h, h / part, state->q, state->p, own->v,
                              own->guess);
}

static dvi_status shooting_guess(dvi__stepper *self, double h, double *x)
{
  const shooter *own = self->own;
  (void)h;
  memcpy(x, own->guess, (size_t)own->unknowns * sizeof *x);
  return DVI_OK;
}

static dvi_status shooting_solve(dvi__stepper *self, const dvi__state *state, double h)
{
  shooter *own = self->own;
  if (own->tolerance > 0) {
    DVI_TRY(shooting_place(self, state, h, 1));
    return solve_loosely(own, dvi__largest((size_t)self->system->n, state->q));
  }
  const dvi__stationary_step step = {
      .stepper = self, .state = state, .h = h, .place = shooting_place, .guess = shooting_guess};
  DVI_TRY(dvi__stationary_solve(&own->equations, &step));
  /* The ends belong to the last residual of all stages. */
  return own->stacked != NULL ? shooting_residual(own, own->equations.x, own->R) : DVI_OK;
}

static void find_ends(const shooter *own)
{
  if (own->stacked != NULL)
    dvi__stacked_shot_ends(own->stacked, own->dq, own->dp);
  else
    dvi__shot_step_ends(own->shot, own->equations.x, own->dq, own->dp);
}

static dvi_status find_duration(const dvi__stepper *self, double h, double *duration)
{
  const shooter *own = self->own;
  *duration = h;
  if (dvi__transformed_of(self->system) == NULL) return DVI_OK;
  if (own->stacked != NULL) return dvi__stacked_shot_duration(own->stacked, duration);
  return dvi__shot_step_duration(own->shot, own->equations.x, duration);
}

static dvi_status shooting_step(dvi__stepper *self, dvi__state *state, double h)
{
  const shooter *own = self->own;
  double duration;
  memcpy(own->v, self->memory, (size_t)self->system->n * sizeof *own->v);
  DVI_TRY(shooting_solve(self, state, h));
  find_ends(own);
  DVI_TRY(find_duration(self, h, &duration));
  memcpy(self->memory, own->v, (size_t)self->system->n * sizeof *own->v);
  dvi__add_compensated_all(self->system->n, state->q, state->q_compensation, own->dq);
  dvi__add_compensated_all(self->system->n, state->p, state->p_compensation, own->dp);
  dvi__add_compensated(&state->t, &state->t_compensation, duration);
  return DVI_OK;
}

static void shooting_explain(const dvi__stepper *self, dvi__text *text)
{
  const shooter *own = self->own;
  dvi__shooting_explain_options(&self->settings, own->order, text);
  if (own->stacked != NULL)
    dvi__text_add(text,
                  "kernel: stages and their costates; %d unknowns a step, Jacobian with %d entries "
                  "(%.3g %% of a full one)\n",
                  own->unknowns, dvi__pattern_entries(own->pattern),
                  100.0 * dvi__pattern_entries(own->pattern) / own->unknowns / own->unknowns);
  else
    dvi__text_add(text,
                  "kernel: shots from the start, their derivatives by costates; %d unknowns a "
                  "step, full Jacobian\n",
                  own->unknowns);
  dvi__text_add(text, "solver: Newton's method, last a path followed from shorter steps\n");
}

const dvi__method dvi__shooting = {
    .name = "shooting",
    .summary =
        "any one-step method and a quadrature with both ends; order that of the lower of both",
    .cite = "LeokShingel2012",
    .keys = dvi__shooting_keys,
    .uses = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__POTENTIAL | DVI__HAMILTONIAN |
            DVI__VECTOR_POTENTIAL,
    .create = shooting_create,
    .destroy = shooting_destroy,
    .start = shooting_start,
    .step = shooting_step,
    .explain = shooting_explain,
};
