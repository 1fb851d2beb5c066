/* Densities on multiscale elements: the wave u_tt = (a u_x)_x and -div (a grad u) = 1. */
#include <math.h>
#include <stdio.h>

#include "support/field/densities.h"
#include "support/field/galerkin.h"
#include "support/suite.h"

enum { MOST = 33 };

static double stiffness(double x)
{
  return 10 / (1 + .95 * sin(2 * 3.141592653589793 * x / .025));
}

static int sample(int64_t count, const double *x, double *a, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) a[i] = stiffness(x[i]);
  return 0;
}

static int elastic(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < count; i++) {
    const double a = stiffness(x[i]);
    if (l != NULL) l[i] = -a * z[i] * z[i] / 2;
    if (l_z != NULL) l_z[i] = -a * z[i];
    if (l_zz != NULL) l_zz[i] = -a;
  }
  return 0;
}

static dvi_density *rod_of(int cells)
{
  static const dvi_jet slope = {0, 0, {1}};
  const dvi_density_part part[] = {
      kinetic_part,
      {.kind = DVI_DENSITY_QUADRATIC, .variable = &slope, .variables = 1, .density = elastic}};
  const dvi_density_condition fixed = {.part = "boundary", .kind = DVI_FIXED};
  const dvi_axis axis = {.from = 0, .to = 1};
  char kind[64];
  snprintf(kind, sizeof kind, "msfem:cells=%d,fine=%d", cells, 160 / cells);
  const dvi_space_options options = {
      .size = sizeof options, .kind = kind, .axis = &axis, .axes = 1, .coefficient = sample};
  dvi_space *space;
  dvi_density *rod;
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  const dvi_density_terms terms = {.size = sizeof terms,
                                   .space = space,
                                   .components = 1,
                                   .part = part,
                                   .parts = 2,
                                   .condition = &fixed,
                                   .conditions = 1};
  ck_assert_msg(dvi_density_create(&terms, &rod) == DVI_OK, "%s", dvi_last_error());
  dvi_space_destroy(&space);
  return rod;
}

/* Digits of an independent program. The bound of frequencies may be high by a thousandth of the
 * square. */
START_TEST(densities_have_the_frequencies_of_the_space)
{
  const double expected[] = {9.997469273, 9.950195246, 9.938128061};
  const double step[] = {.02432, .01185, .006205};
  for (int i = 0; i < 3; i++) {
    const dvi_modes_options one = {.size = sizeof one, .count = 1};
    double eigenvalue, fastest;
    dvi_density *rod = rod_of(8 << i);
    ck_assert_int_eq(dvi_density_modes(rod, &one, NULL, &eigenvalue, NULL), DVI_OK);
    ck_assert_double_eq_tol(sqrt(eigenvalue), expected[i], .6e-9);
    ck_assert_int_eq(dvi_density_fastest(rod, &fastest), DVI_OK);
    ck_assert_double_eq_tol(2 / fastest, step[i], 1e-3 * step[i]);
    dvi_density_destroy(&rod);
  }
}
END_TEST

/* Run leapfrog from the first mode, and give q_0 at the end as a share of that of the start. */
static double swing(dvi_density *rod, double h, int steps, double *omega)
{
  const dvi_modes_options one = {.size = sizeof one, .count = 1};
  double U[MOST], q[MOST], p[MOST], eigenvalue;
  dvi_system *system;
  dvi_integrator *integrator;
  ck_assert_int_eq(dvi_density_modes(rod, &one, NULL, &eigenvalue, U), DVI_OK);
  ck_assert_int_eq(dvi_density_project(rod, U, NULL, q, NULL, p), DVI_OK);
  ck_assert_int_eq(dvi_density_system(rod, &system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(system, "verlet", &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  const double start = q[0];
  for (int i = 0; i < steps; i++) ck_assert_int_eq(dvi_integrator_step(integrator, h), DVI_OK);
  const double end = dvi_integrator_q(integrator)[0];
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  *omega = sqrt(eigenvalue);
  return end / start;
}

/* Leapfrog turns a mode by the angle 2 asin(omega h/2) a step. Roundoff of other modes grows by at
 * most the number of steps. */
START_TEST(leapfrog_keeps_modes_with_steps_of_coarse_cells)
{
  dvi_density *rod = rod_of(16);
  double fastest, omega;
  ck_assert_int_eq(dvi_density_fastest(rod, &fastest), DVI_OK);
  const double h = 1.9 / fastest;
  const int steps = repeats(1000);
  const double share = swing(rod, h, steps, &omega);
  ck_assert_double_eq_tol(share, cos(steps * 2 * asin(omega * h / 2)), 1e-9);
  dvi_density_destroy(&rod);
}
END_TEST

/* ---- the plane ---- */

static int waves(int64_t count, const double *x, double *a, void *user)
{
  (void)user;
  for (int64_t i = 0; i < count; i++) a[i] = 1.1 + sin(20 * x[i]) * sin(30 * x[count + i]);
  return 0;
}

/* l = u - a |grad u|^2/2 */
static int bending(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  double a;
  (void)t;
  for (int i = 0; i < count; i++) {
    const double place[2] = {x[i], x[count + i]}, *u = z + i, *ux = u + count, *uy = ux + count;
    waves(1, place, &a, user);
    const double slope[3] = {1, -a * *ux, -a * *uy}, second[6] = {0, 0, -a, 0, 0, -a};
    if (l != NULL) l[i] = *u - a * (*ux * *ux + *uy * *uy) / 2;
    for (int k = 0; k < 3 && l_z != NULL; k++) l_z[k * count + i] = slope[k];
    for (int k = 0; k < 6 && l_zz != NULL; k++) l_zz[k * count + i] = second[k];
  }
  return 0;
}

/* Both put the same sums together. */
START_TEST(densities_have_the_solutions_of_the_space)
{
  static const dvi_jet jets[] = {{0, 0, {0}}, {0, 0, {1}}, {0, 0, {0, 1}}};
  static const dvi_axis axis[] = {{.from = 0, .to = 1}, {.from = 0, .to = 2}};
  const dvi_density_part part[] = {
      kinetic_part,
      {.kind = DVI_DENSITY_QUADRATIC, .variable = jets, .variables = 3, .density = bending}};
  const dvi_density_condition fixed = {.part = "boundary", .kind = DVI_FIXED};
  const dvi_space_options options = {.size = sizeof options,
                                     .kind = "msfem:cells=5,fine=12,edges=oversampled",
                                     .axis = axis,
                                     .axes = 2,
                                     .coefficient = waves};
  dvi_space *space;
  dvi_density *plate;
  double U[36] = {0}, expected[36];
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  const dvi_density_terms terms = {.size = sizeof terms,
                                   .space = space,
                                   .components = 1,
                                   .part = part,
                                   .parts = 2,
                                   .condition = &fixed,
                                   .conditions = 1};
  ck_assert_msg(dvi_density_create(&terms, &plate) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_density_solve(plate, U, NULL) == DVI_OK, "%s", dvi_last_error());
  galerkin g = galerkin_of(space, waves, NULL, NULL);
  galerkin_solve(&g, expected);
  for (int i = 0; i < 36; i++) ck_assert_double_eq_tol(U[i], expected[i], 1e-13);
  galerkin_clear(&g);
  dvi_density_destroy(&plate);
  dvi_space_destroy(&space);
}
END_TEST

SUITE(multiscale_density)
{
  tcase_add_test(tests, densities_have_the_frequencies_of_the_space);
  tcase_add_test(tests, leapfrog_keeps_modes_with_steps_of_coarse_cells);
  tcase_add_test(tests, densities_have_the_solutions_of_the_space);
}
