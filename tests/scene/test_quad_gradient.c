/* A scene's gradient in quadruple precision, against its callbacks and against derivatives on
 * paper. */
#include <check.h>
#include <dvi/scene.h>
#include <math.h>
#include <string.h>

#include "expr/quad.h"
#include "support/suite.h"

static dvi_scene *read_scene(const char *text)
{
  char message[1024] = "";
  dvi_scene *scene = NULL;
  ck_assert_msg(
      dvi_scene_parse("a", text, strlen(text), 0, NULL, &scene, message, sizeof message) == DVI_OK,
      "%s", message);
  return scene;
}

static const char chain[] =
    "parameters: {k: [1, 2, 3]}\ncoordinates: {\"x[3]\": scalar}\nkinetic: sum(i, k[i]*x[i]'^2)/2\n"
    "potentials: {bonds: \"sum(i=1..2, k[i]*(x[i+1] - x[i])^4/4)\", push: \"x[1]*sin(2*t)\"}\n"
    "initial: {\"x[i]\": 0.1*i^2, \"x[i]'\": 0.2*i}\nmethod: galerkin\nstep: 0.1\nuntil: 1\n";
static const char general[] =
    "coordinates: {a: scalar, b: scalar}\nlagrangian: a'^2/2 + a'*b'*cos(a - b) + b'^2 + exp(a*b) "
    "- hypot(a, b)\n"
    "initial: {a: 0.4, b: 1.3, a': 0.7, b': -0.2}\nmethod: galerkin\nstep: 0.1\nuntil: 1\n";

#ifdef DVI__QUAD
enum { N_MAX = 3 };

/* The sum of both parts is the callbacks' number to some roundings of a double. */
START_TEST(the_gradient_is_that_of_the_callbacks)
{
  dvi_scene *scene = read_scene(_i == 0 ? chain : general);
  const dvi_system_terms *terms = dvi_scene_terms(scene);
  const double *q, *v, *p, t = 0.3;
  double L_q[N_MAX] = {0}, L_v[N_MAX], V_q[N_MAX];
  dvi_pair at[2][N_MAX], found[2][N_MAX];
  dvi_scene_start(scene, &q, &v, &p);
  const int n = dvi_system_nq(dvi_scene_system(scene));
  for (int i = 0; i < n; i++) at[0][i] = (dvi_pair){q[i], 0}, at[1][i] = (dvi_pair){v[i], 0};
  ck_assert_int_eq(
      dvi_scene_quad_gradient(scene, (dvi_pair){t, 0}, at[0], at[1], found[0], found[1]), DVI_OK);
  if (terms->lagrangian != NULL)
    ck_assert_int_eq(
        terms->lagrangian->gradient_batch(1, &t, q, v, L_q, L_v, terms->lagrangian->user), 0);
  for (int k = 0; k < terms->potential_count; k++) {
    ck_assert_int_eq(terms->potentials[k].gradient_batch(1, &t, q, V_q, terms->potentials[k].user),
                     0);
    for (int i = 0; i < n; i++) L_q[i] -= V_q[i];
  }
  for (int i = 0; i < n; i++) {
    ck_assert_double_eq_tol(found[0][i].high, L_q[i], 1e-15);
    ck_assert_double_eq_tol(found[1][i].high, p[i], 1e-15);
    ck_assert(fabs(found[0][i].low) <= 1.2e-16 * fabs(found[0][i].high));
  }
  dvi_scene_destroy(&scene);
}
END_TEST

/* L_q = -x^3 at x = 1/3 to 32 digits. 1/3 is the pair of 0x1.5555555555555p-2 and a 2^-54 of it. */
START_TEST(digits_beyond_a_double_are_there)
{
  dvi_scene *scene = read_scene("coordinates: {x: scalar}\nlagrangian: x'^2/2 - x^4/4\n"
                                "initial: {x: 1}\nmethod: galerkin\nstep: 0.1\nuntil: 1\n");
  const dvi_pair third = {1.0 / 3, 0x1.5555555555555p-56};
  dvi_pair L_q, L_v;
  ck_assert_int_eq(dvi_scene_quad_gradient(scene, third, &third, &third, &L_q, &L_v), DVI_OK);
  const dvi__quad error = ((dvi__quad)L_q.high + (dvi__quad)L_q.low) * 27 + 1;
  ck_assert(fabs((double)error) < 1e-30);
  ck_assert(L_v.high >= third.high && L_v.high <= third.high && fabs(L_v.low - third.low) < 1e-32);
  dvi_scene_destroy(&scene);
}
END_TEST

START_TEST(a_point_without_a_gradient_is_told)
{
  dvi_scene *scene = read_scene("coordinates: {x: scalar}\nlagrangian: x'^2/2 - log(x)\n"
                                "initial: {x: 1}\nmethod: galerkin\nstep: 0.1\nuntil: 1\n");
  const dvi_pair zero = {0, 0};
  dvi_pair L_q, L_v;
  ck_assert_int_eq(dvi_scene_quad_gradient(scene, zero, &zero, &zero, &L_q, &L_v), DVI_NOT_FINITE);
  ck_assert_int_eq(dvi_scene_quad_gradient(scene, zero, NULL, &zero, &L_q, &L_v), DVI_BAD_ARGUMENT);
  dvi_scene_destroy(&scene);
}
END_TEST
#endif

START_TEST(what_is_no_lagrangian_of_numbers_is_refused)
{
  static const char *const others[] = {
      "coordinates: {x: scalar, y: scalar}\none_form: {x: y}\nhamiltonian: x^2 + y^2\n"
      "initial: {x: 1, y: 0}\nmethod: vprk\nstep: 0.1\nuntil: 1\n",
      "coordinates: {x: scalar}\nhamiltonian: x^2 + p(x)^2\ninitial: {x: 1, p(x): 0}\n"
      "method: hamiltonian\nstep: 0.1\nuntil: 1\n",
      "coordinates: {R: rotation}\nlagrangian: dot(omega(R), omega(R))/2\n"
      "initial: {R: 'turn([0, 0, 1], 0)'}\nmethod: lie-verlet\nstep: 0.1\nuntil: 1\n"};
  dvi_scene *scene = read_scene(others[_i]);
  dvi_pair x[18] = {{0, 0}}, L_q[18], L_v[18];
  ck_assert_int_eq(dvi_scene_quad_gradient(scene, x[0], x, x, L_q, L_v), DVI_UNSUPPORTED);
  dvi_scene_destroy(&scene);
}
END_TEST

SUITE(quad_gradient)
{
#ifdef DVI__QUAD
  tcase_add_loop_test(tests, the_gradient_is_that_of_the_callbacks, 0, 2);
  tcase_add_test(tests, digits_beyond_a_double_are_there);
  tcase_add_test(tests, a_point_without_a_gradient_is_told);
#endif
  tcase_add_loop_test(tests, what_is_no_lagrangian_of_numbers_is_refused, 0, 3);
}
