/* labels: unit */
/* Fixed-point iteration in which slow potentials lag behind fast ones (system/evaluate/lagged.h).
 * Solutions, and the numbers of evaluations. */
#include <dvi/method.h>
#include <math.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "support/prepared.h"
#include "support/runs.h"
#include "support/suite.h"

enum { N = 15 };

/* A potential whose evaluations are counted, and fail from some call on. */
typedef struct counted {
  dvi_potential of;
  long calls, last; /* last call that succeeds, 0 for all */
  int failure;      /* what a failing call returns; 0: a gradient that is not finite */
} counted;

static problem *model;
static counted potentials[2];
static dvi_system *system;

static int counted_value(int count, const double *t, const double *q, double *V, void *user)
{
  const counted *own = user;
  return own->of.value_batch(count, t, q, V, own->of.user);
}

static int counted_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  counted *own = user;
  const int returned = own->of.gradient_batch(count, t, q, V_q, own->of.user);
  own->calls++;
  if (own->last == 0 || own->calls <= own->last) return returned;
  V_q[0] = NAN;
  return own->failure;
}

static int counted_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const counted *own = user;
  return own->of.hessian_batch(count, t, q, V_qq, own->of.user);
}

/* Declares the catalogue's two potentials again, the Kepler motions and the rest, some as fast. */
static void declare(int first_fast, int second_fast)
{
  model = create_problem("outer-solar-jacobi", NULL);
  dvi_system_terms terms = *model->terms;
  dvi_potential both[2];
  ck_assert_int_eq(terms.potential_count, 2);
  for (int k = 0; k < 2; k++) {
    potentials[k] = (counted){.of = terms.potentials[k]};
    both[k] = terms.potentials[k];
    both[k].value_batch = counted_value;
    both[k].gradient_batch = counted_gradient;
    both[k].hessian_batch = counted_hessian;
    both[k].user = &potentials[k];
    both[k].fast = k == 0 ? first_fast : second_fast;
  }
  terms.potentials = both;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
}

static void forget(void)
{
  dvi_system_destroy(&system);
  problem_destroy(&model);
}

static dvi_integrator *start(const char *method)
{
  dvi_integrator *made = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start(made, 0, model->q, model->p), DVI_OK);
  return made;
}

/* ---- evaluations ---- */

/* Iterations by all forces, and evaluations of slow ones where they lag, over 200 steps. */
static const struct {
  const char *method;
  double h;
  long plain, slow;
} runs[] = {{"galerkin:degree=8", 600, 1605, 855},
            {"galerkin:degree=8", 100, 595, 445},
            {"galerkin:degree=4", 200, 1250, 770}};

START_TEST(slow_forces_are_evaluated_less)
{
  declare(1, 0);
  dvi_integrator *run = start(runs[_i].method);
  const long points = read_counters(run).gradients,
             first[2] = {potentials[0].calls, potentials[1].calls};
  advance(run, runs[_i].h, 200);
  const dvi_counters counters = read_counters(run);
  const long fast = potentials[0].calls - first[0], slow = potentials[1].calls - first[1];
  ck_assert_int_eq(fast, counters.residuals);
  ck_assert_int_eq((counters.gradients - points) % fast, 0);
  ck_assert_int_le(fast, runs[_i].plain * 102 / 100);
  ck_assert_int_le(slow, runs[_i].slow);
  ck_assert_int_eq(counters.fixed_points, 200);
  dvi_integrator_destroy(&run);
}
END_TEST

/* A potential that all others exceed may be declared fast, too. Nothing lags then. */
START_TEST(small_forces_declared_fast_cost_little)
{
  declare(0, 1);
  dvi_integrator *run = start("galerkin:degree=8");
  advance(run, 600, 200);
  ck_assert_int_le(read_counters(run).residuals, 1606 * 101 / 100);
  dvi_integrator_destroy(&run);
}
END_TEST

/* ---- solutions ---- */

static void run_declared(int first_fast, int second_fast, double *q)
{
  declare(first_fast, second_fast);
  dvi_integrator *run = start("galerkin:degree=8");
  advance(run, 600, 50);
  memcpy(q, dvi_integrator_q(run), sizeof(double) * N);
  dvi_integrator_destroy(&run);
  forget();
}

START_TEST(solutions_are_those_of_all_forces)
{
  double plain[N], lagged[N];
  run_declared(0, 0, plain);
  run_declared(_i == 0, _i == 1, lagged);
  ck_assert_double_le(distance(N, plain, lagged), 2e-13 * magnitude(N, plain));
  declare(0, 0);
}
END_TEST

/* A further step, by all forces, of a solution that KINSOL tests moves it by roundings. */
START_TEST(solutions_are_certified)
{
  declare(1, 0);
  dvi_integrator *run = start("galerkin:degree=8,solver=certified");
  advance(run, 600, 100);
  ck_assert_int_eq(read_counters(run).certified, 100);
  dvi_integrator_destroy(&run);
}
END_TEST

/* The factors are saved with the forces. */
START_TEST(restored_runs_go_on)
{
  char bytes[65536];
  size_t size = 0;
  double q[N];
  declare(1, 0);
  dvi_integrator *run = start("galerkin:degree=8"), *other = start("galerkin:degree=8");
  advance(run, 600, 3);
  ck_assert_int_eq(dvi_integrator_save_memory(run, NULL, 0, &size), DVI_OK);
  ck_assert_uint_le(size, sizeof bytes);
  ck_assert_int_eq(dvi_integrator_save_memory(run, bytes, size, &size), DVI_OK);
  const long before = potentials[1].calls;
  advance(run, 600, 5);
  memcpy(q, dvi_integrator_q(run), sizeof q);
  const long calls = potentials[1].calls - before;
  ck_assert_int_eq(dvi_integrator_restore_memory(other, bytes, size), DVI_OK);
  const long restored = potentials[1].calls;
  advance(other, 600, 5);
  ck_assert_mem_eq(dvi_integrator_q(other), q, sizeof q);
  ck_assert_int_eq(potentials[1].calls - restored, calls);
  dvi_integrator_destroy(&run);
  dvi_integrator_destroy(&other);
}
END_TEST

START_TEST(levels_have_the_same_bits)
{
  double base[N];
  declare(1, 0);
  for (int level = 0; level < dvi__lanes_levels(); level++) {
    dvi__lanes_choose(level);
    dvi_integrator *run = start("galerkin:degree=7");
    advance(run, 500, 20);
    if (level == 0) memcpy(base, dvi_integrator_q(run), sizeof base);
    ck_assert_mem_eq(dvi_integrator_q(run), base, sizeof base);
    dvi_integrator_destroy(&run);
  }
  dvi__lanes_choose(-1);
}
END_TEST

START_TEST(steps_of_other_lengths_lead_back)
{
  declare(1, 0);
  dvi_integrator *run = start("galerkin:degree=8");
  advance(run, 600, 3);
  advance(run, 200, 3);
  advance(run, -200, 3);
  advance(run, -600, 3);
  ck_assert_int_eq(read_counters(run).fixed_points, 12);
  ck_assert_double_le(distance(N, dvi_integrator_q(run), model->q), 1e-14 * magnitude(N, model->q));
  dvi_integrator_destroy(&run);
}
END_TEST

/* ---- failures ---- */

/* Of slow forces, by a callback that fails, and by one that gives NaN. */
START_TEST(slow_forces_that_fail_leave_the_state)
{
  double q[N];
  declare(1, 0);
  dvi_integrator *run = start("galerkin:degree=8");
  advance(run, 600, 2);
  memcpy(q, dvi_integrator_q(run), sizeof q);
  potentials[1].last = potentials[1].calls + 1 + _i / 2;
  potentials[1].failure = _i % 2 ? -1 : 0;
  ck_assert_int_ne(dvi_integrator_step(run, 600), DVI_OK);
  check_words("rest");
  ck_assert_mem_eq(dvi_integrator_q(run), q, sizeof q);
  potentials[1].last = 0;
  advance(run, 600, 2);
  dvi_integrator_destroy(&run);
}
END_TEST

/* ---- a fast force without any contraction ---- */

static int weight_value(int count, const double *t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V[k] = q[k];
  return 0;
}

static int weight_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  for (int k = 0; k < count; k++) V_q[k] = 1;
  return 0;
}

static int spring_value(int count, const double *t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V[k] = cosh(q[k]);
  return 0;
}

static int spring_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V_q[k] = sinh(q[k]);
  return 0;
}

START_TEST(constant_fast_forces_are_solved)
{
  dvi_potential both[2] = {
      {.value_batch = weight_value, .gradient_batch = weight_gradient, .fast = _i == 0},
      {.value_batch = spring_value, .gradient_batch = spring_gradient, .fast = _i == 1}};
  const dvi_system_terms terms = {
      .dimension = 1, .mass = {.scalar = 1}, .potentials = both, .potential_count = 2};
  const double q = 1, p = 0;
  declare(0, 0);
  dvi_system *own;
  ck_assert_int_eq(dvi_system_create(&terms, &own), DVI_OK);
  dvi_integrator *run = create_integrator(own, "galerkin:degree=4");
  ck_assert_int_eq(dvi_integrator_start(run, 0, &q, &p), DVI_OK);
  advance(run, 0.2, 100);
  ck_assert_int_eq(read_counters(run).fixed_points, 100);
  dvi_integrator_destroy(&run);
  dvi_system_destroy(&own);
}
END_TEST

SUITE(lagged)
{
  tcase_add_checked_fixture(tests, NULL, forget);
  tcase_add_loop_test(tests, slow_forces_are_evaluated_less, 0, sizeof runs / sizeof *runs);
  tcase_add_test(tests, small_forces_declared_fast_cost_little);
  tcase_add_loop_test(tests, solutions_are_those_of_all_forces, 0, 2);
  tcase_add_test(tests, solutions_are_certified);
  tcase_add_test(tests, restored_runs_go_on);
  tcase_add_test(tests, levels_have_the_same_bits);
  tcase_add_test(tests, steps_of_other_lengths_lead_back);
  tcase_add_loop_test(tests, slow_forces_that_fail_leave_the_state, 0, 4);
  tcase_add_loop_test(tests, constant_fast_forces_are_solved, 0, 2);
}
