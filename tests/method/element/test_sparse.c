/* labels: slow long */
/* A long chain of springs: memory and Jacobian grow in proportion to its length, the pattern is
 * analysed once, no step allocates. Times are printed for the reader, not judged. */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "step/element/action.h"
#include "support/heap.h"
#include "support/prepared.h"
#include "support/runs.h"
#include "support/suite.h"

enum { STEPS = 10, LENGTHS = 4 };

static const int lengths[LENGTHS] = {100, 1000, 10000, 100000};
static const double h = 0.1;

typedef struct kind {
  const char *method;
  dvi__action_space space;
  int lengths;
} kind;

static const kind kinds[] = {
    {"midpoint", {DVI_LAGRANGE_LOBATTO, 1, DVI_MIDPOINT, 1}, LENGTHS},
    {"galerkin:degree=2", {DVI_LAGRANGE_LOBATTO, 2, DVI_GAUSS, 2}, LENGTHS - 1},
};

typedef struct measured {
  int n;
  long bytes;   /* of the integrator */
  long entries; /* of the Jacobian */
  double seconds;
} measured;

static long entries_of(const problem *model, const dvi__action_space *space)
{
  dvi__action *action;
  dvi_counters counters = {0};
  ck_assert_int_eq(dvi__action_create(model->system, space, &counters, &action), DVI_OK);
  ck_assert_int_eq(dvi__action_prepare_jacobian(action), DVI_OK);
  const long entries = dvi__pattern_entries(dvi__action_pattern(action));
  dvi__action_destroy(&action);
  return entries;
}

/* Takes steps of one chain, and asserts the facts that hold at every length. */
static void take_steps(dvi_integrator *integrator, measured *m)
{
  dvi_counters before, after;
  dvi_integrator_counters(integrator, &before);
  const clock_t start = clock();
  long calls = 0;
  int failed = 0;
  for (int i = 0; i < STEPS && !failed; i++) {
    dvi_status status;
    calls += count_calls_of_step(integrator, h, &status);
    failed = status != DVI_OK;
  }
  m->seconds = (double)(clock() - start) / CLOCKS_PER_SEC / (double)STEPS;
  ck_assert_msg(!failed, "%s", dvi_last_error());
  if (heap_is_counted()) ck_assert_int_eq(calls, 0);
  dvi_integrator_counters(integrator, &after);
  /* Nothing is analysed before a step needs it, and each pattern is analysed once, that of the
   * whole Jacobian and those of the decoupled systems. */
  ck_assert_int_eq(before.symbolic, 0);
  ck_assert_int_ge(after.symbolic, 1);
  ck_assert_int_le(after.symbolic, 2);
  /* omega h = 5, where fixed-point iteration does not contract */
  ck_assert_int_eq(after.simplified, STEPS);
  ck_assert_int_ge(after.factorizations, 1);
  /* Factors are kept while they are good. Some of the first steps are followed, with some factors
   * for each part. */
  ck_assert_int_lt(after.factorizations, STEPS + 24 * after.followed);
  ck_assert_int_le(after.followed, STEPS);
}

static void measure(const kind *k, int ell, measured *m)
{
  problem *model = create_undeclared_problem("fpu", method_spec("ell=%d", ell));
  m->n = model->nq;
  m->entries = entries_of(model, &k->space);
  const long before = heap_bytes();
  dvi_integrator *integrator = start_integrator(model, k->method);
  take_steps(integrator, m);
  m->bytes = heap_bytes() - before;
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}

/* A chain lacks a few entries at its two ends, and a few blocks do not grow with it. That is within
 * a tenth for the shortest chain. */
static void check_proportional(long small, int n, long large, int most)
{
  const double ratio = ((double)small / n) / ((double)large / most);
  ck_assert_msg(fabs(ratio - 1) < 0.1, "%ld for %d, %ld for %d: not in proportion (%.3f)", small, n,
                large, most, ratio);
}

START_TEST(memory_and_jacobian_grow_in_proportion_to_the_chain)
{
  const kind *k = &kinds[_i];
  const int count = is_short_run() ? LENGTHS - 1 : k->lengths;
  measured m[LENGTHS];
  const measured *longest = &m[count - 1];
  for (int i = 0; i < count; i++) measure(k, lengths[i], &m[i]);
  (void)printf("%s\n%10s %12s %12s %22s\n", k->method, "n", "entries", "bytes",
               "microseconds per step");
  for (int i = 0; i < count; i++)
    (void)printf("%10d %12ld %12ld %22.1f\n", m[i].n, m[i].entries, m[i].bytes, 1e6 * m[i].seconds);
  for (int i = 0; i < count; i++) {
    check_proportional(m[i].entries, m[i].n, longest->entries, longest->n);
    if (heap_is_counted()) check_proportional(m[i].bytes, m[i].n, longest->bytes, longest->n);
  }
}
END_TEST

SUITE(sparse)
{
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, memory_and_jacobian_grow_in_proportion_to_the_chain, 0,
                      sizeof kinds / sizeof *kinds);
}
