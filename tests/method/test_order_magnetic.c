/* labels: order */
/* Methods with a vector potential beside a constant mass: orders, gauges, what is conserved. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/magnetic.h"

static dvi_integrator *started(const magnetic *m, const char *method)
{
  double p[MAGNETIC_N];
  dvi_integrator *integrator = create_integrator(m->system, method);
  ck_assert_int_eq(dvi_system_momentum(m->system, 0, m->q, m->v, p), DVI_OK);
  ck_assert_msg(dvi_integrator_start(integrator, 0, m->q, p) == DVI_OK, "%s", dvi_last_error());
  return integrator;
}

/* Gives the largest distance of q and v of a state from these. */
static double distance_from(const magnetic *m, double t, const double *q, const double *p,
                            const double *q_end, const double *v_end)
{
  double v[MAGNETIC_N] = {0}, error = 0;
  ck_assert_int_eq(dvi_system_velocity(m->system, t, q, p, v), DVI_OK);
  for (int i = 0; i < m->n; i++)
    error = fmax(error, fmax(fabs(q[i] - q_end[i]), fabs(v[i] - v_end[i])));
  return error;
}

/* ---- orders ---- */

static const struct {
  const char *method;
  int order, steps; /* of the longest step */
} claims[] = {
    {"boris", 2, 80},
    {"composition:order=4", 4, 40},
    {"composition:order=6,base=boris", 6, 20},
    {"midpoint", 2, 80},
    {"trapezoidal", 2, 80},
    {"galerkin:degree=1", 2, 80},
    {"galerkin:degree=2", 4, 30},
    {"galerkin:degree=3", 6, 16},
    {"galerkin:degree=4", 8, 6},
    {"galerkin:degree=3,quadrature=lobatto", 6, 16},
    {"galerkin:degree=3,quadrature=lobatto,nodes=3", 4, 30},
    {"galerkin:degree=2,solver=newton", 4, 30},
    {"galerkin:degree=2,solver=simplified", 4, 30},
    {"hp:type=2,degree=2", 3, 40},
    {"hamiltonian:degree=2,type=2", 4, 30},
    {"composition:order=4,base=midpoint", 4, 40},
};
enum { CLAIMS = sizeof claims / sizeof *claims, LEVELS = 4 };

START_TEST(methods_keep_their_order_in_a_magnetic_field)
{
  for (int kind = 0; kind < MAGNETIC_KINDS; kind++) {
    magnetic m;
    double q[MAGNETIC_N], v[MAGNETIC_N], error[LEVELS], slope = 0;
    int fitted = 0;
    make_magnetic((magnetic_kind)kind, &m);
    magnetic_judge((magnetic_kind)kind, q, v);
    for (int level = 0; level < LEVELS; level++) {
      const int steps = claims[_i].steps << level;
      dvi_integrator *integrator = started(&m, claims[_i].method);
      advance(integrator, m.span / steps, steps);
      error[level] = distance_from(&m, m.span, dvi_integrator_q(integrator),
                                   dvi_integrator_p(integrator), q, v);
      dvi_integrator_destroy(&integrator);
      /* the floor is that of roundings over some hundred steps */
      if (level == 0 || error[level] < 5e-14) continue;
      slope = log2(error[level - 1] / error[level]);
      fitted++;
    }
    ck_assert_msg(fitted > 0 && fabs(slope - claims[_i].order) < 0.3,
                  "%s in %s: order %.2f, errors %.2e, %.2e, %.2e, %.2e", claims[_i].method, m.name,
                  slope, error[0], error[1], error[2], error[3]);
    destroy_magnetic(&m);
  }
}
END_TEST

START_TEST(judges_integrate_vector_potentials)
{
  static const dvi_reference_code codes[] = {DVI_IDA, DVI_CVODE_ADAMS, DVI_CVODE_BDF, DVI_ARKODE};
  for (int kind = 0; kind < MAGNETIC_KINDS; kind++)
    for (size_t c = 0; c < sizeof codes / sizeof *codes; c++) {
      magnetic m;
      double q[MAGNETIC_N], p[MAGNETIC_N], q_end[MAGNETIC_N], v_end[MAGNETIC_N];
      make_magnetic((magnetic_kind)kind, &m);
      magnetic_judge((magnetic_kind)kind, q_end, v_end);
      memcpy(q, m.q, sizeof q);
      ck_assert_int_eq(dvi_system_momentum(m.system, 0, q, m.v, p), DVI_OK);
      ck_assert_msg(dvi_reference_solve(
                        m.system, 0, m.span, q, p,
                        &(dvi_reference_options){.code = codes[c], .relative_tolerance = 1e-11},
                        NULL) == DVI_OK,
                    "%s", dvi_last_error());
      ck_assert_double_lt(distance_from(&m, m.span, q, p, q_end, v_end), 1e-8);
      destroy_magnetic(&m);
    }
}
END_TEST

/* ---- the same steps as by a general Lagrangian ---- */

START_TEST(the_term_has_the_steps_of_the_whole_lagrangian)
{
  static const char *const methods[] = {"galerkin:degree=1", "galerkin:degree=3",
                                        "galerkin:degree=5,quadrature=lobatto", "sem:degree=2",
                                        "shooting:onestep=rk4,quadrature=simpson"};
  /* sem finds the lengths of its steps to a few digits less, and without rates not at all. The
   * differenced Hessians end the iterations of shooting earlier. */
  const int is_sem = _i == 3, is_shooting = _i == 4;
  const double tolerance = is_sem ? 1e-9 : is_shooting ? 1e-9 : 1e-13;
  for (int kind = 0; kind < MAGNETIC_KINDS; kind++) {
    magnetic m, whole;
    if (is_sem && kind == WAVE) continue;
    make_magnetic((magnetic_kind)kind, &m);
    make_as_lagrangian((magnetic_kind)kind, &whole);
    dvi_integrator *here = started(&m, methods[_i]), *there = started(&whole, methods[_i]);
    advance(here, 0.1, 20);
    advance(there, 0.1, 20);
    for (int i = 0; i < m.n; i++) {
      ck_assert_double_eq_tol(dvi_integrator_q(here)[i], dvi_integrator_q(there)[i], tolerance);
      ck_assert_double_eq_tol(dvi_integrator_p(here)[i], dvi_integrator_p(there)[i], tolerance);
    }
    double energy, other;
    ck_assert_int_eq(dvi_integrator_invariant(here, 0, &energy), DVI_OK);
    ck_assert_int_eq(dvi_integrator_invariant(there, 0, &other), DVI_OK);
    ck_assert_double_eq_tol(energy, other, tolerance);
    dvi_integrator_destroy(&here);
    dvi_integrator_destroy(&there);
    destroy_magnetic(&m);
    destroy_magnetic(&whole);
  }
}
END_TEST

/* Iterations need no Jacobian, and about as many of them as h B/m asks for. */
START_TEST(steps_that_resolve_the_turns_need_no_jacobian)
{
  static const struct {
    const char *method;
    double h;
    int most; /* iterations a step */
  } runs[] = {{"galerkin:degree=1", 0.02, 12},
              {"galerkin:degree=2", 0.05, 12},
              {"galerkin:degree=4", 0.2, 14},
              {"galerkin:degree=6,quadrature=lobatto", 0.3, 14}};
  for (size_t k = 0; k < sizeof runs / sizeof *runs; k++) {
    magnetic m;
    dvi_counters counters;
    make_magnetic(BOTTLE, &m);
    dvi_integrator *integrator = started(&m, runs[k].method);
    advance(integrator, runs[k].h, 100);
    dvi_integrator_counters(integrator, &counters);
    ck_assert_int_eq(counters.jacobians, 0);
    ck_assert_int_eq(counters.hessians, 0);
    ck_assert_int_eq(counters.fixed_points, 100);
    ck_assert_msg(counters.residuals <= 100L * runs[k].most, "%s: %ld iterations", runs[k].method,
                  counters.residuals);
    dvi_integrator_destroy(&integrator);
    destroy_magnetic(&m);
  }
}
END_TEST

/* ---- gauges ---- */

/* f = c q0^2 q1 + q0 q1: the bottle's A + grad f. A cubic f changes galerkin's steps. */
static double cubic;

static int gauged_A(double t, const double *q, double *A, void *user)
{
  const magnetic *m = user;
  (void)m->A.value(t, q, A, NULL);
  A[0] += 2 * cubic * q[0] * q[1] + q[1];
  A[1] += cubic * q[0] * q[0] + q[0];
  return 0;
}

static int gauged_A_q(double t, const double *q, double *A_q, void *user)
{
  const magnetic *m = user;
  double own[4];
  (void)m->A.gradient(t, q, own, NULL);
  memset(A_q, 0, 9 * sizeof *A_q);
  A_q[0] = 2 * cubic * q[1];
  A_q[1] = own[0] + 2 * cubic * q[0] + 1;
  A_q[2] = own[1];
  A_q[3] = own[2] + 2 * cubic * q[0] + 1;
  A_q[5] = own[3];
  return 0;
}

static double distance_of_gauges(const char *method, double c, double h)
{
  magnetic m, gauged;
  make_magnetic(BOTTLE, &m);
  cubic = c;
  gauged = m;
  gauged.A = (dvi_vector_potential){.value = gauged_A, .gradient = gauged_A_q, .user = &m};
  gauged.terms.vector_potential = &gauged.A;
  gauged.terms.potentials = &gauged.V;
  ck_assert_int_eq(dvi_system_create(&gauged.terms, &gauged.system), DVI_OK);
  dvi_integrator *here = started(&m, method), *there = started(&gauged, method);
  advance(here, h, 20);
  advance(there, h, 20);
  double distance = 0;
  for (int i = 0; i < m.n; i++)
    distance = fmax(distance, fabs(dvi_integrator_q(here)[i] - dvi_integrator_q(there)[i]));
  dvi_integrator_destroy(&here);
  dvi_integrator_destroy(&there);
  destroy_magnetic(&m);
  destroy_magnetic(&gauged);
  return distance;
}

START_TEST(steps_depend_on_the_gauge_only_by_the_quadrature)
{
  ck_assert_double_lt(distance_of_gauges("boris", 0.3, 0.1), 1e-14);
  /* A step of degree s sees d f/dt of degree 2s-1 exactly if f is quadratic, ... */
  ck_assert_double_lt(distance_of_gauges("galerkin:degree=1", 0, 0.1), 1e-13);
  ck_assert_double_lt(distance_of_gauges("galerkin:degree=3", 0, 0.1), 1e-13);
  /* ... and else up to its order. */
  const double at_1 = distance_of_gauges("galerkin:degree=1", 0.3, 0.1),
               at_2 = distance_of_gauges("galerkin:degree=2", 0.3, 0.1);
  ck_assert_double_gt(at_1, 1e-5);
  ck_assert_double_gt(at_2, 1e-9);
  ck_assert_double_lt(at_2, 1e-5);
}
END_TEST

/* ---- structure ---- */

START_TEST(galerkin_is_symplectic_and_keeps_the_angular_momentum)
{
  magnetic m;
  double J0, J, p[MAGNETIC_N], defect;
  make_magnetic(BOTTLE, &m);
  dvi_integrator *integrator = started(&m, "galerkin:degree=2");
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 1, &J0), DVI_OK);
  advance(integrator, 0.2, repeats(2000));
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 1, &J), DVI_OK);
  ck_assert_double_eq_tol(J, J0, 1e-13);
  ck_assert_int_eq(dvi_system_momentum(m.system, 0, m.q, m.v, p), DVI_OK);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, m.q, p, 0.2, &defect), DVI_OK);
  ck_assert_double_lt(defect, 1e-8);
  dvi_integrator_destroy(&integrator);
  destroy_magnetic(&m);
}
END_TEST

SUITE(order_magnetic)
{
  tcase_add_loop_test(tests, methods_keep_their_order_in_a_magnetic_field, 0, CLAIMS);
  tcase_add_test(tests, judges_integrate_vector_potentials);
  tcase_add_loop_test(tests, the_term_has_the_steps_of_the_whole_lagrangian, 0, 5);
  tcase_add_test(tests, steps_that_resolve_the_turns_need_no_jacobian);
  tcase_add_test(tests, steps_depend_on_the_gauge_only_by_the_quadrature);
  tcase_add_test(tests, galerkin_is_symplectic_and_keeps_the_angular_momentum);
}
