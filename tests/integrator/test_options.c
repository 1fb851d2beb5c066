/* labels: unit */
/* Missing options of an integrator have defaults, and options that do not go together are
 * refused. */
#include <stddef.h>

#include "support/paced.h"
#include "support/runs.h"
#include "support/suite.h"

static problem *model;

static void make_kepler(void)
{
  model = create_problem("kepler", NULL);
}

static void destroy_kepler(void)
{
  problem_destroy(&model);
}

static void check_refused(dvi_integrator_options options, const char *words)
{
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create_with(model->system, &options, &integrator),
                   DVI_BAD_ARGUMENT);
  check_words(words);
  ck_assert_ptr_null(integrator);
}

START_TEST(a_size_that_is_none_of_the_struct_is_refused)
{
  const size_t whole = sizeof(dvi_integrator_options);
  check_refused((dvi_integrator_options){.method = "midpoint"},
                "the options' size is 0; set it to sizeof");
  check_refused((dvi_integrator_options){.size = whole + 8, .method = "midpoint"},
                "the options' size is");
}
END_TEST

START_TEST(a_struct_of_an_older_header_has_default_values_behind_its_end)
{
  const dvi_monitor monitor = read_monitor("distance");
  dvi_integrator_options options = {
      .method = "midpoint", .pacing = DVI_TIME_TRANSFORM, .monitor = &monitor};
  dvi_integrator *integrator = NULL;
  options.size = offsetof(dvi_integrator_options, pacing);
  ck_assert_int_eq(dvi_integrator_create_with(model->system, &options, &integrator), DVI_OK);
  ck_assert_ptr_null(dvi_integrator_monitor(integrator));
  dvi_integrator_destroy(&integrator);
}
END_TEST

START_TEST(options_that_do_not_go_together_are_refused)
{
  const dvi_monitor monitor = read_monitor("distance");
  const size_t size = sizeof(dvi_integrator_options);
  dvi_integrator *integrator = NULL;
  check_refused((dvi_integrator_options){.size = size}, "the method is NULL");
  check_refused(
      (dvi_integrator_options){.size = size, .method = "midpoint", .pacing = DVI_STEP_CONTROL},
      "the monitor is NULL");
  check_refused((dvi_integrator_options){.size = size, .method = "midpoint", .monitor = &monitor},
                "the pacing is steps of time");
  check_refused(
      (dvi_integrator_options){.size = size, .method = "midpoint", .pacing = (dvi_pacing)3},
      "no pacing number 3");
  ck_assert_int_eq(dvi_integrator_create_with(model->system, NULL, &integrator), DVI_BAD_ARGUMENT);
  check_words("the options are NULL");
  ck_assert_int_eq(dvi_integrator_create_with(NULL, &(dvi_integrator_options){0}, &integrator),
                   DVI_BAD_ARGUMENT);
  check_words("the system is NULL");
  ck_assert_int_eq(dvi_integrator_create_with(model->system, &(dvi_integrator_options){0}, NULL),
                   DVI_BAD_ARGUMENT);
}
END_TEST

SUITE(options)
{
  tcase_add_checked_fixture(tests, make_kepler, destroy_kepler);
  tcase_add_test(tests, a_size_that_is_none_of_the_struct_is_refused);
  tcase_add_test(tests, a_struct_of_an_older_header_has_default_values_behind_its_end);
  tcase_add_test(tests, options_that_do_not_go_together_are_refused);
}
