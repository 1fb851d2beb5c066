/* The catalogue's problems in quadruple precision, from their definitions. */
#include <string.h>

#include "quad_system.h"

/* Reads the number at *text, and moves *text behind it. */
static quad next_number(const char **text)
{
  char *end;
  quad number = quad_parse(*text, &end);
  if (*end == '/') number /= quad_parse(end + 1, &end);
  *text = end;
  return number;
}

quad quad_number(const char *text)
{
  return next_number(&text);
}

static quad cube(quad x)
{
  return x * x * x;
}

/* q'' = -k q. */
static void oscillator_prepare(quad_system *system)
{
  system->n = 1;
  system->q[0] = quad_number("0.5");
}

static void oscillator_acceleration(const quad_system *system, const quad *q, const quad *v,
                                    quad *a)
{
  (void)v;
  a[0] = -system->value[0] * q[0];
}

/* q'' = -(1 + omega^2) q. */
static void oscillators_prepare(quad_system *system)
{
  system->n = 1;
  system->q[0] = 1;
}

static void oscillators_acceleration(const quad_system *system, const quad *q, const quad *v,
                                     quad *a)
{
  (void)v;
  a[0] = -(1 + system->value[0] * system->value[0]) * q[0];
}

/* H = p^2/2 + cos q. */
static void pendulum_prepare(quad_system *system)
{
  system->n = 1;
  system->q[0] = system->value[0];
}

static void pendulum_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  (void)system, (void)v;
  a[0] = quad_sin(q[0]);
}

static void kepler_prepare(quad_system *system)
{
  const quad e = system->value[0];
  system->n = 2;
  system->q[0] = 1 - e;
  system->v[1] = quad_sqrt((1 + e) / (1 - e));
}

static void kepler_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const quad r3 = cube(quad_sqrt(q[0] * q[0] + q[1] * q[1]));
  (void)system, (void)v;
  a[0] = -q[0] / r3;
  a[1] = -q[1] / r3;
}

/* V = (x^2+y^2)/2 + lambda (x^2 y - y^3/3). */
static void henon_heiles_prepare(quad_system *system)
{
  system->n = 2;
  system->q[0] = system->q[1] = quad_number("0.2");
  system->v[0] = system->v[1] = quad_number("0.3");
}

static void henon_heiles_acceleration(const quad_system *system, const quad *q, const quad *v,
                                      quad *a)
{
  const quad lambda = system->value[0], x = q[0], y = q[1];
  (void)v;
  a[0] = -x - 2 * lambda * x * y;
  a[1] = -y - lambda * (x * x - y * y);
}

/* Two point masses m1, m2. The first is at (l1 sin t1, -l1 cos t1), the second is (l2 sin t2, -l2
 * cos t2) away from it, and M(theta) omega = p. */
typedef struct mass_matrix {
  quad upper, coupling, lower;
} mass_matrix;

static mass_matrix double_pendulum_mass(const quad_system *system, const quad *q)
{
  const quad l1 = system->value[0], l2 = system->value[1], m1 = system->value[2],
             m2 = system->value[3];
  return (mass_matrix){(m1 + m2) * l1 * l1, m2 * l1 * l2 * quad_cos(q[0] - q[1]), m2 * l2 * l2};
}

static void mass_solve(mass_matrix M, quad upper, quad lower, quad *v)
{
  const quad determinant = M.upper * M.lower - M.coupling * M.coupling;
  v[0] = (M.lower * upper - M.coupling * lower) / determinant;
  v[1] = (M.upper * lower - M.coupling * upper) / determinant;
}

static void double_pendulum_prepare(quad_system *system)
{
  const quad pi = quad_acos(-1);
  system->n = 2;
  system->q[0] = pi / 4;
  system->q[1] = pi / 2;
  system->v[1] = pi / 8;
}

static void double_pendulum_acceleration(const quad_system *system, const quad *q, const quad *v,
                                         quad *a)
{
  const quad l1 = system->value[0], l2 = system->value[1], m1 = system->value[2],
             m2 = system->value[3], g = system->value[4];
  const quad sine = m2 * l1 * l2 * quad_sin(q[0] - q[1]);
  const quad upper = -sine * v[1] * v[1] - (m1 + m2) * g * l1 * quad_sin(q[0]);
  const quad lower = sine * v[0] * v[0] - m2 * g * l2 * quad_sin(q[1]);
  mass_solve(double_pendulum_mass(system, q), upper, lower, a);
}

static void double_pendulum_momentum(const quad_system *system, const quad *q, const quad *v,
                                     quad *p)
{
  const mass_matrix M = double_pendulum_mass(system, q);
  p[0] = M.upper * v[0] + M.coupling * v[1];
  p[1] = M.coupling * v[0] + M.lower * v[1];
}

static void double_pendulum_velocity(const quad_system *system, const quad *q, const quad *p,
                                     quad *v)
{
  mass_solve(double_pendulum_mass(system, q), p[0], p[1], v);
}

/* L = v^2/2 + x'(t) v cos q - cos q with x' = a omega cos(omega t). The time stands behind the
 * velocity. */
static void driven_pendulum_prepare(quad_system *system)
{
  system->n = 1;
  system->q[0] = 2;
}

static void driven_pendulum_acceleration(const quad_system *system, const quad *q, const quad *v,
                                         quad *a)
{
  const quad omega = system->value[1],
             pull = system->value[0] * omega * omega * quad_sin(omega * v[1]);
  a[0] = quad_sin(q[0]) + pull * quad_cos(q[0]);
}

static void driven_pendulum_momentum(const quad_system *system, const quad *q, const quad *v,
                                     quad *p)
{
  p[0] = v[0] +
         system->value[0] * system->value[1] * quad_cos(system->value[1] * v[1]) * quad_cos(q[0]);
}

/* At t = 0. */
static void driven_pendulum_velocity(const quad_system *system, const quad *q, const quad *p,
                                     quad *v)
{
  v[0] = p[0] - system->value[0] * system->value[1] * quad_cos(q[0]);
}

/* L = m/2 (a'^2 + (l+a)^2 th'^2) + m g (l+a) cos th - k a^2/2. */
static void stiff_pendulum_prepare(quad_system *system)
{
  system->n = 2;
  system->q[0] = quad_number("0.05");
  system->q[1] = 1;
}

static void stiff_pendulum_acceleration(const quad_system *system, const quad *q, const quad *v,
                                        quad *a)
{
  const quad k = system->value[0], m = system->value[2], g = system->value[3],
             length = system->value[1] + q[0];
  a[0] = length * v[1] * v[1] + g * quad_cos(q[1]) - k / m * q[0];
  a[1] = -(g * quad_sin(q[1]) + 2 * v[0] * v[1]) / length;
}

static void stiff_pendulum_momentum(const quad_system *system, const quad *q, const quad *v,
                                    quad *p)
{
  const quad length = system->value[1] + q[0], m = system->value[2];
  p[0] = m * v[0];
  p[1] = m * length * length * v[1];
}

static void stiff_pendulum_velocity(const quad_system *system, const quad *q, const quad *p,
                                    quad *v)
{
  const quad length = system->value[1] + q[0], m = system->value[2];
  v[0] = p[0] / m;
  v[1] = p[1] / (m * length * length);
}

/* V = omega^2/2 sum x1_i^2 + 1/4 [ (x0_1-x1_1)^4 + sum (x0_{i+1}-x1_{i+1}-x0_i-x1_i)^4 +
 * (x0_ell+x1_ell)^4 ]. */
static void fpu_prepare(quad_system *system)
{
  const int ell = (int)system->value[0];
  if (ell < 1 || 2 * ell > QUAD_N_MAX) return;
  system->n = 2 * ell;
  system->q[0] = system->v[0] = system->v[ell] = 1;
  system->q[ell] = 1 / system->value[1];
}

static void fpu_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const int ell = system->n / 2;
  const quad square = system->value[1] * system->value[1];
  const quad *x0 = q, *x1 = q + ell;
  quad *a0 = a, *a1 = a + ell;
  (void)v;
  for (int i = 0; i < ell; i++) {
    a0[i] = 0;
    a1[i] = -square * x1[i];
  }
  const quad first = cube(x0[0] - x1[0]), last = cube(x0[ell - 1] + x1[ell - 1]);
  a0[0] -= first;
  a1[0] += first;
  a0[ell - 1] -= last;
  a1[ell - 1] -= last;
  for (int i = 0; i + 1 < ell; i++) {
    const quad force = cube(x0[i + 1] - x1[i + 1] - x0[i] - x1[i]);
    a0[i] += force;
    a1[i] += force;
    a0[i + 1] -= force;
    a1[i + 1] += force;
  }
}

/* V = 0.64 sum exp(q_i - q_{i+1}), periodic. */
static void toda_prepare(quad_system *system)
{
  const int N = (int)system->value[0];
  if (N < 2 || N > QUAD_N_MAX) return;
  system->n = N;
  for (int i = 0; i < system->n; i++) {
    const quad xi = quad_number("-0.5") + (quad)i / (N - 1);
    const quad s = 6 * quad_abs(xi + quad_number("0.15"));
    if (s <= 1)
      system->q[i] = 1 - 3 * s * s / 2 + 3 * cube(s) / 4;
    else if (s <= 2)
      system->q[i] = cube(2 - s) / 4;
  }
}

static void toda_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const quad strength = (quad)64 / 100;
  (void)v;
  for (int i = 0; i < system->n; i++) a[i] = 0;
  for (int i = 0; i < system->n; i++) {
    const int next = i + 1 < system->n ? i + 1 : 0;
    const quad force = strength * quad_exp(q[i] - q[next]);
    a[i] -= force;
    a[next] += force;
  }
}

/* V = sum_{i=0}^{n} d_i^2/2 + beta d_i^4/4, d_i = q_{i+1} - q_i between walls at q_0 = q_{n+1} = 0,
 * with the start sin(pi k i/(n+1)). */
static void chain_prepare(quad_system *system)
{
  const int n = (int)system->value[0];
  if (n < 1 || n > QUAD_N_MAX) return;
  system->n = n;
  for (int i = 0; i < n; i++)
    system->q[i] = quad_sin(quad_acos(-1) * ((i + 1) * ((n + 7) / 8)) / (n + 1));
}

static void chain_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const int n = system->n;
  (void)v;
  for (int i = 0; i < n; i++) a[i] = 0;
  for (int i = 0; i <= n; i++) {
    const quad d = (i < n ? q[i] : 0) - (i > 0 ? q[i - 1] : 0),
               force = d + system->value[1] * cube(d);
    if (i < n) a[i] -= force;
    if (i > 0) a[i - 1] += force;
  }
}

/* V = k/2 sum (|d| - 0.8)^2 over the springs of a net of side^dim masses, and those to its walls. q
 * are displacements from a grid of spacing 1. A mass has 2 dim springs, each judged from its own
 * end. */
static int net_masses(const quad_system *system)
{
  const int side = (int)system->value[1];
  return (int)system->value[0] == 2 ? side * side : side * side * side;
}

static void net_prepare(quad_system *system)
{
  const int dim = (int)system->value[0], side = (int)system->value[1];
  if (dim < 2 || dim > 3 || side < 1 || side > 5 || net_masses(system) * dim > QUAD_N_MAX) return;
  system->n = net_masses(system) * dim;
  for (int i = 0; i < system->n; i++) {
    quad bulge = quad_number(i % dim == 0 ? "0.1" : "0.05");
    for (int axis = 0, place = i / dim; axis < dim; axis++, place /= side)
      bulge *= quad_sin(quad_acos(-1) * (1 + place % side) / (side + 1));
    system->q[i] = bulge;
  }
}

/* The force on the mass whose coordinates begin at `at`, by the spring along an axis to `other`,
 * NULL for the wall. */
static void net_pull(int dim, quad k, const quad *at, const quad *other, int axis, int step,
                     quad *a)
{
  quad d[3], square = 0;
  for (int c = 0; c < dim; c++) {
    d[c] = (c == axis ? step : 0) + (other != NULL ? other[c] : 0) - at[c];
    square += d[c] * d[c];
  }
  const quad factor = k * (1 - quad_number("0.8") / quad_sqrt(square));
  for (int c = 0; c < dim; c++) a[c] += factor * d[c];
}

static void net_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const int dim = (int)system->value[0], side = (int)system->value[1];
  (void)v;
  for (int i = 0; i < system->n; i++) a[i] = 0;
  for (int mass = 0; mass < system->n / dim; mass++)
    for (int axis = 0, stride = 1; axis < dim; axis++, stride *= side)
      for (int step = -1; step <= 1; step += 2) {
        const int place = mass / stride % side + step;
        const quad *at = q + mass * dim;
        const quad *other = place >= 0 && place < side ? at + step * stride * dim : NULL;
        net_pull(dim, system->value[2], at, other, axis, step, a + mass * dim);
      }
}

/* Newton's gravity between point masses. q holds body after body. */
static void gravity_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const int d = system->dimension;
  (void)v;
  for (int j = 0; j < system->n; j++) a[j] = 0;
  for (int body = 0; body < system->bodies; body++)
    for (int other = 0; other < system->bodies; other++) {
      if (other == body) continue;
      quad r2 = 0;
      for (int i = 0; i < d; i++)
        r2 += (q[other * d + i] - q[body * d + i]) * (q[other * d + i] - q[body * d + i]);
      const quad pull = system->G * system->mass[other] / (r2 * quad_sqrt(r2));
      for (int i = 0; i < d; i++) a[body * d + i] += pull * (q[other * d + i] - q[body * d + i]);
    }
}

static void gravity_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  (void)q;
  for (int j = 0; j < system->n; j++) p[j] = system->mass[j / system->dimension] * v[j];
}

static void gravity_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  (void)q;
  for (int j = 0; j < system->n; j++) v[j] = p[j] / system->mass[j / system->dimension];
}

/* G, then each body's mass, position and velocity. */
static void gravity_prepare(quad_system *system, int bodies, int dimension, const char *numbers)
{
  system->bodies = bodies;
  system->dimension = dimension;
  system->n = bodies * dimension;
  system->G = next_number(&numbers);
  for (int body = 0; body < bodies; body++) {
    system->mass[body] = next_number(&numbers);
    for (int i = 0; i < dimension; i++) system->q[body * dimension + i] = next_number(&numbers);
    for (int i = 0; i < dimension; i++) system->v[body * dimension + i] = next_number(&numbers);
  }
}

static void outer_solar_prepare(quad_system *system)
{
  gravity_prepare(
      system, 6, 3,
      "2.95912208286e-4 "
      "0.000954786104043  -3.5023653 -3.8169847 -1.5507963  0.00565429 -0.00412490 -0.00190589 "
      "0.000285583733151  9.0755314 -3.0458353 -1.6483708  0.00168318 0.00483525 0.00192462 "
      "0.0000437273164546  8.3101420 -16.2901086 -7.2521278  0.00354178 0.00137102 0.00055029 "
      "0.0000517759138449  11.4707666 -25.7294829 -10.8169456  0.00288930 0.00114527 0.00039677 "
      "1/1.3e8  -15.5387357 -25.2225594 -3.1902382  0.00276725 -0.00170702 -0.00136504 "
      "1.00000597682  0 0 0  0 0 0");
}

static void figure_eight_prepare(quad_system *system)
{
  gravity_prepare(system, 3, 2,
                  "1 "
                  "1  0.97000436 -0.24308753  0.93240737/2 0.86473146/2 "
                  "1  -0.97000436 0.24308753  0.93240737/2 0.86473146/2 "
                  "1  0 0  -0.93240737 -0.86473146");
}

static void pythagorean_prepare(quad_system *system)
{
  gravity_prepare(system, 3, 2,
                  "1 "
                  "3  1 3  0 0 "
                  "4  -2 -1  0 0 "
                  "5  1 -1  0 0");
}

#define GRAVITY \
  .acceleration = gravity_acceleration, .momentum = gravity_momentum, .velocity = gravity_velocity

static const quad_problem problems[] = {
    {"oscillator",
     {"k"},
     {"0.5"},
     oscillator_prepare,
     oscillator_acceleration,
     NULL,
     NULL,
     NULL,
     NULL},
    {"oscillators",
     {"omega"},
     {"50"},
     oscillators_prepare,
     oscillators_acceleration,
     NULL,
     NULL,
     NULL,
     NULL},
    {"pendulum",
     {"q0"},
     {"1.1592794807274085998465837940224"},
     pendulum_prepare,
     pendulum_acceleration,
     NULL,
     NULL,
     NULL,
     NULL},
    {"kepler", {"e"}, {"0.6"}, kepler_prepare, kepler_acceleration, NULL, NULL, NULL, NULL},
    {"henon-heiles",
     {"lambda"},
     {"1"},
     henon_heiles_prepare,
     henon_heiles_acceleration,
     NULL,
     NULL,
     NULL,
     NULL},
    {"double-pendulum",
     {"l1", "l2", "m1", "m2", "g"},
     {"2", "3", "1", "2", "9.80665"},
     double_pendulum_prepare,
     double_pendulum_acceleration,
     double_pendulum_momentum,
     double_pendulum_velocity,
     NULL,
     NULL},
    {"driven-pendulum",
     {"a", "omega"},
     {"0.25", "2"},
     driven_pendulum_prepare,
     driven_pendulum_acceleration,
     driven_pendulum_momentum,
     driven_pendulum_velocity,
     NULL,
     NULL},
    {"stiff-pendulum",
     {"k", "l", "m", "g"},
     {"1e4", "1", "1", "9.81"},
     stiff_pendulum_prepare,
     stiff_pendulum_acceleration,
     stiff_pendulum_momentum,
     stiff_pendulum_velocity,
     NULL,
     NULL},
    {"fpu", {"ell", "omega"}, {"3", "50"}, fpu_prepare, fpu_acceleration, NULL, NULL, NULL, NULL},
    {"toda", {"N"}, {"20"}, toda_prepare, toda_acceleration, NULL, NULL, NULL, NULL},
    {"chain",
     {"n", "beta"},
     {"32", "1"},
     chain_prepare,
     chain_acceleration,
     NULL,
     NULL,
     NULL,
     NULL},
    {.name = "net",
     .parameter = {"dim", "side", "k"},
     .standard = {"2", "4", "1"},
     .prepare = net_prepare,
     .acceleration = net_acceleration},
    {.name = "outer-solar", .prepare = outer_solar_prepare, GRAVITY},
    {.name = "figure-eight", .prepare = figure_eight_prepare, GRAVITY},
    {.name = "pythagorean", .prepare = pythagorean_prepare, GRAVITY},
};

const quad_problem *quad_problem_find(const char *name)
{
  for (size_t i = 0; i < sizeof problems / sizeof *problems; i++)
    if (strcmp(problems[i].name, name) == 0) return &problems[i];
  for (const quad_problem *p = quad_degenerate; p->name; p++)
    if (strcmp(p->name, name) == 0) return p;
  for (const quad_problem *p = quad_factors; p->name; p++)
    if (strcmp(p->name, name) == 0) return p;
  return NULL;
}
