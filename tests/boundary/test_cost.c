/* labels: unit */
/* The cost of a path is proportional to its steps, it has one symbolic analysis, and it survives
 * every failure of memory. */
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/heap.h"
#include "support/runs.h"
#include "support/suite.h"

enum { BODIES = 18 };

/* Ten steps of 100 days each, or so many shorter ones, between two places of the planets. */
static dvi_path *planets(const problem *model, int steps, const double *q1)
{
  dvi_path *path = NULL;
  const dvi_path_options options = {.ends = DVI_ENDS_FIXED,
                                    .steps = steps,
                                    .span = 1000,
                                    .dimension = BODIES,
                                    .q0 = model->q,
                                    .q1 = q1};
  ck_assert_msg(dvi_path_create(model->system, "midpoint", &options, &path) == DVI_OK, "%s",
                dvi_last_error());
  return path;
}

/* Twice as many steps take twice the memory, twice the evaluations, and as many factorisations. */
START_TEST(memory_and_work_are_in_proportion_to_the_steps)
{
  problem *model = create_problem("outer-solar", NULL);
  double q1[BODIES];
  long bytes[3];
  dvi_counters counters[3];
  dvi_integrator *stepped = start_integrator(model, "midpoint");
  advance(stepped, 10, 100);
  memcpy(q1, dvi_integrator_q(stepped), sizeof q1);
  dvi_integrator_destroy(&stepped);
  dvi_path *first = planets(model, 2, q1); /* it completes the system */
  dvi_path_destroy(&first);
  for (int k = 0; k < 3; k++) {
    const long before = heap_bytes();
    dvi_path *path = planets(model, 100 << k, q1);
    ck_assert_msg(dvi_path_solve(path, NULL) == DVI_OK, "%s", dvi_last_error());
    bytes[k] = heap_bytes() - before;
    dvi_path_counters(path, &counters[k]);
    dvi_path_destroy(&path);
    ck_assert_int_eq(heap_bytes(), before);
  }
  for (int k = 1; k < 3; k++) {
    /* The sanitizers do not let the heap be counted, and valgrind does not tell sizes. */
    if (heap_is_counted() && bytes[0] > 0)
      ck_assert_msg(10 * bytes[k] > 19 * bytes[k - 1] && 10 * bytes[k] < 21 * bytes[k - 1],
                    "%ld %ld", bytes[k - 1], bytes[k]);
    ck_assert_int_eq(counters[k].symbolic, 1);
    ck_assert(labs(counters[k].factorizations - counters[k - 1].factorizations) <= 1);
    ck_assert_double_lt((double)counters[k].hessians, 2.5 * (double)counters[k - 1].hessians);
  }
  problem_destroy(&model);
}
END_TEST

/* A closed path of three bodies with four symmetries and a free period, each of which has a full
 * row and column in the Jacobian. It has four times the steps, and perhaps a second order of pivots
 * beside the first one. Fill-in would be sixteen times as much. */
START_TEST(full_rows_and_columns_leave_it_in_proportion)
{
  problem *model = create_problem("figure-eight", NULL);
  long bytes[2];
  for (int k = 0; k < 2; k++) {
    const int steps = 400 << 2 * k;
    const dvi_path_options options = {.ends = DVI_ENDS_PERIODIC,
                                      .steps = steps,
                                      .span = 6.32591398,
                                      .free_span = 1,
                                      .energy = -1.287142};
    double *t = calloc((size_t)steps + 1, sizeof *t),
           *q = calloc(6 * ((size_t)steps + 1), sizeof *q);
    dvi_integrator *stepped = start_integrator(model, "midpoint");
    for (int m = 0; m <= steps; m++) {
      t[m] = m;
      memcpy(q + (size_t)6 * (size_t)m, dvi_integrator_q(stepped), 6 * sizeof *q);
      advance(stepped, options.span / steps, 1);
    }
    dvi_integrator_destroy(&stepped);
    const long before = heap_bytes();
    dvi_path *path = NULL;
    ck_assert_msg(dvi_path_create(model->system, "midpoint", &options, &path) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_int_eq(dvi_path_guess(path, steps + 1, 6, t, q), DVI_OK);
    ck_assert_msg(dvi_path_solve(path, NULL) == DVI_OK, "%s", dvi_last_error());
    bytes[k] = heap_bytes() - before;
    dvi_path_destroy(&path);
    free(t);
    free(q);
  }
  if (heap_is_counted() && bytes[0] > 0)
    ck_assert_msg(bytes[1] < 8 * bytes[0], "%ld %ld", bytes[0], bytes[1]);
  problem_destroy(&model);
}
END_TEST

static dvi_status closed(const problem *model, dvi_path **path)
{
  const double turn[] = {-1, 0, 0, -1};
  const dvi_path_options options = {.ends = DVI_ENDS_PERIODIC,
                                    .steps = 6,
                                    .span = 3,
                                    .dimension = 2,
                                    .symmetry = turn,
                                    .free_span = 1,
                                    .energy = -0.5};
  return dvi_path_create(model->system, "galerkin:degree=3", &options, path);
}

START_TEST(a_path_survives_every_failure_of_memory)
{
  problem *model = create_problem("kepler", NULL);
  dvi_path *path = NULL;
  ck_assert_int_eq(closed(model, &path), DVI_OK); /* the first one completes the system */
  dvi_path_destroy(&path);
  const long before = dvi__allocation_count(), bytes = heap_bytes();
  ck_assert_int_eq(closed(model, &path), DVI_OK);
  const long needed = dvi__allocation_count() - before;
  dvi_path_destroy(&path);
  for (long successes = 0; successes < needed; successes++) {
    path = (dvi_path *)model;
    dvi__fail_allocations_after(successes);
    const dvi_status status = closed(model, &path);
    dvi__fail_allocations_after(-1);
    ck_assert_msg(status == DVI_NO_MEMORY, "%ld: %s: %s", successes, dvi_status_name(status),
                  dvi_last_error());
    ck_assert_ptr_null(path);
  }
  ck_assert_int_eq(heap_bytes(), bytes);
  problem_destroy(&model);
}
END_TEST

/* A solve gives back all memory that it takes. Without memory the path stays as it was. */
START_TEST(a_solve_without_memory_fails)
{
  problem *model = create_problem("pendulum", NULL);
  const double q0[] = {1}, q1[] = {2};
  const dvi_path_options options = {
      .ends = DVI_ENDS_FIXED, .steps = 20, .span = 1, .dimension = 1, .q0 = q0, .q1 = q1};
  dvi_path *path = NULL;
  ck_assert_int_eq(dvi_path_create(model->system, "galerkin:degree=2", &options, &path), DVI_OK);
  for (long successes = 0; successes < 4; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi_path_solve(path, NULL);
    dvi__fail_allocations_after(-1);
    ck_assert_int_eq(status, DVI_NO_MEMORY);
    ck_assert_ptr_null(dvi_path_p(path, 0));
    ck_assert_double_eq_tol(dvi_path_q(path, 10)[0], 1.5, 1e-15);
  }
  ck_assert_int_eq(dvi_path_solve(path, NULL), DVI_OK);
  dvi_path_destroy(&path);
  problem_destroy(&model);
}
END_TEST

SUITE(cost)
{
  tcase_add_test(tests, memory_and_work_are_in_proportion_to_the_steps);
  tcase_add_test(tests, full_rows_and_columns_leave_it_in_proportion);
  tcase_add_test(tests, a_path_survives_every_failure_of_memory);
  tcase_add_test(tests, a_solve_without_memory_fails);
}
