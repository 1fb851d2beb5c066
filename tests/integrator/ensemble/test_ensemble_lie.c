/* labels: unit */
/* Members of systems with factors drift side by side, each with the bits of a run alone. */
#include <math.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/mixed_factors.h"
#include "integrator/ensemble/twins.h"

/* ---- systems ---- */

/* LOOSE has a direction, an angle and a motion whose centre of mass is not its origin. STIRRED has
 * a direction and a body with forces alone. */
enum { LOOSE_KIND, LINES_KIND, BODY_KIND, FREE_KIND, STIRRED_KIND, KINDS };

static int stir(double t, const double *q, const double *v, double *F, void *user)
{
  const int nv = *(const int *)user;
  (void)v;
  for (int i = 0; i < nv; i++) F[i] = .2 * sin(3 * t + i) + .1 * q[i];
  return 0;
}

static int nv_of_direction = 3, nv_of_both = 6;
static const dvi_force stirs_direction = {.name = "stir",
                                          .value = stir,
                                          .without_velocity = 1,
                                          .user = &nv_of_direction},
                       stirs_both = {.name = "stir",
                                     .value = stir,
                                     .without_velocity = 1,
                                     .user = &nv_of_both};

static void create_system(const dvi_system_terms *terms, body *model)
{
  ck_assert_msg(dvi_system_create(terms, &model->system) == DVI_OK, "%s", dvi_last_error());
  model->nq = dvi_system_nq(model->system);
  model->nv = dvi_system_nv(model->system);
}

static void make_stirred(body *model)
{
  static const double inertia[] = {1.3, .1, 0, .1, 1.1, .05, 0, .05, .9};
  static const dvi_factor both[] = {{.kind = DVI_S2, .mass = 1},
                                    {.kind = DVI_SO3, .inertia = inertia}};
  *model = (body){.q = {0, 0, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1}, .v = {.5, .2, 0, .3, -.4, .8}};
  create_system(
      &(dvi_system_terms){
          .factors = both, .factor_count = 2, .forces = &stirs_both, .force_count = 1},
      model);
}

static void make_kind(int kind, body *model)
{
  if (kind < BODY_KIND)
    make_mixed_factors(kind == LOOSE_KIND ? LOOSE : LINES, model);
  else if (kind == STIRRED_KIND)
    make_stirred(model);
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
                                  .forces = &stirs_direction,
                                  .force_count = 1};
  *model = (body){.q = {0, 0, -1}, .v = {0.5, 0, 0}};
  create_system(&terms, model);
}

/* ---- members and their twins ---- */

/* Lengths of steps change on the way, and one goes back. The longest turn some members too far,
 * which go on alone. */
static const double lengths[] = {.05, .05, .05, .1, .1, -.02, .2, .3, 1, 1.5, .05, .05};
enum { STEPS = sizeof lengths / sizeof *lengths };

static twins twins_of(const body *model, const char *method)
{
  return (twins){.system = model->system,
                 .method = method,
                 .nq = model->nq,
                 .nv = model->nv,
                 .q = model->q,
                 .v = model->v,
                 .steps = STEPS,
                 .length = lengths};
}

static long compare(const body *model, const char *method, int threads)
{
  const twins all = twins_of(model, method);
  return compare_members(&all, threads);
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
  const twins all = twins_of(&model, "lie-verlet");
  start_members(e, &all);
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
