/* labels: invariant */
/* Shooting: structure of the steps, refusals. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"

/* ---- structure ---- */

/* Methods of high orders that are not symmetric cannot be told from roundoff. */
enum { UNSYMMETRIC, SYMMETRIC, NEARLY };

static const struct {
  const char *setting;
  int symmetric;
} pairs[] = {{"onestep=euler,quadrature=trapezoid", UNSYMMETRIC},
             {"onestep=heun,quadrature=trapezoid", UNSYMMETRIC},
             {"onestep=rk4", UNSYMMETRIC},
             {"onestep=cooper-verner,quadrature=lobatto", NEARLY},
             {"onestep=backward-euler", UNSYMMETRIC},
             {"onestep=sdirk,stages=3", UNSYMMETRIC},
             {"onestep=radau-iia,quadrature=clenshaw-curtis", UNSYMMETRIC},
             {"onestep=implicit-midpoint,quadrature=trapezoid", SYMMETRIC},
             {"onestep=gauss,quadrature=lobatto", SYMMETRIC},
             {"onestep=lobatto-iiia,stages=3", SYMMETRIC},
             {"onestep=implicit-midpoint,composition=4", SYMMETRIC},
             {"onestep=taylor,stages=3", UNSYMMETRIC},
             {"onestep=rk4,quadrature=euler-maclaurin,terms=2", UNSYMMETRIC},
             {"onestep=taylor,stages=8,quadrature=euler-maclaurin", NEARLY},
             {"onestep=taylor,stages=6,quadrature=euler-maclaurin,terms=3", NEARLY},
             {"onestep=gauss,quadrature=euler-maclaurin,terms=3", SYMMETRIC},
             {"onestep=gauss,quadrature=gauss-hermite", SYMMETRIC},
             {"onestep=gauss,stages=4,quadrature=clenshaw-curtis", SYMMETRIC}};
enum { PAIRS = sizeof pairs / sizeof *pairs };

static const struct {
  const char *problem;
  double h;
} places[] = {{"pendulum", 0.2},
              {"kepler", 0.1},
              {"double-pendulum", 0.02},
              {"driven-pendulum", 0.1},
              {"henon-heiles", 0.2}};
enum { PLACES = sizeof places / sizeof *places };

/* 1e-10 is the floor of differences, see dvi_symplecticity. */
START_TEST(steps_are_symplectic_and_symmetric_pairs_symmetric)
{
  const char *method = method_spec("shooting:%s", pairs[_i].setting);
  for (int place = 0; place < PLACES; place++) {
    problem *model = create_problem(places[place].problem, NULL);
    dvi_integrator *integrator = start_integrator(model, method);
    double defect;
    ck_assert_int_eq(dvi_symplecticity(integrator, 0, model->q, model->p, places[place].h, &defect),
                     DVI_OK);
    ck_assert_msg(defect <= 1e-10, "%s %s: symplectic to %g", model->name, method, defect);
    ck_assert_int_eq(
        dvi_reversibility(integrator, 0, model->q, model->p, places[place].h, 20, &defect), DVI_OK);
    if (pairs[_i].symmetric != NEARLY)
      ck_assert_msg((pairs[_i].symmetric == SYMMETRIC) == (defect <= 1e-12),
                    "%s %s: reversible to %g", model->name, method, defect);
    dvi_integrator_destroy(&integrator);
    problem_destroy(&model);
  }
}
END_TEST

/* ---- momenta ---- */

/* Kepler's problem with x = q0, y = q1 + q0^2. A rotation is no affine map of q, and no Runge-Kutta
 * method is equivariant under it. */
typedef struct bent {
  double x, y, vx, vy, r3;
} bent;

static bent bent_at(const double *q, const double *v)
{
  const double y = q[1] + q[0] * q[0], r = hypot(q[0], y);
  return (bent){q[0], y, v[0], v[1] + 2 * q[0] * v[0], r * r * r};
}

static int bent_value(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  const bent b = bent_at(q, v);
  *L = (b.vx * b.vx + b.vy * b.vy) / 2 + 1 / cbrt(b.r3);
  return 0;
}

static int bent_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                         void *user)
{
  (void)t, (void)user;
  const bent b = bent_at(q, v);
  L_v[0] = b.vx + 2 * b.x * b.vy;
  L_v[1] = b.vy;
  L_q[0] = 2 * v[0] * b.vy - (b.x + 2 * b.x * b.y) / b.r3;
  L_q[1] = -b.y / b.r3;
  return 0;
}

static int bent_hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                        double *L_vv, void *user)
{
  (void)t, (void)user;
  const bent b = bent_at(q, v);
  const double rr = b.x * b.x + b.y * b.y, r5 = b.r3 * rr, s = 2 * b.x,
               xx = (3 * b.x * b.x - rr) / r5, xy = 3 * b.x * b.y / r5,
               yy = (3 * b.y * b.y - rr) / r5;
  L_qq[0] = 4 * v[0] * v[0] + xx + 2 * s * xy + s * s * yy - 2 * b.y / b.r3;
  L_qq[1] = L_qq[2] = xy + s * yy;
  L_qq[3] = yy;
  L_qv[0] = 2 * b.vy + s * 2 * v[0]; /* column by column, with row q and column v */
  L_qv[1] = 0;
  L_qv[2] = 2 * v[0];
  L_qv[3] = 0;
  L_vv[0] = 1 + s * s;
  L_vv[1] = L_vv[2] = s;
  L_vv[3] = 1;
  return 0;
}

static int bent_angular_momentum(double t, const double *q, const double *p, double *J, void *user)
{
  (void)t, (void)user;
  *J = q[0] * p[1] - (q[1] + q[0] * q[0]) * (p[0] - 2 * q[0] * p[1]);
  return 0;
}

/* The largest change of the angular momentum, invariant 1. */
static double momentum_error(dvi_integrator *integrator, double h, int steps)
{
  double value[8], first, largest = 0;
  ck_assert_int_eq(dvi_integrator_invariants(integrator, value), DVI_OK);
  first = value[1];
  for (int step = 0; step < steps; step += 100) {
    advance(integrator, h, 100);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, value), DVI_OK);
    largest = fmax(largest, fabs(value[1] - first));
  }
  return largest;
}

/* Takes 1e5 steps of a compensated sum. The bound is some tens of roundings of one. */
START_TEST(momenta_of_equivariant_one_step_methods_stay_at_roundoff)
{
  static const char *const method[] = {"shooting:onestep=heun,quadrature=trapezoid", "shooting",
                                       "shooting:onestep=implicit-midpoint"};
  problem *model = create_problem("kepler", "e=0.3");
  dvi_integrator *integrator = start_integrator(model, method[_i]);
  ck_assert_double_le(momentum_error(integrator, 0.05, repeats(_i < 2 ? 100000 : 10000)), 1e-13);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

static dvi_system *bent_system(void)
{
  const dvi_lagrangian L = {
      .value = bent_value, .gradient = bent_gradient, .hessian = bent_hessian};
  const dvi_invariant J = {.name = "angular momentum", .value = bent_angular_momentum};
  const dvi_system_terms terms = {
      .dimension = 2, .lagrangian = &L, .invariants = &J, .invariant_count = 1, .autonomous = 1};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  return system;
}

START_TEST(momenta_of_other_one_step_methods_do_not)
{
  const double e = 0.3, q[] = {1 - e, -(1 - e) * (1 - e)}, vy = sqrt((1 + e) / (1 - e)),
               v[] = {0, vy};
  dvi_system *system = bent_system();
  ck_assert_msg(dvi_system_check(system, 0, q, (double[]){0.3, vy}, 0, NULL) == DVI_OK, "%s",
                dvi_last_error());
  dvi_integrator *integrator = create_integrator(system, "shooting");
  double defect;
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  ck_assert_double_ge(momentum_error(integrator, 0.05, 5000), 1e-6);
  ck_assert_int_eq(
      dvi_symplecticity(integrator, 0, q, (double[]){2 * (1 - e) * vy, vy}, 0.05, &defect), DVI_OK);
  ck_assert_double_le(defect, 1e-10);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* Gives the end of twenty steps from the pericentre, all turned by an angle, in Cartesian
 * coordinates. */
static void end_of_turned(dvi_integrator *integrator, int is_bent, double angle, double *x)
{
  const double e = 0.3, r = 1 - e, speed = sqrt((1 + e) / (1 - e)), c = cos(angle), s = sin(angle);
  const double q[] = {r * c, r * s - is_bent * r * c * r * c},
               v[] = {-speed * s, speed * c + is_bent * 2 * r * c * speed * s};
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  advance(integrator, 0.05, 20);
  x[0] = dvi_integrator_q(integrator)[0];
  x[1] = dvi_integrator_q(integrator)[1] + is_bent * x[0] * x[0];
}

/* How far turning comes from commuting with the steps. */
static double turning_error(dvi_integrator *integrator, int is_bent)
{
  const double angle = 1, c = cos(angle), s = sin(angle);
  double x[2], turned[2];
  end_of_turned(integrator, is_bent, 0, x);
  end_of_turned(integrator, is_bent, angle, turned);
  return hypot(turned[0] - (c * x[0] - s * x[1]), turned[1] - (s * x[0] + c * x[1]));
}

/* 20 steps, each of which rounds numbers of size 1. */
START_TEST(steps_are_equivariant_where_the_one_step_method_is)
{
  problem *model = create_problem("kepler", "e=0.3");
  dvi_system *other = bent_system();
  dvi_integrator *straight_steps = create_integrator(model->system, "shooting"),
                 *bent_steps = create_integrator(other, "shooting");
  ck_assert_double_le(turning_error(straight_steps, 0), 1e-14);
  ck_assert_double_ge(turning_error(bent_steps, 1), 1e-7);
  dvi_integrator_destroy(&straight_steps);
  dvi_integrator_destroy(&bent_steps);
  dvi_system_destroy(&other);
  problem_destroy(&model);
}
END_TEST

/* ---- failures ---- */

static const struct {
  const char *method;
  const char *words;
} refused[] = {
    {"shooting:quadrature=gauss", "does not have both ends of the step among its nodes"},
    {"shooting:quadrature=midpoint", "does not have both ends of the step among its nodes"},
    {"shooting:quadrature=radau-left", "does not have both ends of the step among its nodes"},
    {"shooting:quadrature=simpson,nodes=5", "quadrature=simpson has 3 nodes, not nodes=5"},
    {"shooting:onestep=rk4,stages=5", "onestep=rk4 has 4 stages, not stages=5"},
    {"shooting:onestep=gauss,stages=9", "onestep=gauss has 2 or more stages, not stages=9"},
    {"shooting:onestep=rk5", "possible are euler"},
    {"shooting:onestep=file", "onestep=file needs the name of the file"},
    {"shooting:onestep=rk4,tableau=x", "onestep=rk4 is built in"},
    {"shooting:quadrature=gauss-hermite,nodes=3", "has its 2 nodes at the ends, not nodes=3"},
    {"shooting:quadrature=euler-maclaurin,terms=0", "terms=1 to 20 are possible"},
    {"shooting:onestep=taylor,solve=stages", "solve=stages is for one-step methods with a tableau"},
    {"shooting:terms=2", "quadrature=simpson has no terms"},
    {"shooting:composition=4",
     "raises the order of symmetric one-step methods alone, and onestep=rk4 is none"},
    {"shooting:tableau=", "tableau= is empty; give it a text, or leave it out"},
    {"shooting:tableau=no/such/file", "no/such/file cannot be read"},
};
enum { REFUSED = sizeof refused / sizeof *refused };

START_TEST(what_does_not_go_is_refused)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *none = NULL;
  ck_assert_int_eq(dvi_integrator_create(model->system, refused[_i].method, &none), DVI_BAD_OPTION);
  check_words(refused[_i].words);
  ck_assert_ptr_null(none);
  problem_destroy(&model);
}
END_TEST

/* All problems of the catalogue that have a mass and few coordinates have them. */
START_TEST(what_needs_taylor_coefficients_says_who_lacks_them)
{
  problem *model = create_problem("kepler", NULL);
  const dvi_potential plain = {.name = "plain",
                               .value = model->terms->potentials[0].value,
                               .gradient = model->terms->potentials[0].gradient,
                               .value_batch = model->terms->potentials[0].value_batch,
                               .gradient_batch = model->terms->potentials[0].gradient_batch,
                               .user = model->terms->potentials[0].user};
  const dvi_system_terms terms = {
      .dimension = 2, .mass = {.scalar = 1}, .potentials = &plain, .potential_count = 1};
  dvi_system *system;
  dvi_integrator *none = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(system, "shooting:quadrature=euler-maclaurin", &none),
                   DVI_UNSUPPORTED);
  check_words("shooting: quadrature=euler-maclaurin");
  check_words("'plain'");
  ck_assert_int_eq(dvi_integrator_create(system, "shooting:onestep=taylor", &none),
                   DVI_UNSUPPORTED);
  check_words("shooting: onestep=taylor");
  ck_assert_ptr_null(none);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

static int wall_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = q[0] < 1 ? -log(1 - q[0]) : 0;
  return q[0] < 1 ? 0 : 1;
}

static int wall_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  *V_q = 1 / (1 - q[0]);
  return q[0] < 1 ? 0 : 1;
}

/* Takes steps of a system with the callbacks that `given` selects: values alone, gradients too, or
 * all. q becomes the final state. */
static void step_rotors(const char *method, int given, double *q)
{
  behaviour calls = {0};
  dvi_lagrangian lagrangian = rotors(&calls, ONE_POINT);
  if (given < 2) lagrangian.hessian = NULL;
  if (given < 1) lagrangian.gradient = NULL;
  dvi_system *system = make_system(
      &(dvi_system_terms){.dimension = SITES, .lagrangian = &lagrangian});
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, generic_q, generic_v), DVI_OK);
  advance(integrator, 0.1, 40);
  memcpy(q, dvi_integrator_q(integrator), SITES * sizeof *q);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}

static const char *const noisy[] = {"shooting", "shooting:type=2", "shooting:type=3",
                                    "shooting:onestep=gauss", "shooting:solve=stages"};
enum { NOISY = sizeof noisy / sizeof *noisy };

/* The residual holds second derivatives, whose noise is its floor, and that of the steps. */
START_TEST(derivatives_that_are_left_out_are_differenced)
{
  double q[3][SITES];
  for (int given = 0; given < 3; given++) step_rotors(noisy[_i], given, q[given]);
  ck_assert_double_le(distance(SITES, q[1], q[2]), 1e-8);
  ck_assert_double_le(distance(SITES, q[0], q[2]), 1e-5);
}
END_TEST

START_TEST(a_one_step_method_that_fails_inside_a_step_leaves_the_state)
{
  const dvi_potential potential = {.name = "wall", .value = wall_value, .gradient = wall_gradient};
  const dvi_system_terms terms = {
      .dimension = 1, .mass = {.scalar = 1}, .potentials = &potential, .potential_count = 1};
  const double q = 0, p = 4;
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  dvi_integrator *integrator = create_integrator(system,
                                                 _i == 0 ? "shooting" : "shooting:onestep=gauss");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &q, &p), DVI_OK);
  ck_assert_int_gt(dvi_integrator_step(integrator, 2), 0);
  check_words(_i == 0 ? "stage 2 of the one-step method from node 1 on"
                      : "the stages of the one-step method from node 1 on");
  check_words("the state is unchanged, try a smaller step");
  ck_assert_double_eq(dvi_integrator_q(integrator)[0], q);
  ck_assert_double_eq(dvi_integrator_p(integrator)[0], p);
  advance(integrator, 0.01, 10);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(shooting)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, steps_are_symplectic_and_symmetric_pairs_symmetric, 0, PAIRS);
  tcase_add_loop_test(tests, momenta_of_equivariant_one_step_methods_stay_at_roundoff, 0, 3);
  tcase_add_test(tests, momenta_of_other_one_step_methods_do_not);
  tcase_add_test(tests, steps_are_equivariant_where_the_one_step_method_is);
  tcase_add_loop_test(tests, what_does_not_go_is_refused, 0, REFUSED);
  tcase_add_test(tests, what_needs_taylor_coefficients_says_who_lacks_them);
  tcase_add_loop_test(tests, derivatives_that_are_left_out_are_differenced, 0, NOISY);
  tcase_add_loop_test(tests, a_one_step_method_that_fails_inside_a_step_leaves_the_state, 0, 2);
}
