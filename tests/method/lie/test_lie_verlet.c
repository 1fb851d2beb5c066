/* labels: unit */
#include <check.h>
#include <dvi/group.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/systems/mixed_factors.h"
#include "support/runs.h"
#include "support/suite.h"

/* Omega at T = 10 and T = 1, in quadruple precision. */
static const double free_moments[] = {3, 2, 1.5},
                    free_end[] = {.4671205340242394, .6269711557238373, -.1811252970621061};
static const double pendulum_moments[] = {.13, .28, .17},
                    pendulum_end[] = {-6.751473860336227, .1484346732487297, 3.362315606396518};

static const char *const solves[] = {"lie-verlet:solve=exp", "lie-verlet:solve=cayley"};

/* ---- order ---- */

/* The error of Omega at time T. */
static double error_of(const body *model, const char *method, double h, double T,
                       const double *moments, const double *end)
{
  dvi_integrator *integrator = body_integrator(model, method);
  advance(integrator, h, lround(T / h));
  const double *Pi = dvi_integrator_p(integrator),
               Omega[] = {Pi[0] / moments[0], Pi[1] / moments[1], Pi[2] / moments[2]};
  const double error = distance(3, Omega, end);
  dvi_integrator_destroy(&integrator);
  return error;
}

START_TEST(a_free_body_has_order_2)
{
  body top;
  make_body(FREE_BODY, &top);
  const double coarse = error_of(&top, solves[_i], .05, 10, free_moments, free_end),
               fine = error_of(&top, solves[_i], .025, 10, free_moments, free_end);
  ck_assert_double_le(fine, 2e-4);
  ck_assert_double_eq_tol(log2(coarse / fine), 2, .05);
  destroy_body(&top);
}
END_TEST

START_TEST(a_pendulum_has_order_2)
{
  body top;
  make_body(PENDULUM_3D, &top);
  const double coarse = error_of(&top, solves[_i], .005, 1, pendulum_moments, pendulum_end),
               fine = error_of(&top, solves[_i], .0025, 1, pendulum_moments, pendulum_end);
  ck_assert_double_le(fine, 3e-4);
  ck_assert_double_eq_tol(log2(coarse / fine), 2, .05);
  destroy_body(&top);
}
END_TEST

/* Distance of q and p at time 1 from those of lie-galerkin:degree=6. */
static double distance_from_galerkin(const body *model, const char *method, double h)
{
  const int n = dvi_system_nq(model->system), nv = dvi_system_nv(model->system);
  dvi_integrator *judge = body_integrator(model, "lie-galerkin:degree=6"),
                 *integrator = body_integrator(model, method);
  advance(judge, 1.0 / 16, 16);
  advance(integrator, h, lround(1 / h));
  const double error = fmax(distance(n, dvi_integrator_q(judge), dvi_integrator_q(integrator)),
                            distance(nv, dvi_integrator_p(judge), dvi_integrator_p(integrator)));
  dvi_integrator_destroy(&judge);
  dvi_integrator_destroy(&integrator);
  return error;
}

enum { PRODUCTS = MIXED_KINDS + 1 };

static void make_product(int number, body *model)
{
  if (number < MIXED_KINDS)
    make_mixed_factors((mixed_kind)number, model);
  else
    make_body(PRODUCT, model);
}

START_TEST(products_have_order_2)
{
  body product;
  make_product(_i, &product);
  const double coarse = distance_from_galerkin(&product, "lie-verlet", 1.0 / 64),
               fine = distance_from_galerkin(&product, "lie-verlet", 1.0 / 128);
  ck_assert_double_le(fine, 1e-3);
  ck_assert_double_eq_tol(log2(coarse / fine), 2, .1);
  destroy_body(&product);
}
END_TEST

START_TEST(compositions_have_order_4)
{
  const char *method = "composition:order=4,base=lie-verlet";
  body product;
  make_product(_i, &product);
  const double coarse = distance_from_galerkin(&product, method, 1.0 / 32),
               fine = distance_from_galerkin(&product, method, 1.0 / 64);
  ck_assert_double_le(fine, 1e-5);
  ck_assert_double_eq_tol(log2(coarse / fine), 4, .2);
  destroy_body(&product);
}
END_TEST

START_TEST(both_parametrisations_are_one_method)
{
  body top;
  make_body(PENDULUM_3D, &top);
  dvi_integrator *by_exp = body_integrator(&top, solves[0]),
                 *by_cayley = body_integrator(&top, solves[1]);
  advance(by_exp, .02, 50);
  advance(by_cayley, .02, 50);
  ck_assert_double_le(distance(9, dvi_integrator_q(by_exp), dvi_integrator_q(by_cayley)),
                      1e-13); /* rounding, grown 50 steps long */
  dvi_integrator_destroy(&by_exp);
  dvi_integrator_destroy(&by_cayley);
  destroy_body(&top);
}
END_TEST

/* ---- structure ---- */

/* Differences and roundoff make 2e-10 of it. */
START_TEST(a_step_is_symplectic)
{
  static const struct {
    body_kind kind;
    double h;
  } cases[] = {{FREE_BODY, .2},   {PENDULUM_3D, .02}, {HEAVY_TOP, .002}, {MOTION, .2},
               {DIRECTIONS, .02}, {ANGLE, .2},        {PRODUCT, .05}};
  body product;
  make_body(cases[_i].kind, &product);
  ck_assert_double_le(symplectic_defect(&product, "lie-verlet", cases[_i].h), 1e-9);
  destroy_body(&product);
}
END_TEST

START_TEST(a_step_of_cells_is_symplectic)
{
  body product;
  make_mixed_factors(_i == 0 ? LOOSE : WEDGED, &product);
  ck_assert_double_le(symplectic_defect(&product, "lie-verlet", .2), 1e-9);
  /* the test can tell */
  ck_assert_double_ge(symplectic_defect(&product, "lie-rk:scheme=crouch-grossman", .2), 1e-5);
  destroy_body(&product);
}
END_TEST

START_TEST(a_step_back_undoes_a_step)
{
  body product;
  make_product(_i, &product);
  const int n = dvi_system_nq(product.system), nv = dvi_system_nv(product.system);
  dvi_integrator *integrator = body_integrator(&product, "lie-verlet");
  double p[BODY_V];
  memcpy(p, dvi_integrator_p(integrator), (size_t)nv * sizeof *p);
  advance(integrator, .1, 10);
  ck_assert_double_ge(distance(n, dvi_integrator_q(integrator), product.q), .1);
  advance(integrator, -.1, 10);
  ck_assert_double_le(distance(n, dvi_integrator_q(integrator), product.q), 1e-13);
  ck_assert_double_le(distance(nv, dvi_integrator_p(integrator), p), 1e-13);
  dvi_integrator_destroy(&integrator);
  destroy_body(&product);
}
END_TEST

/* The discrete free body has the energy and the momentum of the continuous one (Hairer and Vilmart
 * 2006) up to rounding, however thin and fast it is. */
START_TEST(thin_and_fast_bodies_keep_energy_and_momentum)
{
  static const struct {
    double J[9], Omega[3], h;
  } cases[] = {
      {{1, 0, 0, 0, 1, 0, 0, 0, 1e-6}, {300, -400, 10}, 1e-3}, /* a rod */
      /* nearly a symmetric plate, nearly flat */
      {{1, 0, 0, 0, 1.000001, 0, 0, 0, 2}, {600, -800, 30}, 1e-4},
      {{2, 0, 0, 0, 1.999998, 0, 0, 0, 2.000001}, {1000, -300, 50}, 5e-4}, /* nearly a sphere */
  };
  body top;
  make_free_body(cases[_i].J, cases[_i].Omega, &top);
  dvi_integrator *integrator = body_integrator(&top, "lie-verlet");
  double first, last, space[2][3];
  for (int k = 0; k < 2; k++) {
    const double *R = dvi_integrator_q(integrator), *Pi = dvi_integrator_p(integrator);
    for (int i = 0; i < 3; i++)
      space[k][i] = R[3 * i] * Pi[0] + R[3 * i + 1] * Pi[1] + R[3 * i + 2] * Pi[2];
    ck_assert_int_eq(dvi_integrator_invariants(integrator, k == 0 ? &first : &last), DVI_OK);
    if (k == 0) advance(integrator, cases[_i].h, 100000);
  }
  ck_assert_double_le(distance(3, space[0], space[1]), 1e-12 * magnitude(3, space[0]));
  ck_assert_double_le(fabs(last - first), 1e-11 * first);
  dvi_integrator_destroy(&integrator);
  destroy_body(&top);
}
END_TEST

/* ---- steps too large ---- */

/* The step can be solved for h p just below the moment of inertia, and not just above. The state
 * stays. */
START_TEST(a_step_beyond_the_bound_is_refused)
{
  static const double inertia[] = {2, 0, 0, 0, 2, 0, 0, 0, 2};
  static const struct {
    dvi_factor factor;
    int nq;
    double q[9], v[3]; /* |v| = 1 */
    const char *words;
  } cases[] = {
      {{.kind = DVI_SO3, .inertia = inertia},
       9,
       {1, 0, 0, 0, 1, 0, 0, 0, 1},
       {.6, 0, -.8},
       "the moment of inertia about the axis that it turns about, at most 2"},
      {{.kind = DVI_S2, .mass = 2},
       3,
       {0, 0, 1},
       {.6, -.8, 0},
       "direction at coordinates 0 to 2 turns too far: h |p| is 2.0002, and a step can be solved "
       "up to the moment of inertia 2"},
      {{.kind = DVI_U1, .mass = 2},
       2,
       {0, 1},
       {1},
       "angle at coordinates 0 to 1 turns too far: h |p| is 2.0002, and a step can be solved up to "
       "the moment of inertia 2"},
  };
  const char *method = solves[_i % 2];
  body top = {.name = "top"};
  memcpy(top.q, cases[_i / 2].q, sizeof cases->q);
  memcpy(top.v, cases[_i / 2].v, sizeof cases->v);
  ck_assert_int_eq(
      dvi_system_create(
          &(dvi_system_terms){.factors = &cases[_i / 2].factor, .factor_count = 1, .autonomous = 1},
          &top.system),
      DVI_OK);
  dvi_integrator *integrator = body_integrator(&top, method);
  ck_assert_int_eq(dvi_integrator_step(integrator, 1.0001), DVI_STEP_TOO_LARGE);
  check_words(cases[_i / 2].words);
  ck_assert_int_eq(
      memcmp(dvi_integrator_q(integrator), top.q, (size_t)cases[_i / 2].nq * sizeof(double)), 0);
  ck_assert_int_eq(dvi_integrator_step(integrator, .9999), DVI_OK);
  dvi_integrator_destroy(&integrator);
  destroy_body(&top);
}
END_TEST

START_TEST(coupled_cells_refuse_steps_too_large)
{
  body product;
  make_body(PRODUCT, &product);
  dvi_integrator *integrator = body_integrator(&product, "lie-verlet");
  ck_assert_int_eq(dvi_integrator_step(integrator, 3), DVI_STEP_TOO_LARGE);
  check_words("too far");
  ck_assert_int_eq(
      memcmp(dvi_integrator_q(integrator), product.q, (size_t)product.nq * sizeof(double)), 0);
  advance(integrator, .1, 1);
  dvi_integrator_destroy(&integrator);
  destroy_body(&product);
}
END_TEST

/* ---- masses ---- */

static int height(double t, const double *q, double *V, void *user)
{
  (void)t;
  *V = *(double *)user * q[8];
  return 0;
}

static int weight(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q;
  memset(V_q, 0, 9 * sizeof *V_q);
  V_q[8] = *(double *)user;
  return 0;
}

/* A ball under a weight along an axis of its own, and a system with the Lagrangian -L. Its scalar
 * mass -1 makes I of J into -I. */
static dvi_integrator *ball(const char *method, double sign, body *model)
{
  static const double J[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  static double signs[2];
  double *own = &signs[sign < 0];
  *own = sign;
  const dvi_factor factor = {.kind = DVI_SO3, .inertia = J};
  const dvi_potential potential = {
      .name = "weight", .value = height, .gradient = weight, .user = own};
  *model = (body){
      .name = "ball", .nq = 9, .nv = 3, .q = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .v = {1, .5, .2}};
  const dvi_system_terms terms = {.factors = &factor,
                                  .factor_count = 1,
                                  .potentials = &potential,
                                  .potential_count = 1,
                                  .mass = {.scalar = sign < 0 ? -1 : 0},
                                  .autonomous = 1};
  ck_assert_int_eq(dvi_system_create(&terms, &model->system), DVI_OK);
  return body_integrator(model, method);
}

/* -L has the same motions as L. */
START_TEST(a_negative_mass_moves_against_the_force)
{
  static const char *const methods[] = {"lie-verlet", "lie-verlet:solve=cayley",
                                        "lie-galerkin:degree=2", "lie-rk"};
  body plus, minus;
  dvi_integrator *one = ball(methods[_i], 1, &plus), *other = ball(methods[_i], -1, &minus);
  advance(one, .05, 100);
  advance(other, .05, 100);
  ck_assert_double_le(distance(9, dvi_integrator_q(one), dvi_integrator_q(other)), 1e-13);
  for (int i = 0; i < 3; i++)
    ck_assert_double_eq_tol(dvi_integrator_p(one)[i], -dvi_integrator_p(other)[i], 1e-13);
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&other);
  destroy_body(&plus);
  destroy_body(&minus);
}
END_TEST

/* L = y1'.y2' = a' b' cos(a - b) of two angles. At rest b stays, and sin(a - b) grows by a'(0)
 * cos(a(0) - b) t, without any kinetic energy. */
START_TEST(a_motion_without_kinetic_energy_is_solved)
{
  static const int start[] = {0, 1, 2, 3, 4}, row[] = {2, 3, 0, 1};
  static const double mass[] = {1, 1, 1, 1};
  const dvi_factor factors[] = {{.kind = DVI_U1}, {.kind = DVI_U1}};
  body angles = {.name = "angles", .nq = 4, .nv = 2, .q = {1, 0, cos(.7), sin(.7)}, .v = {1, 0}};
  const dvi_system_terms terms = {.factors = factors,
                                  .factor_count = 2,
                                  .mass = {.values = mass, .pattern = {start, row}},
                                  .autonomous = 1};
  ck_assert_int_eq(dvi_system_create(&terms, &angles.system), DVI_OK);
  dvi_integrator *integrator = body_integrator(&angles, "lie-verlet");
  advance(integrator, .1, 4);
  ck_assert_double_eq_tol(dvi_u1_log(dvi_integrator_q(integrator)),
                          .7 + asin(.4 * cos(.7) - sin(.7)), 1e-15);
  dvi_integrator_destroy(&integrator);
  destroy_body(&angles);
}
END_TEST

/* ---- cost ---- */

START_TEST(a_step_costs_one_gradient_and_no_memory)
{
  body product;
  make_product(_i, &product);
  dvi_integrator *integrator = body_integrator(&product, "lie-verlet");
  dvi_counters before, after;
  advance(integrator, .1, 1);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, .1, 20);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.gradients - before.gradients, 20);
  ck_assert_int_eq(after.hessians, before.hessians);
  ck_assert_int_eq(after.allocations, before.allocations);
  ck_assert_int_le(after.jacobians - before.jacobians, _i == LOOSE || _i == LINES ? 0 : 20 * 6);
  dvi_integrator_destroy(&integrator);
  destroy_body(&product);
}
END_TEST

enum { MANY = 300 };

START_TEST(hundreds_of_bodies_leap_one_by_one)
{
  static const double J[] = {3, .1, .2, .1, 2, -.1, .2, -.1, 1.5};
  dvi_factor factors[MANY];
  double *numbers = calloc((size_t)12 * MANY, sizeof *numbers), *v = numbers + 9 * MANY;
  dvi_system *system = NULL;
  ck_assert_ptr_nonnull(numbers);
  for (int b = 0; b < MANY; b++) {
    factors[b] = (dvi_factor){.kind = DVI_SO3, .inertia = J};
    for (int i = 0; i < 3; i++) {
      numbers[9 * b + 4 * i] = 1;
      v[3 * b + i] = sin(b + i);
    }
  }
  ck_assert_int_eq(
      dvi_system_create(
          &(dvi_system_terms){.factors = factors, .factor_count = MANY, .autonomous = 1}, &system),
      DVI_OK);
  dvi_integrator *integrator = create_integrator(system, "lie-verlet");
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, numbers, v), DVI_OK);
  double first, last;
  dvi_counters before, after;
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &first), DVI_OK);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, .2, 100);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.factorizations, before.factorizations);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &last), DVI_OK);
  ck_assert_double_eq_tol(last / first, 1, 1e-13);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  free(numbers);
}
END_TEST

/* The centre of mass of a rigid motion without forces moves on a straight line in every step. */
START_TEST(a_centre_of_mass_goes_straight)
{
  const double centre[] = {.1, -.2, .15}, mass = 2, h = .1, steps = 1000;
  body motion;
  double start[3], push[3];
  make_body(FREE_MOTION, &motion);
  dvi_integrator *integrator = body_integrator(&motion, "lie-verlet");
  const double *q = dvi_integrator_q(integrator);
  memcpy(push, dvi_integrator_p(integrator) + 3, sizeof push);
  for (int i = 0; i < 3; i++)
    start[i] = q[9 + i] + q[3 * i] * centre[0] + q[3 * i + 1] * centre[1] +
               q[3 * i + 2] * centre[2];
  advance(integrator, h, (long)steps);
  q = dvi_integrator_q(integrator);
  for (int i = 0; i < 3; i++) {
    const double place = q[9 + i] + q[3 * i] * centre[0] + q[3 * i + 1] * centre[1] +
                         q[3 * i + 2] * centre[2];
    ck_assert_double_eq_tol(place, start[i] + h * steps * push[i] / mass, 1e-11);
  }
  ck_assert_double_le(distance(3, push, dvi_integrator_p(integrator) + 3), 0);
  dvi_integrator_destroy(&integrator);
  destroy_body(&motion);
}
END_TEST

START_TEST(between_steps_it_stays_on_the_group)
{
  body product;
  make_product(_i, &product);
  const int n = dvi_system_nq(product.system);
  dvi_integrator *integrator = body_integrator(&product, "lie-verlet");
  double q[BODY_Q], v[BODY_V];
  advance(integrator, .1, 1);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, .05, q, v), DVI_OK);
  ck_assert_double_le(dvi_system_distance(product.system, q), 1e-15);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, .1, q, v), DVI_OK);
  ck_assert_double_le(distance(n, q, dvi_integrator_q(integrator)), 1e-14);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0, q, v), DVI_OK);
  ck_assert_double_le(distance(n, q, product.q), 1e-15);
  /* the step's constant velocity, right up to O(h) */
  ck_assert_double_le(distance(dvi_system_nv(product.system), v, product.v), .2);
  dvi_integrator_destroy(&integrator);
  destroy_body(&product);
}
END_TEST

START_TEST(systems_without_factors_are_refused)
{
  problem *oscillator = create_problem("oscillator", NULL);
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create(oscillator->system, "lie-verlet", &integrator),
                   DVI_UNSUPPORTED);
  ck_assert_ptr_null(integrator);
  problem_destroy(&oscillator);
}
END_TEST

SUITE(lie_verlet)
{
  tcase_add_loop_test(tests, a_free_body_has_order_2, 0, 2);
  tcase_add_loop_test(tests, a_pendulum_has_order_2, 0, 2);
  tcase_add_loop_test(tests, products_have_order_2, 0, PRODUCTS);
  tcase_add_loop_test(tests, compositions_have_order_4, 0, PRODUCTS);
  tcase_add_test(tests, both_parametrisations_are_one_method);
  tcase_add_loop_test(tests, a_step_is_symplectic, 0, 7);
  tcase_add_loop_test(tests, a_step_of_cells_is_symplectic, 0, 2);
  tcase_add_loop_test(tests, a_step_back_undoes_a_step, 0, PRODUCTS);
  tcase_add_loop_test(tests, thin_and_fast_bodies_keep_energy_and_momentum, 0, 3);
  tcase_add_loop_test(tests, a_step_beyond_the_bound_is_refused, 0, 6);
  tcase_add_test(tests, coupled_cells_refuse_steps_too_large);
  tcase_add_test(tests, a_motion_without_kinetic_energy_is_solved);
  tcase_add_loop_test(tests, a_negative_mass_moves_against_the_force, 0, 4);
  tcase_add_loop_test(tests, a_step_costs_one_gradient_and_no_memory, 0, PRODUCTS);
  tcase_add_test(tests, hundreds_of_bodies_leap_one_by_one);
  tcase_add_test(tests, a_centre_of_mass_goes_straight);
  tcase_add_loop_test(tests, between_steps_it_stays_on_the_group, 0, PRODUCTS);
  tcase_add_test(tests, systems_without_factors_are_refused);
}
