/* labels: unit */
/* User bases: their use of memory, and what checkpoints, copies and ensembles know of them. */
#include <dvi/dvi.h>
#include <string.h>

#include "core/memory.h"
#include "support/files.h"
#include "support/heap.h"
#include "support/runs.h"
#include "support/spaces.h"
#include "support/suite.h"

/* ---- memory ---- */

START_TEST(a_step_takes_no_memory)
{
  static const double omega = 5;
  static const char *const methods[] = {"shaped-galerkin:nodes=6",
                                        "composition:order=4,base=shaped-galerkin,nodes=6"};
  problem *model = create_problem("henon-heiles", NULL);
  const dvi_shapes shapes = oscillation(&omega);
  dvi_integrator *integrator = start_integrator_with_shapes(model, &shapes, methods[_i]);
  double q[2], v[2];
  advance(integrator, 0.1, 1);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 0.1, q, v), DVI_OK); /* makes room */
  const long before = heap_calls();
  dvi__fail_allocations_after(0);
  advance(integrator, 0.1, 5);
  advance(integrator, 0.3, 5);
  ck_assert_int_eq(dvi_integrator_interpolate(integrator, 1.9, q, v), DVI_OK);
  dvi__fail_allocations_after(-1);
  ck_assert_int_eq(heap_calls(), before);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(creation_survives_every_failure_of_memory)
{
  enum { MOST = 1000 };
  static const int first = 0;
  problem *model = create_problem("kepler", NULL);
  dvi_shapes shapes = spline;
  shapes.coordinates = &first, shapes.coordinate_count = 1;
  dvi_integrator *integrator = create_integrator_with_shapes(model->system, &shapes,
                                                             "shaped-galerkin");
  dvi_integrator_destroy(&integrator);
  const long bytes_before = heap_bytes();
  long successes = 0;
  for (dvi_status status = DVI_NO_MEMORY; status != DVI_OK && successes < MOST; successes++) {
    dvi__fail_allocations_after(successes);
    status = create_with_shapes(model->system, &shapes, "shaped-galerkin", &integrator);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
    ck_assert_int_eq(status == DVI_OK, integrator != NULL);
  }
  dvi_integrator_destroy(&integrator);
  ck_assert(successes > 20 && successes < MOST);
  ck_assert_int_eq(heap_bytes(), bytes_before);
  problem_destroy(&model);
}
END_TEST

/* ---- checkpoints, copies, ensembles ---- */

static const double five = 5, six = 6;

static void check_restores(const dvi_shapes *shapes, const char *method, const dvi_shapes *others,
                           const char *other_method, const char *words)
{
  problem *model = create_problem("henon-heiles", NULL);
  dvi_integrator *saved = start_integrator_with_shapes(model, shapes, method),
                 *restored = start_integrator_with_shapes(model, others, other_method);
  advance(saved, 0.1, 7);
  advance(restored, 0.3, 2);
  ck_assert_int_eq(dvi_integrator_save(saved, path_in_folder("checkpoint")), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore(restored, path_in_folder("checkpoint")),
                   words != NULL ? DVI_BAD_FILE : DVI_OK);
  if (words != NULL) {
    check_words(words);
    advance(restored, 0.3, 1);
    double q[2];
    ck_assert_int_eq(dvi_integrator_interpolate(restored, 0.7, q, NULL), DVI_OK);
  } else {
    advance(saved, 0.1, 3);
    advance(restored, 0.1, 3);
    check_same_state(saved, restored);
  }
  dvi_integrator_destroy(&saved);
  dvi_integrator_destroy(&restored);
  problem_destroy(&model);
}

START_TEST(checkpoints_know_the_space)
{
  static const int first = 0, second = 1;
  const dvi_shapes shapes = oscillation(&five), other = oscillation(&six);
  dvi_shapes renamed = shapes, one = shapes, two = shapes;
  renamed.name = "wave";
  one.coordinates = &first, two.coordinates = &second,
  one.coordinate_count = two.coordinate_count = 1;
  const char *method = "shaped-galerkin:nodes=6",
             *composed = "composition:order=4,base=shaped-galerkin,nodes=6";
  check_restores(&shapes, method, &shapes, method, NULL);
  check_restores(&shapes, composed, &shapes, composed, NULL);
  check_restores(
      &shapes, method, &renamed, method,
      "written by shaped-galerkin:degree=1,quadrature=gauss,nodes=6,space=oscillation, not by");
  check_restores(&shapes, method, &other, method, "of another function space of the same name");
  check_restores(&shapes, composed, &other, composed, "of another function space of the same name");
  check_restores(&one, method, &two, method,
                 "written with other coordinates that have the functions of its space");
}
END_TEST

START_TEST(what_the_program_gave_is_copied)
{
  int first = 0;
  char name[] = "oscillation";
  dvi_shapes shapes = oscillation(&five);
  shapes.name = name, shapes.coordinates = &first, shapes.coordinate_count = 1;
  problem *model = create_problem("henon-heiles", NULL);
  dvi_integrator *integrator = start_integrator_with_shapes(model, &shapes,
                                                            "shaped-galerkin:nodes=6"),
                 *like = NULL;
  memset(name, 'x', sizeof name - 1), first = 1;
  memset(&shapes, 0, sizeof shapes);
  ck_assert_str_eq(dvi_integrator_method(integrator),
                   "shaped-galerkin:degree=1,quadrature=gauss,nodes=6,space=oscillation");
  ck_assert_msg(dvi_integrator_create_like(integrator, &like) == DVI_OK, "%s", dvi_last_error());
  ck_assert_str_eq(dvi_integrator_method(like), dvi_integrator_method(integrator));
  ck_assert_int_eq(dvi_integrator_start(like, 0, model->q, model->p), DVI_OK);
  advance(integrator, 0.1, 5);
  advance(like, 0.1, 5);
  check_same_state(integrator, like);
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&like);
  problem_destroy(&model);
}
END_TEST

START_TEST(members_of_an_ensemble_have_the_digits_of_single_runs)
{
  enum { MEMBERS = 5 };
  problem *model = create_problem("henon-heiles", NULL);
  const dvi_shapes shapes = oscillation(&five);
  const dvi_ensemble_options options = {.members = MEMBERS, .threads = 2, .shapes = &shapes};
  double q[2 * MEMBERS], p[2 * MEMBERS];
  dvi_ensemble *ensemble;
  for (int k = 0; k < MEMBERS; k++)
    for (int i = 0; i < 2; i++) {
      q[i * MEMBERS + k] = model->q[i] * (1 + 0.1 * k);
      p[i * MEMBERS + k] = model->p[i];
    }
  ck_assert_msg(
      dvi_ensemble_create(model->system, "shaped-galerkin:nodes=6", &options, &ensemble) == DVI_OK,
      "%s", dvi_last_error());
  ck_assert_int_eq(dvi_ensemble_start(ensemble, 0, q, p), DVI_OK);
  ck_assert_int_eq(dvi_ensemble_advance(ensemble, 0.1, 10), DVI_OK);
  dvi_integrator *single = create_integrator_with_shapes(model->system, &shapes,
                                                         "shaped-galerkin:nodes=6");
  for (int k = 0; k < MEMBERS; k++) {
    const double q_k[] = {model->q[0] * (1 + 0.1 * k), model->q[1] * (1 + 0.1 * k)};
    ck_assert_int_eq(dvi_integrator_start(single, 0, q_k, model->p), DVI_OK);
    advance(single, 0.1, 10);
    ck_assert_int_eq(dvi_ensemble_state(ensemble, NULL, q, p), DVI_OK);
    for (int i = 0; i < 2; i++)
      ck_assert_mem_eq(&q[i * MEMBERS + k], dvi_integrator_q(single) + i, sizeof(double));
  }
  dvi_integrator_destroy(&single);
  dvi_ensemble_destroy(&ensemble);
  dvi_shapes nameless = shapes;
  nameless.name = NULL;
  ck_assert_int_eq(dvi_ensemble_create(model->system, "shaped-galerkin",
                                       &(dvi_ensemble_options){.members = 2, .shapes = &nameless},
                                       &ensemble),
                   DVI_BAD_ARGUMENT);
  problem_destroy(&model);
}
END_TEST

SUITE(shaped_states)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, a_step_takes_no_memory, 0, 2);
  tcase_add_test(tests, creation_survives_every_failure_of_memory);
  tcase_add_test(tests, checkpoints_know_the_space);
  tcase_add_test(tests, what_the_program_gave_is_copied);
  tcase_add_test(tests, members_of_an_ensemble_have_the_digits_of_single_runs);
}
