/* labels: unit */
/* An integrator takes a checkpoint only if it takes the same steps. A refusal names the
 * difference. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/hash.h"
#include "support/files.h"
#include "support/runs.h"
#include "support/spaces.h"
#include "support/paced.h"
#include "support/suite.h"

static void check_taken(const dvi_integrator *from, dvi_integrator *by)
{
  ck_assert_msg(dvi_integrator_save(from, path_in_folder("state")) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_msg(dvi_integrator_restore(by, path_in_folder("state")) == DVI_OK, "%s",
                dvi_last_error());
  const dvi_system *system = dvi_integrator_system(from);
  ck_assert_double_eq(dvi_integrator_time(from), dvi_integrator_time(by));
  ck_assert_mem_eq(dvi_integrator_q(from), dvi_integrator_q(by),
                   (size_t)dvi_system_nq(system) * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(from), dvi_integrator_p(by),
                   (size_t)dvi_system_nv(system) * sizeof(double));
}

static void check_refused(const dvi_integrator *from, dvi_integrator *by, const char *words)
{
  ck_assert_msg(dvi_integrator_save(from, path_in_folder("state")) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_restore(by, path_in_folder("state")), DVI_BAD_FILE);
  check_words(words);
}

/* ---- long specifications, tableaus ---- */

enum { LONG = 1200 };

static const char kutta[] = "order 4\na\na 1/2\na 0 1/2\na 0 0 1\nb 1/6 1/3 1/3 1/6\n";
static const char three_eighths[] = "order 4\na\na 1/3\na -1/3 1\na 1 -1 1\nb 1/8 3/8 3/8 1/8\n";

static void write_text(const char *name, const char *text)
{
  write_bytes(path_in_folder(name), (const unsigned char *)text, strlen(text));
}

/* "shooting:tableau=<path>,<rest>", where the path takes a thousand characters to get to the
 * file. */
static const char *by_a_long_way(const char *name, const char *rest)
{
  static char texts[2][2 * LONG];
  static int next;
  char way[LONG] = "", *text = texts[next++ % 2];
  while (strlen(way) < LONG - 200) strcat(way, "/.");
  (void)snprintf(text, sizeof texts[0], "shooting:tableau=%s%s/%s,%s", path_in_folder("."), way,
                 name, rest);
  return text;
}

START_TEST(a_long_specification_is_kept_whole)
{
  problem *model = create_problem("kepler", NULL);
  write_text("kutta", kutta);
  dvi_integrator *one = start_integrator(model, by_a_long_way("kutta", "type=1")),
                 *same = start_integrator(model, by_a_long_way("kutta", "type=1"));
  dvi_integrator *other = start_integrator(model, by_a_long_way("kutta", "type=2")), *like = NULL;
  advance(one, 0.01, 3);
  advance(other, 0.01, 1);
  ck_assert_uint_gt(strlen(dvi_integrator_method(one)), 1000);
  ck_assert_ptr_nonnull(strstr(dvi_integrator_method(one), ",type=1"));
  check_taken(one, same);
  check_refused(one, other, "type=1 there, type=2 here");
  write_text("same", kutta);
  dvi_integrator *elsewhere = start_integrator(
      model, method_spec("shooting:tableau=%s,type=2", path_in_folder("same")));
  /* and not the path, which may be any */
  check_refused(one, elsewhere, "type=1 there, type=2 here");
  dvi_integrator_destroy(&elsewhere);
  ck_assert_msg(dvi_integrator_create_like(other, &like) == DVI_OK, "%s", dvi_last_error());
  ck_assert_str_eq(dvi_integrator_method(like), dvi_integrator_method(other));
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&same);
  dvi_integrator_destroy(&other);
  dvi_integrator_destroy(&like);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_specification_may_have_any_length)
{
  enum { LENGTH = 1000000 };
  problem *model = create_problem("kepler", NULL);
  char *text = malloc(LENGTH + 1);
  dvi_integrator *integrator = NULL;
  ck_assert_ptr_nonnull(text);
  memset(text, 'x', LENGTH);
  text[LENGTH] = 0;
  memcpy(text, "shooting:tableau=", strlen("shooting:tableau="));
  ck_assert_int_eq(dvi_integrator_create(model->system, text, &integrator), DVI_BAD_OPTION);
  check_words("shooting: xxx"); /* no file has this name, and nothing is said of its length */
  free(text);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_tableau_is_known_by_its_coefficients_not_by_its_path)
{
  problem *model = create_problem("kepler", NULL);
  write_text("one", kutta);
  write_text("other", kutta);
  write_text("third", three_eighths);
  dvi_integrator *one = start_integrator(model,
                                         method_spec("shooting:tableau=%s", path_in_folder("one"))),
                 *other = start_integrator(
                     model, method_spec("shooting:tableau=%s", path_in_folder("other"))),
                 *third = start_integrator(
                     model, method_spec("shooting:tableau=%s", path_in_folder("third")));
  write_text("one", three_eighths);
  dvi_integrator *rewritten = start_integrator(
      model, method_spec("shooting:tableau=%s", path_in_folder("one")));
  advance(one, 0.01, 3);
  check_taken(one, other);
  check_refused(one, third, "other coefficients of the tableau");
  check_refused(one, rewritten, "other coefficients of the tableau");
  check_taken(rewritten, third);
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&other);
  dvi_integrator_destroy(&third);
  dvi_integrator_destroy(&rewritten);
  problem_destroy(&model);
}
END_TEST

/* ---- functions of the program ---- */

/* Before the first step nothing but the functions themselves tells spaces of one name apart. */
START_TEST(a_space_is_known_before_the_first_step)
{
  static const double five = 5, six = 6;
  const dvi_shapes shapes = oscillation(&five), others = oscillation(&six);
  problem *model = create_problem("henon-heiles", NULL);
  const char *method = _i == 0 ? "shaped-galerkin:nodes=6"
                               : "composition:order=4,base=shaped-galerkin,nodes=6";
  dvi_integrator *one = start_integrator_with_shapes(model, &shapes, method),
                 *same = start_integrator_with_shapes(model, &shapes, method),
                 *other = start_integrator_with_shapes(model, &others, method);
  check_taken(one, same);
  check_refused(one, other, "another function space of the same name");
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&same);
  dvi_integrator_destroy(&other);
  problem_destroy(&model);
}
END_TEST

/* A monitor that is 1 + c q.q in both programs, of one name. */
static int g_value(double t, const double *q, double *g, void *user)
{
  (void)t;
  *g = 1 + *(const double *)user * (q[0] * q[0] + q[1] * q[1]);
  return 0;
}

START_TEST(a_monitor_is_known_by_its_values)
{
  double one_c = 0.25, other_c = 0.26;
  problem *model = create_problem("kepler", NULL);
  const dvi_monitor one = {.function = {.name = "mine", .value = g_value, .user = &one_c}},
                    other = {.function = {.name = "mine", .value = g_value, .user = &other_c}};
  dvi_integrator *first = NULL, *same = NULL, *second = NULL;
  dvi_status (*create)(const dvi_system *, const dvi_monitor *, const char *,
                       dvi_integrator **) = _i == 0 ? create_transformed : create_controlled;
  ck_assert_int_eq(create(model->system, &one, "midpoint", &first), DVI_OK);
  ck_assert_int_eq(create(model->system, &one, "midpoint", &same), DVI_OK);
  ck_assert_int_eq(create(model->system, &other, "midpoint", &second), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(first, 0, model->q, model->p), DVI_OK);
  advance(first, 0.01, 3);
  check_taken(first, same);
  check_refused(first, second, "of another monitor");
  dvi_integrator *plain = start_integrator(model, "midpoint");
  check_refused(first, plain,
                _i == 0 ? "of steps in another time, by mine, not of steps of time"
                        : "of steps controlled by mine");
  check_refused(plain, first, "of steps of time, not of steps");
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&same);
  dvi_integrator_destroy(&second);
  dvi_integrator_destroy(&plain);
  problem_destroy(&model);
}
END_TEST

/* ---- parameters ---- */

/* Springs at nine places. */
enum { SPRINGS = 9 };
typedef struct springs {
  double k[SPRINGS], tilt, failing;
} springs;

static int springs_value(double t, const double *q, double *V, void *user)
{
  const springs *s = user;
  (void)t;
  *V = 0;
  for (int i = 0; i < SPRINGS; i++) *V += 0.5 * s->k[i] * q[i] * q[i];
  *V += s->tilt * (q[0] - q[1]);
  return s->failing > 0;
}

static int springs_gradient(double t, const double *q, double *V_q, void *user)
{
  const springs *s = user;
  (void)t;
  for (int i = 0; i < SPRINGS; i++) V_q[i] = s->k[i] * q[i];
  V_q[0] += s->tilt, V_q[1] -= s->tilt;
  return 0;
}

static dvi_system *create_springs(springs *s)
{
  const dvi_potential potential = {
      .name = "springs", .value = springs_value, .gradient = springs_gradient, .user = s};
  const dvi_system_terms terms = {
      .dimension = SPRINGS, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  dvi_system *system = NULL;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static const springs nine = {{1, 2, 3, 4, 5, 6, 7, 8, 9}, 0, 0};

/* All q are 1, so that exchanged springs and forces that differ and balance leave the energy as
 * it is. */
static void check_springs(const springs *changed, const char *words)
{
  const double q[SPRINGS] = {1, 1, 1, 1, 1, 1, 1, 1, 1}, p[SPRINGS] = {0};
  springs one = nine, other = *changed;
  dvi_system *first = create_springs(&one), *second = create_springs(&other);
  dvi_integrator *saved = create_integrator(first, "verlet"),
                 *taker = create_integrator(second, "verlet");
  ck_assert_int_eq(dvi_integrator_start(saved, 0, q, p), DVI_OK);
  check_refused(saved, taker, words);
  dvi_integrator_destroy(&saved);
  dvi_integrator_destroy(&taker);
  dvi_system_destroy(&first);
  dvi_system_destroy(&second);
}

/* The two numbers of "was A, here it is B". */
static void numbers_differ(void)
{
  char was[64], is[64];
  const char *at = strstr(dvi_last_error(), "was ");
  ck_assert_ptr_nonnull(at);
  ck_assert_int_eq(sscanf(at, "was %63[^,], here it is %63s", was, is), 2);
  ck_assert_str_ne(was, is);
}

START_TEST(exchanged_parameters_are_others)
{
  springs exchanged = nine;
  exchanged.k[0] = nine.k[7], exchanged.k[7] = nine.k[0];
  check_springs(&exchanged, "other parameters");
  numbers_differ();
}
END_TEST

START_TEST(a_refusal_shows_the_numbers_that_differ)
{
  springs tilted = nine, softer = nine;
  tilted.tilt = 1e-3;
  check_springs(&tilted, "weighted sum of the forces was");
  numbers_differ();
  softer.k[3] += 4e-7;
  check_springs(&softer, "the Lagrangian was -22.5, here it is -22.5000002");
  numbers_differ();
}
END_TEST

START_TEST(a_system_that_fails_where_the_saved_one_did_not_is_another)
{
  springs failing = nine;
  failing.failing = 1;
  check_springs(&failing, "at its state this one fails");
}
END_TEST

START_TEST(what_a_system_declares_is_named)
{
  problem *kepler = create_problem("kepler", NULL), *henon = create_problem("henon-heiles", NULL);
  problem *light = create_problem("double-pendulum", NULL);
  dvi_integrator *saved = start_integrator(kepler, "midpoint"),
                 *other = start_integrator(henon, "midpoint"),
                 *general = start_integrator(light, "midpoint");
  check_refused(saved, other, "declares other names or speeds of potentials");
  check_refused(saved, general, "declares other terms");
  dvi_integrator_destroy(&saved);
  dvi_integrator_destroy(&other);
  dvi_integrator_destroy(&general);
  problem_destroy(&kepler);
  problem_destroy(&henon);
  problem_destroy(&light);
}
END_TEST

/* ---- every method with every other ---- */

static const struct {
  const char *problem;
  double h;
  const char *methods[20];
} families[] = {
    {"kepler",
     0.02,
     {"verlet",
      "midpoint",
      "trapezoidal",
      "midpoint:solver=newton",
      "galerkin:degree=1",
      "galerkin:degree=2",
      "galerkin:degree=2,basis=legendre",
      "galerkin:degree=2,nodes=3",
      "galerkin:degree=2,quadrature=lobatto",
      "composition",
      "composition:order=6",
      "composition:base=midpoint",
      "sem",
      "sem:degree=2",
      "shooting",
      "shooting:onestep=gauss",
      "shooting:type=2",
      "prolongation-collocation",
      "hp:type=2",
      "hp:type=4,degree=2"}},
    {"fpu",
     0.01,
     {"verlet", "imex", "imex:solver=newton", "respa", "respa:substeps=7", "respa:substeps=exact",
      "mollified", "mollified:filter=projection", "trig", "trig:filter=gautschi", "multiscale",
      "midpoint", "composition:base=imex"}},
    {"vortices",
     0.01,
     {"vprk", "vprk:nodes=3", "dg", "dg:degree=1", "dg:stiffness=1", "dg:stiffness=2", "dg-phase",
      "dg-phase:degree=2"}},
    {"heavy-top",
     0.001,
     {"lie-verlet:solve=exp", "lie-verlet:solve=cayley", "lie-rk", "lie-galerkin",
      "lie-galerkin:degree=1", "composition"}},
};
enum { FAMILIES = sizeof families / sizeof *families };

START_TEST(no_method_takes_the_checkpoint_of_another)
{
  problem *model = create_problem(families[_i].problem, NULL);
  const char *const *methods = families[_i].methods;
  for (int i = 0; i < 20 && methods[i] != NULL; i++) {
    dvi_integrator *saved = start_integrator(model, methods[i]);
    advance(saved, families[_i].h, 3);
    ck_assert_int_eq(dvi_integrator_save(saved, path_in_folder("state")), DVI_OK);
    for (int k = 0; k < 20 && methods[k] != NULL; k++) {
      dvi_integrator *by = start_integrator(model, methods[k]);
      const dvi_status status = dvi_integrator_restore(by, path_in_folder("state"));
      ck_assert_msg(status == (i == k ? DVI_OK : DVI_BAD_FILE), "%s by %s: %s", methods[i],
                    methods[k], dvi_status_name(status));
      if (status != DVI_OK) check_words(" there, ");
      advance(by, families[_i].h, 1);
      dvi_integrator_destroy(&by);
    }
    dvi_integrator_destroy(&saved);
  }
  problem_destroy(&model);
}
END_TEST

/* ---- files that are not whole ---- */

/* Writes a file that differs in one byte, or ends before it. Neither is taken. */
static void check_byte(dvi_integrator *by, bytes file, size_t at, unsigned char damage)
{
  write_bytes(path_in_folder("cut"), file.at, at);
  ck_assert_int_eq(dvi_integrator_restore(by, path_in_folder("cut")), DVI_BAD_FILE);
  file.at[at] ^= damage;
  write_bytes(path_in_folder("flipped"), file.at, file.count);
  ck_assert_int_eq(dvi_integrator_restore(by, path_in_folder("flipped")), DVI_BAD_FILE);
  file.at[at] ^= damage;
}

START_TEST(no_method_takes_what_is_cut_or_damaged_at_any_byte)
{
  static const unsigned char damages[] = {0x01, 0x10, 0x80, 0xff};
  const size_t stride = (size_t)(10 / repeats(10)); /* every tenth where memory is watched */
  problem *model = create_problem(families[_i].problem, NULL);
  for (int k = 0; k < 20 && families[_i].methods[k] != NULL; k++) {
    dvi_integrator *integrator = start_integrator(model, families[_i].methods[k]);
    advance(integrator, families[_i].h, 3);
    const bytes good = read_state(integrator);
    for (size_t at = 0; at < good.count; at += stride)
      check_byte(integrator, good, at, damages[(at + (size_t)k) % 4]);
    check_state(integrator, good);
    dvi_integrator_destroy(&integrator);
  }
  problem_destroy(&model);
}
END_TEST

/* ---- forged files ---- */

/* No checksum protects these numbers. A step from them may fail, but it ends, and DVI_OK goes with
 * finite numbers alone. */
static dvi_status status_of_forged(dvi_integrator *integrator, double h)
{
  dvi_status status = dvi_integrator_restore(integrator, path_in_folder("forged"));
  if (status == DVI_OK) status = dvi_integrator_step(integrator, h);
  for (int i = 0; status == DVI_OK && i < dvi_system_nq(dvi_integrator_system(integrator)); i++)
    ck_assert(isfinite(dvi_integrator_q(integrator)[i]));
  return status;
}

/* Finds the beginning of a section of a file. Its header has 40 bytes, of which the last 8 are its
 * hash and the 8 before them its size (lib/src/march/sections.h). */
static unsigned char *find_section(const bytes *file, const char *name, uint64_t *size)
{
  unsigned char *at = file->at + 16;
  for (;; at += 40 + (*size + 7) / 8 * 8) {
    memcpy(size, at + 24, sizeof *size);
    if (strcmp((const char *)at, name) == 0) return at;
    ck_assert_str_ne((const char *)at, "end");
  }
}

static void forge(bytes *file, unsigned long long draw)
{
  static const double evil[] = {(double)NAN, (double)INFINITY, -1e308, 1e-310, 0, -1,
                                1e9,         4294967297.0};
  uint64_t size;
  unsigned char *section = find_section(file, draw % 2 == 0 ? "state" : "memory", &size);
  if (size == 0) section = find_section(file, "state", &size);
  memcpy(section + 40 + (draw / 2) % (size / 8) * 8, &evil[(draw >> 32) % 8], sizeof(double));
  const uint64_t hash = dvi__hash(dvi__hash(DVI__HASH_START, 32, section), size, section + 40);
  memcpy(section + 32, &hash, sizeof hash);
}

START_TEST(forged_numbers_do_no_harm)
{
  problem *model = create_problem(families[_i].problem, NULL);
  unsigned long long draw = 88172645463325252ULL;
  int gone_on = 0, refused = 0;
  for (int k = 0; k < 20 && families[_i].methods[k] != NULL; k++) {
    dvi_integrator *saved = start_integrator(model, families[_i].methods[k]),
                   *taker = start_integrator(model, families[_i].methods[k]);
    advance(saved, families[_i].h, 3);
    const bytes good = read_state(saved);
    for (int i = 0; i < repeats(60); i++) {
      bytes bad = {malloc(good.count), good.count};
      ck_assert_ptr_nonnull(bad.at);
      memcpy(bad.at, good.at, good.count);
      draw ^= draw << 13, draw ^= draw >> 7, draw ^= draw << 17;
      forge(&bad, draw);
      write_bytes(path_in_folder("forged"), bad.at, bad.count);
      if (status_of_forged(taker, families[_i].h) == DVI_OK)
        gone_on++;
      else
        refused++;
      free(bad.at);
    }
    free(good.at);
    dvi_integrator_destroy(&saved);
    dvi_integrator_destroy(&taker);
  }
  ck_assert_int_gt(gone_on, 0);
  ck_assert_int_gt(refused, 0);
  problem_destroy(&model);
}
END_TEST

SUITE(checkpoint_known)
{
  tcase_set_timeout(tests, 120); /* every file is flushed to the disk, which may be busy */
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, a_long_specification_is_kept_whole);
  tcase_add_test(tests, a_specification_may_have_any_length);
  tcase_add_test(tests, a_tableau_is_known_by_its_coefficients_not_by_its_path);
  tcase_add_loop_test(tests, a_space_is_known_before_the_first_step, 0, 2);
  tcase_add_loop_test(tests, a_monitor_is_known_by_its_values, 0, 2);
  tcase_add_test(tests, exchanged_parameters_are_others);
  tcase_add_test(tests, a_refusal_shows_the_numbers_that_differ);
  tcase_add_test(tests, a_system_that_fails_where_the_saved_one_did_not_is_another);
  tcase_add_test(tests, what_a_system_declares_is_named);
  tcase_add_loop_test(tests, no_method_takes_the_checkpoint_of_another, 0, FAMILIES);
  tcase_add_loop_test(tests, no_method_takes_what_is_cut_or_damaged_at_any_byte, 0, FAMILIES);
  tcase_add_loop_test(tests, forged_numbers_do_no_harm, 0, FAMILIES);
}
