/* labels: unit */
/* A pool does every item once, on its own threads, as often as it is asked, and ends them. */
#include <stdatomic.h>

#include "core/memory.h"
#include "core/pool.h"
#include "support/suite.h"

enum { ITEMS_MOST = 1000 };

static atomic_int done[ITEMS_MOST], wrong_threads;
static int threads;

static void mark(void *of, int thread, int item)
{
  if (of != done || thread < 0 || thread >= threads) wrong_threads++;
  done[item]++;
}

START_TEST(every_item_is_done_once_in_every_round)
{
  static const int counts[] = {0, 1, 2, 3, 17, 64, ITEMS_MOST};
  dvi__pool *pool = NULL;
  threads = 1 + _i;
  wrong_threads = 0;
  ck_assert_int_eq(dvi__pool_create(threads, &pool), DVI_OK);
  for (int round = 0; round < 200; round++) {
    const int count = counts[round % 7];
    for (int i = 0; i < ITEMS_MOST; i++) done[i] = 0;
    dvi__pool_run(pool, count, mark, done);
    for (int i = 0; i < ITEMS_MOST; i++) ck_assert_int_eq(done[i], i < count);
  }
  ck_assert_int_eq(wrong_threads, 0);
  dvi__pool_destroy(&pool);
  ck_assert_ptr_null(pool);
}
END_TEST

static atomic_int waiting;

/* Both of two items must be in work at one time, or neither ends. */
static void meet(void *of, int thread, int item)
{
  (void)of, (void)thread, (void)item;
  waiting++;
  while (waiting < 2) (void)0;
}

START_TEST(two_threads_work_at_one_time)
{
  dvi__pool *pool = NULL;
  waiting = 0;
  ck_assert_int_eq(dvi__pool_create(2, &pool), DVI_OK);
  dvi__pool_run(pool, 2, meet, NULL);
  dvi__pool_destroy(&pool);
}
END_TEST

START_TEST(a_pool_without_memory_is_none)
{
  for (int successes = 0; successes < 2; successes++) {
    dvi__pool *pool = NULL;
    dvi__fail_allocations_after(successes);
    ck_assert_int_eq(dvi__pool_create(3, &pool), DVI_NO_MEMORY);
    dvi__fail_allocations_after(-1);
    ck_assert_ptr_null(pool);
    check_words("no memory");
  }
}
END_TEST

START_TEST(a_pool_that_never_worked_can_be_ended)
{
  dvi__pool *pool = NULL;
  dvi__pool_destroy(&pool);
  ck_assert_int_eq(dvi__pool_create(4, &pool), DVI_OK);
  dvi__pool_destroy(&pool);
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("pool");
  tcase_add_loop_test(tests, every_item_is_done_once_in_every_round, 0, 5);
  tcase_add_test(tests, two_threads_work_at_one_time);
  tcase_add_test(tests, a_pool_without_memory_is_none);
  tcase_add_test(tests, a_pool_that_never_worked_can_be_ended);
  return run_tests("core/pool", tests);
}
