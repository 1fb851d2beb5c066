/* Fields that went wrong once: shifts at eigenvalues, materials of all sizes, numbers too large. */
#include <dvi/field.h>
#include <dvi/integrator.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/suite.h"

static dvi_mesh *box(int n, int cells, int periodic)
{
  dvi_mesh *mesh = NULL;
  dvi_generator_options options = {.size = sizeof options, .dimension = n};
  for (int a = 0; a < n; a++) {
    options.cells[a] = cells;
    options.periodic[a] = periodic;
  }
  ck_assert_msg(dvi_mesh_generate("box", &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

/* Make a field of a density and a stiffness, each NULL for 1. The mesh is then the field's. */
static dvi_field *field_of(dvi_mesh *mesh, dvi_star_kind kind, const double *rho, const double *a,
                           const dvi_condition *condition, int conditions)
{
  const double *const factor[DVI_MESH_DIMENSION_MAX + 1] = {rho, a};
  const dvi_star_options options = {
      .size = sizeof options, .kind = kind, .factor = rho || a ? factor : NULL};
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  const dvi_wave_terms terms = {
      .size = sizeof terms, .star = star, .condition = condition, .conditions = conditions};
  ck_assert_msg(dvi_wave_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
  return field;
}

/* ---- modes ---- */

/* A periodic grid of 6^3 boxes has the eigenvalues 0, 36 six times, 72 twelve times. */
START_TEST(shifts_at_an_eigenvalue_find_no_others)
{
  dvi_field *field = field_of(box(3, 6, 1), DVI_CIRCUMCENTRIC, NULL, NULL, NULL, 0);
  for (int i = 0; i < 14; i++) {
    double eigenvalue[8];
    const dvi_modes_options options = {
        .size = sizeof options, .count = 8, .shift = 36 * (1 + (i < 13 ? pow(10, -i - 3) : 0))};
    ck_assert_msg(dvi_field_modes(field, &options, eigenvalue, NULL, NULL) == DVI_OK, "%s",
                  dvi_last_error());
    for (int k = 1; k < 8; k++) ck_assert(eigenvalue[k] >= eigenvalue[k - 1]);
    for (int k = 0; k < 8; k++)
      ck_assert_msg(fabs(eigenvalue[k] - (k < 6 ? 36 : 72)) < 1e-7,
                    "shift 36 + 36e-%d: mode %d: %.12g", i + 3, k, eigenvalue[k]);
  }
  dvi_field_destroy(&field);
}
END_TEST

/* A diagonal pencil has the eigenvalues that stand in it. */
static void check_diagonal(int n, const double *K, double shift, int count, const double *expected)
{
  double one[128], eigenvalue[16], size = 0;
  for (int i = 0; i < n; i++) {
    one[i] = 1;
    size = fmax(size, K[i]);
  }
  const dvi_matrix of_K = {.rows = n, .columns = n, .width = 1, .symmetric = 1, .value = K},
                   of_M = {.rows = n, .columns = n, .width = 1, .symmetric = 1, .value = one};
  const dvi_modes_options options = {.size = sizeof options, .count = count, .shift = shift};
  ck_assert_msg(dvi_matrix_modes(&of_K, &of_M, &options, eigenvalue, NULL) == DVI_OK, "%g: %s",
                shift, dvi_last_error());
  for (int k = 0; k < count; k++)
    ck_assert_msg(fabs(eigenvalue[k] - expected[k]) < 1e-9 * size, "shift %g: mode %d: %.12g",
                  shift, k, eigenvalue[k]);
}

START_TEST(tiny_shifts_of_singular_matrices_are_taken)
{
  static const double shift[] = {1e-300, -1e-300, 1e-14, -1e-14, 1e-8}, lowest[] = {0, 1, 2, 3, 4};
  double K[100];
  for (int i = 0; i < 100; i++) K[i] = i;
  for (int i = 0; i < 5; i++) check_diagonal(100, K, shift[i], 5, lowest);
}
END_TEST

/* Of two clusters on both sides of an eigenvalue the nearer one is found. */
START_TEST(nearer_cluster_is_found)
{
  static const double nearest[] = {0, 0, 0, 0, 0, 1};
  double K[100];
  for (int i = 0; i < 100; i++) K[i] = i < 10 ? 0 : i == 10 ? 1 : i < 21 ? 2.0005 : 10 + i;
  check_diagonal(100, K, 1, 6, nearest);
}
END_TEST

START_TEST(shifts_that_are_no_numbers_are_refused)
{
  static const double shift[] = {NAN, INFINITY, -INFINITY};
  for (int cells = 4; cells <= 12; cells += 8) {
    dvi_field *field = field_of(box(2, cells, 0), DVI_CIRCUMCENTRIC, NULL, NULL, NULL, 0);
    for (int i = 0; i < 3; i++) {
      double eigenvalue[2];
      const dvi_modes_options options = {.size = sizeof options, .count = 2, .shift = shift[i]};
      ck_assert_int_eq(dvi_field_modes(field, &options, eigenvalue, NULL, NULL), DVI_BAD_ARGUMENT);
    }
    dvi_field_destroy(&field);
  }
}
END_TEST

/* The bound is compared with all eigenvalues, found by LAPACK. */
START_TEST(fastest_frequency_bounds_all_others)
{
  enum { CELLS = 8, ALL = CELLS * CELLS, POINTS = (CELLS + 1) * (CELLS + 1) };
  unsigned long long seed = 41584;
  double worst = 1;
  for (int trial = 0; trial < repeats(600); trial++) {
    double rho[ALL], a[ALL], eigenvalue[POINTS - 1], omega;
    const double spread = 1 + 3 * random_number(&seed);
    for (int i = 0; i < ALL; i++) {
      a[i] = exp(spread * (2 * random_number(&seed) - 1));
      rho[i] = exp(spread * (2 * random_number(&seed) - 1));
    }
    const dvi_modes_options all = {.size = sizeof all, .count = POINTS - 1};
    dvi_field *field = field_of(box(2, CELLS, 0), DVI_CIRCUMCENTRIC, rho, a, NULL, 0);
    ck_assert_int_eq(dvi_field_modes(field, &all, eigenvalue, NULL, NULL), DVI_OK);
    ck_assert_int_eq(dvi_field_fastest(field, &omega), DVI_OK);
    const double ratio = omega / sqrt(eigenvalue[POINTS - 2]);
    ck_assert_msg(ratio > 1 - 1e-12 && ratio < 1.001, "trial %d: %g", trial, ratio);
    worst = fmax(worst, ratio);
    dvi_field_destroy(&field);
  }
  ck_assert(worst > 1); /* something was measured */
}
END_TEST

/* Strings of springs of all sizes, and two disjoint ones of which the lighter one is the faster. */
START_TEST(fastest_frequency_has_no_scale)
{
  static const double size[] = {1e-200, 1e-165, 1, 1e155, 1e200};
  for (int i = 0; i < 5; i++) {
    double a[8], reference = 0, omega;
    for (int k = 0; k < 2; k++) {
      for (int c = 0; c < 8; c++) a[c] = (k == 0 ? 1 : size[i]) * (1 + c);
      dvi_field *field = field_of(box(1, 8, 0), DVI_CIRCUMCENTRIC, NULL, a, NULL, 0);
      ck_assert_int_eq(dvi_field_fastest(field, &omega), DVI_OK);
      if (k == 0) reference = omega;
      dvi_field_destroy(&field);
    }
    ck_assert_double_eq_tol(omega / sqrt(size[i]) / reference, 1, 1e-3);
  }
}
END_TEST

START_TEST(light_and_heavy_parts_have_one_bound)
{
  enum { CELLS = 40 };
  for (int i = 0; i < 8; i++) {
    double a[CELLS], rho[CELLS], eigenvalue[CELLS - 1], omega;
    const double ratio = 1 + pow(2, -i - 2);
    for (int c = 0; c < CELLS; c++) {
      const int heavy = c >= CELLS / 2;
      rho[c] = heavy ? 1e6 : 1e-6;
      a[c] = c == CELLS / 2 || c == CELLS / 2 - 1 ? 0 : rho[c] * (heavy ? ratio : 1);
      if (c == 10 || c == 30) a[c] *= 1.8;
    }
    dvi_field *field = field_of(box(1, CELLS, 0), DVI_CIRCUMCENTRIC, rho, a, NULL, 0);
    const dvi_modes_options all = {.size = sizeof all, .count = CELLS - 1};
    ck_assert_int_eq(dvi_field_modes(field, &all, eigenvalue, NULL, NULL), DVI_OK);
    ck_assert_int_eq(dvi_field_fastest(field, &omega), DVI_OK);
    ck_assert_msg(omega > (1 - 1e-9) * sqrt(eigenvalue[CELLS - 2]), "ratio %g: %.9g below %.9g",
                  ratio, omega, sqrt(eigenvalue[CELLS - 2]));
    dvi_field_destroy(&field);
  }
}
END_TEST

START_TEST(a_field_without_stiffness_has_no_frequency)
{
  static const double zero[9];
  dvi_system *system = NULL;
  double omega = 1;
  dvi_field *field = field_of(box(2, 3, 0), DVI_CIRCUMCENTRIC, NULL, zero, NULL, 0);
  ck_assert_msg(dvi_field_fastest(field, &omega) == DVI_OK, "%s", dvi_last_error());
  ck_assert(omega == 0);
  ck_assert_msg(dvi_field_system(field, &system) == DVI_OK, "%s", dvi_last_error());
  dvi_system_destroy(&system);
  dvi_field_destroy(&field);
}
END_TEST

/* ---- statics ---- */

static int one(const double *x, const double *normal, double *datum, void *user)
{
  (void)x, (void)normal;
  *datum = *(const double *)user;
  return 0;
}

/* Half of an interval is softer by 10^-17. The solution falls from 1 to 0 in it. */
START_TEST(soft_beside_stiff_is_solved)
{
  const double datum = 1, expected[] = {0, 0, 0, 0, 0, 0, 0.2, 0.4, 0.6, 0.8, 1};
  const dvi_condition ends[] = {
      {.part = "left", .kind = DVI_FIXED},
      {.part = "right", .kind = DVI_FIXED, .datum = one, .user = (void *)&datum}};
  for (int e = 0; e <= 40; e++) {
    double a[10], u[11];
    for (int i = 0; i < 10; i++) a[i] = i < 5 ? 1 : pow(10, -e);
    dvi_field *field = field_of(box(1, 10, 0), DVI_CIRCUMCENTRIC, NULL, a, ends, 2);
    ck_assert_int_eq(dvi_field_solve(field, NULL, u, NULL), DVI_OK);
    for (int i = 5; i < 11; i++) {
      const double stiff = a[9] / (1 + a[9]), right = stiff + (1 - stiff) * expected[i];
      ck_assert_msg(fabs(u[i] - right) < 1e-13, "10^-%d: u_%d = %g, not %g", e, i, u[i], right);
    }
    dvi_field_destroy(&field);
  }
}
END_TEST

static int huge(const double *x, double *f, void *user)
{
  (void)x;
  *f = *(const double *)user;
  return 0;
}

START_TEST(numbers_that_overflow_are_refused)
{
  static const dvi_condition rim = {.part = "boundary", .kind = DVI_FIXED};
  static const struct {
    double source, extent;
    dvi_status created, solved;
  } cases[] = {{1e308, 1000, DVI_NOT_FINITE, DVI_OK}, {1e300, 1, DVI_OK, DVI_OK}};
  for (int i = 0; i < 2; i++) {
    dvi_mesh *mesh = NULL;
    dvi_star *star = NULL;
    dvi_field *field = NULL;
    double u[81];
    dvi_field_solve_report report;
    const dvi_generator_options options = {
        .size = sizeof options, .cells = {8, 8}, .extent = {cases[i].extent, cases[i].extent}};
    ck_assert_int_eq(dvi_mesh_generate("box", &options, &mesh), DVI_OK);
    ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_OK);
    const dvi_wave_terms terms = {.size = sizeof terms,
                                  .star = star,
                                  .condition = &rim,
                                  .conditions = 1,
                                  .source = huge,
                                  .source_user = (void *)&cases[i].source};
    ck_assert_int_eq(dvi_wave_create(&terms, &field), cases[i].created);
    if (field != NULL) {
      ck_assert_int_eq(dvi_field_solve(field, NULL, u, &report), cases[i].solved);
      ck_assert(report.residual < 1e-14);
    }
    dvi_field_destroy(&field);
    dvi_star_destroy(&star);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

static int no_number(int64_t count, const double *x, const double *u, double *V, double *V_u,
                     double *V_uu, void *user)
{
  (void)x, (void)user;
  for (int64_t i = 0; i < count; i++) {
    if (V != NULL) V[i] = 0;
    if (V_u != NULL) V_u[i] = u[i] > 1e300 ? 0 : NAN;
    if (V_uu != NULL) V_uu[i] = 1;
  }
  return 0;
}

START_TEST(a_potential_without_a_slope_is_named)
{
  static const dvi_field_potential potential = {.density = no_number};
  dvi_mesh *mesh = box(1, 4, 0);
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  double u[5] = {0};
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_OK);
  const dvi_wave_terms terms = {.size = sizeof terms, .star = star, .potential = &potential};
  ck_assert_int_eq(dvi_wave_create(&terms, &field), DVI_OK);
  ck_assert_int_eq(dvi_field_solve(field, NULL, u, NULL), DVI_NOT_FINITE);
  ck_assert_ptr_nonnull(strstr(dvi_last_error(), "vertex 0"));
  dvi_field_destroy(&field);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- the spectral star ---- */

/* A wave of the spectral star has no error of its wave number: after one period it is back. */
START_TEST(spectral_fields_are_systems)
{
  const double pi = acos(-1.0);
  for (int cells = 3; cells <= 14; cells++) {
    dvi_system *system = NULL;
    dvi_integrator *integrator = NULL;
    double q[14], p[14] = {0};
    dvi_field *field = field_of(box(1, cells, 1), DVI_SPECTRAL, NULL, NULL, NULL, 0);
    ck_assert_msg(dvi_field_system(field, &system) == DVI_OK, "%s", dvi_last_error());
    for (int i = 0; i < cells; i++) q[i] = cos(2 * pi * i / cells);
    ck_assert_msg(dvi_integrator_create(system, "galerkin:degree=8", &integrator) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
    for (int i = 0; i < 50; i++) ck_assert_int_eq(dvi_integrator_step(integrator, 0.02), DVI_OK);
    for (int i = 0; i < cells; i++)
      ck_assert_double_eq_tol(dvi_integrator_q(integrator)[i], q[i], 1e-12);
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&system);
    dvi_field_destroy(&field);
  }
}
END_TEST

SUITE(hard_fields)
{
  tcase_add_test(tests, shifts_at_an_eigenvalue_find_no_others);
  tcase_add_test(tests, tiny_shifts_of_singular_matrices_are_taken);
  tcase_add_test(tests, nearer_cluster_is_found);
  tcase_add_test(tests, shifts_that_are_no_numbers_are_refused);
  tcase_add_test(tests, fastest_frequency_bounds_all_others);
  tcase_add_test(tests, fastest_frequency_has_no_scale);
  tcase_add_test(tests, light_and_heavy_parts_have_one_bound);
  tcase_add_test(tests, a_field_without_stiffness_has_no_frequency);
  tcase_add_test(tests, soft_beside_stiff_is_solved);
  tcase_add_test(tests, numbers_that_overflow_are_refused);
  tcase_add_test(tests, a_potential_without_a_slope_is_named);
  tcase_add_test(tests, spectral_fields_are_systems);
}
