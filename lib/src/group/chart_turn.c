/* Rotations of space acting on a rotation or a direction, and the angular momentum. */
#include <dvi/group.h>
#include <string.h>

#include "group/chart_functions.h"
#include "group/stumpff.h"
#include "group/vector.h"
#include "num/compensated.h"

/* Count the vectors in a stored point, which are the columns of a rotation or the direction
 * itself. */
static int vectors_of(dvi__chart_kind kind)
{
  return kind == DVI__ROTATION ? 3 : 1;
}

static void get_vector(const double *y, int vectors, int j, double *x)
{
  for (int i = 0; i < 3; i++) x[i] = y[i * vectors + j];
}

void dvi__chart_add_moment(dvi__chart_kind kind, const double *y, const double *a, double *moment)
{
  const int vectors = vectors_of(kind);
  for (int j = 0; j < vectors; j++) {
    double x[3], f[3], product[3];
    get_vector(y, vectors, j, x);
    get_vector(a, vectors, j, f);
    dvi__cross(x, f, product);
    for (int i = 0; i < 3; i++) moment[i] += product[i];
  }
}

void dvi__chart_angular_momentum(const dvi__chart *chart, const double *p, double *angular)
{
  double stored[3];
  dvi__chart_store(chart, p, stored);
  if (chart->kind == DVI__SPHERE)
    dvi__cross(chart->y0, stored, angular);
  else
    memcpy(angular, stored, sizeof stored);
}

void dvi__chart_add_impulse(const dvi__chart *chart, const double *impulse, double *angular)
{
  const double *R = chart->y0;
  for (int j = 0; j < 3; j++)
    angular[j] += chart->kind == DVI__ROTATION
                      ? R[j] * impulse[0] + R[3 + j] * impulse[1] + R[6 + j] * impulse[2]
                      : impulse[j];
}

/* Compute p_j = T_j.(angular x y) of a direction, T_j = c_1 B_j + xi_j ((c_3 - c_2) B xi - c_1
 * y0). */
static void direction_momentum(const dvi__chart *chart, const double c[4], const double *xi,
                               const double *angular, double *p)
{
  double x[3], y[3], P[3];
  dvi__chart_lift(chart, xi, x);
  for (int i = 0; i < 3; i++) y[i] = c[0] * chart->y0[i] + c[1] * x[i];
  dvi__cross(angular, y, P);
  const double along = (c[3] - c[2]) * dvi__dot(x, P) - c[1] * dvi__dot(chart->y0, P);
  for (int j = 0; j < 2; j++) p[j] = c[1] * dvi__dot(chart->basis[j], P) + along * xi[j];
}

/* A turn by w of R0 exp(xi) in the centre's frame moves xi by d xi with dexp_xi d xi = w. So
 * p = dexp_xi^T angular = dexp_{-xi} angular. */
void dvi__chart_momentum(const dvi__chart *chart, const double *xi, const double *angular,
                         double *p)
{
  double c[4];
  dvi__stumpff_four(dvi__inner(dvi__chart_size(chart->kind), xi, xi), c);
  if (chart->kind == DVI__ROTATION)
    dvi__about(xi, -c[2], c[3], angular, p);
  else
    direction_momentum(chart, c, xi, angular, p);
}

static void carry_direction(const dvi__chart *chart, const double *xi, const double *added,
                            double *y, double *y_compensation, double *p, double *p_compensation)
{
  dvi__twofold mu[3];
  dvi__turn_angular(y, y_compensation, p, p_compensation, mu);
  for (int i = 0; i < 3; i++) mu[i] = dvi__twofold_sum(mu[i], (dvi__twofold){added[i], 0});
  dvi__chart_move(chart, xi, y, y_compensation);
  dvi__turn_momentum(mu, dvi__dot(added, added) == 0 ? DVI__TURN_ANY : DVI__TURN_ROUNDINGS, y,
                     y_compensation, p, p_compensation);
}

void dvi__chart_transport(const dvi__chart *chart, const double *xi, const double *added, double *y,
                          double *y_compensation, double *p, double *p_compensation)
{
  if (chart->kind == DVI__SPHERE) {
    carry_direction(chart, xi, added, y, y_compensation, p, p_compensation);
    return;
  }
  const dvi__turn turn = dvi__chart_turn(chart, xi);
  dvi__add_compensated_all(3, p, p_compensation, added);
  dvi__turn_rows(&turn, 9, y, y_compensation);
  dvi__turn_rows(&turn, 3, p, p_compensation);
}

void dvi__chart_moments(const dvi__chart *chart, const double *xi, double *W)
{
  for (int k = 0; k < 3; k++) {
    double e[3] = {0}, impulse[3] = {0}, column[3] = {0};
    e[k] = 1;
    dvi__chart_add_impulse(chart, e, impulse);
    dvi__chart_momentum(chart, xi, impulse, column);
    for (int j = 0; j < dvi__chart_size(chart->kind); j++) W[3 * j + k] = column[j];
  }
}

void dvi__chart_momentum_derivative(const dvi__chart *chart, const double *xi,
                                    const double *angular, double *derivative)
{
  if (chart->kind == DVI__ROTATION) {
    dvi_so3_velocity_derivative(xi, angular, derivative);
    return;
  }
  const double rest[2] = {0}, none[3] = {0};
  double y[3], v[3], T[6], S[6], covector[3], unused[4];
  dvi__functions c;
  dvi__chart_functions(chart->kind, xi, &c);
  dvi__chart_point(chart, &c, xi, rest, y, v);
  dvi__chart_tangents(chart, &c, xi, rest, T, S);
  dvi__cross(angular, y, covector);
  dvi__chart_curvature(chart, &c, xi, rest, covector, none, derivative, unused);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      double turned[3];
      dvi__cross(angular, (const double[]){T[j], T[2 + j], T[4 + j]}, turned);
      for (int k = 0; k < 3; k++) derivative[2 * i + j] += turned[k] * T[2 * k + i];
    }
}
