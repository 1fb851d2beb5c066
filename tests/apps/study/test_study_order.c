/* Studies of things that are no motions: rules of quadrature, an adaptive one, and a boundary value
 * problem. Their orders, decisions, tables and verdicts, what small errors cost, and how many
 * digits can be trusted. */
#include <check.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "apps/study/subjects.h"
#include "study/order_report.h"
#include "support/suite.h"

enum { TEXT = 4096 };

/* --- Orders. --- */

/* The study of one subject, with so many levels. */
static result_table *study_order(const study_subject *subject, int levels, order_result *result,
                                 table_column *columns)
{
  dvi_study_levels choice;
  const dvi_study_search request = {.levels = levels};
  memset(result, 0, sizeof *result);
  order_columns(subject->words, columns);
  result_table *rows = table_create(columns);
  ck_assert_int_eq(levels_choose(subject, &request, &choice), DVI_OK);
  ck_assert_int_eq(choice.room, 1);
  ck_assert_int_eq(order_measure(subject, &choice, levels, rows, result), DVI_OK);
  return rows;
}

/* Gives the text of a report. */
static void read_back(FILE *file, char *text)
{
  rewind(file);
  text[fread(text, 1, TEXT - 1, file)] = '\0';
  ck_assert_int_eq(fclose(file), 0);
}

static void verdict_of(const order_result *result, char *text)
{
  FILE *file = tmpfile();
  ck_assert_ptr_nonnull(file);
  order_print_verdict(file, result);
  read_back(file, text);
}

START_TEST(rules_have_their_orders)
{
  rule rules[] = {trapezoids(), simpson()};
  for (int k = 0; k < 2; k++) {
    const study_subject subject = subject_of(&rules[k], "rule", rules[k].order);
    table_column columns[ORDER_COLUMNS_MAX];
    order_result result;
    char text[TEXT];
    result_table *rows = study_order(&subject, 6, &result, columns);
    ck_assert_int_eq(result.levels, 6);
    ck_assert_int_eq(result.settled, 1);
    ck_assert_double_eq_tol(result.fit.slope, rules[k].order, 0.02); /* terms of h^2 more */
    ck_assert_int_eq(order_holds(&result), 1);
    for (int i = 0; i < result.levels; i++) ck_assert_double_gt(result.error[i], result.floor);
    verdict_of(&result, text);
    ck_assert_ptr_nonnull(strstr(text, k == 0 ? "rule: claimed order 2, fitted 2.00 to levels"
                                              : "rule: claimed order 4, fitted 4.00 to levels"));
    ck_assert_ptr_nonnull(strstr(text, ": ok\n  judge: the antiderivative, error 2.2e-16"));
    table_destroy(&rows);
  }
}
END_TEST

START_TEST(a_wrong_claim_is_missed)
{
  rule r = trapezoids();
  const study_subject subject = subject_of(&r, "trapezoids", 3);
  table_column columns[ORDER_COLUMNS_MAX];
  order_result result;
  char text[TEXT];
  result_table *rows = study_order(&subject, 6, &result, columns);
  ck_assert_int_eq(order_holds(&result), 0);
  verdict_of(&result, text);
  ck_assert_ptr_nonnull(strstr(text, "trapezoids: claimed order 3, fitted 2.00"));
  ck_assert_ptr_nonnull(strstr(text, "MISSED"));
  table_destroy(&rows);
}
END_TEST

START_TEST(a_singular_integrand_takes_the_order_away)
{
  rule r = {.integrand = with_root, .exact = 2.0 / 3.0, .order = 4};
  const study_subject subject = subject_of(&r, "simpson", 4);
  table_column columns[ORDER_COLUMNS_MAX];
  order_result result;
  result_table *rows = study_order(&subject, 6, &result, columns);
  ck_assert_double_eq_tol(result.fit.slope, 1.5, 0.02);
  ck_assert_int_eq(order_holds(&result), 0);
  table_destroy(&rows);
}
END_TEST

START_TEST(sentences_are_in_the_words_of_the_subject)
{
  rule r = trapezoids();
  const study_subject subject = subject_of(&r, "trapezoids", 2);
  order_result result = {.name = "trapezoids",
                         .words = subject.words,
                         .claimed = 2,
                         .extent = 1.0,
                         .judge = "the antiderivative",
                         .levels = 5,
                         .length = {0.5, 0.25, 0.125, 0.0625, 0.03125},
                         .error = {0.5, 0.3, 0.2, 0.1, 0.06},
                         .floor = 1e-14,
                         .ceiling = 0.02,
                         .fit = {.first = -1}};
  char text[TEXT];
  verdict_of(&result, text);
  ck_assert_str_eq(text,
                   "trapezoids: claimed order 2, not decided: panels are too large: 5 of 5 levels "
                   "have errors above 1 % of the solution (2.0e-02); take more\n"
                   "  judge: the antiderivative, error 0.0e+00; errors up to 1.0e-14 are not "
                   "fitted\n");
}
END_TEST

START_TEST(the_table_has_the_titles_of_the_subject)
{
  static const char *const titles[] = {"rule",  "integrand", "width",       "panels",
                                       "error", "slope",     "cpu_seconds", "evaluations"};
  rule r = simpson();
  const study_subject subject = subject_of(&r, "simpson", 4);
  table_column columns[ORDER_COLUMNS_MAX];
  order_result result;
  result_table *rows = study_order(&subject, 4, &result, columns);
  for (int i = 0; i < 8; i++) ck_assert_str_eq(table_title(rows, i), titles[i]);
  ck_assert_int_eq(table_rows(rows), 4);
  ck_assert_str_eq(table_text_at(rows, 0, 0), "simpson");
  for (int k = 0; k < 4; k++) {
    const double panels = table_number_at(rows, k, 3);
    ck_assert_double_eq(table_number_at(rows, k, 2), 1.0 / panels);
    ck_assert_double_eq(table_number_at(rows, k, 7), 3.0 * panels);
    ck_assert_double_gt(table_number_at(rows, k, 6), 0.0);
  }
  ck_assert(isnan(table_number_at(rows, 0, 5)));
  table_destroy(&rows);
}
END_TEST

/* A level without a result is too rough, and the search goes on. A level that ends the study ends
 * it. */
static dvi_status no_run(void *user, double parts, study_level *level)
{
  (void)user, (void)parts, (void)level;
  return DVI_NOT_CONVERGED;
}

static dvi_status broken_run(void *user, double parts, study_level *level)
{
  (void)user, (void)parts, (void)level;
  return DVI_NO_MEMORY;
}

START_TEST(failures_are_rough_or_final)
{
  rule r = simpson();
  study_subject subject = subject_of(&r, "simpson", 4);
  const dvi_study_search request = {.levels = 4};
  dvi_study_levels choice;
  r.odd_fails = 1;
  ck_assert_int_eq(levels_choose(&subject, &request, &choice), DVI_OK);
  ck_assert_int_eq((int)(choice.parts[0] % 2), 0);
  subject.run = no_run;
  ck_assert_int_eq(levels_choose(&subject, &request, &choice), DVI_NOT_CONVERGED);
  subject.may_miss = true;
  ck_assert_int_eq(levels_choose(&subject, &request, &choice), DVI_OK);
  ck_assert_int_eq((int)choice.parts[0], 0);
  subject.run = broken_run;
  ck_assert_int_eq(levels_choose(&subject, &request, &choice), DVI_NO_MEMORY);
}
END_TEST

START_TEST(a_boundary_value_problem_has_its_order_and_further_errors)
{
  const study_subject subject = poisson();
  table_column columns[ORDER_COLUMNS_MAX];
  order_result result;
  char text[TEXT];
  result_table *rows = study_order(&subject, 6, &result, columns);
  ck_assert_int_eq(order_holds(&result), 1);
  ck_assert_str_eq(table_title(rows, 6), "slope_error");
  for (int k = 1; k < 6; k++) { /* of second order, too: u' is even about the end */
    const double ratio = table_number_at(rows, k - 1, 2) / table_number_at(rows, k, 2);
    const double fall = table_number_at(rows, k - 1, 6) / table_number_at(rows, k, 6);
    ck_assert_double_eq_tol(log(fall) / log(ratio), 2.0, 0.1);
  }
  verdict_of(&result, text);
  ck_assert_ptr_nonnull(strstr(text, "differences: claimed order 2, fitted 2.00"));
  ck_assert_ptr_nonnull(strstr(text, "  judge: error 2.2e-16; errors up to"));
  table_destroy(&rows);
}
END_TEST

/* An error whose slope rises from 2 to 4 where h is about 1/10. */
static dvi_status rising_run(void *user, double parts, study_level *level)
{
  const double h = 1.0 / parts;
  (void)user;
  level->parts = parts;
  level->length = h;
  level->error = pow(h, 4.0) / (1.0 + 100.0 * h * h);
  return DVI_OK;
}

static dvi_status rising_repeat(void *user, double parts, double *preparation)
{
  (void)user, (void)parts, (void)preparation;
  return DVI_OK;
}

START_TEST(levels_are_added_while_the_slope_comes_near_the_order)
{
  rule r = simpson();
  study_subject subject = subject_of(&r, "rising", 4);
  const dvi_study_levels choice = {.parts = {2, 4, 8, 16, 32, 64}, .floor = 1e-14, .ceiling = 1.0};
  table_column columns[ORDER_COLUMNS_MAX];
  order_result result = {0};
  char text[TEXT];
  subject.run = rising_run;
  subject.repeat = rising_repeat;
  order_columns(subject.words, columns);
  result_table *rows = table_create(columns);
  ck_assert_int_eq(order_measure(&subject, &choice, 6, rows, &result), DVI_OK);
  ck_assert_int_eq(order_may_settle(&result), 1);
  verdict_of(&result, text);
  ck_assert_ptr_nonnull(strstr(text, "it comes near the claimed order at the last levels alone"));
  ck_assert_int_eq(order_extend(&subject, rows, &result), DVI_OK);
  ck_assert_int_eq(result.levels, 8); /* the slopes 3.90, 3.97 and 3.99 are settled */
  ck_assert_int_eq(table_rows(rows), 8);
  ck_assert_double_eq_tol(result.length[7], 1.0 / 256.0, 1e-15);
  ck_assert_int_eq(order_holds(&result), 1);
  ck_assert_int_eq(order_may_settle(&result), 0);
  table_destroy(&rows);

  result.settled = false;
  result.floor = result.error[7] / 10.0; /* the next error would be below */
  ck_assert_int_eq(order_may_settle(&result), 0);
}
END_TEST

SUITE(study_order)
{
  tcase_add_test(tests, rules_have_their_orders);
  tcase_add_test(tests, a_wrong_claim_is_missed);
  tcase_add_test(tests, a_singular_integrand_takes_the_order_away);
  tcase_add_test(tests, sentences_are_in_the_words_of_the_subject);
  tcase_add_test(tests, the_table_has_the_titles_of_the_subject);
  tcase_add_test(tests, failures_are_rough_or_final);
  tcase_add_test(tests, levels_are_added_while_the_slope_comes_near_the_order);
  tcase_add_test(tests, a_boundary_value_problem_has_its_order_and_further_errors);
}
