/* labels: unit slow */
/* Fields with densities on Fourier modes. */
#include <dvi/integrator.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/densities.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

static const dvi_density_terms well = {
    .part = (const dvi_density_part[]){{0}}, .components = 1, .translations = 1};

static density_field make_field(const char *kind, int dimension, const dvi_density_part *part,
                                int parts)
{
  dvi_density_terms terms = well;
  terms.part = part;
  terms.parts = parts;
  return make_density_of(make_density_space(kind, dimension, 0, 2 * pi, 1), terms);
}

/* ---- systems ---- */

START_TEST(callbacks_agree_with_differences)
{
  dvi_density_part parts[] = {kinetic_part, elastic_part, klein_gordon_part, sine_gordon_part,
                              double_well_part};
  density_field field = make_field("fourier:modes=5", 1, parts, 5);
  check_density(&field, 1e-6);
  end_density(&field);
  parts[1] = elastic_part_2d;
  field = make_field("fourier:modes=2", 2, parts, 5);
  check_density(&field, 1e-6);
  end_density(&field);
}
END_TEST

START_TEST(mass_is_one_and_stiffness_diagonal)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, klein_gordon_part};
  density_field field = make_field("fourier:modes=6", 1, parts, 3);
  dvi_system_terms terms;
  dvi_matrix K;
  double omega;
  ck_assert_int_eq(dvi_density_system_terms(field.density, &terms), DVI_OK);
  ck_assert_double_eq_tol(terms.mass.scalar, 1, 1e-15);
  ck_assert_int_eq(dvi_density_matrix(field.density, DVI_FIELD_STIFFNESS, &K), DVI_OK);
  ck_assert_int_eq(dvi_matrix_entries(&K), 13);
  for (int i = 0; i < 13; i++) {
    const int k = (i + 1) / 2;
    ck_assert_double_eq_tol(K.value[i], k * k + 2.25, 1e-12);
  }
  ck_assert_int_eq(dvi_density_fastest(field.density, &omega), DVI_OK);
  ck_assert(omega * omega > 38.25 - 1e-9 && omega * omega < 38.25 * 1.0022);
  end_density(&field);
}
END_TEST

/* l = 2 u^2, which makes modes up to k = 2 unstable. */
static int hill(int count, double t, const double *x, const double *z, double *l, double *l_z,
                double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = 2 * z[k] * z[k];
    if (l_z != NULL) l_z[k] = 4 * z[k];
    if (l_zz != NULL) l_zz[k] = 4;
  }
  return 0;
}

START_TEST(fastest_frequency_is_that_of_the_stable_modes)
{
  dvi_density_part parts[] = {kinetic_part, klein_gordon_part, elastic_part};
  double omega;
  parts[1].density = hill;
  density_field field = make_field("fourier:modes=6", 1, parts, 3);
  ck_assert_int_eq(dvi_density_fastest(field.density, &omega), DVI_OK);
  ck_assert(omega * omega > 32 - 1e-9 && omega * omega < 32 * 1.0022);
  end_density(&field);
  field = make_field("fourier:modes=6", 1, parts, 2);
  ck_assert_int_eq(dvi_density_fastest(field.density, &omega), DVI_OK);
  ck_assert_double_eq(omega, 0);
  end_density(&field);
}
END_TEST

/* l = -(2 + cos x) u_x^2/2: 2 is in the matrix, and cos x in a potential. */
static int varied(int count, double t, const double *x, const double *z, double *l, double *l_z,
                  double *l_zz, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) {
    const double a = 2 + cos(x[k]);
    if (l != NULL) l[k] = -0.5 * a * z[k] * z[k];
    if (l_z != NULL) l_z[k] = -a * z[k];
    if (l_zz != NULL) l_zz[k] = -a;
  }
  return 0;
}

START_TEST(coefficients_that_vary_have_a_potential_of_their_own)
{
  const dvi_density_part parts[] = {kinetic_part,
                                    {.name = "varied",
                                     .kind = DVI_DENSITY_QUADRATIC,
                                     .variable = elastic_part.variable,
                                     .variables = 1,
                                     .density = varied}};
  density_field field = make_field("fourier:modes=4,points=16", 1, parts, 2);
  dvi_system_terms terms;
  dvi_matrix K;
  double watched[2], eigenvalue[2];
  check_density(&field, 1e-6);
  ck_assert_int_eq(dvi_density_system_terms(field.density, &terms), DVI_OK);
  ck_assert_int_eq(terms.potential_count, 2);
  ck_assert_int_eq(dvi_density_matrix(field.density, DVI_FIELD_STIFFNESS, &K), DVI_OK);
  ck_assert_double_eq_tol(K.value[7], 32, 1e-12);
  /* u = cos x + sin 2 x: the integral of (2 + cos x) u_x^2/2 by hand, with u_x = -sin x + 2 cos 2x:
   * 2 (pi + 4 pi)/2 + int cos x (-4 sin x cos 2x + ..)/2 = 5 pi */
  memset(field.q, 0, (size_t)field.n * sizeof(double));
  field.q[1] = field.q[4] = sqrt(pi);
  ck_assert_int_eq(dvi_system_invariants(field.system, 0, field.q, field.p, watched), DVI_OK);
  ck_assert_double_eq_tol(watched[0], 5 * pi, 1e-12);
  const dvi_modes_options two = {.size = sizeof two, .count = 2};
  ck_assert_msg(dvi_density_modes(field.density, &two, NULL, eigenvalue, NULL) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_double_eq_tol(eigenvalue[0], 0, 1e-11);
  end_density(&field);
}
END_TEST

START_TEST(masses_that_vary_are_refused)
{
  const dvi_density_part heavy = {.name = "heavy",
                                  .kind = DVI_DENSITY_KINETIC,
                                  .variable = kinetic_part.variable,
                                  .variables = 1,
                                  .density = varied};
  dvi_space *space = make_density_space("fourier:modes=4", 1, 0, 1, 1);
  dvi_density *density = NULL;
  const dvi_density_terms terms = {
      .size = sizeof terms, .space = space, .components = 1, .part = &heavy, .parts = 1};
  ck_assert_int_eq(dvi_density_create(&terms, &density), DVI_UNSUPPORTED);
  check_words("the coefficients of kinetic part 'heavy' vary in x");
  dvi_space_destroy(&space);
}
END_TEST

/* ---- momentum ---- */

static int bump(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = 1 + 0.4 * cos(x[k]) + 0.2 * sin(2 * x[k]);
  return 0;
}

static int push(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = 0.5 * sin(x[k]) + 0.3 * cos(3 * x[k]);
  return 0;
}

static double drift_of_momentum(const char *kind, const char *method)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part, double_well_part};
  density_field field = make_field(kind, 1, parts, 3);
  double before[2], after[2];
  set_density(&field, bump, push, NULL);
  ck_assert_str_eq(dvi_system_invariant_name(field.system, 1), "momentum_x");
  ck_assert_int_eq(dvi_system_invariants(field.system, 0, field.q, field.p, before), DVI_OK);
  run_density(&field, method, 0, 0.05, 200);
  ck_assert_int_eq(dvi_system_invariants(field.system, 10, field.q, field.p, after), DVI_OK);
  end_density(&field);
  return fabs(after[1] - before[1]);
}

/* u^4 of modes to K has modes to 4 K, which alias onto lower ones unless M > 4 K. */
START_TEST(momentum_is_exact_without_aliasing)
{
  static const char *const methods[] = {"verlet", "midpoint", "galerkin:degree=2", "imex"};
  for (int i = 0; i < 4; i++) {
    ck_assert_double_le(drift_of_momentum("fourier:modes=8,points=33", methods[i]), 1e-14);
    ck_assert_double_ge(drift_of_momentum("fourier:modes=8,points=17", methods[i]), 1e-6);
  }
}
END_TEST

/* ---- two dimensions ---- */

static int start_2d(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = 1 + 0.5 * cos(x[k]) * cos(x[count + k]);
  return 0;
}

static int rate_2d(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = 0.3 * sin(x[k] + x[count + k]);
  return 0;
}

START_TEST(momenta_of_two_axes_are_exact_without_aliasing)
{
  const dvi_density_part parts[] = {kinetic_part, elastic_part_2d, double_well_part};
  density_field field = make_field("fourier:modes=3,points=13", 2, parts, 3);
  double before[3], after[3];
  set_density(&field, start_2d, rate_2d, NULL);
  ck_assert_str_eq(dvi_system_invariant_name(field.system, 2), "momentum_y");
  ck_assert_int_eq(dvi_system_invariants(field.system, 0, field.q, field.p, before), DVI_OK);
  run_density(&field, "verlet", 0, 0.05, 100);
  ck_assert_int_eq(dvi_system_invariants(field.system, 5, field.q, field.p, after), DVI_OK);
  for (int i = 1; i < 3; i++) ck_assert_double_eq_tol(after[i], before[i], 1e-13);
  end_density(&field);
}
END_TEST

/* The value at the origin is that of a numpy program with 24^2 modes and steps of order 8. */
START_TEST(pendula_on_a_torus_have_a_known_state)
{
  const double origin[2] = {0, 0};
  const dvi_density_part parts[] = {kinetic_part, elastic_part_2d, sine_gordon_part};
  density_field field = make_field("fourier:modes=8,points=32", 2, parts, 3);
  set_density(&field, start_2d, rate_2d, NULL);
  run_density(&field, "composition:order=6", 0, 0.025, 120);
  ck_assert_double_eq_tol(density_at(&field, 3, origin), -.80444209124, 2e-9);
  end_density(&field);
}
END_TEST

/* ---- Korteweg and de Vries ---- */

/* phi = psi + m x with the mean slope m, so that psi is periodic. l = psi_x psi_t/2. */
static int kdv_form(int count, double t, const double *x, const double *z, double *l, double *l_z,
                    double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = 0.5 * z[k] * z[count + k];
    if (l_z != NULL) l_z[k] = 0.5 * z[count + k], l_z[count + k] = 0.5 * z[k];
    if (l_zz != NULL) l_zz[k] = 0.5;
  }
  return 0;
}

/* l = (psi_x + m)^3. */
static int kdv_cube(int count, double t, const double *x, const double *z, double *l, double *l_z,
                    double *l_zz, void *user)
{
  const double m = *(const double *)user;
  (void)t, (void)x;
  for (int k = 0; k < count; k++) {
    const double u = z[k] + m;
    if (l != NULL) l[k] = u * u * u;
    if (l_z != NULL) l_z[k] = 3 * u * u;
    if (l_zz != NULL) l_zz[k] = 6 * u;
  }
  return 0;
}

static const dvi_jet kdv_variable[] = {{.order = {1}}, {.rate = 1}}, kdv_second = {.order = {2}};
static const int kdv_pair[1][2] = {{1, 0}};
static double mean_slope = 4.0 / 20;

static const dvi_density_part kdv_parts[] = {{.kind = DVI_DENSITY_ONE_FORM,
                                              .variable = kdv_variable,
                                              .variables = 2,
                                              .pair = kdv_pair,
                                              .pairs = 1,
                                              .density = kdv_form},
                                             {.name = "cube",
                                              .kind = DVI_DENSITY_POTENTIAL,
                                              .variable = kdv_variable,
                                              .variables = 1,
                                              .density = kdv_cube,
                                              .user = &mean_slope},
                                             {.name = "dispersion",
                                              .kind = DVI_DENSITY_QUADRATIC,
                                              .variable = &kdv_second,
                                              .variables = 1,
                                              .density = NULL}};

/* l = -psi_xx^2/2, as the elastic part of another variable. */
static density_field make_kdv(const char *kind)
{
  dvi_density_part parts[3];
  memcpy(parts, kdv_parts, sizeof parts);
  parts[2].density = elastic_part.density;
  return make_density_of(make_density_space(kind, 1, 0, 20, 1),
                         (dvi_density_terms){.part = parts, .parts = 3, .translations = 1});
}

/* The soliton u = c/2 sech^2(sqrt(c)/2 (x - c t - x0)) with c = 4 has phi = 2 tanh(x - 4 t - x0),
 * and psi = phi - x/5. Its images of the period 20 are added. */
static int soliton(int64_t count, const double *x, double *f, void *user)
{
  const double centre = *(const double *)user;
  for (int64_t k = 0; k < count; k++) {
    f[k] = -x[k] * mean_slope;
    for (int image = -1; image <= 1; image++) f[k] += 2 * tanh(x[k] - centre - 20 * image);
  }
  return 0;
}

static double kdv_error(const char *kind, const char *method, int steps)
{
  density_field field = make_kdv(kind);
  double start = 5, end = 7, sum = 0;
  set_density(&field, soliton, NULL, &start);
  ck_assert_int_eq(dvi_system_momentum(field.system, 0, field.q, field.q, field.p), DVI_OK);
  run_density(&field, method, 0, 0.5 / steps, steps);
  ck_assert_int_eq(dvi_density_lift(field.density, 0.5, field.q, field.U), DVI_OK);
  double *exact = calloc((size_t)field.places, sizeof *exact);
  ck_assert_int_eq(dvi_space_interpolate(field.space, soliton, &end, exact), DVI_OK);
  const double *weight;
  const int64_t points = dvi_space_points(field.space, NULL, &weight);
  const int first[DVI_AXES_MAX] = {1};
  double *u = calloc((size_t)points, sizeof *u);
  for (int64_t i = 0; i < field.places; i++) exact[i] -= field.U[i];
  ck_assert_int_eq(dvi_space_apply(field.space, first, exact, u), DVI_OK);
  for (int64_t k = 0; k < points; k++) sum += weight[k] * u[k] * u[k];
  free(u);
  free(exact);
  end_density(&field);
  return sqrt(sum);
}

/* The errors are those of a numpy program of the Poisson form u_t = D grad H. */
START_TEST(solitons_have_the_errors_of_the_poisson_form)
{
  static const double midpoint[] = {1.738e-3, 4.347e-4, 1.087e-4},
                      gauss[] = {6.6e-6, 3.5e-7, 2.2e-8};
  for (int i = 0; i < 3; i++) {
    ck_assert_double_eq_tol(
        kdv_error("fourier:modes=40,points=128", "vprk:nodes=1", 50 << i) / midpoint[i], 1, 2e-3);
    ck_assert_double_eq_tol(
        kdv_error("fourier:modes=40,points=128", "vprk:nodes=2", 25 << i) / gauss[i], 1, 1e-2);
  }
}
END_TEST

/* The slope of splines of degree 4 has order 4. Two-forms are regular for odd numbers of cells. */
START_TEST(solitons_on_splines_have_the_order_of_a_slope)
{
  const double coarse = kdv_error("spline:degree=4,cells=101", "vprk:nodes=2", 100),
               fine = kdv_error("spline:degree=4,cells=201", "vprk:nodes=2", 100);
  ck_assert_double_ge(log2(coarse / fine), 3.8);
}
END_TEST

START_TEST(kdv_agrees_with_differences)
{
  static const char *const kinds[] = {"fourier:modes=6", "spline:degree=3,cells=11"};
  for (int i = 0; i < 2; i++) {
    density_field field = make_kdv(kinds[i]);
    char text[600];
    dvi_density_explain(field.density, text, sizeof text);
    ck_assert_msg(strstr(text, "1 constant left out") != NULL, "%s", text);
    ck_assert_msg(strstr(text, "one-form: constant gradients") != NULL, "%s", text);
    double eigenvalue[6];
    ck_assert_int_eq(dvi_density_modes(field.density, NULL, NULL, eigenvalue, NULL),
                     DVI_UNSUPPORTED);
    check_density(&field, 1e-6);
    end_density(&field);
  }
}
END_TEST

/* H = int u_xx^2.. is -32/5 of this soliton, and -int u^2/2 = -8/3 its momentum. */
START_TEST(solitons_have_known_invariants)
{
  density_field field = make_kdv("fourier:modes=40,points=128");
  double start = 5, invariant[2];
  set_density(&field, soliton, NULL, &start);
  ck_assert_int_eq(dvi_system_momentum(field.system, 0, field.q, field.q, field.p), DVI_OK);
  ck_assert_int_eq(dvi_system_invariants(field.system, 0, field.q, field.p, invariant), DVI_OK);
  ck_assert_double_eq_tol(invariant[0], -32.0 / 5, 1e-5);
  /* -p.D psi = -int psi_x^2/2 = -int u^2/2 + m int u - m^2 L/2 */
  ck_assert_double_eq_tol(invariant[1], 0.4 - 8.0 / 3, 1e-6);
  end_density(&field);
}
END_TEST

/* int u is no coordinate, and int u^2/2 is exact for M > 3 K. */
START_TEST(momentum_of_solitons_is_exact_without_aliasing)
{
  density_field field = make_kdv("fourier:modes=40,points=128");
  double start = 5, before[2], after[2];
  set_density(&field, soliton, NULL, &start);
  ck_assert_int_eq(dvi_system_momentum(field.system, 0, field.q, field.q, field.p), DVI_OK);
  ck_assert_int_eq(dvi_system_invariants(field.system, 0, field.q, field.p, before), DVI_OK);
  run_density(&field, "vprk:nodes=1", 0, 0.01, 50);
  ck_assert_int_eq(dvi_system_invariants(field.system, 0.5, field.q, field.p, after), DVI_OK);
  ck_assert_double_eq_tol(after[1], before[1], 1e-13);
  end_density(&field);
}
END_TEST

/* The dispersion u_xxx has the frequencies (2 pi k/20)^3, and methods of leapfrog's kind are stable
 * up to sin(theta) = h omega = 1. */
START_TEST(explicit_methods_of_first_order_know_their_largest_step)
{
  static const char *const methods[] = {"hp:type=2", "hp:type=3", "dg-phase"};
  density_field field = make_kdv("fourier:modes=40,points=128");
  dvi_system_terms terms;
  double start = 5;
  ck_assert_int_eq(dvi_density_system_terms(field.density, &terms), DVI_OK);
  const double omega = terms.potentials[0].fastest, exact = pow(2 * pi * 40 / 20, 3);
  ck_assert_double_eq_tol(omega, exact, 1e-3 * exact);
  set_density(&field, soliton, NULL, &start);
  ck_assert_int_eq(dvi_system_momentum(field.system, 0, field.q, field.q, field.p), DVI_OK);
  for (int i = 0; i < 3; i++) {
    dvi_integrator *integrator = NULL;
    ck_assert_int_eq(dvi_integrator_create(field.system, methods[i], &integrator), DVI_OK);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, field.q, field.p), DVI_OK);
    ck_assert_int_eq(dvi_integrator_step(integrator, 1.01 / exact), DVI_STEP_TOO_LARGE);
    ck_assert(strstr(dvi_last_error(), "vprk") != NULL);
    ck_assert_int_eq(dvi_integrator_step(integrator, 0.99 / exact), DVI_OK);
    dvi_integrator_destroy(&integrator);
  }
  end_density(&field);
}
END_TEST

/* A full Hessian of 361 coordinates is not declared. The midpoint rule iterates with that of the
 * quadratic part, and has the same motion as with all Hessians (289 coordinates). */
START_TEST(large_fields_go_without_full_hessians)
{
  static const char *const spaces[] = {"fourier:modes=8,points=24", "fourier:modes=9,points=24"};
  const double x[2] = {0.3, 0.4};
  double u[2];
  for (int i = 0; i < 2; i++) {
    const dvi_density_part parts[] = {kinetic_part, elastic_part_2d, sine_gordon_part};
    density_field field = make_field(spaces[i], 2, parts, 3);
    dvi_system_terms terms;
    ck_assert_int_eq(dvi_density_system_terms(field.density, &terms), DVI_OK);
    ck_assert_int_eq(terms.potentials[1].without_hessian, i);
    ck_assert_int_eq(terms.potentials[1].hessian == NULL, i);
    set_density(&field, start_2d, rate_2d, NULL);
    run_density(&field, "midpoint", 0, 0.05, 10);
    u[i] = density_at(&field, 0.5, x);
    end_density(&field);
  }
  ck_assert_double_eq_tol(u[0], u[1], 1e-7);
}
END_TEST

/* Static states of the pendula's chain under a constant torque: sin u = 1/2. */
static int tilted(int count, double t, const double *x, const double *z, double *l, double *l_z,
                  double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = cos(z[k]) + 0.5 * z[k];
    if (l_z != NULL) l_z[k] = 0.5 - sin(z[k]);
    if (l_zz != NULL) l_zz[k] = -cos(z[k]);
  }
  return 0;
}

START_TEST(static_states_are_found_by_full_hessians)
{
  static const char *const spaces[] = {"fourier:modes=8", "fourier:modes=9"};
  for (int i = 0; i < 2; i++) {
    dvi_density_part parts[] = {kinetic_part, i == 0 ? elastic_part : elastic_part_2d,
                                sine_gordon_part};
    parts[2].density = tilted;
    density_field field = make_field(spaces[i], 1 + i, parts, 3);
    const double x[2] = {0.3, 0.4};
    set_density(&field, i == 0 ? bump : start_2d, NULL, NULL);
    memset(field.q, 0, (size_t)field.n * sizeof(double));
    ck_assert_msg(dvi_density_solve(field.density, field.U, NULL) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_eq(dvi_density_project(field.density, field.U, NULL, field.q, NULL, NULL),
                     DVI_OK);
    ck_assert_double_eq_tol(density_at(&field, 0, x), pi / 6, 1e-12);
    end_density(&field);
  }
}
END_TEST

SUITE(density_fourier)
{
  tcase_add_test(tests, callbacks_agree_with_differences);
  tcase_add_test(tests, mass_is_one_and_stiffness_diagonal);
  tcase_add_test(tests, fastest_frequency_is_that_of_the_stable_modes);
  tcase_add_test(tests, coefficients_that_vary_have_a_potential_of_their_own);
  tcase_add_test(tests, masses_that_vary_are_refused);
  tcase_add_test(tests, momentum_is_exact_without_aliasing);
  tcase_add_test(tests, momenta_of_two_axes_are_exact_without_aliasing);
  tcase_add_test(tests, pendula_on_a_torus_have_a_known_state);
  tcase_add_test(tests, solitons_have_the_errors_of_the_poisson_form);
  tcase_add_test(tests, solitons_on_splines_have_the_order_of_a_slope);
  tcase_add_test(tests, kdv_agrees_with_differences);
  tcase_add_test(tests, solitons_have_known_invariants);
  tcase_add_test(tests, momentum_of_solitons_is_exact_without_aliasing);
  tcase_add_test(tests, explicit_methods_of_first_order_know_their_largest_step);
  tcase_add_test(tests, large_fields_go_without_full_hessians);
  tcase_add_test(tests, static_states_are_found_by_full_hessians);
}
