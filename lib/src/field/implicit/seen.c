#include "field/implicit/state.h"

#include "core/status.h"
#include "field/mesh/share.h"

/* Give E. Of others' cells the mass may lack a part here. */
static double E_at(const dvi__implicit_march *m, int64_t cell)
{
  const int i = m->field->number[cell];
  return i < 0 ? 0 : -m->shown.p[cell] / m->field->mass.value[i];
}

static const double *find_E(const dvi__implicit_march *m)
{
  for (int64_t c = 0; c < m->field->cells; c++) m->E[c] = E_at(m, c);
  return m->E;
}

/* Give the integral of E, up to a constant, or NULL without losses that move charge. */
static const double *integral_of_E(const dvi__implicit_march *m)
{
  if (!m->field->is_damped) return NULL;
  for (int64_t c = 0; c < m->field->cells; c++) m->spare[c] = -m->shown.q[c];
  return m->spare;
}

void dvi__implicit_begin_charge(dvi__implicit_march *m)
{
  dvi__charge_start(&m->charge, find_E(m), integral_of_E(m));
}

static double B_at(const dvi__implicit_march *m, int64_t cell)
{
  return m->field->is_wave ? dvi__sweep_d(&m->sweep, cell, m->shown.q) : m->shown.B[cell];
}

static dvi_status sample(const void *self, dvi_march_form form, int64_t count, const int *cell,
                         double *values)
{
  const dvi__implicit_march *m = self;
  for (int64_t i = 0; i < count; i++) {
    const int64_t c = cell != NULL ? cell[i] : i;
    values[i] = form == DVI_FORM_A ? m->shown.q[c] : form == DVI_FORM_E ? E_at(m, c) : B_at(m, c);
  }
  return DVI_OK;
}

/* Take E of others' cells from them. */
dvi_status dvi__implicit_sample(const void *self, dvi_march_form form, int64_t count,
                                const int *cell, double *values)
{
  const dvi__implicit_march *m = self;
  const dvi_field *f = m->field;
  if (form == DVI_FORM_E && cell != NULL)
    DVI_TRY(dvi__check_owned(f->mesh, f->degree, count, cell));
  DVI_TRY(sample(self, form, count, cell, values));
  if (form != DVI_FORM_E || cell != NULL) return DVI_OK;
  return dvi__refresh(f->mesh, f->degree, values);
}

/* Add w V of own unknowns. */
static dvi_status add_density(const dvi__implicit_march *m, dvi__block_sum *sum)
{
  const dvi_field *f = m->field;
  if (f->potential.density == NULL) return DVI_OK;
  for (int64_t i = 0; i < f->unknowns; i++) m->spare[i] = m->shown.q[f->unknown[i]];
  for (int64_t i = 0; i < f->unknowns; i++) {
    double value;
    if (!dvi__owns(f->mesh, f->degree, f->unknown[i])) continue;
    const int failed = dvi__field_density(f, m->spare, i, i + 1, &(dvi__density){.sum = &value});
    if (failed != 0) return dvi__implicit_refuse(failed);
    dvi__block_sum_add(sum, value);
  }
  return DVI_OK;
}

/* Add q.(K q/2 - load) of own unknowns of a wave. */
static dvi_status add_elastic(const dvi__implicit_march *m, dvi__block_sum *sum)
{
  const dvi_field *f = m->field;
  for (int64_t i = 0; i < f->unknowns; i++) {
    const int c = f->unknown[i];
    if (!dvi__owns(f->mesh, f->degree, c)) continue;
    const double half = 0.5 * dvi__field_row(f, &f->stiffness, i, m->shown.q);
    dvi__block_sum_add(sum, m->shown.q[c] * (half - f->load[i]));
  }
  return add_density(m, sum);
}

/* Add B.M_{k+1} B/2 of own faces. */
static dvi_status add_magnetic(const dvi__implicit_march *m, dvi__block_sum *sum)
{
  const dvi_field *f = m->field;
  dvi_matrix M;
  DVI_TRY(dvi_star_matrix(f->star, f->degree + 1, &M));
  for (int64_t b = 0; b < m->faces; b++)
    if (dvi__owns(f->mesh, f->degree + 1, b))
      dvi__block_sum_add(sum, 0.5 * M.value[b] * m->shown.B[b] * m->shown.B[b]);
  return DVI_OK;
}

/* p.M^-1 p/2 + B.M_{k+1} B/2, or of waves q.(K q/2 - load) + the sum of w V, and the energy of the
 * fixed values. */
static dvi_status energy(const void *self, double *value)
{
  const dvi__implicit_march *m = self;
  const dvi_field *f = m->field;
  const double *p = m->shown.p;
  dvi__block_sum sum = {.count = 0};
  for (int64_t i = 0; i < f->unknowns; i++)
    if (dvi__owns(f->mesh, f->degree, f->unknown[i]))
      dvi__block_sum_add(&sum, 0.5 * p[f->unknown[i]] * (p[f->unknown[i]] / f->mass.value[i]));
  DVI_TRY(dvi__agree(f->mesh, f->is_wave ? add_elastic(m, &sum) : add_magnetic(m, &sum)));
  DVI_TRY(dvi__sum_of_all(f->mesh, dvi__block_sum_end(&sum), value));
  *value += f->rest;
  return DVI_OK;
}

static dvi_status charge_error(const void *self, double *error)
{
  const dvi__implicit_march *m = self;
  return dvi__charge_error(&m->charge, find_E(m), integral_of_E(m), error);
}

int dvi__implicit_observables(const void *self)
{
  return dvi__field_observables(((const dvi__implicit_march *)self)->field);
}

const char *dvi__implicit_observable(const void *self, int i)
{
  return dvi__field_observable(((const dvi__implicit_march *)self)->field, i);
}

dvi_status dvi__implicit_observe(const void *self, int i, double *value)
{
  const dvi__observed march = {
      .sample = sample, .energy = energy, .charge_error = charge_error, .of = self};
  return dvi__field_observe(((const dvi__implicit_march *)self)->field, &march, i, value);
}
