/* labels: unit */
/* What holonomic constraints may be declared, where they are refused, how the check compares them,
 * and what happens where they fail. */
#include <math.h>
#include <string.h>

#include "support/paced.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/constrained.h"

static int line_value(double t, const double *q, double *phi, void *user)
{
  const double *c = user;
  phi[0] = q[0] - q[1] + c[0] * t;
  phi[1] = c[1] * q[0] * q[0] + q[1] * q[2];
  return 0;
}

static int line_gradient(double t, const double *q, double *phi_q, void *user)
{
  const double *c = user;
  const double entries[] = {1, -1, 0, 2 * c[1] * q[0], q[2], q[1]};
  (void)t;
  memcpy(phi_q, entries, sizeof entries);
  return 0;
}

static int wrong_gradient(double t, const double *q, double *phi_q, void *user)
{
  const int returned = line_gradient(t, q, phi_q, user);
  phi_q[4] *= 1.01;
  return returned;
}

static int line_hessian(double t, const double *q, const double *w, double *phi_w_qq, void *user)
{
  const double *c = user;
  (void)t, (void)q;
  memset(phi_w_qq, 0, 9 * sizeof *phi_w_qq);
  phi_w_qq[0] = 2 * c[1] * w[1];
  phi_w_qq[5] = phi_w_qq[7] = w[1];
  return 0;
}

static int wrong_hessian(double t, const double *q, const double *w, double *phi_w_qq, void *user)
{
  const int returned = line_hessian(t, q, w, phi_w_qq, user);
  phi_w_qq[0] *= 1.01;
  return returned;
}

static int unit_rate(double t, const double *q, double *phi_t, void *user)
{
  (void)t, (void)q;
  phi_t[0] = *(const double *)user;
  phi_t[1] = 0;
  return 0;
}

static double numbers[2] = {0, 0.5};

static const dvi_holonomic good = {.name = "line",
                                   .count = 2,
                                   .value = line_value,
                                   .gradient = line_gradient,
                                   .hessian = line_hessian,
                                   .user = numbers};

static dvi_status create_with(dvi_holonomic rows, int autonomous, dvi_system **system)
{
  const dvi_system_terms terms = {.dimension = 3,
                                  .mass = {.scalar = 1},
                                  .holonomics = &rows,
                                  .holonomic_count = 1,
                                  .autonomous = autonomous};
  return dvi_system_create(&terms, system);
}

static void refused(dvi_holonomic rows, dvi_status status, const char *words)
{
  dvi_system *system;
  ck_assert_int_eq(create_with(rows, 1, &system), status);
  ck_assert_ptr_null(system);
  check_words(words);
}

START_TEST(constraints_that_are_not_well_declared_are_refused)
{
  static const int start[] = {0, 1, 2}, beyond[] = {0, 3};
  dvi_holonomic rows = good;
  rows.value = NULL;
  refused(rows, DVI_BAD_ARGUMENT, "constraint 'line' has no value callback");
  rows = good;
  rows.gradient = NULL;
  refused(rows, DVI_BAD_ARGUMENT, "constraint 'line' has no gradient callback");
  rows = good;
  rows.count = 0;
  refused(rows, DVI_BAD_SIZE, "constraint 'line' has 0 rows");
  rows.count = 13;
  refused(rows, DVI_BAD_SIZE, "constraint 'line' has 13 rows; 1 to 12 are possible");
  rows = good;
  rows.rate = unit_rate;
  refused(rows, DVI_BAD_ARGUMENT, "declared autonomous");
  rows = good;
  rows.gradients = (dvi_pattern){start, beyond};
  refused(rows, DVI_BAD_ARGUMENT, "line");
}
END_TEST

/* Declares a constraint beside the terms of a problem of the catalogue. */
static void refused_beside(const char *problem_name, const char *words)
{
  problem *model = create_problem(problem_name, NULL);
  dvi_system_terms terms = *model->terms;
  dvi_system *system;
  terms.holonomics = &good;
  terms.holonomic_count = 1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_UNSUPPORTED);
  check_words(words);
  problem_destroy(&model);
}

START_TEST(constraints_are_refused_beside_other_kinds_of_dynamics)
{
  refused_beside("guiding-centre", "holonomic constraints go with");
  refused_beside("elastica", "not with a Hamiltonian");
}
END_TEST

START_TEST(methods_that_take_no_constraints_say_so)
{
  static const char *const methods[] = {"respa",    "imex",        "sem",
                                        "shooting", "trig",        "boris",
                                        "hp",       "hamiltonian", "composition:base=boris"};
  constrained model;
  make_constrained(SPHERICAL_PENDULUM, 0, &model);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_integrator *integrator;
    ck_assert_int_eq(dvi_integrator_create(model.system, methods[m], &integrator), DVI_UNSUPPORTED);
    check_words("holonomic constraints phi(t,q) = 0");
  }
  destroy_constrained(&model);
}
END_TEST

START_TEST(a_transform_of_time_and_a_path_take_no_constraints)
{
  static const double q1[] = {0, 0, -1};
  constrained model;
  dvi_integrator *integrator;
  dvi_path *path;
  make_constrained(SPHERICAL_PENDULUM, 0, &model);
  const dvi_monitor monitor = read_monitor("arclength");
  ck_assert_int_eq(create_transformed(model.system, &monitor, "galerkin", &integrator),
                   DVI_UNSUPPORTED);
  check_words("the system declares holonomic constraints, which the transform does not carry over");
  const dvi_path_options options = {
      .ends = DVI_ENDS_FIXED, .steps = 5, .span = 1, .dimension = 3, .q0 = model.q, .q1 = q1};
  ck_assert_int_eq(dvi_path_create(model.system, "midpoint", &options, &path), DVI_UNSUPPORTED);
  check_words("path: the system declares holonomic constraints");
  destroy_constrained(&model);
}
END_TEST

/* ---- the check ---- */

static void check_says(dvi_holonomic rows, double speed, dvi_status status, const char *words)
{
  static const double q[] = {0.3, -0.4, 0.8}, v[] = {0.1, 0.2, 0.3};
  dvi_system *system;
  numbers[0] = speed;
  ck_assert_msg(create_with(rows, 0, &system) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_system_check(system, 0.3, q, v, 0, NULL), status);
  if (status != DVI_OK) check_words(words);
  dvi_system_destroy(&system);
  numbers[0] = 0;
}

START_TEST(the_check_compares_gradients_and_hessians)
{
  dvi_holonomic rows = good;
  check_says(good, 0, DVI_OK, NULL);
  rows.hessian = NULL;
  check_says(rows, 0, DVI_OK, NULL);
  check_says(good, 0.1, DVI_BAD_ARGUMENT, "constraint 'line': d phi_0/dt is 0 from the callback");
  rows.rate = unit_rate;
  check_says(rows, 0.1, DVI_OK, NULL);
  rows = good;
  rows.gradient = wrong_gradient;
  check_says(rows, 0, DVI_BAD_ARGUMENT, "constraint 'line': d phi_j/dq_i at (i,j) = (1,1) is");
  rows = good;
  rows.hessian = wrong_hessian;
  check_says(rows, 0, DVI_BAD_ARGUMENT, "constraint 'line': d2(phi.w)/dq2 (0,0) is");
}
END_TEST

/* ---- failures ---- */

/* Rows phi = (x, c0 x + c1 y + c2 y^2 + c3), of which the second may contradict the first, or be
 * no constraint. */
static int pair_value(double t, const double *q, double *phi, void *user)
{
  const double *c = user;
  (void)t;
  phi[0] = q[0];
  phi[1] = c[0] * q[0] + c[1] * q[1] + c[2] * q[1] * q[1] + c[3];
  return 0;
}

static int pair_gradient(double t, const double *q, double *phi_q, void *user)
{
  const double *c = user, entries[] = {1, 0, 0, c[0], c[1] + 2 * c[2] * q[1], 0};
  (void)t;
  memcpy(phi_q, entries, sizeof entries);
  return 0;
}

static void pair_is_refused(const char *method, double c[4], int project, dvi_status expected,
                            const char *words)
{
  const dvi_holonomic rows = {
      .name = "pair", .count = 2, .value = pair_value, .gradient = pair_gradient, .user = c};
  const double q[] = {0, 0, 0}, p[] = {0, 0, 1};
  const dvi_start_options options = {.project = project};
  dvi_system *system;
  double lambda[2];
  ck_assert_int_eq(create_with(rows, 1, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start_with(integrator, 0, q, p, &options), expected);
  check_words(words);
  ck_assert_int_eq(dvi_integrator_reactions(integrator, lambda), DVI_BAD_STATE);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}

START_TEST(rows_that_contradict_each_other_or_are_none_are_refused_by_name)
{
  static const char *const methods[] = {"galerkin", "verlet", "trapezoidal", "composition"};
  for (int m = 0; m < 4; m++) {
    double shifted[] = {1, 0, 0, 1}, bent[] = {1, 0, 1, 0}, squared[] = {0, 0, 1, 0},
           constant[] = {0, 0, 0, 0}, wrong[] = {0, 0, 0, 1};
    pair_is_refused(methods[m], shifted, 0, DVI_BAD_ARGUMENT, "constraint 'pair' (row 1) is 1");
    pair_is_refused(methods[m], shifted, 1, DVI_NOT_CONVERGED,
                    "no point of the constraints was found: constraint 'pair' (row ");
    pair_is_refused(methods[m], bent, 0, DVI_SINGULAR,
                    "constraint 'pair' (row 1) depends on the others at t = 0, but not around");
    pair_is_refused(methods[m], squared, 0, DVI_SINGULAR,
                    "constraint 'pair' (row 1) has the gradient 0 at t = 0");
    pair_is_refused(methods[m], constant, 0, DVI_SINGULAR,
                    "constraint 'pair' (row 1) has the gradient 0 at t = 0");
    pair_is_refused(methods[m], wrong, 0, DVI_BAD_ARGUMENT, "constraint 'pair' (row 1) is 1");
  }
}
END_TEST

/* Rows phi = (a, a + b, 2 a + b) with a = x - 1 and b = y/128 - 1, of rank 2, which differ
 * little. */
static int triple_value(double t, const double *q, double *phi, void *user)
{
  (void)t, (void)user;
  phi[0] = q[0] - 1;
  phi[1] = q[0] - 1 + (q[1] / 128 - 1);
  phi[2] = 2 * (q[0] - 1) + (q[1] / 128 - 1);
  return 0;
}

static int triple_gradient(double t, const double *q, double *phi_q, void *user)
{
  const double entries[] = {1, 0, 0, 1, 1.0 / 128, 0, 2, 1.0 / 128, 0};
  (void)t, (void)q, (void)user;
  memcpy(phi_q, entries, sizeof entries);
  return 0;
}

/* Places are on the rows, and off them. */
START_TEST(starts_are_projected_onto_rows_that_depend_on_others)
{
  static const char *const methods[] = {"galerkin", "verlet", "trapezoidal", "composition"};
  const dvi_holonomic rows = {
      .name = "triple", .count = 3, .value = triple_value, .gradient = triple_gradient};
  const dvi_start_options options = {.project = 1};
  dvi_system *system;
  ck_assert_int_eq(create_with(rows, 1, &system), DVI_OK);
  for (int off = 0; off < 2; off++) {
    const double q[] = {1 + 0.01 * off, 128, -2}, p[] = {1, 3, 4};
    dvi_integrator *integrator = create_integrator(system, methods[_i]);
    ck_assert_msg(dvi_integrator_start_with(integrator, 0, q, p, &options) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_double_eq_tol(dvi_integrator_p(integrator)[0], 0, 1e-11);
    ck_assert_double_eq_tol(dvi_integrator_p(integrator)[1], 0, 1e-9);
    ck_assert_double_eq_tol(dvi_integrator_p(integrator)[2], 4, 1e-15);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(reactions_need_a_start)
{
  double lambda[2];
  dvi_system *system;
  ck_assert_int_eq(create_with(good, 1, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, "galerkin");
  ck_assert_int_eq(dvi_integrator_reactions(integrator, lambda), DVI_BAD_STATE);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- checkpoints, ensembles ---- */

START_TEST(a_restored_run_has_the_same_bits)
{
  static unsigned char bytes[1 << 16];
  for (int kind = 0; kind < CONSTRAINED_KINDS; kind++) {
    size_t size;
    constrained model;
    make_constrained((constrained_kind)kind, 0, &model);
    dvi_integrator *first = constrained_integrator(&model, "galerkin:degree=3"),
                   *second = create_integrator(model.system, "galerkin:degree=3");
    advance(first, 0.01, 20);
    ck_assert_int_eq(dvi_integrator_save_memory(first, bytes, sizeof bytes, &size), DVI_OK);
    advance(first, 0.01, 20);
    ck_assert_msg(dvi_integrator_restore_memory(second, bytes, size) == DVI_OK, "%s",
                  dvi_last_error());
    advance(second, 0.01, 20);
    for (int i = 0; i < model.n; i++) {
      ck_assert_double_eq(dvi_integrator_q(first)[i], dvi_integrator_q(second)[i]);
      ck_assert_double_eq(dvi_integrator_p(first)[i], dvi_integrator_p(second)[i]);
    }
    dvi_integrator_destroy(&first);
    dvi_integrator_destroy(&second);
    destroy_constrained(&model);
  }
}
END_TEST

START_TEST(members_of_ensembles_have_the_bits_of_runs_alone)
{
  enum { MEMBERS = 3 };
  constrained model;
  make_constrained(SPHERICAL_PENDULUM, 0, &model);
  double q[3 * MEMBERS], p[3 * MEMBERS], t[MEMBERS];
  for (int k = 0; k < MEMBERS; k++)
    for (int i = 0; i < 3; i++) {
      q[i * MEMBERS + k] = model.q[i];
      p[i * MEMBERS + k] = (1 + 0.1 * k) * model.v[i];
    }
  dvi_ensemble *e = create_ensemble(model.system, "galerkin",
                                    (dvi_ensemble_options){.members = MEMBERS});
  ck_assert_msg(dvi_ensemble_start(e, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.02, 25), DVI_OK);
  double q_all[3 * MEMBERS], p_all[3 * MEMBERS];
  ck_assert_int_eq(dvi_ensemble_state(e, t, q_all, p_all), DVI_OK);
  for (int k = 0; k < MEMBERS; k++) {
    dvi_integrator *alone = create_integrator(model.system, "galerkin");
    const double q0[] = {q[k], q[MEMBERS + k], q[2 * MEMBERS + k]},
                 p0[] = {p[k], p[MEMBERS + k], p[2 * MEMBERS + k]};
    ck_assert_int_eq(dvi_integrator_start(alone, 0, q0, p0), DVI_OK);
    advance(alone, 0.02, 25);
    for (int i = 0; i < 3; i++)
      ck_assert_double_eq(dvi_integrator_q(alone)[i], q_all[i * MEMBERS + k]);
    dvi_integrator_destroy(&alone);
  }
  dvi_ensemble_destroy(&e);
  destroy_constrained(&model);
}
END_TEST

SUITE(holonomic)
{
  tcase_add_test(tests, constraints_that_are_not_well_declared_are_refused);
  tcase_add_test(tests, constraints_are_refused_beside_other_kinds_of_dynamics);
  tcase_add_test(tests, methods_that_take_no_constraints_say_so);
  tcase_add_test(tests, a_transform_of_time_and_a_path_take_no_constraints);
  tcase_add_test(tests, the_check_compares_gradients_and_hessians);
  tcase_add_test(tests, rows_that_contradict_each_other_or_are_none_are_refused_by_name);
  tcase_add_loop_test(tests, starts_are_projected_onto_rows_that_depend_on_others, 0, 4);
  tcase_add_test(tests, reactions_need_a_start);
  tcase_add_test(tests, a_restored_run_has_the_same_bits);
  tcase_add_test(tests, members_of_ensembles_have_the_bits_of_runs_alone);
}
