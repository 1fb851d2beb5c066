/* Codifferentials, Laplacians, Hodge's decomposition, harmonic forms. */
#include <dvi/forms.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

static dvi_star *star_of(const dvi_mesh *mesh, dvi_star_kind kind)
{
  dvi_star *star = NULL;
  const dvi_star_options options = {.size = sizeof options, .kind = kind};
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  return star;
}

static dvi_mesh *generated(const char *name, int dimension, int cells)
{
  dvi_mesh *mesh = NULL;
  dvi_generator_options options = {.size = sizeof options, .dimension = dimension};
  for (int i = 0; i < (dimension > 0 ? dimension : 1); i++) options.cells[i] = cells;
  ck_assert_msg(dvi_mesh_generate(name, &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

static double *random_form(const dvi_mesh *mesh, int k, unsigned long long seed)
{
  const int64_t count = dvi_mesh_count(mesh, k);
  double *form = malloc((size_t)count * sizeof *form);
  for (int64_t i = 0; i < count; i++) form[i] = random_number(&seed) - 0.5;
  return form;
}

static double product(const dvi_star *star, int k, const double *a, const double *b)
{
  dvi_matrix M;
  ck_assert_int_eq(dvi_star_matrix(star, k, &M), DVI_OK);
  double sum = 0, *Mb = malloc((size_t)M.rows * sizeof *Mb);
  dvi_matrix_multiply(&M, 0, b, Mb);
  for (int64_t i = 0; i < M.rows; i++) sum += a[i] * Mb[i];
  free(Mb);
  return sum;
}

static double length(const dvi_star *star, int k, const double *a)
{
  return sqrt(product(star, k, a, a));
}

/* ---- matrices ---- */

START_TEST(codifferential_squares_to_zero)
{
  dvi_mesh *mesh = generated("box", 3, 3);
  dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
  for (int k = 2; k <= 3; k++) {
    dvi_matrix *upper = NULL, *lower = NULL;
    ck_assert_int_eq(dvi_form_codifferential_create(star, k, &upper), DVI_OK);
    ck_assert_int_eq(dvi_form_codifferential_create(star, k - 1, &lower), DVI_OK);
    double *form = random_form(mesh, k, 3), *once = random_form(mesh, k - 1, 3),
           *twice = random_form(mesh, k - 2, 3);
    dvi_matrix_multiply(upper, 0, form, once);
    dvi_matrix_multiply(lower, 0, once, twice);
    for (int64_t i = 0; i < dvi_mesh_count(mesh, k - 2); i++) ck_assert(fabs(twice[i]) < 1e-10);
    free(form), free(once), free(twice);
    dvi_matrix_destroy(&upper);
    dvi_matrix_destroy(&lower);
  }
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Without values at the boundary: Neumann's eigenvalues, one of which is zero. */
START_TEST(staggered_triangles_have_the_eigenvalues_of_the_square)
{
  static const double expected[] = {0, 9.743283624691, 9.755353316864};
  const dvi_modes_options options = {.size = sizeof options, .count = 3, .shift = -1};
  dvi_mesh *mesh = staggered_mesh(8, 8);
  dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
  dvi_matrix *K = NULL, M;
  double eigenvalue[3];
  ck_assert_int_eq(dvi_form_laplacian_create(star, 0, &K), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(star, 0, &M), DVI_OK);
  ck_assert_msg(dvi_matrix_modes(K, &M, &options, eigenvalue, NULL) == DVI_OK, "%s",
                dvi_last_error());
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(eigenvalue[i], expected[i], 2e-11);
  dvi_matrix_destroy(&K);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The spectrum of L_1 on a grid of squares is that of the functions, once for exact and once for
 * coexact forms, and two harmonic forms of the torus. */
START_TEST(forms_on_a_torus_share_the_spectrum_of_functions)
{
  const int cells = 6;
  const double h = 1.0 / cells, lowest = 4 * pow(sin(pi * h), 2) / (h * h);
  const dvi_modes_options options = {.size = sizeof options, .count = 10, .shift = -1};
  dvi_generator_options sizes = {.size = sizeof sizes, .cells = {6, 6}, .periodic = {1, 1}};
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate("box", &sizes, &mesh), DVI_OK);
  dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
  dvi_matrix *L = NULL, M;
  double eigenvalue[10];
  ck_assert_int_eq(dvi_form_laplacian_create(star, 1, &L), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(star, 1, &M), DVI_OK);
  ck_assert_int_eq(dvi_matrix_modes(L, &M, &options, eigenvalue, NULL), DVI_OK);
  for (int i = 0; i < 10; i++)
    ck_assert_double_eq_tol(eigenvalue[i], i < 2 ? 0 : lowest, 1e-10 * lowest);
  dvi_matrix_destroy(&L);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- decompositions ---- */

static void check_decomposition(const dvi_star *star, int k, const char *held)
{
  const dvi_mesh *mesh = dvi_star_mesh(star);
  const int64_t count = dvi_mesh_count(mesh, k);
  double *part[3], *form = random_form(mesh, k, 5);
  int64_t cells = 0;
  const int *cell = held != NULL ? dvi_mesh_part_cells(mesh, held, k, &cells) : NULL;
  for (int64_t i = 0; i < cells; i++) form[cell[i]] = 0;
  for (int i = 0; i < 3; i++) part[i] = malloc((size_t)count * sizeof(double));
  ck_assert_msg(dvi_form_decompose(star, k, held, form, part[0], part[1], part[2]) == DVI_OK, "%s",
                dvi_last_error());
  const double whole = length(star, k, form);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < i; j++)
      ck_assert_double_eq_tol(product(star, k, part[i], part[j]), 0, 1e-12 * whole * whole);
  for (int64_t i = 0; i < count; i++)
    ck_assert_double_eq_tol(part[0][i] + part[1][i] + part[2][i], form[i], 1e-12);
  for (int i = 0; i < 3; i++) free(part[i]);
  free(form);
}

static void check_all_decompositions(dvi_mesh *mesh, dvi_star_kind kind)
{
  dvi_star *star = star_of(mesh, kind);
  for (int k = 0; k <= dvi_mesh_dimension(mesh); k++) {
    check_decomposition(star, k, NULL);
    check_decomposition(star, k, "boundary");
  }
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}

START_TEST(parts_of_a_form_are_orthogonal_and_add_up)
{
  check_all_decompositions(staggered_mesh(5, 4), DVI_CIRCUMCENTRIC);
  check_all_decompositions(staggered_mesh(5, 4), DVI_WHITNEY);
  check_all_decompositions(generated("box", 3, 3), DVI_CIRCUMCENTRIC);
  check_all_decompositions(jittered_mesh(3, 3, 2, 0.1, 7), DVI_WHITNEY);
  check_all_decompositions(generated("icosphere", 0, 1), DVI_CIRCUMCENTRIC);
}
END_TEST

START_TEST(torus_has_as_many_harmonic_forms_as_its_betti_numbers)
{
  static const int betti[] = {1, 3, 3, 1};
  dvi_mesh *mesh = generated("kuhn-torus", 3, 3);
  dvi_star *star = star_of(mesh, DVI_WHITNEY);
  for (int k = 0; k <= 3; k++) {
    int64_t count = 0;
    ck_assert_msg(dvi_form_harmonic(star, k, NULL, &count, NULL) == DVI_OK, "%s", dvi_last_error());
    ck_assert_int_eq(count, betti[k]);
  }
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* A square with a square hole, of 32 of 36 boxes. The field around the hole is absolute, and the
 * one from its rim to the outer rim is relative. */
static dvi_mesh *square_with_hole(void)
{
  enum { SIDE = 6 };
  double point[(SIDE + 1) * (SIDE + 1) * 2];
  int vertex[SIDE * SIDE * 4], cells = 0, number[(SIDE + 1) * (SIDE + 1)], points = 0;
  for (int y = 0; y <= SIDE; y++)
    for (int x = 0; x <= SIDE; x++) {
      number[y * (SIDE + 1) + x] = x == 3 && y == 3 ? -1 : points;
      if (x == 3 && y == 3) continue;
      point[2 * points] = x;
      point[2 * points++ + 1] = y;
    }
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++) {
      if ((x == 2 || x == 3) && (y == 2 || y == 3)) continue;
      for (int c = 0; c < 4; c++)
        vertex[4 * cells + c] = number[(y + c / 2) * (SIDE + 1) + x + c % 2];
      cells++;
    }
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .kind = DVI_BOXES,
                                .dimension = 2,
                                .points = points,
                                .point = point,
                                .cells = cells,
                                .vertex = vertex};
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

START_TEST(hole_has_one_harmonic_field_of_each_kind)
{
  static const int absolute[] = {1, 1, 0}, relative[] = {0, 1, 1};
  static const dvi_star_kind kinds[] = {DVI_CIRCUMCENTRIC, DVI_WHITNEY};
  dvi_mesh *mesh = square_with_hole();
  for (int i = 0; i < 2; i++) {
    dvi_star *star = star_of(mesh, kinds[i]);
    for (int k = 0; k <= 2; k++) {
      int64_t count = 0;
      ck_assert_int_eq(dvi_form_harmonic(star, k, NULL, &count, NULL), DVI_OK);
      ck_assert_int_eq(count, absolute[k]);
      ck_assert_int_eq(dvi_form_harmonic(star, k, "boundary", &count, NULL), DVI_OK);
      ck_assert_int_eq(count, relative[k]);
    }
    dvi_star_destroy(&star);
  }
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Where one rim of an annulus is held and the other one is free, there is no harmonic form. */
START_TEST(mixed_conditions_leave_no_harmonic_form)
{
  static const dvi_star_kind kinds[] = {DVI_CIRCUMCENTRIC, DVI_WHITNEY};
  dvi_mesh *mesh = generated("annulus", 0, 0);
  for (int i = 0; i < 2; i++) {
    dvi_star *star = star_of(mesh, kinds[i]);
    for (int k = 0; k <= 2; k++) {
      int64_t count = -1, held;
      double *f = random_form(mesh, k, 3), *u = random_form(mesh, k, 1);
      ck_assert_int_eq(dvi_form_harmonic(star, k, "inner", &count, NULL), DVI_OK);
      ck_assert_int_eq(count, 0);
      check_decomposition(star, k, "inner");
      ck_assert_msg(dvi_form_solve(star, k, "inner", f, u) == DVI_OK, "%s", dvi_last_error());
      const int *cell = dvi_mesh_part_cells(mesh, "inner", k, &held);
      for (int64_t j = 0; j < held; j++) ck_assert(u[cell[j]] == 0);
      free(f), free(u);
    }
    dvi_star_destroy(&star);
  }
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* K u = M_0 f at all vertices that are not held. */
START_TEST(mixed_problems_of_functions_are_solved)
{
  dvi_mesh *mesh = generated("annulus", 0, 0);
  dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
  double *f = random_form(mesh, 0, 3), *u = random_form(mesh, 0, 1), *Ku = random_form(mesh, 0, 1);
  int64_t held, at = 0;
  dvi_matrix *K = NULL;
  dvi_matrix M;
  const int *vertex = dvi_mesh_part_cells(mesh, "inner", 0, &held);
  ck_assert_int_eq(dvi_form_solve(star, 0, "inner", f, u), DVI_OK);
  ck_assert_int_eq(dvi_form_laplacian_create(star, 0, &K), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(star, 0, &M), DVI_OK);
  dvi_matrix_multiply(K, 0, u, Ku);
  for (int64_t v = 0; v < K->rows; v++) {
    const bool is_held = at < held && vertex[at] == v;
    at += is_held;
    if (!is_held) ck_assert_double_eq_tol(Ku[v], M.value[v] * f[v], 1e-12);
  }
  free(f), free(u), free(Ku);
  dvi_matrix_destroy(&K);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The form that goes from the hole to the outer rim vanishes on both, in Whitney's star, too. Its
 * derivative vanishes, and so does its product with the derivative of every function that vanishes
 * there. */
START_TEST(relative_form_is_closed_and_coclosed)
{
  dvi_mesh *mesh = square_with_hole();
  dvi_star *star = star_of(mesh, DVI_WHITNEY);
  const int64_t edges = dvi_mesh_count(mesh, 1);
  double *h = random_form(mesh, 1, 1), *Mh = random_form(mesh, 1, 1), *dh = random_form(mesh, 2, 1),
         *delta = random_form(mesh, 0, 1);
  int64_t count = 0, held;
  dvi_matrix M, d0, d1;
  ck_assert_int_eq(dvi_form_harmonic(star, 1, "boundary", &count, h), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(star, 1, &M), DVI_OK);
  ck_assert_int_eq(dvi_mesh_incidence(mesh, 0, &d0), DVI_OK);
  ck_assert_int_eq(dvi_mesh_incidence(mesh, 1, &d1), DVI_OK);
  const int *edge = dvi_mesh_part_cells(mesh, "boundary", 1, &held);
  for (int64_t i = 0; i < held; i++) ck_assert(h[edge[i]] == 0);
  dvi_matrix_multiply(&d1, 0, h, dh);
  for (int64_t i = 0; i < dvi_mesh_count(mesh, 2); i++) ck_assert(fabs(dh[i]) < 1e-13);
  dvi_matrix_multiply(&M, 0, h, Mh);
  dvi_matrix_multiply(&d0, 1, Mh, delta);
  const int *vertex = dvi_mesh_part_cells(mesh, "boundary", 0, &held);
  for (int64_t i = 0; i < held; i++) delta[vertex[i]] = 0;
  for (int64_t i = 0; i < dvi_mesh_count(mesh, 0); i++) ck_assert(fabs(delta[i]) < 1e-13);
  double square = 0;
  for (int64_t i = 0; i < edges; i++) square += h[i] * Mh[i];
  ck_assert_double_eq_tol(square, 1, 1e-12);
  free(h), free(Mh), free(dh), free(delta);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- Poisson's equation ---- */

/* L_k of the solution is the right side, from which the harmonic part has been taken. */
static void check_solution(const dvi_star *star, int k)
{
  const dvi_mesh *mesh = dvi_star_mesh(star);
  const int64_t count = dvi_mesh_count(mesh, k);
  double *f = random_form(mesh, k, 11), *h = random_form(mesh, k, 1), *u = random_form(mesh, k, 1),
         *Lu = random_form(mesh, k, 1);
  dvi_matrix *L = NULL;
  ck_assert_int_eq(dvi_form_decompose(star, k, NULL, f, NULL, NULL, h), DVI_OK);
  for (int64_t i = 0; i < count; i++) f[i] -= h[i];
  ck_assert_msg(dvi_form_solve(star, k, NULL, f, u) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_form_laplacian_create(star, k, &L), DVI_OK);
  dvi_matrix_multiply(L, 0, u, Lu);
  ck_assert_int_eq(dvi_star_solve(star, k, Lu), DVI_OK);
  for (int64_t i = 0; i < count; i++) ck_assert_double_eq_tol(Lu[i], f[i], 1e-11);
  dvi_matrix_destroy(&L);
  free(f), free(h), free(u), free(Lu);
}

START_TEST(poisson_problems_are_solved_in_every_degree)
{
  dvi_mesh *mesh = square_with_hole();
  dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
  for (int k = 0; k <= 2; k++) check_solution(star, k);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* With all vertices held, d of functions vanishes, and the matrix has a large kernel into which
 * roundings lead. The solution is as large as the right side, whatever that is. */
START_TEST(solutions_scale_with_their_right_sides)
{
  static const double scale[] = {1e-250, 1e-150, 1e-3, 1e2, 1e3, 1e150};
  enum { POINTS = 16 };
  int all[POINTS];
  for (int v = 0; v < POINTS; v++) all[v] = v;
  dvi_mesh *plain = jittered_mesh(2, 2, 3, 0.2, 8), *mesh = NULL;
  const dvi_mesh_part part = {.name = "pins", .degree = 0, .count = POINTS, .cell = all};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .points = POINTS,
                                .point = dvi_mesh_points(plain),
                                .cells = dvi_mesh_count(plain, 2),
                                .vertex = dvi_mesh_vertices(plain, 2, NULL),
                                .part = &part,
                                .parts = 1};
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  dvi_star *star = star_of(mesh, DVI_BARYCENTRIC);
  const int64_t edges = dvi_mesh_count(mesh, 1);
  double *f = random_form(mesh, 1, 5), *h = random_form(mesh, 1, 1), *u = random_form(mesh, 1, 1),
         *scaled = random_form(mesh, 1, 1), *found = random_form(mesh, 1, 1), most = 0;
  ck_assert_int_eq(dvi_form_decompose(star, 1, "pins", f, NULL, NULL, h), DVI_OK);
  for (int64_t i = 0; i < edges; i++) f[i] -= h[i];
  ck_assert_msg(dvi_form_solve(star, 1, "pins", f, u) == DVI_OK, "%s", dvi_last_error());
  for (int64_t i = 0; i < edges; i++) most = fmax(most, fabs(u[i]));
  ck_assert(most > 1e-4);
  for (size_t k = 0; k < sizeof scale / sizeof *scale; k++) {
    for (int64_t i = 0; i < edges; i++) scaled[i] = scale[k] * f[i];
    const dvi_status status = dvi_form_solve(star, 1, "pins", scaled, found);
    ck_assert_msg(status == DVI_OK || scale[k] > 1e100, "times %g: %s", scale[k], dvi_last_error());
    if (status != DVI_OK) continue; /* squares overflow, and are refused */
    for (int64_t i = 0; i < edges; i++)
      ck_assert_msg(fabs(found[i] / scale[k] - u[i]) < 1e-9 * most, "times %g: %g, not %g",
                    scale[k], found[i] / scale[k], u[i]);
  }
  free(f), free(h), free(u), free(scaled), free(found);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
  dvi_mesh_destroy(&plain);
}
END_TEST

START_TEST(harmonic_right_side_is_refused)
{
  dvi_mesh *mesh = staggered_mesh(4, 4);
  dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
  double *f = random_form(mesh, 0, 11), *u = random_form(mesh, 0, 11);
  for (int64_t i = 0; i < dvi_mesh_count(mesh, 0); i++) f[i] = 1;
  ck_assert_int_eq(dvi_form_solve(star, 0, NULL, f, u), DVI_BAD_ARGUMENT);
  ck_assert_ptr_nonnull(strstr(dvi_last_error(), "harmonic part"));
  ck_assert_int_eq(dvi_form_solve(star, 0, "boundary", f, u), DVI_OK);
  free(f), free(u);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The dual of a flipped edge is negative, and zero on Kuhn's diagonals. */
START_TEST(stars_that_are_not_definite_are_refused)
{
  dvi_mesh *mesh = generated("kuhn-torus", 2, 3);
  dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
  dvi_matrix *matrix = NULL;
  double *b = random_form(mesh, 1, 1);
  const dvi_status solved = dvi_star_solve(star, 1, b);
  ck_assert_int_eq(solved, DVI_SINGULAR);
  ck_assert_int_eq(dvi_form_decompose(star, 1, NULL, b, NULL, NULL, b), DVI_SINGULAR);
  ck_assert_ptr_nonnull(strstr(dvi_last_error(), "edge"));
  ck_assert_ptr_nonnull(strstr(dvi_last_error(), "--repair"));
  ck_assert_int_eq(dvi_form_decompose(star, 0, "rim", b, NULL, NULL, b), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_form_codifferential_create(star, 2, &matrix), DVI_SINGULAR);
  ck_assert_ptr_null(matrix);
  ck_assert_ptr_nonnull(strstr(dvi_last_error(), "edge"));
  free(b);
  dvi_star_destroy(&star);
  star = star_of(mesh, DVI_WHITNEY);
  ck_assert_int_eq(dvi_form_codifferential_create(star, 2, &matrix), DVI_UNSUPPORTED);
  ck_assert_int_eq(dvi_form_laplacian_create(star, 3, &matrix), DVI_BAD_ARGUMENT);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(operators)
{
  tcase_add_test(tests, codifferential_squares_to_zero);
  tcase_add_test(tests, staggered_triangles_have_the_eigenvalues_of_the_square);
  tcase_add_test(tests, forms_on_a_torus_share_the_spectrum_of_functions);
  tcase_add_test(tests, parts_of_a_form_are_orthogonal_and_add_up);
  tcase_add_test(tests, torus_has_as_many_harmonic_forms_as_its_betti_numbers);
  tcase_add_test(tests, hole_has_one_harmonic_field_of_each_kind);
  tcase_add_test(tests, mixed_conditions_leave_no_harmonic_form);
  tcase_add_test(tests, mixed_problems_of_functions_are_solved);
  tcase_add_test(tests, relative_form_is_closed_and_coclosed);
  tcase_add_test(tests, poisson_problems_are_solved_in_every_degree);
  tcase_add_test(tests, solutions_scale_with_their_right_sides);
  tcase_add_test(tests, harmonic_right_side_is_refused);
  tcase_add_test(tests, stars_that_are_not_definite_are_refused);
}
