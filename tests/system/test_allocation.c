/* Every create must survive the failure of each of its allocations, with a status, without an
 * object or a leak (the sanitizer and valgrind runs of this test see the leaks). */
#include <string.h>

#include "core/memory.h"
#include "support/suite.h"
#include "support/systems/systems.h"
#include "system/evaluate/evaluator.h"

enum { MOST = 500 };

static behaviour quiet;

static int generator(const double *q, double *xi, void *user)
{
  (void)user;
  memcpy(xi, q, SITES * sizeof *xi);
  return 0;
}

/* All kinds of terms, all derivatives to be differenced. */
typedef struct scene {
  dvi_lagrangian lagrangian;
  dvi_potential potentials[2];
  dvi_symmetry symmetry;
  dvi_system_terms terms;
} scene;

enum { SPARSE_MASS, GENERAL, SCALAR_MASS, KINDS };

static void build_scene(scene *c, int kind)
{
  c->lagrangian = rotors(&quiet, BATCH);
  c->lagrangian.hessian_batch = NULL;
  c->lagrangian.gradient_batch = NULL;
  c->potentials[0] = springs(&quiet, BATCH);
  c->potentials[0].hessian_batch = NULL;
  c->potentials[1] = wells(&quiet, ONE_POINT);
  c->symmetry = (dvi_symmetry){"dilation", generator, NULL};
  c->terms = (dvi_system_terms){.dimension = SITES,
                                .potentials = c->potentials,
                                .potential_count = 2,
                                .symmetries = &c->symmetry,
                                .symmetry_count = 1};
  if (kind == GENERAL)
    c->terms.lagrangian = &c->lagrangian;
  else if (kind == SCALAR_MASS)
    c->terms.mass.scalar = 2;
  else
    c->terms.mass = (dvi_mass){.values = tridiagonal_mass, .pattern = tridiagonal};
}

static void out_of_memory(dvi_status status, const void *made)
{
  dvi__fail_allocations_after(-1);
  ck_assert_msg(status == DVI_NO_MEMORY, "%s: %s", dvi_status_name(status), dvi_last_error());
  ck_assert_ptr_null(made);
  check_words("no memory");
}

START_TEST(a_system_survives_every_failure)
{
  scene c;
  build_scene(&c, _i);
  const long before = dvi__allocation_count();
  dvi_system *s = make_system(&c.terms);
  const long needed = dvi__allocation_count() - before;
  dvi_system_destroy(&s);
  ck_assert(needed > 12 && needed < MOST);
  for (long successes = 0; successes < needed; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi_system_create(&c.terms, &s);
    out_of_memory(status, s);
  }
}
END_TEST

/* The next call uses the remains of a failure, or makes them anew. */
START_TEST(completing_a_system_survives_every_failure)
{
  scene c;
  build_scene(&c, _i);
  dvi_system *s = make_system(&c.terms);
  int failures = 0;
  for (long successes = 0; s->qq.start == NULL; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi__system_prepare_hessian(s);
    if (status != DVI_OK) out_of_memory(status, s->qq.start);
    failures += status != DVI_OK;
    dvi__fail_allocations_after(-1);
  }
  ck_assert_int_gt(failures, 5);
  ck_assert_int_eq(dvi__pattern_entries(&s->qq), 3 * SITES - 2);
  dvi_system_destroy(&s);
}
END_TEST

START_TEST(an_evaluator_survives_every_failure)
{
  scene c;
  build_scene(&c, _i);
  dvi_system *s = make_system(&c.terms);
  dvi__evaluator *e;
  ck_assert_int_eq(dvi__system_prepare_hessian(s), DVI_OK);
  const long before = dvi__allocation_count();
  ck_assert_int_eq(dvi__evaluator_create(s, 3, DVI__HESSIANS, NULL, &e), DVI_OK);
  const long needed = dvi__allocation_count() - before;
  dvi__evaluator_destroy(&e);
  ck_assert(needed > 10 && needed < MOST);
  for (long successes = 0; successes < needed; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi__evaluator_create(s, 3, DVI__HESSIANS, NULL, &e);
    out_of_memory(status, e);
  }
  dvi_system_destroy(&s);
}
END_TEST

/* Creates the object and its first factor, which takes the memory. The next call takes up the
 * remains of a failure. */
START_TEST(a_linear_solver_survives_every_failure)
{
  const dvi__linear_kind kinds[] = {DVI__LINEAR_DENSE, DVI__LINEAR_SPARSE};
  dvi__pattern pattern;
  dvi__linear *linear;
  dvi_counters counters = {0};
  ck_assert_int_eq(dvi__pattern_copy(&tridiagonal, SITES, "matrix", &pattern), DVI_OK);
  double values[3 * SITES];
  for (int j = 0; j < SITES; j++)
    for (int e = pattern.start[j]; e < pattern.start[j + 1]; e++)
      values[e] = pattern.row[e] == j ? 3 : 1;
  const long before = dvi__allocation_count();
  ck_assert_int_eq(dvi__linear_create(&pattern, kinds[_i], NULL, &linear), DVI_OK);
  const long created = dvi__allocation_count() - before;
  ck_assert_int_eq(dvi__linear_factor(linear, values), DVI_OK);
  const long needed = dvi__allocation_count() - before;
  dvi__linear_destroy(&linear);
  ck_assert(created == 1 && needed >= 5 && needed < MOST);
  for (long successes = 0; successes < needed; successes++) {
    dvi__fail_allocations_after(successes);
    dvi_status status = dvi__linear_create(&pattern, kinds[_i], &counters, &linear);
    if (successes < created) {
      out_of_memory(status, linear);
      continue;
    }
    ck_assert_int_eq(status, DVI_OK);
    status = dvi__linear_factor(linear, values);
    out_of_memory(status, NULL);
    ck_assert_int_eq(counters.preparations, 0);
    ck_assert_int_eq(dvi__linear_factor(linear, values), DVI_OK);
    ck_assert_int_eq(counters.preparations, 1);
    counters.preparations = 0;
    dvi__linear_destroy(&linear);
  }
  dvi__pattern_clear(&pattern);
}
END_TEST

typedef dvi_status (*one_point_call)(const dvi_system *s);

static dvi_status call_lagrangian(const dvi_system *s)
{
  double L;
  return dvi_system_lagrangian(s, 0, generic_q, generic_v, &L);
}

static dvi_status call_momentum(const dvi_system *s)
{
  double p[SITES];
  return dvi_system_momentum(s, 0, generic_q, generic_v, p);
}

static dvi_status call_velocity(const dvi_system *s)
{
  double v[SITES] = {0};
  return dvi_system_velocity(s, 0, generic_q, generic_v, v);
}

static dvi_status call_invariants(const dvi_system *s)
{
  double value[2];
  return dvi_system_invariants(s, 0, generic_q, generic_v, value);
}

static dvi_status call_check(const dvi_system *s)
{
  return dvi_system_check(s, 0, generic_q, generic_v, 0, NULL);
}

START_TEST(every_call_at_one_point_survives_every_failure)
{
  const one_point_call calls[] = {call_lagrangian, call_momentum, call_velocity, call_invariants,
                                  call_check};
  scene c;
  build_scene(&c, _i % KINDS);
  dvi_system *s = make_system(&c.terms);
  ck_assert_int_eq(dvi__system_prepare_hessian(s), DVI_OK);
  const long before = dvi__allocation_count();
  ck_assert_msg(calls[_i / KINDS](s) == DVI_OK, "%s", dvi_last_error());
  const long needed = dvi__allocation_count() - before;
  for (long successes = 0; successes < needed; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = calls[_i / KINDS](s);
    out_of_memory(status, NULL);
  }
  dvi_system_destroy(&s);
}
END_TEST

SUITE(allocation)
{
  tcase_add_loop_test(tests, a_system_survives_every_failure, 0, KINDS);
  tcase_add_loop_test(tests, completing_a_system_survives_every_failure, 0, KINDS);
  tcase_add_loop_test(tests, an_evaluator_survives_every_failure, 0, KINDS);
  tcase_add_loop_test(tests, a_linear_solver_survives_every_failure, 0, 2);
  tcase_add_loop_test(tests, every_call_at_one_point_survives_every_failure, 0, 5 * KINDS);
}
