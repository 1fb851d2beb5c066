/* Marches by asynchronous steps (field/avi/avi.h has the discrete action and its source). */
#include "field/avi/march.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/avi/monodromy.h"
#include "field/step/classes.h"
#include "field/step/observables.h"
#include "field/step/source.h"

/* A current of the field, for the callback. */
typedef struct signal {
  const dvi_field *field;
  int current;
} signal;

/* A field as the arrays of its steps. */
typedef struct arrays {
  double *M1, *damping, *profile; /* [cells], [cells], [currents*cells] */
  int8_t *is_fixed;               /* [cells] */
  dvi__avi_current *current;
  signal *signal; /* outlives the others */
  double *source; /* [unknowns] of a wave, or NULL. Outlives the others */
  dvi__avi_terms terms;
} arrays;

typedef struct march {
  const dvi_field *field;
  dvi__avi *avi;
  signal *signal;
  double *source;
} march;

/* ---- the field's arrays ---- */

static void clear_arrays(arrays *a)
{
  dvi__release(a->M1);
  dvi__release(a->damping);
  dvi__release(a->profile);
  dvi__release(a->is_fixed);
  dvi__release(a->current);
}

static dvi_status impulse_of_current(double from, double to, double *impulse, void *user)
{
  const signal *s = user;
  return dvi__current_impulse(s->field, s->current, from, to, impulse);
}

/* A wave's source is a current that does not change: E = -u' makes M E' = K u - source of
 * M u'' = source - K u. */
static dvi_status impulse_of_source(double from, double to, double *impulse, void *user)
{
  (void)user;
  *impulse = to - from;
  return DVI_OK;
}

static void fill_currents(const dvi_field *field, arrays *a)
{
  for (int c = 0; c < a->terms.currents; c++) {
    double *profile = a->profile + c * field->cells;
    const int is_source = c == field->currents;
    for (int64_t i = 0; i < field->unknowns && is_source; i++)
      profile[field->unknown[i]] = a->source[i];
    for (int64_t k = 0; !is_source && k < field->current[c].count; k++)
      profile[field->unknown[field->current[c].unknown[k]]] = field->current[c].weight[k];
    a->signal[c] = (signal){field, c};
    a->current[c] = (dvi__avi_current){profile, is_source ? impulse_of_source : impulse_of_current,
                                       a->signal + c};
  }
}

static void fill_in(const dvi_field *field, arrays *a)
{
  for (int64_t c = 0; c < field->cells; c++) a->is_fixed[c] = field->number[c] < 0;
  for (int64_t i = 0; i < field->unknowns; i++) {
    const int64_t at = field->damping.rows > 0 ? dvi__csr_find(&field->damping, i, (int)i) : -1;
    a->M1[field->unknown[i]] = field->mass.value[i];
    a->damping[field->unknown[i]] = at >= 0 ? field->damping.value[at] : 0;
  }
  fill_currents(field, a);
}

static dvi_status find_incidence(const dvi_field *field, dvi__avi_terms *terms)
{
  dvi_matrix d, below = {0}, M2;
  DVI_TRY(dvi_mesh_incidence(field->mesh, field->degree, &d));
  DVI_TRY(dvi_star_matrix(field->star, field->degree + 1, &M2));
  if (field->degree > 0) DVI_TRY(dvi_mesh_incidence(field->mesh, field->degree - 1, &below));
  if (!field->mass_is_diagonal || M2.column != NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "avi: the star is not diagonal, so that cells have no steps of their own; "
                     "take a circumcentric star, or leapfrog");
  *terms = (dvi__avi_terms){.mesh = field->mesh,
                            .degree = field->degree,
                            .edges = field->cells,
                            .faces = d.rows,
                            .width = d.width,
                            .facet = d.column,
                            .sign = d.sign,
                            .M2 = M2.value,
                            .nodes = below.columns,
                            .node_width = below.width,
                            .node = below.column,
                            .node_sign = below.sign};
  return DVI_OK;
}

static dvi_status make_arrays(const dvi_field *field, const dvi__march_plan *plan, arrays *a)
{
  DVI_TRY(find_incidence(field, &a->terms));
  a->terms.shortest = plan->step;
  a->terms.fraction = plan->fraction;
  a->terms.span = plan->step > 0 ? 0 : plan->span;
  a->terms.threads = plan->threads;
  DVI_TRY(dvi__read_classes(plan->options, &a->terms.is_free, &a->terms.band));
  DVI_TRY(dvi__wave_source(field, &a->source));
  const int currents = field->currents + (a->source != NULL);
  a->M1 = DVI_NEW(double, field->cells);
  a->damping = DVI_NEW(double, field->cells);
  a->profile = DVI_NEW(double, currents * field->cells);
  a->is_fixed = DVI_NEW(int8_t, field->cells);
  a->current = DVI_NEW(dvi__avi_current, currents);
  a->signal = DVI_NEW(signal, currents);
  if (!a->M1 || !a->damping || !a->profile || !a->is_fixed || !a->current || !a->signal)
    return dvi__fail(DVI_NO_MEMORY, "avi: no memory for %lld cells", (long long)field->cells);
  a->terms.M1 = a->M1;
  a->terms.damping = a->damping;
  a->terms.is_fixed = a->is_fixed;
  a->terms.current = a->current;
  a->terms.currents = currents;
  fill_in(field, a);
  return DVI_OK;
}

/* ---- motion ---- */

static void destroy(void *self)
{
  march *m = self;
  if (m == NULL) return;
  dvi__avi_destroy(&m->avi);
  dvi__release(m->signal);
  dvi__release(m->source);
  dvi__release(m);
}

/* What is held has the field's values, whatever A says there. */
static dvi_status start(void *self, const dvi_march_state *state)
{
  march *m = self;
  const dvi_field *f = m->field;
  double *A = dvi__duplicate(f->fixed, (size_t)f->cells, sizeof *A);
  if (A == NULL) return dvi__fail(DVI_NO_MEMORY, "avi: no memory for a start");
  for (int64_t i = 0; i < f->unknowns && state->A != NULL; i++)
    A[f->unknown[i]] = state->A[f->unknown[i]];
  const dvi_status status = dvi__avi_start(m->avi, state->t, A, state->E, state->B);
  dvi__release(A);
  return status;
}

static dvi_status advance(void *self, double t)
{
  return dvi__avi_advance(((march *)self)->avi, t);
}

static double time(const void *self)
{
  return dvi__avi_time(((const march *)self)->avi);
}

/* ---- what can be seen ---- */

static int64_t size(const void *self, dvi_march_form form)
{
  const dvi_field *f = ((const march *)self)->field;
  return form == DVI_FORM_B ? dvi_mesh_count(f->mesh, f->degree + 1) : f->cells;
}

static dvi_status sample(const void *self, dvi_march_form form, int64_t count, const int *cell,
                         double *values)
{
  return dvi__avi_sample(((const march *)self)->avi, form, count, cell, values);
}

/* E.M1 E/2 + B.M2 B/2 - source.A */
static dvi_status energy(const void *self, double *value)
{
  const march *m = self;
  DVI_TRY(dvi__avi_energy(m->avi, value, NULL));
  for (int64_t i = 0; i < m->field->unknowns && m->source != NULL; i++) {
    double A;
    DVI_TRY(dvi__avi_sample(m->avi, DVI_FORM_A, 1, m->field->unknown + i, &A));
    *value -= m->source[i] * A;
  }
  return DVI_OK;
}

static dvi_status charge_error(const void *self, double *error)
{
  *error = dvi__avi_gauss(((const march *)self)->avi);
  return DVI_OK;
}

/* Those of all fields, and the growth. */
static int observables(const void *self)
{
  return dvi__field_observables(((const march *)self)->field) + 1;
}

static const char *observable(const void *self, int i)
{
  const dvi_field *f = ((const march *)self)->field;
  return i < dvi__field_observables(f) ? dvi__field_observable(f, i) : "growth";
}

static dvi_status observe(const void *self, int i, double *value)
{
  const march *m = self;
  const dvi__observed seen = {
      .sample = sample, .energy = energy, .charge_error = charge_error, .of = self};
  double sum;
  if (i < dvi__field_observables(m->field)) return dvi__field_observe(m->field, &seen, i, value);
  return dvi__avi_energy(m->avi, &sum, value);
}

static void facts(const void *self, dvi_march_facts *facts)
{
  dvi__avi_facts(((const march *)self)->avi, facts);
}

static dvi_status save(const void *self, dvi__sections_writer *writer)
{
  dvi__avi_save(((const march *)self)->avi, writer);
  return DVI_OK;
}

static dvi_status load(void *self, const dvi__sections *sections)
{
  return dvi__avi_load(((march *)self)->avi, sections);
}

/* ---- create ---- */

static const dvi__march_kind kind = {
    .name = "avi",
    .destroy = destroy,
    .start = start,
    .advance = advance,
    .time = time,
    .size = size,
    .sample = sample,
    .observables = observables,
    .observable = observable,
    .observe = observe,
    .facts = facts,
    .save = save,
    .load = load,
};

dvi_status dvi__avi_march_create(const dvi_field *field, const dvi__march_plan *plan,
                                 dvi_march **made)
{
  march *m = DVI_NEW(march, 1);
  if (m == NULL) return dvi__fail(DVI_NO_MEMORY, "avi: no memory");
  arrays a = {.M1 = NULL};
  dvi_status status = make_arrays(field, plan, &a);
  if (status == DVI_OK) status = dvi__avi_create(&a.terms, &m->avi);
  clear_arrays(&a);
  m->field = field;
  m->signal = a.signal;
  m->source = a.source;
  if (status == DVI_OK) return dvi__march_wrap(&kind, m, made);
  destroy(m);
  return status;
}

dvi_status dvi__avi_march_stability(const dvi_field *field, const dvi__march_plan *plan,
                                    double span, dvi_stability *report)
{
  arrays a = {.M1 = NULL};
  dvi_status status = make_arrays(field, plan, &a);
  if (status == DVI_OK) status = dvi__avi_stability(&a.terms, span, report);
  clear_arrays(&a);
  dvi__release(a.signal);
  dvi__release(a.source);
  return status;
}
