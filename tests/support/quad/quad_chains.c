/* The catalogue's chains and nets of springs in quadruple precision, from their definitions. */
#include "quad_system.h"

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
  const quad first = quad_cube(x0[0] - x1[0]), last = quad_cube(x0[ell - 1] + x1[ell - 1]);
  a0[0] -= first;
  a1[0] += first;
  a0[ell - 1] -= last;
  a1[ell - 1] -= last;
  for (int i = 0; i + 1 < ell; i++) {
    const quad force = quad_cube(x0[i + 1] - x1[i + 1] - x0[i] - x1[i]);
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
      system->q[i] = 1 - 3 * s * s / 2 + 3 * quad_cube(s) / 4;
    else if (s <= 2)
      system->q[i] = quad_cube(2 - s) / 4;
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
               force = d + system->value[1] * quad_cube(d);
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

#define CHAIN(title) .prepare = title##_prepare, .acceleration = title##_acceleration

const quad_problem quad_chains[] = {
    {.name = "fpu", .parameter = {"ell", "omega"}, .standard = {"3", "50"}, CHAIN(fpu)},
    {.name = "toda", .parameter = {"N"}, .standard = {"20"}, CHAIN(toda)},
    {.name = "chain", .parameter = {"n", "beta"}, .standard = {"32", "1"}, CHAIN(chain)},
    {.name = "net", .parameter = {"dim", "side", "k"}, .standard = {"2", "4", "1"}, CHAIN(net)},
    {.name = NULL},
};
