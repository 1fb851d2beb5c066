/* The first guess of a step, and what it learns from the last one. */
#include <math.h>

#include "core/status.h"
#include "method/element/element_struct.h"
#include "num/finite.h"
#include "step/element/fixed_point.h"

const double *dvi__element_last_path(const dvi__stepper *self)
{
  const dvi__element *own = self->own;
  const double *memory = self->memory, *last = memory + DVI__LAST_Y;
  if (!own->late_paths || memory[DVI__LATE] == 0) return last;
  dvi__action_path_of_forces(own->action, memory[DVI__LAST_H], last,
                             memory + dvi__element_forces(self), own->guess);
  return own->guess;
}

/* Give what the last path of a step as long as this one had more than the path before it continued,
 * in charts. NULL for others. It is the last part of the memory. */
static double *element_bending(dvi__stepper *self, double h)
{
  const dvi__element *own = self->own;
  if (!own->centred || self->memory[DVI__LAST_H] != h) return NULL;
  return self->memory + self->memory_count - dvi__action_unknowns(own->action);
}

/* Bend a straight guess by iterations with the kinetic part of the Jacobian, each of which gains an
 * order in h. Returns 0 if they fail, or do not contract, as those of thin bodies that spin. Then Y
 * is spoilt. */
static int element_bend_line(dvi__stepper *self, double *Y)
{
  enum { BENDS = 3 };
  const dvi__element *own = self->own;
  const size_t unknowns = (size_t)dvi__action_unknowns(own->action);
  double last = HUGE_VAL;
  if (dvi__action_prepare_chord(own->action, Y) != DVI_OK) return 0;
  for (int k = 0; k < BENDS; k++) {
    self->counters->residuals++;
    if (dvi__action_residual(own->action, Y, own->guess) != DVI_OK) return 0;
    dvi__action_chord(own->action, own->guess);
    const double change = dvi__largest(unknowns, own->guess);
    if (!(change < last)) return 0;
    last = change;
    for (size_t i = 0; i < unknowns; i++) Y[i] -= own->guess[i];
  }
  return 1;
}

/* Guess the first step. In charts it may turn far. Unknowns of terms have no kinetic part. */
static dvi_status element_first_guess(dvi__stepper *self, const dvi__element_place *at, double *Y)
{
  const dvi__element *own = self->own;
  const int unknowns = dvi__action_unknowns(own->action),
            degree = dvi__action_space_of(own->action).degree;
  DVI_TRY(dvi__element_straight(self, at, Y));
  if (!own->centred || unknowns > self->system->n * degree) return DVI_OK;
  return element_bend_line(self, Y) ? DVI_OK : dvi__element_straight(self, at, Y);
}

/* In charts steps turn far, and the path bends away from the continued one as the last path did. */
dvi_status dvi__element_guess(dvi__stepper *self, const dvi__element_place *at, double *Y)
{
  dvi__element *own = self->own;
  const double *bending = element_bending(self, at->h);
  if (at->last_h == 0) return element_first_guess(self, at, Y);
  dvi__action_continue(own->action, at->h / at->last_h, dvi__element_last_path(self), Y);
  for (int i = 0; bending != NULL && i < dvi__action_unknowns(own->action); i++) Y[i] += bending[i];
  dvi__action_begin_multipliers(own->action, Y);
  return DVI_OK;
}

void dvi__element_note_bending(dvi__stepper *self, double h)
{
  const dvi__element *own = self->own;
  const int unknowns = dvi__action_unknowns(own->action);
  const double *last = element_bending(self, h);
  double *bending = self->memory + self->memory_count - unknowns;
  if (!own->centred) return;
  for (int i = 0; i < unknowns; i++)
    bending[i] = self->memory[DVI__LAST_H] == 0 || self->follow
                     ? 0
                     : own->Y[i] - own->guess[i] + (last != NULL ? last[i] : 0);
}
