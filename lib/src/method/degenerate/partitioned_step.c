#include "method/degenerate/partitioned_step.h"

#include "num/compensated.h"

/* The memory holds the multiplier of the last step [n]. */
enum { MULTIPLIER = DVI__CARRIED };

typedef struct partitioned {
  dvi__one_step one;
  dvi__projection projection;
} partitioned;

static void partitioned_step_explain(const dvi__stepper *self, dvi__text *text)
{
  const partitioned *own = self->own;
  if (self->system->terms & DVI__ONE_FORM)
    dvi__text_add(text, "constraint: p = alpha(q), %s\n",
                  own->projection == DVI__NO_PROJECTION ? "which the steps leave"
                                                        : "to the last bit after every step");
}

static dvi_status partitioned_step_place(dvi__stepper *self, const dvi__state *state, double h,
                                         double part)
{
  const dvi__one_step *one = self->own;
  const double *p;
  DVI_TRY(dvi__one_step_momentum(self, state, part, &p));
  dvi__partitioned_place(one->of, state->t, h, state->q, p, self->memory + MULTIPLIER);
  return DVI_OK;
}

DVI__STEP_PARTS(partitioned)
DVI__STEP_KIND(partitioned, partitioned_step_place, partitioned_step_explain,
               DVI__STEP_PART_MEMBERS);

dvi_status dvi__partitioned_step_create(dvi__stepper *self, dvi__tableau tableau, int stages,
                                        dvi__projection projection)
{
  dvi__partitioned *step;
  const dvi_status status = dvi__partitioned_create(self->system, tableau, stages, projection,
                                                    self->counters, &step);
  if (status != DVI_OK) return dvi__fail_in(status, "%s", self->method->name);
  DVI_TRY(dvi__one_step_create(self, sizeof(partitioned), &kind, step, (size_t)self->system->n));
  ((partitioned *)self->own)->projection = projection;
  return DVI_OK;
}

static void keep_multiplier(dvi__stepper *self)
{
  const partitioned *own = self->own;
  const int n = self->system->n, m = dvi__partitioned_pattern(own->one.of)->columns / n;
  for (int i = 0; i < n; i++)
    self->memory[MULTIPLIER + i] = own->projection != DVI__NO_PROJECTION ? own->one.x[i * m + m - 1]
                                                                         : 0;
}

/* Evaluate p = alpha(q) again where the projection imposes the constraint. Then the constraint
 * holds to the last bit. */
dvi_status dvi__partitioned_step(dvi__stepper *self, dvi__state *state, double h)
{
  const partitioned *own = self->own;
  const dvi__one_step *one = &own->one;
  DVI_TRY(dvi__one_step_solve(self, state, h));
  if (own->projection == DVI__NO_PROJECTION)
    DVI_TRY(dvi__partitioned_residual(one->of, one->x, one->work));
  dvi__partitioned_ends(one->of, one->x, one->dq, one->dp);
  keep_multiplier(self);
  DVI_TRY(dvi__one_step_move(self, state, h, one->x));
  if (own->projection != DVI__NO_PROJECTION) return dvi__one_step_constrain(self, state);
  dvi__add_compensated_all(self->system->n, state->p, state->p_compensation, one->dp);
  return DVI_OK;
}

const double *dvi__partitioned_step_multiplier(const dvi__stepper *self)
{
  const partitioned *own = self->own;
  return own->projection == DVI__NO_PROJECTION ? NULL : self->memory + MULTIPLIER;
}
