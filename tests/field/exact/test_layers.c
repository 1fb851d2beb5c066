/* labels: judge */
/* Frequencies of layers, as a judge of fields. */
#include <math.h>

#include "support/suite.h"
#include "support/waves/layers.h"

static const double pi = 3.14159265358979323846;

/* n = 2 and 1, with the border in the middle. n_1 cot(n_1 w/2) + n_2 cot(n_2 w/2) = 0
 * is the same condition. */
START_TEST(two_layers_have_the_roots_of_their_equation)
{
  const layer half[] = {{0.5, 4, 1, 0}, {0.5, 1, 1, 0}};
  double w[5];
  layers_frequencies(2, half, LAYER_CONDUCTOR, 5, w);
  ck_assert_double_eq_tol(w[0], 1.910633236249, 5e-13);
  ck_assert_double_eq_tol(w[1], 4.372552070931, 5e-13);
  for (int i = 0; i < 5; i++)
    ck_assert_double_eq_tol(2 * cos(w[i]) * sin(w[i] / 2) + cos(w[i] / 2) * sin(w[i]), 0, 1e-14);
}
END_TEST

/* E and H = E'/(i w mu) are continuous: with the admittance n/mu of each layer,
 * sin_1 cos_2/Y_1 + cos_1 sin_2/Y_2 = 0 between conductors, and cos_1 cos_2 - (Y_2/Y_1) sin_1 sin_2
 * = 0 before a magnetic wall. */
START_TEST(magnetic_layers_have_the_roots_of_their_equation)
{
  const layer two[] = {{0.3, 2, 3, 0}, {0.9, 1.5, 1, 0}};
  const double n = sqrt(6), m = sqrt(1.5), Y = n / 3, Z = m;
  double w[4];
  for (int end = 0; end < 2; end++) {
    layers_frequencies(2, two, end == 0 ? LAYER_CONDUCTOR : LAYER_MAGNETIC_WALL, 4, w);
    for (int i = 0; i < 4; i++) {
      const double a = n * w[i] * 0.3, b = m * w[i] * 0.9;
      const double defect = end == 0 ? sin(a) * cos(b) / Y + cos(a) * sin(b) / Z
                                     : cos(a) * cos(b) - Z / Y * sin(a) * sin(b);
      ck_assert_double_eq_tol(defect, 0, 1e-14);
    }
  }
}
END_TEST

/* Cutting a layer in two changes nothing. Both ways to a root agree. */
START_TEST(layers_may_be_cut)
{
  const layer whole[] = {{0.3, 2, 3, 0}, {0.9, 1.5, 1, 0}},
              cut[] = {{0.1, 2, 3, 0}, {0.2, 2, 3, 0}, {0.4, 1.5, 1, 0}, {0.5, 1.5, 1, 0}};
  double w[3], v[3];
  layers_frequencies(2, whole, LAYER_MAGNETIC_WALL, 3, w);
  layers_frequencies(4, cut, LAYER_MAGNETIC_WALL, 3, v);
  for (int i = 0; i < 3; i++) {
    double frequency, decay;
    ck_assert_double_eq_tol(w[i], v[i], 1e-15 * w[i]);
    ck_assert(layers_mode(2, whole, LAYER_MAGNETIC_WALL, w[i] + 0.01, &frequency, &decay));
    ck_assert_double_eq_tol(frequency, w[i], 1e-15 * w[i]);
    ck_assert_double_eq_tol(decay, 0, 1e-18);
  }
}
END_TEST

/* Between conductors and magnetic walls, c = 1/sqrt(eps mu). */
START_TEST(one_layer_has_half_waves_or_quarter_waves)
{
  const layer one = {0.7, 2, 3, 0};
  double w[4];
  for (int end = 0; end < 2; end++) {
    layers_frequencies(1, &one, end == 0 ? LAYER_CONDUCTOR : LAYER_MAGNETIC_WALL, 4, w);
    for (int m = 1; m <= 4; m++)
      ck_assert_double_eq_tol(w[m - 1], (m - 0.5 * end) * pi / 0.7 / sqrt(6), 2e-15 * w[m - 1]);
  }
}
END_TEST

/* eps w^2 + i sigma w = k^2: the decay is sigma/(2 eps), Q = w eps/sigma. */
START_TEST(a_conducting_layer_loses_half_of_sigma_over_eps)
{
  const layer one = {1, 2, 1, 0.3};
  double frequency, decay;
  ck_assert(layers_mode(1, &one, LAYER_CONDUCTOR, 2.2, &frequency, &decay));
  ck_assert_double_eq_tol(decay, 0.3 / 4, 1e-16);
  ck_assert_double_eq_tol(frequency, sqrt(pi * pi / 2 - 0.3 * 0.3 / 16), 1e-15);
}
END_TEST

/* A layer with an index n > 1 before vacuum: exp(2 i n w d) = -(n + 1)/(n - 1), so that n w d is
 * (m + 1/2) pi - i log((n+1)/(n-1))/2. */
START_TEST(a_layer_leaks_into_vacuum)
{
  for (int m = 0; m < 4; m++) {
    const double n = 3, d = 0.4;
    const layer one = {d, n * n, 1, 0};
    double frequency, decay;
    const double expected = (m + 0.5) * pi / (n * d);
    ck_assert(layers_mode(1, &one, LAYER_VACUUM, expected + 0.1, &frequency, &decay));
    ck_assert_double_eq_tol(frequency, expected, 1e-15 * expected);
    ck_assert_double_eq_tol(decay, log((n + 1) / (n - 1)) / (2 * n * d), 2e-16);
  }
}
END_TEST

SUITE(layers)
{
  tcase_add_test(tests, two_layers_have_the_roots_of_their_equation);
  tcase_add_test(tests, magnetic_layers_have_the_roots_of_their_equation);
  tcase_add_test(tests, layers_may_be_cut);
  tcase_add_test(tests, one_layer_has_half_waves_or_quarter_waves);
  tcase_add_test(tests, a_conducting_layer_loses_half_of_sigma_over_eps);
  tcase_add_test(tests, a_layer_leaks_into_vacuum);
}
