#include "space/filon.h"

#include <math.h>
#include <stddef.h>

#include "space/legendre.h"
#include "space/quadrature.h"

/* The downward recurrence starts at so many orders beyond the last one. The error of its start has
 * then died out below long double's rounding. */
enum { ABOVE = 40 };

/* Compute the spherical Bessel functions j_0 to j_(count-1) at a >= 0. The recurrence
 * j_(k-1) + j_(k+1) = (2k+1)/a j_k runs upwards where that is stable, a >= k. Otherwise it runs
 * downwards and is scaled by the larger one of j_0 and j_1 (Miller). The moments of Legendre
 * polynomials then need no series for small nu. */
static void bessel_up(int count, long double a, long double *j)
{
  j[0] = sinl(a) / a;
  if (count > 1) j[1] = (j[0] - cosl(a)) / a;
  for (int k = 1; k + 1 < count; k++) j[k + 1] = (long double)(2 * k + 1) / a * j[k] - j[k - 1];
}

static void bessel_down(int count, long double a, long double *j)
{
  long double value[DVI__FILON_NODES_MOST + ABOVE + 2];
  const int top = count + ABOVE;
  value[top + 1] = 0;
  value[top] = 1;
  for (int k = top; k > 0; k--) {
    value[k - 1] = value[k] * ((long double)(2 * k + 1) / a) - value[k + 1];
    if (fabsl(value[k - 1]) < 1e200L) continue;
    for (int i = k - 1; i <= top; i++) value[i] *= 1e-200L;
  }
  const long double first = sinl(a) / a;
  const int by_first = fabsl(value[0]) >= fabsl(value[1]);
  const long double scale = by_first ? first / value[0] : (first - cosl(a)) / a / value[1];
  for (int k = 0; k < count; k++) j[k] = scale * value[k];
}

static void bessel_functions(int count, long double a, long double *j)
{
  const long double tiny = 1e-30L; /* j_k is below a^k/3^k */
  if (a < tiny)
    for (int k = 0; k < count; k++) j[k] = k == 0;
  else if (a >= (long double)count)
    bessel_up(count, a, j);
  else
    bessel_down(count, a, j);
}

/* The Lobatto rule itself gives l_j = sum_k (P_k(c_j) b_j / gamma_k) P_k, with gamma_k = 1/(2k+1),
 * and 1/(n-1) for the last one. The integral of P_k(2x-1) e^{i nu (x - 1/2)} over [0,1] is i^k
 * j_k(nu/2). */
static void moments_at(int n, const long double *node, const long double *weight, long double nu,
                       long double *real, long double *imaginary)
{
  long double j[DVI__FILON_NODES_MOST], P[DVI__FILON_NODES_MOST], difference[DVI__FILON_NODES_MOST];
  bessel_functions(n, fabsl(nu) / 2, j);
  for (int i = 0; i < n; i++) {
    long double part[2] = {0, 0};
    dvi__legendre(n - 1, 1 - node[i], P, difference);
    for (int k = 0; k < n; k++) {
      const long double term = weight[i] * P[k] * j[k] *
                               (long double)(k < n - 1 ? 2 * k + 1 : n - 1);
      part[k % 2] += k / 2 % 2 == 0 ? term : -term;
    }
    real[i] = part[0];
    imaginary[i] = nu < 0 ? -part[1] : part[1];
  }
}

void dvi__filon_moments(int n, long double nu, long double *real, long double *imaginary)
{
  long double node[DVI__FILON_NODES_MOST], weight[DVI__FILON_NODES_MOST];
  (void)dvi__quadrature_long(DVI_LOBATTO, n, node, weight);
  moments_at(n, node, weight, nu, real, imaginary);
}

void dvi__filon_rule(int n, int harmonics, long double nu, long double *node, long double *weight)
{
  const int samples = 2 * harmonics + 1;
  const long double turn = 8 * atanl(1);
  long double lobatto[DVI__FILON_NODES_MOST], real[DVI__FILON_NODES_MOST],
      imaginary[DVI__FILON_NODES_MOST];
  (void)dvi__quadrature_long(DVI_LOBATTO, n, node, lobatto);
  for (int i = 0; i < n * samples; i++) weight[i] = 0;
  for (int k = 0; k <= harmonics; k++) {
    moments_at(n, node, lobatto, (long double)k * nu, real, imaginary);
    for (int j = 0; j < n; j++)
      for (int m = 0; m < samples; m++) {
        const long double phase = (long double)k * (nu * (node[j] - 0.5L) +
                                                    turn * (long double)m / (long double)samples);
        weight[j * samples + m] += (k == 0 ? 1 : 2) *
                                   (real[j] * cosl(phase) + imaginary[j] * sinl(phase)) /
                                   (long double)samples;
      }
  }
}
