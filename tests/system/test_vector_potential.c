/* labels: unit */
/* What vector potentials may be declared, where they are refused, how the check compares them, and
 * that ensembles and checkpoints keep every bit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/magnetic.h"

static int value(double t, const double *q, double *A, void *user)
{
  const double *c = user;
  A[0] = -q[1] + c[0] * t;
  A[1] = c[1] * q[0] * q[0];
  return (int)c[2];
}

static int gradient(double t, const double *q, double *A_q, void *user)
{
  const double *c = user;
  (void)t;
  A_q[0] = A_q[3] = 0;
  A_q[1] = -1;
  A_q[2] = 2 * c[1] * q[0];
  return 0;
}

static int wrong_gradient(double t, const double *q, double *A_q, void *user)
{
  const int returned = gradient(t, q, A_q, user);
  A_q[2] *= 1.01;
  return returned;
}

static int wrong_hessian(double t, const double *q, const double *w, double *A_w_qq, void *user)
{
  (void)t, (void)q, (void)user;
  memset(A_w_qq, 0, 4 * sizeof *A_w_qq);
  A_w_qq[0] = w[1];
  return 0;
}

static int rate(double t, const double *q, double *A_t, void *user)
{
  (void)t, (void)q;
  A_t[0] = ((const double *)user)[0];
  A_t[1] = 0;
  return 0;
}

static int wrong_rate(double t, const double *q, double *A_t, void *user)
{
  const int returned = rate(t, q, A_t, user);
  A_t[1] = 0.1;
  return returned;
}

static int batch(int count, const double *t, const double *q, double *A, void *user)
{
  (void)count, (void)t, (void)q, (void)A, (void)user;
  return -1;
}

static double numbers[3] = {0, 0.5, 0};
static const double q[2] = {0.3, -0.4}, v[2] = {0.7, 0.2};
static const int diagonal_start[] = {0, 1, 2}, crossed_row[] = {1, 0};

static dvi_status create_with(dvi_vector_potential A, int autonomous, dvi_system **system)
{
  A.user = numbers;
  const dvi_system_terms terms = {
      .dimension = 2, .mass = {.scalar = 1}, .vector_potential = &A, .autonomous = autonomous};
  return dvi_system_create(&terms, system);
}

static void refused(dvi_vector_potential A, const char *words)
{
  dvi_system *system;
  ck_assert_int_eq(create_with(A, 1, &system), DVI_BAD_ARGUMENT);
  ck_assert_ptr_null(system);
  check_words(words);
}

START_TEST(vector_potentials_that_are_not_well_declared_are_refused)
{
  static const int beyond[] = {0, 2};
  refused((dvi_vector_potential){.gradient = gradient}, "the vector potential has no value");
  refused((dvi_vector_potential){.value = value}, "the vector potential has no gradient");
  refused((dvi_vector_potential){.value = value, .value_batch = batch, .gradient = gradient},
          "the vector potential has its value callback in two shapes");
  refused((dvi_vector_potential){.value = value, .gradient = gradient, .rate = rate},
          "the vector potential has a rate, but the system is declared autonomous");
  refused((dvi_vector_potential){.value = value,
                                 .gradient = gradient,
                                 .gradients = {diagonal_start, beyond}},
          "gradients of the vector potential");
}
END_TEST

/* Declares a vector potential beside the terms of a problem of the catalogue. */
static void refused_beside(const char *problem_name, const char *words)
{
  const dvi_vector_potential A = {.value = value, .gradient = gradient, .user = numbers};
  problem *model = create_problem(problem_name, NULL);
  dvi_system_terms terms = *model->terms;
  dvi_system *system;
  terms.vector_potential = &A;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_UNSUPPORTED);
  check_words(words);
  problem_destroy(&model);
}

START_TEST(vector_potentials_are_refused_beside_other_kinds_of_dynamics)
{
  refused_beside("vortices", "not with a one-form");
  refused_beside("elastica", "not with a Hamiltonian");
  refused_beside("pendulum-3d", "not with factors");
  refused_beside("double-pendulum", "not with a general Lagrangian");
}
END_TEST

START_TEST(methods_that_cannot_use_them_name_them)
{
  static const char *const methods[] = {
      "verlet",       "composition:order=4,base=verlet", "prolongation-collocation",
      "lie-galerkin", "multiscale:fast=0:1,omega=5",     "hp:type=4"};
  magnetic m;
  make_magnetic(BOTTLE, &m);
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
    dvi_integrator *integrator;
    ck_assert_int_eq(dvi_integrator_create(m.system, methods[k], &integrator), DVI_UNSUPPORTED);
    check_words("a vector potential A(t,q).v");
  }
  destroy_magnetic(&m);
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator;
  ck_assert_int_eq(dvi_integrator_create(model->system, "boris", &integrator), DVI_UNSUPPORTED);
  check_words("a vector potential A(t,q).v");
  problem_destroy(&model);
}
END_TEST

START_TEST(boris_needs_the_rate_of_a_field_that_changes)
{
  dvi_system *system;
  dvi_integrator *integrator;
  const dvi_vector_potential A = {.value = value, .gradient = gradient};
  ck_assert_int_eq(create_with(A, 0, &system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(system, "boris", &integrator), DVI_UNSUPPORTED);
  check_words("the vector potential has no rate callback");
  dvi_system_destroy(&system);
}
END_TEST

static void check_says(dvi_vector_potential A, int autonomous, double drift, dvi_status status,
                       const char *words)
{
  dvi_system *system;
  dvi_derivative_check found;
  numbers[0] = drift;
  ck_assert_msg(create_with(A, autonomous, &system) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_system_check(system, 0.3, q, v, 0, &found), status);
  if (status != DVI_OK) check_words(words);
  dvi_system_destroy(&system);
  numbers[0] = 0;
}

START_TEST(the_check_compares_gradients_hessians_patterns_and_time)
{
  const dvi_vector_potential good = {.value = value, .gradient = gradient};
  dvi_vector_potential wrong = good, narrow = good, bent = good, timed = good, late = good;
  wrong.gradient = wrong_gradient;
  narrow.qq = (dvi_pattern){diagonal_start, crossed_row};
  bent.hessian = wrong_hessian;
  timed.rate = rate;
  late.rate = wrong_rate;
  numbers[1] = 0.5;
  check_says(good, 1, 0, DVI_OK, NULL);
  check_says(wrong, 1, 0, DVI_BAD_ARGUMENT, "vector potential: dA_j/dq_i at (i,j) = (0,1) is");
  check_says(narrow, 1, 0, DVI_BAD_ARGUMENT,
             "vector potential: d2(A.v)/dq2 (0,0) is not in the pattern");
  check_says(timed, 0, 0.1, DVI_OK, NULL);
  check_says(late, 0, 0.1, DVI_BAD_ARGUMENT, "vector potential: dA/dt is");
  check_says(good, 1, 0.1, DVI_BAD_ARGUMENT, "vector potential: its value");
  numbers[1] = 0.6;
  check_says(bent, 1, 0, DVI_BAD_ARGUMENT, "vector potential: d2(A.v)/dq2 (0,0) is");
  numbers[1] = 0.5;
}
END_TEST

START_TEST(a_callback_that_fails_leaves_the_state)
{
  static const char *const methods[] = {"boris", "galerkin:degree=2"};
  dvi_system *system;
  const double p[2] = {0.1, 0.2};
  ck_assert_int_eq(
      create_with((dvi_vector_potential){.value = value, .gradient = gradient}, 1, &system),
      DVI_OK);
  for (int k = 0; k < 2; k++) {
    dvi_integrator *integrator = create_integrator(system, methods[k]);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
    advance(integrator, 0.1, 3);
    const double before = dvi_integrator_q(integrator)[0];
    numbers[2] = -7;
    ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_CALLBACK_FAILED);
    check_words("vector potential: the value callback failed with -7");
    numbers[2] = 0;
    ck_assert(before == dvi_integrator_q(integrator)[0]);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

/* ---- bits ---- */

enum { MEMBERS = 7, STEPS = 12 };

static const char *const bitwise[] = {"boris", "composition:order=4,base=boris",
                                      "galerkin:degree=3", "composition:order=4,base=midpoint"};

START_TEST(members_of_an_ensemble_have_the_bits_of_runs_alone)
{
  for (int kind = 0; kind < MAGNETIC_KINDS; kind++) {
    magnetic m;
    double all_q[MAGNETIC_N * MEMBERS], all_p[MAGNETIC_N * MEMBERS], p[MAGNETIC_N];
    make_magnetic((magnetic_kind)kind, &m);
    ck_assert_int_eq(dvi_system_momentum(m.system, 0, m.q, m.v, p), DVI_OK);
    for (int i = 0; i < m.n * MEMBERS; i++) {
      all_q[i] = m.q[i / MEMBERS] * (1 + 0.02 * (i % MEMBERS));
      all_p[i] = p[i / MEMBERS] * (1 - 0.03 * (i % MEMBERS));
    }
    dvi_ensemble *e = create_ensemble(m.system, bitwise[_i],
                                      (dvi_ensemble_options){.members = MEMBERS});
    ck_assert_int_eq(dvi_ensemble_start(e, 0, all_q, all_p), DVI_OK);
    for (int k = 0; k < STEPS; k++) ck_assert_int_eq(dvi_ensemble_step(e, 0.1), DVI_OK);
    double t[MEMBERS], q_end[MAGNETIC_N * MEMBERS], p_end[MAGNETIC_N * MEMBERS];
    ck_assert_int_eq(dvi_ensemble_state(e, t, q_end, p_end), DVI_OK);
    dvi_counters together, sum = {0};
    dvi_ensemble_counters(e, &together);
    for (int k = 0; k < MEMBERS; k++) {
      double q_k[MAGNETIC_N], p_k[MAGNETIC_N];
      for (int i = 0; i < m.n; i++)
        q_k[i] = all_q[i * MEMBERS + k], p_k[i] = all_p[i * MEMBERS + k];
      dvi_integrator *alone = create_integrator(m.system, bitwise[_i]);
      ck_assert_int_eq(dvi_integrator_start(alone, 0, q_k, p_k), DVI_OK);
      advance(alone, 0.1, STEPS);
      for (int i = 0; i < m.n; i++) {
        ck_assert(q_end[i * MEMBERS + k] == dvi_integrator_q(alone)[i]);
        ck_assert(p_end[i * MEMBERS + k] == dvi_integrator_p(alone)[i]);
      }
      dvi_counters own;
      dvi_integrator_counters(alone, &own);
      sum.gradients += own.gradients;
      dvi_integrator_destroy(&alone);
    }
    ck_assert_int_eq(together.gradients, sum.gradients);
    dvi_ensemble_destroy(&e);
    destroy_magnetic(&m);
  }
}
END_TEST

START_TEST(a_restored_run_goes_on_with_the_same_bits)
{
  magnetic m;
  double p[MAGNETIC_N];
  make_magnetic(WAVE, &m);
  ck_assert_int_eq(dvi_system_momentum(m.system, 0, m.q, m.v, p), DVI_OK);
  dvi_integrator *whole = create_integrator(m.system, bitwise[_i]),
                 *restored = create_integrator(m.system, bitwise[_i]);
  ck_assert_int_eq(dvi_integrator_start(whole, 0, m.q, p), DVI_OK);
  advance(whole, 0.1, 5);
  void *saved = NULL;
  size_t size = 0;
  ck_assert_int_eq(dvi_integrator_save_memory(whole, NULL, 0, &size), DVI_OK);
  saved = malloc(size);
  ck_assert_int_eq(dvi_integrator_save_memory(whole, saved, size, &size), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore_memory(restored, saved, size), DVI_OK);
  free(saved);
  advance(whole, 0.1, 5);
  advance(restored, 0.1, 5);
  for (int i = 0; i < m.n; i++)
    ck_assert(dvi_integrator_q(whole)[i] == dvi_integrator_q(restored)[i]);
  dvi_integrator_destroy(&whole);
  dvi_integrator_destroy(&restored);
  destroy_magnetic(&m);
}
END_TEST

SUITE(vector_potential)
{
  tcase_add_test(tests, vector_potentials_that_are_not_well_declared_are_refused);
  tcase_add_test(tests, vector_potentials_are_refused_beside_other_kinds_of_dynamics);
  tcase_add_test(tests, methods_that_cannot_use_them_name_them);
  tcase_add_test(tests, boris_needs_the_rate_of_a_field_that_changes);
  tcase_add_test(tests, the_check_compares_gradients_hessians_patterns_and_time);
  tcase_add_test(tests, a_callback_that_fails_leaves_the_state);
  tcase_add_loop_test(tests, members_of_an_ensemble_have_the_bits_of_runs_alone, 0, 4);
  tcase_add_loop_test(tests, a_restored_run_goes_on_with_the_same_bits, 0, 4);
}
