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

const quad_problem quad_constrained[] = {
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
