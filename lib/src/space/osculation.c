#include "space/osculation.h"

/* Compute w_{2l-1} = B_{2l}/(2l) = (-1)^(l-1) T_l / (4^l (4^l - 1)) with the tangent numbers
 * T_l = 1, 2, 16, 272, ... */
static void euler_maclaurin(int terms, double *weight)
{
  long double T[DVI_TAYLOR_MAX / 2 + 1] = {0, 1}, power = 1;
  for (int k = 2; k <= terms; k++) T[k] = (k - 1) * T[k - 1];
  for (int k = 2; k <= terms; k++)
    for (int j = k; j <= terms; j++) T[j] = (j - k) * T[j - 1] + (j - k + 2) * T[j];
  weight[0] = 0.5;
  for (int l = 1; l <= terms; l++) {
    power *= 4;
    if (l > 1) weight[2 * l - 2] = 0;
    weight[2 * l - 1] = (double)((l % 2 ? 1 : -1) * T[l] / (power * (power - 1)));
  }
}

/* Compute w_j = N! (2N-1-j)! / ((2N)! (j+1) (N-1-j)!) (Davis and Rabinowitz 1984, sec. 2.10.1). */
static void hermite_weights(int N, double *weight)
{
  long double ratio = 0.5L; /* N! (2N-1-j)! / ((2N)! (N-1-j)!) */
  for (int j = 0; j < N; j++) {
    weight[j] = (double)(ratio / (j + 1));
    ratio *= (long double)(N - 1 - j) / (2 * N - 1 - j);
  }
}

void dvi__osculation_weights(dvi__osculation rule, int terms, double *weight)
{
  if (rule == DVI__EULER_MACLAURIN)
    euler_maclaurin(terms, weight);
  else
    hermite_weights(terms, weight);
}

int dvi__osculation_count(dvi__osculation rule, int terms)
{
  if (rule == DVI__HERMITE) return terms;
  return terms > 0 ? 2 * terms : 1;
}

int dvi__osculation_order(dvi__osculation rule, int terms)
{
  return rule == DVI__HERMITE ? 2 * terms : 2 * terms + 2;
}

static double binomial_coefficient(int n, int k)
{
  long double product = 1;
  for (int i = 1; i <= k; i++) product = product * (n - k + i) / i;
  return (double)product;
}

/* The function with a_j = 1 alone is tau^j (1-tau)^N sum_{i < N-j} binomial(N-1+i, i) tau^i. The
 * sum is the truncated series of (1-tau)^-N. The first truncated term is its next coefficient, and
 * the sum itself is that of the other end. */
void dvi__hermite_next(int N, double *from_a, double *from_b)
{
  for (int j = 0; j < N; j++) {
    from_a[j] = -binomial_coefficient(2 * N - 1 - j, N - 1);
    from_b[j] = (j % 2 ? -1 : 1) * binomial_coefficient(2 * N - 1 - j, N);
  }
}

void dvi__hermite_functions(int N, double tau, double *value, double *slope)
{
  const double rest = 1 - tau;
  double power = 1; /* (1-tau)^(N-1) */
  for (int i = 1; i < N; i++) power *= rest;
  double sum = 0, sum_slope = 0, term = 1, term_slope = 0; /* sum and last term of the series */
  for (int j = N - 1, i = 0; j >= 0; j--, i++) {
    sum += term;
    sum_slope += term_slope;
    const double left = j > 0 ? pow(tau, j - 1) : 1, at = j > 0 ? left * tau : 1;
    value[j] = at * power * rest * sum;
    slope[j] = (j > 0 ? j * left : 0) * power * rest * sum - N * at * power * sum +
               at * power * rest * sum_slope;
    const double next = (double)(N + i) / (i + 1);
    term_slope = next * (term_slope * tau + term);
    term *= next * tau;
  }
}
