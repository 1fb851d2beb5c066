/* labels: unit */
/* Lattices as marches: the same bits for all cuts of the way and after a restart, words of the
 * method, and what is refused. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/field/marches.h"
#include "support/files.h"
#include "support/suite.h"
#include "support/waves/lattices.h"

static double hump(double t, const double *x, const void *of)
{
  (void)of;
  return 2 * exp(cos(x[0])) + .5 * sin(x[0] + t);
}

enum { KINDS = 6 };

/* Explicit and implicit, linear and not, with and without fixed ends, on one and two axes. */
static lattice kind(int i)
{
  static const double weight[KINDS][2] = {{0, 0},           {1. / 6, 1. / 6},   {.25, .25},
                                          {1. / 6, 1. / 4}, {1. / 12, 1. / 12}, {0, 1. / 6}};
  return (lattice){.axes = 1 + (i == 4),
                   .cells = 15,
                   .space = weight[i][0],
                   .time = weight[i][1],
                   .V = i == 5 ? "quartic" : "sine",
                   .levels = i == 3,
                   .in_one = i % 2,
                   .fixed = i == 2 || i == 4,
                   .step = i == 5 ? .2 : .13};
}

static void check_same(const dvi_march *a, const dvi_march *b)
{
  ck_assert_double_eq(dvi_march_time(a), dvi_march_time(b));
  for (int form = DVI_FORM_A; form <= DVI_FORM_E; form++) {
    const int64_t size = dvi_march_size(a, (dvi_march_form)form);
    double *u = calloc((size_t)(2 * size), sizeof *u);
    ck_assert_int_eq(dvi_march_sample(a, (dvi_march_form)form, 0, NULL, u), DVI_OK);
    ck_assert_int_eq(dvi_march_sample(b, (dvi_march_form)form, 0, NULL, u + size), DVI_OK);
    ck_assert_mem_eq(u, u + size, (size_t)size * sizeof *u);
    free(u);
  }
  for (int i = 0; dvi_march_observable(a, i) != NULL; i++) {
    double x, y;
    ck_assert_int_eq(dvi_march_observe(a, i, &x), DVI_OK);
    ck_assert_int_eq(dvi_march_observe(b, i, &y), DVI_OK);
    ck_assert_double_eq(x, y);
  }
}

static dvi_march *begun(lattice *w)
{
  dvi_march *march = lattice_march(w);
  lattice_start(march, w, hump, NULL);
  return march;
}

/* ---- bits ---- */

START_TEST(cuts_of_the_way_and_observations_change_no_bit)
{
  lattice w = kind(_i);
  dvi_march *a = begun(&w), *b = begun(&w);
  advance_march(a, 4.4);
  for (int i = 1; i < 60; i++) {
    double energy;
    advance_march(b, .07 * i);
    ck_assert_int_eq(dvi_march_observe(b, 0, &energy), DVI_OK);
  }
  advance_march(b, 4.4);
  check_same(a, b);
  dvi_march_destroy(&a);
  dvi_march_destroy(&b);
}
END_TEST

START_TEST(restarts_change_no_bit)
{
  lattice w = kind(_i), other = kind(_i);
  dvi_march *a = begun(&w), *b = lattice_march(&other);
  const char *path = path_in_folder("lattice.state");
  advance_march(a, 2.1);
  ck_assert_int_eq(dvi_march_save(a, path), DVI_OK);
  ck_assert_int_eq(dvi_march_load(b, path), DVI_OK);
  check_same(a, b);
  advance_march(a, 5);
  advance_march(b, 5);
  check_same(a, b);
  dvi_march_destroy(&a);
  dvi_march_destroy(&b);
}
END_TEST

START_TEST(a_start_forgets_what_was_before)
{
  lattice w = kind(_i);
  dvi_march *a = begun(&w), *b = begun(&w);
  advance_march(b, 3);
  lattice_start(b, &w, hump, NULL);
  advance_march(a, 3);
  advance_march(b, 3);
  check_same(a, b);
  dvi_march_destroy(&a);
  dvi_march_destroy(&b);
}
END_TEST

/* A level has one value whether it is reached from below, where the parabola ends there, or not. */
START_TEST(samples_are_continuous_at_levels)
{
  lattice w = kind(_i);
  dvi_march *a = begun(&w), *b = begun(&w);
  double below, at;
  advance_march(a, 8 * w.step * (1 - 1e-12));
  advance_march(b, 8 * w.step);
  const int cell = 4;
  ck_assert_int_eq(dvi_march_sample(a, DVI_FORM_A, 1, &cell, &below), DVI_OK);
  ck_assert_int_eq(dvi_march_sample(b, DVI_FORM_A, 1, &cell, &at), DVI_OK);
  ck_assert_double_eq_tol(below, at, 1e-10);
  dvi_march_destroy(&a);
  dvi_march_destroy(&b);
}
END_TEST

START_TEST(damaged_files_and_those_of_others_are_refused)
{
  lattice w = kind(1), other = kind(1);
  dvi_march *a = begun(&w), *b = begun(&other);
  const char *path = path_in_folder("lattice.state");
  advance_march(a, 1);
  ck_assert_int_eq(dvi_march_save(a, path), DVI_OK);
  const bytes whole = read_bytes(path);
  for (size_t count = 0; count < whole.count; count += 97) {
    write_bytes(path, whole.at, count);
    ck_assert_int_eq(dvi_march_load(b, path), DVI_BAD_FILE);
  }
  write_bytes(path, whole.at, whole.count);
  free(whole.at);
  dvi_march *fresh = begun(&other);
  check_same(b, fresh);
  dvi_march_destroy(&b);
  other.V = "quartic";
  b = lattice_march(&other);
  ck_assert_int_eq(dvi_march_load(b, path), DVI_BAD_FILE);
  check_words("another lattice or density");
  dvi_march_destroy(&a);
  dvi_march_destroy(&b);
  dvi_march_destroy(&fresh);
}
END_TEST

/* ---- words ---- */

START_TEST(methods_are_read_with_their_weights)
{
  dvi_multisymplectic_weights w;
  ck_assert_int_eq(dvi_multisymplectic_parse("multisymplectic", &w), DVI_OK);
  ck_assert(w.space[0] == 0 && w.time == 0 && w.levels == 0);
  ck_assert_int_eq(dvi_multisymplectic_parse("multisymplectic:space=1/6,time=midpoint", &w),
                   DVI_OK);
  ck_assert(w.space[0] == 1. / 6 && w.space[2] == 1. / 6 && w.time == .25);
  ck_assert_int_eq(
      dvi_multisymplectic_parse("multisymplectic:time=fourth,potential=levels,space=.2", &w),
      DVI_OK);
  ck_assert(w.space[1] == .2 && w.time == 1. / 12 && w.levels == 1);
  ck_assert_int_eq(dvi_multisymplectic_parse("multisymplectic:space=1/6:fourth,time=0", &w),
                   DVI_OK);
  ck_assert(w.space[0] == 1. / 6 && w.space[1] == 1. / 12 && w.axes == 2);
  ck_assert_int_eq(dvi_multisymplectic_parse("multisymplectic:space=0:.1:.2", &w), DVI_OK);
  ck_assert(w.space[0] == 0 && w.space[1] == .1 && w.space[2] == .2 && w.axes == 3);
  static const char *const bad[] = {"multisymplectic:space=0:0:0:0",
                                    "multisymplectic:space=0:",
                                    "multisymplectic:time=0:0",
                                    "multisymplectic:space=1/3",
                                    "multisymplectic:space=1/",
                                    "multisymplectic:space=-.1",
                                    "multisymplectic:time=nan",
                                    "multisymplectic:time=",
                                    "multisymplectic:time=1/0",
                                    "multisymplectic:time=1/4x",
                                    "multisymplectic:mass=1",
                                    "multisymplectic2",
                                    "verlet"};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    ck_assert_int_eq(dvi_multisymplectic_parse(bad[i], &w), DVI_BAD_OPTION);
  ck_assert(w.space[2] == .2);
  ck_assert_int_eq(dvi_multisymplectic_parse(NULL, &w), DVI_BAD_ARGUMENT);
}
END_TEST

/* ---- what is refused ---- */

static void refuse(const dvi_multisymplectic_terms *terms, dvi_status expected, const char *words)
{
  dvi_march *march = NULL;
  const dvi_status status = dvi_multisymplectic_create(terms, &march);
  ck_assert_msg(status == expected, "%s: %s", dvi_status_name(status), dvi_last_error());
  ck_assert_ptr_null(march);
  check_words(words);
}

START_TEST(bad_axes_and_weights_are_refused)
{
  lattice w = {.step = .1};
  refuse(NULL, DVI_BAD_ARGUMENT, "terms are needed");
  lattice_terms(&w), w.terms.size = 3;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "set terms.size");
  lattice_terms(&w), w.terms.axes = 4;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "4 axes");
  lattice_terms(&w), w.terms.components = 0;
  refuse(&w.terms, DVI_BAD_SIZE, "0 components");
  lattice_terms(&w), w.terms.cells[0] = 1;
  refuse(&w.terms, DVI_BAD_SIZE, "1 cells");
  lattice_terms(&w), w.axis[0].to = (double)NAN;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "from 0 to nan");
  lattice_terms(&w), w.axis[0].to = 0;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "from 0 to 0");
  const double node[] = {0, 2, 1, 3};
  lattice_terms(&w), w.axis[0].node = node, w.axis[0].nodes = 4, w.axis[0].to = 3;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "they ascend");
  lattice_terms(&w), w.terms.weights.space[0] = .3;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "the weight of x is 0.3");
  lattice_terms(&w), w.terms.weights.axes = 2;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "weights of 2 axes, and the field has 1");
  lattice_terms(&w), w.terms.weights.time = (double)NAN;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "the weight of time is nan");
  w.axes = 3, lattice_terms(&w), w.terms.cells[0] = w.terms.cells[1] = w.terms.cells[2] = 10000000;
  refuse(&w.terms, DVI_BAD_SIZE, "too many vertices");
  ck_assert_int_eq(dvi_multisymplectic_vertices(&w.terms, NULL), 0);
  ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, NULL), DVI_BAD_ARGUMENT);
}
END_TEST

START_TEST(bad_steps_are_refused)
{
  static const double bad[] = {-1, (double)NAN, (double)INFINITY};
  lattice w = {.time = .25};
  for (int i = 0; i < 3; i++) {
    lattice_terms(&w), w.terms.step = bad[i];
    refuse(&w.terms, DVI_BAD_ARGUMENT, "steps and spans are positive");
  }
  lattice_terms(&w), w.terms.step = 0;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "nothing is known that bounds the step");
  w.time = 0, lattice_terms(&w), w.terms.step = 0, w.terms.fraction = 1.5;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "fraction = 1.5");
  w.terms.fraction = 0, w.terms.span = 1;
  dvi_march *march = NULL;
  ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  ck_assert_double_eq_tol(facts.step, 1.0 / 7, 1e-15); /* below pi/20 */
  dvi_march_destroy(&march);
}
END_TEST

START_TEST(bad_densities_are_refused)
{
  static const int wrong[][2] = {{0, 1}};
  static const dvi_jet second = {.order = {2, 0, 0}}, other = {.component = 1, .rate = 1};
  lattice w = {.step = .1, .V = "sine"};
  lattice_terms(&w), w.terms.parts = 0;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "no parts");
  lattice_terms(&w), w.part[0].density = NULL;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "has no density");
  lattice_terms(&w), w.part[0].kind = DVI_DENSITY_ONE_FORM;
  refuse(&w.terms, DVI_UNSUPPORTED, "one-form");
  lattice_terms(&w), w.part[1].kind = DVI_DENSITY_KINETIC;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "is no rate");
  lattice_terms(&w), w.part[0].kind = DVI_DENSITY_POTENTIAL;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "is a rate");
  lattice_terms(&w), w.part[1].variable = &second;
  refuse(&w.terms, DVI_UNSUPPORTED, "no first derivative");
  lattice_terms(&w), w.part[0].variable = &other;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "of component 1 of 1");
  lattice_terms(&w), w.part[1].pair = wrong, w.part[1].pairs = 1;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "pair (0, 1)");
  lattice_terms(&w), w.terms.part = w.part + 1, w.terms.parts = 2;
  refuse(&w.terms, DVI_SINGULAR, "each component needs a kinetic part");
}
END_TEST

START_TEST(bad_conditions_and_symmetries_are_refused)
{
  static const dvi_multisymplectic_symmetry nameless = {.name = NULL};
  lattice w = {.step = .1, .fixed = 1};
  lattice_terms(&w), w.condition.part = "front";
  refuse(&w.terms, DVI_BAD_ARGUMENT, "no part \"front\"");
  lattice_terms(&w), w.condition.component = 1;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "component 1");
  lattice_terms(&w), w.condition.kind = DVI_FREE, w.condition.robin = (double)NAN;
  refuse(&w.terms, DVI_NOT_FINITE, "robin = nan");
  w.cells = 2, lattice_terms(&w);
  w.terms.condition = (dvi_density_condition[]){w.condition, w.condition};
  w.terms.conditions = -1;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "-1 conditions");
  lattice_terms(&w), w.terms.symmetry = &nameless, w.terms.symmetries = 1;
  refuse(&w.terms, DVI_BAD_ARGUMENT, "symmetry 0 has no name");
}
END_TEST

/* A potential that fails, or is defined for positive values alone. */
static int failing_potential(int count, double t, const double *x, const double *z, double *l,
                             double *l_z, double *l_zz, void *user)
{
  const int result = *(int *)user;
  (void)t, (void)x;
  for (int i = 0; i < count; i++) {
    if (result < 0 || (result > 0 && !(z[i] > 0))) return result;
    if (l) l[i] = log(z[i]);
    if (l_z) l_z[i] = 1 / z[i];
    if (l_zz) l_zz[i] = -1 / (z[i] * z[i]);
  }
  return 0;
}

/* Values where a density is not defined are none of a failure. */
START_TEST(densities_that_fail_are_refused_at_create)
{
  int result = -7;
  lattice w = {.step = .1, .V = "sine"};
  lattice_terms(&w), w.part[2].density = failing_potential, w.part[2].user = &result;
  refuse(&w.terms, DVI_CALLBACK_FAILED, "the density potential failed with -7 at t = 0");
  for (result = 0; result < 2; result++) {
    dvi_march *march = NULL;
    ck_assert_msg(dvi_multisymplectic_create(&w.terms, &march) == DVI_OK, "%s", dvi_last_error());
    dvi_march_destroy(&march);
  }
}
END_TEST

/* A wall, or a density, that fails from some time on. */
static int failing_wall(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)x;
  for (int64_t i = 0; i < count; i++) datum[i] = t > 1 && *(int *)user == 0 ? (double)NAN : t;
  return t > 1 ? *(int *)user : 0;
}

static int failing_wall_rate(int64_t count, double t, const double *x, double *rate, double *second,
                             void *user)
{
  (void)t, (void)x, (void)second, (void)user;
  for (int64_t i = 0; i < count; i++) rate[i] = 1;
  return 0;
}

START_TEST(failures_of_callbacks_leave_a_good_state)
{
  static const dvi_status expected[] = {DVI_CALLBACK_FAILED, DVI_NOT_FINITE, DVI_CALLBACK_RETRY};
  int result = _i - 1;
  lattice w = {.step = .1, .fixed = 1};
  lattice_terms(&w);
  w.condition.datum = failing_wall;
  w.condition.rate = failing_wall_rate;
  w.condition.user = &result;
  dvi_march *march = NULL;
  ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
  lattice_start(march, &w, hump, NULL);
  ck_assert_int_eq(dvi_march_advance(march, 3), expected[_i]);
  ck_assert_double_gt(dvi_march_time(march), .7);
  ck_assert_double_lt(dvi_march_time(march), 1);
  double u[21], again[21];
  ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_A, 0, NULL, u), DVI_OK);
  for (int i = 0; i < 21; i++) ck_assert(isfinite(u[i]));
  ck_assert_int_eq(dvi_march_advance(march, 3), expected[_i]);
  ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_A, 0, NULL, again), DVI_OK);
  ck_assert_mem_eq(u, again, sizeof u);
  dvi_march_destroy(&march);
}
END_TEST

/* A density, one call of which fails. */
typedef struct failing_density {
  dvi_density_part good;
  int calls, fails;
} failing_density;

static int fail_once(int count, double t, const double *x, const double *z, double *l, double *l_z,
                     double *l_zz, void *user)
{
  failing_density *of = user;
  return ++of->calls == of->fails ? 1
                                  : of->good.density(count, t, x, z, l, l_z, l_zz, of->good.user);
}

/* Steps that fail may have computed their matrix anew before. */
START_TEST(failed_steps_change_no_bit_of_later_ones)
{
  lattice a = kind(2);
  a.V = "quartic";
  a.step = .2;
  lattice b = a;
  dvi_march *clean = lattice_march(&a), *march = NULL;
  const dvi_multisymplectic_terms *terms = lattice_terms(&b);
  failing_density of = {.good = b.part[terms->parts - 1]};
  b.part[terms->parts - 1].density = fail_once;
  b.part[terms->parts - 1].user = &of;
  ck_assert_int_eq(dvi_multisymplectic_create(terms, &march), DVI_OK);
  lattice_start(clean, &a, hump, NULL);
  lattice_start(march, &b, hump, NULL);
  for (int failures = 0, i = 1; i <= 60; i++) {
    of.calls = 0;
    of.fails = i;
    if (dvi_march_advance(march, i * a.step) != DVI_OK) failures++;
    of.fails = 0;
    advance_march(march, i * a.step);
    advance_march(clean, i * a.step);
    check_same(clean, march);
    ck_assert(i < 60 || failures > 5);
  }
  dvi_march_destroy(&clean);
  dvi_march_destroy(&march);
}
END_TEST

static double slow_hump(double t, const double *x, const void *of)
{
  return .1 * hump(t, x, of);
}

START_TEST(starts_beyond_the_density_leave_the_state)
{
  lattice w = {.step = .1, .cells = 21, .space = 1. / 6, .time = 1. / 6};
  lattice_terms(&w);
  w.terms.part = &lattice_strings;
  w.terms.parts = 1;
  dvi_march *march = NULL, *same = NULL;
  ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &march), DVI_OK);
  ck_assert_int_eq(dvi_multisymplectic_create(&w.terms, &same), DVI_OK);
  lattice_start(march, &w, slow_hump, NULL);
  lattice_start(same, &w, slow_hump, NULL);
  double fast[21];
  for (int i = 0; i < 21; i++) fast[i] = 2;
  const dvi_march_state start = {.size = sizeof start, .E = fast};
  ck_assert_int_eq(dvi_march_start(march, &start), DVI_CALLBACK_RETRY);
  advance_march(march, 1);
  advance_march(same, 1);
  check_same(march, same);
  const dvi_march_state with_B = {.size = sizeof start, .B = fast};
  ck_assert_int_eq(dvi_march_start(march, &with_B), DVI_BAD_ARGUMENT);
  dvi_march_destroy(&march);
  dvi_march_destroy(&same);
}
END_TEST

START_TEST(failed_allocations_are_reported)
{
  lattice w = kind(_i);
  lattice_terms(&w);
  dvi_march *march = NULL;
  dvi_status status = DVI_NO_MEMORY;
  for (long successes = 0; status == DVI_NO_MEMORY; successes++) {
    dvi__fail_allocations_after(successes);
    status = dvi_multisymplectic_create(&w.terms, &march);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
    if (status != DVI_OK) check_words("no memory");
  }
  lattice_start(march, &w, hump, NULL);
  advance_march(march, 1);
  const long before = dvi__allocation_count();
  advance_march(march, 5);
  ck_assert_int_eq(dvi__allocation_count(), before);
  dvi_march_destroy(&march);
  dvi_law law[DVI_LAWS_MAX];
  int count;
  status = DVI_NO_MEMORY;
  for (long successes = 0; status == DVI_NO_MEMORY; successes++) {
    dvi__fail_allocations_after(successes);
    status = dvi_multisymplectic_laws(&w.terms, NULL, 3, 1, law, &count);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
  }
}
END_TEST

SUITE(lattice_marches)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, cuts_of_the_way_and_observations_change_no_bit, 0, KINDS);
  tcase_add_loop_test(tests, restarts_change_no_bit, 0, KINDS);
  tcase_add_loop_test(tests, a_start_forgets_what_was_before, 0, KINDS);
  tcase_add_loop_test(tests, samples_are_continuous_at_levels, 0, KINDS);
  tcase_add_test(tests, damaged_files_and_those_of_others_are_refused);
  tcase_add_test(tests, methods_are_read_with_their_weights);
  tcase_add_test(tests, bad_axes_and_weights_are_refused);
  tcase_add_test(tests, bad_steps_are_refused);
  tcase_add_test(tests, bad_densities_are_refused);
  tcase_add_test(tests, bad_conditions_and_symmetries_are_refused);
  tcase_add_test(tests, densities_that_fail_are_refused_at_create);
  tcase_add_loop_test(tests, failures_of_callbacks_leave_a_good_state, 0, 3);
  tcase_add_test(tests, failed_steps_change_no_bit_of_later_ones);
  tcase_add_test(tests, starts_beyond_the_density_leave_the_state);
  tcase_add_loop_test(tests, failed_allocations_are_reported, 0, KINDS);
}
