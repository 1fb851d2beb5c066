/* labels: order */
/* Orders of interpolation and of eigenvalues. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/field/function_spaces.h"
#include "support/meshes.h"
#include "support/suite.h"

enum { MOST = 400 };

static const double pi = 3.14159265358979323846;

static const char *const consistent = "fem:degree=%d,cells=%d",
                         *const lumped = "fem:degree=%d,cells=%d,lumped=yes",
                         *const splines = "spline:degree=%d,cells=%d";

static dvi_space *space_on_string(const char *form, int degree, int cells)
{
  char kind[80];
  (void)snprintf(kind, sizeof kind, form, degree, cells);
  return space_on_line(kind, 0, pi, 0);
}

/* Requires that errors [4] on four meshes fall with an order. */
static void check_order(const char *kind, const int *cells, const double *error, double order,
                        double tolerance)
{
  for (int i = 0; i < 3; i++) {
    const double found = log(error[i] / error[i + 1]) / log((double)cells[i + 1] / cells[i]);
    ck_assert_msg(fabs(found - order) < tolerance, "%s, %d to %d cells: order %g, not %g", kind,
                  cells[i], cells[i + 1], found, order);
  }
}

/* ---- one axis ---- */

/* The error of the lowest eigenvalue of a string with fixed ends, 1 on [0, pi]. */
static double eigenvalue_error(const char *form, int degree, int cells)
{
  double lambda[MOST];
  dvi_space *space = space_on_string(form, degree, cells);
  (void)space_eigenvalues_inside(space, "boundary", lambda);
  dvi_space_destroy(&space);
  return fabs(lambda[0] - 1);
}

static void check_eigenvalues(const char *form, int degree, const int *cells, double tolerance)
{
  double error[4];
  for (int i = 0; i < 4; i++) error[i] = eigenvalue_error(form, degree, cells[i]);
  check_order(form, cells, error, 2 * degree, tolerance * degree);
}

/* The errors go down to 1e-11. Roundings are 1e-14 and more. */
START_TEST(eigenvalues_have_the_order_2k)
{
  const int cells[4][4] = {{8, 16, 32, 64}, {6, 12, 24, 48}, {4, 6, 8, 12}, {2, 3, 4, 5}};
  for (int k = 1; k <= 4; k++) {
    check_eigenvalues(consistent, k, cells[k - 1], 0.1);
    check_eigenvalues(lumped, k, cells[k - 1], 0.1);
  }
}
END_TEST

/* Open ends add errors that fall faster. */
START_TEST(eigenvalues_of_splines_have_the_order_2p)
{
  const int cells[4][4] = {{8, 16, 32, 64}, {8, 16, 24, 32}, {8, 12, 16, 20}, {8, 10, 12, 14}};
  for (int p = 1; p <= 4; p++) check_eigenvalues(splines, p, cells[p - 1], 0.2);
}
END_TEST

static int line_wave(int64_t count, const double *x, double *f, void *user)
{
  for (int64_t i = 0; i < count; i++) f[i] = sin(*(double *)user * x[i] + 0.3);
  return 0;
}

/* The error in L2 on [0, pi], by a rule that is finer than the space's own. The waves are so
 * short that errors stay above roundings, and so long that the order shows, for splines also at the
 * ends. */
static double error_of(const char *form, int degree, int cells)
{
  double number = form != splines ? 8 : degree < 6 ? 2 : 3;
  enum { PLACES = 4000 };
  const int value[1] = {0};
  double *x = malloc(PLACES * sizeof *x), *u = malloc(PLACES * sizeof *u),
         *exact = malloc(PLACES * sizeof *exact), U[MOST], sum = 0;
  dvi_space *space = space_on_string(form, degree, cells);
  ck_assert_int_eq(dvi_space_interpolate(space, line_wave, &number, U), DVI_OK);
  for (int i = 0; i < PLACES; i++) x[i] = pi * (i + 0.5) / PLACES;
  ck_assert_int_eq(dvi_space_evaluate(space, value, U, PLACES, x, u), DVI_OK);
  (void)line_wave(PLACES, x, exact, &number);
  for (int i = 0; i < PLACES; i++) sum += (u[i] - exact[i]) * (u[i] - exact[i]);
  free(x);
  free(u);
  free(exact);
  dvi_space_destroy(&space);
  return sqrt(sum * pi / PLACES);
}

START_TEST(interpolation_has_the_order_k_plus_1)
{
  const char *const forms[] = {consistent, lumped, splines};
  const int cells[] = {16, 24, 32, 48};
  double error[4];
  for (int f = 0; f < 3; f++)
    for (int k = 1; k <= 8; k++) {
      for (int i = 0; i < 4; i++) error[i] = error_of(forms[f], k, cells[i]);
      check_order(forms[f], cells, error, k + 1, 0.1 * (k + 1));
    }
}
END_TEST

/* ---- a square ---- */

static int product_of_waves(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) f[i] = sin(2 * pi * x[i] + 0.1) * cos(2 * pi * x[count + i]);
  return 0;
}

static double error_on_square(const char *form, int cells)
{
  char kind[60];
  (void)snprintf(kind, sizeof kind, form, cells);
  dvi_space *space = space_on_box(kind, 2, 1, 1);
  const double error = interpolation_error(space, product_of_waves, NULL);
  dvi_space_destroy(&space);
  return error;
}

START_TEST(interpolation_on_a_square_has_the_order_k_plus_1)
{
  const int cells[] = {8, 12, 16, 24};
  double error[4];
  for (int k = 1; k <= 3; k++)
    for (int f = 0; f < 2; f++) {
      char form[60];
      (void)snprintf(form, sizeof form, "%s:degree=%d,points=6,cells=%%d",
                     f == 0 ? "fem" : "spline", k);
      for (int i = 0; i < 4; i++) error[i] = error_on_square(form, cells[i]);
      check_order(form, cells, error, k + 1, 0.1 * (k + 1));
    }
}
END_TEST

/* ---- meshes ---- */

static int wave_on_mesh(int64_t count, const double *x, double *f, void *user)
{
  const int n = *(int *)user;
  for (int64_t i = 0; i < count; i++) {
    f[i] = 1;
    for (int d = 0; d < n; d++) f[i] *= sin(pi * x[d * count + i] + 0.3);
  }
  return 0;
}

/* Error of interpolation by a finer quadrature than that of the nodes. */
static double error_in_cube(const char *kind, int n, int cells)
{
  dvi_mesh *mesh = jittered_mesh(n, n, cells, 0, 1);
  dvi_space *space = space_on_mesh(kind, mesh);
  const double error = interpolation_error(space, wave_on_mesh, &n);
  dvi_space_destroy(&space);
  dvi_mesh_destroy(&mesh);
  return error;
}

static void check_interpolation(const char *kind, int n, const int *cells, double order)
{
  double error[4];
  for (int i = 0; i < 4; i++) error[i] = error_in_cube(kind, n, cells[i]);
  check_order(kind, cells, error, order, 0.1);
}

START_TEST(interpolation_on_meshes_has_the_order_k_plus_1)
{
  const int plane[] = {8, 16, 32, 64}, space[] = {6, 8, 12, 16};
  check_interpolation("fem:degree=1,points=6", 2, plane, 2);
  check_interpolation("fem:degree=2,points=6", 2, plane, 3);
  check_interpolation("fem:degree=1,points=14", 3, space, 2);
  check_interpolation("fem:degree=2,points=14", 3, space, 3);
}
END_TEST

/* The lowest eigenvalue of the square with fixed ends is 2 pi^2. */
static double eigenvalue_error_on_mesh(const char *kind, int cells)
{
  dvi_mesh *mesh = jittered_mesh(2, 2, cells, 0, 1);
  dvi_space *space = space_on_mesh(kind, mesh);
  double *lambda = malloc((size_t)dvi_space_functions(space) * sizeof *lambda);
  (void)space_eigenvalues_inside(space, "boundary", lambda);
  const double error = lambda[0] / (2 * pi * pi) - 1;
  free(lambda);
  dvi_space_destroy(&space);
  dvi_mesh_destroy(&mesh);
  return error;
}

START_TEST(eigenvalues_on_meshes_have_the_order_2k)
{
  const char *const kinds[] = {"fem:degree=1", "fem:degree=2"};
  const int cells[] = {4, 6, 8, 12};
  double error[4];
  for (int k = 1; k <= 2; k++) {
    for (int i = 0; i < 4; i++) error[i] = eigenvalue_error_on_mesh(kinds[k - 1], cells[i]);
    check_order(kinds[k - 1], cells, error, 2 * k, 0.15 * k);
  }
}
END_TEST

SUITE(space_orders)
{
  tcase_add_test(tests, eigenvalues_have_the_order_2k);
  tcase_add_test(tests, eigenvalues_of_splines_have_the_order_2p);
  tcase_add_test(tests, interpolation_has_the_order_k_plus_1);
  tcase_add_test(tests, interpolation_on_a_square_has_the_order_k_plus_1);
  tcase_add_test(tests, interpolation_on_meshes_has_the_order_k_plus_1);
  tcase_add_test(tests, eigenvalues_on_meshes_have_the_order_2k);
}
