/* labels: unit */
/* Threads that wait for work: everyone gets his share, once a turn, and the caller goes on when all have ended. */
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
      if (t.all != turn * count) ck_abort_msg("turn %ld of %d members: %ld", turn, count, (long)t.all);
    }
    for (int member = 0; member < MOST; member++) ck_assert_int_eq(t.turns[member], member < count ? TURNS : 0);
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
  for (int waited = 0; member + 1 < c->size && atomic_load(&c->arrived[member + 1]) == 0; waited++) dvi__team_pause(waited);
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

int main(void)
{
  TCase *tests = tcase_create("team");
  tcase_add_loop_test(tests, each_turn_calls_each_member_once, 1, MOST + 1);
  tcase_add_test(tests, members_work_at_one_time);
  tcase_add_test(tests, a_team_without_memory_is_none);
  return run_tests("num/team", tests);
}
