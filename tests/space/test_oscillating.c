#include <math.h>

#include "roundoff.h"
#include "space/oscillating.h"
#include "space/quadrature.h"
#include "support/suite.h"

enum { FUNCTIONS = DVI__OSCILLATING_FUNCTIONS };

/* Each for one harmonic, and for two. */
static const double lengths[] = {1e-9, 1e-3, 0.1, 1, 9.9, 10.1, 29.9, 30.1, 300, -12};

/* Creates a space of frequency 1, so that h is h omega. */
static dvi__oscillating *create_space(int harmonics, double h)
{
  dvi__oscillating *space = dvi__oscillating_create(3, 1, harmonics, 1);
  ck_assert_ptr_nonnull(space);
  const dvi__shapes shapes = dvi__oscillating_shapes(space);
  shapes.set(shapes.of, h);
  return space;
}

static void check_start_and_first_function(const dvi__shapes *shapes)
{
  const double error = 1e-15 + 10 * (double)long_roundoff();
  double psi[FUNCTIONS], dpsi[FUNCTIONS];
  shapes->path(shapes->of, 0, psi, NULL);
  for (int k = 0; k < shapes->functions; k++) ck_assert_double_eq_tol(psi[k], 0, error);
  shapes->path(shapes->of, 0.3, psi, dpsi);
  ck_assert_double_eq_tol(psi[0], 0.3, error);
  ck_assert_double_eq_tol(dpsi[0], 1, error);
}

START_TEST(all_functions_vanish_at_the_start_and_the_first_one_is_the_straight_line)
{
  dvi__oscillating *space = create_space(1 + _i % 2, lengths[_i / 2]);
  const dvi__shapes shapes = dvi__oscillating_shapes(space);
  check_start_and_first_function(&shapes);
  dvi__oscillating_destroy(&space);
}
END_TEST

START_TEST(of_every_degree_and_amplitude)
{
  for (int harmonics = 1; harmonics <= 2; harmonics++)
    for (int amplitude = 0; amplitude <= _i; amplitude++) {
      dvi__oscillating *space = dvi__oscillating_create(_i, amplitude, harmonics, 1);
      const dvi__shapes shapes = dvi__oscillating_shapes(space);
      ck_assert_int_le(shapes.functions, FUNCTIONS);
      shapes.set(shapes.of, 1);
      check_start_and_first_function(&shapes);
      shapes.set(shapes.of, dvi__oscillating_resolved(space));
      check_start_and_first_function(&shapes);
      shapes.set(shapes.of, 100);
      check_start_and_first_function(&shapes);
      dvi__oscillating_destroy(&space);
    }
}
END_TEST

/* psi_k psi_l + psi_k' psi_l' by a point of a weight, added. */
static void add_products(int count, double weight, const double *psi, const double *dpsi,
                         double sum[FUNCTIONS][FUNCTIONS])
{
  for (int k = 0; k < count; k++)
    for (int l = 0; l <= k; l++) sum[k][l] += weight * (dpsi[k] * dpsi[l] + psi[k] * psi[l]);
}

/* The quadrature less the integral along the path, by Gauss with 80 points on each of 16 pieces. */
static void product_errors(const dvi__shapes *shapes, double error[FUNCTIONS][FUNCTIONS])
{
  double node[DVI_QUADRATURE_MAX], weight[DVI_QUADRATURE_MAX], psi[FUNCTIONS], dpsi[FUNCTIONS], tau,
      by;
  ck_assert_int_eq(dvi_quadrature(DVI_GAUSS, DVI_QUADRATURE_MAX, node, weight), DVI_OK);
  for (int j = 0; j < shapes->points; j++) {
    shapes->point(shapes->of, j, &tau, &by, psi, dpsi);
    add_products(shapes->functions, by, psi, dpsi, error);
  }
  for (int g = 0; g < 16 * DVI_QUADRATURE_MAX; g++) {
    const int piece = g / DVI_QUADRATURE_MAX;
    shapes->path(shapes->of, (piece + node[g % DVI_QUADRATURE_MAX]) / 16, psi, dpsi);
    add_products(shapes->functions, -weight[g % DVI_QUADRATURE_MAX] / 16, psi, dpsi, error);
  }
}

/* The last functions are what is left, 1e-8 of it at the least, after the others are subtracted. */
START_TEST(the_quadrature_is_exact_for_products_of_two_functions)
{
  double error[FUNCTIONS][FUNCTIONS] = {{0}};
  dvi__oscillating *space = create_space(1 + _i % 2, lengths[_i / 2]);
  const dvi__shapes shapes = dvi__oscillating_shapes(space);
  product_errors(&shapes, error);
  for (int k = 0; k < shapes.functions; k++)
    for (int l = 0; l <= k; l++)
      ck_assert_double_le(fabs(error[k][l]), 1e8 * (double)long_roundoff());
  dvi__oscillating_destroy(&space);
}
END_TEST

START_TEST(where_steps_are_far_below_the_period_polynomials_are_left)
{
  dvi__oscillating *space = create_space(1, 1e-9);
  const dvi__shapes shapes = dvi__oscillating_shapes(space);
  for (int k = 0; k < shapes.functions; k++) ck_assert_int_eq(shapes.present(shapes.of, k), k < 3);
  shapes.set(shapes.of, 2);
  for (int k = 0; k < shapes.functions; k++) ck_assert_int_eq(shapes.present(shapes.of, k), 1);
  dvi__oscillating_destroy(&space);
}
END_TEST

/* sum_k psi_k(tau) Y'_k = path(1 + tau) - path(1) */
START_TEST(a_path_is_continued_into_the_next_step)
{
  dvi__oscillating *space = create_space(1 + _i, 20);
  const dvi__shapes shapes = dvi__oscillating_shapes(space);
  double last[FUNCTIONS], Y[FUNCTIONS], here[FUNCTIONS], beyond[FUNCTIONS], end[FUNCTIONS];
  for (int k = 0; k < shapes.functions; k++) last[k] = 1.0 / (k + 2);
  shapes.next(shapes.of, last, Y);
  shapes.path(shapes.of, 1, end, NULL);
  for (int part = 1; part <= 4; part++) {
    double sum = 0;
    shapes.path(shapes.of, 0.25 * part, here, NULL);
    shapes.path(shapes.of, 1 + 0.25 * part, beyond, NULL);
    for (int k = 0; k < shapes.functions; k++)
      sum += here[k] * Y[k] - (beyond[k] - end[k]) * last[k];
    ck_assert_double_eq_tol(sum, 0, 1e-11);
  }
  dvi__oscillating_destroy(&space);
}
END_TEST

SUITE(oscillating)
{
  tcase_add_loop_test(tests,
                      all_functions_vanish_at_the_start_and_the_first_one_is_the_straight_line, 0,
                      2 * sizeof lengths / sizeof *lengths);
  tcase_add_loop_test(tests, of_every_degree_and_amplitude, 1, DVI__OSCILLATING_DEGREE_MOST + 1);
  tcase_add_loop_test(tests, the_quadrature_is_exact_for_products_of_two_functions, 0,
                      2 * sizeof lengths / sizeof *lengths);
  tcase_add_test(tests, where_steps_are_far_below_the_period_polynomials_are_left);
  tcase_add_loop_test(tests, a_path_is_continued_into_the_next_step, 0, 2);
}
