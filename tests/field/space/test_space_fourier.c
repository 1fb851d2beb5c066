/* Spaces of trigonometric polynomials. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "field/space/space.h"
#include "support/field/function_spaces.h"
#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

static double *random_array(int64_t count, unsigned long long seed)
{
  double *array = malloc((size_t)count * sizeof *array);
  for (int64_t i = 0; i < count; i++) array[i] = 2 * random_number(&seed) - 1;
  return array;
}

static double dot(int64_t count, const double *a, const double *b)
{
  double sum = 0;
  for (int64_t i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

/* A torus whose axes have different lengths and modes. */
static dvi_space *uneven_torus(int axes)
{
  const dvi_axis axis[] = {
      {.to = 5, .periodic = 1, .kind = "fourier:modes=3"},
      {.from = -1, .to = 2, .periodic = 1, .kind = "fourier:modes=1,points=5"},
      {.to = 1, .periodic = 1, .kind = "fourier:modes=4"},
  };
  const dvi_space_options options = {.size = sizeof options, .axis = axis, .axes = axes};
  dvi_space *space = NULL;
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  return space;
}

static void derive(const dvi_space *space, const int *order, const double *U, double *values)
{
  ck_assert_msg(dvi_space_apply(space, order, U, values) == DVI_OK, "%s", dvi_last_error());
}

static double *transposed(const dvi_space *space, const int *order, const double *values)
{
  dvi__space_operator B;
  ck_assert_int_eq(dvi__operator_make(space, order, &B), DVI_OK);
  double *work = malloc((size_t)(dvi__operator_work(space) + 1) * sizeof *work),
         *U = calloc((size_t)dvi_space_functions(space), sizeof *U);
  dvi__operator_add_transposed(&B, values, U, work);
  dvi__operator_clear(&B);
  free(work);
  return U;
}

/* Both sums have the same terms up to roundings, 1e-16 of their sizes. */
START_TEST(the_transposed_operator_is_the_adjoint)
{
  const int order[] = {1, 0, 2};
  for (int axes = 1; axes <= DVI_AXES_MAX; axes++) {
    dvi_space *space = uneven_torus(axes);
    const int64_t n = dvi_space_functions(space), points = dvi_space_points(space, NULL, NULL);
    double *U = random_array(n, 1), *f = random_array(points, 2), *u = random_array(points, 3);
    derive(space, order, U, u);
    double *F = transposed(space, order, f);
    const double left = dot(points, u, f), right = dot(n, U, F);
    double size = 0;
    for (int64_t k = 0; k < points; k++) size += fabs(u[k] * f[k]);
    ck_assert_msg(fabs(left - right) < 1e-15 * size, "%d axes: %g and %g", axes, left, right);
    free(U);
    free(f);
    free(u);
    free(F);
    dvi_space_destroy(&space);
  }
}
END_TEST

/* With 2K+1 points and more the mass is the identity. */
static void check_mass(const char *kind, int axes)
{
  dvi_space *space = space_on_box(kind, axes, 3, 1);
  const double *weight;
  const int64_t n = dvi_space_functions(space), points = dvi_space_points(space, NULL, &weight);
  const int value[DVI_AXES_MAX] = {0};
  double *U = random_array(n, 5), *u = malloc((size_t)points * sizeof *u);
  derive(space, value, U, u);
  for (int64_t k = 0; k < points; k++) u[k] *= weight[k];
  double *same = transposed(space, value, u);
  for (int64_t i = 0; i < n; i++) ck_assert_double_eq_tol(same[i], U[i], 1e-14);
  free(U);
  free(u);
  free(same);
  dvi_space_destroy(&space);
}

START_TEST(the_mass_is_the_identity)
{
  check_mass("fourier:modes=5,points=11", 1);
  check_mass("fourier:modes=5,points=12", 1);
  check_mass("fourier:modes=5,points=13", 1);
  check_mass("fourier:modes=40", 1);
  check_mass("fourier:modes=3,points=7", 2);
  check_mass("fourier:modes=2", 3);
}
END_TEST

START_TEST(the_operators_are_transforms_and_have_no_boundary)
{
  dvi_space *space = space_on_line("fourier:modes=4", 0, 1, 1);
  int64_t count;
  ck_assert_int_eq(dvi__space_is_fourier(space), 1);
  ck_assert_int_eq(dvi__space_is_nodal(space), 0);
  ck_assert_ptr_null(dvi_space_boundary(space, "boundary", &count));
  ck_assert_int_eq(dvi_space_functions(space), 9);
  ck_assert_int_eq(dvi_space_points(space, NULL, NULL), 18);
  dvi_space_destroy(&space);
}
END_TEST

/* u(x) = cos(2 w (x - 1)) on [1, 4], w = 2 pi/3, is sqrt(3/2) times function 3. */
START_TEST(derivatives_of_all_orders_turn_and_scale_the_pairs)
{
  dvi_space *space = space_on_line("fourier:modes=3", 1, 4, 1);
  const double w = 2 * pi / 3, *x, U[7] = {0, 0, 0, sqrt(1.5), 0, 0, 0};
  const int64_t points = dvi_space_points(space, &x, NULL);
  double u[64];
  for (int order = 0; order <= 6; order++) {
    const double size = pow(2 * w, order);
    derive(space, &order, U, u);
    for (int64_t k = 0; k < points; k++)
      ck_assert_double_eq_tol(u[k], size * cos(2 * w * (x[k] - 1) + order * pi / 2), 1e-13 * size);
  }
  dvi_space_destroy(&space);
}
END_TEST

START_TEST(the_image_of_a_function_is_its_derivative)
{
  const int orders[][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 1}, {3, 2}}, value[2] = {0};
  dvi_space *space = space_on_box("fourier:modes=2", 2, 2, 1);
  const int64_t n = dvi_space_functions(space), points = dvi_space_points(space, NULL, NULL);
  double *U = calloc((size_t)n, sizeof *U), *u = random_array(points, 1),
         *v = random_array(points, 1);
  for (int o = 0; o < 5; o++)
    for (int64_t i = 0; i < n; i++) {
      const dvi__fourier_image image = dvi__fourier_derivative(space, orders[o], i);
      U[i] = 1;
      derive(space, orders[o], U, u);
      U[i] = 0;
      U[image.other] = image.factor;
      derive(space, value, U, v);
      U[image.other] = 0;
      for (int64_t k = 0; k < points; k++) ck_assert_double_eq_tol(u[k], v[k], 1e-10);
    }
  free(U);
  free(u);
  free(v);
  dvi_space_destroy(&space);
}
END_TEST

START_TEST(evaluation_at_the_points_is_the_transform)
{
  for (int axes = 1; axes <= DVI_AXES_MAX; axes++) {
    const int order[] = {1, 2, 0};
    dvi_space *space = uneven_torus(axes);
    const double *x;
    const int64_t points = dvi_space_points(space, &x, NULL);
    double *U = random_array(dvi_space_functions(space), 7), *u = random_array(points, 1),
           *v = random_array(points, 1);
    derive(space, order, U, u);
    ck_assert_int_eq(dvi_space_evaluate(space, order, U, points, x, v), DVI_OK);
    for (int64_t k = 0; k < points; k++) ck_assert_double_eq_tol(u[k], v[k], 1e-10);
    free(U);
    free(u);
    free(v);
    dvi_space_destroy(&space);
  }
}
END_TEST

static int smooth(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) f[i] = exp(sin(x[i]));
  return 0;
}

/* The coefficients of exp(sin x) are the Bessel functions I_k(1), 1.1e-6 at k = 7, 2.5e-17 at 15.
 * */
START_TEST(analytic_functions_are_met_with_exponential_accuracy)
{
  const int modes[] = {6, 10, 14};
  const double largest[] = {1e-5, 1e-10, 1e-14};
  for (int i = 0; i < 3; i++) {
    char kind[40];
    (void)snprintf(kind, sizeof kind, "fourier:modes=%d,points=64", modes[i]);
    dvi_space *space = space_on_line(kind, 0, 2 * pi, 1);
    const double error = interpolation_error(space, smooth, NULL);
    ck_assert_msg(error < largest[i], "%d modes: %g", modes[i], error);
    dvi_space_destroy(&space);
  }
}
END_TEST

/* The sum over points of a product of four functions is the integral: cos(K x)^4 has the mean 3/8.
 * With 4K points it would be 1/2. */
START_TEST(default_points_integrate_products_of_four_functions)
{
  dvi_space *space = space_on_line("fourier:modes=4", 0, 2 * pi, 1);
  const double *x, *weight;
  const int64_t points = dvi_space_points(space, &x, &weight);
  double sum = 0;
  for (int64_t k = 0; k < points; k++) sum += weight[k] * pow(cos(4 * x[k]), 4);
  ck_assert_double_eq_tol(sum, 2 * pi * 3 / 8, 1e-14);
  dvi_space_destroy(&space);
}
END_TEST

static void check_refusal(const char *kind, int periodic, const char *second, dvi_status status,
                          const char *words)
{
  const dvi_axis axis[] = {{.to = 1, .periodic = periodic, .kind = kind},
                           {.to = 1, .periodic = 1, .kind = second}};
  const dvi_space_options options = {
      .size = sizeof options, .axis = axis, .axes = second != NULL ? 2 : 1};
  dvi_space *space;
  ck_assert_int_eq(dvi_space_create(&options, &space), status);
  ck_assert_ptr_null(space);
  check_words(words);
}

START_TEST(what_does_not_fit_is_refused)
{
  check_refusal("fourier", 1, NULL, DVI_BAD_OPTION, "space: fourier has no modes; give modes=1 to");
  check_refusal("fourier:modes=4", 0, NULL, DVI_BAD_ARGUMENT, "axis x, which is not periodic");
  check_refusal("fourier:modes=4,points=8", 1, NULL, DVI_BAD_OPTION,
                "space: fourier: points=8 with modes=4; 9 or more possible");
  check_refusal("fourier:modes=4", 1, "fem:cells=4", DVI_UNSUPPORTED,
                "axis x is fourier and axis y is fem, which does not go together");
}
END_TEST

SUITE(space_fourier)
{
  tcase_add_test(tests, the_transposed_operator_is_the_adjoint);
  tcase_add_test(tests, the_mass_is_the_identity);
  tcase_add_test(tests, the_operators_are_transforms_and_have_no_boundary);
  tcase_add_test(tests, derivatives_of_all_orders_turn_and_scale_the_pairs);
  tcase_add_test(tests, the_image_of_a_function_is_its_derivative);
  tcase_add_test(tests, evaluation_at_the_points_is_the_transform);
  tcase_add_test(tests, analytic_functions_are_met_with_exponential_accuracy);
  tcase_add_test(tests, default_points_integrate_products_of_four_functions);
  tcase_add_test(tests, what_does_not_fit_is_refused);
}
