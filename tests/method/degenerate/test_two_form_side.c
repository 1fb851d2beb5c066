/* A trajectory ends where the two-form becomes singular. A step across such a point would continue
 * with a curve that is no trajectory. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

/* alpha = (y, max(0,x-200)^2), H = y^2/2. The two-form 2 max(0,x-200) - 1 is 0 at x = 200.5, where
 * x' = y/(1 - 2 max(0,x-200)) has no bound. */
static const double end_of_bend = 200.5;

static double beyond(double x)
{
  return fmax(0, x - 200);
}

static int bend(const double *q, double *alpha, void *user)
{
  (void)user;
  alpha[0] = q[1];
  alpha[1] = beyond(q[0]) * beyond(q[0]);
  return 0;
}

static int bend_gradient(const double *q, double *alpha_q, void *user)
{
  (void)user;
  const double values[4] = {0, 1, 2 * beyond(q[0]), 0};
  memcpy(alpha_q, values, sizeof values);
  return 0;
}

static int bend_energy(double t, const double *q, double *H, void *user)
{
  (void)t, (void)user;
  *H = 0.5 * q[1] * q[1];
  return 0;
}

static int bend_force(double t, const double *q, double *H_q, void *user)
{
  (void)t, (void)user;
  H_q[0] = 0;
  H_q[1] = q[1];
  return 0;
}

/* alpha = (y - y^3/3, 0), H = x + y^2/2. alpha falls as -t, and the two-form y^2 - 1 is 0 at y =
 * -1. */
static const double end_of_fold = -1;

static int fold(const double *q, double *alpha, void *user)
{
  (void)user;
  alpha[0] = q[1] - q[1] * q[1] * q[1] / 3;
  alpha[1] = 0;
  return 0;
}

static int fold_gradient(const double *q, double *alpha_q, void *user)
{
  (void)user;
  const double values[4] = {0, 1 - q[1] * q[1], 0, 0};
  memcpy(alpha_q, values, sizeof values);
  return 0;
}

static int fold_energy(double t, const double *q, double *H, void *user)
{
  (void)t, (void)user;
  *H = q[0] + 0.5 * q[1] * q[1];
  return 0;
}

static int fold_force(double t, const double *q, double *H_q, void *user)
{
  (void)t, (void)user;
  H_q[0] = 1;
  H_q[1] = q[1];
  return 0;
}

static dvi_system *create_form_system(const dvi_one_form *form, const dvi_potential *H)
{
  const dvi_system_terms terms = {
      .dimension = 2, .one_form = form, .potentials = H, .potential_count = 1, .autonomous = 1};
  dvi_system *system;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static dvi_system *create_bend(void)
{
  return create_form_system(&(dvi_one_form){.value = bend, .gradient = bend_gradient},
                            &(dvi_potential){.value = bend_energy, .gradient = bend_force});
}

static dvi_system *create_fold(void)
{
  return create_form_system(&(dvi_one_form){.value = fold, .gradient = fold_gradient},
                            &(dvi_potential){.value = fold_energy, .gradient = fold_force});
}

/* Takes steps until one fails, at most so many. The state is then the one before that step. */
static dvi_status run(dvi_integrator *integrator, const double *start, double h, int most)
{
  double p[2], v[2] = {0, 0}, q[2];
  dvi_status status = DVI_OK;
  ck_assert_int_eq(dvi_system_momentum(dvi_integrator_system(integrator), 0, start, v, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, start, p), DVI_OK);
  for (int k = 0; k < most && status == DVI_OK; k++) {
    memcpy(q, dvi_integrator_q(integrator), sizeof q);
    status = dvi_integrator_step(integrator, h);
  }
  if (status != DVI_OK) ck_assert_mem_eq(q, dvi_integrator_q(integrator), sizeof q);
  return status;
}

static const char *const general[] = {
    "dg",           "dg:degree=0", "dg:degree=1,stiffness=1",  "dg:flux=path",        "dg-phase",
    "vprk:nodes=1", "vprk",        "vprk:projection=midpoint", "vprk:projection=post"};

static const char *const one_step[] = {"dvrk:nodes=1", "dvrk",         "dvrk:nodes=3",   "dvi-a",
                                       "dvi-b",        "dvi-midpoint", "dvi-trapezoidal"};

/* Unwatched, dg:degree=1,stiffness=1 goes over it at several of these lengths. Whatever fails, the
 * sentence tells of the singular point. */
START_TEST(no_step_leads_over_a_singular_two_form)
{
  static const double start[2] = {199.9, 1};
  dvi_system *system = create_bend();
  for (double h = 0.4; h > 0.005; h /= is_short_run() ? 1.728 : 1.2) {
    dvi_integrator *integrator = create_integrator(system, general[_i]);
    const dvi_status status = run(integrator, start, h, 200);
    ck_assert_msg(status > 0, "%s h=%g: %d at x = %.17g", general[_i], h, status,
                  dvi_integrator_q(integrator)[0]);
    ck_assert_double_lt(dvi_integrator_q(integrator)[0], end_of_bend);
    if (_i != 2) check_words("singular"); /* that one is far off the motion by then */
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(nor_does_one_of_a_one_step_method)
{
  static const double start[2] = {0.3, -0.1};
  dvi_system *system = create_fold();
  for (double h = 0.4; h > 0.005; h /= is_short_run() ? 1.728 : 1.2) {
    dvi_integrator *integrator = create_integrator(system, one_step[_i]);
    const dvi_status status = run(integrator, start, h, 200);
    ck_assert_msg(status > 0, "%s h=%g: %d at y = %.17g", one_step[_i], h, status,
                  dvi_integrator_q(integrator)[1]);
    ck_assert_double_gt(dvi_integrator_q(integrator)[1], end_of_fold);
    check_words("singular");
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

/* The two-form at a start on the other side is as good as one on this side. */
START_TEST(both_sides_can_be_started_on)
{
  static const double here[2] = {199.9, 1}, there[2] = {201, 1};
  dvi_system *system = create_bend();
  dvi_integrator *integrator = create_integrator(system, "dg");
  ck_assert_int_eq(run(integrator, here, 0.03, 3), DVI_OK);
  ck_assert_int_eq(run(integrator, there, -0.03, 3), DVI_OK);
  ck_assert_int_eq(run(integrator, here, 0.03, 3), DVI_OK);
  ck_assert_int_gt(run(integrator, here, 0.2, 100), 0);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(two_form_side)
{
  tcase_add_loop_test(tests, no_step_leads_over_a_singular_two_form, 0,
                      sizeof general / sizeof *general);
  tcase_add_loop_test(tests, nor_does_one_of_a_one_step_method, 0,
                      sizeof one_step / sizeof *one_step);
  tcase_add_test(tests, both_sides_can_be_started_on);
}
