/* labels: order */
/* Methods with forces without a potential: orders, balances, shapes of callbacks. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/suite.h"
#include "support/systems/forced.h"

/* ---- orders ---- */

typedef struct claim {
  const char *method;
  int order;
  int steps; /* of the longest step */
} claim;

static const claim claims[] = {
    {"verlet", 2, 40},
    {"midpoint", 2, 40},
    {"trapezoidal", 2, 40},
    {"galerkin:degree=1", 2, 40},
    {"galerkin:degree=2", 4, 20},
    {"galerkin:degree=3", 6, 10},
    {"galerkin:degree=4", 8, 5},
    {"galerkin:degree=2,quadrature=lobatto,nodes=2", 2, 80},
    {"galerkin:degree=3,quadrature=lobatto,nodes=3", 4, 40},
    {"galerkin:degree=2,quadrature=lobatto", 4, 20},
    {"galerkin:degree=2,quadrature=radau-right", 4, 20},
    {"galerkin:degree=2,solver=newton", 4, 20},
    {"galerkin:degree=2,solver=simplified", 4, 20},
    {"galerkin:degree=2,solver=kinsol", 4, 20},
    {"hp:degree=2", 4, 20},
    {"hp:degree=2", 4, 20},
    {"hp:type=2,degree=2", 3, 40},
    {"hamiltonian:degree=2,type=2", 4, 20},
    {"composition:order=4", 4, 40},
    {"composition:order=6", 6, 20},
    {"composition:order=4,base=galerkin,degree=1", 4, 20},
};
enum { CLAIMS = sizeof claims / sizeof *claims, LEVELS = 5 };

static void judge_forced(forced_kind kind, const forced *model, double *q, double *v)
{
  const dvi_reference_options tight = {.code = DVI_IDA, .relative_tolerance = 1e-13};
  double p[FORCED_N];
  if (forced_exact(kind, q, v)) return;
  memcpy(q, model->q, sizeof model->q);
  ck_assert_int_eq(dvi_system_momentum(model->system, 0, q, model->v, p), DVI_OK);
  ck_assert_msg(dvi_reference_solve(model->system, 0, model->span, q, p, &tight, NULL) == DVI_OK,
                "%s", dvi_last_error());
  memcpy(v, model->v, sizeof model->v);
  ck_assert_int_eq(dvi_system_velocity(model->system, model->span, q, p, v), DVI_OK);
}

static double error_at_end(const forced *model, const char *method, int steps, const double *q,
                           const double *v)
{
  dvi_integrator *integrator = forced_integrator(model, method);
  double error = 0, end[FORCED_N];
  for (int k = 0; k < steps; k++)
    ck_assert_msg(dvi_integrator_step(integrator, model->span / steps) == DVI_OK, "%s: %s",
                  model->name, dvi_last_error());
  memcpy(end, model->v, sizeof end);
  ck_assert_int_eq(dvi_system_velocity(model->system, model->span, dvi_integrator_q(integrator),
                                       dvi_integrator_p(integrator), end),
                   DVI_OK);
  for (int i = 0; i < model->n; i++)
    error = fmax(error, fmax(fabs(dvi_integrator_q(integrator)[i] - q[i]), fabs(end[i] - v[i])));
  dvi_integrator_destroy(&integrator);
  return error;
}

/* Requires the slope between the steps whose errors are above the floor, the best of which are the
 * shortest ones. */
static void check_claim(forced_kind kind, const claim *c)
{
  forced model;
  double q[FORCED_N], v[FORCED_N], error[LEVELS];
  make_forced(kind, FORCED_POINT, &model);
  judge_forced(kind, &model, q, v);
  const double floor = forced_exact(kind, error, error + 2) ? 3e-13 : 3e-10;
  int last = -1;
  for (int level = 0; level < LEVELS; level++) {
    error[level] = error_at_end(&model, c->method, c->steps << level, q, v);
    if (error[level] > floor) last = level;
  }
  ck_assert_msg(last >= 1, "%s of %s: nothing to fit, the first error is %.1e", c->method,
                model.name, error[0]);
  const double slope = log2(error[last - 1] / error[last]);
  ck_assert_msg(fabs(slope - c->order) < (last >= 2 ? 0.3 : 0.6),
                "%s of %s: order %.2f, not %d, from the errors %.2e, %.2e, %.2e, %.2e, %.2e",
                c->method, model.name, slope, c->order, error[0], error[1], error[2], error[3],
                error[4]);
  destroy_forced(&model);
}

static int takes(const claim *c, forced_kind kind)
{
  const int explicit_mass = strncmp(c->method, "verlet", 6) == 0 ||
                            (strncmp(c->method, "composition", 11) == 0 &&
                             strstr(c->method, "base") == NULL);
  return kind != CURVED_LINE || !explicit_mass;
}

START_TEST(methods_keep_their_order_with_forces)
{
  const claim *c = &claims[_i];
  for (int kind = 0; kind < FORCED_KINDS; kind++)
    if (takes(c, (forced_kind)kind)) check_claim((forced_kind)kind, c);
}
END_TEST

/* ---- balances ---- */

/* Gives the largest defects of the energy's and of the momentum's balance over the steps. */
static void largest_defects(const forced *model, const char *method, double h, int steps,
                            double *defect)
{
  dvi_integrator *integrator = forced_integrator(model, method);
  const int count = dvi_system_invariant_count(model->system);
  defect[0] = defect[1] = 0;
  for (int k = 0; k < steps; k++) {
    ck_assert_int_eq(dvi_integrator_step(integrator, h), DVI_OK);
    for (int i = 0; i < count; i++) {
      double now;
      ck_assert_int_eq(dvi_integrator_balance(integrator, i, &now), DVI_OK);
      defect[i] = fmax(defect[i], fabs(now));
    }
  }
  dvi_integrator_destroy(&integrator);
}

START_TEST(momenta_are_balanced_to_rounding)
{
  static const char *const methods[] = {"verlet", "midpoint", "galerkin:degree=3",
                                        "galerkin:degree=2,quadrature=lobatto",
                                        "composition:order=6"};
  forced model;
  double defect[2];
  make_forced(STIRRED_SPRING, FORCED_POINT, &model);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    largest_defects(&model, methods[m], 0.1, repeats(100000), defect);
    ck_assert_msg(defect[1] < 2e-13, "%s: momentum off by %.1e", methods[m], defect[1]);
  }
  destroy_forced(&model);
}
END_TEST

START_TEST(energies_that_are_quadratic_are_balanced_to_rounding)
{
  forced model;
  double defect[2];
  make_forced(DRIVEN_OSCILLATOR, FORCED_POINT, &model);
  for (int degree = 1; degree <= 5; degree++) {
    char method[32];
    (void)snprintf(method, sizeof method, "galerkin:degree=%d", degree);
    largest_defects(&model, method, 0.2, repeats(100000), defect);
    ck_assert_msg(defect[0] < 1e-13, "%s: energy off by %.1e", method, defect[0]);
  }
  destroy_forced(&model);
}
END_TEST

/* The defect has the method's order. Over ten times as long it grows by no more than ten times. */
START_TEST(other_energies_have_a_defect_of_the_methods_order)
{
  static const claim of[] = {
      {"verlet", 2, 0}, {"galerkin:degree=2", 4, 0}, {"verlet", 2, 0}, {"galerkin:degree=3", 6, 0}};
  forced model;
  make_forced(DRAGGED_PENDULUM, FORCED_POINT, &model);
  for (size_t m = 0; m < sizeof of / sizeof *of; m++) {
    double long_steps[2], short_steps[2], long_run[2];
    largest_defects(&model, of[m].method, 0.2, 500, long_steps);
    largest_defects(&model, of[m].method, 0.1, 1000, short_steps);
    largest_defects(&model, of[m].method, 0.1, 10000, long_run);
    const double slope = log2(long_steps[0] / short_steps[0]);
    ck_assert_msg(fabs(slope - of[m].order) < 0.3, "%s: slope %.2f", of[m].method, slope);
    ck_assert_msg(long_run[0] < 12 * short_steps[0], "%s: %.2e grows to %.2e", of[m].method,
                  short_steps[0], long_run[0]);
  }
  destroy_forced(&model);
}
END_TEST

/* ---- shapes of callbacks ---- */

/* Gives q and p after some steps. */
static void state_after(forced_kind kind, forced_form form, const char *method, double *state)
{
  forced model;
  make_forced(kind, form, &model);
  dvi_integrator *integrator = forced_integrator(&model, method);
  for (int k = 0; k < 20; k++) ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_OK);
  for (int i = 0; i < model.n; i++) {
    state[i] = dvi_integrator_q(integrator)[i];
    state[FORCED_N + i] = dvi_integrator_p(integrator)[i];
  }
  dvi_integrator_destroy(&integrator);
  destroy_forced(&model);
}

START_TEST(shapes_of_callbacks_give_the_same_steps)
{
  static const char *const methods[] = {"verlet", "galerkin:degree=3"};
  for (int kind = 0; kind < FORCED_KINDS; kind++)
    for (int m = kind == CURVED_LINE; m < 2; m++) {
      double point[2 * FORCED_N] = {0}, batch[2 * FORCED_N] = {0}, differenced[2 * FORCED_N] = {0};
      state_after((forced_kind)kind, FORCED_POINT, methods[m], point);
      state_after((forced_kind)kind, FORCED_BATCH, methods[m], batch);
      state_after((forced_kind)kind, FORCED_DIFFERENCED, methods[m], differenced);
      ck_assert_mem_eq(point, batch, sizeof point);
      for (int i = 0; i < 2 * FORCED_N; i++)
        ck_assert_double_eq_tol(point[i], differenced[i], 1e-13);
    }
}
END_TEST

/* ---- reversal, checkpoints ---- */

/* A step back by a symmetric method undoes a step, for the equations of motion run backward. */
START_TEST(steps_back_undo_steps)
{
  static const char *const methods[] = {"verlet", "galerkin:degree=3", "composition:order=6"};
  forced model;
  make_forced(DRAGGED_PENDULUM, FORCED_POINT, &model);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_integrator *integrator = forced_integrator(&model, methods[m]);
    for (int k = 0; k < 30; k++) ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_OK);
    for (int k = 0; k < 30; k++) ck_assert_int_eq(dvi_integrator_step(integrator, -0.1), DVI_OK);
    ck_assert_double_eq_tol(*dvi_integrator_q(integrator), model.q[0], 2e-9);
    ck_assert_double_eq_tol(dvi_integrator_supplied(integrator, 0), 0, 1e-9);
    dvi_integrator_destroy(&integrator);
  }
  destroy_forced(&model);
}
END_TEST

SUITE(order_forces)
{
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, methods_keep_their_order_with_forces, 0, CLAIMS);
  tcase_add_test(tests, momenta_are_balanced_to_rounding);
  tcase_add_test(tests, energies_that_are_quadratic_are_balanced_to_rounding);
  tcase_add_test(tests, other_energies_have_a_defect_of_the_methods_order);
  tcase_add_test(tests, shapes_of_callbacks_give_the_same_steps);
  tcase_add_test(tests, steps_back_undo_steps);
}
