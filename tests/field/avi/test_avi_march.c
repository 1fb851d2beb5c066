/* Asynchronous steps of fields, through the march. */
#include <dvi/march.h>
#include <dvi/maxwell.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/field/marches.h"
#include "support/meshes.h"
#include "support/field/steps.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;
static const dvi_wall pec = {.part = "boundary", .kind = DVI_PEC};

static int pulse(double t, double *value, void *user)
{
  (void)user;
  *value = exp(-40 * (t - 1) * (t - 1));
  return 0;
}

/* The exact integral, which is the sum of those over parts. */
static int exact_pulse(double from, double to, double *value, void *user)
{
  const double width = sqrt(40);
  (void)user;
  *value = sqrt(pi) / (2 * width) * (erf(width * (to - 1)) - erf(width * (from - 1)));
  return 0;
}

static const dvi_current dipole = {
    .at = {0.4, 0.45}, .along = {0.6, 0.8}, .signal = pulse, .impulse = exact_pulse};
static const dvi_field_probe ear = {.name = "ear", .of = "E", .at = {0.7, 0.3}, .along = {1, 0}};

static dvi_field *maxwell(dvi_mesh *mesh, dvi_star_kind kind, dvi_maxwell_terms terms)
{
  const dvi_star_options options = {.size = sizeof options, .kind = kind};
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  terms.size = sizeof terms;
  terms.star = star;
  ck_assert_msg(dvi_maxwell_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
  return field;
}

static const dvi_maxwell_terms box = {.wall = &pec, .walls = 1};
static const dvi_maxwell_terms antenna = {
    .wall = &pec, .walls = 1, .current = &dipole, .currents = 1, .probe = &ear, .probes = 1};

static dvi_march *march_of(const dvi_field *field, dvi_march_options options)
{
  dvi_march *march = NULL;
  options.size = sizeof options;
  ck_assert_msg(dvi_march_create(field, &options, &march) == DVI_OK, "%s", dvi_last_error());
  return march;
}

/* Start from random A and E. */
static void start(dvi_march *march)
{
  const int64_t edges = dvi_march_size(march, DVI_FORM_E);
  double *numbers = calloc((size_t)(2 * edges), sizeof *numbers);
  unsigned long long seed = 8;
  for (int64_t e = 0; e < 2 * edges; e++) numbers[e] = random_number(&seed) - 0.5;
  const dvi_march_state state = {.size = sizeof state, .A = numbers, .E = numbers + edges};
  ck_assert_msg(dvi_march_start(march, &state) == DVI_OK, "%s", dvi_last_error());
  free(numbers);
}

static void at_rest(dvi_march *march)
{
  const dvi_march_state state = {.size = sizeof state};
  ck_assert_msg(dvi_march_start(march, &state) == DVI_OK, "%s", dvi_last_error());
}

/* The largest difference of two marches beside the largest value. */
static double distance(const dvi_march *a, const dvi_march *b, dvi_march_form form)
{
  double *of_a = sample_march(a, form), *of_b = sample_march(b, form), worst = 0, largest = 0;
  for (int64_t i = 0; i < dvi_march_size(a, form); i++) {
    worst = fmax(worst, fabs(of_a[i] - of_b[i]));
    largest = fmax(largest, fabs(of_a[i]));
  }
  free(of_a), free(of_b);
  ck_assert_double_gt(largest, 0.01);
  return worst / largest;
}

/* ---- against leapfrog ---- */

/* Make both from the same start, and give the difference of a form after 6 units of time. */
static double from_leapfrog(const dvi_field *field, double step, dvi_march_form form)
{
  dvi_march *avi = march_of(field, (dvi_march_options){.method = "avi", .step = step}),
            *leapfrog = march_of(field, (dvi_march_options){.step = step});
  dvi_march_facts facts;
  dvi_march_facts_of(avi, &facts);
  ck_assert_double_eq_tol(facts.longest, step, 1e-15);
  ck_assert_str_eq(facts.method, "avi");
  start(avi);
  start(leapfrog);
  advance_march(avi, 200 * 0.03);
  advance_march(leapfrog, 200 * 0.03);
  const double found = distance(avi, leapfrog, form);
  dvi_march_destroy(&avi), dvi_march_destroy(&leapfrog);
  return found;
}

/* On equal boxes all cells have one step. Between steps both show values of order 2, which are not
 * the same, so that times of steps are compared. */
START_TEST(equal_boxes_move_as_by_leapfrog)
{
  dvi_field *field = maxwell(grid_mesh("box", 2, 9, 1), DVI_CIRCUMCENTRIC, antenna);
  ck_assert_double_lt(from_leapfrog(field, 0.03, DVI_FORM_E), 1e-13);
  ck_assert_double_lt(from_leapfrog(field, 0.03, DVI_FORM_B), 1e-13);
  dvi_field_destroy(&field);
}
END_TEST

/* Losses are exact in a passage, and of order two in leapfrog. */
START_TEST(open_boxes_move_almost_as_by_leapfrog)
{
  dvi_maxwell_terms terms = antenna;
  const dvi_wall open[] = {{"boundary", DVI_ABSORBING}};
  terms.wall = open;
  dvi_field *field = maxwell(grid_mesh("box", 2, 9, 1), DVI_CIRCUMCENTRIC, terms);
  for (dvi_march_form form = DVI_FORM_E; form <= DVI_FORM_B; form++) {
    const double coarse = from_leapfrog(field, 0.03, form),
                 fine = from_leapfrog(field, 0.0075, form);
    ck_assert_double_lt(fine, 2e-3);
    ck_assert_double_eq_tol(coarse / fine, 16, 2);
  }
  dvi_field_destroy(&field);
}
END_TEST

/* A dipole in a graded box with a conductor, and leapfrog's short steps as the judge. The pulse has
 * frequencies up to 15, and the tenth of the bound of the smallest cells resolves them to 1e-4. */
START_TEST(a_dipole_is_heard_as_by_leapfrog)
{
  dvi_maxwell_terms terms = antenna;
  double conductivity[144];
  for (int c = 0; c < 144; c++) conductivity[c] = c % 3;
  terms.conductivity = conductivity;
  dvi_field *field = maxwell(grid_mesh("box", 2, 12, 1.7), DVI_CIRCUMCENTRIC, terms);
  dvi_march *judge = march_of(field, (dvi_march_options){.fraction = 0.05}),
            *avi[] = {
                march_of(field, (dvi_march_options){.method = "avi", .fraction = 0.4}),
                march_of(field, (dvi_march_options){.method = "avi:classes=no", .fraction = 0.2}),
                march_of(field, (dvi_march_options){.method = "avi", .fraction = 0.1})};
  double worst[3] = {0}, largest = 0;
  at_rest(judge);
  for (int i = 0; i < 3; i++) at_rest(avi[i]);
  for (int n = 1; n <= 60; n++) {
    advance_march(judge, n * 0.05);
    const double exact = observe_march(judge, "ear");
    largest = fmax(largest, fabs(exact));
    for (int i = 0; i < 3; i++) {
      advance_march(avi[i], n * 0.05);
      worst[i] = fmax(worst[i], fabs(observe_march(avi[i], "ear") - exact));
      ck_assert_double_lt(observe_march(avi[i], "gauss"), 1e-13);
      ck_assert_double_lt(observe_march(avi[i], "growth"),
                          1.2); /* work in quadratures of a pulse */
    }
  }
  ck_assert_msg(largest > 0.01 && worst[0] < 0.04 * largest && worst[1] < 0.02 * largest &&
                    worst[2] < 0.1 * worst[0],
                "ear %g, errors %g, %g, %g", largest, worst[0], worst[1], worst[2]);
  for (int i = 0; i < 3; i++) dvi_march_destroy(avi + i);
  dvi_march_destroy(&judge);
  dvi_field_destroy(&field);
}
END_TEST

/* ---- waves ---- */

static int height(const double *x, const double *normal, double *datum, void *user)
{
  (void)normal, (void)user;
  *datum = x[0] * (1 - x[1]);
  return 0;
}

static int weight(const double *x, double *value, void *user)
{
  (void)user;
  *value = 1 + x[1];
  return 0;
}

/* A sheet with values at its rim and a load. */
typedef struct sheet {
  dvi_mesh *mesh;
  dvi_field *field;
  int64_t vertices;
  double *u; /* at rest */
} sheet;

static sheet make_sheet(void)
{
  static const dvi_condition rim = {.part = "boundary", .kind = DVI_FIXED, .datum = height};
  sheet s = {.mesh = grid_mesh("kuhn", 2, 7, 1.6)};
  dvi_star *star = NULL;
  s.vertices = dvi_mesh_count(s.mesh, 0);
  s.u = calloc((size_t)s.vertices, sizeof *s.u);
  ck_assert_int_eq(dvi_star_create(s.mesh, NULL, &star), DVI_OK);
  const dvi_wave_terms terms = {
      .size = sizeof terms, .star = star, .condition = &rim, .conditions = 1, .source = weight};
  ck_assert_msg(dvi_wave_create(&terms, &s.field) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_field_solve(s.field, NULL, s.u, NULL), DVI_OK);
  dvi_star_destroy(&star);
  return s;
}

static void end_sheet(sheet *s)
{
  free(s->u);
  dvi_field_destroy(&s->field);
  dvi_mesh_destroy(&s->mesh);
}

/* How far a sheet at rest moves. */
static double unrest(const sheet *s, const char *method, double fraction)
{
  double worst = 0;
  dvi_march *march = march_of(s->field,
                              (dvi_march_options){.method = method, .fraction = fraction});
  const dvi_march_state state = {.size = sizeof state, .A = s->u};
  ck_assert_int_eq(dvi_march_start(march, &state), DVI_OK);
  for (int n = 1; n <= 40; n++) {
    advance_march(march, 0.137 * n);
    double *moved = sample_march(march, DVI_FORM_A);
    for (int64_t v = 0; v < s->vertices; v++) worst = fmax(worst, fabs(moved[v] - s->u[v]));
    free(moved);
  }
  dvi_march_destroy(&march);
  return worst;
}

/* Leapfrog keeps rest up to rounding. With asynchronous steps the pulls of a cell's faces come one
 * after the other, so that it trembles by the square of the steps. */
START_TEST(a_loaded_sheet_at_rest_stays_there)
{
  sheet s = make_sheet();
  const double coarse = unrest(&s, "avi", 0.2), fine = unrest(&s, "avi", 0.1);
  ck_assert_double_lt(unrest(&s, "leapfrog", 0.2), 1e-13);
  ck_assert_msg(coarse < 1e-3 && fine < coarse / 3, "it moves by %g and %g", coarse, fine);
  end_sheet(&s);
}
END_TEST

START_TEST(a_loaded_sheet_keeps_its_energy)
{
  sheet s = make_sheet();
  dvi_march *march = march_of(s.field, (dvi_march_options){.method = "avi", .fraction = 0.2});
  dvi_march_state state = {.size = sizeof state, .A = s.u};
  ck_assert_int_eq(dvi_march_start(march, &state), DVI_OK);
  const double rest = observe_march(march, "energy");
  at_rest(march);
  const double begin = observe_march(march, "energy");
  ck_assert_double_gt(begin - rest, 0.01);
  for (int n = 1; n < 100; n++) {
    advance_march(march, 0.37 * n);
    ck_assert_double_eq_tol(observe_march(march, "energy"), begin, 0.04 * (begin - rest));
  }
  dvi_march_destroy(&march);
  end_sheet(&s);
}
END_TEST

/* ---- files ---- */

START_TEST(a_saved_march_goes_on_with_the_same_bits)
{
  static const char *const methods[] = {"avi", "avi:classes=no"};
  char path[64];
  (void)snprintf(path, sizeof path, "avi-%d.state", (int)getpid());
  dvi_field *field = maxwell(staggered_mesh(6, 5), DVI_CIRCUMCENTRIC, antenna);
  for (int i = 0; i < 2; i++) {
    const dvi_march_options options = {.method = methods[i], .fraction = 0.3};
    dvi_march *whole = march_of(field, options), *other = march_of(field, options);
    start(whole);
    advance_march(whole, 0.77);
    ck_assert_msg(dvi_march_save(whole, path) == DVI_OK, "%s", dvi_last_error());
    ck_assert_msg(dvi_march_load(other, path) == DVI_OK, "%s", dvi_last_error());
    advance_march(whole, 1.9);
    advance_march(other, 1.9);
    ck_assert(distance(whole, other, DVI_FORM_E) == 0);
    ck_assert(distance(whole, other, DVI_FORM_B) == 0);
    dvi_march *leapfrog = march_of(field, (dvi_march_options){.fraction = 0.3});
    ck_assert_int_eq(dvi_march_load(leapfrog, path), DVI_BAD_FILE);
    dvi_march_destroy(&whole), dvi_march_destroy(&other), dvi_march_destroy(&leapfrog);
  }
  (void)remove(path);
  dvi_field_destroy(&field);
}
END_TEST

/* ---- stability ---- */

START_TEST(fields_are_asked_for_their_stability)
{
  dvi_field *field = maxwell(grid_mesh("box", 2, 10, 2), DVI_CIRCUMCENTRIC, box);
  dvi_stability report;
  ck_assert_msg(dvi_field_stability(field, NULL, 0, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert(report.is_stable && report.growth < 1 + 1e-9 && report.followed == 198);
  const dvi_march_options free_steps = {
      .size = sizeof free_steps, .method = "avi:classes=no", .fraction = 0.8};
  ck_assert_int_eq(dvi_field_stability(field, &free_steps, 100, &report), DVI_OK);
  ck_assert(!report.is_stable && report.growth > 1.1 && report.period == 0);
  const dvi_march_options leapfrog = {.size = sizeof leapfrog, .method = "leapfrog"};
  ck_assert_int_eq(dvi_field_stability(field, &leapfrog, 0, &report), DVI_UNSUPPORTED);
  check_words("ask for avi");
  ck_assert_int_eq(dvi_field_stability(field, NULL, -1, &report), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_field_stability(NULL, NULL, 0, &report), DVI_BAD_ARGUMENT);
  dvi_field_destroy(&field);
}
END_TEST

/* ---- refusals ---- */

static void check_refused(const dvi_field *field, dvi_march_options options, dvi_status status,
                          const char *words)
{
  dvi_march *march = NULL;
  options.size = sizeof options;
  ck_assert_int_eq(dvi_march_create(field, &options, &march), status);
  ck_assert_ptr_null(march);
  check_words(words);
}

START_TEST(bad_options_are_refused_with_a_remedy)
{
  static const char *const bad[] = {"avi:class=no", "avi:classes=", "avi:classes=maybe",
                                    "avi:band=1",   "avi:band=x",   "avi:classes=no,",
                                    "avi:band=2x",  "avi:band=inf"};
  dvi_field *field = maxwell(grid_mesh("box", 2, 4, 2), DVI_CIRCUMCENTRIC, box);
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    check_refused(field, (dvi_march_options){.method = bad[i]}, DVI_BAD_OPTION, "are possible");
  check_refused(field, (dvi_march_options){.method = "avi", .step = 1}, DVI_BAD_ARGUMENT,
                "rectangle 0 (vertices");
  dvi_march *march = march_of(field, (dvi_march_options){.method = "avi:band=1.5,classes=no"});
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
  field = maxwell(staggered_mesh(3, 3), DVI_WHITNEY, box);
  check_refused(field, (dvi_march_options){.method = "avi"}, DVI_UNSUPPORTED, "circumcentric");
  dvi_field_destroy(&field);
}
END_TEST

/* Free steps close to their bounds grow until the march says so. */
START_TEST(growth_is_a_status_and_an_observable)
{
  dvi_field *field = maxwell(grid_mesh("box", 2, 6, 2), DVI_CIRCUMCENTRIC, box);
  dvi_march *march = march_of(
      field, (dvi_march_options){.method = "avi:classes=no,band=1.5", .fraction = 0.97});
  start(march);
  ck_assert_int_eq(dvi_march_advance(march, 1e4), DVI_STEP_TOO_LARGE);
  check_words("resonance");
  ck_assert_double_gt(observe_march(march, "growth"), 1.5);
  ck_assert_double_lt(dvi_march_time(march), 1e4);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}
END_TEST

/* A dipole whose edges are all held does nothing. */
START_TEST(currents_on_conductors_push_nothing)
{
  dvi_current still = dipole;
  const dvi_maxwell_terms terms = {.wall = &pec, .walls = 1, .current = &still, .currents = 1};
  still.along[0] = still.along[1] = 0;
  dvi_field *field = maxwell(grid_mesh("box", 2, 4, 2), DVI_CIRCUMCENTRIC, terms);
  dvi_march *march = march_of(field,
                              (dvi_march_options){.method = _i == 0 ? "avi" : "avi:classes=no"});
  at_rest(march);
  ck_assert_msg(dvi_march_advance(march, 2) == DVI_OK, "%s", dvi_last_error());
  ck_assert_double_eq(observe_march(march, "energy"), 0);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}
END_TEST

/* Squares of D = M_1 E vanish or overflow where E.M_1 E does not. The energy is that of eps = 1
 * times eps, because a step of E is the same in another unit of time. */
START_TEST(energies_of_extreme_materials_are_right)
{
  double eps[16], energy[2];
  const double *factor[3] = {NULL, eps};
  for (int i = 0; i < 2; i++) {
    for (int c = 0; c < 16; c++) eps[c] = i == 0 ? 1 : _i == 0 ? 0x1p-1000 : 0x1p+1000;
    dvi_mesh *mesh = grid_mesh("box", 2, 4, 2);
    const dvi_star_options options = {.size = sizeof options, .factor = factor};
    dvi_star *star = NULL;
    dvi_field *field = NULL;
    ck_assert(dvi_star_create(mesh, &options, &star) == DVI_OK);
    const dvi_maxwell_terms terms = {.size = sizeof terms, .star = star};
    ck_assert(dvi_maxwell_create(&terms, &field) == DVI_OK);
    dvi_march *march = march_of(field, (dvi_march_options){.method = "avi"});
    double *E = zeros(dvi_march_size(march, DVI_FORM_E));
    E[3] = 1;
    const dvi_march_state state = {.size = sizeof state, .E = E};
    ck_assert_msg(dvi_march_start(march, &state) == DVI_OK, "%s", dvi_last_error());
    energy[i] = observe_march(march, "energy");
    free(E);
    dvi_march_destroy(&march);
    dvi_field_destroy(&field);
    dvi_star_destroy(&star);
    dvi_mesh_destroy(&mesh);
  }
  ck_assert_double_gt(energy[0], 0);
  ck_assert_double_eq(energy[1], energy[0] * eps[0]);
}
END_TEST

SUITE(avi_march)
{
  tcase_add_loop_test(tests, currents_on_conductors_push_nothing, 0, 2);
  tcase_add_loop_test(tests, energies_of_extreme_materials_are_right, 0, 2);
  tcase_add_test(tests, equal_boxes_move_as_by_leapfrog);
  tcase_add_test(tests, open_boxes_move_almost_as_by_leapfrog);
  tcase_add_test(tests, a_dipole_is_heard_as_by_leapfrog);
  tcase_add_test(tests, a_loaded_sheet_at_rest_stays_there);
  tcase_add_test(tests, a_loaded_sheet_keeps_its_energy);
  tcase_add_test(tests, a_saved_march_goes_on_with_the_same_bits);
  tcase_add_test(tests, fields_are_asked_for_their_stability);
  tcase_add_test(tests, bad_options_are_refused_with_a_remedy);
  tcase_add_test(tests, growth_is_a_status_and_an_observable);
}
