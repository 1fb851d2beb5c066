#include "method/degenerate/carried_step.h"

#include "core/memory.h"
#include "num/compensated.h"
#include "system/dynamics/one_form.h"

typedef struct carried {
  dvi__one_step one;
  int sign;     /* multipliers of the parasite have this sign; 0 admits every gauge */
  double *room; /* [4*n*n] work for the multipliers */
} carried;

static void carried_step_explain(const dvi__stepper *self, dvi__text *text)
{
  const carried *own = self->own;
  static const char *const gauge[] = {
      ("the gauge must make the symmetric part of Dalpha definite, and not 0, which each step "
       "checks"),
      "every gauge will do",
      "the gauge must make the symmetric part of Dalpha definite, or 0, which each step checks"};
  dvi__text_add(text, "constraint: p = alpha(q), which the steps leave; %s\n",
                gauge[own->sign + 1]);
}

static dvi_status carried_step_place(dvi__stepper *self, const dvi__state *state, double h,
                                     double part)
{
  const dvi__one_step *one = self->own;
  const double *p;
  DVI_TRY(dvi__one_step_momentum(self, state, part, &p));
  dvi__action_place(one->of, state->t, h, state->q, p);
  return DVI_OK;
}

DVI__STEP_KIND(action, carried_step_place, carried_step_explain);

static dvi_status carried_step_make_action(const dvi__stepper *self, const dvi__action_space *space,
                                           dvi__action **action)
{
  DVI_TRY(dvi__action_create(self->system, space, self->counters, action));
  const dvi_status status = dvi__action_prepare_jacobian(*action);
  if (status != DVI_OK) dvi__action_destroy(action);
  return status;
}

dvi_status dvi__carried_step_create(dvi__stepper *self, const dvi__action_space *space, int sign)
{
  const size_t n = (size_t)self->system->n;
  dvi__action *action;
  DVI_TRY(carried_step_make_action(self, space, &action));
  DVI_TRY(dvi__one_step_create(self, sizeof(carried), &kind, action, 0));
  if (sign == 0) return DVI_OK;
  carried *own = self->own;
  own->sign = sign;
  own->room = DVI_NEW(double, 4 * n * n);
  return own->room != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
}

void dvi__carried_step_destroy(dvi__stepper *self)
{
  const carried *own = self->own;
  if (own != NULL) dvi__release(own->room);
  dvi__one_step_destroy(self);
}

dvi_status dvi__carried_step(dvi__stepper *self, dvi__state *state, double h)
{
  const carried *own = self->own;
  const dvi__one_step *one = &own->one;
  double *rows = one->work, *dq_low = one->work;
  if (own->sign != 0)
    DVI_TRY(dvi__form_definite(dvi__action_evaluator(one->of), state->q, own->sign, own->room));
  DVI_TRY(dvi__one_step_solve(self, state, h));
  DVI_TRY(dvi__action_residual(one->of, one->x, rows));
  dvi__action_ends(one->of, one->x, one->dq, dq_low, one->dp);
  DVI_TRY(dvi__one_step_move(self, state, h, one->x));
  dvi__add_compensated_all(self->system->n, state->p, state->p_compensation, one->dp);
  return DVI_OK;
}

void dvi__carried_step_path(const dvi__stepper *self, const double *q0, double h, double tau,
                            double *q, double *v)
{
  const dvi__one_step *one = self->own;
  dvi__action_path(one->of, self->memory + one->last, h, tau, q, v);
  for (int i = 0; q != NULL && i < self->system->n; i++) q[i] += q0[i];
}
