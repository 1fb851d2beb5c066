/* labels: order slow */
/* Methods with holonomic constraints: orders, what is kept, multipliers, starts, refusals. */
#include <math.h>
#include <string.h>

#include <dvi/diagnostics.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/constrained.h"

/* ---- orders ---- */

typedef struct claim {
  const char *method;
  int order, steps; /* of the longest step */
} claim;

static const claim claims[] = {
    {"midpoint", 2, 40},
    {"trapezoidal", 2, 40},
    {"galerkin:degree=1", 2, 40},
    {"galerkin:degree=2", 4, 20},
    {"galerkin:degree=3", 6, 16},
    {"galerkin:degree=4", 8, 6},
    {"galerkin:degree=2,quadrature=lobatto", 4, 20},
    {"galerkin:degree=3,quadrature=lobatto", 6, 16},
    {"galerkin:degree=2,basis=legendre", 4, 20},
    {"galerkin:degree=2,nodes=4", 4, 20},
    {"galerkin:degree=2,quadrature=lobatto,nodes=2", 2, 80},
    {"galerkin:degree=3,quadrature=lobatto,nodes=3", 4, 40},
    {"galerkin:degree=2,solver=kinsol", 4, 20},
    {"composition:order=4", 4, 40},
    {"composition:order=6", 6, 20},
    {"composition:order=6,base=midpoint", 6, 20},
    {"verlet", 2, 40},
    {"composition:order=4,base=verlet", 4, 40},
    {"composition:order=6,base=verlet", 6, 20},
    {"composition:order=8,base=verlet", 8, 12},
};
enum { CLAIMS = sizeof claims / sizeof *claims, LEVELS = 5 };

/* Integrates by IDA, on equations of index 2, which shares no solver with the methods. */
static void end_by_ida(const constrained *model, double *q)
{
  const dvi_reference_options tight = {.code = DVI_IDA, .relative_tolerance = 1e-12};
  double p[CONSTRAINED_N];
  memcpy(q, model->q, sizeof model->q);
  ck_assert_int_eq(dvi_system_momentum(model->system, 0, q, model->v, p), DVI_OK);
  ck_assert_msg(dvi_reference_solve(model->system, 0, model->span, q, p, &tight, NULL) == DVI_OK,
                "%s: %s", model->name, dvi_last_error());
}

/* Gives the end of the span, by digits, or by a high degree in short steps with IDA as its
 * witness. */
static void judge_constrained(constrained_kind kind, const constrained *model, double *q)
{
  double by_ida[CONSTRAINED_N];
  if (constrained_digits(kind, q)) return;
  dvi_integrator *fine = constrained_integrator(model, "galerkin:degree=6");
  advance(fine, model->span / 200, 200);
  memcpy(q, dvi_integrator_q(fine), (size_t)model->n * sizeof *q);
  end_by_ida(model, by_ida);
  ck_assert_msg(distance(model->n, q, by_ida) < 1e-8, "%s: IDA is %.1e away", model->name,
                distance(model->n, q, by_ida));
  dvi_integrator_destroy(&fine);
}

static double error_of(const constrained *model, const dvi_integrator *integrator, const double *q)
{
  double error = 0;
  for (int i = 0; i < model->n; i++)
    if (!isnan(q[i])) error = fmax(error, fabs(dvi_integrator_q(integrator)[i] - q[i]));
  return error;
}

static double error_at_end(const constrained *model, const char *method, int steps, const double *q)
{
  dvi_integrator *integrator = constrained_integrator(model, method);
  advance(integrator, model->span / steps, steps);
  const double error = error_of(model, integrator, q);
  dvi_integrator_destroy(&integrator);
  return error;
}

static void check_claim(constrained_kind kind, const claim *c)
{
  constrained model;
  double q[CONSTRAINED_N], error[LEVELS];
  make_constrained(kind, 0, &model);
  judge_constrained(kind, &model, q);
  const double floor = 1e-12, faster = kind == SLIDER_CRANK ? 2.1 : 0.3;
  const int factor = kind == SLIDER_CRANK ? 8 : 1; /* it turns five times, and is less resolved */
  int last = -1;
  for (int level = 0; level < LEVELS; level++) {
    error[level] = error_at_end(&model, c->method, factor * c->steps << level, q);
    if (error[level] > floor) last = level;
  }
  ck_assert_msg(last >= 1, "%s of %s: nothing to fit, the first error is %.1e", c->method,
                model.name, error[0]);
  const double slope = log2(error[last - 1] / error[last]);
  ck_assert_msg(
      slope > c->order - (last >= 2 ? 0.5 : 1.2) && slope < c->order + (last >= 2 ? faster : 4),
      "%s of %s: order %.2f, not %d, from the errors %.2e, %.2e, %.2e, %.2e, %.2e", c->method,
      model.name, slope, c->order, error[0], error[1], error[2], error[3], error[4]);
  destroy_constrained(&model);
}

/* Verlet's method needs a constant mass, and beside constraints no force of the velocity. */
static int takes(const char *method, constrained_kind kind)
{
  return strstr(method, "verlet") == NULL || (kind != DAMPED_PENDULUM && kind != CURVED_PENDULUM);
}

START_TEST(methods_have_their_order_with_constraints)
{
  for (int kind = 0; kind < CONSTRAINED_KINDS; kind++)
    if (takes(claims[_i].method, (constrained_kind)kind))
      check_claim((constrained_kind)kind, &claims[_i]);
}
END_TEST

START_TEST(ida_ends_where_the_digits_are)
{
  static const constrained_kind known[] = {SPHERICAL_PENDULUM, SLIDER_CRANK};
  for (int k = 0; k < 2; k++) {
    constrained model;
    double q[CONSTRAINED_N], digits[CONSTRAINED_N];
    make_constrained(known[k], 0, &model);
    ck_assert_int_eq(constrained_digits(known[k], digits), 1);
    end_by_ida(&model, q);
    for (int i = 0; i < model.n; i++)
      if (!isnan(digits[i]))
        ck_assert_msg(fabs(q[i] - digits[i]) < 1e-8, "%s: q[%d] is off by %.1e", model.name, i,
                      q[i] - digits[i]);
    destroy_constrained(&model);
  }
}
END_TEST

/* ---- what is kept ---- */

START_TEST(constraints_hold_to_rounding_and_the_energy_is_bounded)
{
  static const char *const methods[] = {"trapezoidal",
                                        "galerkin:degree=2",
                                        "galerkin:degree=4",
                                        "composition:order=4",
                                        "verlet",
                                        "composition:order=6,base=verlet"};
  static const double h[] = {0.01, 0.05, 0.1, 0.02, 0.01, 0.02},
                      bound[] = {1e-2, 1e-3, 1e-4, 1e-3, 1e-2, 1e-4};
  constrained model;
  make_constrained(SPHERICAL_PENDULUM, 0, &model);
  for (int m = 0; m < 6; m++) {
    dvi_integrator *integrator = constrained_integrator(&model, methods[m]);
    double first, energy, worst = 0, off = 0, turn = 0;
    const double *q = dvi_integrator_q(integrator), *p = dvi_integrator_p(integrator);
    const double J = q[0] * p[1] - q[1] * p[0];
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &first), DVI_OK);
    for (int k = 0; k < 5000; k++) {
      double distance;
      advance(integrator, h[m], 1);
      q = dvi_integrator_q(integrator), p = dvi_integrator_p(integrator);
      ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &energy), DVI_OK);
      ck_assert_int_eq(dvi_integrator_constraint(integrator, &distance), DVI_OK);
      worst = fmax(worst, fabs(energy - first));
      off = fmax(off, fmax(distance, fabs(q[0] * p[0] + q[1] * p[1] + q[2] * p[2]) / 10));
      turn = fmax(turn, fabs(q[0] * p[1] - q[1] * p[0] - J));
    }
    ck_assert_msg(off < 2e-15, "%s: the constraint is off by %.1e", methods[m], off);
    ck_assert_msg(turn < 1e-13, "%s: the angular momentum changes by %.1e", methods[m], turn);
    ck_assert_msg(worst < bound[m], "%s: the energy is off by %.1e", methods[m], worst);
    dvi_integrator_destroy(&integrator);
  }
  destroy_constrained(&model);
}
END_TEST

/* The form on T*{phi = 0}. Forces change areas. */
START_TEST(steps_are_symplectic_on_the_constraint)
{
  const char *method = claims[_i].method;
  for (int kind = 0; kind < CONSTRAINED_KINDS; kind++) {
    constrained model;
    double defect, p[CONSTRAINED_N];
    if (kind == DAMPED_PENDULUM || !takes(method, (constrained_kind)kind)) continue;
    make_constrained((constrained_kind)kind, 0, &model);
    dvi_integrator *integrator = constrained_integrator(&model, method);
    ck_assert_int_eq(dvi_system_momentum(model.system, 0, model.q, model.v, p), DVI_OK);
    ck_assert_msg(dvi_symplecticity(integrator, 0, model.q, p, 0.05, &defect) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_msg(defect < 1e-10, "%s of %s: %.1e", method, model.name, defect);
    dvi_integrator_destroy(&integrator);
    destroy_constrained(&model);
  }
}
END_TEST

START_TEST(friction_is_not_symplectic_on_the_constraint)
{
  constrained model;
  double defect, p[CONSTRAINED_N];
  make_constrained(DAMPED_PENDULUM, 0, &model);
  dvi_integrator *integrator = constrained_integrator(&model, "galerkin:degree=3");
  ck_assert_int_eq(dvi_system_momentum(model.system, 0, model.q, model.v, p), DVI_OK);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, model.q, p, 0.05, &defect), DVI_OK);
  ck_assert_double_ge(defect, 5e-3); /* areas shrink by exp(-0.2 h) */
  defect = 7;
  model.q[0] += 0.1;
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, model.q, p, 0.05, &defect), DVI_BAD_ARGUMENT);
  ck_assert(defect == 7);
  dvi_integrator_destroy(&integrator);
  destroy_constrained(&model);
}
END_TEST

START_TEST(steps_back_undo_steps)
{
  for (int kind = 0; kind < CONSTRAINED_KINDS; kind++) {
    constrained model;
    if (kind == DAMPED_PENDULUM) continue;
    make_constrained((constrained_kind)kind, 0, &model);
    dvi_integrator *integrator = constrained_integrator(&model, "galerkin:degree=2");
    advance(integrator, 0.01, 20);
    advance(integrator, -0.01, 20);
    ck_assert_double_lt(distance(model.n, dvi_integrator_q(integrator), model.q), 1e-12);
    dvi_integrator_destroy(&integrator);
    destroy_constrained(&model);
  }
}
END_TEST

START_TEST(differenced_hessians_give_nearly_the_same_steps)
{
  for (int kind = 0; kind < CONSTRAINED_KINDS; kind++) {
    constrained given, differenced;
    make_constrained((constrained_kind)kind, 0, &given);
    make_constrained((constrained_kind)kind, 1, &differenced);
    dvi_integrator *one = constrained_integrator(&given, "galerkin:degree=2"),
                   *other = constrained_integrator(&differenced, "galerkin:degree=2");
    advance(one, 0.01, 20);
    advance(other, 0.01, 20);
    ck_assert_double_lt(distance(given.n, dvi_integrator_q(one), dvi_integrator_q(other)), 1e-12);
    dvi_integrator_destroy(&one);
    dvi_integrator_destroy(&other);
    destroy_constrained(&given);
    destroy_constrained(&differenced);
  }
}
END_TEST

/* The trapezoid in L, and the straight line, make both the same method. */
START_TEST(verlet_takes_the_steps_of_trapezoidal)
{
  static const constrained_kind kinds[] = {SPHERICAL_PENDULUM, SWUNG_PENDULUM, SLIDER_CRANK};
  for (int k = 0; k < 3; k++) {
    constrained model;
    make_constrained(kinds[k], 0, &model);
    dvi_integrator *one = constrained_integrator(&model, "verlet"),
                   *other = constrained_integrator(&model, "trapezoidal");
    advance(one, 0.01, 50);
    advance(other, 0.01, 50);
    ck_assert_double_lt(distance(model.n, dvi_integrator_q(one), dvi_integrator_q(other)), 1e-12);
    ck_assert_double_lt(distance(model.n, dvi_integrator_p(one), dvi_integrator_p(other)), 1e-12);
    advance(one, -0.01, 50);
    ck_assert_double_lt(distance(model.n, dvi_integrator_q(one), model.q), 1e-12);
    dvi_integrator_destroy(&one);
    dvi_integrator_destroy(&other);
    destroy_constrained(&model);
  }
}
END_TEST

/* One gradient and one matrix of 6 x 6 a step, and a few values of phi. */
START_TEST(a_step_of_verlet_with_constraints_factors_one_matrix)
{
  enum { STEPS = 100 };
  constrained model;
  dvi_counters before, after;
  make_constrained(SLIDER_CRANK, 0, &model);
  dvi_integrator *integrator = constrained_integrator(&model, "verlet");
  advance(integrator, 1e-3, 1);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, 1e-3, STEPS);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.factorizations - before.factorizations, STEPS);
  ck_assert_int_eq(after.simplified - before.simplified, STEPS);
  ck_assert_int_eq(after.hessians - before.hessians, 0);
  ck_assert_int_eq(after.allocations - before.allocations, 0);
  ck_assert_int_le(after.residuals - before.residuals, 6 * STEPS);
  dvi_integrator_destroy(&integrator);
  destroy_constrained(&model);
}
END_TEST

/* A place that no multiplier reaches: the bob is thrown farther than the rod is long. */
START_TEST(a_step_of_verlet_beyond_the_constraint_leaves_the_state)
{
  constrained model;
  make_constrained(SPHERICAL_PENDULUM, 0, &model);
  dvi_integrator *integrator = constrained_integrator(&model, "verlet");
  ck_assert_int_gt(dvi_integrator_step(integrator, 5), 0);
  check_words("multipliers of the step do not settle");
  ck_assert_double_lt(distance(3, dvi_integrator_q(integrator), model.q), 0x1p-1000);
  ck_assert_double_eq(dvi_integrator_time(integrator), 0);
  advance(integrator, 0.01, 10);
  dvi_integrator_destroy(&integrator);
  destroy_constrained(&model);
}
END_TEST

START_TEST(verlet_refuses_friction_beside_constraints)
{
  constrained model;
  dvi_integrator *integrator = NULL;
  make_constrained(DAMPED_PENDULUM, 0, &model);
  ck_assert_int_eq(dvi_integrator_create(model.system, "verlet", &integrator), DVI_UNSUPPORTED);
  check_words("verlet: forces that depend on the velocity are not taken beside holonomic");
  ck_assert_ptr_null(integrator);
  destroy_constrained(&model);
}
END_TEST

/* ---- multipliers ---- */

/* The digits are those of two codes in quadruple precision, for phi = (|q|^2 - 1)/2. */
START_TEST(multipliers_are_those_of_the_equations_of_motion)
{
  constrained model;
  double lambda;
  make_constrained(SPHERICAL_PENDULUM, 0, &model);
  dvi_integrator *integrator = constrained_integrator(&model, "galerkin:degree=4");
  advance(integrator, 0.025, 80);
  ck_assert_int_eq(dvi_integrator_reactions(integrator, &lambda), DVI_OK);
  ck_assert_double_eq_tol(lambda, 12.83280305331, 1e-9);
  dvi_integrator_destroy(&integrator);
  destroy_constrained(&model);
}
END_TEST

/* ---- starts ---- */

START_TEST(starts_off_the_constraint_are_refused_or_projected)
{
  constrained model;
  make_constrained(SPHERICAL_PENDULUM, 0, &model);
  dvi_integrator *integrator = create_integrator(model.system, "galerkin");
  const double far[] = {1, 0.2, -0.4}, p[] = {0.1, 2, 0.3};
  double off;
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, far, p), DVI_BAD_ARGUMENT);
  check_words("constraint 'rod' is");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, model.q, p), DVI_BAD_ARGUMENT);
  check_words("its rate along the velocity");
  ck_assert_int_eq(
      dvi_integrator_start_with(integrator, 0, far, p, &(dvi_start_options){.project = 1}), DVI_OK);
  const double *q = dvi_integrator_q(integrator), *at = dvi_integrator_p(integrator);
  ck_assert_int_eq(dvi_integrator_constraint(integrator, &off), DVI_OK);
  ck_assert_double_lt(off, 1e-15);
  ck_assert_double_lt(fabs(q[0] * at[0] + q[1] * at[1] + q[2] * at[2]), 1e-15);
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(q[i], far[i] / sqrt(1.2), 1e-15);
  advance(integrator, 0.01, 10);
  dvi_integrator_destroy(&integrator);
  destroy_constrained(&model);
}
END_TEST

SUITE(order_holonomic)
{
  tcase_set_timeout(tests, 240);
  tcase_add_loop_test(tests, methods_have_their_order_with_constraints, 0, CLAIMS);
  tcase_add_test(tests, ida_ends_where_the_digits_are);
  tcase_add_test(tests, constraints_hold_to_rounding_and_the_energy_is_bounded);
  tcase_add_loop_test(tests, steps_are_symplectic_on_the_constraint, 0, CLAIMS);
  tcase_add_test(tests, friction_is_not_symplectic_on_the_constraint);
  tcase_add_test(tests, steps_back_undo_steps);
  tcase_add_test(tests, verlet_takes_the_steps_of_trapezoidal);
  tcase_add_test(tests, a_step_of_verlet_with_constraints_factors_one_matrix);
  tcase_add_test(tests, a_step_of_verlet_beyond_the_constraint_leaves_the_state);
  tcase_add_test(tests, verlet_refuses_friction_beside_constraints);
  tcase_add_test(tests, differenced_hessians_give_nearly_the_same_steps);
  tcase_add_test(tests, multipliers_are_those_of_the_equations_of_motion);
  tcase_add_test(tests, starts_off_the_constraint_are_refused_or_projected);
}
