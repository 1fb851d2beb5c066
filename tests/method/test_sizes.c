/* labels: unit */
/* Systems that are too large are refused at once, before memory is taken, with the numbers that are
 * too large. */
#include <dvi/dvi.h>
#include <limits.h>
#include <stdlib.h>

#include "step/joint.h"
#include "support/runs.h"
#include "support/suite.h"

static int no_potential(double t, const double *q, double *V, void *user)
{
  (void)t, (void)q, (void)user;
  *V = 0;
  return 0;
}

static int no_force(double t, const double *q, double *V_q, void *user)
{
  const int *n = user;
  (void)t, (void)q;
  for (int i = 0; i < *n; i++) V_q[i] = 0;
  return 0;
}

/* Free points, whose potential has a diagonal Hessian. */
static dvi_status make_points(int n, dvi_system **system)
{
  int *start = malloc(((size_t)n + 1) * sizeof *start), *row = malloc((size_t)n * sizeof *row);
  static int count;
  count = n;
  ck_assert_ptr_nonnull(start);
  ck_assert_ptr_nonnull(row);
  for (int i = 0; i < n; i++) start[i] = row[i] = i;
  start[n] = n;
  const dvi_potential none = {.name = "none",
                              .value = no_potential,
                              .gradient = no_force,
                              .qq = {start, row},
                              .user = &count};
  const dvi_system_terms terms = {
      .dimension = n, .mass.scalar = 1, .potentials = &none, .potential_count = 1};
  const dvi_status status = dvi_system_create(&terms, system);
  free(start);
  free(row);
  return status;
}

START_TEST(more_members_than_there_is_memory_for)
{
  problem *model = create_problem("oscillator", NULL);
  const dvi_ensemble_options options = {.members = INT_MAX, .threads = 4 * _i};
  dvi_ensemble *ensemble = NULL;
  ck_assert_int_eq(dvi_ensemble_create(model->system, "verlet", &options, &ensemble),
                   DVI_NO_MEMORY);
  ck_assert_ptr_null(ensemble);
  check_words("ensemble: no memory for 2147483647 members, 80 bytes each");
  problem_destroy(&model);
}
END_TEST

START_TEST(more_coordinates_than_ints_count)
{
  const dvi_factor lines = {.kind = DVI_RN, .size = INT_MAX, .mass = 1};
  const dvi_system_terms plain = {.dimension = INT_MAX, .mass.scalar = 1},
                         product = {.factors = &lines, .factor_count = 1};
  dvi_system *system = NULL;
  ck_assert_int_eq(dvi_system_create(&plain, &system), DVI_BAD_SIZE);
  check_words("system: dimension 2147483647; at most 536870911 is possible");
  ck_assert_int_eq(dvi_system_create(&product, &system), DVI_BAD_SIZE);
  check_words("system: its factors have 2147483647 coordinates; at most 536870911 are possible");
  ck_assert_ptr_null(system);
}
END_TEST

/* 2 blocks of 271 unknowns a coordinate are 2.2e9 unknowns, a number that wrapped around. */
START_TEST(more_unknowns_than_an_int_counts)
{
  enum { N = 4000000 };
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  ck_assert_int_eq(make_points(N, &system), DVI_OK);
  ck_assert_int_eq(dvi_integrator_create(
                       system,
                       "shooting:onestep=gauss,stages=8,quadrature=lobatto,nodes=16,solve=stages",
                       &integrator),
                   DVI_BAD_SIZE);
  ck_assert_ptr_null(integrator);
  check_words(
      "4000000 coordinates with 542 numbers each make 2168000000, more than an int can count");
  dvi_system_destroy(&system);
}
END_TEST

/* The limits themselves, in a system that is small. */
START_TEST(the_largest_counts_are_those_of_an_int)
{
  enum { N = 1000 };
  dvi_system *system = NULL;
  ck_assert_int_eq(make_points(N, &system), DVI_OK);
  ck_assert_int_eq(dvi__joint_check(system, 1, INT_MAX / N), DVI_OK);
  ck_assert_int_eq(dvi__joint_check(system, 1, INT_MAX / N + 1), DVI_BAD_SIZE);
  check_words(
      "1000 coordinates with 2147484 numbers each make 2147484000, more than an int can count");
  ck_assert_int_eq(dvi__joint_check(system, 1465, 1), DVI_OK); /* 1465^2 N = 2146225000 */
  ck_assert_int_eq(dvi__joint_check(system, 1466, 1), DVI_BAD_SIZE);
  check_words("the Jacobian would have 2149156000 entries or more");
  dvi_system_destroy(&system);
}
END_TEST

SUITE(sizes)
{
  tcase_add_loop_test(tests, more_members_than_there_is_memory_for, 0, 2);
  tcase_add_test(tests, more_coordinates_than_ints_count);
  tcase_add_test(tests, more_unknowns_than_an_int_counts);
  tcase_add_test(tests, the_largest_counts_are_those_of_an_int);
}
