/* labels: unit */
/* A checkpoint holds all that the next step depends on, and one that is not whole is refused. */
#define _POSIX_C_SOURCE 200809L /* geteuid, RLIMIT_FSIZE */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/files.h"
#include "support/runs.h"
#include "support/suite.h"
#include "mid_run.h"

/* ---- going on bit for bit ---- */

/* In the first run fixed-point iteration gives up near the pericentre, and more robust solvers take
 * over. Stiff steps keep the factors of earlier ones. */
static const struct {
  const char *problem, *setting, *method;
  double h;
  int steps;
} runs[] = {
    {"kepler", NULL, "galerkin", 0.4, 180},
    {"fpu", "omega=50", "galerkin", 0.05, 30},
    {"fpu", "omega=50", "galerkin:degree=3,basis=chebyshev,quadrature=lobatto,nodes=5", 0.05, 30},
    {"fpu", "omega=50", "galerkin:degree=2,solver=kinsol", 0.05, 30},
    {"fpu", "omega=50", "galerkin:degree=2", 0.1, 40},
    {"double-pendulum", NULL, "galerkin:degree=3,solver=simplified", 0.05, 40},
    {"fpu", "omega=50", "composition:order=6,base=galerkin,degree=2", 0.05, 30},
    {"fpu", "omega=50", "composition:order=4,base=midpoint,solver=newton", 0.05, 30},
    {"kepler", NULL, "galerkin:degree=8,solver=fixed-point", 0.05, 30},
    {"kepler", NULL, "midpoint", 0.05, 30},
    {"kepler", NULL, "trapezoidal", 0.05, 30},
    {"kepler", NULL, "verlet", 0.05, 30},
    {"fpu", NULL, "imex", 0.1, 30},
    {"fpu", NULL, "composition:order=6,base=imex", 0.05, 30},
    {"fpu", NULL, "imex:solver=newton", 0.1, 30},
    {"fpu", NULL, "respa", 0.1, 30},
    {"fpu", NULL, "mollified", 0.1, 30},
    {"fpu", NULL, "multiscale", 0.1, 30},
    {"stiff-pendulum", NULL, "multiscale:fast=0:1", 0.1, 30},
    {"kepler", NULL, "composition:order=8,base=verlet", 0.05, 30},
    {"double-pendulum", NULL, "galerkin:degree=3", 0.02, 30},
    {"double-pendulum", NULL, "trapezoidal:solver=newton", 0.02, 30},
    {"kepler", "e=0.8", "sem", 0.01, 120},
    {"driven-pendulum", NULL, "sem:degree=3,quadrature=lobatto", 0.2, 30},
    {"vortices", NULL, "vprk:nodes=3", 0.05, 30},
    {"vortices", NULL, "dg", 0.05, 30},
    {"vortices", NULL, "dg-phase", 0.02, 30},
    {"circle-dirac", NULL, "dg-phase:degree=2", 0.1, 30},
    {"elastica", NULL, "hamiltonian:degree=3", 0.1, 30},
    {"massless-particle", NULL, "dg:degree=1,stiffness=1:2", 0.1, 30},
    {"massless-particle", NULL, "vprk:projection=symplectic", 0.1, 30},
    {"massless-particle", "gauge=singular", "dvi-a", 0.1, 30},
    {"massless-particle", "gauge=singular", "dvi-trapezoidal", 0.1, 30},
    {"massless-particle", "gauge=singular", "dvrk:nodes=3", 0.1, 30},
    {"double-pendulum", NULL, "hp:type=2,degree=2", 0.02, 30},
    {"double-pendulum", NULL, "hp:type=4,degree=2", 0.02, 30},
    {"damped-driven", NULL, "verlet", 0.1, 30},
    {"magnetic-bottle", NULL, "boris", 0.1, 30},
    {"magnetic-bottle", NULL, "galerkin:degree=3", 0.1, 30},
    {"damped-driven", NULL, "galerkin:degree=3", 0.1, 30},
    {"lotka-volterra", NULL, "hp:type=2,degree=2,quadrature=gauss", 0.1, 30},
};
enum { RUNS = sizeof runs / sizeof *runs, COORDINATES_MOST = 8, INVARIANTS_MOST = 16 };

/* Compares everything that both can be asked between two steps. */
static void check_same_answers(dvi_integrator *a, dvi_integrator *b, double t)
{
  double qv[2][2][COORDINATES_MOST] = {0}, invariants[2][INVARIANTS_MOST] = {0};
  ck_assert_int_eq(dvi_integrator_interpolate(a, t, qv[0][0], qv[0][1]), DVI_OK);
  ck_assert_int_eq(dvi_integrator_interpolate(b, t, qv[1][0], qv[1][1]), DVI_OK);
  ck_assert_mem_eq(qv[0], qv[1], sizeof qv[0]);
  ck_assert_int_eq(dvi_integrator_invariants(a, invariants[0]), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariants(b, invariants[1]), DVI_OK);
  ck_assert_mem_eq(invariants[0], invariants[1], sizeof invariants[0]);
}

/* Restore the first one's checkpoint into an integrator with another past, and take the same step
 * with both. */
static void check_step_after_restoring(const problem *model, const char *method,
                                       dvi_integrator *first, double h, int asked)
{
  dvi_integrator *second = start_integrator(model, method);
  advance(second, 0.6 * h, 2);
  ck_assert_int_eq(dvi_integrator_save(first, path_in_folder("checkpoint")), DVI_OK);
  ck_assert_msg(dvi_integrator_restore(second, path_in_folder("checkpoint")) == DVI_OK, "%s",
                dvi_last_error());
  if (asked)
    check_same_answers(first, second,
                       dvi_integrator_time(first) - 0.3 * dvi_integrator_last_step(first));
  advance(first, h, 1);
  advance(second, h, 1);
  check_same_state(first, second);
  dvi_integrator_destroy(&second);
}

START_TEST(a_restored_run_continues_bit_for_bit_from_any_step)
{
  problem *model = create_problem(runs[_i].problem, runs[_i].setting);
  dvi_integrator *integrator = start_integrator(model, runs[_i].method);
  for (int step = 0; step < runs[_i].steps; step++)
    check_step_after_restoring(model, runs[_i].method, integrator,
                               runs[_i].h * (step % 10 == 9 ? 0.7 : 1), step > 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Else the test above would not see a checkpoint that forgets which of the two is in charge. */
START_TEST(the_first_run_changes_its_solver_on_the_way)
{
  problem *model = create_problem(runs[0].problem, runs[0].setting);
  dvi_integrator *integrator = start_integrator(model, runs[0].method);
  dvi_counters counters;
  advance(integrator, runs[0].h, runs[0].steps);
  dvi_integrator_counters(integrator, &counters);
  ck_assert_int_gt(counters.newtons, 0);
  ck_assert_int_gt(counters.fixed_points, 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(time_and_number_of_steps_are_restored)
{
  problem *model = create_problem("pendulum", NULL);
  dvi_integrator *first = start_integrator(model, "midpoint"),
                 *second = create_integrator(model->system, "midpoint");
  dvi_counters counters;
  advance(first, 0.1, 7);
  ck_assert_int_eq(dvi_integrator_save(first, path_in_folder("checkpoint")), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore(second, path_in_folder("checkpoint")), DVI_OK);
  ck_assert_double_eq(dvi_integrator_time(second), dvi_integrator_time(first));
  ck_assert_double_eq(dvi_integrator_q(second)[0], dvi_integrator_q(first)[0]);
  ck_assert_double_eq(dvi_integrator_p(second)[0], dvi_integrator_p(first)[0]);
  dvi_integrator_counters(second, &counters);
  ck_assert_int_eq(counters.steps, 7);
  ck_assert_int_eq(count_files_in_folder(), 1);
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&second);
  problem_destroy(&model);
}
END_TEST

/* The effect of an alarm is no part of the steps. A run that was stopped goes on with warnings, and
 * one that was warned with stops. */
START_TEST(a_run_goes_on_under_another_alarm_and_under_no_other_key)
{
  problem *model = create_problem("vortices", NULL);
  const char *const method[] = {"dg", "dg-phase"}, *const other[] = {"dg:nodes=4,alarm=warn",
                                                                     "dg-phase:degree=2"};
  dvi_integrator *stops = start_integrator(model, method[_i]),
                 *warns = create_integrator(model->system,
                                            method_spec("%s:alarm=warn", method[_i]));
  dvi_integrator *differs = create_integrator(model->system, other[_i]);
  advance(stops, 0.02, 3);
  ck_assert_int_eq(dvi_integrator_save(stops, path_in_folder("checkpoint")), DVI_OK);
  ck_assert_msg(dvi_integrator_restore(warns, path_in_folder("checkpoint")) == DVI_OK, "%s",
                dvi_last_error());
  advance(stops, 0.02, 3);
  advance(warns, 0.02, 3);
  ck_assert_mem_eq(dvi_integrator_q(stops), dvi_integrator_q(warns),
                   (size_t)model->nq * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(stops), dvi_integrator_p(warns),
                   (size_t)model->nq * sizeof(double));
  ck_assert_int_eq(dvi_integrator_save(warns, path_in_folder("checkpoint")), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore(stops, path_in_folder("checkpoint")), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore(differs, path_in_folder("checkpoint")), DVI_BAD_FILE);
  check_words(method_spec("written by %s", dvi_integrator_method(warns)));
  dvi_integrator_destroy(&stops);
  dvi_integrator_destroy(&warns);
  dvi_integrator_destroy(&differs);
  problem_destroy(&model);
}
END_TEST

/* ---- files that are not whole ---- */

static void refused(const scene *s, size_t count)
{
  const char *file = path_in_folder("bad");
  write_bytes(file, s->past.at, count);
  ck_assert_int_eq(dvi_integrator_restore(s->integrator, file), DVI_BAD_FILE);
  check_words(file);
}

START_TEST(a_checkpoint_cut_anywhere_is_refused)
{
  scene s = create_scene();
  const bytes before = read_state(s.integrator);
  for (size_t count = 0; count < s.past.count; count++) {
    refused(&s, count);
    check_words("cut short");
  }
  check_state(s.integrator, before);
  clear_scene(&s);
}
END_TEST

START_TEST(a_checkpoint_that_is_too_long_is_refused)
{
  scene s = create_scene();
  const bytes before = read_state(s.integrator);
  s.past.at = realloc(s.past.at, s.past.count + 1);
  ck_assert_ptr_nonnull(s.past.at);
  s.past.at[s.past.count] = 0;
  refused(&s, s.past.count + 1);
  check_words("too long");
  check_state(s.integrator, before);
  clear_scene(&s);
}
END_TEST

START_TEST(a_checkpoint_damaged_at_any_byte_is_refused)
{
  const unsigned char damages[] = {0x01, 0x80, 0xff};
  scene s = create_scene();
  const bytes before = read_state(s.integrator);
  for (size_t at = 0; at < s.past.count; at++) {
    s.past.at[at] ^= damages[at % 3];
    refused(&s, s.past.count);
    s.past.at[at] ^= damages[at % 3];
  }
  check_state(s.integrator, before);
  write_bytes(path_in_folder("good"), s.past.at, s.past.count);
  ck_assert_int_eq(dvi_integrator_restore(s.integrator, path_in_folder("good")), DVI_OK);
  clear_scene(&s);
}
END_TEST

START_TEST(a_checkpoint_of_another_format_is_refused_with_a_sentence)
{
  const uint32_t old = 5; /* of libdvi before its checkpoints had sections */
  scene s = create_scene();
  memcpy(s.past.at + 12, &old, sizeof old);
  refused(&s, s.past.count);
  check_words("written in format 5 by another version of libdvi; this one reads format 6");
  clear_scene(&s);
}
END_TEST

/* ---- memory ---- */

static void check_still(const dvi_integrator *integrator, bytes expected)
{
  const bytes found = read_state(integrator);
  ck_assert_uint_eq(found.count, expected.count);
  ck_assert_mem_eq(found.at, expected.at, found.count);
  free(found.at);
}

START_TEST(a_state_in_memory_is_that_of_a_file)
{
  scene s = create_scene();
  size_t size = 0;
  const bytes now = read_state(s.integrator);
  ck_assert_int_eq(dvi_integrator_save_memory(s.integrator, NULL, 0, &size), DVI_OK);
  ck_assert_uint_eq(size, now.count);
  unsigned char *room = malloc(size + 1);
  ck_assert_ptr_nonnull(room);
  ck_assert_int_eq(dvi_integrator_save_memory(s.integrator, room + 1, size - 1, &size),
                   DVI_BAD_SIZE);
  check_words("are needed");
  ck_assert_int_eq(dvi_integrator_save_memory(s.integrator, room + 1, size, &size), DVI_OK);
  ck_assert_mem_eq(room + 1, now.at, size);
  ck_assert_int_eq(dvi_integrator_restore_memory(s.integrator, s.past.at, s.past.count), DVI_OK);
  check_still(s.integrator, s.past);
  /* aligned to nothing */
  ck_assert_int_eq(dvi_integrator_restore_memory(s.integrator, room + 1, size), DVI_OK);
  check_still(s.integrator, now);
  room[size / 2] ^= 1;
  ck_assert_int_eq(dvi_integrator_restore_memory(s.integrator, room + 1, size), DVI_BAD_FILE);
  check_words("checkpoint in memory: damaged");
  ck_assert_int_eq(dvi_integrator_restore_memory(s.integrator, room + 1, size - 1), DVI_BAD_FILE);
  check_words("checkpoint in memory");
  check_still(s.integrator, now);
  free(room);
  free(now.at);
  clear_scene(&s);
}
END_TEST

/* ---- files of others ---- */

static void refused_by(const char *name, const char *setting, const char *method, const char *words)
{
  problem *other = create_problem(name, setting);
  dvi_integrator *integrator = start_integrator(other, method);
  const bytes before = read_state(integrator);
  ck_assert_int_eq(dvi_integrator_restore(integrator, path_in_folder("other")), DVI_BAD_FILE);
  check_words(words);
  check_state(integrator, before);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&other);
}

START_TEST(a_checkpoint_of_another_method_or_dimension_is_refused)
{
  scene s = create_scene();
  ck_assert_int_eq(dvi_integrator_save(s.integrator, path_in_folder("other")), DVI_OK);
  refused_by("kepler", NULL, "verlet", "written by galerkin:degree=2");
  refused_by("kepler", NULL, "galerkin:degree=3", "not by galerkin:degree=3");
  refused_by("kepler", NULL, "galerkin:degree=2,solver=newton", "written by");
  refused_by("kepler", NULL, "composition:base=galerkin,degree=2", "written by");
  refused_by("oscillator", NULL, "galerkin:degree=2", "2 coordinates, not 1");
  refused_by("fpu", "ell=3", "galerkin:degree=2", "2 coordinates, not 6");
  clear_scene(&s);
}
END_TEST

/* A system of the same size is another one if it declares other terms, or if its Lagrangian has
 * another value or other forces. */
START_TEST(a_checkpoint_of_another_system_or_other_parameters_is_refused)
{
  scene s = create_scene();
  ck_assert_int_eq(dvi_integrator_save(s.integrator, path_in_folder("other")), DVI_OK);
  refused_by("henon-heiles", NULL, "galerkin:degree=2",
             "of a system that declares other names or speeds of potentials");
  problem *stiff = create_problem("fpu", "omega=50"),
          *softer = create_problem("fpu", "omega=49.9999");
  dvi_integrator *first = start_integrator(stiff, "verlet"),
                 *second = start_integrator(softer, "verlet");
  /* at the start the velocity is the start's, later the step's */
  for (int steps = 0; steps < 2; steps++) {
    ck_assert_int_eq(dvi_integrator_save(first, path_in_folder("other")), DVI_OK);
    ck_assert_int_eq(dvi_integrator_restore(second, path_in_folder("other")), DVI_BAD_FILE);
    check_words("other parameters");
    ck_assert_int_eq(dvi_integrator_restore(first, path_in_folder("other")), DVI_OK);
    advance(first, 0.01, 1);
  }
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&second);
  problem_destroy(&stiff);
  problem_destroy(&softer);
  clear_scene(&s);
}
END_TEST

/* The start is no parameter of a system, and kepler's e only sets the start. */
START_TEST(a_checkpoint_of_another_start_is_taken)
{
  problem *one = create_problem("kepler", "e=0.6"), *two = create_problem("kepler", "e=0.2");
  dvi_integrator *first = start_integrator(one, "midpoint"),
                 *second = start_integrator(two, "midpoint");
  ck_assert_int_eq(dvi_integrator_save(first, path_in_folder("other")), DVI_OK);
  ck_assert_msg(dvi_integrator_restore(second, path_in_folder("other")) == DVI_OK, "%s",
                dvi_last_error());
  check_same_state(first, second);
  dvi_integrator_destroy(&first);
  dvi_integrator_destroy(&second);
  problem_destroy(&one);
  problem_destroy(&two);
}
END_TEST

START_TEST(a_file_that_is_none_or_a_folder_cannot_be_read)
{
  scene s = create_scene();
  const bytes before = read_state(s.integrator);
  ck_assert_int_eq(dvi_integrator_restore(s.integrator, path_in_folder("missing")), DVI_IO_ERROR);
  check_words("No such file");
  ck_assert_int_eq(dvi_integrator_restore(s.integrator, path_in_folder(".")), DVI_IO_ERROR);
  check_words("directory");
  ck_assert_int_eq(dvi_integrator_restore(s.integrator, ""), DVI_IO_ERROR);
  write_bytes(path_in_folder("text"), (const unsigned char *)"t,x,y,p_x,p_y\n", 14);
  ck_assert_int_eq(dvi_integrator_restore(s.integrator, path_in_folder("text")), DVI_BAD_FILE);
  check_state(s.integrator, before);
  clear_scene(&s);
}
END_TEST

SUITE(checkpoint)
{
  tcase_set_timeout(tests, 120); /* every file is flushed to the disk, which may be busy */
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, a_restored_run_continues_bit_for_bit_from_any_step, 0, RUNS);
  tcase_add_test(tests, the_first_run_changes_its_solver_on_the_way);
  tcase_add_test(tests, time_and_number_of_steps_are_restored);
  tcase_add_loop_test(tests, a_run_goes_on_under_another_alarm_and_under_no_other_key, 0, 2);
  tcase_add_test(tests, a_checkpoint_cut_anywhere_is_refused);
  tcase_add_test(tests, a_checkpoint_that_is_too_long_is_refused);
  tcase_add_test(tests, a_checkpoint_damaged_at_any_byte_is_refused);
  tcase_add_test(tests, a_checkpoint_of_another_format_is_refused_with_a_sentence);
  tcase_add_test(tests, a_state_in_memory_is_that_of_a_file);
  tcase_add_test(tests, a_checkpoint_of_another_method_or_dimension_is_refused);
  tcase_add_test(tests, a_checkpoint_of_another_system_or_other_parameters_is_refused);
  tcase_add_test(tests, a_checkpoint_of_another_start_is_taken);
  tcase_add_test(tests, a_file_that_is_none_or_a_folder_cannot_be_read);
}
