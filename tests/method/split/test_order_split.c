/* labels: order reference */
/* Orders of methods that split, at fixed frequencies. */
#include <check.h>

#include "support/order.h"
#include "support/runs.h"
#include "support/suite.h"

static const char *const methods[] = {"imex",
                                      "imex:solver=newton",
                                      "respa:substeps=3",
                                      "respa:substeps=exact",
                                      "mollified",
                                      "mollified:filter=projection",
                                      "trig:filter=exact",
                                      "trig:filter=gautschi",
                                      "trig:filter=hochbruck-lubich",
                                      "trig:filter=grimm-hochbruck",
                                      "trig:filter=hairer-lubich"};
enum { METHODS = sizeof methods / sizeof *methods };

START_TEST(they_have_order_2_on_the_chain_of_soft_and_stiff_springs)
{
  check_order_over("fpu", NULL, 1, 100, methods[_i], 2);
}
END_TEST

START_TEST(compositions_of_imex_have_theirs)
{
  const int order = 4 + 2 * _i;
  check_order_over("fpu", NULL, 1, 400 / order,
                   method_spec("composition:order=%d,base=imex", order), order);
}
END_TEST

START_TEST(they_have_order_2_on_oscillators)
{
  check_order_over("oscillators", "omega=10", 2, 40, methods[_i], 2);
}
END_TEST

START_TEST(ida_finds_their_order_2)
{
  check_order_by_ida_over("fpu", "omega=20", 1, 40, methods[_i], 2);
}
END_TEST

SUITE(order_split)
{
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, they_have_order_2_on_the_chain_of_soft_and_stiff_springs, 0, METHODS);
  tcase_add_loop_test(tests, compositions_of_imex_have_theirs, 0, 3);
  tcase_add_loop_test(tests, they_have_order_2_on_oscillators, 0, METHODS);
  tcase_add_loop_test(tests, ida_finds_their_order_2, 0, METHODS);
}
