/* Spaces of one dimension. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "field/space/space.h"
#include "support/field/function_spaces.h"
#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* A kind with a degree in it. */
typedef struct kind_text {
  char text[80];
} kind_text;

static kind_text kind_of(const char *form, int degree, int cells)
{
  kind_text kind;
  (void)snprintf(kind.text, sizeof kind.text, form, degree, cells);
  return kind;
}

static const char *const consistent = "fem:degree=%d,cells=%d",
                         *const lumped = "fem:degree=%d,cells=%d,lumped=yes",
                         *const splines = "spline:degree=%d,cells=%d";

static const double nodes[] = {-1, -0.7, -0.1, 0.05, 0.6, 1.3, 1.5};

/* A space on unequal cells from -1 to 1.5. */
static dvi_space *uneven_space(const char *kind, int periodic)
{
  const dvi_axis axis = {.from = -1, .to = 1.5, .periodic = periodic, .node = nodes, .nodes = 7};
  const dvi_space_options options = {
      .size = sizeof options, .kind = kind, .axis = &axis, .axes = 1};
  dvi_space *space = NULL;
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  return space;
}

/* ---- eigenvalues ---- */

enum { CELLS = 24, MOST = 400 };

static double largest_eigenvalue(const char *form, int degree)
{
  double lambda[MOST];
  dvi_space *space = space_on_line(kind_of(form, degree, CELLS).text, 0, CELLS, 1);
  space_forms forms = forms_of_space(space);
  space_eigenvalues(&forms, lambda);
  const double largest = lambda[forms.n - 1];
  free_space_forms(&forms);
  dvi_space_destroy(&space);
  return largest;
}

static void check_largest(const char *form, int count, const int *degree, const double *exact,
                          double tolerance)
{
  for (int i = 0; i < count; i++) {
    const double found = largest_eigenvalue(form, degree[i]);
    ck_assert_msg(fabs(found - exact[i]) <= tolerance * exact[i], "degree %d: %.12g, not %.12g",
                  degree[i], found, exact[i]);
  }
}

/* lambda h^2 of the wave u'' = -lambda u, from numpy, to as many digits as are given. */
START_TEST(the_largest_eigenvalues_of_consistent_elements)
{
  const int degree[] = {1, 2, 3, 4, 5, 6, 8};
  const double exact[] = {12, 60, 170.1249025, 380.2351315, 738.9049, 1304.603, 3339.446};
  check_largest(consistent, 7, degree, exact, 1e-7);
}
END_TEST

START_TEST(the_largest_eigenvalues_of_lumped_elements)
{
  const int degree[] = {1, 2, 3, 4, 5, 6, 8};
  const double exact[] = {4, 24, 74.3109888, 183.3484833, 391.9589, 749.5576, 2154.992};
  check_largest(lumped, 7, degree, exact, 2e-7);
}
END_TEST

/* Those of degree p tend to pi^2, the value of waves of two cells. */
START_TEST(the_largest_eigenvalues_of_splines)
{
  const int degree[] = {1, 2, 3, 4, 5};
  const double exact[] = {12, 10, 9.88235294, 9.87096774, 9.86975398};
  check_largest(splines, 5, degree, exact, 1e-9);
}
END_TEST

/* The largest one of a single polynomial with fixed ends grows as the fourth power of the degree.
 * */
START_TEST(the_largest_eigenvalue_of_one_legendre_element)
{
  double lambda[40];
  dvi_space *space = space_on_line("legendre:degree=32", -1, 1, 0);
  const int count = space_eigenvalues_inside(space, "boundary", lambda);
  ck_assert_int_eq(count, 31);
  ck_assert_double_eq_tol(lambda[count - 1] / pow(32, 4), 0.02711, 5e-6);
  dvi_space_destroy(&space);
}
END_TEST

/* ---- interpolation ---- */

static int wave(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) f[i] = sin(*(double *)user * x[i] + 0.3);
  return 0;
}

/* (x - 1/5)^degree, and its derivatives. */
typedef struct power {
  int degree, order;
} power;

static int power_at(int64_t count, const double *x, double *f, void *user)
{
  const power *p = user;
  for (int64_t i = 0; i < count; i++) {
    f[i] = p->order <= p->degree ? 1 : 0;
    for (int r = 0; r < p->order; r++) f[i] *= p->degree - r;
    for (int r = p->order; r < p->degree; r++) f[i] *= x[i] - 0.2;
  }
  return 0;
}

/* Compares all derivatives of a polynomial with exact ones, at the points and at 40 other places.
 * `growth` is by how much a derivative amplifies roundings. */
static void check_polynomial(const dvi_space *space, int degree, double growth)
{
  enum { PLACES = 40 };
  power p = {degree, 0};
  const double *x;
  const int64_t functions = dvi_space_functions(space), points = dvi_space_points(space, &x, NULL);
  double *U = malloc((size_t)functions * sizeof *U), *u = malloc((size_t)points * sizeof *u),
         *exact = malloc((size_t)points * sizeof *exact), place[PLACES], v[PLACES], w[PLACES],
         tolerance = 1e-13;
  for (int i = 0; i < PLACES; i++) place[i] = -1 + 2.5 * i / (PLACES - 1);
  ck_assert_msg(dvi_space_interpolate(space, power_at, &p, U) == DVI_OK, "%s", dvi_last_error());
  for (p.order = 0; p.order <= dvi_space_smoothness(space, 0); p.order++) {
    ck_assert_int_eq(dvi_space_apply(space, &p.order, U, u), DVI_OK);
    (void)power_at(points, x, exact, &p);
    for (int64_t k = 0; k < points; k++) ck_assert_double_eq_tol(u[k], exact[k], tolerance);
    ck_assert_int_eq(dvi_space_evaluate(space, &p.order, U, PLACES, place, v), DVI_OK);
    (void)power_at(PLACES, place, w, &p);
    for (int k = 0; k < PLACES; k++) ck_assert_double_eq_tol(v[k], w[k], tolerance);
    tolerance *= growth;
  }
  free(U);
  free(u);
  free(exact);
}

/* A derivative on cells of 0.15 at degree p amplifies roundings by about p^2/0.15. */
START_TEST(derivatives_of_polynomials_are_exact_on_unequal_cells)
{
  const char *const forms[] = {"fem:degree=%d", "fem:degree=%d,lumped=yes", "spline:degree=%d"};
  for (int f = 0; f < 3; f++)
    for (int k = 1; k <= 8; k++) {
      dvi_space *space = uneven_space(kind_of(forms[f], k, 0).text, 0);
      check_polynomial(space, k, 2 * k * k / 0.15);
      dvi_space_destroy(&space);
    }
}
END_TEST

START_TEST(one_polynomial_has_all_of_its_derivatives)
{
  for (int degree = 1; degree <= 6; degree++)
    for (int f = 0; f < 2; f++) {
      const char *form = f == 0 ? "legendre:degree=%d" : "chebyshev:degree=%d";
      dvi_space *space = space_on_line(kind_of(form, degree, 0).text, -1, 1.5, 0);
      ck_assert_int_eq(dvi_space_smoothness(space, 0), degree);
      check_polynomial(space, degree, 2 * degree * degree);
      dvi_space_destroy(&space);
    }
}
END_TEST

/* Roundings of values are amplified by N^2 for each derivative. */
START_TEST(one_polynomial_of_degree_256_is_accurate)
{
  const char *const kinds[] = {"legendre:degree=256", "chebyshev:degree=256"};
  for (int f = 0; f < 2; f++) {
    dvi_space *space = space_on_line(kinds[f], -1, 1, 0);
    const double *x;
    const int64_t points = dvi_space_points(space, &x, NULL);
    double U[257], u[257], tolerance = 1e-13, number = 2;
    ck_assert_int_eq(points, 257);
    ck_assert_int_eq(dvi_space_interpolate(space, wave, &number, U), DVI_OK);
    for (int order = 0; order <= 2; order++) {
      ck_assert_int_eq(dvi_space_apply(space, &order, U, u), DVI_OK);
      for (int64_t k = 0; k < points; k++)
        ck_assert_double_eq_tol(u[k], pow(2, order) * sin(2 * x[k] + 0.3 + order * pi / 2),
                                tolerance);
      tolerance *= 256 * 16;
    }
    dvi_space_destroy(&space);
  }
}
END_TEST

/* ---- quadrature ---- */

/* The sum over the points of (x - 1/5)^degree against its integral from -1 to 1.5. */
static double integral_error(const dvi_space *space, int degree)
{
  power p = {degree, 0};
  const double *x, *weight;
  const int64_t points = dvi_space_points(space, &x, &weight);
  double *f = malloc((size_t)points * sizeof *f), sum = 0;
  (void)power_at(points, x, f, &p);
  for (int64_t k = 0; k < points; k++) sum += weight[k] * f[k];
  free(f);
  return sum - (pow(1.3, degree + 1) - pow(-1.2, degree + 1)) / (degree + 1);
}

/* The sums of positive terms reach 1.3^16 = 66. */
static void check_rule(const char *kind, int degree)
{
  dvi_space *space = uneven_space(kind, 0);
  for (int i = 0; i <= degree; i++) ck_assert_double_eq_tol(integral_error(space, i), 0, 1e-13);
  ck_assert_double_ge(fabs(integral_error(space, degree + 1)), 1e-13);
  dvi_space_destroy(&space);
}

START_TEST(quadratures_are_exact_to_their_degree)
{
  for (int k = 1; k <= 3; k++) {
    check_rule(kind_of("fem:degree=%d", k, 0).text, 2 * k + 1);
    check_rule(kind_of("fem:degree=%d,lumped=yes", k, 0).text, 2 * k - 1);
    check_rule(kind_of("spline:degree=%d", k, 0).text, 2 * k + 1);
    check_rule(kind_of("fem:degree=2,points=%d", k, 0).text, 2 * k - 1);
    check_rule(kind_of("spline:points=%d", k, 0).text, 2 * k - 1);
  }
}
END_TEST

/* The functions of fem, splines and polynomials contain 1. */
START_TEST(the_functions_sum_to_one)
{
  const char *const kinds[] = {"fem:degree=5,cells=4", "fem:degree=5,cells=4,lumped=yes",
                               "spline:degree=5,cells=4", "legendre:degree=20",
                               "chebyshev:degree=20"};
  for (int i = 0; i < 10; i++) {
    dvi_space *space = space_on_line(kinds[i / 2], 0, 2, i % 2);
    const int64_t functions = dvi_space_functions(space),
                  points = dvi_space_points(space, NULL, NULL);
    double U[MOST], u[MOST];
    const int value = 0, slope = 1;
    for (int64_t j = 0; j < functions; j++) U[j] = 1;
    ck_assert_int_eq(dvi_space_apply(space, &value, U, u), DVI_OK);
    for (int64_t k = 0; k < points; k++) ck_assert_double_eq_tol(u[k], 1, 1e-14);
    ck_assert_int_eq(dvi_space_apply(space, &slope, U, u), DVI_OK);
    for (int64_t k = 0; k < points; k++) ck_assert_double_eq_tol(u[k], 0, 1e-12);
    dvi_space_destroy(&space);
  }
}
END_TEST

/* ---- nodal spaces ---- */

START_TEST(values_of_a_nodal_space_are_coefficients)
{
  const char *const kinds[] = {"fem:degree=4,cells=3,lumped=yes", "legendre:degree=40"};
  for (int i = 0; i < 4; i++) {
    dvi_space *space = space_on_line(kinds[i / 2], 0, 2, i % 2);
    dvi__space_operator B;
    const int value = 0;
    ck_assert_int_eq(dvi__space_is_nodal(space), 1);
    ck_assert_int_eq(dvi__operator_make(space, &value, &B), DVI_OK);
    for (int64_t k = 0; k < B.matrix.rows; k++) {
      ck_assert_int_eq(B.matrix.start[k + 1] - B.matrix.start[k], 1);
      ck_assert(B.matrix.value[B.matrix.start[k]] == 1);
    }
    dvi__operator_clear(&B);
    dvi_space_destroy(&space);
  }
}
END_TEST

START_TEST(the_mass_of_chebyshev_nodes_is_exact)
{
  dvi_space *space = space_on_line("chebyshev:degree=6", -1, 1.5, 0),
            *judge = space_on_line("chebyshev:degree=6,points=12", -1, 1.5, 0);
  space_forms found = forms_of_space(space), exact = forms_of_space(judge);
  ck_assert_int_eq(dvi__space_is_nodal(space), 0);
  for (int i = 0; i < 49; i++) ck_assert_double_eq_tol(found.mass[i], exact.mass[i], 1e-15);
  free_space_forms(&found);
  free_space_forms(&exact);
  dvi_space_destroy(&space);
  dvi_space_destroy(&judge);
}
END_TEST

/* ---- ends ---- */

static void check_counts(const char *kind, int periodic, int functions, int boundary)
{
  dvi_space *space = space_on_line(kind, 0, 1, periodic);
  int64_t count = -1;
  ck_assert_int_eq(dvi_space_functions(space), functions);
  ck_assert_ptr_nonnull(dvi_space_boundary(space, "boundary", &count));
  ck_assert_int_eq(count, boundary);
  dvi_space_destroy(&space);
}

START_TEST(periodic_ends_are_one)
{
  check_counts("fem:degree=3,cells=5", 0, 16, 2);
  check_counts("fem:degree=3,cells=5", 1, 15, 0);
  check_counts("spline:degree=3,cells=5", 0, 8, 2);
  check_counts("spline:degree=3,cells=5", 1, 5, 0);
  check_counts("legendre:degree=7", 0, 8, 2);
  check_counts("legendre:degree=7", 1, 7, 0);
}
END_TEST

START_TEST(the_ends_of_an_axis_have_one_function_each)
{
  const char *const kinds[] = {"fem:degree=3,cells=5", "spline:degree=3,cells=5",
                               "chebyshev:degree=7"};
  for (int i = 0; i < 3; i++) {
    dvi_space *space = space_on_line(kinds[i], 0, 1, 0);
    const int last = (int)dvi_space_functions(space) - 1;
    int64_t count;
    ck_assert_int_eq(*dvi_space_boundary(space, "left", &count), 0);
    ck_assert_int_eq(*dvi_space_boundary(space, "right", &count), last);
    ck_assert_int_eq(count, 1);
    ck_assert_ptr_null(dvi_space_boundary(space, "top", &count));
    ck_assert_int_eq(count, 0);
    for (int end = 0; end < 2; end++) {
      const double x = end;
      double U[20] = {0}, u;
      const int value = 0;
      U[end == 0 ? 0 : last] = 1;
      ck_assert_int_eq(dvi_space_evaluate(space, &value, U, 1, &x, &u), DVI_OK);
      ck_assert_double_eq_tol(u, 1, 1e-15);
    }
    dvi_space_destroy(&space);
  }
}
END_TEST

/* u(x + L) = u(x), also with so few cells that functions meet themselves around the axis. */
START_TEST(periodic_functions_repeat_themselves)
{
  const char *const kinds[] = {"fem:degree=3,cells=4", "fem:cells=1", "spline:degree=4,cells=9",
                               "spline:degree=5,cells=2"};
  for (int i = 0; i < 4; i++) {
    dvi_space *space = space_on_line(kinds[i], 1, 3, 1);
    unsigned long long seed = 8;
    const double x[] = {1.3, 3.3, -0.7, 7.3, 1, 3};
    double U[20], u[6];
    const int value = 0;
    for (int j = 0; j < 20; j++) U[j] = random_number(&seed);
    ck_assert_int_eq(dvi_space_evaluate(space, &value, U, 6, x, u), DVI_OK);
    for (int j = 1; j < 4; j++) ck_assert_double_eq_tol(u[j], u[0], 1e-13);
    ck_assert_double_eq_tol(u[5], u[4], 1e-13);
    dvi_space_destroy(&space);
  }
}
END_TEST

/* Splines of degree p have p - 1 continuous derivatives also at unequal cells and around. */
START_TEST(splines_are_smooth_at_the_ends_of_cells)
{
  for (int p = 2; p <= 8; p++) {
    dvi_space *space = uneven_space(kind_of("spline:degree=%d", p, 0).text, 1);
    unsigned long long seed = 6;
    double U[6], u[14];
    for (int j = 0; j < 6; j++) U[j] = random_number(&seed);
    for (int order = 0; order < p; order++) {
      double x[14], size = 1e-11;
      for (int i = 0; i < 7; i++) {
        x[2 * i] = nodes[i] - 1e-12;
        x[2 * i + 1] = nodes[i] + 1e-12;
      }
      ck_assert_int_eq(dvi_space_evaluate(space, &order, U, 14, x, u), DVI_OK);
      for (int i = 0; i < 14; i++) size = fmax(size, fabs(u[i]));
      for (int i = 0; i < 7; i++) ck_assert_double_eq_tol(u[2 * i], u[2 * i + 1], 1e-8 * size);
    }
    dvi_space_destroy(&space);
  }
}
END_TEST

/* ---- size ---- */

/* A table for each cell would take a block for each, or quadratic memory. */
START_TEST(a_million_cells_take_a_few_blocks_of_memory)
{
  const long before = dvi__allocation_count();
  dvi_space *space = space_on_line("fem:degree=1,cells=1000000", 0, 1, 0);
  dvi__space_operator B;
  const int slope = 1;
  ck_assert_int_eq(dvi__operator_make(space, &slope, &B), DVI_OK);
  ck_assert_int_eq(B.matrix.start[B.matrix.rows], 4000000);
  ck_assert_int_lt(dvi__allocation_count() - before, 30);
  dvi__operator_clear(&B);
  dvi_space_destroy(&space);
}
END_TEST

SUITE(space_lines)
{
  tcase_add_test(tests, the_largest_eigenvalues_of_consistent_elements);
  tcase_add_test(tests, the_largest_eigenvalues_of_lumped_elements);
  tcase_add_test(tests, the_largest_eigenvalues_of_splines);
  tcase_add_test(tests, the_largest_eigenvalue_of_one_legendre_element);
  tcase_add_test(tests, derivatives_of_polynomials_are_exact_on_unequal_cells);
  tcase_add_test(tests, one_polynomial_has_all_of_its_derivatives);
  tcase_add_test(tests, one_polynomial_of_degree_256_is_accurate);
  tcase_add_test(tests, quadratures_are_exact_to_their_degree);
  tcase_add_test(tests, the_functions_sum_to_one);
  tcase_add_test(tests, values_of_a_nodal_space_are_coefficients);
  tcase_add_test(tests, the_mass_of_chebyshev_nodes_is_exact);
  tcase_add_test(tests, periodic_ends_are_one);
  tcase_add_test(tests, the_ends_of_an_axis_have_one_function_each);
  tcase_add_test(tests, periodic_functions_repeat_themselves);
  tcase_add_test(tests, splines_are_smooth_at_the_ends_of_cells);
  tcase_add_test(tests, a_million_cells_take_a_few_blocks_of_memory);
}
