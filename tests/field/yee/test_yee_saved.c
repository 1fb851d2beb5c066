/* States of grids that processes divide: the file of one process, which any number of them
 * loads. */
#include <dvi/yee.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/field/ranks.h"
#include "support/suite.h"
#include "support/waves/boxes.h"

static int ring(double t, double *value, void *user)
{
  (void)user;
  *value = sin(t + 1);
  return 0;
}

/* -0 in most places. */
static int spot(const double *x, double *value, void *user)
{
  (void)user;
  for (int l = 0; l < 3; l++) value[l] = x[2] > 4 && x[2] < 7 ? x[l] - 2 : -0.0;
  return 0;
}

/* Boxes with losses, layers that reach over several processes, a dipole and a charge. */
static dvi_march *march_of(const dvi_yee_ranks *ranks, double conductivity)
{
  static const dvi_yee_dipole dipole = {.at = {2, 1.5, 5}, .along = {1, 2, 3}, .signal = ring};
  double sigma[3 * 4 * 11];
  for (int i = 0; i < 3 * 4 * 11; i++) sigma[i] = conductivity * (i % 3);
  const dvi_yee_end layers = {.kind = DVI_YEE_CPML, .layers = 3},
                    open = {.kind = DVI_YEE_ABSORBING};
  const dvi_yee_terms terms = {.size = sizeof terms,
                               .axes = 3,
                               .degree = 1,
                               .axis = {{.cells = 3, .upper = 3, .end = {open, open}},
                                        {.cells = 4, .upper = 4},
                                        {.cells = 11, .upper = 11, .end = {layers, layers}}},
                               .sigma.cell = sigma,
                               .together = 3,
                               .dipole = &dipole,
                               .dipoles = 1,
                               .ranks = ranks};
  dvi_march *march = NULL;
  (void)dvi_yee_create(&terms, &march);
  double *E = malloc((size_t)dvi_yee_size(&terms, DVI_FORM_E) * sizeof *E);
  const dvi_march_state start = {.size = sizeof start, .E = E};
  if (dvi_yee_integrate(&terms, DVI_FORM_E, spot, NULL, E) == DVI_OK)
    (void)dvi_march_start(march, &start);
  free(E);
  return march;
}

static state_trial try_whole(void)
{
  state_trial t = {.path = ""};
  dvi_march *march = march_of(NULL, 0.2);
  ck_assert_int_eq(dvi_march_advance(march, 2), DVI_OK);
  t.saved = save_march(march, &t.size);
  ck_assert_int_eq(dvi_march_advance(march, 5), DVI_OK);
  t.later = save_march(march, &t.size);
  dvi_march_destroy(&march);
  (void)snprintf(t.path, sizeof t.path, "yee-%ld.state", (long)getpid());
  return t;
}

static void check_all(const state_trial *t, int count, dvi_status status)
{
  for (int r = 0; r < count; r++) {
    ck_assert_int_eq(t->status[r], status);
    ck_assert_int_eq(t->same[r], 1);
  }
}

/* ---- states go from one division to another ---- */

static void save_part(const dvi_yee_ranks *ranks, void *user)
{
  state_trial *t = user;
  dvi_march *march = march_of(ranks, 0.2);
  (void)dvi_march_advance(march, 2);
  t->status[ranks->rank] = dvi_march_save(march, t->path);
  t->same[ranks->rank] = march_has_bytes(march, t->saved, t->size);
  dvi_march_destroy(&march);
}

static void load_part(const dvi_yee_ranks *ranks, void *user)
{
  state_trial *t = user;
  dvi_march *march = march_of(ranks, 0.2);
  t->status[ranks->rank] = dvi_march_load(march, t->path);
  (void)dvi_march_advance(march, 5);
  t->same[ranks->rank] = march_has_bytes(march, t->later, t->size);
  dvi_march_destroy(&march);
}

START_TEST(a_file_of_several_processes_is_that_of_one)
{
  state_trial t = try_whole();
  for (int count = 1; count <= STATE_TRIAL_MOST; count++) {
    run_box_ranks(count, save_part, &t);
    check_all(&t, count, DVI_OK);
    ck_assert(file_has_bytes(t.path, t.saved, t.size));
    (void)unlink(t.path);
  }
  end_state_trial(&t);
}
END_TEST

START_TEST(a_run_goes_on_with_the_same_bits_on_any_number_of_processes)
{
  state_trial t = try_whole();
  run_box_ranks(3, save_part, &t);
  for (int count = 1; count <= STATE_TRIAL_MOST; count++) {
    run_box_ranks(count, load_part, &t);
    check_all(&t, count, DVI_OK);
  }
  end_state_trial(&t);
}
END_TEST

/* ---- states that are refused ---- */

/* Try to load bytes, or on one process the right ones, and see that nothing changes. */
static void refuse_part(const dvi_yee_ranks *ranks, void *user)
{
  state_trial *t = user;
  dvi_march *march = march_of(ranks, 0.2);
  (void)dvi_march_advance(march, 2);
  t->status[ranks->rank] = ranks->rank == 1 ? dvi_march_load_memory(march, t->saved, t->size)
                                            : dvi_march_load_memory(march, t->tried, t->tried_size);
  t->same[ranks->rank] = march_has_bytes(march, t->saved, t->size);
  dvi_march_destroy(&march);
}

static void check_refused(state_trial *t, const unsigned char *bytes, size_t size)
{
  t->tried = bytes;
  t->tried_size = size;
  run_box_ranks(3, refuse_part, t);
  check_all(t, 3, DVI_BAD_FILE);
}

START_TEST(all_processes_refuse_what_one_of_them_cannot_load)
{
  size_t size;
  state_trial t = try_whole();
  dvi_march *foreign = march_of(NULL, 0.3);
  unsigned char *bytes = save_march(foreign, &size);
  check_refused(&t, bytes, size);         /* of other conductors */
  check_refused(&t, t.saved, t.size - 9); /* cut short */
  check_refused(&t, t.later, t.size);     /* of another time than that of process 1 */
  free(bytes);
  dvi_march_destroy(&foreign);
  end_state_trial(&t);
}
END_TEST

static void miss_part(const dvi_yee_ranks *ranks, void *user)
{
  state_trial *t = user;
  dvi_march *march = march_of(ranks, 0.2);
  (void)dvi_march_advance(march, 2);
  t->status[ranks->rank] = dvi_march_load(march, "no/such.state");
  if (t->status[ranks->rank] == DVI_IO_ERROR)
    t->status[ranks->rank] = dvi_march_save(march, "no/such.state");
  t->same[ranks->rank] = march_has_bytes(march, t->saved, t->size);
  dvi_march_destroy(&march);
}

START_TEST(all_processes_know_that_a_file_is_missing_or_cannot_be_written)
{
  state_trial t = try_whole();
  run_box_ranks(3, miss_part, &t);
  check_all(&t, 3, DVI_IO_ERROR);
  end_state_trial(&t);
}
END_TEST

/* ---- processes that lose each other ---- */

/* A march that has lost the others is not saved, a file that is refused does not find them, and one
 * that is loaded does. */
static void lose_part(const dvi_yee_ranks *ranks, void *user)
{
  state_trial *t = user;
  const int r = ranks->rank;
  watched_ranks line = {.ranks = ranks};
  const dvi_yee_ranks bad = watch_ranks(&line);
  dvi_march *march = march_of(&bad, 0.2);
  size_t size;
  line.is_cut = 1;
  t->same[r] = dvi_march_advance(march, 2) == DVI_CALLBACK_FAILED;
  line.is_cut = 0;
  t->same[r] &= dvi_march_save_memory(march, NULL, 0, &size) == DVI_CALLBACK_FAILED &&
                dvi_march_load_memory(march, t->saved, t->size - 8) == DVI_BAD_FILE &&
                dvi_march_advance(march, 2) == DVI_CALLBACK_FAILED;
  t->status[r] = dvi_march_load_memory(march, t->saved, t->size);
  (void)dvi_march_advance(march, 5);
  t->same[r] &= march_has_bytes(march, t->later, t->size);
  dvi_march_destroy(&march);
}

START_TEST(a_state_brings_processes_together_again)
{
  state_trial t = try_whole();
  run_box_ranks(3, lose_part, &t);
  check_all(&t, 3, DVI_OK);
  end_state_trial(&t);
}
END_TEST

SUITE(yee_saved)
{
  tcase_add_test(tests, a_file_of_several_processes_is_that_of_one);
  tcase_add_test(tests, a_run_goes_on_with_the_same_bits_on_any_number_of_processes);
  tcase_add_test(tests, all_processes_refuse_what_one_of_them_cannot_load);
  tcase_add_test(tests, all_processes_know_that_a_file_is_missing_or_cannot_be_written);
  tcase_add_test(tests, a_state_brings_processes_together_again);
}
