/* labels: unit invariant */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <dvi/diagnostics.h>

#include "support/runs.h"
#include "support/suite.h"

static double defect_of(const char *name, const char *method, double step_factor)
{
  problem *p = create_problem(name, NULL);
  dvi_integrator *integrator = create_integrator(p->system, method);
  double defect = -1;
  const dvi_status status = dvi_symplecticity(integrator, 0, p->q, p->p, step_factor * p->h,
                                              &defect);
  ck_assert_msg(status == DVI_OK, "%s %s: %s", name, method, dvi_last_error());
  dvi_integrator_destroy(&integrator);
  problem_destroy(&p);
  return defect;
}

/* outer-solar holds masses of 1 and of 1e-8, pythagorean and figure-eight start with zeros among
 * coordinates and momenta, and the chains have momenta that are nearly all zero. The last two have
 * no constant mass, which verlet needs. */
static const char *const problems[] = {
    "oscillator", "pendulum",     "kepler",      "henon-heiles",   "outer-solar",
    "fpu",        "figure-eight", "pythagorean", "stiff-pendulum", "double-pendulum"};
enum { PROBLEMS = sizeof problems / sizeof *problems, WITH_MASS = PROBLEMS - 2 };

START_TEST(verlet_is_symplectic_to_the_floor_of_the_differences)
{
  const double defect = defect_of(problems[_i], "verlet", 1);
  printf("%-16s verlet   %.1e\n", problems[_i], defect);
  ck_assert_double_ge(defect, 0);
  ck_assert_double_le(defect, 1e-11); /* what is measured, up to 2e-12, and a margin */
}
END_TEST

START_TEST(galerkin_is_symplectic_to_the_floor_of_the_differences)
{
  const double defect = defect_of(problems[_i], "galerkin", 1);
  printf("%-16s galerkin %.1e\n", problems[_i], defect);
  ck_assert_double_ge(defect, 0);
  ck_assert_double_le(defect, 1e-10); /* the solver's roundoff is added */
}
END_TEST

START_TEST(a_step_backward_is_symplectic_too)
{
  ck_assert_double_le(defect_of("pendulum", "verlet", -1), 1e-11);
}
END_TEST

/* Creates an integrator of a system with this Lagrangian of n coordinates alone. released() frees
 * both. */
static dvi_integrator *create_lagrangian_integrator(const dvi_lagrangian *lagrangian, int n,
                                                    const char *method)
{
  dvi_system *system = NULL;
  const dvi_system_terms terms = {.dimension = n, .lagrangian = lagrangian};
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return create_integrator(system, method);
}

static dvi_integrator *create_potential_integrator(const dvi_potential *potential, int n,
                                                   const char *method)
{
  dvi_system *system = NULL;
  const dvi_system_terms terms = {
      .dimension = n, .mass = {.scalar = 1}, .potentials = potential, .potential_count = 1};
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return create_integrator(system, method);
}

static void released(dvi_integrator *integrator)
{
  dvi_system *system = (dvi_system *)(uintptr_t)dvi_integrator_system(integrator);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}

/* L = v^2/2 + v^4/4 + cos q, whose velocity is no analytic function of momenta beyond 0.4 i,
 * however small h is. */
static int quartic(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  *L = v[0] * v[0] / 2 + v[0] * v[0] * v[0] * v[0] / 4 + cos(q[0]);
  return 0;
}

static int quartic_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                            void *user)
{
  (void)t, (void)user;
  *L_q = -sin(q[0]);
  *L_v = v[0] + v[0] * v[0] * v[0];
  return 0;
}

static const double lengths[] = {0.5, 0.05, 0.005, 0.0005};
enum { LENGTHS = sizeof lengths / sizeof *lengths };

START_TEST(a_kinetic_energy_that_is_not_quadratic_shows_no_defect)
{
  static const double momenta[] = {0, 0.1, 1.043, 2};
  static const char *const methods[] = {"midpoint", "galerkin:degree=4"};
  const dvi_lagrangian lagrangian = {.value = quartic, .gradient = quartic_gradient};
  for (int k = 0; k < 8; k++) {
    dvi_integrator *integrator = create_lagrangian_integrator(&lagrangian, 1, methods[k / 4]);
    const double q = 1;
    double defect = -1;
    const dvi_status status = dvi_symplecticity(integrator, 0, &q, &momenta[k % 4], lengths[_i],
                                                &defect);
    ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
    ck_assert_double_ge(defect, 0);
    ck_assert_double_le(defect, 1e-11); /* measured: up to 2e-13 */
    released(integrator);
  }
}
END_TEST

/* L = -sqrt(1 - v.v) - q.q/2 of two coordinates. Beyond |v| = 1 the callbacks return `user`. */
static int relativistic(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t;
  const double rest = 1 - v[0] * v[0] - v[1] * v[1];
  if (rest <= 0) return *(int *)user;
  *L = -sqrt(rest) - (q[0] * q[0] + q[1] * q[1]) / 2;
  return 0;
}

static int relativistic_gradient(double t, const double *q, const double *v, double *L_q,
                                 double *L_v, void *user)
{
  (void)t;
  const double rest = 1 - v[0] * v[0] - v[1] * v[1];
  if (rest <= 0) return *(int *)user;
  for (int i = 0; i < 2; i++) {
    L_q[i] = -q[i];
    L_v[i] = v[i] / sqrt(rest);
  }
  return 0;
}

static dvi_status relativistic_defect(int beyond, const char *method, double speed, double h,
                                      double *defect)
{
  const dvi_lagrangian lagrangian = {
      .value = relativistic, .gradient = relativistic_gradient, .user = &beyond};
  dvi_integrator *integrator = create_lagrangian_integrator(&lagrangian, 2, method);
  const double q[] = {1, 0.3}, v[] = {speed, 0.2};
  double p[2];
  ck_assert_int_eq(dvi_system_momentum(dvi_integrator_system(integrator), 0, q, v, p), DVI_OK);
  const dvi_status status = dvi_symplecticity(integrator, 0, q, p, h, defect);
  released(integrator);
  return status;
}

START_TEST(an_edge_of_the_domain_of_velocities_shows_no_defect)
{
  static const double speeds[] = {0, 0.6, 0.9};
  static const char *const methods[] = {"midpoint", "galerkin:degree=4"};
  for (int k = 0; k < 6; k++) {
    double defect = -1;
    ck_assert_msg(relativistic_defect(1, methods[k / 3], speeds[k % 3], lengths[_i], &defect) ==
                      DVI_OK,
                  "%s", dvi_last_error());
    ck_assert_double_ge(defect, 0);
    ck_assert_double_le(defect, 1e-11); /* measured: up to 2e-13 */
  }
}
END_TEST

/* V = -log(1 - q). Beyond its wall it gives NaN, or returns the failure in `user`. */
static int wall_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -log(1 - q[0]);
  return 0;
}

static int wall_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t;
  *V_q = q[0] < 1 ? 1 / (1 - q[0]) : (double)NAN;
  return user != NULL && q[0] >= 1 ? *(int *)user : 0;
}

static dvi_status defect_at_wall(int *beyond, double *defect)
{
  const dvi_potential potential = {.value = wall_value, .gradient = wall_gradient, .user = beyond};
  dvi_integrator *integrator = create_potential_integrator(&potential, 1, "verlet");
  const double q = 1 - 1e-4, p = 0;
  const dvi_status status = dvi_symplecticity(integrator, 0, &q, &p, 1e-5, defect);
  released(integrator);
  return status;
}

START_TEST(a_wall_much_nearer_than_the_size_of_a_coordinate_shows_no_defect)
{
  int beyond[] = {1};
  for (int k = 0; k < 2; k++) {
    double defect = -1;
    ck_assert_msg(defect_at_wall(k ? beyond : NULL, &defect) == DVI_OK, "%s", dvi_last_error());
    ck_assert_double_ge(defect, 0);
    ck_assert_double_le(defect, 1e-10); /* rounding of q over differences of about 1e-5 */
  }
}
END_TEST

START_TEST(a_callback_that_fails_for_good_ends_the_search)
{
  int beyond = -1;
  double defect = 7;
  ck_assert_int_eq(defect_at_wall(&beyond, &defect), DVI_CALLBACK_FAILED);
  ck_assert_int_eq(relativistic_defect(beyond, "midpoint", 0.6, 0.05, &defect),
                   DVI_CALLBACK_FAILED);
  ck_assert(defect == 7);
}
END_TEST

/* After many turns of an angle the periods of a force are much shorter than the coordinate. In an
 * eighth of 1600 pi there are 100 periods, in 59 hundredths of it 59, so differences over these two
 * lengths agree that there is no force. */
static int cosine(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -cos(q[0]);
  return 0;
}

static int sine(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  *V_q = sin(q[0]);
  return 0;
}

START_TEST(an_angle_of_many_turns_shows_no_defect)
{
  static const double angles[] = {100, 5026.548245743669, 1000, 1e4};
  const dvi_potential potential = {.value = cosine, .gradient = sine};
  static const char *const methods[] = {"verlet", "galerkin:degree=4"};
  for (int k = 0; k < 2; k++) {
    dvi_integrator *integrator = create_potential_integrator(&potential, 1, methods[k]);
    const double p = 0.5;
    double defect = -1;
    ck_assert_msg(dvi_symplecticity(integrator, 0, &angles[_i], &p, 0.1, &defect) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_double_ge(defect, 0);
    /* 1e4 is rounded to 1e-12, and differences go over lengths of about 1 */
    ck_assert_double_le(defect, 1e-10);
    released(integrator);
  }
}
END_TEST

/* At t = 0 the force exists in a single point. The step there succeeds, and none beside it does. */
static int one_point(double t, const double *q, double *V_q, void *user)
{
  (void)user;
  *V_q = q[0];
  return t == 0 && q[0] != 1;
}

START_TEST(if_no_length_works_the_last_status_is_returned_and_nothing_is_written)
{
  const dvi_potential potential = {.value = cosine, .gradient = one_point};
  dvi_integrator *integrator = create_potential_integrator(&potential, 1, "verlet");
  const double q = 1, p = 0.3;
  double defect = 7;
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, &q, &p, 0.1, &defect), DVI_CALLBACK_RETRY);
  ck_assert(defect == 7);
  released(integrator);
}
END_TEST

/* No force, which exists everywhere but in the point 5/4. */
static int hole(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  *V_q = 0;
  return q[0] == 1.25;
}

START_TEST(a_step_that_fails_has_no_defect_even_if_all_around_it_succeed)
{
  const dvi_potential potential = {.value = cosine, .gradient = hole};
  dvi_integrator *integrator = create_potential_integrator(&potential, 1, "verlet");
  const double q = 1, p = 0.5;
  double defect = 7;
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, &q, &p, 0.5, &defect), DVI_CALLBACK_RETRY);
  ck_assert(defect == 7);
  released(integrator);
}
END_TEST

/* A force c (y, -x) with curl, declared as a gradient. It has no potential, and verlet with it is
 * not symplectic. */
static int no_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)q, (void)user;
  *V = 0;
  return 0;
}

static int turning_force(double t, const double *q, double *V_q, void *user)
{
  (void)t;
  const double curl = *(const double *)user;
  V_q[0] = -curl * q[1];
  V_q[1] = curl * q[0];
  return 0;
}

START_TEST(a_force_with_curl_is_found_in_its_size)
{
  /* The kicks add h c dq1^dq2 at both ends; at h = 1 the end is q1 = q + p - F q / 2 with the
   * turning F = c ((0,-1),(1,0)), so that dq1^dq2 there = (1 + c^2/4) dq1^dq2 + dp1^dp2 + the mixed
   * terms dq1^dp2 - dq2^dp1 + c/2 (dq1^dp1 + dq2^dp2). Their largest factor is that of dq1^dq2 at
   * both ends. With h = m = 1 and |q1| = |q2| the scaled coordinates are the given ones. */
  static const double curls[] = {0.1, 1e-4, 1e-8, 1e-10};
  double curl = curls[_i], defect = 0;
  const dvi_potential potential = {.value = no_value, .gradient = turning_force, .user = &curl};
  dvi_integrator *integrator = create_potential_integrator(&potential, 2, "verlet");
  const double q[] = {1, -1}, p[] = {0.3, 0.2};
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, q, p, 1, &defect), DVI_OK);
  /* roundoff of a linear map's differences */
  ck_assert_double_eq_tol(defect, curl * (2 + curl * curl / 4), 1e-12);
  released(integrator);
}
END_TEST

/* A kinetic energy that is not quadratic in both velocities, and the same force. */
static int turning_quartic(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)q, (void)user;
  *L = 0;
  for (int i = 0; i < 2; i++) *L += v[i] * v[i] / 2 + v[i] * v[i] * v[i] * v[i] / 4;
  return 0;
}

static int turning_quartic_gradient(double t, const double *q, const double *v, double *L_q,
                                    double *L_v, void *user)
{
  (void)t;
  const double curl = *(const double *)user;
  L_q[0] = curl * q[1];
  L_q[1] = -curl * q[0];
  for (int i = 0; i < 2; i++) L_v[i] = v[i] + v[i] * v[i] * v[i];
  return 0;
}

START_TEST(a_curl_is_found_under_a_kinetic_energy_that_is_not_quadratic)
{
  double curl = 1e-3;
  const dvi_lagrangian lagrangian = {
      .value = turning_quartic, .gradient = turning_quartic_gradient, .user = &curl};
  dvi_integrator *integrator = create_lagrangian_integrator(&lagrangian, 2, "midpoint");
  const double q[] = {1, -1}, p[] = {0.3, 0.2}, h = 0.05;
  double defect = 0;
  ck_assert_msg(dvi_symplecticity(integrator, 0, q, p, h, &defect) == DVI_OK, "%s",
                dvi_last_error());
  /* the curl adds 2 h c dq1^dq2, in scaled units times a/b with a = 1 and b = m w; the quartic term
   * allows w of 1/8 to 1/2 here */
  ck_assert_double_ge(defect, 2 * h * curl);
  ck_assert_double_le(defect, 16 * h * curl);
  released(integrator);
}
END_TEST

START_TEST(the_integrator_goes_on_as_if_nothing_had_happened)
{
  problem *p = create_problem("kepler", NULL);
  dvi_integrator *probed = create_integrator(p->system, "galerkin:degree=3"),
                 *alone = create_integrator(p->system, "galerkin:degree=3");
  dvi_counters before, after;
  double defect;
  ck_assert_int_eq(dvi_integrator_start(probed, 0, p->q, p->p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(alone, 0, p->q, p->p), DVI_OK);
  for (int i = 0; i < 20; i++) {
    dvi_integrator_counters(probed, &before);
    if (i % 5 == 3) /* from its own state */
      ck_assert_int_eq(dvi_symplecticity(probed, dvi_integrator_time(probed),
                                         dvi_integrator_q(probed), dvi_integrator_p(probed), p->h,
                                         &defect),
                       DVI_OK);
    dvi_integrator_counters(probed, &after);
    ck_assert_mem_eq(&before, &after, sizeof before);
    ck_assert_int_eq(dvi_integrator_step(probed, p->h), DVI_OK);
    ck_assert_int_eq(dvi_integrator_step(alone, p->h), DVI_OK);
    ck_assert(dvi_integrator_time(probed) == dvi_integrator_time(alone));
    ck_assert_mem_eq(dvi_integrator_q(probed), dvi_integrator_q(alone),
                     (size_t)p->nq * sizeof(double));
    ck_assert_mem_eq(dvi_integrator_p(probed), dvi_integrator_p(alone),
                     (size_t)p->nq * sizeof(double));
  }
  dvi_integrator_destroy(&probed);
  dvi_integrator_destroy(&alone);
  problem_destroy(&p);
}
END_TEST

SUITE(symplecticity)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, verlet_is_symplectic_to_the_floor_of_the_differences, 0, WITH_MASS);
  tcase_add_loop_test(tests, galerkin_is_symplectic_to_the_floor_of_the_differences, 0, PROBLEMS);
  tcase_add_test(tests, a_step_backward_is_symplectic_too);
  tcase_add_loop_test(tests, a_kinetic_energy_that_is_not_quadratic_shows_no_defect, 0, LENGTHS);
  tcase_add_loop_test(tests, an_edge_of_the_domain_of_velocities_shows_no_defect, 0, LENGTHS);
  tcase_add_test(tests, a_wall_much_nearer_than_the_size_of_a_coordinate_shows_no_defect);
  tcase_add_test(tests, a_callback_that_fails_for_good_ends_the_search);
  tcase_add_loop_test(tests, an_angle_of_many_turns_shows_no_defect, 0, 4);
  tcase_add_test(tests, if_no_length_works_the_last_status_is_returned_and_nothing_is_written);
  tcase_add_test(tests, a_step_that_fails_has_no_defect_even_if_all_around_it_succeed);
  tcase_add_loop_test(tests, a_force_with_curl_is_found_in_its_size, 0, 4);
  tcase_add_test(tests, a_curl_is_found_under_a_kinetic_energy_that_is_not_quadratic);
  tcase_add_test(tests, the_integrator_goes_on_as_if_nothing_had_happened);
}
