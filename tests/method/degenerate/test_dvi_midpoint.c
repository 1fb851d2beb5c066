/* labels: order */
/* dvi-midpoint is the midpoint rule, where y is the momentum. */
#include "support/systems/degenerate.h"
#include "support/suite.h"

START_TEST(it_is_the_midpoint_rule)
{
  check_same_as_regular("dvi-midpoint", "midpoint");
}
END_TEST

START_TEST(it_has_order_2_in_its_class_and_refuses_what_is_outside)
{
  check_one_step("dvi-midpoint", 2);
}
END_TEST

SUITE(dvi_midpoint)
{
  tcase_add_test(tests, it_is_the_midpoint_rule);
  tcase_add_test(tests, it_has_order_2_in_its_class_and_refuses_what_is_outside);
}
