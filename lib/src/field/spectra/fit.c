/* Least squares with separable unknowns.
 *
 * With the columns V_k(m) = z_k^m, z = exp(s), and their derivatives V'_k(m) = m z_k^m in s, the
 * amplitudes of given poles are c_p = V^+ y_p, which leave r_p. Orthogonal to V are W = (1 - V V^+)
 * V', so that the step of Gauss and Newton's method for the poles alone is
 *
 *     F ds = g,   F_kl = (W^H W)_kl sum_p conj(c_kp) c_lp,   g_k = sum_p conj(c_kp) (W^H r_p)_k.
 *
 * Noise of mean square n^2 has the covariance n^2 F^-1 of s, half of it in the real part and half
 * in the imaginary one. Source: Golub and Pereyra 1973, sec. 2 to 4; Kaufman 1975. */
#include "field/spectra/fit.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/spectra/complex_matrix.h"
#include "field/spectra/complex_number.h"

enum { BLOCK = 64, STEPS = 3 };

typedef struct fit {
  const dvi__exponentials *series;
  int64_t length, probes, count;
  double complex *V;      /* [length*count] columns of norm 1 */
  double complex *sides;  /* [length*(count+probes)] V', y, and their products with Q^H */
  double complex *F;      /* [count*count] */
  double complex *g;      /* [count] */
  double complex *step;   /* [count] of s */
  double complex *z;      /* [count] */
  double complex *c;      /* [count*probes] */
  double complex *scale;  /* [count] c is the coefficient of a column times this */
  double complex *factor; /* [count] */
  double complex *work;   /* [BLOCK*(count+probes)] */
  double *lambda, *size;  /* [count] */
  double *variance;       /* [count] of s for noise of size 1 */
  double left;            /* mean square of what is left */
} fit;

static dvi_status fit_create(const dvi__exponentials *series, int count, fit *f)
{
  const size_t n = (size_t)series->length, M = (size_t)count, P = (size_t)series->probes;
  *f = (fit){.series = series, .length = series->length, .probes = series->probes, .count = count};
  f->V = DVI_NEW(double complex, n *M);
  f->sides = DVI_NEW(double complex, n *(M + P));
  f->F = DVI_NEW(double complex, M *M);
  f->c = DVI_NEW(double complex, M *P);
  f->work = DVI_NEW(double complex, BLOCK *(M + P));
  f->g = DVI_NEW(double complex, 5 * M);
  f->lambda = DVI_NEW(double, 3 * M);
  if (!f->V || !f->sides || !f->F || !f->c || !f->work || !f->g || !f->lambda)
    return dvi__fail(DVI_NO_MEMORY, "spectrum: no memory for a fit of %d exponentials", count);
  f->step = f->g + M;
  f->z = f->step + M;
  f->scale = f->z + M;
  f->factor = f->scale + M;
  f->size = f->lambda + M;
  f->variance = f->size + M;
  return DVI_OK;
}

static void fit_clear(fit *f)
{
  dvi__release(f->V);
  dvi__release(f->sides);
  dvi__release(f->F);
  dvi__release(f->c);
  dvi__release(f->work);
  dvi__release(f->g);
  dvi__release(f->lambda);
}

/* ---- the amplitudes of given poles ---- */

/* Set a column to z^m, from the end where this is largest, over its norm. Return the factor by
 * which coefficients of the column are amplitudes at the first sample. */
static double complex fill_powers(int64_t length, double complex z, double complex *column)
{
  const int grows = cabs(z) > 1;
  const double complex ratio = grows ? 1 / z : z;
  double complex power = 1;
  double square = 0;
  for (int64_t i = 0; i < length; i++) {
    column[grows ? length - 1 - i : i] = power;
    square += creal(power) * creal(power) + cimag(power) * cimag(power);
    power *= ratio;
  }
  const double norm = sqrt(square);
  for (int64_t i = 0; i < length; i++) column[i] /= norm;
  return (grows ? power / ratio : 1) / norm;
}

static void fill_sides(fit *f)
{
  const int64_t n = f->length;
  for (int64_t k = 0; k < f->count; k++) {
    double complex *column = f->V + k * n, *slope = f->sides + k * n;
    f->scale[k] = fill_powers(n, f->z[k], column);
    for (int64_t m = 0; m < n; m++) slope[m] = (double)m * column[m];
  }
  memcpy(f->sides + f->count * n, f->series->y, (size_t)(f->probes * n) * sizeof *f->sides);
}

/* Return a^H b of the parts of two sides that are orthogonal to V. */
static double complex product(const fit *f, int64_t a, int64_t b)
{
  const double complex *x = f->sides + a * f->length, *y = f->sides + b * f->length;
  double re = 0, im = 0;
  for (int64_t m = f->count; m < f->length; m++) {
    re += creal(x[m]) * creal(y[m]) + cimag(x[m]) * cimag(y[m]);
    im += creal(x[m]) * cimag(y[m]) - cimag(x[m]) * creal(y[m]);
  }
  return dvi__complex(re, im);
}

/* Set c to the coefficients of the columns, and `left`. */
static int find_amplitudes(fit *f)
{
  const int n = (int)f->length, M = (int)f->count, P = (int)f->probes;
  double sum = 0;
  fill_sides(f);
  dvi__complex_qr(n, M, f->V, f->factor, f->work);
  dvi__complex_reflect(n, M, f->V, f->factor, M + P, f->sides, f->work);
  for (int64_t p = 0; p < P; p++) {
    memcpy(f->c + p * M, f->sides + (M + p) * n, (size_t)M * sizeof *f->c);
    sum += creal(product(f, M + p, M + p));
  }
  f->left = sum / ((double)n * P);
  return dvi__complex_back(n, M, f->V, M, P, f->c);
}

/* ---- the step of the poles ---- */

/* Set F and g, scaled to a diagonal of 1 by `size`. */
static void fill_normal_equations(fit *f)
{
  const int64_t M = f->count;
  for (int64_t k = 0; k < M; k++) {
    f->g[k] = 0;
    for (int64_t p = 0; p < f->probes; p++) f->g[k] += conj(f->c[p * M + k]) * product(f, k, M + p);
    for (int64_t l = 0; l <= k; l++) {
      double complex shared = 0;
      for (int64_t p = 0; p < f->probes; p++) shared += conj(f->c[p * M + k]) * f->c[p * M + l];
      f->F[l * M + k] = product(f, k, l) * shared;
    }
    f->size[k] = fmax(sqrt(creal(f->F[k * M + k])), DBL_MIN);
  }
  for (int64_t k = 0; k < M; k++) {
    f->g[k] /= f->size[k];
    for (int64_t l = 0; l <= k; l++) f->F[l * M + k] /= f->size[k] * f->size[l];
  }
}

/* Solve the normal equations by the eigenvectors of F, which are overwritten on it. Directions that
 * roundoff decides have the least eigenvalue that it leaves. */
static dvi_status find_step(fit *f)
{
  const int64_t M = f->count;
  fill_normal_equations(f);
  DVI_TRY(dvi__complex_hermitian((int)M, f->F, f->lambda));
  for (int64_t k = 0; k < M; k++) f->step[k] = f->variance[k] = 0;
  for (int64_t i = 0; i < M; i++) {
    const double complex *u = f->F + i * M;
    const double lambda = fmax(f->lambda[i], (double)M * DBL_EPSILON);
    double complex along = 0;
    for (int64_t k = 0; k < M; k++) along += conj(u[k]) * f->g[k];
    for (int64_t k = 0; k < M; k++) {
      f->step[k] += along / lambda * u[k] / f->size[k];
      f->variance[k] += (creal(u[k]) * creal(u[k]) + cimag(u[k]) * cimag(u[k])) / lambda /
                        (f->size[k] * f->size[k]);
    }
  }
  return DVI_OK;
}

static dvi_status linearize(fit *f)
{
  if (!find_amplitudes(f))
    return dvi__fail(DVI_SOLVER_FAILED, "spectrum: two of %d exponentials are equal",
                     (int)f->count);
  return find_step(f);
}

/* ---- the fit ---- */

/* Give the amplitudes at the first sample, and errors. As many unknowns as there are poles and
 * amplitudes have taken their part of the noise. */
static void give(const fit *f, double rounding, double complex *z, double complex *c, double *error,
                 double *left)
{
  const int64_t M = f->count, P = f->probes;
  const double all = (double)(f->length * P), taken = (double)(M * (1 + P));
  const double noise = sqrt(f->left * all / fmax(all - taken, 1)) + rounding;
  for (int64_t k = 0; k < M; k++) {
    z[k] = f->z[k];
    error[k] = noise * sqrt(f->variance[k] / 2);
    for (int64_t p = 0; p < P; p++) c[k * P + p] = f->c[p * M + k] * f->scale[k];
  }
  *left = f->left;
}

/* Move the poles, but for those that would leave the width that the length resolves: their lines
 * are noise. */
static void move_poles(fit *f)
{
  for (int64_t k = 0; k < f->count; k++)
    if (cabs(f->step[k]) * (double)f->length < 1) f->z[k] *= cexp(f->step[k]);
}

/* Take steps as long as they leave less. */
static dvi_status improve(fit *f, double rounding, double complex *z, double complex *c,
                          double *error, double *left)
{
  for (int i = 0; i <= STEPS; i++) {
    DVI_TRY(linearize(f));
    if (i > 0 && !(f->left < *left)) break;
    give(f, rounding, z, c, error, left);
    move_poles(f);
  }
  return DVI_OK;
}

static double mean_square(const dvi__exponentials *series)
{
  const int64_t count = (int64_t)series->length * series->probes;
  double sum = 0;
  for (int64_t i = 0; i < count; i++)
    sum += creal(series->y[i]) * creal(series->y[i]) + cimag(series->y[i]) * cimag(series->y[i]);
  return sum / (double)count;
}

dvi_status dvi__fit_exponentials(const dvi__exponentials *series, double rounding, int count,
                                 double complex *z, double complex *c, double *error, double *left)
{
  fit f;
  *left = mean_square(series);
  if (count == 0) return DVI_OK;
  dvi_status status = fit_create(series, count, &f);
  if (status == DVI_OK) {
    memcpy(f.z, z, (size_t)count * sizeof *z);
    status = improve(&f, rounding, z, c, error, left);
  }
  fit_clear(&f);
  return status;
}
