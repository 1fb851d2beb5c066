/* Mechanisms with holonomic constraints, from their definitions: the equations of index 1,
 *
 *     M a + G^T lambda = f,     G a = -(G v)_q v,
 *
 * by elimination. */
#include "quad_system.h"

enum { N = 7, ROWS = 6, ALL = N + ROWS };

/* M, f, G and (G v)_q v of a point. */
typedef struct mechanism {
  quad M[N][N], f[N], G[ROWS][N], bend[ROWS];
} mechanism;

/* Solve A x = b by Gauss's elimination with row pivots. */
static void eliminate(int n, quad A[ALL][ALL], quad *b, quad *x)
{
  for (int j = 0; j < n; j++) {
    int pivot = j;
    for (int i = j; i < n; i++)
      if (quad_abs(A[i][j]) > quad_abs(A[pivot][j])) pivot = i;
    for (int k = 0; k < n; k++) {
      const quad kept = A[j][k];
      A[j][k] = A[pivot][k];
      A[pivot][k] = kept;
    }
    const quad kept = b[j];
    b[j] = b[pivot];
    b[pivot] = kept;
    for (int i = j + 1; i < n; i++) {
      const quad factor = A[i][j] / A[j][j];
      for (int k = j; k < n; k++) A[i][k] -= factor * A[j][k];
      b[i] -= factor * b[j];
    }
  }
  for (int i = n - 1; i >= 0; i--) {
    x[i] = b[i];
    for (int k = i + 1; k < n; k++) x[i] -= A[i][k] * x[k];
    x[i] /= A[i][i];
  }
}

static void accelerate(const mechanism *m, quad *a)
{
  quad A[ALL][ALL] = {{0}}, b[ALL], x[ALL];
  for (int i = 0; i < N; i++) {
    for (int j = 0; j < N; j++) A[i][j] = m->M[i][j];
    for (int r = 0; r < ROWS; r++) A[i][N + r] = A[N + r][i] = m->G[r][i];
    b[i] = m->f[i];
  }
  for (int r = 0; r < ROWS; r++) b[N + r] = -m->bend[r];
  eliminate(ALL, A, b, x);
  for (int i = 0; i < N; i++) a[i] = x[i];
}

static void multiply(const mechanism *m, const quad *v, quad *p)
{
  for (int i = 0; i < N; i++) {
    p[i] = 0;
    for (int j = 0; j < N; j++) p[i] += m->M[i][j] * v[j];
  }
}

static void divide(const mechanism *m, const quad *p, quad *v)
{
  quad A[ALL][ALL] = {{0}}, b[ALL];
  for (int i = 0; i < N; i++) {
    for (int j = 0; j < N; j++) A[i][j] = m->M[i][j];
    b[i] = p[i];
  }
  eliminate(N, A, b, v);
}

/* ---- slider-crank: l1, l2, m1, m2, m3, g, rate; x1, y1, a1, x2, y2, a2, x3 ---- */

static void crank_at(const quad_system *system, const quad *q, const quad *v, mechanism *m)
{
  const quad *value = system->value, l1 = value[0], l2 = value[1], x1 = l1 * quad_cos(q[2]),
             y1 = l1 * quad_sin(q[2]), x2 = l2 * quad_cos(q[5]), y2 = l2 * quad_sin(q[5]),
             u = v[2] * v[2], w = v[5] * v[5];
  *m = (mechanism){.f = {0, -value[2] * value[5], 0, 0, -value[3] * value[5]},
                   .G = {{1, 0, y1 / 2},
                         {0, 1, -x1 / 2},
                         {0, 0, y1, 1, 0, y2 / 2},
                         {0, 0, -x1, 0, 1, -x2 / 2},
                         {0, 0, y1, 0, 0, y2, 1},
                         {0, 0, x1, 0, 0, x2}},
                   .bend = {x1 / 2 * u, y1 / 2 * u, x1 * u + x2 / 2 * w, y1 * u + y2 / 2 * w,
                            x1 * u + x2 * w, -y1 * u - y2 * w}};
  const quad mass[N] = {value[2], value[2], value[2] * l1 * l1 / 12,
                        value[3], value[3], value[3] * l2 * l2 / 12,
                        value[4]};
  for (int i = 0; i < N; i++) m->M[i][i] = mass[i];
}

static void crank_prepare(quad_system *system)
{
  const quad l1 = system->value[0], l2 = system->value[1], half = quad_sqrt(2) / 2, s = l1 * half,
             c = l2 * quad_sqrt(1 - s * s / (l2 * l2)), rate = system->value[6],
             follows = -s * rate / c;
  const quad q[N] = {s / 2, s / 2, quad_acos(half), s + c / 2, s / 2, quad_acos(c / l2), s + c},
             v[N] = {-s / 2 * rate,
                     s / 2 * rate,
                     rate,
                     -s * rate + s / 2 * follows,
                     s * rate + c / 2 * follows,
                     follows,
                     -s * rate + s * follows};
  system->n = N;
  for (int i = 0; i < N; i++) system->q[i] = q[i], system->v[i] = v[i];
  system->q[5] = -system->q[5];
}

static void crank_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  mechanism m;
  crank_at(system, q, v, &m);
  accelerate(&m, a);
}

static void crank_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  mechanism m;
  crank_at(system, q, v, &m);
  multiply(&m, v, p);
}

static void crank_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  mechanism m;
  crank_at(system, q, p, &m);
  divide(&m, p, v);
}

/* ---- Andrews' squeezer: beta, Theta, gamma, Phi, delta, Omega, epsilon ---- */

#define Q(digits) quad_number(digits)

static void squeezer_masses(const quad *q, quad M[N][N])
{
  const quad m1 = Q("0.04325"), m2 = Q("0.00365"), m3 = Q("0.02373"), m4 = Q("0.00706"),
             m5 = Q("0.07050"), m6 = Q("0.00706"), m7 = Q("0.05498"), ra = Q("0.00092"),
             rr = Q("0.007"), da = Q("0.0115"), sa = Q("0.01874"), sb = Q("0.01043"),
             h = Q("0.02") - Q("0.01421"), zt = Q("0.04"), ta = Q("0.02308"), tb = Q("0.00916"),
             f = Q("0.02") - Q("0.01421"), u = Q("0.04"), ua = Q("0.01228"), ub = Q("0.00449"),
             i2 = Q("4.410e-7"), i4 = Q("5.667e-7"), i6 = Q("5.667e-7");
  M[0][0] = m1 * ra * ra + m2 * (rr * rr - 2 * da * rr * quad_cos(q[1]) + da * da) + Q("2.194e-6") +
            i2;
  M[0][1] = M[1][0] = m2 * (da * da - da * rr * quad_cos(q[1])) + i2;
  M[1][1] = m2 * da * da + i2;
  M[2][2] = m3 * (sa * sa + sb * sb) + Q("5.255e-6");
  M[3][3] = m4 * h * h + i4;
  M[3][4] = M[4][3] = m4 * (h * h + zt * h * quad_sin(q[3])) + i4;
  M[4][4] = m4 * (zt * zt + 2 * zt * h * quad_sin(q[3]) + h * h) + m5 * (ta * ta + tb * tb) + i4 +
            Q("1.169e-5");
  M[5][5] = m6 * f * f + i6;
  M[5][6] = M[6][5] = m6 * (f * f - u * f * quad_sin(q[5])) + i6;
  M[6][6] = m6 * (f * f - 2 * u * f * quad_sin(q[5]) + u * u) + m7 * (ua * ua + ub * ub) + i6 +
            Q("1.912e-5");
}

static void squeezer_forces(const quad_system *system, const quad *q, const quad *v, quad *f)
{
  const quad m2 = Q("0.00365"), m4 = Q("0.00706"), m6 = Q("0.00706"), da = Q("0.0115"),
             rr = Q("0.007"), h = Q("0.02") - Q("0.01421"), zt = Q("0.04"), u = Q("0.04"),
             sd = Q("0.02"), sc = Q("0.018"), c = quad_cos(q[2]), s = quad_sin(q[2]),
             x = sd * c + sc * s + Q("-0.03635") - Q("0.014"),
             y = sd * s - sc * c + Q("0.03273") - Q("0.072"), length = quad_sqrt(x * x + y * y),
             pull = -system->value[1] * (length - Q("0.07785")) / length;
  f[0] = system->value[0] - m2 * da * rr * v[1] * (v[1] + 2 * v[0]) * quad_sin(q[1]);
  f[1] = m2 * da * rr * v[0] * v[0] * quad_sin(q[1]);
  f[2] = pull * (x * (sc * c - sd * s) + y * (sd * c + sc * s));
  f[3] = m4 * zt * h * v[4] * v[4] * quad_cos(q[3]);
  f[4] = -m4 * zt * h * v[3] * (v[3] + 2 * v[4]) * quad_cos(q[3]);
  f[5] = -m6 * u * h * v[6] * v[6] * quad_cos(q[5]);
  f[6] = m6 * u * h * v[5] * (v[5] + 2 * v[6]) * quad_cos(q[5]);
}

static void squeezer_rows(const quad *q, const quad *v, mechanism *m)
{
  const quad rr = Q("0.007"), d = Q("0.028"), ss = Q("0.035"), e = Q("0.02"), zt = Q("0.04"),
             zf = Q("0.02"), u = Q("0.04"), a = q[0] + q[1], b = q[3] + q[4], o = q[5] + q[6],
             va = (v[0] + v[1]) * (v[0] + v[1]), vb = (v[3] + v[4]) * (v[3] + v[4]),
             vo = (v[5] + v[6]) * (v[5] + v[6]);
  const quad x = -rr * quad_sin(q[0]) + d * quad_sin(a), y = rr * quad_cos(q[0]) - d * quad_cos(a),
             bx = -rr * quad_cos(q[0]) * v[0] * v[0] + d * quad_cos(a) * va,
             by = -rr * quad_sin(q[0]) * v[0] * v[0] + d * quad_sin(a) * va;
  for (int r = 0; r < ROWS; r++) {
    m->G[r][0] = r % 2 ? y : x;
    m->G[r][1] = r % 2 ? -d * quad_cos(a) : d * quad_sin(a);
    m->bend[r] = r % 2 ? by : bx;
  }
  m->G[0][2] = -ss * quad_cos(q[2]);
  m->G[1][2] = -ss * quad_sin(q[2]);
  m->bend[0] += ss * quad_sin(q[2]) * v[2] * v[2];
  m->bend[1] -= ss * quad_cos(q[2]) * v[2] * v[2];
  m->G[2][3] = -e * quad_cos(b);
  m->G[2][4] = -e * quad_cos(b) + zt * quad_sin(q[4]);
  m->G[3][3] = -e * quad_sin(b);
  m->G[3][4] = -e * quad_sin(b) - zt * quad_cos(q[4]);
  m->bend[2] += e * quad_sin(b) * vb + zt * quad_cos(q[4]) * v[4] * v[4];
  m->bend[3] += -e * quad_cos(b) * vb + zt * quad_sin(q[4]) * v[4] * v[4];
  m->G[4][5] = zf * quad_sin(o);
  m->G[4][6] = zf * quad_sin(o) - u * quad_cos(q[6]);
  m->G[5][5] = -zf * quad_cos(o);
  m->G[5][6] = -zf * quad_cos(o) - u * quad_sin(q[6]);
  m->bend[4] += zf * quad_cos(o) * vo + u * quad_sin(q[6]) * v[6] * v[6];
  m->bend[5] += zf * quad_sin(o) * vo - u * quad_cos(q[6]) * v[6] * v[6];
}

static void squeezer_prepare(quad_system *system)
{
  static const char *const start[N] = {
      "-0.0617138900142764496358948458001", "0",
      "0.455279819163070380255912382449",   "0.222668390165885884674473185609",
      "0.487364979543842550225598953530",   "-0.222668390165885884674473185609",
      "1.23054744454982119249735015568"};
  system->n = N;
  for (int i = 0; i < N; i++) system->q[i] = quad_number(start[i]);
}

static void squeezer_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  mechanism m = {.f = {0}};
  squeezer_masses(q, m.M);
  squeezer_forces(system, q, v, m.f);
  squeezer_rows(q, v, &m);
  accelerate(&m, a);
}

static void squeezer_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  mechanism m = {.f = {0}};
  (void)system;
  squeezer_masses(q, m.M);
  multiply(&m, v, p);
}

static void squeezer_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  mechanism m = {.f = {0}};
  (void)system;
  squeezer_masses(q, m.M);
  divide(&m, p, v);
}

const quad_problem quad_mechanisms[] = {
    {.name = "slider-crank",
     .parameter = {"l1", "l2", "m1", "m2", "m3", "g", "rate"},
     .standard = {"0.3", "1", "0.2", "0.5", "0.3", "9.81", "6"},
     .prepare = crank_prepare,
     .acceleration = crank_acceleration,
     .momentum = crank_momentum,
     .velocity = crank_velocity},
    {.name = "andrews",
     .parameter = {"mom", "c0"},
     .standard = {"0.033", "4530"},
     .prepare = squeezer_prepare,
     .acceleration = squeezer_acceleration,
     .momentum = squeezer_momentum,
     .velocity = squeezer_velocity},
    {.name = NULL},
};
