/* labels: unit */
/* A problem whose callbacks take one point at a time is the same problem. */
#include <string.h>

#include "core/memory.h"
#include "support/runs.h"
#include "support/suite.h"

enum { STEPS = 10 };

static const char *method_for(const problem *model)
{
  const dvi_system_terms *terms = model->terms;
  if (terms->hamiltonian != NULL)
    return terms->constraint != NULL ? "dg-phase:degree=3" : "hamiltonian:degree=3";
  if (terms->factors != NULL) return "lie-galerkin:degree=5";
  if (terms->noise != NULL) return "langevin:scheme=ovio,degree=3";
  if (terms->nonholonomic_count > 0) return "composition:order=4";
  return terms->one_form != NULL ? "vprk:nodes=3" : "galerkin:degree=5";
}

/* The end of some steps, and what they counted. */
static void end_of_run(const problem *model, double *q, dvi_counters *counted)
{
  dvi_integrator *integrator = start_integrator(model, method_for(model));
  advance(integrator, model->h, STEPS);
  memcpy(q, dvi_integrator_q(integrator), (size_t)model->nq * sizeof *q);
  dvi_integrator_counters(integrator, counted);
  dvi_integrator_destroy(&integrator);
}

START_TEST(one_point_callbacks_give_the_same_digits_and_counts)
{
  enum { MOST = 64 };
  problem *model = create_problem(problem_name(_i), NULL);
  double batches[MOST], points[MOST];
  dvi_counters of_batches, of_points;
  ck_assert_int_le(model->nq, MOST);
  end_of_run(model, batches, &of_batches);
  ck_assert_int_eq(problem_one_point(model), DVI_OK);
  end_of_run(model, points, &of_points);
  ck_assert_mem_eq(batches, points, (size_t)model->nq * sizeof *points);
  ck_assert_int_eq(of_batches.gradients, of_points.gradients);
  ck_assert_int_eq(of_batches.hessians, of_points.hessians);
  problem_destroy(&model);
}
END_TEST

START_TEST(no_batch_is_left_and_no_term_is_lost)
{
  problem *model = create_problem(problem_name(_i), NULL);
  const dvi_system_terms declared = *model->terms;
  ck_assert_int_eq(problem_one_point(model), DVI_OK);
  const dvi_system_terms *terms = model->terms;
  ck_assert_int_eq(terms->dimension, declared.dimension);
  ck_assert_int_eq(terms->factor_count, declared.factor_count);
  ck_assert_int_eq(terms->potential_count, declared.potential_count);
  ck_assert_int_eq(terms->symmetry_count, declared.symmetry_count);
  ck_assert_int_eq(terms->invariant_count, declared.invariant_count);
  for (int k = 0; k < terms->potential_count; k++) {
    const dvi_potential *potential = &terms->potentials[k];
    ck_assert(potential->value && potential->gradient && potential->hessian);
    ck_assert(!potential->value_batch && !potential->gradient_batch && !potential->hessian_batch);
  }
  ck_assert_int_eq(terms->lagrangian != NULL, declared.lagrangian != NULL);
  if (terms->lagrangian) {
    ck_assert(terms->lagrangian->value && terms->lagrangian->gradient &&
              terms->lagrangian->hessian);
    ck_assert(!terms->lagrangian->value_batch && !terms->lagrangian->gradient_batch &&
              !terms->lagrangian->hessian_batch);
  }
  problem_destroy(&model);
}
END_TEST

START_TEST(without_memory_the_problem_stays_as_it_was)
{
  problem *model = create_problem("double-pendulum", NULL);
  const dvi_system *system = model->system;
  const dvi_system_terms *terms = model->terms;
  dvi__fail_allocations_after(1);
  const dvi_status status = problem_one_point(model);
  dvi__fail_allocations_after(-1);
  ck_assert_int_eq(status, DVI_NO_MEMORY);
  ck_assert_ptr_eq(model->system, system);
  ck_assert_ptr_eq(model->terms, terms);
  double q[2];
  dvi_counters counted;
  end_of_run(model, q, &counted);
  problem_destroy(&model);
}
END_TEST

SUITE(one_point)
{
  tcase_add_loop_test(tests, one_point_callbacks_give_the_same_digits_and_counts, 0,
                      problem_count());
  tcase_add_loop_test(tests, no_batch_is_left_and_no_term_is_lost, 0, problem_count());
  tcase_add_test(tests, without_memory_the_problem_stays_as_it_was);
}
