/* labels: unit */
/* Tests of all methods that split: structure, refusals, failures. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/systems.h"
#include "support/systems/bond.h"

/* The first ones take any fast potential, all take quadratic ones. */
static const char *const methods[] = {"imex",
                                      "respa:substeps=20",
                                      "respa:substeps=exact",
                                      "mollified",
                                      "mollified:filter=projection",
                                      "trig",
                                      "trig:filter=deuflhard",
                                      "trig:filter=exact"};
enum { METHODS = sizeof methods / sizeof *methods, ANY_POTENTIAL = 2 };

static void check_symplectic(const bond *pair, const char *method, double h)
{
  dvi_integrator *integrator = bond_integrator(pair, method);
  double defect;
  ck_assert_msg(dvi_symplecticity(integrator, 0, pair->q, pair->p, h, &defect) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_msg(defect <= 2e-10, "%s: defect %g", method, defect); /* the differences' own error */
  dvi_integrator_destroy(&integrator);
}

/* The bond's frequency is 61 without a bend. The longest steps are beyond h omega = pi, where the
 * last method's filters end. */
START_TEST(steps_are_symplectic)
{
  bond pair;
  make_bond(2500, 0, &pair);
  for (int k = 1; k < (_i < METHODS - 1 ? 4 : 3); k++)
    check_symplectic(&pair, methods[_i], 0.02 * k);
  destroy_bond(&pair);
  make_bond(2500, 0.5, &pair);
  if (_i < ANY_POTENTIAL) check_symplectic(&pair, methods[_i], 0.02);
  destroy_bond(&pair);
}
END_TEST

static void check_momenta(const bond *pair, const char *method)
{
  dvi_integrator *integrator = bond_integrator(pair, method);
  double before[3], after[3];
  ck_assert_int_eq(dvi_integrator_invariants(integrator, before), DVI_OK);
  advance(integrator, 0.02, 2000);
  ck_assert_int_eq(dvi_integrator_invariants(integrator, after), DVI_OK);
  for (int k = 1; k < 3; k++)
    ck_assert_msg(fabs(after[k] - before[k]) < 1e-11, "%s: %g", method, after[k] - before[k]);
  dvi_integrator_destroy(&integrator);
}

/* The error is a random walk of 2000 roundings of forces that are h omega times the momenta, 1e-14
 * times that. */
START_TEST(momenta_of_symmetries_are_kept)
{
  bond pair;
  make_bond(2500, 0, &pair);
  check_momenta(&pair, methods[_i]);
  destroy_bond(&pair);
  make_bond(2500, 0.5, &pair);
  if (_i < ANY_POTENTIAL) check_momenta(&pair, methods[_i]);
  destroy_bond(&pair);
}
END_TEST

START_TEST(a_step_back_undoes_a_step)
{
  bond pair;
  make_bond(2500, _i < ANY_POTENTIAL ? 0.5 : 0, &pair);
  dvi_integrator *integrator = bond_integrator(&pair, methods[_i]);
  advance(integrator, 0.02, 10);
  advance(integrator, -0.02, 10);
  ck_assert_double_le(distance(4, dvi_integrator_q(integrator), pair.q), 1e-13);
  ck_assert_double_le(distance(4, dvi_integrator_p(integrator), pair.p), 1e-11); /* of size 50 */
  dvi_integrator_destroy(&integrator);
  destroy_bond(&pair);
}
END_TEST

/* Steps of other lengths in between leave no trace: tables of a length are made again, to the last
 * bit. */
START_TEST(a_step_depends_on_its_state_and_its_length_alone)
{
  bond pair;
  make_bond(2500, 0, &pair);
  dvi_integrator *mixed = bond_integrator(&pair, methods[_i]),
                 *fresh = bond_integrator(&pair, methods[_i]);
  advance(mixed, 0.03, 1);
  advance(mixed, 0.02, 1);
  ck_assert_int_eq(dvi_integrator_start(mixed, 0, pair.q, pair.p), DVI_OK);
  advance(mixed, 0.02, 5);
  advance(fresh, 0.02, 5);
  ck_assert_mem_eq(dvi_integrator_q(mixed), dvi_integrator_q(fresh), sizeof pair.q);
  ck_assert_mem_eq(dvi_integrator_p(mixed), dvi_integrator_p(fresh), sizeof pair.p);
  dvi_integrator_destroy(&mixed);
  dvi_integrator_destroy(&fresh);
  destroy_bond(&pair);
}
END_TEST

/* ---- refusals ---- */

static const struct {
  const char *problem, *because;
} refused[] = {
    {"kepler", "the method needs a fast potential (one that is declared `fast`), which the system "
               "does not declare"},
    {"double-pendulum", "the system declares a general Lagrangian, which this method cannot use"},
    {"vortices", "the system declares a one-form, which this method cannot use"},
    {"magnetic-pair",
     "the system declares a Hamiltonian with constraints, which this method cannot use"},
    {"pendulum-3d", "factors of its configuration space, which this method cannot use"},
};
enum { REFUSED = sizeof refused / sizeof *refused };

START_TEST(systems_that_cannot_be_split_are_refused_by_name)
{
  const char *method = methods[_i / REFUSED];
  problem *model = create_problem(refused[_i % REFUSED].problem, NULL);
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(dvi_integrator_create(model->system, method, &integrator), DVI_UNSUPPORTED);
  ck_assert_ptr_null(integrator);
  check_words(refused[_i % REFUSED].because);
  check_words("methods for this system: ");
  problem_destroy(&model);
}
END_TEST

/* ---- failures ---- */

typedef struct trap {
  double after;
  int answer;
} trap;

static int flat(double t, const double *q, double *V, void *user)
{
  (void)t, (void)q, (void)user;
  *V = 0;
  return 0;
}

static int sprung_gradient(double t, const double *q, double *V_q, void *user)
{
  const trap *set = user;
  for (int i = 0; i < SITES; i++) V_q[i] = 1e-3 * q[i];
  return t > set->after ? set->answer : 0;
}

static int stiff(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0;
  for (int i = 0; i < SITES; i++) *V += 450 * q[i] * q[i];
  return 0;
}

static int stiff_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < SITES; i++) V_q[i] = 900 * q[i];
  return 0;
}

START_TEST(a_slow_force_that_fails_in_mid_run_leaves_the_state_alone)
{
  trap set = {HUGE_VAL, 7};
  const dvi_potential potentials[] = {
      {.name = "slow", .value = flat, .gradient = sprung_gradient, .user = &set},
      {.name = "stiff", .value = stiff, .gradient = stiff_gradient, .fast = 1, .quadratic = 1}};
  dvi_system *system = make_system(
      &(dvi_system_terms){.dimension = SITES,
                          .mass = {.values = tridiagonal_mass, .pattern = tridiagonal},
                          .potentials = potentials,
                          .potential_count = 2});
  dvi_integrator *tried = create_integrator(system, methods[_i]),
                 *spared = create_integrator(system, methods[_i]);
  ck_assert_int_eq(dvi_integrator_start(tried, 0, generic_q, generic_v), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(spared, 0, generic_q, generic_v), DVI_OK);
  advance(tried, 0.1, 3);
  advance(spared, 0.1, 3);
  set.after = 0.35;
  ck_assert_int_eq(dvi_integrator_step(tried, 0.08), DVI_CALLBACK_RETRY);
  check_words("step 4 from t = 0.3 with h = 0.08 failed; the state is unchanged, try a smaller "
              "step: slow: the gradient callback");
  set.after = HUGE_VAL;
  advance(tried, 0.1, 3);
  advance(spared, 0.1, 3);
  ck_assert_mem_eq(dvi_integrator_q(tried), dvi_integrator_q(spared), sizeof generic_q);
  ck_assert_mem_eq(dvi_integrator_p(tried), dvi_integrator_p(spared), sizeof generic_q);
  dvi_integrator_destroy(&tried);
  dvi_integrator_destroy(&spared);
  dvi_system_destroy(&system);
}
END_TEST

SUITE(impulse)
{
  tcase_add_loop_test(tests, steps_are_symplectic, 0, METHODS);
  tcase_add_loop_test(tests, momenta_of_symmetries_are_kept, 0, METHODS);
  tcase_add_loop_test(tests, a_step_back_undoes_a_step, 0, METHODS);
  tcase_add_loop_test(tests, a_step_depends_on_its_state_and_its_length_alone, 0, METHODS);
  tcase_add_loop_test(tests, systems_that_cannot_be_split_are_refused_by_name, 0,
                      METHODS * REFUSED);
  tcase_add_loop_test(tests, a_slow_force_that_fails_in_mid_run_leaves_the_state_alone, 0, METHODS);
}
