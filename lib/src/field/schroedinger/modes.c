/* Stationary states of the equation without interaction. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/largest.h"
#include "field/algebra/vectors.h"
#include "field/schroedinger/schroedinger.h"
#include "num/eigen.h"
#include "num/finite.h"

enum { FULL_MOST = 400 };

/* ---- by matrices ---- */

static double least_of(const dvi_schroedinger *s)
{
  double least = INFINITY;
  for (int64_t k = 0; k < s->points; k++) least = fmin(least, s->still[k]);
  return least;
}

/* With V - min V the matrix is positive semidefinite, as Lanczos' method on its inverse wants. */
static dvi_status find_sparse(const dvi_schroedinger *s, int count, double *energy, double *z)
{
  const int64_t entries = s->T.start[s->free];
  double *H = DVI_NEW(double, entries + s->points);
  if (H == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld entries", (long long)entries);
  double *V = H + entries;
  const double least = least_of(s);
  for (int64_t k = 0; k < s->points; k++) V[k] = s->still[k] - least;
  dvi__schroedinger_assemble(s, V, H);
  dvi_matrix K = dvi__csr_view(&s->T, 1), M = K;
  K.value = H;
  M.value = s->M;
  const dvi_modes_options options = {
      .size = sizeof options, .count = count, .dimension = s->dimension};
  const dvi_status status = dvi_matrix_modes(&K, &M, &options, energy, z);
  for (int i = 0; i < count && status == DVI_OK; i++) energy[i] += least;
  dvi__release(H);
  return status;
}

/* Column i of a full H is H of function i. */
static void fill(const dvi_schroedinger *s, const dvi__schroedinger_room *room, double *one,
                 double *H)
{
  const int64_t n = s->free;
  for (int64_t i = 0; i < n; i++) {
    memset(one, 0, (size_t)n * sizeof *one);
    one[i] = 1;
    dvi__schroedinger_act(s, s->still, 0, 1, one, H + i * n, room);
  }
}

static dvi_status find_full(const dvi_schroedinger *s, int count, double *energy, double *z)
{
  const int64_t n = s->free, square = n * n;
  dvi__schroedinger_room room;
  DVI_TRY(dvi__schroedinger_make_room(s, &room));
  double *H = DVI_NEW(double, 3 * square + 2 * n);
  dvi_status status = DVI_NO_MEMORY;
  if (H != NULL) {
    double *unit = H + square, *X = unit + square, *value = X + square, *one = value + n;
    fill(s, &room, one, H);
    for (int64_t i = 0; i < n; i++) unit[i * (n + 1)] = 1;
    status = dvi__eigen_symmetric((int)n, H, unit, value, X);
    memcpy(energy, value, (size_t)count * sizeof *value);
    memcpy(z, X, (size_t)(count * n) * sizeof *z);
  } else {
    (void)dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for a full matrix of %lld functions",
                    (long long)n);
  }
  dvi__release(H);
  dvi__schroedinger_clear_room(&room);
  return status;
}

/* ---- polish ---- */

/* The diagonal entries of M and T. */
static double mass_of(const dvi_schroedinger *s, int64_t i)
{
  return s->is_fourier ? 1 : s->M[dvi__csr_find(&s->T, i, (int)i)];
}

static double kinetic_of(const dvi_schroedinger *s, int64_t i)
{
  return s->is_fourier ? s->diagonal[i] : s->T.value[dvi__csr_find(&s->T, i, (int)i)];
}

/* Tell if a residual r, beside M x of size 1, is that of a state of this energy. Roundings are of
 * the size of the largest kinetic energy. */
static int is_small(const dvi_schroedinger *s, const double *r, double energy)
{
  const double scale = fmax(fabs(energy), energy - least_of(s));
  double sum = 0, largest = 0;
  for (int64_t i = 0; i < s->free; i++) {
    sum += r[i] * r[i] / mass_of(s, i);
    largest = fmax(largest, kinetic_of(s, i) / mass_of(s, i));
  }
  return sqrt(sum) <= 1e-4 * scale + 1e-10 * largest;
}

/* Replace an eigenvalue, which has the roundings of the largest ones, by Rayleigh's quotient. This
 * has only those of the state's own energies, and the square of the vector's error. */
static dvi_status polish(const dvi_schroedinger *s, const dvi__schroedinger_room *room, double *x,
                         double *Mx, double *Hx, double *energy)
{
  const int64_t n = s->free;
  dvi__choose_sign(n, x);
  dvi__schroedinger_mass(s, x, Mx);
  const double by = 1 / sqrt(dvi__dot(n, x, Mx));
  for (int64_t k = 0; k < n; k++) {
    x[k] *= by;
    Mx[k] *= by;
  }
  dvi__schroedinger_act(s, s->still, 0, 1, x, Hx, room);
  *energy = dvi__dot(n, x, Hx);
  for (int64_t k = 0; k < n; k++) Hx[k] -= *energy * Mx[k];
  if (is_small(s, Hx, *energy)) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED,
                   "schroedinger: the stationary state of energy %g is not resolved, because the "
                   "potential goes too far beyond it for the digits of numbers",
                   *energy);
}

static dvi_status polish_all(const dvi_schroedinger *s, int count, double *energy, double *z)
{
  dvi__schroedinger_room room;
  DVI_TRY(dvi__schroedinger_make_room(s, &room));
  double *y = DVI_NEW(double, 2 * s->free);
  dvi_status status = y != NULL ? DVI_OK
                                : dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for residuals");
  for (int i = 0; i < count && status == DVI_OK; i++)
    status = polish(s, &room, z + i * s->free, y, y + s->free, energy + i);
  dvi__schroedinger_clear_room(&room);
  dvi__release(y);
  return status;
}

dvi_status dvi__schroedinger_lowest(const dvi_schroedinger *s, int count, double *energy, double *z)
{
  dvi_status status;
  if (!s->is_fourier)
    status = find_sparse(s, count, energy, z);
  else if (s->free <= FULL_MOST)
    status = find_full(s, count, energy, z);
  else
    status = dvi__schroedinger_iterate_modes(s, count, energy, z);
  if (status == DVI_OK) status = polish_all(s, count, energy, z);
  /* Energies may have changed places by roundings. */
  if (status == DVI_OK) dvi__sort_modes(s->free, count, energy, z);
  return status;
}

/* ---- the other end ---- */

dvi_status dvi__schroedinger_largest_kinetic(const dvi_schroedinger *s, double *kinetic)
{
  if (s->is_fourier) {
    *kinetic = dvi__largest((size_t)s->free, s->diagonal);
    return DVI_OK;
  }
  double *mass = DVI_NEW(double, s->free);
  if (mass == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld functions",
                     (long long)s->free);
  for (int64_t i = 0; i < s->free; i++) mass[i] = mass_of(s, i);
  const dvi_matrix K = dvi__csr_view(&s->T, 1), M = {.rows = s->free,
                                                     .columns = s->free,
                                                     .width = 1,
                                                     .symmetric = 1,
                                                     .value = mass};
  const dvi__pencil pencil = {.K = &K, .M = &M, .dimension = s->dimension};
  const dvi_status status = dvi__largest_eigenvalue(&pencil, NULL, kinetic);
  dvi__release(mass);
  return status;
}

/* ---- for users ---- */

dvi_status dvi_schroedinger_modes(const dvi_schroedinger *equation, int count, double *energy,
                                  double *psi)
{
  const dvi_schroedinger *s = equation;
  if (s == NULL || energy == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "schroedinger: an equation and a place for the energies are needed");
  const int64_t most = s->free > 1 ? s->free / 2 : 1;
  if (count < 1 || count > most)
    return dvi__fail(DVI_BAD_SIZE,
                     "schroedinger: %d stationary states of %lld free functions; 1 to %lld can be "
                     "found, the more accurate the fewer",
                     count, (long long)s->free, (long long)most);
  double *z = DVI_NEW(double, count *(s->free + 1));
  if (z == NULL) return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %d states", count);
  double *found = z + count * s->free;
  const dvi_status status = dvi__schroedinger_lowest(s, count, found, z);
  if (status == DVI_OK) memcpy(energy, found, (size_t)count * sizeof *energy);
  for (int i = 0; i < count && psi != NULL && status == DVI_OK; i++)
    dvi__schroedinger_extend(s, z + i * s->free, psi + i * s->functions);
  dvi__release(z);
  return status;
}
