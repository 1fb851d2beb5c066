/* labels: unit */
/* Neighbouring slots of one kind with one mass drift as lanes, with the bits of slots alone. */
#include <math.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "support/runs.h"
#include "support/suite.h"

enum { MOST = 70, STORED = 12, RATES = 6, STEPS = 4 };

typedef struct slot_kind {
  dvi_factor factor;
  int nq, nv;
  double q[STORED], v[RATES];
} slot_kind;

static const double inertia[] = {1.3, .1, 0, .1, 1.1, .05, 0, .05, .9}, centre[] = {.1, -.2, .15};

static const slot_kind kinds[] = {
    {{.kind = DVI_RN, .size = 1, .mass = 1.2}, 1, 1, {.3}, {.5}},
    {{.kind = DVI_U1, .mass = .7}, 2, 1, {.6, .8}, {.9}},
    {{.kind = DVI_S2, .mass = .8}, 3, 3, {.6, 0, .8}, {0, 1.1, 0}},
    {{.kind = DVI_SO3, .inertia = inertia}, 9, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {.3, -.4, .8}},
    {{.kind = DVI_SE3, .mass = 2, .inertia = inertia, .centre = centre},
     12,
     6,
     {1, 0, 0, 0, 1, 0, 0, 0, 1, .3, .1, 0},
     {.3, -.4, .1, 0, .2, .5}},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* The numbers of slots that are too few for lanes, that leave lanes idle, and that need rows
 * twice. */
static const int counts[] = {3, 4, 9, 16, MOST};
enum { COUNTS = sizeof counts / sizeof *counts };

static dvi_system *create_slots(const slot_kind *kind, int count)
{
  dvi_factor factors[MOST];
  dvi_system *made = NULL;
  for (int k = 0; k < count; k++) factors[k] = kind->factor;
  const dvi_system_terms terms = {.factors = factors, .factor_count = count, .autonomous = 1};
  ck_assert_msg(dvi_system_create(&terms, &made) == DVI_OK, "%s", dvi_last_error());
  return made;
}

/* Slots move with velocities of their own. */
static void velocity_of(const slot_kind *kind, int k, double *v)
{
  for (int i = 0; i < kind->nv; i++) v[i] = (0.3 + 0.09 * (k % 11)) * kind->v[i];
}

static dvi_integrator *start_slots(const slot_kind *kind, int count, const dvi_system *system)
{
  double q[MOST * STORED], v[MOST * RATES];
  dvi_integrator *integrator = create_integrator(system, "lie-verlet");
  for (int k = 0; k < count; k++) {
    memcpy(q + k * kind->nq, kind->q, (size_t)kind->nq * sizeof *q);
    velocity_of(kind, k, v + k * kind->nv);
  }
  ck_assert_msg(dvi_integrator_start_velocity(integrator, 0, q, v) == DVI_OK, "%s",
                dvi_last_error());
  return integrator;
}

static void same_as_alone(const slot_kind *kind, const dvi_system *one, int k, dvi_integrator *all)
{
  double v[RATES], q_now[STORED], v_now[RATES], q_all[MOST * STORED], v_all[MOST * RATES];
  dvi_integrator *alone = create_integrator(one, "lie-verlet");
  velocity_of(kind, k, v);
  ck_assert_int_eq(dvi_integrator_start_velocity(alone, 0, kind->q, v), DVI_OK);
  advance(alone, .2, STEPS);
  const size_t nq = (size_t)kind->nq, nv = (size_t)kind->nv, at = (size_t)k;
  ck_assert_mem_eq(dvi_integrator_q(alone), dvi_integrator_q(all) + at * nq, nq * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(alone), dvi_integrator_p(all) + at * nv, nv * sizeof(double));
  ck_assert_int_eq(dvi_integrator_interpolate(alone, .7, q_now, v_now), DVI_OK);
  ck_assert_int_eq(dvi_integrator_interpolate(all, .7, q_all, v_all), DVI_OK);
  ck_assert_mem_eq(q_now, q_all + at * nq, nq * sizeof(double));
  ck_assert_mem_eq(v_now, v_all + at * nv, nv * sizeof(double));
  dvi_integrator_destroy(&alone);
}

static void compare(const slot_kind *kind, int count)
{
  dvi_system *one = create_slots(kind, 1), *many = create_slots(kind, count);
  dvi_integrator *all = start_slots(kind, count, many);
  advance(all, .2, STEPS);
  for (int k = 0; k < count; k++) same_as_alone(kind, one, k, all);
  dvi_integrator_destroy(&all);
  dvi_system_destroy(&many);
  dvi_system_destroy(&one);
}

static void use_best_level(void)
{
  dvi__lanes_choose(-1);
}

START_TEST(like_slots_have_the_bits_of_slots_alone)
{
  compare(&kinds[_i % KINDS], counts[_i / KINDS]);
}
END_TEST

START_TEST(every_level_gives_these_bits)
{
  dvi__lanes_choose(_i / KINDS);
  compare(&kinds[_i % KINDS], 9);
}
END_TEST

/* The fastest slot, number 10, turns too far. */
START_TEST(a_slot_that_turns_too_far_is_named)
{
  const slot_kind *kind = &kinds[2];
  dvi_system *many = create_slots(kind, 11);
  dvi_integrator *all = start_slots(kind, 11, many);
  double before[11 * STORED];
  memcpy(before, dvi_integrator_q(all), 33 * sizeof(double));
  ck_assert_int_eq(dvi_integrator_step(all, .79), DVI_STEP_TOO_LARGE);
  ck_assert_msg(strstr(dvi_last_error(), "direction at coordinates 30 to 32") != NULL, "%s",
                dvi_last_error());
  ck_assert_msg(strstr(dvi_last_error(), "solved up to the moment of inertia ") != NULL, "%s",
                dvi_last_error());
  ck_assert_mem_eq(before, dvi_integrator_q(all), 33 * sizeof(double));
  dvi_integrator_destroy(&all);
  dvi_system_destroy(&many);
}
END_TEST

SUITE(lie_verlet_runs)
{
  tcase_add_checked_fixture(tests, NULL, use_best_level);
  tcase_add_test(tests, a_slot_that_turns_too_far_is_named);
  tcase_add_loop_test(tests, like_slots_have_the_bits_of_slots_alone, 0, KINDS * COUNTS);
  tcase_add_loop_test(tests, every_level_gives_these_bits, 0, KINDS * dvi__lanes_levels());
}
