/* The problems with holonomic constraints, from their definitions. Their multipliers are eliminated
 * by hand. */
#include "quad_system.h"

/* ---- three cranks, which turn as one: a'' = -k sin a ---- */

static void cranks_prepare(quad_system *system)
{
  const quad *value = system->value;
  system->n = 6;
  for (int i = 0; i < 3; i++) system->q[i] = value[5];
  system->q[3] = value[1] * quad_sin(value[5]);
  system->q[4] = -value[1] * quad_cos(value[5]);
}

static void cranks_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const quad m = system->value[0], l = system->value[1], M = system->value[3], g = system->value[4],
             s = quad_sin(q[0]), c = quad_cos(q[0]);
  const quad turn = -(3 * m / 2 + M) / (m + M) * g / l * s;
  for (int i = 0; i < 3; i++) a[i] = turn;
  a[3] = l * (c * turn - s * v[0] * v[0]);
  a[4] = l * (s * turn + c * v[0] * v[0]);
  a[5] = 0;
}

static quad crank_mass(const quad_system *system, int i)
{
  const quad *value = system->value;
  if (i < 3) return value[0] * value[1] * value[1] / 3;
  return i < 5 ? value[3] : value[3] * value[2] * value[2] / 3;
}

static void cranks_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  (void)q;
  for (int i = 0; i < 6; i++) p[i] = crank_mass(system, i) * v[i];
}

static void cranks_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  (void)q;
  for (int i = 0; i < 6; i++) v[i] = p[i] / crank_mass(system, i);
}

/* ---- a bob at the distance l from the origin ---- */

static void bob_prepare(quad_system *system)
{
  const quad l = system->value[2], s = quad_sin(1), c = quad_cos(1);
  system->n = 3;
  system->q[0] = l * s;
  system->q[2] = -l * c;
  system->v[0] = l * c / 2;
  system->v[1] = 2 * l;
  system->v[2] = l * s / 2;
}

/* q.q'' = -|q'|^2 */
static void bob_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const quad g = system->value[1], square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2],
             pull = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] - g * q[2]) / square;
  for (int i = 0; i < 3; i++) a[i] = -pull * q[i] - (i == 2 ? g : 0);
}

static void bob_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  (void)q;
  for (int i = 0; i < 3; i++) p[i] = system->value[0] * v[i];
}

static void bob_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  (void)q;
  for (int i = 0; i < 3; i++) v[i] = p[i] / system->value[0];
}

/* ---- linkage: a rod that carries two, by their angles: links, m, l, g; x, y, a of each ---- */

enum { RODS = 3 };

/* The share of rod i in the place of the centre of rod k, over l. */
static quad share(int k, int i)
{
  const int twice = i == k ? 1 : i == 0 ? 2 : 0;
  return (quad)twice / 2;
}

static void linkage_prepare(quad_system *system)
{
  const quad l = system->value[2], a[RODS] = {-(quad)5 / 4, -(quad)3 / 2, -1};
  system->n = 3 * RODS;
  for (int k = 0; k < RODS; k++) {
    quad *q = system->q + 3 * k;
    for (int i = 0; i < RODS; i++) {
      q[0] += share(k, i) * l * quad_cos(a[i]);
      q[1] += share(k, i) * l * quad_sin(a[i]);
    }
    q[2] = a[k];
  }
}

/* Compute sum_k of the shares of two rods, which is 0 for the two that are carried. */
static quad shared(int i, int j)
{
  quad sum = 0;
  for (int k = 0; k < RODS; k++) sum += share(k, i) * share(k, j);
  return sum;
}

/* The equations M a'' = f of the angles, over m l^2. The carried rods are eliminated first. */
static void linkage_turn(const quad_system *system, const quad *a, const quad *w, quad *turn)
{
  const quad pull = system->value[3] / system->value[2];
  quad M[RODS], f[RODS], diagonal = shared(0, 0) + (quad)1 / 12;
  for (int i = 0; i < RODS; i++) {
    f[i] = 0;
    for (int j = 0; j < RODS; j++) {
      f[i] -= share(j, i) * pull * quad_cos(a[i]);
      f[i] -= shared(i, j) * quad_sin(a[i] - a[j]) * w[j] * w[j];
    }
    M[i] = shared(0, i) * quad_cos(a[0] - a[i]);
  }
  const quad carried = shared(1, 1) + (quad)1 / 12;
  for (int i = 1; i < RODS; i++) {
    diagonal -= M[i] * M[i] / carried;
    f[0] -= M[i] * f[i] / carried;
  }
  turn[0] = f[0] / diagonal;
  for (int i = 1; i < RODS; i++) turn[i] = (f[i] - M[i] * turn[0]) / carried;
}

static void linkage_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const quad l = system->value[2], angle[RODS] = {q[2], q[5], q[8]}, w[RODS] = {v[2], v[5], v[8]};
  quad turn[RODS];
  linkage_turn(system, angle, w, turn);
  for (int k = 0; k < RODS; k++) {
    a[3 * k] = a[3 * k + 1] = 0;
    a[3 * k + 2] = turn[k];
    for (int i = 0; i < RODS; i++) {
      const quad c = share(k, i) * l * quad_cos(angle[i]), s = share(k, i) * l * quad_sin(angle[i]);
      a[3 * k] -= s * turn[i] + c * w[i] * w[i];
      a[3 * k + 1] += c * turn[i] - s * w[i] * w[i];
    }
  }
}

static quad linkage_mass(const quad_system *system, int i)
{
  const quad m = system->value[1], l = system->value[2];
  return i % 3 < 2 ? m : m * l * l / 12;
}

static void linkage_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  (void)q;
  for (int i = 0; i < 3 * RODS; i++) p[i] = linkage_mass(system, i) * v[i];
}

static void linkage_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  (void)q;
  for (int i = 0; i < 3 * RODS; i++) v[i] = p[i] / linkage_mass(system, i);
}

const quad_problem quad_constrained[] = {
    {.name = "linkage",
     .parameter = {"links", "m", "l", "g"},
     .standard = {"3", "1", "1", "1"},
     .prepare = linkage_prepare,
     .acceleration = linkage_acceleration,
     .momentum = linkage_momentum,
     .velocity = linkage_velocity},
    {.name = "three-cranks",
     .parameter = {"m", "l", "d", "M", "g", "start"},
     .standard = {"0.4", "0.7", "0.5", "1.5", "9.81", "1.1"},
     .prepare = cranks_prepare,
     .acceleration = cranks_acceleration,
     .momentum = cranks_momentum,
     .velocity = cranks_velocity},
    {.name = "spherical-constrained",
     .parameter = {"m", "g", "l"},
     .standard = {"1", "9.81", "1"},
     .prepare = bob_prepare,
     .acceleration = bob_acceleration,
     .momentum = bob_momentum,
     .velocity = bob_velocity},
    {.name = NULL},
};
