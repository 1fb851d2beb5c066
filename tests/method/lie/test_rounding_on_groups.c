/* labels: invariant */
#include <check.h>
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"

/* The state and its momentum keep twice the digits, so that only the last rounding of both
 * shows. One rounding a step to the same side would give STEPS times as much, and a random walk
 * 300 times. */
enum { STEPS = 100000 };

static const double rounding = 1.1e-16;

static const double inertia[][9] = {{1.1, 0, 0, 0, .8, 0, 0, 0, .9}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};

/* One factor turns by the same angle in all steps, about one axis of a body, or about any axis of a
 * spherical one. */
static const struct {
  dvi_factor factor;
  double q[9], v[3];
} motions[] = {
    {{.kind = DVI_U1, .mass = .7}, {.6, .8}, {1}},
    {{.kind = DVI_S2, .mass = .7}, {.6, 0, -.8}, {.64, .6, .48}},
    {{.kind = DVI_SO3, .inertia = inertia[0]}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 1}},
    {{.kind = DVI_SO3, .inertia = inertia[1]}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {.36, .48, .8}},
};
enum { ANGLE, DIRECTION, ABOUT_AXIS, SPHERICAL };

static const struct {
  int motion;
  double rate;
  const char *method;
} cases[] = {
    {ANGLE, 3, "lie-verlet"},
    {ANGLE, 1.1, "lie-rk"},
    {ANGLE, 11.3, "lie-galerkin:degree=1"},
    {ANGLE, 20, "euler-poincare:degree=2"},
    {DIRECTION, 3, "lie-verlet"},
    {DIRECTION, 1.1, "lie-rk"},
    {DIRECTION, 1.1, "lie-rk:scheme=crouch-grossman"},
    {DIRECTION, 3, "lie-galerkin:degree=1"},
    {DIRECTION, 20, "sphere-galerkin:degree=2"},
    {ABOUT_AXIS, .5, "lie-verlet"}, /* tan(a/2) = .025, a simple fraction to the last digit */
    {ABOUT_AXIS, 1.1, "lie-rk"},
    {ABOUT_AXIS, 3, "lie-galerkin:degree=2"},
    {SPHERICAL, 5, "lie-verlet"},
    {SPHERICAL, 5, "lie-verlet:solve=exp"},
    {SPHERICAL, 3, "lie-galerkin:degree=1"},
    {SPHERICAL, 3, "euler-poincare:degree=1"},
};
enum { CASES = sizeof cases / sizeof *cases };

static void momentum_in_space(dvi_factor_kind kind, const dvi_integrator *integrator,
                              double momentum[3])
{
  const double *y = dvi_integrator_q(integrator), *p = dvi_integrator_p(integrator);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    if (kind == DVI_U1) momentum[i] = p[0];
    if (kind == DVI_S2) momentum[i] = y[j] * p[k] - y[k] * p[j];
    if (kind == DVI_SO3) momentum[i] = y[3 * i] * p[0] + y[3 * i + 1] * p[1] + y[3 * i + 2] * p[2];
  }
}

START_TEST(steady_turns_keep_to_the_group_and_keep_their_momentum)
{
  const dvi_factor *factor = &motions[cases[_i].motion].factor;
  double v[3], space[2][3];
  dvi_system *system = NULL;
  ck_assert_int_eq(
      dvi_system_create(&(dvi_system_terms){.factors = factor, .factor_count = 1, .autonomous = 1},
                        &system),
      DVI_OK);
  dvi_integrator *integrator = create_integrator(system, cases[_i].method);
  for (int i = 0; i < 3; i++) v[i] = cases[_i].rate * motions[cases[_i].motion].v[i];
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, motions[cases[_i].motion].q, v),
                   DVI_OK);
  momentum_in_space(factor->kind, integrator, space[0]);
  advance(integrator, .1, STEPS);
  momentum_in_space(factor->kind, integrator, space[1]);
  ck_assert_double_le(dvi_system_distance(system, dvi_integrator_q(integrator)), 4 * rounding);
  /* An angle's momentum is the sum of the residuals of its rows, a random walk. */
  ck_assert_double_le(distance(3, space[0], space[1]),
                      (factor->kind == DVI_U1 ? 300 : 8) * rounding * magnitude(3, space[0]));
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

static int weight(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 1.3 * q[2];
  return 0;
}

static int weigh(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  V_q[0] = V_q[1] = 0;
  V_q[2] = 1.3;
  return 0;
}

/* Those with the theorem of Noether, and lie-rk where its own error is below a rounding. */
static const struct {
  const char *method;
  double h;
} pendulums[] = {
    {"lie-verlet", 1e-8},
    {"lie-verlet", .02},
    {"lie-rk", 1e-8},
    {"lie-galerkin:degree=2", 1e-8},
    {"lie-galerkin:degree=2", .02},
    {"sphere-galerkin:degree=2", .02},
};
enum { PENDULUMS = sizeof pendulums / sizeof *pendulums };

/* With steps so short that hundreds of them change q by one rounding, and with usual ones. */
START_TEST(a_pendulum_keeps_its_vertical_momentum)
{
  static const double q[] = {.6, 0, -.8}, v[] = {.8, 1.5, .6};
  const dvi_factor factor = {.kind = DVI_S2, .mass = 1.4};
  const dvi_potential gravity = {.value = weight, .gradient = weigh};
  double space[2][3];
  dvi_system *system = NULL;
  const dvi_system_terms terms = {.factors = &factor,
                                  .factor_count = 1,
                                  .potentials = &gravity,
                                  .potential_count = 1,
                                  .autonomous = 1};
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, pendulums[_i].method);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  momentum_in_space(DVI_S2, integrator, space[0]);
  advance(integrator, pendulums[_i].h, STEPS);
  momentum_in_space(DVI_S2, integrator, space[1]);
  ck_assert_double_le(fabs(space[1][2] - space[0][2]), 8 * rounding * magnitude(3, space[0]));
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(rounding_on_groups)
{
  tcase_add_loop_test(tests, steady_turns_keep_to_the_group_and_keep_their_momentum, 0, CASES);
  tcase_add_loop_test(tests, a_pendulum_keeps_its_vertical_momentum, 0, PENDULUMS);
}
