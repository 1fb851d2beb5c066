/* labels: unit invariant */
/* The path of a system with noise is a function of its seed and stream alone. Members of ensembles
 * have the bits of single runs with streams of their own. */
#include <check.h>
#include <math.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "support/files.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/noisy.h"

enum { N = 3, MEMBERS = 37 };

static const char *const methods[] = {"langevin", "langevin:scheme=obabo",
                                      "langevin:scheme=ovio,degree=1",
                                      "langevin:scheme=ovio,degree=3,quadrature=lobatto"};
enum { METHODS = 4 };

static dvi_noise bath = {.temperature = 0.8, .friction = 0.7, .seed = 99, .stream = 5};
static double q[N * MEMBERS], p[N * MEMBERS];

static void spread_members(void)
{
  for (int i = 0; i < N * MEMBERS; i++) {
    q[i] = 1 + 0.1 * (i % 7);
    p[i] = 0.2 * (i % 5);
  }
}

static dvi_integrator *start_alone(const dvi_system *system, const char *method, int member)
{
  double q_k[N], p_k[N];
  for (int i = 0; i < N; i++) q_k[i] = q[i * MEMBERS + member], p_k[i] = p[i * MEMBERS + member];
  dvi_integrator *alone = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start(alone, 0, q_k, p_k), DVI_OK);
  return alone;
}

static void check_member(dvi_ensemble *e, int member, dvi_integrator *alone)
{
  static double q_all[N * MEMBERS], p_all[N * MEMBERS];
  double here, there;
  ck_assert_int_eq(dvi_ensemble_state(e, NULL, q_all, p_all), DVI_OK);
  for (int i = 0; i < N; i++) {
    ck_assert_mem_eq(&q_all[i * MEMBERS + member], dvi_integrator_q(alone) + i, sizeof here);
    ck_assert_mem_eq(&p_all[i * MEMBERS + member], dvi_integrator_p(alone) + i, sizeof here);
  }
  ck_assert_int_eq(dvi_ensemble_temperature(e, member, &here), DVI_OK);
  ck_assert_int_eq(dvi_integrator_temperature(alone, &there), DVI_OK);
  ck_assert_mem_eq(&here, &there, sizeof here);
}

/* Compares members with single runs, for each instruction set, in blocks and on threads. */
START_TEST(members_have_the_bits_of_single_runs_with_their_streams)
{
  static const int ways[][2] = {{1, 0}, {3, 5}, {2, 1}};
  noisy_oscillators noisy;
  const int coupled = _i / METHODS;
  spread_members();
  make_noisy(N, 1.7, 2.3, coupled, bath, &noisy);
  for (int level = 0; level < dvi__lanes_levels(); level++)
    for (int way = 0; way < 3; way++) {
      dvi__lanes_choose(level);
      dvi_ensemble *e = create_ensemble(noisy.system, methods[_i % METHODS],
                                        (dvi_ensemble_options){.members = MEMBERS,
                                                               .threads = ways[way][0],
                                                               .block = ways[way][1]});
      ck_assert_int_eq(dvi_ensemble_start(e, 0, q, p), DVI_OK);
      ck_assert_int_eq(dvi_ensemble_advance(e, 0.1, 7), DVI_OK);
      ck_assert_int_eq(dvi_ensemble_advance(e, 0.05, 4), DVI_OK);
      for (int member = 0; member < MEMBERS; member += 6) {
        noisy_oscillators own;
        dvi_noise noise = bath;
        noise.stream += (uint32_t)member;
        make_noisy(N, 1.7, 2.3, coupled, noise, &own);
        dvi_integrator *alone = start_alone(own.system, methods[_i % METHODS], member);
        advance(alone, 0.1, 7);
        advance(alone, 0.05, 4);
        check_member(e, member, alone);
        dvi_integrator_destroy(&alone);
        destroy_noisy(&own);
      }
      dvi_ensemble_destroy(&e);
    }
  dvi__lanes_choose(-1);
  destroy_noisy(&noisy);
}
END_TEST

START_TEST(members_are_computed_side_by_side_where_masses_are_diagonal)
{
  char text[2048];
  for (int coupled = 0; coupled < 2; coupled++)
    for (int i = 0; i < METHODS; i++) {
      noisy_oscillators noisy;
      make_noisy(N, 1.7, 2.3, coupled, bath, &noisy);
      dvi_ensemble *e = create_ensemble(noisy.system, methods[i],
                                        (dvi_ensemble_options){.members = MEMBERS});
      (void)dvi_ensemble_explain(e, text, sizeof text);
      ck_assert_msg((strstr(text, "side by side") != NULL) == !coupled, "%s", text);
      dvi_ensemble_destroy(&e);
      destroy_noisy(&noisy);
    }
}
END_TEST

/* A sweep over temperatures: systems that differ in the numbers of their noise alone. */
START_TEST(members_may_have_temperatures_of_their_own)
{
  noisy_oscillators noisy[MEMBERS];
  const dvi_system *systems[MEMBERS];
  spread_members();
  for (int member = 0; member < MEMBERS; member++) {
    dvi_noise noise = bath;
    noise.temperature = 0.1 * (member / 9);
    make_noisy(N, 1.7, 2.3, 0, noise, &noisy[member]);
    systems[member] = noisy[member].system;
  }
  dvi_ensemble *e = create_ensemble(NULL, "langevin",
                                    (dvi_ensemble_options){.members = MEMBERS, .systems = systems});
  ck_assert_int_eq(dvi_ensemble_start(e, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(e, 0.1, 5), DVI_OK);
  for (int member = 0; member < MEMBERS; member += 9) {
    noisy_oscillators own;
    dvi_noise noise = bath;
    noise.temperature = 0.1 * (member / 9);
    noise.stream += (uint32_t)member;
    make_noisy(N, 1.7, 2.3, 0, noise, &own);
    dvi_integrator *alone = start_alone(own.system, "langevin", member);
    advance(alone, 0.1, 5);
    check_member(e, member, alone);
    dvi_integrator_destroy(&alone);
    destroy_noisy(&own);
  }
  dvi_ensemble_destroy(&e);
  for (int member = 0; member < MEMBERS; member++) destroy_noisy(&noisy[member]);
}
END_TEST

START_TEST(a_restored_run_goes_on_with_the_same_noise)
{
  noisy_oscillators noisy, other;
  dvi_noise warmer = bath;
  size_t size;
  static unsigned char saved[16384];
  warmer.temperature *= 2;
  spread_members();
  make_noisy(N, 1.7, 2.3, 1, bath, &noisy);
  make_noisy(N, 1.7, 2.3, 1, warmer, &other);
  dvi_integrator *whole = start_alone(noisy.system, methods[_i], 0),
                 *part = start_alone(noisy.system, methods[_i], 1),
                 *wrong = create_integrator(other.system, methods[_i]);
  advance(whole, 0.1, 10);
  ck_assert_int_eq(dvi_integrator_save_memory(whole, saved, sizeof saved, &size), DVI_OK);
  advance(part, 0.1, 3);
  ck_assert_int_eq(dvi_integrator_restore_memory(part, saved, size), DVI_OK);
  advance(whole, 0.1, 10);
  advance(part, 0.1, 10);
  check_same_state(whole, part);
  ck_assert_int_eq(dvi_integrator_restore_memory(wrong, saved, size), DVI_BAD_FILE);
  check_words("declares other noise");
  dvi_integrator_destroy(&whole);
  dvi_integrator_destroy(&part);
  dvi_integrator_destroy(&wrong);
  destroy_noisy(&noisy);
  destroy_noisy(&other);
}
END_TEST

/* A start begins the noise anew, and a step that was refused does not use it up. */
START_TEST(a_new_start_and_a_refused_step_leave_the_noise_as_it_was)
{
  noisy_oscillators noisy;
  spread_members();
  make_noisy(N, 1.7, 2.3, 0, bath, &noisy);
  dvi_integrator *one = start_alone(noisy.system, methods[_i], 0),
                 *other = start_alone(noisy.system, methods[_i], 0);
  double q0[N], p0[N];
  for (int i = 0; i < N; i++) q0[i] = q[i * MEMBERS], p0[i] = p[i * MEMBERS];
  advance(one, 0.1, 5);
  ck_assert_int_eq(dvi_integrator_start(one, 0, q0, p0), DVI_OK);
  ck_assert_int_ne(dvi_integrator_step(one, -0.1), DVI_OK);
  advance(one, 0.1, 4);
  advance(other, 0.1, 4);
  ck_assert_mem_eq(dvi_integrator_q(one), dvi_integrator_q(other), sizeof q0);
  ck_assert_mem_eq(dvi_integrator_p(one), dvi_integrator_p(other), sizeof p0);
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&other);
  destroy_noisy(&noisy);
}
END_TEST

/* ---- averages in a double well ---- */

static int well_value(double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  *V = (x[0] * x[0] - 1) * (x[0] * x[0] - 1);
  return 0;
}

static int well_gradient(int count, const double *t, const double *x, double *V_q, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V_q[k] = 4 * x[k] * (x[k] * x[k] - 1);
  return 0;
}

/* <x^2> in the distribution exp(-V/kT), by the trapezoid, which is exact to all digits here. */
static double exact_square(double kT)
{
  double sum = 0, moment = 0, V;
  for (int i = -400; i <= 400; i++) {
    const double x = i / 100.0;
    (void)well_value(0, &x, &V, NULL);
    sum += exp(-V / kT);
    moment += x * x * exp(-V / kT);
  }
  return moment / sum;
}

/* The means over each of 128 members are independent, and tell the error of their mean. The bias of
 * h = 0.1 is below 0.002. Each bound is 4 standard errors and the bias. */
START_TEST(averages_in_a_double_well_are_those_of_quadrature)
{
  enum { COPIES = 128, STEPS = 4000, EVERY = 5 };
  const double kT = 0.5, h = 0.1, bias = 0.002;
  const dvi_noise noise = {.temperature = kT, .friction = 1, .seed = 1};
  const dvi_potential well = {.name = "well", .value = well_value, .gradient_batch = well_gradient};
  const dvi_system_terms terms = {.dimension = 1,
                                  .mass.scalar = 1,
                                  .potentials = &well,
                                  .potential_count = 1,
                                  .autonomous = 1,
                                  .noise = &noise};
  double x[COPIES], zero[COPIES] = {0}, square[COPIES] = {0}, heat[COPIES] = {0}, mean[2] = {0},
                    spread[2] = {0};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_ensemble *e = create_ensemble(system, "langevin",
                                    (dvi_ensemble_options){.members = COPIES, .threads = 1});
  for (int k = 0; k < COPIES; k++) x[k] = k % 2 ? 1 : -1;
  ck_assert_int_eq(dvi_ensemble_start(e, 0, x, zero), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(e, h, 200), DVI_OK);
  for (int i = 0; i < STEPS; i += EVERY) {
    ck_assert_int_eq(dvi_ensemble_advance(e, h, EVERY), DVI_OK);
    ck_assert_int_eq(dvi_ensemble_state(e, NULL, x, NULL), DVI_OK);
    for (int k = 0; k < COPIES; k++) {
      double T;
      ck_assert_int_eq(dvi_ensemble_temperature(e, k, &T), DVI_OK);
      square[k] += x[k] * x[k] * EVERY / STEPS;
      heat[k] += T * EVERY / STEPS;
    }
  }
  for (int k = 0; k < COPIES; k++) mean[0] += square[k] / COPIES, mean[1] += heat[k] / COPIES;
  for (int k = 0; k < COPIES; k++) {
    spread[0] += (square[k] - mean[0]) * (square[k] - mean[0]);
    spread[1] += (heat[k] - mean[1]) * (heat[k] - mean[1]);
  }
  const double exact[2] = {exact_square(kT), kT};
  for (int i = 0; i < 2; i++) {
    const double error = sqrt(spread[i] / (COPIES - 1.0) / COPIES);
    ck_assert_double_le(error, 0.005);
    ck_assert_double_eq_tol(mean[i], exact[i], 4 * error + bias);
  }
  dvi_ensemble_destroy(&e);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(noise)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, members_have_the_bits_of_single_runs_with_their_streams, 0,
                      2 * METHODS);
  tcase_add_test(tests, members_are_computed_side_by_side_where_masses_are_diagonal);
  tcase_add_test(tests, members_may_have_temperatures_of_their_own);
  tcase_add_loop_test(tests, a_restored_run_goes_on_with_the_same_noise, 0, METHODS);
  tcase_add_loop_test(tests, a_new_start_and_a_refused_step_leave_the_noise_as_it_was, 0, METHODS);
  tcase_add_test(tests, averages_in_a_double_well_are_those_of_quadrature);
}
