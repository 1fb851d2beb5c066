/* labels: jacobian */
/* Controls of scenes: their callbacks against differences, their part in other commands, and what
 * is refused. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

#include "support/scene/parsed.h"
#include "support/suite.h"

static const char head[] = "coordinates: {x: scalar, y: scalar}\n";

#define MOTION "lagrangian: x'^2/2 + y'^2 - x^2*y\n"
#define START "initial: {x: 1, y: 0.5}\nstep: 0.1\nuntil: 1\n"

static const char cart[] =
    "parameters: {k: 3, most: 2}\n"
    "coordinates: {x: scalar, y: scalar}\n"
    "definitions: {r: x*y}\n"
    "controls:\n  u: {cost: k*u^2/2 + r^2 + cosh(w)*x'^2, within: [-most, 2*most]}\n"
    "  w: {cost: w^4 + t*w}\n"
    "lagrangian: x'^2/2 + y'^2 - x^2*y\n"
    "forces: {x: x*u + sin(w)*y' + 0.3*x, y: u^2*x'}\n"
    "initial: {x: 1, y: 0.5}\nfinal: {x: 2, p(y): -1}\nstep: 0.1\nuntil: 1\n";

enum { N = 2, M = 2 };

typedef struct values {
  double C, C_q[N], C_v[N], C_u[M], F[N], F_q[N * N], F_v[N * N], F_u[N * M];
} values;

static values values_at(const dvi_controls *c, const double *point)
{
  values x = {0};
  const double *q = point, *v = point + N, *u = v + N;
  ck_assert_int_eq(c->cost(0.4, q, v, u, &x.C, x.C_q, x.C_v, x.C_u, c->user), 0);
  ck_assert_int_eq(c->force(0.4, q, v, u, x.F, x.F_q, x.F_v, x.F_u, c->user), 0);
  return x;
}

START_TEST(derivatives_are_those_of_differences)
{
  (void)open_scene(cart);
  const dvi_controls *c = dvi_scene_controls(scene);
  double point[2 * N + M] = {0.7, -0.4, 0.3, 1.1, 0.6, -0.8};
  ck_assert_ptr_nonnull(c);
  ck_assert_int_eq(c->count, M);
  const values at = values_at(c, point);
  const double *C_z[] = {at.C_q, at.C_v, at.C_u}, *F_z[] = {at.F_q, at.F_v, at.F_u};
  for (int j = 0; j < 2 * N + M; j++) {
    const double d = 1e-5, from = point[j];
    point[j] = from + d;
    const values more = values_at(c, point);
    point[j] = from - d;
    const values less = values_at(c, point);
    point[j] = from;
    ck_assert_double_eq_tol(C_z[j / 2][j % 2], (more.C - less.C) / (2 * d), 1e-8);
    for (int i = 0; i < N; i++)
      ck_assert_double_eq_tol(F_z[j / 2][j % 2 * N + i], (more.F[i] - less.F[i]) / (2 * d), 1e-8);
  }
  /* forces without controls belong to the system */
  ck_assert_double_eq_tol(at.F[0], 0.7 * 0.6 + sin(-0.8) * 1.1, 1e-15);
}
END_TEST

START_TEST(bounds_names_and_ends_are_those_of_the_scene)
{
  (void)open_scene(cart);
  const dvi_controls *c = dvi_scene_controls(scene);
  dvi_scene_end end;
  ck_assert_str_eq(dvi_scene_control(scene, 1), "w");
  ck_assert_ptr_null(dvi_scene_control(scene, 2));
  ck_assert_double_eq(c->least[0], -2);
  ck_assert_double_eq(c->most[0], 4);
  ck_assert_double_eq(c->most[1], HUGE_VAL);
  ck_assert_int_eq(dvi_scene_end_of(scene, &end), 1);
  ck_assert_double_eq(end.q[0], 2);
  ck_assert_double_eq(end.p[1], -1);
  ck_assert(!end.free_q[0] && end.free_q[1] && end.free_p[0] && !end.free_p[1]);
}
END_TEST

/* A run of the scene is that of the scene whose forces have 0 for the controls. */
START_TEST(controls_are_zero_in_runs)
{
  static const char plain[] = "parameters: {k: 3, most: 2}\ncoordinates: {x: scalar, y: scalar}\n"
                              "lagrangian: x'^2/2 + y'^2 - x^2*y\nforces: {x: 0.3*x}\n" START;
  const char *const text[] = {cart, plain};
  double q[2][N];
  for (int k = 0; k < 2; k++) {
    dvi_integrator *integrator = NULL;
    const double start[] = {1, 0.5}, rest[] = {0, 0};
    ck_assert_int_eq(dvi_integrator_create(open_scene(text[k]), "galerkin:degree=2", &integrator),
                     DVI_OK);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, start, rest), DVI_OK);
    for (int step = 0; step < 10; step++)
      ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_OK);
    for (int i = 0; i < N; i++) q[k][i] = dvi_integrator_q(integrator)[i];
    dvi_integrator_destroy(&integrator);
  }
  ck_assert_double_eq_tol(q[0][0], q[1][0], 1e-14);
  ck_assert_double_eq_tol(q[0][1], q[1][1], 1e-14);
}
END_TEST

static int write_nothing(const char *text, size_t size, void *user)
{
  (void)text, (void)size, (void)user;
  return 0;
}

START_TEST(c_files_refuse_controls)
{
  (void)open_scene(cart);
  ck_assert_int_eq(dvi_scene_emit_c(scene, "cart", write_nothing, NULL), DVI_UNSUPPORTED);
}
END_TEST

static void refused(const char *sections, const char *words)
{
  char text[1024];
  (void)snprintf(text, sizeof text, "%s%s" START, head, sections);
  check_refused(text, DVI_BAD_FILE, "", words);
}

START_TEST(controls_that_make_no_sense_are_refused)
{
  refused("controls: {u: {within: [0, 1]}}\n" MOTION "forces: {x: u}\n", "has no cost");
  refused("controls: {u: {cost: u^2, within: 3}}\n" MOTION "forces: {x: u}\n",
          "bounds are two numbers");
  refused("controls: {u: {cost: u^2, within: [1, 1]}}\n" MOTION "forces: {x: u}\n",
          "the bound 1 does not lie below 1");
  refused("controls: {u: {cost: u^2, bounds: [0, 1]}}\n" MOTION "forces: {x: u}\n",
          "a control has no 'bounds'");
  refused("controls: {x: {cost: x^2}}\n" MOTION "forces: {x: x}\n", "x");
  refused("controls: {u: {cost: u^2}}\nlagrangian: x'^2/2 + y'^2 - u*x\n",
          "controls cannot stand in");
  refused("controls: {u: {cost: u^2}}\n" MOTION "dissipation: u*x'^2\n",
          "controls cannot stand in a dissipation");
  refused(MOTION "final: {x: 1}\n", "the scene has no section controls");
  refused("controls: {u: {cost: u^2}}\n" MOTION "forces: {x: u}\nfinal: {x': 1, p(y): 0}\n",
          "velocities or momenta, not both");
}
END_TEST

SUITE(scene_controls)
{
  tcase_add_checked_fixture(tests, NULL, release_scene);
  tcase_add_test(tests, derivatives_are_those_of_differences);
  tcase_add_test(tests, bounds_names_and_ends_are_those_of_the_scene);
  tcase_add_test(tests, controls_are_zero_in_runs);
  tcase_add_test(tests, c_files_refuse_controls);
  tcase_add_test(tests, controls_that_make_no_sense_are_refused);
}
