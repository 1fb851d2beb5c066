/* labels: unit */
/* Coordinates that each move alone go through a step with hardly more than the arithmetic. What
 * stands around it, bits, counts and failures, is that of the same system with a force of zero,
 * whose steps are swept one operation after the other. */
#include <dvi/run.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "support/files.h"
#include "support/runs.h"
#include "support/suite.h"

enum { SIZES = 4, MASSES = 4, MOST = 20 };
static const int sizes[SIZES] = {1, 2, 8, MOST};

/* A chain. Its callback is ill from some time on. */
typedef struct chain {
  int n, returned;
  double ill_after, number;
  int blind; /* coordinates that the callback saw and that were not finite */
} chain;

static int chain_value(double t, const double *q, double *V, void *user)
{
  const chain *own = user;
  (void)t;
  *V = 0;
  for (int i = 0; i < own->n; i++) *V += pow(q[i], 4) / 4;
  for (int i = 0; i + 1 < own->n; i++) *V += (q[i + 1] - q[i]) * (q[i + 1] - q[i]) / 2;
  return 0;
}

static int chain_gradient(double t, const double *q, double *V_q, void *user)
{
  chain *own = user;
  for (int i = 0; i < own->n; i++) {
    V_q[i] = q[i] * q[i] * q[i] + (i > 0 ? q[i] - q[i - 1] : 0) -
             (i + 1 < own->n ? q[i + 1] - q[i] : 0);
    own->blind += !isfinite(q[i]);
  }
  if (t < own->ill_after) return 0;
  if (own->returned == 0) V_q[own->n / 2] = own->number;
  return own->returned;
}

static int chain_gradient_of_points(int count, const double *t, const double *q, double *V_q,
                                    void *user)
{
  ck_assert_int_eq(count, 1);
  return chain_gradient(*t, q, V_q, user);
}

static int drive_value(double t, const double *q, double *V, void *user)
{
  (void)user;
  *V = 0.3 * sin(t) * q[0];
  return 0;
}

static int drive_gradient(double t, const double *q, double *V_q, void *user)
{
  const chain *own = user;
  (void)q;
  for (int i = 0; i < own->n; i++) V_q[i] = i == 0 ? 0.3 * sin(t) : 0;
  return 0;
}

static int no_force(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)q, (void)v;
  for (int i = 0; i < ((const chain *)user)->n; i++) F[i] = 0;
  return 0;
}

static dvi_system *system_of(chain *own, int potentials, int mass, int forces)
{
  static const double diagonal[MOST] = {3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5, 8, 9, 7, 9, 3, 2, 3, 8, 4};
  static const dvi_mass masses[MASSES] = {
      {.scalar = 0.25}, {.scalar = 3}, {.scalar = -7}, {.diagonal = diagonal}};
  const dvi_potential parts[] = {
      {.name = "springs",
       .value = chain_value,
       .gradient = potentials == 1 ? chain_gradient : NULL,
       .gradient_batch = potentials == 1 ? NULL : chain_gradient_of_points,
       .user = own},
      {.name = "drive", .value = drive_value, .gradient = drive_gradient, .user = own}};
  const dvi_force none = {.name = "none", .value = no_force, .user = own, .without_velocity = 1};
  const dvi_system_terms terms = {.dimension = own->n,
                                  .mass = masses[mass],
                                  .potentials = parts,
                                  .potential_count = potentials,
                                  .forces = forces > 0 ? &none : NULL,
                                  .force_count = forces};
  dvi_system *system = NULL;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

/* The integrators of a system without forces and of the same one with a force of zero. */
typedef struct couple {
  chain chain;
  dvi_system *system[2];
  dvi_integrator *quick, *swept;
} couple;

static void start_couple(couple *c, int n, int potentials, int mass, const char *method)
{
  double q[MOST], p[MOST];
  *c = (couple){.chain = {.n = n, .ill_after = HUGE_VAL}};
  for (int i = 0; i < n; i++) q[i] = sin(1.0 + 7 * i), p[i] = cos(2.0 + 5 * i);
  for (int k = 0; k < 2; k++) c->system[k] = system_of(&c->chain, potentials, mass, k);
  c->quick = create_integrator(c->system[0], method);
  c->swept = create_integrator(c->system[1], method);
  ck_assert_int_eq(dvi_integrator_start(c->quick, 0.25, q, p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(c->swept, 0.25, q, p), DVI_OK);
}

static void destroy_couple(couple *c)
{
  dvi_integrator_destroy(&c->quick);
  dvi_integrator_destroy(&c->swept);
  for (int k = 0; k < 2; k++) dvi_system_destroy(&c->system[k]);
}

static void check_same(const couple *c)
{
  const size_t size = (size_t)c->chain.n * sizeof(double);
  dvi_counters quick, swept;
  dvi_integrator_counters(c->quick, &quick);
  dvi_integrator_counters(c->swept, &swept);
  ck_assert_mem_eq(dvi_integrator_q(c->quick), dvi_integrator_q(c->swept), size);
  ck_assert_mem_eq(dvi_integrator_p(c->quick), dvi_integrator_p(c->swept), size);
  ck_assert(dvi_integrator_time(c->quick) == dvi_integrator_time(c->swept));
  ck_assert_int_eq(quick.steps, swept.steps);
  ck_assert_int_eq(quick.gradients, swept.gradients);
  ck_assert_int_eq(quick.failed_steps, swept.failed_steps);
}

static const char *method_of(int i)
{
  return i % 2 == 0 ? "verlet" : "composition:order=6";
}

START_TEST(bits_and_counts_are_those_of_swept_steps)
{
  for (int level = 0; level < dvi__lanes_levels(); level++)
    for (int mass = 0; mass < MASSES; mass++)
      for (int size = 0; size < SIZES; size++) {
        couple c;
        start_couple(&c, sizes[size], 1 + _i / 2, mass, method_of(_i));
        dvi__lanes_choose(level);
        for (int i = 0; i < 40; i++) {
          const double h = i < 20 ? 0.05 : -0.031; /* there, and back by other steps */
          advance(c.quick, h, 1);
          advance(c.swept, h, 1);
          check_same(&c);
        }
        destroy_couple(&c);
      }
  dvi__lanes_choose(-1);
}
END_TEST

static int count_looks(dvi_integrator *integrator, void *user)
{
  (void)integrator;
  ++*(int *)user;
  return 0;
}

/* Steps between which nothing looks are taken together. The last one is shorter. */
START_TEST(a_run_has_the_bits_of_its_steps)
{
  couple c;
  int looks = 0;
  start_couple(&c, 3, 2, 3, method_of(_i));
  const dvi_run_options seldom = {
      .h = 0.05, .t_end = 7.67, .observe = count_looks, .every = 50, .user = &looks};
  ck_assert_int_eq(dvi_run(c.quick, &seldom, NULL), DVI_OK);
  ck_assert_int_eq(looks, 1 + 2 + 1);
  ck_assert_int_eq(dvi_run(c.swept, &seldom, NULL), DVI_OK);
  check_same(&c);
  destroy_couple(&c);
}
END_TEST

/* Both give one status and one sentence, count the same, and go on as if nothing had happened. No
 * callback sees what another one spoiled. */
START_TEST(a_failure_is_that_of_swept_steps_and_leaves_no_trace)
{
  static const struct {
    int returned;
    double number;
  } ills[] = {{1, 0}, {-3, 0}, {0, (double)NAN}, {0, HUGE_VAL}, {0, -1.7e308}};
  for (int size = 0; size < SIZES; size++) {
    couple c;
    char words[512];
    start_couple(&c, sizes[size], 2, 0, method_of(_i));
    advance(c.quick, 0.1, 3);
    advance(c.swept, 0.1, 3);
    c.chain.returned = ills[_i / 2].returned;
    c.chain.number = ills[_i / 2].number;
    c.chain.ill_after = 0.25 + 0.3 + 0.05;
    const dvi_status status = dvi_integrator_step(c.swept, 8);
    (void)snprintf(words, sizeof words, "%s", dvi_last_error());
    ck_assert_int_ne(status, DVI_OK);
    ck_assert_int_eq(dvi_integrator_step(c.quick, 8), status);
    ck_assert_str_eq(dvi_last_error(), words);
    /* only swept steps, which name the failure, go on after the overflow of a kick */
    ck_assert(c.chain.blind == 0 || ills[_i / 2].number == -1.7e308);
    check_same(&c);
    c.chain.ill_after = HUGE_VAL;
    advance(c.quick, 0.1, 3);
    advance(c.swept, 0.1, 3);
    check_same(&c);
    destroy_couple(&c);
  }
}
END_TEST

/* No force supplies anything, in steps of all kinds. */
/* Wherever the failure comes, the last step and its path are those of single steps. */
START_TEST(a_run_that_fails_has_its_last_step)
{
  for (int steps = 31; steps < 36; steps++) {
    couple c;
    double quick[MOST], swept[MOST];
    start_couple(&c, 3, 2, 1, "verlet");
    c.chain.returned = 1;
    c.chain.ill_after = 0.25 + 0.05 * (steps + 0.5);
    const dvi_run_options run = {.h = 0.05, .t_end = 10};
    ck_assert_int_eq(dvi_run(c.quick, &run, NULL), DVI_CALLBACK_RETRY);
    ck_assert_int_eq(dvi_run(c.swept, &run, NULL), DVI_CALLBACK_RETRY);
    check_same(&c);
    const double h = dvi_integrator_last_step(c.swept), t = dvi_integrator_time(c.swept) - h / 3;
    ck_assert(dvi_integrator_last_step(c.quick) == h);
    ck_assert_int_eq(dvi_integrator_interpolate(c.quick, t, quick, NULL), DVI_OK);
    ck_assert_int_eq(dvi_integrator_interpolate(c.swept, t, swept, NULL), DVI_OK);
    ck_assert_mem_eq(quick, swept, 3 * sizeof(double));
    destroy_couple(&c);
  }
}
END_TEST

START_TEST(balances_stay_zero)
{
  static const char *const method[] = {"verlet", "verlet:blocking=temporal", "composition:order=4"};
  problem *bodies = create_problem(_i == 1 ? "chain" : "kepler", NULL);
  const dvi_integrator_options keep = {.size = sizeof keep, .method = method[_i], .balances = 1};
  dvi_integrator *integrator = NULL;
  ck_assert_msg(dvi_integrator_create_with(bodies->system, &keep, &integrator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, bodies->q, bodies->p), DVI_OK);
  for (int i = 0; i < 3; i++) {
    ck_assert(dvi_integrator_supplied(integrator, 0) == 0);
    advance(integrator, 0.01, 1);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&bodies);
}
END_TEST

START_TEST(a_restored_run_goes_on_with_the_same_bits)
{
  couple c;
  start_couple(&c, 5, 2, 1, method_of(_i));
  advance(c.quick, 0.1, 3);
  advance(c.swept, 0.1, 3);
  ck_assert_int_eq(dvi_integrator_save(c.quick, path_in_folder("checkpoint")), DVI_OK);
  advance(c.quick, 0.2, 2);
  ck_assert_int_eq(dvi_integrator_restore(c.quick, path_in_folder("checkpoint")), DVI_OK);
  advance(c.quick, 0.1, 3);
  advance(c.swept, 0.1, 3);
  ck_assert_mem_eq(dvi_integrator_q(c.quick), dvi_integrator_q(c.swept), 5 * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(c.quick), dvi_integrator_p(c.swept), 5 * sizeof(double));
  destroy_couple(&c);
}
END_TEST

SUITE(verlet_alone)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, bits_and_counts_are_those_of_swept_steps, 0, 4);
  tcase_add_loop_test(tests, a_run_has_the_bits_of_its_steps, 0, 2);
  tcase_add_loop_test(tests, a_failure_is_that_of_swept_steps_and_leaves_no_trace, 0, 10);
  tcase_add_test(tests, a_run_that_fails_has_its_last_step);
  tcase_add_loop_test(tests, balances_stay_zero, 0, 3);
  tcase_add_loop_test(tests, a_restored_run_goes_on_with_the_same_bits, 0, 2);
}
