#include "method/hamiltonian/phase_step.h"

#include <math.h>

#include "step/hamiltonian/phase_element.h"
#include "method/degenerate/dg_step.h"
#include "num/compensated.h"
#include "num/finite.h"

/* The memory holds the largest motions of a step and the largest jumps so far, each for q and for
 * p. Behind them stand the jumps of both [n] and the multiplier of the node [m]. */
enum { MOTION = DVI__CARRIED, LARGEST_JUMP = MOTION + 2, JUMP = LARGEST_JUMP + 2 };

typedef struct phase_step {
  dvi__one_step one;
  int alarm;
  const char *remedy;
} phase_step;

static double *phase_step_multiplier(const dvi__stepper *self)
{
  return self->memory + JUMP + 2 * self->system->n;
}

static void phase_step_explain(const dvi__stepper *self, dvi__text *text)
{
  const phase_step *own = self->own;
  dvi__text_add(text, "constraint: %d functions phi(q,p), 0 after every step\n",
                dvi_system_constraint_count(self->system));
  dvi__explain_jumps(own->alarm, text);
}

static dvi_status phase_step_place(dvi__stepper *self, const dvi__state *state, double h,
                                   double part)
{
  const dvi__one_step *one = self->own;
  (void)part;
  return dvi__phase_element_place(one->of, state->t, h, state->q, state->p,
                                  phase_step_multiplier(self));
}

DVI__STEP_ITERATION(phase_element)

DVI__STEP_KIND(phase_element, phase_step_place, phase_step_explain, DVI__STEP_ITERATES,
               .fixed_point_frozen = 1);

dvi_status dvi__phase_step_create(dvi__stepper *self, int degree, int moments, int alarm)
{
  dvi__phase_element *step;
  const size_t n = (size_t)self->system->n, m = (size_t)dvi_system_constraint_count(self->system);
  self->symmetric = 1;
  DVI_TRY(dvi__phase_element_create(self->system, degree, moments, self->counters, &step));
  DVI_TRY(dvi__one_step_create(self, sizeof(phase_step), &kind, step, 4 + 2 * n + m));
  phase_step *own = self->own;
  own->alarm = alarm;
  own->remedy = moments < degree
                    ? "from the start on, an even degree with all its moments keeps it small"
                    : "from the start on, smaller steps keep it small for longer";
  return DVI_OK;
}

/* Remove the parasite from the multiplier at the start. The parasite changes its sign from node to
 * node, so that a step forth and one back separate it from the smooth branch up to the second
 * difference of the latter. The formula is lambda <- (lambda(h) + 2 lambda + lambda(-h))/4. */
static dvi_status phase_step_settle_multiplier(dvi__stepper *self, const dvi__state *state,
                                               double h)
{
  const dvi__one_step *one = self->own;
  const int m = dvi_system_constraint_count(self->system);
  double *there = one->work;
  for (int k = 0; k < 2; k++) {
    DVI_TRY(dvi__one_step_solve(self, state, h));
    dvi__phase_element_end(one->of, one->x, one->dq, one->dp, self->memory + JUMP);
    DVI_TRY(dvi__one_step_solve(self, state, -h));
    dvi__phase_element_end(one->of, one->x, one->dq, one->dp, there);
    for (int a = 0; a < m; a++)
      phase_step_multiplier(self)[a] = 0.25 * (self->memory[JUMP + a] +
                                               2 * phase_step_multiplier(self)[a] + there[a]);
  }
  return DVI_OK;
}

/* Check the jumps of q and of p separately. A jump is the force of the constraint, and may be large
 * while nothing moves. The parasite changes its sign from node to node, and so the jump changes by
 * twice the size of the parasite. A change is too large if it exceeds the motion and 1.5 times the
 * largest jump so far. */
static dvi_status phase_step_check_jumps(dvi__stepper *self)
{
  const phase_step *own = self->own;
  const dvi__one_step *one = &own->one;
  const size_t n = (size_t)self->system->n;
  const double *const moved[] = {one->dq, one->dp}, *change = one->work, rounding = 1e-10;
  double *motion = self->memory + MOTION, *largest = self->memory + LARGEST_JUMP,
         *jump = self->memory + JUMP, size[2], changed[2];
  int rings = -1;
  DVI_TRY(dvi__phase_element_jump(one->of, one->x, jump, one->work));
  dvi__phase_element_sizes(one->of, one->x, size);
  for (int i = 0; i < 2; i++, jump += n, change += n) {
    changed[i] = dvi__largest(n, change);
    motion[i] = fmax(motion[i], dvi__largest(n, moved[i]));
    largest[i] = fmax(largest[i], dvi__largest(n, jump));
    if (changed[i] > fmax(motion[i], 1.5 * largest[i]) + rounding * size[i]) rings = i;
  }
  return rings < 0 ? DVI_OK
                   : dvi__ring_alarm(self, own->alarm, "the change of the jump", changed[rings],
                                     motion[rings], own->remedy);
}

dvi_status dvi__phase_step(dvi__stepper *self, dvi__state *state, double h)
{
  const dvi__one_step *one = self->own;
  if (self->memory[DVI__LENGTH] == 0) DVI_TRY(phase_step_settle_multiplier(self, state, h));
  DVI_TRY(dvi__one_step_solve(self, state, h));
  dvi__phase_element_end(one->of, one->x, one->dq, one->dp, phase_step_multiplier(self));
  DVI_TRY(phase_step_check_jumps(self));
  DVI_TRY(dvi__one_step_move(self, state, h, one->x));
  dvi__add_compensated_all(self->system->n, state->p, state->p_compensation, one->dp);
  return DVI_OK;
}

const double *dvi__phase_step_multiplier(const dvi__stepper *self)
{
  return phase_step_multiplier(self);
}

const double *dvi__phase_step_jump(const dvi__stepper *self)
{
  return self->memory + JUMP;
}
