/* labels: unit */
/* Members that step in charts go side by side, each with the bits and the counts of a run alone. */
#include <math.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/mixed_factors.h"
#include "integrator/ensemble/twins.h"

/* LOOSE has a factor of each kind. The mass joins COUPLED, two directions, and PRODUCT, which has
 * all kinds. */
enum { LOOSE_KIND, LINES_KIND, BODY_KIND, FREE_KIND, COUPLED_KIND, PRODUCT_KIND, KINDS };

static void make_kind(int kind, body *model)
{
  static const body_kind bodies[] = {[BODY_KIND] = PENDULUM_3D,
                                     [FREE_KIND] = FREE_BODY,
                                     [COUPLED_KIND] = DIRECTIONS,
                                     [PRODUCT_KIND] = PRODUCT};
  if (kind < BODY_KIND)
    make_mixed_factors(kind == LOOSE_KIND ? LOOSE : LINES, model);
  else
    make_body(bodies[kind], model);
}

/* Steps of one length with blocks that are kept and made anew, another length, and steps back. The
 * step of a path in doubt is taken alone. */
static const double lengths[] = {.05, .05, .05, .05, .05, .05, .05, .1, .1, .1, -.1, -.1},
                    fast[] = {.005, .005, .005, .005, .005, .005, .005, .01, .01, .01, -.01, -.01},
                    halting[] = {.1, .1, .1, .1, .1, .1, .1, .1, .1, .1, .1, .1},
                    far[] = {.05, .05, .05, .5, .5, .5, 4, 4, 4, .05, .05, .05};
enum { STEPS = sizeof lengths / sizeof *lengths };

static twins twins_of(const body *model, const char *method, const double *length)
{
  return (twins){.system = model->system,
                 .method = method,
                 .nq = model->nq,
                 .nv = model->nv,
                 .q = model->q,
                 .v = model->v,
                 .steps = STEPS,
                 .length = length};
}

static long compare(int kind, const char *method, int threads)
{
  body model;
  make_kind(kind, &model);
  const twins all = twins_of(&model, method, kind == COUPLED_KIND ? fast : lengths);
  const long failed = compare_members(&all, threads);
  destroy_body(&model);
  return failed;
}

static void use_best_level(void)
{
  dvi__lanes_choose(-1);
}

static const char *const methods[] = {"lie-galerkin", "lie-galerkin:degree=3,quadrature=lobatto"};
enum { METHODS = sizeof methods / sizeof *methods };

START_TEST(members_have_the_bits_of_runs_alone)
{
  ck_assert_int_eq(compare(_i / METHODS, methods[_i % METHODS], 1 + _i % 4), 0);
}
END_TEST

START_TEST(every_level_gives_these_bits)
{
  static const int kinds[] = {LINES_KIND, BODY_KIND, COUPLED_KIND};
  dvi__lanes_choose(_i / 3);
  ck_assert_int_eq(compare(kinds[_i % 3], "lie-galerkin", 1), 0);
}
END_TEST

/* Steps that turn some members beyond the charts fail for those alone. */
START_TEST(members_that_turn_too_far_fail_alone)
{
  body model;
  make_body(FREE_BODY, &model);
  const twins all = twins_of(&model, "lie-galerkin", far);
  const long failed = compare_members(&all, 2);
  ck_assert_msg(failed > 0 && failed < 3 * MEMBERS, "%ld", failed);
  destroy_body(&model);
}
END_TEST

/* A direction with a weight, whose gradient fails, or is not a number, beyond a limit of q1. */
typedef struct limits {
  double retry_above, fail_above, nan_above, weight;
} limits;

static int weight_value(double t, const double *q, double *V, void *user)
{
  (void)t;
  *V = ((const limits *)user)->weight * q[2];
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  const limits *own = user;
  (void)t;
  V_q[0] = V_q[1] = 0;
  V_q[2] = q[0] > own->nan_above ? (double)NAN : own->weight;
  return q[0] > own->fail_above ? -1 : q[0] > own->retry_above;
}

static int weight_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)user;
  memset(V_qq, 0, 9 * sizeof *V_qq);
  return 0;
}

static void make_limited(limits *own, body *model)
{
  static const dvi_factor direction = {.kind = DVI_S2, .mass = 1};
  const dvi_potential weight = {
      .value = weight_value, .gradient = weight_gradient, .hessian = weight_hessian, .user = own};
  const dvi_system_terms terms = {
      .factors = &direction, .factor_count = 1, .potentials = &weight, .potential_count = 1};
  *model = (body){.q = {0, 0, -1}, .v = {0.5, 0, 0}};
  ck_assert_msg(dvi_system_create(&terms, &model->system) == DVI_OK, "%s", dvi_last_error());
  model->nq = dvi_system_nq(model->system);
  model->nv = dvi_system_nv(model->system);
}

/* Some members swing until their callbacks ask for a smaller step, fail, or give NaN. They fail as
 * they fail alone, and no other member sees them. */
START_TEST(members_that_fail_are_no_one_elses_matter)
{
  const double never = 1e300, limit = .45;
  limits own = {never, never, never, 1};
  body model;
  *(_i == 0 ? &own.retry_above : _i == 1 ? &own.fail_above : &own.nan_above) = limit;
  make_limited(&own, &model);
  const twins all = twins_of(&model, "lie-galerkin", halting);
  const long failed = compare_members(&all, 1 + _i);
  ck_assert_msg(failed > 0 && failed < MEMBERS * STEPS / 2, "%ld", failed);
  destroy_body(&model);
}
END_TEST

/* Members of two systems, half of them each, whose weights differ. */
START_TEST(each_member_has_its_own_system)
{
  enum { HALF = 8, BOTH = 2 * HALF, TAKEN = 12 };
  const double never = 1e300;
  limits own[] = {{never, never, never, 1}, {never, never, never, 2}};
  const dvi_system *systems[BOTH];
  double q[3 * BOTH], v[3 * BOTH];
  body models[2];
  for (int s = 0; s < 2; s++) make_limited(&own[s], &models[s]);
  for (int k = 0; k < BOTH; k++) {
    systems[k] = models[k / HALF].system;
    for (int i = 0; i < 3; i++) q[i * BOTH + k] = models[0].q[i];
    for (int i = 0; i < 3; i++) v[i * BOTH + k] = speed_of(k) * models[0].v[i];
  }
  dvi_ensemble *e = create_ensemble(
      NULL, "lie-galerkin",
      (dvi_ensemble_options){.members = BOTH, .systems = systems, .threads = 1 + _i});
  ck_assert(goes_side_by_side(e));
  ck_assert_int_eq(dvi_ensemble_start_velocity(e, 0, q, v), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(e, .05, TAKEN), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(e, NULL, q, v), DVI_OK);
  for (int k = 0; k < BOTH; k++) {
    dvi_integrator *alone = create_integrator(systems[k], "lie-galerkin");
    double start[3];
    for (int i = 0; i < 3; i++) start[i] = speed_of(k) * models[0].v[i];
    ck_assert_int_eq(dvi_integrator_start_velocity(alone, 0, models[0].q, start), DVI_OK);
    for (int i = 0; i < TAKEN; i++) ck_assert_int_eq(dvi_integrator_step(alone, .05), DVI_OK);
    for (int i = 0; i < 3; i++)
      ck_assert_mem_eq(&q[i * BOTH + k], dvi_integrator_q(alone) + i, sizeof(double));
    dvi_integrator_destroy(&alone);
  }
  dvi_ensemble_destroy(&e);
  for (int s = 0; s < 2; s++) destroy_body(&models[s]);
}
END_TEST

/* sum += sign some */
static void add(int sign, const dvi_counters *some, dvi_counters *sum)
{
  const long *from = (const long *)(const void *)some;
  long *to = (long *)(void *)sum;
  for (size_t i = 0; i < sizeof *sum / sizeof(long); i++) to[i] += sign * from[i];
}

enum { COUNTED = 16 };

/* Adds what steps 2 to COUNTED of member k count alone. */
static void count_alone(const twins *all, int k, double h, dvi_counters *sum)
{
  double start[NUMBERS];
  dvi_counters counters;
  dvi_integrator *alone = create_integrator(all->system, all->method);
  for (int i = 0; i < all->nv; i++) start[i] = speed_of(k) * all->v[i];
  ck_assert_int_eq(dvi_integrator_start_velocity(alone, 0, all->q, start), DVI_OK);
  for (int i = 0; i < COUNTED; i++) {
    ck_assert_int_eq(dvi_integrator_step(alone, h), DVI_OK);
    dvi_integrator_counters(alone, &counters);
    if (i == 0) add(-1, &counters, sum);
  }
  add(1, &counters, sum);
  dvi_integrator_destroy(&alone);
}

/* Members side by side count what they count alone, and allocate nothing. */
START_TEST(steps_count_what_they_count_alone)
{
  dvi_counters before, after, wanted = {0};
  body model;
  make_kind(_i, &model);
  const twins all = twins_of(&model, "lie-galerkin", NULL);
  const double h = _i == COUPLED_KIND ? .001 : .01;
  dvi_ensemble *e = create_ensemble(model.system, all.method,
                                    (dvi_ensemble_options){.members = MEMBERS});
  start_members(e, &all);
  ck_assert_int_eq(dvi_ensemble_advance(e, h, 1), DVI_OK);
  dvi_ensemble_counters(e, &before);
  ck_assert_int_eq(dvi_ensemble_advance(e, h, COUNTED - 1), DVI_OK);
  dvi_ensemble_counters(e, &after);
  add(-1, &before, &after);
  for (int k = 0; k < MEMBERS; k++) count_alone(&all, k, h, &wanted);
  ck_assert_int_eq(wanted.simplified, (COUNTED - 1) * MEMBERS);
  ck_assert_mem_eq(&after, &wanted, sizeof after);
  dvi_ensemble_destroy(&e);
  destroy_body(&model);
}
END_TEST

/* Other solvers go one by one, and so do members that fill no vector. */
START_TEST(other_steps_go_one_by_one)
{
  static const char *const others[] = {"lie-galerkin:solver=newton",
                                       "lie-galerkin:solver=certified", "euler-poincare",
                                       "lie-galerkin"};
  body model;
  make_body(FREE_BODY, &model);
  dvi_ensemble *e = create_ensemble(model.system, others[_i],
                                    (dvi_ensemble_options){.members = _i < 3 ? MEMBERS : 3});
  ck_assert(!goes_side_by_side(e));
  dvi_ensemble_destroy(&e);
  destroy_body(&model);
}
END_TEST

SUITE(ensemble_charts)
{
  tcase_add_checked_fixture(tests, NULL, use_best_level);
  tcase_add_loop_test(tests, members_have_the_bits_of_runs_alone, 0, KINDS * METHODS);
  tcase_add_loop_test(tests, every_level_gives_these_bits, 0, 3 * dvi__lanes_levels());
  tcase_add_test(tests, members_that_turn_too_far_fail_alone);
  tcase_add_loop_test(tests, members_that_fail_are_no_one_elses_matter, 0, 3);
  tcase_add_loop_test(tests, each_member_has_its_own_system, 0, 2);
  tcase_add_loop_test(tests, steps_count_what_they_count_alone, LINES_KIND, KINDS);
  tcase_add_loop_test(tests, other_steps_go_one_by_one, 0, 4);
}
