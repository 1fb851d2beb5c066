/* labels: order */
/* The method for nonholonomic constraints: orders, what is kept, symmetry, multipliers. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/rolling.h"

static const char *const problems[] = {"knife-edge", "sleigh", "snakeboard", "rolling-disk",
                                       "disk-ball"};
static const char *const rules[] = {"nonholonomic:rows=midpoint", "nonholonomic:rows=average"};
enum { PROBLEMS = sizeof problems / sizeof *problems, RULES = 2, LEVELS = 5 };

/* ---- orders ---- */

typedef struct claim {
  const char *method;
  int order;
  double part; /* of the problem's step for studies of order 2 */
} claim;

static const claim claims[] = {
    {"nonholonomic:rows=midpoint", 2, 0.5},
    {"nonholonomic:rows=average", 2, 0.5},
    {"nonholonomic:solver=kinsol", 2, 0.5},
    {"composition:order=4", 4, 1},
    {"composition:order=4,base=nonholonomic,rows=midpoint", 4, 1},
    {"composition:order=6,base=nonholonomic", 6, 2},
};
enum { CLAIMS = sizeof claims / sizeof *claims };

/* The last two errors above the floor give the slope. The first level may be too coarse for the
 * order. */
static void check_slope(const char *method, const char *name, int order, const double *error)
{
  const double floor = 2e-12;
  int last = -1;
  for (int level = 0; level < LEVELS; level++)
    if (error[level] > floor) last = level;
  ck_assert_msg(last >= 1, "%s of %s: nothing to fit, the first error is %.1e", method, name,
                error[0]);
  const double slope = log2(error[last - 1] / error[last]);
  ck_assert_msg(slope > order - 0.3 && slope < order + 0.6,
                "%s of %s: order %.2f, not %d, from the errors %.2e, %.2e, %.2e, %.2e, %.2e",
                method, name, slope, order, error[0], error[1], error[2], error[3], error[4]);
}

/* The digits are those of the reduced equations in quadruple precision. */
START_TEST(methods_have_their_order)
{
  const claim *c = &claims[_i / PROBLEMS];
  problem *model = create_problem(problems[_i % PROBLEMS], NULL);
  double error[LEVELS];
  for (int level = 0; level < LEVELS; level++) {
    dvi_integrator *integrator = start_integrator(model, c->method);
    const long steps = lround(model->order_t_end / (c->part * model->order_h)) << level;
    advance(integrator, model->order_t_end / (double)steps, steps);
    error[level] = fmax(distance(model->nq, dvi_integrator_q(integrator), model->digits_q),
                        distance(model->nq, dvi_integrator_p(integrator), model->digits_p));
    dvi_integrator_destroy(&integrator);
  }
  check_slope(c->method, model->name, c->order, error);
  problem_destroy(&model);
}
END_TEST

static void end_by_ida(const rolling *model, double *q)
{
  const dvi_reference_options tight = {.code = DVI_IDA, .relative_tolerance = 1e-12};
  double p[ROLLING_N];
  memcpy(q, model->q, sizeof model->q);
  ck_assert_int_eq(dvi_system_momentum(model->system, 0, q, model->v, p), DVI_OK);
  ck_assert_msg(dvi_reference_solve(model->system, 0, model->span, q, p, &tight, NULL) == DVI_OK,
                "%s: %s", model->name, dvi_last_error());
}

/* Friction, rows that depend on time, and holonomic constraints beside them. */
START_TEST(forces_time_and_holonomic_rows_keep_the_order)
{
  for (int kind = ROLLING_PLATE; kind <= ROLLING_COSINES; kind++)
    for (int rule = 0; rule < RULES + 1; rule++) {
      const char *method = rule < RULES ? rules[rule] : "composition:order=4";
      rolling model;
      double q[ROLLING_N], error[3];
      make_rolling((rolling_kind)kind, 0, &model);
      end_by_ida(&model, q);
      for (int level = 0; level < 3; level++) {
        dvi_integrator *integrator = rolling_integrator(&model, method);
        const long steps = (long)(rule < RULES ? 100 : 10) << level;
        advance(integrator, model.span / (double)steps, steps);
        error[level] = distance(model.n, dvi_integrator_q(integrator), q);
        dvi_integrator_destroy(&integrator);
      }
      const int order = rule < RULES ? 2 : 4;
      const double slope = log2(error[1] / error[2]);
      ck_assert_msg(fabs(slope - order) < 0.3, "%s of %s: order %.2f from %.2e, %.2e, %.2e", method,
                    model.name, slope, error[0], error[1], error[2]);
      destroy_rolling(&model);
    }
}
END_TEST

/* ---- judges ---- */

START_TEST(all_judges_meet_the_digits)
{
  static const dvi_reference_code codes[] = {DVI_IDA, DVI_CVODE_ADAMS, DVI_ARKODE};
  problem *model = create_problem(problems[_i], NULL);
  for (size_t k = 0; k < sizeof codes / sizeof *codes; k++) {
    const dvi_reference_options tight = {.code = codes[k], .relative_tolerance = 1e-11};
    double q[8], p[8];
    memcpy(q, model->q, (size_t)model->nq * sizeof *q);
    memcpy(p, model->p, (size_t)model->nq * sizeof *p);
    ck_assert_msg(dvi_reference_solve(model->system, 0, model->order_t_end, q, p, &tight, NULL) ==
                      DVI_OK,
                  "%s: %s", model->name, dvi_last_error());
    const double off = distance(model->nq, q, model->digits_q);
    ck_assert_msg(off < 2e-8, "%s: code %d is off by %.1e", model->name, (int)codes[k], off);
  }
  problem_destroy(&model);
}
END_TEST

/* ---- what is kept ---- */

/* Rows see the roundings of angles, which grow as these do. The rule by averages conserves the
 * energies of disk and sleigh to rounding. The other one has an error of the square of h on the
 * sleigh, which sets in as it straightens. On the snakeboard, whose motion has no such end, it is
 * bounded. */
START_TEST(rows_hold_to_rounding_and_energies_are_bounded)
{
  static const struct {
    const char *problem;
    int rule, steps;
    double h, least, most;
  } runs[] = {{"rolling-disk", 0, 2000, 0.1, 0, 5e-12}, {"rolling-disk", 1, 2000, 0.1, 0, 5e-12},
              {"sleigh", 1, 2000, 0.1, 0, 1e-12},       {"sleigh", 0, 2000, 0.1, 2e-4, 5e-3},
              {"knife-edge", 1, 2000, 0.05, 0, 0.2},    {"snakeboard", 1, 4000, 0.05, 0, 2e-2},
              {"snakeboard", 0, 4000, 0.05, 0, 2e-2}};
  problem *model = create_problem(runs[_i].problem, NULL);
  dvi_integrator *integrator = start_integrator(model, rules[runs[_i].rule]);
  double first, energy, distance, worst = 0, off = 0;
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &first), DVI_OK);
  for (int k = 0; k < runs[_i].steps; k++) {
    advance(integrator, runs[_i].h, 1);
    ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &energy), DVI_OK);
    ck_assert_int_eq(dvi_integrator_constraint(integrator, &distance), DVI_OK);
    worst = fmax(worst, fabs(energy - first));
    off = fmax(off, distance / (1 + magnitude(model->nq, dvi_integrator_q(integrator))));
  }
  ck_assert_msg(off < 2e-15, "%s: A v is %.1e of the coordinates", model->name, off);
  ck_assert_msg(worst >= runs[_i].least && worst <= runs[_i].most,
                "%s, %s: the energy is off by %.1e", model->name, rules[runs[_i].rule], worst);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* The step itself fulfils A_d (q1 - q0) + h a_d = 0. */
START_TEST(the_discrete_constraint_holds)
{
  for (int rule = 0; rule < RULES; rule++) {
    problem *model = create_problem("sleigh", NULL);
    dvi_integrator *integrator = start_integrator(model, rules[rule]);
    const double h = 0.1, a = 0.3;
    double q[3];
    for (int k = 0; k < 20; k++) {
      memcpy(q, dvi_integrator_q(integrator), sizeof q);
      advance(integrator, h, 1);
      const double *q1 = dvi_integrator_q(integrator), middle = (q[2] + q1[2]) / 2;
      const double s = rule == 0 ? sin(middle) : (sin(q[2]) + sin(q1[2])) / 2,
                   c = rule == 0 ? cos(middle) : (cos(q[2]) + cos(q1[2])) / 2;
      const double off = s * (q1[0] - q[0]) - c * (q1[1] - q[1]) + a * (q1[2] - q[2]);
      ck_assert_msg(fabs(off) < 5e-15, "%s: step %d is off by %.1e", rules[rule], k, off);
    }
    dvi_integrator_destroy(&integrator);
    problem_destroy(&model);
  }
}
END_TEST

START_TEST(steps_back_undo_steps)
{
  static const char *const methods[] = {"nonholonomic:rows=midpoint", "nonholonomic:rows=average",
                                        "composition:order=6"};
  for (int m = 0; m < 3; m++) {
    problem *model = create_problem(problems[_i], NULL);
    dvi_integrator *integrator = start_integrator(model, methods[m]);
    advance(integrator, 0.05, 40);
    advance(integrator, -0.05, 40);
    const double off = distance(model->nq, dvi_integrator_q(integrator), model->q);
    ck_assert_msg(off < 1e-12, "%s of %s: %.1e", methods[m], model->name, off);
    dvi_integrator_destroy(&integrator);
    problem_destroy(&model);
  }
}
END_TEST

/* ---- balances and multipliers ---- */

static int friction(double t, const double *q, const double *v, double *F, void *user)
{
  (void)t, (void)q, (void)user;
  for (int i = 0; i < 3; i++) F[i] = -0.2 * v[i];
  return 0;
}

/* Gives what the energy of the knife edge has lost, and the defect of its balance. */
static void lose_energy(double h, int steps, double *lost, double *defect)
{
  const dvi_force force = {.name = "friction", .value = friction};
  problem *model = create_problem("knife-edge", NULL);
  dvi_system_terms terms = *model->terms;
  dvi_system *system;
  dvi_integrator *integrator;
  double now, before;
  terms.forces = &force;
  terms.force_count = 1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  const dvi_integrator_options options = {
      .size = sizeof options, .method = "nonholonomic", .balances = 1};
  ck_assert_int_eq(dvi_integrator_create_with(system, &options, &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, model->p), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &before), DVI_OK);
  advance(integrator, h, steps);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &now), DVI_OK);
  ck_assert_int_eq(dvi_integrator_balance(integrator, 0, defect), DVI_OK);
  *lost = before - now;
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}

START_TEST(friction_supplies_what_the_energy_changes)
{
  double lost[3], defect[3];
  for (int k = 0; k < 3; k++) lose_energy(0.05 / (1 << k), 100 << k, &lost[k], &defect[k]);
  ck_assert_double_gt(lost[2], 1);
  const double slope = log2(fabs(defect[1] / defect[2]));
  ck_assert_msg(fabs(slope - 2) < 0.2 && fabs(defect[0]) < 0.05,
                "order %.2f, from the defects %.1e, %.1e, %.1e", slope, defect[0], defect[1],
                defect[2]);
}
END_TEST

/* In a circle the ground holds the disk with m R spin turn, along -sin(a), cos(a). */
START_TEST(multipliers_are_those_of_the_equations_of_motion)
{
  problem *model = create_problem("rolling-disk", NULL);
  dvi_integrator *integrator = start_integrator(model, "composition:order=4");
  double lambda[2];
  ck_assert_int_eq(dvi_system_constraint_count(model->system), 2);
  advance(integrator, 0.05, 40);
  ck_assert_int_eq(dvi_integrator_reactions(integrator, lambda), DVI_OK);
  const double turn = 0.7, force = 0.5 * 3 * turn, a = turn * 2;
  ck_assert_double_eq_tol(lambda[0], force * sin(a), 1e-9);
  ck_assert_double_eq_tol(lambda[1], -force * cos(a), 1e-9);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(differenced_derivatives_give_nearly_the_same_steps)
{
  for (int kind = ROLLING_PLATE; kind <= ROLLING_COSINES; kind++) {
    rolling given, differenced;
    make_rolling((rolling_kind)kind, 0, &given);
    make_rolling((rolling_kind)kind, 1, &differenced);
    dvi_integrator *one = rolling_integrator(&given, "nonholonomic"),
                   *other = rolling_integrator(&differenced, "nonholonomic");
    advance(one, 0.05, 20);
    advance(other, 0.05, 20);
    ck_assert_double_lt(distance(given.n, dvi_integrator_q(one), dvi_integrator_q(other)), 1e-12);
    dvi_integrator_destroy(&one);
    dvi_integrator_destroy(&other);
    destroy_rolling(&given);
    destroy_rolling(&differenced);
  }
}
END_TEST

SUITE(nonholonomic)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, methods_have_their_order, 0, CLAIMS * PROBLEMS);
  tcase_add_test(tests, forces_time_and_holonomic_rows_keep_the_order);
  tcase_add_loop_test(tests, all_judges_meet_the_digits, 0, PROBLEMS);
  tcase_add_loop_test(tests, rows_hold_to_rounding_and_energies_are_bounded, 0, 7);
  tcase_add_test(tests, the_discrete_constraint_holds);
  tcase_add_loop_test(tests, steps_back_undo_steps, 0, PROBLEMS);
  tcase_add_test(tests, friction_supplies_what_the_energy_changes);
  tcase_add_test(tests, multipliers_are_those_of_the_equations_of_motion);
  tcase_add_test(tests, differenced_derivatives_give_nearly_the_same_steps);
}
