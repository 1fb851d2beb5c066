/* Discontinuous Galerkin variational integrators for degenerate Lagrangians alpha(q).v - H(q).
 *
 *     S = sum over elements of h sum_i b_i L(Q_i, V_i) + sum over nodes of N(q-, q+),    N = [q].alpha({q}) + [q].c[q]/2 (average flux)
 *
 * with polynomials of degree d in each element that jump between two: see action/discontinuous.h, whose q* is what stands here for q. p is alpha(q*). The
 * jump is memory of the method, and its oscillation, the parasite, can break a run: it is watched, and an alarm stops the run or is counted. */
#include <math.h>
#include <string.h>

#include "action/discontinuous.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/stationary.h"
#include "num/compensated.h"
#include "num/finite.h"

enum { DEGREE, NODES, FLUX, POINTS, ALARM };
enum { STOP, WARN };

static const char *flux_name(int index)
{
  static const char *const name[] = {"average", "left", "right", "path"};
  return index >= 0 && index < 4 ? name[index] : NULL;
}

static const char *alarm_name(int index)
{
  static const char *const name[] = {"stop", "warn"};
  return index >= 0 && index < 2 ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"degree", NULL, 0, DVI__DG_POINTS_MOST - 1, 2, "of the polynomials, 0 to 7; left out: 2"},
    {"nodes", NULL, 1, DVI__DG_POINTS_MOST, DVI__LEFT_OUT, "Gauss points of an element, degree+1 to 8; left out: degree+1"},
    {"flux", flux_name, 0, 0, DVI__AVERAGE_FLUX, "average, left, right or path; left out: average"},
    {"points", NULL, 1, DVI__DG_POINTS_MOST, DVI__LEFT_OUT, "Gauss points of flux=path, 1 to 8; left out: 2 (1 of other fluxes)"},
    {"alarm", alarm_name, 0, 0, STOP, "stop or warn if the jump is large against the motion; left out: stop"},
    {0},
};

/* The memory: the length of the last step (0: none); the jump [n]; {q} - q* [n]; the last element's coefficients less q* [n*S] (before the first step,
 * the start's velocity in their place). */
enum { LAST_H, JUMP };

typedef struct dg {
  dvi__discontinuous *element;
  dvi__solver *solver;
  double *guess, *x, *dq; /* [unknowns], [unknowns], [n] */
} dg;

static double *jump(const dvi__stepper *self)
{
  return self->memory + JUMP;
}

static double *offset(const dvi__stepper *self)
{
  return jump(self) + self->system->n;
}

static double *coefficients(const dvi__stepper *self)
{
  return offset(self) + self->system->n;
}

static dvi_status residual(void *of, const double *x, double *R)
{
  return dvi__discontinuous_residual(((const dg *)of)->element, x, R);
}

static dvi_status jacobian(void *of, const double *x, double *values)
{
  return dvi__discontinuous_jacobian(((const dg *)of)->element, x, values);
}

static int row_scale(void *of, double *scale)
{
  return dvi__discontinuous_scale(((const dg *)of)->element, scale) == DVI_OK;
}

/* ---- making it ---- */

static dvi_status choose(int *value)
{
  if (value[NODES] == DVI__LEFT_OUT) value[NODES] = value[DEGREE] + 1;
  if (value[POINTS] == DVI__LEFT_OUT) value[POINTS] = value[FLUX] == DVI__PATH_FLUX ? 2 : 1;
  if (value[NODES] <= value[DEGREE])
    return dvi__fail(DVI_BAD_OPTION, "dg: nodes=%d leave a polynomial of degree %d undetermined; take %d or more", value[NODES],
                     value[DEGREE], value[DEGREE] + 1);
  if (value[POINTS] == 1 || value[FLUX] == DVI__PATH_FLUX) return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION, "dg: flux=%s has one point; points=%d goes with flux=path", flux_name(value[FLUX]),
                   value[POINTS]);
}

static dvi_status check_stiffness(const dvi__settings *settings, int n)
{
  if (settings->listed > 1 && settings->listed != n)
    return dvi__fail(DVI_BAD_OPTION, "dg: stiffness has %d numbers; one, or one for each of the %d coordinates is needed",
                     settings->listed, n);
  for (int i = 0; i < settings->listed; i++)
    if (settings->list[i] == 0) return dvi__fail(DVI_BAD_OPTION, "dg: stiffness is 0; leave it out, or take positive numbers");
  return DVI_OK;
}

/* Measured on massless-particle and vortices (tests/method/test_dg.c). Even S share the multiplier 1 of the solution with the jump, which costs two
 * orders. A stiffness that does not change with h adds c j^2/2 per node of the smooth jump j = O(h^S), that is O(h^(2S-1)) to the energy. A flux
 * at one side has the symmetric part of Dalpha for its stiffness. */
static int order_of(const dvi__settings *settings)
{
  const int S = settings->value[DEGREE] + 1, flux = settings->value[FLUX];
  if (settings->listed > 0 || flux == DVI__LEFT_FLUX || flux == DVI__RIGHT_FLUX) return 2 * S - 1;
  return S % 2 == 1 ? 2 * S : 2 * S - 2;
}

static dvi_status allocate(dvi__stepper *self, dg *own)
{
  const size_t n = (size_t)self->system->n, unknowns = (size_t)dvi__discontinuous_unknowns(own->element);
  self->memory_count = JUMP + 2 * n + unknowns;
  own->guess = DVI_NEW(double, unknowns);
  own->x = DVI_NEW(double, unknowns);
  own->dq = DVI_NEW(double, n);
  return own->guess && own->x && own->dq ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "dg: no memory");
}

static dvi_status create(dvi__stepper *self)
{
  int *value = self->settings.value;
  DVI_TRY(choose(value));
  DVI_TRY(check_stiffness(&self->settings, self->system->n));
  dg *own = self->own = DVI_NEW(dg, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "dg: no memory");
  self->order = order_of(&self->settings);
  self->symmetric = value[FLUX] == DVI__AVERAGE_FLUX || value[FLUX] == DVI__PATH_FLUX;
  const dvi__dg_space space = {value[DEGREE], value[NODES],          (dvi__flux)value[FLUX],
                               value[POINTS], self->settings.listed, self->settings.list};
  DVI_TRY(dvi__discontinuous_create(self->system, &space, self->counters, &own->element));
  DVI_TRY(allocate(self, own));
  const dvi__pattern *pattern = dvi__discontinuous_pattern(own->element);
  dvi__equations equations = {.unknowns = pattern->columns,
                              .pattern = pattern,
                              .linear = dvi__linear_for_exchanges(pattern),
                              .of = own,
                              .residual = residual,
                              .jacobian = jacobian,
                              .row_scale = row_scale};
  return dvi__stationary_create(&equations, self->counters, &own->solver);
}

static void destroy(dvi__stepper *self)
{
  dg *own = self->own;
  if (own == NULL) return;
  dvi__solver_destroy(&own->solver);
  dvi__discontinuous_destroy(&own->element);
  dvi__release(own->guess);
  dvi__release(own->x);
  dvi__release(own->dq);
  dvi__release(own);
}

static void start(dvi__stepper *self, const double *v)
{
  memset(self->memory, 0, self->memory_count * sizeof(double));
  memcpy(coefficients(self), v, (size_t)self->system->n * sizeof(double));
}

/* ---- the step ---- */

/* Seen from the other direction of time the two sides of a node change places. */
static void turn(dvi__stepper *self)
{
  for (int i = 0; i < self->system->n; i++) jump(self)[i] = -jump(self)[i];
}

/* A jump may be half of the step's motion. Elements of degree 0 move by jumps alone, and may twice of it. */
static dvi_status watch(const dvi__stepper *self, const double *q, const double *dq)
{
  const size_t n = (size_t)self->system->n;
  const double part = self->settings.value[DEGREE] == 0 ? 2 : 0.5, rounding = 1e-10;
  const double size = dvi__largest(n, jump(self)), motion = dvi__largest(n, dq);
  if (size <= part * motion + rounding * dvi__largest(n, q)) return DVI_OK;
  if (self->settings.value[ALARM] == STOP)
    return dvi__fail(
        DVI_JUMP,
        "the jump, %.2e, is large against the step's motion, %.2e: the parasite has grown; stiffness=c keeps it small, "
        "alarm=warn goes on",
        size, motion);
  self->counters->jump_alarms++;
  return DVI_OK;
}

static dvi_status solve(dvi__stepper *self, const dvi__state *state, double h)
{
  dg *own = self->own;
  const double last_h = self->memory[LAST_H];
  DVI_TRY(dvi__discontinuous_place(own->element, state->t, h, &(dvi__dg_node){state->q, state->p, jump(self), offset(self)}));
  if (last_h != 0)
    dvi__discontinuous_continue(own->element, h / last_h, coefficients(self), own->guess);
  else
    dvi__discontinuous_straight(own->element, coefficients(self), own->guess);
  return dvi__stationary_solve(own->solver, self->counters, dvi__largest((size_t)self->system->n, state->q),
                               dvi__discontinuous_unknowns(own->element), own->guess, own->x);
}

/* Each time the parasite's part of the jump at the start falls by a factor of h; the second time to the order at which it no longer matters. */
static dvi_status settle(dvi__stepper *self, const dvi__state *state, double h)
{
  dg *own = self->own;
  if (!dvi__discontinuous_can_settle(own->element)) return DVI_OK;
  for (int k = 0; k < 2; k++) {
    DVI_TRY(solve(self, state, h));
    DVI_TRY(dvi__discontinuous_settle(own->element, own->x, jump(self), offset(self)));
  }
  return DVI_OK;
}

static dvi_status step(dvi__stepper *self, dvi__state *state, double h)
{
  dg *own = self->own;
  const int n = self->system->n;
  if (self->memory[LAST_H] * h < 0) turn(self);
  if (self->memory[LAST_H] == 0) DVI_TRY(settle(self, state, h));
  DVI_TRY(solve(self, state, h));
  DVI_TRY(dvi__discontinuous_end(own->element, own->x, own->dq, jump(self), offset(self), coefficients(self)));
  DVI_TRY(watch(self, state->q, own->dq));
  self->memory[LAST_H] = h;
  dvi__add_compensated_all(n, state->q, state->q_carry, own->dq);
  dvi__add_compensated(&state->t, &state->t_carry, h);
  memset(own->dq, 0, (size_t)n * sizeof(double));
  return dvi__form_gradient(dvi__discontinuous_evaluator(own->element), state->q, own->dq, own->guess, state->p);
}

static const double *jump_of(const dvi__stepper *self)
{
  return jump(self);
}

static void explain(const dvi__stepper *self, dvi__text *text)
{
  const dg *own = self->own;
  const dvi__pattern *pattern = dvi__discontinuous_pattern(own->element);
  dvi__text_add(text, "kernel: implicit; %d unknowns a step, Jacobian with %d entries (%.3g %% of a full one)\n", pattern->columns,
                dvi__pattern_entries(pattern), 100.0 * dvi__pattern_entries(pattern) / pattern->columns / pattern->columns);
  dvi__text_add(text, "jumps: memory of the method; watched, %s\n",
                self->settings.value[ALARM] == STOP ? "an alarm stops the run" : "alarms are counted");
  dvi__text_add(text, "solver: Newton's method, last KINSOL with line search\n");
}

const dvi__method dvi__dg = {
    .name = "dg",
    .summary = "discontinuous Galerkin with a numerical flux; order 2 (degree+1); degenerate Lagrangians only",
    .cite = "KrausYoshimuraPeng",
    .keys = keys,
    .list = "stiffness",
    .list_help = "c of the jump, one for all coordinates or one for each (c1:c2:...); left out: none",
    .needs = DVI__ONE_FORM,
    .uses = DVI__ONE_FORM | DVI__POTENTIAL,
    .create = create,
    .destroy = destroy,
    .start = start,
    .step = step,
    .jump = jump_of,
    .explain = explain,
};
