/* labels: invariant */
#include <check.h>
#include <dvi/group.h>
#include <math.h>

#include "support/systems/mixed_factors.h"
#include "support/runs.h"
#include "support/suite.h"

/* Equal errors of all steps add up, so a defect of 1e-18 a step is 1e-12 after these. Roundings
 * that differ from step to step are a random walk of 1000 times one of them. Kick-drift steps,
 * which change the energy, have such roundings, and pure rotations have none. */
enum { STEPS = 1000000 };

static const double rounding = 1.1e-16, walk = 1000;

static void momentum_in_space(const dvi_integrator *integrator, double *momentum)
{
  const double *R = dvi_integrator_q(integrator), *Pi = dvi_integrator_p(integrator);
  for (int i = 0; i < 3; i++)
    momentum[i] = R[3 * i] * Pi[0] + R[3 * i + 1] * Pi[1] + R[3 * i + 2] * Pi[2];
}

/* All steps have the same rotation. */
START_TEST(a_steady_rotation_stays_on_the_group)
{
  static const double J[] = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                      Omega[][3] = {{.5, -.6, .7}, {0, 0, 1}, {0, 7, 0}};
  double space[3];
  body top;
  make_free_body(J, Omega[_i], &top);
  dvi_integrator *integrator = body_integrator(&top, "lie-verlet");
  advance(integrator, .1, STEPS);
  ck_assert_double_le(dvi_system_distance(top.system, dvi_integrator_q(integrator)), 4 * rounding);
  momentum_in_space(integrator, space);
  ck_assert_double_le(distance(3, space, Omega[_i]), 4 * rounding * magnitude(3, Omega[_i]));
  dvi_integrator_destroy(&integrator);
  destroy_body(&top);
}
END_TEST

/* J and Omega, in its frame, of a body with these in its principal axes, the columns of A. */
static void turn_body(const double moment[3], const double Omega[3], const double A[9], double J[9],
                      double v[3])
{
  for (int i = 0; i < 3; i++) {
    v[i] = A[3 * i] * Omega[0] + A[3 * i + 1] * Omega[1] + A[3 * i + 2] * Omega[2];
    for (int j = i; j < 3; j++) {
      double sum = 0;
      for (int k = 0; k < 3; k++) sum += A[3 * i + k] * moment[k] * A[3 * j + k];
      J[3 * i + j] = J[3 * j + i] = sum;
    }
  }
}

START_TEST(tumbling_bodies_keep_energy_and_momentum)
{
  static const struct {
    double moment[3], Omega[3], w[3], h;
    const char *method;
  } cases[] = {
      /* a rod, in which small errors of the rotation are large ones of its spin */
      {{1e-6, 1, 1}, {.3, .2, .5}, {0}, .4, "lie-verlet"},
      {{1e-6, 1, 1}, {.3, .2, .5}, {0}, .4, "lie-verlet:solve=exp"},
      /* its axes are not those of the frame */
      {{3, 2, 1.5}, {.4, .6, -.2}, {.6, -.4, .8}, .2, "lie-verlet"},
  };
  double A[9], J[9], v[3], space[2][3], first, last;
  body top;
  dvi_so3_cayley(cases[_i].w, A);
  turn_body(cases[_i].moment, cases[_i].Omega, A, J, v);
  make_free_body(J, v, &top);
  dvi_integrator *integrator = body_integrator(&top, cases[_i].method);
  momentum_in_space(integrator, space[0]);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &first), DVI_OK);
  advance(integrator, cases[_i].h, STEPS);
  momentum_in_space(integrator, space[1]);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &last), DVI_OK);
  ck_assert_double_le(distance(3, space[0], space[1]), 4 * rounding * magnitude(3, space[0]));
  ck_assert_double_le(fabs(last - first), 4 * walk * rounding * first);
  dvi_integrator_destroy(&integrator);
  destroy_body(&top);
}
END_TEST

START_TEST(directions_and_angles_keep_their_length)
{
  static const dvi_factor factors[] = {{.kind = DVI_S2, .mass = 1}, {.kind = DVI_U1, .mass = 1}};
  static const double q[] = {0, 0, 1, .6, .8}, v[] = {.6, 1, 0, 7};
  dvi_system *system = NULL;
  ck_assert_int_eq(
      dvi_system_create(&(dvi_system_terms){.factors = factors, .factor_count = 2, .autonomous = 1},
                        &system),
      DVI_OK);
  dvi_integrator *integrator = create_integrator(system, "lie-verlet");
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  advance(integrator, .1, STEPS);
  ck_assert_double_le(dvi_system_distance(system, dvi_integrator_q(integrator)), 4 * rounding);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(lie_verlet_rounding)
{
  tcase_add_loop_test(tests, a_steady_rotation_stays_on_the_group, 0, 3);
  tcase_add_loop_test(tests, tumbling_bodies_keep_energy_and_momentum, 0, 3);
  tcase_add_test(tests, directions_and_angles_keep_their_length);
}
