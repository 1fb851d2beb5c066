#include "field/step/terms.h"

#include <math.h>

#include "core/status.h"

void dvi__fill_coefficients(const dvi_field *field, double dt, double *keep, double *gain,
                            double *inverse)
{
  const dvi__csr *damping = &field->damping;
  for (int64_t i = 0; i < field->unknowns; i++) {
    const int64_t at = damping->rows > 0 ? dvi__csr_find(damping, i, (int)i) : -1;
    const double M = field->mass.value[i], S = at >= 0 ? damping->value[at] : 0,
                 s = dt * S / (2 * M);
    inverse[i] = 1 / (M * (1 + s));
    gain[field->unknown[i]] = dt * inverse[i];
    if (keep != NULL) keep[field->unknown[i]] = (1 - s) / (1 + s);
  }
}

dvi_status dvi__make_left(const dvi_field *field, double dt, dvi__csr *left)
{
  const dvi_matrix M = dvi__csr_view(&field->mass, 1), S = dvi__csr_view(&field->damping, 1);
  dvi__csr half = {0};
  if (field->damping.rows == 0) return dvi__csr_copy(&M, left);
  DVI_TRY(dvi__csr_copy(&S, &half));
  for (int64_t e = 0; e < half.start[half.rows]; e++) half.value[e] *= dt / 2;
  const dvi_matrix view = dvi__csr_view(&half, 1);
  const dvi_status status = dvi__csr_sum(&M, &view, left);
  dvi__csr_clear(&half);
  return status;
}

dvi_status dvi__find_impulses(const dvi_field *field, double t, double half, double *impulse)
{
  for (int c = 0; c < field->currents; c++)
    DVI_TRY(dvi__current_impulse(field, c, t - half, t + half, impulse + c));
  return DVI_OK;
}

dvi_status dvi__find_first_currents(const dvi_field *field, double t, double half, double *J)
{
  for (int c = 0; c < field->currents; c++) {
    const double from = field->current[c].impulse != NULL ? t : t - half;
    DVI_TRY(dvi__current_impulse(field, c, from, t + half, J + c));
    J[c] /= t + half - from;
  }
  return DVI_OK;
}

/* Only finite numbers times 0 are 0. The compiler takes several at once. */
static int have_overflown(int64_t count, const double *values)
{
  enum { LANES = 8 };
  double zero[LANES] = {0}, sum = 0;
  int64_t c = 0;
  for (; c + LANES <= count; c += LANES)
    for (int i = 0; i < LANES; i++) zero[i] += 0 * values[c + i];
  for (; c < count; c++) sum += 0 * values[c];
  for (int i = 0; i < LANES; i++) sum += zero[i];
  return sum != 0;
}

dvi_status dvi__check_finite(const dvi_field *field, const char *form, const double *values,
                             double t)
{
  int64_t c = 0;
  if (!have_overflown(field->cells, values)) return DVI_OK;
  while (isfinite(values[c])) c++;
  return dvi__fail(DVI_NOT_FINITE,
                   "march: %s has overflowed to %g at %s by t = %g: start from smaller values",
                   form, values[c], dvi__name_cell(field->mesh, field->degree, c).text, t);
}
