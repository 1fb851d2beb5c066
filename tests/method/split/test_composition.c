/* labels: unit */
#include <check.h>
#include <math.h>

#include "method/scheme.h"
#include "support/runs.h"
#include "support/suite.h"

static void check_refused(const char *method, const char *because)
{
  problem *oscillator = create_problem("oscillator", NULL);
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create(oscillator->system, method, &integrator), DVI_BAD_OPTION);
  ck_assert_ptr_null(integrator);
  check_words(because);
  problem_destroy(&oscillator);
}

START_TEST(a_base_that_is_not_symmetric_is_refused)
{
  check_refused("composition:order=4,base=galerkin,degree=2,quadrature=radau-right",
                "not symmetric");
}
END_TEST

START_TEST(a_key_that_the_base_does_not_know_is_refused)
{
  check_refused("composition:order=4,base=verlet,degree=2", "degree");
}
END_TEST

START_TEST(an_order_without_coefficients_is_refused)
{
  check_refused("composition:order=5", "order=5");
}
END_TEST

START_TEST(a_composition_of_compositions_is_refused)
{
  check_refused("composition:base=composition", "base=composition");
}
END_TEST

/* The order conditions are that the weights sum to 1, and so do steps of the clock. */
START_TEST(the_substeps_add_up_to_the_step)
{
  const char *const order[] = {"4", "6", "8"};
  problem *oscillator = create_problem("oscillator", NULL);
  dvi_integrator *integrator = start_integrator(oscillator,
                                                method_spec("composition:order=%s", order[_i]));
  advance(integrator, 0.5, 1);
  /* up to 17 roundings, compensated */
  ck_assert_double_eq_tol(dvi_integrator_time(integrator), 0.5, 1e-15);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&oscillator);
}
END_TEST

START_TEST(a_base_of_higher_order_keeps_its_order)
{
  problem *oscillator = create_problem("oscillator", NULL);
  dvi_integrator *integrator = start_integrator(oscillator,
                                                "composition:order=4,base=galerkin,degree=3");
  ck_assert_int_eq(dvi_integrator_order(integrator), 6);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&oscillator);
}
END_TEST

START_TEST(verlet_keeps_its_one_gradient_a_substep)
{
  problem *stars = create_problem("henon-heiles", NULL);
  dvi_integrator *integrator = start_integrator(stars, "composition:order=8");
  dvi_counters before, after;
  advance(integrator, 0.1, 1);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, 0.1, 10);
  dvi_integrator_counters(integrator, &after);
  ck_assert_int_eq(after.gradients - before.gradients, 170);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&stars);
}
END_TEST

/* Give the trace of the step of Verlet's method for q'' = -q, as the base, of length z. */
static double trace_at(const dvi__scheme *s, double z)
{
  double a = 1, b = 0, c = 0, d = 1; /* the columns (q, p) of two motions */
  for (int i = 0; i < s->substeps; i++) {
    const double g = z * dvi__scheme_part(s, i);
    c -= 0.5 * g * a;
    d -= 0.5 * g * b;
    a += g * c;
    b += g * d;
    c -= 0.5 * g * a;
    d -= 0.5 * g * b;
  }
  return a + d;
}

/* The trace of a matrix with determinant 1 is that of a rotation (Hairer, Lubich and Wanner 2006,
 * sec. I.5.2). Where the trace touches 2, it counts as one. */
START_TEST(steps_are_stable_up_to_the_bound_of_their_scheme)
{
  const dvi__scheme *s = dvi__scheme_at(_i);
  const double mesh = 1e-3, touch = 1e-9;
  int i = 1;
  while (fabs(trace_at(s, i * mesh)) <= 2 + touch) i++;
  ck_assert_double_eq_tol(s->stable, (i - 1) * mesh, 1e-12);
}
END_TEST

/* Where nothing else takes part, the kicks on both sides of a substep's end are taken together. */
START_TEST(substeps_together_have_the_bits_of_single_operations)
{
  static const char *const names[] = {"kepler", "henon-heiles", "outer-solar"};
  problem *model = create_problem(names[_i], NULL);
  dvi_integrator *together = start_integrator(model, "composition:order=8"),
                 *single = start_integrator(model, "composition:order=8,blocking=none");
  const size_t bytes = (size_t)model->nq * sizeof(double);
  dvi_counters one, other;
  advance(together, 0.05, 20);
  advance(single, 0.05, 20);
  ck_assert_mem_eq(dvi_integrator_q(together), dvi_integrator_q(single), bytes);
  ck_assert_mem_eq(dvi_integrator_p(together), dvi_integrator_p(single), bytes);
  dvi_integrator_counters(together, &one);
  dvi_integrator_counters(single, &other);
  ck_assert_int_eq(one.gradients, other.gradients);
  dvi_integrator_destroy(&together);
  dvi_integrator_destroy(&single);
  problem_destroy(&model);
}
END_TEST

START_TEST(the_lengths_of_substeps_are_parts_of_the_step)
{
  const dvi__scheme *s = dvi__scheme_at(_i);
  double length[DVI__SUBSTEPS_MOST];
  dvi__scheme_lengths(s, 0.3, length);
  for (int i = 0; i < s->substeps; i++) ck_assert(length[i] == 0.3 * dvi__scheme_part(s, i));
}
END_TEST

SUITE(composition)
{
  tcase_add_loop_test(tests, steps_are_stable_up_to_the_bound_of_their_scheme, 0, 3);
  tcase_add_loop_test(tests, the_lengths_of_substeps_are_parts_of_the_step, 0, 3);
  tcase_add_test(tests, a_base_that_is_not_symmetric_is_refused);
  tcase_add_test(tests, a_key_that_the_base_does_not_know_is_refused);
  tcase_add_test(tests, an_order_without_coefficients_is_refused);
  tcase_add_test(tests, a_composition_of_compositions_is_refused);
  tcase_add_loop_test(tests, the_substeps_add_up_to_the_step, 0, 3);
  tcase_add_test(tests, a_base_of_higher_order_keeps_its_order);
  tcase_add_loop_test(tests, substeps_together_have_the_bits_of_single_operations, 0, 3);
  tcase_add_test(tests, verlet_keeps_its_one_gradient_a_substep);
}
