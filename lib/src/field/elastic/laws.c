#include "field/elastic/laws.h"

enum { LOWER = DVI__SOLID_ENTRIES * (DVI__SOLID_ENTRIES + 1) / 2 };

/* ---- energies ---- */

/* Give A:B. */
static double contract(int n, const double *A, const double *B)
{
  double sum = 0;
  for (int k = 0; k < n * n; k++) sum += A[k] * B[k];
  return sum;
}

/* W = lambda (tr E)^2/2 + mu E:E. */
static double quadratic_energy(int n, const dvi__solid_material *m, const double *E)
{
  const double t = dvi__trace(n, E);
  return m->lambda * t * t / 2 + m->mu * contract(n, E, E);
}

/* Give x - ln(1+x). Near 0 the series of ln(1+x) = 2 artanh s with s = x/(2+x) is used, whose first
 * term leaves x s. */
static double without_logarithm(double x)
{
  if (fabs(x) > 0.1) return x - log1p(x);
  const double s = x / (2 + x), z = s * s;
  double sum = 0;
  for (int k = 15; k >= 3; k -= 2) sum = sum * z + 1.0 / k;
  return x * s - 2 * s * z * sum;
}

static int logarithmic_energy(int n, const dvi__solid_material *m, const double *H, const double *E,
                              double *W)
{
  const double higher = dvi__higher_volume(n, H), growth = dvi__trace(n, H) + higher;
  if (!(growth > -1)) return 1;
  const double t = dvi__trace(n, E), ln = log1p(growth),
               shear = contract(n, H, H) / 2 - higher + without_logarithm(growth);
  *W = (m->mu + m->mooney) * shear + m->mooney * (t * t - contract(n, E, E)) +
       (m->lambda / 2 - m->mooney) * ln * ln;
  return 0;
}

/* ---- energies that are given ---- */

static void find_deformation(int n, const double *H, double *F)
{
  for (int k = 0; k < n * n; k++) F[k] = H[k] + (k % (n + 1) == 0);
}

/* Numbers that are not finite count as those of a place where W is not defined. */
static int check_numbers(int returned, int count, const double *number)
{
  for (int k = 0; k < count && returned == 0; k++)
    if (!isfinite(number[k])) return 1;
  return returned;
}

int dvi__given_stress(int n, const dvi__solid_material *m, const double *H, double *P)
{
  double F[DVI__SOLID_ENTRIES] = {0};
  find_deformation(n, H, F);
  return check_numbers(m->energy(1, F, NULL, P, NULL, m->user), n * n, P);
}

static int given_energy(int n, const dvi__solid_material *m, const double *H, double *W)
{
  double F[DVI__SOLID_ENTRIES] = {0};
  find_deformation(n, H, F);
  return check_numbers(m->energy(1, F, W, NULL, NULL, m->user), 1, W);
}

static int given_hessian(int n, const dvi__solid_material *m, const double *H, double *A)
{
  double F[DVI__SOLID_ENTRIES] = {0}, lower[LOWER];
  const int entries = n * n;
  find_deformation(n, H, F);
  const int returned = check_numbers(m->energy(1, F, NULL, NULL, lower, m->user),
                                     entries * (entries + 1) / 2, lower);
  for (int i = 0, k = 0; i < entries && returned == 0; i++)
    for (int j = 0; j <= i; j++, k++) A[i * entries + j] = A[j * entries + i] = lower[k];
  return returned;
}

int dvi__law_energy(int n, const dvi__solid_material *m, const double *H, double *W)
{
  double E[DVI__SOLID_ENTRIES] = {0};
  if (m->law == DVI_ELASTIC_ENERGY) return given_energy(n, m, H, W);
  if (m->law == DVI_ELASTIC_LINEAR) {
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) E[i * n + j] = (H[i * n + j] + H[j * n + i]) / 2;
  } else {
    dvi__green_strain(n, H, E);
  }
  if (m->law != DVI_ELASTIC_LINEAR && m->law != DVI_ELASTIC_SVK)
    return logarithmic_energy(n, m, H, E, W);
  *W = quadratic_energy(n, m, E);
  return 0;
}

/* ---- Hessians ---- */

/* What the Hessian of a law consists of:
 *
 *     A_ijkl = d_ik S_jl + a F_ij F_kl + b (F_il F_kj + (F F^T)_ik d_jl)
 *              + c G_ij G_kl + d G_il G_kj. */
typedef struct parts {
  double S[DVI__SOLID_ENTRIES], a, b, c, d, F[DVI__SOLID_ENTRIES], G[DVI__SOLID_ENTRIES];
} parts;

static void fill(int n, const parts *of, double *A)
{
  double FF[DVI__SOLID_ENTRIES] = {0};
  const double *F = of->F, *G = of->G;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++)
      for (int m = 0; m < n; m++) FF[i * n + k] += F[i * n + m] * F[k * n + m];
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int k = 0; k < n; k++)
        for (int l = 0; l < n; l++)
          A[(i * n + j) * n * n + k * n + l] =
              (i == k ? of->S[j * n + l] : 0) + of->a * F[i * n + j] * F[k * n + l] +
              of->b * (F[i * n + l] * F[k * n + j] + (j == l ? FF[i * n + k] : 0)) +
              of->c * G[i * n + j] * G[k * n + l] + of->d * G[i * n + l] * G[k * n + j];
}

/* dP = dF S + F dS with dS = lambda F:dF I + mu (F^T dF + dF^T F). */
static void prepare_svk(int n, const dvi__solid_material *m, const double *E, parts *of)
{
  const double pressure = m->lambda * dvi__trace(n, E);
  for (int k = 0; k < n * n; k++) of->S[k] = 2 * m->mu * E[k] + (k % (n + 1) == 0 ? pressure : 0);
  of->a = m->lambda;
  of->b = m->mu;
}

/* dG = -G dF^T G and d ln J = G:dF. */
static int prepare_logarithmic(int n, const dvi__solid_material *m, const double *H,
                               const double *E, parts *of)
{
  const double growth = dvi__trace(n, H) + dvi__higher_volume(n, H), shear = m->mu + m->mooney,
               bulk = m->lambda - 2 * m->mooney, twice = 2 * m->mooney, t = dvi__trace(n, E);
  if (!(growth > -1)) return 1;
  dvi__inverse_transposed(n, H, 1 + growth, of->G);
  for (int k = 0; k < n * n; k++)
    of->S[k] = (k % (n + 1) == 0 ? shear + twice * t : 0) - twice * E[k];
  of->a = twice;
  of->b = -m->mooney;
  of->c = bulk;
  of->d = shear - bulk * log1p(growth);
  return 0;
}

int dvi__law_hessian(int n, const dvi__solid_material *m, const double *H, double *A)
{
  static const double rest[DVI__SOLID_ENTRIES];
  const int is_linear = m->law == DVI_ELASTIC_LINEAR;
  double E[DVI__SOLID_ENTRIES] = {0};
  parts of = {.a = 0};
  int returned = 0;
  if (m->law == DVI_ELASTIC_ENERGY) return given_hessian(n, m, H, A);
  if (is_linear) H = rest;
  dvi__green_strain(n, H, E);
  find_deformation(n, H, of.F);
  if (is_linear || m->law == DVI_ELASTIC_SVK)
    prepare_svk(n, m, E, &of);
  else
    returned = prepare_logarithmic(n, m, H, E, &of);
  if (returned == 0) fill(n, &of, A);
  return returned;
}
