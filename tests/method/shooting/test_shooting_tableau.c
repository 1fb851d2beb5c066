/* labels: unit */
/* One-step methods of shooting: tableaus, their order conditions, built in and from files. */
#define _POSIX_C_SOURCE 200809L /* mkfifo */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "step/onestep/runge_kutta.h"
#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"

START_TEST(tableaus_have_the_order_that_they_claim_and_no_more)
{
  int fewest, most;
  dvi__runge_kutta method;
  dvi__runge_kutta_range(_i, &fewest, &most);
  for (int stages = fewest; stages <= most; stages++) {
    ck_assert_int_eq(dvi__runge_kutta_named(_i, stages, &method), DVI_OK);
    ck_assert_int_eq(dvi__runge_kutta_check(&method, method.order), DVI_OK);
    if (method.order < DVI__TREES_MOST)
      ck_assert_int_eq(dvi__runge_kutta_check(&method, method.order + 1), DVI_BAD_OPTION);
  }
}
END_TEST

/* A coefficient that is off by 1e-6 breaks a condition whichever it is. */
START_TEST(every_coefficient_counts)
{
  dvi__runge_kutta method;
  ck_assert_int_eq(dvi__runge_kutta_named(8, 11, &method), DVI_OK);
  ck_assert_int_eq(method.order, 8);
  for (int i = 0; i < method.stages; i++)
    for (int j = 0; j < i; j++) {
      const double exact = method.a[i][j];
      method.a[i][j] += 1e-6;
      method.c[i] += 1e-6;
      ck_assert_int_eq(dvi__runge_kutta_check(&method, 8), DVI_BAD_OPTION);
      method.a[i][j] = exact;
      method.c[i] -= 1e-6;
    }
}
END_TEST

static const char *written(const char *text)
{
  static const char *const path = "shooting.tableau";
  FILE *file = fopen(path, "w");
  ck_assert_ptr_nonnull(file);
  ck_assert_int_ge(fputs(text, file), 0);
  ck_assert_int_eq(fclose(file), 0);
  return path;
}

START_TEST(a_tableau_in_a_file_is_the_built_in_one)
{
  problem *model = create_problem("kepler", NULL);
  const char *path = written("# Kutta 1901\norder 4\nc 0 1/2 1/2 1\na\na 1/2\na 0 0.5\na 0 0 1 # "
                             "the last one\nb 1/6 1/3 1/3 1/6\n");
  dvi_integrator *file = start_integrator(model, method_spec("shooting:tableau=%s", path)),
                 *built_in = start_integrator(model, "shooting:onestep=rk4");
  ck_assert_int_eq(dvi_integrator_order(file), 4);
  ck_assert_str_eq(dvi_integrator_method(file),
                   "shooting:onestep=file,stages=4,tableau=shooting.tableau,composition=none,"
                   "quadrature=simpson,nodes=3,terms=0,solve=shot,tolerance=auto,type=1");
  advance(file, 0.05, 20);
  advance(built_in, 0.05, 20);
  ck_assert_mem_eq(dvi_integrator_q(file), dvi_integrator_q(built_in), 2 * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(file), dvi_integrator_p(built_in), 2 * sizeof(double));
  dvi_integrator_destroy(&file);
  dvi_integrator_destroy(&built_in);
  problem_destroy(&model);
  ck_assert_int_eq(remove(path), 0);
}
END_TEST

static const struct {
  const char *text, *words;
} broken[] = {
    {"order 4\na\na 1/2\nb 0 1\n",
     "has not order 3: the sum of its condition for the tree [[[]]] is 0, not 1/6"},
    {"order 1\na\nb 2\n", "has not order 1: the sum of its condition for the tree [] is 2, not 1"},
    {"order 2\na\na 0.666667\nb 1/4 3/4\n",
     "is 0.50000025, not 1/2, to 1e-12; are the decimals cut off?"},
    {"order 2\na\na 2/3\nb 1/4 3/4\nc 0 0.666667\n",
     "has the sum 0.666666666666667, but c is 0.666667 there, to 1e-12"},
    {"order 2\na\na 1/2\nb 0 1\nc 0 1\n", "row 2 of a has the sum 0.5, but c is 1 there"},
    {"order 2\na\na 1/x\nb 0 1\n",
     "shooting.tableau:3:5: a number other than 0 is expected behind the stroke"},
    {"order 2\na\na 1/2,0\n", "shooting.tableau:3:6: a blank is expected behind the number"},
    {"order 2\na\n a half\n", "shooting.tableau:3:4: a number is expected"},
    {"order two\n", "shooting.tableau:1:7: a number is expected"},
    {"order 2.5\n", "shooting.tableau:1:7: the order is one whole number"},
    {"order 1\norder 1\n", "shooting.tableau:2:1: the order is given twice"},
    {"weights 1\n", "shooting.tableau:1:1: order, a, b or c is expected"},
    {"b 1\nb 1\n", "shooting.tableau:2:1: this row is given twice"},
    {"a\nb 1\n", "the order is missing"},
    {"order 1\na\na\nb 1\n",
     "rows of a: 2, numbers of b: 1, of c: 0; as many of each are needed, or none of c"},
    {"order 1\na 0 1\nb 1\n", "row 1 of a has more numbers than there are stages"},
    {"order 1\na\nb 1e999\n", "shooting.tableau:3:3: the number is not finite"},
    {"order 1\nb 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1\n", "methods of up to 16 stages are possible"},
};
enum { BROKEN = sizeof broken / sizeof *broken };

START_TEST(broken_files_are_refused)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *none = NULL;
  const char *path = written(broken[_i].text);
  ck_assert_int_eq(
      dvi_integrator_create(model->system, method_spec("shooting:tableau=%s", path), &none),
      DVI_BAD_OPTION);
  check_words(broken[_i].words);
  ck_assert_ptr_null(none);
  problem_destroy(&model);
  ck_assert_int_eq(remove(path), 0);
}
END_TEST

static void check_refused(const char *path, const char *words)
{
  dvi__runge_kutta method;
  ck_assert_int_eq(dvi__runge_kutta_read(path, &method), DVI_BAD_OPTION);
  check_words(words);
}

START_TEST(what_is_no_text_is_refused)
{
  static const char behind[] = "order 1\na\nb 1\n#\0\nb 7\n";
  const char *path = written("");
  FILE *file = fopen(path, "w");
  ck_assert_ptr_nonnull(file);
  ck_assert_uint_eq(fwrite(behind, 1, sizeof behind - 1, file), sizeof behind - 1);
  ck_assert_int_eq(fclose(file), 0);
  check_refused(path, "shooting.tableau:4:2: a byte of 0");
  check_refused(".", ". cannot be read: it is no regular file");
  check_refused("/dev/zero", "/dev/zero cannot be read: it is no regular file");
  ck_assert_int_eq(remove(path), 0);
  check_refused(path, "shooting.tableau cannot be read: No such file");
  ck_assert_int_eq(mkfifo(path, 0600), 0);
  check_refused(path, "shooting.tableau cannot be read: it is no regular file");
  ck_assert_int_eq(remove(path), 0);
}
END_TEST

/* The last character that a file may have still counts, without a new line behind it. */
START_TEST(files_have_a_most)
{
  enum { MOST = 65536, TAIL = 4 };
  static const char head[] = "order 1\na\n";
  char *text = malloc(MOST + 2);
  dvi__runge_kutta method;
  ck_assert_ptr_nonnull(text);
  memset(text, '\n', MOST + 1);
  memcpy(text, head, sizeof head - 1);
  memcpy(text + MOST - TAIL, " b 1", TAIL + 1);
  ck_assert_int_eq(dvi__runge_kutta_read(written(text), &method), DVI_OK);
  ck_assert_double_eq(method.b[0], 1);
  memcpy(text + MOST - TAIL, "\nb 1\n", TAIL + 2);
  check_refused(written(text), "shooting.tableau has more than 65536 characters");
  ck_assert_int_eq(remove("shooting.tableau"), 0);
  free(text);
}
END_TEST

SUITE(shooting_tableau)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, tableaus_have_the_order_that_they_claim_and_no_more, 0, DVI__RK_NAMED);
  tcase_add_test(tests, every_coefficient_counts);
  tcase_add_test(tests, a_tableau_in_a_file_is_the_built_in_one);
  tcase_add_loop_test(tests, broken_files_are_refused, 0, BROKEN);
  tcase_add_test(tests, what_is_no_text_is_refused);
  tcase_add_test(tests, files_have_a_most);
}
