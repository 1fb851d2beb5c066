#include <stdlib.h>
#include <string.h>

#include "core/status.h"
#include "support/suite.h"

START_TEST(every_status_has_its_own_name_and_a_meaning)
{
  ck_assert_str_eq(dvi_status_name(DVI_OK), "DVI_OK");
  ck_assert_str_eq(dvi_status_name(DVI_SOLVER_FAILED), "DVI_SOLVER_FAILED");
  ck_assert_str_eq(dvi_status_meaning(DVI_NO_MEMORY), "memory could not be allocated");
  ck_assert_str_eq(dvi_status_name((dvi_status)-99), "unknown status");
  ck_assert_str_eq(dvi_status_meaning((dvi_status)99), "unknown status");
}
END_TEST

START_TEST(before_any_failure_the_sentence_is_empty)
{
  ck_assert_str_eq(dvi_last_error(), "");
}
END_TEST

START_TEST(a_failure_returns_its_status_and_keeps_its_sentence)
{
  ck_assert_int_eq(dvi__fail(DVI_BAD_SIZE, "%d points of %s", 7, "x"), DVI_BAD_SIZE);
  ck_assert_str_eq(dvi_last_error(), "7 points of x");
}
END_TEST

START_TEST(a_context_stands_before_the_cause)
{
  dvi__fail(DVI_SINGULAR, "the cause");
  ck_assert_int_eq(dvi__fail_in(DVI_BAD_STATE, "step %d", 3), DVI_BAD_STATE);
  ck_assert_str_eq(dvi_last_error(), "step 3: the cause");
}
END_TEST

START_TEST(a_context_without_a_cause_stands_alone)
{
  dvi__fail_in(DVI_BAD_STATE, "step %d", 3);
  ck_assert_str_eq(dvi_last_error(), "step 3");
}
END_TEST

START_TEST(the_last_sentence_may_be_quoted_in_the_next_one)
{
  dvi__fail(DVI_SINGULAR, "first");
  dvi__fail(DVI_SINGULAR, "second after %s", dvi_last_error());
  ck_assert_str_eq(dvi_last_error(), "second after first");
  dvi__fail_in(DVI_SINGULAR, "third after (%s)", dvi_last_error());
  ck_assert_str_eq(dvi_last_error(), "third after (second after first): second after first");
}
END_TEST

START_TEST(long_sentences_are_cut_not_overrun)
{
  char text[3000];
  memset(text, 'a', sizeof text - 1);
  text[sizeof text - 1] = '\0';
  dvi__fail(DVI_SINGULAR, "%s", text);
  ck_assert_uint_eq(strlen(dvi_last_error()), 1023);
  for (size_t length = 1015; length < 1027; length++) {
    dvi__fail_in(DVI_SINGULAR, "%s", text + sizeof text - 1 - length);
    ck_assert_uint_le(strlen(dvi_last_error()), 1023);
    ck_assert_int_eq(dvi_last_error()[0], 'a');
  }
}
END_TEST

static dvi_status second_call_fails(int *calls)
{
  for (;;) DVI_TRY(++*calls < 2 ? DVI_OK : DVI_NOT_FINITE);
}

START_TEST(try_leaves_with_the_status_of_the_call_that_fails)
{
  int calls = 0;
  ck_assert_int_eq(second_call_fails(&calls), DVI_NOT_FINITE);
  ck_assert_int_eq(calls, 2);
}
END_TEST

SUITE(status)
{
  tcase_add_test(tests, every_status_has_its_own_name_and_a_meaning);
  tcase_add_test(tests, before_any_failure_the_sentence_is_empty);
  tcase_add_test(tests, a_failure_returns_its_status_and_keeps_its_sentence);
  tcase_add_test(tests, a_context_stands_before_the_cause);
  tcase_add_test(tests, a_context_without_a_cause_stands_alone);
  tcase_add_test(tests, the_last_sentence_may_be_quoted_in_the_next_one);
  tcase_add_test(tests, long_sentences_are_cut_not_overrun);
  tcase_add_test(tests, try_leaves_with_the_status_of_the_call_that_fails);
}
