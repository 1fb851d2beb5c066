/* GMRES with restarts (Saad and Schultz 1986), preconditioned from the left. The iteration
 * minimises P^-1 (b - A x), which is near the error where P is near A, and in the units of the
 * unknowns. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/eigen.h"
#include "num/factor.h"

/* Number of directions that are kept, and of restarts from the best solution. */
enum { DIRECTIONS = 40, RESTARTS = 25 };

/* Parts of the solution that may be left: in a search, and in the end. Newton's method corrects the
 * rest. */
static const double enough = 1e-7, acceptable = 1e-5;

/* A search that leaves more than this part of the residual is the last one. */
static const double stagnant = 0.95;

typedef struct iterative {
  const dvi__operator *A;
  size_t size;
  double *basis;                        /* [DIRECTIONS+1][size] orthonormal directions */
  double *x, *r;                        /* [size] solution, and P^-1 b or its remaining part */
  double H[DIRECTIONS + 1][DIRECTIONS]; /* A in these directions, as rotations make it triangular */
  double cosine[DIRECTIONS], sine[DIRECTIONS], left[DIRECTIONS + 1];
  double column[DIRECTIONS][DIRECTIONS + 1]; /* A in these directions, by columns */
  double work[DIRECTIONS * (DIRECTIONS + 6)];
  int has_solved, negatives; /* negative eigenvalues of P^-1 A that the solutions have met */
} iterative;

static void iterative_destroy(void *factor)
{
  iterative *s = factor;
  if (s == NULL) return;
  dvi__release(s->basis);
  dvi__release(s->x);
  dvi__release(s->r);
  dvi__release(s);
}

static dvi_status iterative_create(const dvi__factor_form *form, void **factor)
{
  iterative *s = *factor = DVI_NEW(iterative, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "GMRES: no memory");
  s->A = form->A;
  s->size = (size_t)form->A->size;
  s->basis = DVI_NEW(double, (DIRECTIONS + 1) * s->size);
  s->x = DVI_NEW(double, s->size);
  s->r = DVI_NEW(double, s->size);
  if (s->basis != NULL && s->x != NULL && s->r != NULL) return DVI_OK;
  iterative_destroy(s);
  *factor = NULL;
  return dvi__fail(DVI_NO_MEMORY, "GMRES: no memory for %d directions of %d unknowns",
                   DIRECTIONS + 1, form->A->size);
}

static dvi_status iterative_renew(void *factor, const dvi__pattern *pattern, const double *values)
{
  iterative *s = factor;
  (void)pattern, (void)values;
  s->has_solved = s->negatives = 0;
  return s->A->renew != NULL ? s->A->renew(s->A->of) : DVI_OK;
}

/* ---- vectors ---- */

static double *gmres_direction(const iterative *s, int k)
{
  return s->basis + (size_t)k * s->size;
}

/* Give the scalar product as four sums, which do not wait for each other. */
static double gmres_dot(size_t size, const double *x, const double *y)
{
  double sum[4] = {0, 0, 0, 0};
  size_t i = 0;
  for (; i + 4 <= size; i += 4)
    for (size_t j = 0; j < 4; j++) sum[j] += x[i + j] * y[i + j];
  for (; i < size; i++) sum[0] += x[i] * y[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

static void gmres_add(size_t size, double factor, const double *x, double *y)
{
  for (size_t i = 0; i < size; i++) y[i] += factor * x[i];
}

static void gmres_precondition(const iterative *s, double *r)
{
  if (s->A->precondition != NULL) s->A->precondition(s->A->of, r);
}

/* ---- one search ---- */

/* Find the next direction, orthogonal to all before (Gram and Schmidt, one after the other), and
 * column k of H. */
static void extend_basis(iterative *s, int k)
{
  double *next = gmres_direction(s, k + 1);
  s->A->times(s->A->of, gmres_direction(s, k), next);
  gmres_precondition(s, next);
  for (int j = 0; j <= k; j++) {
    s->H[j][k] = gmres_dot(s->size, gmres_direction(s, j), next);
    gmres_add(s->size, -s->H[j][k], gmres_direction(s, j), next);
  }
  const double length = s->H[k + 1][k] = sqrt(gmres_dot(s->size, next, next));
  for (size_t i = 0; i < s->size && length > 0; i++) next[i] /= length;
  for (int j = 0; j <= k + 1; j++) s->column[k][j] = s->H[j][k];
}

/* Apply the rotations before, and one that removes the entry below the diagonal. */
static void rotate_column(iterative *s, int k)
{
  for (int j = 0; j < k; j++) {
    const double a = s->H[j][k], b = s->H[j + 1][k];
    s->H[j][k] = s->cosine[j] * a + s->sine[j] * b;
    s->H[j + 1][k] = s->cosine[j] * b - s->sine[j] * a;
  }
  const double length = hypot(s->H[k][k], s->H[k + 1][k]);
  s->cosine[k] = length > 0 ? s->H[k][k] / length : 1;
  s->sine[k] = length > 0 ? s->H[k + 1][k] / length : 0;
  s->H[k][k] = length;
  s->left[k + 1] = -s->sine[k] * s->left[k];
  s->left[k] *= s->cosine[k];
}

/* Add to x the combination of `count` directions that minimises the residual. */
static void add_combination(iterative *s, int count)
{
  for (int k = count - 1; k >= 0; k--) {
    for (int j = k + 1; j < count; j++) s->left[k] -= s->H[k][j] * s->left[j];
    s->left[k] = s->H[k][k] != 0 ? s->left[k] / s->H[k][k] : 0;
  }
  for (int k = 0; k < count; k++) gmres_add(s->size, s->left[k], gmres_direction(s, k), s->x);
}

/* Search from the residual r of length `length`. Return the number of directions. A direction that
 * A maps into those before is of no use, because A is singular there. */
static int gmres_search(iterative *s, double length, double most)
{
  double *first = gmres_direction(s, 0);
  int k = 0;
  for (size_t i = 0; i < s->size; i++) first[i] = s->r[i] / length;
  s->left[0] = length;
  while (k < DIRECTIONS && fabs(s->left[k]) > most) {
    extend_basis(s, k);
    rotate_column(s, k);
    if (!(s->H[k][k] > 0)) break;
    k++;
  }
  add_combination(s, k);
  return k;
}

/* Set r = P^-1 (b - A x). */
static double gmres_residual(iterative *s, const double *b)
{
  double *product = gmres_direction(s, 0);
  s->A->times(s->A->of, s->x, product);
  for (size_t i = 0; i < s->size; i++) s->r[i] = b[i] - product[i];
  gmres_precondition(s, s->r);
  return sqrt(gmres_dot(s->size, s->r, s->r));
}

/* Note the negative eigenvalues that these directions show. Another right side may not have shown
 * them all. */
static void note_negatives(iterative *s, int directions)
{
  const int found = directions == 0
                        ? 0
                        : dvi__negative_ritz_values(directions, s->column[0], DIRECTIONS + 1,
                                                    s->column[directions - 1][directions], s->work);
  if (found > s->negatives) s->negatives = found;
  s->has_solved = 1;
}

/* Return the length of what the residual is compared with. Where A is stiff P^-1 b is much longer
 * than the solution, and a small part of it would be a large part of the solution. */
static double gmres_scale(const iterative *s, double whole)
{
  const double length = sqrt(gmres_dot(s->size, s->x, s->x));
  return length < whole ? length : whole;
}

/* Solve. A right side that is not finite has no better solution than itself. */
static dvi_status iterative_solve(void *factor, const dvi__pattern *pattern, double *b)
{
  iterative *s = factor;
  (void)pattern;
  memset(s->x, 0, s->size * sizeof(double));
  memcpy(s->r, b, s->size * sizeof(double));
  gmres_precondition(s, s->r);
  const double whole = sqrt(gmres_dot(s->size, s->r, s->r));
  double length = whole, scale = whole, before = HUGE_VAL;
  for (int i = 0; i < RESTARTS && length > enough * scale && length <= stagnant * before; i++) {
    const int directions = gmres_search(s, length, enough * scale);
    before = length;
    length = gmres_residual(s, b);
    if (i == 0 && isfinite(length)) note_negatives(s, directions);
    scale = gmres_scale(s, whole);
  }
  if (!isfinite(length)) return dvi__fail(DVI_NOT_CONVERGED, "GMRES meets numbers too large");
  memcpy(b, s->x, s->size * sizeof(double));
  if (length <= acceptable * scale) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED,
                   "GMRES leaves %.1e of the solution; the matrix is singular, or its "
                   "preconditioner far from it",
                   length / scale);
}

/* The determinant of A is that of P times the eigenvalues of P^-1 A. */
static int iterative_sign(const void *factor, const dvi__pattern *pattern)
{
  const iterative *s = factor;
  (void)pattern;
  if (s->A->sign == NULL || !s->has_solved) return 0;
  return s->negatives % 2 == 0 ? s->A->sign(s->A->of) : -s->A->sign(s->A->of);
}

static int iterative_is_definite(const void *factor, const dvi__pattern *pattern, int sign)
{
  const iterative *s = factor;
  (void)pattern;
  return s->negatives == 0 && s->A->is_definite != NULL && s->A->is_definite(s->A->of, sign);
}

const dvi__factor_kind dvi__iterative_factor = {.name = "GMRES",
                                                .create = iterative_create,
                                                .destroy = iterative_destroy,
                                                .refactor = iterative_renew,
                                                .solve = iterative_solve,
                                                .sign = iterative_sign,
                                                .is_definite = iterative_is_definite};
