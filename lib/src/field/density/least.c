/* The least eigenvalue of the quadratic part, which tells whether the energy is bounded from below.
 *
 * K is a sum over points, and positive semidefinite if the density is at each of them. Only where
 * this does not hold K + s M is factored, for growing s until it is positive definite. Then -s is
 * below all eigenvalues, and not far from the least one, which Lanczos' method finds. A negative
 * mass has the eigenvalues of -K and -M. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/definite.h"
#include "field/density/density.h"

enum {
  TRIES = 24,
  PAIRS_MOST = DVI_JETS_MAX * (DVI_JETS_MAX + 1) / 2 /* of variables */
};

/* Shifts begin at roundoff and grow by this factor. */
static const double smallest_shift = 1e-11, growth = 16;

/* ---- points ---- */

/* Tell if a symmetric matrix has no negative eigenvalue, by elimination. */
static int is_semidefinite(int n, double (*A)[DVI_JETS_MAX])
{
  double least = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) least = fmax(least, 1e-12 * fabs(A[i][j]));
  for (int k = 0; k < n; k++) {
    if (A[k][k] < -least) return 0;
    for (int i = k + 1; i < n; i++) {
      if (A[k][k] <= least && fabs(A[i][k]) > least) return 0;
      const double factor = A[k][k] > least ? A[i][k] / A[k][k] : 0;
      for (int j = k + 1; j < n; j++) A[i][j] -= factor * A[k][j];
    }
  }
  return 1;
}

/* Second derivatives of a quadratic part are those at 0, times a sign. A part that fails counts as
 * indefinite, and the matrices decide. */
static int is_semidefinite_at(const dvi_density *density, const dvi__density_part *part, int64_t k,
                              double sign)
{
  const dvi_density_part *given = &part->given;
  const size_t variables = (size_t)given->variables, pairs = (size_t)given->pairs;
  double x[DVI_AXES_MAX], z[DVI_JETS_MAX], l_zz[PAIRS_MOST], A[DVI_JETS_MAX][DVI_JETS_MAX];
  memset(z, 0, variables * sizeof *z);
  memset(l_zz, 0, pairs * sizeof *l_zz);
  for (size_t i = 0; i < variables; i++) memset(A[i], 0, variables * sizeof A[i][0]);
  for (int d = 0; d < density->dimension; d++) x[d] = part->x[d * part->points + k];
  if (given->density(1, 0, x, z, NULL, NULL, l_zz, given->user) != 0) return 0;
  for (int e = 0; e < given->pairs; e++) {
    const int a = given->pair[e][0], b = given->pair[e][1];
    A[a][b] = A[b][a] = -sign * l_zz[e];
  }
  return is_semidefinite(given->variables, A);
}

static int is_semidefinite_by_points(const dvi_density *density, double sign)
{
  for (int p = 0; p < density->quadratic.parts; p++) {
    const dvi__density_part *part = density->quadratic.part[p];
    for (int64_t k = 0; k < part->points; k++)
      if (!is_semidefinite_at(density, part, k, sign)) return 0;
  }
  return 1;
}

/* ---- matrices ---- */

/* Tell if K + s M is positive definite: DVI_OK, or DVI_SINGULAR. */
static dvi_status factor_shifted(const dvi_matrix *K, const dvi__csr *M, double s)
{
  dvi__csr scaled = {0}, sum = {0};
  dvi__definite solver;
  const dvi_matrix mass = dvi__csr_view(M, 1);
  dvi_status status = dvi__csr_copy(&mass, &scaled);
  for (int64_t e = 0; e < M->start[M->rows] && status == DVI_OK; e++) scaled.value[e] *= s;
  const dvi_matrix added = dvi__csr_view(&scaled, 1);
  if (status == DVI_OK) status = dvi__csr_sum(K, &added, &sum);
  if (status == DVI_OK) {
    const dvi_matrix shifted = dvi__csr_view(&sum, 1);
    status = dvi__definite_create(&shifted, 2, &solver);
    if (status == DVI_OK) dvi__definite_clear(&solver);
  }
  dvi__csr_clear(&sum);
  dvi__csr_clear(&scaled);
  return status;
}

static dvi_status find_least(const dvi__csr *stiffness, const dvi__csr *mass, double *lambda)
{
  const dvi_matrix K = dvi__csr_view(stiffness, 1), M = dvi__csr_view(mass, 1);
  const double most = dvi__largest_entry(&K);
  double s = smallest_shift * most / dvi__largest_entry(&M);
  dvi_status status = most > 0 ? DVI_SINGULAR : DVI_OK;
  int tries = 0;
  for (; status == DVI_SINGULAR && tries < TRIES; tries++, s *= growth)
    status = factor_shifted(&K, mass, s);
  if (status != DVI_OK || tries < 2) return status;
  const dvi_modes_options options = {
      .size = sizeof options, .count = 1, .shift = -s / growth, .dimension = 2};
  return dvi_matrix_modes(&K, &M, &options, lambda, NULL);
}

static dvi_status copy_negated(const dvi__csr *from, dvi__csr *to)
{
  const dvi_matrix view = dvi__csr_view(from, 1);
  DVI_TRY(dvi__csr_copy(&view, to));
  for (int64_t e = 0; e < to->start[to->rows]; e++) to->value[e] = -to->value[e];
  return DVI_OK;
}

static dvi_status find_least_negated(const dvi_density *density, double *lambda)
{
  dvi__csr K = {0}, M = {0};
  dvi_status status = copy_negated(&density->stiffness, &K);
  if (status == DVI_OK) status = copy_negated(&density->mass, &M);
  if (status == DVI_OK) status = find_least(&K, &M, lambda);
  dvi__csr_clear(&K);
  dvi__csr_clear(&M);
  return status;
}

/* A mass without a positive entry on its diagonal is negative, or indefinite and then refused. */
static int is_mass_negative(const dvi__csr *mass)
{
  for (int64_t i = 0; i < mass->rows; i++) {
    const int64_t place = dvi__csr_find(mass, i, (int)i);
    if (place < 0 || !(mass->value[place] < 0)) return 0;
  }
  return 1;
}

dvi_status dvi_density_least(const dvi_density *density, double *lambda)
{
  if (density == NULL || lambda == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: a field and a place for an eigenvalue are needed");
  if (density->mass.rows == 0)
    return dvi__fail(DVI_UNSUPPORTED, "density: the field has no mass, and no frequencies");
  *lambda = 0;
  const int is_negative = is_mass_negative(&density->mass);
  if (density->quadratic.parts == 0 || is_semidefinite_by_points(density, is_negative ? -1 : 1))
    return DVI_OK;
  if (dvi__definite_iterates(density->unknowns, density->dimension))
    return dvi__fail(DVI_UNSUPPORTED,
                     "density: the least eigenvalue of %lld unknowns in three dimensions takes too "
                     "long: ask dvi_density_modes for those near a shift",
                     (long long)density->unknowns);
  DVI_TRY(is_negative ? find_least_negated(density, lambda)
                      : find_least(&density->stiffness, &density->mass, lambda));
  if (*lambda > 0) *lambda = 0;
  return DVI_OK;
}
