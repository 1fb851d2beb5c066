/* max, min, sign, floor and if(..) in scenes: values, derivatives of one side, what is off, and
 * the kinks that lower orders. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/scene/parsed.h"
#include "support/suite.h"

enum { TEXT_SIZE = 1024, N = 2 };

/* A scene whose potential is the expression. */
static dvi_status parse(const char *expression)
{
  char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text,
                 "parameters: {n: 1, max: 4}\ncoordinates: {x: scalar, y: scalar}\nlagrangian: "
                 "x'^2 + y'^2 - (%s)\n"
                 "initial: {x: 0.5, y: 0.25, x': 1}\nstep: 0.1\nuntil: 1\n",
                 expression);
  return parse_scene(text);
}

/* Evaluates V, its gradient and its Hessian, row by row, at q. The Hessian's pattern is full. */
static void evaluate(const char *expression, const double *q, double *V, double *V_q, double *V_qq)
{
  const double t = 0, v[N] = {0};
  double L;
  ck_assert_msg(parse(expression) == DVI_OK, "%s", message);
  const dvi_system *system = dvi_scene_system(scene);
  ck_assert_msg(dvi_system_lagrangian(system, t, q, v, &L) == DVI_OK, "%s: %s", expression,
                dvi_scene_fault());
  *V = -L;
  const dvi_potential *potential = dvi_scene_terms(scene)->potentials;
  memset(V_qq, 0, N * N * sizeof *V_qq);
  if (potential == NULL) {
    V_q[0] = V_q[1] = 0;
    return;
  }
  double entry[N * N];
  ck_assert_int_eq(potential->gradient_batch(1, &t, q, V_q, potential->user), 0);
  ck_assert_int_eq(potential->hessian_batch(1, &t, q, entry, potential->user), 0);
  for (int j = 0, e = 0; j < N; j++) {
    if (potential->qq.start == NULL)
      for (int i = 0; i < N; i++) V_qq[N * i + j] = entry[N * j + i];
    else
      for (e = potential->qq.start[j]; e < potential->qq.start[j + 1]; e++)
        V_qq[N * potential->qq.row[e] + j] = entry[e];
  }
}

static void check(const char *expression, double x, double y, double value, double by_x,
                  double by_y, double by_xx)
{
  const double q[N] = {x, y};
  double V, V_q[N], V_qq[N * N];
  evaluate(expression, q, &V, V_q, V_qq);
  ck_assert_msg(fabs(V - value) <= 1e-15 * fabs(value), "%s at %g, %g: %.17g", expression, x, y, V);
  ck_assert_msg(fabs(V_q[0] - by_x) <= 1e-15 * fabs(by_x), "%s at %g, %g: by x %.17g", expression,
                x, y, V_q[0]);
  ck_assert_msg(fabs(V_q[1] - by_y) <= 1e-15 * fabs(by_y), "%s at %g, %g: by y %.17g", expression,
                x, y, V_q[1]);
  ck_assert_msg(fabs(V_qq[0] - by_xx) <= 1e-15 * fabs(by_xx), "%s at %g, %g: by x twice %.17g",
                expression, x, y, V_qq[0]);
}

START_TEST(values_and_derivatives_are_those_of_the_side)
{
  check("max(x, 0)^2 + y", 3, 0, 9, 6, 1, 2);
  check("max(x, 0)^2 + y", -3, 0, 0, 0, 1, 0);
  check("max(x, y, 1)", 2, 3, 3, 0, 1, 0);
  check("max(x, y, 1)", 4, 3, 4, 1, 0, 0);
  check("max(x, y, 1)", 0, 0.5, 1, 0, 0, 0);
  check("min(x^2, 2*y)", 1, 3, 1, 2, 0, 2);
  check("min(x^2, 2*y)", 3, 3, 6, 0, 2, 0);
  check("sign(x)*y^2", -3, 2, -4, 0, -4, 0);
  check("floor(x)*y", 2.75, 3, 6, 0, 2, 0);
  check("floor(x)*y", -2.75, 3, -9, 0, -3, 0);
  check("ceil(x)*y", 2.25, 3, 9, 0, 3, 0);
  check("if(x < 1, x^3, 3*x - 2)", 0.5, 0, 0.125, 0.75, 0, 3);
  check("if(x < 1, x^3, 3*x - 2)", 2, 0, 4, 3, 0, 0);
  check("if(0 < x <= 1 and not y > 2 or x == 5, x, -x)", 0.5, 1, 0.5, 1, 0, 0);
  check("if(0 < x <= 1 and not y > 2 or x == 5, x, -x)", 0.5, 3, -0.5, -1, 0, 0);
  check("if(0 < x <= 1 and not y > 2 or x == 5, x, -x)", 5, 3, 5, 1, 0, 0);
  check("if(x != y, 3, 4)*x", 2, 2, 8, 4, 0, 0);
  check("if(x >= y, [x, y], [y, x])[2]", 2, 1, 1, 0, 1, 0);
  check("if(x >= y, [x, y], [y, x])[2]", 1, 2, 1, 1, 0, 0);
  check("max*max(x, max)", 5, 0, 20, 4, 0, 0); /* a parameter, and the word */
}
END_TEST

/* By docs/scenes.md max and min take the last of equal arguments, a condition with < or > is false,
 * and abs and sign have the slope 0. */
START_TEST(at_a_kink_the_derivative_is_that_of_the_side_that_is_documented)
{
  check("max(x, 0)", 0, 0, 0, 0, 0, 0);
  check("max(0, x)", 0, 0, 0, 1, 0, 0);
  check("max(x, y)", 1, 1, 1, 0, 1, 0);
  check("min(x, y)", 1, 1, 1, 0, 1, 0);
  check("if(x < 0, -x, 2*x)", 0, 0, 0, 2, 0, 0);
  check("if(x <= 0, -x, 2*x)", 0, 0, 0, -1, 0, 0);
  check("abs(x)", 0, 0, 0, 0, 0, 0);
  check("floor(x)", 1, 0, 1, 0, 0, 0);
}
END_TEST

/* The root of a negative number, or a division by zero, in a branch that is not taken does not show
 * in values or derivatives. */
START_TEST(what_is_off_need_not_exist)
{
  check("if(x > 0, sqrt(x), y)", -1, 2, 2, 0, 1, 0);
  check("if(x > 0, sqrt(x), y)", 4, 2, 2, 0.25, 0, -1.0 / 32);
  check("if(x > 0, sqrt(x), 0) + if(x > 1, 3*sqrt(x), 0)", -1, 2, 0, 0, 0, 0);
  check("if(x > 0, sqrt(x), 0)*y + if(x > 1, exp(sqrt(x)), 1)", -1, 2, 1, 0, 0, 0);
  check("if(x == 0, 1, sin(x)/x)", 0, 0, 1, 0, 0, 0);
  check("if(x > 0 and log(x) > 1, x, y)", -1, 2, 2, 0, 1, 0);
  check("if(x <= 0 or log(x) > 1, x, y)", -1, 2, -1, 1, 0, 0);
  check("sqrt(max(x, 0))", -1, 0, 0, 0, 0, 0);
  check("max(x, 0)^1.5", -1, 0, 0, 0, 0, 0);
  check("if(n > 1, 1/(n - 1), x)", 3, 0, 3, 1, 0, 0);
  /* known when the scene is read, and not even evaluated */
  check("if(n > 1, [x, y][n + 2], x)", 3, 0, 3, 1, 0, 0);
}
END_TEST

START_TEST(a_condition_that_is_no_number_is_told)
{
  double L;
  ck_assert_int_eq(parse("if(log(x) < 0, 1, 2)*x"), DVI_OK);
  ck_assert_int_ne(
      dvi_system_lagrangian(dvi_scene_system(scene), 0, (double[N]){-1, 0}, (double[N]){0}, &L),
      DVI_OK);
  ck_assert_str_eq(dvi_scene_fault(), "test.yaml:3:31: log(x), x = -1 is not finite, at t = 0");
  ck_assert_int_eq(parse("max(log(x), y)"), DVI_OK);
  ck_assert_int_ne(
      dvi_system_lagrangian(dvi_scene_system(scene), 0, (double[N]){-1, 0}, (double[N]){0}, &L),
      DVI_OK);
  ck_assert_int_eq(parse("if(x > 0, sqrt(x), 1/y)"), DVI_OK);
  ck_assert_int_ne(
      dvi_system_lagrangian(dvi_scene_system(scene), 0, (double[N]){-1, 0}, (double[N]){0}, &L),
      DVI_OK);
  ck_assert_str_eq(dvi_scene_fault(), "test.yaml:3:47: 1/y, y = 0 is not finite, at t = 0");
}
END_TEST

START_TEST(what_is_no_condition_is_told)
{
  static const char *const texts[][2] = {
      {"x < 1", ":3:27: a condition where a number is needed; write if(.., a, b)"},
      {"2*(x < 1 and y < 2)", ":3:30: a condition where a number is needed"},
      {"if(x, 1, 2)", ":3:31: a condition is needed here, as x < 0"},
      {"if(not x, 1, 2)", ":3:35: a condition is needed here"},
      {"if(x = 0, 1, 2)", ":3:33: equality is written =="},
      {"if(x > 0, 1)", "found ')' where ',' is expected"},
      {"if(x > 0, [x, y], y)", ":3:27: the two sides of if are a vector of 2 and a number"},
      {"if(x > 0 && y > 0, 1, 2)", "'&' has no meaning in expressions; write and"},
      {"if(x \xE2\x89\xA4 0, 1, 2)", "has no meaning in expressions; write <="},
      {"max(x)", ":3:27: max takes 2 arguments or more, not 1"},
      {"min([x, y], 2)", "min is taken of a number, not of a vector of 2"},
      {"x ? 1", "write if(x < 0, a, b)"},
      {"min + x", "'min' is a function; write min(..)"},
  };
  for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
    ck_assert_int_eq(parse(texts[k][0]), DVI_BAD_FILE);
    ck_assert_msg(strstr(message, texts[k][1]) != NULL, "\"%s\" is not in \"%s\"", texts[k][1],
                  message);
  }
}
END_TEST

/* The remaining order, that of the first derivative that jumps, 1 more where time alone decides, -1
 * where nothing jumps. test_scene_kinks.c measures orders. */
START_TEST(kinks_are_found_with_the_order_that_they_leave)
{
  static const struct {
    const char *expression;
    int order;
    const char *words;
  } kink[] = {
      {"sin(x)*y", -1, ""},
      {"abs(x)", 1, "test.yaml:3:27: (abs(x)): the first derivative of the Lagrangian jumps here"},
      {"y + max(x, 0)", 1, "orders above 1 are lost"},
      {"x*abs(x)", 2, "second derivative"},
      {"max(x - 5, 0)^2", 2, "max(x - 5, 0): the second derivative"},
      {"max(x*y, 0)^3", 3, "third derivative"},
      {"abs(x)^7", -1, ""},
      {"if(x < 1, x^2, 2*x - 1)", 2, "x < 1"},
      {"if(x < 1, x^2, x^2)", -1, ""},
      {"if(x == 0, 1, sin(x)/x)", -1, ""},
      {"sign(x)", 0, "the Lagrangian itself jumps here, which methods do not see"},
      {"floor(x)*y", 0, "floor(x)"},
      {"if(t < 3, 1, 2)*x^2", 1,
       "the Lagrangian itself jumps here: where the motion crosses it orders above 1 are lost"},
      {"1e4*y^2 + 1e-3*abs(x)", 1, "abs(x)"},
      {"sqrt(max(x, 0))", 1, "max(x, 0)"},
      {"if(n > 1, abs(x), x)", -1, ""},
      {"max(hypot(x, y) - 3, 0)^2 + abs(x^2 + 1)", 2, "max(hypot(x, y) - 3, 0)"},
      {"sum(i=1..3, max(x - i, 0)^2)", 2, "max(x - i, 0)"},
  };
  for (size_t k = 0; k < sizeof kink / sizeof *kink; k++) {
    ck_assert_msg(parse(kink[k].expression) == DVI_OK, "%s", message);
    const int order = dvi_scene_kink(scene, message, sizeof message);
    ck_assert_msg(order == kink[k].order, "%s: %d instead of %d", kink[k].expression, order,
                  kink[k].order);
    ck_assert_msg(strstr(message, kink[k].words) != NULL, "%s: %s", kink[k].expression, message);
  }
  ck_assert_int_eq(dvi_scene_kink(NULL, message, sizeof message), -1);
  ck_assert_int_eq(dvi_scene_kink(scene, NULL, 0), -1);
}
END_TEST

/* The slope of a flat piece is no constant Hessian of a spring. */
START_TEST(what_has_a_kink_is_no_quadratic_potential)
{
  dvi_scene_facts facts;
  static const char *const expressions[] = {"abs(x)", "max(x, 0)", "floor(x)",
                                            "if(x > 0, x^2, 2*x^2)", "if(t > 0, x^2, 2*x^2)"};
  for (size_t k = 0; k < sizeof expressions / sizeof *expressions; k++) {
    ck_assert_int_eq(parse(expressions[k]), DVI_OK);
    dvi_scene_facts_of(scene, &facts);
    ck_assert_int_eq(facts.quadratic_potentials, 0);
    ck_assert_int_eq(dvi_scene_terms(scene)->potentials->quadratic, 0);
  }
}
END_TEST

/* At a kink there is no Taylor series, and a method that needs one says so. Beside the kink there
 * is one. */
START_TEST(series_are_refused_at_a_kink_alone)
{
  for (int k = 0; k < 2; k++) {
    dvi_integrator *integrator = NULL;
    ck_assert_int_eq(parse("max(x, 0)^4 + y^2"), DVI_OK);
    ck_assert_int_eq(dvi_integrator_create(dvi_scene_system(scene),
                                           "prolongation-collocation:derivatives=4", &integrator),
                     DVI_OK);
    ck_assert_int_eq(
        dvi_integrator_start(integrator, 0, (double[N]){k == 0 ? 0 : 0.5, 0}, (double[N]){1, 1}),
        DVI_OK);
    const dvi_status status = dvi_integrator_step(integrator, 0.01);
    ck_assert_int_eq(status == DVI_OK, k == 1);
    if (k == 0)
      ck_assert_str_eq(dvi_scene_fault(),
                       "test.yaml:3:28: max(x, 0), x = 0 has no Taylor series, at t = 0");
    dvi_integrator_destroy(&integrator);
  }
}
END_TEST

SUITE(scene_conditions)
{
  tcase_add_checked_fixture(tests, NULL, release_scene);
  tcase_add_test(tests, values_and_derivatives_are_those_of_the_side);
  tcase_add_test(tests, at_a_kink_the_derivative_is_that_of_the_side_that_is_documented);
  tcase_add_test(tests, what_is_off_need_not_exist);
  tcase_add_test(tests, a_condition_that_is_no_number_is_told);
  tcase_add_test(tests, what_is_no_condition_is_told);
  tcase_add_test(tests, kinks_are_found_with_the_order_that_they_leave);
  tcase_add_test(tests, what_has_a_kink_is_no_quadratic_potential);
  tcase_add_test(tests, series_are_refused_at_a_kink_alone);
}
