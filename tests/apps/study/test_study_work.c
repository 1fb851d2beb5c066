/* The cost of small errors, and the number of digits that can be trusted, of subjects that are no
 * motions. */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "apps/study/subjects.h"
#include "study/asked.h"
#include "study/trust_levels.h"
#include "study/work_table.h"
#include "support/suite.h"

/* --- Work against error. --- */

/* Applies Simpson's rule on halves until two levels agree, refined by a tolerance. */
static dvi_status adaptive_run(void *user, double tolerance, study_level *level)
{
  rule *r = user;
  double last = 0.0, panels = 1.0;
  long all = 0;
  for (int k = 0; k < 20; k++, panels *= 2.0) {
    const double found = integral(r, panels);
    all += r->evaluations;
    level->error = fabs(found - r->exact);
    if (k > 0 && fabs(found - last) <= tolerance) break;
    last = found;
  }
  level->parts = panels;
  level->counted[0] = (double)all;
  return DVI_OK;
}

static dvi_status adaptive_repeat(void *user, double tolerance, double *preparation)
{
  study_level level = {.number = NULL};
  *preparation = (double)NAN;
  return adaptive_run(user, tolerance, &level);
}

static void adaptive_setting(void *user, double tolerance, char *text, size_t size)
{
  (void)user;
  (void)snprintf(text, size, "tol=%.0e", tolerance);
}

static int count_named(const work *w, const char *name)
{
  int count = 0;
  for (int i = 0; i < w->jobs; i++) count += strcmp(w->job[i].subject->name, name) == 0;
  return count;
}

START_TEST(what_small_errors_cost_is_found_for_rules_and_for_tolerances)
{
  static const double tolerance[] = {1e-4, 1e-6, 1e-8, 1e-10};
  static work_job job[100];
  const numbers asked = {.count = 1, .number = {1e-9}, .text = {"1e-9"}};
  rule rules[] = {trapezoids(), simpson(), simpson()};
  study_subject low = subject_of(&rules[0], "trapezoids", 2);
  study_subject high = subject_of(&rules[1], "simpson", 4);
  study_subject adaptive = subject_of(&rules[2], "adaptive", 4);
  work w = {.command = "test", .judge_error = DBL_EPSILON, .asked = &asked, .rounds = 3};
  bool lost;
  w.room = 100;
  w.job = job;
  adaptive.run = adaptive_run;
  adaptive.repeat = adaptive_repeat;
  adaptive.setting = adaptive_setting;
  ck_assert_int_eq(work_add_levels(&w, &low, &low, 5, &lost), DVI_OK);
  ck_assert_int_eq(work_add_levels(&w, &high, &high, 0, &lost), DVI_OK);
  work_add_tolerances(&w, &adaptive, 4, tolerance, 2);
  ck_assert_int_eq(lost, 0);
  ck_assert_int_eq(count_named(&w, "trapezoids"), 5);
  ck_assert_int_ge(count_named(&w, "simpson"), 6);
  ck_assert_int_ge(count_named(&w, "adaptive"), 2);
  ck_assert_str_eq(w.job[w.jobs - 1].setting + 3, "=1e-08"); /* there the asked error is met */
  ck_assert_int_eq(work_run(&w, NULL), DVI_OK);

  table_column columns[WORK_COLUMNS_MAX], at[ASKED_COLUMNS_MAX];
  work_columns(&rule_words, columns);
  asked_columns(&rule_words, at);
  result_table *rows = work_table(&w, columns), *answers = asked_table(&w, at);
  ck_assert_int_eq(table_rows(rows), w.jobs);
  ck_assert_int_eq(table_rows(answers), 3);
  ck_assert_str_eq(table_title(answers, 3), "rule");
  ck_assert_str_eq(table_title(answers, 8), "setup_seconds");
  ck_assert_str_eq(table_text_at(answers, 0, 7), "not reached"); /* in five levels of order 2 */
  const double of_simpson = table_number_at(answers, 1, 6);
  ck_assert_double_gt(of_simpson, 0.0);
  ck_assert_double_lt(of_simpson, table_number_at(answers, 2, 6)); /* no level is run in vain */
  table_destroy(&rows);
  table_destroy(&answers);
}
END_TEST

START_TEST(a_level_without_a_result_is_left_out)
{
  static work_job job[4];
  const numbers none = {.count = 0};
  rule r = simpson();
  const study_subject subject = subject_of(&r, "simpson", 4);
  work w = {.command = "test", .asked = &none, .rounds = 1, .room = 4, .job = job};
  r.odd_fails = 1;
  ck_assert_int_eq(work_add(&w, &subject, 8.0), DVI_OK);
  ck_assert_int_eq(work_add(&w, &subject, 9.0), DVI_OK);
  ck_assert_int_eq(work_add(&w, &subject, 10.0), DVI_OK);
  ck_assert_int_eq(w.jobs, 2);
  ck_assert_str_eq(w.job[1].setting, "width=0.1");
}
END_TEST

/* --- Digits. --- */

enum { NUMBERS = 3, FIRST_CELLS = 64 };

/* Refinement 1 is a mesh of FIRST_CELLS cells. */
static dvi_status mesh_run(void *user, double refinement, study_level *level)
{
  return poisson_run(user, FIRST_CELLS * refinement, level);
}

/* Another way to the same numbers, right to 1e-12, or off by what it is told. */
static dvi_status witness_run(void *user, double refinement, study_level *level)
{
  const double *off = user, pi = acos(-1.0), h = 1.0 / FIRST_CELLS;
  const double exact[NUMBERS] = {sin(pi * h * ((FIRST_CELLS - 1) / 2 + 1)),
                                 sin(pi * h * ((FIRST_CELLS - 1) / 4 + 1)), pi};
  for (int i = 0; i < NUMBERS; i++) level->number[i] = exact[i] + *off + 1e-12 / refinement;
  return DVI_OK;
}

/* The numbers of a node move with the mesh, so those are compared that stay. */
static dvi_status staying_run(void *user, double refinement, study_level *level)
{
  const dvi_status status = mesh_run(user, refinement, level);
  const double pi = acos(-1.0), h = 1.0 / (FIRST_CELLS * refinement), own = 1.0 / FIRST_CELLS;
  const int n = (int)lround(FIRST_CELLS * refinement) - 1;
  level->number[0] += sin(pi * own * ((FIRST_CELLS - 1) / 2 + 1)) - sin(pi * h * (n / 2 + 1));
  level->number[1] += sin(pi * own * ((FIRST_CELLS - 1) / 4 + 1)) - sin(pi * h * (n / 4 + 1));
  return status;
}

typedef struct trusted {
  trust_study study;
  double room[2 * TRUST_LEVELS + 3][NUMBERS];
} trusted;

static const trust_group groups[TRUST_GROUPS] = {{"values", 0, 2}, {"slopes", 2, 1}};

/* Measure with a witness that is off by so much. */
static void trust(trusted *t, double off)
{
  const study_subject mesh = {.run = staying_run};
  const study_subject witness = {.run = witness_run, .user = &off};
  trust_study *s = &t->study;
  *s = (trust_study){.count = NUMBERS, .group = groups};
  for (int k = 0; k < TRUST_LEVELS; k++) {
    s->number[k] = t->room[k];
    s->witness[k] = t->room[TRUST_LEVELS + k];
  }
  s->size = t->room[2 * TRUST_LEVELS];
  s->error = t->room[2 * TRUST_LEVELS + 1];
  s->witness_error = t->room[2 * TRUST_LEVELS + 2];
  ck_assert_int_eq(trust_run(s, &mesh), DVI_OK);
  for (int i = 0; i < NUMBERS; i++) s->size[i] = fabs(s->number[0][i]);
  trust_estimate(s);
  trust_hear(s, &witness);
}

START_TEST(errors_of_a_mesh_are_estimated_and_a_witness_agrees)
{
  trusted t;
  trust(&t, 0.0);
  ck_assert_double_eq_tol(t.study.verdict.ratio, 0.25, 0.01); /* of order 2 */
  ck_assert_int_eq(t.study.verdict.witness, 1);
  ck_assert_int_eq(t.study.verdict.contradicted, 0);
  for (int i = 0; i < NUMBERS; i++) {
    const double exact = t.study.witness[0][i], own = fabs(t.study.number[0][i] - exact);
    ck_assert_double_ge(t.study.error[i], 0.9 * own);
    ck_assert_double_le(t.study.error[i], 2.0 * own);
  }
}
END_TEST

START_TEST(a_witness_that_is_elsewhere_contradicts)
{
  trusted t;
  trust(&t, 0.01);
  ck_assert_int_eq(t.study.verdict.contradicted, 1);
  ck_assert_double_ge(t.study.error[0], 0.009);
}
END_TEST

SUITE(study_work)
{
  tcase_add_test(tests, what_small_errors_cost_is_found_for_rules_and_for_tolerances);
  tcase_add_test(tests, a_level_without_a_result_is_left_out);
  tcase_add_test(tests, errors_of_a_mesh_are_estimated_and_a_witness_agrees);
  tcase_add_test(tests, a_witness_that_is_elsewhere_contradicts);
}
