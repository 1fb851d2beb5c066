/* Simplices from the lengths of their edges: volumes, angles, derivatives, thin ones. */
#include <math.h>
#include <string.h>

#include "field/regge/simplex.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* A simplex that is neither thin nor regular. */
static void lengths_of(int n, int seed, double *length)
{
  for (int e = 0; e < dvi__pairs(n); e++) length[e] = 1 + 0.15 * sin(1.7 * e + 2.9 * seed);
}

static dvi__measured_simplex measured(int n, const double *length)
{
  dvi__measured_simplex m;
  memset(&m, 0, sizeof m);
  ck_assert_int_eq(dvi__simplex_measure(n, length, &m), 1);
  return m;
}

/* arccos(1/n), and sqrt((n+1)/2^n)/n! for unit edges. */
START_TEST(regular_simplices_have_their_volumes_and_angles)
{
  for (int n = 2; n <= 4; n++) {
    double length[DVI__PAIRS], factorial = n == 2 ? 2 : n == 3 ? 6 : 24;
    for (int e = 0; e < dvi__pairs(n); e++) length[e] = 3;
    const dvi__measured_simplex m = measured(n, length);
    ck_assert_double_eq_tol(m.cell.volume / (pow(3, n) * sqrt((n + 1) / pow(2, n)) / factorial), 1,
                            1e-15);
    for (int h = 0; h < dvi__pairs(n); h++) {
      ck_assert_double_eq_tol(m.hinge[h].angle, acos(1.0 / n), 4e-16);
      ck_assert_double_eq_tol(m.hinge[h].face.volume,
                              n == 2   ? 1
                              : n == 3 ? 3
                                       : 9 * sqrt(3) / 4,
                              1e-15);
    }
  }
}
END_TEST

START_TEST(angles_of_a_triangle_sum_up_to_pi)
{
  const double length[] = {3, 4, 5};
  const dvi__measured_simplex m = measured(2, length);
  ck_assert_double_eq_tol(m.hinge[0].angle + m.hinge[1].angle + m.hinge[2].angle, pi, 1e-15);
  /* The vertex that lacks corners 1 and 2 is corner 0, between the edges 3 and 4. */
  ck_assert_double_eq_tol(m.hinge[dvi__pair(2, 1, 2)].angle, pi / 2, 1e-15);
}
END_TEST

/* sum_h |h| d theta_h = 0 (Schlaefli 1858; Regge 1961). */
START_TEST(changes_of_angles_obey_schlaefli)
{
  for (int n = 2; n <= 4; n++)
    for (int seed = 0; seed < 9; seed++) {
      double length[DVI__PAIRS], sum[DVI__PAIRS] = {0}, slope[DVI__PAIRS];
      lengths_of(n, seed, length);
      const dvi__measured_simplex m = measured(n, length);
      for (int h = 0; h < dvi__pairs(n); h++) {
        dvi__angle_slopes(&m, h, slope);
        for (int e = 0; e < dvi__pairs(n); e++) sum[e] += m.hinge[h].face.volume * slope[e];
      }
      for (int e = 0; e < dvi__pairs(n); e++) ck_assert_double_eq_tol(sum[e], 0, 1e-14);
    }
}
END_TEST

/* One of a simplex's functions, with its derivatives. */
typedef double value_of(const dvi__measured_simplex *m, int h);
typedef void slopes_of(const dvi__measured_simplex *m, int h, double *slope);

static double volume(const dvi__measured_simplex *m, int h)
{
  (void)h;
  return m->cell.volume;
}

static void volume_slopes(const dvi__measured_simplex *m, int h, double *slope)
{
  (void)h;
  dvi__volume_slopes(m, slope);
}

static void volume_bends(const dvi__measured_simplex *m, int h, double *bend)
{
  (void)h;
  dvi__volume_bends(m, bend);
}

static double hinge_volume(const dvi__measured_simplex *m, int h)
{
  return m->hinge[h].face.volume;
}

static double hinge_angle(const dvi__measured_simplex *m, int h)
{
  return m->hinge[h].angle;
}

static const struct {
  value_of *value;
  slopes_of *slopes, *bends;
} function[] = {{volume, volume_slopes, volume_bends},
                {hinge_volume, dvi__hinge_slopes, dvi__hinge_bends},
                {hinge_angle, dvi__angle_slopes, dvi__angle_bends}};

/* Compare derivatives with central differences of step d, whose error is about d^2 = 1e-10, and
 * roundings of 1e-16/d. */
static void check_derivatives(int n, int i, int h, const double *length)
{
  const double d = 1e-5;
  const int pairs = dvi__pairs(n);
  const dvi__measured_simplex m = measured(n, length);
  double slope[DVI__PAIRS], bend[DVI__PAIRS * DVI__PAIRS], moved[DVI__PAIRS];
  function[i].slopes(&m, h, slope);
  function[i].bends(&m, h, bend);
  for (int e = 0; e < pairs; e++) {
    double after[DVI__PAIRS], before[DVI__PAIRS];
    memcpy(moved, length, sizeof moved);
    moved[e] = length[e] + d;
    const dvi__measured_simplex up = measured(n, moved);
    moved[e] = length[e] - d;
    const dvi__measured_simplex down = measured(n, moved);
    ck_assert_double_eq_tol(
        slope[e], (function[i].value(&up, h) - function[i].value(&down, h)) / (2 * d), 3e-9);
    function[i].slopes(&up, h, after);
    function[i].slopes(&down, h, before);
    for (int f = 0; f < pairs; f++) {
      ck_assert_double_eq_tol(bend[e * pairs + f], (after[f] - before[f]) / (2 * d), 3e-8);
      ck_assert_double_eq_tol(bend[e * pairs + f], bend[f * pairs + e], 1e-13);
    }
  }
}

START_TEST(derivatives_by_lengths_are_those_of_differences)
{
  double length[DVI__PAIRS];
  for (int n = 2; n <= 4; n++)
    for (int i = 0; i < 3; i++)
      for (int h = 0; h < dvi__pairs(n); h++) {
        lengths_of(n, i + h, length);
        check_derivatives(n, i, h, length);
      }
}
END_TEST

/* The numbers of thin simplices are those of mpmath with 80 digits. */
static void check_thin(int n, const double *length, const double *expected)
{
  double slope[DVI__PAIRS], bend[DVI__PAIRS * DVI__PAIRS];
  const dvi__measured_simplex m = measured(n, length);
  const double close = 2e-14;
  ck_assert_double_eq_tol(m.cell.volume / expected[0], 1, close);
  ck_assert_double_eq_tol(m.hinge[0].angle / expected[1], 1, close);
  dvi__volume_slopes(&m, slope);
  dvi__volume_bends(&m, bend);
  ck_assert_double_eq_tol(slope[0] / expected[2], 1, close);
  ck_assert_double_eq_tol(bend[0] / expected[3], 1, close);
  dvi__angle_slopes(&m, 0, slope);
  dvi__angle_bends(&m, 0, bend);
  ck_assert_double_eq_tol(slope[0] / expected[4], 1, close);
  ck_assert_double_eq_tol(bend[0] / expected[5], 1, close);
}

START_TEST(a_sliver_keeps_its_digits)
{
  const double diagonal = sqrt(2) - 1e-9;
  check_thin(3, (const double[]){1, diagonal, 1, 1, diagonal, 1},
             (const double[]){0.0000125353435363529753, 0.000075212061289028462271,
                              2215.9566364219490239, -391729496703.61608645, 13295.739856137724832,
                              -2350376973573.8265483});
}
END_TEST

START_TEST(a_needle_keeps_its_digits)
{
  check_thin(3, (const double[]){1, 1, 1e-6, 1e-6, 1, 1},
             (const double[]){1.6666666666662498492e-13, 1.5707963267946466192,
                              4.1666666666677079562e-14, -166666666666.70834842,
                              1000000000000.2500905, 750000000000.06256788});
  check_thin(4, (const double[]){1, 1, 1, 1, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5},
             (const double[]){2.9462782548887060241e-17, 1.5707942855534442645,
                              7.3656956374979786467e-18, -4.4194173824435437477e-7,
                              122474.48714145529153, 91855.865354943270327});
}
END_TEST

START_TEST(a_cap_of_a_tetrahedron_keeps_its_digits)
{
  const double c = sqrt(3.0 / 8) + 1e-10;
  check_thin(4, (const double[]){1, 1, 1, c, 1, 1, c, 1, c, c},
             (const double[]){3.2605921263050950418e-7, 3.1415041190566518, -166.39147144891435543,
                              -84911331959.744908435, 45180.110578964798638,
                              23055889246438.615285});
}
END_TEST

START_TEST(lengths_may_have_any_size)
{
  for (int i = 0; i < 2; i++) {
    const double unit = i == 0 ? 1e-70 : 1e70;
    double length[DVI__PAIRS];
    for (int e = 0; e < DVI__PAIRS; e++) length[e] = unit;
    const dvi__measured_simplex m = measured(4, length);
    ck_assert_double_eq_tol(m.cell.volume / pow(unit, 4), sqrt(5) / 96, 1e-15);
    ck_assert_double_eq_tol(m.hinge[9].angle, acos(0.25), 4e-16);
  }
}
END_TEST

START_TEST(lengths_that_make_no_simplex_are_found)
{
  dvi__measured_simplex m;
  double length[] = {1, 1, 1, 1, 1, 1};
  length[0] = 2;
  ck_assert_int_eq(dvi__simplex_measure(3, length, &m), 0);
  ck_assert_int_eq(dvi__missing_face(3, length), 1 << 0 | 1 << 1 | 1 << 2);
  length[0] = 1.8; /* the triangles exist, but the tetrahedron would need less than sqrt(3) */
  ck_assert_int_eq(dvi__missing_face(3, length), 15);
  length[0] = 1.7;
  ck_assert_int_eq(dvi__missing_face(3, length), 0);
}
END_TEST

SUITE(simplex)
{
  tcase_add_test(tests, regular_simplices_have_their_volumes_and_angles);
  tcase_add_test(tests, angles_of_a_triangle_sum_up_to_pi);
  tcase_add_test(tests, changes_of_angles_obey_schlaefli);
  tcase_add_test(tests, derivatives_by_lengths_are_those_of_differences);
  tcase_add_test(tests, a_sliver_keeps_its_digits);
  tcase_add_test(tests, a_needle_keeps_its_digits);
  tcase_add_test(tests, a_cap_of_a_tetrahedron_keeps_its_digits);
  tcase_add_test(tests, lengths_may_have_any_size);
  tcase_add_test(tests, lengths_that_make_no_simplex_are_found);
}
