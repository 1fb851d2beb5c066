/* labels: order invariant */
/* Discrete Hamiltonians by shooting: types 2 and 3 of a one-step method and a quadrature, on
 * degenerate Hamiltonians and on Lagrangians. */
#include <math.h>
#include <string.h>

#include "support/systems/degenerate.h"
#include "support/systems/hamiltonians.h"
#include "support/suite.h"

enum { LEVELS = 5 };

static const double floor_of_errors = 3e-14;

/* A method of this order, which the one-step method or the quadrature decides, and a number of
 * steps that shows it. */
static const struct {
  const char *method;
  int order, steps;
} pairs[] = {{"onestep=euler,quadrature=trapezoid", 1, 200},
             {"onestep=heun,quadrature=trapezoid", 2, 60},
             {"onestep=implicit-midpoint,quadrature=trapezoid", 2, 60},
             {"onestep=rk4,quadrature=trapezoid", 2, 60},
             {"onestep=kutta3,quadrature=simpson", 3, 40},
             {"onestep=rk4,quadrature=simpson", 4, 20},
             {"onestep=gauss,quadrature=simpson", 4, 20},
             {"onestep=butcher6,quadrature=lobatto,nodes=4", 6, 10},
             {"onestep=cooper-verner,quadrature=lobatto,nodes=4", 6, 8}};
enum { PAIRS = sizeof pairs / sizeof *pairs };

static void check_order_of(const hamiltonian_problem *model, const char *method, int order,
                           int first)
{
  dvi_system *system = create_hamiltonian_system(model);
  double h[LEVELS], error[LEVELS], q[HAMILTONIAN_MOST], p[HAMILTONIAN_MOST];
  dvi_order_fit fit;
  model->exact(1.5, q, p);
  for (int level = 0; level < LEVELS; level++) {
    const int steps = (int)lround(first * model->step_factor * pow(2, 0.5 * level));
    dvi_integrator *step = start_hamiltonian_integrator(system, model, method);
    ck_assert_int_eq(dvi_integrator_order(step), order);
    h[level] = 1.5 / steps;
    advance(step, h[level], steps);
    error[level] = fmax(distance(model->n, dvi_integrator_q(step), q),
                        distance(model->n, dvi_integrator_p(step), p));
    dvi_integrator_destroy(&step);
  }
  ck_assert_int_eq(dvi_order(LEVELS, h, error, floor_of_errors, 0, &fit), DVI_OK);
  ck_assert_msg(fit.last - fit.first >= 3 && fabs(fit.slope - order) <= 0.2,
                "%s %s: slope %.2f over %d, not %d (errors %g to %g)", model->name, method,
                fit.slope, fit.last - fit.first + 1, order, error[0], error[LEVELS - 1]);
  dvi_system_destroy(&system);
}

START_TEST(the_order_is_the_lower_one_of_both)
{
  for (int type = 2; type <= 3; type++) {
    const char *method = method_spec("shooting:type=%d,%s", type, pairs[_i].method);
    check_order_of(find_hamiltonian_problem("stiffness"), method, pairs[_i].order, pairs[_i].steps);
    check_order_of(find_hamiltonian_problem("driven"), method, pairs[_i].order, pairs[_i].steps);
  }
}
END_TEST

/* If H is linear in all momenta, p.H_p - H is 0, and the quadrature adds nothing. */
START_TEST(the_order_is_the_one_step_methods_where_h_is_linear)
{
  check_order_of(find_hamiltonian_problem("adjoint"),
                 "shooting:type=2,onestep=heun,quadrature=trapezoid", 2, 60);
  dvi_integrator *by[2];
  const hamiltonian_problem *model = find_hamiltonian_problem("adjoint");
  dvi_system *system = create_hamiltonian_system(model);
  for (int k = 0; k < 2; k++) {
    by[k] = start_hamiltonian_integrator(system, model,
                                         k == 0
                                             ? "shooting:quadrature=trapezoid,onestep=gauss"
                                             : "shooting:quadrature=lobatto,nodes=2,onestep=gauss");
    advance(by[k], 0.2, 10);
  }
  double q[1], p[1];
  model->exact(2, q, p);
  ck_assert_double_le(distance(1, dvi_integrator_q(by[0]), q), 1e-5); /* h^4/720 and not h^2 */
  ck_assert_double_le(distance(1, dvi_integrator_q(by[0]), dvi_integrator_q(by[1])), 1e-14);
  dvi_integrator_destroy(&by[0]);
  dvi_integrator_destroy(&by[1]);
  dvi_system_destroy(&system);
}
END_TEST

/* Those whose errors do not change their sign between these steps, and are above rounding. */
static const int on_elastica[] = {1, 2, 3, 5, 6, 7};

START_TEST(elastica_shows_the_same_orders)
{
  const int i = on_elastica[_i];
  for (int type = 2; type <= 3; type++)
    check_degenerate_order("elastica", NULL,
                           method_spec("shooting:type=%d,%s", type, pairs[i].method), 0.2,
                           pairs[i].order);
}
END_TEST

START_TEST(explicit_one_step_methods_make_symplectic_steps)
{
  static const double q[3] = {0.2, -0.4, 0.7}, p[3] = {-0.8, 0.3, 1.1};
  problem *model = create_problem("elastica", NULL),
          *regular = create_problem("double-pendulum", NULL);
  for (int type = 2; type <= 3; type++) {
    dvi_integrator *degenerate = start_integrator(
                       model, method_spec("shooting:type=%d,%s", type, pairs[_i].method)),
                   *other = start_integrator(
                       regular, method_spec("shooting:type=%d,%s", type, pairs[_i].method));
    double defect;
    ck_assert_msg(dvi_symplecticity(degenerate, 0, q, p, 0.3, &defect) == DVI_OK, "%s",
                  dvi_last_error());
    ck_assert_double_le(defect, 1e-10);
    ck_assert_msg(dvi_symplecticity(other, 0, regular->q, regular->p, 0.02, &defect) == DVI_OK,
                  "%s", dvi_last_error());
    ck_assert_double_le(defect, 1e-10);
    dvi_integrator_destroy(&degenerate);
    dvi_integrator_destroy(&other);
  }
  problem_destroy(&model);
  problem_destroy(&regular);
}
END_TEST

/* H-(p0,q1) of -h is -H+ of h, where the one-step method and the quadrature are symmetric. */
START_TEST(types_2_and_3_of_symmetric_pairs_undo_each_other)
{
  static const char *const symmetric[] = {"onestep=implicit-midpoint,quadrature=trapezoid",
                                          "onestep=gauss,quadrature=simpson"};
  problem *model = create_problem("elastica", NULL);
  dvi_integrator *there = start_integrator(model, method_spec("shooting:type=2,%s", symmetric[_i])),
                 *back = create_integrator(model->system,
                                           method_spec("shooting:type=3,%s", symmetric[_i]));
  advance(there, 0.3, 3);
  const double q[3] = {dvi_integrator_q(there)[0], dvi_integrator_q(there)[1],
                       dvi_integrator_q(there)[2]},
               p[3] = {dvi_integrator_p(there)[0], dvi_integrator_p(there)[1],
                       dvi_integrator_p(there)[2]};
  advance(there, 0.3, 1);
  ck_assert_int_eq(dvi_integrator_start(back, 0, dvi_integrator_q(there), dvi_integrator_p(there)),
                   DVI_OK);
  advance(back, -0.3, 1);
  ck_assert_double_le(distance(3, dvi_integrator_q(back), q), 1e-13);
  ck_assert_double_le(distance(3, dvi_integrator_p(back), p), 1e-13);
  dvi_integrator_destroy(&there);
  dvi_integrator_destroy(&back);
  problem_destroy(&model);
}
END_TEST

START_TEST(energy_stays_and_momenta_are_kept)
{
  check_long_run("elastica", "kappa=1.5",
                 _i == 2 ? "shooting:type=2" : "shooting:type=3,onestep=gauss", 0.1, repeats(5000),
                 1e-2, 1e-11);
}
END_TEST

START_TEST(type_1_is_for_lagrangians)
{
  problem *model = create_problem("elastica", NULL);
  dvi_integrator *none = NULL;
  ck_assert_int_eq(dvi_integrator_create(model->system, "shooting:type=1", &none), DVI_UNSUPPORTED);
  check_words(
      "shooting: type=1 shoots for a discrete Lagrangian, and the system declares a Hamiltonian");
  ck_assert_int_eq(dvi_integrator_create(model->system, "shooting:type=4", &none), DVI_BAD_OPTION);
  problem_destroy(&model);
}
END_TEST

SUITE(hamiltonian_shooting)
{
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, the_order_is_the_lower_one_of_both, 0, PAIRS);
  tcase_add_loop_test(tests, elastica_shows_the_same_orders, 0, 6);
  tcase_add_test(tests, the_order_is_the_one_step_methods_where_h_is_linear);
  tcase_add_loop_test(tests, explicit_one_step_methods_make_symplectic_steps, 0, PAIRS);
  tcase_add_loop_test(tests, types_2_and_3_of_symmetric_pairs_undo_each_other, 0, 2);
  tcase_add_loop_test(tests, energy_stays_and_momenta_are_kept, 2, 4);
  tcase_add_test(tests, type_1_is_for_lagrangians);
}
