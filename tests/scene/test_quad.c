/* Expressions in quadruple precision: against libquadmath, and a scene's gradient against its
 * callbacks and against what the derivatives are on paper. */
#include <check.h>
#include <dvi/scene.h>
#include <math.h>
#include <string.h>

#include "expr/graph_make.h"
#include "expr/quad.h"
#include "support/quad/quad_graph.h"
#include "support/suite.h"

#if defined DVI__QUAD && defined DVI_HAVE_QUADMATH
/* Arguments in the domain of every function that takes them, from small ones to large ones. */
static double argument(dvi__op op, int i)
{
  const double small[] = {-0.999, -0.7, -0.3, -1e-9, 1e-9, 0.1, 0.5, 0.75, 0.9999},
               any[] = {-700.25, -30.5, -1.2, -1e-7, 1e-7, 0.3, 2.75, 41.5, 690.125},
               positive[] = {1e-300, 1e-12, 0.001, 0.3, 0.999, 1.001, 2.5, 1e5, 1e200};
  switch (op) {
  case DVI__OP_ASIN:
  case DVI__OP_ACOS:
  case DVI__OP_ATANH: return small[i];
  case DVI__OP_ACOSH: return 1 + fmin(positive[i], 1e100) * 1e-3;
  case DVI__OP_LOG:
  case DVI__OP_SQRT:
  case DVI__OP_POWER:
  case DVI__OP_RAISE: return positive[i];
  default: return any[i];
  }
}
enum { ARGUMENTS = 9 };

/* Two dozen roundings of numbers of 113 bits, relative: to the result, to the argument (angles), or to
 * the logarithm of the result (powers). */
static const double some_roundings = 24 * 1e-34;

static double off(quad a, quad b, quad size)
{
  const quad difference = a < b ? b - a : a - b;
  return (double)(difference / (size > 1 ? size : 1));
}

START_TEST(every_operation_is_right_to_its_last_digits)
{
  const dvi__op op = (dvi__op)_i;
  const int operands = dvi__operands(op);
  if (operands == 0) return;
  for (int i = 0; i < ARGUMENTS; i++)
    for (int j = 0; j < (operands > 1 ? ARGUMENTS : 1); j++) {
      const double exponent = op == DVI__OP_POWER ? -1.5 : 0;
      const quad a = (quad)argument(op, i) + (quad)1e-20, b = operands > 1 ? (quad)argument(DVI__OP_SIN, j) / 300 : 0;
      const quad expected = quad_operate(op, exponent, a, b), found = dvi__quad_operate(op, exponent, a, b);
      if (!isfinite((double)expected) || fabs((double)expected) > 1e300) continue;
      ck_assert_msg(off(found, expected, fabsq(expected)) <=
                        some_roundings * fmax(fmax(1, fabs((double)a)), fabs(log(fabs((double)expected) + 1e-300))),
                    "%d at %g, %g: %g, %g off", _i, (double)a, (double)b, (double)expected, off(found, expected, fabsq(expected)));
    }
}
END_TEST

/* Central differences of order 2 with a step of 1e-8: the error is some 1e-16 of the third derivative. */
START_TEST(slopes_are_those_of_the_values)
{
  const dvi__op op = (dvi__op)_i;
  const int operands = dvi__operands(op);
  if (operands == 0 || op == DVI__OP_SIGN) return;
  const int least = op == DVI__OP_WHERE; /* a condition is 0 or 1, and has no slope */
  const double exponent = op == DVI__OP_POWER ? 3.5 : 0;
  const quad step = (quad)1e-8, a = op == DVI__OP_ACOSH ? (quad)1.7 : op == DVI__OP_WHERE ? (quad)1 : (quad)0.6, b = (quad)0.8;
  quad slope[2] = {0, 0};
  dvi__quad_slopes(op, exponent, quad_operate(op, exponent, a, b), a, b, slope);
  for (int k = least; k < operands; k++) {
    const quad da = k == 0 ? step : 0, db = k == 1 ? step : 0;
    const quad difference = (quad_operate(op, exponent, a + da, b + db) - quad_operate(op, exponent, a - da, b - db)) / (2 * step);
    ck_assert_msg(off(slope[k], difference, 1) < 1e-14, "%d by %d: %g, not %g", _i, k, (double)slope[k], (double)difference);
  }
}
END_TEST
#endif

static dvi_scene *made(const char *text)
{
  char message[1024] = "";
  dvi_scene *scene = NULL;
  ck_assert_msg(dvi_scene_parse("a", text, strlen(text), 0, NULL, &scene, message, sizeof message) == DVI_OK, "%s", message);
  return scene;
}

static const char chain[] = "parameters: {k: [1, 2, 3]}\ncoordinates: {\"x[3]\": scalar}\nkinetic: sum(i, k[i]*x[i]'^2)/2\n"
                            "potentials: {bonds: \"sum(i=1..2, k[i]*(x[i+1] - x[i])^4/4)\", push: \"x[1]*sin(2*t)\"}\n"
                            "initial: {\"x[i]\": 0.1*i^2, \"x[i]'\": 0.2*i}\nmethod: galerkin\nstep: 0.1\nuntil: 1\n";
static const char general[] =
    "coordinates: {a: scalar, b: scalar}\nlagrangian: a'^2/2 + a'*b'*cos(a - b) + b'^2 + exp(a*b) - hypot(a, b)\n"
    "initial: {a: 0.4, b: 1.3, a': 0.7, b': -0.2}\nmethod: galerkin\nstep: 0.1\nuntil: 1\n";

#ifdef DVI__QUAD
enum { N_MAX = 3 };

/* The sum of both parts is the callbacks' number to some roundings of a double. */
START_TEST(the_gradient_is_that_of_the_callbacks)
{
  dvi_scene *scene = made(_i == 0 ? chain : general);
  const dvi_system_terms *terms = dvi_scene_terms(scene);
  const double *q, *v, *p, t = 0.3;
  double L_q[N_MAX] = {0}, L_v[N_MAX], V_q[N_MAX];
  dvi_pair at[2][N_MAX], found[2][N_MAX];
  dvi_scene_start(scene, &q, &v, &p);
  const int n = dvi_system_nq(dvi_scene_system(scene));
  for (int i = 0; i < n; i++) at[0][i] = (dvi_pair){q[i], 0}, at[1][i] = (dvi_pair){v[i], 0};
  ck_assert_int_eq(dvi_scene_quad_gradient(scene, (dvi_pair){t, 0}, at[0], at[1], found[0], found[1]), DVI_OK);
  if (terms->lagrangian != NULL)
    ck_assert_int_eq(terms->lagrangian->gradient_batch(1, &t, q, v, L_q, L_v, terms->lagrangian->user), 0);
  for (int k = 0; k < terms->potential_count; k++) {
    ck_assert_int_eq(terms->potentials[k].gradient_batch(1, &t, q, V_q, terms->potentials[k].user), 0);
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

/* L_q = -x^3 at x = 1/3 to 32 digits: 1/3 is the pair of 0x1.5555555555555p-2 and a 2^-54 of it. */
START_TEST(digits_beyond_a_double_are_there)
{
  dvi_scene *scene = made(
      "coordinates: {x: scalar}\nlagrangian: x'^2/2 - x^4/4\ninitial: {x: 1}\nmethod: galerkin\nstep: 0.1\nuntil: 1\n");
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
  dvi_scene *scene = made(
      "coordinates: {x: scalar}\nlagrangian: x'^2/2 - log(x)\ninitial: {x: 1}\nmethod: galerkin\nstep: 0.1\nuntil: 1\n");
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
      "coordinates: {x: scalar, y: scalar}\none_form: {x: y}\nhamiltonian: x^2 + y^2\ninitial: {x: 1, y: 0}\n"
      "method: vprk\nstep: 0.1\nuntil: 1\n",
      "coordinates: {x: scalar}\nhamiltonian: x^2 + p(x)^2\ninitial: {x: 1, p(x): 0}\nmethod: hamiltonian\nstep: 0.1\nuntil: 1\n",
      "coordinates: {R: rotation}\nlagrangian: dot(omega(R), omega(R))/2\ninitial: {R: 'turn([0, 0, 1], 0)'}\n"
      "method: lie-verlet\nstep: 0.1\nuntil: 1\n"};
  dvi_scene *scene = made(others[_i]);
  dvi_pair x[18] = {{0, 0}}, L_q[18], L_v[18];
  ck_assert_int_eq(dvi_scene_quad_gradient(scene, x[0], x, x, L_q, L_v), DVI_UNSUPPORTED);
  dvi_scene_destroy(&scene);
}
END_TEST

SUITE(quad)
{
#if defined DVI__QUAD && defined DVI_HAVE_QUADMATH
  tcase_add_loop_test(tests, every_operation_is_right_to_its_last_digits, 0, DVI__OP_COUNT);
  tcase_add_loop_test(tests, slopes_are_those_of_the_values, 0, DVI__OP_COUNT);
#endif
#ifdef DVI__QUAD
  tcase_add_loop_test(tests, the_gradient_is_that_of_the_callbacks, 0, 2);
  tcase_add_test(tests, digits_beyond_a_double_are_there);
  tcase_add_test(tests, a_point_without_a_gradient_is_told);
#endif
  tcase_add_loop_test(tests, what_is_no_lagrangian_of_numbers_is_refused, 0, 3);
}
