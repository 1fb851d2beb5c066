/* A rigid body without forces, Pi' = Pi x Omega, R' = R Omega^, with the exact solution by Jacobi's
 * elliptic functions.
 *
 * Axes 1, 2, 3 are ordered by their inertia, 2 is the middle one, and the motion goes round 3. With
 * u = lambda t + epsilon
 *     Omega = (A cn u, B sn u, C dn u),
 * where A, B, C and the modulus k follow from energy and momentum, written as sums of positive
 * terms of the start. For the attitude let l be the constant direction of the angular momentum L in
 * space. Axis 3 turns about l at the rate
 *     phi' = |L| (2 E - I3 Omega3^2)/(|L|^2 - I3^2 Omega3^2),
 * whose integral is one of the third kind, in u. Everything else follows from l in the body's
 * frame. am is computed by the descending Landen transformation (Abramowitz and Stegun 1964, sec.
 * 16.4), F and Pi by Carlson's R_F and R_J (Carlson 1995, Numer. Algorithms 10:13). The computation
 * is in long double, so that the result is closer where that has more digits than double. */
#include <float.h>
#include <math.h>

#include "bodies/top.h"

typedef long double real;

enum { LANDEN_MAX = 12 }; /* quadratic convergence */

/* The motion in the order of the axes. */
typedef struct free_body_motion {
  int axis[3];              /* indices of the body's axes 1, 2, 3 */
  real A, B, C, lambda, k2; /* amplitudes of Omega, rate of u, and modulus squared */
  real rest;                /* 1 - k2, without cancellation */
  real momentum, bend;      /* |L|, and n in the integral of the third kind, below 0 */
  real mean, excess;        /* phi = mean t + excess times that integral */
} free_body_motion;

/* ---- elliptic integrals ---- */

static real carlson_R_F(real x, real y, real z)
{
  const real close = powl(3.0L * LDBL_EPSILON, 1.0L / 6.0L);
  for (;;) {
    const real mean = (x + y + z) / 3.0L, dx = 1.0L - x / mean, dy = 1.0L - y / mean,
               dz = 1.0L - z / mean;
    if (fmaxl(fabsl(dx), fmaxl(fabsl(dy), fabsl(dz))) < close) {
      const real e2 = dx * dy - dz * dz, e3 = dx * dy * dz;
      return (1.0L + e2 * (e2 / 24.0L - 0.1L - 3.0L * e3 / 44.0L) + e3 / 14.0L) / sqrtl(mean);
    }
    const real shift = sqrtl(x) * sqrtl(y) + sqrtl(y) * sqrtl(z) + sqrtl(z) * sqrtl(x);
    x = 0.25L * (x + shift);
    y = 0.25L * (y + shift);
    z = 0.25L * (z + shift);
  }
}

/* Compute R_C(1, 1 + e) for small e > -1, which is atan(sqrt e)/sqrt e or its continuation. */
static real carlson_R_C1(real e)
{
  if (fabsl(e) < 1e-5L) return 1.0L - e * (1.0L / 3.0L - e * (0.2L - e * (1.0L / 7.0L - e / 9.0L)));
  const real root = sqrtl(fabsl(e));
  return e > 0.0L ? atanl(root) / root : atanhl(root) / root;
}

/* Compute R_J's series for arguments X, Y, Z, P that are nearly equal. */
static real carlson_near_R_J(real X, real Y, real Z)
{
  const real P = -0.5L * (X + Y + Z), XYZ = X * Y * Z, E2 = X * Y + X * Z + Y * Z - 3.0L * P * P;
  const real E3 = XYZ + 2.0L * E2 * P + 4.0L * P * P * P,
             E4 = (2.0L * XYZ + E2 * P + 3.0L * P * P * P) * P, E5 = XYZ * P * P;
  return 1.0L - 3.0L * E2 / 14.0L + E3 / 6.0L + 9.0L * E2 * E2 / 88.0L - 3.0L * E4 / 22.0L -
         9.0L * E2 * E3 / 52.0L + 3.0L * E5 / 26.0L;
}

static real carlson_R_J(real x, real y, real z, real p)
{
  const real first = (x + y + z + 2.0L * p) / 5.0L, X = first - x, Y = first - y, Z = first - z;
  const real apart = fmaxl(fmaxl(fabsl(X), fabsl(Y)), fmaxl(fabsl(Z), fabsl(first - p))) *
                     powl(0.25L * LDBL_EPSILON, -1.0L / 6.0L);
  real delta = (p - x) * (p - y) * (p - z), scale = 1.0L, mean = first, sum = 0.0L;
  while (scale * apart >= mean) {
    const real root_x = sqrtl(x), root_y = sqrtl(y), root_z = sqrtl(z), root_p = sqrtl(p);
    const real d = (root_p + root_x) * (root_p + root_y) * (root_p + root_z);
    const real shift = root_x * root_y + root_y * root_z + root_z * root_x;
    sum += scale / d * carlson_R_C1(delta / (d * d));
    x = 0.25L * (x + shift);
    y = 0.25L * (y + shift);
    z = 0.25L * (z + shift);
    p = 0.25L * (p + shift);
    mean = 0.25L * (mean + shift);
    delta /= 64.0L;
    scale *= 0.25L;
  }
  const real part = scale / mean;
  return part / sqrtl(mean) * carlson_near_R_J(part * X, part * Y, part * Z) + 6.0L * sum;
}

/* Compute the integrals of du and of du/(1 - n sn^2 u) from 0 to the amplitude whose sine and
 * cosine are given, |amplitude| <= pi/2. */
static real first_kind(const free_body_motion *m, real sine, real cosine)
{
  return sine * carlson_R_F(cosine * cosine, cosine * cosine + m->rest * sine * sine, 1.0L);
}

static real third_kind(const free_body_motion *m, real sine, real cosine)
{
  const real s2 = sine * sine, c2 = cosine * cosine, d2 = c2 + m->rest * s2;
  return sine * carlson_R_F(c2, d2, 1.0L) +
         m->bend / 3.0L * sine * s2 * carlson_R_J(c2, d2, 1.0L, 1.0L - m->bend * s2);
}

/* Compute am(u) for |u| <= K. */
static real jacobi_amplitude(const free_body_motion *m, real u)
{
  real a[LANDEN_MAX + 1], c[LANDEN_MAX + 1], b = sqrtl(m->rest);
  int last = 0;
  a[0] = 1.0L;
  c[0] = sqrtl(m->k2);
  while (last < LANDEN_MAX && c[last] > LDBL_EPSILON * a[last]) {
    last++;
    a[last] = 0.5L * (a[last - 1] + b);
    c[last] = 0.5L * (a[last - 1] - b);
    b = sqrtl(a[last - 1] * b);
  }
  real phi = ldexpl(a[last] * u, last);
  for (; last > 0; last--) phi = 0.5L * (phi + asinl(c[last] / a[last] * sinl(phi)));
  return phi;
}

/* ---- the motion ---- */

/* Sort the axes by descending inertia, or by ascending inertia if the motion goes round the
 * largest. Returns the sign of this permutation. */
static int sort_axes(const double *J, const double *Omega, int *axis)
{
  int sign = 1;
  for (int i = 0; i < 3; i++) axis[i] = i;
  for (int pass = 0; pass < 3; pass++)
    for (int i = pass % 2; i < 2; i += 2)
      if (J[axis[i]] < J[axis[i + 1]]) {
        const int kept = axis[i];
        axis[i] = axis[i + 1];
        axis[i + 1] = kept;
        sign = -sign;
      }
  const real I1 = J[axis[0]], I2 = J[axis[1]], I3 = J[axis[2]], w1 = Omega[axis[0]],
             w3 = Omega[axis[2]];
  if (I1 * (I1 - I2) * w1 * w1 <= I3 * (I2 - I3) * w3 * w3) return sign;
  const int kept = axis[0];
  axis[0] = axis[2];
  axis[2] = kept;
  return -sign;
}

/* Compute the constants of the motion from the start. Returns 0, or 1 on the separatrix, where the
 * motion tends to a turn about the middle axis. */
static int find_motion(const double *J, const double *Omega, free_body_motion *m)
{
  const int sign = sort_axes(J, Omega, m->axis);
  const real I1 = J[m->axis[0]], I2 = J[m->axis[1]], I3 = J[m->axis[2]];
  const real w1 = Omega[m->axis[0]], w2 = Omega[m->axis[1]], w3 = Omega[m->axis[2]];
  const real L2 = I1 * I1 * w1 * w1 + I2 * I2 * w2 * w2 + I3 * I3 * w3 * w3;
  m->A = sqrtl(w1 * w1 + I2 * (I2 - I3) / (I1 * (I1 - I3)) * w2 * w2);
  m->B = sqrtl(w2 * w2 + I1 * (I1 - I3) / (I2 * (I2 - I3)) * w1 * w1);
  m->C = copysignl(sqrtl(w3 * w3 + I2 * (I1 - I2) / (I3 * (I1 - I3)) * w2 * w2), w3);
  m->lambda = sign * (I3 - I1) * m->A * m->C / (m->B * I2);
  m->k2 = (I1 - I2) * I2 * m->B * m->B / (I3 * (I1 - I3) * m->C * m->C);
  m->rest = (I1 * (I1 - I2) * w1 * w1 + I3 * (I3 - I2) * w3 * w3) / (I3 * (I3 - I2) * m->C * m->C);
  if (!(m->rest > 0.0L)) return 1;
  const real least = I1 * I1 * m->A * m->A; /* least |L|^2 - I3^2 Omega3^2 */
  m->momentum = sqrtl(L2);
  m->bend = -I3 * I3 * m->C * m->C * m->k2 / least;
  m->mean = m->momentum / I3;
  m->excess = m->momentum * (I1 * (I3 - I1) * w1 * w1 + I2 * (I3 - I2) * w2 * w2) /
              (I3 * least * m->lambda);
  return 0;
}

/* Compute Omega at time t in the body's axes, and the angle phi by which axis 3 has turned about
 * the angular momentum since t = 0. */
static void follow_motion(const free_body_motion *m, const double *Omega, real t, real *w,
                          real *phi)
{
  const real K = first_kind(m, 1.0L, 0.0L), whole = third_kind(m, 1.0L, 0.0L);
  const real cosine = Omega[m->axis[0]] / m->A, sine = Omega[m->axis[1]] / m->B,
             side = cosine < 0.0L ? -1.0L : 1.0L;
  const real before = cosine < 0.0L; /* half periods */
  const real u = 2.0L * K * before + first_kind(m, side * sine, side * cosine) + m->lambda * t;
  const real halves = roundl(u / (2.0L * K)), am = jacobi_amplitude(m, u - 2.0L * K * halves);
  const real sn = sinl(am), cn = cosl(am), turn = fmodl(fabsl(halves), 2.0L) > 0.5L ? -1.0L : 1.0L;
  w[m->axis[0]] = turn * m->A * cn;
  w[m->axis[1]] = turn * m->B * sn;
  w[m->axis[2]] = m->C * sqrtl(cn * cn + m->rest * sn * sn);
  const real integral = 2.0L * whole * (halves - before) + third_kind(m, sn, cn) -
                        third_kind(m, side * sine, side * cosine);
  *phi = m->mean * t + m->excess * integral;
}

/* Compute a rotation T [9]. Its rows are the part of axis `third` across the angular momentum Pi,
 * the cross product of that part, and Pi's direction. */
static void momentum_frame(const real *Pi, int third, real *T)
{
  const real size = sqrtl(Pi[0] * Pi[0] + Pi[1] * Pi[1] + Pi[2] * Pi[2]);
  const int i = (third + 1) % 3, j = (third + 2) % 3;
  const real across = hypotl(Pi[i], Pi[j]);
  T[third] = across / size;
  T[i] = -Pi[third] * Pi[i] / (size * across);
  T[j] = -Pi[third] * Pi[j] / (size * across);
  for (int k = 0; k < 3; k++) T[6 + k] = Pi[k] / size;
  for (int k = 0; k < 3; k++)
    T[3 + k] = T[6 + (k + 1) % 3] * T[(k + 2) % 3] - T[6 + (k + 2) % 3] * T[(k + 1) % 3];
}

/* Compute R = T0^T (turn by phi about the third axis) T, from R = I at the start. */
static void motion_attitude(const real *T0, const real *T, real phi, double *R)
{
  const real c = cosl(phi), s = sinl(phi);
  for (int j = 0; j < 3; j++) {
    const real column[3] = {c * T[j] - s * T[3 + j], s * T[j] + c * T[3 + j], T[6 + j]};
    for (int i = 0; i < 3; i++)
      R[3 * i + j] = (double)(T0[i] * column[0] + T0[3 + i] * column[1] + T0[6 + i] * column[2]);
  }
}

/* Compute R = exp(t Omega^) by Rodrigues' formula. A turn about a principal axis, or any turn of a
 * ball, is steady. */
static void turn_steadily(const double *Omega, real t, double *R)
{
  const real x = Omega[0], y = Omega[1], z = Omega[2], rate = sqrtl(x * x + y * y + z * z),
             scale = rate > 0.0L ? rate : 1.0L;
  const real axis[3] = {x / scale, y / scale, z / scale}, s = sinl(rate * t),
             half = sinl(0.5L * rate * t), versine = 2.0L * half * half;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const real hat = i == j ? 0.0L : ((j + 1) % 3 == i ? axis[3 - i - j] : -axis[3 - i - j]);
      R[3 * i + j] = (double)((i == j ? 1.0L - versine : 0.0L) + s * hat +
                              versine * axis[i] * axis[j]);
    }
}

static int is_steady(const double *Pi, const double *Omega)
{
  int steady = 1;
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    steady &= !(Pi[j] * Omega[k] < Pi[k] * Omega[j]) && !(Pi[j] * Omega[k] > Pi[k] * Omega[j]);
  }
  return steady;
}

static int free_body_exact(const problem *made, double t, double *q, double *p)
{
  const double *full = ((const top *)made->parameters)->J, J[3] = {full[0], full[4], full[8]};
  free_body_motion m;
  real w[3], start[3], end[3], phi, T0[9], T[9];
  if (is_steady(made->p, made->v)) {
    turn_steadily(made->v, t, q);
    for (int i = 0; i < 3; i++) p[i] = made->p[i];
    return 0;
  }
  if (find_motion(J, made->v, &m) != 0) return 1;
  follow_motion(&m, made->v, t, w, &phi);
  for (int i = 0; i < 3; i++) {
    start[i] = (real)J[i] * made->v[i];
    end[i] = J[i] * w[i];
    p[i] = (double)end[i];
  }
  momentum_frame(start, m.axis[2], T0);
  momentum_frame(end, m.axis[2], T);
  motion_attitude(T0, T, phi, q);
  return 0;
}

static dvi_status free_body_make(const double *setting, problem *made)
{
  const dvi_status status = top_room(made, setting + 3);
  if (status != DVI_OK) return status;
  top_inertia(made->parameters, setting);
  return top_system(made, NULL);
}

static const problem_parameter parameters[] = {
    TOP_INERTIA("J1", 3.0),   TOP_INERTIA("J2", 2.0),    TOP_INERTIA("J3", 1.5),
    TOP_START("Omega1", 0.5), TOP_START("Omega2", -0.5), TOP_START("Omega3", 0.4),
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.43973921242427894,  0.55114463629079535,  -0.70913257924337514,
                                  -0.87164410175790596, 0.071575174600853345, -0.48488509386401091,
                                  -0.21648553052601044, 0.83133421935389151,  0.51187638234648758};
static const double digits_p[] = {1.4013616020787181, 1.2539423114476747, -0.27168794559315923};

const problem_entry problem_entry_free_body = {
    .name = "free-body",
    .summary = "a rigid body without forces; rotations, exact solution known",
    .parameters = parameters,
    .make = free_body_make,
    .exact = free_body_exact,
    .h = 0.1,
    .t_end = 100.0,
    .order_h = 0.2,
    .order_t_end = 10.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
