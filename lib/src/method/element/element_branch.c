/* The branch of an element's solutions from h = 0, which is followed, and to which a solution may
 * belong or not. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/element/element_struct.h"
#include "num/finite.h"

/* Largest turn in radians between a guess and its solution in charts. Other solutions were found by
 * a third of a radian and more away, but by a fortieth where the smallest moment of inertia is 1e-5
 * of the others. Steps below half a radian are nearer to their guess. */
static const double near_in_charts = 0.03;

/* Largest turn between an extrapolated guess and the next solution of a branch. */
static const double follows_in_charts = 0.01;

/* Guess a straight line along the velocity at the start, which is found from that of the last
 * path. */
dvi_status dvi__element_straight(dvi__stepper *self, const dvi__element_place *at, double *Y)
{
  dvi__element *own = self->own;
  if (at->last_h != 0)
    dvi__action_path(own->action, dvi__element_last_path(self), at->last_h, 1.0, NULL, own->dq);
  else
    memcpy(own->dq, at->last_Y, (size_t)self->system->n * sizeof(double));
  DVI_TRY(dvi__legendre_inverse(dvi__action_evaluator(own->action), at->t, at->q, at->p, own->dq));
  dvi__action_straight(own->action, own->dq, Y);
  return DVI_OK;
}

/* The step whose branch is followed. */
typedef struct followed_step {
  dvi__stepper *self;
  const dvi__element_place *at;
} followed_step;

static dvi_status followed_place(void *of, double part)
{
  const followed_step *own = of;
  const dvi__element_place *at = own->at;
  dvi__element_put(own->self->own, at, part * at->h);
  return DVI_OK;
}

/* Guess a straight line along the velocity at the start. */
static dvi_status followed_guess(void *of, double part, double *Y)
{
  const followed_step *own = of;
  const dvi__element_place *at = own->at;
  const dvi__element_place short_one = {at->t,      part * at->h, at->q, at->p,
                                        at->last_h, at->last_Y,   NULL};
  return dvi__element_straight(own->self, &short_one, Y);
}

static double followed_turn(void *of, const double *from, const double *Y)
{
  const followed_step *own = of;
  return dvi__action_turn(((dvi__element *)own->self->own)->action, from, Y);
}

/* Fail where the branch ends. In charts the sentence tells how far the path turns, too. */
static dvi_status fail_at_branch_end(const dvi__stepper *self, const dvi__element_place *at,
                                     const double *Y, const dvi__branch_end *end,
                                     const dvi__branch_failure *whole)
{
  const dvi__element *own = self->own;
  const dvi_status status = dvi__branch_tell(end, at->h, whole);
  if (!own->centred) return status;
  if (end->reached == 0)
    return dvi__fail(DVI_STEP_TOO_LARGE, "a step too large: not even that of h = %.3g has a path",
                     at->h / DVI__BRANCH_PARTS);
  dvi__action_path(own->action, Y, 1.0, 1.0, own->dq, NULL);
  return dvi__fail(DVI_STEP_TOO_LARGE,
                   "a step too large: its path continues those of shorter steps up to h = %.3g, "
                   "where it turns by %.3g; the bound of a chart is half a turn",
                   end->reached * at->h, dvi__action_turned(own->action, own->dq));
}

static int direction_of_time(const dvi__element_place *at)
{
  return at->h < 0 ? -1 : 1;
}

/* Tell whether the whole Jacobian is symmetric, as it is with one coefficient a coordinate. */
static int element_is_symmetric(const dvi__stepper *self)
{
  const dvi__element *own = self->own;
  return own->definite && dvi__action_unknowns(own->action) == self->system->n;
}

/* Give the least number of parts of a step. In charts solutions are nearer to their guesses, and
 * differences are noise over short parts. */
static int element_branch_parts(const dvi__stepper *self)
{
  const int coarse = ((const dvi__element *)self->own)->centred ||
                     dvi__hessian_noise(self->system) > 0;
  if (self->follow > 0) return self->follow;
  return coarse ? 1 : DVI__BRANCH_CAREFUL;
}

/* Allocate the work to follow a branch, when one is followed first. */
static dvi_status element_prepare_branch(dvi__element *own)
{
  const size_t unknowns = (size_t)dvi__action_unknowns(own->action);
  if (own->branch != NULL) return DVI_OK;
  own->branch = DVI_NEW(double, DVI__BRANCH_ROOM *unknowns);
  if (own->branch == NULL)
    return dvi__fail(DVI_NO_MEMORY, "action: no memory to follow a branch of %zu unknowns",
                     unknowns);
  own->counters->preparations++;
  return DVI_OK;
}

/* Tell whether the sign of the determinant is known, which it is not with unknowns of terms. */
static int element_has_signs(const dvi__stepper *self)
{
  const dvi__element *own = self->own;
  return dvi__action_unknowns(own->action) ==
         self->system->n * dvi__action_space_of(own->action).degree;
}

dvi_status dvi__element_follow(dvi__stepper *self, const dvi__element_place *at, dvi_status whole,
                               double *Y)
{
  dvi__element *own = self->own;
  followed_step of = {self, at};
  dvi__branch_failure failure;
  dvi__branch_note(whole, own->solver, &failure);
  DVI_TRY(element_prepare_branch(own));
  const dvi__branch branch = {.of = &of,
                              .place = followed_place,
                              .guess = followed_guess,
                              .distance = own->centred ? followed_turn : NULL,
                              .near = own->centred ? follows_in_charts : DVI__BRANCH_NEAR,
                              .parts = element_branch_parts(self),
                              .signs = element_has_signs(self) &&
                                       (!own->centred || dvi__action_signs(own->action)),
                              .definite = element_is_symmetric(self) ? direction_of_time(at) : 0,
                              .from_zero = 1,
                              .size = dvi__largest((size_t)self->system->n, at->q),
                              .room = own->branch};
  dvi__branch_end end;
  self->counters->followed++;
  self->counters->newtons += !self->follow;
  const dvi_status status = dvi__branch_follow(&branch, own->solver, Y, &end);
  if (status > 0 && end.ends) self->doubt = DVI__ASTRAY;
  return status <= 0 ? status : fail_at_branch_end(self, at, Y, &end, &failure);
}

int dvi__element_is_quadratic(const dvi_system *system)
{
  if ((system->terms & DVI__CONSTANT_MASS) == 0 || system->lagrangian != NULL ||
      system->slots != NULL || system->vector != NULL || system->place_rows > 0)
    return 0;
  for (int k = 0; k < system->potential_count; k++)
    if (!system->potentials[k].callbacks.quadratic) return 0;
  return 1;
}

int dvi__element_is_definite(const dvi_system *system, const dvi__evaluator *evaluator)
{
  return system->lagrangian == NULL && system->slots == NULL && system->force_count == 0 &&
         system->vector == NULL && dvi__mass_is_positive(evaluator);
}

/* Tell whether the solution lies beyond a fold. As h goes to 0 the Jacobian is L_vv times a
 * positive matrix over h. On the way to another solution beyond a fold an eigenvalue passes through
 * 0. Then the Jacobian is no longer definite, where it is symmetric, and its determinant may have
 * the other sign. */
static int element_is_folded(const dvi__stepper *self, const dvi__element_place *at)
{
  const dvi__element *own = self->own;
  dvi__evaluator *evaluator = dvi__action_evaluator(own->action);
  const dvi__decoupled *apart = dvi__element_frozen(own);
  const int unknowns = dvi__action_unknowns(own->action),
            degree = dvi__action_space_of(own->action).degree;
  if (!element_has_signs(self)) return 0;
  if (apart != NULL && own->definite)
    return !dvi__decoupled_is_definite(apart, direction_of_time(at));
  if (apart == NULL && element_is_symmetric(self))
    return !dvi__solver_is_definite(own->solver, direction_of_time(at));
  const int sign = (own->by_blocks  ? (int)own->frozen[DVI__FROZEN_POINT]
                    : apart != NULL ? dvi__decoupled_sign(apart)
                                    : dvi__solver_sign(own->solver)) *
                   (unknowns % 2 != 0 ? direction_of_time(at) : 1);
  if (sign > 0 || own->centred || degree % 2 == 0) return sign < 0;
  dvi__action_path(own->action, own->Y, at->h, 0.0, NULL, own->guess);
  if (dvi__legendre_regular(evaluator, at->t, at->q, own->guess) != DVI_OK) return 1;
  return dvi__mass_sign(evaluator) > 0;
}

/* Tell whether the equations are linear, and so have one solution: the Lagrangian is quadratic, and
 * forces are linear as far as the iteration shows. */
static int element_is_linear(const dvi__element *own, const dvi__solve_report *report)
{
  static const double rounding = 1e-6; /* bends of equations that are linear, with small unknowns */
  return own->quadratic && (!own->has_forces || report->bend <= rounding);
}

/* Newton's method takes a few iterations from a guess near the solution. Solutions by GMRES are
 * right to a part only, and the iterations that correct them say nothing of the branch. */
static int most_sure_iterations(const dvi__element *own)
{
  return own->newton.is_operator ? 7 : 4;
}

/* Judge the branch by the solution alone. Its energy and motion decide the rest. */
dvi__doubt dvi__element_doubt(const dvi__stepper *self, const dvi__element_place *at,
                              const dvi__solve_report *report)
{
  const dvi__element *own = self->own;
  if (own->rung == DVI__FIXED_POINT) return DVI__SURE;
  if (element_is_folded(self, at)) return DVI__ASTRAY;
  if (own->rung != DVI__KINSOL && element_is_linear(own, report)) return DVI__SURE;
  if (own->rung == DVI__KINSOL) return DVI__DOUBTED; /* KINSOL reports nothing of its way */
  if (own->rung == DVI__NEWTON && report->iterations - report->idle <= most_sure_iterations(own))
    return DVI__SURE;
  if (dvi__branch_is_near(report)) return DVI__SURE;
  return dvi__branch_is_straight(report) ? DVI__LINEAR : DVI__DOUBTED;
}

/* Tell whether a solution in charts is not the one that continues shorter steps. It turns far away
 * from its guess, or the determinant has the other sign. Fixed-point iteration without blocks has
 * no determinant, and the solver's factor is that of an earlier step. */
int dvi__element_strays(const dvi__stepper *self, const dvi__element_place *at)
{
  const dvi__element *own = self->own;
  const int has_factor = own->rung != DVI__FIXED_POINT || own->by_blocks;
  if (has_factor && dvi__action_signs(own->action) && element_is_folded(self, at)) return 1;
  return !(dvi__action_turn(own->action, own->guess, own->Y) <= near_in_charts);
}
