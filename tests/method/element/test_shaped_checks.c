/* labels: unit */
/* User bases: their requirements, failures of their callbacks, and their effect on checkpoints,
 * ensembles and copies. */
#include <dvi/dvi.h>
#include <math.h>
#include <string.h>

#include "support/files.h"
#include "support/runs.h"
#include "support/spaces.h"
#include "support/paced.h"
#include "support/suite.h"

/* ---- what is refused ---- */

/* The function tau^2 and its planted faults. `point` gives it at the nodes of a rule of three
 * points. */
typedef struct fault {
  int answer;          /* of the callbacks */
  double value, slope; /* are added */
  int leave_out;       /* the derivative */
  double node, weight; /* are added, at the middle point */
  double from;         /* the fault begins with steps of this length */
  long calls;
} fault;

static int evaluate(double h, double tau, double *value, double *derivative, void *user)
{
  fault *wrong = user;
  const int is_wrong = fabs(h) >= wrong->from;
  wrong->calls++;
  *value = tau * tau + (is_wrong ? wrong->value : 0);
  if (!wrong->leave_out) *derivative = 2 * tau + (is_wrong ? wrong->slope : 0);
  return is_wrong ? wrong->answer : 0;
}

static int point(double h, int j, double *tau, double *weight, double *value, double *derivative,
                 void *user)
{
  static const double nodes[] = {0.1127016653792583, 0.5, 0.8872983346207417},
                      weights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  const fault *wrong = user;
  const int is_wrong = j == 1 && fabs(h) >= wrong->from;
  *tau = nodes[j] + (is_wrong ? wrong->node : 0);
  *weight = weights[j] + (is_wrong ? wrong->weight : 0);
  *value = *tau * *tau;
  *derivative = 2 * *tau;
  return is_wrong ? wrong->answer : 0;
}

static void check_refused(const dvi_shapes *shapes, const char *method, dvi_status status,
                          const char *words)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = (dvi_integrator *)model;
  ck_assert_int_eq(create_with_shapes(model->system, shapes, method, &integrator), status);
  check_words(words);
  ck_assert_ptr_null(integrator);
  problem_destroy(&model);
}

static fault no_fault;
static const int twice[] = {1, 1}, beyond[] = {0, 2};

static const struct {
  dvi_shapes shapes;
  dvi_status status;
  const char *words;
} wrong_shapes[] = {
    {{.functions = 1, .evaluate = evaluate}, DVI_BAD_ARGUMENT, "the name is NULL"},
    {{.name = "", .functions = 1, .evaluate = evaluate},
     DVI_BAD_ARGUMENT,
     "the name '' is not of 1 to 40 letters"},
    {{.name = "a,b", .functions = 1, .evaluate = evaluate},
     DVI_BAD_ARGUMENT,
     "the name 'a,b' is not of"},
    {{.name = "long-long-long-long-long-long-long-long-x", .functions = 1, .evaluate = evaluate},
     DVI_BAD_ARGUMENT,
     "is not of 1 to 40"},
    {{.name = "s", .functions = 1}, DVI_BAD_ARGUMENT, "the callback evaluate is NULL"},
    {{.name = "s", .functions = 0, .evaluate = evaluate},
     DVI_BAD_SIZE,
     "0 functions; 1 to 40 are possible"},
    {{.name = "s", .functions = 41, .evaluate = evaluate}, DVI_BAD_SIZE, "41 functions"},
    {{.name = "s", .functions = 1, .evaluate = evaluate, .h = (double)NAN},
     DVI_BAD_ARGUMENT,
     "h = nan is no length"},
    {{.name = "s", .functions = 1, .evaluate = evaluate, .h = 1e-310},
     DVI_BAD_ARGUMENT,
     "is no length of a step"},
    {{.name = "s", .functions = 1, .evaluate = evaluate, .points = 3},
     DVI_BAD_ARGUMENT,
     "there are 3 points, and the callback for them is NULL"},
    {{.name = "s", .functions = 1, .evaluate = evaluate, .point = point},
     DVI_BAD_ARGUMENT,
     "there are 0 points, and the callback for them is given"},
    {{.name = "s", .functions = 1, .evaluate = evaluate, .point = point, .points = 1001},
     DVI_BAD_SIZE,
     "1001 points; 1 to 1000"},
    {{.name = "s", .functions = 1, .evaluate = evaluate, .order = -1},
     DVI_BAD_ARGUMENT,
     "the order -1 is claimed"},
    {{.name = "s", .functions = 1, .evaluate = evaluate, .coordinate_count = 1},
     DVI_BAD_ARGUMENT,
     "coordinate_count is 1, and the list"},
    {{.name = "s", .functions = 1, .evaluate = evaluate, .coordinates = twice},
     DVI_BAD_ARGUMENT,
     "coordinate_count is 0, and the list"},
    {{.name = "s",
      .functions = 1,
      .evaluate = evaluate,
      .coordinates = twice,
      .coordinate_count = 2,
      .user = &no_fault},
     DVI_BAD_ARGUMENT,
     "coordinate 1 is listed twice"},
    {{.name = "s",
      .functions = 1,
      .evaluate = evaluate,
      .coordinates = beyond,
      .coordinate_count = 2,
      .user = &no_fault},
     DVI_BAD_ARGUMENT,
     "there is no coordinate 2; they are counted from 0 to 1"},
};

START_TEST(what_is_missing_or_out_of_range_is_named)
{
  const dvi_shapes good = {.name = "good", .functions = 1, .evaluate = evaluate, .user = &no_fault};
  for (size_t k = 0; k < sizeof wrong_shapes / sizeof *wrong_shapes; k++)
    check_refused(&wrong_shapes[k].shapes, "shaped-galerkin", wrong_shapes[k].status,
                  wrong_shapes[k].words);
  check_refused(NULL, "shaped-galerkin", DVI_BAD_OPTION, "there are no shapes");
  check_refused(&good, NULL, DVI_BAD_ARGUMENT, "the method is NULL");
  ck_assert_int_eq(create_with_shapes(NULL, &good, "shaped-galerkin", NULL), DVI_BAD_ARGUMENT);
}
END_TEST

START_TEST(specifications_that_do_not_fit_are_refused)
{
  static fault none;
  dvi_shapes shapes = {.name = "square", .functions = 1, .evaluate = evaluate, .user = &none};
  check_refused(&shapes, "galerkin", DVI_BAD_OPTION,
                "its space is its own, and not the shapes square; shaped-galerkin takes them");
  check_refused(&shapes, "composition", DVI_BAD_OPTION, "its space is its own");
  check_refused(&shapes, "shaped-galerkin:degree=21", DVI_BAD_OPTION, "1 to 20 are possible");
  check_refused(&shapes, "shaped-galerkin:nodes=1", DVI_BAD_OPTION,
                "1 quadrature points see at most 1 of the 2 velocity modes");
  check_refused(&shapes, "shaped-galerkin:nodes=81", DVI_BAD_OPTION, "no rule with 81 points");
  check_refused(&shapes, "shaped-galerkin:quadrature=own", DVI_BAD_OPTION,
                "the shapes square have no points of their own");
  check_refused(&shapes, "shaped-galerkin:space=cube", DVI_BAD_OPTION,
                "'space=cube' is not possible; it takes degree, quadrature, nodes");
  check_refused(&shapes, "shaped-galerkin:basis=lobatto", DVI_BAD_OPTION,
                "'basis=lobatto' is not possible");
  check_refused(&shapes, "shaped-galerkin:degree=2", DVI_BAD_ARGUMENT,
                "function 0 is a combination of a constant, polynomials up to degree 2");
  shapes.point = point, shapes.points = 3;
  check_refused(&shapes, "shaped-galerkin:nodes=4", DVI_BAD_OPTION,
                "have 3 points of their own; leave quadrature and nodes out");
  check_refused(&shapes, "shaped-galerkin:degree=4", DVI_BAD_OPTION,
                "3 quadrature points see at most 3 of the 5 velocity modes");
}
END_TEST

START_TEST(functions_that_are_wrong_are_refused)
{
  static fault wrong[] = {{.slope = 0.001}, {.slope = (double)NAN}, {.value = (double)INFINITY},
                          {.leave_out = 1}, {.answer = 1},          {.answer = -1}};
  static const dvi_status status[] = {DVI_BAD_ARGUMENT, DVI_NOT_FINITE,     DVI_NOT_FINITE,
                                      DVI_NOT_FINITE,   DVI_CALLBACK_RETRY, DVI_CALLBACK_FAILED};
  static const char *const words[] = {
      "but differences of the values give",
      "evaluate gave derivative[0] = nan at tau = 0 of a step of h = 1",
      "evaluate gave value[0] = inf",
      "evaluate gave derivative[0] = nan",
      "shapes square: evaluate returned 1 for a step of h = 1",
      "returned -1"};
  for (int k = 0; k < 6; k++) {
    const dvi_shapes shapes = {
        .name = "square", .functions = 1, .evaluate = evaluate, .user = &wrong[k]};
    check_refused(&shapes, "shaped-galerkin", status[k], words[k]);
  }
}
END_TEST

START_TEST(points_that_are_wrong_are_refused)
{
  static fault wrong[] = {{.weight = 1e-9},
                          {.weight = (double)NAN},
                          {.node = 0.6},
                          {.node = -0.6},
                          {.node = (double)NAN}};
  static const dvi_status status[] = {DVI_BAD_ARGUMENT, DVI_NOT_FINITE, DVI_BAD_ARGUMENT,
                                      DVI_BAD_ARGUMENT, DVI_NOT_FINITE};
  static const char *const words[] = {
      "the weights sum to 1.000000001 for a step of h = 1; they must sum to 1",
      "point 1 has the weight nan", "point 1 is at tau = 1.1", "point 1 is at tau = -0.1",
      "point 1 is at tau = nan"};
  for (int k = 0; k < 5; k++) {
    const dvi_shapes shapes = {.name = "square",
                               .functions = 1,
                               .evaluate = evaluate,
                               .point = point,
                               .points = 3,
                               .user = &wrong[k]};
    check_refused(&shapes, "shaped-galerkin", status[k], words[k]);
  }
}
END_TEST

static int constant(double h, double tau, double *value, double *derivative, void *user)
{
  (void)h, (void)tau, (void)user;
  *value = 3;
  *derivative = 0;
  return 0;
}

static int same_place(double h, int j, double *tau, double *weight, double *value,
                      double *derivative, void *user)
{
  (void)h, (void)j, (void)user;
  *tau = 0.5, *weight = 0.25, *value = 0.25, *derivative = 1;
  return 0;
}

START_TEST(what_the_points_do_not_tell_apart_is_refused)
{
  static fault none;
  const dvi_shapes flat = {.name = "flat", .functions = 1, .evaluate = constant};
  const dvi_shapes heap = {.name = "heap",
                           .functions = 1,
                           .evaluate = evaluate,
                           .point = same_place,
                           .points = 4,
                           .user = &none};
  check_refused(&flat, "shaped-galerkin", DVI_BAD_ARGUMENT,
                "function 0 is a combination of a constant");
  check_refused(&heap, "shaped-galerkin", DVI_BAD_ARGUMENT,
                "at the 4 points function 0 is a combination");
  check_refused(&heap, "shaped-galerkin:degree=3", DVI_BAD_ARGUMENT,
                "the 4 points do not tell polynomials up to degree 3 apart");
}
END_TEST

static int evaluate_step(double h, double tau, double *value, double *derivative, void *user)
{
  const double steepness = *(const double *)user;
  (void)h;
  *value = tanh(steepness * (tau - 0.37));
  *derivative = steepness * (1 - *value * *value);
  return 0;
}

/* A step of 200 lies between two of 8 points. 80 points see it, and 8 points see a step of 20. */
START_TEST(points_that_do_not_see_a_function_are_refused)
{
  static double steepness = 200;
  const dvi_shapes step = {
      .name = "step", .functions = 1, .evaluate = evaluate_step, .user = &steepness};
  problem *model = create_problem("kepler", NULL);
  check_refused(&step, "shaped-galerkin:nodes=8", DVI_BAD_ARGUMENT,
                "the 8 points are much too coarse for function 0");
  dvi_integrator *fine = create_integrator_with_shapes(model->system, &step,
                                                       "shaped-galerkin:nodes=80");
  dvi_integrator_destroy(&fine);
  steepness = 20;
  dvi_integrator *flat = create_integrator_with_shapes(model->system, &step,
                                                       "shaped-galerkin:nodes=8");
  dvi_integrator_destroy(&flat);
  problem_destroy(&model);
}
END_TEST

START_TEST(without_shapes_there_is_no_such_method)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator;
  dvi_ensemble *ensemble;
  dvi_path *path;
  const dvi_monitor monitor = {.kind = DVI_MONITOR_DISTANCE};
  ck_assert_int_eq(dvi_integrator_create(model->system, "shaped-galerkin", &integrator),
                   DVI_BAD_OPTION);
  check_words("there are no shapes: a program gives them to dvi_integrator_options");
  ck_assert_int_eq(create_transformed(model->system, &monitor, "shaped-galerkin", &integrator),
                   DVI_BAD_OPTION);
  ck_assert_int_eq(dvi_ensemble_create(model->system, "shaped-galerkin",
                                       &(dvi_ensemble_options){.members = 2}, &ensemble),
                   DVI_BAD_OPTION);
  const dvi_path_options options = {.ends = DVI_ENDS_FIXED,
                                    .dimension = 2,
                                    .steps = 4,
                                    .span = 1,
                                    .q0 = model->q,
                                    .q1 = model->q};
  ck_assert_int_eq(dvi_path_create(model->system, "shaped-galerkin", &options, &path),
                   DVI_BAD_OPTION);
  check_words("there are no shapes");
  problem_destroy(&model);
}
END_TEST

START_TEST(terms_that_it_cannot_use_are_refused)
{
  problem *model = create_problem("vortices", NULL);
  dvi_integrator *integrator;
  ck_assert_int_eq(create_with_shapes(model->system, &decay, "shaped-galerkin", &integrator),
                   DVI_UNSUPPORTED);
  check_words("the system declares a one-form");
  problem_destroy(&model);
}
END_TEST

/* ---- steps that fail ---- */

START_TEST(a_failing_callback_leaves_the_state)
{
  static const struct {
    fault wrong;
    int points;
    dvi_status status;
  } cases[] = {{{.from = 0.2, .answer = 1}, 0, DVI_CALLBACK_RETRY},
               {{.from = 0.2, .answer = -1}, 3, DVI_CALLBACK_FAILED},
               {{.from = 0.2, .slope = (double)NAN}, 0, DVI_NOT_FINITE},
               {{.from = 0.2, .value = (double)NAN}, 3, DVI_NOT_FINITE},
               {{.from = 0.2, .weight = (double)INFINITY}, 3, DVI_NOT_FINITE},
               {{.from = 0.2, .weight = 0.1}, 3, DVI_BAD_ARGUMENT},
               {{.from = 0.2, .node = -1}, 3, DVI_BAD_ARGUMENT}};
  problem *model = create_problem("kepler", NULL);
  fault wrong = cases[_i].wrong;
  const dvi_shapes shapes = {.name = "square",
                             .functions = 1,
                             .evaluate = evaluate,
                             .h = 0.1,
                             .user = &wrong,
                             .points = cases[_i].points,
                             .point = cases[_i].points > 0 ? point : NULL};
  dvi_integrator *integrator = start_integrator_with_shapes(model, &shapes, "shaped-galerkin"),
                 *other = start_integrator_with_shapes(model, &shapes, "shaped-galerkin");
  double q[2][2], v[2];
  advance(integrator, 0.1, 2);
  advance(other, 0.1, 2);
  const bytes before = read_state(integrator);
  ck_assert_int_eq(dvi_integrator_step(integrator, 0.3), cases[_i].status);
  check_words("shapes square");
  check_words("the state is unchanged");
  check_state(integrator, before);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.17, q[0], v), DVI_OK);
  ck_assert_int_eq(dvi_integrator_interpolate(other, 0.17, q[1], v), DVI_OK);
  ck_assert_mem_eq(q[0], q[1], sizeof q[0]);
  advance(integrator, 0.1, 2);
  advance(other, 0.1, 2);
  ck_assert_mem_eq(dvi_integrator_q(integrator), dvi_integrator_q(other), sizeof q[0]);
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&other);
  problem_destroy(&model);
}
END_TEST

START_TEST(dense_output_says_where_a_function_fails)
{
  problem *model = create_problem("kepler", NULL);
  fault wrong = {0};
  const dvi_shapes shapes = {
      .name = "square", .functions = 1, .evaluate = evaluate, .user = &wrong};
  dvi_integrator *integrator = start_integrator_with_shapes(model, &shapes, "shaped-galerkin");
  double q[2];
  advance(integrator, 0.1, 2);
  wrong.answer = 1;
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.17, q, NULL), DVI_NOT_FINITE);
  check_words("the path is not finite at t = 0.17");
  wrong.answer = 0;
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.17, q, NULL), DVI_OK);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- cost ---- */

START_TEST(a_step_of_the_same_length_asks_no_function)
{
  problem *model = create_problem("kepler", NULL);
  fault none = {0};
  const dvi_shapes shapes = {
      .name = "square", .functions = 1, .evaluate = evaluate, .h = 0.1, .user = &none};
  dvi_integrator *integrator = start_integrator_with_shapes(model, &shapes,
                                                            "shaped-galerkin:nodes=5");
  advance(integrator, 0.1, 1);
  const long before = none.calls;
  advance(integrator, 0.1, 10);
  ck_assert_int_eq(none.calls, before);
  advance(integrator, 0.2, 10);
  ck_assert_int_le(none.calls, before + 5 + 5); /* the points, and ends */
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(shaped_checks)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, what_is_missing_or_out_of_range_is_named);
  tcase_add_test(tests, specifications_that_do_not_fit_are_refused);
  tcase_add_test(tests, functions_that_are_wrong_are_refused);
  tcase_add_test(tests, points_that_are_wrong_are_refused);
  tcase_add_test(tests, what_the_points_do_not_tell_apart_is_refused);
  tcase_add_test(tests, points_that_do_not_see_a_function_are_refused);
  tcase_add_test(tests, without_shapes_there_is_no_such_method);
  tcase_add_test(tests, terms_that_it_cannot_use_are_refused);
  tcase_add_loop_test(tests, a_failing_callback_leaves_the_state, 0, 7);
  tcase_add_test(tests, dense_output_says_where_a_function_fails);
  tcase_add_test(tests, a_step_of_the_same_length_asks_no_function);
}
