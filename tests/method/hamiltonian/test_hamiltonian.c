/* labels: order invariant */
/* Discrete Hamiltonians: the steps of their types, cases where the types coincide, conserved
 * quantities, refusals. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/systems/degenerate.h"
#include "support/systems/hamiltonians.h"
#include "support/suite.h"

enum { STEPS = 20, COORDINATES = 8, DEGREES = 4 };

/* ---- what they coincide with ---- */

/* Steps of both from the same state end at the same state, to some roundings a step. */
static void check_same(const problem *model, const dvi_system *H, const char *type_2,
                       const char *galerkin)
{
  dvi_integrator *a = create_integrator(H, type_2), *b = start_integrator(model, galerkin);
  ck_assert_int_eq(dvi_integrator_order(a), dvi_integrator_order(b));
  for (int k = 0; k < STEPS; k++) {
    ck_assert_int_eq(
        dvi_integrator_start(a, dvi_integrator_time(b), dvi_integrator_q(b), dvi_integrator_p(b)),
        DVI_OK);
    advance(a, model->order_h / 4, 1);
    advance(b, model->order_h / 4, 1);
    const double q = distance(model->nq, dvi_integrator_q(a), dvi_integrator_q(b)),
                 p = distance(model->nq, dvi_integrator_p(a), dvi_integrator_p(b));
    ck_assert_msg(q <= 1e-12 * fmax(1, magnitude(model->nq, model->q)) &&
                      p <= 1e-12 * fmax(1, magnitude(model->nq, model->p)),
                  "%s, %s: q off by %g, p by %g", model->name, type_2, q, p);
  }
  dvi_integrator_destroy(&a);
  dvi_integrator_destroy(&b);
}

static const char *const quadratures[] = {"gauss,nodes=%d",      "lobatto,nodes=%d",
                                          "radau-left,nodes=%d", "radau-right,nodes=%d",
                                          "gauss,nodes=%d",      "clenshaw-curtis,nodes=%d"};
static const int more_nodes[] = {0, 1, 0, 0, 1, 2};
enum { QUADRATURES = sizeof quadratures / sizeof *quadratures };

START_TEST(type_2_of_a_hyperregular_hamiltonian_is_type_1_that_is_galerkin)
{
  static const char *const names[] = {"pendulum", "henon-heiles", "kepler", "double-pendulum",
                                      "driven-pendulum"};
  problem *model = create_problem(names[_i], NULL);
  dvi_system *H = create_legendre_transform(model);
  for (int degree = 1; degree <= DEGREES; degree++)
    for (int k = 0; k < QUADRATURES; k++) {
      char points[64];
      (void)snprintf(points, sizeof points, quadratures[k], degree + more_nodes[k]);
      check_same(model, H, method_spec("hamiltonian:degree=%d,quadrature=%s", degree, points),
                 method_spec("galerkin:degree=%d,quadrature=%s", degree, points));
    }
  dvi_system_destroy(&H);
  problem_destroy(&model);
}
END_TEST

static void check_equal(const dvi_integrator *a, const dvi_integrator *b, int n)
{
  ck_assert_mem_eq(dvi_integrator_q(a), dvi_integrator_q(b), (size_t)n * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(a), dvi_integrator_p(b), (size_t)n * sizeof(double));
}

START_TEST(all_types_are_the_same_steps_and_on_a_lagrangian_those_of_galerkin)
{
  problem *model = create_problem(_i % 2 ? "double-pendulum" : "kepler", NULL);
  dvi_system *H = create_legendre_transform(model);
  dvi_integrator *galerkin = start_integrator(model, method_spec("galerkin:degree=%d", _i)),
                 *second = create_integrator(H, method_spec("hamiltonian:degree=%d", _i));
  ck_assert_int_eq(dvi_integrator_start(second, 0, model->q, model->p), DVI_OK);
  advance(galerkin, model->order_h, STEPS);
  advance(second, model->order_h, STEPS);
  for (int type = 1; type <= 3; type++) {
    const char *method = method_spec("hamiltonian:type=%d,degree=%d", type, _i);
    dvi_integrator *on_L = start_integrator(model, method), *on_H = create_integrator(H, method);
    ck_assert_int_eq(dvi_integrator_start(on_H, 0, model->q, model->p), DVI_OK);
    advance(on_L, model->order_h, STEPS);
    advance(on_H, model->order_h, STEPS);
    check_equal(on_L, galerkin, model->nq);
    check_equal(on_H, second, model->nq);
    dvi_integrator_destroy(&on_L);
    dvi_integrator_destroy(&on_H);
  }
  dvi_integrator_destroy(&galerkin);
  dvi_integrator_destroy(&second);
  dvi_system_destroy(&H);
  problem_destroy(&model);
}
END_TEST

/* H+ = p1.q0 + h H(q0,p1) and H- = -p0.q1 + h H(q1,p0) are the symplectic Euler methods. The
 * tolerance allows some roundings. */
START_TEST(lowest_degrees_are_the_symplectic_euler_methods)
{
  problem *model = create_problem("elastica", "kappa=1.5");
  dvi_integrator *step = start_integrator(
      model, _i == 2 ? "hamiltonian:type=2,degree=1,quadrature=radau-left"
                     : "hamiltonian:type=3,degree=1,quadrature=radau-right");
  const dvi_hamiltonian *H = model->terms->hamiltonian;
  double q0[3], p0[3], H_q[3], H_p[3];
  for (int k = 0; k < STEPS; k++) {
    memcpy(q0, dvi_integrator_q(step), sizeof q0);
    memcpy(p0, dvi_integrator_p(step), sizeof p0);
    advance(step, 0.1, 1);
    const double *q1 = dvi_integrator_q(step), *p1 = dvi_integrator_p(step);
    ck_assert_int_eq(H->gradient(0, _i == 2 ? q0 : q1, _i == 2 ? p1 : p0, H_q, H_p, H->user), 0);
    for (int i = 0; i < 3; i++) {
      ck_assert_double_eq_tol(q1[i], q0[i] + 0.1 * H_p[i], 1e-15);
      ck_assert_double_eq_tol(p1[i], p0[i] - 0.1 * H_q[i], 1e-15);
    }
  }
  dvi_integrator_destroy(&step);
  problem_destroy(&model);
}
END_TEST

/* ---- structure ---- */

static const char *const kept[] = {"hamiltonian:type=%d,degree=%d",
                                   "hamiltonian:type=%d,degree=%d,quadrature=radau-left",
                                   "hamiltonian:type=%d,degree=%d,quadrature=radau-right"};

START_TEST(steps_on_a_degenerate_hamiltonian_are_symplectic_maps)
{
  static const double q[3] = {0.2, -0.4, 0.7}, p[3] = {-0.8, 0.3, 1.1};
  problem *model = create_problem("elastica", NULL);
  for (int type = 2; type <= 3; type++)
    for (int k = 0; k < 3; k++) {
      dvi_integrator *step = start_integrator(model, method_spec(kept[k], type, _i));
      double defect;
      ck_assert_msg(dvi_symplecticity(step, 0, q, p, 0.3, &defect) == DVI_OK, "%s",
                    dvi_last_error());
      ck_assert_double_le(defect, 1e-10);
      dvi_integrator_destroy(&step);
    }
  problem_destroy(&model);
}
END_TEST

START_TEST(symmetric_quadratures_go_back_the_way_they_came)
{
  problem *model = create_problem("elastica", "kappa=1.9");
  dvi_integrator *symmetric = start_integrator(model,
                                               method_spec("hamiltonian:type=3,degree=%d", _i)),
                 *other = start_integrator(
                     model, method_spec("hamiltonian:degree=%d,quadrature=radau-left", _i));
  double defect, of_radau;
  ck_assert_int_eq(dvi_reversibility(symmetric, 0, model->q, model->p, 0.2, 50, &defect), DVI_OK);
  ck_assert_int_eq(dvi_reversibility(other, 0, model->q, model->p, 0.2, 50, &of_radau), DVI_OK);
  ck_assert_double_le(defect, 1e-12);
  ck_assert_double_ge(of_radau, 1e-11);
  dvi_integrator_destroy(&symmetric);
  dvi_integrator_destroy(&other);
  problem_destroy(&model);
}
END_TEST

/* The forces are momenta of translations, the moment is that of the rotations. They are affine in
 * q, so paths of any degree keep them. */
START_TEST(energy_stays_and_momenta_are_kept_over_long_runs)
{
  check_long_run("elastica", "kappa=1.5", method_spec("hamiltonian:degree=%d", _i), 0.2,
                 repeats(20000), 0.2 * pow(0.1, _i), 1e-11);
  check_long_run("elastica", "kappa=0.7",
                 method_spec("hamiltonian:type=3,degree=%d,quadrature=radau-right", _i), 0.2,
                 repeats(5000), 0.2, 1e-11);
}
END_TEST

/* ---- units ---- */

/* H'(q,p) = S H(q, p/S) has momenta in other units. S is a power of 2, which rounds nothing. */
static const double unit = 0x1p30;

static int scaled_value(double t, const double *q, const double *p, double *H, void *user)
{
  const double scaled[3] = {p[0] / unit, p[1] / unit, p[2] / unit};
  const dvi_hamiltonian *inner = user;
  const int returned = inner->value(t, q, scaled, H, inner->user);
  *H *= unit;
  return returned;
}

static int scaled_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                           void *user)
{
  const double scaled[3] = {p[0] / unit, p[1] / unit, p[2] / unit};
  const dvi_hamiltonian *inner = user;
  const int returned = inner->gradient(t, q, scaled, H_q, H_p, inner->user);
  for (int i = 0; i < 3; i++) H_q[i] *= unit;
  return returned;
}

static int scaled_hessian(double t, const double *q, const double *p, double *H_qq, double *H_qp,
                          double *H_pp, void *user)
{
  const double scaled[3] = {p[0] / unit, p[1] / unit, p[2] / unit};
  const dvi_hamiltonian *inner = user;
  const int returned = inner->hessian(t, q, scaled, H_qq, H_qp, H_pp, inner->user);
  H_qq[0] *= unit;
  H_pp[0] /= unit;
  return returned;
}

START_TEST(units_of_momenta_change_no_bit)
{
  problem *model = create_problem("elastica", NULL);
  dvi_hamiltonian given = *model->terms->hamiltonian, H = given;
  H.value = scaled_value;
  H.gradient = scaled_gradient;
  H.hessian = scaled_hessian;
  H.user = &given;
  const dvi_system_terms terms = {.dimension = 3, .hamiltonian = &H, .autonomous = 1};
  const double p[3] = {unit * model->p[0], unit * model->p[1], unit * model->p[2]};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *plain = start_integrator(model, "hamiltonian"),
                 *scaled = create_integrator(system, "hamiltonian");
  ck_assert_int_eq(dvi_integrator_start(scaled, 0, model->q, p), DVI_OK);
  advance(plain, 0.2, STEPS);
  advance(scaled, 0.2, STEPS);
  ck_assert_mem_eq(dvi_integrator_q(plain), dvi_integrator_q(scaled), 3 * sizeof(double));
  for (int i = 0; i < 3; i++)
    ck_assert_double_eq(unit * dvi_integrator_p(plain)[i], dvi_integrator_p(scaled)[i]);
  dvi_integrator_destroy(&plain);
  dvi_integrator_destroy(&scaled);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

/* A momentum that is almost 0 at the start is no scale of the motion, nor is a momentum that is
 * only the rounding of another one. */
START_TEST(a_start_that_is_almost_zero_is_a_start)
{
  problem *model = create_problem("elastica", NULL);
  const double q[3] = {1e-16, 0, 0}, p[3] = {-1, 1e-17, 1};
  dvi_integrator *zero = start_integrator(model, method_spec("hamiltonian:degree=%d", _i)),
                 *almost = create_integrator(model->system,
                                             method_spec("hamiltonian:degree=%d", _i));
  ck_assert_int_eq(dvi_integrator_start(almost, 0, q, p), DVI_OK);
  advance(zero, 0.5, STEPS);
  advance(almost, 0.5, STEPS);
  ck_assert_double_le(distance(3, dvi_integrator_q(zero), dvi_integrator_q(almost)), 1e-12);
  dvi_integrator_destroy(&zero);
  dvi_integrator_destroy(&almost);
  problem_destroy(&model);
}
END_TEST

/* ---- dense output ---- */

/* The path of degree s errs by h^(s+1) between the ends, and h is halved. */
START_TEST(dense_output_is_the_path)
{
  problem *model = create_problem("elastica", NULL);
  double last = 0;
  for (int k = 0; k < 4; k++) {
    const double h = 0.4 * pow(0.5, k);
    dvi_integrator *step = start_integrator(model, method_spec("hamiltonian:degree=%d", _i));
    double q[3], v[3], exact_q[3], exact_p[3];
    advance(step, h, 1);
    ck_assert_int_eq(dvi_integrator_interpolate(step, 0.4 * h, q, v), DVI_OK);
    ck_assert_int_eq(model->exact(model, 0.4 * h, exact_q, exact_p), 0);
    const double error = distance(3, q, exact_q);
    if (k > 1) ck_assert_double_ge(log2(last / error), _i + 0.8);
    last = error;
    dvi_integrator_destroy(&step);
  }
  problem_destroy(&model);
}
END_TEST

/* ---- refusals ---- */

static void check_refused(const dvi_system *system, const char *method, dvi_status status,
                          const char *words)
{
  dvi_integrator *none = NULL;
  ck_assert_int_eq(dvi_integrator_create(system, method, &none), status);
  ck_assert_ptr_null(none);
  check_words(words);
}

START_TEST(type_1_refuses_a_degenerate_hamiltonian_by_name)
{
  problem *model = create_problem("elastica", NULL);
  check_refused(model->system, "hamiltonian:type=1", DVI_UNSUPPORTED,
                "hamiltonian: the Hamiltonian is degenerate");
  check_refused(model->system, "hamiltonian:type=1", DVI_UNSUPPORTED, "type=2 and 3 can");
  check_refused(model->system, "hamiltonian:quadrature=lobatto", DVI_UNSUPPORTED, "take nodes=2");
  problem_destroy(&model);
}
END_TEST

/* Missing patterns give no information, and the first step looks at the numbers. */
START_TEST(a_degenerate_hamiltonian_with_full_patterns_is_refused_by_the_first_step)
{
  problem *model = create_problem("elastica", NULL);
  dvi_hamiltonian H = *model->terms->hamiltonian;
  H.hessian = NULL;
  H.qq = H.qp = H.pp = (dvi_pattern){0};
  const dvi_system_terms terms = {.dimension = 3, .hamiltonian = &H, .autonomous = 1};
  static const char *const methods[] = {"hamiltonian:type=1",
                                        "hamiltonian:type=3,degree=2,nodes=3"};
  static const char *const words[] = {"no discrete Lagrangian Ld(q0,q1)", "take nodes=2"};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *first = create_integrator(system, methods[_i]),
                 *second = create_integrator(system, "hamiltonian");
  ck_assert_int_eq(dvi_integrator_start(first, 0, model->q, model->p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_step(first, 0.1), DVI_SINGULAR);
  check_words("the state is unchanged");
  check_words(words[_i]);
  ck_assert_mem_eq(dvi_integrator_q(first), model->q, 3 * sizeof(double));
  ck_assert_int_eq(dvi_integrator_start(second, 0, model->q, model->p), DVI_OK);
  advance(second, 0.1, STEPS);
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&second);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

START_TEST(other_methods_refuse_a_hamiltonian_and_name_this_one)
{
  problem *model = create_problem("elastica", NULL);
  for (int i = 0; i < dvi_method_count(); i++) {
    const char *name = dvi_method_name(i);
    if (strcmp(name, "hamiltonian") == 0 || strcmp(name, "shooting") == 0) continue;
    check_refused(model->system, name, DVI_UNSUPPORTED,
                  "declares a Hamiltonian without constraints, and this method needs ");
    check_words("methods for this system: hamiltonian, shooting");
  }
  check_refused(model->system, "verlet", DVI_UNSUPPORTED, "needs a constant mass; methods");
  problem_destroy(&model);
}
END_TEST

START_TEST(bad_options_are_refused)
{
  problem *model = create_problem("elastica", NULL),
          *constrained = create_problem("circle-dirac", NULL),
          *form = create_problem("vortices", NULL);
  check_refused(model->system, "hamiltonian:type=4", DVI_BAD_OPTION, "type");
  check_refused(model->system, "hamiltonian:degree=9", DVI_BAD_OPTION, "degree");
  check_refused(model->system, "hamiltonian:degree=3,nodes=2", DVI_BAD_OPTION,
                "nodes must be at least degree");
  check_refused(model->system, "hamiltonian:degree=8,quadrature=clenshaw-curtis", DVI_BAD_OPTION,
                "at most 9");
  check_refused(model->system, "hamiltonian:degree=2,quadrature=midpoint", DVI_BAD_OPTION,
                "nodes must be at least degree");
  check_refused(constrained->system, "hamiltonian", DVI_UNSUPPORTED,
                "a Hamiltonian with constraints, which this method cannot use");
  check_refused(form->system, "hamiltonian", DVI_UNSUPPORTED,
                "a one-form, which this method cannot use");
  problem_destroy(&model);
  problem_destroy(&constrained);
  problem_destroy(&form);
}
END_TEST

/* ---- failures ---- */

static int stops(double t, const double *q, const double *p, double *H_q, double *H_p, void *user)
{
  const problem *model = user;
  if (q[2] > 0.5) return 1;
  return model->terms->hamiltonian->gradient(t, q, p, H_q, H_p, NULL);
}

START_TEST(a_step_that_fails_leaves_the_state)
{
  problem *model = create_problem("elastica", NULL);
  dvi_hamiltonian H = *model->terms->hamiltonian;
  H.gradient = stops;
  H.user = model;
  const dvi_system_terms terms = {.dimension = 3, .hamiltonian = &H, .autonomous = 1};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *step = create_integrator(system, "hamiltonian:degree=3");
  ck_assert_int_eq(dvi_integrator_start(step, 0, model->q, model->p), DVI_OK);
  advance(step, 0.2, 2);
  const double before[2] = {dvi_integrator_q(step)[2], dvi_integrator_p(step)[2]};
  ck_assert_int_eq(dvi_integrator_step(step, 0.4), DVI_CALLBACK_RETRY);
  check_words("the state is unchanged, try a smaller step");
  ck_assert_double_eq(dvi_integrator_q(step)[2], before[0]);
  ck_assert_double_eq(dvi_integrator_p(step)[2], before[1]);
  advance(step, 0.05, 1);
  dvi_integrator_destroy(&step);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

SUITE(hamiltonian)
{
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, type_2_of_a_hyperregular_hamiltonian_is_type_1_that_is_galerkin, 0, 5);
  tcase_add_loop_test(tests, all_types_are_the_same_steps_and_on_a_lagrangian_those_of_galerkin, 1,
                      1 + DEGREES);
  tcase_add_loop_test(tests, lowest_degrees_are_the_symplectic_euler_methods, 2, 4);
  tcase_add_loop_test(tests, steps_on_a_degenerate_hamiltonian_are_symplectic_maps, 1, 1 + DEGREES);
  tcase_add_loop_test(tests, symmetric_quadratures_go_back_the_way_they_came, 1, 1 + DEGREES);
  tcase_add_loop_test(tests, energy_stays_and_momenta_are_kept_over_long_runs, 1, 1 + DEGREES);
  tcase_add_test(tests, units_of_momenta_change_no_bit);
  tcase_add_loop_test(tests, a_start_that_is_almost_zero_is_a_start, 1, 1 + DEGREES);
  tcase_add_loop_test(tests, dense_output_is_the_path, 1, 1 + DEGREES);
  tcase_add_test(tests, type_1_refuses_a_degenerate_hamiltonian_by_name);
  tcase_add_loop_test(
      tests, a_degenerate_hamiltonian_with_full_patterns_is_refused_by_the_first_step, 0, 2);
  tcase_add_test(tests, other_methods_refuse_a_hamiltonian_and_name_this_one);
  tcase_add_test(tests, bad_options_are_refused);
  tcase_add_test(tests, a_step_that_fails_leaves_the_state);
}
