#include "scaling/rank_counts.h"

#include "cli/command.h"
#include "support/suite.h"

START_TEST(only_ranks_are_asked_for_by_their_name)
{
  ck_assert(rank_counts_asked("ranks=1,2"));
  ck_assert(!rank_counts_asked("threads=1,2"));
  ck_assert(!rank_counts_asked("rank=1"));
  ck_assert(!rank_counts_asked(NULL));
}
END_TEST

START_TEST(dots_go_on_by_the_last_factor)
{
  rank_counts counts;
  ck_assert_int_eq(rank_counts_read("ranks=1,2,4,...,1e5", &counts), DONE);
  ck_assert_int_eq(counts.count, 18);
  for (int i = 0; i < 17; i++) ck_assert_double_eq(counts.number[i], 1 << i);
  ck_assert_double_eq(counts.number[17], 1e5);
  ck_assert_int_eq(rank_counts_read("ranks=1,10,...,1000,2000", &counts), DONE);
  ck_assert_int_eq(counts.count, 5);
  ck_assert_double_eq(counts.number[3], 1000);
}
END_TEST

START_TEST(numbers_without_dots_stay_as_they_are)
{
  rank_counts counts;
  ck_assert_int_eq(rank_counts_read("ranks=3", &counts), DONE);
  ck_assert_int_eq(counts.count, 1);
  ck_assert_double_eq(counts.number[0], 3);
}
END_TEST

START_TEST(nonsense_is_refused)
{
  static const char *const wrong[] = {"ranks=",
                                      "ranks=0",
                                      "ranks=1,-2",
                                      "ranks=1.5",
                                      "ranks=nan",
                                      "ranks=inf",
                                      "ranks=1,,2",
                                      "ranks=2,1",
                                      "ranks=2,2",
                                      "ranks=1,2,...",
                                      "ranks=...,4",
                                      "ranks=1,...,4",
                                      "ranks=1,2,..,8",
                                      "ranks=1,2,",
                                      "ranks=1,2,...,...,8",
                                      "ranks=1e10",
                                      "ranks=1,2,...,1",
                                      "ranks=x",
                                      "ranks=1000000,1000001,...,1e9"};
  rank_counts counts;
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    ck_assert_msg(rank_counts_read(wrong[i], &counts) == USAGE, "%s", wrong[i]);
}
END_TEST

SUITE(rank_counts)
{
  tcase_add_test(tests, only_ranks_are_asked_for_by_their_name);
  tcase_add_test(tests, dots_go_on_by_the_last_factor);
  tcase_add_test(tests, numbers_without_dots_stay_as_they_are);
  tcase_add_test(tests, nonsense_is_refused);
}
