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

/* Pairs of bodies that one potential sums. */
typedef enum nbody_pairs { ALL_PAIRS, PAIRS_OF_LAST, PAIRS_OF_OTHERS } nbody_pairs;

/* Give the range of the second body of pairs whose first is a, which is not the last body. */
PROBLEM_INLINE int first_partner(const nbody_pairs pairs, const nbody *own, int a)
{
  return pairs == PAIRS_OF_LAST ? own->bodies - 1 : a + 1;
}

PROBLEM_INLINE int end_of_partners(const nbody_pairs pairs, const nbody *own)
{
  return pairs == PAIRS_OF_OTHERS ? own->bodies - 1 : own->bodies;
}

/* The kernels below take the dimension and the pairs as constants at each of their callers, so that
 * the loops over the axes are unrolled and the loop over the points is the one that is
 * vectorised. */

static inline int nbody_potential(const int dimension, const nbody_pairs pairs, int count,
                                  const double *q, double *V, const nbody *own)
{
  for (int k = 0; k < count; k++) V[k] = 0.0;
  for (int a = 0; a < own->bodies - 1; a++)
    for (int b = first_partner(pairs, own, a); b < end_of_partners(pairs, own); b++) {
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

/* Compute the squared distances of all pairs at `lanes` points, [pairs*lanes]. Rows of q are
 * `stride` apart. Returns the number of squares. */
PROBLEM_INLINE int squared_distances(const int dimension, const nbody_pairs pairs, const int lanes,
                                     int stride, const double *restrict q, const nbody *own,
                                     double *restrict r2)
{
  const int row = dimension * stride;
  int at = 0;
  for (int a = 0; a < own->bodies - 1; a++)
    for (int b = first_partner(pairs, own, a); b < end_of_partners(pairs, own); b++, at += lanes)
      for (int k = 0; k < lanes; k++) {
        double sum = 0.0;
        for (int i = 0; i < dimension; i++) {
          const double d = q[a * row + i * stride + k] - q[b * row + i * stride + k];
          sum += d * d;
        }
        r2[at + k] = sum;
      }
  return at;
}

/* Add the pulls of all pairs to one gradient row, and subtract them from the other. */
PROBLEM_INLINE void nbody_pull(const int dimension, const nbody_pairs pairs, const int lanes,
                               int stride, const double *restrict q, const nbody *own,
                               const double *restrict inverse_cube, double *restrict V_q)
{
  const int row = dimension * stride;
  for (int a = 0; a < own->bodies - 1; a++)
    for (int b = first_partner(pairs, own, a); b < end_of_partners(pairs, own);
         b++, inverse_cube += lanes) {
      const double weight = own->G * own->mass[a] * own->mass[b];
      for (int i = 0; i < dimension; i++)
        for (int k = 0; k < lanes; k++) {
          const int at_a = a * row + i * stride + k, at_b = b * row + i * stride + k;
          const double force = weight * inverse_cube[k] * (q[at_a] - q[at_b]);
          V_q[at_a] = force + (pairs == PAIRS_OF_LAST ? 0.0 : V_q[at_a]);
          V_q[at_b] -= force;
        }
    }
}

PROBLEM_INLINE void nbody_gradient_at(const int dimension, const nbody_pairs pairs, const int lanes,
                                      int stride, const double *q, double *V_q, const nbody *own)
{
  double r[NBODY_PAIRS_MAX * 8 + PROBLEM_TILE_MAX];
  /* six bodies have 15 pairs, 5 with the last one */
  const int tile = lanes == 1               ? PROBLEM_TILE / 2
                   : pairs == PAIRS_OF_LAST ? PROBLEM_TILE / 4 * 5
                                            : PROBLEM_TILE;
  const int numbers = squared_distances(dimension, pairs, lanes, stride, q, own, r);
  for (int k = numbers; k < numbers + tile; k++) r[k] = 1.0; /* the last tile is computed in full */
  for (int k = 0; k < numbers; k += tile) problem_inverse_cubes(tile, r + k);
  nbody_pull(dimension, pairs, lanes, stride, q, own, r, V_q);
}

/* Compute the gradients at fewer than eight points. The last point fills the others. */
PROBLEM_INLINE void nbody_gradient_of_few(const int dimension, const nbody_pairs pairs, int points,
                                          int stride, const double *q, double *V_q,
                                          const nbody *own)
{
  double filled[24 * NBODY_MAX] = {0}, result[24 * NBODY_MAX] = {0};
  const int n = own->bodies * dimension;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < 8; k++) filled[8 * i + k] = q[i * stride + (k < points ? k : points - 1)];
  nbody_gradient_at(dimension, pairs, 8, 8, filled, result, own);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < points; k++) V_q[i * stride + k] = result[8 * i + k];
}

/* Compute the gradients at eight points at once. Loops of known length need no preparation, which
 * would cost more than their work. For a single point the pairs take the place of points. */
PROBLEM_INLINE int nbody_gradient(const int dimension, const nbody_pairs pairs, int count,
                                  const double *q, double *V_q, const nbody *own)
{
  int k = 0;
  const int zeros = pairs == PAIRS_OF_LAST ? (own->bodies - 1) * dimension * count : 0;
  for (int j = zeros; j < own->bodies * dimension * count; j++) V_q[j] = 0.0;
  for (; k + 8 <= count; k += 8) nbody_gradient_at(dimension, pairs, 8, count, q + k, V_q + k, own);
  if (count - k > 1) nbody_gradient_of_few(dimension, pairs, count - k, count, q + k, V_q + k, own);
  if (count - k == 1) nbody_gradient_at(dimension, pairs, 1, count, q + k, V_q + k, own);
  return 0;
}

/* Evaluate the Hessian. The block weight (1/r^3 - 3 d d^T/r^5) of a pair is added to both diagonal
 * blocks, and subtracted off the diagonal. */
static inline int nbody_hessian(const int dimension, const nbody_pairs pairs, int count,
                                const double *q, double *V_qq, const nbody *own)
{
  const int n = own->bodies * dimension;
  for (int j = 0; j < n * n * count; j++) V_qq[j] = 0.0;
  for (int a = 0; a < own->bodies - 1; a++)
    for (int b = first_partner(pairs, own, a); b < end_of_partners(pairs, own); b++) {
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

/* The callbacks of one dimension and of some pairs. */
#define CALLBACKS(name, dimension, pairs)                                                          \
  static int value_##name(int count, const double *t, const double *q, double *V, void *user)      \
  {                                                                                                \
    (void)t;                                                                                       \
    return nbody_potential(dimension, pairs, count, q, V, user);                                   \
  }                                                                                                \
  PROBLEM_LANES static int gradient_##name(int count, const double *t, const double *q,            \
                                           double *V_q, void *user)                                \
  {                                                                                                \
    (void)t;                                                                                       \
    return nbody_gradient(dimension, pairs, count, q, V_q, user);                                  \
  }                                                                                                \
  static int hessian_##name(int count, const double *t, const double *q, double *V_qq, void *user) \
  {                                                                                                \
    (void)t;                                                                                       \
    return nbody_hessian(dimension, pairs, count, q, V_qq, user);                                  \
  }
CALLBACKS(in_plane, 2, ALL_PAIRS)
CALLBACKS(in_space, 3, ALL_PAIRS)
CALLBACKS(of_last, 3, PAIRS_OF_LAST)
CALLBACKS(of_others, 3, PAIRS_OF_OTHERS)

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

/* Give the potential of some pairs. */
#define POTENTIAL(title, kind, bodies)                                               \
  {                                                                                  \
    .name = (title), .value_batch = value_##kind, .gradient_batch = gradient_##kind, \
    .hessian_batch = hessian_##kind, .user = (bodies)                                \
  }

/* Fill the potentials. Returns their number. A central body is one of space. */
static int nbody_make_potentials(gravity *own, dvi_potential *potentials)
{
  nbody *bodies = &own->bodies;
  const dvi_potential in_plane = POTENTIAL("gravity", in_plane, bodies),
                      in_space = POTENTIAL("gravity", in_space, bodies),
                      of_last = POTENTIAL("pulls of the centre", of_last, bodies),
                      of_others = POTENTIAL("pulls of the others", of_others, bodies);
  potentials[0] = bodies->central ? of_last : bodies->dimension == 2 ? in_plane : in_space;
  potentials[0].fast = bodies->central;
  potentials[1] = of_others;
  return bodies->central ? 2 : 1;
}

static dvi_status nbody_make_system(gravity *own, problem *made)
{
  dvi_potential potentials[2];
  dvi_symmetry symmetries[SYMMETRIES_MAX];
  const int potential_count = nbody_make_potentials(own, potentials),
            symmetry_count = nbody_make_symmetries(own, symmetries);
  const dvi_system_terms terms = {.dimension = made->nq,
                                  .mass = {.diagonal = own->masses},
                                  .potentials = potentials,
                                  .potential_count = potential_count,
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
