/* Large mechanisms: the cost of a step grows as the number of bodies. Counters and memory tell;
 * docs/performance.md has the times, "Large mechanisms". */
#include <math.h>
#include <stdio.h>

#include "support/heap.h"
#include "support/prepared.h"
#include "support/runs.h"
#include "support/suite.h"

enum { STEPS = 20 };

static problem *create_linkage(const char *form, int links)
{
  char form_setting[16], links_setting[16], message[256] = "";
  const char *const settings[] = {form_setting, links_setting};
  problem *made = NULL;
  (void)snprintf(form_setting, sizeof form_setting, "form=%s", form);
  (void)snprintf(links_setting, sizeof links_setting, "links=%d", links);
  ck_assert_msg(problem_create("linkage", 2, settings, &made, message, sizeof message) == DVI_OK,
                "%s", message);
  return made;
}

typedef struct cost {
  double bytes, residuals, factorizations;
} cost;

/* Measures the memory of an integrator, and the work of a step after some. */
static cost measure(const char *form, int links, const char *method)
{
  problem *model = create_linkage(form, links);
  const long before = heap_bytes();
  double off;
  dvi_integrator *integrator = start_integrator(model, method);
  advance(integrator, 0.01, STEPS);
  const dvi_counters early = read_counters(integrator);
  advance(integrator, 0.01, STEPS);
  const dvi_counters late = read_counters(integrator);
  ck_assert_int_eq(late.preparations, early.preparations);
  ck_assert_int_eq(dvi_integrator_constraint(integrator, &off), DVI_OK);
  ck_assert_double_le(off, 4 * 0x1p-52 * (1 + links));
  const cost found = {.bytes = (double)(heap_bytes() - before),
                      .residuals = (double)(late.residuals - early.residuals) / STEPS,
                      .factorizations = (double)(late.factorizations - early.factorizations) /
                                        STEPS};
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
  return found;
}

/* The number of links grows thirtyfold. */
START_TEST(memory_is_linear_and_iterations_do_not_grow)
{
  static const struct {
    const char *form, *method;
    double residuals, factorizations;
  } cases[] = {{"tree", "verlet", 4.1, 1.05},
               {"ring", "verlet", 4.1, 1.05},
               {"tree", "galerkin:degree=2", 10, 5.6},
               {"ring", "galerkin:degree=2", 10, 5.6}};
  const int links = repeats(1000);
  const cost small = measure(cases[_i].form, 33, cases[_i].method),
             large = measure(cases[_i].form, links, cases[_i].method);
  if (small.bytes > 0) /* valgrind counts no bytes of its own */
    ck_assert_double_le(log(large.bytes / small.bytes) / log(links / 33.0), 1.1);
  ck_assert_double_le(small.residuals, cases[_i].residuals);
  ck_assert_double_le(large.residuals, cases[_i].residuals);
  ck_assert_double_le(small.factorizations, cases[_i].factorizations);
  ck_assert_double_le(large.factorizations, cases[_i].factorizations);
}
END_TEST

/* Roundings of places far from the origin move all angles of a long chain a little. Rows of angles
 * are then left with squares of these motions, which are above their own roundings. */
START_TEST(a_long_chain_starts_at_every_degree)
{
  static const char *const methods[] = {"trapezoidal", "galerkin:degree=2", "galerkin:degree=3"};
  problem *model = create_linkage("ring", repeats(1200));
  dvi_integrator *integrator = start_integrator(model, methods[_i]);
  double before, after;
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &before), DVI_OK);
  advance(integrator, 0.01, 3);
  ck_assert_int_eq(read_counters(integrator).followed, 0);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &after), DVI_OK);
  ck_assert_double_eq_tol(after, before, 1e-8 * fabs(before));
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(linkage)
{
  tcase_add_loop_test(tests, memory_is_linear_and_iterations_do_not_grow, 0, 4);
  tcase_add_loop_test(tests, a_long_chain_starts_at_every_degree, 0, 3);
}
