/* Scenes with joints and with constraints on rigid motions: they are those of dvi/joint.h, and what
 * makes no sense is told with its place. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/runs.h"
#include "support/scene/parsed.h"
#include "support/suite.h"

enum { TEXT_SIZE = 2048 };

#define BODIES                                                                         \
  "parameters: {g: 9.81, one: 1}\n"                                                    \
  "coordinates: {point: vector(3), B: motion, 'C[2]': motion, n: direction}\n"         \
  "kinetic: \"dot(point', point')/2 + dot(B.x', B.x')/2 + 0.1*dot(omega(B), omega(B))" \
  " + dot(C[1].x', C[1].x')/2 + 0.1*dot(omega(C[1]), omega(C[1]))"                     \
  " + dot(C[2].x', C[2].x')/2 + 0.1*dot(omega(C[2]), omega(C[2]))"                     \
  " + dot(n', n')/2\"\n"                                                               \
  "potentials: {weight: 'g*(point[3] + B.x[3] + C[1].x[3] + C[2].x[3] + n[3])'}\n"
#define START                                                                               \
  "initial: {point: [1, 0, 0], B.R: 'turn([0, 0, 1], 0.3)', B.x: [0, 0, 0], 'C[1].R': "     \
  "'turn([1, 0, 0], 0.5)', 'C[1].x': [0, 1, 0], 'C[2].R': 'turn([0, 1, 0], 0)', 'C[2].x': " \
  "[0, 2, 0], n: [0, 0, -1], omega(B): [0.1, 0.2, 0.3]}\n"                                  \
  "method: lie-galerkin:degree=2\nstep: 0.01\nuntil: 1\n"

/* All kinds of joints, and a constraint of the section constraints beside them. */
static const char *const all_kinds = BODIES
    "constraints: {tilt: 'n[1] + 0.1*B.x[2]'}\n"
    "joints:\n"
    "  pin: {hinge: [ground, B], at: [0, 0, 0], axis: [0, 0, one]}\n"
    "  rod: {distance: [point, B], at: [1, 0, 0], to: [0.5, 0, 0]}\n"
    "  knee: {ball: '[B, C[1]]', at: [0, 0.5, 0]}\n"
    "  rail: {slider: '[C[1], C[2]]', axis: [0, 1, 0]}\n" START;

/* Steps of the scene are those of the same joints in C, to the last bit. */
START_TEST(joints_are_those_of_programs)
{
  const dvi_system *system = open_scene(all_kinds);
  const double *q, *v, *p;
  dvi_scene_start(scene, &q, &v, &p);
  dvi_system_terms terms = *dvi_scene_terms(scene);
  const dvi_factor bodies[] = {{.kind = DVI_RN, .size = 3},
                               {.kind = DVI_SE3},
                               {.kind = DVI_SE3},
                               {.kind = DVI_SE3},
                               {.kind = DVI_S2}};
  const dvi_joint joints[] = {
      {.name = "pin", .kind = DVI_HINGE, .body = {DVI_GROUND, 1}, .axis = {0, 0, 1}},
      {.name = "rod", .kind = DVI_DISTANCE, .body = {0, 1}, .at = {1, 0, 0}, .to = {.5, 0, 0}},
      {.name = "knee", .kind = DVI_BALL, .body = {1, 2}, .at = {0, .5, 0}},
      {.name = "rail", .kind = DVI_SLIDER, .body = {2, 3}, .axis = {0, 1, 0}}};
  dvi_joints *made;
  dvi_system *other;
  ck_assert_int_eq(dvi_joints_create(bodies, 5, joints, 4, q, &made), DVI_OK);
  ck_assert_int_eq(terms.holonomic_count, 2);
  const dvi_holonomic both[] = {terms.holonomics[0], *dvi_joints_constraints(made)};
  terms.holonomics = both;
  ck_assert_int_eq(dvi_system_create(&terms, &other), DVI_OK);
  const dvi_system *const systems[] = {system, other};
  const dvi_start_options project = {.project = 1};
  dvi_integrator *run[2];
  for (int k = 0; k < 2; k++) {
    run[k] = create_integrator(systems[k], "lie-galerkin:degree=2");
    ck_assert_msg(dvi_integrator_start_with(run[k], 0, q, p, &project) == DVI_OK, "%s",
                  dvi_last_error());
    advance(run[k], 0.01, 20);
  }
  const int nq = dvi_system_nq(system);
  ck_assert_int_eq(
      memcmp(dvi_integrator_q(run[0]), dvi_integrator_q(run[1]), (size_t)nq * sizeof(double)), 0);
  double off;
  ck_assert_int_eq(dvi_integrator_constraint(run[0], &off), DVI_OK);
  ck_assert_double_le(off, 1e-15);
  for (int k = 0; k < 2; k++) dvi_integrator_destroy(&run[k]);
  dvi_system_destroy(&other);
  dvi_joints_destroy(&made);
}
END_TEST

/* The hinge of a pendulum by expressions, and its digits. */
START_TEST(constraints_of_expressions_have_the_digits)
{
  static const char text[] =
      "parameters: {g: 9.81, l: 0.3}\ncoordinates: {B: motion}\n"
      "lagrangian: dot(B.x', B.x')/2 + 0.01*dot(omega(B), omega(B)) - g*B.x[3]\n"
      "definitions: {pivot: 'B.x + B.R*[0, 0, l]'}\n"
      "constraints: {x: 'pivot[1]', y: 'pivot[2]', z: 'pivot[3]', u: 'B.R[1,2]', w: 'B.R[1,3]'}\n"
      "initial: {B.R: 'turn([1, 0, 0], 2)', B.x: '[0, l*sin(2), -l*cos(2)]'}\n"
      "method: lie-galerkin:degree=3\nstep: 0.01\nuntil: 3\n";
  const dvi_system *system = open_scene(text);
  const double *q, *v, *p;
  dvi_scene_start(scene, &q, &v, &p);
  dvi_integrator *run = create_integrator(system, "lie-galerkin:degree=4");
  ck_assert_int_eq(dvi_integrator_start(run, 0, q, p), DVI_OK);
  advance(run, 3.0 / 300, 300);
  q = dvi_integrator_q(run);
  ck_assert_double_eq_tol(atan2(q[7], q[8]), 1.34272056960873, 1e-12);
  dvi_integrator_destroy(&run);
}
END_TEST

/* ---- slips ---- */

/* `by` is DVI_BAD_FILE for slips of the section, and else the status of what it declares. */
static void refuse_joints(const char *section, dvi_status by, const char *words)
{
  char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text, BODIES "joints:\n  it: %s\n" START, section);
  check_refused(text, by, by == DVI_BAD_FILE ? ":6:" : ":6:3:", words);
}

START_TEST(slips_are_told_with_their_places)
{
  refuse_joints("{ball: [ground, D], at: [0,0,0]}", DVI_BAD_FILE, "a joint is between two bodies");
  refuse_joints("{ball: [B], at: [0,0,0]}", DVI_BAD_FILE, "a joint is between two bodies");
  refuse_joints("{ball: '[B, C[3]]', at: [0,0,0]}", DVI_BAD_FILE, "C has 2 members here, and no 3");
  refuse_joints("{ball: [B, B.x], at: [0,0,0]}", DVI_BAD_FILE, "a joint is between two bodies");
  refuse_joints("{ball: [ground, B]}", DVI_BAD_FILE, "a ball needs 'at', a vector in space");
  refuse_joints("{ball: [ground, B], at: [0,0]}", DVI_BAD_FILE,
                "this is a vector of three numbers");
  refuse_joints("{ball: [ground, B], at: [0,0,0], axis: [1,0,0]}", DVI_BAD_FILE,
                "a ball has no 'axis'");
  refuse_joints("{bolt: [ground, B], at: [0,0,0]}", DVI_BAD_FILE, "a joint has no 'bolt'");
  refuse_joints("{at: [0,0,0]}", DVI_BAD_FILE, "a joint is one of ball, hinge");
  refuse_joints("{ball: [ground, B], hinge: [ground, B], at: [0,0,0]}", DVI_BAD_FILE,
                "a joint is one of");
  refuse_joints("{hinge: [ground, B], at: [0,0,0], axis: [0,0,0]}", DVI_BAD_ARGUMENT,
                "an axis of length 0");
  refuse_joints("{hinge: [ground, point], at: [0,0,0], axis: [1,0,0]}", DVI_BAD_ARGUMENT,
                "a point, which has no axes");
  refuse_joints("{ball: [ground, n], at: [0,0,0]}", DVI_BAD_ARGUMENT, "neither a rigid motion");
  refuse_joints("{ball: [B, B], at: [0,0,0]}", DVI_BAD_ARGUMENT, "to itself");
}
END_TEST

START_TEST(joints_are_refused_where_they_have_no_bodies)
{
  static const char with_hamiltonian[] = "coordinates: {x: scalar}\nhamiltonian: p(x)^2/2\n"
                                         "joints: {j: {ball: [ground, x], at: [0,0,0]}}\n"
                                         "initial: {x: 1, p(x): 0}\nstep: 0.1\nuntil: 1\n";
  check_refused(with_hamiltonian, DVI_BAD_FILE, ":3:", "beside a Hamiltonian there are no joints");
}
END_TEST

SUITE(scene_joints)
{
  tcase_add_checked_fixture(tests, NULL, release_scene);
  tcase_add_test(tests, joints_are_those_of_programs);
  tcase_add_test(tests, constraints_of_expressions_have_the_digits);
  tcase_add_test(tests, slips_are_told_with_their_places);
  tcase_add_test(tests, joints_are_refused_where_they_have_no_bodies);
}
