/* labels: unit slow */
/* The same bits for all threads, instruction sets, tiles, cuts of the way, and after a restart; and
 * what is refused. */
#include <dvi/yee.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "num/simd/lanes.h"
#include "support/waves/boxes.h"
#include "support/files.h"
#include "support/suite.h"

/* ---- grids with everything ---- */

static int pulse(double t, double *value, void *user)
{
  (void)user;
  t = (t - 2) / 0.7;
  *value = exp(-t * t / 2);
  return 0;
}

static int swirl(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = x[1] * x[1];
  value[1] = 1 - x[0];
  value[2] = x[0] * x[1];
  return 0;
}

static int ball(const double *x, double *value, void *user)
{
  (void)user;
  const double dx = x[0] - 6, dy = x[1] - 6, dz = x[2] - 6;
  *value = dx * dx + dy * dy + dz * dz < 4 ? 3 : 1;
  return 0;
}

static int plate(const double *x, double *value, void *user)
{
  (void)user;
  *value = x[0] > 5 && x[0] < 7.5 ? 1.5 : 1;
  return 0;
}

static int loss(const double *x, double *value, void *user)
{
  (void)user;
  *value = x[0] > 8 && x[0] < 10.5 && x[1] > 5 && x[1] < 7 ? 0.1 : 0;
  return 0;
}

static const double graded[] = {0, 1, 1.8, 2.5, 3.5, 4.6, 5.5, 6.6, 7.4, 8.4, 9.5, 10.7, 12};

static const dvi_yee_current current = {.density = swirl, .signal = pulse};
static const dvi_yee_dipole dipoles[] = {
    {.at = {6, 5.2, 6.7}, .along = {1, 2, 3}, .signal = pulse, .is_moment = 1},
    {.at = {3.4, 6.5, 5}, .along = {-1, 0, 3}, .signal = pulse}};
static const dvi_yee_wave wave = {.lower = {4, 4, 4},
                                  .upper = {8, 8, 8},
                                  .direction = {1, 1, 1},
                                  .polarization = {1, -1, 0},
                                  .signal = pulse};
static const dvi_yee_wave straight = {.lower = {3.5, 3.5, 3.5},
                                      .upper = {9, 9, 9},
                                      .direction = {-1, 0, 0},
                                      .polarization = {0, 1, 0},
                                      .signal = pulse};
static const dvi_yee_probe probe = {"ear", DVI_FORM_E, .at = {4, 5, 6}, .along = {1, 1, 1}};

enum { KINDS = 12 };

/* Grids of 12^axes boxes: walls, layers, all that repeats itself, absorbing ends, materials,
 * losses, sources, waves, unequal boxes; and on fewer axes. */
static dvi_yee_terms grid(int kind)
{
  static const dvi_yee_end layers = {.kind = DVI_YEE_CPML, .layers = 3, .alpha = 0.1, .kappa = 3};
  static const dvi_yee_boundary ends[KINDS][3] = {
      {DVI_YEE_PEC, DVI_YEE_PMC, DVI_YEE_PEC},
      {DVI_YEE_CPML, DVI_YEE_CPML, DVI_YEE_CPML},
      {DVI_YEE_PERIODIC, DVI_YEE_PERIODIC, DVI_YEE_PERIODIC},
      {DVI_YEE_BLOCH, DVI_YEE_PEC, DVI_YEE_BLOCH},
      {DVI_YEE_ABSORBING, DVI_YEE_ABSORBING, DVI_YEE_PERIODIC},
      {DVI_YEE_PERIODIC, DVI_YEE_PMC, DVI_YEE_CPML},
      {DVI_YEE_PMC, DVI_YEE_CPML, DVI_YEE_PEC},
      {DVI_YEE_CPML, DVI_YEE_PEC, DVI_YEE_PEC},
      {DVI_YEE_PEC, DVI_YEE_PERIODIC, DVI_YEE_PEC},
      {DVI_YEE_CPML, DVI_YEE_PEC, DVI_YEE_PEC},
      {DVI_YEE_ABSORBING, DVI_YEE_ABSORBING, DVI_YEE_ABSORBING},
      {DVI_YEE_CPML, DVI_YEE_ABSORBING, DVI_YEE_BLOCH}};
  dvi_yee_terms terms = {.size = sizeof terms,
                         .axes = kind < 6 || kind >= 10 ? 3
                                 : kind < 9             ? 2
                                                        : 1,
                         .degree = kind <= 6 || kind == 8 || kind >= 10,
                         .probe = &probe,
                         .probes = 1};
  for (int l = 0; l < 3; l++) {
    terms.axis[l] = (dvi_yee_axis){.cells = 12, .upper = 12, .phase = 0.3 + l};
    for (int e = 0; e < 2; e++) {
      terms.axis[l].end[e] = layers;
      terms.axis[l].end[e].kind = ends[kind][l];
    }
  }
  if (kind != 3 && kind != 11) terms.current = &current, terms.currents = 1;
  if (kind != 3 && kind != 11) terms.dipole = dipoles, terms.dipoles = 2;
  if (kind == 0 || kind == 6) terms.axis[0].node = terms.axis[1].node = graded;
  if (kind == 0 || kind == 5 || kind == 7) terms.eps.at = ball, terms.mu.at = plate;
  if (kind == 1) terms.wave = &wave, terms.waves = 1;
  if (kind == 2 || kind >= 10) terms.sigma.at = loss;
  if (kind >= 10) terms.eps.at = ball;
  if (kind == 9) terms.eps.at = plate;
  if (kind == 4) terms.wave = &straight, terms.waves = 1;
  return terms;
}

typedef struct state {
  int64_t count;
  double *values; /* E, B, probe, energy, gauss */
} state;

static state state_of(const dvi_march *march)
{
  const int64_t edges = dvi_march_size(march, DVI_FORM_E),
                faces = dvi_march_size(march, DVI_FORM_B);
  state s = {edges + faces + 3, random_values(edges + faces + 3, 1)};
  ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_E, 0, NULL, s.values), DVI_OK);
  ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_B, 0, NULL, s.values + edges), DVI_OK);
  s.values[edges + faces] = observe_march(march, "ear");
  s.values[edges + faces + 1] = observe_march(march, "energy");
  s.values[edges + faces + 2] = observe_march(march, "gauss");
  return s;
}

static void check_same(state a, state b, const char *what, int number)
{
  ck_assert_int_eq(a.count, b.count);
  ck_assert_msg(memcmp(a.values, b.values, (size_t)a.count * sizeof(double)) == 0, "%s %d differs",
                what, number);
  free(b.values);
}

static void begin(dvi_march *march, const dvi_yee_terms *terms)
{
  const int64_t copies = dvi_march_size(march, DVI_FORM_E) / dvi_yee_size(terms, DVI_FORM_E);
  double *E = random_values(copies * dvi_yee_size(terms, DVI_FORM_E), 5),
         *B = random_values(copies * dvi_yee_size(terms, DVI_FORM_B), 6);
  start_boxes(march, E, B);
  free(E), free(B);
}

static state run(const dvi_yee_terms *terms, double until)
{
  dvi_march *march = box_march(terms);
  begin(march, terms);
  advance_march(march, until);
  const state s = state_of(march);
  dvi_march_destroy(&march);
  return s;
}

/* ---- bits ---- */

static const double until = 12.34;

START_TEST(threads_and_steps_together_change_no_bit)
{
  dvi_yee_terms terms = grid(_i);
  terms.together = 1;
  const state plain = run(&terms, until);
  ck_assert(isfinite(plain.values[plain.count - 2]));
  for (int i = 0; i < 8; i++) {
    if (is_short_run() && i % 3 != 0) continue;
    terms.threads = 1 + i % 3;
    terms.together = i < 2 ? 0 : i < 5 ? 2 * i - 1 : i == 5 ? 1 : 16;
    check_same(plain, run(&terms, until), "threads and steps together",
               100 * terms.threads + terms.together);
  }
  free(plain.values);
}
END_TEST

/* Between steps a sample ends where the next step begins, in layers, on absorbing ends, on the
 * surface of a wave, and with losses (but for a moment there, whose impulses of both halves of a
 * step differ). */
START_TEST(samples_are_continuous_at_whole_steps)
{
  dvi_yee_terms terms = grid(_i);
  dvi_march *march = box_march(&terms);
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  begin(march, &terms);
  advance_march(march, (9 - 1e-9) * facts.step);
  const state before = state_of(march);
  advance_march(march, 9 * facts.step);
  const state at = state_of(march);
  /* all but energy and gauss, which are those of the last step. Currents are up to 144 */
  for (int64_t i = 0; i < at.count - 2; i++)
    ck_assert_double_eq_tol(before.values[i], at.values[i], 1e-6);
  free(before.values), free(at.values);
  dvi_march_destroy(&march);
}
END_TEST

START_TEST(instruction_sets_change_no_bit)
{
  dvi_yee_terms terms = grid(_i);
  dvi__lanes_choose(0);
  const state plain = run(&terms, until);
  for (int level = 1; level < dvi__lanes_levels(); level++) {
    dvi__lanes_choose(level);
    check_same(plain, run(&terms, until), "level", level);
  }
  dvi__lanes_choose(-1);
  free(plain.values);
}
END_TEST

START_TEST(cuts_of_the_way_change_no_bit)
{
  dvi_yee_terms terms = grid(_i);
  terms.together = 5;
  const state plain = run(&terms, until);
  dvi_march *march = box_march(&terms);
  begin(march, &terms);
  for (int i = 1; i <= 50; i++) {
    advance_march(march, i == 50 ? until : until * i / 50);
    (void)observe_march(march, "ear");
    free(sample_march(march, DVI_FORM_E));
  }
  check_same(plain, state_of(march), "cut", 50);
  free(plain.values);
  dvi_march_destroy(&march);
}
END_TEST

START_TEST(restarts_change_no_bit)
{
  dvi_yee_terms terms = grid(_i);
  const state plain = run(&terms, until);
  const char *path = path_in_folder("yee.state");
  dvi_march *first = box_march(&terms), *second = box_march(&terms);
  begin(first, &terms);
  advance_march(first, 4.321);
  ck_assert_int_eq(dvi_march_save(first, path), DVI_OK);
  ck_assert_msg(dvi_march_load(second, path) == DVI_OK, "%s", dvi_last_error());
  ck_assert(dvi_march_time(second) == 4.321);
  advance_march(second, until);
  check_same(plain, state_of(second), "restart", 0);
  /* a start forgets all of it */
  begin(second, &terms);
  advance_march(second, until);
  check_same(plain, state_of(second), "second start", 0);
  free(plain.values);
  dvi_march_destroy(&first);
  dvi_march_destroy(&second);
}
END_TEST

/* Samples at a time that came by a step, a file or a start have the drives of that one. */
START_TEST(samples_forget_what_was_before_a_file_or_a_start)
{
  dvi_yee_terms terms = grid(_i);
  const char *path = path_in_folder("yee.state");
  dvi_march *first = box_march(&terms), *second = box_march(&terms);
  begin(first, &terms), begin(second, &terms);
  const state at_start = state_of(first);
  advance_march(first, 4.321);
  ck_assert_int_eq(dvi_march_save(first, path), DVI_OK);
  const state later = state_of(first);
  free(state_of(second).values);
  ck_assert_int_eq(dvi_march_load(second, path), DVI_OK);
  check_same(later, state_of(second), "a file", 0);
  begin(second, &terms);
  check_same(at_start, state_of(second), "a start", 0);
  free(at_start.values), free(later.values);
  dvi_march_destroy(&first);
  dvi_march_destroy(&second);
}
END_TEST

START_TEST(files_of_other_grids_are_refused)
{
  const char *path = path_in_folder("yee.state");
  dvi_yee_terms terms = grid(5);
  dvi_march *march = box_march(&terms), *other;
  begin(march, &terms);
  advance_march(march, 1);
  ck_assert_int_eq(dvi_march_save(march, path), DVI_OK);
  const state before = state_of(march);
  for (int what = 0; what < 4; what++) {
    dvi_yee_terms changed = terms;
    if (what == 0) changed.axis[0].cells = 11;
    if (what == 1) changed.eps.at = plate;
    if (what == 2) changed.dipoles = 1;
    if (what == 3) changed.fraction = 0.8;
    other = box_march(&changed);
    ck_assert_int_eq(dvi_march_load(other, path), DVI_BAD_FILE);
    check_words("it was saved by another grid");
    dvi_march_destroy(&other);
  }
  check_same(before, state_of(march), "a march", 0);
  free(before.values);
  dvi_march_destroy(&march);
}
END_TEST

/* Between equal boxes a dipole that moves by whole boxes keeps its weights, and its places within
 * rows unless it moves along them. */
START_TEST(files_of_other_places_of_dipoles_are_refused)
{
  const char *path = path_in_folder("yee.state");
  dvi_yee_dipole moved = dipoles[0];
  dvi_yee_terms terms = {.size = sizeof terms, .axes = 3, .degree = 1, .dipole = &moved};
  for (int l = 0; l < 3; l++) terms.axis[l] = (dvi_yee_axis){.cells = 12, .upper = 12};
  terms.dipoles = 1;
  dvi_march *march = box_march(&terms), *other;
  begin(march, &terms);
  ck_assert_int_eq(dvi_march_save(march, path), DVI_OK);
  for (int axis = 0; axis < 3; axis++) {
    moved = dipoles[0];
    moved.at[axis] -= 2;
    other = box_march(&terms);
    ck_assert_int_eq(dvi_march_load(other, path), DVI_BAD_FILE);
    check_words("it was saved by another grid");
    dvi_march_destroy(&other);
  }
  dvi_march_destroy(&march);
}
END_TEST

/* ---- refusals ---- */

static void refuse(const dvi_yee_terms *terms, dvi_status status, const char *words)
{
  dvi_march *march = (dvi_march *)terms;
  const dvi_status found = dvi_yee_create(terms, &march);
  ck_assert_msg(found == status, "%s: %s, %s", words, dvi_status_name(found), dvi_last_error());
  ck_assert_ptr_null(march);
  check_words(words);
}

START_TEST(bad_axes_are_refused)
{
  static const double back[] = {0, 1, 0.5, 2}, bad[] = {0, NAN, 1, 2};
  const dvi_yee_terms good = {
      .size = sizeof good, .axes = 2, .degree = 1, .axis = {{.cells = 3}, {.cells = 3}}};
  dvi_yee_terms terms = good;
  terms.size = 3;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: set terms.size");
  terms = good, terms.axes = 4;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: a grid has 1 to 3 axes, not 4");
  terms = good, terms.axes = 1;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: E has the degree 1 on 1 axes");
  terms = good, terms.axis[1].cells = 0;
  refuse(&terms, DVI_BAD_SIZE, "yee: axis y has 0 boxes");
  terms = good, terms.axis[0].lower = 2;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: axis x reaches from 2 to 0, which is not upwards");
  terms = good, terms.axis[0].node = back;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: nodes of axis x must ascend, and node 2 at 0.5 follows 1");
  terms = good, terms.axis[0].node = bad;
  refuse(&terms, DVI_NOT_FINITE, "yee: node 1 of axis x is");
  terms = good, terms.axis[1].end[0].kind = DVI_YEE_PERIODIC;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: axis y repeats itself at one end only");
  terms = good, terms.axis[1].end[0].kind = (dvi_yee_boundary)17;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: axis y has an end of kind 17");
  terms = good, terms.axis[1].end[0].kind = DVI_YEE_CPML;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: axis y has 3 boxes, and its absorbing layers take 10");
  terms.axis[1].end[0].layers = 2, terms.axis[1].end[0].reflection = 2;
  refuse(&terms, DVI_BAD_ARGUMENT, "0 < reflection < 1");
  terms = good, terms.axis[0].cells = terms.axis[1].cells = 1;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: no edge has an unknown");
  ck_assert_int_eq(dvi_yee_create(&good, NULL), DVI_BAD_ARGUMENT);
}
END_TEST

START_TEST(bad_steps_and_media_are_refused)
{
  const dvi_yee_terms good = {
      .size = sizeof good, .axes = 2, .degree = 1, .axis = {{.cells = 3}, {.cells = 3}}};
  double cell[9] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
  dvi_yee_terms terms = good;
  terms.step = 1;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: the step 1 is not below the bound");
  terms.step = -1;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: step = -1");
  terms = good, terms.fraction = 1;
  refuse(&terms, DVI_BAD_ARGUMENT, "fraction is between 0 and 1");
  terms = good, terms.threads = -1;
  refuse(&terms, DVI_BAD_SIZE, "yee: -1 threads");
  terms = good, terms.eps.cell = cell, cell[4] = -1;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: eps = -1 in the box (1, 1, 0)");
  cell[4] = NAN;
  refuse(&terms, DVI_NOT_FINITE, "in the box (1, 1, 0)");
  terms = good, terms.sigma.cell = cell, cell[4] = -0.5;
  refuse(&terms, DVI_BAD_ARGUMENT,
         "yee: sigma = -0.5 in the box (1, 1, 0), which must be finite and "
         "not negative");
  terms = good, terms.mu.cell = cell, terms.mu.at = ball;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: mu is given by boxes and by a function");
}
END_TEST

START_TEST(bad_sources_and_probes_are_refused)
{
  dvi_yee_dipole source = dipoles[0];
  dvi_yee_wave w = wave;
  dvi_yee_probe p = probe;
  dvi_yee_flux f = {"flux", {1, 1, 1}, {2, 2, 2}};
  dvi_yee_terms good = grid(1), terms;
  good.dipole = &source, good.wave = &w, good.probe = &p;
  terms = good, source.at[1] = 13;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: dipole 0 is at y = 13, outside of the grid from 0 to 12");
  source = dipoles[0], source.signal = NULL;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: dipole 0 needs a signal");
  source = dipoles[0], terms.dipole = NULL;
  refuse(&terms, DVI_BAD_ARGUMENT, "2 dipoles");
  terms = good, terms.dipoles = 1, p.at[2] = NAN;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: probe 0 is at z =");
  p = probe, p.name = NULL;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: probe 0 has no name");
  p = probe, terms.flux = &f, terms.fluxes = 1, f.lower[0] = 3;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: flux flux has its bounds the wrong way round");
  terms.fluxes = 0, w.upper[0] = 14;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: the box of wave 0 is at x = 14");
  w = wave, w.upper[0] = 11;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: wave 0 has its surface in absorbing layers");
  w = wave, w.polarization[1] = 1;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: wave 0 has E along its direction");
  w = wave, terms.eps.at = plate;
  refuse(&terms, DVI_BAD_ARGUMENT, "yee: a wave's box has a material");
}
END_TEST

/* Whichever allocation fails, all memory is released, which the sanitizers see. */
START_TEST(failed_allocations_are_reported)
{
  static const int kinds[] = {1, 3, 4, 6, 7};
  dvi_yee_terms terms = grid(kinds[_i]);
  dvi_march *march = NULL;
  terms.threads = 2;
  for (long successes = 0; march == NULL; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi_yee_create(&terms, &march);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
    if (status != DVI_OK) check_words("no memory");
  }
  begin(march, &terms);
  const long before = dvi__allocation_count();
  advance_march(march, 5);
  ck_assert_int_eq(dvi__allocation_count(), before);
  dvi_march_destroy(&march);
}
END_TEST

SUITE(yee_bits)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, threads_and_steps_together_change_no_bit, 0, KINDS);
  tcase_add_loop_test(tests, samples_are_continuous_at_whole_steps, 0, KINDS);
  tcase_add_loop_test(tests, instruction_sets_change_no_bit, 0, KINDS);
  tcase_add_loop_test(tests, cuts_of_the_way_change_no_bit, 0, KINDS);
  tcase_add_loop_test(tests, restarts_change_no_bit, 0, KINDS);
  tcase_add_loop_test(tests, samples_forget_what_was_before_a_file_or_a_start, 0, KINDS);
  tcase_add_test(tests, files_of_other_grids_are_refused);
  tcase_add_test(tests, files_of_other_places_of_dipoles_are_refused);
  tcase_add_test(tests, bad_axes_are_refused);
  tcase_add_test(tests, bad_steps_and_media_are_refused);
  tcase_add_test(tests, bad_sources_and_probes_are_refused);
  tcase_add_loop_test(tests, failed_allocations_are_reported, 0, 5);
}
