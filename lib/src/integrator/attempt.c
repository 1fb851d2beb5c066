/* A step's equations may have several solutions, and an iteration may find one that has nothing to
 * do with the motion, at steps that would resolve it well. The one that is meant continues those of
 * shorter steps down to h = 0 (solve/branch.h).
 *
 * Where the method does not know its solution to be that one, the new state is asked. Solutions of
 * other branches nearly always change the energy by more than a hundredth of the kinetic energy; in
 * small parts of a system, which the energy does not show, they lead away from where their rates
 * do. A doubted step is taken again along its branch. Most are found again: then the first solution
 * stays, to the last bit (docs/theory.md, docs/branches.md). */
#include "integrator/attempt.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "solve/branch.h"

/* Changes of more than this part of the kinetic energy, or of what the step exchanges, are
 * doubted. */
static const double doubted_change = 0.01;

/* So are steps in which a coordinate, or its momentum, ends farther than this from where the mean
 * of its rates at both ends leads, as a part of the larger rate's way. */
static const double doubted_defect = 0.1;

/* Right steps do so, too, where they are long. After some that were followed in vain the motion of
 * steps like them, whose equations bend no more than so many times theirs, is asked more and more
 * seldom, until its answer is that a step was wrong. Of many coordinates one or the other always
 * bends. */
enum { VAIN_ONES = 4, LONGEST_WAIT = 4096, LIKE_THEM = 2, MANY = 32 };

/* Each one that was asked for its bend, in vain, lets the next one bend by so much more. */
static const double more_bend = 1.25;

/* Two solutions are the same if they differ by less than this part of the step: the roundings of an
 * ill-conditioned step are smaller, other solutions are farther away. */
static const double same = 1e-6;

/* Behind the method's memory, so that checkpoints and members have it: steps in a row that were
 * followed for their motion in vain; steps that are not asked after one; those that are left of
 * them; how much the equations of those in vain bent. */
enum { VAIN, WAIT, SPARED, BEND, LEARNED };

struct dvi__attempt {
  dvi__state state; /* what the first attempt found, */
  double *memory;   /* and left in the memory */
  double *forces;   /* [2 n] work */
  double *numbers;  /* the arrays of all three */
  int by_motion;    /* the step is followed because of its motion alone */
};

void dvi__attempt_extend(dvi_integrator *I)
{
  I->learned = I->stepper.memory_count;
  if (I->stepper.follows) I->stepper.memory_count += LEARNED;
}

dvi_status dvi__attempt_allocate(dvi_integrator *I)
{
  const size_t n = (size_t)I->system->n, memory = I->stepper.memory_count;
  if (!I->stepper.follows) return DVI_OK;
  I->first = DVI_NEW(struct dvi__attempt, 1);
  if (I->first == NULL) return dvi__fail(DVI_NO_MEMORY, "integrator: no memory");
  double *at = I->first->numbers = DVI_NEW(double, 6 * n + memory);
  if (at == NULL) return dvi__fail(DVI_NO_MEMORY, "integrator: no memory for %zu coordinates", n);
  dvi__state_lay_out(&I->first->state, &at, n);
  I->first->forces = at;
  I->first->memory = at + 2 * n;
  return DVI_OK;
}

void dvi__attempt_clear(dvi_integrator *I)
{
  if (I->first != NULL) dvi__release(I->first->numbers);
  dvi__release(I->first);
}

/* Whether this step's motion is not asked. */
static int is_spared(const dvi_integrator *I)
{
  double *own = I->stepper.memory + I->learned;
  const int is_other = I->system->n <= MANY && !(I->stepper.bend <= LIKE_THEM * own[BEND]);
  if (own[SPARED] == 0 || is_other) return 0;
  --own[SPARED];
  return 1;
}

/* Whether energy or motion change by too much from `now` to `next`; also where it cannot be
 * told. */
static int state_jumps(dvi_integrator *I)
{
  double change, exchanged, defect;
  const dvi__instant before = {I->now.t, I->now.q, I->now.p, I->last_v},
                     after = {I->next.t, I->next.q, I->next.p, I->v};
  dvi__guess_velocity(I->system->n, I->now.q, I->last.q, I->last.p, I->last_h, I->last_v);
  dvi__guess_velocity(I->system->n, I->next.q, I->now.q, I->last_v, I->next.t - I->now.t, I->v);
  if (dvi__energy_change(I->evaluator, &before, &after, &change, &exchanged) != DVI_OK) return 1;
  if (!(change <= doubted_change * exchanged)) return 1;
  if (I->stepper.doubt == DVI__LINEAR || is_spared(I)) return 0;
  if (dvi__motion_defect(I->evaluator, &before, &after, I->first->forces, &defect) != DVI_OK)
    return 1;
  I->first->by_motion = defect > doubted_defect;
  return I->first->by_motion;
}

static int is_doubted(dvi_integrator *I)
{
  if (I->first == NULL || I->stepper.doubt == DVI__SURE) return 0;
  I->first->by_motion = 0;
  return I->stepper.doubt == DVI__ASTRAY || state_jumps(I);
}

static dvi_status step(dvi_integrator *I, double length, double density)
{
  dvi__state_copy((size_t)I->system->n, &I->now, &I->next);
  memcpy(I->stepper.memory, I->memory_before, I->stepper.memory_count * sizeof(double));
  I->next.density = density;
  I->stepper.doubt = DVI__SURE;
  I->stepper.bend = 0;
  return I->stepper.method->step(&I->stepper, &I->next, length);
}

static void keep_first(dvi_integrator *I)
{
  dvi__state_copy((size_t)I->system->n, &I->next, &I->first->state);
  memcpy(I->first->memory, I->stepper.memory, I->stepper.memory_count * sizeof(double));
}

static void restore_first(dvi_integrator *I)
{
  dvi__state_copy((size_t)I->system->n, &I->first->state, &I->next);
  memcpy(I->stepper.memory, I->first->memory, I->stepper.memory_count * sizeof(double));
}

/* Whether each number of a vector [n] differs little beside what it moved in the step, or is a
 * rounding of what the others moved: no solver finds it better. */
static int is_same(size_t n, const double *one, const double *other, const double *start)
{
  double largest = 0;
  for (size_t i = 0; i < n; i++) largest = fmax(largest, fabs(other[i] - start[i]));
  for (size_t i = 0; i < n; i++) {
    const double moved = fmax(fabs(other[i] - start[i]), 4 * DBL_EPSILON * fabs(start[i]) / same);
    if (!(fabs(one[i] - other[i]) <= same * fmax(moved, same * largest))) return 0;
  }
  return 1;
}

/* A step that was followed for its motion: in vain, it was right; asked in its turn, or for its
 * bend while others are spared. The memory is that of the step as it was taken. */
static void learn(const dvi_integrator *I, int right, double bend)
{
  double *own = I->stepper.memory + I->learned;
  if (!I->first->by_motion) return;
  if (!right) {
    memset(own, 0, LEARNED * sizeof *own);
    return;
  }
  if (own[SPARED] > 0) {
    own[BEND] *= more_bend;
    return;
  }
  if (own[VAIN] < VAIN_ONES)
    own[BEND] = own[VAIN]++ == 0 ? bend : fmin(own[BEND], bend);
  else
    own[WAIT] = fmin(2 * own[WAIT], LONGEST_WAIT);
  if (own[VAIN] == VAIN_ONES) own[SPARED] = own[WAIT] = fmax(own[WAIT], 1);
}

/* The step along its branch, in at least so many parts; alarms are those of the step as it is
 * taken. */
static dvi_status follow(dvi_integrator *I, double length, double density, int parts,
                         const dvi_counters *before)
{
  I->counters.jump_alarms = before->jump_alarms;
  I->counters.energy_fallbacks = before->energy_fallbacks;
  I->stepper.follow = parts;
  const dvi_status status = step(I, length, density);
  I->stepper.follow = 0;
  return status;
}

/* What the first attempt has found stays, to the last bit, if it was right. */
dvi_status dvi__attempt(dvi_integrator *I, double length, double density)
{
  const size_t n = (size_t)I->system->n;
  const dvi_counters before = I->counters;
  DVI_TRY(step(I, length, density));
  if (!is_doubted(I)) return DVI_OK;
  keep_first(I);
  const double bend = I->stepper.bend;
  const int hasty = I->stepper.doubt != DVI__ASTRAY;
  dvi_status status = follow(I, length, density, hasty ? 1 : DVI__BRANCH_CAREFUL, &before);
  if (hasty && status > 0 && I->stepper.doubt == DVI__ASTRAY)
    status = follow(I, length, density, DVI__BRANCH_CAREFUL, &before);
  const int is_lost = status > 0 && I->stepper.doubt != DVI__ASTRAY;
  if (status != DVI_OK && !(is_lost && I->first->by_motion)) return status;
  /* Motion alone is no reason to refuse a step if there is a solution beyond: at the front of a
   * wave, where numbers grow by high powers of h, a branch may be lost that goes on. */
  const int right = is_lost || (is_same(n, I->next.q, I->first->state.q, I->now.q) &&
                                is_same(n, I->next.p, I->first->state.p, I->now.p));
  if (right) restore_first(I);
  learn(I, right, bend);
  return DVI_OK;
}
