/* labels: unit */
/* Sweeps of parameters: members with systems of their own have the bits of integrators of these systems. */
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { SYSTEMS = 4, EACH = 6, MEMBERS = SYSTEMS * EACH, N_MOST = 32 };

static problem *of[SYSTEMS];
static const dvi_system *systems[MEMBERS];
static double q[N_MOST * MEMBERS], p[N_MOST * MEMBERS];

static const struct {
  const char *problem, *setting[SYSTEMS];
} sweeps[] = {{"oscillator", {"k=1", "k=2", "k=4", "k=1600"}},
              {"fpu", {"omega=50", "omega=10", "omega=20", "omega=5"}},
              {"henon-heiles", {NULL, NULL, NULL, NULL}},
              {"double-pendulum", {"m1=1", "m1=2", "m1=3", "m1=4"}},
              {"chain", {"beta=0.1", "beta=0.2", "beta=0.3", "beta=0"}}};
enum { SWEEPS = sizeof sweeps / sizeof *sweeps };

static const char *const methods[] = {"verlet", "galerkin", "galerkin:degree=8", "galerkin:degree=3,solver=newton",
                                      "composition:order=6,base=midpoint"};
enum { METHODS = 5 };

/* `interleaved`: neighbours have different systems. */
static void make_sweep(int which, int interleaved)
{
  for (int s = 0; s < SYSTEMS; s++) of[s] = made_problem(sweeps[which].problem, sweeps[which].setting[s]);
  const int n = of[0]->nq;
  ck_assert_int_le(n, N_MOST);
  for (int k = 0; k < MEMBERS; k++) {
    const problem *own = of[interleaved ? k % SYSTEMS : k / EACH];
    systems[k] = own->system;
    for (int i = 0; i < n; i++) {
      q[i * MEMBERS + k] = own->q[i] * (1 + 0.01 * (k % 7));
      p[i * MEMBERS + k] = own->p[i];
    }
  }
}

static void clear_sweep(void)
{
  for (int s = 0; s < SYSTEMS; s++) problem_destroy(&of[s]);
}

static void same_as_alone(dvi_ensemble *e, const char *method, double h, int steps)
{
  static double t_all[MEMBERS], q_all[N_MOST * MEMBERS], p_all[N_MOST * MEMBERS];
  ck_assert_int_eq(dvi_ensemble_state(e, t_all, q_all, p_all), DVI_OK);
  for (int k = 0; k < MEMBERS; k++) {
    double q_k[N_MOST], p_k[N_MOST], here[16], there[16];
    const int n = dvi_system_nq(systems[k]);
    for (int i = 0; i < n; i++) q_k[i] = q[i * MEMBERS + k], p_k[i] = p[i * MEMBERS + k];
    dvi_integrator *alone = made_integrator(systems[k], method);
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

START_TEST(members_with_systems_of_their_own_have_the_bits_of_runs_alone)
{
  const int which = _i / METHODS % SWEEPS, interleaved = _i / METHODS / SWEEPS;
  const char *method = methods[_i % METHODS];
  dvi_ensemble *e = NULL;
  make_sweep(which, interleaved);
  const dvi_ensemble_options options = {.members = MEMBERS, .threads = 2, .systems = systems};
  const dvi_status status = dvi_ensemble_create(NULL, method, &options, &e);
  if (status != DVI_UNSUPPORTED) {
    ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
    ck_assert_msg(dvi_ensemble_start(e, 0, q, p) == DVI_OK, "%s", dvi_last_error());
    ck_assert_msg(dvi_ensemble_advance(e, 0.02, 10) == DVI_OK, "%s", dvi_last_error());
    same_as_alone(e, method, 0.02, 10);
  }
  dvi_ensemble_destroy(&e);
  clear_sweep();
}
END_TEST

START_TEST(systems_that_are_not_alike_are_refused)
{
  problem *one = made_problem("kepler", NULL), *other = made_problem("henon-heiles", NULL);
  const dvi_system *pair[] = {one->system, other->system};
  dvi_ensemble *e = NULL;
  ck_assert_int_eq(dvi_ensemble_create(NULL, "verlet", &(dvi_ensemble_options){.members = 2, .systems = pair}, &e),
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
  const dvi_system_terms terms = {.dimension = 1, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  dvi_system *with = NULL, *without = NULL;
  dvi_ensemble *e = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &with), DVI_OK);
  potential.gradient = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &without), DVI_OK);
  const dvi_system *pair[] = {with, without};
  ck_assert_int_eq(dvi_ensemble_create(NULL, "verlet", &(dvi_ensemble_options){.members = 2, .systems = pair}, &e),
                   DVI_BAD_ARGUMENT);
  check_words("a derivative is given in one");
  dvi_system_destroy(&with);
  dvi_system_destroy(&without);
}
END_TEST

static int quartic_range(double t, const double *x, int first, int last, double *V_q, void *user)
{
  (void)t;
  for (int i = first; i < last; i++) V_q[i - first] = i == 0 ? 4 * *(const double *)user * x[0] * x[0] * x[0] : 0;
  return 0;
}

/* Waves are made once, for all systems. */
START_TEST(a_reach_of_its_own_is_refused)
{
  double strength = 1;
  dvi_potential potential = {.value = quartic, .gradient = quartic_gradient, .user = &strength};
  const dvi_system_terms terms = {.dimension = 1, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  dvi_system *whole = NULL, *near = NULL, *far = NULL;
  dvi_ensemble *e = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &whole), DVI_OK);
  potential.gradient_range = quartic_range;
  ck_assert_int_eq(dvi_system_create(&terms, &near), DVI_OK);
  potential.reach = 3;
  ck_assert_int_eq(dvi_system_create(&terms, &far), DVI_OK);
  const dvi_system *pairs[][2] = {{whole, near}, {near, whole}, {near, far}};
  for (int i = 0; i < 3; i++) {
    ck_assert_int_eq(dvi_ensemble_create(NULL, "verlet", &(dvi_ensemble_options){.members = 2, .systems = pairs[i]}, &e),
                     DVI_BAD_ARGUMENT);
    check_words("gradient_range");
  }
  dvi_system_destroy(&whole);
  dvi_system_destroy(&near);
  dvi_system_destroy(&far);
}
END_TEST

/* Calls, not points: neighbours with one system share them. */
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
    const dvi_potential potential = {.value = quartic, .gradient_batch = counted_gradient, .user = &strength[s]};
    const dvi_system_terms terms = {.dimension = 1, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
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
  /* 12 members of a system: a block of 12, or two of 8 and 4. */
  ck_assert_int_ge(calls, 20);
  ck_assert_int_le(calls, 40);
  dvi_ensemble_destroy(&e);
  for (int s = 0; s < 2; s++) dvi_system_destroy(&made[s]);
}
END_TEST

/* ---- a parameter as a coordinate ---- */

/* V = x[1] x[0]^2 / 2, with no force on x[1]: it rests, and each member has its own. */
static int sprung(int count, const double *t, const double *x, double *V, void *user)
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
  const dvi_potential potential = {.value_batch = sprung, .gradient_batch = sprung_gradient};
  const dvi_system_terms terms = {.dimension = 2, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  double x[2 * MEMBERS], momentum[2 * MEMBERS] = {0}, end[2 * MEMBERS];
  dvi_system *system = NULL;
  dvi_ensemble *e = NULL;
  for (int k = 0; k < MEMBERS; k++) x[k] = 1, x[MEMBERS + k] = 1 + 0.1 * k;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_create(system, "verlet", &(dvi_ensemble_options){.members = MEMBERS, .block = BLOCK}, &e), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_start(e, 0, x, momentum), DVI_OK);
  calls = 0;
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.1, STEPS), DVI_OK);
  ck_assert_int_eq(calls, MEMBERS / BLOCK * (STEPS + 1));
  ck_assert_int_eq(dvi_ensemble_state(e, NULL, end, NULL), DVI_OK);
  ck_assert_mem_eq(end + MEMBERS, x + MEMBERS, MEMBERS * sizeof(double));
  for (int k = 0; k < MEMBERS; k++) {
    dvi_potential fixed = {.value = quartic, .gradient_batch = counted_gradient, .user = &x[MEMBERS + k]};
    const dvi_system_terms alone = {.dimension = 1, .mass.scalar = 1, .potentials = &fixed, .potential_count = 1};
    dvi_system *of_member = NULL;
    ck_assert_int_eq(dvi_system_create(&alone, &of_member), DVI_OK);
    dvi_integrator *integrator = made_integrator(of_member, "verlet");
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

int main(void)
{
  TCase *tests = tcase_create("ensemble_systems");
  tcase_add_loop_test(tests, members_with_systems_of_their_own_have_the_bits_of_runs_alone, 0, 2 * SWEEPS * METHODS);
  tcase_add_test(tests, systems_that_are_not_alike_are_refused);
  tcase_add_test(tests, a_derivative_that_only_one_system_gives_is_refused);
  tcase_add_test(tests, a_reach_of_its_own_is_refused);
  tcase_add_test(tests, neighbours_with_one_system_share_a_call);
  tcase_add_test(tests, a_parameter_that_rests_is_one_to_the_last_bit);
  return run_tests("method/ensemble_systems", tests);
}
