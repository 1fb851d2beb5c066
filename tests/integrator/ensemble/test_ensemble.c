/* labels: invariant */
/* Every member of an ensemble has the bits of an integrator of its own, at every level of
 * instructions, for every number of threads and every grouping; and what it counts is what they
 * count together. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "support/accepted.h"
#include "support/heap.h"
#include "support/prepared.h"
#include "support/runs.h"
#include "support/suite.h"

enum { N_MOST = 64, MEMBERS_MOST = 100, INVARIANTS_MOST = 16 };

static void use_best_level(void)
{
  dvi__lanes_choose(-1);
}

/* ---- members and their twins ---- */

/* Makes initial states near the problem's own, no two alike, component-major. */
static double first_q[N_MOST * MEMBERS_MOST], first_p[N_MOST * MEMBERS_MOST];

static void copy_member(int n, int members, int k, const double *all, double *one)
{
  for (int i = 0; i < n; i++) one[i] = all[i * members + k];
}

/* p = alpha(q), where there is a one-form. */
static void constrain(const problem *model, int members, int k)
{
  double q[N_MOST], p[N_MOST];
  copy_member(model->nq, members, k, first_q, q);
  ck_assert_int_eq(dvi_system_momentum(model->system, 0, q, model->v, p), DVI_OK);
  for (int i = 0; i < model->nq; i++) first_p[i * members + k] = p[i];
}

/* With factors the places stay on their manifold, and the momenta in its tangent spaces. With
 * nonholonomic constraints, too, the momenta fulfil these. */
static void spread_momenta(const problem *model, int members, double spread)
{
  for (int k = 0; k < members; k++) {
    for (int i = 0; i < model->nq; i++) first_q[i * members + k] = model->q[i];
    for (int i = 0; i < model->nv; i++)
      first_p[i * members + k] = model->p[i] * (1 + spread * k / members);
  }
}

static void spread_start(const problem *model, int members, double spread)
{
  ck_assert_int_le(model->nq, N_MOST);
  ck_assert_int_le(members, MEMBERS_MOST);
  if (model->terms->factors != NULL || model->terms->nonholonomic_count > 0) {
    spread_momenta(model, members, spread);
    return;
  }
  for (int k = 0; k < members; k++)
    for (int i = 0; i < model->nq; i++) {
      const double u = fmod(0.618033988749895 * (k * model->nq + i + 1), 1.0) - 0.5;
      first_q[i * members + k] = model->q[i] + spread * u * (1 + fabs(model->q[i]));
      first_p[i * members + k] = model->p[i] * (1 + spread * u);
    }
  for (int k = 0; k < members && model->terms->one_form != NULL; k++) constrain(model, members, k);
}

static void start_all(dvi_ensemble *e)
{
  ck_assert_msg(dvi_ensemble_start(e, 0.25, first_q, first_p) == DVI_OK, "%s", dvi_last_error());
}

/* An integrator that runs member k alone. */
static dvi_integrator *create_member_twin(const dvi_system *system, const char *method, int members,
                                          int k)
{
  double q[N_MOST], p[N_MOST];
  dvi_integrator *made = create_integrator(system, method);
  copy_member(dvi_system_nq(system), members, k, first_q, q);
  copy_member(dvi_system_nv(system), members, k, first_p, p);
  ck_assert_msg(dvi_integrator_start(made, 0.25, q, p) == DVI_OK, "%s", dvi_last_error());
  return made;
}

/* Member k and its twin have the same time, coordinates, momenta and invariants. */
static void same_member(dvi_ensemble *e, int k, dvi_integrator *single)
{
  static double t[MEMBERS_MOST], q[N_MOST * MEMBERS_MOST], p[N_MOST * MEMBERS_MOST];
  double q_k[N_MOST], p_k[N_MOST], here[INVARIANTS_MOST], there[INVARIANTS_MOST],
      t_single = dvi_integrator_time(single);
  const dvi_system *system = dvi_integrator_system(single);
  const int n = dvi_system_nq(system), nv = dvi_system_nv(system),
            members = dvi_ensemble_members(e), invariants = dvi_system_invariant_count(system);
  ck_assert_int_le(invariants, INVARIANTS_MOST);
  ck_assert_int_eq(dvi_ensemble_state(e, t, q, p), DVI_OK);
  copy_member(n, members, k, q, q_k), copy_member(nv, members, k, p, p_k);
  ck_assert_mem_eq(&t[k], &t_single, sizeof(double));
  ck_assert_mem_eq(q_k, dvi_integrator_q(single), (size_t)n * sizeof(double));
  ck_assert_mem_eq(p_k, dvi_integrator_p(single), (size_t)nv * sizeof(double));
  /* A run that has blown up has no energy, on both sides. */
  const dvi_status status = dvi_integrator_invariants(single, there);
  ck_assert_int_eq(dvi_ensemble_invariants(e, k, here), status);
  if (status == DVI_OK) ck_assert_mem_eq(here, there, (size_t)invariants * sizeof(double));
}

static void add(const dvi_counters *some, dvi_counters *sum)
{
  const long *from = (const long *)(const void *)some;
  long *to = (long *)(void *)sum;
  for (size_t i = 0; i < sizeof *sum / sizeof(long); i++) to[i] += from[i];
}

/* But for memory, what making an integrator counts, factors that all members share since the length
 * of the step alone matters, and the frozen Jacobians that another member has displaced. */
static void check_counters(dvi_counters got, dvi_counters wanted, const dvi_counters *creation,
                           int members)
{
  wanted.factorizations -= (members - 1) * creation->factorizations;
  wanted.hessians -= (members - 1) * creation->hessians;
  if (wanted.residuals == 0 && wanted.factorizations > got.factorizations) {
    ck_assert_int_eq(got.factorizations * members, wanted.factorizations);
    got.factorizations = wanted.factorizations;
  }
  ck_assert_int_le(got.symbolic, wanted.symbolic); /* once for a thread, or not at all */
  ck_assert_int_eq(got.symbolic > 0, wanted.symbolic > 0);
  ck_assert_int_eq(got.preparations > 0, wanted.preparations > 0);
  ck_assert_int_le(got.preparations, wanted.preparations);
  got.symbolic = wanted.symbolic, got.preparations = wanted.preparations;
  got.allocations = wanted.allocations = 0;
  if (wanted.simplified > 0) {
    ck_assert_int_ge(got.jacobians, wanted.jacobians);
    ck_assert_int_eq(got.hessians - wanted.hessians, got.jacobians - wanted.jacobians);
    ck_assert_int_ge(got.factorizations, wanted.factorizations);
    got.jacobians = wanted.jacobians, got.hessians = wanted.hessians,
    got.factorizations = wanted.factorizations;
  }
  ck_assert_mem_eq(&got, &wanted, sizeof got);
}

/* ---- places ---- */

/* The chain of 40 takes temporal blocking, that of 8 goes in lanes. fpu at h = 0.1 is stiff, and
 * fixed-point iteration fails. At h = 0.02 it fails for some members and steps, and at pericentre
 * kepler's goes through all solvers. */
typedef struct place {
  const char *problem, *setting;
  double h, spread;
} place;
static const place places[] = {{"kepler", NULL, 0.05, 0.1},
                               {"kepler", "e=0.8", 0.2, 0.02},
                               {"pendulum", NULL, 0.1, 0.5},
                               {"fpu", "ell=3", 0.1, 0.1},
                               {"fpu", "ell=3", 0.03, 0.3},
                               {"outer-solar-jacobi", NULL, 200, 0.01},
                               {"double-pendulum", NULL, 0.05, 0.3},
                               {"henon-heiles", NULL, 0.2, 0.1},
                               {"chain", "n=8", 0.1, 0.1},
                               {"chain", "n=40", 0.1, 0.1},
                               {"magnetic-bottle", NULL, 0.1, 0.1},
                               {"sleigh", NULL, 0.05, 0.1},
                               {"vortices", NULL, 0.05, 0.01},
                               {"massless-particle", "gauge=singular", 0.1, 0.01},
                               {"elastica", NULL, 0.1, 0.01},
                               {"free-body", NULL, 0.1, 0.01},
                               {"spherical-double-pendulum", NULL, 0.01, 0.01}};

static const char *const methods[] = {
    "verlet",
    "verlet:blocking=none",
    "midpoint",
    "midpoint:solver=fixed-point",
    "trapezoidal",
    "galerkin",
    "galerkin:degree=3,basis=legendre,quadrature=lobatto",
    "galerkin:degree=5",
    "galerkin:degree=8",
    "galerkin:degree=16",
    "galerkin:degree=2,solver=newton",
    "galerkin:degree=2,solver=certified",
    "composition",
    "composition:order=8",
    "composition:order=6,base=galerkin,degree=2",
    "vprk:nodes=3",
    "dg",
    "dg-phase",
    "dg:degree=3,stiffness=1",
    "vprk:projection=symplectic",
    "dvi-a",
    "dvi-b",
    "dvi-midpoint",
    "dvi-trapezoidal",
    "dvrk",
    "vprk:projection=none",
    "hp:type=3",
    "hamiltonian:degree=3",
    "hp:type=4",
    "lie-galerkin",
    "euler-poincare",
    "sphere-galerkin:degree=1",
    "lie-verlet",
    "lie-rk",
    "boris",
    "composition:base=boris",
    "imex",
    "imex:solver=newton",
    "multiscale:fast=0,omega=5",
    "flow-galerkin",
    "flow-galerkin:stages=7",
    "shooting",
    "respa:substeps=5",
    "respa:substeps=exact",
    "mollified:filter=projection",
    "trig:filter=gautschi",
    "prolongation-collocation:derivatives=3",
    "nonholonomic",
};
enum {
  PLACES = sizeof places / sizeof *places,
  METHODS = sizeof methods / sizeof *methods,
  STEPS = 12
};

/* But sem and moreau-jean, which are refused (tests/method/element/test_sem.c,
 * tests/system/test_contacts_declared.c), and langevin, whose members have streams of their own
 * (test_noise.c). */
START_TEST(every_method_has_its_place)
{
  for (int i = 0; i < dvi_method_count(); i++) {
    if (strcmp(dvi_method_name(i), "sem") == 0) continue;
    if (strcmp(dvi_method_name(i), "moreau-jean") == 0) continue;
    if (strcmp(dvi_method_name(i), "langevin") == 0) continue;
    const size_t length = strlen(dvi_method_name(i));
    int found = 0;
    for (int k = 0; k < METHODS; k++)
      found += strcspn(methods[k], ":") == length &&
               strncmp(methods[k], dvi_method_name(i), length) == 0;
    ck_assert_msg(found > 0, "%s", dvi_method_name(i));
  }
}
END_TEST

/* One way to run an ensemble beside the twins, which take the same steps. Some members may fail, on
 * both sides. */
static void compare_with_twins(const problem *model, const char *method, double h,
                               dvi_ensemble_options options)
{
  dvi_counters wanted = {0}, got, creation, single;
  dvi_ensemble *e = create_ensemble(model->system, method, options);
  dvi_integrator *probe = create_integrator(model->system, method);
  dvi_integrator_counters(probe, &creation);
  dvi_integrator_destroy(&probe);
  start_all(e);
  dvi_status worst = dvi_ensemble_advance(e, h, STEPS - 3);
  if (worst == DVI_OK) worst = dvi_ensemble_step(e, h);
  if (worst == DVI_OK) worst = dvi_ensemble_advance(e, -0.7 * h, 2);
  dvi_ensemble_counters(e, &got);
  for (int k = 0; k < options.members; k++) {
    dvi_integrator *alone = create_member_twin(model->system, method, options.members, k);
    dvi_status status = DVI_OK;
    for (int i = 0; i < (worst == DVI_OK ? STEPS : STEPS - 3) && status == DVI_OK; i++)
      status = dvi_integrator_step(alone, i < STEPS - 2 ? h : -0.7 * h);
    ck_assert_int_eq(dvi_ensemble_status(e, k), status);
    dvi_integrator_counters(alone, &single);
    ck_assert_int_eq(dvi_ensemble_steps(e, k), single.steps);
    add(&single, &wanted);
    same_member(e, k, alone);
    dvi_integrator_destroy(&alone);
  }
  check_counters(got, wanted, &creation, options.members);
  dvi_ensemble_destroy(&e);
}

/* Case number `which` is one method at one place. */
static accepted_cases pairs;

static int pair_is_accepted(int which)
{
  const place *at = &places[which / METHODS];
  return method_accepts_problem(at->problem, at->setting, methods[which % METHODS]);
}

/* Of 602 pairs. Half of the methods are for one-forms, for factors or for split potentials, which
 * few places have. */
START_TEST(every_place_is_taken_by_the_methods_for_it)
{
  check_accepted_cases(&pairs, 288, METHODS, methods);
}
END_TEST

START_TEST(every_member_has_the_bits_of_a_run_alone)
{
  const place *at = &places[pairs.which[sampled_case(_i)] / METHODS];
  problem *model = create_problem(at->problem, at->setting);
  spread_start(model, 21, at->spread);
  compare_with_twins(model, methods[pairs.which[sampled_case(_i)] % METHODS], at->h,
                     (dvi_ensemble_options){.members = 21});
  problem_destroy(&model);
}
END_TEST

/* Compares levels, threads and groupings, one after the other, with runs alone at the best
 * level. */
START_TEST(levels_threads_and_groupings_change_no_bit)
{
  static const struct {
    int members, threads, block;
  } ways[] = {{1, 1, 0},  {2, 1, 0},   {7, 3, 2},    {21, 1, 1},   {21, 2, 5},
              {37, 4, 8}, {37, 1, 37}, {100, 1, 64}, {100, 3, 13}, {9, 100, 0}};
  static const char *const some[] = {"verlet", "galerkin", "galerkin:degree=5",
                                     "composition:order=6,base=galerkin,degree=2",
                                     "galerkin:degree=8"};
  const int way = _i % 10, level = _i / 10;
  problem *model = create_problem("kepler", "e=0.5");
  for (int m = 0; m < 5; m++) {
    dvi__lanes_choose(level);
    spread_start(model, ways[way].members, 0.1);
    compare_with_twins(model, some[m], 0.05,
                       (dvi_ensemble_options){.members = ways[way].members,
                                              .threads = ways[way].threads,
                                              .block = ways[way].block});
  }
  problem_destroy(&model);
}
END_TEST

/* Compares the ensemble's state at each level with that of the baseline. `compare` has both sides
 * at one level. */
START_TEST(levels_agree_with_each_other)
{
  static double base_q[N_MOST * MEMBERS_MOST], q[N_MOST * MEMBERS_MOST];
  problem *model = create_problem("outer-solar", NULL);
  spread_start(model, 33, 0.01);
  for (int level = 0; level < dvi__lanes_levels(); level++) {
    dvi__lanes_choose(level);
    dvi_ensemble *e = create_ensemble(model->system, methods[_i],
                                      (dvi_ensemble_options){.members = 33});
    start_all(e);
    ck_assert_msg(dvi_ensemble_advance(e, 50, 20) == DVI_OK, "%s", dvi_last_error());
    ck_assert_int_eq(dvi_ensemble_state(e, NULL, level == 0 ? base_q : q, NULL), DVI_OK);
    if (level > 0) ck_assert_mem_eq(q, base_q, (size_t)model->nq * 33 * sizeof(double));
    dvi_ensemble_destroy(&e);
  }
  problem_destroy(&model);
}
END_TEST

START_TEST(a_start_in_velocities_is_one_in_their_momenta)
{
  problem *model = create_problem("double-pendulum", NULL);
  double v[N_MOST], momentum[N_MOST], p[N_MOST * 5];
  spread_start(model, 5, 0.2);
  dvi_ensemble *e = create_ensemble(model->system, "galerkin",
                                    (dvi_ensemble_options){.members = 5, .threads = 2});
  /* any numbers will do */
  ck_assert_int_eq(dvi_ensemble_start_velocity(e, 0, first_q, first_p), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(e, NULL, NULL, p), DVI_OK);
  for (int k = 0; k < 5; k++) {
    double q[N_MOST];
    copy_member(model->nq, 5, k, first_q, q), copy_member(model->nq, 5, k, first_p, v);
    ck_assert_int_eq(dvi_system_momentum(model->system, 0, q, v, momentum), DVI_OK);
    for (int i = 0; i < model->nq; i++) ck_assert_double_eq(p[i * 5 + k], momentum[i]);
  }
  dvi_ensemble_destroy(&e);
  problem_destroy(&model);
}
END_TEST

/* ---- what is done ---- */

/* A step of verlet takes one gradient for each member, and one more at the start of all. */
START_TEST(verlet_evaluates_once_a_step)
{
  problem *model = create_problem("kepler", NULL);
  dvi_counters before, after;
  spread_start(model, 64, 0.1);
  dvi_ensemble *e = create_ensemble(model->system, "verlet", (dvi_ensemble_options){.members = 64});
  start_all(e);
  dvi_ensemble_counters(e, &before);
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.01, 50), DVI_OK);
  dvi_ensemble_counters(e, &after);
  ck_assert_int_eq(after.gradients - before.gradients, 64 * 51);
  ck_assert_int_eq(after.steps, 64 * 50);
  ck_assert_int_eq(after.residuals, 0);
  dvi_ensemble_destroy(&e);
  problem_destroy(&model);
}
END_TEST

/* In a stiff step simplified Newton's method keeps its Jacobian as long as it serves. Members that
 * go on alone take 1, 2, 4, ... 32 steps at a time. */
START_TEST(a_frozen_jacobian_serves_several_steps)
{
  enum { ALL = 21, SPAN = 63 };
  problem *model = create_undeclared_problem("fpu", "ell=3");
  dvi_counters got, single;
  long alone = 0;
  spread_start(model, ALL, 0.01);
  dvi_ensemble *e = create_ensemble(model->system, "galerkin",
                                    (dvi_ensemble_options){.members = ALL});
  start_all(e);
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.1, SPAN), DVI_OK);
  dvi_ensemble_counters(e, &got);
  for (int k = 0; k < ALL; k++) {
    dvi_integrator *one = create_member_twin(model->system, "galerkin", ALL, k);
    advance(one, 0.1, SPAN);
    dvi_integrator_counters(one, &single);
    alone += single.jacobians;
    dvi_integrator_destroy(&one);
  }
  ck_assert_int_gt(got.simplified, ALL * SPAN / 2);
  ck_assert_int_le(got.jacobians, alone + 7 * ALL);
  dvi_ensemble_destroy(&e);
  problem_destroy(&model);
}
END_TEST

/* But to prepare a solver, which each thread does for all its members. */
START_TEST(no_step_allocates)
{
  const place *at = &places[pairs.which[sampled_case(_i)] / METHODS];
  const char *method = methods[pairs.which[sampled_case(_i)] % METHODS];
  problem *model = create_problem(at->problem, at->setting);
  dvi_counters before, after;
  spread_start(model, 21, 0.05);
  dvi_ensemble *e = create_ensemble(
      model->system, method, (dvi_ensemble_options){.members = 21, .threads = 2, .block = 4});
  start_all(e);
  dvi_ensemble_counters(e, &before);
  ck_assert_int_gt(before.allocations, 0);
  for (int i = 0; i < 6; i++) {
    const long calls = heap_calls();
    (void)(i == 0 ? dvi_ensemble_advance(e, at->h, 4) : dvi_ensemble_step(e, at->h));
    const long made = heap_calls() - calls;
    dvi_ensemble_counters(e, &after);
    /* SUNDIALS 7 keeps those of failed solves */
    const long messages = atoi(dvi_reference_version()) >= 7 ? 2 * after.kinsols : 0;
    const int prepared = after.preparations > before.preparations;
    ck_assert_msg(prepared || made <= messages, "%s: %ld heap calls", method, made);
    if (!prepared) ck_assert_int_eq(after.allocations, before.allocations);
    before = after;
  }
  ck_assert_int_le(after.preparations, 2 * PREPARATIONS_MOST);
  dvi_ensemble_destroy(&e);
  problem_destroy(&model);
}
END_TEST

SUITE(ensemble)
{
  tcase_set_timeout(tests, 120);
  tcase_add_checked_fixture(tests, NULL, use_best_level);
  tcase_add_test(tests, every_method_has_its_place);
  find_accepted_cases(PLACES * METHODS, pair_is_accepted, &pairs);
  tcase_add_test(tests, every_place_is_taken_by_the_methods_for_it);
  tcase_add_loop_test(tests, every_member_has_the_bits_of_a_run_alone, 0,
                      sampled_count(pairs.count));
  tcase_add_loop_test(tests, levels_threads_and_groupings_change_no_bit, 0,
                      10 * dvi__lanes_levels());
  tcase_add_loop_test(tests, levels_agree_with_each_other, 0, 9);
  tcase_add_test(tests, a_start_in_velocities_is_one_in_their_momenta);
  tcase_add_test(tests, verlet_evaluates_once_a_step);
  tcase_add_test(tests, a_frozen_jacobian_serves_several_steps);
  tcase_add_loop_test(tests, no_step_allocates, 0, sampled_count(pairs.count));
}
