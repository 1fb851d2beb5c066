/* The laws of materials, as functions of H = grad u with F = I + H, because small strains have few
 * digits left in F. [n*n] matrices stand row by row.
 *
 * Green's strain is E = (F^T F - I)/2 = (H + H^T + H^T H)/2. The laws with J = det F all are
 *
 *     W = (mu + m)(tr E - ln J) + m ((tr E)^2 - E:E) + (lambda - 2m)/2 (ln J)^2
 *
 * with m of Mooney and Rivlin, and 0 for the neo-Hookean law, by I_1 = 3 + 2 tr E and
 * I_2 = 3 + 4 tr E + 2 (tr E)^2 - 2 E:E (Ogden 1984, sec. 4.3; Ciarlet 1988, sec. 4.10). In a plane
 * E_33 = 0.
 *
 * All return 0, a positive number if W is not defined at H, or a negative one of a callback. */
#ifndef DVI_FIELD_ELASTIC_LAWS_H
#define DVI_FIELD_ELASTIC_LAWS_H
#include <math.h>

#include "field/elastic/elastic.h"

/* Give W. */
int dvi__law_energy(int n, const dvi__solid_material *m, const double *H, double *W);

/* Give the Hessian A of W, d2W/dF_ij dF_kl at [(i*n+j)*n*n + k*n+l]. */
int dvi__law_hessian(int n, const dvi__solid_material *m, const double *H, double *A);

/* Give P of an energy that is given. */
int dvi__given_stress(int n, const dvi__solid_material *m, const double *H, double *P);

/* ---- strains ---- */

static inline double dvi__trace(int n, const double *A)
{
  double sum = 0;
  for (int i = 0; i < n; i++) sum += A[i * n + i];
  return sum;
}

static inline void dvi__green_strain(int n, const double *H, double *E)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j <= i; j++) {
      double sum = H[i * n + j] + H[j * n + i];
      for (int m = 0; m < n; m++) sum += H[m * n + i] * H[m * n + j];
      E[i * n + j] = E[j * n + i] = sum / 2;
    }
}

/* Give J - 1 - tr H, the terms of J of second and third order. */
static inline double dvi__higher_volume(int n, const double *H)
{
  if (n == 2) return H[0] * H[3] - H[1] * H[2];
  const double a = H[4] * H[8] - H[5] * H[7], b = H[5] * H[6] - H[3] * H[8],
               c = H[3] * H[7] - H[4] * H[6];
  return H[0] * H[4] - H[1] * H[3] + H[0] * H[8] - H[2] * H[6] + a + H[0] * a + H[1] * b + H[2] * c;
}

/* Give G = F^-T, of F = I + H with J = det F. */
static inline void dvi__inverse_transposed(int n, const double *H, double J, double *G)
{
  const double scale = 1 / J;
  if (n == 2) {
    G[0] = scale * (1 + H[3]), G[1] = -scale * H[2];
    G[2] = -scale * H[1], G[3] = scale * (1 + H[0]);
    return;
  }
  const double x = 1 + H[0], y = 1 + H[4], z = 1 + H[8];
  G[0] = scale * (y * z - H[5] * H[7]);
  G[1] = scale * (H[5] * H[6] - H[3] * z);
  G[2] = scale * (H[3] * H[7] - y * H[6]);
  G[3] = scale * (H[2] * H[7] - H[1] * z);
  G[4] = scale * (x * z - H[2] * H[6]);
  G[5] = scale * (H[1] * H[6] - x * H[7]);
  G[6] = scale * (H[1] * H[5] - H[2] * y);
  G[7] = scale * (H[2] * H[3] - x * H[5]);
  G[8] = scale * (x * y - H[1] * H[3]);
}

/* ---- P = dW/dF ---- */

/* P = lambda tr e I + 2 mu e. */
static inline void dvi__linear_stress(int n, const dvi__solid_material *m, const double *H,
                                      double *P)
{
  const double pressure = m->lambda * dvi__trace(n, H);
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) P[i * n + j] = m->mu * (H[i * n + j] + H[j * n + i]);
    P[i * n + i] += pressure;
  }
}

/* P = F S with S = lambda tr E I + 2 mu E. */
static inline void dvi__svk_stress(int n, const dvi__solid_material *m, const double *H, double *P)
{
  double S[DVI__SOLID_ENTRIES] = {0};
  dvi__green_strain(n, H, S);
  const double pressure = m->lambda * dvi__trace(n, S), twice = 2 * m->mu;
  for (int k = 0; k < n * n; k++) S[k] *= twice;
  for (int i = 0; i < n; i++) S[i * n + i] += pressure;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double sum = S[i * n + j];
      for (int k = 0; k < n; k++) sum += H[i * n + k] * S[k * n + j];
      P[i * n + j] = sum;
    }
}

/* Add 2 m (tr E F - F E). */
static inline void dvi__add_mooney_stress(int n, double m, const double *H, double *P)
{
  double E[DVI__SOLID_ENTRIES] = {0};
  dvi__green_strain(n, H, E);
  const double t = dvi__trace(n, E);
  for (int i = 0; i < n; i++) E[i * n + i] -= t;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double sum = E[i * n + j];
      for (int k = 0; k < n; k++) sum += H[i * n + k] * E[k * n + j];
      P[i * n + j] -= 2 * m * sum;
    }
}

/* P = (mu + m)(F - G) + (lambda - 2m) ln J G + 2m (tr E F - F E) with F - G = H + G H^T. */
static inline int dvi__logarithmic_stress(int n, const dvi__solid_material *m, const double *H,
                                          double *P)
{
  double G[DVI__SOLID_ENTRIES] = {0};
  const double growth = dvi__trace(n, H) + dvi__higher_volume(n, H);
  if (!(growth > -1)) return 1;
  dvi__inverse_transposed(n, H, 1 + growth, G);
  const double shear = m->mu + m->mooney, pressure = (m->lambda - 2 * m->mooney) * log1p(growth);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double sum = H[i * n + j];
      for (int k = 0; k < n; k++) sum += G[i * n + k] * H[j * n + k];
      P[i * n + j] = shear * sum + pressure * G[i * n + j];
    }
  if (m->mooney != 0) dvi__add_mooney_stress(n, m->mooney, H, P);
  return 0;
}

/* n is a constant where this is called, so that the loops are unrolled. */
static inline int dvi__law_stress(int n, const dvi__solid_material *m, const double *H, double *P)
{
  switch (m->law) {
  case DVI_ELASTIC_LINEAR: dvi__linear_stress(n, m, H, P); return 0;
  case DVI_ELASTIC_SVK: dvi__svk_stress(n, m, H, P); return 0;
  case DVI_ELASTIC_ENERGY: return dvi__given_stress(n, m, H, P);
  default: return dvi__logarithmic_stress(n, m, H, P);
  }
}

#endif
