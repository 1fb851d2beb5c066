/* A step takes no memory from the heap and gives none back, neither the library's own nor that of
 * SUNDIALS, KLU and LAPACK. The first step that needs a solver prepares it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "step/split/temporal_blocking.h"
#include "support/heap.h"
#include "support/accepted.h"
#include "support/prepared.h"
#include "support/runs.h"
#include "support/suite.h"

enum { STEPS = 60, COORDINATES_MOST = 600, INVARIANTS_MOST = 16 };

/* On fpu's stiff springs (omega h = 5) fixed point iteration gives up where they are not declared
 * quadratic, on the double pendulum it does in mid-run, outer-solar's 72 unknowns of degree 4 go to
 * LAPACK. */
typedef struct place {
  const char *name, *setting;
  double h;
} place;

static const place places[] = {
    {"pendulum", NULL, 0.1},
    {"fpu", "ell=3", 0.1},
    {"fpu", "ell=200", 0.1},
    {"toda", "N=5", 0.1},
    {"toda", "N=300", 0.1},
    {"outer-solar", NULL, 100.0},
    {"double-pendulum", NULL, 0.1},
    {"kepler", "e=0.6", 0.1},
    {"chain", "n=500", 0.1},
    {"vortices", NULL, 0.05},
    {"massless-particle", "gauge=singular", 0.1},
    {"magnetic-pair", NULL, 0.1},
    {"elastica", NULL, 0.1},
};

static const char *const methods[] = {
    "midpoint",
    "dg-phase:degree=3",
    "trapezoidal",
    "galerkin:degree=2",
    "galerkin:degree=2,solver=newton",
    "galerkin:degree=2,solver=kinsol",
    "galerkin:degree=2,solver=fixed-point",
    "galerkin:degree=4,basis=legendre,quadrature=lobatto,nodes=5",
    "galerkin:degree=4,solver=newton",
    "galerkin:degree=5,solver=simplified",
    "galerkin:degree=8,solver=certified",
    "galerkin:degree=4,solver=kinsol",
    "composition:order=4,base=midpoint",
    "composition:order=6,base=galerkin,degree=2,solver=newton",
    "verlet",
    "imex",
    "imex:solver=newton",
    "composition:order=8,base=imex",
    "respa",
    "respa:substeps=exact",
    "trig",
    "multiscale:fast=0,omega=5",
    "flow-galerkin",
    "composition:order=8,base=verlet",
    "verlet:threads=3",
    "composition:order=6,base=verlet,threads=2",
    "vprk:nodes=3",
    "dvi-trapezoidal",
    "dvrk:nodes=3",
    "hp:type=3,quadrature=gauss",
    "dg:stiffness=1",
    "dg-phase",
    "hamiltonian:degree=3",
    "hamiltonian:type=3,degree=2,quadrature=radau-right",
};
enum { PLACES = sizeof places / sizeof *places, METHODS = sizeof methods / sizeof *methods };

/* Case number `which` is one method at one place. */
static accepted_cases pairs;

static int pair_is_accepted(int which)
{
  const place *at = &places[which / METHODS];
  return method_accepts_problem(at->name, at->setting, methods[which % METHODS]);
}

/* The long one of fpu has springs that are taken implicitly in no iteration. Methods that split
 * need them declared. */
static problem *create_place(const place *at, const char *method)
{
  const int splits = strncmp(method, "galerkin", 8) != 0 && strcmp(method, "midpoint") != 0;
  const int is_long = at->setting != NULL && strcmp(at->setting, "ell=200") == 0;
  return splits || !is_long ? create_problem(at->name, at->setting)
                            : create_undeclared_problem(at->name, at->setting);
}

/* Of 429 pairs. Many of the methods are for one-forms or for split potentials, which few places
 * have. */
START_TEST(every_place_is_taken_by_the_methods_for_it)
{
  check_accepted_cases(&pairs, 207, METHODS, methods);
}
END_TEST

/* SUNDIALS 7 puts the message of a failed solve, which the library discards, into memory of its
 * own, one block that is taken and given back. */
static long calls_of_messages(const dvi_integrator *integrator)
{
  dvi_counters counters;
  dvi_integrator_counters(integrator, &counters);
  return atoi(dvi_reference_version()) >= 7 ? 2 * counters.kinsols : 0;
}

/* Counts heap calls of some steps, without preparations. Their length changes, and with it the
 * tables of the continued path. The first step must succeed. verlet and the trapezoidal rule soon
 * blow up on the stiff springs, but a step that fails shall take no memory, either. */
static long calls_of_steps(dvi_integrator *integrator, double h, int steps)
{
  long calls = 0;
  for (int i = 0; i < steps; i++) {
    dvi_status status;
    calls += count_calls_of_step(integrator, i % 3 == 2 ? 0.9 * h : h, &status);
    if (status != DVI_OK && steps == 1) ck_abort_msg("%s", dvi_last_error());
  }
  return calls;
}

START_TEST(no_step_allocates_but_to_prepare_a_solver)
{
  const place *at = &places[pairs.which[_i] / METHODS];
  const char *method = methods[pairs.which[_i] % METHODS];
  problem *model = create_place(at, method);
  dvi_integrator *integrator = start_integrator(model, method);
  const dvi_counters created = read_counters(integrator);
  ck_assert_int_gt(created.allocations, 0);
  const long first = calls_of_steps(integrator, at->h, 1);
  const long later = calls_of_steps(integrator, at->h, repeats(STEPS));
  const long back = calls_of_steps(integrator, -at->h, 2);
  const dvi_counters after = read_counters(integrator);
  ck_assert_msg(first == 0 && later + back <= calls_of_messages(integrator),
                "%s, %s: %ld, %ld and %ld heap calls", at->name, method, first, later, back);
  ck_assert_int_le(after.preparations, PREPARATIONS_MOST);
  if (after.preparations == created.preparations)
    ck_assert_int_eq(after.allocations, created.allocations);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Fallbacks and searches included (the pendulum near its separatrix has both). Not at steps so long
 * that KLU must choose other pivots. */
static const struct {
  const char *name, *setting, *method;
  double h;
} chosen[] = {
    {"kepler", "e=0.3", "sem:degree=2", 0.1},
    {"kepler", "e=0.8", "sem", 0.01},
    {"pendulum", "q0=1e-3", "sem", 0.1},
    {"henon-heiles", NULL, "sem:degree=2,quadrature=lobatto,solver=kinsol", 0.1},
    {"driven-pendulum", NULL, "sem:degree=2,hmax=0.3", 0.1},
    {"fpu", "ell=40", "sem:degree=2", 0.01},
    {"kepler", "e=0.6", "shooting", 0.1},
    {"pendulum", NULL, "shooting:onestep=heun,tolerance=1e-9", 0.1},
    {"double-pendulum", NULL, "shooting:onestep=gauss", 0.05},
    {"toda", "N=5", "shooting:solve=stages", 0.1},
    {"double-pendulum", NULL, "shooting:onestep=taylor,quadrature=euler-maclaurin", 0.01},
    {"damped-driven", NULL, "verlet", 0.1},
    {"magnetic-bottle", NULL, "boris", 0.1},
    {"magnetic-bottle", NULL, "galerkin:degree=3", 0.5},
    {"damped-driven", NULL, "galerkin:degree=3", 0.5},
    {"damped-driven", NULL, "composition:order=4", 0.1},
};

START_TEST(steps_of_chosen_lengths_do_not_allocate)
{
  problem *model = create_problem(chosen[_i].name, chosen[_i].setting);
  dvi_integrator *integrator = start_integrator(model, chosen[_i].method);
  const int steps = repeats(4 * STEPS);
  long calls = 0;
  for (int i = 0; i < steps; i++) {
    dvi_status status;
    calls += count_calls_of_step(integrator, chosen[_i].h, &status);
    if (status != DVI_OK) ck_abort_msg("%s", dvi_last_error());
  }
  ck_assert_int_le(calls, calls_of_messages(integrator));
  ck_assert_int_le(read_counters(integrator).preparations, PREPARATIONS_MOST);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

static int ask_between_steps(dvi_integrator *integrator, double t)
{
  double value[INVARIANTS_MOST], q[COORDINATES_MOST], v[COORDINATES_MOST];
  return dvi_integrator_invariants(integrator, value) ||
         dvi_integrator_interpolate(integrator, t, q, v);
}

/* The first call makes room for velocities. */
START_TEST(invariants_and_dense_output_allocate_once)
{
  const place *at = &places[pairs.which[_i] / METHODS];
  const char *method = methods[pairs.which[_i] % METHODS];
  problem *model = create_place(at, method);
  ck_assert_int_le(model->nq, COORDINATES_MOST);
  ck_assert_int_le(dvi_system_invariant_count(model->system), INVARIANTS_MOST);
  dvi_integrator *integrator = start_integrator(model, method);
  (void)calls_of_steps(integrator, at->h, 2);
  const double t = dvi_integrator_time(integrator) - 0.3 * at->h;
  int failed = ask_between_steps(integrator, t);
  const long before = heap_calls();
  failed = failed || ask_between_steps(integrator, t);
  const long calls = heap_calls() - before; /* Check's own assertions allocate */
  ck_assert_msg(!failed, "%s", dvi_last_error());
  ck_assert_msg(calls == 0, "%s, %s: %ld heap calls", at->name, method, calls);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* The midpoint rule has no solution here, at pericentre. The step goes through the ladder and along
 * the branch from h = 0 to a sentence. */
START_TEST(a_step_that_fails_does_not_allocate)
{
  problem *model = create_problem("kepler", "e=0.6");
  dvi_integrator *integrator = start_integrator(model, "midpoint");
  long calls = 0;
  for (int k = 1; k <= 3; k++) {
    dvi_status status;
    calls += count_calls_of_step(integrator, 0.3, &status);
    ck_assert_int_gt(status, 0);
    ck_assert_int_eq(read_counters(integrator).failed_steps, k);
    ck_assert_int_eq(read_counters(integrator).followed, k);
  }
  ck_assert_int_le(calls, calls_of_messages(integrator));
  /* frozen systems, whole ones, room for the branch */
  ck_assert_int_eq(read_counters(integrator).preparations, 3);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Else the zeros above would say nothing about the solvers. */
START_TEST(the_places_reach_every_solver)
{
  problem *model = create_undeclared_problem("fpu", "ell=200");
  dvi_integrator *integrator = start_integrator(model, "galerkin:degree=2");
  dvi_counters counters;
  (void)calls_of_steps(integrator, 0.1, STEPS);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_gt(counters.simplified, 0);
  dvi_integrator_destroy(&integrator);
  integrator = start_integrator(model, "galerkin:degree=4,solver=newton");
  (void)calls_of_steps(integrator, 0.1, STEPS);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_gt(counters.newtons, 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
  model = create_problem("outer-solar", NULL);
  integrator = start_integrator(model, "galerkin:degree=4,solver=kinsol");
  (void)calls_of_steps(integrator, 100.0, 3);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_eq(counters.kinsols, 3);
  ck_assert_int_eq(counters.symbolic, 0); /* dense LU */
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(no_allocation)
{
  if (!heap_is_counted()) {
    (void)puts("heap calls cannot be counted here: skipped");
    return;
  }
  dvi__blocking_choose_block(16); /* the chain of 500 is long enough for three threads then */
  find_accepted_cases(PLACES * METHODS, pair_is_accepted, &pairs);
  tcase_add_test(tests, every_place_is_taken_by_the_methods_for_it);
  tcase_add_loop_test(tests, no_step_allocates_but_to_prepare_a_solver, 0, pairs.count);
  tcase_add_loop_test(tests, steps_of_chosen_lengths_do_not_allocate, 0,
                      (int)(sizeof chosen / sizeof *chosen));
  tcase_add_loop_test(tests, invariants_and_dense_output_allocate_once, 0, pairs.count);
  tcase_add_test(tests, a_step_that_fails_does_not_allocate);
  tcase_add_test(tests, the_places_reach_every_solver);
}
