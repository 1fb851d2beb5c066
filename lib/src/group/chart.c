#include "group/chart.h"

#include <dvi/group.h>
#include <math.h>
#include <string.h>

#include "group/chart_functions.h"
#include "group/stumpff.h"
#include "group/vector.h"
#include "num/compensated.h"

double dvi__chart_bound(dvi__chart_kind kind)
{
  return kind == DVI__LINE ? HUGE_VAL : 3.14159265358979323846;
}

double dvi__chart_angle(dvi__chart_kind kind, const double *xi)
{
  return sqrt(dvi__inner(dvi__chart_size(kind), xi, xi));
}

/* The derivatives follow from d c_k / ds = (k c_{k+2} - c_{k+1}) / 2. */
void dvi__chart_functions(dvi__chart_kind kind, const double *xi, dvi__functions *c)
{
  const int size = dvi__chart_size(kind);
  double derivative[9];
  *c = (dvi__functions){{{0}}};
  if (kind == DVI__LINE) return;
  dvi__stumpff(dvi__inner(size, xi, xi), derivative);
  for (int j = 0; j < 4; j++) {
    for (int k = 0; k < 4 && k + 2 * j < 9; k++) c->of[k][j] = derivative[k];
    for (int k = 0; k + 2 * (j + 1) < 9; k++)
      derivative[k] = 0.5 * (k * derivative[k + 2] - derivative[k + 1]);
  }
}

/* ---- matrices ---- */

/* out = R0 E. */
static void multiply_rotation(const double *R0, const double *E, double *out)
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      out[3 * i + j] = R0[3 * i] * E[j] + R0[3 * i + 1] * E[3 + j] + R0[3 * i + 2] * E[6 + j];
}

/* E += a^ */
static void add_hat(const double *a, double *E)
{
  E[1] -= a[2], E[2] += a[1], E[5] -= a[0];
  E[3] += a[2], E[6] -= a[1], E[7] += a[0];
}

/* ---- centre ---- */

/* Find a basis that is orthonormal and orthogonal to y0 even where rounding has made y0 longer or
 * shorter than 1. Otherwise the losses of all steps would add up. Source: Duff et al. 2017. */
static void find_basis(const double *y0, double basis[2][3])
{
  const double length = sqrt(dvi__dot(y0, y0)), x = y0[0] / length, y = y0[1] / length,
               z = y0[2] / length;
  const double sign = copysign(1, z), a = -1 / (sign + z), b = x * y * a;
  const double first[] = {1 + sign * x * x * a, sign * b, -sign * x},
               second[] = {b, sign + y * y * a, -y};
  memcpy(basis[0], first, sizeof first);
  memcpy(basis[1], second, sizeof second);
}

void dvi__chart_centre(dvi__chart_kind kind, const double *y0, dvi__chart *chart)
{
  memset(chart, 0, sizeof *chart);
  chart->kind = kind;
  memcpy(chart->y0, y0, (size_t)dvi__chart_stored(kind) * sizeof *y0);
  if (kind == DVI__CIRCLE) {
    chart->basis[0][0] = -y0[1];
    chart->basis[0][1] = y0[0];
  }
  if (kind == DVI__SPHERE) find_basis(y0, chart->basis);
}

void dvi__chart_lift(const dvi__chart *chart, const double *x, double *out)
{
  const int stored = dvi__chart_stored(chart->kind), size = dvi__chart_size(chart->kind);
  for (int i = 0; i < stored; i++) {
    out[i] = 0;
    for (int j = 0; j < size; j++) out[i] += chart->basis[j][i] * x[j];
  }
}

/* ---- points ---- */

/* Add factor ((a b^T + b a^T) - 2 a.b I), which is factor (a^ b^ + b^ a^). */
static void add_squares(double factor, const double *a, const double *b, double *E)
{
  dvi__add_outer(3, factor, a, b, E);
  dvi__add_identity(3, -2 * factor * dvi__dot(a, b), E);
}

static void rotation_point(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                           const double *rate, double *y, double *v)
{
  double E[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, a[3];
  const double sigma = dvi__dot(xi, rate);
  for (int i = 0; i < 3; i++) a[i] = c->of[1][0] * xi[i];
  add_hat(a, E);
  add_squares(0.5 * c->of[2][0], xi, xi, E);
  multiply_rotation(chart->y0, E, y);
  memset(E, 0, sizeof E);
  for (int i = 0; i < 3; i++) a[i] = c->of[1][0] * rate[i] + 2 * sigma * c->of[1][1] * xi[i];
  add_hat(a, E);
  add_squares(c->of[2][0], xi, rate, E);
  add_squares(sigma * c->of[2][1], xi, xi, E);
  multiply_rotation(chart->y0, E, v);
}

static void sphere_point(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                         const double *rate, double *y, double *v)
{
  const int stored = dvi__chart_stored(chart->kind), size = dvi__chart_size(chart->kind);
  double x[3], w[3];
  dvi__chart_lift(chart, xi, x);
  for (int i = 0; i < stored; i++) y[i] = c->of[0][0] * chart->y0[i] + c->of[1][0] * x[i];
  const double sigma = dvi__inner(size, xi, rate);
  dvi__chart_lift(chart, rate, w);
  for (int i = 0; i < stored; i++)
    v[i] = 2 * sigma * (c->of[0][1] * chart->y0[i] + c->of[1][1] * x[i]) + c->of[1][0] * w[i];
}

void dvi__chart_point(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                      const double *rate, double *y, double *v)
{
  if (chart->kind == DVI__LINE) {
    *y = *chart->y0 + *xi;
    *v = *rate;
  } else if (chart->kind == DVI__ROTATION) {
    rotation_point(chart, c, xi, rate, y, v);
  } else {
    sphere_point(chart, c, xi, rate, y, v);
  }
}

void dvi__chart_place(const dvi__chart *chart, const double *xi, double *y)
{
  static const double rest[DVI__CHART_SIZE] = {0};
  double v[DVI__CHART_POINT];
  dvi__functions c;
  if (chart->kind == DVI__ROTATION) {
    double E[9];
    dvi_so3_exp(xi, E);
    multiply_rotation(chart->y0, E, y);
    return;
  }
  dvi__chart_functions(chart->kind, xi, &c);
  dvi__chart_point(chart, &c, xi, rest, y, v);
}

dvi__turn dvi__chart_turn(const dvi__chart *chart, const double *xi)
{
  double w[3] = {0};
  if (chart->kind == DVI__ROTATION) memcpy(w, xi, sizeof w);
  if (chart->kind == DVI__CIRCLE) w[2] = -*xi;
  if (chart->kind == DVI__SPHERE) {
    double x[3];
    dvi__chart_lift(chart, xi, x);
    dvi__cross(x, chart->y0, w);
  }
  dvi__turn_tangent(w, w);
  return dvi__turn_of(w);
}

void dvi__chart_displacement(const dvi__chart *chart, const double *xi, double *displacement)
{
  const int stored = dvi__chart_stored(chart->kind);
  if (chart->kind == DVI__LINE) {
    *displacement = *xi;
    return;
  }
  const dvi__turn turn = dvi__chart_turn(chart, xi);
  for (int i = 0; i < stored; i += 3) {
    double change[3];
    dvi__turn_change(&turn, chart->y0 + i, change);
    memcpy(displacement + i, change, (size_t)(stored < 3 ? stored : 3) * sizeof *displacement);
  }
}

void dvi__chart_move(const dvi__chart *chart, const double *xi, double *y, double *compensation)
{
  if (chart->kind == DVI__LINE) {
    dvi__add_compensated(y, compensation, *xi);
    return;
  }
  const dvi__turn turn = dvi__chart_turn(chart, xi);
  dvi__turn_rows(&turn, dvi__chart_stored(chart->kind), y, compensation);
}

/* ---- tangents ---- */

/* Columns j of T and S are R0 E with these matrices E. */
static void rotation_tangent(const dvi__functions *c, const double *xi, const double *rate, int j,
                             double *T, double *S)
{
  const double sigma = dvi__dot(xi, rate);
  double e[3] = {0}, a[3];
  e[j] = 1;
  for (int i = 0; i < 3; i++) a[i] = c->of[1][0] * e[i] + 2 * xi[j] * c->of[1][1] * xi[i];
  add_hat(a, T);
  add_squares(c->of[2][0], xi, e, T);
  add_squares(xi[j] * c->of[2][1], xi, xi, T);
  for (int i = 0; i < 3; i++)
    a[i] = 2 * c->of[1][1] * (xi[j] * rate[i] + sigma * e[i] + rate[j] * xi[i]) +
           4 * c->of[1][2] * xi[j] * sigma * xi[i];
  add_hat(a, S);
  add_squares(c->of[2][0], rate, e, S);
  add_squares(2 * c->of[2][1] * xi[j], xi, rate, S);
  add_squares(2 * c->of[2][1] * sigma, xi, e, S);
  add_squares(c->of[2][1] * rate[j] + 2 * c->of[2][2] * xi[j] * sigma, xi, xi, S);
}

static void sphere_tangent(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                           const double *rate, int j, double *T, double *S)
{
  const int stored = dvi__chart_stored(chart->kind), size = dvi__chart_size(chart->kind);
  const double sigma = dvi__inner(size, xi, rate), *e = chart->basis[j];
  double x[3], w[3];
  dvi__chart_lift(chart, xi, x);
  dvi__chart_lift(chart, rate, w);
  for (int i = 0; i < stored; i++) {
    T[i] = 2 * xi[j] * (c->of[0][1] * chart->y0[i] + c->of[1][1] * x[i]) + c->of[1][0] * e[i];
    S[i] = (2 * c->of[0][1] * rate[j] + 4 * c->of[0][2] * xi[j] * sigma) * chart->y0[i] +
           2 * c->of[1][1] * (xi[j] * w[i] + sigma * e[i] + rate[j] * x[i]) +
           4 * c->of[1][2] * xi[j] * sigma * x[i];
  }
}

void dvi__chart_tangents(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                         const double *rate, double *T, double *S)
{
  if (chart->kind == DVI__LINE) {
    *T = 1;
    *S = 0;
    return;
  }
  const int stored = dvi__chart_stored(chart->kind), size = dvi__chart_size(chart->kind);
  for (int j = 0; j < size; j++) {
    double column[2][9] = {{0}};
    if (chart->kind == DVI__ROTATION) {
      double turned[2][9];
      rotation_tangent(c, xi, rate, j, column[0], column[1]);
      multiply_rotation(chart->y0, column[0], turned[0]);
      multiply_rotation(chart->y0, column[1], turned[1]);
      memcpy(column, turned, sizeof column);
    } else {
      sphere_tangent(chart, c, xi, rate, j, column[0], column[1]);
    }
    for (int i = 0; i < stored; i++) {
      T[i * size + j] = column[0][i];
      S[i * size + j] = column[1][i];
    }
  }
}

/* ---- from chart to chart ---- */

/* Find xi of the rotation R0^T R. */
static void rotation_inverse(const double *R0, const double *R, double *xi)
{
  double E[9];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      E[3 * i + j] = R0[i] * R[j] + R0[3 + i] * R[3 + j] + R0[6 + i] * R[6 + j];
  memset(xi, 0, 3 * sizeof *xi); /* the matrix is no rotation */
  (void)dvi_so3_log(E, xi);
}

static void sphere_inverse(const dvi__chart *chart, const double *y, double *xi)
{
  double tangent[3];
  dvi_s2_log(chart->y0, y, tangent);
  for (int j = 0; j < 2; j++) xi[j] = dvi__dot(chart->basis[j], tangent);
}

void dvi__chart_inverse(const dvi__chart *chart, const double *y, double *xi)
{
  switch (chart->kind) {
  case DVI__LINE: *xi = *y - *chart->y0; return;
  case DVI__CIRCLE:
    *xi = atan2(dvi__inner(2, chart->basis[0], y), dvi__inner(2, chart->y0, y));
    return;
  case DVI__SPHERE: sphere_inverse(chart, y, xi); return;
  case DVI__ROTATION: rotation_inverse(chart->y0, y, xi); return;
  }
}

/* Find log(exp(-end) exp(xi)) by the product of the two quaternions. */
static void rotation_between(const double *end, const double *xi, double *eta)
{
  double a[4], b[4], normal[3];
  dvi__stumpff_four(0.25 * dvi__dot(end, end), a);
  dvi__stumpff_four(0.25 * dvi__dot(xi, xi), b);
  const double back = 0.5 * a[1], on = 0.5 * b[1],
               real = a[0] * b[0] + back * on * dvi__dot(end, xi);
  dvi__cross(end, xi, normal);
  for (int i = 0; i < 3; i++)
    eta[i] = on * a[0] * xi[i] - back * b[0] * end[i] - back * on * normal[i];
  const double sine = sqrt(dvi__dot(eta, eta)), sign = real < 0 ? -1 : 1,
               ratio = sine > 0 ? 2 * atan2(sine, sign * real) / sine : 2;
  for (int i = 0; i < 3; i++) eta[i] *= sign * ratio;
}

void dvi__chart_follow(const dvi__chart *chart, const dvi__chart *next, const double *end,
                       const double *xi, double *eta)
{
  double y[3];
  if (chart->kind == DVI__ROTATION) {
    rotation_between(end, xi, eta);
  } else if (chart->kind == DVI__SPHERE) {
    dvi__chart_place(chart, xi, y);
    sphere_inverse(next, y, eta);
  } else {
    *eta = *xi - *end;
  }
}

/* On a great circle this is the direction of the path at its end. */
void dvi__chart_back(const dvi__chart *chart, const dvi__chart *next, const double *end,
                     double *eta)
{
  double c[4], x[3];
  for (int i = 0; i < dvi__chart_size(chart->kind); i++) eta[i] = -end[i];
  if (chart->kind != DVI__SPHERE) return;
  const double square = dvi__inner(2, end, end);
  dvi__stumpff_four(square, c);
  dvi__chart_lift(chart, end, x);
  for (int i = 0; i < 3; i++) x[i] = square * c[1] * chart->y0[i] - c[0] * x[i];
  for (int j = 0; j < 2; j++) eta[j] = dvi__dot(next->basis[j], x);
}

void dvi__chart_enter(const dvi__chart *chart, const double *stored, double *local)
{
  if (chart->kind != DVI__SPHERE) {
    memcpy(local, stored, (size_t)dvi__chart_size(chart->kind) * sizeof *local);
    return;
  }
  for (int j = 0; j < 2; j++) local[j] = dvi__dot(chart->basis[j], stored);
}

void dvi__chart_store(const dvi__chart *chart, const double *local, double *stored)
{
  if (chart->kind == DVI__SPHERE)
    dvi__chart_lift(chart, local, stored);
  else
    memcpy(stored, local, (size_t)dvi__chart_size(chart->kind) * sizeof *stored);
}

void dvi__chart_leave_velocity(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                               const double *rate, double *stored)
{
  if (chart->kind == DVI__SPHERE) {
    double y[3];
    dvi__chart_point(chart, c, xi, rate, y, stored);
  } else if (chart->kind == DVI__ROTATION) {
    dvi__about(xi, -c->of[2][0], c->of[3][0], rate, stored); /* dexp_{-xi} rate */
  } else {
    *stored = *rate;
  }
}
