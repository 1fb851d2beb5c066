#include <stdint.h>

#include "core/memory.h"
#include "support/suite.h"

START_TEST(memory_comes_zeroed_and_is_counted)
{
  const long before = dvi__allocation_count();
  double *x = DVI_NEW(double, 100);
  ck_assert_ptr_nonnull(x);
  for (int i = 0; i < 100; i++) ck_assert(x[i] == 0);
  ck_assert_int_eq(dvi__allocation_count(), before + 1);
  dvi__release(x);
  dvi__release(NULL);
  ck_assert_int_eq(dvi__allocation_count(), before + 1);
}
END_TEST

START_TEST(nothing_is_still_a_block)
{
  void *nothing = dvi__allocate(0, sizeof(double)), *copy = dvi__duplicate(NULL, 0, sizeof(double));
  ck_assert_ptr_nonnull(nothing);
  ck_assert_ptr_nonnull(copy);
  dvi__release(nothing);
  dvi__release(copy);
}
END_TEST

START_TEST(a_duplicate_holds_the_same_numbers)
{
  const int original[3] = {1, 2, 3};
  int *copy = dvi__duplicate(original, 3, sizeof(int));
  ck_assert_mem_eq(copy, original, sizeof original);
  dvi__release(copy);
}
END_TEST

START_TEST(sizes_that_overflow_give_no_memory)
{
  const long before = dvi__allocation_count();
  ck_assert_ptr_null(dvi__allocate(SIZE_MAX / 2, 8));
  ck_assert_ptr_null(DVI_NEW(double, -1));
  ck_assert_int_eq(dvi__allocation_count(), before);
}
END_TEST

START_TEST(failures_can_be_injected_and_lifted)
{
  dvi__fail_allocations_after(1);
  void *first = dvi__allocate(1, 1), *second = dvi__allocate(1, 1),
       *third = dvi__duplicate("x", 1, 1);
  dvi__fail_allocations_after(-1);
  void *fourth = dvi__allocate(1, 1);
  ck_assert_ptr_nonnull(first);
  ck_assert_ptr_null(second);
  ck_assert_ptr_null(third);
  ck_assert_ptr_nonnull(fourth);
  dvi__release(first);
  dvi__release(fourth);
}
END_TEST

SUITE(memory)
{
  tcase_add_test(tests, memory_comes_zeroed_and_is_counted);
  tcase_add_test(tests, nothing_is_still_a_block);
  tcase_add_test(tests, a_duplicate_holds_the_same_numbers);
  tcase_add_test(tests, sizes_that_overflow_give_no_memory);
  tcase_add_test(tests, failures_can_be_injected_and_lifted);
}
