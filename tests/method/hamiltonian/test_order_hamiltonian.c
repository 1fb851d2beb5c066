/* labels: order */
/* Orders of discrete Hamiltonians, by exact solutions, on degenerate Hamiltonians and on regular
 * ones. */
#include <math.h>
#include <stdio.h>

#include "support/systems/hamiltonians.h"
#include "support/suite.h"

enum { LEVELS = 5, DEGREES = 4, MOST = 3 };

/* Rounding, and the exact solutions' own. */
static const double floor_of_errors = 3e-14;

static void check_slope(const char *name, const char *method, int order, const double *h,
                        const double *error)
{
  dvi_order_fit fit;
  ck_assert_msg(dvi_order(LEVELS, h, error, floor_of_errors, 0, &fit) == DVI_OK, "%s %s: %s", name,
                method, dvi_last_error());
  ck_assert_msg(fit.last - fit.first >= 3, "%s %s: %d errors only", name, method,
                fit.last - fit.first + 1);
  ck_assert_msg(fabs(fit.slope - order) <= 0.2, "%s %s: slope %.2f, not %d (errors %g to %g)", name,
                method, fit.slope, order, error[0], error[LEVELS - 1]);
}

/* Five numbers of steps, each 2^(1/3) times the one before, because errors of a high order fall
 * fast. */
static int steps_of(int order, int level, double as_many)
{
  static const int first[] = {0, 200, 100, 40, 24, 16, 12, 10, 6};
  return (int)lround(first[order] * as_many * pow(2, level / 3.0));
}

static double error_after(dvi_integrator *step, int n, double h, int steps, const double *q,
                          const double *p)
{
  advance(step, h, steps);
  return fmax(distance(n, dvi_integrator_q(step), q), distance(n, dvi_integrator_p(step), p));
}

static void check_order_on(const hamiltonian_problem *model, const char *method, double span)
{
  dvi_system *system = create_hamiltonian_system(model);
  double h[LEVELS], error[LEVELS], q[MOST], p[MOST];
  int order = 0;
  model->exact(span, q, p);
  for (int level = 0; level < LEVELS; level++) {
    dvi_integrator *step = start_hamiltonian_integrator(system, model, method);
    order = dvi_integrator_order(step);
    const int steps = steps_of(order, level, model->step_factor);
    h[level] = span / steps;
    error[level] = error_after(step, model->n, h[level], steps, q, p);
    dvi_integrator_destroy(&step);
  }
  check_slope(model->name, method, order, h, error);
  dvi_system_destroy(&system);
}

static void check_order_of_elastica(const char *method)
{
  problem *model = create_problem("elastica", "kappa=1.5");
  double h[LEVELS], error[LEVELS], q[MOST], p[MOST];
  const double span = 3;
  int order = 0;
  ck_assert_int_eq(model->exact(model, span, q, p), 0);
  for (int level = 0; level < LEVELS; level++) {
    dvi_integrator *step = start_integrator(model, method);
    order = dvi_integrator_order(step);
    const int steps = steps_of(order, level, 2);
    h[level] = span / steps;
    error[level] = error_after(step, 3, h[level], steps, q, p);
    dvi_integrator_destroy(&step);
  }
  check_slope("elastica", method, order, h, error);
  problem_destroy(&model);
}

static void check_orders(const char *method, int regular)
{
  check_order_of_elastica(method);
  for (const hamiltonian_problem *model = hamiltonian_problems; model->name != NULL; model++)
    if (regular || model->degenerate) check_order_on(model, method, 2);
}

START_TEST(gauss_has_order_2s)
{
  for (int type = 2; type <= 3; type++)
    check_orders(method_spec("hamiltonian:type=%d,degree=%d", type, _i), 1);
}
END_TEST

/* On `curved` the odd power of h is so small beside the next one that no slope shows it. */
START_TEST(radau_has_order_2s_minus_1)
{
  check_orders(method_spec("hamiltonian:type=2,degree=%d,quadrature=radau-left", _i), 0);
  check_orders(method_spec("hamiltonian:type=3,degree=%d,quadrature=radau-right", _i), 0);
}
END_TEST

START_TEST(lobatto_with_as_many_points_has_order_2s_minus_2)
{
  check_orders(method_spec("hamiltonian:degree=%d,quadrature=lobatto,nodes=%d", _i, _i), 1);
}
END_TEST

START_TEST(more_points_have_order_2s_where_h_is_regular)
{
  check_order_on(find_hamiltonian_problem("driven"),
                 method_spec("hamiltonian:degree=%d,quadrature=lobatto", _i), 2);
  check_order_on(find_hamiltonian_problem("curved"),
                 method_spec("hamiltonian:type=1,degree=%d,quadrature=lobatto", _i), 2);
}
END_TEST

SUITE(order_hamiltonian)
{
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, gauss_has_order_2s, 1, 1 + DEGREES);
  tcase_add_loop_test(tests, radau_has_order_2s_minus_1, 1, 1 + DEGREES);
  tcase_add_loop_test(tests, lobatto_with_as_many_points_has_order_2s_minus_2, 2, 1 + DEGREES);
  tcase_add_loop_test(tests, more_points_have_order_2s_where_h_is_regular, 1, 1 + DEGREES);
}
