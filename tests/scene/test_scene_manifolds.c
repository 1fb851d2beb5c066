/* Scenes with rotations, rigid motions, directions and angles: the Lagrangian that is written is
 * the one that there is, and what makes no sense is told with its place. apps/scenes has those of
 * the catalogue, which move as the hand-written ones (tests/apps/scene/test_scenes.sh). */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/scene/parsed.h"
#include "support/suite.h"

enum { TEXT_SIZE = 1024, MOST = 64 };

static void check_near(double found, double wanted)
{
  ck_assert_msg(fabs(found - wanted) <= 1e-14 * fmax(1, fabs(wanted)), "%.17g instead of %.17g",
                found, wanted);
}

#define RUN "step: 0.1\nuntil: 1\n"

/* ---- what is written is what there is ---- */

static const double R[9] = {0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6}; /* a rotation */

/* a = R b */
static void rotate(const double *b, double *a)
{
  for (int i = 0; i < 3; i++) a[i] = R[3 * i] * b[0] + R[3 * i + 1] * b[1] + R[3 * i + 2] * b[2];
}

static void cross(const double *a, const double *b, double *c)
{
  for (int i = 0; i < 3; i++)
    c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

START_TEST(an_angle_is_the_coordinate_of_the_same_pendulum)
{
  static const char *const with_angle =
      "coordinates:\n  x: scalar\n  u: angle\ndefinitions:\n  bob: \"[x + 0.5*u[2], -0.5*u[1]]\"\n"
      "lagrangian: x'^2 + 0.3*rate(u)^2 + 0.1*dot(bob', bob') - 2*bob[2]\n"
      "initial: {x: 0.3, u: 0.7, x': 0.2, rate(u): -0.4}\n" RUN;
  static const char *const with_number =
      "coordinates:\n  x: scalar\n  u: scalar\ndefinitions:\n  bob: [x + 0.5*sin(u), -0.5*cos(u)]\n"
      "lagrangian: x'^2 + 0.3*u'^2 + 0.1*dot(bob', bob') - 2*bob[2]\n"
      "initial: {x: 0.3, u: 0.7, x': 0.2, u': -0.4}\n" RUN;
  const double *q, *v, *p;
  double L[2], momentum[2];
  const dvi_system *system = open_scene(with_number);
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_int_eq(dvi_system_lagrangian(system, 0, q, v, &L[0]), DVI_OK);
  memcpy(momentum, p, sizeof momentum);
  system = open_scene(with_angle);
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_int_eq(dvi_system_lagrangian(system, 0, q, v, &L[1]), DVI_OK);
  check_near(q[1], cos(0.7));
  check_near(q[2], sin(0.7));
  check_near(L[1], L[0]);
  for (int i = 0; i < 2; i++) check_near(p[i], momentum[i]);
}
END_TEST

START_TEST(a_point_of_a_body_moves_as_its_velocity_says)
{
  const dvi_system *system = open_scene(
      "parameters: {J: [[3, 0.1, 0], [0.1, 2, 0], [0, 0, 1.5]], c: [0.3, -0.2, 0.5]}\ncoordinates: "
      "{B: motion}\n"
      "definitions:\n  centre: B.x + B.R*c\n"
      "lagrangian: 2*dot(centre', centre') + dot(omega(B), J*omega(B))/2 - B.R[3,1]\n"
      "initial:\n  B.R: [[0.36, 0.48, -0.8], [-0.8, 0.6, 0], [0.48, 0.64, 0.6]]\n  B.x: [1, 2, 3]\n"
      "  omega(B): [0.4, -0.3, 0.2]\n  B.x': [0.5, 0.6, 0.7]\n" RUN);
  static const double c[] = {0.3, -0.2, 0.5}, w[] = {0.4, -0.3, 0.2}, x_t[] = {0.5, 0.6, 0.7};
  const double Jw[] = {3 * w[0] + 0.1 * w[1], 0.1 * w[0] + 2 * w[1], 1.5 * w[2]};
  const double *q, *v, *p;
  double turned[3], speed[3], L, pull[3], body[3];
  cross(w, c, turned);
  rotate(turned, speed);
  for (int i = 0; i < 3; i++) speed[i] += x_t[i];
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_int_eq(dvi_system_lagrangian(system, 0, q, v, &L), DVI_OK);
  check_near(L, 2 * dot(speed, speed) + 0.5 * dot(w, Jw) - R[6]);
  for (int j = 0; j < 3; j++)
    body[j] = 4 * (R[j] * speed[0] + R[3 + j] * speed[1] + R[6 + j] * speed[2]);
  cross(c, body, pull);
  for (int i = 0; i < 3; i++) check_near(p[i], Jw[i] + pull[i]);
  for (int i = 0; i < 3; i++) check_near(p[3 + i], 4 * speed[i]);
  ck_assert_int_eq(dvi_system_nq(system), 12);
  ck_assert_int_eq(dvi_system_nv(system), 6);
}
END_TEST

/* One of everything, and families of some. */
#define ZOO                                                                                        \
  "coordinates:\n  u: angle\n  x: scalar\n  R: rotation\n  d: direction\n  B[2]: motion\n  w[2]: " \
  "angle\n"                                                                                        \
  "kinetic: >-\n  x'^2/2 + rate(u)^2 + dot(omega(R), omega(R)) + dot(d', d') + sum(i, "            \
  "rate(w[i])^2)\n"                                                                                \
  "  + sum(i, dot(B[i].x', B[i].x') + dot(omega(B[i]), omega(B[i])))\n"                            \
  "initial:\n  u: 0.5\n  x: 1\n  R: turn([1, 2, 2], 0.4)\n  d: [0.6, 0, 0.8]\n  B[i].R: turn([0, " \
  "1, i], i)\n"                                                                                    \
  "  B.x: [[1, 2, 3], [4, 5, 6]]\n  w: [0.1, 0.2]\n  rate(u): 0.3\n  x': 0.7\n  omega(R): [0.1, "  \
  "0.2, 0.3]\n"                                                                                    \
  "  d': \"cross([0.1, 0.2, 0.3], [0.6, 0, 0.8])\"\n  B.x': [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]\n"  \
  "  omega(B[2]): [0.3, 0.1, 0.2]\n  w[1]: 0.1\n  rate(w): [0.4, 0.6]\n" RUN

enum { U = 0, X = 2, TURN = 3, D = 12, B_2 = 27, W_2 = 41 };                     /* in q */
enum { V_U = 0, V_X = 1, V_TURN = 2, V_D = 5, V_B_2 = 14, V_W_2 = 21, NV = 22 }; /* in v */

/* The first event of a scene, at a state. */
static double event_at(const double *q, const double *v)
{
  double g;
  const dvi_scene_event *event = dvi_scene_event_at(scene, 0);
  ck_assert_int_eq(event->value(0, q, v, &g, event->user), 0);
  return g;
}

static double event_of(const char *zero)
{
  char text[2 * TEXT_SIZE];
  const double *q, *v, *p;
  (void)snprintf(text, sizeof text, ZOO "events: {e: {zero: \"%s\"}}\n", zero);
  (void)open_scene(text);
  dvi_scene_start(scene, &q, &v, &p);
  return event_at(q, v);
}

/* Runs a scene of all kinds of coordinates with this section, whose system passes the check, and
 * gives q at the end. */
static void end_with(const char *section, double *end)
{
  char text[TEXT_SIZE];
  const double *q, *v, *p;
  dvi_derivative_check found;
  dvi_integrator *integrator;
  (void)snprintf(text, sizeof text,
                 "coordinates: {B: motion, u: angle, d: direction, x: scalar}\n"
                 "lagrangian: dot(B.x', B.x')/2 + dot(omega(B), omega(B))/2 + 0.1*omega(B)[2]^2 + "
                 "rate(u)^2 + dot(d', d') + x'^2 - 9.81*B.x[3] - d[3] - x*B.x[1]\n%s\n"
                 "initial: {B.R: \"turn([1, 0, 0], 2)\", omega(B): \"[1, 2, 3]\", B.x: \"[0, 1, "
                 "2]\", B.x': \"[1, 2, 1]\", u: 0.2, rate(u): 1, d: \"[0, 0, 1]\", d': \"[1, 0, "
                 "0]\", x: 1, x': 0.5}\n" RUN,
                 section);
  const dvi_system *system = open_scene(text);
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_msg(dvi_system_check(system, 0.3, q, v, 0, &found) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_integrator_create(system, "lie-galerkin:degree=2", &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  for (int k = 0; k < 10; k++) ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_OK);
  memcpy(end, dvi_integrator_q(integrator), (size_t)dvi_system_nq(system) * sizeof *end);
  dvi_integrator_destroy(&integrator);
}

START_TEST(a_dissipation_is_the_force_that_follows_from_it)
{
  double by_function[MOST], by_force[MOST];
  end_with("dissipation: 0.05*dot(omega(B), omega(B)) + 0.1*B.x'[3]^4 + 0.1*rate(u)^2 + "
           "0.15*dot(d', d') + 0.15*x'^2*(1 + x^2)",
           by_function);
  end_with("forces: {omega(B): -0.1*omega(B), B.x: \"[0, 0, -0.4*B.x'[3]^3]\", rate(u): "
           "-0.2*rate(u), d: -0.3*d', x: -0.3*x'*(1 + x^2)}",
           by_force);
  for (int i = 0; i < 18; i++) ck_assert_double_eq_tol(by_function[i], by_force[i], 1e-12);
}
END_TEST

START_TEST(events_see_the_velocities_of_the_state)
{
  const double *q, *v, *p;
  double turned[3];
  static const double c[] = {1, 2, 3};
  (void)open_scene(ZOO);
  dvi_scene_start(scene, &q, &v, &p);
  check_near(q[W_2], cos(0.2));
  check_near(v[V_B_2 + 3], 0.4);
  double held_q[MOST], held_v[NV];
  memcpy(held_q, q, 43 * sizeof *q);
  memcpy(held_v, v, sizeof held_v);
  check_near(event_of("rate(u) + 10*x' + 100*rate(w[2])"), 0.3 + 7 + 60);
  check_near(event_of("u[1]' + 3*u[2]'"), -0.3 * sin(0.5) + 0.9 * cos(0.5));
  check_near(event_of("sum(i, w[i][1]')"), -0.4 * sin(0.1) - 0.6 * sin(0.2));
  check_near(event_of("dot(d', [1, 10, 100])"),
             held_v[V_D] + 10 * held_v[V_D + 1] + 100 * held_v[V_D + 2]);
  check_near(event_of("B[2].x[3]' + omega(B[2])[1]"), 0.6 + 0.3);
  cross(held_v + V_B_2, c, turned);
  check_near(event_of("(B[2].R*[1, 2, 3])[2]'"), dot(held_q + B_2 + 3, turned));
  check_near(event_of("sum(i, (B[i].R*[1, 2, 3])[2]')"), dot(held_q + B_2 + 3, turned));
  cross(held_v + V_TURN, c, turned);
  check_near(event_of("dot((R*[1, 2, 3])', (R*[1, 2, 3])')"), dot(turned, turned));
}
END_TEST

START_TEST(symmetries_and_invariants_go_by_the_velocities_of_the_state)
{
  const dvi_system *system = open_scene(
      ZOO "symmetries:\n  a: {rate(u): 2, omega(R): \"transpose(R)*[0, 0, 1]\", d: \"cross([0, 0, "
          "1], d)\", \"B[i].x\": \"i*B[i].x\"}\n"
          "  b: {\"omega(B[i])\": \"[0, i, 0]\", \"rate(w[i])\": i}\n"
          "invariants:\n  c: p(u) + 10*p(w[2]) + p(d)[1] + p(d[2]) + p(x) + dot(p(R), [1, 2, 3]) + "
          "p(B[2].R)[1] + p(B[2].x)[3]\n");
  const double *q, *v, *p;
  double I[4];
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_int_eq(dvi_system_invariants(system, 0, q, p, I), DVI_OK);
  double a = 2 * p[V_U] + dot(q + TURN + 6, p + V_TURN) - q[D + 1] * p[V_D] + q[D] * p[V_D + 1];
  a += dot(q + B_2 - 3, p + V_B_2 - 3) + 2 * dot(q + B_2 + 9, p + V_B_2 + 3);
  check_near(I[1], a);
  check_near(I[2], p[V_B_2 - 5] + 2 * p[V_B_2 + 1] + p[V_W_2 - 1] + 2 * p[V_W_2]);
  check_near(I[3], p[V_U] + 10 * p[V_W_2] + p[V_D] + p[V_D + 1] + p[V_X] + p[V_TURN] +
                       2 * p[V_TURN + 1] + 3 * p[V_TURN + 2] + p[V_B_2] + p[V_B_2 + 5]);
}
END_TEST

START_TEST(all_numbers_have_names)
{
  (void)open_scene(ZOO);
  ck_assert_str_eq(dvi_scene_coordinate(scene, U), "u_cos");
  ck_assert_str_eq(dvi_scene_coordinate(scene, X), "x");
  ck_assert_str_eq(dvi_scene_coordinate(scene, TURN + 5), "R_23");
  ck_assert_str_eq(dvi_scene_coordinate(scene, D + 1), "d_y");
  ck_assert_str_eq(dvi_scene_coordinate(scene, B_2 + 8), "B_2_R_33");
  ck_assert_str_eq(dvi_scene_coordinate(scene, B_2 + 9), "B_2_x_x");
  ck_assert_str_eq(dvi_scene_coordinate(scene, W_2 + 1), "w_2_sin");
  ck_assert_ptr_null(dvi_scene_coordinate(scene, W_2 + 2));
  ck_assert_str_eq(dvi_scene_velocity(scene, V_U), "rate_u");
  ck_assert_str_eq(dvi_scene_velocity(scene, V_TURN + 1), "omega_R_y");
  ck_assert_str_eq(dvi_scene_velocity(scene, V_B_2 + 2), "omega_B_2_z");
  ck_assert_str_eq(dvi_scene_velocity(scene, V_B_2 + 4), "v_B_2_x_y");
  ck_assert_str_eq(dvi_scene_momentum(scene, V_B_2 + 2), "p_B_2_R_z");
  ck_assert_str_eq(dvi_scene_momentum(scene, V_W_2), "p_w_2");
  ck_assert_ptr_null(dvi_scene_velocity(scene, NV));
  ck_assert_ptr_null(dvi_scene_momentum(scene, NV));
}
END_TEST

START_TEST(momenta_give_the_start_as_velocities_do)
{
  const double *q, *v, *p;
  (void)open_scene(
      "coordinates: {R: rotation, d: direction, u: angle}\n"
      "lagrangian: omega(R)[1]^2 + omega(R)[2]^2 + 0.5*omega(R)[3]^2 + dot(d', d') + 2*rate(u)^2\n"
      "initial: {R: \"turn([0, 0, 1], 1)\", d: [0, 0, 1], u: 0, p(R): [1, 2, 3], p(d): [4, 6, 0], "
      "p(u): 8}\n" RUN);
  dvi_scene_start(scene, &q, &v, &p);
  static const double wanted[] = {0.5, 1, 3, 2, 3, 0, 2};
  for (int i = 0; i < 7; i++) check_near(v[i], wanted[i]);
}
END_TEST

/* ---- what makes no sense ---- */

static void refused(const char *text, const char *place, const char *words)
{
  check_refused(text, DVI_BAD_FILE, place, words);
}

#define KINDS "coordinates: {R: rotation, B: motion, d: direction, u: angle, x: scalar}\n"

/* A Lagrangian in line 2, from column 13 on, of a scene with one of each kind. */
static void lagrangian_refused(const char *L, const char *place, const char *words)
{
  char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text, KINDS "lagrangian: %s\ninitial: {x: 1}\n" RUN, L);
  refused(text, place, words);
}

START_TEST(lagrangians_without_a_constant_mass_are_refused)
{
  static const char *const form = "this term is of another form";
  lagrangian_refused("x'^2 + R[1,1]*x'^2", ":2:20:", form);
  lagrangian_refused("x'^2 - u[1]*rate(u)*x'", ":2:20:", form);
  lagrangian_refused("x'^2 + x*x'", ":2:20:", form);
  lagrangian_refused("x'^2 + t*rate(u)^2", ":2:20:", form);
  lagrangian_refused("x'^2 + exp(x')", ":2:20:", form);
  lagrangian_refused("u[1]*x'", ":2:13:", form);
  lagrangian_refused("x'^2 + rate(u)^2 - 3*rate(u) - x", ":2:32:", form);
  lagrangian_refused("x'^2 + rate(u)^2 - rate(u) - x", ":2:13:", form);
  lagrangian_refused("(x' + 1)^2", ":2:13:", "no velocity stands alone");
  lagrangian_refused("omega(R)[1]*x' + x'^2",
                     ":1:15:", "omega(R) is multiplied by the velocity of x");
  lagrangian_refused("dot(omega(R), omega(B))",
                     ":1:15:", "omega(R) is multiplied by the velocity of B");
  lagrangian_refused("rate(u)*x' + x'^2", ":1:53:", "rate(u) is multiplied by the velocity of x");
}
END_TEST

START_TEST(what_has_no_mass_and_no_body_is_told)
{
  lagrangian_refused(
      "x'^2 + dot(omega(R), omega(R)) + dot(omega(B), omega(B)) + dot(d', d') + rate(u)^2",
      ":1:28:", "the velocity of B.x has no mass");
  lagrangian_refused("x'^2", ":1:15:", "the velocity of R has no mass");
  lagrangian_refused("x'^2 - rate(u)^2",
                     ":1:53:", "the moment of inertia of u is -2, and must be positive");
  refused("coordinates: {x: scalar, R: rotation}\nlagrangian: x'^2 + omega(R)[1]^2 + omega(R)[2]^2 "
          "- omega(R)[3]^2\n"
          "initial: {x: 1, R: \"turn([0, 0, 1], 0)\"}\n" RUN,
          ":1:26:", "the inertia of R is that of no body");
  refused(
      "coordinates: {x: scalar, y: scalar, B: motion}\nlagrangian: x'^2 + y'^2 + dot(B.x', B.x') + "
      "omega(B)[1]^2 + omega(B)[2]^2 + "
      "3*omega(B)[3]^2\ninitial: {x: 1, y: 1, B.x: [0, 0, 0], B.R: \"turn([0, 0, 1], 0)\"}\n" RUN,
      ":1:37:", "the inertia of B is that of no body");
}
END_TEST

START_TEST(velocities_are_asked_of_the_right_kind)
{
  lagrangian_refused("omega(x)^2", ":2:19:", "omega is taken of a rotation, or of a rigid motion");
  lagrangian_refused("omega(3)", ":2:19:", "omega is taken of a rotation");
  lagrangian_refused("omega(R, B)", ":2:13:", "omega takes 1 argument, not 2");
  lagrangian_refused("rate(x)^2", ":2:18:", "of numbers and vectors it is x'");
  lagrangian_refused("omega(R)'", ":2:13:", "there are no accelerations");
  lagrangian_refused("x'^2 - cos(u)", ":2:24:", "the cosine of an angle u is u[1]");
  lagrangian_refused("x'^2 - B", ":2:20:", "take its rotation, B.R, or its place, B.x");
  lagrangian_refused("x'^2 - B.y[1]",
                     ":2:20:", "the parts of B are B.R, its rotation, and B.x, its place");
  lagrangian_refused("x'^2 - R.x[1]", ":2:20:", "only rigid motions have parts");
  lagrangian_refused("x'^2 - R", ":2:13:", "a number minus a 3 x 3 matrix");
  refused(
      "coordinates:\n  R[2]: rotation\nlagrangian: dot(omega(R), omega(R))\ninitial: {R: 1}\n" RUN,
      ":3:23:", "omega is taken of a rotation");
  refused("coordinates: {R: rotation}\nlagrangian: dot(omega(R), omega(R))\ninvariants: {a: "
          "\"omega(R)[1]\"}\n"
          "initial: {R: \"turn([1, 0, 0], 0)\"}\n" RUN,
          ":3:18:", "say it by momenta, p(R)");
}
END_TEST

/* Line 4 of a scene in which all else is given. */
static void start_refused(const char *entry, const char *words)
{
  char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text,
                 KINDS "lagrangian: x'^2 + dot(omega(R), omega(R)) + dot(omega(B), omega(B)) + "
                       "dot(B.x', B.x') + dot(d', d') + rate(u)^2\n"
                       "initial:\n  %s\n  x: 1\n" RUN,
                 entry);
  refused(text, ":", words);
}

START_TEST(starts_are_rotations_directions_and_across_them)
{
  start_refused("R: [[1, 0, 0], [0, 1, 0], [0, 0.001, 1]]",
                "this is no rotation for R: off by 0.0007");
  start_refused("R: [[1, 0, 0], [0, 1, 0], [0, 0, -1]]", "this is no rotation for R: off by 2");
  start_refused("R: turn([0, 0, 0], 1)", "not a finite number");
  start_refused("R: 1", "a number for R, which is a 3 x 3 matrix");
  start_refused("d: [1, 1, 0]", "the direction d is of length 1.414");
  start_refused("d: [1, 0]", "a vector of 2 for d, which is a vector of 3");
  start_refused("u: [1, 0]", "a vector of 2 for u, which is a number");
  start_refused("B: 1", "'B' is a rigid motion: what is given is of B.R or B.x, and omega(B)");
  start_refused("B.z: 1", "'B' has no part z");
  start_refused("R.x: 1", "'R' has no part x");
  start_refused("R': 1", "the velocity of R is omega(R)");
  start_refused("u': 1", "the velocity of u is rate(u)");
  start_refused("omega(x): 1", "the velocity of x is its rate, x'");
  start_refused("rate(R): 1", "the velocity of R is omega(R)");
  start_refused("omega(R): 1", "a number for R, which is a vector of 3");
  start_refused("R: turn([1, 0, 0], 1)\n  B.R: turn([1, 0, 0], 1)",
                "the start of B.x is not given");
  start_refused("R: turn([1, 0, 0], 1)\n  B.R: turn([1, 0, 0], 1)\n  B.x: [0, 0, 0]\n  u: 0\n  d: "
                "[1, 0, 0]\n  d': [0.1, 1, 0]",
                "the velocity or momentum of the direction d is not orthogonal to it");
  start_refused("R: turn([1, 0, 0], 1)\n  B.R: turn([1, 0, 0], 1)\n  B.x: [0, 0, 0]\n  u: 0\n  d: "
                "[1, 0, 0]\n  p(R): [0, 0, 0]",
                "the momentum p(B.R) is not given");
  refused("coordinates:\n  R[2]: rotation\nlagrangian: sum(i, dot(omega(R[i]), "
          "omega(R[i])))\ninitial:\n  R: [1, 2]\n" RUN,
          ":5:3:", "R is more than a matrix: give it by a formula, R[i], or one by one, R[1]");
}
END_TEST

START_TEST(declarations_that_do_not_go_together_are_told)
{
  refused("coordinates: {R: rotatoin}\nlagrangian: 1\ninitial: {x: 1}\n" RUN,
          ":1:18:", "did you mean rotation?");
  refused("coordinates: {R: rotation(3)}\nlagrangian: 1\ninitial: {x: 1}\n" RUN,
          ":1:18:", "a kind is scalar, vector(d), rotation");
  refused(KINDS "one_form: {x: 1}\nhamiltonian: x\ninitial: {x: 1}\n" RUN,
          ":2:11:", "beside one_form there are no rotations");
  refused(KINDS "hamiltonian: x\nconstraints: {a: x, b: p(x)}\ninitial: {x: 1}\n" RUN,
          ":3:14:", "beside constraints there are no rotations");
  refused(KINDS "hamiltonian: x\ninitial: {x: 1}\n" RUN,
          ":2:14:", "beside hamiltonian there are no rotations");
  refused("inertia: {R: 1}\n" KINDS "lagrangian: 1\ninitial: {x: 1}\n" RUN,
          ":1:1:", "a scene has no 'inertia'");
  refused("coordinates: {R: rotation}\nlagrangian: dot(omega(R), omega(R))\nsymmetries: {a: {R: "
          "[1, 0, 0]}}\ninitial: {R: 1}\n" RUN,
          ":3:18:", "a symmetry of a rotation or an angle is given by its velocity, omega(R)");
  refused("coordinates: {d: direction}\nlagrangian: dot(d', d')\nsymmetries: {a: {\"d'\": [1, 0, "
          "0]}}\ninitial: {R: 1}\n" RUN,
          ":3:19:", "a symmetry is given by coordinate");
}
END_TEST

SUITE(scene_manifolds)
{
  tcase_add_checked_fixture(tests, NULL, release_scene);
  tcase_add_test(tests, an_angle_is_the_coordinate_of_the_same_pendulum);
  tcase_add_test(tests, a_point_of_a_body_moves_as_its_velocity_says);
  tcase_add_test(tests, a_dissipation_is_the_force_that_follows_from_it);
  tcase_add_test(tests, events_see_the_velocities_of_the_state);
  tcase_add_test(tests, symmetries_and_invariants_go_by_the_velocities_of_the_state);
  tcase_add_test(tests, all_numbers_have_names);
  tcase_add_test(tests, momenta_give_the_start_as_velocities_do);
  tcase_add_test(tests, lagrangians_without_a_constant_mass_are_refused);
  tcase_add_test(tests, what_has_no_mass_and_no_body_is_told);
  tcase_add_test(tests, velocities_are_asked_of_the_right_kind);
  tcase_add_test(tests, starts_are_rotations_directions_and_across_them);
  tcase_add_test(tests, declarations_that_do_not_go_together_are_told);
}
