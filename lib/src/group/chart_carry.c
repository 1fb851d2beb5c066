/* Momenta of a chart's different points that have the same angular momentum mu.
 *
 * With the momentum f = M(xi) mu of the chart (dvi__chart_momentum), E = M(end) M(xi)^+. On a
 * sphere mu is orthogonal to y(xi), so that the solution of M mu = f of least length is the one,
 *
 *     mu = M^T (M M^T)^-1 f,     d mu = M^+ (df - dM mu) - y (dy.mu). */
#include <string.h>

#include "group/chart_functions.h"
#include "group/vector.h"

/* Compute M [size*3]. */
static void momentum_matrix(const dvi__chart *chart, const double *xi, double *M)
{
  for (int k = 0; k < 3; k++) {
    double e[3] = {0}, column[3];
    e[k] = 1;
    dvi__chart_momentum(chart, xi, e, column);
    for (int i = 0; i < dvi__chart_size(chart->kind); i++) M[3 * i + k] = column[i];
  }
}

/* Solve A x = b by Cramer's rule, with A [size*size] of two or three rows. */
static void solve_small(int size, const double *A, const double *b, double *x)
{
  if (size == 2) {
    const double determinant = A[0] * A[3] - A[1] * A[2];
    x[0] = (b[0] * A[3] - b[1] * A[1]) / determinant;
    x[1] = (A[0] * b[1] - A[2] * b[0]) / determinant;
    return;
  }
  double cofactors[9];
  for (int i = 0; i < 3; i++)
    dvi__cross(A + 3 * ((i + 1) % 3), A + 3 * ((i + 2) % 3), cofactors + 3 * i);
  const double determinant = dvi__dot(A, cofactors);
  for (int j = 0; j < 3; j++)
    x[j] = (b[0] * cofactors[j] + b[1] * cofactors[3 + j] + b[2] * cofactors[6 + j]) / determinant;
}

/* Compute M^+ f. */
static void least_solution(int size, const double *M, const double *f, double *mu)
{
  double square[9] = {0}, weight[3] = {0};
  for (int i = 0; i < size; i++)
    for (int j = 0; j < size; j++) square[size * i + j] = dvi__dot(M + 3 * i, M + 3 * j);
  solve_small(size, square, f, weight);
  for (int k = 0; k < 3; k++) {
    mu[k] = 0;
    for (int i = 0; i < size; i++) mu[k] += M[3 * i + k] * weight[i];
  }
}

static int carries(const dvi__chart *chart)
{
  return chart->kind == DVI__SPHERE || chart->kind == DVI__ROTATION;
}

void dvi__chart_angular_momentum_at(const dvi__chart *chart, const double *xi, const double *p,
                                    double *angular)
{
  const int size = dvi__chart_size(chart->kind);
  double M[9] = {0};
  momentum_matrix(chart, xi, M);
  if (chart->kind == DVI__ROTATION)
    solve_small(size, M, p, angular);
  else
    least_solution(size, M, p, angular);
}

void dvi__chart_carry(const dvi__chart *chart, const double *xi, const double *end, const double *f,
                      double *carried)
{
  double mu[3];
  if (!carries(chart)) {
    memcpy(carried, f, (size_t)dvi__chart_size(chart->kind) * sizeof *f);
    return;
  }
  dvi__chart_angular_momentum_at(chart, xi, f, mu);
  dvi__chart_momentum(chart, end, mu, carried);
}

/* Compute -y (dy.mu) of a direction for each coordinate, added to the columns of d mu [size][3]. */
static void turn_with_direction(const dvi__chart *chart, const double *xi, const double *mu,
                                double change[][3])
{
  static const double rest[2] = {0};
  double y[3], v[3], T[6], S[6];
  dvi__functions c;
  dvi__chart_functions(chart->kind, xi, &c);
  dvi__chart_point(chart, &c, xi, rest, y, v);
  dvi__chart_tangents(chart, &c, xi, rest, T, S);
  for (int j = 0; j < 2; j++)
    for (int k = 0; k < 3; k++)
      change[j][k] -= y[k] * (T[j] * mu[0] + T[2 + j] * mu[1] + T[4 + j] * mu[2]);
}

/* Write M(end) times vectors as the columns of a matrix [size*size]. */
static void carry_columns(const dvi__chart *chart, const double *end, double vector[][3],
                          double *matrix)
{
  const int size = dvi__chart_size(chart->kind);
  for (int j = 0; j < size; j++) {
    double column[3];
    dvi__chart_momentum(chart, end, vector[j], column);
    for (int i = 0; i < size; i++) matrix[size * i + j] = column[i];
  }
}

void dvi__chart_carry_derivatives(const dvi__chart *chart, const double *xi, const double *end,
                                  const double *f, double *in_f, double *in_xi, double *in_end)
{
  const int size = dvi__chart_size(chart->kind);
  double M[9] = {0}, mu[3], dM[9], by_f[3][3] = {{0}}, by_xi[3][3] = {{0}};
  memset(in_xi, 0, (size_t)(size * size) * sizeof *in_xi);
  memset(in_end, 0, (size_t)(size * size) * sizeof *in_end);
  memset(in_f, 0, (size_t)(size * size) * sizeof *in_f);
  if (!carries(chart)) {
    dvi__add_identity(size, 1, in_f);
    return;
  }
  momentum_matrix(chart, xi, M);
  least_solution(size, M, f, mu);
  dvi__chart_momentum_derivative(chart, xi, mu, dM);
  for (int j = 0; j < size; j++) {
    double e[3] = {0}, column[3];
    e[j] = 1;
    for (int i = 0; i < size; i++) column[i] = -dM[size * i + j];
    least_solution(size, M, e, by_f[j]);
    least_solution(size, M, column, by_xi[j]);
  }
  if (chart->kind == DVI__SPHERE) turn_with_direction(chart, xi, mu, by_xi);
  carry_columns(chart, end, by_f, in_f);
  carry_columns(chart, end, by_xi, in_xi);
  dvi__chart_momentum_derivative(chart, end, mu, in_end);
}
