/* labels: unit */
/* An ensemble with wrong arguments, or with members that fail, says which ones, and loses
 * nothing. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/memory.h"
#include "support/heap.h"
#include "support/runs.h"
#include "support/suite.h"

enum { MEMBERS = 12, N = 2 };

/* ---- arguments ---- */

static problem *kepler;
static dvi_ensemble *ensemble;
static double q[N * MEMBERS], p[N * MEMBERS];

static void fill_start(void)
{
  for (int k = 0; k < MEMBERS; k++)
    for (int i = 0; i < N; i++)
      q[i * MEMBERS + k] = kepler->q[i] * (1 + 0.01 * k), p[i * MEMBERS + k] = kepler->p[i];
}

static void set_up(void)
{
  const dvi_ensemble_options options = {.members = MEMBERS, .block = 5};
  kepler = create_problem("kepler", NULL);
  fill_start();
  ck_assert_int_eq(dvi_ensemble_create(kepler->system, "verlet", &options, &ensemble), DVI_OK);
}

static void tear_down(void)
{
  dvi_ensemble_destroy(&ensemble);
  problem_destroy(&kepler);
}

static void refused(dvi_status expected, const dvi_system *system, const char *method,
                    const dvi_ensemble_options *options)
{
  dvi_ensemble *made = (dvi_ensemble *)(uintptr_t)1;
  ck_assert_int_eq(dvi_ensemble_create(system, method, options, &made), expected);
  ck_assert_ptr_null(made);
  ck_assert(dvi_last_error()[0] != 0);
}

START_TEST(wrong_options_are_refused_by_name)
{
  const dvi_system *system = kepler->system;
  const dvi_system *systems[2] = {system, NULL};
  ck_assert_int_eq(
      dvi_ensemble_create(system, "verlet", &(dvi_ensemble_options){.members = 1}, NULL),
      DVI_BAD_ARGUMENT);
  refused(DVI_BAD_ARGUMENT, system, NULL, &(dvi_ensemble_options){.members = 1});
  refused(DVI_BAD_ARGUMENT, system, "verlet", NULL);
  refused(DVI_BAD_ARGUMENT, NULL, "verlet", &(dvi_ensemble_options){.members = 1});
  check_words("no system");
  refused(DVI_BAD_SIZE, system, "verlet", &(dvi_ensemble_options){0});
  check_words("0 members");
  refused(DVI_BAD_SIZE, system, "verlet", &(dvi_ensemble_options){.members = -3});
  check_words("-3 members");
  refused(DVI_BAD_SIZE, system, "verlet", &(dvi_ensemble_options){.members = 1, .threads = -1});
  check_words("-1 threads");
  refused(DVI_BAD_SIZE, system, "verlet", &(dvi_ensemble_options){.members = 1, .threads = 2000});
  refused(DVI_BAD_SIZE, system, "verlet", &(dvi_ensemble_options){.members = 1, .block = -1});
  check_words("blocks of -1");
  refused(DVI_BAD_SIZE, system, "verlet", &(dvi_ensemble_options){.members = 1, .block = 100000});
  refused(DVI_BAD_ARGUMENT, system, "verlet",
          &(dvi_ensemble_options){.members = 2, .systems = systems});
  check_words("two ways");
  refused(DVI_BAD_ARGUMENT, NULL, "verlet",
          &(dvi_ensemble_options){.members = 2, .systems = systems});
  check_words("member 1 is NULL");
  refused(DVI_BAD_OPTION, system, "verlett", &(dvi_ensemble_options){.members = 1});
}
END_TEST

START_TEST(an_ensemble_has_no_state_before_its_start)
{
  double value[8];
  ck_assert_int_eq(dvi_ensemble_step(ensemble, 0.1), DVI_BAD_STATE);
  check_words("dvi_ensemble_start");
  ck_assert_int_eq(dvi_ensemble_advance(ensemble, 0.1, 3), DVI_BAD_STATE);
  ck_assert_int_eq(dvi_ensemble_state(ensemble, NULL, q, NULL), DVI_BAD_STATE);
  ck_assert_int_eq(dvi_ensemble_invariants(ensemble, 0, value), DVI_BAD_STATE);
  ck_assert_int_eq(dvi_ensemble_status(ensemble, 0), DVI_OK);
}
END_TEST

START_TEST(null_and_members_that_are_not_are_refused)
{
  double value[8];
  dvi_counters counters = {.steps = 5};
  dvi_ensemble *none = NULL;
  char text[8] = "text";
  ck_assert_int_eq(dvi_ensemble_start(ensemble, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_start(ensemble, 0, NULL, p), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_start(ensemble, 0, q, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_start_velocity(NULL, 0, q, p), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_step(NULL, 0.1), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_state(NULL, NULL, NULL, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_status(NULL, 0), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_status(ensemble, MEMBERS), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_status(ensemble, -1), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_steps(ensemble, MEMBERS), 0);
  ck_assert_int_eq(dvi_ensemble_invariants(ensemble, MEMBERS, value), DVI_BAD_ARGUMENT);
  check_words("no member 12");
  ck_assert_int_eq(dvi_ensemble_invariants(ensemble, 0, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_members(NULL), 0);
  ck_assert_ptr_null(dvi_ensemble_method(NULL));
  dvi_ensemble_counters(NULL, &counters);
  ck_assert_int_eq(counters.steps, 0);
  dvi_ensemble_counters(ensemble, NULL);
  ck_assert_uint_eq(dvi_ensemble_explain(NULL, text, sizeof text), 0);
  ck_assert_str_eq(text, "");
  dvi_ensemble_destroy(&none);
  dvi_ensemble_destroy(NULL);
}
END_TEST

static void same_state(const dvi_ensemble *e, const double *t_then, const double *q_then,
                       const double *p_then)
{
  double t[MEMBERS], q_now[N * MEMBERS], p_now[N * MEMBERS];
  ck_assert_int_eq(dvi_ensemble_state(e, t, q_now, p_now), DVI_OK);
  ck_assert_mem_eq(t, t_then, sizeof t);
  ck_assert_mem_eq(q_now, q_then, sizeof q_now);
  ck_assert_mem_eq(p_now, p_then, sizeof p_now);
}

START_TEST(a_step_that_is_none_moves_nobody)
{
  const double bad[] = {0, -0.0, (double)NAN, HUGE_VAL, -HUGE_VAL, DBL_MIN / 4};
  double t[MEMBERS], q_then[N * MEMBERS], p_then[N * MEMBERS];
  ck_assert_int_eq(dvi_ensemble_start(ensemble, 1, q, p), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_step(ensemble, 0.1), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(ensemble, t, q_then, p_then), DVI_OK);
  for (int i = 0; i < 6; i++)
    ck_assert_int_eq(dvi_ensemble_step(ensemble, bad[i]), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_advance(ensemble, 0.1, -1), DVI_BAD_ARGUMENT);
  check_words("-1 steps");
  ck_assert_int_eq(dvi_ensemble_step(ensemble, 1e-17), DVI_BAD_ARGUMENT); /* t + h = t */
  check_words("member 0, one of 12");
  ck_assert_int_eq(dvi_ensemble_advance(ensemble, 0.1, 0), DVI_OK);
  same_state(ensemble, t, q_then, p_then);
}
END_TEST

START_TEST(a_start_that_fails_for_one_changes_none)
{
  double t[MEMBERS], q_then[N * MEMBERS], p_then[N * MEMBERS];
  ck_assert_int_eq(dvi_ensemble_start(ensemble, 1, q, p), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(ensemble, 0.1, 3), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(ensemble, t, q_then, p_then), DVI_OK);
  q[MEMBERS + 7] = (double)NAN;
  ck_assert_int_eq(dvi_ensemble_start(ensemble, 2, q, p), DVI_NOT_FINITE);
  check_words("member 7");
  fill_start();
  ck_assert_int_eq(dvi_ensemble_start(ensemble, (double)NAN, q, p), DVI_NOT_FINITE);
  q[3] = q[MEMBERS + 3] = 0; /* the singularity */
  q[9] = q[MEMBERS + 9] = 0;
  ck_assert_int_eq(dvi_ensemble_start(ensemble, 2, q, p), DVI_NOT_FINITE);
  check_words("member 3, one of 2");
  dvi__fail_allocations_after(0);
  ck_assert_int_eq(dvi_ensemble_start(ensemble, 2, q, p), DVI_NO_MEMORY);
  dvi__fail_allocations_after(-1);
  same_state(ensemble, t, q_then, p_then);
  ck_assert_int_eq(dvi_ensemble_steps(ensemble, 4), 3);
}
END_TEST

/* ---- members that fail ---- */

/* A free fall in which callbacks refuse, or fail for good, below a floor. q[0] rises or falls with
 * p[0]. */
typedef struct ground {
  double retry_below, fail_below, nan_below;
} ground;

static int fall_value(int count, const double *t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V[k] = 0 * x[k];
  return 0;
}

static int fall_gradient(int count, const double *t, const double *x, double *V_q, void *user)
{
  const ground *g = user;
  (void)t;
  int answer = 0;
  for (int k = 0; k < count; k++) {
    V_q[k] = x[k] < g->nan_below ? (double)NAN : 0.0;
    V_q[count + k] = 0.0;
    if (x[k] < g->retry_below && answer == 0) answer = 1;
    if (x[k] < g->fail_below) answer = -1;
  }
  return answer;
}

static dvi_system *create_fall(ground *g)
{
  dvi_system *made = NULL;
  const dvi_potential potential = {
      .name = "ground", .value_batch = fall_value, .gradient_batch = fall_gradient, .user = g};
  const dvi_system_terms terms = {
      .dimension = 2, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  ck_assert_int_eq(dvi_system_create(&terms, &made), DVI_OK);
  return made;
}

static const char *const falling_methods[] = {
    "verlet", "galerkin:degree=2", "composition:order=4,base=midpoint", "galerkin:degree=9"};

/* Member 4 falls from x = 1 with velocity -1 through the floor at x = 0.05, member 8 falls from 2,
 * and all others rise. */
static void drop_member(double *x, double *momentum)
{
  for (int k = 0; k < MEMBERS; k++) {
    x[k] = k == 8 ? 2 : 1;
    momentum[k] = k == 4 || k == 8 ? -1 : 1;
    x[MEMBERS + k] = momentum[MEMBERS + k] = 0;
  }
}

START_TEST(a_member_that_fails_stays_and_the_others_go_on)
{
  const char *method = falling_methods[_i % 4];
  const int threads = 1 + _i / 4 % 2, kind = _i / 8;
  static const dvi_status statuses[] = {DVI_CALLBACK_RETRY, DVI_CALLBACK_FAILED, DVI_NOT_FINITE};
  ground g = {kind == 0 ? 0.05 : -100, kind == 1 ? 0.05 : -100, kind == 2 ? 0.05 : -100};
  dvi_system *system = create_fall(&g);
  dvi_ensemble *e = NULL;
  double x[2 * MEMBERS], momentum[2 * MEMBERS], t[MEMBERS];
  dvi_counters counters;
  drop_member(x, momentum);
  ck_assert_int_eq(dvi_ensemble_create(
                       system, method,
                       &(dvi_ensemble_options){.members = MEMBERS, .threads = threads, .block = 6},
                       &e),
                   DVI_OK);
  ck_assert_int_eq(dvi_ensemble_start(e, 0, x, momentum), DVI_OK);
  /* member 8 is at 0.5 then */
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.125, 12), statuses[kind]);
  check_words("ensemble: member 4: ");
  check_words("step 8 from t = 0.875");
  for (int k = 0; k < MEMBERS; k++) {
    ck_assert_int_eq(dvi_ensemble_status(e, k), k == 4 ? statuses[kind] : DVI_OK);
    ck_assert_int_eq(dvi_ensemble_steps(e, k), k == 4 ? 7 : 12);
  }
  ck_assert_int_eq(dvi_ensemble_state(e, t, x, momentum), DVI_OK);
  ck_assert_double_eq(t[4], 0.875);
  ck_assert_double_eq_tol(x[4], 0.125, 1e-14);
  ck_assert_double_eq(t[5], 1.5);
  ck_assert_double_eq_tol(x[5], 2.5, 1e-14);
  dvi_ensemble_counters(e, &counters);
  ck_assert_int_eq(counters.steps, 12 * (MEMBERS - 1) + 7);
  ck_assert_int_eq(counters.failed_steps, 1);
  /* The next call tries it again, and member 8 fails as well. The sentence names the first one. */
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.125, 12), statuses[kind]);
  check_words("ensemble: member 4, one of 2 that failed: ");
  ck_assert_int_eq(dvi_ensemble_steps(e, 8), 15);
  ck_assert_int_eq(dvi_ensemble_steps(e, 9), 24);
  /* A step back leads out of it, for all. */
  ck_assert_int_eq(dvi_ensemble_step(e, -0.125), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_status(e, 4), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_steps(e, 4), 8);
  dvi_ensemble_destroy(&e);
  dvi_system_destroy(&system);
}
END_TEST

/* Member 4 meets a request for a smaller step first, and member 8 later a failure for good, which
 * is the worse. */
START_TEST(a_fatal_failure_is_worse_than_an_earlier_member)
{
  for (int threads = 1; threads <= 3; threads++) {
    ground g = {0.05, -0.5, -100};
    dvi_system *system = create_fall(&g);
    dvi_ensemble *e = NULL;
    double x[2 * MEMBERS], momentum[2 * MEMBERS];
    drop_member(x, momentum);
    momentum[8] = -16; /* lands at x = -14 from x = 2, in one step of 1 */
    momentum[4] = -1;
    ck_assert_int_eq(
        dvi_ensemble_create(
            system, "verlet",
            &(dvi_ensemble_options){.members = MEMBERS, .threads = threads, .block = 3}, &e),
        DVI_OK);
    ck_assert_int_eq(dvi_ensemble_start(e, 0, x, momentum), DVI_OK);
    ck_assert_int_eq(dvi_ensemble_step(e, 1.0), DVI_CALLBACK_FAILED);
    check_words("member 8, one of 2");
    ck_assert_int_eq(dvi_ensemble_status(e, 4), DVI_CALLBACK_RETRY);
    ck_assert_int_eq(dvi_ensemble_status(e, 8), DVI_CALLBACK_FAILED);
    dvi_ensemble_destroy(&e);
    dvi_system_destroy(&system);
  }
}
END_TEST

/* A force on x < 0 whose second kick overflows the momentum. The mass is so large that no member
 * moves much. */
static int huge_gradient(int count, const double *t, const double *x, double *V_q, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V_q[k] = x[k] < 0 ? -1.5e308 : 0;
  return 0;
}

START_TEST(a_state_that_is_not_finite_is_not_taken)
{
  const dvi_potential potential = {.value_batch = fall_value, .gradient_batch = huge_gradient};
  const dvi_system_terms terms = {
      .dimension = 1, .mass.scalar = 1e306, .potentials = &potential, .potential_count = 1};
  double x[MEMBERS], momentum[MEMBERS] = {0}, x_now[MEMBERS], p_now[MEMBERS];
  dvi_system *system = NULL;
  dvi_ensemble *e = NULL;
  for (int k = 0; k < MEMBERS; k++) x[k] = k == 5 ? -1e6 : 1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(
      dvi_ensemble_create(system, "verlet", &(dvi_ensemble_options){.members = MEMBERS}, &e),
      DVI_OK);
  ck_assert_int_eq(dvi_ensemble_start(e, 0, x, momentum), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_step(e, 2), DVI_NOT_FINITE);
  check_words("member 5: verlet: step 1 from t = 0");
  ck_assert_int_eq(dvi_ensemble_state(e, NULL, x_now, p_now), DVI_OK);
  ck_assert_mem_eq(x_now, x, sizeof x);
  ck_assert_mem_eq(p_now, momentum, sizeof momentum);
  ck_assert_int_eq(dvi_ensemble_steps(e, 5), 0);
  ck_assert_int_eq(dvi_ensemble_steps(e, 6), 1);
  dvi_ensemble_destroy(&e);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- memory ---- */

static const struct {
  const char *problem, *method;
} places[] = {{"kepler", "verlet"},
              {"kepler", "galerkin"},
              {"kepler", "galerkin:degree=8"},
              {"kepler", "composition:order=4,base=galerkin"},
              {"double-pendulum", "midpoint"},
              {"spherical-constrained", "verlet"}};

START_TEST(creation_survives_every_failure_of_memory)
{
  problem *model = create_problem(places[_i].problem, NULL);
  const dvi_system *systems[MEMBERS];
  for (int k = 0; k < MEMBERS; k++) systems[k] = model->system;
  const dvi_ensemble_options options[] = {{.members = MEMBERS, .threads = 2},
                                          {.members = MEMBERS, .systems = systems}};
  for (int way = 0; way < 2; way++) {
    const dvi_system *system = way == 0 ? model->system : NULL;
    dvi_ensemble *made = NULL;
    ck_assert_int_eq(dvi_ensemble_create(system, places[_i].method, &options[way], &made), DVI_OK);
    /* the first one completes the system, and libraries take what they keep */
    dvi_ensemble_destroy(&made);
    const long before = dvi__allocation_count();
    ck_assert_int_eq(dvi_ensemble_create(system, places[_i].method, &options[way], &made), DVI_OK);
    const long needed = dvi__allocation_count() - before;
    dvi_ensemble_destroy(&made);
    ck_assert_int_gt(needed, 10);
    const long bytes_before = heap_bytes();
    for (long successes = 0; successes < needed; successes++) {
      made = (dvi_ensemble *)(uintptr_t)1;
      dvi__fail_allocations_after(successes);
      const dvi_status status = dvi_ensemble_create(system, places[_i].method, &options[way],
                                                    &made);
      dvi__fail_allocations_after(-1);
      ck_assert_msg(status == DVI_NO_MEMORY, "%s after %ld of %ld", dvi_status_name(status),
                    successes, needed);
      check_words("no memory");
      ck_assert_ptr_null(made);
    }
    ck_assert_int_eq(heap_bytes(), bytes_before);
  }
  problem_destroy(&model);
}
END_TEST

SUITE(ensemble_failure)
{
  tcase_add_checked_fixture(tests, set_up, tear_down);
  tcase_add_test(tests, wrong_options_are_refused_by_name);
  tcase_add_test(tests, an_ensemble_has_no_state_before_its_start);
  tcase_add_test(tests, null_and_members_that_are_not_are_refused);
  tcase_add_test(tests, a_step_that_is_none_moves_nobody);
  tcase_add_test(tests, a_start_that_fails_for_one_changes_none);
  tcase_add_loop_test(tests, a_member_that_fails_stays_and_the_others_go_on, 0, 24);
  tcase_add_test(tests, a_fatal_failure_is_worse_than_an_earlier_member);
  tcase_add_test(tests, a_state_that_is_not_finite_is_not_taken);
  tcase_add_loop_test(tests, creation_survives_every_failure_of_memory, 0, 6);
}
