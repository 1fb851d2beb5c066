/* labels: unit */
/* What contacts may be declared, where they are refused, and how the check compares them. */
#include <dvi/ensemble.h>
#include <dvi/path.h>
#include <dvi/reference.h>
#include <dvi/transform.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/walls.h"

static int height(double t, const double *q, double *phi, void *user)
{
  (void)user;
  *phi = q[0] * q[0] - 0.5 * t;
  return 0;
}

static int right_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)user;
  phi_q[0] = 2 * q[0];
  return 0;
}

static int wrong_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)user;
  phi_q[0] = q[0];
  return 0;
}

static int right_rate(double t, const double *q, double *phi_t, void *user)
{
  (void)t, (void)q, (void)user;
  *phi_t = -0.5;
  return 0;
}

static int slip(double t, const double *q, double *T, void *user)
{
  (void)t, (void)q, (void)user;
  T[0] = 1;
  return 0;
}

static dvi_system_terms terms_of(const dvi_contact *contact)
{
  return (dvi_system_terms){
      .dimension = 1, .mass = {.scalar = 1}, .contacts = contact, .contact_count = 1};
}

static void refused(dvi_contact contact, dvi_status status, const char *words)
{
  dvi_system *system;
  contact.name = "wall";
  const dvi_system_terms terms = terms_of(&contact);
  ck_assert_int_eq(dvi_system_create(&terms, &system), status);
  check_words(words);
}

START_TEST(contacts_that_are_not_well_declared_are_refused)
{
  const dvi_contact good = {.gap = height, .gradient = right_gradient, .rate = right_rate};
  dvi_contact bad = good;
  bad.gap = NULL;
  refused(bad, DVI_BAD_ARGUMENT, "contact 'wall' has no gap callback");
  bad = good, bad.gradient = NULL;
  refused(bad, DVI_BAD_ARGUMENT, "contact 'wall' has no gradient callback");
  bad = good, bad.restitution = -0.1;
  refused(bad, DVI_BAD_ARGUMENT, "restitution -0.1; 0 to 1 is possible");
  bad = good, bad.restitution = 1.5;
  refused(bad, DVI_BAD_ARGUMENT, "restitution 1.5");
  bad = good, bad.restitution = (double)NAN;
  refused(bad, DVI_BAD_ARGUMENT, "restitution nan");
  bad = good, bad.friction = -1;
  refused(bad, DVI_BAD_ARGUMENT, "friction -1");
  bad = good, bad.friction = 0.5;
  refused(bad, DVI_BAD_ARGUMENT, "no tangent callback");
  bad = good, bad.tangent = slip, bad.tangent_count = 3;
  refused(bad, DVI_BAD_SIZE, "3 tangents");
  bad = good, bad.tangent = slip;
  refused(bad, DVI_BAD_SIZE, "0 tangents");
  bad = good, bad.tangent_count = 1;
  refused(bad, DVI_BAD_SIZE, "1 tangents");
}
END_TEST

START_TEST(contacts_stand_beside_masses_and_lagrangians_alone)
{
  static const char *const others[] = {"vortices", "elastica", "pendulum-3d"};
  const dvi_contact contact = {.gap = height, .gradient = right_gradient};
  const dvi_holonomic rod = {
      .name = "rod", .count = 1, .value = height, .gradient = right_gradient};
  dvi_system *system;
  for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
    problem *model = create_problem(others[k], NULL);
    dvi_system_terms terms = *model->terms;
    terms.contacts = &contact;
    terms.contact_count = 1;
    ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_UNSUPPORTED);
    check_words("contacts go with");
    problem_destroy(&model);
  }
  dvi_system_terms terms = terms_of(&contact);
  terms.holonomics = &rod;
  terms.holonomic_count = 1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_UNSUPPORTED);
  check_words("contacts beside holonomic constraints");
  terms = terms_of(NULL);
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  check_words("1 contacts declared");
}
END_TEST

START_TEST(methods_that_cannot_meet_hits_refuse_them)
{
  static const char *const methods[] = {"sem",      "hp:type=1",   "imex",
                                        "respa",    "trig",        "mollified",
                                        "shooting", "hamiltonian", "multiscale"};
  dvi_system *system = create_walls(WALLS_PENDULUM, 1);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    dvi_integrator *integrator;
    ck_assert_int_ne(dvi_integrator_create(system, methods[m], &integrator), DVI_OK);
    check_words("contacts phi(t,q) >= 0");
  }
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(paths_ensembles_judges_and_other_times_refuse_them)
{
  const dvi_monitor monitor = {.kind = DVI_MONITOR_ARCLENGTH};
  const dvi_path_options ends = {.ends = DVI_ENDS_FIXED, .steps = 4, .span = 1};
  const dvi_ensemble_options pair = {.members = 2};
  double q = -0.5, p = 1;
  dvi_integrator *integrator;
  dvi_ensemble *ensemble;
  dvi_path *path;
  dvi_system *system = create_walls(WALLS_PENDULUM, 1);
  for (int pacing = DVI_TIME_TRANSFORM; pacing <= DVI_STEP_CONTROL; pacing++) {
    const dvi_integrator_options paced = {.size = sizeof paced,
                                          .method = "galerkin",
                                          .pacing = (dvi_pacing)pacing,
                                          .monitor = &monitor};
    ck_assert_int_eq(dvi_integrator_create_with(system, &paced, &integrator), DVI_UNSUPPORTED);
    check_words("contacts");
  }
  ck_assert_int_eq(dvi_path_create(system, "galerkin", &ends, &path), DVI_UNSUPPORTED);
  check_words("contacts");
  ck_assert_int_eq(dvi_ensemble_create(system, "verlet", &pair, &ensemble), DVI_UNSUPPORTED);
  check_words("contacts");
  for (int code = DVI_IDA; code <= DVI_ARKODE; code++) {
    const dvi_reference_options options = {.code = (dvi_reference_code)code};
    ck_assert_int_eq(dvi_reference_solve(system, 0, 1, &q, &p, &options, NULL), DVI_UNSUPPORTED);
    check_words("contacts");
  }
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(the_check_compares_gradients_and_rates)
{
  const double q = 0.7, v = 0.2;
  dvi_contact contact = {
      .name = "wall", .gap = height, .gradient = right_gradient, .rate = right_rate};
  dvi_system_terms terms = terms_of(&contact);
  dvi_derivative_check found;
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_system_contact_count(system), 1);
  ck_assert_str_eq(dvi_system_contact_name(system, 0), "wall");
  ck_assert_ptr_null(dvi_system_contact_name(system, 1));
  ck_assert_int_eq(dvi_system_check(system, 0.1, &q, &v, 0, &found), DVI_OK);
  dvi_system_destroy(&system);
  contact.rate = NULL;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_system_check(system, 0.1, &q, &v, 0, &found), DVI_BAD_ARGUMENT);
  check_words("contact 'wall': d phi_0/dt");
  dvi_system_destroy(&system);
  contact.rate = right_rate;
  contact.gradient = wrong_gradient;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  ck_assert_int_eq(dvi_system_check(system, 0.1, &q, &v, 0, &found), DVI_BAD_ARGUMENT);
  check_words("contact 'wall'");
  dvi_system_destroy(&system);
  terms.autonomous = 1;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_BAD_ARGUMENT);
  check_words("wall");
}
END_TEST

/* A checkpoint belongs to a system with the same laws. */
START_TEST(checkpoints_know_the_restitution)
{
  const double q = -0.5, v = 1;
  static char bytes[4096];
  size_t size;
  dvi_system *one = create_walls(WALLS_PENDULUM, 1), *other = create_walls(WALLS_PENDULUM, 0.5);
  dvi_integrator *saved = create_integrator(one, "verlet"),
                 *restored = create_integrator(other, "verlet");
  ck_assert_int_eq(dvi_integrator_start(saved, 0, &q, &v), DVI_OK);
  ck_assert_int_eq(dvi_integrator_save_memory(saved, bytes, sizeof bytes, &size), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore_memory(restored, bytes, size), DVI_BAD_FILE);
  check_words("contacts");
  dvi_integrator_destroy(&saved);
  dvi_integrator_destroy(&restored);
  dvi_system_destroy(&one);
  dvi_system_destroy(&other);
}
END_TEST

SUITE(contacts_declared)
{
  tcase_add_test(tests, contacts_that_are_not_well_declared_are_refused);
  tcase_add_test(tests, contacts_stand_beside_masses_and_lagrangians_alone);
  tcase_add_test(tests, methods_that_cannot_meet_hits_refuse_them);
  tcase_add_test(tests, paths_ensembles_judges_and_other_times_refuse_them);
  tcase_add_test(tests, the_check_compares_gradients_and_rates);
  tcase_add_test(tests, checkpoints_know_the_restitution);
}
