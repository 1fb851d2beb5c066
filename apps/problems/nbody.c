#include "nbody.h"

#include <math.h>

#include "entry.h"

#define SYMMETRIES_MAX 6

/* A translation along an axis, or a rotation about it. */
typedef struct nbody_motion {
  const nbody *bodies;
  int axis;
} nbody_motion;

/* The state of the callbacks and generators. */
typedef struct gravity {
  nbody bodies;
  double masses[3 * NBODY_MAX];
  nbody_motion motions[SYMMETRIES_MAX];
} gravity;

/* The kernels below take the dimension as a constant at each of their callers, so that the loops
 * over the axes are unrolled and the loop over the points is the one that is vectorised. */

static inline int nbody_potential(const int dimension, int count, const double *q, double *V,
                                  const nbody *own)
{
  for (int k = 0; k < count; k++) V[k] = 0.0;
  for (int a = 0; a < own->bodies; a++)
    for (int b = a + 1; b < own->bodies; b++) {
      const double *restrict x_a = q + a * dimension * count, *restrict x_b = q +
                                                                              b * dimension * count;
      const double weight = own->G * own->mass[a] * own->mass[b];
      for (int k = 0; k < count; k++) {
        double r2 = 0.0;
        for (int i = 0; i < dimension; i++) {
          const double d = x_a[i * count + k] - x_b[i * count + k];
          r2 += d * d;
        }
        V[k] -= weight / sqrt(r2);
      }
    }
  return 0;
}

/* Compute the squared distances of all pairs at one point. Rows of q are `stride` apart. Returns
 * the number of squares. */
PROBLEM_INLINE int squared_distances(const int dimension, int stride, const double *restrict q,
                                     const nbody *own, double *restrict r2)
{
  const int row = dimension * stride;
  int at = 0;
  for (int a = 0; a < own->bodies; a++)
    for (int b = a + 1; b < own->bodies; b++) {
      double sum = 0.0;
      for (int i = 0; i < dimension; i++) {
        const double d = q[a * row + i * stride] - q[b * row + i * stride];
        sum += d * d;
      }
      r2[at++] = sum;
    }
  return at;
}

/* Add the pulls of all pairs to one gradient row, and subtract them from the other. */
PROBLEM_INLINE void nbody_pull(const int dimension, int stride, const double *restrict q,
                               const nbody *own, const double *restrict inverse_cube,
                               double *restrict V_q)
{
  const int row = dimension * stride;
  for (int a = 0; a < own->bodies; a++)
    for (int b = a + 1; b < own->bodies; b++) {
      const double weight = own->G * own->mass[a] * own->mass[b] * *inverse_cube++;
      for (int i = 0; i < dimension; i++) {
        const int at_a = a * row + i * stride, at_b = b * row + i * stride;
        const double force = weight * (q[at_a] - q[at_b]);
        V_q[at_a] += force;
        V_q[at_b] -= force;
      }
    }
}

/* Compute the gradient at a single point, where pairs take the place of points. */
PROBLEM_INLINE void nbody_gradient_at_one(const int dimension, int stride, const double *q,
                                          double *V_q, const nbody *own)
{
  double r[NBODY_PAIRS_MAX + PROBLEM_TILE];
  const int tile = PROBLEM_TILE / 2; /* six bodies have 15 pairs */
  const int numbers = squared_distances(dimension, stride, q, own, r);
  for (int k = numbers; k < numbers + tile; k++) r[k] = 1.0; /* the last tile is computed in full */
  for (int k = 0; k < numbers; k += tile) problem_inverse_cubes(tile, r + k);
  for (int i = 0; i < own->bodies * dimension; i++) V_q[i * stride] = 0.0;
  nbody_pull(dimension, stride, q, own, r, V_q);
}

/* Numbers at eight points. */
typedef double eight __attribute__((vector_size(8 * sizeof(double))));
typedef uint64_t eight_bits __attribute__((vector_size(8 * sizeof(double))));

/* Do what problem_inverse_cubes does. */
PROBLEM_INLINE void inverse_cube(eight *x)
{
  eight y = (eight)(UINT64_C(0x5fe6eb50c7b537a9) - ((eight_bits)*x >> 1)), e = 1.0 - *x * (y * y);
  y += y * (e * (0.5 + e * (0.375 + e * 0.3125)));
  e = 1.0 - *x * (y * y);
  y += y * (e * (0.5 + e * 0.375));
  *x = y * y * y;
}

/* The forces of pairs a < b, in [a][b]. */
typedef eight pair_forces[NBODY_MAX][NBODY_MAX][3];

/* Compute them at eight points, in registers. The processor takes up the next pair before one is
 * done. Rows are `stride` apart. */
PROBLEM_INLINE void forces_at_eight(const int dimension, int stride, const double *q,
                                    const nbody *own, pair_forces force)
{
  const int row = dimension * stride;
  eight at[3], d[3];
  for (int a = 0; a < own->bodies; a++) {
    for (int i = 0; i < dimension; i++) memcpy(&at[i], q + a * row + i * stride, sizeof at[i]);
    for (int b = a + 1; b < own->bodies; b++) {
      eight cube = {0};
      for (int i = 0; i < dimension; i++) {
        memcpy(&d[i], q + b * row + i * stride, sizeof d[i]);
        d[i] = at[i] - d[i];
        cube += d[i] * d[i];
      }
      inverse_cube(&cube);
      cube *= own->G * own->mass[a] * own->mass[b];
      for (int i = 0; i < dimension; i++) force[a][b][i] = cube * d[i];
    }
  }
}

PROBLEM_INLINE void nbody_gradient_at_eight(const int dimension, int stride, const double *q,
                                            double *V_q, const nbody *own)
{
  pair_forces force;
  forces_at_eight(dimension, stride, q, own, force);
  for (int c = 0; c < own->bodies; c++) {
    eight sum[3] = {{0}, {0}, {0}};
    for (int a = 0; a < c; a++)
      for (int i = 0; i < dimension; i++) sum[i] -= force[a][c][i];
    for (int b = c + 1; b < own->bodies; b++)
      for (int i = 0; i < dimension; i++) sum[i] += force[c][b][i];
    for (int i = 0; i < dimension; i++)
      memcpy(V_q + (c * dimension + i) * stride, &sum[i], sizeof sum[i]);
  }
}

/* Compute the gradients at fewer than eight points. The last point fills the others. */
PROBLEM_INLINE void nbody_gradient_at_few(const int dimension, int points, int stride,
                                          const double *q, double *V_q, const nbody *own)
{
  double filled[24 * NBODY_MAX] = {0}, result[24 * NBODY_MAX] = {0};
  const int n = own->bodies * dimension;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < 8; k++) filled[8 * i + k] = q[i * stride + (k < points ? k : points - 1)];
  nbody_gradient_at_eight(dimension, 8, filled, result, own);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < points; k++) V_q[i * stride + k] = result[8 * i + k];
}

/* Compute the gradients at eight points at once. Loops of known length need no preparation, which
 * would cost more than their work. */
PROBLEM_INLINE int nbody_gradient(const int dimension, int count, const double *q, double *V_q,
                                  const nbody *own)
{
  int k = 0;
  for (; k + 8 <= count; k += 8) nbody_gradient_at_eight(dimension, count, q + k, V_q + k, own);
  if (count - k > 1) nbody_gradient_at_few(dimension, count - k, count, q + k, V_q + k, own);
  if (count - k == 1) nbody_gradient_at_one(dimension, count, q + k, V_q + k, own);
  return 0;
}

/* Evaluate the Hessian. The block weight (1/r^3 - 3 d d^T/r^5) of a pair is added to both diagonal
 * blocks, and subtracted off the diagonal. */
static inline int nbody_hessian(const int dimension, int count, const double *q, double *V_qq,
                                const nbody *own)
{
  const int n = own->bodies * dimension;
  for (int j = 0; j < n * n * count; j++) V_qq[j] = 0.0;
  for (int a = 0; a < own->bodies; a++)
    for (int b = a + 1; b < own->bodies; b++) {
      const double weight = own->G * own->mass[a] * own->mass[b];
      for (int k = 0; k < count; k++) {
        double d[3], r2 = 0.0;
        for (int i = 0; i < dimension; i++) {
          d[i] = q[(a * dimension + i) * count + k] - q[(b * dimension + i) * count + k];
          r2 += d[i] * d[i];
        }
        const double inverse = weight / (r2 * sqrt(r2)), curvature = 3.0 * inverse / r2;
        for (int j = 0; j < dimension; j++)
          for (int i = 0; i < dimension; i++) {
            const double entry = (i == j ? inverse : 0.0) - curvature * d[i] * d[j];
            const int a_i = a * dimension + i, b_i = b * dimension + i;
            double *a_column = V_qq + (a * dimension + j) * n * count + k,
                   *b_column = V_qq + (b * dimension + j) * n * count + k;
            a_column[a_i * count] += entry;
            b_column[b_i * count] += entry;
            a_column[b_i * count] = -entry;
            b_column[a_i * count] = -entry;
          }
      }
    }
  return 0;
}

/* The callbacks of one dimension. */
#define CALLBACKS(dimension)                                                                       \
  static int value_##dimension(int count, const double *t, const double *q, double *V, void *user) \
  {                                                                                                \
    (void)t;                                                                                       \
    return nbody_potential(dimension, count, q, V, user);                                          \
  }                                                                                                \
  PROBLEM_LANES static int gradient_##dimension(int count, const double *t, const double *q,       \
                                                double *V_q, void *user)                           \
  {                                                                                                \
    (void)t;                                                                                       \
    return nbody_gradient(dimension, count, q, V_q, user);                                         \
  }                                                                                                \
  static int hessian_##dimension(int count, const double *t, const double *q, double *V_qq,        \
                                 void *user)                                                       \
  {                                                                                                \
    (void)t;                                                                                       \
    return nbody_hessian(dimension, count, q, V_qq, user);                                         \
  }
CALLBACKS(2)
CALLBACKS(3)

static int nbody_translation(const double *q, double *xi, void *user)
{
  const nbody_motion *own = user;
  (void)q;
  for (int i = 0; i < own->bodies->bodies * own->bodies->dimension; i++)
    xi[i] = i % own->bodies->dimension == own->axis;
  return 0;
}

/* Compute xi = e_axis x x for each body. In the plane the axis is the third one. */
static int nbody_rotation(const double *q, double *xi, void *user)
{
  const nbody_motion *own = user;
  const int dimension = own->bodies->dimension, first = (own->axis + 1) % 3,
            second = (own->axis + 2) % 3;
  for (int i = 0; i < own->bodies->bodies * dimension; i++) xi[i] = 0.0;
  for (int a = 0; a < own->bodies->bodies; a++) {
    xi[a * dimension + first] = -q[a * dimension + second];
    xi[a * dimension + second] = q[a * dimension + first];
  }
  return 0;
}

static int nbody_make_symmetries(gravity *own, dvi_symmetry *symmetries)
{
  static const char *const momentum[3] = {"momentum_x", "momentum_y", "momentum_z"};
  static const char *const angular[3] = {"angular_momentum_x", "angular_momentum_y",
                                         "angular_momentum_z"};
  const int planar = own->bodies.dimension == 2;
  int count = 0;
  for (int axis = 0; axis < own->bodies.dimension; axis++, count++)
    symmetries[count] = (dvi_symmetry){.name = momentum[axis], .generator = nbody_translation};
  for (int axis = planar ? 2 : 0; axis < 3; axis++, count++)
    symmetries[count] = (dvi_symmetry){.name = planar ? "angular_momentum" : angular[axis],
                                       .generator = nbody_rotation};
  for (int i = 0; i < count; i++) {
    own->motions[i] = (nbody_motion){.bodies = &own->bodies,
                                     .axis = i < own->bodies.dimension ? i
                                             : planar                  ? 2
                                                                       : i - 3};
    symmetries[i].user = &own->motions[i];
  }
  return count;
}

static dvi_status nbody_make_system(gravity *own, problem *made)
{
  const int planar = own->bodies.dimension == 2;
  const dvi_potential attraction = {.name = "gravity",
                                    .value_batch = planar ? value_2 : value_3,
                                    .gradient_batch = planar ? gradient_2 : gradient_3,
                                    .hessian_batch = planar ? hessian_2 : hessian_3,
                                    .user = &own->bodies};
  dvi_symmetry symmetries[SYMMETRIES_MAX];
  const int symmetry_count = nbody_make_symmetries(own, symmetries);
  const dvi_system_terms terms = {.dimension = made->nq,
                                  .mass = {.diagonal = own->masses},
                                  .potentials = &attraction,
                                  .potential_count = 1,
                                  .symmetries = symmetries,
                                  .symmetry_count = symmetry_count,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

dvi_status nbody_make(const nbody *bodies, problem *made)
{
  const int dimension = bodies->dimension;
  const dvi_status status = problem_room(made, bodies->bodies * dimension, sizeof(gravity));
  if (status != DVI_OK) return status;
  gravity *own = made->parameters;
  own->bodies = *bodies;
  made->bodies = bodies->bodies;
  for (int a = 0; a < bodies->bodies; a++)
    for (int i = 0; i < dimension; i++) {
      const int j = a * dimension + i;
      problem_label(made, j, "%c_%s", "xyz"[i], bodies -> name[a]);
      made->q[j] = bodies->position[a][i];
      made->v[j] = bodies->velocity[a][i];
      own->masses[j] = bodies->mass[a];
    }
  return nbody_make_system(own, made);
}
