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
  const quad r3 = quad_cube(quad_sqrt(q[0] * q[0] + q[1] * q[1]));
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

/* V = b (1 - s^2)^2 with s = (r - 3/2)/w, without the bath. */
static void dimer_prepare(quad_system *system)
{
  static const char *const q[] = {"-0.6", "0.1", "0.5", "0"}, *const v[] = {"0.1", "0.3", "-0.2",
                                                                            "-0.4"};
  system->n = 4;
  for (int i = 0; i < 4; i++) {
    system->q[i] = quad_number(q[i]);
    system->v[i] = quad_number(v[i]);
  }
}

static void dimer_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const quad b = system->value[0], w = system->value[1], x = q[2] - q[0], y = q[3] - q[1],
             r = quad_sqrt(x * x + y * y), s = (r - quad_number("1.5")) / w,
             pull = 4 * b * s * (1 - s * s) / (w * r);
  (void)v;
  a[2] = pull * x;
  a[3] = pull * y;
  a[0] = -a[2];
  a[1] = -a[3];
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

/* q'' = -q - c q' + f sin(omega t). The time stands behind the velocity. */
static void damped_driven_prepare(quad_system *system)
{
  system->n = 1;
  system->q[0] = 1;
}

static void damped_driven_acceleration(const quad_system *system, const quad *q, const quad *v,
                                       quad *a)
{
  const quad *c = system->value;
  a[0] = -q[0] - c[0] * v[0] + c[1] * quad_sin(c[2] * v[1]);
}

/* q'' = q' x (-x B'/2, -y B'/2, B(z)) with B(z) = B (1 + z^2/l^2), p = q' + B(z)/2 (-y, x, 0). */
static quad bottle_field(const quad_system *system, quad z)
{
  return system->value[0] * (1 + z * z / (system->value[1] * system->value[1]));
}

static void magnetic_bottle_prepare(quad_system *system)
{
  system->n = 3;
  system->q[0] = 1;
  system->v[1] = quad_number("0.6");
  system->v[2] = quad_number("0.5");
}

static void magnetic_bottle_acceleration(const quad_system *system, const quad *q, const quad *v,
                                         quad *a)
{
  const quad half = system->value[0] * q[2] / (system->value[1] * system->value[1]),
             B[3] = {-half * q[0], -half * q[1], bottle_field(system, q[2])};
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    a[i] = v[j] * B[k] - v[k] * B[j];
  }
}

static void magnetic_bottle_momentum(const quad_system *system, const quad *q, const quad *v,
                                     quad *p)
{
  const quad half = bottle_field(system, q[2]) / 2;
  p[0] = v[0] - half * q[1];
  p[1] = v[1] + half * q[0];
  p[2] = v[2];
}

static void magnetic_bottle_velocity(const quad_system *system, const quad *q, const quad *p,
                                     quad *v)
{
  const quad half = bottle_field(system, q[2]) / 2;
  v[0] = p[0] + half * q[1];
  v[1] = p[1] - half * q[0];
  v[2] = p[2];
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

/* Jacobi's vectors of the planets, from the centre of mass of the Sun and the planets inside, and
 * back to bodies about the centre of mass of all. The Sun is the last body. */
static void to_jacobi(const quad_system *system, const quad *x, quad *jacobi)
{
  const int planets = system->bodies - 1;
  for (int i = 0; i < 3; i++) {
    quad inside = system->mass[planets], centre = x[3 * planets + i];
    for (int body = 0; body < planets; body++) {
      const quad m = system->mass[body], place = x[3 * body + i];
      jacobi[3 * body + i] = place - centre;
      centre += m / (inside + m) * (place - centre);
      inside += m;
    }
  }
}

static void from_jacobi(const quad_system *system, const quad *jacobi, quad *x)
{
  const int planets = system->bodies - 1;
  for (int i = 0; i < 3; i++) {
    quad centre = 0, inside = 0;
    for (int body = 0; body <= planets; body++) inside += system->mass[body];
    for (int body = planets - 1; body >= 0; body--) {
      centre -= system->mass[body] / inside * jacobi[3 * body + i];
      inside -= system->mass[body];
      x[3 * body + i] = centre + jacobi[3 * body + i];
    }
    x[3 * planets + i] = centre;
  }
}

static quad jacobi_mass(const quad_system *system, int body)
{
  quad inside = system->mass[system->bodies - 1];
  for (int other = 0; other < body; other++) inside += system->mass[other];
  return system->mass[body] * inside / (inside + system->mass[body]);
}

static void jacobi_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  quad x[QUAD_N_MAX], pull[QUAD_N_MAX];
  quad_system whole = *system;
  whole.n = 3 * system->bodies;
  from_jacobi(system, q, x);
  gravity_acceleration(&whole, x, v, pull);
  to_jacobi(system, pull, a);
}

static void jacobi_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  (void)q;
  for (int j = 0; j < system->n; j++) p[j] = jacobi_mass(system, j / 3) * v[j];
}

static void jacobi_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  (void)q;
  for (int j = 0; j < system->n; j++) v[j] = p[j] / jacobi_mass(system, j / 3);
}

static void outer_solar_jacobi_prepare(quad_system *system)
{
  quad jacobi[QUAD_N_MAX];
  outer_solar_prepare(system);
  system->n = 15;
  to_jacobi(system, system->q, jacobi);
  memcpy(system->q, jacobi, sizeof system->q);
  to_jacobi(system, system->v, jacobi);
  memcpy(system->v, jacobi, sizeof system->v);
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
    {"damped-driven",
     {"c", "f", "omega"},
     {"0.2", "0.5", "2"},
     damped_driven_prepare,
     damped_driven_acceleration,
     NULL,
     NULL,
     NULL,
     NULL},
    {"magnetic-bottle",
     {"B", "l"},
     {"4", "2"},
     magnetic_bottle_prepare,
     magnetic_bottle_acceleration,
     magnetic_bottle_momentum,
     magnetic_bottle_velocity,
     NULL,
     NULL},
    {.name = "langevin-dimer",
     .parameter = {"b", "w"},
     .standard = {"1", "0.5"},
     .prepare = dimer_prepare,
     .acceleration = dimer_acceleration},
    {"stiff-pendulum",
     {"k", "l", "m", "g"},
     {"1e4", "1", "1", "9.81"},
     stiff_pendulum_prepare,
     stiff_pendulum_acceleration,
     stiff_pendulum_momentum,
     stiff_pendulum_velocity,
     NULL,
     NULL},
    {.name = "outer-solar", .prepare = outer_solar_prepare, GRAVITY},
    {.name = "outer-solar-jacobi",
     .prepare = outer_solar_jacobi_prepare,
     .acceleration = jacobi_acceleration,
     .momentum = jacobi_momentum,
     .velocity = jacobi_velocity},
    {.name = "figure-eight", .prepare = figure_eight_prepare, GRAVITY},
    {.name = "pythagorean", .prepare = pythagorean_prepare, GRAVITY},
};

const quad_problem *quad_problem_find(const char *name)
{
  for (size_t i = 0; i < sizeof problems / sizeof *problems; i++)
    if (strcmp(problems[i].name, name) == 0) return &problems[i];
  for (const quad_problem *p = quad_chains; p->name; p++)
    if (strcmp(p->name, name) == 0) return p;
  for (const quad_problem *p = quad_degenerate; p->name; p++)
    if (strcmp(p->name, name) == 0) return p;
  for (const quad_problem *p = quad_factors; p->name; p++)
    if (strcmp(p->name, name) == 0) return p;
  for (const quad_problem *p = quad_constrained; p->name; p++)
    if (strcmp(p->name, name) == 0) return p;
  for (const quad_problem *p = quad_mechanisms; p->name; p++)
    if (strcmp(p->name, name) == 0) return p;
  for (const quad_problem *p = quad_rolling; p->name; p++)
    if (strcmp(p->name, name) == 0) return p;
  return NULL;
}
