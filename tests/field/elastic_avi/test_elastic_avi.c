/* Marches of elastic solids with steps of their own for all cells. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "field/elastic_avi/plan.h"
#include "support/field/generated.h"
#include "support/field/marches.h"
#include "support/field/solids.h"
#include "support/suite.h"

static const char *const methods[] = {"avi", "avi:classes=no", "verlet"};
enum { METHODS = 3, NUMBERS_MOST = 3 * 1000 };

/* Start the turning block. */
static dvi_march *spun(const dvi_elastic *solid, const char *method, double fraction, double scale)
{
  double rate[NUMBERS_MOST];
  dvi_march *march = march_of_solid(solid, method, fraction);
  spin_block(solid, scale, rate);
  start_march_of_solid(march, NULL, rate);
  return march;
}

/* Require equal bits of both forms. */
static void check_same(const dvi_march *a, const dvi_march *b)
{
  double values[2][NUMBERS_MOST];
  const size_t size = (size_t)dvi_march_size(a, DVI_FORM_A) * sizeof(double);
  for (int form = 0; form < 2; form++) {
    copy_march(a, (dvi_march_form)form, values[0]);
    copy_march(b, (dvi_march_form)form, values[1]);
    ck_assert_mem_eq(values[0], values[1], size);
  }
}

/* ---- digits ---- */

/* The corner (1,1,1), the last node, at t = 1, by an independent program. */
static double corner_error(dvi_elastic_law law, const char *method, double fraction)
{
  static const double x[2][3] = {{1.120541854504, 0.880670758168, 1.078836923111},
                                 {1.121240896990, 0.880808459494, 1.079014224797}};
  double u[NUMBERS_MOST], worst = 0;
  dvi_elastic *solid = block(3, 2, 2, law);
  dvi_march *march = spun(solid, method, fraction, 1);
  advance_march(march, 1);
  copy_march(march, DVI_FORM_A, u);
  const int64_t last = dvi_march_size(march, DVI_FORM_A) - 3;
  for (int i = 0; i < 3; i++)
    worst = fmax(worst, fabs(1 + u[last + i] - x[law == DVI_ELASTIC_NEO_HOOKEAN][i]));
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
  return worst;
}

/* Steps that are no part of the time shift the slope by a tenth. */
START_TEST(the_free_block_has_its_digits_with_order_2)
{
  const dvi_elastic_law law = _i % 2 ? DVI_ELASTIC_NEO_HOOKEAN : DVI_ELASTIC_SVK;
  const char *method = methods[_i / 2];
  const double fraction[] = {0.8, 0.4, 0.2, 0.1};
  double error[4], slope;
  for (int k = 0; k < 4; k++) error[k] = corner_error(law, method, fraction[k]);
  slope = log2(error[0] / error[3]) / 3;
  ck_assert_double_lt(fabs(slope - 2), 0.2);
  ck_assert_double_lt(error[3], 1e-5);
}
END_TEST

/* ---- laws ---- */

START_TEST(momenta_are_conserved_to_roundings)
{
  dvi_elastic *solid = block(3, 2, 2, DVI_ELASTIC_SVK);
  dvi_march *march = spun(solid, methods[_i], 0.5, 1);
  static const char *const names[] = {"momentum_x", "momentum_y", "momentum_z",
                                      "angular_x",  "angular_y",  "angular_z"};
  double before[6];
  for (int k = 0; k < 6; k++) before[k] = observe_march(march, names[k]);
  advance_march(march, 20);
  for (int k = 0; k < 6; k++)
    ck_assert_double_eq_tol(observe_march(march, names[k]), before[k], 5e-15);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}
END_TEST

START_TEST(cuts_and_observations_change_no_bit)
{
  dvi_elastic *solid = block(3, 2, 2, DVI_ELASTIC_NEO_HOOKEAN);
  dvi_march *whole = spun(solid, methods[_i], 0.5, 1), *cut = spun(solid, methods[_i], 0.5, 1);
  dvi_march_facts facts;
  dvi_march_facts_of(whole, &facts);
  advance_march(whole, 1.5);
  for (int n = 1; n * facts.step < 1.5; n++) {
    double E[3 * 27], single;
    const int cell = n % 81;
    advance_march(cut, n * facts.step);
    advance_march(cut, n * facts.step * (1 + 4e-16));
    ck_assert(dvi_march_sample(cut, DVI_FORM_E, 1, &cell, &single) == DVI_OK);
    copy_march(cut, DVI_FORM_E, E);
    ck_assert(single == E[cell]);
    advance_march(cut, fmin((n + 0.3) * facts.step, 1.5));
    (void)observe_march(cut, "energy");
  }
  advance_march(cut, 1.5);
  check_same(whole, cut);
  dvi_march_destroy(&whole);
  dvi_march_destroy(&cut);
  dvi_elastic_destroy(&solid);
}
END_TEST

START_TEST(a_saved_march_goes_on_with_the_same_bits)
{
  char path[64];
  dvi_elastic *solid = block(3, 2, 2, DVI_ELASTIC_SVK);
  dvi_march *whole = spun(solid, methods[_i], 0.5, 1),
            *other = march_of_solid(solid, methods[_i], 0.5),
            *stranger = march_of_solid(solid, methods[_i], 0.4);
  (void)snprintf(path, sizeof path, "elastic_avi_%d_%d.state", _i, (int)getpid());
  advance_march(whole, 0.7);
  ck_assert(dvi_march_save(whole, path) == DVI_OK);
  ck_assert(dvi_march_load(other, path) == DVI_OK);
  ck_assert(dvi_march_load(stranger, path) == DVI_BAD_FILE);
  (void)remove(path);
  advance_march(whole, 2);
  advance_march(other, 2);
  check_same(whole, other);
  dvi_march_destroy(&whole);
  dvi_march_destroy(&other);
  dvi_march_destroy(&stranger);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* ---- energy ---- */

/* Give the largest swing of the energy about its start. */
static double swing(dvi_elastic_law law, const char *method, double fraction, double scale,
                    double T)
{
  dvi_elastic *solid = block(3, 2, 2, law);
  dvi_march *march = spun(solid, method, fraction, scale);
  const double start = observe_march(march, "energy");
  double worst = 0;
  for (int k = 1; k <= 200; k++) {
    advance_march(march, T * k / 200);
    worst = fmax(worst, fabs(observe_march(march, "energy") / start - 1));
  }
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
  return worst;
}

START_TEST(the_energy_of_classes_stays_for_a_long_time)
{
  const double found = swing(DVI_ELASTIC_SVK, "avi", 0.5, 1, is_short_run() ? 50 : 400);
  ck_assert_double_lt(found, 5e-3);
}
END_TEST

/* ---- damping, loads and conditions ---- */

static int shake(double t, const double *X, double *u, double *rate, void *user)
{
  (void)user;
  u[0] = 0.05 * sin(3 * t) * (1 + X[1]), rate[0] = 0.15 * cos(3 * t) * (1 + X[1]);
  u[1] = u[2] = rate[1] = rate[2] = 0;
  return 0;
}

static int weight(double t, const double *X, const double *normal, double *force, void *user)
{
  (void)normal, (void)user;
  force[0] = 0.1 * cos(2 * t), force[1] = 0.05 * X[0], force[2] = -0.2;
  return 0;
}

static dvi_elastic *driven_block(double alpha, double beta)
{
  static const dvi_elastic_condition condition = {.part = "left", .displacement = shake};
  static const dvi_elastic_load load = {.part = "all", .force = weight};
  const dvi_generator_options options = {.cells = {2, 2, 2}, .grading = {2}};
  dvi_elastic_material material = unit_material(DVI_ELASTIC_SVK);
  material.alpha = alpha;
  material.beta = beta;
  return solid_on(
      generated("kuhn", options), material,
      (dvi_elastic_terms){.condition = &condition, .conditions = 1, .load = &load, .loads = 1});
}

/* Each of driven nodes, loads that depend on time, alpha and beta. */
START_TEST(loads_conditions_and_damping_have_order_2)
{
  dvi_elastic *solid = driven_block(_i / 3 % 2 ? 0.7 : 0, _i / 6 ? 0.05 : 0);
  const double fraction[] = {0.8, 0.4, 0.2, 0.1, 0.0125};
  double u[5][2][81], error[4] = {0}, slope[2];
  for (int k = 0; k < 5; k++) {
    dvi_march *march = march_of_solid(solid, methods[_i % 3], fraction[k]);
    start_march_of_solid(march, NULL, NULL);
    advance_march(march, 1);
    copy_march(march, DVI_FORM_A, u[k][0]);
    copy_march(march, DVI_FORM_E, u[k][1]);
    dvi_march_destroy(&march);
  }
  for (int form = 0; form < 2; form++) {
    for (int k = 0; k < 4; k++) {
      error[k] = 0;
      for (int i = 0; i < 81; i++) error[k] = fmax(error[k], fabs(u[k][form][i] - u[4][form][i]));
    }
    slope[form] = log2(error[0] / error[3]) / 3;
  }
  ck_assert_double_gt(slope[0], 1.8);
  ck_assert_double_gt(slope[1], 1.8);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* ---- failures ---- */

/* The side X = 0 is pushed through the block, which inverts a cell at about t = 1. */
static int crush(double t, const double *X, double *u, double *rate, void *user)
{
  (void)X, (void)user;
  u[0] = t, rate[0] = 1;
  return 0;
}

/* Works until t = 1. */
static int break_down(double t, const double *X, double *u, double *rate, void *user)
{
  (void)X, (void)u, (void)rate;
  return t > 1 ? *(const int *)user : 0;
}

static dvi_elastic *
held_block(int (*displacement)(double, const double *, double *, double *, void *), int *returned)
{
  const dvi_elastic_condition condition[] = {
      {.part = "left", .displacement = displacement, .user = returned}, {.part = "right"}};
  const dvi_generator_options options = {.cells = {2, 2, 2}, .grading = {2}};
  return solid_on(generated("kuhn", options), unit_material(DVI_ELASTIC_NEO_HOOKEAN),
                  (dvi_elastic_terms){.condition = condition, .conditions = 2});
}

/* Advance until a failure, and require that the march stands before it, and does so again. */
static void check_halt(dvi_march *march, dvi_status expected, const char *words)
{
  double u[2][NUMBERS_MOST];
  start_march_of_solid(march, NULL, NULL);
  ck_assert_msg(dvi_march_advance(march, 3) == expected, "%s", dvi_last_error());
  ck_assert_msg(strstr(dvi_last_error(), words) != NULL, "%s", dvi_last_error());
  const double t = dvi_march_time(march);
  ck_assert(t > 0.1 && t < 1.2);
  copy_march(march, DVI_FORM_A, u[0]);
  ck_assert(dvi_march_advance(march, 3) == expected);
  ck_assert_double_eq(dvi_march_time(march), t);
  copy_march(march, DVI_FORM_A, u[1]);
  for (int64_t i = 0; i < dvi_march_size(march, DVI_FORM_A); i++)
    ck_assert(isfinite(u[0][i]) && u[0][i] == u[1][i]);
}

START_TEST(a_march_stands_before_a_cell_is_inverted)
{
  dvi_elastic *solid = held_block(crush, NULL);
  dvi_march *march = march_of_solid(solid, methods[_i], 0.2);
  check_halt(march, DVI_SINGULAR, "invert");
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}
END_TEST

START_TEST(a_condition_that_fails_is_named)
{
  int returned = _i / METHODS ? 7 : -3;
  dvi_elastic *solid = held_block(break_down, &returned);
  dvi_march *march = march_of_solid(solid, methods[_i % METHODS], 0.2);
  check_halt(march, DVI_CALLBACK_FAILED,
             returned == 7 ? "a displacement that is given at" : "returned -3");
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* The swing of the energy is taken for a growth by a narrow band. The run goes on. */
START_TEST(an_alarm_tells_that_the_energy_grew)
{
  dvi_elastic *solid = block(3, 2, 2, DVI_ELASTIC_SVK);
  dvi_march *march = spun(solid, "avi:band=1.00001", 0.9, 1);
  dvi_status status = DVI_OK;
  for (int k = 1; k < 100 && status == DVI_OK; k++) status = dvi_march_advance(march, k);
  ck_assert_msg(status == DVI_STEP_TOO_LARGE, "%s", dvi_last_error());
  ck_assert_ptr_nonnull(strstr(dvi_last_error(), "times that of the start and what loads"));
  advance_march(march, 100);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* Far from rest a bound at rest is none. */
START_TEST(a_run_without_end_is_stopped)
{
  dvi_elastic *solid = block(3, 2, 2, DVI_ELASTIC_SVK);
  dvi_march *march = spun(solid, "verlet", 0.9, 2.5);
  dvi_status status = DVI_OK;
  for (int k = 1; k < 100 && status == DVI_OK; k++) status = dvi_march_advance(march, k);
  ck_assert_msg(status == DVI_NOT_FINITE, "%s", dvi_last_error());
  ck_assert_ptr_nonnull(strstr(dvi_last_error(), "the run cannot go on; take shorter steps"));
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}
END_TEST

START_TEST(steps_beyond_the_bound_are_refused)
{
  dvi_elastic *solid = block(3, 2, 2, DVI_ELASTIC_SVK);
  const dvi_march_options options = {.size = sizeof options, .method = methods[_i], .step = 10};
  dvi_march *march = NULL;
  ck_assert(dvi_elastic_march_create(solid, &options, &march) == DVI_BAD_ARGUMENT);
  ck_assert_ptr_null(march);
  ck_assert_ptr_nonnull(strstr(dvi_last_error(), "are not stable; the least bound is"));
  dvi_elastic_destroy(&solid);
}
END_TEST

static int swing_softly(double t, const double *X, double *u, double *rate, void *user)
{
  (void)X, (void)user;
  u[0] = 0.05 * (1 - cos(3 * t)), rate[0] = 0.15 * sin(3 * t);
  return 0;
}

/* A side that swings moves its own mass, too, which no force of a soft cell does. */
START_TEST(conditions_that_work_ring_no_alarm)
{
  const dvi_elastic_condition condition = {.part = "left", .displacement = swing_softly};
  const dvi_generator_options options = {.cells = {2, 2, 2}, .grading = {2}};
  dvi_elastic_material material = unit_material(DVI_ELASTIC_SVK);
  material.lambda = material.mu = 0.01;
  dvi_elastic *solid = solid_on(generated("kuhn", options), material,
                                (dvi_elastic_terms){.condition = &condition, .conditions = 1});
  dvi_march *march = march_of_solid(solid, methods[_i], 0.1);
  start_march_of_solid(march, NULL, NULL);
  for (int k = 1; k <= 40; k++) {
    advance_march(march, k / 4.0);
    ck_assert_double_lt(observe_march(march, "growth"), 1.01);
  }
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}
END_TEST

SUITE(elastic_avi)
{
  tcase_add_loop_test(tests, the_free_block_has_its_digits_with_order_2, 0, 2 * METHODS);
  tcase_add_loop_test(tests, momenta_are_conserved_to_roundings, 0, METHODS);
  tcase_add_loop_test(tests, cuts_and_observations_change_no_bit, 0, METHODS);
  tcase_add_loop_test(tests, a_saved_march_goes_on_with_the_same_bits, 0, METHODS);
  tcase_add_test(tests, the_energy_of_classes_stays_for_a_long_time);
  tcase_add_loop_test(tests, loads_conditions_and_damping_have_order_2, 0, 12);
  tcase_add_loop_test(tests, a_march_stands_before_a_cell_is_inverted, 0, METHODS);
  tcase_add_loop_test(tests, a_condition_that_fails_is_named, 0, 2 * METHODS);
  tcase_add_test(tests, an_alarm_tells_that_the_energy_grew);
  tcase_add_test(tests, a_run_without_end_is_stopped);
  tcase_add_loop_test(tests, steps_beyond_the_bound_are_refused, 0, METHODS);
  tcase_add_loop_test(tests, conditions_that_work_ring_no_alarm, 0, METHODS);
}
