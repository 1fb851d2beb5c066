/* Derivatives of a.y(xi) + b.v(xi,rate) for fixed covectors a and b. */
#include <dvi/group.h>
#include <string.h>

#include "group/chart_functions.h"
#include "group/vector.h"

/* The function w.y(xi) = w0 c_0 + c_1 z.xi + c_2 xi.B xi, up to a constant. */
typedef struct form {
  int size;
  double w0, z[3], B[9];
} form;

static form form_of(const dvi__chart *chart, const double *w)
{
  form f = {.size = dvi__chart_size(chart->kind)};
  if (chart->kind != DVI__ROTATION) {
    const int stored = dvi__chart_stored(chart->kind);
    f.w0 = dvi__inner(stored, w, chart->y0);
    for (int j = 0; j < f.size; j++) f.z[j] = dvi__inner(stored, w, chart->basis[j]);
    return f;
  }
  double W[9]; /* R0^T w */
  const double *R = chart->y0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      W[3 * i + j] = R[i] * w[j] + R[3 + i] * w[3 + j] + R[6 + i] * w[6 + j];
  f.z[0] = W[7] - W[5];
  f.z[1] = W[2] - W[6];
  f.z[2] = W[3] - W[1];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) f.B[3 * i + j] = 0.5 * (W[3 * i + j] + W[3 * j + i]);
  dvi__add_identity(3, -(W[0] + W[4] + W[8]), f.B);
  return f;
}

static void multiply_matrices(const form *f, const double *x, double *Bx)
{
  for (int i = 0; i < f->size; i++) Bx[i] = dvi__inner(f->size, f->B + i * f->size, x);
}

/* Differentiate j times in s, with xi held fixed in z.xi and xi.B xi. */
static double in_s(const form *f, const dvi__functions *c, int j, double z_xi, double xi_B_xi)
{
  return c->of[0][j] * f->w0 + c->of[1][j] * z_xi + c->of[2][j] * xi_B_xi;
}

static void form_add_gradient(const form *f, const dvi__functions *c, const double *xi,
                              double *gradient)
{
  double Bxi[3];
  multiply_matrices(f, xi, Bxi);
  const double by_s = 2 *
                      in_s(f, c, 1, dvi__inner(f->size, f->z, xi), dvi__inner(f->size, xi, Bxi));
  for (int i = 0; i < f->size; i++)
    gradient[i] = by_s * xi[i] + c->of[1][0] * f->z[i] + 2 * c->of[2][0] * Bxi[i];
}

/* Add the Hessian to H. */
static void form_add_hessian(const form *f, const dvi__functions *c, const double *xi, double *H)
{
  const int n = f->size;
  double Bxi[3];
  multiply_matrices(f, xi, Bxi);
  const double m = dvi__inner(n, f->z, xi), k = dvi__inner(n, xi, Bxi);
  dvi__add_identity(n, 2 * in_s(f, c, 1, m, k), H);
  dvi__add_outer(n, 2 * in_s(f, c, 2, m, k), xi, xi, H);
  dvi__add_outer(n, 2 * c->of[1][1], f->z, xi, H);
  dvi__add_outer(n, 4 * c->of[2][1], Bxi, xi, H);
  for (int i = 0; i < n * n; i++) H[i] += 2 * c->of[2][0] * f->B[i];
}

/* Add the derivative of the Hessian along u to H. */
static void add_third(const form *f, const dvi__functions *c, const double *xi, const double *u,
                      double *H)
{
  const int n = f->size;
  double Bxi[3], Bu[3];
  multiply_matrices(f, xi, Bxi);
  multiply_matrices(f, u, Bu);
  const double m = dvi__inner(n, f->z, xi), k = dvi__inner(n, xi, Bxi),
               sigma = dvi__inner(n, xi, u), m_u = dvi__inner(n, f->z, u),
               k_u = 2 * dvi__inner(n, xi, Bu);
  const double second = in_s(f, c, 2, m, k), first_u = c->of[1][1] * m_u + c->of[2][1] * k_u,
               second_u = c->of[1][2] * m_u + c->of[2][2] * k_u;
  dvi__add_identity(n, 4 * sigma * second + 2 * first_u, H);
  dvi__add_outer(n, 4 * sigma * in_s(f, c, 3, m, k) + 2 * second_u, xi, xi, H);
  dvi__add_outer(n, 4 * second, u, xi, H);
  dvi__add_outer(n, 4 * c->of[1][2] * sigma, f->z, xi, H);
  dvi__add_outer(n, 2 * c->of[1][1], f->z, u, H);
  dvi__add_outer(n, 8 * c->of[2][2] * sigma, Bxi, xi, H);
  dvi__add_outer(n, 4 * c->of[2][1], Bu, xi, H);
  dvi__add_outer(n, 4 * c->of[2][1], Bxi, u, H);
  for (int i = 0; i < n * n; i++) H[i] += 4 * c->of[2][1] * sigma * f->B[i];
}

void dvi__chart_gradient(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                         const double *rate, const double *a, const double *b, double *in_xi,
                         double *in_rate)
{
  double H[9] = {0};
  if (chart->kind == DVI__LINE) {
    *in_xi = *a;
    *in_rate = *b;
    return;
  }
  const form of_a = form_of(chart, a), of_b = form_of(chart, b);
  form_add_gradient(&of_a, c, xi, in_xi);
  form_add_gradient(&of_b, c, xi, in_rate);
  form_add_hessian(&of_b, c, xi, H);
  for (int i = 0; i < of_a.size; i++) in_xi[i] += dvi__inner(of_a.size, H + i * of_a.size, rate);
}

void dvi__chart_curvature(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                          const double *rate, const double *a, const double *b, double *in_xi,
                          double *mixed)
{
  const int n = dvi__chart_size(chart->kind);
  memset(in_xi, 0, (size_t)(n * n) * sizeof *in_xi);
  memset(mixed, 0, (size_t)(n * n) * sizeof *mixed);
  if (chart->kind == DVI__LINE) return;
  const form of_a = form_of(chart, a), of_b = form_of(chart, b);
  form_add_hessian(&of_a, c, xi, in_xi);
  add_third(&of_b, c, xi, rate, in_xi);
  form_add_hessian(&of_b, c, xi, mixed);
}

/* Write l.dexp_{-xi} rate as a form of c_2 and c_3, which replace c_1 and c_2. */
static form turning_form(const dvi__functions *c, const double *rate, const double *l,
                         dvi__functions *shifted)
{
  form f = {.size = 3};
  memcpy(shifted->of, c->of + 1, 3 * sizeof *c->of);
  dvi__cross(l, rate, f.z);
  dvi__add_outer(3, 0.5, l, rate, f.B);
  dvi__add_identity(3, -dvi__dot(l, rate), f.B);
  return f;
}

void dvi__chart_turning_gradient(const dvi__functions *c, const double *xi, const double *rate,
                                 const double *l, double *in_xi, double *in_rate)
{
  dvi__functions shifted;
  const form f = turning_form(c, rate, l, &shifted);
  form_add_gradient(&f, &shifted, xi, in_xi);
  dvi__about(xi, c->of[2][0], c->of[3][0], l, in_rate); /* dexp_xi l */
}

void dvi__chart_turning_curvature(const dvi__functions *c, const double *xi, const double *rate,
                                  const double *l, double *in_xi, double *mixed)
{
  const double back[] = {-xi[0], -xi[1], -xi[2]};
  dvi__functions shifted;
  double derivative[9]; /* derivative of dexp_{-back} l in back */
  const form f = turning_form(c, rate, l, &shifted);
  memset(in_xi, 0, 9 * sizeof *in_xi);
  form_add_hessian(&f, &shifted, xi, in_xi);
  dvi_so3_velocity_derivative(back, l, derivative);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) mixed[3 * i + j] = -derivative[3 * j + i];
}
