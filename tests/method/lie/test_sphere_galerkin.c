/* labels: invariant */
/* Directions alone: the steps of lie-galerkin, the length of directions, chains at linear cost, and
 * refusals. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/systems/bodies.h"
#include "support/heap.h"
#include "support/runs.h"
#include "support/suite.h"

START_TEST(it_takes_the_steps_of_lie_galerkin)
{
  body model;
  make_body(_i == 0 ? DIRECTIONS : ANGLE, &model);
  dvi_integrator *mine = body_integrator(&model, "sphere-galerkin:degree=3"),
                 *theirs = body_integrator(&model, "lie-galerkin:degree=3");
  advance(mine, 0.02, 100);
  advance(theirs, 0.02, 100);
  ck_assert_mem_eq(dvi_integrator_q(mine), dvi_integrator_q(theirs),
                   (size_t)model.nq * sizeof(double));
  ck_assert_mem_eq(dvi_integrator_p(mine), dvi_integrator_p(theirs),
                   (size_t)model.nv * sizeof(double));
  dvi_integrator_destroy(&mine);
  dvi_integrator_destroy(&theirs);
  destroy_body(&model);
}
END_TEST

/* A free direction goes round a great circle with the same step each time, in which rounding errors
 * of one sign would add up to 1e-10. */
START_TEST(a_free_direction_keeps_its_momentum)
{
  const dvi_factor factor = {.kind = DVI_S2, .mass = 1};
  dvi_system *system;
  ck_assert_int_eq(
      dvi_system_create(&(dvi_system_terms){.factors = &factor, .factor_count = 1, .autonomous = 1},
                        &system),
      DVI_OK);
  dvi_integrator *made = create_integrator(system, "sphere-galerkin:degree=2");
  ck_assert_int_eq(
      dvi_integrator_start_velocity(made, 0, (double[]){1, 0, 0}, (double[]){0, .7, .4}), DVI_OK);
  advance(made, 1e-3, 100000);
  const double *q = dvi_integrator_q(made), *p = dvi_integrator_p(made);
  ck_assert_double_le(fabs(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - 0.65), 1e-15);
  ck_assert_double_le(fabs(q[0] * p[1] - q[1] * p[0] - 0.7), 1e-15);
  ck_assert_double_le(dvi_system_distance(system, q), 1e-15);
  dvi_integrator_destroy(&made);
  dvi_system_destroy(&system);
}
END_TEST

/* |q| = 1 and p is orthogonal to q, without projection, and the vertical momentum is kept. */
START_TEST(directions_stay_directions)
{
  body model;
  double before[2], after[2];
  make_body(DIRECTIONS, &model);
  dvi_integrator *made = body_integrator(&model, "sphere-galerkin:degree=2");
  ck_assert_int_eq(dvi_integrator_invariants(made, before), DVI_OK);
  advance(made, 0.01, 10000);
  ck_assert_int_eq(dvi_integrator_invariants(made, after), DVI_OK);
  const double *q = dvi_integrator_q(made), *p = dvi_integrator_p(made);
  ck_assert_double_le(dvi_system_distance(model.system, q), 1e-15);
  for (int i = 0; i < 6; i += 3)
    ck_assert_double_le(fabs(q[i] * p[i] + q[i + 1] * p[i + 1] + q[i + 2] * p[i + 2]),
                        1e-14 * magnitude(6, p));
  ck_assert_double_le(fabs(after[1] - before[1]), 1e-15);
  dvi_integrator_destroy(&made);
  destroy_body(&model);
}
END_TEST

START_TEST(rotations_are_refused_by_name)
{
  body model;
  dvi_integrator *made;
  make_body(PRODUCT, &model);
  ck_assert_int_eq(dvi_integrator_create(model.system, "sphere-galerkin", &made), DVI_UNSUPPORTED);
  check_words("sphere-galerkin: the system declares rotations");
  check_words("methods for this system: composition, lie-galerkin");
  ck_assert_ptr_null(strstr(dvi_last_error(), "lie-rk, sphere-galerkin"));
  destroy_body(&model);
}
END_TEST

typedef struct cost {
  long bytes;
  dvi_counters counters;
} cost;

static cost cost_of(int links)
{
  direction_chain linked;
  cost found;
  make_direction_chain(links, &linked);
  const long before = heap_bytes();
  dvi_integrator *made = create_integrator(linked.system, "sphere-galerkin:degree=2,solver=newton");
  found.bytes = heap_bytes() - before;
  ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, linked.q, linked.v), DVI_OK);
  advance(made, 0.02, 10);
  dvi_integrator_counters(made, &found.counters);
  dvi_integrator_destroy(&made);
  destroy_direction_chain(&linked);
  return found;
}

/* Ten times the links take ten times the memory, and as many residuals and Jacobians, whose entries
 * test_charted counts. The cost of a chain of one link is part of both. */
START_TEST(chains_cost_as_much_as_they_have_links)
{
  const cost few = cost_of(100), many = cost_of(1000);
  ck_assert_int_le(many.counters.residuals, few.counters.residuals * 12 / 10);
  ck_assert_int_le(many.counters.jacobians, few.counters.jacobians * 12 / 10);
  if (heap_is_counted())
    ck_assert_msg(many.bytes < 12 * few.bytes && few.bytes > 100000, "%ld and %ld bytes", few.bytes,
                  many.bytes);
}
END_TEST

/* Weak springs leave each direction its own block of the Jacobian. One Jacobian serves for many
 * steps, and nothing sparse is analysed but the mass, for the velocity and the bend of the first
 * guess. */
START_TEST(chains_are_solved_direction_by_direction)
{
  direction_chain linked;
  dvi_counters before, counters;
  make_direction_chain(50, &linked);
  dvi_integrator *made = create_integrator(linked.system, "sphere-galerkin:degree=2");
  ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, linked.q, linked.v), DVI_OK);
  dvi_integrator_counters(made, &before);
  advance(made, 0.02, 100);
  dvi_integrator_counters(made, &counters);
  ck_assert_int_eq(counters.simplified, 100);
  ck_assert_int_le(counters.jacobians, 10);
  ck_assert_int_eq(counters.symbolic, before.symbolic + 2);
  ck_assert_int_eq(counters.factorizations, before.factorizations + 2);
  dvi_integrator_destroy(&made);
  destroy_direction_chain(&linked);
}
END_TEST

/* The path of a long first step bends away from the straight line by more than a path may from its
 * guess. The guess bends, too, and nothing is followed from shorter steps. */
START_TEST(first_steps_are_not_followed)
{
  direction_chain linked;
  dvi_counters counters;
  make_direction_chain(8, &linked);
  dvi_integrator *made = create_integrator(linked.system, "sphere-galerkin:degree=4");
  ck_assert_int_eq(dvi_integrator_start_velocity(made, 0, linked.q, linked.v), DVI_OK);
  advance(made, 0.2, 1);
  dvi_integrator_counters(made, &counters);
  ck_assert_int_eq(counters.followed, 0);
  dvi_integrator_destroy(&made);
  destroy_direction_chain(&linked);
}
END_TEST

/* The mass couples two directions. Their 32 unknowns are one block, and no sparse Jacobian is
 * factored. */
START_TEST(coupled_directions_are_one_block)
{
  body model;
  dvi_counters before, counters;
  make_body(DIRECTIONS, &model);
  dvi_integrator *made = body_integrator(&model, "sphere-galerkin:degree=8");
  advance(made, 0.01, 1);
  dvi_integrator_counters(made, &before);
  advance(made, 0.01, 50);
  dvi_integrator_counters(made, &counters);
  ck_assert_int_eq(counters.simplified, before.simplified + 50);
  ck_assert_int_eq(counters.factorizations, before.factorizations);
  dvi_integrator_destroy(&made);
  destroy_body(&model);
}
END_TEST

SUITE(sphere_galerkin)
{
  tcase_add_test(tests, first_steps_are_not_followed);
  tcase_add_test(tests, coupled_directions_are_one_block);
  tcase_add_test(tests, a_free_direction_keeps_its_momentum);
  tcase_add_loop_test(tests, it_takes_the_steps_of_lie_galerkin, 0, 2);
  tcase_add_test(tests, directions_stay_directions);
  tcase_add_test(tests, rotations_are_refused_by_name);
  tcase_add_test(tests, chains_cost_as_much_as_they_have_links);
  tcase_add_test(tests, chains_are_solved_direction_by_direction);
}
