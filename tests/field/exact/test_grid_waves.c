/* labels: judge */
/* What Yee's grid does exactly, as a judge of its steps: against digits of plain
 * loops, limits, and runs. */
#include <dvi/spectrum.h>
#include <math.h>

#include "support/suite.h"
#include "support/waves/grid_waves.h"

static const double pi = 3.14159265358979323846;

START_TEST(a_box_has_the_frequencies_of_plain_loops)
{
  const double side[3] = {1, 0.8, 0.6}, known[] = {4.973909883247, 5.973299740175, 6.414511709401};
  const int cells[3] = {5, 4, 3}, half_waves[][3] = {{1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
  const double dt = 0.9 * 0.2 / sqrt(3);
  for (int i = 0; i < 3; i++)
    ck_assert_double_eq_tol(grid_box_frequency(3, side, cells, dt, half_waves[i]), known[i], 1e-12);
}
END_TEST

START_TEST(a_square_has_the_frequency_of_plain_loops)
{
  const double side[2] = {1, 1};
  const int cells[2] = {10, 10}, half_waves[2] = {1, 0};
  ck_assert_double_eq_tol(grid_box_frequency(2, side, cells, 0.05 / sqrt(2), half_waves),
                          3.130286593782, 1e-12);
}
END_TEST

/* Along an axis, at dt = h, the grid makes no error. */
START_TEST(the_magic_step_is_exact)
{
  for (double k = 0.1; k < 3; k += 0.3) {
    const double h = 1;
    double growth;
    ck_assert_double_eq_tol(grid_frequency(1, &h, 1, &k), k, 1e-15 * k);
    ck_assert_double_lt(grid_mur_reflection(k, 0, 1, 1, &growth), 1e-30);
  }
}
END_TEST

/* Errors fall as h^2: w = k (1 - (1 - dt^2/h^2) (k h)^2/24 ..). */
START_TEST(the_error_of_the_grid_has_order_two)
{
  const double k = 1;
  for (double h = 0.1; h > 1e-3; h /= 2) {
    const double error = grid_frequency(1, &h, h / 2, &k) - k;
    ck_assert_double_eq_tol(error / (h * h), -0.75 / 24, 0.02 * h);
  }
}
END_TEST

START_TEST(a_lossy_line_has_the_numbers_of_plain_loops)
{
  const double h = 0.05, dt = 0.8 * h;
  double frequency, decay;
  grid_lossy_mode(grid_frequency(1, &h, dt, &pi), dt, 0.7, &frequency, &decay);
  ck_assert_double_eq_tol(frequency, 3.120964341326, 1e-12);
  ck_assert_double_eq_tol(decay, 0.350022869356, 1e-12);
  grid_lossy_mode(2, dt, 0, &frequency, &decay);
  ck_assert_double_eq_tol(frequency, 2, 1e-15);
  ck_assert_double_eq_tol(decay, 0, 1e-30);
}
END_TEST

START_TEST(mur_reflects_what_plain_loops_show)
{
  double growth;
  ck_assert_double_eq_tol(grid_mur_reflection(5, 0, 0.05, 0.025, &growth), 2.954717e-3, 5e-10);
  ck_assert_double_eq_tol(growth, 1, 1e-30);
}
END_TEST

/* Between Mur's boundary at j = 0 and a conductor at j = N a mode is q^j + R q^-j, so that
 * |R| = |q|^2N. The modes of a run have it, whose frequencies and decay rates a series tells. */
START_TEST(modes_of_a_line_with_mur_have_its_reflection)
{
  enum { CELLS = 20, SAMPLES = 256, MOST = 64 };
  const double h = 0.05, dt = 0.025, b = (dt - h) / (dt + h);
  double E[CELLS + 1] = {0}, B[CELLS] = {0}, y[SAMPLES];
  dvi_spectral_line line[MOST];
  int count = 0;
  for (int j = 1; j < CELLS; j++) E[j] = exp(-pow((j - 7) / 2.0, 2));
  for (int n = 0; n < SAMPLES; n++) {
    const double outer = E[0], inner = E[1];
    y[n] = E[8];
    for (int j = 0; j < CELLS; j++) B[j] += dt / h * (E[j + 1] - E[j]);
    for (int j = 1; j < CELLS; j++) E[j] += dt / h * (B[j] - B[j - 1]);
    E[0] = inner + b * (E[1] - outer);
  }
  ck_assert_int_eq(dvi_spectrum(SAMPLES, 1, y, dt, NULL, MOST, &count, line, NULL, NULL, NULL),
                   DVI_OK);
  int seen = 0;
  for (int k = 0; k < count; k++) {
    double growth;
    const double w = line[k].frequency, R = grid_mur_reflection(w, line[k].decay, h, dt, &growth);
    if (w == 0 || line[k].error > 1e-9) continue;
    /* log |R| changes by 2 N h, less than 10, times an error of the decay */
    ck_assert_double_eq_tol(log(R), 2 * CELLS * log(growth), 1e-7);
    seen++;
  }
  ck_assert_int_ge(seen, 5);
}
END_TEST

SUITE(grid_waves)
{
  tcase_add_test(tests, a_box_has_the_frequencies_of_plain_loops);
  tcase_add_test(tests, a_square_has_the_frequency_of_plain_loops);
  tcase_add_test(tests, the_magic_step_is_exact);
  tcase_add_test(tests, the_error_of_the_grid_has_order_two);
  tcase_add_test(tests, a_lossy_line_has_the_numbers_of_plain_loops);
  tcase_add_test(tests, mur_reflects_what_plain_loops_show);
  tcase_add_test(tests, modes_of_a_line_with_mur_have_its_reflection);
}
