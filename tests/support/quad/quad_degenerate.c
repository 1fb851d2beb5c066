/* The catalogue's degenerate problems in quadruple precision. The velocity solves Omega(q) v =
 * dH/dq, by hand where Omega has blocks of two. Problems with a Hamiltonian and constraints have
 * accelerations. */
#include "quad_system.h"

/* Solves a block of two coordinates, omega (v2, -v1) = (H_1, H_2). */
static void turn(quad omega, quad H_1, quad H_2, quad *v)
{
  v[0] = -H_2 / omega;
  v[1] = H_1 / omega;
}

/* Volterra's equations, with Omega_12 = -1/(q1 q2). */
static void lotka_volterra_prepare(quad_system *system)
{
  system->n = 2;
  system->q[0] = system->value[0];
  system->q[1] = system->value[1];
}

static void lotka_volterra_rate(const quad_system *system, const quad *q, quad *v)
{
  (void)system;
  v[0] = q[0] * (q[1] - 2);
  v[1] = q[1] * (1 - q[0]);
}

static void lotka_volterra_momentum(const quad_system *system, const quad *q, const quad *v,
                                    quad *p)
{
  (void)system, (void)v;
  p[0] = q[1] + quad_log(q[1]) / q[0];
  p[1] = q[0];
}

static const int C[4][4] = {{0, 1, -1, 1}, {-1, 0, 1, -1}, {1, -1, 0, 1}, {-1, 1, -1, 0}};

static void species_prepare(quad_system *system)
{
  system->n = 4;
  system->q[0] = 2;
  system->q[1] = system->q[2] = system->q[3] = 1;
}

/* A 4 x 4 system by Gauss's elimination with the largest pivot. */
static void eliminate(quad A[4][4], quad *b)
{
  for (int k = 0; k < 4; k++) {
    int pivot = k;
    for (int i = k + 1; i < 4; i++)
      if (quad_abs(A[i][k]) > quad_abs(A[pivot][k])) pivot = i;
    for (int j = 0; j < 4; j++) {
      const quad kept = A[k][j];
      A[k][j] = A[pivot][j];
      A[pivot][j] = kept;
    }
    const quad kept = b[k];
    b[k] = b[pivot];
    b[pivot] = kept;
    for (int i = k + 1; i < 4; i++) {
      const quad factor = A[i][k] / A[k][k];
      for (int j = k; j < 4; j++) A[i][j] -= factor * A[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (int k = 3; k >= 0; k--) {
    for (int j = k + 1; j < 4; j++) b[k] -= A[k][j] * b[j];
    b[k] /= A[k][k];
  }
}

/* With Omega_ij = -C_ij/(q_i q_j) the equations are sum_j C_ij (v_j/q_j) = -(q_i + b_i). */
static void species_rate(const quad_system *system, const quad *q, quad *v)
{
  static const int b[4] = {-1, -2, -1, -1};
  quad A[4][4];
  (void)system;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) A[i][j] = C[i][j];
    v[i] = -(q[i] + b[i]);
  }
  eliminate(A, v);
  for (int i = 0; i < 4; i++) v[i] *= q[i];
}

static void species_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  (void)system, (void)v;
  for (int i = 0; i < 4; i++) {
    p[i] = 0;
    for (int j = 0; j < 4; j++) p[i] += C[i][j] * quad_log(q[j]) / (2 * q[i]);
  }
}

static void massless_prepare(quad_system *system)
{
  system->n = 2;
  system->q[0] = system->q[1] = 1;
}

static void massless_rate(const quad_system *system, const quad *q, quad *v)
{
  (void)system;
  turn(1 + 2 * (q[0] * q[0] + q[1] * q[1]), -quad_sin(q[0]), quad_cos(q[1]), v);
}

static void massless_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  const quad half = (1 + q[0] * q[0] + q[1] * q[1]) / 2;
  (void)system, (void)v;
  p[0] = -half * q[1];
  p[1] = half * q[0];
}

static void vortices_linear_prepare(quad_system *system)
{
  system->n = 4;
  system->q[0] = quad_number("1/3");
  system->q[2] = quad_number("-2/3");
}

static void vortices_linear_rate(const quad_system *system, const quad *q, quad *v)
{
  const quad dx = q[0] - q[2], dy = q[1] - q[3],
             strength = 2 * 8 / (4 * quad_acos(-1) * (dx * dx + dy * dy));
  (void)system;
  turn(4, strength * dx, strength * dy, v);
  turn(2, -strength * dx, -strength * dy, v + 2);
}

static void vortices_linear_momentum(const quad_system *system, const quad *q, const quad *v,
                                     quad *p)
{
  (void)system, (void)v;
  p[0] = -2 * q[1];
  p[1] = 2 * q[0];
  p[2] = -q[3];
  p[3] = q[2];
}

static void vortices_prepare(quad_system *system)
{
  system->n = 4;
  system->q[0] = system->q[2] = quad_number("0.5");
  system->q[1] = quad_number("0.1");
  system->q[3] = quad_number("-0.1");
}

/* H = S_1 S_2 ln d^2/(8 pi), and Omega of one vortex is (1 + 2 r^2)/2. */
static void vortices_rate(const quad_system *system, const quad *q, quad *v)
{
  const quad dx = q[0] - q[2], dy = q[1] - q[3], d2 = dx * dx + dy * dy,
             factor = 1 / (8 * quad_acos(-1));
  const quad r2[2] = {q[0] * q[0] + q[1] * q[1], q[2] * q[2] + q[3] * q[3]};
  const quad both = (1 + r2[0]) * (1 + r2[1]) / d2, l = quad_log(d2);
  (void)system;
  for (int k = 0; k < 2; k++) {
    const quad *x = q + 2 * k, side = k == 0 ? 1 : -1, other = (1 + r2[1 - k]) * l;
    turn((1 + 2 * r2[k]) / 2, factor * (2 * x[0] * other + 2 * side * dx * both),
         factor * (2 * x[1] * other + 2 * side * dy * both), v + 2 * k);
  }
}

static void vortices_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  (void)system, (void)v;
  for (int k = 0; k < 4; k += 2) {
    const quad quarter = (1 + q[k] * q[k] + q[k + 1] * q[k + 1]) / 4;
    p[k] = -quarter * q[k + 1];
    p[k + 1] = quarter * q[k];
  }
}

static void guiding_centre_prepare(quad_system *system)
{
  system->n = 4;
  system->q[0] = system->q[3] = quad_number("0.5");
}

static void guiding_centre_rate(const quad_system *system, const quad *q, quad *v)
{
  const quad twice_mu = quad_number("0.02");
  (void)system;
  turn(1 + q[0] * q[0] + q[1] * q[1], twice_mu * q[0], twice_mu * q[1], v);
  v[2] = q[3];
  v[3] = 0;
}

static void guiding_centre_momentum(const quad_system *system, const quad *q, const quad *v,
                                    quad *p)
{
  const quad s = (2 + q[0] * q[0] + q[1] * q[1]) / 4;
  (void)system, (void)v;
  p[0] = -q[1] * s;
  p[1] = q[0] * s;
  p[2] = q[3];
  p[3] = 0;
}

static void tokamak_prepare(quad_system *system)
{
  system->n = 4;
  system->q[0] = quad_number("1.05");
  system->q[3] = quad_number("4.306e-4");
}

/* Gives b = B/|B| in covariant components, from |B|^2 = B_R^2 + B_Z^2 + B_phi^2/R^2, and returns
 * |B|. */
static quad tokamak_field(const quad *q, quad *b)
{
  const quad R = q[0], Z = q[1], B_R = -Z / (2 * R), B_Z = (R - 1) / (2 * R);
  const quad strength = quad_sqrt(B_R * B_R + B_Z * B_Z + 1 / (R * R));
  b[0] = B_R / strength;
  b[1] = B_Z / strength;
  b[2] = 1 / strength;
  return strength;
}

/* b_x and |B|_x for x = R (j = 0) and Z (j = 1), by the quotient rule on the components. */
static quad tokamak_slopes(const quad *q, int j, quad *b_x)
{
  const quad R = q[0], Z = q[1], R2 = R * R, B_R = -Z / (2 * R), B_Z = (R - 1) / (2 * R);
  const quad B_Rx = j == 0 ? Z / (2 * R2) : -1 / (2 * R), B_Zx = j == 0 ? 1 / (2 * R2) : 0,
             inverse_x = j == 0 ? -1 / (R2 * R) : 0;
  quad b[3];
  const quad strength = tokamak_field(q, b),
             slope = (B_R * B_Rx + B_Z * B_Zx + inverse_x) / strength;
  b_x[0] = B_Rx / strength - b[0] * slope / strength;
  b_x[1] = B_Zx / strength - b[1] * slope / strength;
  b_x[2] = -b[2] * slope / strength;
  return slope;
}

static void tokamak_rate(const quad_system *system, const quad *q, quad *v)
{
  const quad mu = quad_number("2.25e-6"), R = q[0], Z = q[1], u = q[3];
  quad b[3], b_R[3], b_Z[3], omega[4][4] = {{0}};
  (void)system;
  (void)tokamak_field(q, b);
  v[0] = mu * tokamak_slopes(q, 0, b_R);
  v[1] = mu * tokamak_slopes(q, 1, b_Z);
  v[2] = 0;
  v[3] = u;
  /* A = (Z/(2R), -ln(R)/2, ((R-1)^2 + Z^2)/4). */
  omega[0][1] = -1 / (2 * R) - 1 / (2 * R) + u * (b_R[1] - b_Z[0]);
  omega[0][2] = (R - 1) / 2 + u * b_R[2];
  omega[1][2] = Z / 2 + u * b_Z[2];
  for (int i = 0; i < 3; i++) omega[i][3] = -b[i];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < i; j++) omega[i][j] = -omega[j][i];
  eliminate(omega, v);
}

static void tokamak_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  const quad R = q[0], Z = q[1], u = q[3];
  quad b[3];
  (void)system, (void)v;
  (void)tokamak_field(q, b);
  p[0] = Z / (2 * R) + u * b[0];
  p[1] = -quad_log(R) / 2 + u * b[1];
  p[2] = ((R - 1) * (R - 1) + Z * Z) / 4 + u * b[2];
  p[3] = 0;
}

/* A particle on a circle, x'' = (0,-1) - mu x with the mu that keeps |x| = 1. */
static void circle_prepare(quad_system *system)
{
  system->n = 2;
  system->q[0] = quad_number("0.8");
  system->q[1] = quad_number("0.6");
  system->v[0] = system->q[1] * system->value[0];
  system->v[1] = -system->q[0] * system->value[0];
}

static void circle_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const quad mu = (v[0] * v[0] + v[1] * v[1] - q[1]) / (q[0] * q[0] + q[1] * q[1]);
  (void)system;
  a[0] = -mu * q[0];
  a[1] = -1 - mu * q[1];
}

/* x'' = -x - y'/2, S y' = -cos z, S z' = -x'/2 - sin y with S = 1 + y^2 + z^2. The last two are
 * differentiated. */
static void pair_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  const quad S = 1 + q[1] * q[1] + q[2] * q[2];
  (void)system;
  v[0] = p[0] - q[1] / 2;
  v[1] = -quad_cos(q[2]) / S;
  v[2] = (-v[0] / 2 - quad_sin(q[1])) / S;
}

static void pair_prepare(quad_system *system)
{
  const quad p[3] = {quad_number("0.5"), 0, 0};
  system->n = 3;
  system->q[0] = quad_number("0.5");
  system->q[1] = system->q[2] = 1;
  pair_velocity(system, system->q, p, system->v);
}

static void pair_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const quad S = 1 + q[1] * q[1] + q[2] * q[2], S_t = 2 * (q[1] * v[1] + q[2] * v[2]);
  (void)system;
  a[0] = -q[0] - v[1] / 2;
  a[1] = (quad_sin(q[2]) * v[2] - v[1] * S_t) / S;
  a[2] = (-a[0] / 2 - quad_cos(q[1]) * v[1] - v[2] * S_t) / S;
}

static void pair_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  (void)system;
  p[0] = v[0] + q[1] / 2;
  p[1] = -q[2] * (1 + q[1] * q[1] + q[2] * q[2] / 3);
  p[2] = 0;
}

/* x' = cos theta, y' = sin theta, theta'' = p_x sin theta with p_x = -1. The first two are
 * differentiated. */
static void elastica_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  (void)system;
  v[0] = quad_cos(q[2]);
  v[1] = quad_sin(q[2]);
  v[2] = p[2];
}

static void elastica_prepare(quad_system *system)
{
  system->n = 3;
  system->v[0] = 1;
  system->v[2] = system->value[0];
}

static void elastica_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  (void)system;
  a[0] = -quad_sin(q[2]) * v[2];
  a[1] = quad_cos(q[2]) * v[2];
  a[2] = -quad_sin(q[2]);
}

static void elastica_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  (void)system, (void)q;
  p[0] = -1;
  p[1] = 0;
  p[2] = v[2];
}

#define DEGENERATE(name) .prepare = name##_prepare, .rate = name##_rate, .momentum = name##_momentum

const quad_problem quad_degenerate[] = {
    {.name = "lotka-volterra",
     .parameter = {"prey", "predators"},
     .standard = {"1", "1"},
     DEGENERATE(lotka_volterra)},
    {.name = "lotka-volterra-4d", DEGENERATE(species)},
    {.name = "massless-particle", DEGENERATE(massless)},
    {.name = "vortices-linear", DEGENERATE(vortices_linear)},
    {.name = "vortices", DEGENERATE(vortices)},
    {.name = "guiding-centre", DEGENERATE(guiding_centre)},
    {.name = "tokamak", DEGENERATE(tokamak)},
    {.name = "circle-dirac",
     .parameter = {"speed"},
     .standard = {"0.5"},
     .prepare = circle_prepare,
     .acceleration = circle_acceleration},
    {.name = "magnetic-pair",
     .prepare = pair_prepare,
     .acceleration = pair_acceleration,
     .momentum = pair_momentum,
     .velocity = pair_velocity},
    {.name = "elastica",
     .parameter = {"kappa"},
     .standard = {"1"},
     .prepare = elastica_prepare,
     .acceleration = elastica_acceleration,
     .momentum = elastica_momentum,
     .velocity = elastica_velocity},
    {.name = NULL},
};
