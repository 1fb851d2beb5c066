/* Charts at many nodes at once, against the same chart at each of them. */
#include <dvi/group.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "group/chart_bends.h"
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
      b[9 * NODES], N[3 * STRIDE];
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

/* Second derivatives at the nodes of a path. */
typedef struct bends {
  double T[27 * NODES], S[27 * NODES], turned[2][27 * NODES], in_xi[9 * NODES], mixed[9 * NODES],
      C[2][9 * NODES];
} bends;

static const double W[] = {0.3, -0.7, 0.2, 0.5, 0.9, -0.4, -0.1, 0.6, 0.8};

static void bend_path(const path *p, bends *b)
{
  memset(b, 0, sizeof *b);
  dvi__chart_bend_nodes(&p->chart, &p->nodes, p->chart.kind >= DVI__SPHERE ? W : NULL,
                        &(dvi__chart_bends){.stride = NODES,
                                            .T = b->T,
                                            .S = b->S,
                                            .in_xi = b->in_xi,
                                            .mixed = b->mixed,
                                            .turned_T = b->turned[0],
                                            .turned_S = b->turned[1],
                                            .C_xi = b->C[0],
                                            .C_rate = b->C[1]});
}

START_TEST(second_derivatives_are_those_of_points)
{
  for (int count = 1; count <= NODES; count++) {
    path p;
    bends b;
    set_path(_i, count, &p);
    bend_path(&p, &b);
    for (int k = 0; k < count; k++) {
      double T[27], S[27], in_xi[9], mixed[9];
      place at;
      set_place(&p, k, &at);
      dvi__chart_tangents(&p.chart, &at.functions, at.xi, at.rate, T, S);
      dvi__chart_curvature(&p.chart, &at.functions, at.xi, at.rate, at.a, at.b, in_xi, mixed);
      check_node(p.stored * p.size, NODES, k, b.T, T);
      check_node(p.stored * p.size, NODES, k, b.S, S);
      check_node(p.size * p.size, count, k, b.in_xi, in_xi);
      check_node(p.size * p.size, count, k, b.mixed, mixed);
    }
  }
}
END_TEST

/* Give column j of tangents at node k. */
static void get_column(const path *p, int k, int j, const double *tangents, double *column)
{
  for (int i = 0; i < p->stored; i++) column[i] = tangents[(i * p->size + j) * NODES + k];
}

/* Column j of turned_T has the moment of a covector as its product: a.(W_j x y) = W_j.(y x a). */
START_TEST(turned_tangents_have_the_moments)
{
  path p;
  bends b;
  set_path(_i, 5, &p);
  bend_path(&p, &b);
  for (int k = 0; k < p.count; k++)
    for (int j = 0; j < p.size; j++) {
      double N[2][3] = {{0}}, turned[2][9], sum[2] = {0};
      place at;
      set_place(&p, k, &at);
      dvi__chart_add_moment(p.chart.kind, at.y, at.a, N[0]);
      dvi__chart_add_moment(p.chart.kind, at.v, at.a, N[1]);
      for (int which = 0; which < 2; which++) {
        get_column(&p, k, j, b.turned[which], turned[which]);
        for (int i = 0; i < p.stored; i++) sum[which] += at.a[i] * turned[which][i];
        ck_assert_double_le(fabs(sum[which] - dvi__dot(W + 3 * j, N[which])), 1e-13);
      }
    }
}
END_TEST

START_TEST(changes_of_moments_are_those_of_tangents)
{
  path p;
  bends b;
  set_path(_i, 5, &p);
  bend_path(&p, &b);
  for (int k = 0; k < p.count; k++)
    for (int j = 0; j < p.size; j++) {
      double N[2][3] = {{0}}, T[9], S[9];
      place at;
      set_place(&p, k, &at);
      get_column(&p, k, j, b.T, T);
      get_column(&p, k, j, b.S, S);
      dvi__chart_add_moment(p.chart.kind, T, at.a, N[0]);
      dvi__chart_add_moment(p.chart.kind, S, at.b, N[0]);
      dvi__chart_add_moment(p.chart.kind, T, at.b, N[1]);
      for (int which = 0; which < 2; which++)
        for (int i = 0; i < p.size; i++)
          ck_assert_double_le(
              fabs(b.C[which][(i * p.size + j) * p.count + k] - dvi__dot(W + 3 * i, N[which])),
              1e-13);
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

static void move_path(path *p)
{
  dvi__chart_move_nodes(&p->chart, p->chart.kind == DVI__ROTATION ? inertia : mass, &p->nodes);
}

static void differentiate_path(path *p)
{
  dvi__chart_differentiate_nodes(&p->chart, &p->nodes);
  if (p->chart.kind >= DVI__SPHERE)
    dvi__chart_moments_of_nodes(&p->chart, mass, &p->nodes, STRIDE, p->N);
}

static void check_digits(int rows, const double *found, int stride, const double *expected,
                         int expected_stride, int count)
{
  for (int i = 0; i < rows; i++)
    for (int k = 0; k < count; k++)
      ck_assert_msg(found[i * stride + k] == expected[i * expected_stride + k],
                    "row %d of node %d of %d", i, k, count);
}

/* A step's digits do not depend on what is computed beside it. */
START_TEST(nodes_do_not_depend_on_their_neighbours)
{
  void (*const compute[])(path *) = {move_path, differentiate_path};
  for (int which = 0; which < 2; which++)
    for (int count = 1; count < NODES; count++) {
      path all, one;
      set_path(_i, NODES, &all);
      set_path(_i, count, &one);
      compute[which](&all);
      compute[which](&one);
      check_digits(one.stored, one.y, count, all.y, NODES, count);
      check_digits(one.stored, one.v, count, all.v, NODES, count);
      check_digits(one.size, one.in_xi, STRIDE, all.in_xi, STRIDE, count);
      check_digits(one.size, one.in_rate, STRIDE, all.in_rate, STRIDE, count);
      check_digits(3, one.N, STRIDE, all.N, STRIDE, count);
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
  tcase_add_loop_test(tests, second_derivatives_are_those_of_points, 0, KINDS);
  tcase_add_loop_test(tests, turned_tangents_have_the_moments, DVI__SPHERE, KINDS);
  tcase_add_loop_test(tests, changes_of_moments_are_those_of_tangents, DVI__SPHERE, KINDS);
  tcase_add_loop_test(tests, nodes_do_not_depend_on_their_neighbours, 0, KINDS);
  tcase_add_test(tests, nodes_beyond_half_a_turn_are_refused);
  tcase_add_test(tests, functions_side_by_side_have_the_digits_of_each);
}
