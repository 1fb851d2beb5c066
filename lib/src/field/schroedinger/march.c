/* Schroedinger's equation as a march (dvi/march.h), by whole steps. */
#include "field/schroedinger/march.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"

/* ---- the step ---- */

dvi_status dvi__wave_stepper_create(const dvi_schroedinger *s,
                                    const dvi__schroedinger_method *method, double h,
                                    dvi__wave_stepper *stepper)
{
  if (method->is_split) {
    if (stepper->split == NULL) DVI_TRY(dvi__split_create(s, method->order, &stepper->split));
    return dvi__split_prepare(stepper->split, h);
  }
  if (stepper->gauss == NULL) DVI_TRY(dvi__gauss_create(s, method->stages, &stepper->gauss));
  return dvi__gauss_prepare(stepper->gauss, h);
}

void dvi__wave_stepper_destroy(dvi__wave_stepper *stepper)
{
  dvi__gauss_destroy(&stepper->gauss);
  dvi__split_destroy(&stepper->split);
}

/* ---- creation ---- */

static void destroy(void *self)
{
  dvi__wave_march *m = self;
  dvi__wave_stepper_destroy(&m->stepper);
  dvi__wave_clear_view(m);
  dvi__release(m->z);
  dvi__release(m->compensation);
  dvi__release(m);
}

static dvi_status check_options(const dvi_schroedinger_march_options *options)
{
  if (options == NULL || options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "schroedinger: set options.size to sizeof(dvi_schroedinger_march_options)");
  if (!(options->step > 0) || isinf(options->step))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "schroedinger: the step is %g; a finite one above 0 is needed", options->step);
  if (!(options->span >= 0) || isinf(options->span))
    return dvi__fail(DVI_BAD_ARGUMENT, "schroedinger: the span is %g; 0 or more are possible",
                     options->span);
  if (options->probes < 0 || (options->probes > 0 && options->probe == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "schroedinger: %d probes need as many points",
                     options->probes);
  return DVI_OK;
}

static dvi_status make(dvi__wave_march *m, const dvi_schroedinger_march_options *options)
{
  const char *method = options->method != NULL ? options->method : "midpoint";
  DVI_TRY(dvi__schroedinger_read_method(method, &m->method));
  m->dt = dvi__fit_step(options->step, options->span);
  DVI_TRY(dvi__wave_stepper_create(m->s, &m->method, m->dt, &m->stepper));
  if (m->method.is_split && m->s->beta != NULL)
    DVI_TRY(dvi__schroedinger_largest_kinetic(m->s, &m->kinetic));
  m->z = DVI_NEW(double, 2 * m->s->free);
  m->compensation = DVI_NEW(double, 2 * m->s->free);
  if (m->z == NULL || m->compensation == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld functions",
                     (long long)m->s->free);
  return dvi__wave_make_view(m, options);
}

/* ---- motion ---- */

static dvi_status start(void *self, const dvi_march_state *state)
{
  dvi__wave_march *m = self;
  const dvi_schroedinger *s = m->s;
  if (state->E != NULL || state->B != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "schroedinger: a start has psi as its form A, and no forms E and B");
  const ptrdiff_t bad = state->A != NULL ? dvi__first_not_finite(2 * (size_t)s->functions, state->A)
                                         : -1;
  if (bad >= 0)
    return dvi__fail(
        DVI_NOT_FINITE, "schroedinger: the start has %g as the %s part of function %lld",
        state->A[bad], bad < s->functions ? "real" : "imaginary", (long long)(bad % s->functions));
  for (int c = 0; c < 2 && state->A != NULL; c++)
    dvi__schroedinger_restrict(s, state->A + c * s->functions, m->z + c * s->free);
  if (state->A == NULL) memset(m->z, 0, (size_t)(2 * s->free) * sizeof *m->z);
  memset(m->compensation, 0, (size_t)(2 * s->free) * sizeof *m->z);
  m->t0 = m->t = state->t;
  m->step = 0;
  m->view->is_now = 0;
  return DVI_OK;
}

double dvi__wave_spare(const dvi__wave_march *m, double t)
{
  return fmin(0.25, 4e-15 * (fabs(m->t0) + fabs(t)) / m->dt);
}

static dvi_status take_step(dvi__wave_march *m)
{
  const double t = m->t0 + (double)m->step * m->dt;
  if (m->method.is_split)
    DVI_TRY(dvi__split_step(m->stepper.split, t, m->z, m->compensation));
  else
    DVI_TRY(dvi__gauss_step(m->stepper.gauss, t, m->z, m->compensation));
  m->step++;
  return DVI_OK;
}

static dvi_status advance(void *self, double t)
{
  dvi__wave_march *m = self;
  const double steps = (t - m->t0) / m->dt + dvi__wave_spare(m, t);
  if (!(steps < 9e15))
    return dvi__fail(DVI_BAD_ARGUMENT, "schroedinger: %g steps until t = %g cannot be counted",
                     steps, t);
  m->view->is_now = 0;
  while (m->step < (int64_t)floor(steps)) {
    const dvi_status status = take_step(m);
    if (status == DVI_OK) continue;
    m->t = fmax(m->t, m->t0 + (double)m->step * m->dt);
    return status;
  }
  m->t = t;
  return DVI_OK;
}

static double time_of(const void *self)
{
  const dvi__wave_march *m = self;
  return m->t;
}

/* The largest energy of an interaction that repels, now. */
static double repulsion_of(const dvi__wave_march *m)
{
  const dvi_schroedinger *s = m->s;
  double *u = m->view->u, *v = u + s->points, most = 0;
  dvi__schroedinger_to_points(s, m->z, u, m->view->work);
  dvi__schroedinger_to_points(s, m->z + s->free, v, m->view->work);
  for (int64_t k = 0; k < s->points; k++)
    most = fmax(most, s->beta[k] * (u[k] * u[k] + v[k] * v[k]));
  return most;
}

/* Beside a wave of a density rho that is the same everywhere, split steps of small amplitudes are a
 * turn by the kinetic phase a and a shear by 2 beta rho h/hbar of their real and imaginary parts.
 * They grow if a + 2 atan(beta rho h/hbar) is above pi, where a = T h/hbar on fourier and
 * 2 atan(T h/(2 hbar)) of Cayley's transform. T is the largest kinetic energy. Below a = pi none
 * grow beside attraction but those that do so without steps. Source: Weideman and Herbst 1986, for
 * fourier. Compositions of order 4 and 6 grow at no less than part_of_bound of it, by the
 * eigenvalues of their matrices for T/B from 1 to 200. */
static double bound_of_order_2(const dvi__wave_march *m)
{
  const double pi = 3.141592653589793, hbar = m->s->hbar;
  if (m->kinetic == 0) return INFINITY;
  const double B = repulsion_of(m);
  if (!m->s->is_fourier) return B > 0 ? hbar * sqrt(2 / (m->kinetic * B)) : (double)INFINITY;
  double below = 0, above = pi * hbar / m->kinetic;
  for (int i = 0; i < 60 && B > 0; i++) {
    const double h = 0.5 * (below + above);
    *(m->kinetic * h / hbar + 2 * atan(B * h / hbar) < pi ? &below : &above) = h;
  }
  return above;
}

static double bound_of(const dvi__wave_march *m)
{
  const double part_of_bound = m->s->is_fourier ? 0.98 : 0.94;
  return bound_of_order_2(m) * (m->method.order > 2 ? part_of_bound : 1);
}

static void facts_of(const void *self, dvi_march_facts *facts)
{
  const dvi__wave_march *m = self;
  facts->step = facts->longest = m->dt;
  facts->bound = bound_of(m);
  facts->steps = m->step;
  facts->updates = m->step * m->s->free;
}

static const dvi__march_kind wave_kind = {.name = "schroedinger",
                                          .destroy = destroy,
                                          .start = start,
                                          .advance = advance,
                                          .time = time_of,
                                          .size = dvi__wave_size,
                                          .sample = dvi__wave_sample,
                                          .observables = dvi__wave_observables,
                                          .observable = dvi__wave_observable,
                                          .observe = dvi__wave_observe,
                                          .facts = facts_of,
                                          .save = dvi__wave_save,
                                          .load = dvi__wave_load};

dvi_status dvi_schroedinger_march(const dvi_schroedinger *equation,
                                  const dvi_schroedinger_march_options *options, dvi_march **march)
{
  if (equation == NULL || march == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "schroedinger: an equation and a place for the march are needed");
  *march = NULL;
  DVI_TRY(check_options(options));
  dvi__wave_march *m = DVI_NEW(dvi__wave_march, 1);
  if (m == NULL) return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for a march");
  m->s = equation;
  const dvi_status status = make(m, options);
  if (status == DVI_OK) return dvi__march_wrap(&wave_kind, m, march);
  destroy(m);
  return status;
}
