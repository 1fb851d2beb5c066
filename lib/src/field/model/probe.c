/* Probes: values at a place, the power through facets (power.c), and the energy in a part. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/conjugate.h"
#include "field/forms/component.h"
#include "field/forms/evaluate.h"
#include "field/forms/star.h"
#include "field/mesh/share.h"
#include "field/model/field.h"

/* ---- functionals ---- */

void dvi__functional_clear(dvi__functional *functional)
{
  dvi__release(functional->cell);
  dvi__release(functional->weight);
  *functional = (dvi__functional){0};
}

dvi_status dvi__functional_make(const dvi_mesh *mesh, int k, int64_t cell, const double *place,
                                const double *along, dvi__functional *functional)
{
  *functional = (dvi__functional){.cell = DVI_NEW(int, DVI__LOCAL_FACES),
                                  .weight = DVI_NEW(double, DVI__LOCAL_FACES),
                                  .is_here = dvi__owns(mesh, mesh->n, cell)};
  if (functional->cell == NULL || functional->weight == NULL) {
    dvi__functional_clear(functional);
    return dvi__fail(DVI_NO_MEMORY, "field: no memory for a probe");
  }
  functional->count = dvi__form_weights(mesh, k, cell, place, along, functional->cell,
                                        functional->weight);
  return DVI_OK;
}

dvi_status dvi__functional_at(const dvi_mesh *mesh, int k, const double *at, const double *along,
                              dvi__functional *functional)
{
  double place[DVI__CORNERS];
  int64_t number;
  DVI_TRY(dvi__locate_first(mesh, at, place, &number));
  if (number < 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: the point (%g, %g, %g) lies outside of the mesh",
                     at[0], mesh->n > 1 ? at[1] : 0.0, mesh->n > 2 ? at[2] : 0.0);
  const int64_t cell = dvi__find_number(mesh, mesh->n, number);
  *functional = (dvi__functional){0};
  return cell >= 0 ? dvi__functional_make(mesh, k, cell, place, along, functional) : DVI_OK;
}

void dvi__probe_clear(dvi__probe *probe)
{
  dvi__release(probe->name);
  dvi__functional_clear(&probe->value);
  for (int i = 0; i < probe->count; i++)
    for (int k = 0; k < 2; k++) dvi__functional_clear(probe->product[i].factor + k);
  dvi__release(probe->product);
  dvi__csr_clear(&probe->electric);
  dvi__csr_clear(&probe->magnetic);
}

/* ---- parts ---- */

char *dvi__mark_cells(const dvi_mesh *mesh, const char *part)
{
  int64_t count;
  const int *cell = dvi_mesh_part_cells(mesh, part, mesh->n, &count);
  char *inside = DVI_NEW(char, mesh->count[mesh->n]);
  for (int64_t i = 0; i < count && inside != NULL; i++) inside[cell[i]] = 1;
  return inside;
}

dvi_status dvi__probe_refuse(const char *name, const char *part, const char *why)
{
  return dvi__fail(DVI_BAD_ARGUMENT, "field: the probe \"%s\" is on part \"%s\", %s", name,
                   part != NULL ? part : "", why);
}

/* ---- the energy in a part ---- */

static dvi_status make_energy(const dvi_field *field, const char *part, dvi__probe *probe)
{
  char *inside = dvi__mark_cells(field->mesh, part);
  if (inside == NULL) return dvi__fail(DVI_NO_MEMORY, "field: no memory for a probe");
  dvi_status status = dvi__part_total(field->mesh, part, field->mesh->n) > 0
                          ? DVI_OK
                          : dvi__probe_refuse(probe->name, part, "which has no cells");
  if (status == DVI_OK)
    status = dvi__star_of_part(field->star, field->degree, inside, 1, &probe->electric);
  if (status == DVI_OK)
    status = dvi__star_of_part(field->star, field->degree + 1, inside, 1, &probe->magnetic);
  dvi__release(inside);
  return status;
}

/* ---- create ---- */

static dvi_status check(const dvi_field *field, const dvi_field_probe *from)
{
  int64_t count;
  if (from->name == NULL || from->of == NULL || *from->name == '\0')
    return dvi__fail(DVI_BAD_ARGUMENT, "field: a probe has no name, or nothing to look at");
  for (int i = 0; i < field->probes; i++)
    if (field->probe[i].name != NULL && strcmp(field->probe[i].name, from->name) == 0)
      return dvi__fail(DVI_BAD_ARGUMENT, "field: two probes have the name \"%s\"", from->name);
  if (strcmp(from->of, "E") == 0 || strcmp(from->of, "B") == 0) return DVI_OK;
  if (strcmp(from->of, "flux") != 0 && strcmp(from->of, "energy") != 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "field: the probe \"%s\" is of \"%s\"; E, B, flux and energy are possible",
                     from->name, from->of);
  (void)dvi_mesh_part_cells(field->mesh, from->part != NULL ? from->part : "", 0, &count);
  return count >= 0 ? DVI_OK : dvi__probe_refuse(from->name, from->part, "which the mesh has not");
}

static dvi_status make_value(const dvi_field *field, const dvi_field_probe *from, dvi__probe *probe)
{
  double along[DVI__COMPONENTS] = {0};
  const int most = (int)(sizeof from->along / sizeof *from->along);
  for (int l = 0; l < most; l++) along[l] = from->along[l];
  probe->is_B = *from->of == 'B';
  return dvi__functional_at(field->mesh, field->degree + probe->is_B, from->at, along,
                            &probe->value);
}

/* Add a probe by its name. */
static dvi_status name_probe(dvi_field *field, const dvi_field_probe *from)
{
  DVI_TRY(check(field, from));
  dvi__probe *made = field->probe + field->probes++;
  made->name = dvi__duplicate(from->name, strlen(from->name) + 1, 1);
  if (made->name == NULL) return dvi__fail(DVI_NO_MEMORY, "field: no memory for probes");
  made->kind = *from->of == 'f'   ? DVI__PROBE_FLUX
               : *from->of == 'e' ? DVI__PROBE_ENERGY
                                  : DVI__PROBE_VALUE;
  return DVI_OK;
}

static dvi_status make_probe(dvi_field *field, const dvi_maxwell_terms *terms, int i)
{
  const dvi_field_probe *from = terms->probe + i;
  dvi__probe *made = field->probe + i;
  if (made->kind == DVI__PROBE_FLUX) return dvi__probe_make_flux(field, terms, from->part, made);
  return made->kind == DVI__PROBE_ENERGY ? make_energy(field, from->part, made)
                                         : make_value(field, from, made);
}

dvi_status dvi__maxwell_make_probes(dvi_field *field, const dvi_maxwell_terms *terms)
{
  if (terms->probes == 0) return DVI_OK;
  field->probe = DVI_NEW(dvi__probe, terms->probes);
  DVI_TRY(dvi__agree(field->mesh, field->probe != NULL
                                      ? DVI_OK
                                      : dvi__fail(DVI_NO_MEMORY, "field: no memory for probes")));
  for (int i = 0; i < terms->probes; i++) {
    DVI_TRY(dvi__agree(field->mesh, name_probe(field, terms->probe + i)));
    DVI_TRY(dvi__agree(field->mesh, make_probe(field, terms, i)));
  }
  return DVI_OK;
}

/* ---- observe ---- */

/* Where the values of forms come from, and their sum. */
typedef struct source {
  const dvi_mesh *mesh;
  dvi__field_sampler *sample;
  const void *of;
  dvi__block_sum total;
} source;

static dvi_status sum(const source *s, dvi_march_form form, const dvi__functional *functional,
                      double *value)
{
  double values[DVI__LOCAL_FACES];
  DVI_TRY(s->sample(s->of, form, functional->count, functional->cell, values));
  *value = 0;
  for (int i = 0; i < functional->count; i++) *value += functional->weight[i] * values[i];
  return DVI_OK;
}

static dvi_status add_value(source *s, const dvi__probe *probe)
{
  double value;
  if (!probe->value.is_here) return DVI_OK;
  DVI_TRY(sum(s, probe->is_B ? DVI_FORM_B : DVI_FORM_E, &probe->value, &value));
  dvi__block_sum_add(&s->total, value);
  return DVI_OK;
}

static dvi_status add_power(source *s, const dvi__probe *probe)
{
  for (int i = 0; i < probe->count; i++) {
    const dvi__product *product = probe->product + i;
    double E, other;
    if (!product->factor[0].is_here) continue;
    DVI_TRY(sum(s, DVI_FORM_E, product->factor, &E));
    DVI_TRY(sum(s, product->is_square ? DVI_FORM_E : DVI_FORM_B, product->factor + 1, &other));
    dvi__block_sum_add(&s->total, E * other);
  }
  return DVI_OK;
}

static dvi_status add_energy(source *s, dvi_march_form form, int degree, const dvi__csr *matrix)
{
  const dvi_matrix M = dvi__csr_view(matrix, 1);
  double *values = DVI_NEW(double, 2 * M.rows);
  if (values == NULL) return dvi__fail(DVI_NO_MEMORY, "field: no memory for a probe's energy");
  double *product = values + M.rows;
  const dvi_status status = s->sample(s->of, form, M.rows, NULL, values);
  if (status == DVI_OK) {
    dvi_matrix_multiply(&M, 0, values, product);
    for (int64_t i = 0; i < M.rows; i++)
      if (dvi__owns(s->mesh, degree, i))
        dvi__block_sum_add(&s->total, 0.5 * values[i] * product[i]);
  }
  dvi__release(values);
  return status;
}

static dvi_status add_energies(source *s, int degree, const dvi__probe *probe)
{
  DVI_TRY(add_energy(s, DVI_FORM_E, degree, &probe->electric));
  return add_energy(s, DVI_FORM_B, degree + 1, &probe->magnetic);
}

dvi_status dvi__field_probe(const dvi_field *field, int i, dvi__field_sampler *sample,
                            const void *of, double *value)
{
  const dvi__probe *probe = field->probe + i;
  source s = {.mesh = field->mesh, .sample = sample, .of = of};
  const dvi_status status = probe->kind == DVI__PROBE_VALUE ? add_value(&s, probe)
                            : probe->kind == DVI__PROBE_FLUX
                                ? add_power(&s, probe)
                                : add_energies(&s, field->degree, probe);
  DVI_TRY(dvi__agree(field->mesh, status));
  return dvi__sum_of_all(field->mesh, dvi__block_sum_end(&s.total), value);
}

/* ---- states of a mechanical system ---- */

/* A state, and E [unknowns] of it. */
typedef struct motion {
  const dvi_field *field;
  const double *q, *p;
  double *E; /* -M^-1 p, where M is not diagonal */
} motion;

static double potential_at(const motion *m, int64_t cell)
{
  const int number = m->field->number[cell];
  return number >= 0 ? m->q[number] : m->field->fixed[cell];
}

static double rate_at(const motion *m, int64_t cell)
{
  const int i = m->field->number[cell];
  if (i < 0) return 0;
  return m->E != NULL ? m->E[i] : -m->p[i] / m->field->mass.value[i];
}

static double derivative_at(const motion *m, int64_t face)
{
  const dvi_mesh *mesh = m->field->mesh;
  const int k = m->field->degree + 1, facets = dvi__facets(mesh->kind, k);
  double sum = 0;
  for (int64_t i = face * facets; i < (face + 1) * facets; i++)
    sum += mesh->sign[k][i] * potential_at(m, mesh->facet[k][i]);
  return sum;
}

static dvi_status sample_motion(const void *of, dvi_march_form form, int64_t count, const int *cell,
                                double *values)
{
  const motion *m = of;
  for (int64_t i = 0; i < count; i++) {
    const int64_t c = cell != NULL ? cell[i] : i;
    values[i] = form == DVI_FORM_B ? derivative_at(m, c) : rate_at(m, c);
  }
  return DVI_OK;
}

static dvi_status divide_momenta(motion *m)
{
  const dvi_field *f = m->field;
  const dvi_matrix M = dvi__csr_view(&f->mass, 1);
  const dvi__products products = dvi__products_of(&M);
  if (f->mass_is_diagonal) return DVI_OK;
  m->E = DVI_NEW(double, f->unknowns);
  if (m->E == NULL) return dvi__fail(DVI_NO_MEMORY, "field: no memory for a probe");
  DVI_TRY(dvi__conjugate_gradients(&products, 1e-16, m->p, m->E, NULL));
  for (int64_t i = 0; i < f->unknowns; i++) m->E[i] = -m->E[i];
  return DVI_OK;
}

const char *dvi_field_probe_name(const dvi_field *field, int i)
{
  return field != NULL && i >= 0 && i < field->probes ? field->probe[i].name : NULL;
}

dvi_status dvi_field_probe_at(const dvi_field *field, int i, const double *q, const double *p,
                              double *value)
{
  if (dvi_field_probe_name(field, i) == NULL || q == NULL || p == NULL || value == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: there is no probe %d, or no state or value", i);
  motion m = {.field = field, .q = q, .p = p};
  dvi_status status = divide_momenta(&m);
  if (status == DVI_OK) status = dvi__field_probe(field, i, sample_motion, &m, value);
  dvi__release(m.E);
  return status;
}
