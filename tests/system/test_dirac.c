/* Hamiltonians with constraints of second class: their motion, their bracket matrix, the derivative
 * check, refusals. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

static dvi_system *create_system(const dvi_system_terms *terms)
{
  dvi_system *system = NULL;
  ck_assert_msg(dvi_system_create(terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

START_TEST(the_velocity_is_that_of_the_constrained_motion)
{
  problem *model = create_problem("magnetic-pair", NULL);
  const double S = 1 + model->q[1] * model->q[1] + model->q[2] * model->q[2],
               u = model->p[0] - model->q[1] / 2;
  ck_assert_int_eq(dvi_system_constraint_count(model->system), 2);
  ck_assert_double_eq_tol(model->v[0], u, 1e-15);
  ck_assert_double_eq_tol(model->v[1], -cos(model->q[2]) / S, 1e-15);
  ck_assert_double_eq_tol(model->v[2], (-u / 2 - sin(model->q[1])) / S, 1e-15);
  problem_destroy(&model);
}
END_TEST

START_TEST(the_energy_is_the_hamiltonian)
{
  problem *model = create_problem("circle-dirac", NULL);
  double energy;
  ck_assert_int_eq(dvi_system_invariants(model->system, 0, model->q, model->p, &energy), DVI_OK);
  ck_assert_double_eq_tol(energy, 0.25 / 2 + 0.6, 1e-15);
  problem_destroy(&model);
}
END_TEST

START_TEST(the_bracket_matrix_is_that_of_the_gradients)
{
  problem *model = create_problem("circle-dirac", NULL),
          *vortices = create_problem("vortices", NULL);
  const double nowhere[2] = {0, 0};
  double bracket[4], condition, v[2] = {7, 7};
  ck_assert_int_eq(dvi_system_bracket(model->system, model->q, model->p, bracket, &condition),
                   DVI_OK);
  ck_assert_double_eq(bracket[0], 0);
  ck_assert_double_eq(bracket[3], 0);
  ck_assert_double_eq_tol(bracket[2], 1, 1e-15);
  ck_assert_double_eq_tol(bracket[1], -1, 1e-15);
  ck_assert_double_eq_tol(condition, 1, 1e-14);
  ck_assert_int_eq(dvi_system_bracket(model->system, nowhere, model->p, NULL, &condition), DVI_OK);
  ck_assert(isinf(condition));
  ck_assert_int_eq(dvi_system_velocity(model->system, 0, nowhere, model->p, v), DVI_SINGULAR);
  check_words("bracket matrix {phi_a, phi_b} is singular");
  ck_assert_double_eq(v[0], 7);
  ck_assert_int_eq(dvi_system_bracket(vortices->system, vortices->q, vortices->p, bracket, NULL),
                   DVI_UNSUPPORTED);
  ck_assert_int_eq(dvi_system_constraint_count(vortices->system), 0);
  problem_destroy(&vortices);
  problem_destroy(&model);
}
END_TEST

START_TEST(there_is_no_lagrangian)
{
  problem *model = create_problem("circle-dirac", NULL);
  double L, p[2];
  ck_assert_int_eq(dvi_system_lagrangian(model->system, 0, model->q, model->v, &L),
                   DVI_UNSUPPORTED);
  ck_assert_int_eq(dvi_system_momentum(model->system, 0, model->q, model->v, p), DVI_UNSUPPORTED);
  check_words("a Hamiltonian is declared, no Lagrangian");
  problem_destroy(&model);
}
END_TEST

/* ---- derivatives ---- */

static const double somewhere_q[3] = {0.3, -0.7, 0.4}, somewhere_p[3] = {0.9, 0.2, -0.6};

static const dvi_hamiltonian *wronged;
static const dvi_constraint *wronged_constraint;

static int wrong_H_p(double t, const double *q, const double *p, double *H_q, double *H_p,
                     void *user)
{
  const int returned = wronged->gradient(t, q, p, H_q, H_p, user);
  H_p[0] += 0.1;
  return returned;
}

static int wrong_H_qp(double t, const double *q, const double *p, double *H_qq, double *H_qp,
                      double *H_pp, void *user)
{
  const int returned = wronged->hessian(t, q, p, H_qq, H_qp, H_pp, user);
  H_qp[0] += 0.1;
  return returned;
}

static int wrong_phi_z(const double *q, const double *p, double *phi_z, void *user)
{
  const int returned = wronged_constraint->gradient(q, p, phi_z, user);
  phi_z[3] += 0.1;
  return returned;
}

static int wrong_phi_qq(const double *q, const double *p, const double *w, double *qq, double *qp,
                        double *pp, void *user)
{
  const int returned = wronged_constraint->hessian(q, p, w, qq, qp, pp, user);
  qq[3] += 0.1 * w[0];
  return returned;
}

static void check_offender(const dvi_system_terms *terms, const char *words)
{
  dvi_system *system = create_system(terms);
  dvi_derivative_check found;
  ck_assert_int_eq(dvi_system_check(system, 0, somewhere_q, somewhere_p, 0, &found),
                   DVI_BAD_ARGUMENT);
  check_words(words);
  dvi_system_destroy(&system);
}

START_TEST(the_check_names_the_offender)
{
  problem *model = create_problem("magnetic-pair", NULL);
  dvi_system_terms terms = *model->terms;
  dvi_hamiltonian H = *terms.hamiltonian;
  dvi_constraint phi = *terms.constraint;
  wronged = terms.hamiltonian;
  wronged_constraint = terms.constraint;
  terms.hamiltonian = &H;
  terms.constraint = &phi;
  H.gradient = wrong_H_p;
  check_offender(&terms, "Hamiltonian: dH/dp (0)");
  H.gradient = wronged->gradient;
  H.hessian = wrong_H_qp;
  check_offender(&terms, "Hamiltonian: d2H/dqdp (1,0)");
  H.hessian = wronged->hessian;
  phi.gradient = wrong_phi_z;
  check_offender(&terms, "constraint 1: dphi/dp (2)");
  phi.gradient = wronged_constraint->gradient;
  phi.hessian = wrong_phi_qq;
  check_offender(&terms, "constraint 0: d2phi/dq2 (2,2)");
  phi.hessian = wronged_constraint->hessian;
  phi.qq = phi.qp;
  phi.hessian = NULL;
  check_offender(&terms, "is not in the pattern");
  problem_destroy(&model);
}
END_TEST

/* Newton's method ends at the same floor. */
START_TEST(differenced_hessians_give_the_same_steps)
{
  problem *model = create_problem("magnetic-pair", NULL);
  dvi_system_terms terms = *model->terms;
  dvi_hamiltonian H = *terms.hamiltonian;
  dvi_constraint phi = *terms.constraint;
  H.hessian = NULL;
  phi.hessian = NULL;
  phi.gradients = phi.qq = phi.qp = phi.pp = H.qq = H.qp = H.pp = (dvi_pattern){NULL, NULL};
  phi.gradients = model->terms->constraint->gradients;
  terms.hamiltonian = &H;
  terms.constraint = &phi;
  dvi_system *system = create_system(&terms);
  dvi_integrator *given = start_integrator(model, "dg-phase:degree=3"),
                 *differenced = create_integrator(system, "dg-phase:degree=3");
  ck_assert_int_eq(dvi_integrator_start(differenced, 0, model->q, model->p), DVI_OK);
  advance(given, 0.1, 20);
  advance(differenced, 0.1, 20);
  ck_assert_double_le(distance(3, dvi_integrator_q(given), dvi_integrator_q(differenced)), 1e-13);
  ck_assert_double_le(distance(3, dvi_integrator_p(given), dvi_integrator_p(differenced)), 1e-13);
  dvi_integrator_destroy(&given);
  dvi_integrator_destroy(&differenced);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

/* ---- refusals ---- */

static void check_terms(const dvi_system_terms *terms, dvi_status status, const char *words)
{
  dvi_system *none = NULL;
  ck_assert_int_eq(dvi_system_create(terms, &none), status);
  ck_assert_ptr_null(none);
  check_words(words);
}

START_TEST(terms_that_do_not_go_together_are_refused)
{
  problem *model = create_problem("circle-dirac", NULL),
          *well = create_problem("henon-heiles", NULL);
  const dvi_system_terms declared = *model->terms;
  dvi_constraint phi = *declared.constraint;
  dvi_hamiltonian H = *declared.hamiltonian;
  dvi_system_terms terms = declared;
  terms.hamiltonian = NULL;
  terms.mass.scalar = 1;
  check_terms(&terms, DVI_BAD_ARGUMENT, "constraints without a Hamiltonian");
  terms.hamiltonian = declared.hamiltonian;
  check_terms(&terms, DVI_BAD_ARGUMENT, "both a constant mass and a Hamiltonian");
  terms = declared;
  terms.potentials = well->terms->potentials;
  terms.potential_count = 1;
  check_terms(&terms, DVI_BAD_ARGUMENT, "1 potentials beside a Hamiltonian");
  terms = declared;
  terms.constraint = &phi;
  phi.count = 3;
  check_terms(&terms, DVI_BAD_SIZE, "3 constraints; an even number from 2 to 4");
  phi = *declared.constraint;
  phi.value = NULL;
  check_terms(&terms, DVI_BAD_ARGUMENT, "the constraint has no value callback");
  terms = declared;
  terms.hamiltonian = &H;
  H.gradient = NULL;
  check_terms(&terms, DVI_BAD_ARGUMENT, "the Hamiltonian has no gradient callback");
  problem_destroy(&well);
  problem_destroy(&model);
}
END_TEST

SUITE(dirac)
{
  tcase_add_test(tests, the_velocity_is_that_of_the_constrained_motion);
  tcase_add_test(tests, the_energy_is_the_hamiltonian);
  tcase_add_test(tests, the_bracket_matrix_is_that_of_the_gradients);
  tcase_add_test(tests, there_is_no_lagrangian);
  tcase_add_test(tests, the_check_names_the_offender);
  tcase_add_test(tests, differenced_hessians_give_the_same_steps);
  tcase_add_test(tests, terms_that_do_not_go_together_are_refused);
}
