/* labels: unit invariant */
/* Flows of a program's own, and the known methods that some of them are. */
#include <dvi/dvi.h>
#include <math.h>
#include <string.h>

#include "support/files.h"
#include "support/runs.h"
#include "support/spaces.h"
#include "support/suite.h"

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

/* The flow of H0 = p.p/4, beside the rest of the kinetic energy and Henon and Heiles' potential. */
static int half_drift(int count, const double *tau, const double *q, const double *p, double *to_q,
                      double *to_p, void *user)
{
  (void)user;
  for (int j = 0; j < 2 * count; j++) {
    to_q[j] = q[j] + 0.5 * tau[j % count] * p[j];
    to_p[j] = p[j];
  }
  return 0;
}

static int half_drift_back(int count, const double *tau, const double *q, const double *p,
                           const double *lambda_q, const double *lambda_p, double *by_q,
                           double *by_p, void *user)
{
  (void)q, (void)p, (void)user;
  for (int j = 0; j < 2 * count; j++) {
    by_q[j] = lambda_q[j];
    by_p[j] = lambda_p[j] + 0.5 * tau[j % count] * lambda_q[j];
  }
  return 0;
}

static int half_gradient(int count, const double *t, const double *q, const double *p, double *H_q,
                         double *H_p, void *user)
{
  (void)whole_gradient(count, t, q, p, H_q, H_p, user);
  for (int j = 0; j < 2 * count; j++) H_p[j] *= 0.5;
  return 0;
}

/* A rest that depends on the momenta, along a flow that depends on them, too. */
START_TEST(a_rest_of_the_program_may_depend_on_the_momenta)
{
  const dvi_flow flow = {
      .size = sizeof flow, .move = half_drift, .pullback = half_drift_back, .rest = half_gradient};
  const dvi_shapes shapes = {.name = "half", .flow = &flow};
  problem *model = create_problem("henon-heiles", NULL);
  dvi_integrator *integrator = start_integrator_with_shapes(model, &shapes,
                                                            "flow-galerkin:stages=6"),
                 *other = start_integrator(model, "galerkin:degree=8");
  double defect;
  advance(integrator, 0.1, 50);
  advance(other, 0.1, 50);
  ck_assert_double_le(distance(2, dvi_integrator_q(integrator), dvi_integrator_q(other)), 1e-13);
  ck_assert_double_le(distance(2, dvi_integrator_p(integrator), dvi_integrator_p(other)), 1e-13);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, model->q, model->p, 0.5, &defect), DVI_OK);
  ck_assert_double_le(defect, 1e-10);
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&other);
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

SUITE(flow_declared)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, without_a_flow_it_is_gauss, 0, 4);
  tcase_add_test(tests, along_the_drift_it_is_nystroem);
  tcase_add_test(tests, a_rest_of_the_program_may_depend_on_the_momenta);
  tcase_add_test(tests, a_flow_of_the_program_gives_what_the_built_in_one_gives);
  tcase_add_test(tests, a_flow_that_fails_leaves_the_state);
  tcase_add_test(tests, what_does_not_fit_is_refused);
}
