/* Integrals of forms over cells, and Whitney's interpolation between them. */
#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>

#include "support/meshes.h"
#include "support/suite.h"

/* The form whose component c is sum_l (c + 1 + l) x_l + c + 1/2, or only the constant. */
typedef struct affine {
  int space, k;
  double linear;
} affine;

static int affine_form(const double *x, double *value, void *user)
{
  const affine *f = user;
  for (int c = 0; c < dvi_form_components(f->space, f->k); c++) {
    value[c] = c + 0.5;
    for (int l = 0; l < f->space; l++) value[c] += f->linear * (c + 1 + l) * x[l];
  }
  return 0;
}

static double *integrals(const dvi_mesh *mesh, int k, dvi_form_function *function, void *user)
{
  double *form = calloc((size_t)dvi_mesh_count(mesh, k), sizeof *form);
  ck_assert_msg(dvi_form_integrate(mesh, k, function, user, form) == DVI_OK, "%s",
                dvi_last_error());
  return form;
}

START_TEST(components_are_counted)
{
  ck_assert_int_eq(dvi_form_components(3, 0), 1);
  ck_assert_int_eq(dvi_form_components(3, 2), 3);
  ck_assert_int_eq(dvi_form_components(4, 2), 6);
  ck_assert_int_eq(dvi_form_components(8, 4), 70);
  ck_assert_int_eq(dvi_form_components(3, 4), 0);
  ck_assert_int_eq(dvi_form_components(9, 1), 0);
}
END_TEST

/* Constant forms of each degree have constant values in each cell. */
START_TEST(constant_forms_are_interpolated_exactly)
{
  for (int n = 1; n <= 4; n++) {
    dvi_mesh *mesh = jittered_mesh(n, n, 2, 0.2, (unsigned)n);
    for (int k = 0; k <= n; k++) {
      affine f = {n, k, 0};
      double value[6], *form = integrals(mesh, k, affine_form, &f);
      double place[] = {0.1, 0.2, 0.3, 0.15, 0.25}, sum = 0;
      for (int i = 0; i <= n; i++) sum += place[i];
      for (int i = 0; i <= n; i++) place[i] /= sum;
      for (int64_t c = 0; c < dvi_mesh_count(mesh, n); c++) {
        ck_assert_int_eq(dvi_form_evaluate(mesh, k, form, c, place, value), DVI_OK);
        for (int i = 0; i < dvi_form_components(n, k); i++)
          ck_assert_double_eq_tol(value[i], i + 0.5, 1e-12 * (i + 1));
      }
      free(form);
    }
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* Stokes: the integral of d(x_0 f) over a cell is that of x_0 f over its boundary. Here for 0-forms
 * of degree 3, whose derivative has degree 2. */
static int cubic(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = x[0] * x[0] * x[1] - 2 * x[1] * x[1] * x[1] + x[0];
  return 0;
}

static int slope_of_cubic(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = 2 * x[0] * x[1] + 1;
  value[1] = x[0] * x[0] - 6 * x[1] * x[1];
  return 0;
}

/* d of the 1-form (-x^2 y, x y^2) is y^2 + x^2. */
static int turning(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = -x[0] * x[0] * x[1];
  value[1] = x[0] * x[1] * x[1];
  return 0;
}

static int curl_of_turning(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = x[0] * x[0] + x[1] * x[1];
  return 0;
}

static void check_stokes(const dvi_mesh *mesh, int k, dvi_form_function *f, dvi_form_function *df)
{
  dvi_matrix d;
  ck_assert_int_eq(dvi_mesh_incidence(mesh, k, &d), DVI_OK);
  double *a = integrals(mesh, k, f, NULL), *b = integrals(mesh, k + 1, df, NULL),
         *da = calloc((size_t)d.rows, sizeof *da);
  dvi_matrix_multiply(&d, 0, a, da);
  for (int64_t i = 0; i < d.rows; i++) ck_assert_double_eq_tol(da[i], b[i], 1e-15);
  free(a);
  free(b);
  free(da);
}

START_TEST(the_derivative_is_exact)
{
  dvi_mesh *mesh = jittered_mesh(2, 2, 4, 0.2, 1);
  check_stokes(mesh, 0, cubic, slope_of_cubic);
  check_stokes(mesh, 1, turning, curl_of_turning);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Largest error of the interpolation of a smooth 1-form at the centres of the cells. */
static int smooth_form(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = sin(x[0] + 2 * x[1]);
  value[1] = cos(3 * x[0]) * x[1];
  return 0;
}

static double error_at_centres(int cells)
{
  dvi_mesh *mesh = jittered_mesh(2, 2, cells, 0.1, 1);
  double *form = integrals(mesh, 1, smooth_form, NULL), worst = 0;
  const double place[] = {1.0 / 3, 1.0 / 3, 1.0 / 3}, *x = dvi_mesh_points(mesh);
  for (int64_t c = 0; c < dvi_mesh_count(mesh, 2); c++) {
    const int *vertex = dvi_mesh_vertices(mesh, 2, NULL) + 3 * c;
    double value[2], right[2], centre[2] = {0};
    for (int i = 0; i < 3; i++)
      for (int l = 0; l < 2; l++) centre[l] += x[2 * vertex[i] + l] / 3;
    ck_assert_int_eq(dvi_form_evaluate(mesh, 1, form, c, place, value), DVI_OK);
    (void)smooth_form(centre, right, NULL);
    for (int l = 0; l < 2; l++) worst = fmax(worst, fabs(value[l] - right[l]));
  }
  free(form);
  dvi_mesh_destroy(&mesh);
  return worst;
}

START_TEST(interpolation_of_a_1_form_has_order_1)
{
  double last = error_at_centres(8);
  for (int cells = 16; cells <= 64; cells *= 2) {
    const double error = error_at_centres(cells), order = log2(last / error);
    ck_assert_msg(order > 0.8 && order < 1.4, "order %.2f with %d cells", order, cells);
    last = error;
  }
}
END_TEST

/* ---- bad input ---- */

static int failing(const double *x, double *value, void *user)
{
  (void)x, (void)value, (void)user;
  return 3;
}

static int undefined(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = log(x[0] - 0.5);
  return 0;
}

START_TEST(bad_functions_are_named)
{
  double form[9], place[3] = {0}, value[2];
  dvi_mesh *mesh = jittered_mesh(2, 2, 2, 0, 1);
  ck_assert_int_eq(dvi_form_integrate(mesh, 0, failing, NULL, form), DVI_CALLBACK_FAILED);
  check_words("a 0-form returned 3 in vertex 0");
  ck_assert_int_eq(dvi_form_integrate(mesh, 0, undefined, NULL, form), DVI_NOT_FINITE);
  check_words("in vertex 0");
  ck_assert_int_eq(dvi_form_integrate(mesh, 3, failing, NULL, form), DVI_BAD_ARGUMENT);
  check_words("the degree is 3, and must be 0 to 2");
  ck_assert_int_eq(dvi_form_integrate(mesh, 0, NULL, NULL, form), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_form_evaluate(mesh, 0, form, 99, place, value), DVI_BAD_ARGUMENT);
  check_words("no cell 99");
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(derham)
{
  tcase_add_test(tests, components_are_counted);
  tcase_add_test(tests, constant_forms_are_interpolated_exactly);
  tcase_add_test(tests, the_derivative_is_exact);
  tcase_add_test(tests, interpolation_of_a_1_form_has_order_1);
  tcase_add_test(tests, bad_functions_are_named);
}
