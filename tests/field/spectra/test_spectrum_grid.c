/* Spectral lines of series that finite differences have made, whose frequencies are known. */
#include <dvi/spectrum.h>
#include <math.h>
#include <stdlib.h>

#include "support/waves/boxes.h"
#include "support/suite.h"
#include "support/waves/grid_waves.h"

enum { SAMPLES = 600, CELLS = 60, MOST = 64, LINE = 21 };

static const int cells[3] = {5, 4, 3};
static const double side[3] = {1, 0.8, 0.6};

static double bound(void)
{
  double sum = 0;
  for (int i = 0; i < 3; i++) sum += pow(cells[i] / side[i], 2);
  return 1 / sqrt(sum);
}

/* Add dt^2 times the discrete Laplacian of u, with closed walls, to `rate`. */
static void kick(const double *u, double dt, double *rate)
{
  const int step[3] = {1, cells[0], cells[0] * cells[1]};
  for (int v = 0; v < CELLS; v++)
    for (int i = 0; i < 3; i++) {
      const double factor = pow(dt * cells[i] / side[i], 2);
      if (v / step[i] % cells[i] == cells[i] - 1) continue;
      const double flux = factor * (u[v + step[i]] - u[v]);
      rate[v] += flux;
      rate[v + step[i]] -= flux;
    }
}

/* A scalar wave in the cells of a closed box has all frequencies of Yee's grid, and one that is
 * zero. The start is at rest, so that the first kick is half of one. */
static void run_box(double dt, double *y)
{
  double u[CELLS], rate[CELLS] = {0};
  for (int v = 0; v < CELLS; v++) u[v] = sin(1 + 37.0 * v * v);
  kick(u, dt, rate);
  for (int v = 0; v < CELLS; v++) rate[v] /= 2;
  for (int n = 0; n < SAMPLES; n++) {
    y[n] = u[0];
    for (int v = 0; v < CELLS; v++) u[v] += rate[v];
    kick(u, dt, rate);
  }
}

static int compare_numbers(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Set the frequencies of the box, ascending, of modes with at least so many numbers of half waves
 * that are not zero. Some share one, as (4,0,0) and (3,0,1) do. */
static int list_frequencies(double dt, int least, double *frequency)
{
  int modes = 0, count = 0;
  for (int v = 0; v < CELLS; v++) {
    const int half_waves[3] = {v % 5, v / 5 % 4, v / 20};
    if ((half_waves[0] != 0) + (half_waves[1] != 0) + (half_waves[2] != 0) >= least)
      frequency[modes++] = grid_box_frequency(3, side, cells, dt, half_waves);
  }
  qsort(frequency, (size_t)modes, sizeof *frequency, compare_numbers);
  for (int v = 0; v < modes; v++)
    if (count == 0 || frequency[v] - frequency[count - 1] > 1e-9) frequency[count++] = frequency[v];
  return count;
}

/* All lines of 600 samples. The goal is 5e-13. Roundoff of 600 steps is about 1e-14 of u. */
START_TEST(all_frequencies_of_a_box_are_found_from_600_samples)
{
  const double dt = 0.9 * bound();
  double y[SAMPLES], expected[CELLS];
  dvi_spectral_line line[MOST];
  int count = 0;
  const int lines = list_frequencies(dt, 0, expected);
  ck_assert_int_eq(lines, 45);
  run_box(dt, y);
  ck_assert_msg(dvi_spectrum(SAMPLES, 1, y, dt, NULL, MOST, &count, line, NULL, NULL, NULL) ==
                    DVI_OK,
                "%s", dvi_last_error());
  ck_assert_int_eq(count, lines);
  for (int k = 0; k < lines; k++) {
    ck_assert_double_eq_tol(line[k].frequency, expected[k], 5e-13);
    ck_assert_double_eq_tol(line[k].decay, 0, 5e-13);
  }
}
END_TEST

/* Probes of all components see all modes of the box, and a field that stands, that of the charges
 * of the start. */
static void run_yee(double dt, double *y)
{
  const dvi_yee_probe probe[] = {
      {.name = "x", .form = DVI_FORM_E, .at = {0.13, 0.07, 0.11}, .along = {1, 0, 0}},
      {.name = "y", .form = DVI_FORM_E, .at = {0.13, 0.07, 0.11}, .along = {0, 1, 0}},
      {.name = "z", .form = DVI_FORM_E, .at = {0.13, 0.07, 0.11}, .along = {0, 0, 1}}};
  dvi_yee_terms terms = {
      .size = sizeof terms, .axes = 3, .degree = 1, .step = dt, .probe = probe, .probes = 3};
  for (int i = 0; i < 3; i++) terms.axis[i] = (dvi_yee_axis){.cells = cells[i], .upper = side[i]};
  dvi_march *march = box_march(&terms);
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 7);
  start_boxes(march, E, NULL);
  for (int n = 0; n < SAMPLES; n++) {
    advance_march(march, n * dt);
    y[n] = observe_march(march, "x");
    y[SAMPLES + n] = observe_march(march, "y");
    y[2 * SAMPLES + n] = observe_march(march, "z");
  }
  dvi_march_destroy(&march);
  free(E);
}

START_TEST(all_frequencies_of_yee_are_found_from_600_samples)
{
  const double dt = 0.9 * bound();
  double y[3 * SAMPLES], expected[CELLS];
  dvi_spectral_line line[MOST];
  int count = 0;
  const int lines = list_frequencies(dt, 2, expected);
  run_yee(dt, y);
  ck_assert_msg(dvi_spectrum(SAMPLES, 3, y, dt, NULL, MOST, &count, line, NULL, NULL, NULL) ==
                    DVI_OK,
                "%s", dvi_last_error());
  ck_assert_int_eq(count, lines + 1);
  ck_assert_double_eq(line[0].frequency, 0);
  for (int k = 0; k < lines; k++) {
    ck_assert_double_eq_tol(line[k + 1].frequency, expected[k], 5e-13);
    ck_assert_double_eq_tol(line[k + 1].decay, 0, 5e-13);
  }
}
END_TEST

/* The lowest frequencies which Yee's loops have given. */
START_TEST(a_band_holds_the_lowest_frequencies_of_a_box)
{
  const double known[] = {4.973909883247, 5.973299740175, 6.414511709401}, dt = 0.9 * bound();
  const dvi_spectrum_options band = {.size = sizeof band, .lowest = 4.9, .highest = 6.5};
  double y[SAMPLES];
  dvi_spectral_line line[MOST];
  int count = 0, next = 0;
  run_box(dt, y);
  ck_assert_int_eq(dvi_spectrum(SAMPLES, 1, y, dt, &band, MOST, &count, line, NULL, NULL, NULL),
                   DVI_OK);
  for (int k = 0; k < count && next < 3; k++)
    if (fabs(line[k].frequency - known[next]) < 1e-12) next++;
  ck_assert_int_eq(next, 3);
}
END_TEST

/* A conducting line of 20 cells, whose first mode goes as exp(-0.35 t). A start in
 * that mode has one line. */
START_TEST(the_decay_of_a_conducting_line_is_found)
{
  enum { FEW = 100 };
  const double pi = 3.14159265358979323846, h = 0.05, dt = 0.8 * h, s = 0.7 * dt / 2;
  double E[LINE] = {0}, B[LINE] = {0}, y[FEW], frequency, decay;
  dvi_spectral_line line[MOST];
  int count = 0;
  for (int i = 1; i < LINE - 1; i++) E[i] = sin(pi * i * h);
  for (int n = 0; n < FEW; n++) {
    y[n] = E[7];
    for (int i = 0; i < LINE - 1; i++) B[i] += dt / h * (E[i + 1] - E[i]);
    for (int i = 1; i < LINE - 1; i++)
      E[i] = ((1 - s) * E[i] + dt / h * (B[i] - B[i - 1])) / (1 + s);
  }
  grid_lossy_mode(grid_frequency(1, &h, dt, &pi), dt, 0.7, &frequency, &decay);
  ck_assert_int_eq(dvi_spectrum(FEW, 1, y, dt, NULL, MOST, &count, line, NULL, NULL, NULL), DVI_OK);
  ck_assert_int_eq(count, 1);
  ck_assert_double_eq_tol(line[0].frequency, frequency, 1e-12);
  ck_assert_double_eq_tol(line[0].decay, decay, 1e-12);
  ck_assert_double_eq_tol(line[0].frequency, 3.120964341326, 1e-12);
  ck_assert_double_eq_tol(line[0].decay, 0.350022869356, 1e-12);
  ck_assert_double_eq_tol(line[0].quality, frequency / (2 * decay), 1e-10);
}
END_TEST

SUITE(spectrum_grid)
{
  tcase_add_test(tests, all_frequencies_of_a_box_are_found_from_600_samples);
  tcase_add_test(tests, all_frequencies_of_yee_are_found_from_600_samples);
  tcase_add_test(tests, a_band_holds_the_lowest_frequencies_of_a_box);
  tcase_add_test(tests, the_decay_of_a_conducting_line_is_found);
}
