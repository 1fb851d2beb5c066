/* The catalogue's problems with rotations, places and directions in quadruple precision, by
 * d'Alembert's principle for points.
 *
 * Everything is points r that are linear in the slots: R rho of a rotation, f x of a place, f q of
 * a direction. A point has a mass, and its share of the potential V = weight.r + spring |r|^2/2 -
 * pull/|r|; a body's inertia is that of three points on its axes, of masses tr(J)/2 - J_kk. With
 * velocities v (Omega in the body's frame; x'; of a direction the angular velocity omega in space,
 * q' = omega x q) and r' = B v, r'' = B v' + b:
 *     sum over points of B^t ( m (B v' + b) + V_r ) = 0,      and omega'.q = 0 for directions. */
#include <string.h>

#include "quad_system.h"

enum { CELLS = QUAD_SLOTS_MAX, NV = 3 * CELLS };

/* ---- vectors ---- */

static void cross(const quad *a, const quad *b, quad *c)
{
  for (int i = 0; i < 3; i++)
    c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static quad dot(const quad *a, const quad *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void turn_by(const quad *R, const quad *x, quad *y)
{
  for (int i = 0; i < 3; i++) y[i] = dot(R + 3 * i, x);
}

/* ---- points ---- */

/* Adds a slot's part of r, of b, and of column k of B. */
static void part(char cell, const quad *q, const quad *v, const quad *arm, quad *r, quad *b)
{
  quad x[3], y[3];
  if (cell == 'R') {
    turn_by(q, arm, r);
    cross(v, arm, x);
    cross(v, x, y);
    turn_by(q, y, b);
    return;
  }
  cross(v, q, x);
  cross(v, x, y);
  for (int i = 0; i < 3; i++) {
    r[i] = arm[0] * q[i];
    b[i] = cell == 'S' ? arm[0] * y[i] : 0;
  }
}

static void lever(char cell, const quad *q, const quad *arm, int k, quad *column)
{
  const quad axis[3] = {k == 0, k == 1, k == 2};
  quad x[3];
  if (cell == 'R') {
    cross(axis, arm, x);
    turn_by(q, x, column);
    return;
  }
  cross(axis, q, x);
  for (int i = 0; i < 3; i++) column[i] = arm[0] * (cell == 'S' ? x[i] : axis[i]);
}

typedef struct mechanics {
  quad mass[NV][NV]; /* B^t m B, and q q^t */
  quad load[NV];     /* B^t (m b + V_r) */
} mechanics;

static int stored_of(char cell)
{
  return cell == 'R' ? 9 : 3;
}

static void add_potential(const quad_point *point, const quad *r, quad *force)
{
  const quad r2 = dot(r, r), pull = point->pull > 0 ? point->pull / (r2 * quad_sqrt(r2)) : 0;
  for (int i = 0; i < 3; i++) force[i] += point->weight[i] + (point->spring + pull) * r[i];
}

static void add_point(const quad_system *system, const quad_point *point, const quad *q,
                      const quad *v, mechanics *m)
{
  quad r[3] = {0}, force[3] = {0}, B[NV][3];
  int used[CELLS];
  for (int c = 0; system->slots[c]; q += stored_of(system->slots[c]), c++) {
    quad part_r[3], part_b[3];
    used[c] = dot(point->arm[c], point->arm[c]) > 0;
    if (!used[c]) continue;
    part(system->slots[c], q, v + 3 * c, point->arm[c], part_r, part_b);
    for (int k = 0; k < 3; k++) {
      lever(system->slots[c], q, point->arm[c], k, B[3 * c + k]);
      r[k] += part_r[k];
      force[k] += point->mass * part_b[k];
    }
  }
  add_potential(point, r, force);
  for (int i = 0; i < system->nv; i++) {
    if (!used[i / 3]) continue;
    m->load[i] += dot(B[i], force);
    for (int j = 0; j < system->nv && point->mass > 0; j++)
      if (used[j / 3]) m->mass[i][j] += point->mass * dot(B[i], B[j]);
  }
}

static void gather(const quad_system *system, const quad *q, const quad *v, mechanics *m)
{
  memset(m, 0, sizeof *m);
  for (int a = 0; a < system->points; a++) add_point(system, &system->point[a], q, v, m);
  for (int c = 0; system->slots[c]; q += stored_of(system->slots[c]), c++)
    for (int i = 0; i < 3 && system->slots[c] == 'S'; i++)
      for (int j = 0; j < 3; j++) m->mass[3 * c + i][3 * c + j] += q[i] * q[j];
}

/* Solves mass x = x in place. The mass is positive definite and is overwritten. */
static void solve(int n, quad A[NV][NV], quad *x)
{
  for (int k = 0; k < n; k++)
    for (int i = k + 1; i < n; i++) {
      const quad factor = A[i][k] / A[k][k];
      if (!(factor < 0 || factor > 0)) continue;
      for (int j = k; j < n; j++) A[i][j] -= factor * A[k][j];
      x[i] -= factor * x[k];
    }
  for (int k = n - 1; k >= 0; k--) {
    for (int j = k + 1; j < n; j++) x[k] -= A[k][j] * x[j];
    x[k] /= A[k][k];
  }
}

static void rate_of(char cell, const quad *q, const quad *v, quad *rate)
{
  if (cell == 'P') memcpy(rate, v, 3 * sizeof *rate);
  if (cell == 'S') cross(v, q, rate);
  for (int row = 0; row < 9 && cell == 'R'; row += 3) cross(q + row, v, rate + row);
}

static void flow(const quad_system *system, const quad *y, quad *rate)
{
  const quad *v = y + system->n;
  quad *v_rate = rate + system->n;
  mechanics m;
  gather(system, y, v, &m);
  memset(rate, 0, 2 * (size_t)system->n * sizeof *rate);
  for (int c = 0, at = 0; system->slots[c]; at += stored_of(system->slots[c]), c++)
    rate_of(system->slots[c], y + at, v + 3 * c, rate + at);
  for (int i = 0; i < system->nv; i++) v_rate[i] = -m.load[i];
  solve(system->nv, m.mass, v_rate);
}

/* Gives the momentum of a direction. p belongs to q' and is tangent, and q x p belongs to omega. */
static void momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  mechanics m;
  gather(system, q, v, &m);
  for (int c = 0; system->slots[c]; q += stored_of(system->slots[c]), c++) {
    quad of_v[3] = {0};
    for (int i = 0; i < system->nv; i++)
      for (int k = 0; k < 3; k++) of_v[k] += m.mass[3 * c + k][i] * v[i];
    if (system->slots[c] == 'S')
      cross(of_v, q, p + 3 * c);
    else
      memcpy(p + 3 * c, of_v, sizeof of_v);
  }
}

static void velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  const quad rest[NV] = {0};
  mechanics m;
  gather(system, q, rest, &m);
  for (int c = 0; system->slots[c]; q += stored_of(system->slots[c]), c++)
    if (system->slots[c] == 'S')
      cross(q, p + 3 * c, v + 3 * c);
    else
      memcpy(v + 3 * c, p + 3 * c, 3 * sizeof *v);
  solve(system->nv, m.mass, v);
}

/* ---- definitions ---- */

/* The slots are R, a rotation that starts at I, P, a place, and S, a direction. */
static void lay_out(quad_system *system, const char *slots)
{
  (void)strcpy(system->slots, slots);
  system->nv = 3 * (int)strlen(slots);
  for (int c = 0; slots[c]; c++) {
    for (int k = 0; k < 9 && slots[c] == 'R'; k += 4) system->q[system->n + k] = 1;
    system->n += stored_of(slots[c]);
  }
}

static quad_point *new_point(quad_system *system, quad mass)
{
  quad_point *point = &system->point[system->points++];
  point->mass = mass;
  return point;
}

/* Principal inertias as points on the axes. */
static void add_inertia(quad_system *system, int cell, quad J1, quad J2, quad J3)
{
  const quad J[3] = {J1, J2, J3}, half = (J1 + J2 + J3) / 2;
  for (int k = 0; k < 3; k++) new_point(system, half - J[k])->arm[cell][k] = 1;
}

static void set(quad *x, const char *a, const char *b, const char *c)
{
  x[0] = quad_number(a);
  x[1] = quad_number(b);
  x[2] = quad_number(c);
}

static void free_body_prepare(quad_system *system)
{
  lay_out(system, "R");
  add_inertia(system, 0, system->value[0], system->value[1], system->value[2]);
  memcpy(system->v, system->value + 3, 3 * sizeof *system->v);
}

static void pendulum_3d_prepare(quad_system *system)
{
  lay_out(system, "R");
  add_inertia(system, 0, quad_number("0.13"), quad_number("0.28"), quad_number("0.17"));
  set(system->v, "4.14", "4.14", "4.14");
  quad_point *centre = new_point(system, 0);
  centre->arm[0][2] = quad_number("0.3");
  centre->weight[2] = -quad_number("9.81");
}

static void heavy_top_prepare(quad_system *system)
{
  lay_out(system, "R");
  add_inertia(system, 0, quad_number("0.234375"), quad_number("0.46875"), quad_number("0.234375"));
  set(system->v, "0", "150", "-4.61538");
  quad_point *centre = new_point(system, 15);
  centre->arm[0][1] = 1;
  centre->weight[2] = 15 * quad_number("9.81");
}

static void kovalevskaya_prepare(quad_system *system)
{
  lay_out(system, "R");
  add_inertia(system, 0, 2, 2, 1);
  set(system->v, "0.5", "1", "1.5");
  quad_point *centre = new_point(system, 0);
  centre->arm[0][0] = 1;
  centre->weight[2] = 1;
}

static void spherical_double_pendulum_prepare(quad_system *system)
{
  const quad tenth = quad_number("0.1"),
             length = quad_sqrt(quad_number("0.866") * quad_number("0.866") + quad_number("0.25"));
  lay_out(system, "SS");
  system->q[0] = quad_number("0.866") / length;
  system->q[2] = quad_number("0.5") / length;
  system->q[5] = 1;
  set(system->v, "-0.433", "0", "0.75");
  set(system->v + 3, "0", "1", "0");
  for (int k = 0; k < 2; k++) {
    quad_point *mass = new_point(system, tenth);
    mass->weight[2] = -tenth * quad_number("9.81");
    for (int c = 0; c <= k; c++) mass->arm[c][0] = tenth;
  }
}

static void spherical_chain_prepare(quad_system *system)
{
  const quad tilt = quad_number("0.5");
  lay_out(system, "SSSSSSSS");
  for (int i = 0; i < 8; i++) {
    const quad round = 2 * quad_acos(-1) * i / 8;
    quad_point *mass = new_point(system, 1);
    mass->arm[i][0] = 1;
    mass->weight[2] = -1;
    system->q[3 * i] = quad_sin(tilt) * quad_cos(round);
    system->q[3 * i + 1] = quad_sin(tilt) * quad_sin(round);
    system->q[3 * i + 2] = quad_cos(tilt);
    if (i == 0) continue;
    quad_point *spring = new_point(system, 0);
    spring->spring = spring->arm[i][0] = 1;
    spring->arm[i - 1][0] = -1;
  }
}

/* Puts six points on the axes of each body. All pairs attract each other. */
static void two_body_prepare(quad_system *system)
{
  static const char *const semiaxis[2][3] = {{"0.6", "0.4", "0.3"}, {"0.35", "0.3", "0.15"}};
  const quad mass[2] = {1, quad_number("0.5")};
  lay_out(system, "RPRP");
  for (int body = 0; body < 2; body++) {
    new_point(system, mass[body])->arm[2 * body + 1][0] = 1;
    for (int k = 0; k < 3; k++)
      new_point(system, mass[body] / 3)->arm[2 * body][k] = quad_number(semiaxis[body][k]);
  }
  for (int a = 0; a < 6; a++)
    for (int b = 0; b < 6; b++) {
      quad_point *pair = new_point(system, 0);
      pair->pull = mass[0] * mass[1] / 36;
      pair->arm[0][a / 2] = (a % 2 ? -1 : 1) * quad_number(semiaxis[0][a / 2]);
      pair->arm[1][0] = 1;
      pair->arm[2][b / 2] = (b % 2 ? 1 : -1) * quad_number(semiaxis[1][b / 2]);
      pair->arm[3][0] = -1;
    }
  system->q[9] = 1;
  system->q[21] = -2;
  set(system->v, "0.2", "0.3", "0.5");
  set(system->v + 3, "0", "0.7/3", "0");
  set(system->v + 6, "-0.4", "0.1", "0.8");
  set(system->v + 9, "0", "-1.4/3", "0");
}

static void satellite_prepare(quad_system *system)
{
  const quad rate = quad_sqrt(quad_number("10/125")), length = quad_sqrt(quad_number("1.13")),
             half = quad_number("0.5");
  lay_out(system, "RPSSSS");
  add_inertia(system, 0, quad_number("0.8"), quad_number("1.2"), quad_number("1.5"));
  quad_point *body = new_point(system, 10);
  body->arm[1][0] = 1;
  body->pull = 100;
  for (int k = 1; k <= 4; k++) {
    quad_point *link = new_point(system, half);
    link->pull = 10 * half;
    set(link->arm[0], "-0.5", "0", "0.1");
    link->arm[1][0] = 1;
    for (int c = 2; c < 2 + k; c++) link->arm[c][0] = half / 2;
    quad *q = system->q + 12 + 3 * (k - 1), *omega = system->v + 6 + 3 * (k - 1);
    q[0] = -1 / length;
    q[1] = quad_number("0.3") / length;
    q[2] = quad_number("0.2") / length;
    for (int i = 0; i < 3; i++) omega[i] = rate * ((i == 2) - q[2] * q[i]);
  }
  system->q[9] = 5;
  system->v[2] = rate;
  system->v[4] = 5 * rate;
}

#define FACTORS(problem) \
  .prepare = problem##_prepare, .flow = flow, .momentum = momentum, .velocity = velocity

const quad_problem quad_factors[] = {
    {.name = "free-body",
     .parameter = {"J1", "J2", "J3", "Omega1", "Omega2", "Omega3"},
     .standard = {"3", "2", "1.5", "0.5", "-0.5", "0.4"},
     FACTORS(free_body)},
    {.name = "pendulum-3d", FACTORS(pendulum_3d)},
    {.name = "heavy-top", FACTORS(heavy_top)},
    {.name = "kovalevskaya", FACTORS(kovalevskaya)},
    {.name = "spherical-double-pendulum", FACTORS(spherical_double_pendulum)},
    {.name = "spherical-chain", FACTORS(spherical_chain)},
    {.name = "two-body", FACTORS(two_body)},
    {.name = "satellite", FACTORS(satellite)},
    {.name = NULL},
};
