#include "method/one_step.h"

#include <string.h>

#include "core/memory.h"
#include "num/compensated.h"
#include "num/finite.h"

static size_t one_step_unknowns(const dvi__one_step *one)
{
  return (size_t)one->kind->pattern(one->of)->columns;
}

/* Give the place of the predictor's numbers. */
static double *predictor_memory(const dvi__stepper *self)
{
  const dvi__one_step *one = self->own;
  return self->memory + one->last + one_step_unknowns(one);
}

/* ---- create ---- */

static int one_step_allocate(dvi__one_step *one, size_t n)
{
  one->predictor.unknowns = one_step_unknowns(one);
  one->predictor.plain = DVI_NEW(double, one_step_unknowns(one));
  one->work = DVI_NEW(double, one_step_unknowns(one));
  one->dq = DVI_NEW(double, n);
  one->dp = DVI_NEW(double, n);
  one->carried = DVI_NEW(double, 2 * n);
  return one->predictor.plain && one->work && one->dq && one->dp && one->carried;
}

dvi_status dvi__one_step_create(dvi__stepper *self, size_t size, const dvi__step_kind *kind,
                                void *of, size_t carried)
{
  dvi__one_step *one = self->own = dvi__allocate(1, size);
  if (one == NULL) {
    kind->destroy(of);
    return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  }
  one->kind = kind;
  one->of = of;
  one->last = DVI__CARRIED + carried;
  one->equations.ladder = one->last + one_step_unknowns(one) +
                          dvi__predictor_memory(one_step_unknowns(one));
  self->memory_count = one->equations.ladder + DVI__LADDER;
  if (!one_step_allocate(one, (size_t)self->system->n))
    return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  /* Coefficients of several kinds of functions have no common unit for each coordinate. */
  dvi__equations equations = {
      .unknowns = (int)one_step_unknowns(one),
      .group = (int)(kind->renewed ? one_step_unknowns(one)
                                   : one_step_unknowns(one) / (size_t)self->system->n),
      .pattern = kind->pattern(of),
      .of = of,
      .residual = kind->residual,
      .jacobian = kind->jacobian,
      .invert = kind->invert,
      .correct = kind->correct,
      .fill = kind->fill,
      .row_scale = kind->row_scale,
      .renewed = kind->renewed,
      .ahead = kind->renewed || (!kind->inexact && dvi__hessian_noise(self->system) == 0)};
  if (kind->has_iteration != NULL && kind->has_iteration(of)) {
    equations.fixed_point_begin = kind->fixed_point_begin;
    equations.fixed_point_iterate = kind->fixed_point_iterate;
    equations.fixed_point_end = kind->fixed_point_end;
    equations.fixed_point_frozen = kind->fixed_point_frozen;
  }
  DVI_TRY(dvi__stationary_create(self, &equations, &one->equations));
  one->x = one->equations.x;
  /* Do not follow the branch for functions that change with h, and for steps over many periods. The
   * measures of a branch, or of a motion, do not apply to them. */
  if (kind->renewed) self->follows = 0;
  return DVI_OK;
}

void dvi__one_step_destroy(dvi__stepper *self)
{
  dvi__one_step *one = self->own;
  if (one == NULL) return;
  dvi__stationary_clear(&one->equations);
  one->kind->destroy(one->of);
  dvi__release(one->predictor.plain);
  dvi__release(one->work);
  dvi__release(one->dq);
  dvi__release(one->dp);
  dvi__release(one->carried);
  dvi__release(one);
}

void dvi__one_step_start(dvi__stepper *self, const double *v)
{
  const dvi__one_step *one = self->own;
  memcpy(self->memory + one->last, v, (size_t)self->system->n * sizeof(double));
}

/* ---- the step ---- */

static dvi_status one_step_guess(dvi__stepper *self, double h, double *x)
{
  dvi__one_step *one = self->own;
  const double last_h = self->memory[DVI__LENGTH], *last = self->memory + one->last;
  if (last_h != 0) {
    one->kind->continued(one->of, h / last_h, last, x);
    dvi__predictor_correct(&one->predictor, predictor_memory(self), h, x);
  } else {
    one->kind->straight(one->of, last, x);
    dvi__predictor_leave(&one->predictor);
  }
  return DVI_OK;
}

dvi_status dvi__one_step_solve(dvi__stepper *self, const dvi__state *state, double h)
{
  dvi__one_step *one = self->own;
  const dvi__stationary_step step = {
      .stepper = self, .state = state, .h = h, .place = one->kind->place, .guess = one_step_guess};
  return dvi__stationary_solve(&one->equations, &step);
}

int dvi__one_step_is_iterated(const dvi__stepper *self)
{
  return ((const dvi__one_step *)self->own)->equations.iterated;
}

dvi_status dvi__one_step_momentum(dvi__stepper *self, const dvi__state *state, double part,
                                  const double **p)
{
  const dvi__one_step *one = self->own;
  const size_t n = (size_t)self->system->n;
  double *alpha = one->carried, *unwanted = alpha + n;
  *p = state->p;
  if (part == 1 || !(self->system->terms & DVI__ONE_FORM)) return DVI_OK;
  memset(one->dq, 0, n * sizeof(double));
  DVI_TRY(dvi__form_gradient(one->kind->evaluator(one->of), state->q, one->dq, unwanted, alpha));
  for (size_t i = 0; i < n; i++) alpha[i] += part * (state->p[i] - alpha[i]);
  *p = alpha;
  return DVI_OK;
}

dvi_status dvi__one_step_move(dvi__stepper *self, dvi__state *state, double h, const double *last)
{
  dvi__one_step *one = self->own;
  double duration = h;
  if (one->kind->duration != NULL) DVI_TRY(one->kind->duration(one->of, one->x, &duration));
  dvi__add_compensated_all(self->system->n, state->q, state->q_compensation, one->dq);
  dvi__add_compensated(&state->t, &state->t_compensation, duration);
  self->memory[DVI__LENGTH] = h;
  memcpy(self->memory + one->last, last, one_step_unknowns(one) * sizeof(double));
  dvi__predictor_learn(&one->predictor, predictor_memory(self), h, one->x);
  return DVI_OK;
}

dvi_status dvi__one_step_constrain(dvi__stepper *self, dvi__state *state)
{
  const dvi__one_step *one = self->own;
  memset(one->dq, 0, (size_t)self->system->n * sizeof(double));
  return dvi__form_gradient(one->kind->evaluator(one->of), state->q, one->dq, one->dp, state->p);
}

void dvi__one_step_explain(const dvi__stepper *self, dvi__text *text)
{
  const dvi__one_step *one = self->own;
  const dvi__pattern *pattern = one->kind->pattern(one->of);
  dvi__text_add(
      text,
      "kernel: implicit; %d unknowns a step, Jacobian with %d entries (%.3g %% of a full one)\n",
      pattern->columns, dvi__pattern_entries(pattern),
      100.0 * dvi__pattern_entries(pattern) / pattern->columns / pattern->columns);
  one->kind->explain(self, text);
  dvi__text_add(text, "solver: %sNewton's method, last a path followed from shorter steps\n",
                !one->equations.has_iteration ? ""
                : one->equations.frozen
                    ? "simplified Newton's method, "
                    : "fixed point while it contracts by 0.45 or better, else ");
}
