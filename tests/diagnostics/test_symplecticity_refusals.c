/* labels: unit */
/* Where there is no defect of symplecticity to measure, nothing is written, and the status tells
 * why. */
#include <math.h>
#include <dvi/diagnostics.h>

#include "core/memory.h"
#include "support/runs.h"
#include "support/suite.h"

START_TEST(a_start_in_a_singularity_is_reported_and_nothing_is_written)
{
  const double origin[] = {0, 0};
  problem *p = create_problem("kepler", NULL);
  dvi_integrator *integrator = create_integrator(p->system, "verlet");
  double defect = 7;
  ck_assert_int_ne(dvi_symplecticity(integrator, 0, origin, p->p, p->h, &defect), DVI_OK);
  ck_assert(defect == 7);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&p);
}
END_TEST

START_TEST(missing_arguments_and_a_step_of_0_are_refused)
{
  problem *p = create_problem("pendulum", NULL);
  dvi_integrator *integrator = create_integrator(p->system, "verlet");
  double defect = 7;
  ck_assert_int_eq(dvi_symplecticity(NULL, 0, p->q, p->p, p->h, &defect), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, NULL, p->p, p->h, &defect), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, p->q, NULL, p->h, &defect), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, p->q, p->p, p->h, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, p->q, p->p, 0, &defect), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, p->q, p->p, (double)NAN, &defect),
                   DVI_BAD_ARGUMENT);
  ck_assert(defect == 7);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&p);
}
END_TEST

/* Directions, too, whose q and v have as many numbers. */
START_TEST(factors_have_no_canonical_coordinates)
{
  static const char *const place[] = {"free-body", "spherical-double-pendulum", "two-body"};
  for (size_t k = 0; k < sizeof place / sizeof *place; k++) {
    problem *p = create_problem(place[k], NULL);
    dvi_integrator *integrator = create_integrator(p->system, "lie-verlet");
    double defect = 7;
    ck_assert_int_eq(dvi_symplecticity(integrator, 0, p->q, p->p, p->h, &defect), DVI_UNSUPPORTED);
    ck_assert(defect == 7);
    dvi_integrator_destroy(&integrator);
    problem_destroy(&p);
  }
}
END_TEST

/* Their starts lie on a constraint, and the map of a step is not defined off it. */
START_TEST(degenerate_systems_are_refused_and_the_sentence_names_the_loop_integral)
{
  static const char *const place[][2] = {{"lotka-volterra", "vprk"},
                                         {"massless-particle", "dg"},
                                         {"vortices-linear", "hp:type=2"},
                                         {"circle-dirac", "dg-phase"}};
  for (size_t k = 0; k < sizeof place / sizeof *place; k++) {
    problem *p = create_problem(place[k][0], NULL);
    dvi_integrator *integrator = create_integrator(p->system, place[k][1]);
    double defect = 7;
    ck_assert_int_eq(dvi_symplecticity(integrator, 0, p->q, p->p, p->h, &defect), DVI_UNSUPPORTED);
    check_words("use dvi_loop_integral over a loop of starts");
    ck_assert(defect == 7);
    dvi_integrator_destroy(&integrator);
    problem_destroy(&p);
  }
}
END_TEST

START_TEST(every_failing_allocation_is_reported)
{
  problem *p = create_problem("pendulum", NULL);
  dvi_integrator *integrator = create_integrator(p->system, "verlet");
  double defect = 7;
  dvi_status status = DVI_NO_MEMORY;
  for (long successes = 0; status != DVI_OK; successes++) {
    dvi__fail_allocations_after(successes);
    status = dvi_symplecticity(integrator, 0, p->q, p->p, p->h, &defect);
    dvi__fail_allocations_after(-1);
    ck_assert_msg(status == DVI_OK || status == DVI_NO_MEMORY, "%s", dvi_last_error());
    ck_assert((status == DVI_OK) == (defect != 7));
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&p);
}
END_TEST

SUITE(symplecticity_refusals)
{
  tcase_set_timeout(tests, 60);
  tcase_add_test(tests, a_start_in_a_singularity_is_reported_and_nothing_is_written);
  tcase_add_test(tests, missing_arguments_and_a_step_of_0_are_refused);
  tcase_add_test(tests, factors_have_no_canonical_coordinates);
  tcase_add_test(tests, degenerate_systems_are_refused_and_the_sentence_names_the_loop_integral);
  tcase_add_test(tests, every_failing_allocation_is_reported);
}
