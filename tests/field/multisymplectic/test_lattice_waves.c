/* labels: unit slow */
/* Known waves: the dispersion of plane ones, exact steps, breathers and kinks, orders, energies. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdlib.h>

#include "field/multisymplectic/march.h"
#include "support/field/marches.h"
#include "support/suite.h"
#include "support/waves/lattices.h"

static const double pi = 3.14159265358979323846;

static double observe(const dvi_march *march, int i)
{
  double value = (double)NAN;
  ck_assert_int_eq(dvi_march_observe(march, i, &value), DVI_OK);
  return value;
}

/* ---- plane and standing waves ---- */

typedef struct wave {
  int axes, stands;
  double k[3], omega;
} wave;

static double wave_at(double t, const double *x, const void *of)
{
  const wave *p = of;
  double phase = -p->omega * t, product = cos(p->omega * t);
  for (int d = 0; d < p->axes; d++) {
    phase += p->k[d] * x[d];
    product *= sin(p->k[d] * x[d]);
  }
  return p->stands ? product : cos(phase);
}

/* The frequencies are the solutions of s_at(omega dt)/dt^2 = s_ax(k dx)/dx^2, with s_a(th) =
 * 4 sin^2(th/2)/(1 - 4 a sin^2(th/2)), for k = 3 and dx = pi/10. The box scheme needs an odd number
 * of periodic cells, and stands between fixed ends instead. */
static const struct {
  double space, time, ratio, omega;
  int stands;
} waves[] = {{0, 0, .9, 2.977331178366868, 0},
             {1. / 6, 1. / 6, .9, 3.019550053106444, 0},
             {1. / 12, 1. / 12, .9, 2.998217003350727, 0},
             {1. / 4, 1. / 4, 3, 2.103968441015779, 1},
             {1. / 6, 1. / 4, 2, 2.463991275398103, 0},
             {0, 0, .9, 2.977331178366868, 1},
             {1. / 6, 1. / 4, 2, 2.463991275398103, 1}};

enum { WAVES = sizeof waves / sizeof *waves };

static lattice lattice_of_wave(int i)
{
  return (lattice){.space = waves[i].space,
                   .time = waves[i].time,
                   .step = waves[i].ratio * pi / 10,
                   .fixed = waves[i].stands,
                   .mean_rate = 1};
}

/* The largest rest of the discrete Euler-Lagrange equations of three levels, beside the largest sum
 * of sizes of their terms, 4 |u| (dx/dt + dt/dx). */
static double residual(lattice *w, const wave *of)
{
  dvi__lattice_march m = {0};
  double largest = 0;
  ck_assert_int_eq(dvi__lattice_march_make(lattice_terms(w), &m), DVI_OK);
  double *const level[3] = {m.before, m.now, m.next}, *unused = m.level;
  for (int k = 0; k < 3; k++)
    for (int64_t i = 0; i < m.lattice.vertices; i++) {
      double x[3];
      dvi__lattice_vertex(&m.lattice, i, x);
      level[k][i] = wave_at((k - 1) * m.lattice.dt, x, of);
    }
  const dvi__row row[2] = {{.t = -m.lattice.dt, .u = {m.before, m.now}}, {.u = {m.now, m.next}}};
  ck_assert_int_eq(dvi__row_gradient(&m.lattice, &row[0], unused, m.p_now), DVI_OK);
  ck_assert_int_eq(dvi__row_gradient(&m.lattice, &row[1], m.lower, unused), DVI_OK);
  for (int64_t i = 0; i < m.lattice.vertices; i++)
    if (m.lattice.unknown[i] >= 0) largest = fmax(largest, fabs(m.p_now[i] + m.lower[i]));
  const double ratio = m.lattice.dt / (pi / 10), size = 4 * (ratio + 1 / ratio);
  dvi__lattice_march_clear(&m);
  return largest / size;
}

START_TEST(plane_waves_fulfil_the_equations_with_their_frequency)
{
  lattice w = lattice_of_wave(_i);
  const wave of = {1, waves[_i].stands, {3}, waves[_i].omega};
  ck_assert_double_le(residual(&w, &of), 1e-15);
}
END_TEST

/* Roundings of a hundred steps, which are random, beside values of 1. */
START_TEST(plane_waves_go_on_with_their_frequency)
{
  lattice w = lattice_of_wave(_i);
  const wave of = {1, waves[_i].stands, {3}, waves[_i].omega};
  dvi_march *march = lattice_march(&w);
  lattice_start(march, &w, wave_at, &of);
  advance_march(march, 100 * w.step);
  ck_assert_double_lt(lattice_distance(march, &w, wave_at, &of), 1e-12);
  dvi_march_destroy(&march);
}
END_TEST

/* s_a(theta), and its inverse. */
static double symbol(double a, double theta)
{
  const double s = pow(sin(theta / 2), 2);
  return 4 * s / (1 - 4 * a * s);
}

static double angle(double a, double s)
{
  return 2 * asin(sqrt(s / (4 + 4 * a * s)));
}

/* In more dimensions the symbols of the axes add. */
START_TEST(waves_on_more_axes_have_the_sum_of_symbols)
{
  static const double weight[][2] = {
      {0, 0}, {1. / 6, 1. / 6}, {1. / 12, 1. / 12}, {1. / 6, 1. / 4}};
  const double dx = 2 * pi / 12, dt = 0.5 * dx, space = weight[_i / 2][0], time = weight[_i / 2][1];
  lattice w = {
      .axes = 2 + _i % 2, .cells = 12, .space = space, .time = time, .step = dt, .mean_rate = 1};
  wave of = {w.axes, 0, {2, 1, 3}, 0};
  double s = 0;
  for (int d = 0; d < w.axes; d++) s += symbol(space, of.k[d] * dx) / (dx * dx);
  of.omega = angle(time, s * dt * dt) / dt;
  dvi_march *march = lattice_march(&w);
  lattice_start(march, &w, wave_at, &of);
  advance_march(march, 20 * dt);
  ck_assert_double_lt(lattice_distance(march, &w, wave_at, &of), 1e-13);
  dvi_march_destroy(&march);
}
END_TEST

/* 26^3 unknowns are solved for by conjugate gradients, which leave a part of 1e-15 of each right
 * side, and some digits of theirs. */
START_TEST(large_matrices_in_space_are_solved_with_by_iteration)
{
  const double dx = 2 * pi / 26, dt = dx;
  lattice w = {.axes = 3, .cells = 26, .space = 1. / 6, .time = .25, .step = dt, .mean_rate = 1};
  wave of = {3, 0, {2, 1, 3}, 0};
  double s = 0;
  for (int d = 0; d < 3; d++) s += symbol(w.space, of.k[d] * dx) / (dx * dx);
  of.omega = angle(w.time, s * dt * dt) / dt;
  dvi_march *march = lattice_march(&w);
  lattice_start(march, &w, wave_at, &of);
  advance_march(march, 3 * dt);
  ck_assert_double_lt(lattice_distance(march, &w, wave_at, &of), 1e-12);
  dvi_march_destroy(&march);
}
END_TEST

/* ---- orders ---- */

static double right_wave(double t, const double *x, const void *of)
{
  (void)of;
  return exp(sin(x[0] - t));
}

/* Equal weights at dt = dx move any wave by one cell a step. */
START_TEST(waves_are_exact_where_the_step_is_a_cell)
{
  static const double weight[] = {0, 1. / 6, 1. / 12};
  lattice w = {
      .cells = 40, .space = weight[_i], .time = weight[_i], .step = 2 * pi / 40, .mean_rate = 1};
  dvi_march *march = lattice_march(&w);
  lattice_start(march, &w, right_wave, NULL);
  advance_march(march, 60 * w.step);
  /* at the bound of stability, roundings of the shortest wave grow as the steps */
  ck_assert_double_lt(lattice_distance(march, &w, right_wave, NULL), 1e-11);
  dvi_march_destroy(&march);
}
END_TEST

static double error_of_wave(double space, double time, int cells, int mean_rate)
{
  lattice w = {.cells = cells,
               .space = space,
               .time = time,
               .step = 2 * pi / cells * 0.6,
               .mean_rate = mean_rate};
  dvi_march *march = lattice_march(&w);
  lattice_start(march, &w, right_wave, NULL);
  advance_march(march, 2 * pi);
  const double error = lattice_distance(march, &w, right_wave, NULL);
  dvi_march_destroy(&march);
  return error;
}

/* The period is no whole number of steps. Between levels the parabola has an error of h^3, and so
 * the fourth order is measured at a whole number: 5/3 of a period is. */
static double error_at_level(double space, double time, int cells)
{
  lattice w = {.cells = cells, .space = space, .time = time, .mean_rate = 1};
  w.step = 2 * pi / cells * 0.6;
  dvi_march *march = lattice_march(&w);
  lattice_start(march, &w, right_wave, NULL);
  advance_march(march, cells * w.step);
  const double error = lattice_distance(march, &w, right_wave, NULL);
  dvi_march_destroy(&march);
  return error;
}

START_TEST(weights_have_order_two_and_a_twelfth_has_order_four)
{
  static const double weight[][3] = {
      {0, 0, 2}, {1. / 6, 1. / 6, 2}, {1. / 6, 1. / 4, 2}, {1. / 12, 1. / 12, 4}};
  double before = 0;
  for (int cells = 40; cells <= 320; cells *= 2) {
    const double error = error_at_level(weight[_i][0], weight[_i][1], cells);
    if (cells > 80) ck_assert_double_eq_tol(log2(before / error), weight[_i][2], 0.1);
    before = error;
  }
}
END_TEST

START_TEST(starts_with_a_rate_and_samples_between_levels_have_order_two)
{
  double before = 0;
  for (int cells = 40; cells <= 320; cells *= 2) {
    const double error = error_of_wave(1. / 6, 1. / 6, cells, 0);
    if (cells > 80) ck_assert_double_eq_tol(log2(before / error), 2, 0.1);
    before = error;
  }
}
END_TEST

/* ---- nonlinear waves ---- */

static double breather(double t, const double *x, const void *of)
{
  const double w = 0.5, g = sqrt(1 - w * w);
  (void)of;
  return 4 * atan(g / w * sin(w * t) / cosh(g * x[0]));
}

/* From levels that are exact, with 4/dt = round(8/dx) steps. The numbers are those of a program in
 * numpy. The trapezoidal rule is explicit and Gauss's is implicit. */
START_TEST(breathers_have_known_errors)
{
  static const struct {
    double weight;
    int cells;
    double error;
  } known[] = {{0, 101, 5.55e-2},   {0, 201, 1.43e-2},      {0, 401, 3.59e-3},
               {1. / 6, 101, .127}, {1. / 6, 201, 3.14e-2}, {1. / 6, 401, 7.86e-3}};
  lattice w = {.cells = known[_i / 2].cells,
               .from = -20,
               .to = 20,
               .space = known[_i / 2].weight,
               .time = known[_i / 2].weight,
               .V = "sine",
               .in_one = _i % 2,
               .mean_rate = 1};
  w.step = 4 / round(8 / (40.0 / w.cells));
  dvi_march *march = lattice_march(&w);
  lattice_start(march, &w, breather, NULL);
  advance_march(march, 4);
  ck_assert_double_eq_tol(lattice_distance(march, &w, breather, NULL), known[_i / 2].error,
                          0.005 * known[_i / 2].error);
  dvi_march_destroy(&march);
}
END_TEST

static double dimpled(double t, const double *x, const void *of)
{
  (void)of;
  return 1 + .5 * cos(x[0]) * cos(x[1]) + t * .3 * sin(x[0] + x[1]);
}

/* u(3, 0, 0) of sine-Gordon on a torus is known from a spectral solution. Errors of symmetric steps
 * are series in h^2, of which two extrapolations leave the sixth order. */
START_TEST(sine_gordon_on_a_torus_has_its_known_value)
{
  static const double weight[][2] = {{0, 0}, {1. / 6, 1. / 6}, {1. / 6, 1. / 4}};
  const double exact = -.80444209124;
  double found[3];
  for (int k = 0; k < 3; k++) {
    lattice w = {.axes = 2,
                 .cells = 20 << k,
                 .space = weight[_i][0],
                 .time = weight[_i][1],
                 .levels = _i == 2,
                 .V = "sine",
                 .step = 3.0 / (20 << k)};
    const int origin = 0;
    dvi_march *march = lattice_march(&w);
    lattice_start(march, &w, dimpled, NULL);
    advance_march(march, 3);
    ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_A, 1, &origin, &found[k]), DVI_OK);
    dvi_march_destroy(&march);
  }
  ck_assert_double_eq_tol((found[1] - exact) / (found[2] - exact), 4, 0.1);
  const double coarse = (4 * found[1] - found[0]) / 3, fine = (4 * found[2] - found[1]) / 3;
  ck_assert_double_eq_tol((16 * fine - coarse) / 15, exact, 1e-7);
}
END_TEST

static double kink(double t, const double *x, const void *of)
{
  const double v = .5, g = 1 / sqrt(1 - v * v);
  (void)of;
  return tanh(g * (x[0] - v * t) / sqrt(2));
}

/* phi^4: a kink with the speed 1/2 has the energy 2 sqrt2 gamma/3, with an error of order 2. It is
 * free at both ends. */
START_TEST(kinks_have_their_energy)
{
  const double exact = 2 * sqrt(2) / 3 / sqrt(.75);
  double before = 0;
  for (int cells = 200; cells <= 800; cells *= 2) {
    lattice w = {.cells = cells, .from = -20, .to = 20, .V = "quartic"};
    lattice_terms(&w);
    w.axis[0].periodic = 0;
    w.terms.step = .5 * 40 / cells;
    w.terms.weights.space[0] = w.terms.weights.time = _i == 0 ? 0 : 1. / 6;
    dvi_march *march = NULL;
    ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
    lattice_start(march, &w, kink, NULL);
    advance_march(march, 5);
    const double error = fabs(observe(march, 0) - exact);
    if (before > 0) ck_assert_double_eq_tol(log2(before / error), 2, 0.1);
    ck_assert_double_lt(error, 30.0 / cells / cells * 4);
    before = error;
    dvi_march_destroy(&march);
  }
}
END_TEST

SUITE(lattice_waves)
{
  tcase_add_loop_test(tests, plane_waves_fulfil_the_equations_with_their_frequency, 0, WAVES);
  tcase_add_loop_test(tests, plane_waves_go_on_with_their_frequency, 0, WAVES);
  tcase_add_loop_test(tests, waves_on_more_axes_have_the_sum_of_symbols, 0, 8);
  tcase_add_test(tests, large_matrices_in_space_are_solved_with_by_iteration);
  tcase_add_loop_test(tests, waves_are_exact_where_the_step_is_a_cell, 0, 3);
  tcase_add_loop_test(tests, weights_have_order_two_and_a_twelfth_has_order_four, 0, 4);
  tcase_add_test(tests, starts_with_a_rate_and_samples_between_levels_have_order_two);
  tcase_add_loop_test(tests, breathers_have_known_errors, 0, 12);
  tcase_add_loop_test(tests, sine_gordon_on_a_torus_has_its_known_value, 0, 3);
  tcase_add_loop_test(tests, kinks_have_their_energy, 0, 2);
}
