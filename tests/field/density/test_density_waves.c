/* Motion and static states of fields with densities: orders in time and space, kinks, breathers. */
#include <dvi/reference.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/densities.h"
#include "support/runs.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* ---- orders in time ---- */

/* The largest error of q at t = 1 beside CVODE, for steps of 1/steps. */
static double error_in_time(density_field *field, const double *judged, const char *method,
                            int steps)
{
  memset(field->U, 0, (size_t)field->places * sizeof(double));
  set_density(field, pendula_start, pendula_rate, NULL);
  run_density(field, method, 0, 1.0 / steps, steps);
  return distance((int)field->n, field->q, judged);
}

/* Orders over four step sizes. CVODE's error is about 1e-11. */
START_TEST(methods_have_their_orders_in_time)
{
  static const struct {
    const char *method;
    int order, steps;
  } cases[] = {{"verlet", 2, 50}, {"galerkin:degree=2", 4, 5}, {"imex", 2, 50}};
  static const char *const kinds[] = {"fem:degree=2,cells=8,lumped=yes",
                                      "spline:degree=3,cells=12"};
  const dvi_density_part parts[] = {kinetic_part, elastic_part, sine_gordon_part};
  const dvi_reference_options adams = {.code = DVI_CVODE_ADAMS};
  for (int i = 0; i < 2; i++) {
    density_field field = make_density(make_density_space(kinds[i], 1, 0, 2 * pi, 1), parts, 3,
                                       NULL, 0);
    double *judged = calloc((size_t)field.n, sizeof *judged);
    set_density(&field, pendula_start, pendula_rate, NULL);
    ck_assert_msg(dvi_reference_solve(field.system, 0, 1, field.q, field.p, &adams, NULL) == DVI_OK,
                  "%s", dvi_last_error());
    memcpy(judged, field.q, (size_t)field.n * sizeof *judged);
    for (int m = 0; m < 3; m++) {
      double last = 0;
      for (int halving = 0; halving < 4; halving++) {
        const double error = error_in_time(&field, judged, cases[m].method,
                                           cases[m].steps << halving);
        if (halving > 0) ck_assert_double_eq_tol(log2(last / error), cases[m].order, 0.1);
        last = error;
      }
    }
    free(judged);
    end_density(&field);
  }
}
END_TEST

/* ---- orders in space ---- */

static int cosine(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = cos(x[k]);
  return 0;
}

/* Klein-Gordon waves with m = 1.5: u = cos x cos w t, w^2 = 1 + 2.25. The error is that of the L2
 * norm at t = 1, at points without superconvergence, by Gauss steps of order 6. */
static double error_in_space(const char *kind, int degree, int cells, const char *more)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, klein_gordon_part};
  char spec[80];
  (void)snprintf(spec, sizeof spec, "%s:degree=%d,cells=%d%s", kind, degree, cells, more);
  density_field field = make_density(make_density_space(spec, 1, 0, 2 * pi, 1), parts, 3, NULL, 0);
  set_density(&field, cosine, NULL, NULL);
  run_density(&field, "galerkin:degree=3", 0, 0.02, 50);
  enum { POINTS = 997 };
  const int order[DVI_AXES_MAX] = {0};
  double x[POINTS], u[POINTS], sum = 0;
  for (int k = 0; k < POINTS; k++) x[k] = 2 * pi * (k + 0.5) / POINTS;
  ck_assert_int_eq(dvi_density_lift(field.density, 1, field.q, field.U), DVI_OK);
  ck_assert_int_eq(dvi_space_evaluate(field.space, order, field.U, POINTS, x, u), DVI_OK);
  for (int k = 0; k < POINTS; k++) sum += pow(u[k] - cos(x[k]) * cos(sqrt(3.25)), 2) / POINTS;
  end_density(&field);
  return sqrt(sum);
}

START_TEST(elements_have_their_orders_in_space)
{
  static const struct {
    const char *kind, *more;
    int degree;
  } cases[] = {{"fem", "", 1},
               {"fem", "", 2},
               {"fem", "", 3},
               {"fem", "", 4},
               {"fem", ",lumped=yes", 3},
               {"spline", "", 2},
               {"spline", "", 3}};
  for (int i = 0; i < 7; i++) {
    double last = 0;
    for (int cells = 10; cells <= 40; cells *= 2) {
      const double error = error_in_space(cases[i].kind, cases[i].degree, cells, cases[i].more);
      if (cells > 10)
        ck_assert_msg(fabs(log2(last / error) - cases[i].degree - 1) < 0.35, "%s %d%s: %g %g",
                      cases[i].kind, cases[i].degree, cases[i].more, last, error);
      last = error;
    }
  }
}
END_TEST

/* ---- kinks ---- */

static int side(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)t, (void)user;
  for (int64_t k = 0; k < count; k++) datum[k] = tanh(x[k] / sqrt(2));
  return 0;
}

static int guess(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = fmax(-1, fmin(1, 0.4 * x[k]));
  return 0;
}

/* The kink tanh(x/sqrt 2) of (u^2-1)^2/4 has, from -a to a, the energy sqrt 2 (T - T^3/3) with
 * T = tanh(a/sqrt 2). */
START_TEST(static_kinks_have_known_energies)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, double_well_part};
  const dvi_density_condition ends = {.part = "boundary", .kind = DVI_FIXED, .datum = side};
  static const char *const kinds[] = {"fem:degree=4,cells=40", "spline:degree=5,cells=60"};
  const double T = tanh(5 / sqrt(2));
  for (int i = 0; i < 2; i++) {
    density_field field = make_density(make_density_space(kinds[i], 1, -5, 5, 0), parts, 3, &ends,
                                       1);
    double energy;
    dvi_field_solve_report report;
    ck_assert_int_eq(dvi_space_interpolate(field.space, guess, NULL, field.U), DVI_OK);
    ck_assert_msg(dvi_density_solve(field.density, field.U, &report) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_le(report.iterations, 12);
    ck_assert_int_eq(dvi_density_project(field.density, field.U, NULL, field.q, NULL, field.p),
                     DVI_OK);
    ck_assert_int_eq(dvi_system_invariants(field.system, 0, field.q, field.p, &energy), DVI_OK);
    ck_assert_double_eq_tol(energy, sqrt(2) * (T - T * T * T / 3), 1e-8);
    for (int k = -6; k <= 6; k++) {
      const double x = 0.5 * k;
      ck_assert_double_eq_tol(density_at(&field, 0, &x), tanh(x / sqrt(2)), 1e-5);
    }
    end_density(&field);
  }
}
END_TEST

static int kink(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = tanh(x[k] / sqrt(2));
  return 0;
}

/* The modes of the kink are 0, 3/2, and those above 2. The second one falls off as
 * exp(-|x|/sqrt 2), so that ends at 16 change its eigenvalue by 1e-9. */
START_TEST(kinks_have_known_modes)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, double_well_part};
  const dvi_density_condition ends = {.part = "boundary", .kind = DVI_FIXED, .datum = side};
  const dvi_modes_options two = {.size = sizeof two, .count = 2};
  density_field field = make_density(make_density_space("fem:degree=4,cells=128", 1, -16, 16, 0),
                                     parts, 3, &ends, 1);
  double eigenvalue[2], *mode = calloc((size_t)(2 * field.places), sizeof *mode);
  ck_assert_int_eq(dvi_space_interpolate(field.space, kink, NULL, field.U), DVI_OK);
  ck_assert_msg(dvi_density_modes(field.density, &two, field.U, eigenvalue, mode) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_double_eq_tol(eigenvalue[0], 0, 1e-7);
  ck_assert_double_eq_tol(eigenvalue[1], 1.5, 1e-7);
  ck_assert(mode[0] == 0 && mode[2 * field.places - 1] == 0);
  free(mode);
  end_density(&field);
}
END_TEST

/* About 0 the modes between fixed ends have the eigenvalues (k pi/8)^2 - 1, two of them below 0.
 * The numbers of unknowns are those of full matrices and of Lanczos' method. */
START_TEST(unstable_states_have_modes_that_grow)
{
  static const char *const kinds[] = {"fem:degree=4,cells=16", "fem:degree=4,cells=60"};
  const dvi_density_part parts[] = {kinetic_part, elastic_part, double_well_part};
  const dvi_density_condition ends = {.part = "boundary", .kind = DVI_FIXED};
  const dvi_modes_options four = {.size = sizeof four, .count = 4};
  for (int i = 0; i < 2; i++) {
    density_field field = make_density(make_density_space(kinds[i], 1, 0, 8, 0), parts, 3, &ends,
                                       1);
    double eigenvalue[4];
    ck_assert_msg(dvi_density_modes(field.density, &four, NULL, eigenvalue, NULL) == DVI_OK, "%s",
                  dvi_last_error());
    for (int k = 0; k < 4; k++)
      ck_assert_double_eq_tol(eigenvalue[k], pow((k + 1) * acos(-1.0) / 8, 2) - 1, 1e-7);
    end_density(&field);
  }
}
END_TEST

START_TEST(singular_static_problems_are_refused)
{
  density_field field = make_density(make_density_space("fem:degree=1,cells=8", 1, 0, 1, 0),
                                     &elastic_part, 1, NULL, 0);
  for (int i = 0; i < 9; i++) field.U[i] = i;
  ck_assert_int_eq(dvi_density_solve(field.density, field.U, NULL), DVI_SINGULAR);
  check_words("fix a value on the boundary");
  ck_assert_double_eq(field.U[8], 8);
  end_density(&field);
}
END_TEST

/* ---- breathers ---- */

/* The breather 4 atan(s sin(w t)/(w cosh(s x))), s^2 = 1 - w^2, which starts at 0. */
static double breather(double x, double t)
{
  const double w = 0.5, s = sqrt(1 - w * w);
  return 4 * atan(s / w * sin(w * t) / cosh(s * x));
}

static int breather_rate(int64_t count, const double *x, double *f, void *user)
{
  const double s = sqrt(0.75);
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = 4 * s / cosh(s * x[k]);
  return 0;
}

/* The errors are those of a numpy program of the same method. */
START_TEST(breathers_have_the_errors_of_imex_steps)
{
  static const double expected[] = {.699, .144, .0345};
  const dvi_density_part parts[] = {kinetic_part, elastic_part, sine_gordon_part};
  for (int i = 0; i < 3; i++) {
    density_field field = make_density(
        make_density_space("fem:degree=2,cells=800,lumped=yes", 1, -20, 20, 1), parts, 3, NULL, 0);
    double worst = 0;
    set_density(&field, NULL, breather_rate, NULL);
    run_density(&field, "imex", 0, 0.2 / (1 << i), 100 << i);
    for (int k = 0; k < 1600; k++) {
      const double x = -20 + 0.025 * k;
      worst = fmax(worst, fabs(density_at(&field, 20, &x) - breather(x, 20)));
    }
    ck_assert_double_eq_tol(worst / expected[i], 1, 5e-3);
    end_density(&field);
  }
}
END_TEST

/* ---- general Lagrangians and one-forms ---- */

/* l = (1 + u^2) u_t^2/2 - u_x^2/2 with z = (u, u_t, u_x). */
static int heavy(int count, double t, const double *x, const double *z, double *l, double *l_z,
                 double *l_zz, void *user)
{
  const double *u = z, *u_t = z + count, *u_x = z + 2 * count;
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    const double m = 1 + u[k] * u[k];
    if (l != NULL) l[k] = 0.5 * (m * u_t[k] * u_t[k] - u_x[k] * u_x[k]);
    if (l_z != NULL) {
      l_z[k] = u[k] * u_t[k] * u_t[k];
      l_z[count + k] = m * u_t[k];
      l_z[2 * count + k] = -u_x[k];
    }
    if (l_zz != NULL) {
      l_zz[k] = u_t[k] * u_t[k];
      l_zz[count + k] = 2 * u[k] * u_t[k];
      l_zz[2 * count + k] = m;
      l_zz[3 * count + k] = -1;
    }
  }
  return 0;
}

static const dvi_jet heavy_variable[] = {{0}, {.rate = 1}, {.order = {1}}};
static const int heavy_pair[][2] = {{0, 0}, {1, 0}, {1, 1}, {2, 2}};
static const dvi_density_part heavy_part = {.name = "heavy",
                                            .kind = DVI_DENSITY_GENERAL,
                                            .variable = heavy_variable,
                                            .variables = 3,
                                            .pair = heavy_pair,
                                            .pairs = 4,
                                            .density = heavy};

START_TEST(general_parts_agree_with_differences)
{
  static const char *const kinds[] = {"fem:degree=2,cells=5", "fem:degree=2,cells=5,lumped=yes",
                                      "spline:degree=2,cells=7", "fourier:modes=4"};
  const dvi_density_part parts[] = {heavy_part, kinetic_part, elastic_part, sine_gordon_part};
  for (int i = 0; i < 4; i++) {
    density_field field = make_density(make_density_space(kinds[i], 1, 0, 2 * pi, 1), parts, 4,
                                       NULL, 0);
    check_density(&field, 1e-6);
    end_density(&field);
  }
}
END_TEST

START_TEST(general_parts_go_with_values_that_move)
{
  static const char *const kinds[] = {"fem:degree=2,cells=5", "spline:degree=2,cells=7"};
  const dvi_density_condition ends = {
      .part = "boundary", .kind = DVI_FIXED, .datum = sine_datum, .rate = sine_datum_rates};
  for (int i = 0; i < 2; i++) {
    density_field field = make_density(make_density_space(kinds[i], 1, 0, 1, 0), &heavy_part, 1,
                                       &ends, 1);
    dvi_system_terms terms;
    ck_assert_int_eq(dvi_density_system_terms(field.density, &terms), DVI_OK);
    ck_assert(terms.lagrangian->rate != NULL && !terms.autonomous);
    check_density(&field, 1e-6);
    end_density(&field);
  }
}
END_TEST

/* At u = 0 the general part is that of a string of length pi, with the modes k^2. */
START_TEST(general_parts_have_modes)
{
  const dvi_density_condition ends = {.part = "boundary", .kind = DVI_FIXED};
  const dvi_modes_options three = {.size = sizeof three, .count = 3};
  density_field field = make_density(make_density_space("fem:degree=4,cells=20", 1, 0, pi, 0),
                                     &heavy_part, 1, &ends, 1);
  double eigenvalue[3];
  ck_assert_msg(dvi_density_modes(field.density, &three, NULL, eigenvalue, NULL) == DVI_OK, "%s",
                dvi_last_error());
  for (int k = 1; k <= 3; k++) ck_assert_double_eq_tol(eigenvalue[k - 1], k * k, 1e-8);
  end_density(&field);
}
END_TEST

/* galerkin of degree 2 has order 4 beside IDA. */
START_TEST(general_parts_move_as_ida_says)
{
  density_field field = make_density(make_density_space("fem:degree=2,cells=4", 1, 0, 2 * pi, 1),
                                     &heavy_part, 1, NULL, 0);
  double errors[3], *judged = calloc((size_t)(2 * field.n), sizeof *judged);
  for (int i = 0; i < 3; i++) {
    set_density(&field, pendula_start, pendula_rate, NULL);
    if (i == 0) {
      double *p = judged + field.n;
      memcpy(judged, field.q, (size_t)field.n * sizeof *judged);
      memcpy(p, field.p, (size_t)field.n * sizeof *p);
      ck_assert_msg(dvi_reference_solve(field.system, 0, 1, judged, p, NULL, NULL) == DVI_OK, "%s",
                    dvi_last_error());
    }
    run_density(&field, "galerkin:degree=2", 0, 0.1 / (1 << i), 10 << i);
    errors[i] = distance((int)field.n, field.q, judged);
  }
  ck_assert_double_eq_tol(log2(errors[0] / errors[1]), 4, 0.3);
  ck_assert_double_eq_tol(log2(errors[1] / errors[2]), 4, 0.3);
  free(judged);
  end_density(&field);
}
END_TEST

/* l = (u + s u^3/3) v_t with z = (u, v_t): the one-form of a pair, linear without s. */
static int pair_form(int count, double t, const double *x, const double *z, double *l, double *l_z,
                     double *l_zz, void *user)
{
  const double s = *(const double *)user;
  const double *u = z, *v_t = z + count;
  (void)t, (void)x;
  for (int k = 0; k < count; k++) {
    const double a = u[k] + s * pow(u[k], 3) / 3, a_u = 1 + s * u[k] * u[k];
    if (l != NULL) l[k] = a * v_t[k];
    if (l_z != NULL) l_z[k] = a_u * v_t[k], l_z[count + k] = a;
    if (l_zz != NULL) {
      l_zz[k] = 2 * s * u[k] * v_t[k];
      l_zz[count + k] = a_u;
      l_zz[2 * count + k] = 0;
    }
  }
  return 0;
}

/* H = (u_x^2 + v_x^2 + u^2 v^2)/2 with z = (u, v, u_x, v_x). */
static int pair_energy(int count, double t, const double *x, const double *z, double *l,
                       double *l_z, double *l_zz, void *user)
{
  const double *u = z, *v = z + count, *u_x = z + 2 * count, *v_x = z + 3 * count;
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = -0.5 * (u_x[k] * u_x[k] + v_x[k] * v_x[k] + u[k] * u[k] * v[k] * v[k]);
    if (l_z != NULL) {
      l_z[k] = -u[k] * v[k] * v[k];
      l_z[count + k] = -v[k] * u[k] * u[k];
      l_z[2 * count + k] = -u_x[k];
      l_z[3 * count + k] = -v_x[k];
    }
    if (l_zz != NULL) {
      l_zz[k] = -v[k] * v[k];
      l_zz[count + k] = -2 * u[k] * v[k];
      l_zz[2 * count + k] = -u[k] * u[k];
      l_zz[3 * count + k] = l_zz[4 * count + k] = -1;
    }
  }
  return 0;
}

START_TEST(one_forms_of_pairs_agree_with_differences)
{
  static const dvi_jet form_variable[] = {{.component = 0}, {.component = 1, .rate = 1}},
                       energy_variable[] = {{.component = 0},
                                            {.component = 1},
                                            {.component = 0, .order = {1}},
                                            {.component = 1, .order = {1}}};
  static const int energy_pair[][2] = {{0, 0}, {1, 0}, {1, 1}, {2, 2}, {3, 3}};
  static const char *const kinds[] = {"fem:degree=2,cells=5", "spline:degree=2,cells=6",
                                      "fourier:modes=4"};
  double s = 0;
  const dvi_density_part parts[] = {{.kind = DVI_DENSITY_ONE_FORM,
                                     .variable = form_variable,
                                     .variables = 2,
                                     .density = pair_form,
                                     .user = &s},
                                    {.kind = DVI_DENSITY_POTENTIAL,
                                     .variable = energy_variable,
                                     .variables = 4,
                                     .pair = energy_pair,
                                     .pairs = 5,
                                     .density = pair_energy}};
  for (int i = 0; i < 6; i++) {
    s = i < 3 ? 0 : 1;
    density_field field = make_density_of(
        make_density_space(kinds[i % 3], 1, 0, 2 * pi, 1),
        (dvi_density_terms){.components = 2, .part = parts, .parts = 2});
    check_density(&field, 1e-6);
    ck_assert_int_eq(dvi_density_project(field.density, field.U, NULL, field.q, NULL, field.p),
                     DVI_OK);
    run_density(&field, "vprk:nodes=2", 0, 0.01, 3);
    end_density(&field);
  }
}
END_TEST

SUITE(density_waves)
{
  tcase_add_test(tests, methods_have_their_orders_in_time);
  tcase_add_test(tests, elements_have_their_orders_in_space);
  tcase_add_test(tests, static_kinks_have_known_energies);
  tcase_add_test(tests, kinks_have_known_modes);
  tcase_add_test(tests, unstable_states_have_modes_that_grow);
  tcase_add_test(tests, singular_static_problems_are_refused);
  tcase_add_test(tests, breathers_have_the_errors_of_imex_steps);
  tcase_add_test(tests, general_parts_agree_with_differences);
  tcase_add_test(tests, general_parts_go_with_values_that_move);
  tcase_add_test(tests, general_parts_have_modes);
  tcase_add_test(tests, general_parts_move_as_ida_says);
  tcase_add_test(tests, one_forms_of_pairs_agree_with_differences);
}
