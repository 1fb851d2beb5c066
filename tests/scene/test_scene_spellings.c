/* Two spellings of one thing give the same scene: sums and the terms that they stand for, vectors
 * and their numbers, definitions and their texts. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/suite.h"

enum { N = 8, MESSAGE_SIZE = 1024, TEXT_SIZE = 2048 };

static char message[MESSAGE_SIZE];
static dvi_scene *scene[2];

static void release(void)
{
  for (int k = 0; k < 2; k++) dvi_scene_destroy(&scene[k]);
}

/* Coordinates x, y, the vector u of 3 and the family z_1 .. z_3, with a mass for all, so that every
 * spelling moves. */
static void open_spelling(int k, const char *definitions, const char *L)
{
  char text[TEXT_SIZE];
  (void)snprintf(
      text, sizeof text,
      "parameters: {n: 3, m: [2, 3, 5], A: [[1, 2, 3], [4, 5, 6], [7, 8, 9]], pair: [3, 1, 2]}\n"
      "coordinates:\n  [x, y]: scalar\n  u: vector(3)\n  z[n]: scalar\n%s"
      "lagrangian: (x'^2 + y'^2 + dot(u', u') + sum(i, z[i]'^2))/2 + (%s)\n"
      "initial: {x: 1, y: 1, u: [1, 0, 0], z: [1, 2, 3]}\nstep: 0.1\nuntil: 1\n",
      definitions, L);
  const dvi_status status = dvi_scene_parse("test.yaml", text, strlen(text), 0, NULL, &scene[k],
                                            message, sizeof message);
  ck_assert_msg(status == DVI_OK, "%s", message);
}

static double value(int k, double t, const double *q, const double *v, double *p)
{
  double L;
  ck_assert_msg(dvi_system_lagrangian(dvi_scene_system(scene[k]), t, q, v, &L) == DVI_OK, "%s",
                dvi_scene_fault());
  ck_assert_int_eq(dvi_system_momentum(dvi_scene_system(scene[k]), t, q, v, p), DVI_OK);
  return L;
}

static void same_with(const char *definitions, const char *a, const char *b)
{
  static const double q[N] = {0.7, 0.4, 1.1, -0.6, 0.9, 0.3, 0.8, 1.3},
                      v[N] = {0.2, -0.5, 0.4, 0.6, -0.3, 0.1, 0.9, -0.7};
  double p[2][N];
  release();
  open_spelling(0, definitions, a);
  open_spelling(1, "", b);
  const double L[2] = {value(0, 0.4, q, v, p[0]), value(1, 0.4, q, v, p[1])};
  ck_assert_msg(fabs(L[0] - L[1]) <= 1e-13 * fmax(1, fabs(L[1])), "%s: %.17g, %s: %.17g", a, L[0],
                b, L[1]);
  for (int i = 0; i < N; i++)
    ck_assert_msg(fabs(p[0][i] - p[1][i]) <= 1e-13 * fmax(1, fabs(p[1][i])), "%s: p %d", a, i);
  for (int k = 0; k < 2; k++)
    ck_assert_msg(dvi_system_check(dvi_scene_system(scene[k]), 0.4, q, v, 0, NULL) == DVI_OK, "%s",
                  dvi_last_error());
}

static void check_same_scene(const char *a, const char *b)
{
  same_with("", a, b);
}

START_TEST(sums_are_their_terms)
{
  check_same_scene("sum(i, m[i]*z[i]^2)", "2*z[1]^2 + 3*z[2]^2 + 5*z[3]^2");
  check_same_scene("sum(i=2..n, i*z[i]*z[i-1])", "2*z[2]*z[1] + 3*z[3]*z[2]");
  check_same_scene("sum(i=3..2, z[i])", "0");
  check_same_scene("sum(i<j, m[i]*m[j]*(z[i] - z[j])^4)",
                   "6*(z[1] - z[2])^4 + 10*(z[1] - z[3])^4 + 15*(z[2] - z[3])^4");
  check_same_scene("sum(i<j=2..n, z[i]*z[j])", "z[2]*z[3]");
  check_same_scene("sum(i, z[pair[i]]*z[i])", "z[3]*z[1] + z[1]*z[2] + z[2]*z[3]");
  check_same_scene(
      "sum(i, sum(j, A[i,j]*z[i]*sin(z[j])))",
      "z[1]*(sin(z[1]) + 2*sin(z[2]) + 3*sin(z[3])) + z[2]*(4*sin(z[1]) + 5*sin(z[2]) + "
      "6*sin(z[3]))"
      " + z[3]*(7*sin(z[1]) + 8*sin(z[2]) + 9*sin(z[3]))");
  check_same_scene(
      "sum(i=1..n, sum(j=1..i, z[i]*cos(z[j])))",
      "z[1]*cos(z[1]) + z[2]*(cos(z[1]) + cos(z[2])) + z[3]*(cos(z[1]) + cos(z[2]) + cos(z[3]))");
}
END_TEST

START_TEST(sums_inside_of_something_are_their_terms)
{
  check_same_scene("sqrt(sum(i, z[i]^2))", "sqrt(z[1]^2 + z[2]^2 + z[3]^2)");
  check_same_scene("sum(i=1..n, sin(sum(j=1..i, z[j])))",
                   "sin(z[1]) + sin(z[1] + z[2]) + sin(z[1] + z[2] + z[3])");
  check_same_scene("x*sum(i, z[i])", "x*z[1] + x*z[2] + x*z[3]");
  check_same_scene("sum(i, z[i])*sum(j, z[j])", "(z[1] + z[2] + z[3])^2");
  check_same_scene("norm(sum(i, [z[i], m[i]*z[i]]))",
                   "sqrt((z[1] + z[2] + z[3])^2 + (2*z[1] + 3*z[2] + 5*z[3])^2)");
  check_same_scene("sum(i=1..n, u[i]*z[i])", "dot(u, [z[1], z[2], z[3]])");
}
END_TEST

/* The index of a definition's own sum is another one than that around its use. */
START_TEST(definitions_do_not_see_the_indices_around_them)
{
  same_with("definitions: {all: 'sum(i=1..n, z[i])'}\n", "sum(i=1..n, (u[i] + all - m[i]*z[i])^2)",
            "sum(i=1..n, (u[i] + z[1] + z[2] + z[3] - m[i]*z[i])^2)");
  same_with("definitions: {all: 'sum(k=1..n, z[k])', more: 'sum(i=1..n, all*i*z[i])'}\n",
            "sum(i=1..n, sum(k=1..n, sin(more*u[k])*z[i]))",
            "(z[1] + z[2] + z[3])*sum(k=1..n, "
            "sin((z[1] + z[2] + z[3])*(z[1] + 2*z[2] + 3*z[3])*u[k]))");
}
END_TEST

START_TEST(factors_of_sums_are_kept)
{
  check_same_scene("-2*sum(i, z[i]^2)/4", "-(z[1]^2 + z[2]^2 + z[3]^2)/2");
  check_same_scene("x - (y - sum(i, z[i]^2))*3", "x - 3*y + 3*(z[1]^2 + z[2]^2 + z[3]^2)");
  check_same_scene("cos(t)*sum(i, z[i])", "cos(t)*z[1] + cos(t)*z[2] + cos(t)*z[3]");
  same_with("definitions: {V: 'sum(i, z[i]^3)', W: 2*V + x}\n", "V - W",
            "-(z[1]^3 + z[2]^3 + z[3]^3) - x");
}
END_TEST

START_TEST(vectors_and_matrices_are_their_numbers)
{
  check_same_scene("dot(u, [1, x, y])", "u[1] + u[2]*x + u[3]*y");
  check_same_scene("dot(cross(u, [1, 2, 3]), [x, y, 1])",
                   "(u[2]*3 - u[3]*2)*x + (u[3] - 3*u[1])*y + (2*u[1] - u[2])");
  check_same_scene("cross([x, y], [u[1], u[2]])", "x*u[2] - y*u[1]");
  check_same_scene("norm(u - [x, y, 0])", "sqrt((u[1] - x)^2 + (u[2] - y)^2 + u[3]^2)");
  check_same_scene("dot(u, A*u)", "dot(transpose(A)*u, u)");
  check_same_scene("dot(A[2], u)", "4*u[1] + 5*u[2] + 6*u[3]");
  check_same_scene("dot((A*A)*u, [0, 1, 0])", "66*u[1] + 81*u[2] + 96*u[3]");
  check_same_scene("dot(turn([0, 0, 2], x)*u, [1, 0, 0])", "cos(x)*u[1] - sin(x)*u[2]");
  check_same_scene("dot(turn([1, 0, 0], x)*u, [0, 0, 1])", "sin(x)*u[2] + cos(x)*u[3]");
  check_same_scene("dot(turn([0, 1, 0], x)*u, [0, 0, 1])", "-sin(x)*u[1] + cos(x)*u[3]");
}
END_TEST

START_TEST(rates_follow_the_chain_rule)
{
  check_same_scene("(sin(x)*y)'", "cos(x)*x'*y + sin(x)*y'");
  same_with("definitions:\n  r: [x*cos(t), y^2]\n  s: dot(r, r)\n", "dot(r', r') + s'",
            "(x'*cos(t) - x*sin(t))^2 + 4*y^2*y'^2 + 2*x*cos(t)*(x'*cos(t) - x*sin(t)) + 4*y^3*y'");
  check_same_scene("sum(i, (z[i]^2)'^2)", "4*(z[1]^2*z[1]'^2 + z[2]^2*z[2]'^2 + z[3]^2*z[3]'^2)");
  check_same_scene("dot(u, u)'", "2*dot(u, u')");
  check_same_scene("u[2]'*u'[1]/2", "u'[2]*u[1]'/2");
}
END_TEST

START_TEST(powers_and_functions_are_those_of_the_page)
{
  check_same_scene("-x^2", "-(x^2)");
  check_same_scene("x^y^2", "x^(y^2)");
  check_same_scene("x^3 + y^(-2) + u[1]^0.5", "x*x*x + 1/y/y + sqrt(u[1])");
  check_same_scene("atan2(x, y) + hypot(x, y)", "atan(x/y) + sqrt(x^2 + y^2)");
  check_same_scene("sinh(x) + cosh(x) + abs(-x)", "exp(x) + x");
}
END_TEST

SUITE(scene_spellings)
{
  tcase_add_checked_fixture(tests, NULL, release);
  tcase_add_test(tests, sums_are_their_terms);
  tcase_add_test(tests, sums_inside_of_something_are_their_terms);
  tcase_add_test(tests, definitions_do_not_see_the_indices_around_them);
  tcase_add_test(tests, factors_of_sums_are_kept);
  tcase_add_test(tests, vectors_and_matrices_are_their_numbers);
  tcase_add_test(tests, rates_follow_the_chain_rule);
  tcase_add_test(tests, powers_and_functions_are_those_of_the_page);
}
