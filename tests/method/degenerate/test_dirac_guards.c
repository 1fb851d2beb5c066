/* labels: invariant */
/* Guards of a Hamiltonian with constraints, and of a one-form like it: the alarm, the bracket
 * matrix, statuses, checkpoints. */
#include <math.h>
#include <string.h>

#include "support/files.h"
#include "support/runs.h"
#include "support/suite.h"

typedef struct world {
  double radius;  /* of the circle */
  double shift;   /* of the one-form */
  int calls_left; /* calls until phi's gradient fails (negative, never) */
  int returned;   /* by a failing gradient, beside a NaN */
} world;

static const world whole = {.radius = 1, .shift = 0, .calls_left = -1, .returned = 0};

static dvi_system *create_constrained_system(int n, const dvi_hamiltonian *H,
                                             const dvi_constraint *phi)
{
  const dvi_system_terms terms = {
      .dimension = n, .autonomous = 1, .hamiltonian = H, .constraint = phi};
  dvi_system *system = NULL;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static dvi_integrator *start_integrator_at(const dvi_system *system, const char *method,
                                           const double *q, const double *p)
{
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_msg(dvi_integrator_start(integrator, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  return integrator;
}

/* ---- a particle on a table: H = |p|^2/2 + 9.8 z, phi = (z, p_z) ---- */

static int table_H(double t, const double *q, const double *p, double *H, void *user)
{
  (void)t, (void)user;
  *H = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) / 2 + 9.8 * q[2];
  return 0;
}

static int table_H_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                            void *user)
{
  (void)t, (void)q, (void)user;
  H_q[0] = H_q[1] = 0;
  H_q[2] = 9.8;
  memcpy(H_p, p, 3 * sizeof *p);
  return 0;
}

static int table_phi(const double *q, const double *p, double *phi, void *user)
{
  (void)user;
  phi[0] = q[2];
  phi[1] = p[2];
  return 0;
}

static int table_phi_gradient(const double *q, const double *p, double *phi_z, void *user)
{
  (void)q, (void)p, (void)user;
  memset(phi_z, 0, 12 * sizeof *phi_z);
  phi_z[2] = phi_z[6 + 5] = 1;
  return 0;
}

static dvi_system *create_table(void)
{
  return create_constrained_system(
      3, &(dvi_hamiltonian){.value = table_H, .gradient = table_H_gradient},
      &(dvi_constraint){.count = 2, .value = table_phi, .gradient = table_phi_gradient});
}

/* ---- a pendulum: H = |p|^2/2 + y, phi = ((|q|^2 - radius^2)/2, q.p) ---- */

static int circle_H(double t, const double *q, const double *p, double *H, void *user)
{
  (void)t, (void)user;
  *H = (p[0] * p[0] + p[1] * p[1]) / 2 + q[1];
  return 0;
}

static int circle_H_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                             void *user)
{
  (void)t, (void)q, (void)user;
  H_q[0] = 0;
  H_q[1] = 1;
  memcpy(H_p, p, 2 * sizeof *p);
  return 0;
}

static int circle_phi(const double *q, const double *p, double *phi, void *user)
{
  const world *setup = user;
  phi[0] = (q[0] * q[0] + q[1] * q[1] - setup->radius * setup->radius) / 2;
  phi[1] = q[0] * p[0] + q[1] * p[1];
  return 0;
}

static int circle_phi_gradient(const double *q, const double *p, double *phi_z, void *user)
{
  world *setup = user;
  const double values[8] = {q[0], q[1], 0, 0, p[0], p[1], q[0], q[1]};
  memcpy(phi_z, values, sizeof values);
  if (setup->calls_left > 0) setup->calls_left--;
  if (setup->calls_left != 0) return 0;
  phi_z[0] = (double)NAN;
  return setup->returned;
}

static dvi_system *create_circle(world *setup)
{
  return create_constrained_system(
      2, &(dvi_hamiltonian){.value = circle_H, .gradient = circle_H_gradient},
      &(dvi_constraint){
          .count = 2, .value = circle_phi, .gradient = circle_phi_gradient, .user = setup});
}

/* ---- the alarm ---- */

static const char *const methods[] = {"dg-phase", "dg-phase:degree=2", "dg-phase:degree=3",
                                      "dg-phase:degree=4", "dg-phase:degree=2,moments=0"};
enum { METHODS = sizeof methods / sizeof *methods };

static void check_quiet(const dvi_system *system, const char *method, const double *q,
                        const double *p)
{
  dvi_integrator *integrator = start_integrator_at(system, method, q, p);
  advance(integrator, 0.1, 1000);
  dvi_integrator_destroy(&integrator);
}

/* The constraint's force is large although nothing moves along it. At rest only roundings move. */
START_TEST(a_force_without_motion_rings_no_alarm)
{
  static const double origin[3] = {0, 0, 0}, along[3] = {1, 0, 0}, bottom[2] = {0, -1},
                      slow[2] = {1e-3, 0}, swing[2] = {0.1, 0};
  world setup = whole;
  dvi_system *table = create_table(), *circle = create_circle(&setup);
  check_quiet(table, methods[_i], origin, along);
  check_quiet(table, methods[_i], origin, origin);
  check_quiet(circle, methods[_i], bottom, origin);
  check_quiet(circle, methods[_i], bottom, slow);
  check_quiet(circle, methods[_i], bottom, swing);
  dvi_system_destroy(&table);
  dvi_system_destroy(&circle);
}
END_TEST

static const struct {
  const char *problem, *method, *remedy;
  double h;
} parasites[] = {
    {"magnetic-pair", "dg-phase", "an even degree with all its moments", 0.3},
    {"magnetic-pair", "dg-phase:degree=3", "an even degree with all its moments", 0.3},
    {"magnetic-pair", "dg-phase:degree=2,moments=0", "an even degree with all its moments", 0.3},
    {"magnetic-pair", "dg-phase:degree=2", "smaller steps keep it small for longer", 1.1},
    {"lotka-volterra", "dg-phase", "take another method, dg:degree=3,stiffness=c", 0.1}};

START_TEST(a_parasite_does_with_a_remedy_that_is_another_method)
{
  problem *model = create_problem(parasites[_i].problem, NULL);
  dvi_integrator *integrator = start_integrator(model, parasites[_i].method);
  dvi_status status = DVI_OK;
  for (int step = 0; step < 20000 && status == DVI_OK; step++)
    status = dvi_integrator_step(integrator, parasites[_i].h);
  ck_assert_int_eq(status, DVI_JUMP);
  check_words(parasites[_i].remedy);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* ---- the bracket matrix ---- */

/* The bracket of x and p_x (1 - z) is 0 at z = 1. */
static int fold_phi(const double *q, const double *p, double *phi, void *user)
{
  (void)user;
  phi[0] = q[0];
  phi[1] = p[0] * (1 - q[2]);
  return 0;
}

static int fold_phi_gradient(const double *q, const double *p, double *phi_z, void *user)
{
  (void)user;
  memset(phi_z, 0, 12 * sizeof *phi_z);
  phi_z[0] = 1;
  phi_z[6 + 2] = -p[0];
  phi_z[6 + 3] = 1 - q[2];
  return 0;
}

static int free_H(double t, const double *q, const double *p, double *H, void *user)
{
  (void)t, (void)q, (void)user;
  *H = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) / 2;
  return 0;
}

static int free_H_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                           void *user)
{
  (void)t, (void)q, (void)user;
  memset(H_q, 0, 3 * sizeof *H_q);
  memcpy(H_p, p, 3 * sizeof *p);
  return 0;
}

START_TEST(no_step_leads_over_a_singular_bracket_matrix)
{
  const double h = 0.0937;
  dvi_system *system = create_constrained_system(
      3, &(dvi_hamiltonian){.value = free_H, .gradient = free_H_gradient},
      &(dvi_constraint){.count = 2, .value = fold_phi, .gradient = fold_phi_gradient});
  dvi_integrator *here = start_integrator_at(system, methods[_i], (double[]){0, 0, 0},
                                             (double[]){0, 0.1, 2});
  advance(here, h, 5);
  ck_assert_int_eq(dvi_integrator_step(here, h), DVI_NOT_CONVERGED);
  check_words("the constraints' bracket matrix is singular");
  ck_assert_double_lt(dvi_integrator_q(here)[2], 1);
  advance(here, -h, 5);
  dvi_integrator *there = start_integrator_at(system, methods[_i], (double[]){0, 0, 1.5},
                                              (double[]){0, 0.1, 2});
  advance(there, h, 5);
  dvi_integrator_destroy(&here);
  dvi_integrator_destroy(&there);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- statuses ---- */

/* From any of its calls on in a step. */
START_TEST(a_gradient_that_fails_from_some_call_on_says_so)
{
  static const double q[2] = {0.6, -0.8}, p[2] = {0.4, 0.3};
  world setup = whole;
  dvi_system *system = create_circle(&setup);
  for (int calls = 1; calls <= 4; calls++)
    for (int returned = 0; returned <= 1; returned++) {
      dvi_integrator *integrator = start_integrator_at(system, methods[_i], q, p);
      advance(integrator, 0.1, 1);
      setup.calls_left = calls;
      setup.returned = returned;
      ck_assert_int_eq(dvi_integrator_step(integrator, 0.1),
                       returned ? DVI_CALLBACK_RETRY : DVI_NOT_FINITE);
      check_words("try a smaller step");
      setup.calls_left = -1;
      advance(integrator, 0.1, 1);
      dvi_integrator_destroy(&integrator);
    }
  dvi_system_destroy(&system);
}
END_TEST

/* ---- checkpoints ---- */

/* alpha = (shift - y/2, x/2), H = |q|^2/2. At rest at 0 neither the Lagrangian nor its forces
 * depend on the shift. */
static int form(const double *q, double *alpha, void *user)
{
  alpha[0] = ((const world *)user)->shift - q[1] / 2;
  alpha[1] = q[0] / 2;
  return 0;
}

static int form_gradient(const double *q, double *alpha_q, void *user)
{
  static const double values[4] = {0, -0.5, 0.5, 0};
  (void)q, (void)user;
  memcpy(alpha_q, values, sizeof values);
  return 0;
}

static int bowl(double t, const double *q, double *H, void *user)
{
  (void)t, (void)user;
  *H = (q[0] * q[0] + q[1] * q[1]) / 2;
  return 0;
}

static int bowl_gradient(double t, const double *q, double *H_q, void *user)
{
  (void)t, (void)user;
  memcpy(H_q, q, 2 * sizeof *q);
  return 0;
}

static dvi_system *create_form(world *setup)
{
  const dvi_one_form alpha = {.value = form, .gradient = form_gradient, .user = setup};
  const dvi_potential H = {.value = bowl, .gradient = bowl_gradient};
  const dvi_system_terms terms = {
      .dimension = 2, .one_form = &alpha, .potentials = &H, .potential_count = 1, .autonomous = 1};
  dvi_system *system = NULL;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

static void check_known_again(const dvi_system *system, const char *method, const double *q,
                              const double *p, double *parameter)
{
  dvi_integrator *first = start_integrator_at(system, method, q, p),
                 *second = create_integrator(system, method);
  advance(first, 0.1, 3);
  ck_assert_int_eq(dvi_integrator_save(first, path_in_folder("state")), DVI_OK);
  *parameter += 1e-3;
  ck_assert_int_eq(dvi_integrator_restore(second, path_in_folder("state")), DVI_BAD_FILE);
  check_words("another constraint");
  *parameter -= 1e-3;
  ck_assert_msg(dvi_integrator_restore(second, path_in_folder("state")) == DVI_OK, "%s",
                dvi_last_error());
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&second);
}

START_TEST(a_checkpoint_of_another_constraint_is_refused)
{
  static const double q[2] = {0.6, -0.8}, p[2] = {0.4, 0.3};
  world setup = whole;
  dvi_system *system = create_circle(&setup);
  check_known_again(system, methods[_i], q, p, &setup.radius);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_checkpoint_of_another_one_form_is_refused)
{
  static const char *const of_forms[] = {"vprk", "vprk:projection=none", "dg", "dg-phase",
                                         "hp:type=2,quadrature=gauss"};
  static const double origin[2] = {0, 0};
  world setup = whole;
  dvi_system *system = create_form(&setup);
  check_known_again(system, of_forms[_i], origin, origin, &setup.shift);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(dirac_guards)
{
  tcase_set_timeout(tests, 60);
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, a_force_without_motion_rings_no_alarm, 0, METHODS);
  tcase_add_loop_test(tests, a_parasite_does_with_a_remedy_that_is_another_method, 0,
                      sizeof parasites / sizeof *parasites);
  tcase_add_loop_test(tests, no_step_leads_over_a_singular_bracket_matrix, 0, METHODS);
  tcase_add_loop_test(tests, a_gradient_that_fails_from_some_call_on_says_so, 0, METHODS);
  tcase_add_loop_test(tests, a_checkpoint_of_another_constraint_is_refused, 0, METHODS);
  tcase_add_loop_test(tests, a_checkpoint_of_another_one_form_is_refused, 0, 5);
}
