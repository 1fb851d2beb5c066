/* labels: unit */
/* In sweeps of parameters members with systems of their own have the bits of integrators of these
 * systems. */
#include <string.h>

#include "support/accepted.h"
#include "support/runs.h"
#include "support/suite.h"

enum { SYSTEMS = 4, EACH = 6, MEMBERS = SYSTEMS * EACH, N_MOST = 32 };

static problem *model[SYSTEMS];
static const dvi_system *systems[MEMBERS];
static double q[N_MOST * MEMBERS], p[N_MOST * MEMBERS];

static const struct {
  const char *problem, *setting[SYSTEMS];
} sweeps[] = {{"oscillator", {"k=1", "k=2", "k=4", "k=1600"}},
              {"fpu", {"omega=50", "omega=10", "omega=20", "omega=5"}},
              {"henon-heiles", {NULL, NULL, NULL, NULL}},
              {"double-pendulum", {"m1=1", "m1=2", "m1=3", "m1=4"}},
              {"chain", {"beta=0.1", "beta=0.2", "beta=0.3", "beta=0"}},
              {"oscillators", {"omega=10", "omega=20", "omega=40", "omega=5"}},
              {"damped-driven", {"c=0.1", "c=1", "f=2", "omega=1"}},
              {"magnetic-bottle", {"B=0.5", "B=1", "B=2", "l=3"}}};
enum {
  OSCILLATOR,
  FPU,
  HENON_HEILES,
  DOUBLE_PENDULUM,
  CHAIN,
  OSCILLATORS,
  DAMPED_DRIVEN,
  MAGNETIC_BOTTLE,
  SWEEPS
};

static const char *const methods[] = {"verlet", "galerkin", "galerkin:degree=8",
                                      "galerkin:degree=3,solver=newton",
                                      "composition:order=6,base=midpoint"};
enum { METHODS = 5 };

/* Makes the members. With `interleaved` neighbours have different systems. */
static void make_sweep(int which, int interleaved)
{
  for (int s = 0; s < SYSTEMS; s++)
    model[s] = create_problem(sweeps[which].problem, sweeps[which].setting[s]);
  const int n = model[0]->nq;
  ck_assert_int_le(n, N_MOST);
  for (int k = 0; k < MEMBERS; k++) {
    const problem *own = model[interleaved ? k % SYSTEMS : k / EACH];
    systems[k] = own->system;
    for (int i = 0; i < n; i++) {
      q[i * MEMBERS + k] = own->q[i] * (1 + 0.01 * (k % 7));
      p[i * MEMBERS + k] = own->p[i];
    }
  }
}

static void clear_sweep(void)
{
  for (int s = 0; s < SYSTEMS; s++) problem_destroy(&model[s]);
}

static void same_as_alone(dvi_ensemble *e, const char *method, double h, int steps)
{
  static double t_all[MEMBERS], q_all[N_MOST * MEMBERS], p_all[N_MOST * MEMBERS];
  ck_assert_int_eq(dvi_ensemble_state(e, t_all, q_all, p_all), DVI_OK);
  for (int k = 0; k < MEMBERS; k++) {
    double q_k[N_MOST], p_k[N_MOST], here[16], there[16];
    const int n = dvi_system_nq(systems[k]);
    for (int i = 0; i < n; i++) q_k[i] = q[i * MEMBERS + k], p_k[i] = p[i * MEMBERS + k];
    dvi_integrator *alone = create_integrator(systems[k], method);
    ck_assert_int_eq(dvi_integrator_start(alone, 0, q_k, p_k), DVI_OK);
    advance(alone, h, steps);
    for (int i = 0; i < n; i++) {
      ck_assert_mem_eq(&q_all[i * MEMBERS + k], dvi_integrator_q(alone) + i, sizeof(double));
      ck_assert_mem_eq(&p_all[i * MEMBERS + k], dvi_integrator_p(alone) + i, sizeof(double));
    }
    ck_assert_int_eq(dvi_ensemble_invariants(e, k, here), DVI_OK);
    ck_assert_int_eq(dvi_integrator_invariants(alone, there), DVI_OK);
    ck_assert_mem_eq(here, there, (size_t)dvi_system_invariant_count(systems[k]) * sizeof(double));
    dvi_integrator_destroy(&alone);
  }
}

static void check_bits_of_runs_alone(int which, int interleaved, const char *method)
{
  dvi_ensemble *e = NULL;
  make_sweep(which, interleaved);
  const dvi_ensemble_options options = {.members = MEMBERS, .threads = 2, .systems = systems};
  ck_assert_msg(dvi_ensemble_create(NULL, method, &options, &e) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_ensemble_start(e, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_ensemble_advance(e, 0.02, 10) == DVI_OK, "%s", dvi_last_error());
  same_as_alone(e, method, 0.02, 10);
  dvi_ensemble_destroy(&e);
  clear_sweep();
}

static accepted_cases cases;

static int case_is_accepted(int which)
{
  const int sweep = which / METHODS % SWEEPS;
  return method_accepts_problem(sweeps[sweep].problem, sweeps[sweep].setting[0],
                                methods[which % METHODS]);
}

/* verlet wants a constant mass, which the double pendulum has not, and no vector potential. */
START_TEST(one_method_refuses_two_systems)
{
  ck_assert_int_eq(cases.count, 2 * (SWEEPS * METHODS - 2));
}
END_TEST

START_TEST(members_with_systems_of_their_own_have_the_bits_of_runs_alone)
{
  const int which = cases.which[_i];
  check_bits_of_runs_alone(which / METHODS % SWEEPS, which / METHODS / SWEEPS,
                           methods[which % METHODS]);
}
END_TEST

/* Parts, modes and factors belong to one system. */
static const struct {
  int sweep;
  const char *method;
} splits[] = {{OSCILLATORS, "imex"},
              {OSCILLATORS, "imex:solver=newton"},
              {OSCILLATORS, "respa:substeps=7"},
              {OSCILLATORS, "respa:substeps=exact"},
              {OSCILLATORS, "mollified"},
              {OSCILLATORS, "trig"},
              {OSCILLATORS, "multiscale"},
              {OSCILLATORS, "multiscale:omega=10"},
              {OSCILLATORS, "composition:base=imex"},
              {FPU, "imex"},
              {FPU, "trig:filter=gautschi"},
              {FPU, "multiscale"}};
enum { SPLITS = sizeof splits / sizeof *splits };

START_TEST(methods_that_split_have_the_parts_of_each_members_system)
{
  check_bits_of_runs_alone(splits[_i / 2].sweep, _i % 2, splits[_i / 2].method);
}
END_TEST

/* A block has an integrator of its own, and each member's system is asked for its Hessian once. */
START_TEST(neighbours_with_one_system_share_its_modes)
{
  make_sweep(OSCILLATORS, 0);
  dvi_ensemble *e = NULL;
  dvi_counters counters;
  const dvi_ensemble_options options = {.members = MEMBERS, .systems = systems};
  ck_assert_int_eq(dvi_ensemble_create(NULL, "trig", &options, &e), DVI_OK);
  dvi_ensemble_counters(e, &counters);
  ck_assert_int_eq(counters.hessians, SYSTEMS);
  dvi_ensemble_destroy(&e);
  clear_sweep();
}
END_TEST

START_TEST(systems_that_are_not_alike_are_refused)
{
  problem *one = create_problem("kepler", NULL), *other = create_problem("henon-heiles", NULL);
  const dvi_system *pair[] = {one->system, other->system};
  dvi_ensemble *e = NULL;
  ck_assert_int_eq(dvi_ensemble_create(NULL, "verlet",
                                       &(dvi_ensemble_options){.members = 2, .systems = pair}, &e),
                   DVI_BAD_ARGUMENT);
  check_words("member 1 is not like that of member 0");
  ck_assert_ptr_null(e);
  problem_destroy(&one);
  problem_destroy(&other);
}
END_TEST

static int quartic(double t, const double *x, double *V, void *user)
{
  (void)t;
  *V = *(const double *)user * x[0] * x[0] * x[0] * x[0];
  return 0;
}

static int quartic_gradient(double t, const double *x, double *V_q, void *user)
{
  (void)t;
  V_q[0] = 4 * *(const double *)user * x[0] * x[0] * x[0];
  return 0;
}

START_TEST(a_derivative_that_only_one_system_gives_is_refused)
{
  double strength = 1;
  dvi_potential potential = {.value = quartic, .gradient = quartic_gradient, .user = &strength};
  const dvi_system_terms terms = {
      .dimension = 1, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  dvi_system *with = NULL, *without = NULL;
  dvi_ensemble *e = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &with), DVI_OK);
  potential.gradient = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &without), DVI_OK);
  const dvi_system *pair[] = {with, without};
  ck_assert_int_eq(dvi_ensemble_create(NULL, "verlet",
                                       &(dvi_ensemble_options){.members = 2, .systems = pair}, &e),
                   DVI_BAD_ARGUMENT);
  check_words("a derivative is given in one");
  dvi_system_destroy(&with);
  dvi_system_destroy(&without);
}
END_TEST

static int spring(double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  *V = 50 * x[0] * x[0];
  return 0;
}

static int spring_gradient(double t, const double *x, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = 100 * x[0];
  return 0;
}

START_TEST(slow_potentials_are_those_of_each_member)
{
  static const char *const split[] = {"imex", "respa",      "respa:substeps=exact", "mollified",
                                      "trig", "multiscale", "composition:base=imex"};
  static double strength[2] = {1, 5};
  dvi_system *made[2];
  const double x[] = {1, 1}, rest[] = {0, 0};
  double end[2];
  for (int s = 0; s < 2; s++) {
    const dvi_potential pair[] = {
        {.value = spring, .gradient = spring_gradient, .fast = 1, .quadratic = 1},
        {.value = quartic, .gradient = quartic_gradient, .user = &strength[s]}};
    const dvi_system_terms terms = {
        .dimension = 1, .mass.scalar = 1, .potentials = pair, .potential_count = 2};
    ck_assert_int_eq(dvi_system_create(&terms, &made[s]), DVI_OK);
  }
  const dvi_system *const both[] = {made[0], made[1]};
  dvi_ensemble *e = NULL;
  ck_assert_int_eq(dvi_ensemble_create(NULL, split[_i],
                                       &(dvi_ensemble_options){.members = 2, .systems = both}, &e),
                   DVI_OK);
  ck_assert_int_eq(dvi_ensemble_start(e, 0, x, rest), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.05, 10), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_state(e, NULL, end, NULL), DVI_OK);
  for (int s = 0; s < 2; s++) {
    dvi_integrator *alone = create_integrator(made[s], split[_i]);
    ck_assert_int_eq(dvi_integrator_start(alone, 0, x, rest), DVI_OK);
    advance(alone, 0.05, 10);
    ck_assert_mem_eq(&end[s], dvi_integrator_q(alone), sizeof(double));
    dvi_integrator_destroy(&alone);
  }
  dvi_ensemble_destroy(&e);
  for (int s = 0; s < 2; s++) dvi_system_destroy(&made[s]);
}
END_TEST

static int quartic_range(double t, const double *x, int first, int last, double *V_q, void *user)
{
  (void)t;
  for (int i = first; i < last; i++)
    V_q[i - first] = i == 0 ? 4 * *(const double *)user * x[0] * x[0] * x[0] : 0;
  return 0;
}

/* Waves are made once, for all systems. */
START_TEST(a_reach_of_its_own_is_refused)
{
  double strength = 1;
  dvi_potential potential = {.value = quartic, .gradient = quartic_gradient, .user = &strength};
  const dvi_system_terms terms = {
      .dimension = 1, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  dvi_system *whole = NULL, *near = NULL, *far = NULL;
  dvi_ensemble *e = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &whole), DVI_OK);
  potential.gradient_range = quartic_range;
  ck_assert_int_eq(dvi_system_create(&terms, &near), DVI_OK);
  potential.reach = 3;
  ck_assert_int_eq(dvi_system_create(&terms, &far), DVI_OK);
  const dvi_system *pairs[][2] = {{whole, near}, {near, whole}, {near, far}};
  for (int i = 0; i < 3; i++) {
    ck_assert_int_eq(dvi_ensemble_create(NULL, "verlet",
                                         &(dvi_ensemble_options){.members = 2, .systems = pairs[i]},
                                         &e),
                     DVI_BAD_ARGUMENT);
    check_words("gradient_range");
  }
  dvi_system_destroy(&whole);
  dvi_system_destroy(&near);
  dvi_system_destroy(&far);
}
END_TEST

/* Counts calls, not points, because neighbours with one system share them. */
static int calls;

static int counted_gradient(int count, const double *t, const double *x, double *V_q, void *user)
{
  (void)t;
  calls++;
  for (int k = 0; k < count; k++) V_q[k] = *(const double *)user * x[k];
  return 0;
}

START_TEST(neighbours_with_one_system_share_a_call)
{
  double strength[2] = {1, 2}, x[MEMBERS] = {0}, momentum[MEMBERS];
  dvi_system *made[2];
  for (int s = 0; s < 2; s++) {
    const dvi_potential potential = {
        .value = quartic, .gradient_batch = counted_gradient, .user = &strength[s]};
    const dvi_system_terms terms = {
        .dimension = 1, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
    ck_assert_int_eq(dvi_system_create(&terms, &made[s]), DVI_OK);
  }
  for (int k = 0; k < MEMBERS; k++) systems[k] = made[2 * k / MEMBERS], momentum[k] = 1;
  dvi_ensemble *e = NULL;
  const dvi_ensemble_options options = {.members = MEMBERS, .systems = systems};
  ck_assert_int_eq(dvi_ensemble_create(NULL, "verlet", &options, &e), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_start(e, 0, x, momentum), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_step(e, 0.1), DVI_OK);
  calls = 0;
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.1, 10), DVI_OK);
  /* 12 members of a system make a block of 12, or two of 8 and 4. */
  ck_assert_int_ge(calls, 20);
  ck_assert_int_le(calls, 40);
  dvi_ensemble_destroy(&e);
  for (int s = 0; s < 2; s++) dvi_system_destroy(&made[s]);
}
END_TEST

/* ---- constraints ---- */

/* H = |p|^2/2 + y on a circle of radius r, with phi = (|q|^2 - r^2)/2 and q.p. */
static int H(double t, const double *x, const double *momentum, double *value, void *user)
{
  (void)t, (void)user;
  *value = (momentum[0] * momentum[0] + momentum[1] * momentum[1]) / 2 + x[1];
  return 0;
}

static int H_gradient(double t, const double *x, const double *momentum, double *H_q, double *H_p,
                      void *user)
{
  (void)t, (void)x, (void)user;
  H_q[0] = 0;
  H_q[1] = 1;
  H_p[0] = momentum[0];
  H_p[1] = momentum[1];
  return 0;
}

static int circle(const double *x, const double *momentum, double *value, void *user)
{
  const double r = *(const double *)user;
  value[0] = (x[0] * x[0] + x[1] * x[1] - r * r) / 2;
  value[1] = x[0] * momentum[0] + x[1] * momentum[1];
  return 0;
}

static int circle_gradient(const double *x, const double *momentum, double *phi_z, void *user)
{
  (void)user;
  for (int i = 0; i < 2; i++) {
    phi_z[i] = phi_z[4 + i] = x[i];
    phi_z[2 + i] = momentum[i];
  }
  return 0;
}

START_TEST(circles_of_different_radii_hold_their_own_particles)
{
  static const int start[] = {0, 2, 6}, row[] = {0, 1, 0, 1, 2, 3};
  static double radius[2] = {1, 2};
  const double x[] = {1, 2, 0, 0}, momentum[] = {0, 0, 0.3, 0.3};
  dvi_system *made[2];
  double end[4];
  const dvi_hamiltonian hamiltonian = {.value = H, .gradient = H_gradient};
  for (int s = 0; s < 2; s++) {
    const dvi_constraint constraint = {.count = 2,
                                       .value = circle,
                                       .gradient = circle_gradient,
                                       .gradients = {start, row},
                                       .user = &radius[s]};
    const dvi_system_terms terms = {
        .dimension = 2, .autonomous = 1, .hamiltonian = &hamiltonian, .constraint = &constraint};
    ck_assert_msg(dvi_system_create(&terms, &made[s]) == DVI_OK, "%s", dvi_last_error());
  }
  const dvi_system *const pair[] = {made[0], made[1]};
  dvi_ensemble *e = NULL;
  ck_assert_msg(dvi_ensemble_create(NULL, "dg-phase",
                                    &(dvi_ensemble_options){.members = 2, .systems = pair},
                                    &e) == DVI_OK,
                "%s", dvi_last_error());
  ck_assert_msg(dvi_ensemble_start(e, 0, x, momentum) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_ensemble_advance(e, 0.1, 5) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_ensemble_state(e, NULL, end, NULL), DVI_OK);
  for (int s = 0; s < 2; s++) {
    dvi_integrator *alone = create_integrator(made[s], "dg-phase");
    ck_assert_int_eq(dvi_integrator_start(alone, 0, (double[]){x[s], 0}, (double[]){0, 0.3}),
                     DVI_OK);
    advance(alone, 0.1, 5);
    for (int i = 0; i < 2; i++)
      ck_assert_mem_eq(&end[2 * i + s], dvi_integrator_q(alone) + i, sizeof(double));
    dvi_integrator_destroy(&alone);
  }
  dvi_ensemble_destroy(&e);
  for (int s = 0; s < 2; s++) dvi_system_destroy(&made[s]);
}
END_TEST

/* ---- a parameter as a coordinate ---- */

/* V = x[1] x[0]^2 / 2, without a force on x[1], which rests and differs between members. */
static int sprung_value(int count, const double *t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V[k] = 0.5 * x[count + k] * x[k] * x[k];
  return 0;
}

static int sprung_gradient(int count, const double *t, const double *x, double *V_q, void *user)
{
  (void)t, (void)user;
  calls++;
  for (int k = 0; k < count; k++) V_q[k] = x[count + k] * x[k], V_q[count + k] = 0;
  return 0;
}

START_TEST(a_parameter_that_rests_is_one_to_the_last_bit)
{
  enum { BLOCK = 8, STEPS = 50 };
  const dvi_potential potential = {.value_batch = sprung_value, .gradient_batch = sprung_gradient};
  const dvi_system_terms terms = {
      .dimension = 2, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  double x[2 * MEMBERS], momentum[2 * MEMBERS] = {0}, end[2 * MEMBERS];
  dvi_system *system = NULL;
  dvi_ensemble *e = NULL;
  for (int k = 0; k < MEMBERS; k++) x[k] = 1, x[MEMBERS + k] = 1 + 0.1 * k;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_create(system, "verlet",
                                       &(dvi_ensemble_options){.members = MEMBERS, .block = BLOCK},
                                       &e),
                   DVI_OK);
  ck_assert_int_eq(dvi_ensemble_start(e, 0, x, momentum), DVI_OK);
  calls = 0;
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.1, STEPS), DVI_OK);
  ck_assert_int_eq(calls, MEMBERS / BLOCK * (STEPS + 1));
  ck_assert_int_eq(dvi_ensemble_state(e, NULL, end, NULL), DVI_OK);
  ck_assert_mem_eq(end + MEMBERS, x + MEMBERS, MEMBERS * sizeof(double));
  for (int k = 0; k < MEMBERS; k++) {
    dvi_potential fixed = {
        .value = quartic, .gradient_batch = counted_gradient, .user = &x[MEMBERS + k]};
    const dvi_system_terms alone = {
        .dimension = 1, .mass.scalar = 1, .potentials = &fixed, .potential_count = 1};
    dvi_system *of_member = NULL;
    ck_assert_int_eq(dvi_system_create(&alone, &of_member), DVI_OK);
    dvi_integrator *integrator = create_integrator(of_member, "verlet");
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, x + k, momentum + k), DVI_OK);
    advance(integrator, 0.1, STEPS);
    ck_assert_mem_eq(dvi_integrator_q(integrator), end + k, sizeof(double));
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&of_member);
  }
  dvi_ensemble_destroy(&e);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(ensemble_systems)
{
  find_accepted_cases(2 * SWEEPS * METHODS, case_is_accepted, &cases);
  tcase_add_test(tests, one_method_refuses_two_systems);
  tcase_add_loop_test(tests, members_with_systems_of_their_own_have_the_bits_of_runs_alone, 0,
                      cases.count);
  tcase_add_loop_test(tests, methods_that_split_have_the_parts_of_each_members_system, 0,
                      2 * SPLITS);
  tcase_add_test(tests, neighbours_with_one_system_share_its_modes);
  tcase_add_loop_test(tests, slow_potentials_are_those_of_each_member, 0, 7);
  tcase_add_test(tests, circles_of_different_radii_hold_their_own_particles);
  tcase_add_test(tests, systems_that_are_not_alike_are_refused);
  tcase_add_test(tests, a_derivative_that_only_one_system_gives_is_refused);
  tcase_add_test(tests, a_reach_of_its_own_is_refused);
  tcase_add_test(tests, neighbours_with_one_system_share_a_call);
  tcase_add_test(tests, a_parameter_that_rests_is_one_to_the_last_bit);
}
