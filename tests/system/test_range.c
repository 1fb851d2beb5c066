/* labels: unit */
/* Gradients by ranges: refusals, methods that need ranges alone, and broken promises that the check
 * finds. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"

enum { LENGTH = 11 };

/* Springs d^2/2 + d^4/4 between sites that are two apart. On demand the range breaks its promise:
 * it looks farther, adds something to the entries of long or short ranges, writes one entry more,
 * or fails. */
typedef struct line {
  int looks_at; /* distance at which the first site of a range looks, too (default 0, none) */
  double lie;   /* added to the site `at` */
  int at, longest_lie; /* of ranges up to this length */
  int writes_behind, writes_before, answer;
} line;

static double tension(double d)
{
  return d + d * d * d;
}

static double entry(const double *q, int i)
{
  return (i >= 2 ? tension(q[i] - q[i - 2]) : 0) - (i + 2 < LENGTH ? tension(q[i + 2] - q[i]) : 0);
}

static int line_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0;
  for (int i = 0; i + 2 < LENGTH; i++) {
    const double d = q[i + 2] - q[i];
    *V += d * d / 2 + d * d * d * d / 4;
  }
  return 0;
}

static int line_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < LENGTH; i++) V_q[i] = entry(q, i);
  return 0;
}

static int line_gradient_batch(int count, const double *t, const double *q, double *V_q, void *user)
{
  double point[LENGTH];
  (void)t, (void)user;
  for (int k = 0; k < count; k++) {
    for (int i = 0; i < LENGTH; i++) point[i] = q[i * count + k];
    for (int i = 0; i < LENGTH; i++) V_q[i * count + k] = entry(point, i);
  }
  return 0;
}

static int line_range(double t, const double *q, int first, int last, double *V_q, void *user)
{
  const line *own = user;
  const int farther = first - own->looks_at;
  (void)t;
  for (int i = first; i < last; i++) V_q[i - first] = entry(q, i);
  if (own->looks_at != 0 && farther >= 0) V_q[0] += 0 * q[farther];
  if (own->lie != 0 && own->at >= first && own->at < last && last - first <= own->longest_lie)
    V_q[own->at - first] += own->lie;
  if (own->writes_behind && last < LENGTH) V_q[last - first] = 1;
  if (own->writes_before && first > 0) V_q[-1] = 1;
  return own->answer;
}

static dvi_potential line_potential(line *own)
{
  return (dvi_potential){
      .name = "line", .value = line_value, .gradient_range = line_range, .reach = 2, .user = own};
}

static dvi_status create(const dvi_potential *potential, dvi_system **system)
{
  return dvi_system_create(
      &(dvi_system_terms){
          .dimension = LENGTH, .mass.scalar = 1, .potentials = potential, .potential_count = 1},
      system);
}

static double place_of_site(int i)
{
  return sin(1.0 + 3 * i);
}

/* ---- declaring ---- */

START_TEST(a_bad_reach_is_refused_by_name)
{
  line own = {0};
  dvi_system *system = (dvi_system *)&own;
  dvi_potential p = line_potential(&own);
  p.reach = -1;
  ck_assert_int_eq(create(&p, &system), DVI_BAD_SIZE);
  ck_assert_ptr_null(system);
  check_words("potential 'line' has reach -1; 0 or more is possible");
  p.reach = 1;
  p.gradient_range = NULL;
  ck_assert_int_eq(create(&p, &system), DVI_BAD_ARGUMENT);
  check_words("potential 'line' has reach 1 but no gradient_range callback");
  p = line_potential(&own);
  p.gradient = line_gradient;
  p.gradient_batch = line_gradient_batch;
  ck_assert_int_eq(create(&p, &system), DVI_BAD_ARGUMENT);
  check_words("gradient callback in two shapes");
}
END_TEST

/* Implicit methods ask for batches of points, explicit ones for one. */
START_TEST(a_range_alone_serves_every_method)
{
  static const char *const methods[] = {"galerkin:degree=3", "midpoint", "verlet:blocking=none",
                                        "verlet", "composition:order=4"};
  line own = {0};
  double q[LENGTH], p[LENGTH], end[3][LENGTH];
  for (int i = 0; i < LENGTH; i++) q[i] = place_of_site(i), p[i] = place_of_site(i + 100);
  for (int shape = 0; shape < 3; shape++) {
    dvi_potential potential = line_potential(&own);
    if (shape > 0) potential.gradient_range = NULL, potential.reach = 0;
    if (shape == 1) potential.gradient = line_gradient;
    if (shape == 2) potential.gradient_batch = line_gradient_batch;
    dvi_system *system = NULL;
    ck_assert_int_eq(create(&potential, &system), DVI_OK);
    dvi_integrator *integrator = create_integrator(system, methods[_i]);
    ck_assert_msg(dvi_integrator_start(integrator, 0, q, p) == DVI_OK, "%s", dvi_last_error());
    advance(integrator, 0.05, 20);
    memcpy(end[shape], dvi_integrator_q(integrator), sizeof end[0]);
    dvi_integrator_destroy(&integrator);
    dvi_system_destroy(&system);
  }
  ck_assert_mem_eq(end[0], end[1], sizeof end[0]);
  ck_assert_mem_eq(end[0], end[2], sizeof end[0]);
}
END_TEST

START_TEST(where_waves_are_not_possible_auto_sweeps_plainly_and_says_why)
{
  static const char *const words[] = {"there is no potential", "a potential has no gradient_range",
                                      "the mass is not diagonal"};
  line own = {0};
  int start[LENGTH + 1], row[LENGTH];
  double values[LENGTH];
  char text[1024];
  dvi_potential potential = line_potential(&own);
  dvi_system_terms terms = {
      .dimension = LENGTH, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  dvi_system *system = NULL;
  for (int i = 0; i < LENGTH; i++) row[i] = start[i] = i, values[i] = 1 + i;
  start[LENGTH] = LENGTH;
  if (_i == 0) terms.potentials = NULL, terms.potential_count = 0;
  if (_i == 1)
    potential.gradient = line_gradient, potential.gradient_range = NULL, potential.reach = 0;
  if (_i == 2) terms.mass = (dvi_mass){.values = values, .pattern = {start, row}};
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  dvi_integrator *integrator = create_integrator(system, "verlet"), *wave = integrator;
  (void)dvi_integrator_explain(integrator, text, sizeof text);
  ck_assert_msg(strstr(text, method_spec("blocking: none; %s", words[_i])) != NULL, "%s", text);
  ck_assert_int_eq(dvi_integrator_create(system, "verlet:blocking=temporal", &wave),
                   DVI_UNSUPPORTED);
  ck_assert_ptr_null(wave);
  check_words(words[_i]);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- the check ---- */

static dvi_status checked(const dvi_potential *potential, dvi_derivative_check *found)
{
  double q[LENGTH], v[LENGTH] = {0};
  dvi_system *system = NULL;
  for (int i = 0; i < LENGTH; i++) q[i] = place_of_site(i);
  ck_assert_msg(create(potential, &system) == DVI_OK, "%s", dvi_last_error());
  const dvi_status status = dvi_system_check(system, 0, q, v, 0, found);
  dvi_system_destroy(&system);
  return status;
}

START_TEST(a_true_range_passes)
{
  line own = {0};
  dvi_derivative_check found;
  dvi_potential p = line_potential(&own);
  for (int shape = 0; shape < 3; shape++) {
    p.gradient = shape == 1 ? line_gradient : NULL;
    p.gradient_batch = shape == 2 ? line_gradient_batch : NULL;
    for (p.reach = 2; p.reach < 100; p.reach *= 3) {
      ck_assert_msg(checked(&p, &found) == DVI_OK, "%s", dvi_last_error());
      ck_assert_int_eq(found.range_row, -1);
    }
  }
}
END_TEST

static void found_lie(const dvi_potential *p, int row, const char *words)
{
  dvi_derivative_check found;
  ck_assert_int_eq(checked(p, &found), DVI_BAD_ARGUMENT);
  check_words("potential 'line'");
  check_words(words);
  ck_assert_int_eq(found.range_row, row);
  ck_assert_msg(strstr(found.where, "potential 'line': gradient_range (") != NULL, "%s",
                found.where);
}

START_TEST(a_range_that_looks_beyond_its_reach_is_found)
{
  line own = {.looks_at = 0};
  dvi_potential p = line_potential(&own);
  p.reach = 1; /* the neighbours are two away, so coordinate 0 is the first that has one */
  found_lie(&p, 0, "is the reach 1 too small?");
  p.reach = 2;
  own.looks_at = 3;
  found_lie(&p, 3, "is the reach 2 too small?");
}
END_TEST

START_TEST(a_range_with_other_bits_than_the_whole_is_found)
{
  line own = {.lie = 1e-15, .at = 7, .longest_lie = 1};
  dvi_potential p = line_potential(&own);
  found_lie(&p, 7, "from gradient_range of coordinates 7 to 7");
  own = (line){.lie = 1e-15, .at = 4, .longest_lie = LENGTH};
  p.gradient = line_gradient; /* it has those bits itself, but the whole gradient does not */
  found_lie(&p, 4, "from the whole gradient");
}
END_TEST

START_TEST(a_range_that_writes_before_its_start_is_found)
{
  line own = {.writes_before = 1};
  const dvi_potential p = line_potential(&own);
  found_lie(&p, 1, "gradient_range of coordinates 1 to 1 writes one before them");
}
END_TEST

START_TEST(a_range_that_writes_behind_its_end_is_found)
{
  line own = {.writes_behind = 1};
  const dvi_potential p = line_potential(&own);
  found_lie(&p, 1, "gradient_range of coordinates 0 to 0 writes one more");
}
END_TEST

START_TEST(a_wrong_gradient_is_named_before_its_ranges)
{
  line own = {.lie = 1e-3, .at = 7, .longest_lie = LENGTH};
  dvi_derivative_check found;
  const dvi_potential p = line_potential(&own);
  ck_assert_int_eq(checked(&p, &found), DVI_BAD_ARGUMENT);
  check_words("dV/dq (7)");
  check_words("from differences");
}
END_TEST

START_TEST(a_range_that_fails_ends_the_check_with_its_status)
{
  line own = {.answer = 2};
  dvi_derivative_check found;
  dvi_potential p = line_potential(&own);
  p.gradient = line_gradient;
  ck_assert_int_eq(checked(&p, &found), DVI_CALLBACK_RETRY);
  check_words("the gradient_range callback returned 2");
  own.answer = -2;
  ck_assert_int_eq(checked(&p, &found), DVI_CALLBACK_FAILED);
}
END_TEST

SUITE(range)
{
  tcase_add_test(tests, a_bad_reach_is_refused_by_name);
  tcase_add_loop_test(tests, a_range_alone_serves_every_method, 0, 5);
  tcase_add_loop_test(tests, where_waves_are_not_possible_auto_sweeps_plainly_and_says_why, 0, 3);
  tcase_add_test(tests, a_true_range_passes);
  tcase_add_test(tests, a_range_that_looks_beyond_its_reach_is_found);
  tcase_add_test(tests, a_range_with_other_bits_than_the_whole_is_found);
  tcase_add_test(tests, a_range_that_writes_before_its_start_is_found);
  tcase_add_test(tests, a_range_that_writes_behind_its_end_is_found);
  tcase_add_test(tests, a_wrong_gradient_is_named_before_its_ranges);
  tcase_add_test(tests, a_range_that_fails_ends_the_check_with_its_status);
}
