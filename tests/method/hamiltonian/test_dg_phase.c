/* labels: order invariant */
/* Discontinuous Galerkin with the constraint at the averages: the printed scheme, its order for
 * every degree, refusals. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { LEVELS = 4 };

static double error_at_end(problem *model, const problem *standard, const char *method, double h)
{
  dvi_integrator *integrator = start_integrator(model, method);
  ck_assert_int_eq(dvi_integrator_order(integrator), 2);
  advance(integrator, h, lround(model->order_t_end / h));
  const double error = distance(model->nq, dvi_integrator_q(integrator), standard->digits_q);
  dvi_integrator_destroy(&integrator);
  return error;
}

static const struct {
  const char *problem, *setting;
  double h;
} places[] = {{"lotka-volterra", NULL, 0.0625},
              {"lotka-volterra", "gauge=singular", 0.0625},
              {"lotka-volterra", "gauge=symmetric", 0.0625},
              {"lotka-volterra-4d", NULL, 0.03125},
              {"massless-particle", NULL, 0.125},
              {"massless-particle", "gauge=singular", 0.0625},
              {"vortices-linear", NULL, 0.03125},
              {"vortices", NULL, 0.0125},
              {"guiding-centre", NULL, 8},
              {"tokamak", NULL, 100}};
enum { PLACES = sizeof places / sizeof *places };

START_TEST(every_degree_has_order_2)
{
  const int at = _i % PLACES, degree = 1 + _i / PLACES;
  problem *model = create_problem(places[at].problem, places[at].setting),
          *standard = create_problem(places[at].problem, NULL);
  const char *method = method_spec("dg-phase:degree=%d", degree);
  double h = places[at].h, last = error_at_end(model, standard, method, h);
  for (int level = 1; level < LEVELS; level++) {
    const double error = error_at_end(model, standard, method, h /= 2), slope = log2(last / error);
    ck_assert_msg(fabs(slope - 2) <= 0.2, "%s: slope %.2f at h = %g", places[at].problem, slope, h);
    last = error;
  }
  problem_destroy(&model);
  problem_destroy(&standard);
}
END_TEST

/* Gives alpha = (1 + r^2)/2 (-y, x) of massless-particle, and the gradient of alpha.w. */
static void form(const double *q, const double *w, double *alpha, double *gradient)
{
  const double x = q[0], y = q[1], s = (1 + x * x + y * y) / 2, turn = -y * w[0] + x * w[1];
  alpha[0] = -y * s;
  alpha[1] = x * s;
  gradient[0] = x * turn + s * w[1];
  gradient[1] = y * turn - s * w[0];
}

/* alpha(q') = alpha(q) - h H_q(q + [q]/2) + ((Dalpha)^T [q] + (Dalpha')^T [q'])/2, q' = q + ([q] +
 * [q'])/2, with H = cos x + sin y. */
START_TEST(steps_solve_the_printed_equations)
{
  const double h = 0.1;
  problem *model = create_problem("massless-particle", NULL);
  dvi_integrator *integrator = start_integrator(model, "dg-phase");
  double q[2], jump[2], next[2], alpha[2], gradient[2], next_alpha[2], next_gradient[2];
  advance(integrator, h, 1);
  for (int step = 0; step < 50; step++) {
    memcpy(q, dvi_integrator_q(integrator), sizeof q);
    ck_assert_double_gt(dvi_integrator_jump(integrator, jump), 0.01);
    advance(integrator, h, 1);
    (void)dvi_integrator_jump(integrator, next);
    form(q, jump, alpha, gradient);
    form(dvi_integrator_q(integrator), next, next_alpha, next_gradient);
    const double H_q[2] = {-sin(q[0] + jump[0] / 2), cos(q[1] + jump[1] / 2)};
    for (int i = 0; i < 2; i++) {
      ck_assert_double_eq_tol(dvi_integrator_q(integrator)[i], q[i] + (jump[i] + next[i]) / 2,
                              1e-14);
      ck_assert_double_eq_tol(next_alpha[i],
                              alpha[i] - h * H_q[i] + (gradient[i] + next_gradient[i]) / 2, 1e-13);
      ck_assert_double_eq_tol(dvi_integrator_p(integrator)[i], next_alpha[i], 1e-15);
    }
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(degrees_and_nodes_give_the_steps_of_degree_0_on_the_configurations)
{
  static const char *const methods[] = {"dg-phase", "dg-phase:degree=3",
                                        "dg-phase:degree=2,nodes=4"};
  problem *model = create_problem("vortices", NULL);
  dvi_integrator *one = start_integrator(model, methods[_i]),
                 *other = start_integrator(model, "dg:degree=0");
  advance(one, 0.02, 20);
  advance(other, 0.02, 20);
  ck_assert_mem_eq(dvi_integrator_q(one), dvi_integrator_q(other),
                   (size_t)model->nq * sizeof(double));
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&other);
  problem_destroy(&model);
}
END_TEST

START_TEST(energy_stays_bounded)
{
  problem *model = create_problem("massless-particle", NULL);
  dvi_integrator *integrator = start_integrator(model, "dg-phase");
  double first, now, worst[2] = {0, 0};
  const int steps = 20000;
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &first), DVI_OK);
  for (int k = 0; k < steps; k++) {
    advance(integrator, 0.2, 1);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, &now), DVI_OK);
    worst[2 * k / steps] = fmax(worst[2 * k / steps], fabs(now / first - 1));
  }
  ck_assert_double_le(worst[0], 5e-4);
  ck_assert_double_le(worst[1], 1.02 * worst[0]);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(too_few_nodes_are_refused)
{
  problem *model = create_problem("vortices", NULL);
  dvi_integrator *none = NULL;
  ck_assert_int_eq(dvi_integrator_create(model->system, "dg-phase:degree=3,nodes=2", &none),
                   DVI_BAD_OPTION);
  check_words("take 3 or more");
  problem_destroy(&model);
}
END_TEST

SUITE(dg_phase)
{
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, every_degree_has_order_2, 0, 3 * PLACES);
  tcase_add_test(tests, steps_solve_the_printed_equations);
  tcase_add_loop_test(tests, degrees_and_nodes_give_the_steps_of_degree_0_on_the_configurations, 0,
                      3);
  tcase_add_test(tests, energy_stays_bounded);
  tcase_add_test(tests, too_few_nodes_are_refused);
}
