/* Products with the parts of H. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/schroedinger/schroedinger.h"
#include "field/space/kind.h"

dvi_status dvi__schroedinger_make_room(const dvi_schroedinger *s, dvi__schroedinger_room *room)
{
  room->u = DVI_NEW(double, 2 * s->points);
  room->work = DVI_NEW(double, dvi__operator_work(s->space));
  if (room->u != NULL && room->work != NULL) return DVI_OK;
  dvi__schroedinger_clear_room(room);
  return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for values at %lld points",
                   (long long)s->points);
}

void dvi__schroedinger_clear_room(dvi__schroedinger_room *room)
{
  dvi__release(room->u);
  dvi__release(room->work);
  *room = (dvi__schroedinger_room){0};
}

/* ---- potential ---- */

/* Sums and products of larger energies could overflow. */
static const double largest_energy = 1e100;

/* Find a value that is not finite, or too large. */
static ptrdiff_t find_bad(int64_t count, const double *values)
{
  ptrdiff_t k = 0;
  while (k < count && fabs(values[k]) <= largest_energy) k++;
  return k < count ? k : -1;
}

static dvi_status refuse_value(const dvi_schroedinger *s, const char *name, ptrdiff_t k,
                               double value)
{
  char place[96] = "";
  dvi__note note = {place, sizeof place, 0};
  for (int d = 0; d < s->dimension; d++)
    dvi__note_add(&note, "%s%g", d > 0 ? ", " : "", s->x[d * s->points + k]);
  return dvi__fail(DVI_NOT_FINITE,
                   "schroedinger: the %s is %g at (%s); a finite number is needed at each "
                   "quadrature point, up to 1e100, with walls as fixed ends of the domain",
                   name, value, place);
}

dvi_status dvi__schroedinger_check(const dvi_schroedinger *s, const char *name,
                                   const double *values)
{
  const ptrdiff_t bad = find_bad(s->points, values);
  return bad < 0 ? DVI_OK : refuse_value(s, name, bad, values[bad]);
}

dvi_status dvi__schroedinger_potential(const dvi_schroedinger *s, double t, double *V)
{
  if (s->potential == NULL || !s->depends_on_time) {
    if (s->still != V) memcpy(V, s->still, (size_t)s->points * sizeof *V);
    return DVI_OK;
  }
  const int failure = s->potential(s->points, t, s->x, V, s->user);
  if (failure != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "schroedinger: the potential failed with %d at t = %g",
                     failure, t);
  const dvi_status status = dvi__schroedinger_check(s, "potential", V);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "t = %g", t);
}

/* Add a row of w V B^T B of one point to row i of values. Columns that follow each other do so in
 * the pattern, too, so that few are searched for. */
static void add_row(const dvi_schroedinger *s, int64_t k, int i, double factor, double *values)
{
  const dvi__csr *B = &s->B, *T = &s->T;
  int64_t at = -1;
  for (int64_t b = B->start[k]; b < B->start[k + 1]; b++) {
    at++;
    if (at == 0 || at >= T->start[i + 1] || T->column[at] != B->column[b])
      at = dvi__csr_find(T, i, B->column[b]);
    values[at] += factor * B->value[b];
  }
}

void dvi__schroedinger_add_square(const dvi_schroedinger *s, const double *V, double *values)
{
  const dvi__csr *B = &s->B;
  for (int64_t k = 0; k < s->points; k++) {
    const double w = s->weight[k] * (V != NULL ? V[k] : 1);
    for (int64_t a = B->start[k]; a < B->start[k + 1]; a++)
      add_row(s, k, B->column[a], w * B->value[a], values);
  }
}

void dvi__schroedinger_assemble(const dvi_schroedinger *s, const double *V, double *values)
{
  memcpy(values, s->T.value, (size_t)s->T.start[s->free] * sizeof *values);
  if (V != NULL) dvi__schroedinger_add_square(s, V, values);
}

/* ---- products ---- */

void dvi__schroedinger_to_points(const dvi_schroedinger *s, const double *x, double *u,
                                 double *work)
{
  const dvi_matrix B = dvi__csr_view(&s->B, 0);
  if (s->is_fourier)
    dvi__operator_apply(&s->values, x, u, work);
  else
    dvi_matrix_multiply(&B, 0, x, u);
}

void dvi__schroedinger_add_points(const dvi_schroedinger *s, const double *p, double *y,
                                  double *work)
{
  const dvi__csr *B = &s->B;
  if (s->is_fourier) {
    dvi__operator_add_transposed(&s->values, p, y, work);
    return;
  }
  for (int64_t k = 0; k < s->points; k++)
    for (int64_t e = B->start[k]; e < B->start[k + 1]; e++) y[B->column[e]] += B->value[e] * p[k];
}

void dvi__schroedinger_mass(const dvi_schroedinger *s, const double *x, double *y)
{
  dvi_matrix M = dvi__csr_view(&s->T, 1);
  M.value = s->M;
  if (s->is_fourier)
    memcpy(y, x, (size_t)s->free * sizeof *y);
  else
    dvi_matrix_multiply(&M, 0, x, y);
}

void dvi__schroedinger_kinetic(const dvi_schroedinger *s, const double *x, double *y)
{
  const dvi_matrix T = dvi__csr_view(&s->T, 1);
  if (!s->is_fourier) dvi_matrix_multiply(&T, 0, x, y);
  for (int64_t i = 0; i < s->free && s->is_fourier; i++) y[i] = s->diagonal[i] * x[i];
}

void dvi__schroedinger_act(const dvi_schroedinger *s, const double *V, double strength, int parts,
                           const double *z, double *y, const dvi__schroedinger_room *room)
{
  const double *beta = strength != 0 ? s->beta : NULL;
  double *u = room->u, *v = room->u + (parts - 1) * s->points;
  for (int c = 0; c < parts; c++) {
    dvi__schroedinger_kinetic(s, z + c * s->free, y + c * s->free);
    dvi__schroedinger_to_points(s, z + c * s->free, u + c * s->points, room->work);
  }
  for (int64_t k = 0; k < s->points; k++) {
    const double density = u[k] * u[k] + (parts > 1 ? v[k] * v[k] : 0);
    const double by = s->weight[k] * (V[k] + (beta != NULL ? strength * beta[k] * density : 0));
    u[k] *= by;
    if (parts > 1) v[k] *= by;
  }
  for (int c = 0; c < parts; c++)
    dvi__schroedinger_add_points(s, u + c * s->points, y + c * s->free, room->work);
}

void dvi__schroedinger_act_beside(const dvi_schroedinger *s, const double *V, const double *psi,
                                  const double *z, double *y, const dvi__schroedinger_room *room)
{
  double *u = room->u, *v = room->u + s->points;
  for (int c = 0; c < 2; c++) {
    dvi__schroedinger_kinetic(s, z + c * s->free, y + c * s->free);
    dvi__schroedinger_to_points(s, z + c * s->free, u + c * s->points, room->work);
  }
  for (int64_t k = 0; k < s->points; k++) {
    const double beta = s->beta != NULL ? s->beta[k] : 0, a = beta != 0 ? psi[k] : 0,
                 b = beta != 0 ? psi[s->points + k] : 0, w = s->weight[k],
                 diagonal = V[k] + beta * (a * a + b * b), along = 2 * beta * (a * u[k] + b * v[k]);
    u[k] = w * (diagonal * u[k] + along * a);
    v[k] = w * (diagonal * v[k] + along * b);
  }
  for (int c = 0; c < 2; c++)
    dvi__schroedinger_add_points(s, u + c * s->points, y + c * s->free, room->work);
}

/* ---- free functions ---- */

void dvi__schroedinger_restrict(const dvi_schroedinger *s, const double *psi, double *z)
{
  for (int64_t i = 0; i < s->free; i++) z[i] = psi[s->place[i]];
}

void dvi__schroedinger_extend(const dvi_schroedinger *s, const double *z, double *psi)
{
  memset(psi, 0, (size_t)s->functions * sizeof *psi);
  for (int64_t i = 0; i < s->free; i++) psi[s->place[i]] = z[i];
}
