/* Marches of fields by tents: cuts, files, observables, and fields that they cannot advance. */
#include <dvi/march.h>
#include <dvi/maxwell.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/field/marches.h"
#include "support/files.h"
#include "support/meshes.h"
#include "support/suite.h"

static const char random_tents[] = "tents:least=0.3,seed=11";
static const dvi_wall pec = {.part = "boundary", .kind = DVI_PEC};

static dvi_star *star_over(dvi_mesh *mesh)
{
  dvi_star *star = NULL;
  ck_assert_msg(dvi_star_create(mesh, NULL, &star) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  return star;
}

/* A cavity of conductors, with two probes. */
static dvi_field *make_cavity(int across)
{
  static const dvi_field_probe probes[] = {
      {.name = "ear", .of = "E", .at = {0.4, 0.6}, .along = {1, 0.5}},
      {.name = "part", .of = "energy", .part = "all"}};
  dvi_field *field = NULL;
  dvi_star *star = star_over(staggered_mesh(across, 5));
  const dvi_maxwell_terms terms = {
      .size = sizeof terms, .star = star, .wall = &pec, .walls = 1, .probe = probes, .probes = 2};
  ck_assert_msg(dvi_maxwell_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  return field;
}

static dvi_status create(const dvi_field *field, const char *method, dvi_march **march)
{
  const dvi_march_options options = {.size = sizeof options, .method = method};
  return dvi_march_create(field, &options, march);
}

static dvi_march *make_march(const dvi_field *field, const char *method)
{
  dvi_march *march = NULL;
  ck_assert_msg(create(field, method, &march) == DVI_OK, "%s", dvi_last_error());
  return march;
}

static void start_at_random(dvi_march *march, double t)
{
  const int64_t size = dvi_march_size(march, DVI_FORM_E);
  double *E = calloc((size_t)size, sizeof *E);
  unsigned long long seed = 5;
  for (int64_t i = 0; i < size; i++) E[i] = random_number(&seed) - 0.5;
  const dvi_march_state state = {.size = sizeof state, .t = t, .E = E};
  ck_assert_msg(dvi_march_start(march, &state) == DVI_OK, "%s", dvi_last_error());
  free(E);
}

static void advance(dvi_march *march, double t)
{
  advance_march(march, t);
  ck_assert_double_eq(dvi_march_time(march), t);
}

/* All that a march holds, as the bytes of a file. */
static bytes state_of(const dvi_march *march)
{
  const char *path = path_in_folder("state");
  ck_assert_msg(dvi_march_save(march, path) == DVI_OK, "%s", dvi_last_error());
  return read_bytes(path);
}

static void check_equal(bytes a, bytes b)
{
  ck_assert_uint_eq(a.count, b.count);
  ck_assert_mem_eq(a.at, b.at, a.count);
  free(a.at);
  free(b.at);
}

/* ---- cuts and files ---- */

START_TEST(cuts_and_observations_change_no_bit)
{
  dvi_field *field = make_cavity(6);
  dvi_march *whole = make_march(field, random_tents), *cut = make_march(field, random_tents);
  start_at_random(whole, 0.1);
  start_at_random(cut, 0.1);
  advance(whole, 1.3);
  for (int i = 1; i <= 37; i++) {
    advance(cut, i < 37 ? 0.1 + 1.2 * i / 37 : 1.3);
    ck_assert(observe_march(cut, "energy") > 0);
    (void)observe_march(cut, "ear");
  }
  check_equal(state_of(whole), state_of(cut));
  ck_assert_double_eq(observe_march(whole, "ear"), observe_march(cut, "ear"));
  dvi_march_destroy(&whole);
  dvi_march_destroy(&cut);
  dvi_field_destroy(&field);
}
END_TEST

START_TEST(a_loaded_march_goes_on_with_the_same_bits)
{
  dvi_field *field = make_cavity(6);
  dvi_march *first = make_march(field, random_tents), *second = make_march(field, random_tents);
  start_at_random(first, 0);
  advance(first, 0.7);
  ck_assert_int_eq(dvi_march_save(first, path_in_folder("saved")), DVI_OK);
  ck_assert_msg(dvi_march_load(second, path_in_folder("saved")) == DVI_OK, "%s", dvi_last_error());
  ck_assert_double_eq(dvi_march_time(second), 0.7);
  ck_assert_double_eq(observe_march(second, "energy"), observe_march(first, "energy"));
  advance(first, 2);
  advance(second, 2);
  ck_assert_double_eq(observe_march(second, "gauss"), observe_march(first, "gauss"));
  check_equal(state_of(first), state_of(second));
  dvi_march_destroy(&first);
  dvi_march_destroy(&second);
  dvi_field_destroy(&field);
}
END_TEST

/* Other seeds and other meshes are other marches. */
START_TEST(a_state_of_another_march_is_refused)
{
  dvi_field *field = make_cavity(6), *wide = make_cavity(7);
  dvi_march *first = make_march(field, random_tents),
            *others[] = {make_march(field, "tents"), make_march(wide, random_tents)};
  start_at_random(first, 0);
  advance(first, 0.5);
  ck_assert_int_eq(dvi_march_save(first, path_in_folder("saved")), DVI_OK);
  for (int i = 0; i < 2; i++) {
    start_at_random(others[i], 0.2);
    advance(others[i], 0.4);
    bytes before = state_of(others[i]);
    ck_assert_int_eq(dvi_march_load(others[i], path_in_folder("saved")), DVI_BAD_FILE);
    check_words("tents on another mesh, or of other materials, walls or options");
    check_equal(before, state_of(others[i]));
    dvi_march_destroy(&others[i]);
  }
  dvi_march_destroy(&first);
  dvi_field_destroy(&field);
  dvi_field_destroy(&wide);
}
END_TEST

/* ---- observables ---- */

/* The energy in all cells is that of the field. The charge stays, and the walls hold E = 0. */
START_TEST(a_cavity_shows_its_energy_charge_and_probes)
{
  dvi_field *field = make_cavity(6);
  dvi_march *march = make_march(field, "tents");
  dvi_march_facts facts;
  int64_t count;
  const dvi_star *star = dvi_field_star(field);
  const int *wall = dvi_mesh_part_cells(dvi_star_mesh(star), "boundary", 1, &count);
  double *E = calloc((size_t)count, sizeof *E);
  start_at_random(march, 0);
  const double before = observe_march(march, "energy");
  advance(march, 3);
  ck_assert_double_eq_tol(observe_march(march, "energy") / before, 1, 0.1);
  ck_assert_double_eq_tol(observe_march(march, "part"), observe_march(march, "energy"),
                          1e-13 * before);
  ck_assert_double_le(observe_march(march, "gauss"), 1e-13);
  ck_assert_double_gt(fabs(observe_march(march, "ear")), 1e-6);
  ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_E, count, wall, E), DVI_OK);
  for (int64_t i = 0; i < count; i++) ck_assert_double_eq(E[i], 0);
  dvi_march_facts_of(march, &facts);
  ck_assert_str_eq(facts.method, "tents");
  ck_assert_double_eq(facts.step, 0.5 * facts.bound);
  ck_assert_double_le(facts.step, facts.longest);
  ck_assert_int_ge(facts.steps,
                   (int64_t)(3 / facts.longest) * dvi_mesh_count(dvi_star_mesh(star), 0));
  ck_assert_int_gt(facts.updates, 3 * facts.steps);
  free(E);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}
END_TEST

/* A wave is held at 1 on the left, and at 3 on the right: 1 + 2 x stays at rest, if its other
 * values are those of a start. A start without values has the held ones. */
static int tilt(const double *x, const double *normal, double *datum, void *user)
{
  (void)normal, (void)user;
  *datum = 1 + 2 * x[0];
  return 0;
}

static dvi_field *make_wave(dvi_mesh *mesh, const dvi_wave_terms *more)
{
  static const dvi_condition held = {.part = "boundary", .kind = DVI_FIXED, .datum = tilt};
  dvi_field *field = NULL;
  dvi_star *star = star_over(mesh);
  dvi_wave_terms terms = *more;
  terms.size = sizeof terms;
  terms.star = star;
  terms.condition = terms.condition != NULL ? terms.condition : &held;
  terms.conditions = 1;
  ck_assert_msg(dvi_wave_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  return field;
}

START_TEST(held_values_stay_and_pull)
{
  dvi_field *field = make_wave(staggered_mesh(4, 4), &(dvi_wave_terms){0});
  dvi_march *march = make_march(field, random_tents);
  const int64_t count = dvi_march_size(march, DVI_FORM_A);
  const double *x = dvi_mesh_points(dvi_star_mesh(dvi_field_star(field)));
  double *u = calloc((size_t)count, sizeof *u), *v = calloc((size_t)count, sizeof *v);
  for (int64_t i = 0; i < count; i++) u[i] = 1 + 2 * x[2 * i];
  dvi_march_state state = {.size = sizeof state, .A = u};
  ck_assert_int_eq(dvi_march_start(march, &state), DVI_OK);
  advance(march, 2);
  ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_A, count, NULL, v), DVI_OK);
  for (int64_t i = 0; i < count; i++) ck_assert_double_eq_tol(v[i], u[i], 1e-13);
  state.A = NULL;
  ck_assert_int_eq(dvi_march_start(march, &state), DVI_OK);
  ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_A, count, NULL, v), DVI_OK);
  int64_t free_ones;
  const int *unknown = dvi_field_unknowns(field, &free_ones);
  for (int64_t i = 0; i < free_ones; i++) {
    ck_assert_double_eq(v[unknown[i]], 0);
    v[unknown[i]] = u[unknown[i]];
  }
  ck_assert_mem_eq(u, v, (size_t)count * sizeof *u);
  free(u);
  free(v);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}
END_TEST

/* ---- sources ---- */

static int push(const double *x, double *f, void *user)
{
  (void)x, (void)user;
  *f = 1;
  return 0;
}

/* A free sheet falls: its momentum grows by the force exactly, and each vertex by t^2/2 up to
 * what tents of different times add, with the square of their heights. */
START_TEST(a_source_pushes)
{
  static const dvi_condition open = {.part = "boundary", .kind = DVI_FREE};
  dvi_field *field = make_wave(staggered_mesh(6, 6),
                               &(dvi_wave_terms){.condition = &open, .source = push});
  dvi_march *march = make_march(field, random_tents);
  const int64_t count = dvi_march_size(march, DVI_FORM_A);
  double *u = calloc((size_t)count, sizeof *u), *E = calloc((size_t)count, sizeof *E), momentum = 0;
  const double *mass = NULL;
  dvi_matrix M;
  const dvi_march_state state = {.size = sizeof state};
  ck_assert_int_eq(dvi_star_matrix(dvi_field_star(field), 0, &M), DVI_OK);
  mass = M.value;
  ck_assert_int_eq(dvi_march_start(march, &state), DVI_OK);
  advance(march, 2);
  ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_A, count, NULL, u), DVI_OK);
  ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_E, count, NULL, E), DVI_OK);
  for (int64_t v = 0; v < count; v++) {
    momentum -= mass[v] * E[v];
    ck_assert_double_eq_tol(u[v], 2, 0.005);
  }
  ck_assert_double_eq_tol(momentum, 2, 1e-12);
  ck_assert_double_eq_tol(observe_march(march, "energy"), 0, 0.005);
  free(u);
  free(E);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}
END_TEST

/* A sheet that is held, at rest at first, oscillates about its equilibrium. Its energy without that
 * of the force comes from the force alone. */
START_TEST(a_source_gives_no_alarm)
{
  dvi_field *field = make_wave(staggered_mesh(5, 5), &(dvi_wave_terms){.source = push});
  dvi_march *march = make_march(field, "tents");
  const dvi_march_state state = {.size = sizeof state};
  ck_assert_int_eq(dvi_march_start(march, &state), DVI_OK);
  advance(march, 100);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}
END_TEST

/* ---- growth ---- */

/* With scalar E the tents of the default height are in resonance here, at 0.5 but not at 0.4. */
static dvi_field *make_tm_cavity(void)
{
  const dvi_generator_options options = {.size = sizeof options, .cells = {5, 5}};
  dvi_field *field = NULL;
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate("staggered", &options, &mesh), DVI_OK);
  dvi_star *star = star_over(mesh);
  const dvi_maxwell_terms terms = {
      .size = sizeof terms, .star = star, .wall = &pec, .walls = 1, .scalar = 1};
  ck_assert_msg(dvi_maxwell_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  return field;
}

/* Without an alarm the energy would be 1e9 times that of the start at t = 3000. */
START_TEST(slow_resonances_of_regular_tents_are_noticed)
{
  if (is_short_run()) return;
  dvi_field *field = make_tm_cavity();
  dvi_march *march = make_march(field, "tents");
  start_at_random(march, 0);
  const double start = observe_march(march, "energy");
  ck_assert_int_eq(dvi_march_advance(march, 3000), DVI_STEP_TOO_LARGE);
  check_words("times that of the start, above 2: the tents are in resonance; take a smaller");
  ck_assert_double_lt(dvi_march_time(march), 2000);
  const double growth = observe_march(march, "energy") / start;
  ck_assert(growth > 2 && growth < 2.5);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}
END_TEST

static dvi_march *grow(const dvi_field *field, const char *method)
{
  dvi_march *march = NULL;
  const dvi_march_options options = {.size = sizeof options, .method = method, .fraction = 0.99};
  ck_assert_int_eq(dvi_march_create(field, &options, &march), DVI_OK);
  start_at_random(march, 0.1);
  return march;
}

/* The alarm does not depend on the cuts of a run, and files know of it. */
START_TEST(a_run_that_grows_says_so_and_goes_on)
{
  dvi_field *field = make_cavity(5);
  dvi_march *march = grow(field, "tents:least=0.5,seed=3"),
            *other = grow(field, "tents:least=0.5,seed=3"),
            *wide = grow(field, "tents:band=1e3,least=0.5,seed=3");
  dvi_status status = DVI_OK;
  for (int n = 1; n < 100 && status == DVI_OK; n++) status = dvi_march_advance(march, 1.7 * n);
  ck_assert_int_eq(status, DVI_STEP_TOO_LARGE);
  ck_assert_int_eq(dvi_march_advance(other, 1000), DVI_STEP_TOO_LARGE);
  const double t = dvi_march_time(march);
  ck_assert_double_eq(dvi_march_time(other), t);
  check_equal(state_of(march), state_of(other));
  ck_assert_int_eq(dvi_march_advance(wide, 1000), DVI_STEP_TOO_LARGE);
  check_words("above 1000");
  ck_assert_double_gt(dvi_march_time(wide), t + 5);
  start_at_random(other, 0);
  ck_assert_int_eq(dvi_march_save(march, path_in_folder("saved")), DVI_OK);
  ck_assert_int_eq(dvi_march_load(other, path_in_folder("saved")), DVI_OK);
  advance(other, t + 0.1);
  for (status = DVI_OK; status == DVI_OK || status == DVI_STEP_TOO_LARGE;)
    status = dvi_march_advance(other, 1e6);
  ck_assert_int_eq(status, DVI_NOT_FINITE);
  check_words("the run cannot go on; take a smaller fraction");
  ck_assert(isfinite(observe_march(other, "energy")));
  dvi_march_destroy(&march);
  dvi_march_destroy(&other);
  dvi_march_destroy(&wide);
  dvi_field_destroy(&field);
}
END_TEST

/* ---- refusals ---- */

static int one(double t, double *value, void *user)
{
  (void)t, (void)user;
  *value = 1;
  return 0;
}

static void check_refusal(dvi_field *field, const char *words)
{
  dvi_march *march = NULL;
  ck_assert_int_eq(create(field, "tents", &march), DVI_UNSUPPORTED);
  ck_assert_ptr_null(march);
  check_words(words);
  check_words("take leapfrog or avi");
  dvi_field_destroy(&field);
}

static dvi_field *make_maxwell(dvi_maxwell_terms terms)
{
  dvi_field *field = NULL;
  dvi_star *star = star_over(staggered_mesh(4, 4));
  terms.size = sizeof terms;
  terms.star = star;
  ck_assert_msg(dvi_maxwell_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  return field;
}

START_TEST(currents_and_losses_are_refused)
{
  static const dvi_current dipole = {.at = {0.5, 0.5}, .along = {1, 0}, .signal = one};
  static const dvi_wall open = {.part = "boundary", .kind = DVI_ABSORBING};
  check_refusal(make_maxwell((dvi_maxwell_terms){.current = &dipole, .currents = 1}),
                "the field has currents");
  check_refusal(make_maxwell((dvi_maxwell_terms){.wall = &open, .walls = 1}),
                "conductors or absorbing walls");
}
END_TEST

START_TEST(options_that_tents_have_not_are_refused)
{
  static const char *const bad[] = {"tents:rise=1",      "tents:least=0",       "tents:least=1.5",
                                    "tents:least=0.5x",  "tents:seed=0.5",      "tents:seed=-1",
                                    "tents:least=0.5;",  "tents:seed",          "tents:seed=1e20",
                                    "tents:seed=1,rise", "tents:least=,seed=1", "tents:band=1",
                                    "tents:band=inf",    "tents:band=2x"};
  dvi_field *field = make_cavity(3);
  dvi_march *march = NULL;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ck_assert_msg(create(field, bad[i], &march) == DVI_BAD_OPTION, "%s", bad[i]);
    check_words("is no option: \"least=\" a part above 0 and at most 1, \"seed=\"");
  }
  const dvi_march_options options = {.size = sizeof options, .method = "tents", .step = 0.01};
  ck_assert_int_eq(dvi_march_create(field, &options, &march), DVI_BAD_ARGUMENT);
  check_words("they have no common step, as 0.01 would be: give a fraction");
  ck_assert_ptr_null(march);
  dvi_field_destroy(&field);
}
END_TEST

/* Every allocation of a creation may fail. */
START_TEST(a_creation_without_memory_leaves_nothing)
{
  dvi_field *field = make_cavity(3);
  dvi_march *march = NULL;
  dvi_status status = DVI_NO_MEMORY;
  int failures = 0;
  for (; status == DVI_NO_MEMORY; failures += status == DVI_NO_MEMORY) {
    dvi__fail_allocations_after(failures);
    status = create(field, "tents", &march);
    dvi__fail_allocations_after(-1);
  }
  ck_assert_int_eq(status, DVI_OK);
  ck_assert_int_gt(failures, 30);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}
END_TEST

SUITE(tents_march)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, cuts_and_observations_change_no_bit);
  tcase_add_test(tests, a_loaded_march_goes_on_with_the_same_bits);
  tcase_add_test(tests, a_state_of_another_march_is_refused);
  tcase_add_test(tests, a_cavity_shows_its_energy_charge_and_probes);
  tcase_add_test(tests, held_values_stay_and_pull);
  tcase_add_test(tests, a_source_pushes);
  tcase_add_test(tests, a_source_gives_no_alarm);
  tcase_add_test(tests, slow_resonances_of_regular_tents_are_noticed);
  tcase_add_test(tests, a_run_that_grows_says_so_and_goes_on);
  tcase_add_test(tests, currents_and_losses_are_refused);
  tcase_add_test(tests, options_that_tents_have_not_are_refused);
  tcase_add_test(tests, a_creation_without_memory_leaves_nothing);
}
