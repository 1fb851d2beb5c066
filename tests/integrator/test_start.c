/* labels: unit */
/* Starting from a momentum or from a velocity, where the Legendre map is not linear. */
#include <float.h>
#include <math.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"

/* Lagrangians of one coordinate, T(v) - q^2/2, by T, T' and T''. */
typedef struct kinetic {
  double (*T)(double v), (*T1)(double v), (*T2)(double v);
  double limit; /* a velocity at or beyond it is refused */
} kinetic;

static int value(double t, const double *q, const double *v, double *L, void *user)
{
  const kinetic *k = user;
  (void)t;
  *L = k->T(v[0]) - q[0] * q[0] / 2;
  return fabs(v[0]) >= k->limit;
}

static int gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                    void *user)
{
  const kinetic *k = user;
  (void)t;
  L_q[0] = -q[0];
  L_v[0] = k->T1(v[0]);
  return fabs(v[0]) >= k->limit;
}

static int hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                   double *L_vv, void *user)
{
  const kinetic *k = user;
  (void)t, (void)q;
  L_qq[0] = -1;
  L_qv[0] = 0;
  L_vv[0] = k->T2(v[0]);
  return fabs(v[0]) >= k->limit;
}

static dvi_system *create_kinetic_system(kinetic *k)
{
  const dvi_lagrangian l = {.value = value, .gradient = gradient, .hessian = hessian, .user = k};
  return make_system(&(dvi_system_terms){.dimension = 1, .lagrangian = &l});
}

static double quartic(double v)
{
  return v * v * v * v / 4;
}

static double quartic1(double v)
{
  return v * v * v;
}

static double quartic2(double v)
{
  return 3 * v * v;
}

/* Three velocities have each momentum between -0.38 and 0.38. */
static double wells_of_v(double v)
{
  return (v * v - 1) * (v * v - 1) / 4;
}

static double wells_of_v1(double v)
{
  return v * v * v - v;
}

static double wells_of_v2(double v)
{
  return 3 * v * v - 1;
}

static double relativistic(double v)
{
  return -sqrt(1 - v * v);
}

static double relativistic1(double v)
{
  return v / sqrt(1 - v * v);
}

static double relativistic2(double v)
{
  return 1 / ((1 - v * v) * sqrt(1 - v * v));
}

static double exponential(double v)
{
  return exp(v);
}

static kinetic quartic_term = {quartic, quartic1, quartic2, HUGE_VAL},
               wells_term = {wells_of_v, wells_of_v1, wells_of_v2, HUGE_VAL};
static kinetic relativistic_term = {relativistic, relativistic1, relativistic2, 1};
static kinetic exponential_term = {exponential, exponential, exponential, HUGE_VAL};

/* The energy p v - T + q^2/2 from the momentum tells the velocity that was found. */
static double energy_after_start(kinetic *term, double p)
{
  double energy;
  dvi_system *system = create_kinetic_system(term);
  dvi_integrator *integrator = create_integrator(system, "galerkin");
  ck_assert_msg(dvi_integrator_start(integrator, 0, &(double){0}, &p) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &energy), DVI_OK);
  advance(integrator, 1e-3, 10);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  return energy;
}

START_TEST(a_velocity_is_found_where_the_hessian_at_rest_is_singular_or_indefinite)
{
  const double root = cbrt(0.5), outer = 1.1914878839531187; /* of v^3 - v = 1/2 */
  ck_assert_double_eq_tol(energy_after_start(&quartic_term, 0.5), 0.5 * root - quartic(root),
                          1e-14);
  ck_assert_double_eq_tol(energy_after_start(&wells_term, 0.5), 0.5 * outer - wells_of_v(outer),
                          1e-14);
}
END_TEST

/* Newton's first step from rest leads far beyond the speed of light. L = sqrt(1 + p^2) there. */
START_TEST(a_velocity_near_the_edge_of_the_domain_is_found)
{
  const double momenta[] = {0.5, 3, -50, 1e4};
  const double p = momenta[_i], energy = sqrt(1 + p * p);
  ck_assert_double_eq_tol(energy_after_start(&relativistic_term, p), energy,
                          4 * DBL_EPSILON * energy * energy);
}
END_TEST

START_TEST(a_momentum_that_none_has_or_that_is_degenerate_is_refused)
{
  dvi_system *falling = create_kinetic_system(&exponential_term),
             *flat = create_kinetic_system(&quartic_term);
  dvi_integrator *one = create_integrator(falling, "midpoint"),
                 *two = create_integrator(flat, "midpoint");
  ck_assert_int_eq(dvi_integrator_start(one, 0, &(double){0}, &(double){-1}), DVI_NOT_CONVERGED);
  check_words("no velocity found for the momentum");
  ck_assert_int_eq(dvi_integrator_start(two, 0, &(double){0}, &(double){0}), DVI_SINGULAR);
  check_words("degenerate");
  ck_assert_int_eq(dvi_integrator_start_velocity(two, 0, &(double){0}, &(double){0}), DVI_SINGULAR);
  check_words("degenerate");
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&two);
  dvi_system_destroy(&falling);
  dvi_system_destroy(&flat);
}
END_TEST

/* q' is the right velocity, up to the error h of a quotient, and stays on its branch. For v near
 * -1, 0 and 1 the motions differ. */
START_TEST(a_start_velocity_chooses_among_those_of_one_momentum)
{
  static const char *const methods[] = {"midpoint", "galerkin:degree=3",
                                        "composition:order=4,base=trapezoidal",
                                        "galerkin:degree=2,solver=kinsol"};
  const double velocities[] = {-0.9, 0.2, 1.1}, v = velocities[_i % 3], h = 1e-3;
  dvi_system *system = create_kinetic_system(&wells_term);
  dvi_integrator *integrator = create_integrator(system, methods[_i / 3]);
  double energy, later;
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, &(double){0.1}, &v), DVI_OK);
  ck_assert_double_eq_tol(dvi_integrator_p(integrator)[0], wells_of_v1(v), 2 * DBL_EPSILON);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &energy), DVI_OK);
  ck_assert_double_eq_tol(energy, wells_of_v1(v) * v - wells_of_v(v) + 0.005, 4 * DBL_EPSILON);
  advance(integrator, h, 1);
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0], 0.1 + h * v, h * h);
  advance(integrator, h, 99);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &later), DVI_OK);
  ck_assert_double_eq_tol(later, energy, 1e-6); /* order 2 at h = 1e-3 */
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(both_starts_are_one_where_the_velocity_is_unique)
{
  static const char *const methods[] = {"verlet", "galerkin:degree=4"};
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *first = start_integrator(model, methods[_i]),
                 *second = create_integrator(model->system, methods[_i]);
  /* the mass is 1 */
  ck_assert_int_eq(dvi_integrator_start_velocity(second, 0, model->q, model->p), DVI_OK);
  advance(first, 0.05, 5);
  advance(second, 0.05, 5);
  ck_assert_mem_eq(dvi_integrator_q(first), dvi_integrator_q(second), 2 * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(first), dvi_integrator_p(second), 2 * sizeof(double));
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&second);
  problem_destroy(&model);
}
END_TEST

START_TEST(bad_velocities_are_refused_and_the_state_stays)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *integrator = start_integrator(model, "midpoint");
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, model->q, &(double){(double)NAN}),
                   DVI_NOT_FINITE);
  check_words("v[0] = nan");
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, (double)NAN, model->q, model->p),
                   DVI_NOT_FINITE);
  ck_assert_int_eq(dvi_integrator_start_velocity(NULL, 0, model->q, model->p), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, NULL, model->p), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, model->q, NULL), DVI_BAD_ARGUMENT);
  ck_assert_double_eq(dvi_integrator_q(integrator)[0], model->q[0]);
  advance(integrator, 0.1, 1);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(queries_of_nothing_give_nothing)
{
  dvi_counters counters = {.steps = 5};
  char text[8] = "before";
  ck_assert(isnan(dvi_integrator_time(NULL)));
  ck_assert_ptr_null(dvi_integrator_q(NULL));
  ck_assert_ptr_null(dvi_integrator_p(NULL));
  ck_assert_ptr_null(dvi_integrator_system(NULL));
  ck_assert_ptr_null(dvi_integrator_method(NULL));
  ck_assert_int_eq(dvi_integrator_order(NULL), 0);
  ck_assert_uint_eq(dvi_integrator_explain(NULL, text, sizeof text), 0);
  ck_assert_str_eq(text, "");
  dvi_integrator_counters(NULL, &counters);
  ck_assert_int_eq(counters.steps, 0);
  dvi_integrator_counters(NULL, NULL);
}
END_TEST

SUITE(start)
{
  tcase_add_test(tests, a_velocity_is_found_where_the_hessian_at_rest_is_singular_or_indefinite);
  tcase_add_loop_test(tests, a_velocity_near_the_edge_of_the_domain_is_found, 0, 4);
  tcase_add_test(tests, a_momentum_that_none_has_or_that_is_degenerate_is_refused);
  tcase_add_loop_test(tests, a_start_velocity_chooses_among_those_of_one_momentum, 0, 12);
  tcase_add_loop_test(tests, both_starts_are_one_where_the_velocity_is_unique, 0, 2);
  tcase_add_test(tests, bad_velocities_are_refused_and_the_state_stays);
  tcase_add_test(tests, queries_of_nothing_give_nothing);
}
