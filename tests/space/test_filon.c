#include <math.h>

#include "roundoff.h"
#include "space/filon.h"
#include "space/quadrature.h"
#include "support/suite.h"

enum { NODES = 5, SAMPLES = 5 };

static const long double phases[] = {-7,   0,    1e-12L, 1e-3L, 0.5L, 3,
                                     4.9L, 5.1L, 9.9L,   10.1L, 25,   60};

static long double largest(long double a, long double b)
{
  return fmaxl(fabsl(a), b);
}

/* Gauss with 80 points is exact to roundoff for nu up to 60. */
static void integrate(int j, const long double *node, long double nu, long double *real,
                      long double *imaginary)
{
  long double at[DVI_QUADRATURE_MAX], weight[DVI_QUADRATURE_MAX];
  ck_assert_int_eq(dvi__quadrature_long(DVI_GAUSS, DVI_QUADRATURE_MAX, at, weight), DVI_OK);
  *real = *imaginary = 0;
  for (int g = 0; g < DVI_QUADRATURE_MAX; g++) {
    long double l = weight[g];
    for (int i = 0; i < NODES; i++)
      if (i != j) l *= (at[g] - node[i]) / (node[j] - node[i]);
    *real += l * cosl(nu * (at[g] - 0.5L));
    *imaginary += l * sinl(nu * (at[g] - 0.5L));
  }
}

START_TEST(moments_of_the_lagrange_polynomials_are_right_to_roundoff_at_every_frequency)
{
  const long double nu = phases[_i];
  long double node[NODES], weight[NODES], real[NODES], imaginary[NODES], exact[2], error = 0;
  ck_assert_int_eq(dvi__quadrature_long(DVI_LOBATTO, NODES, node, weight), DVI_OK);
  dvi__filon_moments(NODES, nu, real, imaginary);
  for (int j = 0; j < NODES; j++) {
    integrate(j, node, nu, &exact[0], &exact[1]);
    error = largest(imaginary[j] - exact[1], largest(real[j] - exact[0], error));
  }
  ck_assert_double_le((double)error, 200 * (double)long_roundoff());
}
END_TEST

START_TEST(moments_add_up_to_the_integral_of_the_wave_at_frequencies_that_no_grid_resolves)
{
  long double nu = 100;
  for (int k = 0; k < 8; k++, nu *= 7.3L) {
    long double real[NODES], imaginary[NODES], sum = 0;
    dvi__filon_moments(NODES, nu, real, imaginary);
    for (int j = 0; j < NODES; j++) sum += real[j];
    ck_assert_double_le((double)fabsl(sum - sinl(nu / 2) / (nu / 2)), 10 * (double)long_roundoff());
  }
}
END_TEST

/* f = a(x) (1 + cos(phi - 1) + cos(2 phi - 3)) with a of degree NODES - 1. */
static long double amplitude(long double x)
{
  return 1 - 3 * x + x * x * x - 2 * x * x * x * x;
}

static long double wave(long double phi)
{
  return 1 + cosl(phi - 1) + cosl(2 * phi - 3);
}

START_TEST(the_rule_is_exact_for_two_harmonics_whose_amplitude_the_nodes_interpolate)
{
  const long double nu = phases[_i], turn = 8 * atanl(1);
  long double node[NODES], weight[NODES * SAMPLES], at[DVI_QUADRATURE_MAX], by[DVI_QUADRATURE_MAX],
      sum = 0;
  dvi__filon_rule(NODES, 2, nu, node, weight);
  for (int j = 0; j < NODES * SAMPLES; j++) {
    const long double x = node[j / SAMPLES];
    sum += weight[j] * amplitude(x) *
           wave(nu * (x - 0.5L) + turn * (long double)(j % SAMPLES) / SAMPLES);
  }
  ck_assert_int_eq(dvi__quadrature_long(DVI_GAUSS, DVI_QUADRATURE_MAX, at, by), DVI_OK);
  for (int g = 0; g < DVI_QUADRATURE_MAX; g++)
    sum -= by[g] * amplitude(at[g]) * wave(nu * (at[g] - 0.5L));
  ck_assert_double_le((double)fabsl(sum), 1000 * (double)long_roundoff());
}
END_TEST

START_TEST(without_a_frequency_it_is_lobattos_rule_on_the_path)
{
  long double node[NODES], weight[NODES * SAMPLES], at[NODES], by[NODES];
  dvi__filon_rule(NODES, 2, 0, node, weight);
  ck_assert_int_eq(dvi__quadrature_long(DVI_LOBATTO, NODES, at, by), DVI_OK);
  for (int j = 0; j < NODES; j++)
    for (int m = 0; m < SAMPLES; m++)
      ck_assert_double_le((double)fabsl(weight[j * SAMPLES + m] - (m == 0 ? by[j] : 0)),
                          10 * (double)long_roundoff());
}
END_TEST

SUITE(filon)
{
  tcase_add_loop_test(tests,
                      moments_of_the_lagrange_polynomials_are_right_to_roundoff_at_every_frequency,
                      0, sizeof phases / sizeof *phases);
  tcase_add_test(tests,
                 moments_add_up_to_the_integral_of_the_wave_at_frequencies_that_no_grid_resolves);
  tcase_add_loop_test(tests,
                      the_rule_is_exact_for_two_harmonics_whose_amplitude_the_nodes_interpolate, 0,
                      sizeof phases / sizeof *phases);
  tcase_add_test(tests, without_a_frequency_it_is_lobattos_rule_on_the_path);
}
