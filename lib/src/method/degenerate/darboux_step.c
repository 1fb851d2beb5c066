#include "method/degenerate/darboux_step.h"

static void darboux_step_explain(const dvi__stepper *self, dvi__text *text)
{
  const dvi__one_step *one = self->own;
  dvi__text_add(text, "one-form: constant in the components of");
  for (int i = 0; i < self->system->n; i++)
    if (!dvi__darboux_is_x(one->of, i)) dvi__text_add(text, " q[%d]", i);
  dvi__text_add(text, ", which stand for the momenta of the others\n");
  dvi__text_add(text, "constraint: p = alpha(q), to the last bit after every step\n");
}

static dvi_status darboux_step_place(dvi__stepper *self, const dvi__state *state, double h,
                                     double part)
{
  const dvi__one_step *one = self->own;
  (void)part;
  dvi__darboux_place(one->of, state->t, h, state->q, state->p);
  return DVI_OK;
}

DVI__STEP_KIND(darboux, darboux_step_place, darboux_step_explain);

dvi_status dvi__darboux_step_create(dvi__stepper *self, dvi__darboux_rule rule, int stages)
{
  dvi__darboux *step;
  self->symmetric = rule == DVI__GAUSS_STAGES || rule == DVI__TRAPEZOIDAL_PAIR;
  self->order = rule == DVI__GAUSS_STAGES ? 2 * stages : rule == DVI__TRAPEZOIDAL_PAIR ? 2 : 1;
  const dvi_status status = dvi__darboux_create(self->system, rule, stages, self->counters, &step);
  if (status != DVI_OK) return dvi__fail_in(status, "%s", self->method->name);
  return dvi__one_step_create(self, sizeof(dvi__one_step), &kind, step, 0);
}

/* Evaluate alpha at q1 again for p1 = alpha(q1). The last stage solves this equation only to the
 * tolerance, and the constraint shall hold to the last bit. */
dvi_status dvi__darboux_step(dvi__stepper *self, dvi__state *state, double h)
{
  const dvi__one_step *one = self->own;
  DVI_TRY(dvi__one_step_solve(self, state, h));
  dvi__darboux_end(one->of, one->x, one->dq);
  DVI_TRY(dvi__one_step_move(self, state, h, one->x));
  return dvi__one_step_constrain(self, state);
}
