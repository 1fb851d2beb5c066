/* labels: unit invariant */
#include <dvi/dvi.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "support/files.h"
#include "support/heap.h"
#include "support/runs.h"
#include "support/spaces.h"
#include "support/suite.h"

/* ---- without a rest ---- */

/* Creates the system of a problem whose only potential is declared fast, and maybe quadratic. */
static dvi_system *create_fast(const problem *model, int quadratic)
{
  dvi_system *system;
  dvi_potential potential = model->terms->potentials[0];
  dvi_system_terms terms = *model->terms;
  potential.fast = 1;
  potential.quadratic = quadratic;
  terms.potentials = &potential;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static dvi_integrator *start_at(const dvi_system *system, const char *method, const double *q,
                                const double *p)
{
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_msg(dvi_integrator_start(integrator, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  return integrator;
}

/* Steps of any length, forward and backward, are exact. The roundings of the start count by
 * 1/(1 - e). */
START_TEST(eccentric_kepler_motions_are_exact)
{
  static const struct {
    const char *setting;
    double error; /* in a unit of time */
  } cases[] = {{"e=0", 1e-14}, {"e=0.6", 6e-14}, {"e=0.9", 5e-13}, {"e=0.99", 5e-12}};
  static const double h[] = {0.3, 2, -1.1, 11};
  problem *model = create_problem("kepler", cases[_i].setting);
  dvi_system *system = create_fast(model, 0);
  for (int k = 0; k < 4; k++) {
    dvi_integrator *integrator = start_at(system, "flow-galerkin:stages=2", model->q, model->p);
    double q[2], p[2];
    for (int step = 0; step < 40; step++) {
      advance(integrator, h[k], 1);
      const double t = dvi_integrator_time(integrator);
      ck_assert_int_eq(model->exact(model, t, q, p), 0);
      ck_assert_double_le(distance(2, dvi_integrator_q(integrator), q),
                          cases[_i].error * (1 + fabs(t)));
    }
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

START_TEST(oscillations_are_exact)
{
  problem *model = create_problem("oscillator", "k=4");
  dvi_system *system = create_fast(model, 1);
  dvi_integrator *integrator = start_at(system, "flow-galerkin:stages=1", model->q, model->p);
  for (int step = 0; step < 50; step++) {
    double q, p;
    advance(integrator, 7, 1);
    ck_assert_int_eq(model->exact(model, dvi_integrator_time(integrator), &q, &p), 0);
    ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], q, 2e-14 * (step + 1));
  }
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

/* One step of a hyperbola is two halves, and goes back. */
START_TEST(hyperbolas_are_exact)
{
  const double q[] = {1, 0.5}, p[] = {-1.5, 1};
  problem *model = create_problem("kepler", NULL);
  dvi_system *system = create_fast(model, 0);
  dvi_integrator *whole = start_at(system, "flow-galerkin", q, p),
                 *halves = start_at(system, "flow-galerkin", q, p);
  advance(whole, 6, 1);
  advance(halves, 3, 2);
  ck_assert_double_le(distance(2, dvi_integrator_q(whole), dvi_integrator_q(halves)), 1e-13);
  ck_assert_double_le(distance(2, dvi_integrator_p(whole), dvi_integrator_p(halves)), 1e-13);
  advance(whole, -6, 1);
  ck_assert_double_le(distance(2, dvi_integrator_q(whole), q), 1e-13);
  ck_assert_double_le(distance(2, dvi_integrator_p(whole), p), 1e-13);
  dvi_integrator_destroy(&whole);
  dvi_integrator_destroy(&halves);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

/* ---- known relatives ---- */

/* The flow phi = 1 of H0 = 0, beside the oscillator's H as the rest. */
static int stay(int count, const double *tau, const double *q, const double *p, double *to_q,
                double *to_p, void *user)
{
  const size_t size = 2 * (size_t)count * sizeof(double);
  (void)tau, (void)user;
  memcpy(to_q, q, size);
  memcpy(to_p, p, size);
  return 0;
}

static int stay_back(int count, const double *tau, const double *q, const double *p,
                     const double *lambda_q, const double *lambda_p, double *by_q, double *by_p,
                     void *user)
{
  (void)q, (void)p;
  return stay(count, tau, lambda_q, lambda_p, by_q, by_p, user);
}

/* Henon and Heiles. */
static int whole_gradient(int count, const double *t, const double *q, const double *p, double *H_q,
                          double *H_p, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) {
    const double x = q[k], y = q[count + k];
    H_q[k] = x + 2 * x * y;
    H_q[count + k] = y + x * x - y * y;
  }
  memcpy(H_p, p, 2 * (size_t)count * sizeof(double));
  return 0;
}

static const dvi_flow none = {
    .size = sizeof none, .move = stay, .pullback = stay_back, .rest = whole_gradient};

START_TEST(without_a_flow_it_is_gauss)
{
  const int s = 1 + _i;
  const dvi_shapes shapes = {.name = "none", .flow = &none};
  problem *model = create_problem("henon-heiles", NULL);
  dvi_integrator *one = start_integrator_with_shapes(model, &shapes,
                                                     method_spec("flow-galerkin:stages=%d", s)),
                 *other = start_integrator(model, method_spec("galerkin:degree=%d", s));
  for (int step = 0; step < 20; step++) {
    advance(one, 0.2, 1);
    advance(other, 0.2, 1);
    ck_assert_double_le(distance(2, dvi_integrator_q(one), dvi_integrator_q(other)),
                        1e-15 * (step + 2));
    ck_assert_double_le(distance(2, dvi_integrator_p(one), dvi_integrator_p(other)),
                        1e-15 * (step + 2));
  }
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&other);
  problem_destroy(&model);
}
END_TEST

/* The Runge-Kutta-Nystroem method a_ij (c_i - c_j) of Gauss's two nodes. */
static void step_by_nystroem(double h, double *q, double *p)
{
  const double root = sqrt(3) / 6, c[] = {0.5 - root, 0.5 + root},
               across[] = {(0.25 - root) * (c[0] - c[1]), (0.25 + root) * (c[1] - c[0])};
  double force[2][2] = {{0}}, zero[2] = {0};
  for (int iteration = 0; iteration < 80; iteration++)
    for (int i = 0; i < 2; i++) {
      double place[2], V_q[2], V_p[2];
      for (int k = 0; k < 2; k++)
        place[k] = q[k] + c[i] * h * p[k] + h * h * across[i] * force[1 - i][k];
      (void)whole_gradient(1, zero, place, zero, V_q, V_p, NULL);
      for (int k = 0; k < 2; k++) force[i][k] = -V_q[k];
    }
  for (int k = 0; k < 2; k++) {
    q[k] += h * p[k] + h * h / 2 * ((1 - c[0]) * force[0][k] + (1 - c[1]) * force[1][k]);
    p[k] += h / 2 * (force[0][k] + force[1][k]);
  }
}

START_TEST(along_the_drift_it_is_nystroem)
{
  problem *model = create_problem("henon-heiles", NULL);
  dvi_integrator *integrator = start_integrator(model, "flow-galerkin:stages=2");
  double q[] = {model->q[0], model->q[1]}, p[] = {model->p[0], model->p[1]};
  for (int step = 0; step < 20; step++) {
    advance(integrator, 0.3, 1);
    step_by_nystroem(0.3, q, p);
    ck_assert_double_le(distance(2, dvi_integrator_q(integrator), q), 1e-15 * (step + 2));
    ck_assert_double_le(distance(2, dvi_integrator_p(integrator), p), 1e-15 * (step + 2));
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- structure ---- */

static const struct {
  const char *problem;
  double h, defect;
} places[] = {{"pendulum", 0.4, 1e-10},
              {"fpu", 0.05, 1e-10},
              {"outer-solar-jacobi", 400, 1e-10},
              {"outer-solar", 100, 1e-10}};
enum { PLACES = sizeof places / sizeof *places };

START_TEST(steps_are_symplectic_and_reversible)
{
  const int place = _i / 4;
  problem *model = create_problem(places[place].problem, NULL);
  dvi_integrator *integrator = create_integrator(
      model->system, method_spec("flow-galerkin:stages=%d", 1 + _i % 4));
  double defect;
  ck_assert_msg(dvi_symplecticity(integrator, 0, model->q, model->p, places[place].h, &defect) ==
                    DVI_OK,
                "%s", dvi_last_error());
  ck_assert_double_le(defect, places[place].defect);
  ck_assert_msg(
      dvi_reversibility(integrator, 0, model->q, model->p, places[place].h, 20, &defect) == DVI_OK,
      "%s", dvi_last_error());
  ck_assert_double_le(defect, 1e-11);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* The energy is that of H, of which a step sees the rest alone. */
START_TEST(energy_and_angular_momenta_stay_over_many_steps)
{
  const int steps = repeats(20000);
  problem *model = create_problem("outer-solar-jacobi", NULL);
  dvi_integrator *integrator = start_integrator(model, "flow-galerkin:stages=4");
  double first[4], now[4];
  ck_assert_int_eq(dvi_integrator_invariants(integrator, first), DVI_OK);
  for (int k = 0; k < 10; k++) {
    advance(integrator, 200, steps / 10);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, now), DVI_OK);
    for (int i = 0; i < 4; i++)
      ck_assert_double_eq_tol(now[i], first[i], (i == 0 ? 2e-11 : 1e-13) * fabs(first[i]));
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Five years of Jupiter and the others in 8 steps. */
START_TEST(the_path_follows_the_flow_inside_of_a_step)
{
  problem *model = create_problem("outer-solar-jacobi", NULL);
  dvi_integrator *integrator = start_integrator(model, "flow-galerkin:stages=4"),
                 *fine = start_integrator(model, "galerkin:degree=8");
  double q[15], v[15];
  for (int step = 0; step < 8; step++) {
    advance(integrator, 400, 1);
    ck_assert_int_eq(dvi_integrator_interpolate(integrator, 400 * (step + 1), q, v), DVI_OK);
    ck_assert_double_le(distance(15, q, dvi_integrator_q(integrator)), 1e-13);
    ck_assert_int_eq(dvi_integrator_interpolate(integrator, 400 * step + 160, q, v), DVI_OK);
    advance(fine, 40, 4);
    ck_assert_double_le(distance(15, q, dvi_integrator_q(fine)), 3e-7);
    advance(fine, 40, 6);
  }
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&fine);
  problem_destroy(&model);
}
END_TEST

/* ---- cost ---- */

/* The first step has more iterations, because it does not know the forces before. */
START_TEST(a_small_rest_takes_two_iterations_a_step)
{
  problem *model = create_problem("outer-solar-jacobi", NULL);
  dvi_integrator *integrator = start_integrator(model, "flow-galerkin:stages=4");
  dvi_counters before, after;
  advance(integrator, 100, 1);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, 100, 100);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.fixed_points - before.fixed_points, 100);
  ck_assert_int_le(after.residuals - before.residuals, 240);
  ck_assert_int_eq(after.gradients - before.gradients, 4 * (after.residuals - before.residuals));
  ck_assert_int_eq(after.jacobians, 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

static const char *const kinds[] = {"pendulum", "fpu", "outer-solar-jacobi"};
enum { KINDS = sizeof kinds / sizeof *kinds };

START_TEST(a_step_takes_no_memory)
{
  problem *model = create_problem(kinds[_i], NULL);
  dvi_integrator *integrator = start_integrator(model, "flow-galerkin");
  double q[64], v[64];
  advance(integrator, model->h, 1);
  const long before = heap_calls();
  dvi__fail_allocations_after(0);
  advance(integrator, model->h, 3);
  advance(integrator, -0.5 * model->h, 3);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 2.7 * model->h, q, v), DVI_OK);
  dvi__fail_allocations_after(-1);
  ck_assert_int_eq(heap_calls(), before);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- states ---- */

START_TEST(a_restored_run_has_the_same_bits)
{
  problem *model = create_problem(kinds[_i], NULL);
  dvi_integrator *saved = start_integrator(model, "flow-galerkin:stages=3"),
                 *restored = start_integrator(model, "flow-galerkin:stages=3");
  advance(saved, model->h, 5);
  advance(restored, 0.3 * model->h, 2);
  ck_assert_int_eq(dvi_integrator_save(saved, path_in_folder("state")), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore(restored, path_in_folder("state")), DVI_OK);
  for (int k = 0; k < 4; k++) {
    const double h = (k % 2 ? -0.7 : 1) * model->h;
    advance(saved, h, 2);
    advance(restored, h, 2);
    check_same_state(saved, restored);
  }
  dvi_integrator_destroy(&saved);
  dvi_integrator_destroy(&restored);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_step_that_is_too_long_leaves_the_state)
{
  problem *model = create_problem("henon-heiles", NULL);
  dvi_integrator *tried = start_integrator(model, "flow-galerkin"),
                 *plain = start_integrator(model, "flow-galerkin");
  advance(tried, 0.1, 3);
  advance(plain, 0.1, 3);
  ck_assert_int_lt(0, dvi_integrator_step(tried, 50));
  check_words("the state is unchanged");
  ck_assert_int_eq(dvi_integrator_step(tried, 0), DVI_BAD_ARGUMENT);
  check_same_state(tried, plain);
  advance(tried, 0.1, 2);
  advance(plain, 0.1, 2);
  check_same_state(tried, plain);
  dvi_integrator_destroy(&tried);
  dvi_integrator_destroy(&plain);
  problem_destroy(&model);
}
END_TEST

/* ---- flows of a program ---- */

/* The drift, with planted faults. */
typedef struct fault {
  int answer;         /* of the callbacks */
  int move, pullback; /* which of them has the fault */
  int skip;           /* a number is left out */
} fault;

static int drift(int count, const double *tau, const double *q, const double *p, double *to_q,
                 double *to_p, void *user)
{
  const fault *wrong = user;
  for (int j = 0; j < 2 * count; j++) {
    to_q[j] = q[j] + tau[j % count] * p[j];
    if (!(wrong->move && wrong->skip)) to_p[j] = p[j];
  }
  return wrong->move ? wrong->answer : 0;
}

static int drift_back(int count, const double *tau, const double *q, const double *p,
                      const double *lambda_q, const double *lambda_p, double *by_q, double *by_p,
                      void *user)
{
  const fault *wrong = user;
  ck_assert_ptr_null(lambda_p);
  (void)q, (void)p;
  for (int j = 0; j < 2 * count; j++) {
    by_q[j] = lambda_q[j];
    if (!(wrong->pullback && wrong->skip)) by_p[j] = tau[j % count] * lambda_q[j];
  }
  return wrong->pullback ? wrong->answer : 0;
}

static dvi_flow drift_with(fault *wrong)
{
  return (dvi_flow){.size = sizeof(dvi_flow), .move = drift, .pullback = drift_back, .user = wrong};
}

START_TEST(a_flow_of_the_program_gives_what_the_built_in_one_gives)
{
  fault good = {0};
  dvi_flow flow = drift_with(&good);
  dvi_shapes shapes = {.name = "drift", .flow = &flow};
  problem *model = create_problem("henon-heiles", NULL);
  dvi_integrator *own = start_integrator_with_shapes(model, &shapes, "flow-galerkin:stages=3"),
                 *built_in = start_integrator(model, "flow-galerkin:stages=3"), *like;
  flow.move = NULL; /* it was copied */
  shapes.name = NULL;
  ck_assert_int_eq(dvi_integrator_create_like(own, &like), DVI_OK);
  ck_assert_str_eq(dvi_integrator_method(like), "flow-galerkin:stages=3,flow=drift");
  advance(own, 0.2, 30);
  advance(built_in, 0.2, 30);
  ck_assert_double_le(distance(2, dvi_integrator_q(own), dvi_integrator_q(built_in)), 1e-14);
  dvi_integrator_destroy(&own);
  dvi_integrator_destroy(&built_in);
  dvi_integrator_destroy(&like);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_flow_that_fails_leaves_the_state)
{
  static const struct {
    fault wrong;
    dvi_status status;
    const char *words;
  } cases[] = {
      {{1, 1, 0, 0}, DVI_CALLBACK_RETRY, "the flow's move returned 1"},
      {{-2, 0, 1, 0}, DVI_CALLBACK_FAILED, "the flow's pullback returned -2"},
      {{0, 1, 0, 1}, DVI_NOT_FINITE, "the flow's move gave NaN or Inf, or left a number out"},
      {{0, 0, 1, 1}, DVI_NOT_FINITE, "the flow's pullback gave NaN or Inf"},
  };
  fault wrong = {0}, good = {0};
  const dvi_flow flow = drift_with(&wrong), sound = drift_with(&good);
  problem *model = create_problem("henon-heiles", NULL);
  dvi_integrator *tried = start_integrator_with_shapes(
                     model, &(dvi_shapes){.name = "drift", .flow = &flow}, "flow-galerkin"),
                 *plain = start_integrator_with_shapes(
                     model, &(dvi_shapes){.name = "drift", .flow = &sound}, "flow-galerkin");
  advance(tried, 0.1, 3);
  advance(plain, 0.1, 3);
  for (int k = 0; k < 4; k++) {
    wrong = cases[k].wrong;
    ck_assert_int_eq(dvi_integrator_step(tried, 0.1), cases[k].status);
    check_words(cases[k].words);
    check_same_state(tried, plain);
  }
  wrong = good;
  advance(tried, 0.1, 2);
  advance(plain, 0.1, 2);
  check_same_state(tried, plain);
  dvi_integrator_destroy(&tried);
  dvi_integrator_destroy(&plain);
  problem_destroy(&model);
}
END_TEST

static void check_refused(const dvi_system *system, const dvi_shapes *shapes, const char *method,
                          dvi_status status, const char *words)
{
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(create_with_shapes(system, shapes, method, &integrator), status);
  check_words(words);
  ck_assert_ptr_null(integrator);
}

START_TEST(what_does_not_fit_is_refused)
{
  fault good = {0};
  const dvi_flow flow = drift_with(&good);
  dvi_flow small = flow, still = flow, one_way = flow;
  small.size = 8;
  still.move = NULL;
  one_way.pullback = NULL;
  const dvi_shapes plain = {.name = "drift", .flow = &flow};
  dvi_shapes both = powers(1);
  both.flow = &flow;
  problem *model = create_problem("henon-heiles", NULL);
  const dvi_shapes functions = powers(1);
  const dvi_system *system = model->system;
  check_refused(system, &(dvi_shapes){.flow = &flow}, "flow-galerkin", DVI_BAD_ARGUMENT,
                "the name is NULL");
  check_refused(system, &(dvi_shapes){.name = "f", .flow = &small}, "flow-galerkin",
                DVI_BAD_ARGUMENT, "the flow's size is 8; set it to sizeof(dvi_flow)");
  check_refused(system, &(dvi_shapes){.name = "f", .flow = &still}, "flow-galerkin",
                DVI_BAD_ARGUMENT, "the flow's callback move is NULL");
  check_refused(system, &(dvi_shapes){.name = "f", .flow = &one_way}, "flow-galerkin",
                DVI_BAD_ARGUMENT, "the flow's callback pullback is NULL");
  check_refused(system, &both, "flow-galerkin", DVI_BAD_ARGUMENT, "there are a flow and functions");
  check_refused(system, &functions, "flow-galerkin", DVI_BAD_OPTION, "have no flow");
  check_refused(system, &plain, "shaped-galerkin", DVI_BAD_OPTION, "are a flow");
  check_refused(system, &plain, "galerkin", DVI_BAD_OPTION, "flow-galerkin takes them");
  check_refused(system, &plain, "flow-galerkin:flow=other", DVI_BAD_OPTION,
                "the name of its shapes, drift");
  check_refused(system, NULL, "flow-galerkin:flow=other", DVI_BAD_OPTION,
                "as flow the name of the shapes that a program gives");
  check_refused(system, NULL, "flow-galerkin:stages=21", DVI_BAD_OPTION, "1 to 20 are possible");
  problem_destroy(&model);
}
END_TEST

START_TEST(fast_potentials_without_a_known_flow_are_refused)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_system *system = create_fast(model, 0);
  check_refused(system, NULL, "flow-galerkin", DVI_UNSUPPORTED,
                "flow-galerkin: the flow of the fast potentials is not known");
  dvi_system_destroy(&system);
  problem_destroy(&model);
  model = create_problem("figure-eight", NULL);
  system = create_fast(model, 0);
  check_refused(system, NULL, "flow-galerkin", DVI_UNSUPPORTED, "their sum is not -k/|q|");
  dvi_system_destroy(&system);
  problem_destroy(&model);
  model = create_problem("double-pendulum", NULL);
  check_refused(model->system, NULL, "flow-galerkin", DVI_UNSUPPORTED, "flow-galerkin");
  problem_destroy(&model);
}
END_TEST

SUITE(flow_galerkin)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, eccentric_kepler_motions_are_exact, 0, 4);
  tcase_add_test(tests, oscillations_are_exact);
  tcase_add_test(tests, hyperbolas_are_exact);
  tcase_add_loop_test(tests, without_a_flow_it_is_gauss, 0, 4);
  tcase_add_test(tests, along_the_drift_it_is_nystroem);
  tcase_add_loop_test(tests, steps_are_symplectic_and_reversible, 0, 4 * PLACES);
  tcase_add_test(tests, energy_and_angular_momenta_stay_over_many_steps);
  tcase_add_test(tests, the_path_follows_the_flow_inside_of_a_step);
  tcase_add_test(tests, a_small_rest_takes_two_iterations_a_step);
  tcase_add_loop_test(tests, a_step_takes_no_memory, 0, KINDS);
  tcase_add_loop_test(tests, a_restored_run_has_the_same_bits, 0, KINDS);
  tcase_add_test(tests, a_step_that_is_too_long_leaves_the_state);
  tcase_add_test(tests, a_flow_of_the_program_gives_what_the_built_in_one_gives);
  tcase_add_test(tests, a_flow_that_fails_leaves_the_state);
  tcase_add_test(tests, what_does_not_fit_is_refused);
  tcase_add_test(tests, fast_potentials_without_a_known_flow_are_refused);
}
