/* Orders of eigenvalues and of Poisson problems on meshes of several kinds. */
#include <dvi/field.h>
#include <math.h>
#include <stdlib.h>

#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

static dvi_mesh *generated(const char *name, int dimension, int cells)
{
  dvi_mesh *mesh = NULL;
  dvi_generator_options options = {.size = sizeof options, .dimension = dimension};
  options.cells[0] = cells;
  for (int i = 1; i < dimension; i++) options.cells[i] = cells;
  ck_assert_msg(dvi_mesh_generate(name, &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

/* A Delaunay mesh of the unit cube: a grid whose inner points, and those inside its sides, are
 * moved by up to a tenth of a cell. */
static dvi_mesh *delaunay(int n, int cells)
{
  const int64_t side = cells + 1, count = n == 2 ? side * side : side * side * side;
  double *point = malloc((size_t)(count * n) * sizeof *point);
  dvi_mesh *mesh = NULL;
  unsigned long long seed = 1;
  for (int64_t i = 0; i < count; i++) {
    int64_t rest = i;
    for (int a = 0; a < n; a++, rest /= side) {
      const int at = (int)(rest % side);
      const double moved = at > 0 && at < cells ? 0.2 * (random_number(&seed) - 0.5) : 0;
      point[i * n + a] = (at + moved) / cells;
    }
  }
  ck_assert_msg(dvi_mesh_delaunay(n, count, point, &mesh) == DVI_OK, "%s", dvi_last_error());
  free(point);
  return mesh;
}

static dvi_field *field_on(const dvi_mesh *mesh, dvi_star_kind kind, int conditions,
                           dvi_form_function *source, void *user)
{
  static const dvi_condition fixed = {.part = "boundary", .kind = DVI_FIXED};
  const dvi_star_options options = {.size = sizeof options, .kind = kind};
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  const dvi_wave_terms terms = {.size = sizeof terms,
                                .star = star,
                                .condition = &fixed,
                                .conditions = conditions,
                                .source = source,
                                .source_user = user};
  ck_assert_msg(dvi_wave_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  return field;
}

/* ---- Poisson's problem with the product of sines ---- */

static double product_of_sines(int n, const double *x)
{
  double product = 1;
  for (int a = 0; a < n; a++) product *= sin(pi * x[a]);
  return product;
}

static int source(const double *x, double *f, void *user)
{
  const int n = *(int *)user;
  *f = n * pi * pi * product_of_sines(n, x);
  return 0;
}

/* The root of the mean square of the errors, by M_0. */
static double poisson_error(dvi_mesh *mesh, dvi_star_kind kind)
{
  int n = dvi_mesh_dimension(mesh);
  dvi_field *field = field_on(mesh, kind, 1, source, &n);
  int64_t unknowns;
  const int *vertex = dvi_field_unknowns(field, &unknowns);
  double *u = calloc((size_t)dvi_mesh_count(mesh, 0), sizeof *u), sum = 0;
  ck_assert_msg(dvi_field_solve(field, NULL, u, NULL) == DVI_OK, "%s", dvi_last_error());
  for (int64_t i = 0; i < unknowns; i++) {
    const double *x = dvi_mesh_points(mesh) + (int64_t)vertex[i] * n;
    sum += pow(u[vertex[i]] - product_of_sines(n, x), 2) / (double)unknowns;
  }
  free(u);
  dvi_field_destroy(&field);
  dvi_mesh_destroy(&mesh);
  return sqrt(sum);
}

typedef dvi_mesh *mesh_maker(int n, int cells);

static dvi_mesh *staggered(int n, int cells)
{
  (void)n;
  return staggered_mesh(cells, cells);
}

static dvi_mesh *kuhn(int n, int cells)
{
  return generated("kuhn", n, cells);
}

static dvi_mesh *box(int n, int cells)
{
  return generated("box", n, cells);
}

/* Cells along an axis: twice as many in the plane, half as many again in space. */
static int cells_of(int n, int cells, int level)
{
  return (int)lround(cells * pow(n == 2 ? 2 : 1.5, level));
}

/* Require the order 2 of the error, from the first of four levels to the last one. Where memory is
 * watched, two levels show that all works. */
static void check_order(double (*error_of)(dvi_mesh *, dvi_star_kind), mesh_maker *make, int n,
                        dvi_star_kind kind, int cells)
{
  const int levels = is_short_run() ? 2 : 4, most = cells_of(n, cells, levels - 1);
  const double first = error_of(make(n, cells), kind);
  double last = first;
  for (int level = 1; level < levels; level++) {
    const double error = error_of(make(n, cells_of(n, cells, level)), kind);
    ck_assert_msg(error < last, "n = %d, star %d, level %d: error %g", n, (int)kind, level, error);
    last = error;
  }
  const double order = log(first / last) / log((double)most / cells);
  ck_assert_msg(order > 1.85 && order < 2.3, "n = %d, star %d, %d to %d cells: order %g", n,
                (int)kind, cells, most, order);
}

START_TEST(poisson_problems_of_the_plane_have_second_order)
{
  check_order(poisson_error, staggered, 2, DVI_CIRCUMCENTRIC, 8);
  check_order(poisson_error, kuhn, 2, DVI_CIRCUMCENTRIC, 8);
  check_order(poisson_error, box, 2, DVI_CIRCUMCENTRIC, 8);
  check_order(poisson_error, delaunay, 2, DVI_CIRCUMCENTRIC, 8);
  check_order(poisson_error, delaunay, 2, DVI_WHITNEY, 8);
}
END_TEST

START_TEST(poisson_problems_of_space_have_second_order)
{
  check_order(poisson_error, kuhn, 3, DVI_CIRCUMCENTRIC, 6);
  check_order(poisson_error, kuhn, 3, DVI_BARYCENTRIC, 6);
  check_order(poisson_error, box, 3, DVI_CIRCUMCENTRIC, 6);
}
END_TEST

/* Where tetrahedra have circumcentres outside, the circumcentric star of a Delaunay mesh may have
 * entries of either sign in the mass. */
START_TEST(finite_elements_have_second_order_on_any_tetrahedra)
{
  check_order(poisson_error, delaunay, 3, DVI_WHITNEY, 5);
  check_order(poisson_error, delaunay, 3, DVI_BARYCENTRIC, 5);
}
END_TEST

/* ---- eigenvalues ---- */

static double lowest(dvi_mesh *mesh, dvi_star_kind kind, int conditions)
{
  double eigenvalue;
  const dvi_modes_options one = {.size = sizeof one, .count = 1};
  dvi_field *field = field_on(mesh, kind, conditions, NULL, NULL);
  ck_assert_msg(dvi_field_modes(field, &one, &eigenvalue, NULL, NULL) == DVI_OK, "%s",
                dvi_last_error());
  dvi_field_destroy(&field);
  dvi_mesh_destroy(&mesh);
  return eigenvalue;
}

static double eigenvalue_error(dvi_mesh *mesh, dvi_star_kind kind)
{
  const double exact = dvi_mesh_dimension(mesh) * pi * pi;
  return fabs(lowest(mesh, kind, 1) - exact);
}

START_TEST(eigenvalues_of_the_plane_have_second_order)
{
  check_order(eigenvalue_error, staggered, 2, DVI_CIRCUMCENTRIC, 8);
  check_order(eigenvalue_error, kuhn, 2, DVI_CIRCUMCENTRIC, 8);
  check_order(eigenvalue_error, delaunay, 2, DVI_WHITNEY, 8);
}
END_TEST

START_TEST(eigenvalues_of_space_have_second_order)
{
  check_order(eigenvalue_error, kuhn, 3, DVI_CIRCUMCENTRIC, 6);
}
END_TEST

START_TEST(eigenvalues_of_finite_elements_have_second_order)
{
  check_order(eigenvalue_error, kuhn, 3, DVI_WHITNEY, 6);
}
END_TEST

/* The stencil of nine points in four dimensions: 4 (2 sin(pi/6)/(1/3))^2 = 36. */
START_TEST(cube_of_four_dimensions_has_a_known_eigenvalue)
{
  ck_assert_double_eq_tol(lowest(generated("kuhn", 4, 3), DVI_CIRCUMCENTRIC, 1), 36, 1e-11);
}
END_TEST

/* ---- the body-centred torus ---- */

START_TEST(body_centred_torus_has_known_forms)
{
  const double exact = 4 * pi * pi,
               first = lowest(generated("bcc-torus", 3, 3), DVI_CIRCUMCENTRIC, 0);
  ck_assert_double_eq_tol(first / exact, 0.854897486982, 2e-12);
  const int cells[] = {4, 6, 9, 13}, levels = is_short_run() ? 2 : 4;
  double error[4];
  for (int i = 0; i < levels; i++)
    error[i] = fabs(lowest(generated("bcc-torus", 3, cells[i]), DVI_CIRCUMCENTRIC, 0) - exact);
  const double order = log(error[0] / error[levels - 1]) / log((double)cells[levels - 1] / 4);
  ck_assert_msg(fabs(order - 2) < 0.15, "order %g", order);
  dvi_mesh *mesh = generated("bcc-torus", 3, 3);
  dvi_star *star = NULL;
  int64_t harmonic;
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_OK);
  ck_assert_int_eq(dvi_form_harmonic(star, 1, NULL, &harmonic, NULL), DVI_OK);
  ck_assert_int_eq(harmonic, 3);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- the sphere ---- */

/* The eigenvalues l (l+1) of a sphere come 2 l + 1 times. The mesh splits those of l = 3 into
 * groups of 3 and of 4, as the icosahedron's symmetries do. */
START_TEST(spheres_have_their_harmonics)
{
  double last = 0;
  for (int level = 1; level <= (is_short_run() ? 3 : 4); level++) {
    double eigenvalue[15];
    int64_t zeros;
    const dvi_modes_options options = {.size = sizeof options, .count = 15};
    dvi_mesh *mesh = generated("icosphere", 0, level);
    dvi_field *field = field_on(mesh, DVI_CIRCUMCENTRIC, 0, NULL, NULL);
    ck_assert_int_eq(dvi_field_modes(field, &options, eigenvalue, NULL, &zeros), DVI_OK);
    ck_assert_int_eq(zeros, 1);
    for (int i = 1; i < 3; i++) ck_assert_double_eq_tol(eigenvalue[i], eigenvalue[0], 1e-10);
    for (int i = 4; i < 8; i++) ck_assert_double_eq_tol(eigenvalue[i], eigenvalue[3], 1e-10);
    for (int i = 8; i < 15; i++)
      ck_assert_double_eq_tol(eigenvalue[i], 12, 12 * 0.3 * pow(0.25, level - 1));
    if (level == 3) {
      ck_assert_double_eq_tol(eigenvalue[0], 1.999999176887, 2e-12);
      ck_assert_double_eq_tol(eigenvalue[3], 5.965925145402, 5e-12);
    }
    const double error = 6 - eigenvalue[3];
    if (level > 1) ck_assert_msg(fabs(log2(last / error) - 2) < 0.1, "%g, %g", last, error);
    last = error;
    dvi_field_destroy(&field);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

SUITE(convergence)
{
  tcase_add_test(tests, poisson_problems_of_the_plane_have_second_order);
  tcase_add_test(tests, poisson_problems_of_space_have_second_order);
  tcase_add_test(tests, finite_elements_have_second_order_on_any_tetrahedra);
  tcase_add_test(tests, eigenvalues_of_the_plane_have_second_order);
  tcase_add_test(tests, eigenvalues_of_space_have_second_order);
  tcase_add_test(tests, eigenvalues_of_finite_elements_have_second_order);
  tcase_add_test(tests, cube_of_four_dimensions_has_a_known_eigenvalue);
  tcase_add_test(tests, body_centred_torus_has_known_forms);
  tcase_add_test(tests, spheres_have_their_harmonics);
}
