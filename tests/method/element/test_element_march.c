/* labels: unit */
/* Steps by fixed-point iteration that a run takes one after the other, without a look between
 * them. */
#include <math.h>

#include "support/files.h"
#include "support/runs.h"
#include "support/suite.h"

enum { STEPS = 101 };

typedef struct march {
  const char *problem, *setting, *method;
  double h;
} march;

/* In the third and the fourth some steps are too long for fixed-point iteration. The last ones have
 * several potentials, one of them implicit, or a vector potential. */
static const march marches[] = {{"kepler", NULL, "galerkin:degree=8", 0.19},
                                {"pendulum", NULL, "galerkin:degree=3,solver=fixed-point", -0.1},
                                {"kepler", "e=0.8", "galerkin:degree=6", 0.3},
                                {"kepler", "e=0.9", "galerkin:degree=11", 0.4},
                                {"henon-heiles", NULL, "midpoint", 0.05},
                                {"outer-solar", NULL, "galerkin:degree=5,nodes=6", 300},
                                {"outer-solar", NULL, "galerkin:degree=4,solver=certified", 300},
                                {"kepler", NULL, "galerkin:degree=8,solver=certified", 0.19},
                                {"kepler", "e=0.8", "galerkin:degree=6,solver=certified", 0.3},
                                {"oscillator", NULL, "galerkin:degree=2,solver=certified", 0.1},
                                {"fpu", NULL, "galerkin:degree=8", 0.05},
                                {"fpu", "ell=20", "galerkin:degree=4,solver=certified", 0.02},
                                {"magnetic-bottle", NULL, "galerkin:degree=4", 0.05}};
enum { MARCHES = sizeof marches / sizeof *marches };

static dvi_counters counters_of(const dvi_integrator *integrator)
{
  dvi_counters counters;
  dvi_integrator_counters(integrator, &counters);
  return counters;
}

static void check_same_step(const problem *model, dvi_integrator *a, dvi_integrator *b)
{
  double q[2][64], v[2][64];
  const double t = dvi_integrator_time(a) - 0.3 * dvi_integrator_last_step(a);
  check_same_state(a, b);
  ck_assert_double_eq(dvi_integrator_last_step(a), dvi_integrator_last_step(b));
  ck_assert_int_eq(dvi_integrator_interpolate(a, t, q[0], v[0]), DVI_OK);
  ck_assert_int_eq(dvi_integrator_interpolate(b, t, q[1], v[1]), DVI_OK);
  ck_assert_mem_eq(q[0], q[1], (size_t)model->nq * sizeof(double));
  ck_assert_mem_eq(v[0], v[1], (size_t)model->nq * sizeof(double));
}

START_TEST(a_run_has_the_bits_of_single_steps_and_their_rungs)
{
  const march *m = &marches[_i];
  problem *model = create_problem(m->problem, m->setting);
  dvi_integrator *runner = start_integrator(model, m->method),
                 *walker = start_integrator(model, m->method);
  ck_assert_int_eq(dvi_run(runner, &(dvi_run_options){.h = m->h, .t_end = STEPS * m->h}, NULL),
                   DVI_OK);
  advance(walker, m->h, STEPS);
  check_same_step(model, runner, walker);
  const dvi_counters ran = counters_of(runner), walked = counters_of(walker);
  ck_assert_int_eq(ran.steps, STEPS);
  ck_assert_int_eq(ran.fixed_points, walked.fixed_points);
  ck_assert_int_eq(ran.simplified + ran.newtons, walked.simplified + walked.newtons);
  ck_assert_int_eq(ran.fixed_points < STEPS,
                   m->setting != NULL && m->setting[0] == 'e' && m->setting[1] == '=');
  ck_assert_int_eq(ran.certified, walked.certified);
  if (ran.fixed_points == STEPS) ck_assert_int_eq(ran.residuals, walked.residuals);
  if (ran.fixed_points == STEPS) ck_assert_int_eq(ran.gradients, walked.gradients);
  if (ran.fixed_points == STEPS) ck_assert_int_eq(ran.allocations, walked.allocations);
  dvi_integrator_destroy(&runner);
  dvi_integrator_destroy(&walker);
  problem_destroy(&model);
}
END_TEST

/* ---- a run that fails ---- */

typedef struct trap {
  double until;     /* the forces fail beyond this time */
  double spoilt;    /* what they are then */
  double stiffness; /* 0 for 1 */
  long calls;
} trap;

static int trap_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  trap *set = user;
  set->calls++;
  for (int j = 0; j < count; j++) {
    if (t[j] > set->until && set->spoilt == 0) return 1;
    V_q[j] = t[j] > set->until ? set->spoilt
                               : (set->stiffness > 0 ? set->stiffness : 1) * sin(q[j]);
  }
  return 0;
}

static int trap_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)user;
  for (int j = 0; j < count; j++) V_qq[j] = cos(q[j]);
  return 0;
}

static int trap_value(int count, const double *t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  for (int j = 0; j < count; j++) V[j] = -cos(q[j]);
  return 0;
}

static dvi_system *trapped(trap *set)
{
  const dvi_potential potential = {.name = "trap",
                                   .value_batch = trap_value,
                                   .gradient_batch = trap_gradient,
                                   .hessian_batch = trap_hessian,
                                   .user = set};
  dvi_system *system = NULL;
  ck_assert_msg(dvi_system_create(&(dvi_system_terms){.dimension = 1,
                                                      .mass = {.scalar = 1},
                                                      .potential_count = 1,
                                                      .potentials = &potential},
                                  &system) == DVI_OK,
                "%s", dvi_last_error());
  return system;
}

static dvi_integrator *launched_at(double q, double p, const dvi_system *system, const char *method)
{
  dvi_integrator *made = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start(made, 0, &q, &p), DVI_OK);
  return made;
}

static dvi_integrator *launched(const dvi_system *system)
{
  return launched_at(0.5, 0.2, system, "galerkin:degree=4");
}

/* The trap closes within the 21st step. The largest number is met by a step that succeeds, and the
 * momentum overflows later. The last step, and all that follows, are those of single steps. */
START_TEST(a_run_that_fails_ends_at_the_last_good_step)
{
  const double spoilt[] = {0, (double)NAN, HUGE_VAL, 1e308};
  const problem shape = {.nq = 1};
  trap set = {.until = 2.04, .spoilt = spoilt[_i]};
  dvi_system *system = trapped(&set);
  dvi_integrator *runner = launched(system), *walker = launched(system);
  ck_assert_int_ne(dvi_run(runner, &(dvi_run_options){.h = 0.1, .t_end = 10}, NULL), DVI_OK);
  check_words(_i < 3 ? "step 21 from t = 2 with h = 0.1 failed; the state is unchanged"
                     : "step 39 from t = 3.8 with h = 0.1 failed; the state is unchanged");
  while (dvi_integrator_step(walker, 0.1) == DVI_OK) continue;
  check_same_step(&shape, runner, walker);
  ck_assert_int_eq(counters_of(runner).failed_steps, 1);
  set.until = HUGE_VAL;
  if (_i == 3) dvi_integrator_start(runner, 0, (double[]){0.5}, (double[]){0.2});
  if (_i == 3) dvi_integrator_start(walker, 0, (double[]){0.5}, (double[]){0.2});
  const double t = dvi_integrator_time(runner);
  ck_assert_int_eq(dvi_run(runner, &(dvi_run_options){.h = 0.1, .t_end = t + 5}, NULL), DVI_OK);
  advance(walker, 0.1, 50);
  check_same_step(&shape, runner, walker);
  dvi_integrator_destroy(&runner);
  dvi_integrator_destroy(&walker);
  dvi_system_destroy(&system);
}
END_TEST

/* With a flag that may cancel the run, steps are taken one by one. */
START_TEST(nothing_is_evaluated_twice)
{
  const volatile int cancel = 0;
  trap open = {.until = HUGE_VAL};
  dvi_system *system = trapped(&open);
  dvi_integrator *runner = launched(system);
  const dvi_run_options options = {.h = 0.1, .t_end = 5, .cancel = _i == 0 ? NULL : &cancel};
  const long before = open.calls, at_start = counters_of(runner).gradients;
  ck_assert_int_eq(dvi_run(runner, &options, NULL), DVI_OK);
  ck_assert_int_eq(open.calls - before, counters_of(runner).residuals);
  ck_assert_int_eq(counters_of(runner).gradients - at_start, 4 * counters_of(runner).residuals);
  dvi_integrator_destroy(&runner);
  dvi_system_destroy(&system);
}
END_TEST

/* Near an equilibrium far from the origin places have roundings that are large beside the offsets,
 * and KINSOL does not certify all steps. */
START_TEST(steps_that_are_not_certified_together_are_certified_alone)
{
  const char *method = "galerkin:degree=4,solver=certified";
  const double far = 2e4 * 3.14159265358979323846;
  const problem shape = {.nq = 1};
  trap open = {.until = HUGE_VAL, .stiffness = 2500};
  dvi_system *system = trapped(&open);
  dvi_integrator *runner = launched_at(far, 1e-4, system, method),
                 *walker = launched_at(far, 1e-4, system, method);
  ck_assert_int_eq(dvi_run(runner, &(dvi_run_options){.h = 0.01, .t_end = 2}, NULL), DVI_OK);
  advance(walker, 0.01, 200);
  check_same_step(&shape, runner, walker);
  const dvi_counters ran = counters_of(runner), walked = counters_of(walker);
  ck_assert_int_eq(ran.certified, walked.certified);
  ck_assert_int_eq(ran.kinsols, walked.kinsols);
  ck_assert_int_gt(walked.kinsols, 0);
  ck_assert_int_gt(ran.residuals, walked.residuals); /* of what was taken again */
  dvi_integrator_destroy(&runner);
  dvi_integrator_destroy(&walker);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(element_march)
{
  /* states are compared by their checkpoints, and disks may be busy */
  tcase_set_timeout(tests, 120);
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, a_run_has_the_bits_of_single_steps_and_their_rungs, 0, MARCHES);
  tcase_add_loop_test(tests, a_run_that_fails_ends_at_the_last_good_step, 0, 4);
  tcase_add_loop_test(tests, nothing_is_evaluated_twice, 0, 2);
  tcase_add_test(tests, steps_that_are_not_certified_together_are_certified_alone);
}
