/* labels: order reference */
/* As h goes to 0 with fixed omega the space is as good as polynomials of degree d + 2m + 2. */
#include <check.h>

#include "support/order.h"
#include "support/suite.h"

START_TEST(it_has_twice_the_order_of_its_functions_on_the_stiff_pendulum)
{
  check_order_over("stiff-pendulum", NULL, 1, 40, "multiscale:degree=1,amplitude=0,fast=0:1,omega=100", 6);
}
END_TEST

START_TEST(and_at_a_frequency_that_is_not_the_motions)
{
  check_order_over("pendulum", NULL, 2, 4, "multiscale:degree=1,amplitude=0,fast=0,omega=3", 6);
}
END_TEST

int main(void)
{
  TCase *tests = tcase_create("order");
  tcase_add_test(tests, it_has_twice_the_order_of_its_functions_on_the_stiff_pendulum);
  tcase_add_test(tests, and_at_a_frequency_that_is_not_the_motions);
  return run_tests("method/order_multiscale", tests);
}
