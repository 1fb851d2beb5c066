/* Stars of random simplices, of meshes, and of boxes. */
#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>

#include "num/eigen.h"
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

static dvi_matrix matrix_of(const dvi_star *star, int k)
{
  dvi_matrix matrix;
  ck_assert_int_eq(dvi_star_matrix(star, k, &matrix), DVI_OK);
  return matrix;
}

static double binomial(int n, int k)
{
  return k == 0 ? 1 : binomial(n, k - 1) * (n - k + 1) / k;
}

/* ---- volumes ---- */

/* sum |s||*s| = C(n,k) |K|. An entry of a diagonal star is |*s|/|s|, so |s||*s| = |*s|^2/M. */
static void check_sum_of_duals(const dvi_mesh *mesh)
{
  dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
  const int n = dvi_mesh_dimension(mesh);
  double volume = 0;
  const dvi_matrix top = matrix_of(star, n);
  for (int64_t c = 0; c < top.rows; c++) volume += 1 / top.value[c];
  for (int k = 0; k <= n; k++) {
    const dvi_matrix M = matrix_of(star, k);
    const double *dual = dvi_star_duals(star, k);
    double sum = 0, size = 0;
    for (int64_t s = 0; s < M.rows; s++) {
      const double product = dual[s] != 0 ? dual[s] * dual[s] / M.value[s] : 0;
      sum += product;
      size += fabs(product);
    }
    ck_assert_double_eq_tol(sum, binomial(n, k) * volume, 1e-12 * (size + volume));
  }
  dvi_star_destroy(&star);
}

/* Duals are negative in most random simplices. Slivers lose digits, so they are left out. */
START_TEST(dual_volumes_fill_a_simplex)
{
  for (int n = 1; n <= 4; n++)
    for (unsigned seed = 1; seed <= 60; seed++) {
      dvi_mesh *mesh = random_simplex(n, n + (int)seed % 3, NULL, seed);
      const double thin = pow(0.1, n);
      dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
      const double volume = 1 / matrix_of(star, n).value[0];
      dvi_star_destroy(&star);
      if (volume > thin) check_sum_of_duals(mesh);
      dvi_mesh_destroy(&mesh);
    }
}
END_TEST

START_TEST(dual_volumes_fill_a_mesh)
{
  for (int n = 1; n <= 4; n++) {
    dvi_mesh *mesh = jittered_mesh(n, n, 3, 0.2, (unsigned)n);
    check_sum_of_duals(mesh);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* Random points have simplices of every shape. */
START_TEST(dual_volumes_fill_delaunays_triangulation)
{
  enum { POINTS = 200 };
  for (int n = 2; n <= 4; n++) {
    double point[4 * POINTS];
    unsigned long long state = (unsigned)n;
    dvi_mesh *mesh;
    for (int i = 0; i < n * POINTS; i++) point[i] = random_number(&state);
    ck_assert_msg(dvi_mesh_delaunay(n, POINTS, point, &mesh) == DVI_OK, "%s", dvi_last_error());
    check_sum_of_duals(mesh);
    dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
    int negative = 0;
    for (int64_t e = 0; e < dvi_mesh_count(mesh, 1); e++)
      negative += dvi_star_duals(star, 1)[e] < 0;
    ck_assert_int_gt(negative, 0);
    dvi_star_destroy(&star);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* ---- affine functions ---- */

/* Set r = d0^T M1 d0 u at all vertices. */
static void stiffness(const dvi_star *star, const double *u, double *r)
{
  dvi_matrix d;
  const dvi_matrix M = matrix_of(star, 1);
  double *du = calloc((size_t)M.rows, sizeof *du), *Mdu = calloc((size_t)M.rows, sizeof *Mdu);
  ck_assert_int_eq(dvi_mesh_incidence(dvi_star_mesh(star), 0, &d), DVI_OK);
  dvi_matrix_multiply(&d, 0, u, du);
  dvi_matrix_multiply(&M, 0, du, Mdu);
  dvi_matrix_multiply(&d, 1, Mdu, r);
  free(du);
  free(Mdu);
}

static void check_affine(const dvi_mesh *mesh, dvi_star_kind kind)
{
  dvi_star *star = star_of(mesh, kind);
  const int64_t count = dvi_mesh_count(mesh, 0);
  const int space = dvi_mesh_space(mesh);
  const double *x = dvi_mesh_points(mesh);
  double *u = calloc((size_t)count, sizeof *u), *r = calloc((size_t)count, sizeof *r);
  int64_t rim;
  const int *boundary = dvi_mesh_part_cells(mesh, "boundary", 0, &rim);
  for (int64_t v = 0; v < count; v++)
    for (int i = 0; i < space; i++) u[v] += (i + 0.5) * x[v * space + i];
  stiffness(star, u, r);
  for (int64_t i = 0; i < rim; i++) r[boundary[i]] = 0;
  for (int64_t v = 0; v < count; v++) ck_assert_double_le(fabs(r[v]), 2e-14);
  free(u);
  free(r);
  dvi_star_destroy(&star);
}

START_TEST(affine_functions_have_no_laplacian)
{
  for (int n = 1; n <= 4; n++) {
    dvi_mesh *mesh = jittered_mesh(n, n, n < 4 ? 4 : 3, 0.15, (unsigned)n);
    check_affine(mesh, DVI_CIRCUMCENTRIC);
    check_affine(mesh, DVI_WHITNEY);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* ---- constant forms ---- */

/* A constant 1-form has the integrals c.(b - a), and a.M a is |c|^2 |K| on any mesh that fills a
 * cube. The circumcentric star has this norm only on lines and surfaces. */
START_TEST(constant_forms_have_their_norm)
{
  for (int n = 1; n <= 4; n++) {
    dvi_mesh *mesh = jittered_mesh(n, n, 3, 0.15, (unsigned)n);
    dvi_matrix d;
    ck_assert_int_eq(dvi_mesh_incidence(mesh, 0, &d), DVI_OK);
    const double *x = dvi_mesh_points(mesh);
    for (int kind = n < 3 ? DVI_CIRCUMCENTRIC : DVI_BARYCENTRIC; kind <= DVI_WHITNEY; kind++) {
      dvi_star *star = star_of(mesh, (dvi_star_kind)kind);
      const dvi_matrix M = matrix_of(star, 1);
      double *u = calloc((size_t)d.columns, sizeof *u), *a = calloc((size_t)d.rows, sizeof *a),
             *Ma = calloc((size_t)d.rows, sizeof *Ma), square = 0, sum = 0;
      for (int i = 0; i < n; i++) square += (i + 1.0) * (i + 1.0);
      for (int64_t v = 0; v < d.columns; v++)
        for (int i = 0; i < n; i++) u[v] += (i + 1) * x[v * n + i];
      dvi_matrix_multiply(&d, 0, u, a);
      dvi_matrix_multiply(&M, 0, a, Ma);
      for (int64_t e = 0; e < d.rows; e++) sum += a[e] * Ma[e];
      ck_assert_double_eq_tol(sum, square, 1e-13 * square);
      free(u);
      free(a);
      free(Ma);
      dvi_star_destroy(&star);
    }
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* ---- the mesh of fields: eigenvalues ---- */

/* Fill the full matrix K = d0^T M1 d0 restricted to the vertices with `row` >= 0. */
static void fill_stiffness(const dvi_star *star, const int *row, int n, double *K)
{
  const int64_t count = dvi_mesh_count(dvi_star_mesh(star), 0);
  double *u = calloc((size_t)count, sizeof *u), *r = calloc((size_t)count, sizeof *r);
  for (int64_t v = 0; v < count; v++) {
    if (row[v] < 0) continue;
    u[v] = 1;
    stiffness(star, u, r);
    u[v] = 0;
    for (int64_t w = 0; w < count; w++)
      if (row[w] >= 0) K[row[v] * n + row[w]] = r[w];
  }
  free(u);
  free(r);
}

/* Compute the eigenvalues of K u = lambda M0 u, without the vertices of the boundary if `fixed`. */
static void eigenvalues(const dvi_star *star, int fixed, double *lambda)
{
  const dvi_mesh *mesh = dvi_star_mesh(star);
  const int64_t count = dvi_mesh_count(mesh, 0);
  int *row = calloc((size_t)count, sizeof *row), n = 0;
  int64_t rim;
  const int *boundary = dvi_mesh_part_cells(mesh, "boundary", 0, &rim);
  for (int64_t i = 0; i < rim && fixed; i++) row[boundary[i]] = -1;
  for (int64_t v = 0; v < count; v++)
    if (row[v] == 0) row[v] = n++;
  const size_t entries = (size_t)n * (size_t)n;
  double *K = calloc(entries, sizeof *K), *M = calloc(entries, sizeof *M),
         *X = calloc(entries, sizeof *X);
  const dvi_matrix M0 = matrix_of(star, 0);
  for (int64_t v = 0; v < count; v++)
    if (row[v] >= 0) M[row[v] * n + row[v]] = M0.value[v];
  fill_stiffness(star, row, n, K);
  ck_assert_int_eq(dvi__eigen_symmetric(n, K, M, lambda, X), DVI_OK);
  free(K);
  free(M);
  free(X);
  free(row);
}

START_TEST(staggered_triangles_have_their_eigenvalues)
{
  double lambda[100];
  dvi_mesh *mesh = staggered_mesh(8, 8);
  dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
  eigenvalues(star, 1, lambda);
  ck_assert_double_eq_tol(lambda[0], 19.362777564429, 1e-10);
  ck_assert_double_eq_tol(lambda[1], 46.629256462815, 1e-10);
  eigenvalues(star, 0, lambda);
  ck_assert_double_eq_tol(lambda[0], 0, 1e-11);
  ck_assert_double_eq_tol(lambda[1], 9.743283624691, 1e-10);
  ck_assert_double_eq_tol(lambda[2], 9.755353316864, 1e-10);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Kuhn's simplices of cubes have the stencil of cubes, whose lowest eigenvalue in four dimensions
 * with three cells is 4 (2/h)^2 sin^2(pi h/2) = 36. */
START_TEST(kuhn_simplices_have_the_stencil_of_cubes)
{
  double lambda[256];
  for (int n = 2; n <= 4; n++) {
    dvi_mesh *mesh = jittered_mesh(n, n, 3, 0, 1);
    dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
    eigenvalues(star, 1, lambda);
    ck_assert_double_eq_tol(lambda[0], n * 36 * pow(sin(pi / 6), 2), 1e-11);
    dvi_star_destroy(&star);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* ---- boxes ---- */

static dvi_mesh *box(int n)
{
  dvi_mesh *mesh = NULL;
  const dvi_generator_options options = {.size = sizeof options,
                                         .dimension = n,
                                         .cells = {3, n > 1 ? 2 : 0, n > 2 ? 2 : 0, n > 3},
                                         .extent = {1, n > 1 ? 0.8 : 0, n > 2 ? 0.6 : 0},
                                         .grading = {2}};
  ck_assert_msg(dvi_mesh_generate("box", &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

/* The entry of a k-cell is the product of h across it over the product of h along it, with half of
 * the cells on each side of it. */
START_TEST(boxes_have_the_star_of_yee)
{
  for (int n = 1; n <= 4; n++) {
    dvi_mesh *mesh = box(n);
    check_sum_of_duals(mesh);
    dvi_mesh_destroy(&mesh);
  }
  dvi_mesh *mesh = box(2);
  dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
  const double *x = dvi_mesh_points(mesh);
  const dvi_matrix M = matrix_of(star, 1);
  for (int64_t e = 0; e < M.rows; e++) {
    const int *v = dvi_mesh_vertices(mesh, 1, NULL) + 2 * e;
    if (x[2 * v[0]] != 0 || x[2 * v[0] + 1] != 0) continue;
    const double h = x[2 * v[1]] + x[2 * v[1] + 1], across = h == 0.4 ? 1.0 / 9 : 0.4;
    ck_assert_double_eq_tol(M.value[e], 0.5 * across / h, 1e-15);
  }
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Whitney's stars have the norm of constant k-forms, whose components are 1, 2, .., on simplices
 * and on boxes. */
static int constant_form(const double *x, double *value, void *user)
{
  (void)x;
  for (int i = 0; i < *(int *)user; i++) value[i] = i + 1;
  return 0;
}

static void check_norm(const dvi_mesh *mesh, double volume)
{
  dvi_star *star = star_of(mesh, DVI_WHITNEY);
  const int n = dvi_mesh_dimension(mesh);
  for (int k = 0; k <= n; k++) {
    int components = dvi_form_components(n, k);
    const dvi_matrix M = matrix_of(star, k);
    double *a = calloc((size_t)M.rows, sizeof *a), *Ma = calloc((size_t)M.rows, sizeof *Ma),
           sum = 0, square = 0;
    ck_assert_int_eq(dvi_form_integrate(mesh, k, constant_form, &components, a), DVI_OK);
    dvi_matrix_multiply(&M, 0, a, Ma);
    for (int64_t i = 0; i < M.rows; i++) sum += a[i] * Ma[i];
    for (int i = 1; i <= components; i++) square += i * i;
    ck_assert_double_eq_tol(sum, square * volume, 1e-13 * square);
    free(a);
    free(Ma);
  }
  dvi_star_destroy(&star);
}

START_TEST(whitneys_stars_have_the_norm_of_constant_forms)
{
  static const double volume[] = {1, 1, 0.8, 0.48, 0.48};
  for (int n = 1; n <= 4; n++) {
    dvi_mesh *boxes = box(n), *simplices = jittered_mesh(n, n, 2, 0.2, 3);
    check_norm(boxes, volume[n]);
    check_norm(simplices, 1);
    dvi_mesh_destroy(&boxes);
    dvi_mesh_destroy(&simplices);
  }
}
END_TEST

/* Factors by cell count with the pieces of the dual cells. */
START_TEST(factors_count_by_cell)
{
  static const double point[] = {0, 0, 1, 0, 0, 1, 1, 1}, factors[] = {2, 6};
  static const int vertex[] = {0, 1, 3, 0, 2, 3};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .points = 4,
                                .point = point,
                                .cells = 2,
                                .vertex = vertex};
  for (int kind = DVI_CIRCUMCENTRIC; kind <= DVI_WHITNEY; kind++) {
    const double *const factor[] = {factors, NULL, factors};
    const dvi_star_options options = {sizeof options, (dvi_star_kind)kind, factor};
    dvi_mesh *mesh;
    dvi_star *star;
    double sum = 0;
    ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
    ck_assert_int_eq(dvi_star_create(mesh, &options, &star), DVI_OK);
    const dvi_matrix M = matrix_of(star, 0), top = matrix_of(star, 2);
    for (int64_t e = 0; e < dvi_matrix_entries(&M); e++) sum += M.value[e];
    ck_assert_double_eq_tol(sum, 4, 1e-14); /* the integral of the factor */
    ck_assert_double_eq_tol(top.value[0], 4, 1e-14);
    ck_assert_double_eq_tol(top.value[1], 12, 1e-14);
    dvi_star_destroy(&star);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

START_TEST(bad_stars_are_refused)
{
  /* three triangles share an edge, as the pages of a book */
  static const int page[] = {0, 1, 2, 0, 1, 3, 0, 1, 4};
  static const double corner[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .space = 3,
                                .points = 5,
                                .point = corner,
                                .cells = 3,
                                .vertex = page};
  dvi_star_options options = {.size = sizeof options, .kind = (dvi_star_kind)7};
  dvi_mesh *mesh;
  dvi_star *star;
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_BAD_ARGUMENT);
  check_words("the mesh is no manifold: edge 0 (vertices 0 1) belongs to more than two cells");
  ck_assert_ptr_null(star);
  ck_assert_int_eq(dvi_star_create(mesh, &options, &star), DVI_BAD_ARGUMENT);
  check_words("there is no kind 7");
  options.size = 1;
  ck_assert_int_eq(dvi_star_create(mesh, &options, &star), DVI_BAD_ARGUMENT);
  check_words("sizeof(dvi_star_options)");
  ck_assert_int_eq(dvi_star_create(NULL, NULL, &star), DVI_BAD_ARGUMENT);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- a metric with signs ---- */

/* An edge along a ray of light has no length. */
START_TEST(lightlike_edges_are_refused)
{
  static const double metric[] = {1, -1}, point[] = {0, 0, 1, 1, 1, 0};
  static const int vertex[] = {0, 1, 2};
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .points = 3,
                                .point = point,
                                .cells = 1,
                                .vertex = vertex,
                                .metric = metric};
  dvi_mesh *mesh;
  dvi_star *star;
  ck_assert_int_eq(dvi_mesh_create(&terms, &mesh), DVI_OK);
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_BAD_ARGUMENT);
  check_words("edge 0 (vertices 0 1) has no volume in the mesh's metric");
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* In 1+1 dimensions the weights of the scalar wave are w_ab = -1/2 sum (u.v)/A with the vectors u
 * and v from the opposite vertex to the edge, in the metric (+,-). */
START_TEST(spacetime_has_the_weights_of_waves)
{
  static const double metric[] = {1, -1};
  for (unsigned seed = 1; seed <= 20; seed++) {
    dvi_mesh *mesh = random_simplex(2, 2, metric, seed);
    dvi_star *star = star_of(mesh, DVI_CIRCUMCENTRIC);
    const dvi_matrix M = matrix_of(star, 1);
    const double *x = dvi_mesh_points(mesh);
    for (int e = 0; e < 3; e++) {
      const int *edge = dvi_mesh_vertices(mesh, 1, NULL) + 2 * e, other = 3 - edge[0] - edge[1];
      const double u[] = {x[2 * edge[0]] - x[2 * other], x[2 * edge[0] + 1] - x[2 * other + 1]},
                   v[] = {x[2 * edge[1]] - x[2 * other], x[2 * edge[1] + 1] - x[2 * other + 1]},
                   area = fabs(u[0] * v[1] - u[1] * v[0]),
                   weight = -0.5 * (u[0] * v[0] - u[1] * v[1]) / area;
      ck_assert_double_eq_tol(M.value[e], weight, 1e-9 * (1 + fabs(weight)));
    }
    dvi_star_destroy(&star);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

SUITE(star)
{
  tcase_add_test(tests, dual_volumes_fill_a_simplex);
  tcase_add_test(tests, dual_volumes_fill_a_mesh);
  tcase_add_test(tests, dual_volumes_fill_delaunays_triangulation);
  tcase_add_test(tests, affine_functions_have_no_laplacian);
  tcase_add_test(tests, constant_forms_have_their_norm);
  tcase_add_test(tests, staggered_triangles_have_their_eigenvalues);
  tcase_add_test(tests, kuhn_simplices_have_the_stencil_of_cubes);
  tcase_add_test(tests, boxes_have_the_star_of_yee);
  tcase_add_test(tests, whitneys_stars_have_the_norm_of_constant_forms);
  tcase_add_test(tests, factors_count_by_cell);
  tcase_add_test(tests, bad_stars_are_refused);
  tcase_add_test(tests, lightlike_edges_are_refused);
  tcase_add_test(tests, spacetime_has_the_weights_of_waves);
}
