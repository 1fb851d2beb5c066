/* The first step that needs a solver prepares it, as counters tell. A step that finds no memory for
 * it changes nothing. */
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/files.h"
#include "support/heap.h"
#include "support/prepared.h"
#include "support/runs.h"
#include "support/suite.h"

enum { MOST = 400, NUMBERS = 200 };

/* Each at a step that Newton's methods, KINSOL, or a branch have to solve. */
typedef struct place {
  const char *problem, *setting, *method;
  double h;
} place;

static const place places[] = {
    {"fpu", "ell=40", "galerkin:degree=3", 0.1},
    {"fpu", "ell=40", "galerkin:degree=3,solver=newton", 0.1},
    {"fpu", "ell=40", "galerkin:degree=2,solver=kinsol", 0.1},
    {"fpu", "ell=40", "galerkin:degree=2,solver=certified", 0.02},
    {"fpu", "ell=40", "composition:order=4,base=midpoint", 0.1},
    {"fpu", "ell=40", "imex", 0.1},
    {"outer-solar", NULL, "galerkin:degree=4,solver=newton", 100},
    {"double-pendulum", NULL, "trapezoidal", 0.1},
    {"kepler", "e=0.9", "midpoint", 0.03},
    {"kepler", NULL, "sem:degree=2", 0.1},
    {"heavy-top", NULL, "lie-galerkin:degree=2", 0.01},
    {"massless-particle", "gauge=singular", "dvrk:nodes=2", 0.1},
};
enum { PLACES = sizeof places / sizeof *places };

/* imex has no solver but for potentials that are not declared quadratic, galerkin for such ones. */
static problem *create_place(const place *at)
{
  return strcmp(at->method, "imex") == 0 ? create_problem(at->problem, at->setting)
                                         : create_undeclared_problem(at->problem, at->setting);
}

static int has_state_of(const dvi_integrator *integrator, const problem *model)
{
  return dvi_integrator_time(integrator) == 0 &&
         memcmp(dvi_integrator_q(integrator), model->q, (size_t)model->nq * sizeof(double)) == 0 &&
         memcmp(dvi_integrator_p(integrator), model->p, (size_t)model->nv * sizeof(double)) == 0;
}

/* Makes every allocation of the library in the first step fail. Then the integrator goes on as one
 * that never failed. */
START_TEST(a_step_without_memory_for_its_solver_leaves_the_state)
{
  problem *model = create_place(&places[_i]);
  dvi_integrator *integrator = start_integrator(model, places[_i].method),
                 *other = start_integrator(model, places[_i].method);
  const long before = dvi__allocation_count();
  advance(other, places[_i].h, 1);
  const long needed = dvi__allocation_count() - before;
  ck_assert(needed > 0 && needed < MOST);
  dvi_status status = DVI_NO_MEMORY;
  int failures = 0;
  while (status != DVI_OK) {
    dvi__fail_allocations_after(failures); /* what earlier ones took stays taken */
    status = dvi_integrator_step(integrator, places[_i].h);
    dvi__fail_allocations_after(-1);
    if (status == DVI_OK) break;
    ck_assert_msg(status == DVI_NO_MEMORY, "%s: %s", dvi_status_name(status), dvi_last_error());
    check_words("no memory");
    ck_assert(has_state_of(integrator, model));
    ck_assert_int_lt(++failures, MOST);
  }
  ck_assert_int_gt(failures, 0);
  ck_assert_int_eq(read_counters(integrator).failed_steps, failures);
  advance(integrator, places[_i].h, 4);
  advance(other, places[_i].h, 4);
  ck_assert_mem_eq(dvi_integrator_q(integrator), dvi_integrator_q(other),
                   (size_t)model->nq * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(integrator), dvi_integrator_p(other),
                   (size_t)model->nv * sizeof(double));
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&other);
  problem_destroy(&model);
}
END_TEST

/* Makes every request of the program fail, those of KLU, too. SUNDIALS 6.4 ends the program if it
 * has no memory for its context. */
START_TEST(a_step_survives_every_failure_of_the_heap)
{
  problem *model = create_place(&places[_i]);
  const int needs_kinsol = strstr(places[_i].method, "kinsol") != NULL ||
                           strstr(places[_i].method, "certified") != NULL;
  if (heap_is_counted() && !needs_kinsol) {
    const long bytes_before = heap_bytes();
    dvi_integrator *integrator = start_integrator(model, places[_i].method);
    int failures = 0;
    dvi_status status = DVI_NO_MEMORY;
    while (status != DVI_OK) {
      heap_fail_after(failures);
      status = dvi_integrator_step(integrator, places[_i].h);
      heap_fail_after(-1);
      if (status == DVI_OK) break;
      ck_assert_msg(status == DVI_NO_MEMORY, "%d: %s: %s", failures, dvi_status_name(status),
                    dvi_last_error());
      ck_assert(has_state_of(integrator, model));
      dvi_integrator_destroy(&integrator);
      integrator = start_integrator(model, places[_i].method);
      ck_assert_int_lt(++failures, 20 * MOST);
    }
    ck_assert_int_gt(failures, 0);
    dvi_integrator_destroy(&integrator);
    /* what the system and the libraries keep */
    ck_assert_int_le(heap_bytes() - bytes_before, 20000);
  }
  problem_destroy(&model);
}
END_TEST

/* At create nothing is analysed. Each solver analyses at its first use, and never again. */
START_TEST(a_ladder_prepares_each_rung_when_it_is_needed)
{
  problem *model = create_undeclared_problem("fpu", "ell=40");
  dvi_integrator *integrator = start_integrator(model, "galerkin:degree=3");
  dvi_counters counters = read_counters(integrator);
  ck_assert_int_eq(counters.symbolic + counters.factorizations + counters.preparations, 0);
  const long created = counters.allocations;
  advance(integrator, 0.001, 20); /* fixed point iteration */
  counters = read_counters(integrator);
  ck_assert_int_eq(counters.fixed_points, 20);
  ck_assert_int_eq(counters.symbolic + counters.factorizations + counters.preparations, 0);
  ck_assert_int_eq(counters.allocations, created);
  advance(integrator, 0.1, 1); /* simplified Newton's method, of one real system and a pair */
  counters = read_counters(integrator);
  ck_assert_int_eq(counters.simplified, 1);
  ck_assert_int_eq(counters.symbolic, 1 + (counters.newtons + counters.followed > 0));
  ck_assert_int_ge(counters.preparations, 2);
  const dvi_counters first = counters;
  advance(integrator, 0.1, 20);
  advance(integrator, 0.09, 20);
  counters = read_counters(integrator);
  ck_assert_int_le(counters.symbolic, 2);
  /* the whole Jacobian, and a branch */
  ck_assert_int_le(counters.preparations - first.preparations, 2);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* A state that was saved before a solver was prepared, or after, goes on with the same digits. */
START_TEST(checkpoints_do_not_see_what_is_prepared)
{
  problem *model = create_place(&places[_i]);
  dvi_integrator *whole = start_integrator(model, places[_i].method),
                 *later = create_integrator(model->system, places[_i].method);
  advance(whole, places[_i].h, 3);
  ck_assert_msg(dvi_integrator_save(whole, path_in_folder("checkpoint")) == DVI_OK, "%s",
                dvi_last_error());
  advance(whole, places[_i].h, 5);
  ck_assert_msg(dvi_integrator_restore(later, path_in_folder("checkpoint")) == DVI_OK, "%s",
                dvi_last_error());
  advance(later, places[_i].h, 5);
  ck_assert_mem_eq(dvi_integrator_q(whole), dvi_integrator_q(later),
                   (size_t)model->nq * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(whole), dvi_integrator_p(later),
                   (size_t)model->nv * sizeof(double));
  dvi_integrator_destroy(&whole);
  dvi_integrator_destroy(&later);
  problem_destroy(&model);
}
END_TEST

/* A value of a potential with as many coordinates, whose Hessian counts as full. */
static int uncoupled(double t, const double *q, double *V, void *user)
{
  (void)t, *V = 0;
  for (int i = 0; i < *(const int *)user; i++) *V += 0.5 * q[i] * q[i];
  return 0;
}

static int uncoupled_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t;
  memcpy(V_q, q, (size_t) * (const int *)user * sizeof *q);
  return 0;
}

/* n^2 numbers would be 800 MB, and (2 n)^2 four times that. */
START_TEST(a_pattern_that_was_left_out_costs_nothing_before_it_is_needed)
{
  int n = 10000;
  const dvi_potential potential = {.value = uncoupled, .gradient = uncoupled_gradient, .user = &n};
  const dvi_system_terms terms = {
      .dimension = n, .mass.scalar = 1, .potentials = &potential, .potential_count = 1};
  dvi_system *system = NULL;
  double *numbers = calloc(2 * (size_t)n, sizeof *numbers);
  ck_assert_ptr_nonnull(numbers);
  numbers[0] = 1;
  const long before = heap_bytes();
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, "galerkin:degree=2");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, numbers, numbers + n), DVI_OK);
  advance(integrator, 0.1, 5);
  ck_assert_int_eq(read_counters(integrator).fixed_points, 5);
  ck_assert_int_lt(heap_bytes() - before, 100L * n * (long)sizeof(double));
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  free(numbers);
}
END_TEST

SUITE(late)
{
  tcase_set_timeout(tests, 120);
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, a_step_without_memory_for_its_solver_leaves_the_state, 0, PLACES);
  tcase_add_loop_test(tests, a_step_survives_every_failure_of_the_heap, 0, PLACES);
  tcase_add_test(tests, a_ladder_prepares_each_rung_when_it_is_needed);
  tcase_add_loop_test(tests, checkpoints_do_not_see_what_is_prepared, 0, PLACES);
  tcase_add_test(tests, a_pattern_that_was_left_out_costs_nothing_before_it_is_needed);
}
