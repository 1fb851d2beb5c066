/* labels: judge */
/* The judge of elastic solids against digits of an earlier computation, and against itself. */
#include <math.h>

#include "support/meshes.h"
#include "support/solid/blocks.h"
#include "support/solid/quad_avi.h"
#include "support/suite.h"

enum { SIZE = 81 };

static const dvi_elastic_law laws[] = {DVI_ELASTIC_LINEAR, DVI_ELASTIC_SVK, DVI_ELASTIC_NEO_HOOKEAN,
                                       DVI_ELASTIC_MOONEY_RIVLIN};

static quad_solid solid_of(const dvi_mesh *mesh, dvi_elastic_law law)
{
  const dvi_elastic_material material = {
      .part = "all", .law = law, .lambda = 1, .mu = 1, .mooney = 0.25, .rho = 1};
  const dvi_elastic_terms terms = {
      .size = sizeof terms, .mesh = mesh, .material = &material, .materials = 1};
  return quad_solid_of(&terms, NULL, NULL);
}

/* ---- digits ---- */

static void check_corner(dvi_elastic_law law, const double *expected)
{
  dvi_mesh *mesh = graded_block(3, 2, 2);
  quad_solid s = solid_of(mesh, law);
  quad u[SIZE], v[SIZE];
  turning_start(&s, 1, u, v);
  ck_assert_double_le(quad_solid_advance(&s, 0, 1, u, v), 1e-19);
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol((double)u[78 + i] + 1, expected[i], 0.51e-12);
  quad_solid_clear(&s);
  dvi_mesh_destroy(&mesh);
}

START_TEST(corners_of_blocks_arrive_at_their_digits)
{
  static const double svk[] = {1.120541854504, .880670758168, 1.078836923111},
                      neo_hookean[] = {1.121240896990, .880808459494, 1.079014224797};
  check_corner(DVI_ELASTIC_SVK, svk);
  check_corner(DVI_ELASTIC_NEO_HOOKEAN, neo_hookean);
}
END_TEST

/* ---- laws ---- */

static void random_shift(int count, double size, unsigned long long *seed, quad *u)
{
  for (int i = 0; i < count; i++) u[i] = size * (2 * random_number(seed) - 1);
}

/* Differences of 1e-11 have errors of 1e-22 times third derivatives. */
static void check_gradient(const quad_solid *s, quad *u)
{
  const quad h = 1e-11;
  quad f[12], other[12];
  (void)quad_solid_cell(s, 0, 0, u, f);
  for (int i = 0; i < (s->n + 1) * s->n; i++) {
    const quad at = u[i];
    u[i] = at + h;
    const quad above = quad_solid_cell(s, 0, 0, u, other);
    u[i] = at - h;
    const quad below = quad_solid_cell(s, 0, 0, u, other);
    u[i] = at;
    ck_assert_double_le((double)quad_abs(f[i] + (above - below) / (2 * h)), 1e-18);
  }
}

/* All laws pull as the linear one does at small displacements, up to second order. */
static void check_small_strains(const quad_solid *s, const quad *u)
{
  const quad size = 1e-9;
  quad little[12], f[12], linear[12];
  for (int i = 0; i < 12; i++) little[i] = size * u[i];
  (void)quad_solid_cell(s, 0, 0, little, f);
  (void)quad_solid_cell(s, 0, 1, little, linear);
  for (int i = 0; i < (s->n + 1) * s->n; i++)
    ck_assert_double_le((double)quad_abs(f[i] - linear[i]), 1e-16);
}

START_TEST(forces_are_gradients_and_those_of_small_strains)
{
  unsigned long long seed = 3;
  for (int n = 2; n <= 3; n++)
    for (int law = 0; law < 4; law++) {
      dvi_mesh *mesh = graded_block(n, 1, 1);
      quad_solid s = solid_of(mesh, laws[law]);
      quad u[12];
      random_shift(12, 0.2, &seed, u);
      check_gradient(&s, u);
      check_small_strains(&s, u);
      quad_solid_clear(&s);
      dvi_mesh_destroy(&mesh);
    }
}
END_TEST

/* ---- errors ---- */

/* Two spans instead of one have other steps. */
START_TEST(errors_are_not_above_the_stated_ones)
{
  dvi_mesh *mesh = graded_block(2, 2, 1.5);
  quad_solid s = solid_of(mesh, DVI_ELASTIC_MOONEY_RIVLIN);
  quad u[18], v[18], w[18], rate[18];
  turning_start(&s, 2, u, v);
  turning_start(&s, 2, w, rate);
  const double stated = quad_solid_advance(&s, 0, 1, u, v);
  (void)quad_solid_advance(&s, 0, 0.37, w, rate);
  (void)quad_solid_advance(&s, 0.37, 1, w, rate);
  for (int i = 0; i < s.size; i++) {
    ck_assert_double_le((double)quad_abs(u[i] - w[i]), stated);
    ck_assert_double_le((double)quad_abs(v[i] - rate[i]), 100 * stated);
  }
  quad_solid_clear(&s);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- asynchronous steps ---- */

static double corner_error(const quad_solid *s, double fraction, int has_classes, quad exact)
{
  double step[48];
  quad u[SIZE], v[SIZE];
  turning_start(s, 1, u, v);
  quad_avi_steps(s, fraction, has_classes, 0, step);
  quad_avi avi = quad_avi_of(s, step, 0, u, v);
  quad_avi_advance(&avi, 1, u, v);
  quad_avi_clear(&avi);
  return fabs((double)(u[s->size - s->n] - exact)); /* the last node is the far corner */
}

/* An earlier computation printed these two digits. */
START_TEST(free_steps_have_their_errors_at_a_corner)
{
  dvi_mesh *mesh = graded_block(3, 2, 2);
  quad_solid s = solid_of(mesh, DVI_ELASTIC_SVK);
  const quad exact = quad_parse(".120541854504", NULL);
  ck_assert_double_eq_tol(corner_error(&s, 0.8, 0, exact), 4.0e-4, 0.05e-4);
  ck_assert_double_eq_tol(corner_error(&s, 0.1, 0, exact), 5.5e-6, 0.05e-6);
  quad_solid_clear(&s);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(asynchronous_steps_have_order_two)
{
  dvi_mesh *mesh = graded_block(2, 2, 2);
  quad_solid s = solid_of(mesh, DVI_ELASTIC_NEO_HOOKEAN);
  quad u[18], v[18];
  turning_start(&s, 1, u, v);
  (void)quad_solid_advance(&s, 0, 1, u, v);
  for (int has_classes = 0; has_classes < 2; has_classes++) {
    const double coarse = corner_error(&s, 0.1, has_classes, u[16]),
                 fine = corner_error(&s, 0.00625, has_classes, u[16]);
    ck_assert_double_eq_tol(log2(coarse / fine) / 4, 2, 0.2);
  }
  quad_solid_clear(&s);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(quad_solid)
{
  tcase_add_test(tests, corners_of_blocks_arrive_at_their_digits);
  tcase_add_test(tests, forces_are_gradients_and_those_of_small_strains);
  tcase_add_test(tests, errors_are_not_above_the_stated_ones);
  tcase_add_test(tests, free_steps_have_their_errors_at_a_corner);
  tcase_add_test(tests, asynchronous_steps_have_order_two);
}
