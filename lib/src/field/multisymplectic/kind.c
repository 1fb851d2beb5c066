/* Lattices as marches (dvi/march.h).
 *
 * With the multilinear function u_h of the values at the corners, and points and weights of a
 * product quadrature, a cell has the action
 *     Ld = sum_q w_q l(t_q, x_q, u_h, d_t u_h, d_x u_h).
 * Its stationarity at a vertex is D_1 Ld + .. + D_n Ld = 0 over the n = 2^(axes+1) cells around it.
 * Source: Marsden, Patrick and Shkoller 1998; Leok 2004, sec. 5.1.3. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multisymplectic/march.h"

/* ---- creation ---- */

void dvi__lattice_march_clear(dvi__lattice_march *m)
{
  dvi__lattice_solver_clear(&m->solver);
  dvi__lattice_clear(&m->lattice);
  dvi__release(m->all);
}

static void destroy(void *self)
{
  dvi__lattice_march_clear(self);
  dvi__release(self);
}

static dvi_status choose_step(const dvi_multisymplectic_terms *terms, dvi__lattice *lattice)
{
  const double fraction = terms->fraction != 0 ? terms->fraction : 0.5;
  if (!isfinite(terms->step) || terms->step < 0 || !(fraction > 0 && fraction <= 1) ||
      !isfinite(terms->span) || terms->span < 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: step = %g, fraction = %g, span = %g; steps and spans are "
                     "positive, and a fraction is above 0 and at most 1",
                     terms->step, fraction, terms->span);
  if (terms->step == 0 && !isfinite(lattice->bound))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: nothing is known that bounds the step; set a step");
  lattice->dt = terms->step > 0 ? terms->step
                                : dvi__fit_step(fraction * lattice->bound, terms->span);
  if (lattice->dt <= lattice->bound * (1 + 1e-12)) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "multisymplectic: the step %.17g is beyond the bound %.17g of stable ones; take "
                   "a shorter step, or the weight 1/4 in time, with which all steps are stable",
                   lattice->dt, lattice->bound);
}

static dvi_status allocate(dvi__lattice_march *m)
{
  const size_t size = (size_t)m->lattice.size;
  double **const place[] = {&m->before,  &m->now,     &m->next,   &m->p_now,       &m->p_next,
                            &m->level,   &m->p,       &m->lower,  &m->factored[0], &m->factored[1],
                            &m->kept[0], &m->kept[1], &m->change, &m->rate};
  const size_t count = sizeof place / sizeof *place;
  m->all = DVI_NEW(double, count *size);
  if (m->all == NULL)
    return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for %lld values",
                     (long long)m->lattice.size);
  for (size_t i = 0; i < count; i++) *place[i] = m->all + i * size;
  return DVI_OK;
}

dvi_status dvi__lattice_march_make(const dvi_multisymplectic_terms *terms, dvi__lattice_march *m)
{
  dvi__lattice *lattice = &m->lattice;
  DVI_TRY(dvi__lattice_make(terms, lattice));
  DVI_TRY(choose_step(terms, lattice));
  DVI_TRY(dvi__lattice_make_pattern(lattice));
  DVI_TRY(allocate(m));
  m->mean_rate = terms->mean_rate != 0;
  const dvi__lattice_solver_terms equations = {.pattern = &lattice->pattern,
                                               .axes = lattice->axes,
                                               .is_symmetric = lattice->is_symmetric,
                                               .is_exact = lattice->is_linear};
  DVI_TRY(dvi__lattice_solver_make(&equations, &m->solver));
  if (!lattice->is_linear) return DVI_OK;
  return dvi__lattice_factor(m, 0, m->now, m->next);
}

/* ---- motion ---- */

/* Give the number of whole steps until t, with a few roundings of the times to spare. */
static int64_t steps_until(const dvi__lattice_march *m, double t)
{
  const double dt = m->lattice.dt, steps = (t - m->t0) / dt,
               spare = 4 * DBL_EPSILON * ((fabs(t) + fabs(m->t0)) / dt + fabs(steps));
  return (int64_t)floor(steps + fmin(spare, 0.5));
}

static dvi_status advance(void *self, double t)
{
  dvi__lattice_march *m = self;
  const double steps = (t - m->t0) / m->lattice.dt;
  if (!(steps < 9e15))
    return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: %g steps until t = %g cannot be counted",
                     steps, t);
  for (const int64_t last = steps_until(m, t); m->step < last;) {
    const dvi_status status = dvi__lattice_step(m);
    if (status == DVI_OK) continue;
    m->t = fmax(m->t, m->t0 + (double)m->step * m->lattice.dt);
    return status;
  }
  m->t = t;
  return DVI_OK;
}

static double time_of(const void *self)
{
  return ((const dvi__lattice_march *)self)->t;
}

static int64_t size_of(const void *self, dvi_march_form form)
{
  return form == DVI_FORM_B ? 0 : ((const dvi__lattice_march *)self)->lattice.size;
}

/* The parabola through three levels, or its rate. */
static dvi_status sample(const void *self, dvi_march_form form, int64_t count, const int *cell,
                         double *values)
{
  const dvi__lattice_march *m = self;
  const double dt = m->lattice.dt, s = (m->t - m->t0) / dt - (double)m->step;
  for (int64_t k = 0; k < count; k++) {
    const int64_t i = cell != NULL ? cell[k] : k;
    const double slope = (m->next[i] - m->before[i]) / 2,
                 bend = (m->next[i] - m->now[i]) - (m->now[i] - m->before[i]);
    values[k] = form == DVI_FORM_A ? m->now[i] + s * (slope + s * bend / 2)
                                   : -(slope + s * bend) / dt;
  }
  return DVI_OK;
}

static void facts_of(const void *self, dvi_march_facts *facts)
{
  const dvi__lattice_march *m = self;
  facts->step = facts->longest = m->lattice.dt;
  facts->bound = m->lattice.bound;
  facts->steps = m->step;
  facts->updates = m->step * m->lattice.cells;
}

static const dvi__march_kind lattice_kind = {.name = "multisymplectic",
                                             .destroy = destroy,
                                             .start = dvi__lattice_start,
                                             .advance = advance,
                                             .time = time_of,
                                             .size = size_of,
                                             .sample = sample,
                                             .observables = dvi__lattice_observables,
                                             .observable = dvi__lattice_observable,
                                             .observe = dvi__lattice_observe,
                                             .facts = facts_of,
                                             .save = dvi__lattice_save,
                                             .load = dvi__lattice_load};

dvi_status dvi_multisymplectic_create(const dvi_multisymplectic_terms *terms, dvi_march **march)
{
  if (march == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: a place for the march is needed");
  *march = NULL;
  dvi__lattice_march *m = DVI_NEW(dvi__lattice_march, 1);
  if (m == NULL) return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory");
  const dvi_status status = dvi__lattice_march_make(terms, m);
  if (status == DVI_OK) return dvi__march_wrap(&lattice_kind, m, march);
  destroy(m);
  return status;
}
