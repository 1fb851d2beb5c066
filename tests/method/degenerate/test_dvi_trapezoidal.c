/* labels: order */
/* dvi-trapezoidal is Stoermer-Verlet, where y is the momentum. */
#include "support/systems/degenerate.h"
#include "support/suite.h"

START_TEST(it_is_stoermer_verlet)
{
  check_same_as_regular("dvi-trapezoidal", "verlet");
}
END_TEST

START_TEST(it_has_order_2_in_its_class_and_refuses_what_is_outside)
{
  check_one_step("dvi-trapezoidal", 2);
}
END_TEST

SUITE(dvi_trapezoidal)
{
  tcase_add_test(tests, it_is_stoermer_verlet);
  tcase_add_test(tests, it_has_order_2_in_its_class_and_refuses_what_is_outside);
}
