/* labels: judge */
/* Frequencies of cavities, as judges of fields. */
#include <math.h>

#include "support/suite.h"
#include "support/waves/cavities.h"

static const double pi = 3.14159265358979323846;

static void check_list(int count, const double *value, const double *expected, double tolerance)
{
  for (int i = 0; i < count; i++) ck_assert_double_eq_tol(value[i], expected[i], tolerance);
}

/* (1,1,0), (1,0,1), (0,1,1), and (1,1,1) twice. */
START_TEST(a_box_has_its_wave_numbers)
{
  const double side[3] = {1, 0.8, 0.6}, known[] = {5.029002016085, 6.106158545427, 6.544984694979};
  double frequency[6];
  cavity_box(side, 6, frequency);
  check_list(3, frequency, known, 5e-13);
  ck_assert_double_eq_tol(frequency[3], pi * sqrt(1 + 1 / 0.64 + 1 / 0.36), 1e-14);
  ck_assert_double_eq(frequency[4], frequency[3]);
}
END_TEST

/* A cube has (1,1,0) three times, and (1,1,1) twice. */
START_TEST(a_cube_has_equal_frequencies)
{
  const double side[3] = {pi, pi, pi};
  double frequency[6];
  cavity_box(side, 6, frequency);
  for (int i = 0; i < 5; i++) ck_assert_double_eq_tol(frequency[i], sqrt(i < 3 ? 2 : 3), 1e-15);
  ck_assert_double_eq_tol(frequency[5], sqrt(5), 1e-15);
}
END_TEST

/* Three TM modes of the order 1, five of the order 2. Three TE modes follow at tan x = x
 * (Abramowitz and Stegun, table 10.6: 4.493409). */
START_TEST(a_sphere_has_modes_of_all_orders)
{
  double frequency[11];
  cavity_sphere(1, 11, frequency);
  for (int i = 0; i < 11; i++)
    ck_assert_double_eq_tol(frequency[i],
                            i < 3   ? 2.743707269992
                            : i < 8 ? 3.870238580222
                                    : 4.493409457909,
                            5e-13);
  ck_assert_double_eq_tol(tan(frequency[10]), frequency[10], 1e-13);
  /* (x j_1)' = 0 is tan x = x/(1 - x^2) */
  const double x = frequency[0];
  ck_assert_double_eq_tol(tan(x), x / (1 - x * x), 1e-14);
}
END_TEST

/* Jackson 1999, sec. 8.7: TM_010 is 2.405/R, and TE_111 (1.841/R) sqrt(1 + 2.912 R^2/d^2), which
 * is lower for d > 2.03 R. */
START_TEST(a_cylinder_has_transverse_modes)
{
  double frequency[8];
  cavity_cylinder(2, 1, 1, frequency);
  ck_assert_double_eq_tol(frequency[0], 2.404825557695773 / 2, 1e-14);
  cavity_cylinder(1, 4, 3, frequency);
  const double lowest = 1.841 * sqrt(1 + 2.912 / 16);
  ck_assert_double_eq_tol(frequency[0], lowest, 1e-3);
  ck_assert_double_eq(frequency[1], frequency[0]);
  ck_assert_double_eq_tol(frequency[2], 2.404825557695773, 1e-14);
}
END_TEST

/* Weyl's law for Maxwell's equations: V w^3/(3 pi^2) modes below w, and no term of the surface
 * (Balian and Bloch 1971). The term of curvature is of the order 1/w^2 of it: a tenth at 100 modes.
 * A list without the fivefold modes of a sphere, say, would lack a third. */
START_TEST(cavities_have_as_many_modes_as_their_volume_allows)
{
  enum { COUNT = 100 };
  double frequency[COUNT];
  const double side[3] = {1, 0.8, 0.6};
  const double volume[] = {0.48, 4 * pi / 3, pi * 1.5};
  if (_i == 0) cavity_box(side, COUNT, frequency);
  if (_i == 1) cavity_sphere(1, COUNT, frequency);
  if (_i == 2) cavity_cylinder(1, 1.5, COUNT, frequency);
  const double expected = volume[_i] * pow(frequency[COUNT - 1], 3) / (3 * pi * pi);
  ck_assert_double_eq_tol(COUNT / expected, 1, 0.13);
}
END_TEST

/* The drum's tones are those of Bessel's functions, twice but for the order 0. */
START_TEST(a_disk_has_the_tones_of_a_drum)
{
  const double known[] = {2.404825557695773, 3.831705970207512, 3.831705970207512,
                          5.135622301840683, 5.135622301840683, 5.520078110286311};
  double frequency[6];
  cavity_disk(1, 6, frequency);
  check_list(6, frequency, known, 2e-15);
}
END_TEST

SUITE(cavities)
{
  tcase_add_test(tests, a_box_has_its_wave_numbers);
  tcase_add_test(tests, a_cube_has_equal_frequencies);
  tcase_add_test(tests, a_sphere_has_modes_of_all_orders);
  tcase_add_test(tests, a_cylinder_has_transverse_modes);
  tcase_add_loop_test(tests, cavities_have_as_many_modes_as_their_volume_allows, 0, 3);
  tcase_add_test(tests, a_disk_has_the_tones_of_a_drum);
}
