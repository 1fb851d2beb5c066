/* labels: jacobian */
/* Derivatives of scenes by their parameters, against differences of scenes that are read with other
 * values. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/scene/parsed.h"
#include "support/suite.h"

enum { PARAMETERS = 8, N = 2 };

/* Lagrangians with a mass that is constant, or depends on a parameter and q, a start by velocities
 * or by momenta. `s` is made of others, `list` is no number, and sums run over an index. */
static const char *const scenes[] = {
    "parameters: {m: 1.3, k: 0.7, c: 0.2, f: 0.4, a: 0.3, s: m*k + 1, list: [m, 2*k]}\n"
    "coordinates: {x: scalar, y: scalar}\n"
    "kinetic: m*(x'^2 + 2*y'^2)/2\n"
    "potentials: {fast: {spring: k*x^2*y^2/2 + s*y^2}, well: \"sum(i=1..2, list[i])*x^2/2\"}\n"
    "forces: {x: f*sin(a*t)*y, y: -k*x*y'}\n"
    "dissipation: c*x'^4/4 + c^2*y'^2/2\n"
    "initial: {x: a, y: 0.5 + k^2, x': s, y': 0}\n"
    "objective: {end: m*x^2 + y*p(x), integral: k*x'^2 + y}\nstep: 0.1\nuntil: 1\n",
    "parameters: {m: 1.3, k: 0.7, c: 0.2, f: 0.4, a: 0.3}\n"
    "coordinates:\n  q[2]: scalar\n"
    "definitions:\n  bend: 2 + cos(a*q[1])\n"
    "lagrangian: m*bend*q[1]'^2/2 + q[2]'^2/2 + c*sin(q[1])*q[1]'*q[2]' - f*cos(q[1] - k*q[2])\n"
    "initial: {\"q[i]\": a*i, \"q[i]'\": i - m}\n"
    "objective:\n  end: q[1]*p(q[2]) + m\nstep: 0.1\nuntil: 1\n",
    "parameters: {m: 1.3, k: 0.7, c: 0.2, f: 0.4, a: 0.3}\n"
    "coordinates: {x: scalar, y: scalar}\n"
    "lagrangian: x'^2*(m + y^2)/2 + y'^2/2 - k*x^4 - f*y^2 - x*y\n"
    "dissipation: c*x'^2/2\n"
    "initial: {x: a, y: 0.5, p(x): m^2, p(y): k}\n"
    "objective: {integral: x*y + a*x'^2}\nstep: 0.1\nuntil: 1\n",
    /* with a vector potential */
    "parameters: {m: 1.3, k: 0.7, c: 0.2, f: 0.4, a: 0.3}\n"
    "coordinates: {x: scalar, y: scalar}\n"
    "lagrangian: m*(x'^2 + y'^2)/2 + k*x^2*y' - f*y*x' - a*x^4 - c*y^2\n"
    "initial: {x: a, y: 0.5, x': k, y': 1}\n"
    "objective: {end: x*p(y), integral: y*x'}\nstep: 0.1\nuntil: 1\n",
};
enum { SCENES = sizeof scenes / sizeof *scenes };

/* Returns the objective of the scene's run, with the derivatives by its parameters. */
static double total(double *by_parameter)
{
  char text[MESSAGE_SIZE];
  dvi_dependence dependence;
  double by_q[N], by_p[N], start_q[N * PARAMETERS], start_p[N * PARAMETERS];
  dvi_sensitivity *run = NULL;
  const double *q, *v, *p;
  ck_assert_msg(dvi_scene_depend(scene, &dependence, text, sizeof text) == DVI_OK, "%s", text);
  ck_assert_int_eq(dvi_scene_start_tangent(scene, start_q, start_p), DVI_OK);
  ck_assert_msg(dvi_sensitivity_create(dvi_scene_system(scene), "galerkin:degree=2", &dependence,
                                       &run) == DVI_OK,
                "%s", dvi_last_error());
  dvi_scene_start(scene, &q, &v, &p);
  const dvi_run_plan plan = {0, 0.1, 10, q, p};
  dvi_gradient gradient = {.by_q = by_q, .by_p = by_p, .by_theta = by_parameter};
  ck_assert_msg(dvi_sensitivity_gradient(run, &plan, dvi_scene_objective(scene), &gradient) ==
                    DVI_OK,
                "%s", dvi_last_error());
  for (int k = 0; k < dependence.count; k++)
    for (int i = 0; i < N; i++)
      by_parameter[k] += by_q[i] * start_q[k * N + i] + by_p[i] * start_p[k * N + i];
  dvi_sensitivity_destroy(&run);
  return gradient.value;
}

static double moved_total(const char *text, const char *name, double value)
{
  char setting[64];
  const char *const settings[] = {setting};
  double unused[PARAMETERS];
  (void)snprintf(setting, sizeof setting, "%s=%.17g", name, value);
  ck_assert_msg(parse_with(text, 1, settings) == DVI_OK, "%s", message);
  return total(unused);
}

START_TEST(derivatives_are_those_of_other_values)
{
  static const char *const names[] = {"m", "k", "c", "f", "a"};
  static const double values[] = {1.3, 0.7, 0.2, 0.4, 0.3};
  double by_parameter[PARAMETERS];
  (void)open_scene(scenes[_i]);
  (void)total(by_parameter);
  for (int k = 0; k < 5; k++) {
    const double d = 1e-3, x = values[k];
    const double near = moved_total(scenes[_i], names[k], x + d) -
                        moved_total(scenes[_i], names[k], x - d),
                 far = moved_total(scenes[_i], names[k], x + 2 * d) -
                       moved_total(scenes[_i], names[k], x - 2 * d);
    const double by_differences = (8 * near - far) / (12 * d);
    ck_assert_msg(fabs(by_parameter[k] - by_differences) < 1e-8 * fmax(1, fabs(by_differences)),
                  "scene %d, %s: %.12g by the adjoint, %.12g by differences", _i, names[k],
                  by_parameter[k], by_differences);
  }
}
END_TEST

START_TEST(made_parameters_are_marked)
{
  (void)open_scene(scenes[0]);
  ck_assert_int_eq(dvi_scene_parameter_at(scene, 0)->is_made, 0);
  ck_assert_int_eq(dvi_scene_parameter_at(scene, 5)->is_made, 1);
  const char *const setting[] = {"s=2"};
  ck_assert_int_eq(parse_with(scenes[0], 1, setting), DVI_OK);
  ck_assert_int_eq(dvi_scene_parameter_at(scene, 5)->is_made, 0);
}
END_TEST

#define HEAD \
  "coordinates: {x: scalar}\nlagrangian: x'^2/2 - x^2/2\ninitial: {x: 1}\nstep: 0.1\nuntil: 1\n"

START_TEST(what_makes_no_sense_is_refused)
{
  dvi_dependence dependence;
  char text[MESSAGE_SIZE];
  double numbers[PARAMETERS];
  check_refused(HEAD "objective: {last: x}\n", DVI_BAD_FILE, "", "an objective has no 'last'");
  check_refused(HEAD "objective: {}\n", DVI_BAD_FILE, "", "an end, an integral or both");
  check_refused(HEAD "objective: {end: x'^2}\n", DVI_BAD_FILE, "",
                "velocities cannot stand in the end of an objective");
  (void)open_scene(HEAD);
  ck_assert_ptr_null(dvi_scene_objective(scene));
  ck_assert_int_eq(dvi_scene_start_tangent(scene, numbers, numbers), DVI_BAD_STATE);
  (void)open_scene("coordinates: {q: scalar}\nhamiltonian: p(q)^2/2 + q^2/2\ninitial: {q: 1, p(q): "
                   "0}\nstep: 0.1\nuntil: 1\n");
  ck_assert_int_eq(dvi_scene_depend(scene, &dependence, text, sizeof text), DVI_UNSUPPORTED);
  (void)open_scene("parameters: {a: 1}\ncoordinates:\n  q[2]: scalar\nlagrangian: sum(i, "
                   "q[i]'^2)/2\ninitial: {\"q[i]\": a, \"q[1]\": 2}\nstep: 0.1\nuntil: 1\n");
  ck_assert_int_eq(dvi_scene_depend(scene, &dependence, text, sizeof text), DVI_BAD_FILE);
  ck_assert_ptr_nonnull(strstr(text, "each number of the start once"));
}
END_TEST

SUITE(scene_dependence)
{
  tcase_add_checked_fixture(tests, NULL, release_scene);
  tcase_add_loop_test(tests, derivatives_are_those_of_other_values, 0, SCENES);
  tcase_add_test(tests, made_parameters_are_marked);
  tcase_add_test(tests, what_makes_no_sense_is_refused);
}
