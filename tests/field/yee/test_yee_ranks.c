/* Grids that are divided among processes: every bit of every step is that of one process, for
 * random grids, ends, materials and sources, and so are the step, energies, charges, probes and
 * fluxes. */
#include <dvi/yee.h>
#include <string.h>

#include "core/memory.h"
#include "support/field/ranks.h"
#include "support/shares/box_shares.h"
#include "support/suite.h"
#include "support/waves/boxes.h"

enum { PROCESSES = 6, TRIALS = 18 };

typedef struct processes {
  const box_trial *trial;
  int64_t wrong[PROCESSES];
  char sentence[PROCESSES][256];
} processes;

static void run_rank(const dvi_yee_ranks *ranks, void *user)
{
  processes *p = user;
  p->wrong[ranks->rank] = run_box_share(p->trial, ranks);
  (void)strncpy(p->sentence[ranks->rank], dvi_last_error(), 255);
}

START_TEST(values_have_the_bits_of_one_process)
{
  box_trial *trial = make_box_trial(_i);
  for (int count = 2 + _i % 2; count <= PROCESSES; count *= 2) {
    processes p = {.trial = trial};
    run_box_ranks(count, run_rank, &p);
    for (int r = 0; r < count; r++)
      ck_assert_msg(p.wrong[r] == 0, "process %d of %d: %lld (%s)", r, count, (long long)p.wrong[r],
                    p.sentence[r]);
  }
  free_box_trial(trial);
}
END_TEST

/* ---- refusals ---- */

static int none(int count, double *number, void *user)
{
  (void)count, (void)number, (void)user;
  return 0;
}

static int none_of(int count, int64_t *number, void *user)
{
  (void)count, (void)number, (void)user;
  return 0;
}

/* A pass of which the calls fail from a certain one on. */
static int failing(int to, int from, int64_t count, const double *sent, double *received,
                   void *user)
{
  int *left = user;
  (void)to, (void)from, (void)count, (void)sent, (void)received;
  return --*left < 0 ? 17 : 0;
}

static const dvi_yee_terms small = {
    .size = sizeof small, .axes = 2, .degree = 1, .axis = {{.cells = 3}, {.cells = 5}}};

static void refuse(const dvi_yee_terms *terms, const dvi_yee_ranks *ranks, dvi_status status,
                   const char *words)
{
  dvi_yee_terms divided = *terms;
  dvi_march *march;
  divided.ranks = ranks;
  ck_assert_int_eq(dvi_yee_create(&divided, &march), status);
  ck_assert_ptr_null(march);
  check_words(words);
}

START_TEST(bad_divisions_are_refused)
{
  const dvi_yee_terms line = {.size = sizeof line, .axes = 1, .axis = {{.cells = 9}}};
  const dvi_yee_ranks good = {
      .size = sizeof good, .count = 2, .pass = failing, .sum = none_of, .largest = none};
  dvi_yee_ranks ranks = good;
  ranks.size = 1;
  refuse(&small, &ranks, DVI_BAD_ARGUMENT, "yee: set ranks.size");
  ranks = good, ranks.rank = 2;
  refuse(&small, &ranks, DVI_BAD_ARGUMENT, "yee: there is no process 2 of 2");
  ranks = good, ranks.pass = NULL;
  refuse(&small, &ranks, DVI_BAD_ARGUMENT, "by which processes speak are not all given");
  ranks = good, ranks.parts[1] = -2;
  refuse(&small, &ranks, DVI_BAD_ARGUMENT, "yee: ranks.parts is -2 for axis y; set 0 or more");
  ranks = good, ranks.parts[0] = 2;
  refuse(&small, &ranks, DVI_UNSUPPORTED, "yee: axis x is to have 2 parts, but is not divided");
  ranks = good, ranks.count = 1, ranks.parts[1] = 2;
  refuse(&small, &ranks, DVI_BAD_ARGUMENT, "among 1 processes by 0 x 2 x 0 parts");
  ranks = good, ranks.parts[2] = 2;
  refuse(&small, &ranks, DVI_BAD_ARGUMENT, "by 0 x 0 x 2 parts");
  ranks = good, ranks.parts[1] = 1;
  refuse(&small, &ranks, DVI_BAD_ARGUMENT, "by 0 x 1 x 0 parts, where 0 is any number");
  ranks = good, ranks.count = 3;
  refuse(&small, &ranks, DVI_BAD_ARGUMENT,
         "yee: 3 x 5 x 1 boxes cannot be divided among 3 processes so that each of them "
         "has 2 boxes of y; run fewer processes");
  refuse(&line, &good, DVI_UNSUPPORTED, "yee: a grid of one axis cannot be divided");
}
END_TEST

START_TEST(one_process_needs_no_other)
{
  const dvi_yee_ranks ranks = {
      .size = sizeof ranks, .count = 1, .pass = failing, .sum = none_of, .largest = none};
  dvi_yee_terms terms = small;
  const int first[] = {0, 0}, last[] = {2, 5};
  terms.ranks = &ranks;
  ck_assert_int_eq(dvi_yee_size(&terms, DVI_FORM_E), dvi_yee_size(&small, DVI_FORM_E));
  ck_assert_int_eq(dvi_yee_place(&terms, DVI_FORM_E, 0, first), 0);
  ck_assert_int_eq(dvi_yee_place(&terms, DVI_FORM_E, 0, last), 17);
}
END_TEST

START_TEST(places_are_those_of_the_whole_grid)
{
  dvi_yee_ranks ranks = {
      .size = sizeof ranks, .count = 2, .pass = failing, .sum = none_of, .largest = none};
  dvi_yee_terms terms = small;
  const int below[] = {1, 1}, above[] = {1, 2};
  terms.ranks = &ranks;
  ck_assert_int_eq(dvi_yee_size(&terms, DVI_FORM_E), 2 * 3 + 2 * 4);
  ck_assert_int_eq(dvi_yee_place(&terms, DVI_FORM_E, 1, below), 2 * 3 + 4 + 1);
  ck_assert_int_eq(dvi_yee_place(&terms, DVI_FORM_E, 1, above), -1);
  ranks.rank = 1;
  ck_assert_int_eq(dvi_yee_size(&terms, DVI_FORM_E), 4 * 3 + 3 * 4);
  ck_assert_int_eq(dvi_yee_place(&terms, DVI_FORM_E, 1, below), -1);
  ck_assert_int_eq(dvi_yee_place(&terms, DVI_FORM_E, 1, above), 4 * 3 + 1);
}
END_TEST

/* Give the process, of `count`, that has a box of a grid. */
static int owner_of(const dvi_yee_terms *terms, dvi_yee_ranks *ranks, const int *box)
{
  dvi_yee_terms divided = *terms;
  divided.ranks = ranks;
  for (ranks->rank = 0; ranks->rank < ranks->count; ranks->rank++)
    if (dvi_yee_place(&divided, DVI_FORM_E, 0, box) >= 0) return ranks->rank;
  return -1;
}

/* Check who has the last box of y and the first one of z, and the other way round. */
static void check_division(int rows, int planes, int count, const int *parts, int last_row,
                           int last_plane)
{
  const int across[] = {0, rows - 1, 0}, up[] = {0, 0, planes - 1};
  const dvi_yee_terms terms = {.size = sizeof terms,
                               .axes = 3,
                               .degree = 1,
                               .axis = {{.cells = 1}, {.cells = rows}, {.cells = planes}}};
  dvi_yee_ranks ranks = {
      .size = sizeof ranks, .count = count, .pass = failing, .sum = none_of, .largest = none};
  memcpy(ranks.parts, parts, sizeof ranks.parts);
  ck_assert_int_eq(owner_of(&terms, &ranks, across), last_row);
  ck_assert_int_eq(owner_of(&terms, &ranks, up), last_plane);
}

START_TEST(divisions_are_slabs_until_these_are_thin)
{
  static const int any[3] = {0}, rows[3] = {1, 4, 0}, planes[3] = {0, 0, 8};
  check_division(48, 48, 4, any, 0, 3);
  check_division(48, 47, 4, any, 1, 2);
  check_division(48, 48, 4, rows, 3, 0);
  check_division(48, 48, 16, planes, 1, 14);
  check_division(12, 48, 12, any, 1, 10); /* 2 x 6 */
  check_division(96, 4, 8, any, 7, 0);
  check_division(2, 22, 11, any, 0, 10);
}
END_TEST

/* A march that lost the others says so until it is started again. */
START_TEST(a_failure_to_speak_is_told_until_a_start)
{
  int left = 4;
  const dvi_yee_ranks ranks = {.size = sizeof ranks,
                               .count = 2,
                               .pass = failing,
                               .sum = none_of,
                               .largest = none,
                               .user = &left};
  dvi_yee_terms terms = small;
  double value;
  terms.ranks = &ranks;
  dvi_march *march = box_march(&terms);
  start_boxes(march, NULL, NULL);
  ck_assert_int_eq(dvi_march_advance(march, 1), DVI_CALLBACK_FAILED);
  check_words("yee: process 0 of 2 could not speak with the others: code 17");
  left = 1000;
  ck_assert_int_eq(dvi_march_advance(march, 1), DVI_CALLBACK_FAILED);
  ck_assert_int_eq(dvi_march_observe(march, 0, &value), DVI_CALLBACK_FAILED);
  start_boxes(march, NULL, NULL);
  ck_assert_int_eq(dvi_march_advance(march, 1), DVI_OK);
  dvi_march_destroy(&march);
}
END_TEST

/* ---- several steps together ---- */

/* How often planes go in 8 steps, and in two looks at the energy thereafter. */
typedef struct exchanges {
  int axes, together, passes[PROCESSES], looks[PROCESSES];
} exchanges;

static void count_exchanges(const dvi_yee_ranks *ranks, void *user)
{
  exchanges *e = user;
  watched_ranks watched = {.ranks = ranks};
  const dvi_yee_ranks watching = watch_ranks(&watched);
  dvi_yee_terms terms = small;
  terms.axes = e->axes;
  terms.axis[1].cells = terms.axis[2].cells = 12;
  terms.ranks = &watching;
  terms.together = e->together;
  dvi_march *march = box_march(&terms);
  double energy;
  start_boxes(march, NULL, NULL);
  watched.passes = 0;
  (void)dvi_march_advance(march, 8.2 * step_of_march(march));
  e->passes[ranks->rank] = watched.passes;
  (void)dvi_march_observe(march, 0, &energy);
  (void)dvi_march_observe(march, 0, &energy);
  e->looks[ranks->rank] = watched.passes - e->passes[ranks->rank];
  dvi_march_destroy(&march);
}

static void check_exchanges(int count, int together, int passes, int looks)
{
  exchanges e = {.axes = count == 3 ? 2 : 3, .together = together};
  run_box_ranks(count, count_exchanges, &e);
  for (int r = 0; r < count; r++) {
    ck_assert_int_eq(e.passes[r], passes);
    ck_assert_int_eq(e.looks[r], looks);
  }
}

/* One in both directions of an axis for each block of steps, of which no more go together than
 * there are planes, and one for what is looked at: 3 slabs, and 2 x 2 processes. */
START_TEST(steps_that_go_together_exchange_planes_once)
{
  check_exchanges(3, 1, 2 * 8, 0);
  check_exchanges(3, 2, 2 * 4, 2);
  check_exchanges(3, 4, 2 * 2, 2);
  check_exchanges(3, 16, 2 * 2, 2);
  check_exchanges(4, 1, 4 * 8, 0);
  check_exchanges(4, 4, 4 * 2, 4);
}
END_TEST

/* ---- failures of one process ---- */

/* A signal that fails after t = 2 where it is told so. */
static int moody(double t, double *value, void *user)
{
  const int *fails = user;
  *value = t * t;
  return *fails && t > 2 ? 5 : 0;
}

static dvi_march *driven_march(const dvi_yee_ranks *ranks, int *fails)
{
  const dvi_yee_dipole dipole = {.at = {1.5, 4.2}, .along = {1, 2}, .signal = moody, .user = fails};
  const dvi_yee_wave wave = {.lower = {1, 3},
                             .upper = {2, 5},
                             .direction = {0, 1},
                             .polarization = {1, 0},
                             .signal = moody,
                             .user = fails};
  dvi_yee_terms terms = {.size = sizeof terms,
                         .axes = 2,
                         .degree = 1,
                         .axis = {{.cells = 3, .upper = 3}, {.cells = 8, .upper = 8}},
                         .dipole = &dipole,
                         .dipoles = 1,
                         .wave = &wave,
                         .waves = 1,
                         .together = 2,
                         .ranks = ranks};
  dvi_march *march = NULL;
  if (dvi_yee_create(&terms, &march) == DVI_OK)
    (void)dvi_march_start(march, &(dvi_march_state){.size = sizeof(dvi_march_state)});
  return march;
}

/* What processes tell of a failure of process 1, and the energy after they went on. */
typedef struct moods {
  dvi_status status[PROCESSES];
  char sentence[PROCESSES][256];
  double energy[PROCESSES];
} moods;

static void run_moody(const dvi_yee_ranks *ranks, void *user)
{
  moods *m = user;
  int fails = ranks->rank == 1;
  dvi_march *march = driven_march(ranks, &fails);
  m->status[ranks->rank] = dvi_march_advance(march, 3);
  (void)strncpy(m->sentence[ranks->rank], dvi_last_error(), 255);
  fails = 0;
  (void)dvi_march_advance(march, 3);
  (void)dvi_march_observe(march, 0, &m->energy[ranks->rank]);
  dvi_march_destroy(&march);
}

START_TEST(a_signal_that_fails_on_one_process_loses_nothing)
{
  int fails = 0;
  moods m = {.energy = {0}};
  dvi_march *march = driven_march(NULL, &fails);
  double energy = 0;
  ck_assert_int_eq(dvi_march_advance(march, 3), DVI_OK);
  ck_assert_int_eq(dvi_march_observe(march, 0, &energy), DVI_OK);
  dvi_march_destroy(&march);
  run_box_ranks(3, run_moody, &m);
  for (int r = 0; r < 3; r++) {
    ck_assert_msg(m.status[r] == DVI_CALLBACK_FAILED, "%s", m.sentence[r]);
    ck_assert(m.energy[r] == energy && energy > 0);
    ck_assert_ptr_nonnull(
        strstr(m.sentence[r], r == 1 ? "returned 5" : "another one of 3 processes failed"));
  }
}
END_TEST

/* One process has no memory for its k-th array. */
typedef struct shortage {
  long successes;
  dvi_status status[PROCESSES];
} shortage;

static void run_short(const dvi_yee_ranks *ranks, void *user)
{
  shortage *s = user;
  dvi_yee_terms terms = small;
  dvi_march *march = NULL;
  terms.ranks = ranks;
  if (ranks->rank == s->successes % 2) dvi__fail_allocations_after(s->successes);
  s->status[ranks->rank] = dvi_yee_create(&terms, &march);
  dvi__fail_allocations_after(-1);
  dvi_march_destroy(&march);
}

START_TEST(memory_that_lacks_on_one_process_ends_all)
{
  shortage s = {.status = {DVI_NO_MEMORY}};
  for (s.successes = 0; s.status[0] != DVI_OK; s.successes++) {
    run_box_ranks(2, run_short, &s);
    ck_assert_int_eq(s.status[1], s.status[0]);
    ck_assert(s.status[0] == DVI_OK || s.status[0] == DVI_NO_MEMORY);
  }
  ck_assert(s.successes > 10);
}
END_TEST

SUITE(yee_ranks)
{
  tcase_add_loop_test(tests, values_have_the_bits_of_one_process, 0, TRIALS);
  tcase_add_test(tests, bad_divisions_are_refused);
  tcase_add_test(tests, one_process_needs_no_other);
  tcase_add_test(tests, places_are_those_of_the_whole_grid);
  tcase_add_test(tests, divisions_are_slabs_until_these_are_thin);
  tcase_add_test(tests, a_failure_to_speak_is_told_until_a_start);
  tcase_add_test(tests, steps_that_go_together_exchange_planes_once);
  tcase_add_test(tests, a_signal_that_fails_on_one_process_loses_nothing);
  tcase_add_test(tests, memory_that_lacks_on_one_process_ends_all);
}
