/* labels: unit */
/* Members of systems with factors drift side by side, each with the bits of a run alone. */
#include <math.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/mixed_factors.h"

enum { MEMBERS = 21, BLOCK = 8 };

/* ---- systems ---- */

/* LOOSE has a direction, an angle and a motion whose centre of mass is not its origin. */
enum { LOOSE_KIND, LINES_KIND, BODY_KIND, FREE_KIND, KINDS };

static void make_kind(int kind, body *model)
{
  if (kind < BODY_KIND)
    make_mixed_factors(kind == LOOSE_KIND ? LOOSE : LINES, model);
  else
    make_body(kind == BODY_KIND ? PENDULUM_3D : FREE_BODY, model);
}

/* A direction with a weight, whose gradient fails, or is not a number, beyond a limit of q1. */
typedef struct limits {
  double retry_above, fail_above, nan_above;
} limits;

static int weight_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = q[2];
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  const limits *own = user;
  (void)t;
  V_q[0] = V_q[1] = 0;
  V_q[2] = q[0] > own->nan_above ? (double)NAN : 1;
  return q[0] > own->fail_above ? -1 : q[0] > own->retry_above;
}

static void make_limited(limits *own, body *model)
{
  static const dvi_factor direction = {.kind = DVI_S2, .mass = 1};
  const dvi_potential weight = {.value = weight_value, .gradient = weight_gradient, .user = own};
  const dvi_system_terms terms = {.factors = &direction,
                                  .factor_count = 1,
                                  .potentials = &weight,
                                  .potential_count = 1,
                                  .autonomous = 1};
  *model = (body){.nq = 3, .nv = 3, .q = {0, 0, -1}, .v = {0.5, 0, 0}};
  ck_assert_msg(dvi_system_create(&terms, &model->system) == DVI_OK, "%s", dvi_last_error());
}

/* ---- members and their twins ---- */

/* Lengths of steps change on the way, and the last ones go back. The longest turn some members too
 * far, which go on alone. */
static const double lengths[] = {.05, .05, .05, .1, .1, -.02, .2, .3, 1, 1.5, .05, .05};
enum { STEPS = sizeof lengths / sizeof *lengths };

static double v[BODY_V * MEMBERS];

/* Starts the members with velocities of their own. */
static void start_members(dvi_ensemble *e, const body *model)
{
  double q[BODY_Q * MEMBERS];
  for (int k = 0; k < MEMBERS; k++) {
    for (int i = 0; i < model->nq; i++) q[i * MEMBERS + k] = model->q[i];
    for (int i = 0; i < model->nv; i++)
      v[i * MEMBERS + k] = model->v[i] * 0.08 * (1 + 8 * k % MEMBERS);
  }
  ck_assert_msg(dvi_ensemble_start_velocity(e, 0, q, v) == DVI_OK, "%s", dvi_last_error());
}

/* Returns the gradients that the run alone takes. */
static long same_as_alone(dvi_ensemble *e, const body *model, const char *method, int k)
{
  double t[MEMBERS], q[BODY_Q * MEMBERS], p[BODY_V * MEMBERS], start[BODY_V];
  dvi_counters counters;
  dvi_integrator *alone = create_integrator(model->system, method);
  for (int i = 0; i < model->nv; i++) start[i] = v[i * MEMBERS + k];
  dvi_status status = dvi_integrator_start_velocity(alone, 0, model->q, start);
  for (int i = 0; i < STEPS; i++) status = dvi_integrator_step(alone, lengths[i]);
  ck_assert_int_eq(dvi_ensemble_status(e, k), status);
  ck_assert_int_eq(dvi_ensemble_state(e, t, q, p), DVI_OK);
  for (int i = 0; i < model->nq; i++)
    ck_assert_mem_eq(&q[i * MEMBERS + k], dvi_integrator_q(alone) + i, sizeof(double));
  for (int i = 0; i < model->nv; i++)
    ck_assert_mem_eq(&p[i * MEMBERS + k], dvi_integrator_p(alone) + i, sizeof(double));
  ck_assert_double_eq(t[k], dvi_integrator_time(alone));
  dvi_integrator_counters(alone, &counters);
  dvi_integrator_destroy(&alone);
  return counters.gradients;
}

static int goes_side_by_side(const dvi_ensemble *e)
{
  char text[4096];
  (void)dvi_ensemble_explain(e, text, sizeof text);
  return strstr(text, "side by side as lanes") != NULL;
}

/* Returns how many steps fail. */
static long compare(const body *model, const char *method, int threads)
{
  dvi_counters counters;
  dvi_ensemble *e = create_ensemble(
      model->system, method,
      (dvi_ensemble_options){.members = MEMBERS, .threads = threads, .block = BLOCK});
  ck_assert(goes_side_by_side(e));
  start_members(e, model);
  for (int i = 0; i < STEPS; i++) (void)dvi_ensemble_step(e, lengths[i]);
  long gradients = 0;
  for (int k = 0; k < MEMBERS; k++) gradients += same_as_alone(e, model, method, k);
  dvi_ensemble_counters(e, &counters);
  ck_assert_int_eq(counters.gradients, gradients);
  dvi_ensemble_destroy(&e);
  return counters.failed_steps;
}

static void use_best_level(void)
{
  dvi__lanes_choose(-1);
}

static const char *const methods[] = {"lie-verlet", "composition:order=4,base=lie-verlet"};

START_TEST(members_have_the_bits_of_runs_alone)
{
  body model;
  make_kind(_i / 2, &model);
  const long failed = compare(&model, methods[_i % 2], 1 + _i % 4);
  ck_assert_msg((failed > 0 || _i % 2 == 1) && failed < MEMBERS * STEPS / 3, "%ld", failed);
  destroy_body(&model);
}
END_TEST

START_TEST(every_level_gives_these_bits)
{
  body model;
  make_kind(_i % KINDS, &model);
  dvi__lanes_choose(_i / KINDS);
  (void)compare(&model, "lie-verlet", 1);
  destroy_body(&model);
}
END_TEST

/* Some members swing until their callbacks ask for a smaller step, fail, or give NaN. They fail as
 * they fail alone, and no other member sees them. */
START_TEST(members_that_fail_are_no_one_elses_matter)
{
  const double never = 1e300, limit = .45;
  limits own = {never, never, never};
  body model;
  *(_i == 0 ? &own.retry_above : _i == 1 ? &own.fail_above : &own.nan_above) = limit;
  make_limited(&own, &model);
  const long failed = compare(&model, "lie-verlet", 1 + _i);
  ck_assert_msg(failed > 0 && failed < MEMBERS * STEPS / 4, "%ld", failed);
  destroy_body(&model);
}
END_TEST

START_TEST(a_step_takes_one_gradient_and_no_memory)
{
  dvi_counters before, after;
  body model;
  make_kind(LOOSE_KIND, &model);
  dvi_ensemble *e = create_ensemble(model.system, "lie-verlet",
                                    (dvi_ensemble_options){.members = MEMBERS});
  start_members(e, &model);
  ck_assert_int_eq(dvi_ensemble_advance(e, .01, 2), DVI_OK);
  dvi_ensemble_counters(e, &before);
  ck_assert_int_eq(dvi_ensemble_advance(e, .01, 10), DVI_OK);
  dvi_ensemble_counters(e, &after);
  ck_assert_int_eq(after.gradients - before.gradients, 10 * MEMBERS);
  ck_assert_int_eq(after.allocations, before.allocations);
  dvi_ensemble_destroy(&e);
  destroy_body(&model);
}
END_TEST

/* Slots that the mass couples share Newton's iteration, and the exponential map has series. */
START_TEST(other_drifts_go_one_by_one)
{
  body model;
  if (_i == 0)
    make_mixed_factors(WEDGED, &model);
  else
    make_body(PENDULUM_3D, &model);
  dvi_ensemble *e = create_ensemble(model.system, _i == 0 ? "lie-verlet" : "lie-verlet:solve=exp",
                                    (dvi_ensemble_options){.members = MEMBERS});
  ck_assert(!goes_side_by_side(e));
  dvi_ensemble_destroy(&e);
  destroy_body(&model);
}
END_TEST

SUITE(ensemble_lie)
{
  tcase_add_checked_fixture(tests, NULL, use_best_level);
  tcase_add_loop_test(tests, members_have_the_bits_of_runs_alone, 0, 2 * KINDS);
  tcase_add_loop_test(tests, every_level_gives_these_bits, 0, KINDS * dvi__lanes_levels());
  tcase_add_loop_test(tests, members_that_fail_are_no_one_elses_matter, 0, 3);
  tcase_add_test(tests, a_step_takes_one_gradient_and_no_memory);
  tcase_add_loop_test(tests, other_drifts_go_one_by_one, 0, 2);
}
