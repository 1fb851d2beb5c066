/* Elastic solids as mechanical systems in motion. */
#include <dvi/contact.h>
#include <dvi/reference.h>
#include <math.h>
#include <stdlib.h>

#include "support/field/generated.h"
#include "support/field/solids.h"
#include "support/suite.h"

static void advance(dvi_integrator *integrator, double h, int steps)
{
  for (int i = 0; i < steps; i++)
    ck_assert_msg(dvi_integrator_step(integrator, h) == DVI_OK, "%s", dvi_last_error());
}

/* ---- the free block of 2^3 cells, graded by 2 along x ---- */

/* The positions of the corner (1,1,1), the last node, at t = 1, by an independent program. */
typedef struct corner {
  dvi_elastic_law law;
  double x[3];
} corner;

static const corner corners[] = {
    {DVI_ELASTIC_SVK, {1.120541854504, 0.880670758168, 1.078836923111}},
    {DVI_ELASTIC_NEO_HOOKEAN, {1.121240896990, 0.880808459494, 1.079014224797}}};
enum { CORNERS = sizeof corners / sizeof *corners, NODES = 27 };

static void check_corner(const corner *c, const double *q)
{
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(1 + q[3 * NODES - 3 + i], c->x[i], 1e-12);
}

START_TEST(galerkin_has_the_digits_of_the_free_block)
{
  const corner *c = corners + _i;
  double rate[3 * NODES];
  dvi_elastic *solid = block(3, 2, 2, c->law);
  dvi_system *system = system_of_solid(solid);
  spin_block(solid, 1, rate);
  dvi_integrator *integrator = start_solid(solid, system, "galerkin:degree=4", rate);
  advance(integrator, 0.02, 50);
  check_corner(c, dvi_integrator_q(integrator));
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* IDA at its default tolerance of 1e-12 has errors of some 1e-11. */
START_TEST(ida_finds_the_same_motion)
{
  double rate[3 * NODES], q[3 * NODES] = {0}, p[3 * NODES];
  dvi_elastic *solid = block(3, 2, 2, DVI_ELASTIC_SVK);
  dvi_system *system = system_of_solid(solid);
  spin_block(solid, 1, rate);
  dvi_elastic_project(solid, NULL, rate, NULL, NULL, p);
  ck_assert_msg(dvi_reference_solve(system, 0, 1, q, p, NULL, NULL) == DVI_OK, "%s",
                dvi_last_error());
  for (int i = 0; i < 3; i++)
    ck_assert_double_eq_tol(1 + q[3 * NODES - 3 + i], corners[0].x[i], 1e-10);
  dvi_system_destroy(&system);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* Return the x position of the corner at t = 1 by a method. */
static double run_corner(dvi_elastic *solid, const char *method, double h, int steps)
{
  double rate[3 * NODES];
  dvi_system *system = system_of_solid(solid);
  spin_block(solid, 1, rate);
  dvi_integrator *integrator = start_solid(solid, system, method, rate);
  advance(integrator, h, steps);
  const double x = 1 + dvi_integrator_q(integrator)[3 * NODES - 3];
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  return x;
}

/* verlet takes the whole energy, and imex its stiffness at rest implicitly. */
START_TEST(explicit_and_split_methods_have_order_2)
{
  dvi_elastic *whole = block(3, 2, 2, DVI_ELASTIC_SVK);
  dvi_elastic *split = solid_on(dvi_mesh_share(dvi_elastic_mesh(whole)),
                                unit_material(DVI_ELASTIC_SVK), (dvi_elastic_terms){.split = 1});
  static const char *const methods[] = {"verlet", "imex", "galerkin:degree=1"};
  dvi_elastic *const solids[] = {whole, split, whole};
  for (int m = 0; m < 3; m++) {
    double last = 0;
    for (int steps = 50; steps <= 400; steps *= 2) {
      const double x = run_corner(solids[m], methods[m], 1.0 / steps, steps),
                   error = fabs(x - corners[0].x[0]);
      if (last > 0) ck_assert_double_eq_tol(log2(last / error), 2, 0.1);
      last = error;
    }
  }
  dvi_elastic_destroy(&split);
  dvi_elastic_destroy(&whole);
}
END_TEST

/* ---- invariants ---- */

START_TEST(momenta_stay_and_the_energy_swings)
{
  double rate[3 * NODES], before[7], after[7], q[3 * NODES] = {0};
  dvi_elastic *solid = block(3, 2, 2, (dvi_elastic_law)_i);
  dvi_system *system = system_of_solid(solid);
  spin_block(solid, _i == DVI_ELASTIC_LINEAR ? 0.01 : 1, rate);
  dvi_integrator *integrator = start_solid(solid, system, "verlet", rate);
  dvi_elastic_energies energies;
  ck_assert_int_eq(dvi_elastic_energy(solid, 0, q, rate, NULL, &energies), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, before), DVI_OK);
  ck_assert_double_eq_tol(energies.kinetic / before[0], 1, 1e-14);
  advance(integrator, 0.02, repeats(2000));
  ck_assert_int_eq(dvi_integrator_invariants(integrator, after), DVI_OK);
  ck_assert_double_eq_tol(after[0] / before[0], 1, 0.01);
  for (int i = 1; i < 7; i++) ck_assert_double_eq_tol(after[i], before[i], 1e-13);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* ---- damping ---- */

/* Of a lone mode x with the eigenvalue k = omega^2 Rayleigh's damping gives
 * x'' = -k x - (alpha + beta k) x', which in the linear law stays in the mode. */
START_TEST(rayleighs_damping_of_a_mode_is_that_of_an_oscillator)
{
  dvi_elastic_material material = unit_material(DVI_ELASTIC_LINEAR);
  material.alpha = 0.3, material.beta = 0.02;
  dvi_elastic *solid = solid_on(grid_mesh("kuhn", 2, 3, 1), material, (dvi_elastic_terms){0});
  const dvi_modes_options one = {.size = sizeof one, .count = 1};
  double k, mode[32];
  ck_assert_int_eq(dvi_elastic_modes(solid, &one, &k, mode, NULL), DVI_OK);
  dvi_system *system = system_of_solid(solid);
  dvi_integrator *integrator = start_solid(solid, system, "galerkin:degree=4", mode);
  advance(integrator, 0.05, 20);
  const double rate = (material.alpha + material.beta * k) / 2, omega = sqrt(k - rate * rate),
               factor = exp(-rate) * sin(omega) / omega;
  for (int i = 0; i < 32; i++)
    ck_assert_double_eq_tol(dvi_integrator_q(integrator)[i], factor * mode[i], 1e-11);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* ---- steps that pass over fast vibrations ---- */

static int sway(double t, const double *X, double *u, double *rate, void *user)
{
  (void)X, (void)user;
  u[0] = rate[0] = 0;
  u[1] = 0.02 * sin(7 * t), rate[1] = 0.14 * cos(7 * t);
  return 0;
}

static int weigh_down(double t, const double *X, const double *normal, double *force, void *user)
{
  (void)t, (void)X, (void)normal, (void)user;
  force[0] = 0, force[1] = -0.1;
  return 0;
}

/* A bar that is held at its left end, which may sway, and has a damping. */
static dvi_elastic *damped_bar(dvi_elastic_law law, double alpha, int sways)
{
  const dvi_generator_options options = {.cells = {20, 2}, .extent = {1, 0.1}};
  const dvi_elastic_condition left = {
      .part = "left", .displacement = sways ? sway : NULL, .is_steady = !sways};
  const dvi_elastic_load weight = {.part = "all", .force = weigh_down, .is_steady = 1};
  const dvi_elastic_material material = {.part = "all",
                                         .law = law,
                                         .lambda = 1000 * 0.3 / (1.3 * 0.4),
                                         .mu = 1000 / 2.6,
                                         .rho = 1,
                                         .alpha = alpha};
  return solid_on(
      generated("kuhn", options), material,
      (dvi_elastic_terms){.condition = &left, .conditions = 1, .load = &weight, .loads = 1});
}

/* The energy of a driven bar is balanced by the work of its condition. Its steps are doubted for
 * their motion alone, and soon no more. */
START_TEST(driven_steps_are_seldom_followed)
{
  dvi_counters counters;
  dvi_elastic *solid = damped_bar(DVI_ELASTIC_SVK, 1, 1);
  dvi_system *system = system_of_solid(solid);
  dvi_integrator *integrator = start_solid(solid, system, "midpoint", NULL);
  advance(integrator, 0.005, 100);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_lt(counters.followed, 15);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* Compositions know the work of the damping in their inner steps. */
START_TEST(no_damping_makes_a_composition_too_large)
{
  for (int law = DVI_ELASTIC_SVK; law <= DVI_ELASTIC_NEO_HOOKEAN; law++) {
    dvi_elastic *solid = damped_bar((dvi_elastic_law)law, 40, 0);
    dvi_system *system = system_of_solid(solid);
    dvi_integrator *integrator = start_solid(solid, system, "composition:order=4,base=midpoint",
                                             NULL);
    advance(integrator, 0.02, 2);
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&system);
    dvi_elastic_destroy(&solid);
  }
}
END_TEST

/* A step has one solution. It is 20 and more times as long as the fastest vibrations, and damping
 * and the moving end change the energy by much of its kinetic part. Steps of linear laws are not
 * even doubted. */
START_TEST(no_damping_and_no_driving_makes_a_step_too_large)
{
  static const char *const methods[] = {"midpoint", "galerkin:degree=2"};
  static const double step[] = {0.05, 0.02, 0.005};
  for (int law = DVI_ELASTIC_LINEAR; law <= DVI_ELASTIC_NEO_HOOKEAN; law++)
    for (int k = 0; k < 12; k++) {
      dvi_counters counters;
      dvi_elastic *solid = damped_bar((dvi_elastic_law)law, k % 2 ? 6 : 1, _i);
      dvi_system *system = system_of_solid(solid);
      dvi_integrator *integrator = start_solid(solid, system, methods[k / 2 % 2], NULL);
      advance(integrator, step[k / 4], 2);
      dvi_integrator_counters(integrator, &counters);
      if (law == DVI_ELASTIC_LINEAR) ck_assert_int_eq(counters.followed, 0);
      dvi_integrator_destroy(&integrator);
      dvi_system_destroy(&system);
      dvi_elastic_destroy(&solid);
    }
}
END_TEST

/* ---- a block that falls ---- */

static int gravity(double t, const double *X, const double *normal, double *force, void *user)
{
  (void)t, (void)X, (void)normal, (void)user;
  force[0] = force[1] = 0, force[2] = -1;
  return 0;
}

/* A block at the height 0.2 above a floor. */
static dvi_elastic *falling_block(double restitution, double friction)
{
  const dvi_generator_options options = {.cells = {2, 2, 2}, .origin = {0, 0, 0.2}};
  const dvi_elastic_load weight = {.part = "all", .force = gravity, .is_steady = 1};
  const dvi_obstacle floor = {
      .name = "floor", .normal = {0, 0, 1}, .restitution = restitution, .friction = friction};
  dvi_elastic_material material = unit_material(DVI_ELASTIC_SVK);
  material.lambda = material.mu = 10;
  return solid_on(
      generated("kuhn", options), material,
      (dvi_elastic_terms){.load = &weight, .loads = 1, .obstacle = &floor, .obstacles = 1});
}

/* The block hits at t = sqrt(0.4) with nine nodes at one time. After many hits of single nodes it
 * is in the air again at t = 1.5. Without losses its energy of 0 stays, which galerkin of order 4
 * keeps to 1e-6, verlet to 1 percent of that of the fall, 0.2. */
START_TEST(a_block_that_falls_rebounds)
{
  static const char *const methods[] = {"galerkin:degree=2", "verlet"};
  for (int m = 0; m < 2; m++) {
    dvi_elastic *solid = falling_block(1, 0);
    dvi_system *system = system_of_solid(solid);
    dvi_integrator *integrator = start_solid(solid, system, methods[m], NULL);
    double before, after, gap;
    int hits = 0;
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &before), DVI_OK);
    for (int i = 0; i < 150; i++) {
      advance(integrator, 0.01, 1);
      hits += dvi_integrator_hit_count(integrator);
      if (i == 62) ck_assert_int_eq(hits, 0);
      if (i == 63) ck_assert_int_eq(hits, 9);
    }
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &after), DVI_OK);
    ck_assert_int_eq(dvi_integrator_gap(integrator, &gap, NULL), DVI_OK);
    ck_assert_double_eq_tol(after, before, m == 0 ? 1e-6 : 0.002);
    ck_assert_int_gt(hits, 30);
    ck_assert_double_gt(gap, 0.05);
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&system);
    dvi_elastic_destroy(&solid);
  }
}
END_TEST

/* Where restitution ends hits of nodes, and with friction, moreau-jean keeps contacts closed. It
 * overlaps by a step's way, 0.01 times the velocity 0.6. */
START_TEST(a_block_with_friction_rebounds_with_a_part_of_its_energy)
{
  dvi_elastic *solid = falling_block(0.5, 0.3);
  dvi_system *system = system_of_solid(solid);
  dvi_integrator *integrator = start_solid(solid, system, "moreau-jean", NULL);
  double gap, energy, highest = -1;
  for (int i = 0; i < 200; i++) {
    advance(integrator, 0.01, 1);
    ck_assert_int_eq(dvi_integrator_gap(integrator, &gap, NULL), DVI_OK);
    ck_assert_double_gt(gap, -0.006);
    if (i > 100) highest = fmax(highest, gap);
  }
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &energy), DVI_OK);
  ck_assert(energy < -0.03 && energy > -0.2);
  ck_assert(highest > 0.04 && highest < 0.2);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi_elastic_destroy(&solid);
}
END_TEST

SUITE(elastic_motion)
{
  tcase_add_loop_test(tests, galerkin_has_the_digits_of_the_free_block, 0, CORNERS);
  tcase_add_test(tests, ida_finds_the_same_motion);
  tcase_add_test(tests, explicit_and_split_methods_have_order_2);
  tcase_add_loop_test(tests, momenta_stay_and_the_energy_swings, 0, DVI_ELASTIC_ENERGY);
  tcase_add_test(tests, rayleighs_damping_of_a_mode_is_that_of_an_oscillator);
  tcase_add_loop_test(tests, no_damping_and_no_driving_makes_a_step_too_large, 0, 2);
  tcase_add_test(tests, driven_steps_are_seldom_followed);
  tcase_add_test(tests, no_damping_makes_a_composition_too_large);
  tcase_add_test(tests, a_block_that_falls_rebounds);
  tcase_add_test(tests, a_block_with_friction_rebounds_with_a_part_of_its_energy);
}
