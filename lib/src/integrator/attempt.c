/* A step's equations may have several solutions. An iteration may find one that has nothing to do
 * with the motion, even at steps that would resolve the motion well. The right one lies on the
 * branch connected to h = 0 (solve/branch.h).
 *
 * Where the method does not know the branch of its solution, the new state is tested. Solutions of
 * other branches nearly always change the energy by more than a hundredth of the kinetic energy. In
 * small parts of a system, which the energy does not show, such solutions end away from the points
 * to which their rates lead. A doubted step is taken again along its branch. In most cases this
 * finds the same solution, and then the first solution stays, to the last bit (docs/theory.md,
 * docs/branches.md). */
#include "integrator/attempt.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/damping.h"
#include "num/finite.h"
#include "solve/branch.h"

/* A step is doubted if its energy changes by more than this part of the kinetic energy, or of the
 * energy that the step exchanges. */
static const double doubted_change = 0.01;

/* A step is doubted if a coordinate or its momentum ends too far from the point to which the mean
 * of its rates at both ends leads. The limit is a part of the distance by the larger rate. */
static const double doubted_defect = 0.1;

/* Long steps may fail the test of the motion although they are right. After some steps that were
 * followed in vain, similar steps are tested less and less often, until a test finds a wrong step.
 * Steps are similar if their equations bend at most SIMILAR_BEND times as much. In a system of
 * MANY_COORDINATES coordinates some coordinate always bends, and all steps count as similar. */
enum { VAIN_LIMIT = 4, LONGEST_WAIT = 4096, SIMILAR_BEND = 2, MANY_COORDINATES = 32 };

/* Each step that was tested for its bend, in vain, raises the bend of similar steps by this
 * factor. */
static const double more_bend = 1.25;

/* Two solutions are the same if they differ by less than this part of the step. The roundings of an
 * ill-conditioned step are smaller, and other solutions are farther away. */
static const double same = 1e-6;

/* The learned numbers stand behind the method's memory, so that checkpoints and members of
 * ensembles contain them. */
enum {
  VAIN,   /* number of steps in a row that were followed for their motion in vain */
  WAIT,   /* number of steps without a test after such a step */
  SPARED, /* number of steps without a test that remain */
  BEND,   /* bend of the equations of the steps in vain */
  LEARNED
};

struct dvi__attempt {
  dvi__state state; /* state after the first attempt */
  double *memory;   /* the stepper's memory after the first attempt */
  double *forces;   /* [2 n] work */
  double *numbers;  /* storage of all these arrays */
  int by_motion;    /* the step is followed because of its motion alone */
  int by_driving;   /* or because of its energy, which need not be kept where time acts */
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
  double *at = I->first->numbers = DVI_NEW(double, dvi__state_numbers(I) + 2 * n + memory);
  if (at == NULL) return dvi__fail(DVI_NO_MEMORY, "integrator: no memory for %zu coordinates", n);
  dvi__state_lay_out(I, &I->first->state, &at);
  I->first->forces = at;
  I->first->memory = at + 2 * n;
  return DVI_OK;
}

void dvi__attempt_clear(dvi_integrator *I)
{
  if (I->first != NULL) dvi__release(I->first->numbers);
  dvi__release(I->first);
}

/* Test whether this step goes without the test of its motion. */
static int is_spared(const dvi_integrator *I)
{
  double *own = I->stepper.memory + I->learned;
  const int is_other = I->system->n <= MANY_COORDINATES &&
                       !(I->stepper.bend <= SIMILAR_BEND * own[BEND]);
  if (own[SPARED] == 0 || is_other) return 0;
  --own[SPARED];
  return 1;
}

/* Test whether energy or motion change by too much from `now` to `next`. The result is 1 also if
 * they cannot be evaluated. */
static int state_jumps(dvi_integrator *I)
{
  double change, exchanged, defect;
  const double *const *free = I->stepper.free_p;
  const dvi__instant before = {I->now.t, I->now.q, free[0] != NULL ? free[0] : I->now.p, I->last_v},
                     after = {I->next.t, I->next.q, free[1] != NULL ? free[1] : I->next.p, I->v};
  dvi__guess_velocity(I->system->n, I->now.q, I->last.q, I->last.p, I->last_h, I->last_v);
  dvi__guess_velocity(I->system->n, I->next.q, I->now.q, I->last_v, I->next.t - I->now.t, I->v);
  if (dvi__energy_change(I->evaluator, &before, &after, I->stepper.work, &change, &exchanged) !=
      DVI_OK)
    return 1;
  I->first->by_driving = !I->system->autonomous;
  if (!(change <= doubted_change * exchanged)) return 1;
  I->first->by_driving = 0;
  if (I->stepper.doubt == DVI__LINEAR || is_spared(I)) return 0;
  if (dvi__motion_defect(I->evaluator, &before, &after, I->first->forces, &defect) != DVI_OK)
    return 1;
  I->first->by_motion = defect > doubted_defect;
  return I->first->by_motion;
}

static int is_doubted(dvi_integrator *I)
{
  if (I->first == NULL || I->stepper.doubt == DVI__SURE) return 0;
  I->first->by_motion = I->first->by_driving = 0;
  return I->stepper.doubt == DVI__ASTRAY || state_jumps(I);
}

static dvi_status attempt_step(dvi_integrator *I, double length, double density)
{
  dvi__state_copy(I, &I->now, &I->next);
  memcpy(I->stepper.memory, I->memory_before, I->stepper.memory_count * sizeof(double));
  I->next.density = density;
  I->stepper.doubt = DVI__SURE;
  I->stepper.bend = I->stepper.worked = 0;
  I->stepper.work = NULL;
  return dvi__take_step(&I->stepper, &I->next, length);
}

static void keep_first(dvi_integrator *I)
{
  dvi__state_copy(I, &I->next, &I->first->state);
  memcpy(I->first->memory, I->stepper.memory, I->stepper.memory_count * sizeof(double));
}

static void restore_first(dvi_integrator *I)
{
  dvi__state_copy(I, &I->first->state, &I->next);
  memcpy(I->stepper.memory, I->first->memory, I->stepper.memory_count * sizeof(double));
}

/* Test whether two vectors [n] are the same solution. Each number must differ by little beside its
 * change in the step, or by a rounding of the other numbers' changes, beyond which no solver
 * goes. */
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

/* Update the learned numbers after a step that was followed for its motion. A step that was right
 * was followed in vain. It was tested in its turn, or for its bend while similar steps are spared.
 * The memory is that of the accepted step. */
static void learn_from_followed(const dvi_integrator *I, int right, double bend)
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
  if (own[VAIN] < VAIN_LIMIT)
    own[BEND] = own[VAIN]++ == 0 ? bend : fmin(own[BEND], bend);
  else
    own[WAIT] = fmin(2 * own[WAIT], LONGEST_WAIT);
  if (own[VAIN] == VAIN_LIMIT) own[SPARED] = own[WAIT] = fmax(own[WAIT], 1);
}

typedef struct alarms {
  long jumps, fallbacks;
} alarms;

/* Take the step along its branch, in at least `parts` parts. Alarms count once, for the step that
 * is accepted. */
static dvi_status follow_branch(dvi_integrator *I, double length, double density, int parts,
                                const alarms *before)
{
  I->counters.jump_alarms = before->jumps;
  I->counters.energy_fallbacks = before->fallbacks;
  I->stepper.follow = parts;
  const dvi_status status = attempt_step(I, length, density);
  I->stepper.follow = 0;
  return status;
}

/* The solution of the first attempt stays, to the last bit, if it was right. */
dvi_status dvi__attempt(dvi_integrator *I, double length, double density)
{
  const size_t n = (size_t)I->system->n;
  const alarms before = {I->counters.jump_alarms, I->counters.energy_fallbacks};
  DVI_TRY(attempt_step(I, length, density));
  if (!is_doubted(I)) return DVI_OK;
  keep_first(I);
  const double bend = I->stepper.bend;
  const int hasty = I->stepper.doubt != DVI__ASTRAY;
  dvi_status status = follow_branch(I, length, density, hasty ? 1 : DVI__BRANCH_CAREFUL, &before);
  if (hasty && status > 0 && I->stepper.doubt == DVI__ASTRAY)
    status = follow_branch(I, length, density, DVI__BRANCH_CAREFUL, &before);
  const int is_lost = status > 0 && I->stepper.doubt != DVI__ASTRAY;
  if (status != DVI_OK && !(is_lost && (I->first->by_motion || I->first->by_driving)))
    return status;
  /* Do not refuse a step because of its motion alone if its equations have a solution. At the front
   * of a travelling wave, where numbers grow by high powers of h, following may lose a branch that
   * goes on. So may it where a long step passes over fast vibrations. The energy
   * of a driven system says no more against a step than its motion does. */
  const int right = is_lost || (is_same(n, I->next.q, I->first->state.q, I->now.q) &&
                                is_same(n, I->next.p, I->first->state.p, I->now.p));
  if (right) restore_first(I);
  learn_from_followed(I, right, bend);
  return DVI_OK;
}
