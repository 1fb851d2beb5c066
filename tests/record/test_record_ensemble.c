/* labels: unit */
/* Recordings of ensembles are the states between calls. */
#include <dvi/ensemble.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { MEMBERS = 5, ROWS = 4, EVERY = 3 };

static problem *model;
static dvi_ensemble *members, *others;
static double q[2 * MEMBERS], p[2 * MEMBERS];

static dvi_ensemble *create_members(void)
{
  const dvi_ensemble_options options = {.members = MEMBERS};
  dvi_ensemble *made = NULL;
  ck_assert_int_eq(dvi_ensemble_create(model->system, "galerkin:degree=2", &options, &made),
                   DVI_OK);
  ck_assert_int_eq(dvi_ensemble_start(made, 0, q, p), DVI_OK);
  return made;
}

static void set_up(void)
{
  model = create_problem("kepler", NULL);
  for (int k = 0; k < MEMBERS; k++) {
    q[k] = 1;
    p[MEMBERS + k] = 1 + 0.01 * k;
  }
  members = create_members();
  others = create_members();
}

static void tear_down(void)
{
  dvi_ensemble_destroy(&members);
  dvi_ensemble_destroy(&others);
  problem_destroy(&model);
}

START_TEST(rows_are_the_states_after_steps)
{
  double t[ROWS * MEMBERS], Q[ROWS * 2 * MEMBERS], now_t[MEMBERS], now_q[2 * MEMBERS];
  const dvi_ensemble_rows rows = {.size = sizeof rows, .t = t, .q = Q};
  ck_assert_int_eq(dvi_ensemble_record(members, 0.1, EVERY, ROWS, &rows), DVI_OK);
  for (int row = 0; row < ROWS; row++) {
    if (row > 0) ck_assert_int_eq(dvi_ensemble_advance(others, 0.1, EVERY), DVI_OK);
    ck_assert_int_eq(dvi_ensemble_state(others, now_t, now_q, NULL), DVI_OK);
    ck_assert_mem_eq(t + row * MEMBERS, now_t, sizeof now_t);
    ck_assert_mem_eq(Q + row * 2 * MEMBERS, now_q, sizeof now_q);
  }
}
END_TEST

START_TEST(wrong_counts_are_refused)
{
  const dvi_ensemble_rows rows = {.size = sizeof rows}, unsized = {0};
  ck_assert_int_eq(dvi_ensemble_record(members, 0.1, 0, 1, &rows), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_record(members, 0.1, 1, 0, &rows), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_record(members, 0, 1, 2, &rows), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_record(members, 0.1, 1, 1, &unsized), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_record(NULL, 0.1, 1, 1, &rows), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_ensemble_record(members, 0.1, 1, 1, NULL), DVI_BAD_ARGUMENT);
}
END_TEST

SUITE(record_ensemble)
{
  tcase_add_checked_fixture(tests, set_up, tear_down);
  tcase_add_test(tests, rows_are_the_states_after_steps);
  tcase_add_test(tests, wrong_counts_are_refused);
}
