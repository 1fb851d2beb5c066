/* Joints: their rows at the assembly, their derivatives, and what is refused. */
#include <dvi/joint.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/machines.h"

static const double inertia[] = {1.3, .1, 0, .1, 1.1, .05, 0, .05, .9};

/* A body, a rotation, and a point, in that order. */
static const dvi_factor factors[] = {{.kind = DVI_SE3, .mass = 2, .inertia = inertia},
                                     {.kind = DVI_SO3, .inertia = inertia},
                                     {.kind = DVI_RN, .size = 3, .mass = 1}};
enum { FACTORS = 3, NQ = 24, ROWS_MOST = 6 };

static const double assembled[NQ] = {.8, -.6, 0, .6, .8, 0,   0, 0,  1,  .3, -.2, .5,
                                     1,  0,   0, 0,  .6, -.8, 0, .8, .6, .1, .2,  .3};

static dvi_joint example(dvi_joint_kind kind)
{
  return (dvi_joint){.name = "it",
                     .kind = kind,
                     .body = {0, 1},
                     .at = {.3, .7, -.2},
                     .to = {.1, .1, .5},
                     .axis = {.4, .2, -.9},
                     .second_axis = {.9, 0, .4}};
}

static dvi_status create(const dvi_joint *joint, dvi_joints **made)
{
  return dvi_joints_create(factors, FACTORS, joint, 1, assembled, made);
}

/* ---- rows ---- */

static const int rows_of[] = {
    [DVI_BALL] = 3,   [DVI_HINGE] = 5, [DVI_UNIVERSAL] = 4, [DVI_SLIDER] = 5,
    [DVI_PLANAR] = 3, [DVI_WELD] = 6,  [DVI_DISTANCE] = 1,
};

START_TEST(assembled_machines_fulfil_their_joints)
{
  const dvi_joint joint = example((dvi_joint_kind)_i);
  double phi[ROWS_MOST];
  dvi_joints *made;
  ck_assert_msg(create(&joint, &made) == DVI_OK, "%s", dvi_last_error());
  const dvi_holonomic *rows = dvi_joints_constraints(made);
  ck_assert_int_eq(rows->count, rows_of[_i]);
  ck_assert_int_eq(rows->value(0, assembled, phi, rows->user), 0);
  ck_assert_double_le(magnitude(rows->count, phi), 4e-16);
  dvi_joints_destroy(&made);
  ck_assert_ptr_null(made);
}
END_TEST

/* Joints of a point have balls and distances, and either body may be first. */
START_TEST(derivatives_agree_with_differences)
{
  static const int pairs[][2] = {{0, 1},          {1, 0}, {DVI_GROUND, 0}, {0, DVI_GROUND},
                                 {1, DVI_GROUND}, {2, 0}, {0, 2},          {1, 2}};
  double q[NQ], v[NQ];
  for (int i = 0; i < NQ; i++) q[i] = assembled[i] + 0.1 * sin(i + 1.0), v[i] = cos(2.0 * i);
  for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
    dvi_joint joint = example((dvi_joint_kind)_i);
    dvi_joints *made;
    dvi_system *system;
    memcpy(joint.body, pairs[k], sizeof joint.body);
    if ((pairs[k][0] == 2 || pairs[k][1] == 2) && _i != DVI_BALL && _i != DVI_DISTANCE) continue;
    ck_assert_msg(create(&joint, &made) == DVI_OK, "%s", dvi_last_error());
    /* as constraints of R^n, where every point may be checked */
    const dvi_system_terms terms = {.dimension = NQ,
                                    .mass = {.scalar = 1},
                                    .holonomics = dvi_joints_constraints(made),
                                    .holonomic_count = 1,
                                    .autonomous = 1};
    ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
    ck_assert_msg(dvi_system_check(system, 0, q, v, 1e-9, NULL) == DVI_OK, "kind %d, pair %zu: %s",
                  _i, k, dvi_last_error());
    dvi_system_destroy(&system);
    dvi_joints_destroy(&made);
  }
}
END_TEST

/* ---- refusals ---- */

static void check_refused(const dvi_joint *joint, dvi_status expected, const char *words)
{
  dvi_joints *made;
  ck_assert_int_eq(create(joint, &made), expected);
  ck_assert_ptr_null(made);
  check_words(words);
}

START_TEST(bodies_that_are_none_are_refused)
{
  dvi_joint joint = example(DVI_BALL);
  joint.body[1] = FACTORS;
  check_refused(&joint, DVI_BAD_ARGUMENT, "there is no body 3");
  joint.body[1] = -2;
  check_refused(&joint, DVI_BAD_ARGUMENT, "there is no body -2");
  joint.body[1] = 0;
  check_refused(&joint, DVI_BAD_ARGUMENT, "joins body 0 to itself");
  joint.body[0] = joint.body[1] = DVI_GROUND;
  check_refused(&joint, DVI_BAD_ARGUMENT, "joins the ground to itself");
  joint = example(DVI_HINGE);
  joint.body[1] = 2;
  check_refused(&joint, DVI_BAD_ARGUMENT, "a point, which has no axes");
  const dvi_factor direction = {.kind = DVI_S2, .mass = 1};
  const double q[] = {0, 0, 1};
  dvi_joints *made;
  joint = example(DVI_BALL);
  joint.body[0] = DVI_GROUND, joint.body[1] = 0;
  ck_assert_int_eq(dvi_joints_create(&direction, 1, &joint, 1, q, &made), DVI_BAD_ARGUMENT);
  check_words("neither a rigid motion");
}
END_TEST

START_TEST(axes_and_points_that_are_none_are_refused)
{
  dvi_joint joint = example(DVI_HINGE);
  memset(joint.axis, 0, sizeof joint.axis);
  check_refused(&joint, DVI_BAD_ARGUMENT, "an axis of length 0");
  joint = example(DVI_UNIVERSAL);
  joint.second_axis[1] = 1;
  check_refused(&joint, DVI_BAD_ARGUMENT, "not orthogonal");
  joint = example(DVI_DISTANCE);
  memcpy(joint.to, joint.at, sizeof joint.to);
  check_refused(&joint, DVI_BAD_ARGUMENT, "a distance of 0");
  joint = example(DVI_BALL);
  joint.at[1] = NAN;
  check_refused(&joint, DVI_NOT_FINITE, "not finite");
  joint = example((dvi_joint_kind)7);
  check_refused(&joint, DVI_BAD_ARGUMENT, "of no known kind");
}
END_TEST

START_TEST(missing_arguments_are_refused)
{
  const dvi_joint joint = example(DVI_BALL);
  double q[NQ];
  dvi_joints *made;
  memcpy(q, assembled, sizeof q);
  ck_assert_int_eq(dvi_joints_create(NULL, FACTORS, &joint, 1, q, &made), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_joints_create(factors, FACTORS, NULL, 1, q, &made), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_joints_create(factors, FACTORS, &joint, 0, q, &made), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_joints_create(factors, FACTORS, &joint, 1, NULL, &made), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_joints_create(factors, FACTORS, &joint, 1, q, NULL), DVI_BAD_ARGUMENT);
  q[3] = INFINITY;
  ck_assert_int_eq(dvi_joints_create(factors, FACTORS, &joint, 1, q, &made), DVI_NOT_FINITE);
  ck_assert_ptr_null(dvi_joints_constraints(NULL));
  dvi_joints_destroy(NULL);
}
END_TEST

SUITE(joints)
{
  tcase_add_loop_test(tests, assembled_machines_fulfil_their_joints, DVI_BALL, DVI_DISTANCE + 1);
  tcase_add_loop_test(tests, derivatives_agree_with_differences, DVI_BALL, DVI_DISTANCE + 1);
  tcase_add_test(tests, bodies_that_are_none_are_refused);
  tcase_add_test(tests, axes_and_points_that_are_none_are_refused);
  tcase_add_test(tests, missing_arguments_are_refused);
}
