#include "step/split/integrable.h"

#include <math.h>
#include <string.h>

#include "step/split/integrable_struct.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/compensated.h"
#include "num/finite.h"
#include "system/part.h"

/* ---- drift ---- */

static dvi_status drift_move(dvi__integrable *own, const dvi__points *at, double *to_q,
                             double *to_p)
{
  dvi__mass_solve(own->evaluator, at->count, at->p, to_q);
  for (int i = 0; i < own->n; i++)
    for (int k = 0; k < at->count; k++) {
      const int place = i * at->count + k;
      to_q[place] = at->q[place] + at->tau[k] * to_q[place];
      if (to_p != NULL) to_p[place] = at->p[place];
    }
  return DVI_OK;
}

static dvi_status drift_change(dvi__integrable *own, double tau, const double *q, const double *p)
{
  (void)q;
  dvi__mass_solve(own->evaluator, 1, p, own->dq);
  for (int i = 0; i < own->n; i++) {
    own->dq[i] *= tau;
    own->dp[i] = 0;
  }
  return DVI_OK;
}

static dvi_status drift_pullback(dvi__integrable *own, const dvi__points *at,
                                 const double *lambda_q, const double *lambda_p, double *by_q,
                                 double *by_p)
{
  (void)lambda_p;
  dvi__mass_solve(own->evaluator, at->count, lambda_q, by_p);
  for (int i = 0; i < own->n; i++)
    for (int k = 0; k < at->count; k++) {
      by_q[i * at->count + k] = lambda_q[i * at->count + k];
      by_p[i * at->count + k] *= at->tau[k];
    }
  return DVI_OK;
}

static const dvi__integrable_kind drift = {.words = "drift, the motion without forces",
                                           .move = drift_move,
                                           .change = drift_change,
                                           .pullback = drift_pullback};

/* ---- declared by a program ---- */

/* Numbers that a callback leaves out are not finite. */
static void spoil(size_t count, double *x)
{
  for (size_t i = 0; i < count; i++) x[i] = (double)NAN;
}

static dvi_status check_call(const char *callback, int returned, size_t count, const double *one,
                             const double *other)
{
  if (returned != 0)
    return dvi__fail(returned > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                     "the flow's %s returned %d", callback, returned);
  if (dvi__first_not_finite(count, one) < 0 && dvi__first_not_finite(count, other) < 0)
    return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "the flow's %s gave NaN or Inf, or left a number out", callback);
}

static dvi_status declared_move(dvi__integrable *own, const dvi__points *at, double *to_q,
                                double *to_p)
{
  const size_t numbers = (size_t)own->n * (size_t)at->count;
  double *moved_p = to_p != NULL ? to_p : own->z;
  spoil(numbers, to_q);
  spoil(numbers, moved_p);
  const int returned = own->flow->move(at->count, at->tau, at->q, at->p, to_q, moved_p,
                                       own->flow->user);
  return check_call("move", returned, numbers, to_q, moved_p);
}

static dvi_status declared_change(dvi__integrable *own, double tau, const double *q,
                                  const double *p)
{
  const dvi__points point = {.count = 1, .tau = &tau, .q = q, .p = p};
  DVI_TRY(declared_move(own, &point, own->dq, own->dp));
  for (int i = 0; i < own->n; i++) {
    own->dq[i] -= q[i];
    own->dp[i] -= p[i];
  }
  return DVI_OK;
}

static dvi_status declared_pullback(dvi__integrable *own, const dvi__points *at,
                                    const double *lambda_q, const double *lambda_p, double *by_q,
                                    double *by_p)
{
  const size_t numbers = (size_t)own->n * (size_t)at->count;
  spoil(numbers, by_q);
  spoil(numbers, by_p);
  const int returned = own->flow->pullback(at->count, at->tau, at->q, at->p, lambda_q, lambda_p,
                                           by_q, by_p, own->flow->user);
  return check_call("pullback", returned, numbers, by_q, by_p);
}

static const dvi__integrable_kind declared = {.words = "the program's own",
                                              .move = declared_move,
                                              .change = declared_change,
                                              .pullback = declared_pullback};

/* ---- create, destroy ---- */

static dvi_status integrable_choose(dvi__integrable *own, dvi_counters *counters)
{
  int found;
  own->kind = own->flow != NULL ? &declared : &drift;
  if (own->flow != NULL || own->fast->potential_count == 0) return DVI_OK;
  if (!own->fast->autonomous)
    return dvi__fail(DVI_UNSUPPORTED,
                     "the flow of fast potentials is known only if nothing depends on the time; "
                     "declare the system autonomous, or no potential fast");
  if (dvi__system_fast_is_quadratic(own->system)) return dvi__integrable_find_modes(own, counters);
  DVI_TRY(dvi__integrable_find_centres(own, &found));
  if (found) return DVI_OK;
  return dvi__fail(
      DVI_UNSUPPORTED,
      "the flow of the fast potentials is not known: '%s' is not declared quadratic, and their sum "
      "is not -k/|q| of bodies with 3 or 2 coordinates and one mass each, about the origin; "
      "declare other potentials fast, or give the flow (dvi_flow in dvi/shapes.h)",
      dvi__system_fast_not_quadratic(own->system));
}

static dvi_status integrable_initialise(dvi__integrable *own, dvi_counters *counters)
{
  const size_t n = (size_t)own->n;
  own->dq = DVI_NEW(double, n);
  own->dp = DVI_NEW(double, n);
  own->z = DVI_NEW(double, n *(size_t)own->capacity);
  if (own->dq == NULL || own->dp == NULL || own->z == NULL)
    return dvi__fail(DVI_NO_MEMORY, "no memory");
  DVI_TRY(dvi__system_fast_part(own->system, &own->fast));
  /* what is found once does not count among the evaluations of steps */
  DVI_TRY(dvi__evaluator_create(own->fast, own->capacity, DVI__GRADIENTS, NULL, &own->evaluator));
  return integrable_choose(own, counters);
}

dvi_status dvi__integrable_create(const dvi_system *system, const dvi_flow *flow, int capacity,
                                  dvi_counters *counters, dvi__integrable **integrable)
{
  dvi__integrable *own = *integrable = DVI_NEW(dvi__integrable, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  *own = (dvi__integrable){.system = system, .flow = flow, .n = system->n, .capacity = capacity};
  const dvi_status status = integrable_initialise(own, counters);
  if (status != DVI_OK) dvi__integrable_destroy(integrable);
  return status;
}

void dvi__integrable_destroy(dvi__integrable **integrable)
{
  dvi__integrable *own = *integrable;
  if (own == NULL) return;
  dvi__modes_destroy(&own->modes);
  dvi__evaluator_destroy(&own->evaluator);
  dvi_system_destroy(&own->fast);
  double *numbers[] = {own->dq, own->dp, own->shift, own->y,   own->w,
                       own->f,  own->z,  own->mu,    own->mass};
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) dvi__release(numbers[k]);
  dvi__release(own->orbits);
  dvi__release(own);
  *integrable = NULL;
}

/* ---- points ---- */

const char *dvi__integrable_words(const dvi__integrable *own)
{
  return own->kind->words;
}

void dvi__integrable_begin(dvi__integrable *own)
{
  const size_t orbits = (size_t)own->bodies * (size_t)own->capacity;
  if (orbits > 0) memset(own->orbits, 0, orbits * sizeof *own->orbits);
}

dvi_status dvi__integrable_move(dvi__integrable *own, const dvi__points *at, double *to_q,
                                double *to_p)
{
  return own->kind->move(own, at, to_q, to_p);
}

dvi_status dvi__integrable_advance(dvi__integrable *own, double tau, const dvi__phase *phase)
{
  DVI_TRY(own->kind->change(own, tau, phase->q, phase->p));
  dvi__add_compensated_all(own->n, phase->q, phase->q_compensation, own->dq);
  dvi__add_compensated_all(own->n, phase->p, phase->p_compensation, own->dp);
  return DVI_OK;
}

dvi_status dvi__integrable_pullback(dvi__integrable *own, const dvi__points *at,
                                    const double *lambda_q, const double *lambda_p, double *by_q,
                                    double *by_p)
{
  return own->kind->pullback(own, at, lambda_q, lambda_p, by_q, by_p);
}
