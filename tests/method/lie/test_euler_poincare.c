/* The reduced form takes the steps of lie-galerkin from the momentum alone. Also tested are the
 * discrete Euler-Poincare equation, and refusals. */
#include <math.h>
#include <string.h>

#include "support/systems/bodies.h"
#include "support/runs.h"
#include "support/suite.h"

static const double inertia[] = {1.3, .1, 0, .1, 1.1, .05, 0, .05, .9}, centre[] = {.1, -.2, .15};

/* Two bodies, an angle, and two coordinates whose mass is full. */
enum { PRODUCT_Q = 9 + 2 + 12 + 2, FIRST_LINE = 9 + 2 + 12 };

static void make_product(double between_lines, double across, body *model)
{
  static const dvi_factor factors[] = {
      {.kind = DVI_SO3, .inertia = inertia},
      {.kind = DVI_U1, .mass = .7},
      {.kind = DVI_SE3, .mass = 2, .inertia = inertia, .centre = centre},
      {.kind = DVI_RN, .size = 2, .mass = 1.5}};
  static double mass[PRODUCT_Q * PRODUCT_Q];
  memset(mass, 0, sizeof mass);
  mass[FIRST_LINE * PRODUCT_Q + FIRST_LINE + 1] = mass[(FIRST_LINE + 1) * PRODUCT_Q + FIRST_LINE] =
      between_lines;
  mass[FIRST_LINE * PRODUCT_Q + 4] = mass[4 * PRODUCT_Q + FIRST_LINE] = across;
  const dvi_system_terms terms = {
      .factors = factors, .factor_count = 4, .mass.values = mass, .autonomous = 1};
  *model = (body){.name = "product", .factors = factors, .factor_count = 4};
  ck_assert_msg(dvi_system_create(&terms, &model->system) == DVI_OK, "%s", dvi_last_error());
}

static const double product_q[PRODUCT_Q] = {0, -1, 0, 1, 0, 0, 0, 0,  1,   .6, .8, 1, 0,
                                            0, 0,  1, 0, 0, 0, 1, .3, -.2, .1, .5, .7},
                    product_v[12] = {1, .3, -.4, .9, -.2, .8, 1.1, .4, -.3, .6, .5, -.7};

/* Both take 200 steps, and roundoff of the states adds up. */
static void compare_steps(const dvi_system *system, const double *q, const double *v,
                          const char *keys, double h)
{
  dvi_integrator *whole = create_integrator(system, method_spec("lie-galerkin:%s", keys)),
                 *reduced = create_integrator(system, method_spec("euler-poincare:%s", keys));
  ck_assert_msg(dvi_integrator_start_velocity(whole, 0, q, v) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_integrator_start_velocity(reduced, 0, q, v) == DVI_OK, "%s", dvi_last_error());
  advance(whole, h, 200);
  advance(reduced, h, 200);
  const double in_q = distance(dvi_system_nq(system), dvi_integrator_q(whole),
                               dvi_integrator_q(reduced)),
               in_p = distance(dvi_system_nv(system), dvi_integrator_p(whole),
                               dvi_integrator_p(reduced));
  ck_assert_msg(in_q < 2e-12 && in_p < 2e-12, "%s: %.1e in q, %.1e in p", keys, in_q, in_p);
  dvi_integrator_destroy(&whole);
  dvi_integrator_destroy(&reduced);
}

static const char *const keys[] = {"degree=1",
                                   "degree=2",
                                   "degree=4",
                                   "degree=2,solver=newton",
                                   "degree=3,quadrature=lobatto,nodes=4",
                                   "degree=3,basis=legendre"};
enum { KEYS = sizeof keys / sizeof *keys };

START_TEST(it_takes_the_steps_of_lie_galerkin)
{
  static const body_kind kinds[] = {FREE_BODY, FREE_MOTION};
  body model;
  for (int k = 0; k < 2; k++) {
    make_body(kinds[k], &model);
    compare_steps(model.system, model.q, model.v, keys[_i], 0.1);
    destroy_body(&model);
  }
  make_product(.2, 0, &model);
  compare_steps(model.system, product_q, product_v, keys[_i], 0.1);
  destroy_body(&model);
}
END_TEST

/* Gives mu1 = Ad*_f mu0 from f = g0^{-1} g1 alone, Pi1 = F^T (Pi0 - R0^T (x1 - x0) x p). */
START_TEST(momenta_follow_the_coadjoint_action)
{
  body model;
  make_body(FREE_MOTION, &model);
  dvi_integrator *made = body_integrator(&model, "euler-poincare:degree=2");
  for (int n = 0; n < 50; n++) {
    double q0[12], p0[6], shift[3], moment[3], due[3] = {0};
    memcpy(q0, dvi_integrator_q(made), sizeof q0);
    memcpy(p0, dvi_integrator_p(made), sizeof p0);
    advance(made, 0.3, 1);
    const double *q1 = dvi_integrator_q(made), *p1 = dvi_integrator_p(made);
    for (int i = 0; i < 3; i++) shift[i] = q1[9 + i] - q0[9 + i];
    for (int i = 0; i < 3; i++)
      moment[i] = shift[(i + 1) % 3] * p0[3 + (i + 2) % 3] -
                  shift[(i + 2) % 3] * p0[3 + (i + 1) % 3];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        due[i] += q1[3 * j + i] *
                  (q0[3 * j] * p0[0] + q0[3 * j + 1] * p0[1] + q0[3 * j + 2] * p0[2] - moment[j]);
    ck_assert_double_le(distance(3, due, p1), 5e-15 * magnitude(3, p0));
    ck_assert_mem_eq(p0 + 3, p1 + 3, 3 * sizeof *p0);
  }
  dvi_integrator_destroy(&made);
  destroy_body(&model);
}
END_TEST

START_TEST(its_steps_are_symplectic)
{
  body model;
  make_body(_i == 0 ? FREE_BODY : FREE_MOTION, &model);
  const double defect = symplectic_defect(&model, "euler-poincare:degree=3", 0.4);
  ck_assert_msg(defect < 1e-8, "%s: %.1e", model.name, defect);
  destroy_body(&model);
}
END_TEST

static void check_refusal(const body *model, const char *words)
{
  dvi_integrator *made;
  ck_assert_int_eq(dvi_integrator_create(model->system, "euler-poincare", &made), DVI_UNSUPPORTED);
  ck_assert_ptr_null(made);
  check_words("euler-poincare");
  check_words(words);
  check_words("lie-galerkin");
}

START_TEST(what_the_group_does_not_leave_alone_is_refused)
{
  const dvi_factor direction = {.kind = DVI_S2, .mass = 1};
  const double plane[] = {1, 0, 0, 2}; /* an ellipse's circle */
  const dvi_factor angle = {.kind = DVI_U1};
  body model;
  make_body(PENDULUM_3D, &model);
  check_refusal(&model, "potentials");
  destroy_body(&model);
  ck_assert_int_eq(dvi_system_create(&(dvi_system_terms){.factors = &direction, .factor_count = 1},
                                     &model.system),
                   DVI_OK);
  check_refusal(&model, "directions (S^2)");
  destroy_body(&model);
  make_product(0, .1, &model);
  check_refusal(&model, "the mass of coordinates");
  destroy_body(&model);
  ck_assert_int_eq(
      dvi_system_create(
          &(dvi_system_terms){.factors = &angle, .factor_count = 1, .mass.values = plane},
          &model.system),
      DVI_OK);
  check_refusal(&model, "the mass of coordinates 1 and 1");
  destroy_body(&model);
  const dvi_system_terms one_entry = {
      .factors = &angle,
      .factor_count = 1,
      .mass = {.values = plane, .pattern = {(const int[]){0, 1, 1}, (const int[]){0}}}};
  ck_assert_int_eq(dvi_system_create(&one_entry, &model.system), DVI_OK);
  check_refusal(&model, "the mass of coordinates 1 and 1");
  destroy_body(&model);
}
END_TEST

START_TEST(a_turn_beyond_the_chart_is_a_step_too_large)
{
  body model;
  make_body(FREE_BODY, &model);
  dvi_integrator *made = body_integrator(&model, "euler-poincare:degree=2");
  double p[3];
  memcpy(p, dvi_integrator_p(made), sizeof p);
  ck_assert_int_eq(dvi_integrator_step(made, 8), DVI_STEP_TOO_LARGE);
  check_words("half a turn");
  ck_assert_mem_eq(p, dvi_integrator_p(made), sizeof p);
  ck_assert_mem_eq(model.q, dvi_integrator_q(made), 9 * sizeof *model.q);
  advance(made, 0.5, 3);
  dvi_integrator_destroy(&made);
  destroy_body(&model);
}
END_TEST

SUITE(euler_poincare)
{
  tcase_add_loop_test(tests, it_takes_the_steps_of_lie_galerkin, 0, KEYS);
  tcase_add_test(tests, momenta_follow_the_coadjoint_action);
  tcase_add_loop_test(tests, its_steps_are_symplectic, 0, 2);
  tcase_add_test(tests, what_the_group_does_not_leave_alone_is_refused);
  tcase_add_test(tests, a_turn_beyond_the_chart_is_a_step_too_large);
}
