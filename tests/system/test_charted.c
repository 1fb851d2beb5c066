/* labels: jacobian */
/* The Lagrangian in charts against its definition, its derivatives and those of what moving the
 * centre adds against differences. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "step/element/action.h"
#include "core/memory.h"
#include "support/systems/bodies.h"
#include "support/runs.h"
#include "support/suite.h"
#include "system/chart/charted_struct.h"

static const dvi__action_space space = {DVI_CHEBYSHEV, 3, DVI_GAUSS, 4};

enum {
  REDUCED = BODIES,
  KINDS = BODIES + 2,
  UNKNOWNS_MOST = 3 * BODY_V,
  ENTRIES_MOST = UNKNOWNS_MOST * UNKNOWNS_MOST
};

static body model;
static dvi_counters counters;
static dvi__charted *charts;

/* All bodies, then the free ones by the group's own velocity. */
static int is_reduced(int kind)
{
  return kind >= REDUCED;
}

static void make_charts(int kind)
{
  make_body(kind == REDUCED       ? FREE_BODY
            : kind == REDUCED + 1 ? FREE_MOTION
                                  : (body_kind)kind,
            &model);
  ck_assert_msg(dvi__charted_create(model.system, is_reduced(kind), &counters, &charts) == DVI_OK,
                "%s", dvi_last_error());
  dvi__charted_centre(charts, model.q);
}

static void free_charts(void)
{
  dvi__charted_destroy(&charts);
  destroy_body(&model);
}

/* Numbers without a pattern, of size 1. */
static void scatter(int count, double by, double *x)
{
  for (int i = 0; i < count; i++) x[i] = by * sin(1.7 * i * i + 0.9 * i + 0.4);
}

static const dvi_system *local(void)
{
  return dvi__charted_system(charts);
}

START_TEST(derivatives_are_those_of_the_value)
{
  double xi[BODY_V], rate[BODY_V];
  make_charts(_i);
  scatter(dvi_system_nq(local()), 0.6, xi);
  scatter(dvi_system_nq(local()), -1.3, rate);
  ck_assert_msg(dvi_system_check(local(), 0, xi, rate, 1e-8, NULL) == DVI_OK, "%s: %s", model.name,
                dvi_last_error());
}
END_TEST

/* Evaluates at y(xi) with the stored velocity, the reduced one, too. */
START_TEST(the_value_is_the_systems_own)
{
  double xi[BODY_V], rate[BODY_V], q[BODY_Q], v[BODY_V], in_charts, in_space;
  make_charts(_i);
  scatter(dvi_system_nq(local()), 0.6, xi);
  scatter(dvi_system_nq(local()), -1.3, rate);
  dvi__charted_point(charts, xi, rate, q, v);
  ck_assert_int_eq(dvi_system_lagrangian(local(), 0, xi, rate, &in_charts), DVI_OK);
  ck_assert_int_eq(dvi_system_lagrangian(model.system, 0, q, v, &in_space), DVI_OK);
  ck_assert_double_eq_tol(in_charts, in_space, 1e-14 * fmax(1, fabs(in_space)) * 50);
}
END_TEST

/* L_vv rate is the momentum, reduced or not. */
START_TEST(the_mass_at_the_centre_is_that_of_velocities)
{
  double zero[BODY_V] = {0}, rate[BODY_V], momentum[BODY_V], by_mass[BODY_V] = {0},
         mass[ENTRIES_MOST];
  make_charts(_i);
  const dvi__pattern *vv = &local()->vv;
  scatter(dvi_system_nq(local()), 0.7, rate);
  ck_assert_int_eq(dvi_system_momentum(local(), 0, zero, rate, momentum), DVI_OK);
  dvi__charted_mass(charts, mass);
  for (int j = 0; j < vv->columns; j++)
    for (int e = vv->start[j]; e < vv->start[j + 1]; e++) by_mass[vv->row[e]] += mass[e] * rate[j];
  for (int i = 0; i < vv->columns; i++)
    ck_assert_double_eq_tol(by_mass[i], momentum[i], 1e-14 * fmax(1, fabs(momentum[i])));
}
END_TEST

/* A point on the way and the start are found again in the charts at the end. */
START_TEST(paths_are_followed_into_the_charts_at_their_end)
{
  double xi[2][BODY_V], q[2][BODY_Q], points[2 * BODY_V], start[BODY_V], found[BODY_Q];
  make_charts(_i);
  const int nx = dvi_system_nq(local());
  for (int m = 0; m < 2; m++) {
    scatter(nx, m == 0 ? 0.4 : -0.9, xi[m]);
    dvi__charted_point(charts, xi[m], NULL, q[m], NULL);
    for (int i = 0; i < nx; i++) points[2 * i + m] = xi[m][i];
  }
  dvi__charted_follow(charts, q[1], xi[1], 2, points);
  for (int i = 0; i < nx; i++) {
    start[i] = -points[2 * i + 1];
    xi[0][i] = points[2 * i] + start[i];
  }
  dvi__charted_point(charts, start, NULL, found, NULL);
  ck_assert_double_le(distance(model.nq, model.q, found), 1e-14);
  dvi__charted_point(charts, xi[0], NULL, found, NULL);
  ck_assert_double_le(distance(model.nq, q[0], found), 1e-14);
  ck_assert_double_le(dvi_system_distance(model.system, found), 1e-15);
}
END_TEST

/* ---- rows with the centre's motion ---- */

static dvi__action *centred_action(void)
{
  dvi__action *made;
  dvi__centring centring;
  ck_assert_int_eq(dvi__action_create(local(), &space, &counters, &made), DVI_OK);
  ck_assert_int_eq(dvi__action_prepare_jacobian(made), DVI_OK);
  ck_assert_int_eq(dvi__charted_centring(charts, dvi__action_nodes(made), &centring), DVI_OK);
  ck_assert_int_eq(dvi__action_centre(made, &centring), DVI_OK);
  return made;
}

/* Takes central differences of order 4, with an error of 1e-12 beside roundoff over the length. */
static void difference_column(dvi__action *action, const double *Y, int column, double *in_column)
{
  static const double weight[] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12},
                      place[] = {-2, -1, 1, 2}, length = 1e-3;
  double moved[UNKNOWNS_MOST], R[UNKNOWNS_MOST];
  const int unknowns = dvi__action_unknowns(action);
  memset(in_column, 0, sizeof R);
  for (int k = 0; k < 4; k++) {
    memcpy(moved, Y, sizeof moved);
    moved[column] += place[k] * length;
    ck_assert_msg(dvi__action_residual(action, moved, R) == DVI_OK, "%s", dvi_last_error());
    for (int i = 0; i < unknowns; i++) in_column[i] += weight[k] / length * R[i];
  }
}

START_TEST(the_centred_jacobian_is_that_of_the_rows)
{
  double zero[BODY_V] = {0}, p[BODY_V], Y[UNKNOWNS_MOST], column[UNKNOWNS_MOST], size = 0,
         error = 0;
  make_charts(_i);
  dvi__action *action = centred_action();
  const dvi__pattern *pattern = dvi__action_pattern(action);
  double *values = calloc((size_t)dvi__pattern_entries(pattern), sizeof *values);
  ck_assert_ptr_nonnull(values);
  scatter(dvi__action_unknowns(action), 0.3, Y);
  scatter(BODY_V, 0.8, p);
  dvi__action_place(action, 0, 0.4, zero, p);
  ck_assert_msg(dvi__action_jacobian(action, Y, values) == DVI_OK, "%s", dvi_last_error());
  for (int j = 0; j < pattern->columns; j++) {
    difference_column(action, Y, j, column);
    for (int i = 0; i < pattern->rows; i++) {
      const int e = dvi__pattern_find(pattern, i, j);
      size = fmax(size, fabs(column[i]));
      error = fmax(error, fabs(column[i] - (e >= 0 ? values[e] : 0)));
    }
  }
  ck_assert_msg(error < 1e-9 * size, "%s: %.1e of %.1e", model.name, error, size);
  free(values);
  dvi__action_destroy(&action);
}
END_TEST

/* ---- create ---- */

START_TEST(charts_survive_every_failure)
{
  make_charts(_i);
  const long before = dvi__allocation_count();
  dvi__charted *made;
  ck_assert_int_eq(dvi__charted_create(model.system, is_reduced(_i), &counters, &made), DVI_OK);
  const long needed = dvi__allocation_count() - before;
  dvi__charted_destroy(&made);
  ck_assert_int_gt(needed, 20);
  for (long successes = 0; successes < needed; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = dvi__charted_create(model.system, is_reduced(_i), &counters, &made);
    dvi__fail_allocations_after(-1);
    ck_assert_int_eq(status, DVI_NO_MEMORY);
    ck_assert_ptr_null(made);
    check_words("no memory");
  }
}
END_TEST

/* Beyond half a turn only the status and the distance are known. */
START_TEST(beyond_half_a_turn_there_is_no_chart)
{
  double xi[BODY_V] = {0}, rate[BODY_V] = {0}, L;
  make_charts(FREE_BODY);
  xi[1] = 3.2;
  ck_assert_int_gt(dvi_system_lagrangian(local(), 0, xi, rate, &L), 0);
  ck_assert_int_eq(dvi__charted_explain(charts, DVI_CALLBACK_RETRY), DVI_STEP_TOO_LARGE);
  check_words("3.2");
  ck_assert_int_eq(dvi__charted_check(charts, xi), DVI_STEP_TOO_LARGE);
  xi[1] = 3.1;
  ck_assert_int_eq(dvi__charted_check(charts, xi), DVI_OK);
}
END_TEST

/* The patterns of a chain of n links have 3 n - 2 blocks of 4 entries. */
START_TEST(a_chains_patterns_are_sparse)
{
  direction_chain long_chain;
  make_direction_chain(100, &long_chain);
  ck_assert_int_eq(dvi__charted_create(long_chain.system, 0, &counters, &charts), DVI_OK);
  ck_assert_int_eq(dvi__pattern_entries(&charts->qq), 4 * (3 * 100 - 2));
  ck_assert_int_eq(dvi__pattern_entries(&charts->qv), 4 * 100);
  ck_assert_int_eq(dvi__pattern_entries(&charts->vv), 4 * 100);
  dvi__charted_destroy(&charts);
  destroy_direction_chain(&long_chain);
}
END_TEST

SUITE(charted)
{
  tcase_add_checked_fixture(tests, NULL, free_charts);
  tcase_add_loop_test(tests, derivatives_are_those_of_the_value, 0, KINDS);
  tcase_add_loop_test(tests, the_value_is_the_systems_own, 0, KINDS);
  tcase_add_loop_test(tests, the_mass_at_the_centre_is_that_of_velocities, 0, KINDS);
  tcase_add_loop_test(tests, paths_are_followed_into_the_charts_at_their_end, 0, BODIES);
  tcase_add_loop_test(tests, the_centred_jacobian_is_that_of_the_rows, 0, KINDS);
  tcase_add_loop_test(tests, charts_survive_every_failure, 0, KINDS);
  tcase_add_test(tests, beyond_half_a_turn_there_is_no_chart);
  tcase_add_test(tests, a_chains_patterns_are_sparse);
}
