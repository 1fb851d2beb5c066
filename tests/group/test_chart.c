/* Charts of rotations, directions, angles and lines. Every derivative is tested against differences
 * of its function, and every chart by the way back. */
#include <dvi/group.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "group/chart.h"
#include "support/runs.h"
#include "support/suite.h"

enum { KINDS = DVI__ROTATION + 1, LENGTHS = 4 };

/* lengths |xi| where series would be used, ordinary ones, and ones near half a turn */
static const double lengths[LENGTHS] = {1e-6, 0.3, 1.9, 3.1};

typedef struct scene {
  dvi__chart chart;
  int size, stored;
  double xi[3], rate[3], a[9], b[9];
} scene;

static scene set_scene(int index)
{
  const dvi__chart_kind kind = (dvi__chart_kind)(index / LENGTHS);
  const double turn[] = {0.4, -1.2, 0.8}, toward[] = {0.48, -0.6, 0.64},
               direction[] = {0.6, -0.48, 0.64}, angle[] = {0.6, 0.8}, line = 1.7;
  double R[9];
  scene s = {
      .size = dvi__chart_size(kind), .stored = dvi__chart_stored(kind), .rate = {0.7, -1.1, 0.4}};
  dvi_so3_exp(turn, R);
  const double *const centre[] = {&line, angle, direction, R};
  dvi__chart_centre(kind, centre[kind], &s.chart);
  const double norm = dvi__chart_angle(kind, toward);
  for (int i = 0; i < s.size; i++) s.xi[i] = toward[i] * lengths[index % LENGTHS] / norm;
  for (int i = 0; i < s.stored; i++) s.a[i] = cos(1.3 * i + 0.2), s.b[i] = sin(2.1 * i - 0.7);
  return s;
}

/* ---- differences of order 6, which err by 1e-13 of smooth functions of unit size ---- */

typedef void vector_of(const scene *s, const double *xi, const double *rate, double *value);

enum { IN_XI, IN_RATE, VALUES_MOST = 9 };

static void difference_column(vector_of *f, const scene *s, int in, int j, int count,
                              double *derivative)
{
  static const double weight[] = {-1.0 / 60, 9.0 / 60, -45.0 / 60, 45.0 / 60, -9.0 / 60, 1.0 / 60},
                      place[] = {-3, -2, -1, 1, 2, 3}, length = 1.0 / 128;
  memset(derivative, 0, (size_t)count * sizeof *derivative);
  for (int k = 0; k < 6; k++) {
    double moved[2][3], value[VALUES_MOST];
    memcpy(moved[IN_XI], s->xi, sizeof s->xi);
    memcpy(moved[IN_RATE], s->rate, sizeof s->rate);
    moved[in][j] += place[k] * length;
    f(s, moved[IN_XI], moved[IN_RATE], value);
    for (int i = 0; i < count; i++) derivative[i] += weight[k] / length * value[i];
  }
}

/* Good until the next call. */
static const dvi__functions *functions_at(const scene *s, const double *xi)
{
  static dvi__functions c;
  dvi__chart_functions(s->chart.kind, xi, &c);
  return &c;
}

/* Row i of `derivative` holds the derivatives of number i. */
static void check_derivative(vector_of *f, const scene *s, int in, int count,
                             const double *derivative, const char *what)
{
  for (int j = 0; j < s->size; j++) {
    double expected[VALUES_MOST];
    difference_column(f, s, in, j, count, expected);
    for (int i = 0; i < count; i++)
      ck_assert_msg(fabs(derivative[i * s->size + j] - expected[i]) < 1e-11,
                    "%s of kind %d at |xi| = %g: (%d,%d) is %.15g, not %.15g", what,
                    (int)s->chart.kind, dvi__chart_angle(s->chart.kind, s->xi), i, j,
                    derivative[i * s->size + j], expected[i]);
  }
}

static void point_of(const scene *s, const double *xi, const double *rate, double *value)
{
  double v[9];
  dvi__chart_point(&s->chart, functions_at(s, xi), xi, rate, value, v);
}

static void velocity_of(const scene *s, const double *xi, const double *rate, double *value)
{
  double y[9];
  dvi__chart_point(&s->chart, functions_at(s, xi), xi, rate, y, value);
}

static void contraction_of(const scene *s, const double *xi, const double *rate, double *value)
{
  double y[9], v[9];
  dvi__chart_point(&s->chart, functions_at(s, xi), xi, rate, y, v);
  *value = 0;
  for (int i = 0; i < s->stored; i++) *value += s->a[i] * y[i] + s->b[i] * v[i];
}

static void in_xi_of(const scene *s, const double *xi, const double *rate, double *value)
{
  double unused[3];
  dvi__chart_gradient(&s->chart, functions_at(s, xi), xi, rate, s->a, s->b, value, unused);
}

static void in_rate_of(const scene *s, const double *xi, const double *rate, double *value)
{
  double unused[3];
  dvi__chart_gradient(&s->chart, functions_at(s, xi), xi, rate, s->a, s->b, unused, value);
}

static void momentum_of(const scene *s, const double *xi, const double *rate, double *value)
{
  (void)rate;
  dvi__chart_momentum(&s->chart, xi, s->a, value);
}

static void spin_of(const scene *s, const double *xi, const double *rate, double *value)
{
  double Omega[3];
  dvi__chart_leave_velocity(&s->chart, functions_at(s, xi), xi, rate, Omega);
  *value = s->a[0] * Omega[0] + s->a[1] * Omega[1] + s->a[2] * Omega[2];
}

static void spin_in_xi_of(const scene *s, const double *xi, const double *rate, double *value)
{
  double unused[3];
  dvi__chart_turning_gradient(functions_at(s, xi), xi, rate, s->a, value, unused);
}

START_TEST(derivatives_are_those_of_points)
{
  const scene s = set_scene(_i);
  double T[27], S[27], in_xi[9], in_rate[9], mixed[9];
  dvi__chart_tangents(&s.chart, functions_at(&s, s.xi), s.xi, s.rate, T, S);
  check_derivative(point_of, &s, IN_XI, s.stored, T, "T");
  check_derivative(velocity_of, &s, IN_XI, s.stored, S, "S");
  check_derivative(velocity_of, &s, IN_RATE, s.stored, T, "T as that of the rate");
  dvi__chart_gradient(&s.chart, functions_at(&s, s.xi), s.xi, s.rate, s.a, s.b, in_xi, in_rate);
  check_derivative(contraction_of, &s, IN_XI, 1, in_xi, "the gradient in xi");
  check_derivative(contraction_of, &s, IN_RATE, 1, in_rate, "the gradient in the rate");
  dvi__chart_curvature(&s.chart, functions_at(&s, s.xi), s.xi, s.rate, s.a, s.b, in_xi, mixed);
  check_derivative(in_xi_of, &s, IN_XI, s.size, in_xi, "the curvature");
  check_derivative(in_xi_of, &s, IN_RATE, s.size, mixed, "the mixed curvature");
  /* it is symmetric */
  check_derivative(in_rate_of, &s, IN_XI, s.size, mixed, "the mixed curvature");
}
END_TEST

/* The velocity is the derivative along the rate, and a stored velocity leads back to it. */
START_TEST(velocities_are_those_of_points)
{
  const scene s = set_scene(_i);
  double y[9], v[9], T[27], S[27], along[9] = {0}, stored[3];
  dvi__chart_point(&s.chart, functions_at(&s, s.xi), s.xi, s.rate, y, v);
  dvi__chart_tangents(&s.chart, functions_at(&s, s.xi), s.xi, s.rate, T, S);
  for (int i = 0; i < s.stored; i++)
    for (int j = 0; j < s.size; j++) along[i] += T[i * s.size + j] * s.rate[j];
  ck_assert_double_le(distance(s.stored, along, v), 1e-15 * 10);
  dvi__chart_leave_velocity(&s.chart, functions_at(&s, s.xi), s.xi, s.rate, stored);
  if (s.chart.kind == DVI__SPHERE) ck_assert_double_le(distance(3, stored, v), 1e-15);
  for (int j = 0; j < 3 && s.chart.kind == DVI__ROTATION; j++) { /* R' e_j = R (Omega x e_j) */
    double e[3] = {0}, turned[3], column[3], found[3];
    e[j] = 1;
    for (int i = 0; i < 3; i++)
      turned[i] = stored[(i + 1) % 3] * e[(i + 2) % 3] - stored[(i + 2) % 3] * e[(i + 1) % 3];
    for (int i = 0; i < 3; i++) {
      column[i] = y[3 * i] * turned[0] + y[3 * i + 1] * turned[1] + y[3 * i + 2] * turned[2];
      found[i] = v[3 * i + j];
    }
    ck_assert_double_le(distance(3, column, found), 1e-14);
  }
}
END_TEST

/* p.rate, the power of the momentum, is that of the angular momentum, and so is its derivative. */
START_TEST(momenta_are_those_of_turns)
{
  const scene s = set_scene(_i);
  double p[3], derivative[9];
  dvi__chart_momentum(&s.chart, s.xi, s.a, p);
  dvi__chart_momentum_derivative(&s.chart, s.xi, s.a, derivative);
  check_derivative(momentum_of, &s, IN_XI, s.size, derivative, "the momentum's derivative");
  if (s.chart.kind == DVI__ROTATION) return;
  double y[9], v[9], moment[3] = {0}, power = 0;
  dvi__chart_point(&s.chart, functions_at(&s, s.xi), s.xi, s.rate, y, v);
  dvi__chart_add_moment(DVI__SPHERE, y, v, moment);
  for (int i = 0; i < 3; i++) power += s.a[i] * moment[i];
  ck_assert_double_eq_tol(p[0] * s.rate[0] + p[1] * s.rate[1], power, 1e-14);
}
END_TEST

/* s.a is the momentum, s.rate the point to which it is carried. */
static void carried_of(const scene *s, const double *xi, const double *rate, double *value)
{
  dvi__chart_carry(&s->chart, xi, rate, s->a, value);
}

START_TEST(carried_momenta_keep_the_angular_momentum)
{
  const scene s = set_scene(_i);
  double in_f[9], in_xi[9], in_end[9], angular[3], there[3], carried[3], linear[3] = {0};
  /* opposite to the centre momenta are infinite, and differences say nothing */
  if (s.chart.kind == DVI__SPHERE && _i % LENGTHS == LENGTHS - 1) return;
  dvi__chart_carry_derivatives(&s.chart, s.xi, s.rate, s.a, in_f, in_xi, in_end);
  check_derivative(carried_of, &s, IN_XI, s.size, in_xi, "carried, in xi");
  check_derivative(carried_of, &s, IN_RATE, s.size, in_end, "carried, in the end");
  dvi__chart_carry(&s.chart, s.xi, s.rate, s.a, carried);
  for (int i = 0; i < s.size; i++)
    for (int j = 0; j < s.size; j++) linear[i] += in_f[s.size * i + j] * s.a[j];
  ck_assert_double_le(distance(s.size, linear, carried), 1e-13 * magnitude(s.size, carried));
  dvi__chart_carry(&s.chart, s.xi, s.xi, s.a, carried);
  ck_assert_double_le(distance(s.size, carried, s.a), 1e-13);
  if (s.chart.kind != DVI__SPHERE && s.chart.kind != DVI__ROTATION) return;
  dvi__chart_angular_momentum_at(&s.chart, s.xi, s.a, angular);
  dvi__chart_momentum(&s.chart, s.xi, angular, there);
  ck_assert_double_le(distance(s.size, there, s.a), 1e-13);
}
END_TEST

START_TEST(spins_have_their_derivatives)
{
  const scene s = set_scene(DVI__ROTATION * LENGTHS + _i);
  double in_xi[9], in_rate[9], mixed[9];
  dvi__chart_turning_gradient(functions_at(&s, s.xi), s.xi, s.rate, s.a, in_xi, in_rate);
  check_derivative(spin_of, &s, IN_XI, 1, in_xi, "the spin's gradient in xi");
  check_derivative(spin_of, &s, IN_RATE, 1, in_rate, "the spin's gradient in the rate");
  dvi__chart_turning_curvature(functions_at(&s, s.xi), s.xi, s.rate, s.a, in_xi, mixed);
  check_derivative(spin_in_xi_of, &s, IN_XI, 3, in_xi, "the spin's curvature");
  check_derivative(spin_in_xi_of, &s, IN_RATE, 3, mixed, "the spin's mixed curvature");
}
END_TEST

/* Rotations have their digits up to half a turn. A direction close to the opposite one has only the
 * digits of its angle around it. */
START_TEST(points_are_found_again)
{
  scene s = set_scene(_i * LENGTHS);
  static const double far[] = {1e-9, 0.5, 3.0, 3.14159265258979};
  for (int k = 0; k < 4; k++) {
    double y[9], found[3];
    const double norm = dvi__chart_angle(s.chart.kind, s.xi);
    for (int i = 0; i < s.size; i++) s.xi[i] *= far[k] / norm;
    dvi__chart_place(&s.chart, s.xi, y);
    dvi__chart_inverse(&s.chart, y, found);
    const double lost = s.chart.kind == DVI__SPHERE && far[k] > 1 ? 1 / sin(far[k]) : 1;
    ck_assert_msg(distance(s.size, s.xi, found) < 2e-15 * lost, "kind %d at %g: %.1e", _i, far[k],
                  distance(s.size, s.xi, found));
  }
}
END_TEST

/* a.dy = w.moment for dy = w x y of all columns, and of a direction. */
START_TEST(moments_are_those_of_turns)
{
  const dvi__chart_kind kind = _i == 0 ? DVI__SPHERE : DVI__ROTATION;
  const scene s = set_scene((int)kind * LENGTHS);
  const double w[] = {3e-4, -1e-4, 2e-4};
  double E[9], moment[3] = {0}, by_moment = 0, by_change = 0;
  const int columns = s.stored / 3;
  dvi_so3_exp(w, E);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < columns; j++) {
      double moved = 0;
      for (int l = 0; l < 3; l++) moved += E[3 * i + l] * s.chart.y0[l * columns + j];
      by_change += s.a[i * columns + j] * (moved - s.chart.y0[i * columns + j]);
    }
  dvi__chart_add_moment(kind, s.chart.y0, s.a, moment);
  for (int i = 0; i < 3; i++) by_moment += moment[i] * w[i];
  ck_assert_double_eq_tol(by_moment, by_change, 4e-7); /* |w|^2 */
}
END_TEST

SUITE(chart)
{
  tcase_add_loop_test(tests, carried_momenta_keep_the_angular_momentum, 0, KINDS * LENGTHS);
  tcase_add_loop_test(tests, derivatives_are_those_of_points, 0, KINDS * LENGTHS);
  tcase_add_loop_test(tests, velocities_are_those_of_points, 0, KINDS * LENGTHS);
  tcase_add_loop_test(tests, momenta_are_those_of_turns, DVI__SPHERE * LENGTHS, KINDS * LENGTHS);
  tcase_add_loop_test(tests, spins_have_their_derivatives, 0, LENGTHS);
  tcase_add_loop_test(tests, points_are_found_again, 0, KINDS);
  tcase_add_loop_test(tests, moments_are_those_of_turns, 0, 2);
}
