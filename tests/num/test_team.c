/* labels: unit */
/* Threads that wait for work: everyone gets his share, once a turn, and the caller goes on when all
 * have ended. */
#include <stdatomic.h>

#include "core/memory.h"
#include "num/team.h"
#include "support/suite.h"

enum { MOST = 8, TURNS = 500 };

typedef struct tally {
  long turns[MOST]; /* each written by its member alone */
  atomic_long all;
} tally;

static void count_turn(void *user, int member)
{
  tally *t = user;
  t->turns[member]++;
  atomic_fetch_add(&t->all, 1);
}

START_TEST(each_turn_calls_each_member_once)
{
  const int size = _i;
  dvi__team *team = NULL;
  ck_assert_int_eq(dvi__team_create(size, &team), DVI_OK);
  for (int count = 1; count <= size; count++) {
    tally t = {.all = 0};
    for (long turn = 1; turn <= TURNS; turn++) {
      dvi__team_run(team, count, count_turn, &t);
      if (t.all != turn * count)
        ck_abort_msg("turn %ld of %d members: %ld", turn, count, (long)t.all);
    }
    for (int member = 0; member < MOST; member++)
      ck_assert_int_eq(t.turns[member], member < count ? TURNS : 0);
  }
  dvi__team_destroy(&team);
  ck_assert_ptr_null(team);
}
END_TEST

/* Members may wait for each other: all are at work at one time. */
typedef struct chain {
  atomic_int arrived[MOST];
  int size;
} chain;

static void wait_for_next(void *user, int member)
{
  chain *c = user;
  for (int waited = 0; member + 1 < c->size && atomic_load(&c->arrived[member + 1]) == 0; waited++)
    dvi__team_pause(waited);
  atomic_store(&c->arrived[member], 1);
}

START_TEST(members_work_at_one_time)
{
  dvi__team *team = NULL;
  ck_assert_int_eq(dvi__team_create(MOST, &team), DVI_OK);
  for (int turn = 0; turn < 100; turn++) {
    chain c = {.size = MOST};
    dvi__team_run(team, MOST, wait_for_next, &c);
    ck_assert_int_eq(c.arrived[0], 1);
  }
  dvi__team_destroy(&team);
}
END_TEST

/* ---- items that are shared ---- */

enum { ITEMS_MOST = 1000 };

static atomic_int done[ITEMS_MOST], strangers;
static int team_size;

static void mark(void *user, int member, int item)
{
  if (user != done || member < 0 || member >= team_size) strangers++;
  done[item]++;
}

START_TEST(each_item_is_done_once)
{
  static const int counts[] = {0, 1, 2, 3, 17, 64, ITEMS_MOST};
  dvi__team *team = NULL;
  team_size = _i;
  strangers = 0;
  ck_assert_int_eq(dvi__team_create(team_size, &team), DVI_OK);
  for (int turn = 0; turn < 200; turn++) {
    const int count = counts[turn % 7];
    for (int i = 0; i < ITEMS_MOST; i++) done[i] = 0;
    dvi__team_share(team, count, mark, done);
    for (int i = 0; i < ITEMS_MOST; i++) ck_assert_int_eq(done[i], i < count);
  }
  ck_assert_int_eq(strangers, 0);
  dvi__team_destroy(&team);
}
END_TEST

/* Both of two items must be at work at one time, or neither ends. */
static void meet(void *user, int member, int item)
{
  atomic_int *arrived = user;
  (void)member, (void)item;
  atomic_fetch_add(arrived, 1);
  for (int waited = 0; atomic_load(arrived) < 2; waited++) dvi__team_pause(waited);
}

START_TEST(items_are_done_at_one_time)
{
  dvi__team *team = NULL;
  atomic_int arrived = 0;
  ck_assert_int_eq(dvi__team_create(2, &team), DVI_OK);
  dvi__team_share(team, 2, meet, &arrived);
  dvi__team_destroy(&team);
}
END_TEST

/* ---- beginning and end ---- */

START_TEST(a_team_that_never_worked_can_be_ended)
{
  dvi__team *team = NULL;
  ck_assert_int_eq(dvi__team_create(4, &team), DVI_OK);
  dvi__team_destroy(&team);
  ck_assert_ptr_null(team);
}
END_TEST

START_TEST(a_team_without_memory_is_none)
{
  for (long successes = 0; successes < 2; successes++) {
    dvi__team *team = NULL;
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi__team_create(4, &team);
    dvi__fail_allocations_after(-1);
    ck_assert_int_eq(status, DVI_NO_MEMORY);
    ck_assert_ptr_null(team);
    check_words("no memory");
  }
  dvi__team *none = NULL;
  dvi__team_destroy(&none);
}
END_TEST

SUITE(team)
{
  tcase_add_loop_test(tests, each_turn_calls_each_member_once, 1, MOST + 1);
  tcase_add_test(tests, members_work_at_one_time);
  tcase_add_loop_test(tests, each_item_is_done_once, 1, 6);
  tcase_add_test(tests, items_are_done_at_one_time);
  tcase_add_test(tests, a_team_that_never_worked_can_be_ended);
  tcase_add_test(tests, a_team_without_memory_is_none);
}
