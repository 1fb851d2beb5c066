/* labels: order invariant */
/* Hamilton-Pontryagin integrators of types 2 and 3 for degenerate Lagrangians: p is carried, off
 * alpha(q). */
#include <math.h>
#include <string.h>

#include "support/systems/degenerate.h"
#include "support/suite.h"

/* ---- quadratures that see all of a constant two-form: every gauge ---- */

/* Degree d has order d+1 for odd d, d for even d. These problems have an alpha and H that are not
 * nearly linear and quadratic, for which Gauss's points do better. */
static const struct {
  const char *problem, *gauge, *setting;
  int order;
  double h;
} claims[] = {
    {"lotka-volterra", NULL, "type=2,quadrature=gauss", 2, 0.05},
    {"lotka-volterra", NULL, "type=2,degree=2,quadrature=gauss", 2, 0.1},
    {"lotka-volterra", NULL, "type=3,degree=3,quadrature=gauss", 4, 0.125},
    {"lotka-volterra", NULL, "type=2,degree=4,quadrature=gauss", 4, 0.125},
    {"lotka-volterra", "gauge=singular", "type=2,quadrature=gauss", 2, 0.05},
    {"lotka-volterra", "gauge=symmetric", "type=2,degree=2,quadrature=gauss", 2, 0.05},
    {"lotka-volterra", NULL, "type=3,degree=2,quadrature=lobatto", 2, 0.05},
    {"lotka-volterra", NULL, "type=2,degree=3,quadrature=clenshaw-curtis", 4, 0.0625},
    {"massless-particle", NULL, "type=2,quadrature=midpoint", 2, 0.1},
    {"massless-particle", NULL, "type=2,degree=3,quadrature=gauss", 4, 0.25},
    {"massless-particle", "gauge=singular", "type=3,degree=2,quadrature=simpson", 2, 0.125},
    {"vortices", NULL, "type=2,quadrature=gauss", 2, 0.0015625},
    {"vortices", NULL, "type=2,degree=3,quadrature=lobatto", 4, 0.0125},
    {"guiding-centre", NULL, "type=2,quadrature=trapezoid", 2, 4},
    {"guiding-centre", NULL, "type=2,degree=3,quadrature=gauss", 4, 16},
    {"tokamak", NULL, "type=2,quadrature=lobatto", 2, 100},
    {"tokamak", NULL, "type=3,degree=3,quadrature=gauss", 4, 400}};
enum { CLAIMS = sizeof claims / sizeof *claims };

START_TEST(orders_are_those_claimed_in_every_gauge)
{
  check_degenerate_order(claims[_i].problem, claims[_i].gauge,
                         method_spec("hp:%s", claims[_i].setting), claims[_i].h, claims[_i].order);
}
END_TEST

/* Runs 20000 steps. docs/methods/hp.md tells where other quadratures and problems break. */
START_TEST(energy_stays_bounded_over_long_runs)
{
  check_long_run("lotka-volterra", NULL, "hp:type=2,degree=3,quadrature=gauss", 0.1, 20000, 1e-5,
                 0);
  check_long_run("massless-particle", NULL, "hp:type=2,degree=3,quadrature=lobatto", 0.1, 20000,
                 5e-7, 0);
}
END_TEST

/* The loops start on the constraint, and leave it. */
START_TEST(steps_are_symplectic)
{
  ck_assert_double_le(
      loop_integral_change("lotka-volterra", NULL, "hp:type=2,degree=2,quadrature=gauss", 0.1, 20),
      1e-10);
  ck_assert_double_le(loop_integral_change("massless-particle", NULL,
                                           "hp:type=3,degree=2,quadrature=lobatto", 0.1, 20),
                      1e-10);
}
END_TEST

START_TEST(with_symmetric_quadratures_a_step_back_undoes_a_step)
{
  problem *model = create_problem("massless-particle", NULL);
  dvi_integrator *integrator = start_integrator(
      model, method_spec("hp:type=2,degree=%d,quadrature=gauss", _i));
  double defect;
  ck_assert_int_eq(dvi_reversibility(integrator, 0, model->q, model->p, 0.1, 20, &defect), DVI_OK);
  ck_assert_double_le(defect, 1e-12);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- Radau's: gauges whose symmetric part is definite ---- */

static int gradient(const double *q, double *f_q, void *user)
{
  const problem *model = user;
  for (int i = 0; i < model->nq; i++) f_q[i] = 20 * q[i];
  return 0;
}

static int hessian(const double *q, double *f_qq, void *user)
{
  const problem *model = user;
  (void)q;
  for (int i = 0; i < model->nq; i++) f_qq[i] = 20;
  return 0;
}

static int form_third_derivative(const double *q, const double *w, double *f_w_qq, void *user)
{
  const problem *model = user;
  (void)q, (void)w;
  memset(f_w_qq, 0, (size_t)model->nq * sizeof *f_w_qq);
  return 0;
}

/* The problem with alpha + 20 q. */
static dvi_system *lifted(problem *model)
{
  static const int start[] = {0, 1, 2, 3, 4}, row[] = {0, 1, 2, 3};
  const dvi_gauge f = {.gradient = gradient,
                       .hessian = hessian,
                       .third = form_third_derivative,
                       .qq = {start, row},
                       .user = model};
  dvi_system_terms terms = *model->terms;
  dvi_system *system = NULL;
  terms.gauge = &f;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static dvi_integrator *start_integrator_in(const dvi_system *system, const problem *model,
                                           const char *method)
{
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_msg(dvi_integrator_start_velocity(integrator, 0, model->q, model->v) == DVI_OK, "%s",
                dvi_last_error());
  return integrator;
}

/* The largest distance from the constraint on the way, and the error at the end. */
static void run_off(const dvi_system *system, const problem *model, const char *method, double h,
                    double *off, double *error)
{
  dvi_integrator *integrator = start_integrator_in(system, model, method);
  double now;
  *off = 0;
  for (long k = lround(model->order_t_end / h); k > 0; k--) {
    advance(integrator, h, 1);
    ck_assert_int_eq(dvi_integrator_constraint(integrator, &now), DVI_OK);
    *off = fmax(*off, now);
  }
  *error = distance(model->nq, dvi_integrator_q(integrator), model->digits_q);
  dvi_integrator_destroy(&integrator);
}

static const struct {
  const char *problem;
  double h;
} lifts[] = {{"lotka-volterra", 0.003125}, {"massless-particle", 0.0125}, {"vortices", 0.0005}};
enum { LIFTS = sizeof lifts / sizeof *lifts, LEVELS = 4 };

/* The parasitic mode has the size h^d, and sets both the distance from the constraint and the
 * error. The error's phase at the end is that of the mode, so the distance tells the order. */
START_TEST(radaus_distance_from_the_constraint_shrinks_with_the_order_and_bounds_the_error)
{
  problem *model = create_problem(lifts[_i].problem, NULL);
  dvi_system *system = lifted(model);
  for (int type = 2; type <= 3; type++)
    for (int degree = 1; degree <= 3; degree++) {
      const char *method = method_spec("hp:type=%d,degree=%d", type, degree);
      double last = 0, off, error;
      for (int level = 0; level < LEVELS; level++, last = off) {
        run_off(system, model, method, lifts[_i].h / (1 << level), &off, &error);
        ck_assert_double_le(error, 10 * off);
        const double slope = log2(last / off), within = level == 1 ? 0.7 : 0.25;
        if (level > 0)
          ck_assert_msg(fabs(slope - degree) <= within, "%s %s: slope %.2f (%g)", model->name,
                        method, slope, off);
      }
    }
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

/* p1 = alpha(q0) of type 2, p0 = alpha(q1) of type 3, to roundoff. */
START_TEST(the_lowest_degrees_take_alpha_at_one_end)
{
  problem *model = create_problem("massless-particle", NULL);
  dvi_system *system = lifted(model);
  dvi_integrator *integrator = start_integrator_in(system, model, method_spec("hp:type=%d", _i));
  double before[2][2], alpha[2];
  for (int step = 0; step < 20; step++) {
    memcpy(before[0], dvi_integrator_q(integrator), sizeof before[0]);
    memcpy(before[1], dvi_integrator_p(integrator), sizeof before[1]);
    advance(integrator, 0.01, 1);
    const double *at = _i == 2 ? before[0] : dvi_integrator_q(integrator);
    ck_assert_int_eq(dvi_system_momentum(system, 0, at, model->v, alpha), DVI_OK);
    ck_assert_double_le(distance(2, alpha, _i == 2 ? dvi_integrator_p(integrator) : before[1]),
                        1e-13 * magnitude(2, alpha));
  }
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

/* Two of these gauges make Dalpha singular, too. */
START_TEST(other_gauges_are_refused_and_the_sentence_names_one_that_helps)
{
  static const char *const place[][2] = {{"lotka-volterra", NULL},
                                         {"lotka-volterra", "gauge=singular"},
                                         {"massless-particle", "gauge=singular"},
                                         {"vortices", NULL},
                                         {"guiding-centre", NULL},
                                         {"tokamak", NULL},
                                         {"lotka-volterra-4d", NULL}};
  for (size_t k = 0; k < sizeof place / sizeof *place; k++) {
    problem *model = create_problem(place[k][0], place[k][1]);
    dvi_integrator *integrator = start_integrator(model, method_spec("hp:type=%d", _i));
    ck_assert_int_eq(dvi_integrator_step(integrator, 1e-3), DVI_SINGULAR);
    check_words("f = c |q|^2/2 with c well above");
    ck_assert_mem_eq(dvi_integrator_p(integrator), model->p, (size_t)model->nq * sizeof(double));
    dvi_integrator_destroy(&integrator);
    problem_destroy(&model);
  }
}
END_TEST

/* ---- the parasite ---- */

/* With alpha = (S, W; -W, 2 S) q, S = 0.3, W = -1/2 the symmetric part is definite. */
static int form(const double *q, double *alpha, void *user)
{
  (void)user;
  alpha[0] = 0.3 * q[0] - 0.5 * q[1];
  alpha[1] = 0.5 * q[0] + 0.6 * q[1];
  return 0;
}

static int form_gradient(const double *q, double *alpha_q, void *user)
{
  static const double constant[] = {0.3, -0.5, 0.5, 0.6};
  (void)q, (void)user;
  memcpy(alpha_q, constant, sizeof constant);
  return 0;
}

static int energy(double t, const double *q, double *H, void *user)
{
  (void)t, (void)user;
  *H = cosh(q[0]) + 0.5 * cosh(1.5 * q[1]);
  return 0;
}

static int energy_gradient(double t, const double *q, double *H_q, void *user)
{
  (void)t, (void)user;
  H_q[0] = sinh(q[0]);
  H_q[1] = 0.75 * sinh(1.5 * q[1]);
  return 0;
}

enum { CHANGES = 4 };

/* The changes of p - alpha(q) from step to step, which the parasite makes alone, but for O(h). */
static void find_changes(const char *method, double (*change)[2])
{
  const dvi_one_form linear = {.value = form, .gradient = form_gradient};
  const dvi_potential H = {.value = energy, .gradient = energy_gradient};
  const dvi_system_terms terms = {
      .dimension = 2, .one_form = &linear, .potentials = &H, .potential_count = 1, .autonomous = 1};
  const double q[2] = {1, 0.5}, v[2] = {0, 0};
  double alpha[2], off[2] = {0, 0};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  for (int k = 0; k < CHANGES; k++) {
    advance(integrator, 0.005, 1);
    (void)form(dvi_integrator_q(integrator), alpha, NULL);
    for (int i = 0; i < 2; i++) {
      const double now = dvi_integrator_p(integrator)[i] - alpha[i];
      change[k][i] = now - off[i];
      off[i] = now;
    }
  }
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}

/* Gives (-1)^(d-1) times the eigenvalues of Dalpha^-T Dalpha. Their sum and product follow by
 * Cayley and Hamilton from three successive changes. The trace of Dalpha^-T Dalpha is 2 (ad - b^2/2
 * - c^2/2)/(ad - bc). */
START_TEST(the_parasites_multipliers_are_those_of_the_one_form_with_radaus_rules)
{
  const double expected = (_i % 2 == 1 ? 1 : -1) * 2 * (0.18 - 0.25) / (0.18 + 0.25);
  for (int type = 2; type <= 3; type++) {
    double D[CHANGES][2];
    find_changes(method_spec("hp:type=%d,degree=%d", type, _i), D);
    const double det = D[1][1] * D[2][0] - D[1][0] * D[2][1],
                 sum = (D[1][1] * D[3][0] - D[1][0] * D[3][1]) / det,
                 product = (D[3][0] * D[2][1] - D[3][1] * D[2][0]) / det;
    ck_assert_double_eq_tol(sum, expected, 0.05);
    ck_assert_double_eq_tol(product, 1, 0.05);
  }
}
END_TEST

START_TEST(with_lobattos_points_it_is_one_or_minus_one)
{
  double D[CHANGES][2];
  find_changes(method_spec("hp:type=2,degree=%d,quadrature=lobatto", _i), D);
  for (int i = 0; i < 2; i++) ck_assert_double_eq_tol(D[2][i] / D[1][i], _i % 2 == 1 ? -1 : 1, 0.1);
}
END_TEST

/* Only roundings are left. */
START_TEST(with_gauss_points_there_is_none_where_alpha_is_linear)
{
  double D[CHANGES][2];
  find_changes(method_spec("hp:type=2,degree=%d,quadrature=gauss", _i), D);
  for (int k = 0; k < CHANGES; k++) ck_assert_double_le(magnitude(2, D[k]), 5e-15);
}
END_TEST

/* ---- a multiplier at 1 ---- */

/* alpha = (S q0 - q1/2, q0/2 + S q1): with nu = 1/(2 S) lambda is -1 for S = 0, and goes to 1 with
 * S. */
static int round_form(const double *q, double *alpha, void *user)
{
  const double S = *(const double *)user;
  alpha[0] = S * q[0] - 0.5 * q[1];
  alpha[1] = 0.5 * q[0] + S * q[1];
  return 0;
}

static int round_gradient(const double *q, double *alpha_q, void *user)
{
  const double S = *(const double *)user;
  (void)q;
  alpha_q[0] = alpha_q[3] = S;
  alpha_q[1] = -0.5;
  alpha_q[2] = 0.5;
  return 0;
}

static dvi_status try_round(double S, const char *method)
{
  const dvi_one_form linear = {.value = round_form, .gradient = round_gradient, .user = &S};
  const dvi_potential H = {.value = energy, .gradient = energy_gradient};
  const dvi_system_terms terms = {
      .dimension = 2, .one_form = &linear, .potentials = &H, .potential_count = 1, .autonomous = 1};
  const double q[2] = {1, 0.5}, v[2] = {0, 0};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  const dvi_status status = dvi_integrator_step(integrator, 1e-4);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  return status;
}

/* |1 - mu| is below 0.02 for 2 S < 0.01 and even degrees, and for 2 S > 100 and odd ones. */
START_TEST(multipliers_near_1_are_refused)
{
  static const struct {
    double S;
    int odd, even;
  } tried[] = {{0, 1, 0},   {2e-9, 1, 0}, {-0.004, 1, 0}, {-0.006, 1, 1},
               {0.3, 1, 1}, {45, 1, 1},   {-55, 0, 1},    {300, 0, 1}};
  for (size_t k = 0; k < sizeof tried / sizeof *tried; k++) {
    const int allowed = _i % 2 == 1 ? tried[k].odd : tried[k].even;
    for (int type = 2; type <= 3; type++) {
      const dvi_status status = try_round(tried[k].S,
                                          method_spec("hp:type=%d,degree=%d", type, _i));
      ck_assert_msg(status == (allowed ? DVI_OK : DVI_SINGULAR), "S = %g: %s", tried[k].S,
                    dvi_status_name(status));
      if (!allowed) check_words("adds up from step to step and costs an order; use ");
      if (!allowed) check_words(_i % 2 == 1 ? "a weaker gauge" : "f = c |q|^2/2 with c about 0.5");
    }
  }
}
END_TEST

START_TEST(odd_degrees_need_no_symmetric_part)
{
  check_degenerate_order("vortices-linear", NULL, method_spec("hp:type=%d", _i), 0.0001, 1);
  check_degenerate_order("vortices-linear", NULL, method_spec("hp:type=%d,degree=3", _i), 0.05, 3);
}
END_TEST

START_TEST(coarse_quadratures_are_refused)
{
  problem *model = create_problem("lotka-volterra", NULL);
  dvi_integrator *none = NULL;
  ck_assert_int_eq(
      dvi_integrator_create(model->system, "hp:type=2,degree=2,quadrature=trapezoid", &none),
      DVI_BAD_OPTION);
  check_words("has order 2, and does not integrate even a constant two-form with degree 2; order 3 "
              "is needed");
  ck_assert_ptr_null(none);
  problem_destroy(&model);
}
END_TEST

SUITE(hp_degenerate)
{
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, orders_are_those_claimed_in_every_gauge, 0, CLAIMS);
  tcase_add_test(tests, energy_stays_bounded_over_long_runs);
  tcase_add_test(tests, steps_are_symplectic);
  tcase_add_loop_test(tests, with_symmetric_quadratures_a_step_back_undoes_a_step, 1, 4);
  tcase_add_loop_test(
      tests, radaus_distance_from_the_constraint_shrinks_with_the_order_and_bounds_the_error, 0,
      LIFTS);
  tcase_add_loop_test(tests, the_lowest_degrees_take_alpha_at_one_end, 2, 4);
  tcase_add_loop_test(tests, other_gauges_are_refused_and_the_sentence_names_one_that_helps, 2, 4);
  tcase_add_loop_test(tests, the_parasites_multipliers_are_those_of_the_one_form_with_radaus_rules,
                      1, 4);
  tcase_add_loop_test(tests, with_lobattos_points_it_is_one_or_minus_one, 1, 3);
  tcase_add_loop_test(tests, with_gauss_points_there_is_none_where_alpha_is_linear, 1, 4);
  tcase_add_loop_test(tests, multipliers_near_1_are_refused, 1, 5);
  tcase_add_loop_test(tests, odd_degrees_need_no_symmetric_part, 2, 4);
  tcase_add_test(tests, coarse_quadratures_are_refused);
}
