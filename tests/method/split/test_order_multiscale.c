/* labels: order reference */
/* As h goes to 0 with fixed omega the space is as good as polynomials with the same number of
 * functions. The order is d + 2m + 2, and 2 more with the second harmonic. */
#include <check.h>

#include "support/order.h"
#include "support/runs.h"
#include "support/suite.h"

enum { PENDULUM = 1, HENON_HEILES };

START_TEST(it_has_twice_the_order_of_its_functions_on_the_stiff_pendulum)
{
  check_order_over("stiff-pendulum", NULL, 1, 40,
                   "multiscale:degree=1,amplitude=0,fast=0:1,omega=100", 6);
}
END_TEST

START_TEST(and_at_a_frequency_that_is_not_the_motions)
{
  check_order_over("pendulum", NULL, 2, 4, "multiscale:degree=1,amplitude=0,fast=0,omega=3", 6);
}
END_TEST

/* Above 6 by one step's errors at six lengths or more, from 1e-9 to 1e-14. */
static const struct {
  int place, degree, amplitude, harmonics, order;
} cases[] = {{PENDULUM, 2, 0, 1, 8},      {PENDULUM, 3, 0, 1, 10}, {PENDULUM, 1, 1, 1, 10},
             {PENDULUM, 2, 1, 1, 12},     {PENDULUM, 3, 1, 1, 14}, {PENDULUM, 2, 2, 1, 16},
             {HENON_HEILES, 3, 2, 1, 18}, {PENDULUM, 1, 0, 2, 10}};

START_TEST(at_every_degree_of_path_and_amplitudes)
{
  const char *fast = cases[_i].place == PENDULUM ? "0" : "0:1";
  check_order(cases[_i].place,
              method_spec("multiscale:degree=%d,amplitude=%d,harmonics=%d,fast=%s,omega=1",
                          cases[_i].degree, cases[_i].amplitude, cases[_i].harmonics, fast),
              cases[_i].order);
}
END_TEST

START_TEST(a_slow_coordinate_has_the_order_of_its_polynomials)
{
  check_order(HENON_HEILES, "multiscale:degree=2,amplitude=1,fast=0,omega=1", 4);
}
END_TEST

SUITE(order_multiscale)
{
  tcase_add_test(tests, it_has_twice_the_order_of_its_functions_on_the_stiff_pendulum);
  tcase_add_test(tests, and_at_a_frequency_that_is_not_the_motions);
  tcase_add_loop_test(tests, at_every_degree_of_path_and_amplitudes, 0,
                      sizeof cases / sizeof *cases);
  tcase_add_test(tests, a_slow_coordinate_has_the_order_of_its_polynomials);
}
