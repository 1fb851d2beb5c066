/* labels: unit */
/* An ensemble says how its members are grouped, and keeps the waves of temporal blocking. */
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

START_TEST(explain_says_how_members_are_grouped)
{
  char text[2048], little[20];
  problem *model = create_problem("kepler", NULL);
  dvi_ensemble *e = create_ensemble(model->system, "verlet",
                                    (dvi_ensemble_options){.members = 64, .block = 16});
  const size_t length = dvi_ensemble_explain(e, text, sizeof text);
  ck_assert_uint_eq(length, strlen(text));
  ck_assert_ptr_nonnull(
      strstr(text, "64 members in 4 blocks, side by side as lanes, 1 thread\nmethod: verlet"));
  ck_assert_uint_eq(dvi_ensemble_explain(e, little, sizeof little), length);
  ck_assert_int_eq(strncmp(text, little, sizeof little - 1), 0);
  ck_assert_uint_eq(dvi_ensemble_explain(e, NULL, 0), length);
  ck_assert_str_eq(dvi_ensemble_method(e), "verlet:blocking=auto,threads=1");
  dvi_ensemble_destroy(&e);
  e = create_ensemble(model->system, "galerkin:solver=newton",
                      (dvi_ensemble_options){.members = 64, .threads = 2});
  (void)dvi_ensemble_explain(e, text, sizeof text);
  ck_assert_ptr_nonnull(strstr(text, "64 members in 64 blocks, one after the other, 2 threads\n"));
  dvi_ensemble_destroy(&e);
  problem_destroy(&model);
}
END_TEST

static void explained(const char *method, const char *setting, const char *words)
{
  char text[2048];
  problem *model = create_problem("chain", setting);
  dvi_ensemble *e = create_ensemble(model->system, method, (dvi_ensemble_options){.members = 16});
  (void)dvi_ensemble_explain(e, text, sizeof text);
  ck_assert_msg(strstr(text, words) != NULL, "%s", text);
  dvi_ensemble_destroy(&e);
  problem_destroy(&model);
}

START_TEST(waves_are_not_given_up_for_members_as_lanes)
{
  explained("verlet", "n=8", "side by side");
  explained("verlet:blocking=temporal", "n=8", "one after the other");
  explained("verlet:threads=2", "n=8", "one after the other");
  explained("verlet", "n=40", "one after the other");
  explained("verlet:blocking=none", "n=40", "side by side");
  explained("composition", "n=40", "one after the other");
  explained("galerkin", "n=40", "side by side");
  explained("galerkin:degree=8", "n=20", "side by side");
  explained("galerkin:degree=8", "n=21", "one after the other");
}
END_TEST

SUITE(ensemble_explain)
{
  tcase_add_test(tests, explain_says_how_members_are_grouped);
  tcase_add_test(tests, waves_are_not_given_up_for_members_as_lanes);
}
