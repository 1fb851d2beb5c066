/* Marches by implicit steps for fields on shares of a mesh (field/implicit/step.h). All steps of a
 * march are equal. What is asked for at a time between them is the end of a shorter step from the
 * last one on, which is made beside the state. */
#include "field/implicit/march.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/implicit/state.h"
#include "field/mesh/share.h"
#include "field/step/saved.h"
#include "field/step/terms.h"

/* ---- steps ---- */

static double time_of(const dvi__implicit_march *m, int64_t n)
{
  return m->at.t0 + (double)n * m->at.dt;
}

static dvi_status explain(const dvi__implicit_march *m, double h, dvi_status status,
                          const dvi__elliptic_report *report)
{
  if (status == DVI_NOT_CONVERGED)
    (void)dvi__fail(status,
                    "%s: Newton's method left a residual of %.2g after %d corrections and %lld "
                    "iterations",
                    report->why, report->residual, report->corrections,
                    (long long)report->iterations);
  return dvi__fail_in(status,
                      "march: %s: step %lld from t = %.9g with h = %.6g failed; the state is "
                      "unchanged, try a smaller step",
                      m->kind->name, (long long)m->at.n + 1, m->last.t, h);
}

/* Set what is shown to the end of a step of h from t_n on. */
static dvi_status take(dvi__implicit_march *m, double h, dvi__implicit_step *s)
{
  dvi__elliptic_report report;
  const dvi_status status = dvi__implicit_take(s, &m->last, &m->shown, &m->is_lost, &report);
  return status == DVI_OK || m->is_lost ? status : explain(m, h, status, &report);
}

static void copy(const dvi__implicit_march *m, const dvi__implicit_state *from,
                 dvi__implicit_state *to)
{
  const dvi_field *f = m->field;
  memcpy(to->q, from->q, (size_t)f->cells * sizeof *to->q);
  memcpy(to->p, from->p, (size_t)f->cells * sizeof *to->p);
  memcpy(to->B, from->B, (size_t)m->faces * sizeof *to->B);
  memcpy(to->delivered, from->delivered, (size_t)f->currents * sizeof *to->delivered);
  to->t = from->t;
}

static dvi_status step(dvi__implicit_march *m)
{
  DVI_TRY(take(m, m->at.dt, m->step));
  m->at.t = m->shown.t = time_of(m, ++m->at.n);
  copy(m, &m->shown, &m->last);
  return DVI_OK;
}

static dvi_status create_step(const dvi__implicit_march *m, double h, dvi__implicit_step **made)
{
  const dvi__implicit_step wanted = {
      .field = m->field, .rule = m->rule, .sweep = m->field->is_wave ? NULL : &m->sweep, .h = h};
  return dvi__implicit_step_create(&wanted, made);
}

/* Show the end of a step of another length. */
static dvi_status step_aside(dvi__implicit_march *m, double h)
{
  if (m->shorter != NULL && m->shorter->h != h) dvi__implicit_step_destroy(&m->shorter);
  if (m->shorter == NULL) DVI_TRY(create_step(m, h, &m->shorter));
  m->shorter->knows_force = 0;
  return take(m, h, m->shorter);
}

static dvi_status move_to(dvi__implicit_march *m, double t)
{
  const double rounding = 8 * DBL_EPSILON * fmax(fabs(t), fabs(m->at.t0));
  while (time_of(m, m->at.n + 1) <= t + rounding) DVI_TRY(step(m));
  if (t > m->last.t + rounding)
    DVI_TRY(step_aside(m, t - m->last.t));
  else
    copy(m, &m->last, &m->shown);
  m->at.t = m->shown.t = t;
  return DVI_OK;
}

/* What has overflowed once stays, so that it is enough to look where the state can be seen. */
static dvi_status check_overflow(dvi__implicit_march *m)
{
  const dvi_field *f = m->field;
  const dvi__implicit_state *s = &m->shown;
  dvi_status status = dvi__check_finite(f, "A", s->q, s->t);
  if (status == DVI_OK) status = dvi__check_finite(f, "the momentum", s->p, s->t);
  status = dvi__agree(f->mesh, status);
  if (status != DVI_OK) m->is_lost = 1;
  return status;
}

static dvi_status advance(void *self, double t)
{
  dvi__implicit_march *m = self;
  const dvi_status status = move_to(m, t);
  if (m->is_lost) return status;
  const dvi_status overflow = check_overflow(m);
  return overflow != DVI_OK ? overflow : status;
}

/* ---- a start ---- */

static void fill(const dvi__implicit_march *m, const dvi_march_state *state,
                 dvi__implicit_state *first)
{
  const dvi_field *f = m->field;
  memcpy(first->q, f->fixed, (size_t)f->cells * sizeof *first->q);
  memset(first->p, 0, (size_t)f->cells * sizeof *first->p);
  memset(first->delivered, 0, (size_t)f->currents * sizeof *first->delivered);
  for (int64_t i = 0; i < f->unknowns; i++) {
    const int c = f->unknown[i];
    if (state->A != NULL) first->q[c] = state->A[c];
    if (state->E != NULL) first->p[c] = -f->mass.value[i] * state->E[c];
  }
  first->t = state->t;
}

/* Set B to what is given, of each cell by its owner, or to dA. */
static dvi_status fill_B(const dvi__implicit_march *m, const double *given,
                         dvi__implicit_state *first)
{
  const dvi_field *f = m->field;
  for (int64_t b = 0; b < m->faces; b++)
    first->B[b] = given != NULL ? given[b] : dvi__sweep_d(&m->sweep, b, first->q);
  return m->faces > 0 ? dvi__refresh(f->mesh, f->degree + 1, first->B) : DVI_OK;
}

static dvi_status start(void *self, const dvi_march_state *state)
{
  dvi__implicit_march *m = self;
  const dvi_field *f = m->field;
  if (state->B != NULL && f->is_wave)
    return dvi__agree(
        f->mesh, dvi__fail(DVI_UNSUPPORTED, "march: %s starts waves from A and E", m->kind->name));
  m->at.t0 = m->at.t = state->t;
  m->at.n = 0;
  m->step->knows_force = 0;
  fill(m, state, &m->last);
  dvi_status status = dvi__refresh(f->mesh, f->degree, m->last.q);
  if (status == DVI_OK) status = dvi__refresh(f->mesh, f->degree, m->last.p);
  if (status == DVI_OK) status = fill_B(m, state->B, &m->last);
  m->is_lost = status != DVI_OK;
  copy(m, &m->last, &m->shown);
  if (status == DVI_OK) status = check_overflow(m);
  if (status == DVI_OK) dvi__implicit_begin_charge(m);
  return status;
}

/* ---- what it is ---- */

static double time(const void *self)
{
  return ((const dvi__implicit_march *)self)->at.t;
}

static int64_t size(const void *self, dvi_march_form form)
{
  const dvi__implicit_march *m = self;
  return form == DVI_FORM_B ? m->sweep.faces : m->field->cells;
}

static void facts(const void *self, dvi_march_facts *facts)
{
  const dvi__implicit_march *m = self;
  *facts = (dvi_march_facts){.step = m->at.dt,
                             .longest = m->at.dt,
                             .bound = (double)INFINITY,
                             .steps = m->at.n,
                             .updates = m->at.n *
                                        dvi__whole_count(m->field->mesh, m->field->degree + 1)};
}

/* ---- files ---- */

enum { VERSION = 2, PIECES = 8 };

static dvi__saved_march saved_of(const dvi__implicit_march *m, dvi__piece piece[PIECES])
{
  const dvi_field *f = m->field;
  double *const forms[] = {m->last.q, m->last.p, m->shown.q, m->shown.p};
  for (int i = 0; i < 4; i++) piece[i] = (dvi__piece){f->degree, f->cells, forms[i]};
  piece[4] = (dvi__piece){f->degree + 1, m->faces, m->last.B};
  piece[5] = (dvi__piece){f->degree + 1, m->faces, m->shown.B};
  piece[6] = (dvi__piece){-1, 2 * (int64_t)f->currents, m->last.delivered};
  piece[7] = (dvi__piece){f->degree - 1, dvi__charge_numbers(f) - f->currents, m->charge.start};
  return (dvi__saved_march){.method = m->rule->name,
                            .version = VERSION,
                            .mesh = f->mesh,
                            .at = (dvi__march_place *)&m->at,
                            .pieces = PIECES,
                            .piece = piece};
}

static dvi_status save(const void *self, dvi__sections_writer *writer)
{
  dvi__piece piece[PIECES];
  const dvi__saved_march march = saved_of(self, piece);
  return dvi__saved_march_put(&march, writer);
}

static dvi_status load(void *self, const dvi__sections *sections)
{
  dvi__implicit_march *m = self;
  dvi__piece piece[PIECES];
  const dvi__saved_march march = saved_of(m, piece);
  DVI_TRY(dvi__saved_march_take(&march, sections));
  m->last.t = time_of(m, m->at.n);
  m->shown.t = m->at.t;
  m->is_lost = m->step->knows_force = 0;
  return DVI_OK;
}

static dvi_status agree(const void *self, dvi_status status)
{
  return dvi__agree(((const dvi__implicit_march *)self)->field->mesh, status);
}

static int is_lost(const void *self)
{
  return ((const dvi__implicit_march *)self)->is_lost;
}

static int writes(const void *self)
{
  return dvi__is_first(((const dvi__implicit_march *)self)->field->mesh);
}

/* ---- create ---- */

static void destroy(void *self)
{
  dvi__implicit_march *m = self;
  if (m == NULL) return;
  dvi__implicit_step_destroy(&m->step);
  dvi__implicit_step_destroy(&m->shorter);
  dvi__charge_clear(&m->charge);
  dvi__sweep_clear(&m->sweep);
  dvi__release(m->numbers);
  dvi__release(m);
}

/* Lay the states out in one block. */
static dvi_status make_own(dvi__implicit_march *m)
{
  const dvi_field *f = m->field;
  double **const forms[] = {&m->last.q, &m->last.p, &m->shown.q, &m->shown.p, &m->E, &m->spare};
  DVI_TRY(dvi__sweep_create(f, 1, &m->sweep));
  if (!f->is_wave && !m->sweep.is_diagonal)
    DVI_TRY(dvi__refuse_share_but(f->mesh, "march: midpoint with a star that is not diagonal",
                                  "the circumcentric star"));
  m->faces = f->is_wave ? 0 : m->sweep.faces;
  m->numbers = DVI_NEW(double, 6 * f->cells + 2 * m->faces + f->currents + dvi__charge_numbers(f));
  if (m->numbers == NULL) return dvi__fail(DVI_NO_MEMORY, "march: no memory for a state");
  for (int i = 0; i < 6; i++) *forms[i] = m->numbers + i * f->cells;
  m->last.B = m->numbers + 6 * f->cells;
  m->shown.B = m->last.B + m->faces;
  m->last.delivered = m->shown.B + m->faces;
  m->shown.delivered = m->last.delivered + f->currents;
  return dvi__charge_create(f, m->shown.delivered, &m->charge);
}

static dvi_status make(dvi__implicit_march *m)
{
  const dvi_field *f = m->field;
  DVI_TRY(dvi__agree(f->mesh, make_own(m)));
  DVI_TRY(dvi__refresh(f->mesh, f->degree + 1, m->sweep.weight));
  DVI_TRY(create_step(m, m->at.dt, &m->step));
  return dvi__field_hash(f, &m->at.hash);
}

/* The same functions by the name of each method. */
#define KIND(NAME)                                                                            \
  {                                                                                           \
    .name = (NAME), .destroy = destroy, .start = start, .advance = advance, .time = time,     \
    .size = size, .sample = dvi__implicit_sample, .observables = dvi__implicit_observables,   \
    .observable = dvi__implicit_observable, .observe = dvi__implicit_observe, .facts = facts, \
    .save = save, .load = load, .agree = agree, .writes = writes, .is_lost = is_lost,         \
    .has_parts = 1,                                                                           \
  }

static const dvi__march_kind kinds[] = {[DVI__IMPLICIT_MIDPOINT] = KIND("midpoint"),
                                        [DVI__IMPLICIT_IMEX] = KIND("imex"),
                                        [DVI__IMPLICIT_GALERKIN] = KIND("galerkin")};

dvi_status dvi__implicit_create(const dvi_field *field, const dvi__implicit_plan *plan,
                                dvi_march **march)
{
  dvi__implicit_march *m = DVI_NEW(dvi__implicit_march, 1);
  dvi_status status = dvi__agree(field->mesh,
                                 m != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "march: no memory"));
  if (status == DVI_OK) {
    m->kind = kinds + plan->method;
    m->rule = plan->rule;
    m->field = field;
    m->at.dt = plan->dt;
    status = make(m);
  }
  if (status != DVI_OK) {
    destroy(m);
    return status;
  }
  status = dvi__agree(field->mesh, dvi__march_wrap(m->kind, m, march));
  if (status != DVI_OK) dvi_march_destroy(march);
  return status;
}
