/* labels: order invariant */
/* dg-phase with a Hamiltonian and constraints phi(q,p) = 0: orders, what is conserved, the
 * one-form's path, refusals. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

/* ---- order ---- */

enum { LEVELS = 4 };

/* `steps` is the number of the first level, and each level has sqrt 2 times as many. Few levels
 * keep the errors above 1e-12. */
static const struct {
  const char *problem, *method;
  int order, steps;
} claims[] = {{"circle-dirac", "dg-phase", 2, 40},
              {"circle-dirac", "dg-phase:degree=2", 4, 24},
              {"circle-dirac", "dg-phase:degree=3", 6, 18},
              {"circle-dirac", "dg-phase:degree=4", 8, 12},
              {"circle-dirac", "dg-phase:degree=3,moments=0", 2, 40},
              {"circle-dirac", "dg-phase:degree=4,moments=2", 6, 14},
              {"magnetic-pair", "dg-phase", 2, 40},
              {"magnetic-pair", "dg-phase:degree=2", 4, 20},
              {"magnetic-pair", "dg-phase:degree=3", 6, 8},
              {"magnetic-pair", "dg-phase:degree=2,moments=0", 2, 40},
              {"magnetic-pair", "dg-phase:degree=5,moments=2", 6, 10}};
enum { CLAIMS = sizeof claims / sizeof *claims };

static double error_of(const problem *model, const char *method, int order, int steps)
{
  dvi_integrator *integrator = start_integrator(model, method);
  ck_assert_int_eq(dvi_integrator_order(integrator), order);
  advance(integrator, model->order_t_end / steps, steps);
  const double error = fmax(distance(model->nq, dvi_integrator_q(integrator), model->digits_q),
                            distance(model->nq, dvi_integrator_p(integrator), model->digits_p));
  dvi_integrator_destroy(&integrator);
  return error;
}

START_TEST(claimed_order_is_measured)
{
  problem *model = create_problem(claims[_i].problem, NULL);
  int steps = claims[_i].steps;
  double last = error_of(model, claims[_i].method, claims[_i].order, steps);
  for (int level = 1; level < LEVELS; level++) {
    const int more = (int)lround(steps * 1.4142135623730951);
    const double error = error_of(model, claims[_i].method, claims[_i].order, more);
    const double slope = log(last / error) / log((double)more / steps);
    ck_assert_msg(fabs(slope - claims[_i].order) <= 0.2, "%s %s: slope %.2f at %d steps (error %g)",
                  model->name, claims[_i].method, slope, more, error);
    last = error;
    steps = more;
  }
  problem_destroy(&model);
}
END_TEST

/* The angle from the top is the pendulum's. galerkin of degree 8 at this step is right up to
 * roundings. */
START_TEST(the_particle_on_a_circle_is_the_pendulum)
{
  problem *circle = create_problem("circle-dirac", NULL),
          *pendulum = create_problem("pendulum", NULL);
  dvi_integrator *particle = start_integrator(circle, "dg-phase:degree=6"),
                 *angle = create_integrator(pendulum->system, "galerkin:degree=8");
  ck_assert_int_eq(dvi_integrator_start(angle, 0, (double[]){atan2(0.8, 0.6)}, (double[]){0.5}),
                   DVI_OK);
  advance(particle, 0.05, 60);
  advance(angle, 0.05, 60);
  const double theta = dvi_integrator_q(angle)[0], omega = dvi_integrator_p(angle)[0];
  const double q[2] = {sin(theta), cos(theta)}, p[2] = {omega * cos(theta), -omega * sin(theta)};
  ck_assert_double_le(distance(2, dvi_integrator_q(particle), q), 1e-13);
  ck_assert_double_le(distance(2, dvi_integrator_p(particle), p), 1e-13);
  dvi_integrator_destroy(&particle);
  dvi_integrator_destroy(&angle);
  problem_destroy(&circle);
  problem_destroy(&pendulum);
}
END_TEST

/* ---- the one-form's path ---- */

/* A one-form's problem as a Hamiltonian with phi = p - alpha(q). */
static int form_H(double t, const double *q, const double *p, double *H, void *user)
{
  const dvi_potential *V = ((const problem *)user)->terms->potentials;
  (void)p;
  return V->value(t, q, H, V->user);
}

static int form_H_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                           void *user)
{
  const dvi_potential *V = ((const problem *)user)->terms->potentials;
  (void)p;
  H_p[0] = H_p[1] = 0;
  return V->gradient(t, q, H_q, V->user);
}

static int form_phi(const double *q, const double *p, double *phi, void *user)
{
  const dvi_one_form *form = ((const problem *)user)->terms->one_form;
  const int returned = form->value(q, phi, form->user);
  for (int i = 0; i < 2; i++) phi[i] = p[i] - phi[i];
  return returned;
}

static int form_phi_gradient(const double *q, const double *p, double *phi_z, void *user)
{
  const dvi_one_form *form = ((const problem *)user)->terms->one_form;
  double alpha_q[4];
  (void)p;
  const int returned = form->gradient(q, alpha_q, form->user);
  for (int a = 0; a < 2; a++)
    for (int i = 0; i < 2; i++) {
      phi_z[4 * a + i] = -alpha_q[2 * a + i];
      phi_z[4 * a + 2 + i] = i == a;
    }
  return returned;
}

/* The printed steps of the one-form (tests/method/hamiltonian/test_dg_phase.c), with [q] = h
 * lambda:
 *     q' = q + ([q] + [q'])/2,   alpha' = alpha - h H_q(q + [q]/2) + ((Dalpha)^T [q] + (Dalpha')^T
 * [q'])/2. */
static void check_printed_step(const problem *model, double h, const double *q, const double *jump,
                               const dvi_integrator *integrator)
{
  const dvi_one_form *form = model->terms->one_form;
  const dvi_potential *V = model->terms->potentials;
  const double *next_q = dvi_integrator_q(integrator);
  double next_jump[2], alpha[2], next_alpha[2], alpha_q[4], next_alpha_q[4], H_q[2];
  (void)dvi_integrator_jump(integrator, next_jump);
  const double middle[2] = {q[0] + jump[0] / 2, q[1] + jump[1] / 2};
  ck_assert_int_eq(form->value(q, alpha, form->user) | form->value(next_q, next_alpha, form->user),
                   0);
  ck_assert_int_eq(
      form->gradient(q, alpha_q, form->user) | form->gradient(next_q, next_alpha_q, form->user), 0);
  ck_assert_int_eq(V->gradient(0, middle, H_q, V->user), 0);
  for (int i = 0; i < 2; i++) {
    double sum = alpha[i] - h * H_q[i];
    for (int j = 0; j < 2; j++)
      sum += (alpha_q[2 * j + i] * jump[j] + next_alpha_q[2 * j + i] * next_jump[j]) / 2;
    ck_assert_double_eq_tol(next_q[i], q[i] + (jump[i] + next_jump[i]) / 2, 1e-14);
    ck_assert_double_eq_tol(next_alpha[i], sum, 1e-13);
    ck_assert_double_eq_tol(dvi_integrator_p(integrator)[i], next_alpha[i], 1e-14);
    ck_assert_double_eq_tol(next_jump[i], h * dvi_integrator_multiplier(integrator)[i], 1e-15);
  }
}

/* Without Hessians the method differences them. The trajectory is that of the one-form, too, up to
 * the parasitic mode of size h^3 from the starts. */
START_TEST(without_moments_every_degree_takes_the_steps_of_the_one_form)
{
  problem *model = create_problem("massless-particle", NULL);
  const dvi_hamiltonian H = {.value = form_H, .gradient = form_H_gradient, .user = model};
  const dvi_constraint phi = {
      .count = 2, .value = form_phi, .gradient = form_phi_gradient, .user = model};
  const dvi_system_terms terms = {
      .dimension = 2, .autonomous = 1, .hamiltonian = &H, .constraint = &phi};
  dvi_system *system = NULL;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  dvi_integrator *form = start_integrator(model, "dg-phase"),
                 *general = create_integrator(system,
                                              method_spec("dg-phase:degree=%d,moments=0", _i));
  ck_assert_int_eq(dvi_integrator_start(general, 0, model->q, model->p), DVI_OK);
  const double h = 0.1;
  advance(form, h, 1);
  advance(general, h, 1);
  for (int step = 0; step < 100; step++) {
    double q[2], jump[2];
    memcpy(q, dvi_integrator_q(general), sizeof q);
    (void)dvi_integrator_jump(general, jump);
    advance(form, h, 1);
    advance(general, h, 1);
    check_printed_step(model, h, q, jump, general);
    ck_assert_double_le(distance(2, dvi_integrator_q(form), dvi_integrator_q(general)), 1e-3);
  }
  dvi_integrator_destroy(&form);
  dvi_integrator_destroy(&general);
  dvi_system_destroy(&system);
  problem_destroy(&model);
}
END_TEST

/* ---- structure ---- */

enum { POINTS = 128 };

/* The loop integrals of p dq and of [p] d[q]/4 over states of circle-dirac, with [q] = h lambda_2
 * q, [p] = -h (lambda_1 q + lambda_2 p). */
static double conserved_loop(dvi_integrator *const *point, double h, double *alone)
{
  double q[2 * POINTS], p[2 * POINTS], q_jump[2 * POINTS], p_jump[2 * POINTS], jumps;
  for (int k = 0; k < POINTS; k++)
    for (int i = 0; i < 2; i++) {
      const double *lambda = dvi_integrator_multiplier(point[k]);
      q[i * POINTS + k] = dvi_integrator_q(point[k])[i];
      p[i * POINTS + k] = dvi_integrator_p(point[k])[i];
      q_jump[i * POINTS + k] = h * lambda[1] * q[i * POINTS + k];
      p_jump[i * POINTS + k] = -h * (lambda[0] * q[i * POINTS + k] + lambda[1] * p[i * POINTS + k]);
    }
  ck_assert_int_eq(dvi_loop_integral(2, POINTS, q, p, alone), DVI_OK);
  ck_assert_int_eq(dvi_loop_integral(2, POINTS, q_jump, p_jump, &jumps), DVI_OK);
  return *alone + jumps / 4;
}

/* A loop of angles and speeds. p dq alone is not conserved where the multiplier is large, without
 * moments. */
START_TEST(the_two_form_of_both_sides_is_conserved)
{
  static const char *const methods[] = {"dg-phase", "dg-phase:degree=2", "dg-phase:degree=3",
                                        "dg-phase:degree=3,moments=0"};
  const double h = 0.1;
  problem *model = create_problem("circle-dirac", NULL);
  dvi_integrator *point[POINTS];
  double alone[2];
  for (int k = 0; k < POINTS; k++) {
    const double turn = 2 * 3.14159265358979323846 * k / POINTS, angle = 1 + 0.1 * cos(turn),
                 speed = 0.5 + 0.1 * sin(turn);
    const double q[2] = {sin(angle), cos(angle)}, p[2] = {speed * q[1], -speed * q[0]};
    point[k] = create_integrator(model->system, methods[_i]);
    ck_assert_msg(dvi_integrator_start(point[k], 0, q, p) == DVI_OK, "%s", dvi_last_error());
    advance(point[k], h, 1);
  }
  const double before = conserved_loop(point, h, &alone[0]);
  for (int k = 0; k < POINTS; k++) advance(point[k], h, 50);
  const double after = conserved_loop(point, h, &alone[1]);
  ck_assert_double_gt(fabs(before), 0.01);
  ck_assert_double_eq_tol(after, before, 1e-12);
  if (_i == 0) ck_assert_double_gt(fabs(alone[1] - alone[0]), 1e-8);
  for (int k = 0; k < POINTS; k++) dvi_integrator_destroy(&point[k]);
  problem_destroy(&model);
}
END_TEST

static const char *const structured[] = {"dg-phase", "dg-phase:degree=2", "dg-phase:degree=3",
                                         "dg-phase:degree=4"};

/* Up to roundings, which the way back doubles. */
START_TEST(steps_back_undo_steps)
{
  problem *model = create_problem(_i % 2 ? "magnetic-pair" : "circle-dirac", NULL);
  dvi_integrator *integrator = start_integrator(model, structured[_i / 2]);
  advance(integrator, 0.1, 50);
  advance(integrator, -0.1, 50);
  ck_assert_double_le(distance(model->nq, dvi_integrator_q(integrator), model->q), 1e-11);
  ck_assert_double_le(distance(model->nq, dvi_integrator_p(integrator), model->p), 1e-11);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Bounds of twice what was measured. */
START_TEST(energy_stays_and_the_constraint_holds)
{
  static const double bound[] = {2e-2, 4e-5, 2e-8, 2e-11};
  problem *model = create_problem("circle-dirac", NULL);
  dvi_integrator *integrator = start_integrator(model, structured[_i]);
  double first, now, off;
  ck_assert_int_eq(dvi_integrator_invariants(integrator, &first), DVI_OK);
  for (int step = 0; step < 2000; step++) {
    advance(integrator, 0.1, 1);
    ck_assert_int_eq(dvi_integrator_invariants(integrator, &now), DVI_OK);
    ck_assert_int_eq(dvi_integrator_constraint(integrator, &off), DVI_OK);
    ck_assert_msg(fabs(now - first) <= bound[_i], "%s: energy off by %g", structured[_i],
                  now - first);
    ck_assert_double_le(off, 1e-14);
  }
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Without moments the node's multiplier is that of the motion up to h^2. With moments it is small,
 * because it holds only their remainder. */
START_TEST(the_multiplier_is_that_of_the_motion_or_what_is_left_of_it)
{
  problem *model = create_problem("circle-dirac", NULL);
  dvi_integrator *whole = start_integrator(model, "dg-phase"),
                 *rest = start_integrator(model, "dg-phase:degree=2");
  ck_assert_ptr_null(dvi_integrator_multiplier(whole));
  advance(whole, 0.01, 100);
  advance(rest, 0.01, 100);
  const double *q = dvi_integrator_q(whole), *p = dvi_integrator_p(whole);
  ck_assert_double_eq_tol(dvi_integrator_multiplier(whole)[0], p[0] * p[0] + p[1] * p[1] - q[1],
                          1e-3);
  ck_assert_double_le(fabs(dvi_integrator_multiplier(rest)[0]), 1e-3);
  dvi_integrator_destroy(&whole);
  dvi_integrator_destroy(&rest);
  problem_destroy(&model);
}
END_TEST

/* ---- the parasite ---- */

START_TEST(the_parasite_rings_the_alarm)
{
  problem *model = create_problem("magnetic-pair", NULL);
  dvi_integrator *stops = start_integrator(model, "dg-phase"),
                 *warns = start_integrator(model, "dg-phase:alarm=warn");
  dvi_status status = DVI_OK;
  int steps = 0;
  dvi_counters counters;
  for (; steps < 20000 && status == DVI_OK; steps++) status = dvi_integrator_step(stops, 0.3);
  ck_assert_int_eq(status, DVI_JUMP);
  check_words("the parasite has grown");
  advance(warns, 0.3, steps);
  dvi_integrator_counters(warns, &counters);
  ck_assert_int_eq(counters.jump_alarms, 1);
  dvi_integrator_destroy(&stops);
  dvi_integrator_destroy(&warns);
  problem_destroy(&model);
}
END_TEST

/* ---- refusals ---- */

static void check_refused(const char *problem_name, const char *method, dvi_status status,
                          const char *words)
{
  problem *model = create_problem(problem_name, NULL);
  dvi_integrator *none = NULL;
  ck_assert_int_eq(dvi_integrator_create(model->system, method, &none), status);
  ck_assert_ptr_null(none);
  check_words(words);
  problem_destroy(&model);
}

START_TEST(what_cannot_be_is_refused_by_name)
{
  check_refused("circle-dirac", "galerkin", DVI_UNSUPPORTED,
                "declares a Hamiltonian with constraints, which this method cannot use");
  check_refused("circle-dirac", "vprk", DVI_UNSUPPORTED, "methods for this system: dg-phase");
  check_refused("circle-dirac", "dg-phase:degree=2,nodes=3", DVI_BAD_OPTION, "take nodes=2");
  check_refused("circle-dirac", "dg-phase:degree=2,nodes=1", DVI_BAD_OPTION, "take 2 or more");
  check_refused("circle-dirac", "dg-phase:degree=3,moments=3", DVI_BAD_OPTION,
                "an even number up to the degree");
  check_refused("circle-dirac", "dg-phase:degree=3,moments=4", DVI_BAD_OPTION,
                "an even number up to the degree");
  check_refused("vortices", "dg-phase:degree=2,moments=2", DVI_BAD_OPTION,
                "vprk:projection=symplectic");
}
END_TEST

START_TEST(starts_off_the_constraint_are_refused)
{
  problem *model = create_problem("circle-dirac", NULL);
  dvi_integrator *integrator = create_integrator(model->system, "dg-phase");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, (double[]){0.8, 0.61}, model->p),
                   DVI_BAD_ARGUMENT);
  check_words("constraint 0 is");
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, (double[]){0.3, 0.4}),
                   DVI_BAD_ARGUMENT);
  check_words("constraint 1 is");
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, model->q, model->v),
                   DVI_UNSUPPORTED);
  check_words("start with q and p");
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* The Hamiltonian vector fields of (|q|^2 - 1)/2 and q.p at (q,p) are (0, -q) and (q, -p). The
 * first one has to change p along q, the second one scales q. */
START_TEST(a_start_off_the_constraint_is_projected_on_request)
{
  problem *model = create_problem("circle-dirac", NULL);
  dvi_integrator *integrator = create_integrator(model->system, "dg-phase");
  const dvi_start_options projected = {.project = 1};
  double distance;
  ck_assert_int_eq(dvi_integrator_start_with(integrator, 0, (double[]){0.9, 0.5},
                                             (double[]){0.3, 0.4}, &projected),
                   DVI_OK);
  ck_assert_int_eq(dvi_integrator_constraint(integrator, &distance), DVI_OK);
  ck_assert_double_lt(distance, 1e-15);
  ck_assert_double_eq_tol(dvi_integrator_q(integrator)[0] * 0.5,
                          dvi_integrator_q(integrator)[1] * 0.9, 1e-15);
  ck_assert_int_eq(dvi_integrator_step(integrator, 0.1), DVI_OK);
  ck_assert_int_eq(
      dvi_integrator_start_with(integrator, 0, (double[]){0, 0}, (double[]){0.3, 0.4}, &projected),
      DVI_SINGULAR);
  check_words("singular");
  ck_assert_double_gt(dvi_integrator_time(integrator), 0.05);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(dirac)
{
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, claimed_order_is_measured, 0, CLAIMS);
  tcase_add_test(tests, the_particle_on_a_circle_is_the_pendulum);
  tcase_add_loop_test(tests, without_moments_every_degree_takes_the_steps_of_the_one_form, 1, 4);
  tcase_add_loop_test(tests, the_two_form_of_both_sides_is_conserved, 0, 4);
  tcase_add_loop_test(tests, steps_back_undo_steps, 0, 8);
  tcase_add_loop_test(tests, energy_stays_and_the_constraint_holds, 0, 4);
  tcase_add_test(tests, the_multiplier_is_that_of_the_motion_or_what_is_left_of_it);
  tcase_add_test(tests, the_parasite_rings_the_alarm);
  tcase_add_test(tests, what_cannot_be_is_refused_by_name);
  tcase_add_test(tests, starts_off_the_constraint_are_refused);
  tcase_add_test(tests, a_start_off_the_constraint_is_projected_on_request);
}
