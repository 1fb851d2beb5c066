/* labels: invariant */
/* Both ways to solve a step of shooting, by the shot and by all stages at once, and which of them
 * is taken. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { STEPS = 20 };

static const struct {
  const char *problem, *setting;
  double h;
} places[] = {{"pendulum", NULL, 0.2},         {"kepler", NULL, 0.1},
              {"double-pendulum", NULL, 0.02}, {"driven-pendulum", NULL, 0.1},
              {"henon-heiles", NULL, 0.2},     {"fpu", "ell=3", 0.01}};
enum { PLACES = sizeof places / sizeof *places };

static const char *const solved[] = {"rk4", "gauss", "sdirk,stages=3",
                                     "implicit-midpoint,composition=4",
                                     "cooper-verner,quadrature=clenshaw-curtis"};
enum { SOLVED = sizeof solved / sizeof *solved };

static double relative_distance(int n, const double *a, const double *b, const double *start)
{
  return distance(n, a, b) / fmax(magnitude(n, a), magnitude(n, start));
}

/* Both solve the same equations in other unknowns, which differ by some roundings a step. */
START_TEST(all_stages_at_once_give_the_same_steps)
{
  for (int place = 0; place < PLACES; place++) {
    problem *model = create_problem(places[place].problem, places[place].setting);
    dvi_integrator *shot = start_integrator(
                       model, method_spec("shooting:onestep=%s,solve=shot", solved[_i])),
                   *stages = start_integrator(
                       model, method_spec("shooting:onestep=%s,solve=stages", solved[_i]));
    advance(shot, places[place].h, STEPS);
    advance(stages, places[place].h, STEPS);
    const double difference = fmax(
        relative_distance(model->nq, dvi_integrator_q(shot), dvi_integrator_q(stages), model->q),
        relative_distance(model->nq, dvi_integrator_p(shot), dvi_integrator_p(stages), model->p));
    ck_assert_msg(difference <= 2e-13, "%s %s: apart by %g", model->name, solved[_i], difference);
    dvi_integrator_destroy(&shot);
    dvi_integrator_destroy(&stages);
    problem_destroy(&model);
  }
}
END_TEST

/* The Jacobians of both are exact for short steps alone. Here they contract by a constant factor up
 * to 0.9, so that no end may be foreseen from the size of the first correction. */
static const struct {
  const char *problem, *onestep;
  double h;
} slow[] = {{"oscillator", "butcher6", 3},
            {"oscillator", "butcher6", 3.1786},
            {"double-pendulum", "euler", 0.48029972879807525}};

START_TEST(long_steps_are_solved_to_the_end)
{
  problem *model = create_problem(slow[_i].problem, NULL);
  dvi_integrator *shot = start_integrator(
                     model, method_spec("shooting:onestep=%s,solve=shot", slow[_i].onestep)),
                 *stages = start_integrator(
                     model, method_spec("shooting:onestep=%s,solve=stages", slow[_i].onestep));
  advance(shot, slow[_i].h, 1);
  advance(stages, slow[_i].h, 1);
  const double difference = relative_distance(model->nq, dvi_integrator_q(shot),
                                              dvi_integrator_q(stages), model->q);
  ck_assert_msg(difference <= 1e-14, "%s %s: apart by %g", model->name, slow[_i].onestep,
                difference);
  dvi_integrator_destroy(&shot);
  dvi_integrator_destroy(&stages);
  problem_destroy(&model);
}
END_TEST

/* Only neighbours of a chain couple. The factors stay sparse, where those of the shot would take
 * 2000 x 2000 numbers. */
START_TEST(long_chains_are_solved_by_all_stages_at_once)
{
  problem *model = create_problem("chain", "n=1000");
  dvi_integrator *integrator = start_integrator(
      model, "shooting:onestep=heun,quadrature=trapezoid,solve=stages");
  dvi_counters counters;
  advance(integrator, 0.1, 2);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_eq(counters.newtons, 2);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* rk4 and Simpson's rule have 21 blocks, gauss has 13. outer-solar's Hessian is full, and the
 * double pendulum's mass is not diagonal. */
static const struct {
  const char *problem, *setting, *method, *solve;
} taken[] = {{"chain", "n=126", "shooting", "solve=shot"},
             {"chain", "n=127", "shooting", "solve=stages"},
             {"chain", "n=127", "shooting:type=2", "solve=shot"},
             {"chain", "n=127", "shooting:solve=shot", "solve=shot"},
             {"chain", "n=13", "shooting:onestep=gauss", "solve=shot"},
             {"chain", "n=14", "shooting:onestep=gauss", "solve=stages"},
             {"chain", "n=3000", "shooting:onestep=heun,quadrature=trapezoid", "solve=stages"},
             {"outer-solar", NULL, "shooting:onestep=gauss", "solve=shot"},
             {"double-pendulum", NULL, "shooting:onestep=gauss", "solve=shot"},
             {"kepler", NULL, "shooting:onestep=taylor", "solve=shot"}};
enum { TAKEN = sizeof taken / sizeof *taken };

START_TEST(left_out_the_cheaper_one_is_taken)
{
  problem *model = create_problem(taken[_i].problem, taken[_i].setting);
  dvi_integrator *integrator = create_integrator(model->system, taken[_i].method);
  ck_assert_ptr_nonnull(strstr(dvi_integrator_method(integrator), taken[_i].solve));
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

static const struct {
  const char *setting, *method, *words;
} refused[] = {
    {"n=2001", "shooting:solve=shot", "solve=shot has full matrices of 2n = 4002 unknowns"},
    {"n=2001", "shooting:type=3", "solve=stages, with type=1"},
    {"n=10", "shooting:type=2,solve=stages", "solve=stages is for type=1"}};
enum { REFUSED = sizeof refused / sizeof *refused };

START_TEST(what_is_too_large_or_has_no_such_way_is_refused)
{
  problem *model = create_problem("chain", refused[_i].setting);
  dvi_integrator *none = NULL;
  ck_assert_int_ne(dvi_integrator_create(model->system, refused[_i].method, &none), DVI_OK);
  check_words(refused[_i].words);
  ck_assert_ptr_null(none);
  problem_destroy(&model);
}
END_TEST

SUITE(shooting_solve)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, all_stages_at_once_give_the_same_steps, 0, SOLVED);
  tcase_add_loop_test(tests, long_steps_are_solved_to_the_end, 0, sizeof slow / sizeof *slow);
  tcase_add_test(tests, long_chains_are_solved_by_all_stages_at_once);
  tcase_add_loop_test(tests, left_out_the_cheaper_one_is_taken, 0, TAKEN);
  tcase_add_loop_test(tests, what_is_too_large_or_has_no_such_way_is_refused, 0, REFUSED);
}
