/* labels: judge */
/* Scattering by cylinders and spheres, as a judge of fields: conservation, limits, published
 * numbers, and the equations themselves. */
#include <math.h>

#include "support/suite.h"
#include "support/waves/scattering.h"

static const double pi = 3.14159265358979323846;

/* ---- the cylinder ---- */

static const cylinder_case both[] = {CYLINDER_TM, CYLINDER_TE};

/* Without absorption all that is taken from the wave is scattered (optical theorem). */
START_TEST(a_cylinder_without_absorption_scatters_all_that_it_takes)
{
  for (double x = 0.1; x < 20; x *= 2.3) {
    cylinder c;
    double extinction, scattering;
    cylinder_solve(both[_i], 2, x / 2, 1.5, 0, &c);
    cylinder_efficiencies(&c, &extinction, &scattering);
    ck_assert_double_eq_tol(scattering / extinction, 1, 4e-16);
    cylinder_solve(both[_i], 2, x / 2, 1.5, 0.1, &c);
    cylinder_efficiencies(&c, &extinction, &scattering);
    ck_assert_double_gt(extinction, scattering);
  }
}
END_TEST

/* A thin cylinder scatters pi^2 x^3 (eps-1)^2/8 (TM), and twice that of ((eps-1)/(eps+1))^2 (TE),
 * with corrections of the order x^2 log x (van de Hulst 1957, sec. 15.5). */
START_TEST(a_thin_cylinder_scatters_as_a_dipole)
{
  const double x = 1e-3, eps = 2.25;
  const double factor = both[_i] == CYLINDER_TM ? pow(eps - 1, 2) / 8
                                                : pow((eps - 1) / (eps + 1), 2) / 4;
  cylinder c;
  double extinction, scattering;
  cylinder_solve(both[_i], 1, x, sqrt(eps), 0, &c);
  cylinder_efficiencies(&c, &extinction, &scattering);
  ck_assert_double_eq_tol(scattering / (pi * pi * x * x * x * factor), 1, 3e-5);
}
END_TEST

/* A cylinder of vacuum leaves the plane wave as it is. */
START_TEST(nothing_scatters_nothing)
{
  const double places[][2] = {{0.3, 0.2}, {-2, 1}, {1.5, -3}};
  cylinder c;
  cylinder_solve(both[_i], 2, 1, 1, 0, &c);
  for (int i = 0; i < 3; i++) {
    quad_complex u, u_x, u_y;
    const double x = places[i][0], y = places[i][1];
    cylinder_field(&c, x, y, &u, &u_x, &u_y);
    ck_assert_double_eq_tol((double)u.re, cos(2 * x), 1e-15);
    ck_assert_double_eq_tol((double)u.im, sin(2 * x), 1e-15);
    ck_assert_double_eq_tol((double)u_x.re, -2 * sin(2 * x), 1e-15);
    ck_assert_double_eq_tol((double)u_x.im, 2 * cos(2 * x), 1e-15);
    ck_assert_double_eq_tol((double)qc_size(u_y), 0, 1e-28);
  }
}
END_TEST

/* At the surface the field is continuous, and its normal derivative over 1 or eps. The coefficients
 * have been found order by order, the fields are summed in another way. */
START_TEST(fields_continue_through_the_surface)
{
  const double a = 0.8, index = 1.7, absorption = 0.2, past = 1e-14;
  const quad_complex eps = qc_multiply(qc(index, absorption), qc(index, absorption));
  cylinder c;
  cylinder_solve(both[_i], 3, a, index, absorption, &c);
  for (int k = 0; k < 8; k++) {
    const double cosine = cos(0.2 + 0.8 * k), sine = sin(0.2 + 0.8 * k);
    quad_complex u[2], flux[2];
    for (int side = 0; side < 2; side++) {
      const double r = a * (side == 0 ? 1 - past : 1 + past);
      quad_complex u_x, u_y;
      cylinder_field(&c, r * cosine, r * sine, &u[side], &u_x, &u_y);
      flux[side] = qc_add(qc_scale(cosine, u_x), qc_scale(sine, u_y));
      if (side == 0 && both[_i] == CYLINDER_TE) flux[side] = qc_divide(flux[side], eps);
    }
    ck_assert_double_lt((double)qc_size(qc_subtract(u[0], u[1])), 1e-12);
    ck_assert_double_lt((double)qc_size(qc_subtract(flux[0], flux[1])), 1e-12);
  }
}
END_TEST

/* Laplace u + (k m)^2 u = 0 on both sides, by differences of h = 1e-5, whose error is about h^2 k^4
 * m^4/12 = 5e-9. The derivatives that are given are those of the field. */
START_TEST(fields_solve_helmholtz_equation)
{
  const double places[][2] = {{0.2, 0.3}, {1.1, -0.6}}, h = 1e-5, k = 3, index = 1.7;
  cylinder c;
  cylinder_solve(both[_i], k, 0.8, index, 0, &c);
  for (int i = 0; i < 2; i++) {
    const double x = places[i][0], y = places[i][1], m = i == 0 ? index : 1;
    quad_complex u, u_x, u_y, ignored, east, west, north, south;
    cylinder_field(&c, x, y, &u, &u_x, &u_y);
    cylinder_field(&c, x + h, y, &east, &ignored, &ignored);
    cylinder_field(&c, x - h, y, &west, &ignored, &ignored);
    cylinder_field(&c, x, y + h, &north, &ignored, &ignored);
    cylinder_field(&c, x, y - h, &south, &ignored, &ignored);
    const quad_complex around = qc_add(qc_add(east, west), qc_add(north, south)),
                       laplace = qc_scale(1 / ((quad)h * h), qc_subtract(around, qc_scale(4, u))),
                       left = qc_add(laplace, qc_scale(k * k * m * m, u));
    ck_assert_double_lt((double)qc_size(left), 1e-6);
    const quad_complex slope_x = qc_scale(0.5 / (quad)h, qc_subtract(east, west)),
                       slope_y = qc_scale(0.5 / (quad)h, qc_subtract(north, south));
    ck_assert_double_lt((double)qc_size(qc_subtract(slope_x, u_x)), 1e-8);
    ck_assert_double_lt((double)qc_size(qc_subtract(slope_y, u_y)), 1e-8);
  }
}
END_TEST

/* The power that an absorbing cylinder takes flows through any circle around it: the integral of
 * Im(u* du/dn) over the circle is -k times the diameter times the difference of efficiencies. */
START_TEST(what_is_absorbed_flows_in)
{
  enum { POINTS = 128 };
  const double k = 2, a = 1, r = 1.5;
  cylinder c;
  double extinction, scattering, sum = 0;
  cylinder_solve(both[_i], k, a, 1.5, 0.3, &c);
  cylinder_efficiencies(&c, &extinction, &scattering);
  for (int i = 0; i < POINTS; i++) {
    const double cosine = cos(2 * pi * i / POINTS), sine = sin(2 * pi * i / POINTS);
    quad_complex u, u_x, u_y;
    cylinder_field(&c, r * cosine, r * sine, &u, &u_x, &u_y);
    const quad_complex slope = qc_add(qc_scale(cosine, u_x), qc_scale(sine, u_y));
    sum += (double)(u.re * slope.im - u.im * slope.re) * 2 * pi * r / POINTS;
  }
  ck_assert_double_eq_tol(-sum / (2 * a * k), extinction - scattering, 1e-14);
}
END_TEST

/* ---- the sphere ---- */

/* Bohren and Huffman 1983, app. A: the sample of BHMIE. */
START_TEST(a_sphere_has_the_efficiencies_of_bohren_and_huffman)
{
  const sphere_efficiencies s = sphere_solve(2 * pi * 0.525 / 0.6328, 1.55, 0);
  ck_assert_double_eq_tol(s.extinction, 3.10543, 5e-6);
  ck_assert_double_eq_tol(s.scattering, 3.10543, 5e-6);
  ck_assert_double_eq_tol(s.backscattering, 2.92534, 5e-6);
  ck_assert_double_eq_tol(s.asymmetry, 0.63314, 5e-6);
}
END_TEST

/* Wiscombe 1979, the test cases 7, 9, 10, 14 and 15 of MIEV0. */
START_TEST(a_sphere_has_the_efficiencies_of_wiscombe)
{
  static const struct {
    double x, index, absorption, extinction, scattering, asymmetry;
  } known[] = {{10, 0.75, 0, 2.232265, 2.232265, 0.896473},
               {1, 1.33, 1e-5, 0.093952, 0.093923, 0.184517},
               {100, 1.33, 1e-5, 2.101321, 2.096594, 0.868959},
               {1, 1.5, 1, 2.336321, 0.663454, 0.192136},
               {100, 1.5, 1, 2.097502, 1.283697, 0.850252}};
  const sphere_efficiencies s = sphere_solve(known[_i].x, known[_i].index, known[_i].absorption);
  ck_assert_double_eq_tol(s.extinction, known[_i].extinction, 1e-6);
  ck_assert_double_eq_tol(s.scattering, known[_i].scattering, 1e-6);
  ck_assert_double_eq_tol(s.asymmetry, known[_i].asymmetry, 1e-6);
}
END_TEST

/* Q = 4 Re S(0)/x^2. */
START_TEST(the_optical_theorem_holds)
{
  for (double x = 0.1; x < 30; x *= 2.7) {
    const sphere_efficiencies s = sphere_solve(x, 1.5, 0);
    ck_assert_double_eq_tol(s.scattering / s.extinction, 1, 4e-16);
    ck_assert_double_eq_tol(4 * s.forward_re / (x * x) / s.extinction, 1, 4e-16);
  }
}
END_TEST

/* 8/3 x^4 ((m^2-1)/(m^2+2))^2, with a correction of the order x^2. */
START_TEST(a_small_sphere_scatters_as_rayleigh_found)
{
  const double x = 1e-3, eps = 2.25, factor = (eps - 1) / (eps + 2);
  const sphere_efficiencies s = sphere_solve(x, 1.5, 0);
  ck_assert_double_eq_tol(s.scattering / (8.0 / 3 * pow(x, 4) * factor * factor), 1, 2e-6);
  ck_assert_double_lt(fabs(s.asymmetry), 1e-6);
}
END_TEST

SUITE(scattering)
{
  tcase_add_loop_test(tests, a_cylinder_without_absorption_scatters_all_that_it_takes, 0, 2);
  tcase_add_loop_test(tests, a_thin_cylinder_scatters_as_a_dipole, 0, 2);
  tcase_add_loop_test(tests, nothing_scatters_nothing, 0, 2);
  tcase_add_loop_test(tests, fields_continue_through_the_surface, 0, 2);
  tcase_add_loop_test(tests, fields_solve_helmholtz_equation, 0, 2);
  tcase_add_loop_test(tests, what_is_absorbed_flows_in, 0, 2);
  tcase_add_test(tests, a_sphere_has_the_efficiencies_of_bohren_and_huffman);
  tcase_add_loop_test(tests, a_sphere_has_the_efficiencies_of_wiscombe, 0, 5);
  tcase_add_test(tests, the_optical_theorem_holds);
  tcase_add_test(tests, a_small_sphere_scatters_as_rayleigh_found);
}
