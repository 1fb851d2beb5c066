/* labels: order long */
/* Constraints that depend on others: three cranks with one coupler, which have six rows of rank 5,
 * beside the same machine without one of the rows. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { N = 6, ROWS = 6, LEFT_OUT = 3 };

static const char *const methods[] = {"midpoint",
                                      "trapezoidal",
                                      "galerkin:degree=2",
                                      "galerkin:degree=3,quadrature=lobatto",
                                      "galerkin:degree=4,basis=legendre",
                                      "galerkin:degree=3,solver=kinsol",
                                      "verlet",
                                      "composition:order=4,base=verlet",
                                      "composition:order=6"};
enum { METHODS = sizeof methods / sizeof *methods };

/* ---- the same machine without one of its rows, and with rows of other sizes ---- */

typedef struct changed {
  const dvi_holonomic *rows;
  int out;            /* bits of the rows that are left out */
  double scale[ROWS]; /* of each row that stays */
} changed;

static int is_out(const changed *own, int row)
{
  return own->out >> row & 1;
}

static int changed_value(double t, const double *q, double *phi, void *user)
{
  const changed *own = user;
  double all[ROWS];
  const int status = own->rows->value(t, q, all, own->rows->user);
  for (int a = 0, at = 0; a < ROWS; a++)
    if (!is_out(own, a)) phi[at++] = own->scale[a] * all[a];
  return status;
}

static int changed_gradient(double t, const double *q, double *phi_q, void *user)
{
  const changed *own = user;
  double all[3 * ROWS];
  const int status = own->rows->gradient(t, q, all, own->rows->user);
  for (int a = 0, at = 0; a < ROWS; a++)
    for (int e = 3 * a; !is_out(own, a) && e < 3 * a + 3; e++) phi_q[at++] = own->scale[a] * all[e];
  return status;
}

static int changed_hessian(double t, const double *q, const double *w, double *phi_w, void *user)
{
  const changed *own = user;
  double all[ROWS];
  for (int a = 0, at = 0; a < ROWS; a++) all[a] = is_out(own, a) ? 0 : own->scale[a] * w[at++];
  return own->rows->hessian(t, q, all, phi_w, own->rows->user);
}

/* `of` must outlive the system. */
static dvi_system *change_rows(const problem *model, changed *of)
{
  const dvi_holonomic *rows = of->rows = model->terms->holonomics;
  int row[3 * ROWS], start[ROWS + 1] = {0}, count = 0;
  for (int a = 0; a < ROWS; a++) {
    if (is_out(of, a)) continue;
    memcpy(row + start[count], rows->gradients.row + rows->gradients.start[a], 3 * sizeof *row);
    start[count + 1] = start[count] + 3;
    count++;
  }
  const dvi_holonomic changed_rows = {.name = "changed",
                                      .count = count,
                                      .value = changed_value,
                                      .gradient = changed_gradient,
                                      .hessian = changed_hessian,
                                      .gradients = {start, row},
                                      .qq = rows->qq,
                                      .user = of};
  dvi_system_terms terms = *model->terms;
  terms.holonomics = &changed_rows;
  dvi_system *system;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static dvi_integrator *start_as(const problem *model, const dvi_system *system, const char *method)
{
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_msg(dvi_integrator_start(integrator, 0, model->q, model->p) == DVI_OK, "%s",
                dvi_last_error());
  return integrator;
}

static void ends_are_near(const dvi_integrator *one, const dvi_integrator *other, double most,
                          const char *what)
{
  const double in_q = distance(N, dvi_integrator_q(one), dvi_integrator_q(other)),
               in_p = distance(N, dvi_integrator_p(one), dvi_integrator_p(other));
  ck_assert_msg(in_q < most && in_p < 10 * most, "%s: off by %.1e and %.1e", what, in_q, in_p);
}

START_TEST(states_are_those_of_independent_rows)
{
  problem *model = create_problem("three-cranks", NULL);
  changed five = {.out = 1 << LEFT_OUT, .scale = {1, 1, 1, 1, 1, 1}};
  dvi_system *independent = change_rows(model, &five);
  dvi_integrator *one = start_integrator(model, methods[_i]),
                 *other = start_as(model, independent, methods[_i]);
  dvi_counters all, fewer;
  advance(one, 0.02, 150);
  advance(other, 0.02, 150);
  ends_are_near(one, other, 1e-13, methods[_i]);
  dvi_integrator_counters(one, &all);
  dvi_integrator_counters(other, &fewer);
  /* verlet makes a new matrix in each iteration; a residual more costs less than that */
  const double more = strstr(methods[_i], "verlet") != NULL ? 1.5 : 1.1;
  ck_assert_msg((double)all.residuals <= more * (double)fewer.residuals,
                "%s: %ld residuals, not %ld", methods[_i], all.residuals, fewer.residuals);
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&other);
  dvi_system_destroy(&independent);
  problem_destroy(&model);
}
END_TEST

/* The size of a row means nothing. */
START_TEST(rows_of_any_size_give_the_same_states)
{
  problem *model = create_problem("three-cranks", NULL);
  changed sizes = {.out = 0, .scale = {1e12, 1, 1e-12, 1e6, 1, 1e-9}},
          five = {.out = 1 << LEFT_OUT, .scale = {1e12, 1, 1, 1e-12, 1e6, 1e-6}};
  dvi_system *six = change_rows(model, &sizes), *independent = change_rows(model, &five);
  dvi_integrator *one = start_integrator(model, methods[_i]),
                 *other = start_as(model, six, methods[_i]),
                 *third = start_as(model, independent, methods[_i]);
  advance(one, 0.02, 50);
  advance(other, 0.02, 50);
  advance(third, 0.02, 50);
  ends_are_near(one, other, 1e-13, methods[_i]);
  ends_are_near(one, third, 1e-13, methods[_i]);
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&other);
  dvi_integrator_destroy(&third);
  dvi_system_destroy(&six);
  dvi_system_destroy(&independent);
  problem_destroy(&model);
}
END_TEST

/* ---- orders ---- */

static const struct {
  const char *method;
  int order, steps; /* of the longest step */
} claims[] = {{"trapezoidal", 2, 40},
              {"midpoint", 2, 40},
              {"verlet", 2, 40},
              {"galerkin:degree=2", 4, 20},
              {"galerkin:degree=2,quadrature=lobatto", 4, 20},
              {"galerkin:degree=3", 6, 15},
              {"composition:order=4,base=verlet", 4, 60}};
enum { CLAIMS = sizeof claims / sizeof *claims, LEVELS = 4 };

/* The digits are those of the pendulum, in quadruple precision. */
START_TEST(orders_are_those_of_independent_rows)
{
  problem *model = create_problem("three-cranks", NULL);
  double error[LEVELS];
  for (int level = 0; level < LEVELS; level++) {
    const int steps = claims[_i].steps << level;
    dvi_integrator *integrator = start_integrator(model, claims[_i].method);
    advance(integrator, model->order_t_end / steps, steps);
    error[level] = distance(N, dvi_integrator_q(integrator), model->digits_q);
    dvi_integrator_destroy(&integrator);
  }
  const double slope = log2(error[LEVELS - 2] / error[LEVELS - 1]);
  ck_assert_msg(fabs(slope - claims[_i].order) < 0.3 && error[LEVELS - 1] > 1e-13,
                "%s: order %.2f from the errors %.2e, %.2e, %.2e, %.2e", claims[_i].method, slope,
                error[0], error[1], error[2], error[3]);
  problem_destroy(&model);
}
END_TEST

/* IDA integrates rows that are independent at the start alone, as long as they are. The judge is
 * IDA on five other rows. */
START_TEST(ida_takes_independent_rows)
{
  const dvi_reference_options tight = {.code = DVI_IDA, .relative_tolerance = 1e-11};
  problem *model = create_problem("three-cranks", NULL);
  changed five = {.out = 1 << LEFT_OUT, .scale = {1, 1, 1, 1, 1, 1}};
  dvi_system *independent = change_rows(model, &five);
  double q[2][N], p[2][N];
  for (int k = 0; k < 2; k++) {
    memcpy(q[k], model->q, sizeof q[k]);
    memcpy(p[k], model->p, sizeof p[k]);
    ck_assert_msg(dvi_reference_solve(k == 0 ? model->system : independent, 0, 0.3, q[k], p[k],
                                      &tight, NULL) == DVI_OK,
                  "%s", dvi_last_error());
  }
  ck_assert_double_lt(distance(N, q[0], q[1]), 1e-9);
  dvi_system_destroy(&independent);
  problem_destroy(&model);
}
END_TEST

/* ---- what is said of them ---- */

START_TEST(explain_names_the_rows_that_depend_on_others)
{
  static char text[4096];
  problem *model = create_problem("three-cranks", NULL);
  dvi_integrator *integrator = start_integrator(model, "galerkin");
  (void)dvi_integrator_explain(integrator, text, sizeof text);
  ck_assert_msg(strstr(text, "constraints: 6 rows of rank 5; ") != NULL, "%s", text);
  ck_assert_msg(strstr(text, "'middle_x'") != NULL, "%s", text);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Multipliers that have no effect are 0, so that those of the symmetric machine are symmetric, and
 * G^T lambda is that of five rows. */
START_TEST(reactions_have_the_forces_of_independent_rows)
{
  problem *model = create_problem("three-cranks", NULL);
  changed five = {.out = 1 << LEFT_OUT, .scale = {1, 1, 1, 1, 1, 1}};
  dvi_system *independent = change_rows(model, &five);
  dvi_integrator *one = start_integrator(model, "galerkin"),
                 *other = start_as(model, independent, "galerkin");
  const dvi_holonomic *rows = model->terms->holonomics;
  double lambda[ROWS], fewer[ROWS], G[3 * ROWS], sum[N] = {0};
  ck_assert_int_eq(dvi_integrator_reactions(one, lambda), DVI_OK);
  ck_assert_int_eq(dvi_integrator_reactions(other, fewer), DVI_OK);
  rows->gradient(0, model->q, G, rows->user);
  for (int a = 0, at = 0; a < ROWS; a++) {
    const double less = a == LEFT_OUT ? 0 : fewer[at++];
    for (int e = 3 * a; e < 3 * a + 3; e++)
      sum[rows->gradients.row[e]] += G[e] * (lambda[a] - less);
  }
  ck_assert_double_lt(magnitude(N, sum), 1e-9);
  ck_assert_double_eq_tol(lambda[0], lambda[4], 1e-7);
  ck_assert_double_eq_tol(lambda[1], lambda[5], 1e-7);
  dvi_integrator_destroy(&one);
  dvi_integrator_destroy(&other);
  dvi_system_destroy(&independent);
  problem_destroy(&model);
}
END_TEST

/* ---- a rank that changes ---- */

START_TEST(cranks_in_line_are_refused_at_a_start)
{
  problem *model = create_problem("three-cranks", NULL);
  const double q[N] = {acos(0), acos(0), acos(0), 0.7, 0, 0};
  double p[N] = {0};
  dvi_integrator *integrator = create_integrator(model->system, methods[_i]);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_SINGULAR);
  check_words("depends on the others at t = 0, but not around this point");
  check_words("_x'");
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* The cranks turn over, and are in line with the coupler after a quarter of a turn. So are two
 * cranks with four independent rows, beside one that hangs free. */
START_TEST(steps_past_cranks_in_line_are_refused_and_change_nothing)
{
  problem *model = create_problem("three-cranks", "start=0");
  changed four = {.out = 1 << 2 | 1 << 3, .scale = {1, 1, 1, 1, 1, 1}};
  dvi_system *independent = change_rows(model, &four);
  const double v[N] = {11, 11, 11, 7.7, 0, 0};
  for (int k = 0; k < 2; k++) {
    dvi_integrator *integrator = create_integrator(k == 0 ? model->system : independent,
                                                   methods[_i]);
    ck_assert_msg(dvi_integrator_start_velocity(integrator, 0, model->q, v) == DVI_OK, "%s",
                  dvi_last_error());
    double before[2 * N], t = 0;
    dvi_status status = DVI_OK;
    for (int step = 0; step < 200 && status == DVI_OK; step++) {
      t = dvi_integrator_time(integrator);
      memcpy(before, dvi_integrator_q(integrator), N * sizeof *before);
      memcpy(before + N, dvi_integrator_p(integrator), N * sizeof *before);
      status = dvi_integrator_step(integrator, 0.004);
    }
    ck_assert_msg(status == DVI_SINGULAR, "%s: status %d, %s", methods[_i], status,
                  dvi_last_error());
    check_words("the step passes a point where constraint '");
    ck_assert_double_eq_tol(before[0], acos(0), 0.05);
    ck_assert_double_eq(dvi_integrator_time(integrator), t);
    ck_assert_mem_eq(dvi_integrator_q(integrator), before, N * sizeof *before);
    ck_assert_mem_eq(dvi_integrator_p(integrator), before + N, N * sizeof *before);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&independent);
  problem_destroy(&model);
}
END_TEST

/* A crank that turns by half a right angle between nodes, and by more than a right angle in a step,
 * passes no such point. */
START_TEST(long_steps_of_a_crank_that_turns_are_taken)
{
  static const char *const high[] = {"galerkin:degree=4", "galerkin:degree=6", "galerkin:degree=8"};
  static const double error[] = {0.2, 2e-2, 1e-3};
  problem *model = create_problem("slider-crank", NULL);
  dvi_integrator *integrator = start_integrator(model, high[_i]);
  advance(integrator, 0.08, 25);
  const double off = distance(model->nq, dvi_integrator_q(integrator), model->digits_q);
  ck_assert_double_lt(off, error[_i]);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- checkpoints, members, long runs ---- */

START_TEST(a_restored_run_has_the_same_bits)
{
  static unsigned char bytes[1 << 16];
  size_t size;
  double lambda[2][ROWS];
  problem *model = create_problem("three-cranks", NULL);
  dvi_integrator *first = start_integrator(model, methods[_i]),
                 *second = create_integrator(model->system, methods[_i]);
  advance(first, 0.02, 20);
  ck_assert_int_eq(dvi_integrator_save_memory(first, bytes, sizeof bytes, &size), DVI_OK);
  ck_assert_msg(dvi_integrator_restore_memory(second, bytes, size) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_reactions(first, lambda[0]), DVI_OK);
  ck_assert_int_eq(dvi_integrator_reactions(second, lambda[1]), DVI_OK);
  ck_assert_double_lt(distance(ROWS, lambda[0], lambda[1]), 1e-6);
  advance(first, 0.02, 20);
  advance(second, 0.02, 20);
  ck_assert_mem_eq(dvi_integrator_q(first), dvi_integrator_q(second), N * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(first), dvi_integrator_p(second), N * sizeof(double));
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&second);
  problem_destroy(&model);
}
END_TEST

/* Without stabilisation. The energy's bounds are those of the first 2000 steps. The crank turns all
 * the time, and roundings of its rows are those of its angle. */
static const struct {
  const char *problem, *method;
  double h, energy, rows;
} machines[] = {{"three-cranks", "verlet", 0.01, 5e-3, 5e-15},
                {"three-cranks", "galerkin:degree=2", 0.04, 1e-4, 5e-15},
                {"slider-crank", "verlet", 0.002, 8e-4, 1e-14},
                {"slider-crank", "galerkin:degree=2", 0.01, 3e-5, 3e-14}};
enum { MACHINES = sizeof machines / sizeof *machines };

START_TEST(energy_is_bounded_and_rows_hold_to_rounding)
{
  const long steps = is_short_run() ? 5000 : 1000000;
  const char *method = machines[_i].method;
  problem *model = create_problem(machines[_i].problem, NULL);
  dvi_integrator *integrator = start_integrator(model, method);
  double first, energy, off, worst = 0, farthest = 0;
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &first), DVI_OK);
  for (long k = 0; k < steps; k++) {
    advance(integrator, machines[_i].h, 1);
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &energy), DVI_OK);
    ck_assert_int_eq(dvi_integrator_constraint(integrator, &off), DVI_OK);
    worst = fmax(worst, fabs(energy - first));
    farthest = fmax(farthest, off / fmax(1, magnitude(model->nq, dvi_integrator_q(integrator))));
  }
  ck_assert_msg(farthest < machines[_i].rows, "%s: the rows are off by %.1e", method, farthest);
  ck_assert_msg(worst < machines[_i].energy, "%s: the energy is off by %.1e", method, worst);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(redundant)
{
  tcase_set_timeout(tests, 900);
  tcase_add_loop_test(tests, states_are_those_of_independent_rows, 0, METHODS);
  tcase_add_loop_test(tests, rows_of_any_size_give_the_same_states, 0, METHODS);
  tcase_add_loop_test(tests, orders_are_those_of_independent_rows, 0, CLAIMS);
  tcase_add_test(tests, ida_takes_independent_rows);
  tcase_add_test(tests, explain_names_the_rows_that_depend_on_others);
  tcase_add_test(tests, reactions_have_the_forces_of_independent_rows);
  tcase_add_loop_test(tests, cranks_in_line_are_refused_at_a_start, 0, METHODS);
  tcase_add_loop_test(tests, steps_past_cranks_in_line_are_refused_and_change_nothing, 0, METHODS);
  tcase_add_loop_test(tests, long_steps_of_a_crank_that_turns_are_taken, 0, 3);
  tcase_add_loop_test(tests, a_restored_run_has_the_same_bits, 0, METHODS);
  tcase_add_loop_test(tests, energy_is_bounded_and_rows_hold_to_rounding, 0, MACHINES);
}
