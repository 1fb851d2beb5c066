/* Spaces on triangles and tetrahedra. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "field/space/space.h"
#include "support/field/function_spaces.h"
#include "support/meshes.h"
#include "support/suite.h"

/* Kuhn's mesh of the unit cube with moved inner points. */
static dvi_space *space_in_cube(const char *kind, int n, int cells)
{
  dvi_mesh *mesh = jittered_mesh(n, n, cells, 0.2, 3);
  dvi_space *space = space_on_mesh(kind, mesh);
  dvi_mesh_destroy(&mesh);
  return space;
}

static const char *const linear = "fem:degree=1", *const quadratic = "fem:degree=2";

/* ---- exactness ---- */

/* The monomial x^a y^b z^c, and its derivative along an axis. */
typedef struct monomial {
  int n, power[3];
} monomial;

static double power_of(double x, int power)
{
  return power > 0 ? pow(x, power) : power == 0;
}

static int monomial_at(int64_t count, const double *x, double *f, void *user)
{
  const monomial *m = user;
  for (int64_t i = 0; i < count; i++) {
    f[i] = 1;
    for (int d = 0; d < m->n; d++) f[i] *= power_of(x[d * count + i], m->power[d]);
  }
  return 0;
}

static void check_integral(const dvi_space *space, monomial *m)
{
  const double *x, *weight;
  const int64_t points = dvi_space_points(space, &x, &weight);
  double *f = calloc((size_t)points, sizeof *f), sum = 0, exact = 1;
  (void)monomial_at(points, x, f, m);
  for (int64_t k = 0; k < points; k++) sum += weight[k] * f[k];
  for (int d = 0; d < m->n; d++) exact /= m->power[d] + 1;
  ck_assert_msg(fabs(sum - exact) < 1e-14, "x^%d y^%d z^%d: error %g", m->power[0], m->power[1],
                m->power[2], sum - exact);
  free(f);
}

/* The next monomial up to a total degree. Returns 0 behind the last one. */
static int next_monomial(monomial *m, int degree)
{
  for (int d = 0; d < m->n; d++) {
    m->power[d]++;
    if (m->power[0] + m->power[1] + m->power[2] <= degree) return 1;
    m->power[d] = 0;
  }
  return 0;
}

static void check_rule(const char *kind, int n, int degree)
{
  dvi_space *space = space_in_cube(kind, n, 3);
  monomial m = {.n = n};
  do check_integral(space, &m);
  while (next_monomial(&m, degree));
  dvi_space_destroy(&space);
}

/* The sums have about 1000 terms of sum 1, and roundings of 1e-16 each. */
START_TEST(quadratures_are_exact_to_their_degree)
{
  check_rule("fem:points=1", 2, 1);
  check_rule(linear, 2, 2);
  check_rule(quadratic, 2, 4);
  check_rule("fem:points=1", 3, 1);
  check_rule(linear, 3, 2);
  check_rule(quadratic, 3, 5);
}
END_TEST

/* Compares a derivative along axis d, or the value if d is -1, at the points and anywhere. */
static void check_derivative(const dvi_space *space, monomial m, int d, const double *U)
{
  enum { PLACES = 50 };
  const int n = dvi_space_dimension(space);
  const double *x, factor = d >= 0 ? m.power[d] : 1;
  const int64_t points = dvi_space_points(space, &x, NULL);
  double *u = malloc((size_t)points * sizeof *u), *exact = malloc((size_t)points * sizeof *exact),
         place[3 * PLACES] = {0};
  int order[3] = {0};
  unsigned long long seed = 4;
  if (d >= 0) order[d] = 1;
  if (d >= 0) m.power[d]--;
  ck_assert_int_eq(dvi_space_apply(space, order, U, u), DVI_OK);
  (void)monomial_at(points, x, exact, &m);
  for (int64_t k = 0; k < points; k++) ck_assert_double_eq_tol(u[k], factor * exact[k], 1e-12);
  for (int i = 0; i < n * PLACES; i++) place[i] = random_number(&seed);
  ck_assert_int_eq(dvi_space_evaluate(space, order, U, PLACES, place, u), DVI_OK);
  (void)monomial_at(PLACES, place, exact, &m);
  for (int k = 0; k < PLACES; k++) ck_assert_double_eq_tol(u[k], factor * exact[k], 1e-12);
  free(u);
  free(exact);
}

static void check_polynomials(const char *kind, int n, int degree)
{
  dvi_space *space = space_in_cube(kind, n, 3);
  double *U = malloc((size_t)dvi_space_functions(space) * sizeof *U);
  monomial m = {.n = n};
  do {
    ck_assert_int_eq(dvi_space_interpolate(space, monomial_at, &m, U), DVI_OK);
    for (int d = -1; d < n; d++) check_derivative(space, m, d, U);
  } while (next_monomial(&m, degree));
  free(U);
  dvi_space_destroy(&space);
}

/* Derivatives of polynomials of size 1 on cells of size 1/3 have roundings of 1e-15. */
START_TEST(polynomials_and_their_derivatives_are_exact)
{
  check_polynomials(linear, 2, 1);
  check_polynomials(quadratic, 2, 2);
  check_polynomials(linear, 3, 1);
  check_polynomials(quadratic, 3, 2);
}
END_TEST

START_TEST(the_functions_sum_to_one)
{
  for (int n = 2; n <= 3; n++) {
    dvi_space *space = space_in_cube(quadratic, n, 2);
    const int64_t functions = dvi_space_functions(space),
                  points = dvi_space_points(space, NULL, NULL);
    double *U = malloc((size_t)functions * sizeof *U), *u = malloc((size_t)points * sizeof *u);
    const int value[3] = {0};
    for (int64_t i = 0; i < functions; i++) U[i] = 1;
    ck_assert_int_eq(dvi_space_apply(space, value, U, u), DVI_OK);
    for (int64_t k = 0; k < points; k++) ck_assert_double_eq_tol(u[k], 1, 1e-15);
    free(U);
    free(u);
    dvi_space_destroy(&space);
  }
}
END_TEST

/* ---- numbers, boundaries and refusals ---- */

START_TEST(functions_of_a_part_are_those_of_its_vertices_and_edges)
{
  dvi_mesh *mesh = jittered_mesh(2, 2, 3, 0, 1);
  dvi_space *one = space_on_mesh(linear, mesh), *two = space_on_mesh(quadratic, mesh);
  int64_t count;
  ck_assert_int_eq(dvi_space_functions(one), 16);
  ck_assert_int_eq(dvi_space_functions(two), 16 + 33);
  ck_assert_ptr_nonnull(dvi_space_boundary(one, "boundary", &count));
  ck_assert_int_eq(count, 12);
  const int *function = dvi_space_boundary(two, "boundary", &count);
  ck_assert_int_eq(count, 12 + 12);
  for (int i = 1; i < count; i++) ck_assert_int_lt(function[i - 1], function[i]);
  ck_assert_ptr_null(dvi_space_boundary(two, "left", &count));
  ck_assert_int_eq(count, 0);
  dvi_space_destroy(&one);
  dvi_space_destroy(&two);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(a_torus_has_the_area_of_its_period_and_no_boundary)
{
  dvi_mesh *mesh = equilateral_torus(6, 4);
  dvi_space *space = space_on_mesh(quadratic, mesh);
  const double *weight, height = 4.0 / 6 * sqrt(0.75);
  const int64_t points = dvi_space_points(space, NULL, &weight);
  int64_t count;
  double area = 0;
  for (int64_t k = 0; k < points; k++) area += weight[k];
  ck_assert_double_eq_tol(area, height, 1e-14);
  ck_assert_int_eq(dvi_space_functions(space), 24 + 72);
  ck_assert_ptr_nonnull(dvi_space_boundary(space, "boundary", &count));
  ck_assert_int_eq(count, 0);
  dvi_space_destroy(&space);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(a_space_outlives_the_mesh_of_its_creation)
{
  dvi_space *space = space_in_cube(quadratic, 2, 2);
  const int order[2] = {0};
  const double x[2] = {2, 0.5};
  double U[25] = {0}, u;
  char text[200];
  ck_assert_int_eq(dvi_space_evaluate(space, order, U, 1, x, &u), DVI_BAD_ARGUMENT);
  check_words("space: the point x = 2, y = 0.5 lies outside of the domain");
  dvi_space_explain(space, text, sizeof text);
  ck_assert_str_eq(text, "mesh of 8 triangles: fem, degree 2: 25 functions, 6 points a cell, exact "
                         "for polynomials of degree 4\n");
  dvi_space_destroy(&space);
}
END_TEST

START_TEST(a_row_evaluates_at_one_point)
{
  dvi_space *space = space_in_cube(quadratic, 3, 2);
  const int value[3] = {0};
  const double x[3] = {0.3, 0.6, 0.1}, far[3] = {2, 0, 0};
  int column[10];
  double entry[10], sum = 0;
  int64_t count;
  ck_assert_int_eq(dvi__space_row_entries(space), 10);
  ck_assert_int_eq(dvi__space_row(space, value, x, 10, column, entry, &count), DVI_OK);
  for (int i = 0; i < count; i++) sum += entry[i];
  ck_assert_double_eq_tol(sum, 1, 1e-14);
  for (int i = 1; i < count; i++) ck_assert_int_lt(column[i - 1], column[i]);
  ck_assert_int_eq(dvi__space_row(space, value, far, 10, column, entry, &count), DVI_OK);
  ck_assert_int_eq(count, 0);
  ck_assert_int_eq(dvi__space_row(space, value, x, 9, column, entry, &count), DVI_BAD_SIZE);
  check_words("a row has up to 10 entries, and there is place for 9");
  dvi_space_destroy(&space);
}
END_TEST

static void check_refusal(const char *kind, dvi_mesh *mesh, dvi_status status, const char *words)
{
  const dvi_space_options options = {.size = sizeof options, .kind = kind, .mesh = mesh};
  dvi_space *space;
  ck_assert_int_eq(dvi_space_create(&options, &space), status);
  ck_assert_ptr_null(space);
  check_words(words);
  dvi_mesh_destroy(&mesh);
}

static dvi_mesh *boxes(void)
{
  const dvi_generator_options options = {.size = sizeof options, .cells = {2, 2}};
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate("box", &options, &mesh), DVI_OK);
  return mesh;
}

START_TEST(what_does_not_fit_is_refused)
{
  check_refusal(linear, boxes(), DVI_UNSUPPORTED, "the mesh has boxes of dimension 2");
  check_refusal(linear, ring_mesh(8, 0, 1), DVI_UNSUPPORTED,
                "the mesh has simplices of dimension 1");
  check_refusal(linear, jittered_mesh(2, 3, 2, 0, 1), DVI_UNSUPPORTED,
                "cells of dimension 2 in 3 coordinates");
  check_refusal("fem:degree=3", jittered_mesh(2, 2, 2, 0, 1), DVI_BAD_OPTION,
                "space: fem: degree=3; whole numbers from 1 to 2");
  check_refusal("fem:cells=3", jittered_mesh(2, 2, 2, 0, 1), DVI_BAD_OPTION,
                "space: fem has no option \"cells\"; it has degree, points");
  check_refusal("fem:points=4", jittered_mesh(2, 2, 2, 0, 1), DVI_BAD_OPTION,
                "space: fem: points=4; 1, 3 and 6 are possible in triangles");
  check_refusal("spline", jittered_mesh(3, 3, 2, 0, 1), DVI_BAD_OPTION,
                "space: there is no kind \"spline\" here; there are fem");
}
END_TEST

START_TEST(second_derivatives_are_refused)
{
  dvi_space *space = space_in_cube(quadratic, 2, 2);
  const int second[2] = {2, 0}, mixed[2] = {1, 1};
  double U[25] = {0}, u[100];
  ck_assert_int_eq(dvi_space_apply(space, second, U, u), DVI_UNSUPPORTED);
  check_words("a derivative of order 2 along x is asked, but functions of this space have 1");
  ck_assert_int_eq(dvi_space_apply(space, mixed, U, u), DVI_UNSUPPORTED);
  check_words("a derivative of order 2 is asked, but functions on a mesh have first ones only");
  dvi_space_destroy(&space);
}
END_TEST

START_TEST(a_lack_of_memory_leaks_nothing)
{
  dvi_mesh *mesh = jittered_mesh(3, 3, 2, 0, 1);
  const dvi_space_options options = {.size = sizeof options, .kind = quadratic, .mesh = mesh};
  dvi_space *space = NULL;
  for (long allowed = 0; space == NULL; allowed++) {
    dvi__fail_allocations_after(allowed);
    const dvi_status status = dvi_space_create(&options, &space);
    dvi__fail_allocations_after(-1);
    ck_assert_int_eq(status, space != NULL ? DVI_OK : DVI_NO_MEMORY);
  }
  dvi_space_destroy(&space);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(space_meshes)
{
  tcase_add_test(tests, quadratures_are_exact_to_their_degree);
  tcase_add_test(tests, polynomials_and_their_derivatives_are_exact);
  tcase_add_test(tests, the_functions_sum_to_one);
  tcase_add_test(tests, functions_of_a_part_are_those_of_its_vertices_and_edges);
  tcase_add_test(tests, a_torus_has_the_area_of_its_period_and_no_boundary);
  tcase_add_test(tests, a_space_outlives_the_mesh_of_its_creation);
  tcase_add_test(tests, a_row_evaluates_at_one_point);
  tcase_add_test(tests, what_does_not_fit_is_refused);
  tcase_add_test(tests, second_derivatives_are_refused);
  tcase_add_test(tests, a_lack_of_memory_leaks_nothing);
}
