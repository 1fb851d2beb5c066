/* In a host program with a decimal comma the library reads and says the same. */
#include <dvi/dvi.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/comma.h"
#include "support/files.h"
#include "support/paced.h"
#include "support/runs.h"
#include "support/suite.h"

enum { TEXT_SIZE = 4096 };

/* The state after a few steps. */
typedef struct outcome {
  char method[TEXT_SIZE], explained[TEXT_SIZE], monitor[TEXT_SIZE], error[TEXT_SIZE];
  double q[64], p[64];
} outcome;

static void take_steps(const problem *model, dvi_integrator *integrator, outcome *seen)
{
  advance(integrator, 0.05, 5);
  (void)snprintf(seen->method, TEXT_SIZE, "%s", dvi_integrator_method(integrator));
  (void)snprintf(seen->monitor, TEXT_SIZE, "%s",
                 dvi_integrator_monitor(integrator) != NULL ? dvi_integrator_monitor(integrator)
                                                            : "");
  (void)dvi_integrator_explain(integrator, seen->explained, TEXT_SIZE);
  memcpy(seen->q, dvi_integrator_q(integrator), (size_t)model->nq * sizeof(double));
  memcpy(seen->p, dvi_integrator_p(integrator), (size_t)model->nv * sizeof(double));
  /* A sentence with numbers, of the state. */
  ck_assert_int_eq(dvi_run(integrator, &(dvi_run_options){.h = -0.25, .t_end = 1.5}, NULL),
                   DVI_BAD_ARGUMENT);
  (void)snprintf(seen->error, TEXT_SIZE, "%s", dvi_last_error());
  dvi_integrator_destroy(&integrator);
}

static void check_same(const outcome *expected, const outcome *found)
{
  ck_assert_str_eq(found->method, expected->method);
  ck_assert_str_eq(found->explained, expected->explained);
  ck_assert_str_eq(found->monitor, expected->monitor);
  ck_assert_str_eq(found->error, expected->error);
  ck_assert_mem_eq(found->q, expected->q, sizeof found->q);
  ck_assert_mem_eq(found->p, expected->p, sizeof found->p);
}

static const struct {
  const char *problem, *setting, *method, *monitor;
} runs[] = {
    {"fpu", "omega=50.5", "multiscale:omega=50.5", NULL},
    {"kepler", "e=0.25", "shooting:onestep=gauss,tolerance=1.5e-3", NULL},
    {"kepler", NULL, "shooting:tableau=half.tableau", NULL},
    {"lotka-volterra", NULL, "dg:degree=1,stiffness=0.125:1.5", NULL},
    {"kepler", "e=0.5", "galerkin:degree=2", "distance:power=1.25"},
    {"kepler", "e=0.5", "midpoint", "acceleration:power=0.5"},
};
enum { RUNS = sizeof runs / sizeof *runs };

static void run(int i, outcome *seen)
{
  problem *model = create_problem(runs[i].problem, runs[i].setting);
  memset(seen, 0, sizeof *seen);
  take_steps(model,
             runs[i].monitor != NULL ? start_paced_integrator(model, create_transformed,
                                                              runs[i].monitor, runs[i].method)
                                     : start_integrator(model, runs[i].method),
             seen);
  problem_destroy(&model);
}

START_TEST(specifications_lists_monitors_and_tableaus_are_read_the_same)
{
  static outcome point, comma;
  FILE *tableau = fopen("half.tableau", "w");
  ck_assert_ptr_nonnull(tableau);
  (void)fputs("order 4\nc 0 0.5 0.5 1\na\na 0.5\na 0 1/2\na 0 0 1\nb 0.5/3 1/3 1/3 1/6\n", tableau);
  ck_assert_int_eq(fclose(tableau), 0);
  run(_i, &point);
  set_comma_locale();
  run(_i, &comma);
  ck_assert_str_eq(localeconv()->decimal_point, ",");
  set_point_locale();
  ck_assert_int_eq(remove("half.tableau"), 0);
  check_same(&point, &comma);
}
END_TEST

START_TEST(commas_are_refused)
{
  dvi_monitor monitor;
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *none;
  set_comma_locale();
  ck_assert_int_eq(dvi_monitor_read("distance:power=1,5", &monitor), DVI_BAD_OPTION);
  ck_assert_int_eq(dvi_integrator_create(model->system, "shooting:tolerance=1,5", &none),
                   DVI_BAD_OPTION);
  set_point_locale();
  problem_destroy(&model);
}
END_TEST

START_TEST(the_command_writes_the_same_rows)
{
  char command[1024];
  set_comma_locale();
  for (int k = 0; k < 2; k++) {
    (void)snprintf(
        command, sizeof command,
        "LC_ALL=%s '%s' run kepler --set e=0.25 --method verlet --h 0.125 --t-end 1.5 --out %s",
        k == 0 ? "comma" : "C", DVI_COMMAND, path_in_folder(k == 0 ? "comma.csv" : "point.csv"));
    ck_assert_int_eq(system(command), 0); /* NOLINT(cert-env33-c): the command of the build */
  }
  set_point_locale();
  bytes comma = read_bytes(path_in_folder("comma.csv")),
        point = read_bytes(path_in_folder("point.csv"));
  ck_assert_uint_gt(point.count, 0);
  ck_assert_uint_eq(comma.count, point.count);
  ck_assert_mem_eq(comma.at, point.at, point.count);
  free(comma.at);
  free(point.at);
}
END_TEST

SUITE(locale)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, specifications_lists_monitors_and_tableaus_are_read_the_same, 0, RUNS);
  tcase_add_test(tests, commas_are_refused);
  tcase_add_test(tests, the_command_writes_the_same_rows);
}
