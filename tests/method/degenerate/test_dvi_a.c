/* labels: order */
/* dvi-a is symplectic Euler with the momentum first, where y is the momentum. */
#include "support/systems/degenerate.h"
#include "support/suite.h"

START_TEST(it_is_symplectic_euler)
{
  check_symplectic_euler("dvi-a", 1);
}
END_TEST

START_TEST(it_has_order_1_in_its_class_and_refuses_what_is_outside)
{
  check_one_step("dvi-a", 1);
}
END_TEST

SUITE(dvi_a)
{
  tcase_add_test(tests, it_is_symplectic_euler);
  tcase_add_test(tests, it_has_order_1_in_its_class_and_refuses_what_is_outside);
}
