/* The outer solar system in Jacobi's vectors x_i. Each goes from the centre of mass of the Sun and
 * the planets inside to the next planet. The masses stay apart,
 *
 *     L = sum_i mu_i |x_i'|^2/2 + k_i/|x_i| - U(x),     k_i = G m_0 m_i,
 *     U = sum_i k_i (1/|x_i| - 1/|x_i + d_i|) - sum_{i<j} G m_i m_j/|y_i - y_j|,
 *
 * with y_i = x_i + d_i from the Sun, d_i = sum_{j<i} f_j x_j, and U depends on x alone. The first
 * terms are Kepler motions about fixed centres, a thousand times U. They are declared fast. The
 * centre of mass of all is left out. Source: Wisdom and Holman 1991. */
#include <math.h>
#include <string.h>

#include "entry.h"
#include "nbody.h"

enum { PLANETS = 5, N = 3 * PLANETS };

/* Pairs of planets, and pairs of the Sun and each planet but the first. */
enum { PAIRS = PLANETS * (PLANETS - 1) / 2 + PLANETS - 1 };

/* The pair's distance is |sum_i part_i x_i|, its potential -weight/distance. */
typedef struct jacobi_pair {
  double weight, part[PLANETS];
  int first, last; /* planets with a part */
  int of_sun;      /* the Sun and planet `last`, whose Kepler motion is not in U */
} jacobi_pair;

typedef struct jacobi {
  double masses[N];
  double pull[PLANETS]; /* k */
  jacobi_pair pair[PAIRS];
} jacobi;

/* ---- the Kepler motions ---- */

static int centre_value(int count, const double *t, const double *q, double *V, void *user)
{
  const jacobi *own = user;
  (void)t;
  for (int k = 0; k < count; k++) {
    V[k] = 0;
    for (int a = 0; a < PLANETS; a++) {
      const double *x = q + (ptrdiff_t)3 * a * count + k;
      const double square = x[0] * x[0] + x[count] * x[count] + x[2 * count] * x[2 * count];
      V[k] -= own->pull[a] / sqrt(square);
    }
  }
  return 0;
}

static int centre_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  const jacobi *own = user;
  (void)t;
  for (int a = 0; a < PLANETS; a++) {
    const double *x = q + (ptrdiff_t)3 * a * count;
    double *to = V_q + (ptrdiff_t)3 * a * count;
    for (int k = 0; k < count; k++) {
      const double square = x[k] * x[k] + x[count + k] * x[count + k] +
                            x[2 * count + k] * x[2 * count + k],
                   weight = own->pull[a] / (square * sqrt(square));
      for (int i = 0; i < 3; i++) to[i * count + k] = weight * x[i * count + k];
    }
  }
  return 0;
}

/* Add (weight/r^3 - 3 weight d d^T/r^5) times the parts to a full Hessian at point k. */
static void add_curvature(int count, int k, double weight, const double *d, const double *part,
                          int first, int last, double *V_qq)
{
  const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2],
               inverse = weight / (square * sqrt(square));
  for (int a = first; a <= last; a++)
    for (int b = first; b <= last; b++)
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
          V_qq[((3 * b + j) * N + 3 * a + i) * count + k] += part[a] * part[b] * inverse *
                                                             ((i == j) - 3 * d[i] * d[j] / square);
}

static void take_vector(int count, int k, const double *q, int a, double *x)
{
  for (int i = 0; i < 3; i++) x[i] = q[(3 * a + i) * count + k];
}

static void add_centres(int count, int k, double sign, int first, const double *q,
                        const jacobi *own, double *V_qq)
{
  static const double whole[PLANETS] = {1, 1, 1, 1, 1};
  for (int a = first; a < PLANETS; a++) {
    double x[3];
    take_vector(count, k, q, a, x);
    add_curvature(count, k, sign * own->pull[a], x, whole, a, a, V_qq);
  }
}

static int centre_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  (void)t;
  memset(V_qq, 0, (size_t)(N * N) * (size_t)count * sizeof *V_qq);
  for (int k = 0; k < count; k++) add_centres(count, k, 1, 0, q, user, V_qq);
  return 0;
}

/* ---- the rest ---- */

static void pair_vector(int count, int k, const double *q, const jacobi_pair *pair, double *d)
{
  d[0] = d[1] = d[2] = 0;
  for (int a = pair->first; a <= pair->last; a++)
    for (int i = 0; i < 3; i++) d[i] += pair->part[a] * q[(3 * a + i) * count + k];
}

/* Give the change of the square |y|^2 - |x|^2 without cancellation, y = x + d. */
static double changed_square(const double *x, const double *d)
{
  double change = 0;
  for (int i = 0; i < 3; i++) change += d[i] * (2 * x[i] + d[i]);
  return change;
}

static double length_of(const double *x)
{
  return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

/* Give x of the pair's planet, and y - x. */
static void part_of_sun(int count, int k, const double *q, const jacobi_pair *pair, double *x,
                        double *d)
{
  jacobi_pair inside = *pair;
  inside.last--;
  take_vector(count, k, q, pair->last, x);
  pair_vector(count, k, q, &inside, d);
}

static int rest_value(int count, const double *t, const double *q, double *V, void *user)
{
  const jacobi *own = user;
  double x[3], d[3];
  (void)t;
  for (int k = 0; k < count; k++) {
    V[k] = 0;
    for (const jacobi_pair *pair = own->pair; pair < own->pair + PAIRS; pair++) {
      if (!pair->of_sun) {
        pair_vector(count, k, q, pair, d);
        V[k] -= pair->weight / length_of(d);
        continue;
      }
      part_of_sun(count, k, q, pair, x, d);
      const double change = changed_square(x, d), r = length_of(x), R = sqrt(r * r + change);
      V[k] += pair->weight * change / ((r + R) * r * R);
    }
  }
  return 0;
}

/* Add weight (y/|y|^3 - x/|x|^3), y = x + d, to the gradient of the pair's planet, without
 * cancellation. */
static void add_pull_of_sun(int count, int k, const double *q, const jacobi_pair *pair, double *V_q)
{
  double x[3], d[3];
  part_of_sun(count, k, q, pair, x, d);
  const double change = changed_square(x, d), r = length_of(x), R = sqrt(r * r + change),
               inverse = pair->weight / (R * R * R),
               less = change * (R * R + R * r + r * r) / ((R + r) * r * r * r);
  for (int i = 0; i < 3; i++)
    V_q[(3 * pair->last + i) * count + k] += inverse * (d[i] - less * x[i]);
}

static int rest_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  const jacobi *own = user;
  double d[3];
  (void)t;
  memset(V_q, 0, (size_t)N * (size_t)count * sizeof *V_q);
  for (int k = 0; k < count; k++)
    for (const jacobi_pair *pair = own->pair; pair < own->pair + PAIRS; pair++) {
      pair_vector(count, k, q, pair, d);
      const double r = length_of(d), pull = pair->weight / (r * r * r);
      for (int a = pair->first; a <= pair->last - pair->of_sun; a++)
        for (int i = 0; i < 3; i++) V_q[(3 * a + i) * count + k] += pair->part[a] * pull * d[i];
      if (pair->of_sun) add_pull_of_sun(count, k, q, pair, V_q);
    }
  return 0;
}

static int rest_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const jacobi *own = user;
  double d[3];
  (void)t;
  memset(V_qq, 0, (size_t)(N * N) * (size_t)count * sizeof *V_qq);
  for (int k = 0; k < count; k++) {
    for (const jacobi_pair *pair = own->pair; pair < own->pair + PAIRS; pair++) {
      pair_vector(count, k, q, pair, d);
      add_curvature(count, k, pair->weight, d, pair->part, pair->first, pair->last, V_qq);
    }
    add_centres(count, k, -1, 1, q, own, V_qq);
  }
  return 0;
}

/* ---- the vectors ---- */

/* Fill the parts of y_b - y_a of planets, or with a < 0 of y_b from the Sun. */
static void fill_pair(const double *fraction, int a, int b, jacobi_pair *pair)
{
  pair->first = a < 0 ? 0 : a;
  pair->last = b;
  for (int j = pair->first; j < b; j++) pair->part[j] = fraction[j];
  pair->part[b] = 1;
  if (a >= 0) pair->part[a] -= 1;
}

static void fill_jacobi(const nbody *bodies, jacobi *own)
{
  double fraction[PLANETS];
  jacobi_pair *pair = own->pair;
  long double inside = bodies->mass[PLANETS];
  for (int a = 0; a < PLANETS; a++) {
    const long double m = bodies->mass[a];
    fraction[a] = (double)(m / (inside + m));
    own->pull[a] = bodies->G * bodies->mass[PLANETS] * bodies->mass[a];
    for (int i = 0; i < 3; i++) own->masses[3 * a + i] = (double)(m * inside / (inside + m));
    inside += m;
  }
  for (int b = 1; b < PLANETS; b++, pair++) {
    pair->weight = own->pull[b];
    pair->of_sun = 1;
    fill_pair(fraction, -1, b, pair);
  }
  for (int a = 0; a < PLANETS; a++)
    for (int b = a + 1; b < PLANETS; b++, pair++) {
      pair->weight = bodies->G * bodies->mass[a] * bodies->mass[b];
      fill_pair(fraction, a, b, pair);
    }
}

/* Give Jacobi's vectors of places or velocities. */
static void vectors_of(const nbody *bodies, double (*place)[3], double *x)
{
  for (int i = 0; i < 3; i++) {
    long double inside = bodies->mass[PLANETS], centre = place[PLANETS][i];
    for (int a = 0; a < PLANETS; a++) {
      const long double m = bodies->mass[a], from = place[a][i] - centre;
      x[3 * a + i] = (double)from;
      centre += m / (inside + m) * from;
      inside += m;
    }
  }
}

static int jacobi_rotation(const double *q, double *xi, void *user)
{
  const int axis = *(const int *)user, first = (axis + 1) % 3, second = (axis + 2) % 3;
  for (int i = 0; i < N; i++) xi[i] = 0;
  for (int a = 0; a < PLANETS; a++) {
    xi[3 * a + first] = -q[3 * a + second];
    xi[3 * a + second] = q[3 * a + first];
  }
  return 0;
}

static dvi_status outer_solar_jacobi_make(const double *setting, problem *made)
{
  static int axes[] = {0, 1, 2};
  const dvi_status status = problem_room(made, N, sizeof(jacobi));
  nbody bodies = outer_solar_bodies;
  (void)setting;
  if (status != DVI_OK) return status;
  jacobi *own = made->parameters;
  fill_jacobi(&bodies, own);
  for (int j = 0; j < N; j++) problem_label(made, j, "%c_%s", "xyz"[j % 3], bodies.name[j / 3]);
  vectors_of(&bodies, bodies.position, made->q);
  vectors_of(&bodies, bodies.velocity, made->v);
  const dvi_potential potentials[] = {{.name = "centres",
                                       .value_batch = centre_value,
                                       .gradient_batch = centre_gradient,
                                       .hessian_batch = centre_hessian,
                                       .user = own,
                                       .fast = 1},
                                      {.name = "rest",
                                       .value_batch = rest_value,
                                       .gradient_batch = rest_gradient,
                                       .hessian_batch = rest_hessian,
                                       .user = own}};
  const dvi_symmetry symmetries[] = {
      {.name = "angular_momentum_x", .generator = jacobi_rotation, .user = &axes[0]},
      {.name = "angular_momentum_y", .generator = jacobi_rotation, .user = &axes[1]},
      {.name = "angular_momentum_z", .generator = jacobi_rotation, .user = &axes[2]}};
  const dvi_system_terms terms = {.dimension = N,
                                  .mass = {.diagonal = own->masses},
                                  .potentials = potentials,
                                  .potential_count = 2,
                                  .symmetries = symmetries,
                                  .symmetry_count = 3,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {
    4.7083825336411119,  -1.4704788522616812, -0.74489754469428384, 7.0265493682472147,
    -6.3489579723028825, -2.9250243643680011, 14.337620444473285,   12.473405831672767,
    5.2601914203087961,  29.634746979157047,  -3.4532779365207740,  -2.1512147927000879,
    15.175632225973724,  -27.917151830626415, -13.284361722551581,
};
static const double digits_p[] = {
    2.2913784228195261e-6,  6.5839356955173558e-6,  2.7662849291655945e-6,   1.0345341232292006e-6,
    1.0575047784793604e-6,  3.9223972167526958e-7,  -1.1932835717189702e-7,  1.0659847138514317e-7,
    4.8374685310466517e-8,  2.0798960478863809e-8,  1.501678623856132e-7,    6.094681664025969e-8,
    2.2259391232824456e-11, 7.7688728651517702e-12, -4.2821690683151107e-12,
};

const problem_entry problem_entry_outer_solar_jacobi = {
    .name = "outer-solar-jacobi",
    .summary = "the outer solar system in Jacobi's vectors, Kepler motions and a small rest; AU "
               "and days",
    .make = outer_solar_jacobi_make,
    .h = 200.0,
    .t_end = 500000.0,
    .order_h = 200.0,
    .order_t_end = 10000.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
