/* Sums that are rounded once: known results, any order, any division, and terms of all sizes. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "num/accumulator.h"
#include "support/meshes.h"
#include "support/suite.h"

enum { TERMS = 1000 };

static double sum_of(int count, const double *term)
{
  dvi__accumulator sum = {.terms = 0};
  for (int i = 0; i < count; i++) dvi__accumulate(&sum, term[i]);
  return dvi__accumulator_value(&sum);
}

/* A number with an exponent between two. */
static double draw(unsigned long long *state, int least, int most)
{
  const double mantissa = random_number(state) - 0.5;
  return ldexp(mantissa, least + (int)((most - least) * random_number(state)));
}

START_TEST(known_sums_are_rounded_once)
{
  const struct {
    double term[4], sum;
  } list[] = {{{1, 0x1p-53, 0, 0}, 1},
              {{1, 0x1p-53, 0x1p-1074, 0}, 1 + 0x1p-52},
              {{1, 0x1.8p-52, 0, 0}, 1 + 0x1p-51},
              {{0x1p1000, 1, -0x1p1000, 0}, 1},
              {{0x1.fffffffffffffp1023, 0x1p970, 0, 0}, INFINITY},
              {{0x1.fffffffffffffp1023, 0x1p969, 0, 0}, 0x1.fffffffffffffp1023},
              {{0x1.fffffffffffffp1023, 0x1.fffffffffffffp1023, -0x1.fffffffffffffp1023, 1},
               0x1.fffffffffffffp1023},
              {{0x1p-1074, 0x1p-1074, -0x1p-1073, 0}, 0},
              {{-0x1p-1074, 0, 0, 0}, -0x1p-1074},
              {{-1, -0x1p-60, 0.5, 0.5}, -0x1p-60},
              {{INFINITY, 1, 0, -0x1p1023}, INFINITY},
              {{-INFINITY, 1, 0, 0}, -INFINITY}};
  for (size_t i = 0; i < sizeof list / sizeof *list; i++)
    ck_assert_msg(sum_of(4, list[i].term) == list[i].sum, "%zu: %a", i, sum_of(4, list[i].term));
  ck_assert(isnan(sum_of(2, (double[]){INFINITY, -INFINITY})));
  ck_assert(isnan(sum_of(2, (double[]){NAN, 1})));
}
END_TEST

/* Terms in pairs that cancel leave one of them, whatever lies between. */
START_TEST(no_order_changes_a_bit)
{
  unsigned long long state = 11;
  double term[TERMS + 1];
  for (int trial = 0; trial < repeats(100); trial++) {
    const double rest = draw(&state, -1060, 1000);
    for (int i = 0; i < TERMS; i += 2) term[i + 1] = -(term[i] = draw(&state, -1070, 1000));
    term[TERMS] = rest;
    for (int i = TERMS; i > 0; i--) {
      const int other = (int)((i + 1) * random_number(&state));
      const double kept = term[i];
      term[i] = term[other];
      term[other] = kept;
    }
    ck_assert(sum_of(TERMS + 1, term) == rest);
  }
}
END_TEST

/* All products at once, and in parts that are added number by number, are those one by one. */
START_TEST(no_division_changes_a_bit)
{
  unsigned long long state = 12;
  double x[TERMS], y[TERMS], terms[TERMS];
  char taken[TERMS];
  for (int trial = 0; trial < repeats(300); trial++) {
    const int spread = trial % 3 == 0   ? 4
                       : trial % 3 == 1 ? 60
                                        : 500,
              count = 1 + (int)(TERMS * random_number(&state));
    dvi__accumulator all = {.terms = 0}, part[2] = {{.terms = 0}, {.terms = 0}};
    int kept = 0;
    for (int i = 0; i < count; i++) {
      x[i] = draw(&state, -spread, spread);
      y[i] = draw(&state, -spread, spread);
      taken[i] = random_number(&state) < 0.5;
      terms[i] = x[i] * y[i];
    }
    dvi__accumulate_products(&all, count, x, y, NULL);
    dvi__accumulate_products(part, count, x, y, taken);
    for (int i = 0; i < count; i++)
      if (!taken[i]) terms[kept++] = x[i] * y[i];
    for (int i = 0; i < kept; i++) dvi__accumulate(part + 1, terms[i]);
    for (int i = 0; i < count; i++) terms[i] = x[i] * y[i];
    for (int k = 0; k < 2; k++) dvi__accumulator_carry(part + k);
    for (int i = 0; i < DVI__SUM_NUMBERS; i++) part[0].number[i] += part[1].number[i];
    ck_assert(dvi__accumulator_value(&all) == sum_of(count, terms));
    ck_assert(dvi__accumulator_value(part) == sum_of(count, terms));
  }
}
END_TEST

START_TEST(a_term_that_is_no_number_is_not_lost_among_zeros)
{
  const double x[] = {0, NAN, 0}, y[] = {1, 1, 1};
  dvi__accumulator sum = {.terms = 0};
  dvi__accumulate_products(&sum, 3, x, y, NULL);
  ck_assert(isnan(dvi__accumulator_value(&sum)));
}
END_TEST

SUITE(accumulator)
{
  tcase_add_test(tests, a_term_that_is_no_number_is_not_lost_among_zeros);
  tcase_add_test(tests, known_sums_are_rounded_once);
  tcase_add_test(tests, no_order_changes_a_bit);
  tcase_add_test(tests, no_division_changes_a_bit);
}
