#include "field/step/observables.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"

/* ---- charge ---- */

void dvi__charge_clear(dvi__charge *charge)
{
  dvi__release(charge->is_free);
  dvi__release(charge->work);
  *charge = (dvi__charge){.field = NULL};
}

static void find_free(dvi__charge *charge)
{
  const dvi_matrix *d = &charge->d;
  for (int64_t v = 0; v < d->columns; v++) charge->is_free[v] = 1;
  for (int64_t e = 0; e < d->rows; e++)
    for (int64_t i = dvi__first_entry(d, e);
         i < dvi__first_entry(d, e + 1) && charge->field->number[e] < 0; i++)
      charge->is_free[d->column[i]] = 0;
}

static int64_t count_below(const dvi_field *field)
{
  return field->degree > 0 ? field->mesh->count[field->degree - 1] : 0;
}

int64_t dvi__charge_numbers(const dvi_field *field)
{
  return field->currents + count_below(field);
}

dvi_status dvi__charge_create(const dvi_field *field, double *numbers, dvi__charge *charge)
{
  const int64_t below = count_below(field);
  *charge = (dvi__charge){.field = field, .delivered = numbers, .start = numbers + field->currents};
  if (below == 0) return DVI_OK;
  DVI_TRY(dvi_mesh_incidence(field->mesh, field->degree - 1, &charge->d));
  charge->is_free = DVI_NEW(char, below);
  charge->work = DVI_NEW(double, field->cells + field->unknowns + 2 * below);
  if (!charge->is_free || !charge->work) {
    dvi__charge_clear(charge);
    return dvi__fail(DVI_NO_MEMORY, "march: no memory for the charge of %lld cells",
                     (long long)below);
  }
  find_free(charge);
  return DVI_OK;
}

/* Set form [k-cells] to M E, plus what currents and damping have moved. */
static void displacement(const dvi__charge *charge, const double *E, const double *integral,
                         double *form)
{
  const dvi_field *f = charge->field;
  double *sum = form + f->cells;
  for (int64_t i = 0; i < f->unknowns; i++) {
    sum[i] = dvi__field_row(f, &f->mass, i, E);
    if (integral != NULL) sum[i] += dvi__field_row(f, &f->damping, i, integral);
  }
  dvi__add_currents(f, 1, charge->delivered, sum);
  for (int64_t c = 0; c < f->cells; c++) form[c] = f->number[c] >= 0 ? sum[f->number[c]] : 0;
}

void dvi__charge_start(dvi__charge *charge, const double *E, const double *integral)
{
  const dvi_field *f = charge->field;
  for (int c = 0; c < f->currents; c++) charge->delivered[c] = 0;
  if (f->degree == 0) return;
  displacement(charge, E, integral, charge->work);
  dvi_matrix_multiply(&charge->d, 1, charge->work, charge->start);
}

dvi_status dvi__charge_error(const dvi__charge *charge, const double *E, const double *integral,
                             double *error)
{
  const dvi_field *f = charge->field;
  const dvi_matrix *d = &charge->d;
  double *form = charge->work, *sum = form + d->rows + f->unknowns, *size = sum + d->columns,
         largest[2] = {0, 0}; /* error and size */
  displacement(charge, E, integral, form);
  for (int64_t v = 0; v < d->columns; v++) {
    sum[v] = -charge->start[v];
    size[v] = fabs(charge->start[v]);
  }
  for (int64_t e = 0; e < d->rows; e++)
    for (int64_t i = dvi__first_entry(d, e); i < dvi__first_entry(d, e + 1); i++) {
      sum[d->column[i]] += d->sign[i] * form[e];
      size[d->column[i]] += fabs(form[e]);
    }
  for (int64_t v = 0; v < d->columns; v++) {
    if (!charge->is_free[v] || !dvi__owns(f->mesh, f->degree - 1, v)) continue;
    largest[0] = fmax(largest[0], fabs(sum[v]));
    largest[1] = fmax(largest[1], size[v]);
  }
  DVI_TRY(dvi__largest_of_all(f->mesh, 2, largest));
  *error = largest[1] > 0 ? largest[0] / largest[1] : 0;
  return DVI_OK;
}

/* ---- all ---- */

static int has_charge(const dvi_field *field)
{
  return field->degree > 0;
}

int dvi__field_observables(const dvi_field *field)
{
  return 1 + has_charge(field) + field->probes;
}

const char *dvi__field_observable(const dvi_field *field, int i)
{
  if (i == 0) return "energy";
  if (i == 1 && has_charge(field)) return "gauss";
  return field->probe[i - 1 - has_charge(field)].name;
}

dvi_status dvi__field_observe(const dvi_field *field, const dvi__observed *march, int i,
                              double *value)
{
  if (i == 0) return march->energy(march->of, value);
  if (i == 1 && has_charge(field)) return march->charge_error(march->of, value);
  return dvi__field_probe(field, i - 1 - has_charge(field), march->sample, march->of, value);
}
