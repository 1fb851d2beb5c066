#include "group/chart.h"

#include <math.h>
#include <string.h>

#include "group/stumpff.h"

int dvi__chart_stored(dvi__chart_kind kind)
{
  static const int count[] = {1, 2, 3, 9};
  return count[kind];
}

int dvi__chart_velocities(dvi__chart_kind kind)
{
  static const int count[] = {1, 1, 3, 3};
  return count[kind];
}

int dvi__chart_size(dvi__chart_kind kind)
{
  static const int count[] = {1, 1, 2, 3};
  return count[kind];
}

double dvi__chart_bound(dvi__chart_kind kind)
{
  return kind == DVI__LINE ? HUGE_VAL : 3.14159265358979323846;
}

/* ---- vectors ---- */

static double dot(int n, const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

static void cross(const double *a, const double *b, double *c)
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

/* out = R0 E. */
static void turn(const double *R0, const double *E, double *out)
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) out[3 * i + j] = R0[3 * i] * E[j] + R0[3 * i + 1] * E[3 + j] + R0[3 * i + 2] * E[6 + j];
}

/* E += a^ */
static void add_hat(const double *a, double *E)
{
  E[1] -= a[2], E[2] += a[1], E[5] -= a[0];
  E[3] += a[2], E[6] -= a[1], E[7] += a[0];
}

/* H += factor (a b^T + b a^T). */
static void add_outer(int n, double factor, const double *a, const double *b, double *H)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) H[i * n + j] += factor * (a[i] * b[j] + b[i] * a[j]);
}

static void add_identity(int n, double factor, double *H)
{
  for (int i = 0; i < n; i++) H[i * n + i] += factor;
}

/* ---- the functions of s and their derivatives ---- */

/* of[k][j]: the derivative of order j of c_k in s, by c_k' = (k c_{k+2} - c_{k+1})/2. */
typedef struct functions {
  double of[9][4];
} functions;

static void find_functions(int size, const double *xi, int derivatives, functions *c)
{
  double value[9];
  dvi__stumpff(dot(size, xi, xi), value);
  for (int k = 0; k < 9; k++) c->of[k][0] = value[k];
  for (int j = 0; j < derivatives; j++)
    for (int k = 0; k + 2 * (j + 1) < 9; k++) c->of[k][j + 1] = 0.5 * (k * c->of[k + 2][j] - c->of[k + 1][j]);
}

/* ---- centre ---- */

void dvi__chart_centre(dvi__chart_kind kind, const double *y0, dvi__chart *chart)
{
  memset(chart, 0, sizeof *chart);
  chart->kind = kind;
  memcpy(chart->y0, y0, (size_t)dvi__chart_stored(kind) * sizeof *y0);
  if (kind == DVI__CIRCLE) {
    chart->basis[0][0] = -y0[1];
    chart->basis[0][1] = y0[0];
  }
  if (kind != DVI__SPHERE) return;
  /* Duff et al. 2017. */
  const double sign = copysign(1, y0[2]), a = -1 / (sign + y0[2]), b = y0[0] * y0[1] * a;
  const double first[] = {1 + sign * y0[0] * y0[0] * a, sign * b, -sign * y0[0]}, second[] = {b, sign + y0[1] * y0[1] * a, -y0[1]};
  memcpy(chart->basis[0], first, sizeof first);
  memcpy(chart->basis[1], second, sizeof second);
}

/* B x: from the tangent plane's coordinates. */
static void lift(const dvi__chart *chart, const double *x, double *out)
{
  const int stored = dvi__chart_stored(chart->kind), size = dvi__chart_size(chart->kind);
  for (int i = 0; i < stored; i++) {
    out[i] = 0;
    for (int j = 0; j < size; j++) out[i] += chart->basis[j][i] * x[j];
  }
}

/* ---- points ---- */

/* (a b^T + b a^T) - 2 a.b I, which is a^ b^ + b^ a^. */
static void add_squares(double factor, const double *a, const double *b, double *E)
{
  add_outer(3, factor, a, b, E);
  add_identity(3, -2 * factor * dot(3, a, b), E);
}

static void rotation_point(const dvi__chart *chart, const functions *c, const double *xi, const double *rate, double *y, double *v)
{
  const double sigma = rate != NULL ? dot(3, xi, rate) : 0;
  double E[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, a[3];
  for (int i = 0; i < 3; i++) a[i] = c->of[1][0] * xi[i];
  add_hat(a, E);
  add_squares(0.5 * c->of[2][0], xi, xi, E);
  turn(chart->y0, E, y);
  if (rate == NULL) return;
  memset(E, 0, sizeof E);
  for (int i = 0; i < 3; i++) a[i] = c->of[1][0] * rate[i] + 2 * sigma * c->of[1][1] * xi[i];
  add_hat(a, E);
  add_squares(c->of[2][0], xi, rate, E);
  add_squares(sigma * c->of[2][1], xi, xi, E);
  turn(chart->y0, E, v);
}

static void sphere_point(const dvi__chart *chart, const functions *c, const double *xi, const double *rate, double *y, double *v)
{
  const int stored = dvi__chart_stored(chart->kind), size = dvi__chart_size(chart->kind);
  double x[3], w[3];
  lift(chart, xi, x);
  for (int i = 0; i < stored; i++) y[i] = c->of[0][0] * chart->y0[i] + c->of[1][0] * x[i];
  if (rate == NULL) return;
  const double sigma = dot(size, xi, rate);
  lift(chart, rate, w);
  for (int i = 0; i < stored; i++)
    v[i] = 2 * sigma * (c->of[0][1] * chart->y0[i] + c->of[1][1] * x[i]) + c->of[1][0] * w[i];
}

void dvi__chart_point(const dvi__chart *chart, const double *xi, const double *rate, double *y, double *v)
{
  functions c;
  if (chart->kind == DVI__LINE) {
    *y = *chart->y0 + *xi;
    if (rate != NULL) *v = *rate;
    return;
  }
  find_functions(dvi__chart_size(chart->kind), xi, 1, &c);
  if (chart->kind == DVI__ROTATION)
    rotation_point(chart, &c, xi, rate, y, v);
  else
    sphere_point(chart, &c, xi, rate, y, v);
}

/* ---- contractions ---- */

/* w.y(xi) = w0 c_0 + c_1 z.xi + c_2 xi.B xi, up to a constant. */
typedef struct form {
  int size;
  double w0, z[3], B[9];
} form;

static form form_of(const dvi__chart *chart, const double *w)
{
  form f = {.size = dvi__chart_size(chart->kind)};
  if (chart->kind != DVI__ROTATION) {
    const int stored = dvi__chart_stored(chart->kind);
    f.w0 = dot(stored, w, chart->y0);
    for (int j = 0; j < f.size; j++) f.z[j] = dot(stored, w, chart->basis[j]);
    return f;
  }
  double W[9]; /* R0^T w */
  const double *R = chart->y0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) W[3 * i + j] = R[i] * w[j] + R[3 + i] * w[3 + j] + R[6 + i] * w[6 + j];
  f.z[0] = W[7] - W[5];
  f.z[1] = W[2] - W[6];
  f.z[2] = W[3] - W[1];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) f.B[3 * i + j] = 0.5 * (W[3 * i + j] + W[3 * j + i]);
  add_identity(3, -(W[0] + W[4] + W[8]), f.B);
  return f;
}

static void multiply(const form *f, const double *x, double *Bx)
{
  for (int i = 0; i < f->size; i++) Bx[i] = dot(f->size, f->B + i * f->size, x);
}

/* Derivative of order j in s, with xi in z.xi and xi.B xi held. */
static double in_s(const form *f, const functions *c, int j, double z_xi, double xi_B_xi)
{
  return c->of[0][j] * f->w0 + c->of[1][j] * z_xi + c->of[2][j] * xi_B_xi;
}

static void form_gradient(const form *f, const functions *c, const double *xi, double *gradient)
{
  double Bxi[3];
  multiply(f, xi, Bxi);
  const double by_s = 2 * in_s(f, c, 1, dot(f->size, f->z, xi), dot(f->size, xi, Bxi));
  for (int i = 0; i < f->size; i++) gradient[i] = by_s * xi[i] + c->of[1][0] * f->z[i] + 2 * c->of[2][0] * Bxi[i];
}

/* H += the Hessian. */
static void add_hessian(const form *f, const functions *c, const double *xi, double *H)
{
  const int n = f->size;
  double Bxi[3];
  multiply(f, xi, Bxi);
  const double m = dot(n, f->z, xi), k = dot(n, xi, Bxi);
  add_identity(n, 2 * in_s(f, c, 1, m, k), H);
  add_outer(n, 2 * in_s(f, c, 2, m, k), xi, xi, H);
  add_outer(n, 2 * c->of[1][1], f->z, xi, H);
  add_outer(n, 4 * c->of[2][1], Bxi, xi, H);
  for (int i = 0; i < n * n; i++) H[i] += 2 * c->of[2][0] * f->B[i];
}

/* H += the derivative of the Hessian along u. */
static void add_third(const form *f, const functions *c, const double *xi, const double *u, double *H)
{
  const int n = f->size;
  double Bxi[3], Bu[3];
  multiply(f, xi, Bxi);
  multiply(f, u, Bu);
  const double m = dot(n, f->z, xi), k = dot(n, xi, Bxi), sigma = dot(n, xi, u), m_u = dot(n, f->z, u), k_u = 2 * dot(n, xi, Bu);
  const double second = in_s(f, c, 2, m, k), first_u = c->of[1][1] * m_u + c->of[2][1] * k_u,
               second_u = c->of[1][2] * m_u + c->of[2][2] * k_u;
  add_identity(n, 4 * sigma * second + 2 * first_u, H);
  add_outer(n, 4 * sigma * in_s(f, c, 3, m, k) + 2 * second_u, xi, xi, H);
  add_outer(n, 4 * second, u, xi, H);
  add_outer(n, 4 * c->of[1][2] * sigma, f->z, xi, H);
  add_outer(n, 2 * c->of[1][1], f->z, u, H);
  add_outer(n, 8 * c->of[2][2] * sigma, Bxi, xi, H);
  add_outer(n, 4 * c->of[2][1], Bu, xi, H);
  add_outer(n, 4 * c->of[2][1], Bxi, u, H);
  for (int i = 0; i < n * n; i++) H[i] += 4 * c->of[2][1] * sigma * f->B[i];
}

void dvi__chart_gradient(const dvi__chart *chart, const double *xi, const double *rate, const double *a, const double *b,
                         double *in_xi, double *in_rate)
{
  functions c;
  double H[9] = {0};
  if (chart->kind == DVI__LINE) {
    *in_xi = *a;
    *in_rate = *b;
    return;
  }
  const form of_a = form_of(chart, a), of_b = form_of(chart, b);
  find_functions(of_a.size, xi, 2, &c);
  form_gradient(&of_a, &c, xi, in_xi);
  form_gradient(&of_b, &c, xi, in_rate);
  add_hessian(&of_b, &c, xi, H);
  for (int i = 0; i < of_a.size; i++) in_xi[i] += dot(of_a.size, H + i * of_a.size, rate);
}

void dvi__chart_curvature(const dvi__chart *chart, const double *xi, const double *rate, const double *a, const double *b,
                          double *in_xi, double *mixed)
{
  functions c;
  const int n = dvi__chart_size(chart->kind);
  memset(in_xi, 0, (size_t)(n * n) * sizeof *in_xi);
  memset(mixed, 0, (size_t)(n * n) * sizeof *mixed);
  if (chart->kind == DVI__LINE) return;
  const form of_a = form_of(chart, a), of_b = form_of(chart, b);
  find_functions(n, xi, 3, &c);
  add_hessian(&of_a, &c, xi, in_xi);
  add_third(&of_b, &c, xi, rate, in_xi);
  add_hessian(&of_b, &c, xi, mixed);
}

/* ---- tangents ---- */

/* Columns j of T and S, as matrices E before R0. */
static void rotation_tangent(const functions *c, const double *xi, const double *rate, int j, double *T, double *S)
{
  const double sigma = dot(3, xi, rate);
  double e[3] = {0}, a[3];
  e[j] = 1;
  for (int i = 0; i < 3; i++) a[i] = c->of[1][0] * e[i] + 2 * xi[j] * c->of[1][1] * xi[i];
  add_hat(a, T);
  add_squares(c->of[2][0], xi, e, T);
  add_squares(xi[j] * c->of[2][1], xi, xi, T);
  for (int i = 0; i < 3; i++)
    a[i] = 2 * c->of[1][1] * (xi[j] * rate[i] + sigma * e[i] + rate[j] * xi[i]) + 4 * c->of[1][2] * xi[j] * sigma * xi[i];
  add_hat(a, S);
  add_squares(c->of[2][0], rate, e, S);
  add_squares(2 * c->of[2][1] * xi[j], xi, rate, S);
  add_squares(2 * c->of[2][1] * sigma, xi, e, S);
  add_squares(c->of[2][1] * rate[j] + 2 * c->of[2][2] * xi[j] * sigma, xi, xi, S);
}

static void sphere_tangent(const dvi__chart *chart, const functions *c, const double *xi, const double *rate, int j, double *T,
                           double *S)
{
  const int stored = dvi__chart_stored(chart->kind), size = dvi__chart_size(chart->kind);
  const double sigma = dot(size, xi, rate), *e = chart->basis[j];
  double x[3], w[3];
  lift(chart, xi, x);
  lift(chart, rate, w);
  for (int i = 0; i < stored; i++) {
    T[i] = 2 * xi[j] * (c->of[0][1] * chart->y0[i] + c->of[1][1] * x[i]) + c->of[1][0] * e[i];
    S[i] = (2 * c->of[0][1] * rate[j] + 4 * c->of[0][2] * xi[j] * sigma) * chart->y0[i] +
           2 * c->of[1][1] * (xi[j] * w[i] + sigma * e[i] + rate[j] * x[i]) + 4 * c->of[1][2] * xi[j] * sigma * x[i];
  }
}

void dvi__chart_tangents(const dvi__chart *chart, const double *xi, const double *rate, double *T, double *S)
{
  functions c;
  if (chart->kind == DVI__LINE) {
    *T = 1;
    *S = 0;
    return;
  }
  const int stored = dvi__chart_stored(chart->kind), size = dvi__chart_size(chart->kind);
  find_functions(size, xi, 2, &c);
  for (int j = 0; j < size; j++) {
    double column[2][9] = {{0}}, turned[2][9];
    if (chart->kind == DVI__ROTATION) {
      rotation_tangent(&c, xi, rate, j, column[0], column[1]);
      turn(chart->y0, column[0], turned[0]);
      turn(chart->y0, column[1], turned[1]);
      memcpy(column, turned, sizeof column);
    } else {
      sphere_tangent(chart, &c, xi, rate, j, column[0], column[1]);
    }
    for (int i = 0; i < stored; i++) {
      T[i * size + j] = column[0][i];
      S[i * size + j] = column[1][i];
    }
  }
}

/* ---- turning in space ---- */

/* out = x + first xi x x + second xi x (xi x x). */
static void add_turns(const double *xi, const double *x, double first, double second, double *out)
{
  double once[3], twice[3];
  cross(xi, x, once);
  cross(xi, once, twice);
  for (int i = 0; i < 3; i++) out[i] = x[i] + first * once[i] + second * twice[i];
}

/* Vectors in a stored point: the columns of a rotation, or the direction itself. */
static int vectors_of(dvi__chart_kind kind)
{
  return kind == DVI__ROTATION ? 3 : 1;
}

static void get_vector(const double *y, int vectors, int j, double *x)
{
  for (int i = 0; i < 3; i++) x[i] = y[i * vectors + j];
}

void dvi__chart_turns(dvi__chart_kind kind, const double *y, double *turns)
{
  const int vectors = vectors_of(kind);
  for (int j = 0; j < vectors; j++)
    for (int k = 0; k < 3; k++) {
      double x[3], e[3] = {0}, moved[3];
      e[k] = 1;
      get_vector(y, vectors, j, x);
      cross(e, x, moved);
      for (int i = 0; i < 3; i++) turns[3 * (i * vectors + j) + k] = moved[i];
    }
}

void dvi__chart_add_moment(dvi__chart_kind kind, const double *y, const double *a, double *moment)
{
  const int vectors = vectors_of(kind);
  for (int j = 0; j < vectors; j++) {
    double x[3], f[3], product[3];
    get_vector(y, vectors, j, x);
    get_vector(a, vectors, j, f);
    cross(x, f, product);
    for (int i = 0; i < 3; i++) moment[i] += product[i];
  }
}

void dvi__chart_angular_momentum(const dvi__chart *chart, const double *p, double *angular)
{
  double P[3];
  if (chart->kind == DVI__ROTATION) {
    memcpy(angular, p, 3 * sizeof *p);
    return;
  }
  lift(chart, p, P);
  cross(chart->y0, P, angular);
}

void dvi__chart_add_impulse(const dvi__chart *chart, const double *impulse, double *angular)
{
  const double *R = chart->y0;
  for (int j = 0; j < 3; j++)
    angular[j] += chart->kind == DVI__ROTATION ? R[j] * impulse[0] + R[3 + j] * impulse[1] + R[6 + j] * impulse[2] : impulse[j];
}

/* Of a rotation R0 exp(xi): turning by w in the centre's frame is d xi with dexp_xi d xi = w, so p = dexp_xi^T angular = dexp_{-xi} angular. Of a direction:
 * p_j = T_j.(angular x y). */
void dvi__chart_momentum(const dvi__chart *chart, const double *xi, const double *angular, double *p)
{
  functions c;
  if (chart->kind == DVI__ROTATION) {
    find_functions(3, xi, 0, &c);
    add_turns(xi, angular, -c.of[2][0], c.of[3][0], p);
    return;
  }
  const double rest[2] = {0};
  double y[3], P[3], unused[2];
  dvi__chart_point(chart, xi, NULL, y, NULL);
  cross(angular, y, P);
  dvi__chart_gradient(chart, xi, rest, P, P, unused, p);
}

void dvi__chart_stored_momentum(const dvi__chart *chart, const double *xi, const double *angular, double *stored)
{
  functions c;
  double y[3];
  if (chart->kind == DVI__ROTATION) {
    find_functions(3, xi, 0, &c);
    add_turns(xi, angular, -c.of[1][0], c.of[2][0], stored);
    return;
  }
  dvi__chart_point(chart, xi, NULL, y, NULL);
  cross(angular, y, stored);
}

void dvi__chart_moments(const dvi__chart *chart, const double *xi, double *W)
{
  for (int k = 0; k < 3; k++) {
    double e[3] = {0}, impulse[3] = {0}, column[3];
    e[k] = 1;
    dvi__chart_add_impulse(chart, e, impulse);
    dvi__chart_momentum(chart, xi, impulse, column);
    for (int j = 0; j < dvi__chart_size(chart->kind); j++) W[3 * j + k] = column[j];
  }
}

static void rotation_derivative(const double *xi, const double *angular, double *derivative)
{
  functions c;
  double once[3], twice[3];
  find_functions(3, xi, 1, &c);
  cross(xi, angular, once);
  cross(xi, once, twice);
  for (int j = 0; j < 3; j++) {
    double e[3] = {0}, first[3], second[3], third[3];
    e[j] = 1;
    cross(e, angular, first);
    cross(e, once, second);
    cross(xi, first, third);
    for (int i = 0; i < 3; i++)
      derivative[3 * i + j] = -c.of[2][0] * first[i] + c.of[3][0] * (second[i] + third[i]) +
                              2 * xi[j] * (-c.of[2][1] * once[i] + c.of[3][1] * twice[i]);
  }
}

void dvi__chart_momentum_derivative(const dvi__chart *chart, const double *xi, const double *angular, double *derivative)
{
  if (chart->kind == DVI__ROTATION) {
    rotation_derivative(xi, angular, derivative);
    return;
  }
  const double rest[2] = {0}, none[3] = {0};
  double y[3], T[6], S[6], covector[3], unused[4];
  dvi__chart_point(chart, xi, NULL, y, NULL);
  dvi__chart_tangents(chart, xi, rest, T, S);
  cross(angular, y, covector);
  dvi__chart_curvature(chart, xi, rest, covector, none, derivative, unused);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      double turned[3];
      cross(angular, (const double[]){T[j], T[2 + j], T[4 + j]}, turned);
      for (int k = 0; k < 3; k++) derivative[2 * i + j] += turned[k] * T[2 * k + i];
    }
}

/* ---- between charts ---- */

/* x of length sin(angle), made as long as the angle. */
static void stretch(int size, double cosine, double *x)
{
  const double sine = sqrt(dot(size, x, x)), angle = atan2(sine, cosine), by = sine > 0 ? angle / sine : 1;
  for (int i = 0; i < size; i++) x[i] *= by;
}

void dvi__chart_inverse(const dvi__chart *chart, const double *y, double *xi)
{
  if (chart->kind == DVI__LINE) {
    *xi = *y - *chart->y0;
    return;
  }
  const form f = form_of(chart, y);
  const int turns = chart->kind == DVI__ROTATION;
  for (int i = 0; i < f.size; i++) xi[i] = turns ? 0.5 * f.z[i] : f.z[i];
  stretch(f.size, turns ? 0.5 * (-0.5 * (f.B[0] + f.B[4] + f.B[8]) - 1) : f.w0, xi);
}

void dvi__chart_enter(const dvi__chart *chart, const double *stored, double *local)
{
  if (chart->kind != DVI__SPHERE) {
    memcpy(local, stored, (size_t)dvi__chart_size(chart->kind) * sizeof *local);
    return;
  }
  for (int j = 0; j < 2; j++) local[j] = dot(3, chart->basis[j], stored);
}

void dvi__chart_store(const dvi__chart *chart, const double *local, double *stored)
{
  if (chart->kind == DVI__SPHERE)
    lift(chart, local, stored);
  else
    memcpy(stored, local, (size_t)dvi__chart_size(chart->kind) * sizeof *stored);
}

void dvi__chart_leave_velocity(const dvi__chart *chart, const double *xi, const double *rate, double *stored)
{
  functions c;
  double y[3];
  if (chart->kind == DVI__LINE || chart->kind == DVI__CIRCLE) {
    *stored = *rate;
    return;
  }
  find_functions(dvi__chart_size(chart->kind), xi, 1, &c);
  if (chart->kind == DVI__SPHERE)
    sphere_point(chart, &c, xi, rate, y, stored);
  else
    add_turns(xi, rate, -c.of[2][0], c.of[3][0], stored); /* dexp_{-xi} */
}
