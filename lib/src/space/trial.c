#include "space/trial.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "space/quadrature.h"

static void round_difference(int degree, const long double *a, const long double *b, double *out)
{
  if (!out) return;
  for (int k = 1; k <= degree; k++) out[k - 1] = (double)(a[k] - b[k]);
}

void dvi__trial_in(const dvi__space *space, long double tau, double *psi, double *bar, double *dpsi)
{
  const long double zero[DVI__TRIAL_MAX] = {0};
  long double value[DVI__TRIAL_MAX], derivative[DVI__TRIAL_MAX], at_end[DVI__TRIAL_MAX];
  dvi__space_evaluate(space, tau, value, derivative);
  round_difference(space->degree, derivative, zero, dpsi);
  if (psi != NULL) dvi__space_evaluate(space, 0, at_end, NULL);
  round_difference(space->degree, value, at_end, psi);
  if (bar != NULL) dvi__space_evaluate(space, 1, at_end, NULL);
  round_difference(space->degree, value, at_end, bar);
}

void dvi__trial_at_long(dvi_basis basis, int degree, long double tau, double *psi, double *bar,
                        double *dpsi)
{
  dvi__space space;
  dvi__space_init(&space, basis, degree);
  dvi__trial_in(&space, tau, psi, bar, dpsi);
}

void dvi__trial_at(dvi_basis basis, int degree, double tau, double *psi, double *bar, double *dpsi)
{
  dvi__trial_at_long(basis, degree, (long double)tau, psi, bar, dpsi);
}

/* A rule by which a basis reads its coefficients from a polynomial r that vanishes at 0,
 * Y_k = sum_j matrix[k-1][j] r(point[j]).
 *
 * Nodal bases take r(node_k) - r(node_0), for sum_k phi_k(0) r(node_k) = 0. Modal bases take the
 * orthogonal expansion, by the quadrature that is exact for it (Gauss, and for Chebyshev the zeros
 * of T_{degree+1} with equal weights). */
typedef struct reading {
  long double point[DVI__TRIAL_MAX];
  long double matrix[DVI_DEGREE_MAX][DVI__TRIAL_MAX];
} reading;

static void read_nodal(const dvi__space *space, reading *to)
{
  memset(to->matrix, 0, sizeof to->matrix);
  for (int k = 0; k <= space->degree; k++) to->point[k] = space->mark[k] / space->scale;
  for (int k = 1; k <= space->degree; k++) {
    to->matrix[k - 1][k] = 1;
    to->matrix[k - 1][0] = -1;
  }
}

static void read_modal(const dvi__space *space, reading *to)
{
  const int points = space->degree + 1;
  long double weight[DVI__TRIAL_MAX], value[DVI__TRIAL_MAX];
  (void)dvi__quadrature_long(DVI_GAUSS, points, to->point, weight);
  for (int j = 0; j < points; j++) {
    if (space->basis == DVI_CHEBYSHEV) {
      const long double sine = sinl(atanl(1) * (long double)(2 * j + 1) / (long double)points);
      to->point[j] = sine * sine;
    }
    dvi__space_evaluate(space, to->point[j], value, NULL);
    for (int k = 1; k < points; k++)
      to->matrix[k - 1][j] = value[k] * (space->basis == DVI_CHEBYSHEV
                                             ? 2 / (long double)points
                                             : (long double)(2 * k + 1) * weight[j]);
  }
}

static void read_coefficients(const dvi__space *space, reading *to)
{
  (dvi__basis_is_nodal(space->basis) ? read_nodal : read_modal)(space, to);
}

/* Compute primitive[m], the integral of P_m from `from` to `to`, m < count. The primitives are
 * (P_{m+1} - P_{m-1}) / (2 (2m+1)). */
static void integrate_legendre(int count, long double from, long double to, long double *primitive)
{
  dvi__space space;
  long double lower[DVI__TRIAL_MAX], upper[DVI__TRIAL_MAX];
  dvi__space_init(&space, DVI_LEGENDRE, count);
  dvi__space_evaluate(&space, from, lower, NULL);
  dvi__space_evaluate(&space, to, upper, NULL);
  primitive[0] = to - from;
  for (int m = 1; m < count; m++)
    primitive[m] = ((upper[m + 1] - lower[m + 1]) - (upper[m - 1] - lower[m - 1])) /
                   (long double)(2 * (2 * m + 1));
}

/* Compute expansion[m][l-1], coefficient m of psi_l' in Legendre functions, m < count. */
static void expand_derivatives(const dvi__space *space, int count,
                               long double expansion[][DVI_DEGREE_MAX])
{
  const int degree = space->degree;
  dvi__space legendre;
  long double node[DVI_DEGREE_MAX], weight[DVI_DEGREE_MAX], P[DVI__TRIAL_MAX],
      derivative[DVI__TRIAL_MAX];
  dvi__space_init(&legendre, DVI_LEGENDRE, degree);
  (void)dvi__quadrature_long(DVI_GAUSS, degree, node, weight);
  for (int m = 0; m < count; m++) memset(expansion[m], 0, sizeof expansion[m]);
  for (int i = 0; i < degree; i++) {
    dvi__space_evaluate(&legendre, node[i], P, NULL);
    dvi__space_evaluate(space, node[i], NULL, derivative);
    for (int m = 0; m < count; m++)
      for (int l = 0; l < degree; l++)
        expansion[m][l] += (long double)(2 * m + 1) * weight[i] * P[m] * derivative[l + 1];
  }
}

static void apply_reading(const reading *read, int degree, const long double *values,
                          long double *coefficients)
{
  for (int k = 0; k < degree; k++) {
    coefficients[k] = 0;
    for (int j = 0; j <= degree; j++) coefficients[k] += read->matrix[k][j] * values[j];
  }
}

void dvi__trial_shift(dvi_basis basis, int degree, int keep, double ratio, double *shift)
{
  dvi__space space;
  reading read;
  long double expansion[DVI_DEGREE_MAX][DVI_DEGREE_MAX], primitive[DVI__TRIAL_MAX][DVI_DEGREE_MAX];
  long double values[DVI__TRIAL_MAX], coefficients[DVI_DEGREE_MAX];
  dvi__space_init(&space, basis, degree);
  read_coefficients(&space, &read);
  expand_derivatives(&space, keep, expansion);
  for (int j = 0; j <= degree; j++)
    integrate_legendre(keep, 1, 1 + (long double)ratio * read.point[j], primitive[j]);
  for (int l = 0; l < degree; l++) {
    for (int j = 0; j <= degree; j++) {
      values[j] = 0;
      for (int m = 0; m < keep; m++) values[j] += primitive[j][m] * expansion[m][l];
    }
    apply_reading(&read, degree, values, coefficients);
    for (int k = 0; k < degree; k++) shift[k * degree + l] = (double)coefficients[k];
  }
}

/* A least-squares problem. columns[m][i] belongs to point i. The columns are orthogonalised in
 * place, so that old columns = new columns times R. */
typedef struct columns {
  int count, points;
  long double column[DVI_DEGREE_MAX][DVI_QUADRATURE_MAX];
  long double R[DVI_DEGREE_MAX][DVI_DEGREE_MAX];
} columns;

static long double column_product(int count, const long double *a, const long double *b)
{
  long double sum = 0;
  for (int i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

/* Orthogonalise by modified Gram-Schmidt, each column twice, to roundoff. */
static void orthogonalize_columns(columns *c)
{
  for (int m = 0; m < c->count; m++) {
    long double *column = c->column[m];
    for (int k = 0; k < m; k++) c->R[k][m] = 0;
    for (int pass = 0; pass < 2; pass++)
      for (int k = 0; k < m; k++) {
        const long double along = column_product(c->points, c->column[k], column);
        for (int i = 0; i < c->points; i++) column[i] -= along * c->column[k][i];
        c->R[k][m] += along;
      }
    c->R[m][m] = sqrtl(column_product(c->points, column, column));
    for (int i = 0; i < c->points; i++) column[i] /= c->R[m][m];
  }
}

/* Compute column[m][i], the integral of P_m from 0 to point i. */
static void sample_primitive(int degree, int i, long double point,
                             long double column[][DVI_QUADRATURE_MAX])
{
  long double primitive[DVI_DEGREE_MAX];
  integrate_legendre(degree, 0, point, primitive);
  for (int m = 0; m < degree; m++) column[m][i] = primitive[m];
}

/* Compute C[m], the coefficients in the basis of the combination of primitives that column m of Q
 * stands for. They are the coefficients of the primitives themselves, times R^{-1}. */
static void read_primitive_columns(const dvi__space *space, const columns *c,
                                   long double C[][DVI_DEGREE_MAX])
{
  const int degree = space->degree;
  reading read;
  long double sample[DVI_DEGREE_MAX][DVI_QUADRATURE_MAX];
  read_coefficients(space, &read);
  for (int j = 0; j <= degree; j++) sample_primitive(degree, j, read.point[j], sample);
  for (int m = 0; m < degree; m++) {
    apply_reading(&read, degree, sample[m], C[m]);
    for (int k = 0; k < degree; k++) {
      for (int i = 0; i < m; i++) C[m][k] -= C[i][k] * c->R[i][m];
      C[m][k] /= c->R[m][m];
    }
  }
}

/* Find the polynomial as a combination of the Legendre functions' primitives, then read it in the
 * basis by Y = C Q^T (values - q0). The primitives vanish at 0 and are well conditioned where the
 * basis itself may not be. */
void dvi__trial_fit(dvi_basis basis, int degree, int points, const double *tau, double *matrix)
{
  dvi__space space;
  columns c = {.count = degree, .points = points};
  long double C[DVI_DEGREE_MAX][DVI_DEGREE_MAX] = {{0}};
  dvi__space_init(&space, basis, degree);
  for (int i = 0; i < points; i++) sample_primitive(degree, i, (long double)tau[i], c.column);
  orthogonalize_columns(&c);
  read_primitive_columns(&space, &c, C);
  for (int k = 0; k < degree; k++)
    for (int i = 0; i < points; i++) {
      long double sum = 0;
      for (int m = 0; m < degree; m++) sum += C[m][k] * c.column[m][i];
      matrix[k * points + i] = (double)sum;
    }
}
