/* Laws of elastic materials: derivatives, objectivity, small strains, and what is refused. */
#include <math.h>
#include <string.h>

#include "field/elastic/laws.h"
#include "support/suite.h"

enum { LAWS = 4, ENTRIES = DVI__SOLID_ENTRIES };

static dvi__solid_material material(int law)
{
  return (dvi__solid_material){.law = (dvi_elastic_law)law,
                               .lambda = 1.3,
                               .mu = 0.8,
                               .mooney = law == DVI_ELASTIC_MOONEY_RIVLIN ? 0.3 : 0,
                               .rho = 1};
}

/* A deformation with J > 0 whose entries differ. */
static void fill(int n, double size, double *H)
{
  for (int k = 0; k < n * n; k++) H[k] = size * sin(1.7 * k + 0.4);
}

static double energy(int n, const dvi__solid_material *m, const double *H)
{
  double W = 0;
  ck_assert_int_eq(dvi__law_energy(n, m, H, &W), 0);
  return W;
}

/* Differences of order 4 with steps of 1e-3 have errors of 1e-12 of these smooth functions, and
 * roundings of 1e-13. */
START_TEST(stress_is_the_gradient_of_the_energy)
{
  for (int n = 2; n <= 3; n++)
    for (int law = 0; law < LAWS; law++) {
      const dvi__solid_material m = material(law);
      double H[ENTRIES], P[ENTRIES];
      fill(n, 0.3, H);
      ck_assert_int_eq(dvi__law_stress(n, &m, H, P), 0);
      for (int k = 0; k < n * n; k++) {
        const double h = 1e-3, at = H[k];
        double value[4];
        for (int s = 0; s < 4; s++) {
          H[k] = at + (s < 2 ? s - 2 : s - 1) * h;
          value[s] = energy(n, &m, H);
        }
        H[k] = at;
        const double slope = (value[0] - 8 * value[1] + 8 * value[2] - value[3]) / (12 * h);
        ck_assert_double_eq_tol(P[k], slope, 1e-11);
      }
    }
}
END_TEST

START_TEST(hessian_is_the_gradient_of_the_stress)
{
  for (int n = 2; n <= 3; n++)
    for (int law = 0; law < LAWS; law++) {
      const dvi__solid_material m = material(law);
      double H[ENTRIES], A[ENTRIES * ENTRIES], P[4][ENTRIES];
      fill(n, 0.3, H);
      ck_assert_int_eq(dvi__law_hessian(n, &m, H, A), 0);
      for (int k = 0; k < n * n; k++) {
        const double h = 1e-3, at = H[k];
        for (int s = 0; s < 4; s++) {
          H[k] = at + (s < 2 ? s - 2 : s - 1) * h;
          ck_assert_int_eq(dvi__law_stress(n, &m, H, P[s]), 0);
        }
        H[k] = at;
        for (int i = 0; i < n * n; i++)
          ck_assert_double_eq_tol(
              A[i * n * n + k], (P[0][i] - 8 * P[1][i] + 8 * P[2][i] - P[3][i]) / (12 * h), 1e-10);
      }
    }
}
END_TEST

/* H of Q F with a rotation Q by 0.7 about an axis (in a plane about its normal). */
static void turn(int n, const double *H, double *turned)
{
  const double c = cos(0.7), s = sin(0.7), x = n == 3 ? 2.0 / 3 : 0, y = n == 3 ? 1.0 / 3 : 0,
               z = n == 3 ? 2.0 / 3 : 1;
  const double axis[3] = {x, y, z}, cross[9] = {0, -z, y, z, 0, -x, -y, x, 0};
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double sum = 0;
      for (int k = 0; k < n; k++) {
        const double Q = c * (i == k) + (1 - c) * axis[i] * axis[k] + s * cross[3 * i + k];
        sum += Q * (H[k * n + j] + (k == j));
      }
      turned[i * n + j] = sum - (i == j);
    }
}

START_TEST(rotations_store_nothing_in_laws_that_are_objective)
{
  for (int n = 2; n <= 3; n++)
    for (int law = DVI_ELASTIC_SVK; law < LAWS; law++) {
      const dvi__solid_material m = material(law);
      double H[ENTRIES], turned[ENTRIES];
      fill(n, 0.3, H);
      turn(n, H, turned);
      ck_assert_double_eq_tol(energy(n, &m, turned), energy(n, &m, H), 1e-15);
    }
}
END_TEST

/* Terms of third order are 1e-8 of those of second order at this strain, and digits of the law
 * itself are left at roundoff, although J - 1 and tr E cancel. */
START_TEST(small_strains_have_lame_constants_in_all_laws)
{
  for (int n = 2; n <= 3; n++)
    for (int law = DVI_ELASTIC_SVK; law < LAWS; law++) {
      const dvi__solid_material m = material(law), linear = material(DVI_ELASTIC_LINEAR);
      double H[ENTRIES], P[ENTRIES], expected[ENTRIES];
      fill(n, 1e-9, H);
      (void)dvi__law_stress(n, &m, H, P);
      (void)dvi__law_stress(n, &linear, H, expected);
      for (int k = 0; k < n * n; k++) ck_assert_double_eq_tol(P[k], expected[k], 1e-8 * 1e-9);
      ck_assert_double_eq_tol(energy(n, &m, H) / energy(n, &linear, H), 1, 1e-8);
    }
}
END_TEST

/* In a plane the laws are those in space with F_33 = 1. */
START_TEST(strain_in_a_plane_is_plane_strain)
{
  for (int law = 0; law < LAWS; law++) {
    const dvi__solid_material m = material(law);
    double H[ENTRIES], P[ENTRIES], P_space[ENTRIES];
    fill(2, 0.3, H);
    const double space[ENTRIES] = {H[0], H[1], 0, H[2], H[3]};
    ck_assert_double_eq_tol(energy(2, &m, H), energy(3, &m, space), 1e-15);
    (void)dvi__law_stress(2, &m, H, P);
    (void)dvi__law_stress(3, &m, space, P_space);
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) ck_assert_double_eq_tol(P[i * 2 + j], P_space[i * 3 + j], 1e-15);
  }
}
END_TEST

/* The formula of the header, in 64 bits of mantissa. */
START_TEST(mooney_and_rivlin_is_the_energy_of_its_invariants)
{
  const dvi__solid_material m = material(DVI_ELASTIC_MOONEY_RIVLIN);
  double H[ENTRIES];
  fill(3, 0.3, H);
  long double F[9], C[9] = {0}, trace = 0, square = 0;
  for (int k = 0; k < 9; k++) F[k] = H[k] + (k % 4 == 0);
  for (int i = 0; i < 9; i++)
    for (int k = 0; k < 3; k++) C[i] += F[3 * k + i / 3] * F[3 * k + i % 3];
  for (int i = 0; i < 9; i++) trace += i % 4 == 0 ? C[i] : 0, square += C[i] * C[i];
  const long double second = (trace * trace - square) / 2,
                    J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
                        F[2] * (F[3] * F[7] - F[4] * F[6]),
                    W = (m.mu - m.mooney) / 2 * (trace - 3) + m.mooney / 2 * (second - 3) -
                        (m.mu + m.mooney) * logl(J) +
                        (m.lambda - 2 * m.mooney) / 2 * logl(J) * logl(J);
  ck_assert_double_eq_tol(energy(3, &m, H), (double)W, 1e-15);
}
END_TEST

START_TEST(logarithms_refuse_cells_that_are_inverted)
{
  const double H[ENTRIES] = {-1.1};
  for (int law = DVI_ELASTIC_NEO_HOOKEAN; law < LAWS; law++) {
    const dvi__solid_material m = material(law);
    double P[ENTRIES], A[ENTRIES * ENTRIES], W;
    ck_assert_int_gt(dvi__law_stress(3, &m, H, P), 0);
    ck_assert_int_gt(dvi__law_energy(3, &m, H, &W), 0);
    ck_assert_int_gt(dvi__law_hessian(3, &m, H, A), 0);
  }
}
END_TEST

SUITE(elastic_laws)
{
  tcase_add_test(tests, stress_is_the_gradient_of_the_energy);
  tcase_add_test(tests, hessian_is_the_gradient_of_the_stress);
  tcase_add_test(tests, rotations_store_nothing_in_laws_that_are_objective);
  tcase_add_test(tests, small_strains_have_lame_constants_in_all_laws);
  tcase_add_test(tests, strain_in_a_plane_is_plane_strain);
  tcase_add_test(tests, mooney_and_rivlin_is_the_energy_of_its_invariants);
  tcase_add_test(tests, logarithms_refuse_cells_that_are_inverted);
}
