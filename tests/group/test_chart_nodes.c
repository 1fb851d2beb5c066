/* Charts at many nodes at once, against the same chart at each of them. */
#include <dvi/group.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "group/chart_nodes.h"
#include "group/stumpff.h"
#include "group/vector.h"
#include "support/suite.h"

enum { KINDS = DVI__ROTATION + 1, NODES = 8, STRIDE = 9 };

/* Nodes of a path out to nearly half a turn. */
typedef struct path {
  dvi__chart chart;
  int count, size, stored;
  double xi[3 * STRIDE], rate[3 * STRIDE], in_xi[3 * STRIDE], in_rate[3 * STRIDE],
      functions[DVI__NODE_FUNCTIONS * NODES], y[9 * NODES], v[9 * NODES], a[9 * NODES],
      b[9 * NODES], N[3 * NODES];
  dvi__chart_nodes nodes;
} path;

static void set_path(int kind, int count, path *p)
{
  const double turn[] = {0.4, -1.2, 0.8}, direction[] = {0.6, -0.48, 0.64}, angle[] = {0.6, 0.8},
               line = 1.7;
  double R[9];
  dvi_so3_exp(turn, R);
  const double *const centre[] = {&line, angle, direction, R};
  memset(p, 0, sizeof *p);
  dvi__chart_centre((dvi__chart_kind)kind, centre[kind], &p->chart);
  p->count = count;
  p->size = dvi__chart_size(p->chart.kind);
  p->stored = dvi__chart_stored(p->chart.kind);
  for (int i = 0; i < p->size; i++)
    for (int k = 0; k < count; k++) {
      p->xi[i * STRIDE + k] = 0.19 * k * cos(1 + i) / cos(1);
      p->rate[i * STRIDE + k] = sin(0.3 * k + 2 * i + 1);
    }
  for (int i = 0; i < p->stored; i++)
    for (int k = 0; k < count; k++) {
      p->a[i * count + k] = cos(1.3 * i + 0.2 * k);
      p->b[i * count + k] = sin(2.1 * i - 0.7 * k);
    }
  p->nodes = (dvi__chart_nodes){.count = count,
                                .local = STRIDE,
                                .xi = p->xi,
                                .rate = p->rate,
                                .functions = p->functions,
                                .y = p->y,
                                .v = p->v,
                                .a = p->a,
                                .b = p->b,
                                .in_xi = p->in_xi,
                                .in_rate = p->in_rate};
  ck_assert(dvi__chart_place_nodes(&p->chart, &p->nodes) == 0);
}

/* Copy the numbers of node k from rows. */
static void gather(int rows, int stride, int k, const double *from, double *one)
{
  for (int i = 0; i < rows; i++) one[i] = from[i * stride + k];
}

static void check_node(int rows, int stride, int k, const double *found, const double *expected)
{
  for (int i = 0; i < rows; i++)
    ck_assert_msg(fabs(found[i * stride + k] - expected[i]) < 1e-13,
                  "row %d of node %d: %.17g, %.17g", i, k, found[i * stride + k], expected[i]);
}

/* One node of a path, and its chart there. */
typedef struct place {
  double xi[3], rate[3], a[9], b[9], y[9], v[9], in_xi[3], in_rate[3];
  dvi__functions functions;
} place;

static void set_place(const path *p, int k, place *at)
{
  gather(p->size, STRIDE, k, p->xi, at->xi);
  gather(p->size, STRIDE, k, p->rate, at->rate);
  gather(p->stored, p->count, k, p->a, at->a);
  gather(p->stored, p->count, k, p->b, at->b);
  dvi__chart_functions(p->chart.kind, at->xi, &at->functions);
  dvi__chart_point(&p->chart, &at->functions, at->xi, at->rate, at->y, at->v);
  dvi__chart_gradient(&p->chart, &at->functions, at->xi, at->rate, at->a, at->b, at->in_xi,
                      at->in_rate);
}

START_TEST(nodes_are_points)
{
  for (int count = 1; count <= NODES; count++) {
    path p;
    set_path(_i, count, &p);
    dvi__chart_differentiate_nodes(&p.chart, &p.nodes);
    for (int k = 0; k < count; k++) {
      place at;
      set_place(&p, k, &at);
      check_node(p.stored, count, k, p.y, at.y);
      check_node(p.stored, count, k, p.v, at.v);
      check_node(p.size, STRIDE, k, p.in_xi, at.in_xi);
      check_node(p.size, STRIDE, k, p.in_rate, at.in_rate);
    }
  }
}
END_TEST

/* Masses of the vectors of a rotation, and its J. */
static const double mass[] = {0.7, 0.9, 1.2}, inertia[] = {2.1, 0, 0, 0, 1.9, 0, 0, 0, 1.6};

/* With b = m v the gradient of a.y + b.v is that of a.y and twice the kinetic energy in b's place,
 * so that it is that of the kinetic energy with b fixed. */
START_TEST(even_masses_are_masses)
{
  path p;
  set_path(_i, 7, &p);
  const double *own = _i == DVI__ROTATION ? inertia : mass;
  const int vectors = _i == DVI__ROTATION ? 3 : 1;
  double expected[2][3 * STRIDE];
  for (int i = 0; i < p.stored * p.count; i++) p.b[i] = mass[i / p.count % vectors] * p.v[i];
  dvi__chart_differentiate_nodes(&p.chart, &p.nodes);
  memcpy(expected[0], p.in_xi, sizeof p.in_xi);
  memcpy(expected[1], p.in_rate, sizeof p.in_rate);
  dvi__chart_move_nodes(&p.chart, own, &p.nodes);
  for (int i = 0; i < 3 * STRIDE; i++) {
    ck_assert_double_le(fabs(p.in_xi[i] - expected[0][i]), 1e-12);
    ck_assert_double_le(fabs(p.in_rate[i] - expected[1][i]), 1e-12);
  }
}
END_TEST

START_TEST(moments_are_those_of_points)
{
  path p;
  set_path(_i, 6, &p);
  const int vectors = p.stored / 3;
  dvi__chart_moments_of_nodes(&p.chart, mass, &p.nodes, NODES, p.N);
  for (int k = 0; k < p.count; k++) {
    double N[3] = {0};
    place at;
    set_place(&p, k, &at);
    for (int i = 0; i < p.stored; i++) at.b[i] -= mass[i % vectors] * at.v[i];
    dvi__chart_add_moment(p.chart.kind, at.y, at.a, N);
    dvi__chart_add_moment(p.chart.kind, at.v, at.b, N);
    check_node(3, NODES, k, p.N, N);
  }
}
END_TEST

/* A step's digits do not depend on what is computed beside it. */
START_TEST(nodes_do_not_depend_on_their_neighbours)
{
  path all, one;
  set_path(_i, NODES, &all);
  dvi__chart_differentiate_nodes(&all.chart, &all.nodes);
  for (int count = 1; count < NODES; count++) {
    set_path(_i, count, &one);
    dvi__chart_differentiate_nodes(&one.chart, &one.nodes);
    for (int i = 0; i < one.size; i++)
      for (int k = 0; k < count; k++) {
        ck_assert(one.in_xi[i * STRIDE + k] == all.in_xi[i * STRIDE + k]);
        ck_assert(one.in_rate[i * STRIDE + k] == all.in_rate[i * STRIDE + k]);
      }
  }
}
END_TEST

START_TEST(nodes_beyond_half_a_turn_are_refused)
{
  path p;
  set_path(DVI__SPHERE, NODES, &p);
  p.xi[6] = 3;
  p.xi[STRIDE + 6] = 4;
  ck_assert_double_eq_tol(dvi__chart_place_nodes(&p.chart, &p.nodes), 5, 1e-15);
  p.xi[6] = NAN;
  ck_assert(isnan(dvi__chart_place_nodes(&p.chart, &p.nodes)));
}
END_TEST

START_TEST(functions_side_by_side_have_the_digits_of_each)
{
  for (int k = 0; k < 100; k++) {
    const double s[] = {0.03 * k, 0.4 * k, 2.5, 1e-9 * k};
    double c[6][DVI__STUMPFF_LANES], one[6];
    dvi__stumpff_six_of(s, c);
    for (int j = 0; j < DVI__STUMPFF_LANES; j++) {
      dvi__stumpff_six(s[j], one);
      for (int i = 0; i < 6; i++) ck_assert(c[i][j] == one[i]);
    }
  }
}
END_TEST

SUITE(chart_nodes)
{
  tcase_add_loop_test(tests, nodes_are_points, 0, KINDS);
  tcase_add_loop_test(tests, even_masses_are_masses, 0, KINDS);
  tcase_add_loop_test(tests, moments_are_those_of_points, DVI__SPHERE, KINDS);
  tcase_add_loop_test(tests, nodes_do_not_depend_on_their_neighbours, 0, KINDS);
  tcase_add_test(tests, nodes_beyond_half_a_turn_are_refused);
  tcase_add_test(tests, functions_side_by_side_have_the_digits_of_each);
}
