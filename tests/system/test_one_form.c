/* labels: unit */
/* Degenerate Lagrangians: the callbacks of a one-form, and refusals. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "system/evaluate/evaluator.h"

/* alpha = (-x^2 y, lie + x y^2 + z, w, 0) of n coordinates, or 0 if `flat`. The gradient is wrong
 * if `lie` is not 0. */
typedef struct form {
  double lie;
  int flat;
} form;

static int value(const double *q, double *alpha, void *user)
{
  const form *f = user;
  const double scale = f->flat ? 0 : 1;
  alpha[0] = -scale * q[0] * q[0] * q[1];
  alpha[1] = scale * (q[0] * q[1] * q[1] + q[2]);
  alpha[2] = scale * q[3];
  alpha[3] = 0;
  return 0;
}

static const int start[] = {0, 2, 5, 6, 6}, row[] = {0, 1, 0, 1, 2, 3};

static int gradient(const double *q, double *alpha_q, void *user)
{
  const form *f = user;
  const double x = q[0], y = q[1], scale = f->flat ? 0 : 1;
  const double entries[] = {-2 * x * y, -x * x + f->lie, y * y, 2 * x * y, 1, 1};
  for (int e = 0; e < 6; e++) alpha_q[e] = scale * entries[e];
  return 0;
}

static int H(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return 0;
}

static const dvi_potential hamiltonian = {.name = "H", .value = H};

static dvi_one_form declare_one_form(form *user)
{
  return (dvi_one_form){
      .value = value, .gradient = gradient, .gradients = {start, row}, .user = user};
}

static dvi_system *create_form_system(form *user)
{
  dvi_system *system = NULL;
  const dvi_one_form one_form = declare_one_form(user);
  const dvi_system_terms terms = {.dimension = 4,
                                  .one_form = &one_form,
                                  .potentials = &hamiltonian,
                                  .potential_count = 1,
                                  .autonomous = 1};
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static const double q[] = {0.3, -0.8, 0.5, 1.1}, v[] = {0.7, 0.2, -0.4, 0.9};

START_TEST(values_momenta_and_two_form_are_those_of_the_definition)
{
  form right = {0};
  dvi_system *system = create_form_system(&right);
  double L, p[4], alpha[4], Omega[16], condition;
  (void)value(q, alpha, &right);
  ck_assert_int_eq(dvi_system_lagrangian(system, 0, q, v, &L), DVI_OK);
  ck_assert_double_eq_tol(
      L, alpha[0] * v[0] + alpha[1] * v[1] + alpha[2] * v[2] - 0.5 * (0.09 + 0.64 + 0.25 + 1.21),
      1e-15);
  ck_assert_int_eq(dvi_system_momentum(system, 0, q, v, p), DVI_OK);
  ck_assert_mem_eq(p, alpha, sizeof p);
  ck_assert_msg(dvi_system_two_form(system, q, Omega, &condition) == DVI_OK, "%s",
                dvi_last_error());
  /* d alpha_y/dx - d alpha_x/dy */
  ck_assert_double_eq_tol(Omega[4], q[1] * q[1] + q[0] * q[0], 1e-15);
  ck_assert_double_eq(Omega[4 * 1 + 2], 1); /* d alpha_y/dz */
  ck_assert_double_eq(Omega[4 * 2 + 3], 1); /* d alpha_z/dw */
  for (int j = 0; j < 4; j++)
    for (int i = 0; i < 4; i++) ck_assert_double_eq(Omega[4 * j + i], -Omega[4 * i + j]);
  ck_assert(condition >= 1 && condition < 100);
  dvi_system_destroy(&system);
}
END_TEST

/* Omega v = dH/dq = q. */
START_TEST(the_velocity_solves_the_equations_of_motion)
{
  form right = {0};
  dvi_system *system = create_form_system(&right);
  double Omega[16], found[4], energy;
  ck_assert_int_eq(dvi_system_two_form(system, q, Omega, NULL), DVI_OK);
  ck_assert_msg(dvi_system_velocity(system, 0, q, q, found) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < 4; i++) {
    double sum = -q[i];
    for (int j = 0; j < 4; j++) sum += Omega[4 * j + i] * found[j];
    /* H is differenced to 1e-13 of its values, 1e-11 here */
    ck_assert_double_eq_tol(sum, 0, 1e-10);
  }
  ck_assert_int_eq(dvi_system_invariants(system, 0, q, q, &energy), DVI_OK);
  ck_assert_double_eq_tol(energy, 0.5 * (0.09 + 0.64 + 0.25 + 1.21), 1e-15); /* H, whatever p */
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_wrong_gradient_is_found)
{
  form right = {0}, wrong = {.lie = 1e-3};
  dvi_system *good = create_form_system(&right), *bad = create_form_system(&wrong);
  ck_assert_msg(dvi_system_check(good, 0, q, v, 0, NULL) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_system_check(bad, 0, q, v, 0, NULL), DVI_BAD_ARGUMENT);
  check_words("one-form: d alpha_j/dq_i at (i,j) = (1,0) is");
  dvi_system_destroy(&good);
  dvi_system_destroy(&bad);
}
END_TEST

/* A missing Hessian is differenced, and nothing else, because the gradients are given. */
START_TEST(gradients_are_taken_as_they_are_given_where_the_hessian_is_differenced)
{
  form right = {0};
  dvi_system *system = create_form_system(&right);
  dvi__evaluator *evaluator = NULL;
  double qq[16], qv[6], given[6], all_qq[32], all_qv[12], none[1], twice_q[8], twice_v[8];
  const double t[2] = {0, 0};
  (void)gradient(q, given, &right);
  ck_assert_msg(dvi__evaluator_create(system, 2, DVI__HESSIANS, NULL, &evaluator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi__form_hessian(evaluator, q, v, qq, qv), DVI_OK);
  ck_assert_mem_eq(qv, given, sizeof given);
  for (int i = 0; i < 8; i++) {
    twice_q[i] = q[i / 2];
    twice_v[i] = v[i / 2];
  }
  ck_assert_int_eq(dvi__lagrangian_hessian(evaluator, 2, t, twice_q, twice_v, all_qq, all_qv, none),
                   DVI_OK);
  for (int e = 0; e < 6; e++) ck_assert(all_qv[2 * e] == given[e] && all_qv[2 * e + 1] == given[e]);
  /* d2(alpha.v)/dxdy, where differences err by some 1e-10 */
  ck_assert_double_eq_tol(qq[1], -2 * q[0] * v[0] + 2 * q[1] * v[1], 1e-8);
  dvi__evaluator_destroy(&evaluator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_gradient_outside_of_its_pattern_is_found)
{
  static const int fewer_start[] = {0, 1, 4, 5, 5}, fewer_row[] = {0, 0, 1, 2, 3};
  form right = {0};
  dvi_one_form one_form = declare_one_form(&right);
  dvi_system *system = NULL;
  one_form.gradients = (dvi_pattern){fewer_start, fewer_row};
  const dvi_system_terms terms = {
      .dimension = 4, .one_form = &one_form, .potentials = &hamiltonian, .potential_count = 1};
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_system_check(system, 0, q, v, 0, NULL), DVI_BAD_ARGUMENT);
  check_words("one-form: d alpha_j/dq_i at (i,j) = (");
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_singular_two_form_is_named)
{
  form flat = {.flat = 1};
  dvi_system *system = create_form_system(&flat);
  double found[4] = {1, 2, 3, 4}, condition, Omega[16];
  ck_assert_int_eq(dvi_system_velocity(system, 0, q, q, found), DVI_SINGULAR);
  check_words("two-form");
  ck_assert_double_eq(found[3], 4);
  ck_assert_int_eq(dvi_system_two_form(system, q, Omega, &condition), DVI_OK);
  ck_assert(isinf(condition));
  dvi_system_destroy(&system);
}
END_TEST

static void refused(const dvi_system_terms *terms, dvi_status expected, const char *words)
{
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(terms, &system), expected);
  ck_assert_ptr_null(system);
  check_words(words);
}

START_TEST(bad_declarations_are_refused)
{
  form right = {0};
  const dvi_one_form good = declare_one_form(&right);
  dvi_one_form bad = good;
  refused(&(dvi_system_terms){.dimension = 3, .one_form = &good}, DVI_BAD_SIZE, "even");
  refused(&(dvi_system_terms){.dimension = 4, .one_form = &good, .mass.scalar = 1},
          DVI_BAD_ARGUMENT, "both a constant mass and a one-form");
  bad.value = NULL;
  refused(&(dvi_system_terms){.dimension = 4, .one_form = &bad}, DVI_BAD_ARGUMENT,
          "no value callback");
  bad = good;
  bad.gradient = NULL;
  refused(&(dvi_system_terms){.dimension = 4, .one_form = &bad}, DVI_BAD_ARGUMENT,
          "no gradient callback");
}
END_TEST

START_TEST(methods_for_one_kind_of_system_refuse_the_other)
{
  problem *degenerate = create_problem("lotka-volterra", NULL),
          *regular = create_problem("kepler", NULL);
  dvi_integrator *none = NULL;
  ck_assert_int_eq(dvi_integrator_create(degenerate->system, "galerkin", &none), DVI_UNSUPPORTED);
  check_words("declares a one-form, which this method cannot use; methods for this system: vprk");
  ck_assert_int_eq(dvi_integrator_create(regular->system, "vprk", &none), DVI_UNSUPPORTED);
  check_words("constant mass");
  double Omega[4];
  ck_assert_int_eq(dvi_system_two_form(regular->system, regular->q, Omega, NULL), DVI_UNSUPPORTED);
  problem_destroy(&degenerate);
  problem_destroy(&regular);
}
END_TEST

START_TEST(a_start_off_the_constraint_is_refused)
{
  problem *model = create_problem("massless-particle", NULL);
  dvi_integrator *integrator = create_integrator(model->system, "vprk");
  double p[2] = {model->p[0], model->p[1] + 1e-9}, q_end[2] = {model->q[0], model->q[1]};
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, p), DVI_BAD_ARGUMENT);
  check_words("1e-09 away; start with p = alpha(q)");
  ck_assert_int_eq(dvi_reference_solve(model->system, 0, 1, q_end, p, NULL, NULL),
                   DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, model->q, model->v), DVI_OK);
  ck_assert_mem_eq(dvi_integrator_p(integrator), model->p, sizeof p);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_start_off_the_constraint_is_projected_on_request)
{
  problem *model = create_problem("massless-particle", NULL);
  dvi_integrator *integrator = create_integrator(model->system, "vprk");
  const double p[2] = {model->p[0] + 3, model->p[1] - 2}, not_finite[2] = {(double)NAN, 0};
  const dvi_start_options refused = {0}, projected = {.project = 1};
  ck_assert_int_eq(dvi_integrator_start_with(integrator, 0, model->q, p, &refused),
                   DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_start_with(integrator, 0, model->q, p, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_integrator_start_with(integrator, 0, model->q, not_finite, &projected),
                   DVI_NOT_FINITE);
  ck_assert_int_eq(dvi_integrator_start_with(integrator, 0, model->q, p, &projected), DVI_OK);
  ck_assert_mem_eq(dvi_integrator_q(integrator), model->q, sizeof p);
  ck_assert_mem_eq(dvi_integrator_p(integrator), model->p, sizeof p);
  ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_OK);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(without_a_one_form_a_projection_changes_nothing)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = create_integrator(model->system, "verlet");
  const double p[2] = {0.25, -1};
  ck_assert_int_eq(
      dvi_integrator_start_with(integrator, 0, model->q, p, &(dvi_start_options){.project = 1}),
      DVI_OK);
  ck_assert_mem_eq(dvi_integrator_p(integrator), p, sizeof p);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* alpha = (ln y/x, 0) vanishes at (1,1), where a rounding of q moves it by more than its size. */
START_TEST(a_start_that_is_rounded_where_the_one_form_vanishes_is_not_off_the_constraint)
{
  problem *model = create_problem("lotka-volterra", "gauge=singular");
  dvi_integrator *integrator = create_integrator(model->system, "vprk");
  const double beside[] = {1, 1 - 0x1p-53}, far[] = {1, 1 - 0x1p-33}, none[] = {0, 0};
  ck_assert_msg(dvi_integrator_start(integrator, 0, beside, none) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, far, none), DVI_BAD_ARGUMENT);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(one_form)
{
  tcase_add_test(tests, values_momenta_and_two_form_are_those_of_the_definition);
  tcase_add_test(tests, the_velocity_solves_the_equations_of_motion);
  tcase_add_test(tests, a_wrong_gradient_is_found);
  tcase_add_test(tests, gradients_are_taken_as_they_are_given_where_the_hessian_is_differenced);
  tcase_add_test(tests, a_gradient_outside_of_its_pattern_is_found);
  tcase_add_test(tests, a_singular_two_form_is_named);
  tcase_add_test(tests, bad_declarations_are_refused);
  tcase_add_test(tests, methods_for_one_kind_of_system_refuse_the_other);
  tcase_add_test(tests, a_start_off_the_constraint_is_refused);
  tcase_add_test(tests, a_start_off_the_constraint_is_projected_on_request);
  tcase_add_test(tests, without_a_one_form_a_projection_changes_nothing);
  tcase_add_test(tests,
                 a_start_that_is_rounded_where_the_one_form_vanishes_is_not_off_the_constraint);
}
