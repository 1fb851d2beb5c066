/* Two point masses on two rods in a plane, with angles from straight down. The general Lagrangian
 * has a mass that depends on q.
 *
 *     L = A v1^2/2 + B v2^2/2 + C cos(q1 - q2) v1 v2 + G1 cos q1 + G2 cos q2,
 *     A = (m1+m2) l1^2,  B = m2 l2^2,  C = m2 l1 l2,  G1 = (m1+m2) g l1,  G2 = m2 g l2. */
#include <dvi/taylor.h>
#include <math.h>

#include "entry.h"

typedef struct double_pendulum_coefficients {
  double A, B, C, G1, G2;
} double_pendulum_coefficients;

static int double_pendulum_lagrangian(int count, const double *t, const double *q, const double *v,
                                      double *L, void *user)
{
  const double_pendulum_coefficients *own = user;
  const double *restrict q1 = q, *restrict q2 = q + count, *restrict v1 = v,
                         *restrict v2 = v + count;
  (void)t;
  for (int k = 0; k < count; k++)
    L[k] = 0.5 * own->A * v1[k] * v1[k] + 0.5 * own->B * v2[k] * v2[k] +
           own->C * cos(q1[k] - q2[k]) * v1[k] * v2[k] + own->G1 * cos(q1[k]) +
           own->G2 * cos(q2[k]);
  return 0;
}

static int double_pendulum_gradient(int count, const double *t, const double *q, const double *v,
                                    double *L_q, double *L_v, void *user)
{
  const double_pendulum_coefficients own = *(const double_pendulum_coefficients *)user;
  const double *restrict q1 = q, *restrict q2 = q + count, *restrict v1 = v,
                         *restrict v2 = v + count;
  double *restrict L_q1 = L_q, *restrict L_q2 = L_q + count, *restrict L_v1 = L_v,
                   *restrict L_v2 = L_v + count;
  (void)t;
  for (int k = 0; k < count; k++) {
    const double c = own.C * cos(q1[k] - q2[k]), s = own.C * sin(q1[k] - q2[k]) * v1[k] * v2[k];
    L_q1[k] = -s - own.G1 * sin(q1[k]);
    L_q2[k] = s - own.G2 * sin(q2[k]);
    L_v1[k] = own.A * v1[k] + c * v2[k];
    L_v2[k] = own.B * v2[k] + c * v1[k];
  }
  return 0;
}

static int double_pendulum_hessian(int count, const double *t, const double *q, const double *v,
                                   double *L_qq, double *L_qv, double *L_vv, void *user)
{
  const double_pendulum_coefficients own = *(const double_pendulum_coefficients *)user;
  const double *restrict q1 = q, *restrict q2 = q + count, *restrict v1 = v,
                         *restrict v2 = v + count;
  (void)t;
  for (int k = 0; k < count; k++) {
    const double c = own.C * cos(q1[k] - q2[k]), s = own.C * sin(q1[k] - q2[k]);
    const double c_v1_v2 = c * v1[k] * v2[k];
    L_qq[k] = -c_v1_v2 - own.G1 * cos(q1[k]);
    L_qq[count + k] = c_v1_v2;
    L_qq[2 * count + k] = c_v1_v2;
    L_qq[3 * count + k] = -c_v1_v2 - own.G2 * cos(q2[k]);
    L_qv[k] = -s * v2[k];
    L_qv[count + k] = s * v2[k];
    L_qv[2 * count + k] = -s * v1[k];
    L_qv[3 * count + k] = s * v1[k];
    L_vv[k] = own.A;
    L_vv[count + k] = c;
    L_vv[2 * count + k] = c;
    L_vv[3 * count + k] = own.B;
  }
  return 0;
}

/* The series in the sums of L and its derivatives along a curve. */
typedef struct series {
  double v1[DVI_TAYLOR_MAX + 1], v2[DVI_TAYLOR_MAX + 1];
  double sine_1[DVI_TAYLOR_MAX + 1], cosine_1[DVI_TAYLOR_MAX + 1]; /* series of q1 */
  double sine_2[DVI_TAYLOR_MAX + 1], cosine_2[DVI_TAYLOR_MAX + 1];
  double s[DVI_TAYLOR_MAX + 1], c[DVI_TAYLOR_MAX + 1]; /* C times the series of q1 - q2 */
  double v1_v2[DVI_TAYLOR_MAX + 1];
} series;

static void double_pendulum_expand(const double_pendulum_coefficients *own, int degree,
                                   const double *q, const double *v, series *of)
{
  double q1[DVI_TAYLOR_MAX + 1], q2[DVI_TAYLOR_MAX + 1], between[DVI_TAYLOR_MAX + 1];
  dvi_taylor_get(degree, 2, q, 0, q1);
  dvi_taylor_get(degree, 2, q, 1, q2);
  dvi_taylor_get(degree, 2, v, 0, of->v1);
  dvi_taylor_get(degree, 2, v, 1, of->v2);
  dvi_taylor_sin_cos(degree, q1, of->sine_1, of->cosine_1);
  dvi_taylor_sin_cos(degree, q2, of->sine_2, of->cosine_2);
  dvi_taylor_combine(degree, 1.0, q1, -1.0, q2, between);
  dvi_taylor_sin_cos(degree, between, of->s, of->c);
  for (int k = 0; k <= degree; k++) {
    of->s[k] *= own->C;
    of->c[k] *= own->C;
  }
  dvi_taylor_multiply(degree, of->v1, of->v2, of->v1_v2);
}

/* Compute coefficient k of the Hessian. */
static void double_pendulum_series_hessian(const double_pendulum_coefficients *own,
                                           const series *of, int k, double *L_qq, double *L_qv,
                                           double *L_vv)
{
  const double c_v1_v2 = dvi_taylor_product(k, of->c, of->v1_v2);
  const double s_v1 = dvi_taylor_product(k, of->s, of->v1),
               s_v2 = dvi_taylor_product(k, of->s, of->v2);
  if (L_qq) {
    L_qq[4 * k] = -c_v1_v2 - own->G1 * of->cosine_1[k];
    L_qq[4 * k + 1] = L_qq[4 * k + 2] = c_v1_v2;
    L_qq[4 * k + 3] = -c_v1_v2 - own->G2 * of->cosine_2[k];
  }
  if (L_qv) {
    L_qv[4 * k] = -s_v2;
    L_qv[4 * k + 1] = s_v2;
    L_qv[4 * k + 2] = -s_v1;
    L_qv[4 * k + 3] = s_v1;
  }
  if (L_vv) {
    L_vv[4 * k] = k == 0 ? own->A : 0.0;
    L_vv[4 * k + 1] = L_vv[4 * k + 2] = of->c[k];
    L_vv[4 * k + 3] = k == 0 ? own->B : 0.0;
  }
}

static int double_pendulum_taylor(int degree, const double *t, const double *q, const double *v,
                                  double *L, double *L_q, double *L_v, double *L_qq, double *L_qv,
                                  double *L_vv, void *user)
{
  const double_pendulum_coefficients own = *(const double_pendulum_coefficients *)user;
  series of;
  (void)t;
  double_pendulum_expand(&own, degree, q, v, &of);
  for (int k = 0; k <= degree; k++) {
    const double s_v1_v2 = dvi_taylor_product(k, of.s, of.v1_v2);
    if (L)
      L[k] = 0.5 * own.A * dvi_taylor_product(k, of.v1, of.v1) +
             0.5 * own.B * dvi_taylor_product(k, of.v2, of.v2) +
             dvi_taylor_product(k, of.c, of.v1_v2) + own.G1 * of.cosine_1[k] +
             own.G2 * of.cosine_2[k];
    if (L_q) {
      L_q[2 * k] = -s_v1_v2 - own.G1 * of.sine_1[k];
      L_q[2 * k + 1] = s_v1_v2 - own.G2 * of.sine_2[k];
    }
    if (L_v) {
      L_v[2 * k] = own.A * of.v1[k] + dvi_taylor_product(k, of.c, of.v2);
      L_v[2 * k + 1] = own.B * of.v2[k] + dvi_taylor_product(k, of.c, of.v1);
    }
    if (L_qq || L_qv || L_vv) double_pendulum_series_hessian(&own, &of, k, L_qq, L_qv, L_vv);
  }
  return 0;
}

static dvi_status double_pendulum_make(const double *setting, problem *made)
{
  const dvi_status status = problem_room(made, 2, sizeof(double_pendulum_coefficients));
  if (status != DVI_OK) return status;
  const double pi = 3.14159265358979323846;
  const double l1 = setting[0], l2 = setting[1], m1 = setting[2], m2 = setting[3], g = setting[4];
  double_pendulum_coefficients *own = made->parameters;
  *own = (double_pendulum_coefficients){.A = (m1 + m2) * l1 * l1,
                                        .B = m2 * l2 * l2,
                                        .C = m2 * l1 * l2,
                                        .G1 = (m1 + m2) * g * l1,
                                        .G2 = m2 * g * l2};
  problem_label(made, 0, "theta_1");
  problem_label(made, 1, "theta_2");
  made->q[0] = pi / 4.0;
  made->q[1] = pi / 2.0;
  made->v[1] = pi / 8.0;

  const dvi_lagrangian lagrangian = {.value_batch = double_pendulum_lagrangian,
                                     .gradient_batch = double_pendulum_gradient,
                                     .hessian_batch = double_pendulum_hessian,
                                     .user = own,
                                     .taylor = double_pendulum_taylor};
  const dvi_system_terms terms = {.dimension = 2, .lagrangian = &lagrangian, .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "l1",
     .value = 2.0,
     .least = 1e-50,
     .most = 1e50,
     .help = "the length of the upper rod, positive"},
    {.name = "l2",
     .value = 3.0,
     .least = 1e-50,
     .most = 1e50,
     .help = "the length of the lower rod, positive"},
    {.name = "m1", .value = 1.0, .least = 1e-50, .most = 1e50, .help = "the upper mass, positive"},
    {.name = "m2", .value = 2.0, .least = 1e-50, .most = 1e50, .help = "the lower mass, positive"},
    PROBLEM_GRAVITY(9.80665),
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.61490406957921587, 0.37981894693941085};
static const double digits_p[] = {-29.792570769056137, -47.393198976598959};
static const double far_q[] = {
    -0.48261051139722358,
    -0.19794040936359078,
};

const problem_entry problem_entry_double_pendulum = {
    .name = "double-pendulum",
    .summary = "two masses on two rods; a Lagrangian that is not separable",
    .parameters = parameters,
    .make = double_pendulum_make,
    .h = 0.02,
    .t_end = 20.0,
    .order_h = 0.05,
    .order_t_end = 1.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
    .far_t_end = 20.0,
    .far_q = far_q,
    .far_error = 4e-13,
};
