/* The spectral star of grids that repeat themselves. */
#include <dvi/field.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* A grid of dimension n with so many cells along each axis of length 2 pi. */
static dvi_mesh *grid(int n, int cells)
{
  dvi_mesh *mesh = NULL;
  dvi_generator_options options = {.size = sizeof options, .dimension = n};
  for (int a = 0; a < n; a++) {
    options.cells[a] = cells + a;
    options.extent[a] = 2 * pi;
    options.periodic[a] = 1;
  }
  ck_assert_msg(dvi_mesh_generate("box", &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

static dvi_star *spectral(const dvi_mesh *mesh)
{
  dvi_star *star = NULL;
  const dvi_star_options options = {.size = sizeof options, .kind = DVI_SPECTRAL};
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  return star;
}

static dvi_field *wave_on(const dvi_star *star, dvi_form_function *source)
{
  dvi_field *field = NULL;
  const dvi_wave_terms terms = {.size = sizeof terms, .star = star, .source = source};
  ck_assert_msg(dvi_wave_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  return field;
}

START_TEST(eigenvalues_are_squares_of_wave_numbers)
{
  enum { CELLS = 12 };
  double eigenvalue[CELLS];
  int64_t zeros;
  const dvi_modes_options options = {.size = sizeof options, .count = CELLS - 2};
  dvi_mesh *mesh = grid(1, CELLS);
  dvi_star *star = spectral(mesh);
  dvi_field *field = wave_on(star, NULL);
  ck_assert_msg(dvi_field_modes(field, &options, eigenvalue, NULL, &zeros) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(zeros, 1);
  for (int i = 0; i < CELLS - 2; i++) {
    const int k = i / 2 + 1;
    ck_assert_double_eq_tol(eigenvalue[i], k * k, 1e-12 * CELLS * CELLS);
  }
  dvi_field_destroy(&field);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(eigenvalues_of_a_plane_are_sums_of_squares)
{
  static const double expected[] = {1, 1, 1, 1, 2, 2, 2, 2, 4, 4, 4, 4, 5};
  enum { COUNT = sizeof expected / sizeof *expected };
  double eigenvalue[COUNT], omega;
  const dvi_modes_options options = {.size = sizeof options, .count = COUNT};
  dvi_mesh *mesh = grid(2, 7);
  dvi_star *star = spectral(mesh);
  dvi_field *field = wave_on(star, NULL);
  ck_assert_int_eq(dvi_field_modes(field, &options, eigenvalue, NULL, NULL), DVI_OK);
  for (int i = 0; i < COUNT; i++) ck_assert_double_eq_tol(eigenvalue[i], expected[i], 1e-11);
  ck_assert_int_eq(dvi_field_fastest(field, &omega), DVI_OK);
  ck_assert(omega >= 5 && omega < 5.01); /* 3^2 + 4^2 */
  dvi_field_destroy(&field);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* u = exp(sin x), and -u'' as its source. */
static int source(const double *x, double *f, void *user)
{
  (void)user;
  *f = (sin(x[0]) - cos(x[0]) * cos(x[0])) * exp(sin(x[0]));
  return 0;
}

static double error_at(int cells)
{
  const dvi_field_solve_options options = {.size = sizeof options, .imbalance = 0.5};
  dvi_mesh *mesh = grid(1, cells);
  dvi_star *star = spectral(mesh);
  dvi_field *field = wave_on(star, source);
  double *u = calloc((size_t)cells, sizeof *u), worst = 0;
  ck_assert_msg(dvi_field_solve(field, &options, u, NULL) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < cells; i++)
    worst = fmax(worst, fabs(u[i] - u[0] - exp(sin(dvi_mesh_points(mesh)[i])) + 1));
  free(u);
  dvi_field_destroy(&field);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
  return worst;
}

START_TEST(smooth_solutions_converge_exponentially)
{
  const double errors[] = {error_at(8), error_at(12), error_at(16), error_at(20)};
  for (int i = 1; i < 4; i++)
    ck_assert_msg(errors[i] < errors[i - 1] / 50, "%g, then %g", errors[i - 1], errors[i]);
  ck_assert(error_at(32) < 2e-13);
}
END_TEST

/* The sum over the cells of a wave's integral times that over the dual cell has the factor
 * sinc(j/N) for each axis, in each degree. */
static int plane_wave(const double *x, double *value, void *user)
{
  const int components = *(int *)user;
  for (int c = 0; c < components; c++) value[c] = cos(x[0] + 2 * x[1] - x[2] + c);
  return 0;
}

static double sinc(double s)
{
  return sin(pi * s) / (pi * s);
}

START_TEST(products_of_waves_are_known)
{
  const double each = 4 * pi * pi * pi * sinc(1 / 5.0) * sinc(2 / 6.0) * sinc(1 / 7.0);
  dvi_mesh *mesh = grid(3, 5);
  dvi_star *star = spectral(mesh);
  for (int k = 0; k <= 3; k++) {
    dvi_matrix M;
    int components = dvi_form_components(3, k);
    const int64_t count = dvi_mesh_count(mesh, k);
    double *a = calloc((size_t)(2 * count), sizeof *a), *Ma = a + count, product = 0;
    ck_assert_int_eq(dvi_form_integrate(mesh, k, plane_wave, &components, a), DVI_OK);
    ck_assert_int_eq(dvi_star_matrix(star, k, &M), DVI_OK);
    dvi_matrix_multiply(&M, 0, a, Ma);
    for (int64_t i = 0; i < count; i++) product += a[i] * Ma[i];
    ck_assert_double_eq_tol(product, components * each, 1e-6);
    free(a);
  }
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

static void refuse(const char *generator, const dvi_generator_options *options, const char *why)
{
  dvi_mesh *mesh = NULL;
  dvi_star *star = NULL;
  const dvi_star_options spectral_star = {.size = sizeof spectral_star, .kind = DVI_SPECTRAL};
  ck_assert_int_eq(dvi_mesh_generate(generator, options, &mesh), DVI_OK);
  dvi_status status = dvi_star_create(mesh, &spectral_star, &star);
  dvi_matrix M;
  ck_assert_int_eq(status == DVI_OK, strcmp(why, "entries") == 0); /* asked for by the matrix */
  if (status == DVI_OK) status = dvi_star_matrix(star, 1, &M);
  ck_assert_int_ne(status, DVI_OK);
  ck_assert_msg(strstr(dvi_last_error(), why) != NULL, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}

START_TEST(other_meshes_are_refused)
{
  refuse("box", &(dvi_generator_options){.size = sizeof(dvi_generator_options), .cells = {4, 4}},
         "repeat itself");
  refuse("kuhn-torus",
         &(dvi_generator_options){.size = sizeof(dvi_generator_options), .cells = {4, 4}},
         "simplices");
  refuse("box",
         &(dvi_generator_options){.size = sizeof(dvi_generator_options),
                                  .cells = {4, 4},
                                  .periodic = {1, 1},
                                  .grading = {1, 1.5}},
         "the boxes");
  refuse("box",
         &(dvi_generator_options){
             .size = sizeof(dvi_generator_options), .cells = {200, 200}, .periodic = {1, 1}},
         "entries");
}
END_TEST

SUITE(spectral)
{
  tcase_add_test(tests, eigenvalues_are_squares_of_wave_numbers);
  tcase_add_test(tests, eigenvalues_of_a_plane_are_sums_of_squares);
  tcase_add_test(tests, smooth_solutions_converge_exponentially);
  tcase_add_test(tests, products_of_waves_are_known);
  tcase_add_test(tests, other_meshes_are_refused);
}
