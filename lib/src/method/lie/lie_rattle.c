#include "method/lie/lie_rattle.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/chart/charted.h"
#include "system/dynamics/holonomic.h"
#include "system/dynamics/holonomic_rows.h"
#include "system/factor.h"

enum { MOST_ITERATIONS = 100 };

struct dvi__lie_rattle {
  const dvi_system *system;
  dvi__lie_drift *drift;
  dvi_counters *counters;
  dvi__evaluator *states; /* with the matrix D M^-1 D^T */
  int knows_start;        /* the matrix and the gradients are those of t_start and q_start */
  double t_start;
  double *numbers;             /* storage of all that follows */
  double *q_start;             /* [nq] */
  double *phi_q;               /* [entries of rows_q] */
  double *phi, *phi_t;         /* [rows]; phi becomes a correction of the multipliers */
  double *covector, *rate, *v; /* [nq], [nq], [nv] */
  double *q, *p, *q_compensation, *p_compensation; /* [nq], [nv] of the state before the drift */
};

/* ---- create ---- */

static dvi_status allocate(dvi__lie_rattle *r)
{
  const size_t nq = (size_t)r->system->n, nv = (size_t)r->system->nv,
               m = (size_t)r->system->row_count,
               entries = (size_t)dvi__pattern_entries(&r->system->rows_q);
  double *at = r->numbers = DVI_NEW(double, 5 * nq + 3 * nv + 2 * m + entries);
  if (at == NULL) return dvi__fail(DVI_NO_MEMORY, "lie-verlet: no memory for %zu constraints", m);
  r->q_start = at;
  r->covector = r->q_start + nq;
  r->rate = r->covector + nq;
  r->q = r->rate + nq;
  r->q_compensation = r->q + nq;
  r->v = r->q_compensation + nq;
  r->p = r->v + nv;
  r->p_compensation = r->p + nv;
  r->phi = r->p_compensation + nv;
  r->phi_t = r->phi + m;
  r->phi_q = r->phi_t + m;
  return DVI_OK;
}

dvi_status dvi__lie_rattle_create(const dvi_system *system, dvi__lie_drift *drift,
                                  dvi_counters *counters, dvi__lie_rattle **rattle)
{
  dvi__lie_rattle *r = *rattle = DVI_NEW(dvi__lie_rattle, 1);
  if (r == NULL) return dvi__fail(DVI_NO_MEMORY, "lie-verlet: no memory");
  r->system = system;
  r->drift = drift;
  r->counters = counters;
  dvi_status status = allocate(r);
  if (status == DVI_OK)
    status = dvi__evaluator_create(system, 1, DVI__STATES, counters, &r->states);
  if (status != DVI_OK) dvi__lie_rattle_destroy(rattle);
  return status;
}

void dvi__lie_rattle_destroy(dvi__lie_rattle **rattle)
{
  dvi__lie_rattle *r = *rattle;
  if (r == NULL) return;
  dvi__evaluator_destroy(&r->states);
  dvi__release(r->numbers);
  dvi__release(r);
  *rattle = NULL;
}

/* Factor the matrix at a point, unless it is known. */
static dvi_status factor_at(dvi__lie_rattle *r, double t, const double *q)
{
  const size_t size = (size_t)r->system->n * sizeof *q;
  if (r->knows_start && r->t_start == t && memcmp(r->q_start, q, size) == 0) return DVI_OK;
  r->knows_start = 0;
  r->counters->jacobians++;
  DVI_TRY(dvi__charts_factor_rows(r->states, t, q));
  DVI_TRY(dvi__rows_gradients(r->states, t, q, r->phi_q));
  r->t_start = t;
  memcpy(r->q_start, q, size);
  r->knows_start = 1;
  return DVI_OK;
}

/* Set p -= factor D^T lambda, with the gradients at the start. */
static void kick_by(dvi__lie_rattle *r, double factor, const double *lambda,
                    const dvi__phase *state)
{
  memset(r->covector, 0, (size_t)r->system->n * sizeof(double));
  dvi__rows_pull(r->system, r->phi_q, lambda, 1, r->covector);
  dvi__lie_drift_kick(r->drift, factor, r->covector, state);
}

/* ---- the drift ---- */

static void keep(dvi__lie_rattle *r, const dvi__phase *state)
{
  const size_t q = (size_t)r->system->n * sizeof(double),
               p = (size_t)r->system->nv * sizeof(double);
  memcpy(r->q, state->q, q);
  memcpy(r->p, state->p, p);
  memcpy(r->q_compensation, state->q_compensation, q);
  memcpy(r->p_compensation, state->p_compensation, p);
}

static void restore(const dvi__lie_rattle *r, const dvi__phase *state)
{
  const size_t q = (size_t)r->system->n * sizeof(double),
               p = (size_t)r->system->nv * sizeof(double);
  memcpy(state->q, r->q, q);
  memcpy(state->p, r->p, p);
  memcpy(state->q_compensation, r->q_compensation, q);
  memcpy(state->p_compensation, r->p_compensation, p);
}

/* Drift with the multipliers, and find their correction, in phi. *moved becomes the largest
 * movement by it. */
static dvi_status try_multipliers(dvi__lie_rattle *r, double t, double h, const dvi__phase *state,
                                  const double *lambda, double *displacement, double *moved)
{
  r->counters->residuals++;
  restore(r, state);
  kick_by(r, 0.5 * h, lambda, state);
  DVI_TRY(dvi__lie_drift_drift(r->drift, h, state, displacement));
  DVI_TRY(dvi__rows_value(r->states, t + h, state->q, r->phi));
  if (dvi__first_not_finite((size_t)r->system->row_count, r->phi) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "the constraints at the end of the step are not finite");
  return dvi__charts_solve_rows(r->states, t, r->phi, moved);
}

/* Tell whether a correction is a rounding, or no longer shrinks. */
static int is_settled(double moved, double last, double size)
{
  return moved <= DBL_EPSILON * size || (moved <= 1e-12 * size && moved >= 0.5 * last);
}

dvi_status dvi__lie_rattle_drift(dvi__lie_rattle *r, double t, double h, const dvi__phase *state,
                                 double *lambda, double *displacement)
{
  const double size = dvi__largest((size_t)r->system->n, state->q);
  double moved = HUGE_VAL;
  DVI_TRY(factor_at(r, t, state->q));
  keep(r, state);
  for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
    const double last = moved;
    DVI_TRY(try_multipliers(r, t, h, state, lambda, displacement, &moved));
    if (is_settled(moved, last, size)) {
      r->counters->simplified++;
      return DVI_OK;
    }
    for (int a = 0; a < r->system->row_count; a++) lambda[a] += 2 * r->phi[a] / (h * h);
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "the multipliers of the step do not settle in %d iterations (change %.1e)",
                   (int)MOST_ITERATIONS, moved);
}

/* ---- the end of a step ---- */

static dvi_status project_once(dvi__lie_rattle *r, double t, const dvi__phase *state)
{
  double moved;
  DVI_TRY(dvi__legendre_inverse(r->states, t, state->q, state->p, r->v));
  dvi__factors_rate(r->system, state->q, r->v, r->rate);
  dvi__rows_push(r->system, r->phi_q, r->rate, r->phi_t, r->phi);
  DVI_TRY(dvi__charts_solve_rows(r->states, t, r->phi, &moved));
  kick_by(r, 1, r->phi, state);
  return DVI_OK;
}

/* The second projection rounds off what the first one leaves. */
dvi_status dvi__lie_rattle_end(dvi__lie_rattle *r, double t, const dvi__phase *state)
{
  const dvi_status status = factor_at(r, t, state->q);
  /* a smaller step may end elsewhere */
  if (status != DVI_OK)
    return dvi__fail_in(status == DVI_SINGULAR ? DVI_NOT_CONVERGED : status, "the end of the step");
  DVI_TRY(dvi__rows_rate(r->states, t, state->q, r->phi_t));
  DVI_TRY(project_once(r, t, state));
  return project_once(r, t, state);
}
