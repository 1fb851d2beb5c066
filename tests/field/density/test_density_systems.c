/* Fields with densities as systems: callbacks, matrices, energies, and values that are fixed. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/field/densities.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

static const char *const kinds[] = {"fem:degree=1,cells=9",
                                    "fem:degree=2,cells=7",
                                    "fem:degree=3,cells=5",
                                    "fem:degree=4,cells=4",
                                    "fem:degree=1,cells=9,lumped=yes",
                                    "fem:degree=2,cells=7,lumped=yes",
                                    "fem:degree=3,cells=5,lumped=yes",
                                    "spline:degree=2,cells=9",
                                    "spline:degree=3,cells=9",
                                    "legendre:degree=8",
                                    "chebyshev:degree=8"};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* The check compares gradients, Hessians, patterns, ranges and rates with differences. */
START_TEST(callbacks_agree_with_differences_on_intervals)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, klein_gordon_part, sine_gordon_part,
                                    double_well_part};
  for (int i = 0; i < KINDS; i++) {
    density_field field = make_density(make_density_space(kinds[i], 1, -1, 2, 0), parts, 5, NULL,
                                       0);
    check_density(&field, 1e-6);
    end_density(&field);
  }
}
END_TEST

START_TEST(callbacks_agree_with_differences_on_circles)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, sine_gordon_part};
  for (int i = 0; i < KINDS - 2; i++) {
    density_field field = make_density(make_density_space(kinds[i], 1, 0, 2 * pi, 1), parts, 3,
                                       NULL, 0);
    check_density(&field, 1e-6);
    end_density(&field);
  }
}
END_TEST

static int saddle(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)user;
  for (int64_t k = 0; k < count; k++) datum[k] = x[k] * x[k] - x[count + k] * x[count + k];
  return 0;
}

START_TEST(callbacks_agree_with_differences_on_squares)
{
  static const char *const squares[] = {"fem:degree=1,cells=3", "fem:degree=2,cells=2",
                                        "fem:degree=2,cells=2,lumped=yes",
                                        "spline:degree=2,cells=3"};
  const dvi_density_part parts[] = {kinetic_part, elastic_part_2d, sine_gordon_part};
  const dvi_density_condition left = {.part = "left", .kind = DVI_FIXED, .datum = saddle};
  for (int i = 0; i < 4; i++) {
    density_field field = make_density(make_density_space(squares[i], 2, 0, 1, 0), parts, 3, &left,
                                       1);
    check_density(&field, 1e-6);
    end_density(&field);
  }
}
END_TEST

/* lambda_max h^2 of u'' on a circle, by the symbols of elements (computed by numpy). */
START_TEST(fastest_frequency_is_that_of_the_elements)
{
  static const struct {
    const char *kind;
    double lambda;
  } cases[] = {{"fem:degree=1,cells=32", 12},
               {"fem:degree=2,cells=32", 60},
               {"fem:degree=3,cells=32", 170.1249025},
               {"fem:degree=4,cells=32", 380.2351315},
               {"fem:degree=1,cells=32,lumped=yes", 4},
               {"fem:degree=2,cells=32,lumped=yes", 24},
               {"fem:degree=3,cells=32,lumped=yes", 74.3109888},
               {"spline:degree=2,cells=32", 10},
               {"spline:degree=3,cells=32", 9.88235294}};
  const dvi_density_part parts[] = {kinetic_part, elastic_part};
  for (int i = 0; i < 9; i++) {
    density_field field = make_density(make_density_space(cases[i].kind, 1, 0, 32, 1), parts, 2,
                                       NULL, 0);
    double omega;
    ck_assert_int_eq(dvi_density_fastest(field.density, &omega), DVI_OK);
    const double excess = omega * omega / cases[i].lambda - 1;
    ck_assert_msg(excess > -1e-9 && excess < 2.1e-3, "%s: %.10g", cases[i].kind, omega * omega);
    end_density(&field);
  }
}
END_TEST

/* V'' = 3 u^2 - 1 of the double well is 11 at u = 2, -1 at u = 0, and adds to the 4 of elements of
 * length 1. */
START_TEST(fastest_frequency_at_a_state_has_all_potentials)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, double_well_part};
  const char *const kind = "fem:degree=1,cells=32,lumped=yes";
  density_field field = make_density(make_density_space(kind, 1, 0, 32, 1), parts, 3, NULL, 0);
  for (int u = 0; u <= 2; u += 2) {
    const double square = 4 + 3 * u * u - 1;
    double q[32], omega;
    for (int i = 0; i < 32; i++) q[i] = u;
    ck_assert_int_eq(dvi_density_fastest_at(field.density, q, &omega), DVI_OK);
    ck_assert(omega * omega > square - 1e-9 && omega * omega < square * 1.0022);
  }
  end_density(&field);
}
END_TEST

/* One Fourier series of quadratic energies: u = cos x, u_t = sin x on a circle has the energy
 * pi (1 + 1)/2, which elements of degree 4 have to 1e-7. */
static int cosine(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = cos(x[k]);
  return 0;
}

static int sine(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = sin(x[k]);
  return 0;
}

START_TEST(energy_is_that_of_the_continuum)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, double_well_part};
  density_field field = make_density(make_density_space("fem:degree=4,cells=16", 1, 0, 2 * pi, 1),
                                     parts, 3, NULL, 0);
  double energy;
  set_density(&field, cosine, sine, NULL);
  ck_assert_int_eq(dvi_system_invariants(field.system, 0, field.q, field.p, &energy), DVI_OK);
  /* the integral of (cos^2 x - 1)^2/4 = sin^4 x/4 is 3 pi/16 */
  ck_assert_double_eq_tol(energy, pi + 3 * pi / 16, 1e-7);
  end_density(&field);
}
END_TEST

/* ---- the boundary ---- */

static int line(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)user;
  for (int64_t k = 0; k < count; k++) datum[k] = 2 * x[k] + 1;
  return 0;
}

/* u'' = 0 with fixed ends is a line, in every space. */
START_TEST(fixed_ends_hold_a_line)
{
  const dvi_density_condition ends = {.part = "boundary", .kind = DVI_FIXED, .datum = line};
  for (int i = 0; i < KINDS; i++) {
    density_field field = make_density(make_density_space(kinds[i], 1, -1, 2, 0), &elastic_part, 1,
                                       &ends, 1);
    ck_assert_msg(dvi_density_solve(field.density, field.U, NULL) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_eq(dvi_density_project(field.density, field.U, NULL, field.q, NULL, NULL),
                     DVI_OK);
    for (int k = 0; k <= 12; k++) {
      const double x = -1 + 0.25 * k;
      ck_assert_double_eq_tol(density_at(&field, 0, &x), 2 * x + 1, 1e-12);
    }
    end_density(&field);
  }
}
END_TEST

/* x^2 - y^2 is harmonic, and in the space of degree 2. */
START_TEST(fixed_sides_hold_a_saddle)
{
  static const char *const squares[] = {"fem:degree=2,cells=3", "spline:degree=2,cells=3"};
  const dvi_density_condition sides = {.part = "boundary", .kind = DVI_FIXED, .datum = saddle};
  for (int i = 0; i < 2; i++) {
    density_field field = make_density(make_density_space(squares[i], 2, -1, 1, 0),
                                       &elastic_part_2d, 1, &sides, 1);
    dvi_field_solve_report report;
    ck_assert_msg(dvi_density_solve(field.density, field.U, &report) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_le(report.iterations, 3);
    ck_assert_int_eq(dvi_density_project(field.density, field.U, NULL, field.q, NULL, NULL),
                     DVI_OK);
    const double x[2] = {0.3, -0.8};
    ck_assert_double_eq_tol(density_at(&field, 0, x), 0.09 - 0.64, 1e-12);
    end_density(&field);
  }
}
END_TEST

/* u'' = 0, u(-1) = -1, u'(2) + a u(2) = g: u = -1 + s (x + 1) with s = (g + a)/(1 + 3 a). */
static int flux(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)user;
  for (int64_t k = 0; k < count; k++) datum[k] = x[k];
  return 0;
}

START_TEST(fluxes_and_robin_terms_pull_at_ends)
{
  const dvi_density_condition ends[] = {
      {.part = "left", .kind = DVI_FIXED, .datum = line},
      {.part = "right", .kind = DVI_FREE, .datum = flux, .robin = 0.5}};
  for (int i = 0; i < KINDS; i++) {
    density_field field = make_density(make_density_space(kinds[i], 1, -1, 2, 0), &elastic_part, 1,
                                       ends, 2);
    ck_assert_msg(dvi_density_solve(field.density, field.U, NULL) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_eq(dvi_density_project(field.density, field.U, NULL, field.q, NULL, NULL),
                     DVI_OK);
    const double x = 0.7, slope = 2.5 / 2.5;
    ck_assert_double_eq_tol(density_at(&field, 0, &x), -1 + slope * (x + 1), 1e-12);
    end_density(&field);
  }
}
END_TEST

/* u = x^2 - y^2 has the fluxes 2 x n_x - 2 y n_y, and on top, with a = 0.5, g = -2 + u/2. */
static int saddle_flux(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)user;
  for (int64_t k = 0; k < count; k++) {
    const int is_top = x[count + k] == 1 && fabs(x[k]) < 1;
    datum[k] = is_top ? -2 + 0.5 * (x[k] * x[k] - 1) : x[k] == 1 ? 2 : -2;
  }
  return 0;
}

START_TEST(fluxes_and_robin_terms_pull_at_sides)
{
  static const char *const squares[] = {"fem:degree=2,cells=3", "spline:degree=2,cells=3"};
  const dvi_density_condition sides[] = {{.part = "left", .kind = DVI_FIXED, .datum = saddle},
                                         {.part = "right", .datum = saddle_flux},
                                         {.part = "bottom", .datum = saddle_flux},
                                         {.part = "top", .datum = saddle_flux, .robin = 0.5}};
  for (int i = 0; i < 2; i++) {
    density_field field = make_density(make_density_space(squares[i], 2, -1, 1, 0),
                                       &elastic_part_2d, 1, sides, 4);
    ck_assert_msg(dvi_density_solve(field.density, field.U, NULL) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_eq(dvi_density_project(field.density, field.U, NULL, field.q, NULL, NULL),
                     DVI_OK);
    const double x[2] = {0.3, -0.8};
    ck_assert_double_eq_tol(density_at(&field, 0, x), 0.09 - 0.64, 1e-12);
    end_density(&field);
  }
}
END_TEST

/* Values that move: u = sin(t - x) on [0,1]. */
static const dvi_density_condition moving_ends = {
    .part = "boundary", .kind = DVI_FIXED, .datum = sine_datum, .rate = sine_datum_rates};

static int wave(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = sin(-x[k]);
  return 0;
}

static int wave_rate(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = cos(-x[k]);
  return 0;
}

/* The errors are those of a numpy program of the same midpoint rule, with p = M_II v + M_ID G' and
 * the boundary's values at the middle of a step. */
START_TEST(values_that_move_stay_in_the_lagrangian)
{
  static const double expected[] = {6.0851864e-4, 1.5198081e-4, 3.7691973e-5};
  const dvi_density_part parts[] = {kinetic_part, elastic_part};
  for (int i = 0; i < 3; i++) {
    char kind[64];
    const int cells = 20 << i;
    (void)snprintf(kind, sizeof kind, "fem:degree=1,cells=%d", cells);
    density_field field = make_density(make_density_space(kind, 1, 0, 1, 0), parts, 2, &moving_ends,
                                       1);
    set_density(&field, wave, wave_rate, NULL);
    run_density(&field, "midpoint", 0, 1.0 / cells, 2 * cells);
    double worst = 0;
    for (int k = 0; k <= cells; k++) {
      const double x = (double)k / cells;
      worst = fmax(worst, fabs(density_at(&field, 2, &x) - sin(2 - x)));
    }
    ck_assert_double_eq_tol(worst / expected[i], 1, 1e-7);
    end_density(&field);
  }
}
END_TEST

/* Lumped masses have no part M_ID, so that explicit steps serve, with their order 2. */
START_TEST(values_that_move_beside_lumped_masses_take_explicit_steps)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part};
  double error[2];
  for (int i = 0; i < 2; i++) {
    char kind[64];
    const int cells = 20 << i;
    (void)snprintf(kind, sizeof kind, "fem:degree=2,cells=%d,lumped=yes", cells);
    density_field field = make_density(make_density_space(kind, 1, 0, 1, 0), parts, 2, &moving_ends,
                                       1);
    dvi_system_terms terms;
    ck_assert_int_eq(dvi_density_system_terms(field.density, &terms), DVI_OK);
    ck_assert_ptr_null(terms.vector_potential);
    set_density(&field, wave, wave_rate, NULL);
    run_density(&field, "verlet", 0, 0.25 / cells, 8 * cells);
    error[i] = 0;
    for (int k = 0; k <= cells; k++) {
      const double x = (double)k / cells;
      error[i] = fmax(error[i], fabs(density_at(&field, 2, &x) - sin(2 - x)));
    }
    end_density(&field);
  }
  ck_assert_double_lt(error[0], 1e-4);
  ck_assert_double_eq_tol(log2(error[0] / error[1]), 2, 0.1);
}
END_TEST

START_TEST(callbacks_agree_with_differences_for_values_that_move)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, sine_gordon_part};
  for (int i = 0; i < KINDS; i++) {
    density_field field = make_density(make_density_space(kinds[i], 1, 0, 1, 0), parts, 3,
                                       &moving_ends, 1);
    check_density(&field, 1e-6);
    end_density(&field);
  }
}
END_TEST

START_TEST(fields_explain_themselves)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, sine_gordon_part};
  const dvi_density_condition ends[] = {
      {.part = "left", .kind = DVI_FIXED, .datum = sine_datum, .rate = sine_datum_rates},
      {.part = "right", .kind = DVI_FIXED, .datum = line}};
  density_field field = make_density(make_density_space("fem:degree=1,cells=8", 1, 0, 1, 0), parts,
                                     3, ends, 2);
  char text[600], start[12];
  dvi_density_explain(field.density, text, sizeof text);
  ck_assert_msg(strstr(text, "1 component of 9 functions: 7 coordinates, 1 value that moves, 1 "
                             "fixed value\nmass: sparse, 19 entries\nvector potential: of the "
                             "values that move\npotential 'quadratic': 1 part, 19 entries, "
                             "frequencies up to ") == text &&
                    strstr(text, "potential 'pendula': Hessian of 19 entries, gradients by ranges "
                                 "that reach 1\n") != NULL,
                "%s", text);
  dvi_density_explain(field.density, start, sizeof start);
  ck_assert_str_eq(start, "1 component");
  end_density(&field);
}
END_TEST

START_TEST(rates_are_lifted_with_those_that_move)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part};
  const dvi_density_condition ends[] = {
      {.part = "left", .kind = DVI_FIXED, .datum = sine_datum, .rate = sine_datum_rates},
      {.part = "right", .kind = DVI_FIXED, .datum = line}};
  density_field field = make_density(make_density_space("fem:degree=1,cells=3", 1, 0, 1, 0), parts,
                                     2, ends, 2);
  const double v[2] = {5, 7};
  double rate[4];
  ck_assert_int_eq(dvi_density_lift_rate(field.density, 0.3, v, rate), DVI_OK);
  ck_assert_double_eq(rate[0], cos(0.3));
  ck_assert(rate[1] == 5 && rate[2] == 7 && rate[3] == 0);
  ck_assert_int_eq(dvi_density_lift_rate(field.density, 0, NULL, rate), DVI_BAD_ARGUMENT);
  end_density(&field);
}
END_TEST

START_TEST(lift_undoes_project)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part};
  const dvi_density_condition left = {.part = "left", .kind = DVI_FIXED, .datum = line};
  density_field field = make_density(make_density_space("fem:degree=2,cells=4", 1, -1, 2, 0), parts,
                                     2, &left, 1);
  double U[9], back[9];
  for (int i = 0; i < 9; i++) U[i] = sin(i + 1.0);
  U[0] = -1;
  ck_assert_int_eq(dvi_density_project(field.density, U, NULL, field.q, NULL, NULL), DVI_OK);
  ck_assert_int_eq(dvi_density_lift(field.density, 0, field.q, back), DVI_OK);
  for (int i = 0; i < 9; i++) ck_assert_double_eq(U[i], back[i]);
  end_density(&field);
}
END_TEST

static const double growing = 0.5;

/* u^2/4, which the elastic part alone does not hold. */
static int hill(int count, double t, const double *x, const double *z, double *l, double *l_z,
                double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = growing * z[k] * z[k] / 2;
    if (l_z != NULL) l_z[k] = growing * z[k];
    if (l_zz != NULL) l_zz[k] = growing;
  }
  return 0;
}

/* With the hill the least eigenvalue is that of the constant field. */
START_TEST(least_eigenvalue_tells_of_growth)
{
  const dvi_jet value = {0};
  const dvi_density_part parts[] = {kinetic_part,
                                    elastic_part,
                                    {.name = "hill",
                                     .kind = DVI_DENSITY_QUADRATIC,
                                     .variable = &value,
                                     .variables = 1,
                                     .density = hill}};
  for (int i = 0; i < KINDS; i++)
    for (int with_hill = 0; with_hill < 2; with_hill++) {
      density_field field = make_density(make_density_space(kinds[i], 1, -1, 2, 0), parts,
                                         2 + with_hill, NULL, 0);
      double lambda = 1;
      ck_assert_int_eq(dvi_density_least(field.density, &lambda), DVI_OK);
      ck_assert_double_eq_tol(lambda, with_hill ? -growing : 0, 1e-9);
      end_density(&field);
    }
  ck_assert_int_eq(dvi_density_least(NULL, NULL), DVI_BAD_ARGUMENT);
}
END_TEST

static int negative(int count, double t, const double *x, const double *z, double *l, double *l_z,
                    double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = -z[k] * z[k] / 2;
    if (l_z != NULL) l_z[k] = -z[k];
    if (l_zz != NULL) l_zz[k] = -1;
  }
  return 0;
}

/* All modes grow, and the fastest one of the right sign most. Its frequency is a bound from above
 * within 1e-3, and its square within 2e-3. */
START_TEST(modes_of_a_negative_mass_grow)
{
  dvi_density_part parts[] = {kinetic_part, elastic_part};
  density_field right = make_density(make_density_space(kinds[0], 1, -1, 2, 0), parts, 2, NULL, 0);
  parts[0].density = negative;
  density_field wrong = make_density(make_density_space(kinds[0], 1, -1, 2, 0), parts, 2, NULL, 0);
  double lambda = 0, omega = 0;
  ck_assert_int_eq(dvi_density_fastest(right.density, &omega), DVI_OK);
  ck_assert_int_eq(dvi_density_least(wrong.density, &lambda), DVI_OK);
  ck_assert_double_eq_tol(-lambda / (omega * omega), 1, 2e-3);
  end_density(&right);
  end_density(&wrong);
}
END_TEST

SUITE(density_systems)
{
  tcase_add_test(tests, modes_of_a_negative_mass_grow);
  tcase_add_test(tests, least_eigenvalue_tells_of_growth);
  tcase_add_test(tests, callbacks_agree_with_differences_on_intervals);
  tcase_add_test(tests, callbacks_agree_with_differences_on_circles);
  tcase_add_test(tests, callbacks_agree_with_differences_on_squares);
  tcase_add_test(tests, fastest_frequency_is_that_of_the_elements);
  tcase_add_test(tests, fastest_frequency_at_a_state_has_all_potentials);
  tcase_add_test(tests, energy_is_that_of_the_continuum);
  tcase_add_test(tests, fixed_ends_hold_a_line);
  tcase_add_test(tests, fixed_sides_hold_a_saddle);
  tcase_add_test(tests, fluxes_and_robin_terms_pull_at_ends);
  tcase_add_test(tests, fluxes_and_robin_terms_pull_at_sides);
  tcase_add_test(tests, values_that_move_stay_in_the_lagrangian);
  tcase_add_test(tests, values_that_move_beside_lumped_masses_take_explicit_steps);
  tcase_add_test(tests, callbacks_agree_with_differences_for_values_that_move);
  tcase_add_test(tests, fields_explain_themselves);
  tcase_add_test(tests, rates_are_lifted_with_those_that_move);
  tcase_add_test(tests, lift_undoes_project);
}
