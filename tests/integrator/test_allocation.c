/* labels: unit */
/* Creating, running, saving and restoring survive the failure of each of their allocations, with a
 * status, without an object or a leak. The heap is counted here, and the sanitizer and valgrind
 * runs of this test look closer. */
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "support/accepted.h"
#include "support/files.h"
#include "support/heap.h"
#include "support/runs.h"
#include "support/suite.h"

enum { MOST = 1000 };

/* fpu with ell = 40 is solved by KLU, the double pendulum has a general Lagrangian, the others go
 * to LAPACK or need no solver. */
static const struct {
  const char *problem, *setting, *method;
} places[] = {
    {"kepler", NULL, "verlet"},
    {"kepler", NULL, "midpoint"},
    {"kepler", NULL, "trapezoidal"},
    {"kepler", NULL, "galerkin"},
    {"kepler", NULL, "galerkin:degree=5,basis=legendre,quadrature=clenshaw-curtis"},
    {"kepler", NULL, "composition"},
    {"kepler", NULL, "composition:order=8,base=galerkin,degree=2"},
    {"langevin-dimer", NULL, "langevin"},
    {"langevin-dimer", NULL, "langevin:scheme=ovio,degree=2"},
    {"magnetic-bottle", NULL, "boris"},
    {"magnetic-bottle", NULL, "galerkin:degree=3"},
    {"magnetic-bottle", NULL, "composition"},
    {"fpu", "ell=40", "verlet"},
    {"fpu", "ell=40", "imex"},
    {"fpu", "ell=40", "composition:order=6,base=imex"},
    {"fpu", "ell=40", "imex:solver=newton"},
    {"fpu", "ell=40", "respa"},
    {"fpu", "ell=40", "respa:substeps=exact"},
    {"fpu", "ell=40", "mollified"},
    {"fpu", "ell=40", "trig"},
    {"fpu", NULL, "multiscale"},
    {"kepler", NULL, "flow-galerkin"},
    {"fpu", "ell=40", "flow-galerkin:stages=3"},
    {"outer-solar-jacobi", NULL, "flow-galerkin"},
    {"kepler", NULL, "shooting:onestep=gauss"},
    {"pendulum", NULL, "shooting:onestep=taylor,quadrature=euler-maclaurin,tolerance=1e-9"},
    {"toda", "N=5", "shooting:solve=stages"},
    {"chain", NULL, "verlet:blocking=temporal"},
    {"chain", NULL, "composition:order=8,blocking=temporal,threads=2"},
    {"fpu", "ell=40", "midpoint:solver=kinsol"},
    {"fpu", "ell=40", "galerkin:degree=3"},
    {"fpu", "ell=40", "composition:order=6,base=trapezoidal"},
    {"double-pendulum", NULL, "midpoint"},
    {"double-pendulum", NULL, "galerkin:degree=4"},
    {"double-pendulum", NULL, "composition:order=4,base=trapezoidal"},
    {"kepler", NULL, "sem:degree=2"},
    {"fpu", "ell=40", "sem:solver=kinsol"},
    {"driven-pendulum", NULL, "sem:degree=2,quadrature=lobatto"},
    {"kepler", NULL, "prolongation-collocation"},
    {"double-pendulum", NULL, "prolongation-collocation:derivatives=3"},
    {"vortices", NULL, "vprk"},
    {"tokamak", NULL, "dg-phase"},
    {"magnetic-pair", NULL, "dg-phase:degree=3"},
    {"elastica", NULL, "hamiltonian:type=3,degree=3"},
    {"elastica", NULL, "shooting:type=3,onestep=gauss"},
    {"vortices", NULL, "dg:degree=1,flux=path,stiffness=1"},
    {"tokamak", NULL, "vprk:nodes=3,tableau=lobatto-iiie,projection=symplectic"},
    {"massless-particle", "gauge=singular", "dvi-a"},
    {"massless-particle", "gauge=singular", "dvi-b"},
    {"massless-particle", "gauge=singular", "dvi-midpoint"},
    {"massless-particle", "gauge=singular", "dvi-trapezoidal"},
    {"massless-particle", "gauge=singular", "dvrk:nodes=3"},
    {"double-pendulum", NULL, "hp:type=2"},
    {"vortices-linear", NULL, "hp:type=2"},
    {"kepler", NULL, "hp:type=4,degree=3"},
    {"heavy-top", NULL, "lie-galerkin:degree=3"},
    {"satellite", NULL, "lie-galerkin"},
    {"spherical-chain", "n=6", "sphere-galerkin:degree=1"},
    {"free-body", NULL, "euler-poincare:degree=2"},
    {"two-body", NULL, "lie-verlet:solve=cayley"},
    {"satellite", NULL, "lie-verlet"},
    {"spherical-double-pendulum", NULL, "lie-rk:scheme=implicit-midpoint"},
    {"sleigh", NULL, "nonholonomic"},
};
enum { PLACES = sizeof places / sizeof *places };

static void out_of_memory(dvi_status status)
{
  dvi__fail_allocations_after(-1);
  ck_assert_msg(status == DVI_NO_MEMORY, "%s: %s", dvi_status_name(status), dvi_last_error());
  check_words("no memory");
}

/* But moreau-jean, which needs contacts (test_contacts.c). */
START_TEST(every_method_has_its_place)
{
  for (int i = 0; i < dvi_method_count(); i++) {
    if (strcmp(dvi_method_name(i), "moreau-jean") == 0) continue;
    const size_t length = strlen(dvi_method_name(i));
    int found = 0;
    for (int k = 0; k < PLACES; k++)
      found += strcspn(places[k].method, ":") == length &&
               strncmp(places[k].method, dvi_method_name(i), length) == 0;
    ck_assert_msg(found > 0, "%s", dvi_method_name(i));
  }
}
END_TEST

START_TEST(an_integrator_survives_every_failure)
{
  problem *model = create_problem(places[_i].problem, places[_i].setting);
  /* the first one completes the system */
  dvi_integrator *integrator = create_integrator(model->system, places[_i].method);
  dvi_integrator_destroy(&integrator);
  const long before = dvi__allocation_count();
  integrator = create_integrator(model->system, places[_i].method);
  const long needed = dvi__allocation_count() - before;
  dvi_integrator_destroy(&integrator);
  ck_assert(needed > 5 && needed < MOST);
  const long bytes_before = heap_bytes();
  for (long successes = 0; successes < needed; successes++) {
    integrator = (dvi_integrator *)model;
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi_integrator_create(model->system, places[_i].method, &integrator);
    out_of_memory(status);
    ck_assert_ptr_null(integrator);
  }
  ck_assert_int_eq(heap_bytes(), bytes_before);
  problem_destroy(&model);
}
END_TEST

START_TEST(an_integrator_gives_back_all_that_it_took)
{
  problem *model = create_problem(places[_i].problem, places[_i].setting);
  dvi_integrator *integrator = start_integrator(model, places[_i].method);
  advance(integrator, model->h, 1); /* what libraries keep for themselves is taken once */
  dvi_integrator_destroy(&integrator);
  const long bytes_before = heap_bytes();
  integrator = start_integrator(model, places[_i].method);
  advance(integrator, model->h, 3);
  dvi_integrator_destroy(&integrator);
  ck_assert_int_eq(heap_bytes(), bytes_before);
  problem_destroy(&model);
}
END_TEST

/* ---- runs ---- */

static int first_coordinate(double t, const double *q, const double *v, double *g, void *user)
{
  (void)t, (void)v;
  *g = q[0] - *(const double *)user;
  return 0;
}

static dvi_status run(const problem *model, dvi_integrator *integrator, double t_end,
                      dvi_run_report *report)
{
  double level = model->q[0];
  const dvi_event events[] = {{.name = "there", .value = first_coordinate, .user = &level},
                              {.name = "here", .value = first_coordinate, .user = &level}};
  const dvi_run_options options = {.h = model->h,
                                   .t_end = t_end,
                                   .events = events,
                                   .event_count = 2,
                                   .checkpoint = path_in_folder("checkpoint"),
                                   .checkpoint_every = 2};
  return dvi_run(integrator, &options, report);
}

/* Events want a path between the steps, which lie-rk has not. */
static accepted_cases with_path;

static int place_has_path(int which)
{
  return strncmp(places[which].method, "lie-rk", 6) != 0;
}

/* A run allocates for its events and its checkpoints. A step allocates nothing once its solvers are
 * prepared (test_late.c). */
START_TEST(a_run_survives_every_failure)
{
  const int place = with_path.which[_i];
  problem *model = create_problem(places[place].problem, places[place].setting);
  dvi_integrator *integrator = start_integrator(model, places[place].method);
  const double t_end = 5 * model->h;
  dvi_run_report report;
  ck_assert_msg(run(model, integrator, t_end, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, model->p), DVI_OK);
  const long before = dvi__allocation_count();
  ck_assert_msg(run(model, integrator, t_end, &report) == DVI_OK, "%s", dvi_last_error());
  const long needed = dvi__allocation_count() - before;
  ck_assert(needed >= 7 && needed < MOST); /* four for events, three checkpoints */
  for (long successes = 0; successes < needed; successes++) {
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, model->q, model->p), DVI_OK);
    const long bytes_before = heap_bytes();
    dvi__fail_allocations_after(successes);
    const dvi_status status = run(model, integrator, t_end, &report);
    out_of_memory(status);
    ck_assert_int_eq(heap_bytes(), bytes_before);
    ck_assert_int_eq(report.end, DVI_RUN_FAILED);
    ck_assert_int_le(report.steps, 6); /* sem may take one more than those of a fixed h */
  }
  /* An interrupted run can be continued. */
  ck_assert_msg(run(model, integrator, 2 * t_end, &report) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(report.end, DVI_RUN_COMPLETE);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(saving_and_restoring_survive_the_failure)
{
  problem *model = create_problem(places[_i].problem, places[_i].setting);
  dvi_integrator *integrator = start_integrator(model, places[_i].method);
  advance(integrator, model->h, 2);
  dvi__fail_allocations_after(0);
  out_of_memory(dvi_integrator_save(integrator, path_in_folder("checkpoint")));
  ck_assert_int_eq(count_files_in_folder(), 0);
  ck_assert_int_eq(dvi_integrator_save(integrator, path_in_folder("checkpoint")), DVI_OK);
  advance(integrator, model->h, 1);
  const bytes before = read_state(integrator);
  dvi__fail_allocations_after(0);
  out_of_memory(dvi_integrator_restore(integrator, path_in_folder("checkpoint")));
  check_state(integrator, before);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(allocation)
{
  tcase_set_timeout(tests, 120); /* checkpoints are flushed to the disk, which may be busy */
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, every_method_has_its_place);
  tcase_add_loop_test(tests, an_integrator_survives_every_failure, 0, PLACES);
  tcase_add_loop_test(tests, an_integrator_gives_back_all_that_it_took, 0, PLACES);
  find_accepted_cases(PLACES, place_has_path, &with_path);
  tcase_add_loop_test(tests, a_run_survives_every_failure, 0, with_path.count);
  tcase_add_loop_test(tests, saving_and_restoring_survive_the_failure, 0, PLACES);
}
