/* The equations of a level, and starts.
 *
 * With S(u0, u1) for the action of a row of cells, levels u0 and u1 and their momenta fulfil
 *     p0 = -D_1 S(u0, u1),    p1 = D_2 S(u0, u1),
 * which are the discrete Euler-Lagrange equations of the vertices of u0. u1 is found by Newton's
 * method. Its matrix -D_2 D_1 S is computed anew only if it converges slowly. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multisymplectic/march.h"
#include "num/finite.h"

enum { MOST_ITERATIONS = 50, MOST_FACTORS = 10 };

/* Changes by less than `settled` of the size are roundings. Below `nearly` they are if they do not
 * shrink any more. Above, a change that is not below `slow` of the one before asks for another
 * matrix. */
static const double settled = 4 * DBL_EPSILON, nearly = 1e-10, slow = 0.2;

dvi_status dvi__lattice_factor(dvi__lattice_march *m, double t, const double *lower,
                               const double *upper)
{
  const size_t bytes = (size_t)m->lattice.size * sizeof(double);
  const dvi__row row = {.t = t, .u = {lower, upper}};
  DVI_TRY(dvi__lattice_matrix(&m->lattice, &row, m->solver.values));
  const dvi_status status = dvi__lattice_solver_renew(&m->solver);
  if (status != DVI_OK)
    return dvi__fail_in(status,
                        "multisymplectic: a step of %g from t = %g is too long, or the "
                        "density has no such steps",
                        m->lattice.dt, t);
  m->factored_at = t;
  if (m->factored[0] != lower) memcpy(m->factored[0], lower, bytes);
  if (m->factored[1] != upper) memcpy(m->factored[1], upper, bytes);
  return DVI_OK;
}

void dvi__lattice_keep_factor(dvi__lattice_march *m)
{
  if (m->is_kept) return;
  m->is_kept = 1;
  m->kept_at = m->factored_at;
  for (int k = 0; k < 2; k++)
    memcpy(m->kept[k], m->factored[k], (size_t)m->lattice.size * sizeof(double));
}

dvi_status dvi__lattice_restore_factor(dvi__lattice_march *m)
{
  if (!m->is_kept) return DVI_OK;
  DVI_TRY(dvi__lattice_factor(m, m->kept_at, m->kept[0], m->kept[1]));
  m->is_kept = 0;
  return DVI_OK;
}

/* Set the change of the unknowns of m->level, the upper level of a row, and give its largest. */
static dvi_status find_change(dvi__lattice_march *m, const dvi__row *row, const double *p0,
                              double *largest)
{
  const dvi__lattice *lattice = &m->lattice;
  DVI_TRY(dvi__row_gradient(lattice, row, m->lower, m->p));
  for (int64_t i = 0; i < lattice->size; i++)
    if (lattice->unknown[i] >= 0) m->change[lattice->unknown[i]] = p0[i] + m->lower[i];
  DVI_TRY(dvi__lattice_solver_solve(&m->solver, m->change));
  *largest = dvi__largest((size_t)lattice->unknowns, m->change);
  if (isfinite(*largest)) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "multisymplectic: the step from t = %g leaves the numbers",
                   row->t);
}

static void apply_change(dvi__lattice_march *m)
{
  for (int64_t i = 0; i < m->lattice.size; i++)
    if (m->lattice.unknown[i] >= 0) m->level[i] += m->change[m->lattice.unknown[i]];
}

/* Solve for m->level, which holds a guess, from a level and its momenta, and set m->p. */
static dvi_status solve(dvi__lattice_march *m, double t, const double *u0, const double *p0)
{
  const size_t size = (size_t)m->lattice.size;
  const dvi__row row = {.t = t, .u = {u0, m->level}};
  double last = HUGE_VAL;
  int factors = 0;
  for (int i = 0; i < MOST_ITERATIONS; i++) {
    double change;
    if (i == 1 && m->lattice.is_linear) return dvi__row_gradient(&m->lattice, &row, m->lower, m->p);
    DVI_TRY(find_change(m, &row, p0, &change));
    const double scale = dvi__largest(size, m->level) + dvi__largest(size, u0);
    if (change <= settled * scale || (change <= nearly * scale && change > slow * last))
      return DVI_OK;
    if (i > 0 && change > slow * last && factors < MOST_FACTORS) {
      dvi__lattice_keep_factor(m);
      DVI_TRY(dvi__lattice_factor(m, t, u0, m->level));
      factors++;
      last = HUGE_VAL;
      continue;
    }
    apply_change(m);
    last = change;
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "multisymplectic: the step from t = %g did not converge, with a change of %g in "
                   "iteration %d; take a step shorter than %g",
                   t, last, MOST_ITERATIONS, m->lattice.dt);
}

static void swap(double **a, double **b)
{
  double *const kept = *a;
  *a = *b;
  *b = kept;
}

dvi_status dvi__lattice_step(dvi__lattice_march *m)
{
  const dvi__lattice *lattice = &m->lattice;
  const double t = m->t0 + (double)(m->step + 1) * lattice->dt,
               after = m->t0 + (double)(m->step + 2) * lattice->dt;
  DVI_TRY(dvi__lattice_restore_factor(m));
  for (int64_t i = 0; i < lattice->size; i++) m->level[i] = 2 * m->next[i] - m->now[i];
  DVI_TRY(dvi__lattice_fix(lattice, after, m->level, NULL));
  const dvi_status status = solve(m, t, m->next, m->p_next);
  if (status != DVI_OK) (void)dvi__lattice_restore_factor(m);
  DVI_TRY(status);
  m->is_kept = 0;
  swap(&m->before, &m->now);
  swap(&m->now, &m->next);
  swap(&m->next, &m->level);
  swap(&m->p_now, &m->p_next);
  swap(&m->p_next, &m->p);
  m->step++;
  return DVI_OK;
}

/* ---- start ---- */

/* The first level with its momenta. The next one is in m->level and m->p. */
typedef struct beginning {
  double t;
  double *u, *p;
} beginning;

/* The levels are known: u and u + dt times the rate. */
static dvi_status begin_with_levels(dvi__lattice_march *m, const beginning *b)
{
  const dvi__row row = {.t = b->t, .u = {b->u, m->level}};
  DVI_TRY(dvi__row_gradient(&m->lattice, &row, m->lower, m->p));
  for (int64_t i = 0; i < m->lattice.size; i++) b->p[i] = -m->lower[i];
  return DVI_OK;
}

/* The momenta are those of the rate. */
static dvi_status begin_with_rate(dvi__lattice_march *m, const beginning *b)
{
  const dvi__row row = {.t = b->t, .u = {b->u, b->u}, .rate = m->rate};
  DVI_TRY(dvi__row_momenta(&m->lattice, &row, b->p));
  return solve(m, b->t, b->u, b->p);
}

static dvi_status begin(dvi__lattice_march *m, const dvi_march_state *state, const beginning *b)
{
  const dvi__lattice *lattice = &m->lattice;
  for (int64_t i = 0; i < lattice->size; i++) {
    b->u[i] = state->A != NULL ? state->A[i] : 0;
    m->rate[i] = state->E != NULL ? -state->E[i] : 0;
  }
  DVI_TRY(dvi__lattice_fix(lattice, b->t, b->u, m->rate));
  for (int64_t i = 0; i < lattice->size; i++) m->level[i] = b->u[i] + lattice->dt * m->rate[i];
  DVI_TRY(dvi__lattice_fix(lattice, b->t + lattice->dt, m->level, NULL));
  if (!lattice->is_linear) DVI_TRY(dvi__lattice_factor(m, b->t, b->u, m->level));
  return m->mean_rate ? begin_with_levels(m, b) : begin_with_rate(m, b);
}

static void take_beginning(dvi__lattice_march *m, const beginning *b)
{
  const size_t bytes = (size_t)m->lattice.size * sizeof(double);
  memcpy(m->now, b->u, bytes);
  memcpy(m->p_now, b->p, bytes);
  swap(&m->next, &m->level);
  swap(&m->p_next, &m->p);
  for (int64_t i = 0; i < m->lattice.size; i++)
    m->before[i] = m->mean_rate ? 2 * m->now[i] - m->next[i]
                                : m->next[i] - 2 * m->lattice.dt * m->rate[i];
  m->t = m->t0 = b->t;
  m->step = 0;
  m->is_kept = 0;
}

dvi_status dvi__lattice_start(void *self, const dvi_march_state *state)
{
  dvi__lattice_march *m = self;
  const size_t size = (size_t)m->lattice.size;
  if (state->B != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: a start has the forms A and E, and no B");
  beginning b = {.t = state->t, .u = DVI_NEW(double, 2 * size)};
  if (b.u == NULL) return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for a start");
  b.p = b.u + size;
  if (!m->lattice.is_linear) dvi__lattice_keep_factor(m);
  const dvi_status status = begin(m, state, &b);
  if (status == DVI_OK)
    take_beginning(m, &b);
  else
    (void)dvi__lattice_restore_factor(m);
  dvi__release(b.u);
  return status;
}
