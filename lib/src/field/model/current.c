/* Currents that are given. A density j has the profile W R(j), with de Rham's integrals R and the
 * star W = M_k without a material. A dipole's profile are the weights by which Whitney's
 * interpolation gives the field at its place, so that its work is J.E and its moment does not
 * depend on the mesh. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/star.h"
#include "field/mesh/share.h"
#include "field/model/field.h"

static dvi_status spread_density(const dvi_field *field, const dvi_current *current,
                                 const dvi_matrix *W, double *profile)
{
  double *form = DVI_NEW(double, 2 * field->cells);
  if (form == NULL) return dvi__fail(DVI_NO_MEMORY, "maxwell: no memory for a current");
  double *product = form + field->cells;
  const dvi_status status = dvi_form_integrate(field->mesh, field->degree, current->density,
                                               current->density_user, form);
  if (status == DVI_OK) {
    dvi_matrix_multiply(W, 0, form, product);
    for (int64_t i = 0; i < field->unknowns; i++) profile[i] = product[field->unknown[i]];
  }
  dvi__release(form);
  return status;
}

static dvi_status place_dipole(const dvi_field *field, const dvi_current *current, double *profile)
{
  dvi__functional weights;
  for (int l = 0; l < DVI_MESH_DIMENSION_MAX; l++)
    if (!isfinite(current->at[l]) || !isfinite(current->along[l]))
      return dvi__fail(DVI_BAD_ARGUMENT, "maxwell: a dipole's place or direction is not finite");
  DVI_TRY(dvi__functional_at(field->mesh, field->degree, current->at, current->along, &weights));
  for (int i = 0; i < weights.count; i++) {
    const int number = field->number[weights.cell[i]];
    if (number >= 0) profile[number] += weights.weight[i];
  }
  dvi__functional_clear(&weights);
  return DVI_OK;
}

/* Keep the entries that are not zero. */
static dvi_status keep_entries(int64_t unknowns, const double *profile, dvi__current *current)
{
  for (int64_t i = 0; i < unknowns; i++) current->count += profile[i] != 0;
  current->unknown = DVI_NEW(int, current->count);
  current->weight = DVI_NEW(double, current->count);
  if (current->unknown == NULL || current->weight == NULL)
    return dvi__fail(DVI_NO_MEMORY, "maxwell: no memory for a current");
  int64_t kept = 0;
  for (int64_t i = 0; i < unknowns; i++) {
    if (profile[i] == 0) continue;
    current->unknown[kept] = (int)i;
    current->weight[kept++] = profile[i];
  }
  return DVI_OK;
}

static dvi_status make_current(const dvi_field *field, const dvi_current *from, const dvi_matrix *W,
                               dvi__current *current)
{
  if (from->signal == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "maxwell: a current has no signal");
  *current = (dvi__current){.signal = from->signal, .impulse = from->impulse, .user = from->user};
  double *profile = DVI_NEW(double, field->unknowns);
  dvi_status status = profile != NULL
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "maxwell: no memory for a current");
  status = dvi__agree(field->mesh, status);
  if (status == DVI_OK)
    status = from->density != NULL ? spread_density(field, from, W, profile)
                                   : place_dipole(field, from, profile);
  if (status == DVI_OK) status = keep_entries(field->unknowns, profile, current);
  dvi__release(profile);
  return dvi__agree(field->mesh, status);
}

static int has_density(const dvi_maxwell_terms *terms)
{
  for (int i = 0; i < terms->currents; i++)
    if (terms->current[i].density != NULL) return 1;
  return 0;
}

/* Make room, and the star without a material if it is needed. */
static dvi_status prepare_currents(dvi_field *field, const dvi_maxwell_terms *terms, dvi__csr *bare)
{
  field->current = DVI_NEW(dvi__current, terms->currents);
  if (field->current == NULL) return dvi__fail(DVI_NO_MEMORY, "maxwell: no memory for currents");
  return has_density(terms) ? dvi__star_with_factor(field->star, field->degree, NULL, bare)
                            : DVI_OK;
}

dvi_status dvi__maxwell_make_currents(dvi_field *field, const dvi_maxwell_terms *terms)
{
  dvi__csr bare = {0};
  if (terms->currents == 0) return DVI_OK;
  dvi_status status = dvi__agree(field->mesh, prepare_currents(field, terms, &bare));
  const dvi_matrix W = dvi__csr_view(&bare, 1);
  while (status == DVI_OK && field->currents < terms->currents) {
    const int i = field->currents++;
    status = make_current(field, terms->current + i, &W, field->current + i);
  }
  dvi__csr_clear(&bare);
  return status;
}

int64_t dvi__current_entry(const dvi__current *current, int64_t i)
{
  int64_t first = 0, last = current->count;
  while (first < last) {
    const int64_t middle = first + (last - first) / 2;
    if (current->unknown[middle] < i)
      first = middle + 1;
    else
      last = middle;
  }
  return first;
}

void dvi__add_currents(const dvi_field *field, double scale, const double *factor, double *b)
{
  for (int c = 0; c < field->currents; c++) {
    const dvi__current *current = field->current + c;
    for (int64_t k = 0; k < current->count; k++)
      b[current->unknown[k]] += scale * factor[c] * current->weight[k];
  }
}

dvi_status dvi__current_impulse(const dvi_field *field, int current, double from, double to,
                                double *impulse)
{
  const dvi__current *c = field->current + current;
  const double middle = from + (to - from) / 2;
  const int failed = c->impulse != NULL ? c->impulse(from, to, impulse, c->user)
                                        : c->signal(middle, impulse, c->user);
  if (failed != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "maxwell: the signal of current %d returned %d at t = %g",
                     current, failed, middle);
  if (c->impulse == NULL) *impulse *= to - from;
  if (isfinite(*impulse)) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "maxwell: the signal of current %d is %g at t = %g", current,
                   *impulse, middle);
}
