/* Harmonic forms are left of random forms when their exact and coexact parts are taken away. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/random.h"
#include "field/forms/hodge.h"

/* Least part of a random form that is harmonic, if there is another harmonic form. */
static const double least_part = 1e-9;

/* Subtract the parts along the orthonormal forms of the basis, and return the length left. */
static double orthogonalise(dvi__hodge *h, const double *basis, int64_t size, double *form)
{
  for (int64_t b = 0; b < size; b++) {
    const double along = dvi__hodge_product(h, basis + b * h->count, form);
    for (int64_t i = 0; i < h->count; i++) form[i] -= along * basis[b * h->count + i];
  }
  return sqrt(dvi__hodge_product(h, form, form));
}

/* Find one more harmonic form, or none, `found` = 0. `part` is [3][count]. */
static dvi_status find_next(dvi__hodge *h, const double *basis, int64_t size, double *part,
                            uint64_t *state, double *next, int *found)
{
  const double *harmonic = part + 2 * h->count;
  *state = dvi__fill_random(h->count, *state, next);
  dvi__hodge_hold(h, h->k, next);
  const double whole = sqrt(dvi__hodge_product(h, next, next));
  *found = 1;
  for (int pass = 0; pass < 3 && *found; pass++) {
    DVI_TRY(dvi__hodge_split(h, next, part));
    memcpy(next, harmonic, (size_t)h->count * sizeof *next);
    const double length = orthogonalise(h, basis, size, next);
    *found = length > (pass == 0 ? least_part * whole : 0.5);
    for (int64_t i = 0; i < h->count && *found; i++) next[i] /= length;
  }
  return DVI_OK;
}

static dvi_status find_basis(dvi__hodge *h, int64_t *count, double **basis)
{
  uint64_t state = 1;
  int found = 1;
  double *part = DVI_NEW(double, 3 * h->count);
  dvi_status status = part != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "forms: no memory");
  *count = -1;
  while (status == DVI_OK && found) {
    ++*count;
    double *more = DVI_NEW(double, (*count + 1) * h->count);
    if (more == NULL) {
      status = dvi__fail(DVI_NO_MEMORY, "forms: no memory for %lld harmonic forms",
                         (long long)*count + 1);
      break;
    }
    if (*count > 0) memcpy(more, *basis, (size_t)(*count * h->count) * sizeof *more);
    dvi__release(*basis);
    *basis = more;
    status = find_next(h, more, *count, part, &state, more + *count * h->count, &found);
  }
  dvi__release(part);
  return status;
}

dvi_status dvi_form_harmonic(const dvi_star *star, int k, const char *held, int64_t *count,
                             double *basis)
{
  dvi__hodge h;
  double *found = NULL;
  if (count == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "forms: a place for the count is needed");
  DVI_TRY(dvi__hodge_begin(star, k, held, &h));
  const dvi_status status = find_basis(&h, count, &found);
  if (status == DVI_OK && basis != NULL)
    memcpy(basis, found, (size_t)(*count * h.count) * sizeof *basis);
  dvi__release(found);
  dvi__hodge_end(&h);
  return status;
}
