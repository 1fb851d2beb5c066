/* What a march shows: psi at its time, and observables. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/schroedinger/march.h"

/* Observables before those of the axes, and the numbers for each axis. */
enum { FIRST = 5, FOR_AXIS = 2 };

/* ---- names ---- */

static void name_axes(dvi__wave_march *m, const char *quantity, int *at, int probe)
{
  for (int d = 0; d < m->s->dimension; d++) {
    const char *axis = dvi_space_axis(m->s->space, d);
    if (probe < 0)
      (void)snprintf(m->name[(*at)++], DVI__OBSERVABLE_NAME, "%s_%.16s", quantity, axis);
    else
      (void)snprintf(m->name[(*at)++], DVI__OBSERVABLE_NAME, "%s_%.8s_%d", quantity, axis, probe);
  }
}

static void name_all(dvi__wave_march *m)
{
  static const char *const first[FIRST] = {"norm", "energy", "kinetic", "potential", "interaction"};
  int at = 0;
  for (; at < FIRST; at++) (void)snprintf(m->name[at], DVI__OBSERVABLE_NAME, "%s", first[at]);
  name_axes(m, "position", &at, -1);
  name_axes(m, "momentum", &at, -1);
  for (int i = 0; i < m->probes; i++) {
    (void)snprintf(m->name[at++], DVI__OBSERVABLE_NAME, "density_%d", i);
    name_axes(m, "current", &at, i);
  }
}

/* ---- creation ---- */

static dvi_status allocate(dvi__wave_march *m)
{
  const dvi_schroedinger *s = m->s;
  m->observables = FIRST + FOR_AXIS * s->dimension + m->probes * (1 + s->dimension);
  m->name = dvi__allocate((size_t)m->observables, sizeof *m->name);
  m->probe = DVI_NEW(double, m->probes * s->dimension);
  m->view = DVI_NEW(dvi__view, 1);
  dvi__view *v = m->view;
  if (v != NULL) {
    v->z = DVI_NEW(double, 4 * s->free);
    v->psi = DVI_NEW(double, 2 * s->functions);
    v->V = DVI_NEW(double, 5 * s->points);
    v->work = DVI_NEW(double, dvi__operator_work(s->space));
  }
  if (!m->name || !m->probe || !v || !v->z || !v->psi || !v->V || !v->work)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for observables");
  v->compensation = v->z + 2 * s->free;
  v->u = v->V + s->points;
  return DVI_OK;
}

dvi_status dvi__wave_make_view(dvi__wave_march *m, const dvi_schroedinger_march_options *options)
{
  const int none[DVI_AXES_MAX] = {0};
  m->probes = options->probes;
  DVI_TRY(allocate(m));
  name_all(m);
  for (int i = 0; i < m->probes; i++) {
    double unused;
    for (int d = 0; d < m->s->dimension; d++)
      m->probe[i * m->s->dimension + d] = options->probe[d * m->probes + i];
    const dvi_status status = dvi_space_evaluate(m->s->space, none, m->view->psi, 1,
                                                 m->probe + i * m->s->dimension, &unused);
    if (status != DVI_OK) return dvi__fail_in(status, "schroedinger: probe %d", i);
  }
  return DVI_OK;
}

void dvi__wave_clear_view(dvi__wave_march *m)
{
  dvi__release(m->name);
  dvi__release(m->probe);
  if (m->view == NULL) return;
  dvi__wave_stepper_destroy(&m->view->stepper);
  dvi__release(m->view->z);
  dvi__release(m->view->psi);
  dvi__release(m->view->V);
  dvi__release(m->view->work);
  dvi__release(m->view);
}

/* ---- psi now ---- */

/* Make the rest of a step that leads to the march's time. */
static dvi_status step_beside(const dvi__wave_march *m)
{
  dvi__view *v = m->view;
  const double t = m->t0 + (double)m->step * m->dt, h = m->t - t;
  if (!(h > dvi__wave_spare(m, m->t) * m->dt)) return DVI_OK;
  DVI_TRY(dvi__wave_stepper_create(m->s, &m->method, h, &v->stepper));
  return m->method.is_split ? dvi__split_step(v->stepper.split, t, v->z, v->compensation)
                            : dvi__gauss_step(v->stepper.gauss, t, v->z, v->compensation);
}

static dvi_status look(const dvi__wave_march *m)
{
  const dvi_schroedinger *s = m->s;
  dvi__view *v = m->view;
  if (v->is_now) return DVI_OK;
  memcpy(v->z, m->z, (size_t)(2 * s->free) * sizeof *v->z);
  memcpy(v->compensation, m->compensation, (size_t)(2 * s->free) * sizeof *v->z);
  DVI_TRY(step_beside(m));
  for (int c = 0; c < 2; c++)
    dvi__schroedinger_extend(s, v->z + c * s->free, v->psi + c * s->functions);
  v->is_now = 1;
  v->is_measured = 0;
  return DVI_OK;
}

int64_t dvi__wave_size(const void *self, dvi_march_form form)
{
  const dvi__wave_march *m = self;
  return form == DVI_FORM_A ? 2 * m->s->functions : 0;
}

dvi_status dvi__wave_sample(const void *self, dvi_march_form form, int64_t count, const int *cell,
                            double *values)
{
  const dvi__wave_march *m = self;
  (void)form; /* there is one form */
  DVI_TRY(look(m));
  for (int64_t i = 0; i < count; i++) values[i] = m->view->psi[cell != NULL ? cell[i] : i];
  return DVI_OK;
}

/* ---- observables ---- */

int dvi__wave_observables(const void *self)
{
  const dvi__wave_march *m = self;
  return m->observables;
}

const char *dvi__wave_observable(const void *self, int i)
{
  const dvi__wave_march *m = self;
  return m->name[i];
}

static dvi_status measure(const dvi__wave_march *m)
{
  dvi__view *v = m->view;
  if (v->is_measured) return DVI_OK;
  DVI_TRY(dvi__schroedinger_potential(m->s, m->t, v->V));
  dvi__schroedinger_measure_at(m->s, v->V, v->psi, v->u, v->work, &v->values);
  v->is_measured = 1;
  return DVI_OK;
}

/* Evaluate both parts of a derivative of psi at a probe. */
static dvi_status evaluate(const dvi__wave_march *m, int probe, const int *order, double *parts)
{
  const dvi_schroedinger *s = m->s;
  for (int c = 0; c < 2; c++)
    DVI_TRY(dvi_space_evaluate(s->space, order, m->view->psi + c * s->functions, 1,
                               m->probe + probe * s->dimension, parts + c));
  return DVI_OK;
}

/* The density, or the current along axis d. */
static dvi_status observe_probe(const dvi__wave_march *m, int probe, int d, double *value)
{
  int order[DVI_AXES_MAX] = {0};
  double psi[2], slope[2];
  DVI_TRY(evaluate(m, probe, order, psi));
  *value = psi[0] * psi[0] + psi[1] * psi[1];
  if (d < 0) return DVI_OK;
  order[d] = 1;
  DVI_TRY(evaluate(m, probe, order, slope));
  *value = m->s->hbar / m->s->mass * (psi[0] * slope[1] - psi[1] * slope[0]);
  return DVI_OK;
}

dvi_status dvi__wave_observe(const void *self, int i, double *value)
{
  const dvi__wave_march *m = self;
  const int axes = m->s->dimension, probes = FIRST + FOR_AXIS * axes;
  DVI_TRY(look(m));
  if (i >= probes)
    return observe_probe(m, (i - probes) / (1 + axes), (i - probes) % (1 + axes) - 1, value);
  DVI_TRY(measure(m));
  const dvi_schroedinger_values *v = &m->view->values;
  const double first[FIRST] = {v->norm, v->energy, v->kinetic, v->potential, v->interaction};
  *value = i < FIRST          ? first[i]
           : i < FIRST + axes ? v->position[i - FIRST]
                              : v->momentum[i - FIRST - axes];
  return DVI_OK;
}
