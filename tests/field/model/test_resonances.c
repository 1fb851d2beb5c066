/* labels: order slow */
/* Cavities of tetrahedra: their lowest frequencies converge with the second order. */
#include <dvi/maxwell.h>
#include <math.h>

#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* Give the mean of some of the lowest frequencies on finite elements, with electric walls. */
static double frequency_of(const char *generator, dvi_generator_options cells, int count)
{
  static const dvi_wall pec = {.part = "boundary", .kind = DVI_PEC};
  const dvi_star_options whitney = {.size = sizeof whitney, .kind = DVI_WHITNEY};
  double eigenvalue[8], sum = 0;
  dvi_mesh *mesh = NULL;
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  cells.size = sizeof cells;
  ck_assert_msg(dvi_mesh_generate(generator, &cells, &mesh) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_star_create(mesh, &whitney, &star) == DVI_OK, "%s", dvi_last_error());
  const dvi_maxwell_terms terms = {.size = sizeof terms, .star = star, .wall = &pec, .walls = 1};
  ck_assert_msg(dvi_maxwell_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  const dvi_modes_options options = {.size = sizeof options, .count = count};
  ck_assert_msg(dvi_field_modes(field, &options, eigenvalue, NULL, NULL) == DVI_OK, "%s",
                dvi_last_error());
  for (int i = 0; i < count; i++) sum += sqrt(eigenvalue[i]) / count;
  dvi_field_destroy(&field);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
  return sum;
}

/* The exponents between neighbouring meshes lie between 1.6 and 2.4, and at 0.5 percent a cell of
 * 1/26 of the body, as 1e5 tetrahedra have, is fine enough by the last error and the order. */
static void check(const char *generator, int axes, const double *extent, int count, double exact)
{
  static const int level[] = {4, 6, 8};
  double error[3];
  for (int i = 0; i < 3; i++) {
    dvi_generator_options cells = {.extent = {extent[0], extent[1], extent[2]}};
    for (int a = 0; a < axes; a++) cells.cells[a] = level[i];
    error[i] = fabs(frequency_of(generator, cells, count) / exact - 1);
    const double slope = i > 0 ? log(error[i - 1] / error[i]) / log(level[i] / (double)level[i - 1])
                               : 2;
    ck_assert_msg(slope > 1.6 && slope < 2.4, "%s: errors %g and %g, exponent %g", generator,
                  error[i > 0 ? i - 1 : 0], error[i], slope);
  }
  ck_assert_double_lt(error[2], 0.02);
}

START_TEST(a_box_has_its_frequency)
{
  const double extent[] = {1, 0.8, 0.6};
  check("kuhn", 3, extent, 1, pi * sqrt(1 / (1 * 1) + 1 / (0.8 * 0.8)));
}
END_TEST

/* The roots are those of spherical Bessel functions: 2.743707269992 three times. */
START_TEST(a_ball_has_its_frequency)
{
  const double extent[] = {1, 0, 0};
  check("ball", 1, extent, 3, 2.743707269992);
}
END_TEST

/* Radius 1 and height 1: the root of J_0. */
START_TEST(a_cylinder_has_its_frequency)
{
  const double extent[] = {1, 1, 0};
  check("cylinder", 2, extent, 1, 2.404825557695773);
}
END_TEST

/* The lowest eigenvalue was found in quadruple precision, as the 8 static fields were. */
START_TEST(media_of_very_different_permittivities_keep_their_modes)
{
  static const double contrast[] = {1e6, 1e8, 1e10},
                      exact[] = {5.02371029649909e-05, 5.02371696821224e-07, 5.02371703492946e-09};
  static const dvi_wall pec = {.part = "boundary", .kind = DVI_PEC};
  const dvi_generator_options cells = {
      .size = sizeof cells, .cells = {3, 3, 3}, .extent = {1, 0.9, 0.8}};
  const dvi_modes_options options = {.size = sizeof options};
  double permittivity[162], eigenvalue[6];
  const double *factor[] = {NULL, permittivity, NULL, NULL};
  const dvi_star_options whitney = {.size = sizeof whitney, .kind = DVI_WHITNEY, .factor = factor};
  int64_t zeros;
  dvi_mesh *mesh = NULL;
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  ck_assert_int_eq(dvi_mesh_generate("kuhn", &cells, &mesh), DVI_OK);
  ck_assert_int_eq(dvi_mesh_count(mesh, 3), 162);
  for (int i = 0; i < 3; i++) {
    for (int c = 0; c < 162; c++) permittivity[c] = c * 5 % 7 < 3 ? contrast[i] : 1;
    ck_assert_int_eq(dvi_star_create(mesh, &whitney, &star), DVI_OK);
    const dvi_maxwell_terms terms = {.size = sizeof terms, .star = star, .wall = &pec, .walls = 1};
    ck_assert_int_eq(dvi_maxwell_create(&terms, &field), DVI_OK);
    ck_assert_msg(dvi_field_modes(field, &options, eigenvalue, NULL, &zeros) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_eq(zeros, 8);
    ck_assert_double_lt(fabs(eigenvalue[0] / exact[i] - 1), 1e-15 * contrast[i]);
    dvi_field_destroy(&field);
    dvi_star_destroy(&star);
  }
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The left half has a permeability of 1e-9, so that waves are fast there. The lowest mode is that
 * of the right half, and 342 functions are zero on the electric walls. */
START_TEST(fast_waves_in_a_part_leave_slow_modes_elsewhere)
{
  static const dvi_wall pec[] = {{.part = "right", .kind = DVI_PEC},
                                 {.part = "bottom", .kind = DVI_PEC}};
  const dvi_generator_options cells = {.size = sizeof cells, .cells = {18, 19}};
  double inverse[342], slow = 0, fast = 0;
  const double *factor[] = {NULL, NULL, inverse};
  const dvi_star_options options = {.size = sizeof options, .factor = factor};
  int64_t zeros;
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate("box", &cells, &mesh), DVI_OK);
  for (int i = 0; i < 2; i++) {
    dvi_star *star = NULL;
    dvi_field *field = NULL;
    for (int c = 0; c < 342; c++) inverse[c] = c % 18 < 9 ? (i == 0 ? 1e6 : 1e9) : 1;
    ck_assert_int_eq(dvi_star_create(mesh, &options, &star), DVI_OK);
    const dvi_maxwell_terms terms = {.size = sizeof terms, .star = star, .wall = pec, .walls = 2};
    const dvi_modes_options one = {.size = sizeof one, .count = 1};
    ck_assert_int_eq(dvi_maxwell_create(&terms, &field), DVI_OK);
    ck_assert_msg(dvi_field_modes(field, &one, i == 0 ? &slow : &fast, NULL, &zeros) == DVI_OK,
                  "%s", dvi_last_error());
    ck_assert_int_eq(zeros, 342);
    dvi_field_destroy(&field);
    dvi_star_destroy(&star);
  }
  ck_assert_double_lt(fabs(slow / 5.8243 - 1), 1e-3);
  ck_assert_double_lt(fabs(fast / slow - 1), 1e-5);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(resonances)
{
  tcase_add_test(tests, fast_waves_in_a_part_leave_slow_modes_elsewhere);
  tcase_add_test(tests, media_of_very_different_permittivities_keep_their_modes);
  tcase_add_test(tests, a_box_has_its_frequency);
  tcase_add_test(tests, a_ball_has_its_frequency);
  tcase_add_test(tests, a_cylinder_has_its_frequency);
}
