/* The nonholonomic problems, from their definitions. Velocities along the rows' kernel and across
 * it are separated by hand. */
#include "quad_system.h"

/* ---- knife edge: u' = g sin(slope) cos a for the velocity u along the edge ---- */

static void knife_prepare(quad_system *system)
{
  system->n = 3;
  system->v[0] = system->value[4];
  system->v[2] = system->value[5];
}

static void knife_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const quad c = quad_cos(q[2]), s = quad_sin(q[2]), u = c * v[0] + s * v[1],
             gain = system->value[2] * quad_sin(system->value[3]) * c;
  a[0] = gain * c - u * v[2] * s;
  a[1] = gain * s + u * v[2] * c;
  a[2] = 0;
}

/* ---- masses m, m, J ---- */

static void planar_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  (void)q;
  for (int i = 0; i < 3; i++) p[i] = system->value[i / 2] * v[i];
}

static void planar_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  (void)q;
  for (int i = 0; i < 3; i++) v[i] = p[i] / system->value[i / 2];
}

/* ---- sleigh: u' = a w^2, (J + m a^2) w' = -m a u w, and a w across the blade ---- */

static void sleigh_prepare(quad_system *system)
{
  system->n = 3;
  system->v[0] = 1;
  system->v[1] = 2 * system->value[2];
  system->v[2] = 2;
}

static void sleigh_acceleration(const quad_system *system, const quad *q, const quad *v, quad *acc)
{
  const quad m = system->value[0], J = system->value[1], a = system->value[2], w = v[2],
             c = quad_cos(q[2]), s = quad_sin(q[2]), u = c * v[0] + s * v[1],
             rate = -m * a * u * w / (J + m * a * a), across = u * w + a * rate;
  acc[0] = -across * s; /* along the blade u' - w (a w) = 0 */
  acc[1] = across * c;
  acc[2] = rate;
}

/* ---- snakeboard: x' and y' follow from the board's turn w ---- */

/* The wheels let the board go with u = x' cos a + y' sin a and 0 across, r cot(phi) w = -u. With
 * u = -r cot(phi) w and the mass on the turn, M = J + Jr + 2 Jw, the reduced equations are those of
 * u, psi, phi in the kernel. */
static void snakeboard_prepare(quad_system *system)
{
  const quad angle = quad_number("0.4");
  system->n = 5;
  system->q[3] = quad_number("0.8");
  system->q[4] = angle;
  system->v[0] = quad_number("0.5");
  system->v[2] = -system->v[0] * quad_sin(angle) / quad_cos(angle) / system->value[6];
  system->v[3] = 1;
  system->v[4] = quad_number("-0.6");
}

/* With w = e u and e = -tan(phi)/r the kernel's equations are
 *     m u' + e (M w' + Jr psi'') = 0,   Jr (w' + psi'') = -k psi,   2 Jw phi'' = -kw phi,
 * and the velocity is u along the board. */
static void snakeboard_acceleration(const quad_system *system, const quad *q, const quad *v,
                                    quad *a)
{
  const quad *value = system->value;
  const quad m = value[0], Jr = value[2], M = value[1] + Jr + 2 * value[3], k = value[4],
             kw = value[5], r = value[6];
  const quad c = quad_cos(q[2]), s = quad_sin(q[2]), u = c * v[0] + s * v[1], turn = quad_cos(q[4]),
             e = -quad_sin(q[4]) / turn / r, e_rate = -v[4] / (turn * turn) / r;
  /* w' = e u' + e' u and Jr psi'' = -k psi - Jr w' */
  const quad gain = -e * ((M - Jr) * e_rate * u - k * q[3]) / (m + (M - Jr) * e * e),
             w_rate = e * gain + e_rate * u;
  a[0] = gain * c - u * v[2] * s;
  a[1] = gain * s + u * v[2] * c;
  a[2] = w_rate;
  a[3] = -k * q[3] / Jr - w_rate;
  a[4] = -kw * q[4] / (2 * value[3]);
}

static void snakeboard_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  const quad *value = system->value;
  (void)q;
  p[0] = value[0] * v[0];
  p[1] = value[0] * v[1];
  p[3] = value[2] * (v[2] + v[3]);
  p[2] = (value[1] + 2 * value[3]) * v[2] + p[3];
  p[4] = 2 * value[3] * v[4];
}

static void snakeboard_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  const quad *value = system->value;
  (void)q;
  v[0] = p[0] / value[0];
  v[1] = p[1] / value[0];
  v[2] = (p[2] - p[3]) / (value[1] + 2 * value[3]);
  v[3] = p[3] / value[2] - v[2];
  v[4] = p[4] / (2 * value[3]);
}

/* ---- rolling disk: turn and spin are constant ---- */

static void disk_prepare(quad_system *system)
{
  system->n = 4;
  system->v[0] = system->value[3] * system->value[5];
  system->v[2] = system->value[4];
  system->v[3] = system->value[5];
}

static void disk_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const quad u = system->value[3] * v[3];
  a[0] = -u * v[2] * quad_sin(q[2]);
  a[1] = u * v[2] * quad_cos(q[2]);
  a[2] = a[3] = 0;
}

static void disk_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  (void)q;
  for (int i = 0; i < 4; i++) p[i] = system->value[i == 0 ? 0 : i - 1] * v[i];
}

static void disk_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  (void)q;
  for (int i = 0; i < 4; i++) v[i] = p[i] / system->value[i == 0 ? 0 : i - 1];
}

/* ---- ball: circles, and an angular velocity whose vertical part is constant ---- */

static void ball_prepare(quad_system *system)
{
  const quad R = system->value[2], omega = system->value[3], th = quad_number("1.2"),
             speed = quad_number("0.3");
  system->n = 5;
  system->q[0] = 1;
  system->q[2] = quad_acos(0);
  system->q[3] = th;
  system->v[1] = speed;
  system->v[4] = (omega - speed) / R / quad_sin(th);
  system->v[2] = system->value[4] - system->v[4] * quad_cos(th);
}

static void ball_acceleration(const quad_system *system, const quad *q, const quad *v, quad *a)
{
  const quad m = system->value[0], I = system->value[1], R = system->value[2],
             omega = system->value[3], rate = omega * I / (I + m * R * R);
  const quad sp = quad_sin(q[2]), cp = quad_cos(q[2]), s = quad_sin(q[3]), c = quad_cos(q[3]);
  const quad wx = cp * v[3] + sp * s * v[4], wy = sp * v[3] - cp * s * v[4];
  a[0] = -rate * v[1];
  a[1] = rate * v[0];
  const quad wx_rate = (omega * v[0] - a[1]) / R, wy_rate = (a[0] + omega * v[1]) / R;
  a[3] = cp * wx_rate + sp * wy_rate + v[2] * (cp * wy - sp * wx);
  a[4] = (sp * wx_rate - cp * wy_rate + v[2] * (cp * wx + sp * wy) - v[4] * c * v[3]) / s;
  a[2] = -a[4] * c + v[4] * s * v[3];
}

static void ball_momentum(const quad_system *system, const quad *q, const quad *v, quad *p)
{
  const quad m = system->value[0], I = system->value[1], c = quad_cos(q[3]);
  p[0] = m * v[0];
  p[1] = m * v[1];
  p[2] = I * (v[2] + c * v[4]);
  p[3] = I * v[3];
  p[4] = I * (v[4] + c * v[2]);
}

static void ball_velocity(const quad_system *system, const quad *q, const quad *p, quad *v)
{
  const quad m = system->value[0], I = system->value[1], c = quad_cos(q[3]), s = quad_sin(q[3]);
  v[0] = p[0] / m;
  v[1] = p[1] / m;
  v[2] = (p[2] - c * p[4]) / (I * s * s);
  v[3] = p[3] / I;
  v[4] = (p[4] - c * p[2]) / (I * s * s);
}

const quad_problem quad_rolling[] = {
    {.name = "knife-edge",
     .parameter = {"m", "J", "g", "slope", "u", "turn"},
     .standard = {"1", "0.5", "9.81", "0.3", "1", "2"},
     .prepare = knife_prepare,
     .acceleration = knife_acceleration,
     .momentum = planar_momentum,
     .velocity = planar_velocity},
    {.name = "sleigh",
     .parameter = {"m", "J", "a"},
     .standard = {"1", "0.2", "0.3"},
     .prepare = sleigh_prepare,
     .acceleration = sleigh_acceleration,
     .momentum = planar_momentum,
     .velocity = planar_velocity},
    {.name = "snakeboard",
     .parameter = {"m", "J", "Jr", "Jw", "k", "kw", "r"},
     .standard = {"1", "0.2", "0.05", "0.02", "0.4", "0.3", "0.3"},
     .prepare = snakeboard_prepare,
     .acceleration = snakeboard_acceleration,
     .momentum = snakeboard_momentum,
     .velocity = snakeboard_velocity},
    {.name = "rolling-disk",
     .parameter = {"m", "J", "I", "R", "turn", "spin"},
     .standard = {"1", "0.0625", "0.125", "0.5", "0.7", "3"},
     .prepare = disk_prepare,
     .acceleration = disk_acceleration,
     .momentum = disk_momentum,
     .velocity = disk_velocity},
    {.name = "disk-ball",
     .parameter = {"m", "I", "R", "omega", "spin"},
     .standard = {"1", "0.1", "0.5", "1", "0.5"},
     .prepare = ball_prepare,
     .acceleration = ball_acceleration,
     .momentum = ball_momentum,
     .velocity = ball_velocity},
    {.name = NULL},
};
