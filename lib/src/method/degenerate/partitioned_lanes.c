/* The partitioned step for members of an ensemble abreast (num/simd/abreast.h), a few at a time. It
 * is the way that most steps of partitioned_step.c take: Newton's method from a continued guess,
 * with one Jacobian, which is inverted, and fast convergence. Members for which that does not lead
 * to the end are left to dvi__partitioned_step. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "step/degenerate/partitioned_members.h"
#include "core/memory.h"
#include "method/degenerate/partitioned_step.h"
#include "solve/newton.h"

typedef dvi__abreast abreast;

/* Lanes that are done wait for the others. */
enum { MOST_ITERATIONS = 6 };

typedef struct lanes {
  dvi__partitioned_members *members;
  int n, s, m, rows; /* coordinates, stages, unknowns of a coordinate, numbers of the memory */
  int member[DVI__ABREAST];
  int sound[DVI__ABREAST]; /* the lane's member takes this step here */
  int going[DVI__ABREAST]; /* and iterates on */
  dvi__newton_course course[DVI__ABREAST];
  abreast t[2], size; /* time and its compensation, largest coordinate at the start */
  abreast *q, *q_compensation, *p, *dq; /* [n] */
  abreast *change,
      *largest;           /* [n] largest corrections of each coordinate, and unknowns after them */
  abreast *x, *r, *plain; /* [n*m] */
  abreast *memory;        /* [rows] */
  abreast *numbers;       /* all of them */
} lanes;

/* ---- create ---- */

static size_t lanes_lay_out(lanes *own)
{
  const size_t n = (size_t)own->n, unknowns = n * (size_t)own->m, rows = (size_t)own->rows;
  abreast **const array[] = {&own->q,      &own->q_compensation, &own->p, &own->dq,
                             &own->change, &own->largest,        &own->x, &own->r,
                             &own->plain,  &own->memory};
  const size_t size[] = {n, n, n, n, n, n, unknowns, unknowns, unknowns, rows};
  size_t count = 0;
  for (size_t i = 0; i < sizeof size / sizeof *size; count += size[i++])
    *array[i] = own->numbers != NULL ? own->numbers + count : NULL;
  return count;
}

dvi_status dvi__partitioned_prepare_lanes(dvi__stepper *self, int capacity)
{
  const dvi__one_step *one = self->own;
  (void)capacity;
  if (!dvi__partitioned_has_members(one->of)) return DVI_OK;
  lanes *own = self->lanes = DVI_NEW(lanes, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "%s: no memory", self->method->name);
  own->n = self->system->n;
  own->m = dvi__partitioned_pattern(one->of)->columns / own->n;
  own->s = own->m - 1;
  own->rows = (int)one->equations.ladder;
  own->numbers = DVI_NEW(abreast, lanes_lay_out(own));
  if (own->numbers == NULL)
    return dvi__fail(DVI_NO_MEMORY, "%s: no memory for %d members", self->method->name,
                     DVI__ABREAST);
  (void)lanes_lay_out(own);
  return dvi__partitioned_members_create(one->of, &own->members);
}

void dvi__partitioned_clear_lanes(dvi__stepper *self)
{
  lanes *own = self->lanes;
  dvi__partitioned_members_destroy(&own->members);
  dvi__release(own->numbers);
  dvi__release(own);
}

/* ---- members and lanes ---- */

/* Give the length of the last step that the members have in common, 0 if there is none. Those with
 * another one are left. */
static double common_length(dvi__members *m)
{
  const double *last_h = m->memory + (size_t)DVI__LENGTH * (size_t)m->count;
  double common = 0;
  for (int k = 0; k < m->count; k++) {
    if (common == 0 && !m->left[k]) common = last_h[k];
    if (last_h[k] == 0 || last_h[k] != common) m->left[k] = 1;
  }
  return common;
}

/* Choose the lanes' members. Lanes that have none take the numbers of the first one that there is.
 * Returns 0 if there is none. */
static int lanes_choose(lanes *own, const dvi__members *m, int first)
{
  int chosen = -1;
  for (int lane = 0; lane < DVI__ABREAST; lane++) {
    const int k = first + lane;
    own->sound[lane] = k < m->count && !m->left[k];
    own->member[lane] = k;
    if (own->sound[lane] && chosen < 0) chosen = k;
  }
  for (int lane = 0; lane < DVI__ABREAST; lane++)
    if (!own->sound[lane]) own->member[lane] = chosen;
  return chosen >= 0;
}

static int are_neighbours(const lanes *own)
{
  return own->member[DVI__ABREAST - 1] == own->member[0] + DVI__ABREAST - 1;
}

static void lanes_load(const lanes *own, int rows, size_t count, const double *from, abreast *to)
{
  const int whole = are_neighbours(own);
  for (int i = 0; i < rows; i++, from += count) {
    if (whole) memcpy(&to[i], from + own->member[0], sizeof *to);
    for (int lane = 0; lane < DVI__ABREAST && !whole; lane++) to[i][lane] = from[own->member[lane]];
  }
}

static void lanes_store(const lanes *own, int rows, size_t count, const abreast *from, double *to)
{
  int whole = are_neighbours(own);
  for (int lane = 0; lane < DVI__ABREAST; lane++) whole &= own->sound[lane];
  for (int i = 0; i < rows; i++, to += count) {
    if (whole) memcpy(to + own->member[0], &from[i], sizeof *from);
    for (int lane = 0; lane < DVI__ABREAST && !whole; lane++)
      if (own->sound[lane]) to[own->member[lane]] = from[i][lane];
  }
}

/* ---- the step ---- */

static void lanes_begin(const dvi__stepper *self, lanes *own, const dvi__members *m, double h,
                        double last_h)
{
  const dvi__one_step *one = self->own;
  const size_t count = (size_t)m->count, unknowns = one->predictor.unknowns;
  lanes_load(own, 1, count, m->t, &own->t[0]);
  lanes_load(own, 1, count, m->t_compensation, &own->t[1]);
  lanes_load(own, own->n, count, m->q, own->q);
  lanes_load(own, own->n, count, m->q_compensation, own->q_compensation);
  lanes_load(own, own->n, count, m->p, own->p);
  lanes_load(own, own->rows, count, m->memory, own->memory);
  own->size = (abreast){0};
  for (int i = 0; i < own->n; i++) abreast_larger(&own->size, &own->q[i]);
  for (int lane = 0; lane < DVI__ABREAST; lane++) dvi__newton_begin(&own->course[lane]);
  dvi__partitioned_members_place(own->members, h, &own->t[0], own->q, own->p,
                                 own->memory + DVI__CARRIED);
  dvi__partitioned_members_continue(own->members, h / last_h, own->memory + one->last, own->x);
  dvi__predictor_correct_abreast(unknowns, own->memory + one->last + unknowns, h, own->plain,
                                 own->x);
}

/* Correct the unknowns of the lanes that go on, and find the largest corrections and unknowns of
 * each coordinate. */
WIDE static void correct_lanes(const lanes *own)
{
  dvi__abreast_mask going;
  for (int lane = 0; lane < DVI__ABREAST; lane++) going[lane] = -(int64_t)own->going[lane];
  for (int i = 0, at = 0; i < own->n; i++) {
    abreast change = {0}, largest = {0};
    for (int k = 0; k < own->m; k++, at++) {
      const abreast corrected = own->x[at] - own->r[at];
      abreast_replace(&going, &corrected, &own->x[at]);
      abreast_larger(&change, &own->r[at]);
      abreast_larger(&largest, &own->x[at]);
    }
    own->change[i] = change;
    own->largest[i] = largest;
  }
}

/* Judge the correction of a lane as the solver and dvi__stationary_solve do. A solution that is
 * doubted is for the driver. */
static dvi__progress lanes_judge(const dvi__stepper *self, lanes *own, int lane)
{
  const dvi__one_step *one = self->own;
  dvi__newton_course *course = &own->course[lane];
  dvi__newton_correction of = {.groups = own->n, .size = own->size[lane]};
  for (int i = 0; i < own->n; i++) {
    of.change[i] = own->change[i][lane];
    of.whole[i] = own->largest[i][lane];
    if (!(of.change[i] <= DBL_MAX && of.whole[i] <= DBL_MAX)) return DVI__STALLED;
  }
  const dvi__progress progress = dvi__newton_go_on(one->equations.solver, course, &of);
  const int is_sure = course->report.iterations <= DVI__FAST_NEWTON ||
                      dvi__branch_is_near(&course->report);
  return progress != DVI__CONVERGED || is_sure ? progress : DVI__STALLED;
}

/* Judge all lanes that go on. Returns how many still do. */
static int lanes_test(const dvi__stepper *self, lanes *own)
{
  int going = 0;
  for (int lane = 0; lane < DVI__ABREAST; lane++) {
    if (!own->going[lane]) continue;
    const dvi__progress progress = lanes_judge(self, own, lane);
    own->going[lane] = progress == DVI__GO_ON;
    own->sound[lane] = progress != DVI__STALLED;
    going += own->going[lane];
  }
  return going;
}

static dvi_status lanes_iterate(const dvi__stepper *self, lanes *own)
{
  int going = 1;
  DVI_TRY(dvi__partitioned_members_invert(own->members, own->x, own->sound));
  memcpy(own->going, own->sound, sizeof own->going);
  for (int iteration = 1; iteration <= MOST_ITERATIONS && going > 0; iteration++) {
    DVI_TRY(dvi__partitioned_members_correct(own->members, own->x, own->going, own->r));
    correct_lanes(own);
    going = lanes_test(self, own);
  }
  for (int lane = 0; lane < DVI__ABREAST; lane++) own->sound[lane] &= !own->going[lane];
  return DVI_OK;
}

static void add_abreast(abreast *sum, abreast *compensation, const abreast *term)
{
  const abreast wanted = *term - *compensation, next = *sum + wanted;
  *compensation = (next - *sum) - wanted;
  *sum = next;
}

/* Move to the ends as dvi__partitioned_step. */
static dvi_status lanes_move(const dvi__stepper *self, lanes *own, double h)
{
  const dvi__one_step *one = self->own;
  const size_t unknowns = one->predictor.unknowns;
  const abreast length = (abreast){0} + h;
  abreast *memory = own->memory;
  dvi__partitioned_members_ends(own->members, own->x, own->dq);
  for (int i = 0; i < own->n; i++) {
    add_abreast(&own->q[i], &own->q_compensation[i], &own->dq[i]);
    memory[DVI__CARRIED + i] = own->x[i * own->m + own->s];
  }
  add_abreast(&own->t[0], &own->t[1], &length);
  memory[DVI__LENGTH] = length;
  memcpy(memory + one->last, own->x, unknowns * sizeof *memory);
  dvi__predictor_learn_abreast(unknowns, memory + one->last + unknowns, h, own->plain, own->x);
  return dvi__partitioned_members_constrain(own->members, own->q, own->p, own->sound);
}

static void drop_not_finite(lanes *own)
{
  abreast largest = {0};
  abreast_larger(&largest, &own->t[0]);
  for (int i = 0; i < own->n; i++) {
    abreast_larger(&largest, &own->q[i]);
    abreast_larger(&largest, &own->p[i]);
  }
  for (int lane = 0; lane < DVI__ABREAST; lane++) own->sound[lane] &= largest[lane] <= DBL_MAX;
}

/* Count what the lane's member would have counted alone. */
static void lanes_count(const dvi__stepper *self, const lanes *own, int lane)
{
  dvi_counters *counters = self->counters;
  const int iterations = own->course[lane].report.iterations;
  counters->residuals += iterations;
  counters->solves += iterations;
  counters->gradients += (long)iterations * (own->s + 1) + 1;
  counters->hessians += own->s + 2;
  counters->jacobians++;
  counters->factorizations++;
  counters->newtons++;
}

static void lanes_finish(const dvi__stepper *self, const lanes *own, dvi__members *m)
{
  const size_t count = (size_t)m->count;
  lanes_store(own, 1, count, &own->t[0], m->t);
  lanes_store(own, 1, count, &own->t[1], m->t_compensation);
  lanes_store(own, own->n, count, own->q, m->q);
  lanes_store(own, own->n, count, own->q_compensation, m->q_compensation);
  lanes_store(own, own->n, count, own->p, m->p);
  lanes_store(own, own->rows, count, own->memory, m->memory);
  for (int lane = 0; lane < DVI__ABREAST; lane++)
    if (own->sound[lane]) lanes_count(self, own, lane);
}

static void step_some(const dvi__stepper *self, dvi__members *m, double h, double last_h, int first)
{
  lanes *own = self->lanes;
  if (!lanes_choose(own, m, first)) return;
  lanes_begin(self, own, m, h, last_h);
  if (lanes_iterate(self, own) == DVI_OK && lanes_move(self, own, h) == DVI_OK)
    drop_not_finite(own);
  else
    memset(own->sound, 0, sizeof own->sound);
  lanes_finish(self, own, m);
  for (int lane = 0; lane < DVI__ABREAST && first + lane < m->count; lane++)
    m->left[first + lane] = !own->sound[lane];
}

void dvi__partitioned_step_lanes(dvi__stepper *self, dvi__members *m, double h)
{
  const double last_h = common_length(m);
  for (int first = 0; first < m->count && last_h != 0; first += DVI__ABREAST)
    step_some(self, m, h, last_h, first);
}
